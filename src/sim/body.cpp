#include "sim/body.hpp"

#include "base/array.hpp"
#include "base/error.hpp"
#include "base/llu.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>
#include <span>
#include <tuple>

namespace vox::sim {

namespace {

constexpr double farthest = 1e15; // largest coordinate; the sixth power of it is finite

void check_vectors(const double* values, std::uint64_t count, const char* name) {
    for (std::uint64_t i = 0; i < 3 * count; ++i) {
        if (!std::isfinite(values[i]))
            throw Error(VOX_ERROR_NON_FINITE, format("%s of vertex %llu are not finite: coordinate %c is %g",
                                                     name, llu(i / 3), "xyz"[i % 3], values[i]));
        if (std::abs(values[i]) > farthest)
            refuse(format("%s of vertex %llu: coordinate %c is %g, expected at most %g in size", name,
                          llu(i / 3), "xyz"[i % 3], values[i], farthest));
    }
}

void check_number(double value, bool zero_allowed, const char* name) {
    if (!std::isfinite(value) || value < 0 || (value == 0 && !zero_allowed) || value > 1e60)
        refuse(format("body %s is %g, expected a number %s 0, at most 1e60", name, value,
                      zero_allowed ? "of at least" : "above"));
}

void check_desc(const vox_sim_body_desc& desc) {
    constexpr std::uint32_t known = VOX_SIM_BODY_SELF_COLLISION | VOX_SIM_BODY_FIXED;
    if (desc.flags & ~known)
        refuse(format("body flags are 0x%x, expected a combination of 0x%x", desc.flags, known));
    if (!desc.positions) refuse("body positions are null");
    if (!desc.tets || desc.tet_count == 0)
        refuse(format("body tets are %s, tet_count is %llu: a body needs at least one tet",
                      desc.tets ? "given" : "null", llu(desc.tet_count)));
    if (desc.vertex_count > VOX_MAX_VERTICES || desc.tet_count > VOX_MAX_TETS)
        throw Error(VOX_ERROR_LIMIT,
                    format("the body has %llu vertices and %llu tets, the limits are %u and %u",
                           llu(desc.vertex_count), llu(desc.tet_count), VOX_MAX_VERTICES, VOX_MAX_TETS));
    for (std::uint64_t i = 0; i < 4 * desc.tet_count; ++i)
        if (desc.tets[i] >= desc.vertex_count)
            throw Error(VOX_ERROR_INVALID_MESH, format("tet %llu names vertex %u of %llu", llu(i / 4),
                                                       desc.tets[i], llu(desc.vertex_count)));
    check_number(desc.density, false, "density");
    check_number(desc.youngs_modulus, true, "youngs_modulus");
    check_number(desc.bulk_modulus, true, "bulk_modulus");
    check_number(desc.damping, true, "damping");
    check_vectors(desc.positions, desc.vertex_count, "positions");
    if (desc.rest_positions) check_vectors(desc.rest_positions, desc.vertex_count, "rest_positions");
    if (desc.velocities) check_vectors(desc.velocities, desc.vertex_count, "velocities");
}

Vec3 vector_at(const double* values, std::size_t i) {
    return {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
}

// Gives a quarter of each tet's mass to each of its corners. Much lighter particles would stall the solver,
// so none gets less than a hundredth of the mean. Particles of no tet get the mean.
void lump_masses(SoftBody& body, std::span<const double> volumes6, double density) {
    const std::size_t count = body.positions.size();
    Array<bool> used(count, false, body.masses.memory());
    body.masses.assign(count, 0);
    double total = 0;
    for (std::size_t t = 0; t < volumes6.size(); ++t) {
        const double quarter = density * std::abs(volumes6[t]) / 24;
        for (std::size_t k = 0; k < 4; ++k) {
            body.masses[body.tets[4 * t + k]] += quarter;
            used[body.tets[4 * t + k]] = true;
        }
        total += 4 * quarter;
    }
    if (!(total >= 1e-60 && total <= 1e60))
        refuse(
            format("the body has a mass of %g: %llu of its %zu tets have no rest volume, its density is %g",
                   total, llu(body.flat_tets), volumes6.size(), density));
    const double mean = total / static_cast<double>(std::count(used.begin(), used.end(), true));
    for (std::size_t v = 0; v < count; ++v) {
        if (body.masses[v] < mean / 100) {
            ++body.raised_masses;
            body.masses[v] = used[v] ? mean / 100 : mean;
        }
    }
    body.inverse_masses.resize(count);
    for (std::size_t v = 0; v < count; ++v) body.inverse_masses[v] = body.fixed ? 0 : 1 / body.masses[v];
}

// Makes one constraint for each edge. Let V be the volume that belongs to an edge (a sixth of each tet around
// it). If the directions of the edges are evenly distributed, springs of stiffness 6 E V / l^2 resist a
// uniform stretch like an isotropic material of Young's modulus E and Poisson's ratio 1/4, whose C1111 is 6 E
// times the mean of cos^4, which is 1/5.
void make_edges(SoftBody& body, std::span<const Vec3> rest, std::span<const double> volumes6,
                double modulus) {
    struct Side {
        std::uint32_t a, b;
        std::uint64_t place; // among the sides of all tets
        double volume;
    };
    Array<Side> sides(body.edges.memory());
    sides.reserve(6 * volumes6.size());
    for (std::size_t t = 0; t < volumes6.size(); ++t) {
        const std::uint32_t* corners = &body.tets[4 * t];
        for (std::size_t i = 0; i < 4; ++i)
            for (std::size_t j = i + 1; j < 4; ++j)
                if (corners[i] != corners[j])
                    sides.push_back({std::min(corners[i], corners[j]), std::max(corners[i], corners[j]),
                                     sides.size(), std::abs(volumes6[t]) / 36});
    }
    // `place` fixes the order of the sums below. A stable sort would need more memory.
    std::sort(sides.begin(), sides.end(), [](const Side& s, const Side& t) {
        return std::tie(s.a, s.b, s.place) < std::tie(t.a, t.b, t.place);
    });
    std::size_t count = 0;
    double total_length = 0, total_volume = 0;
    for (const Side& side : sides) {
        total_volume += side.volume;
        if (count > 0 && sides[count - 1].a == side.a && sides[count - 1].b == side.b) {
            sides[count - 1].volume += side.volume;
        } else {
            sides[count++] = side;
            total_length += (rest[side.a] - rest[side.b]).norm();
        }
    }
    sides.resize(count);
    if (count == 0) return;
    body.mean_edge = total_length / static_cast<double>(count);
    if (modulus == 0) return;
    // Edges whose tets are all flat, and edges of zero length, need a finite compliance too.
    const double least_volume = total_volume / static_cast<double>(count) / 100;
    body.edges.reserve(count);
    for (const Side& side : sides) {
        const double length = (rest[side.a] - rest[side.b]).norm();
        const double scale = std::max(length, body.mean_edge / 1000);
        body.edges.push_back(
            {side.a, side.b, length, scale * scale / (6 * modulus * std::max(side.volume, least_volume)), 0});
    }
}

// Makes one constraint for each tet that has a volume at rest. Its energy is K V0 / 2 times the square of the
// relative change.
void make_volumes(SoftBody& body, std::span<const Vec3> rest, std::span<const double> volumes6,
                  double modulus) {
    if (modulus == 0) return;
    body.volumes.reserve(volumes6.size());
    for (std::size_t t = 0; t < volumes6.size(); ++t) {
        if (volumes6[t] == 0) continue;
        const std::uint32_t* c = &body.tets[4 * t];
        const std::array<Vec3, 3> edge = {rest[c[1]] - rest[c[0]], rest[c[2]] - rest[c[0]],
                                          rest[c[3]] - rest[c[0]]};
        const std::array<Vec3, 3> gradient = {edge[1].cross(edge[2]), edge[2].cross(edge[0]),
                                              edge[0].cross(edge[1])};
        double answer = body.inverse_masses[c[0]] * (gradient[0] + gradient[1] + gradient[2]).squaredNorm();
        for (std::size_t k = 0; k < 3; ++k)
            answer += body.inverse_masses[c[k + 1]] * gradient[k].squaredNorm();
        body.volumes.push_back(
            {{c[0], c[1], c[2], c[3]}, volumes6[t], 6 * std::abs(volumes6[t]) / modulus, 0, answer});
    }
}

// Sorts constraints by greedy colours. Those of one colour share no particle, so that the processor need not
// wait for one before it begins the next. Constraints that find none of 64 colours come last. `particles`
// returns a constraint's particles.
template <class Constraint, class Particles>
void sort_by_color(Array<Constraint>& constraints, std::size_t particle_count, Particles particles) {
    constexpr std::size_t color_count = 64;
    std::pmr::memory_resource* memory = constraints.memory();
    Array<std::uint64_t> taken(particle_count, 0, memory); // a bit for each colour used at a particle
    Array<std::uint8_t> color_of(memory);
    color_of.reserve(constraints.size());
    std::array<std::size_t, color_count + 2> first{}; // constraint of each colour, once sorted
    for (const Constraint& constraint : constraints) {
        std::uint64_t around = 0;
        for (const std::uint32_t p : particles(constraint)) around |= taken[p];
        const auto color = static_cast<std::size_t>(std::countr_one(around));
        if (color < color_count)
            for (const std::uint32_t p : particles(constraint)) taken[p] |= std::uint64_t{1} << color;
        color_of.push_back(static_cast<std::uint8_t>(color));
        ++first[color + 1];
    }
    std::partial_sum(first.begin(), first.end(), first.begin());
    Array<Constraint> sorted(constraints.size(), memory);
    for (std::size_t c = 0; c < constraints.size(); ++c) sorted[first[color_of[c]]++] = constraints[c];
    constraints.swap(sorted);
}

} // namespace

double volume6(const Vec3& p0, const Vec3& p1, const Vec3& p2, const Vec3& p3) {
    return (p1 - p0).cross(p2 - p0).dot(p3 - p0);
}

void DestroyBody::operator()(SoftBody* body) const noexcept {
    std::pmr::polymorphic_allocator<>(body->positions.memory()).delete_object(body);
}

BodyHandle make_body(const vox_sim_body_desc& desc, std::pmr::memory_resource* memory) {
    check_desc(desc);
    BodyHandle made(std::pmr::polymorphic_allocator<>(memory).new_object<SoftBody>(memory));
    SoftBody& body = *made;
    body.fixed = (desc.flags & VOX_SIM_BODY_FIXED) != 0;
    body.damping = desc.damping;
    body.tets.assign(desc.tets, desc.tets + 4 * desc.tet_count);
    const std::size_t count = static_cast<std::size_t>(desc.vertex_count);
    body.positions.resize(count);
    body.previous.resize(count);
    body.velocities.assign(count, Vec3::Zero());
    body.grid_positions.resize(3 * count);
    set_state(body, desc.positions, desc.velocities);

    Array<Vec3> rest(count, memory);
    const double* rest_positions = desc.rest_positions ? desc.rest_positions : desc.positions;
    for (std::size_t v = 0; v < count; ++v) rest[v] = vector_at(rest_positions, v);
    Array<double> volumes6(static_cast<std::size_t>(desc.tet_count), memory);
    for (std::size_t t = 0; t < volumes6.size(); ++t) {
        const std::uint32_t* c = &body.tets[4 * t];
        volumes6[t] = volume6(rest[c[0]], rest[c[1]], rest[c[2]], rest[c[3]]);
        // A volume within rounding error counts as zero.
        const double size =
            std::max({(rest[c[1]] - rest[c[0]]).squaredNorm(), (rest[c[2]] - rest[c[0]]).squaredNorm(),
                      (rest[c[3]] - rest[c[0]]).squaredNorm()});
        if (std::abs(volumes6[t]) <= 1e-12 * size * std::sqrt(size)) volumes6[t] = 0;
        if (volumes6[t] == 0) ++body.flat_tets;
        if (volumes6[t] < 0) ++body.inverted_tets;
    }
    lump_masses(body, volumes6, desc.density);
    make_edges(body, rest, volumes6, desc.youngs_modulus);
    make_volumes(body, rest, volumes6, desc.bulk_modulus);
    sort_by_color(body.edges, count, [](const EdgeConstraint& edge) { return std::array{edge.a, edge.b}; });
    sort_by_color(body.volumes, count,
                  [](const VolumeConstraint& tet) { return std::to_array(tet.corners); });
    return made;
}

std::string name_of(const SoftBody& body) {
    return format("body %u (slot %u, user data %llu)", body.mesh, body.slot, llu(body.user_data));
}

void set_state(SoftBody& body, const double* positions, const double* velocities) {
    const std::size_t count = body.positions.size();
    if (positions) check_vectors(positions, count, "positions");
    if (velocities) check_vectors(velocities, count, "velocities");
    for (std::size_t v = 0; v < count; ++v) {
        if (positions) body.positions[v] = body.previous[v] = vector_at(positions, v);
        if (velocities && !body.fixed) body.velocities[v] = vector_at(velocities, v);
    }
    write_grid_positions(body);
}

void write_grid_positions(SoftBody& body) {
    body.most_rounded = 0;
    for (std::size_t v = 0; v < body.positions.size(); ++v)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double exact = body.positions[v][static_cast<Eigen::Index>(axis)];
            const float rounded = body.grid_positions[3 * v + axis] = static_cast<float>(exact);
            body.most_rounded = std::max(body.most_rounded, std::abs(exact - double{rounded}));
        }
}

bool is_far_away(const SoftBody& body) noexcept { return body.most_rounded > 0x1p-14 * body.mean_edge; }

} // namespace vox::sim
