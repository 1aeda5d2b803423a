#include "sim/resolve.hpp"

#include "base/llu.hpp"
#include "sim/constraints.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

namespace vox::sim {

namespace {

constexpr double stiffest = 1e60; // softened to what a sweep can handle
constexpr int sweeps = 4;
constexpr double step_of_edge = 0.4;

// Contacts are answered at once and without friction.
constexpr ContactSettings settings{.friction = 0, .compliance = 0, .push_speed = 1e60, .slop = 0};

// Lets the constraints keep the present shape.
void rest_as_it_is(SoftBody& body, std::size_t first_edge = 0) {
    const Vec3* x = body.positions.data();
    for (EdgeConstraint& edge : std::span(body.edges).subspan(first_edge))
        edge.rest_length = (x[edge.a] - x[edge.b]).norm();
    for (VolumeConstraint& tet : body.volumes) {
        const std::uint32_t* c = tet.corners;
        tet.rest_volume6 = volume6(x[c[0]], x[c[1]], x[c[2]], x[c[3]]);
    }
}

// The volume inside closed triangles, positive if they wind counter-clockwise as seen from outside.
double enclosed(const SoftBody& body, std::span<const std::uint32_t> triangles) {
    double sum = 0;
    const Vec3* x = body.positions.data();
    for (std::size_t t = 0; t < triangles.size(); t += 3)
        sum += volume6(x[0], x[triangles[t]], x[triangles[t + 1]], x[triangles[t + 2]]);
    return sum / 6;
}

} // namespace

Resolver::Resolver(const vox_resolve_desc& desc, std::span<const vox_resolve_body> bodies)
    : memory_(desc.allocator), desc_(desc), bodies_(&memory_), solid_(&memory_), first_bend_(&memory_), shapes_(bodies.size(), VOX_NULL_BODY, &memory_), overlaps_itself_(bodies.size(), false, &memory_), place_(bodies.size(), &memory_), index_(&memory_), triangles_(&memory_), gradients_(&memory_), enclosed_(&memory_), part_(&memory_), wrong_(&memory_), part_size_(&memory_),
      first_(&memory_), body_of_(&memory_), all_(&memory_), start_(&memory_), clear_(&memory_),
      faces_(&memory_), opposites_(&memory_), first_opposite_(&memory_), contacts_(&memory_) {
    if (desc_.max_iterations == 0) desc_.max_iterations = 400;
    make_surface(bodies);
    for (const bool with_tets : {false, true})
        for (std::uint32_t b = 0; b < bodies.size(); ++b)
            if ((bodies[b].tet_count > 0) == with_tets) {
                place_[b] = static_cast<std::uint32_t>(bodies_.size());
                first_bend_.push_back(0);
                bodies_.push_back(make(bodies[b], b));
                bool closed = true; // as long as each edge has two faces
                for (std::size_t e = 0; e < edges_.count; ++e)
                    if (body_of_[edges_.vertices[2 * e]] == b)
                        closed = closed && first_opposite_[e + 1] - first_opposite_[e] >= 2;
                solid_.push_back(closed);
                set_substep(*bodies_.back(), 1);
            }
    for (std::uint32_t b = 0; b < bodies_.size(); ++b) bodies_[b]->slot = b;
    index_.resize(bodies.size());
    for (std::uint32_t b = 0; b < bodies.size(); ++b) {
        index_[place_[b]] = b;
        triangles_.push_back(Array<std::uint32_t>(bodies[b].faces, bodies[b].faces + 3 * bodies[b].face_count, &memory_));
        if (enclosed(*bodies_[place_[b]], triangles_.back()) < 0)
            for (std::size_t t = 0; t < triangles_.back().size(); t += 3) std::swap(triangles_.back()[t + 1], triangles_.back()[t + 2]);
    }
    for (std::uint32_t b = 0; b < bodies.size(); ++b) enclosed_.push_back(enclosed(*bodies_[b], triangles_[index_[b]]));
    make_grid();
}

BodyHandle Resolver::make(const vox_resolve_body& body, std::uint32_t index) {
    if (body.tet_count > 0) {
        vox_sim_body_desc desc = vox_default_sim_body_desc();
        desc.flags = body.flags & VOX_RESOLVE_FIXED ? VOX_SIM_BODY_FIXED : 0;
        desc.positions = body.positions;
        desc.vertex_count = body.vertex_count;
        desc.tets = body.tets;
        desc.tet_count = body.tet_count;
        desc.youngs_modulus = desc.bulk_modulus = stiffest;
        return make_body(desc, &memory_);
    }
    // A shell as thick as its mean edge is long; springs across edges resist bending.
    BodyHandle made(std::pmr::polymorphic_allocator<>(&memory_).new_object<SoftBody>(&memory_));
    SoftBody& shell = *made;
    shell.fixed = (body.flags & VOX_RESOLVE_FIXED) != 0;
    const std::uint32_t first = first_[index];
    const std::size_t count = static_cast<std::size_t>(body.vertex_count);
    shell.positions.assign(&all_[first], &all_[first] + count);
    shell.previous = shell.positions;
    const auto spring = [&](std::uint32_t a, std::uint32_t b) {
        shell.edges.push_back({a - first, b - first, (all_[a] - all_[b]).norm(), 0, 0});
    };
    for (std::size_t e = 0; e < edges_.count; ++e) {
        const std::uint32_t a = edges_.vertices[2 * e], b = edges_.vertices[2 * e + 1];
        if (body_of_[a] != index || a == b) continue;
        spring(a, b);
        shell.mean_edge += shell.edges.back().rest_length;
    }
    const std::size_t sides = shell.edges.size();
    shell.mean_edge /= static_cast<double>(std::max<std::size_t>(sides, 1));
    for (std::size_t e = 0; e < edges_.count; ++e)
        if (body_of_[edges_.vertices[2 * e]] == index)
            for (std::uint32_t i = first_opposite_[e]; i + 1 < first_opposite_[e + 1]; ++i)
                if (opposites_[i] != opposites_[i + 1]) spring(opposites_[i], opposites_[i + 1]);
    first_bend_.back() = sides;
    shell.masses.assign(count, 0);
    for (const Corners& f : faces_)
        if (body_of_[f[0]] == index)
            for (const std::uint32_t v : f)
                shell.masses[v - first] +=
                    (all_[f[1]] - all_[f[0]]).cross(all_[f[2]] - all_[f[0]]).norm() / 6 * shell.mean_edge * 1000;
    const double mean = std::max(
        std::accumulate(shell.masses.begin(), shell.masses.end(), 0.0) / static_cast<double>(count), 1e-60);
    for (double& mass : shell.masses) mass = std::max(mass, mean / 100);
    shell.inverse_masses.resize(count);
    for (std::size_t v = 0; v < count; ++v) shell.inverse_masses[v] = shell.fixed ? 0 : 1 / shell.masses[v];
    return made;
}

// All boundaries as one surface.
void Resolver::make_surface(std::span<const vox_resolve_body> bodies) {
    for (std::uint32_t b = 0; b < bodies.size(); ++b) {
        const auto first = static_cast<std::uint32_t>(all_.size());
        first_.push_back(first);
        for (std::uint64_t v = 0; v < bodies[b].vertex_count; ++v) {
            const double* p = bodies[b].positions + 3 * v;
            all_.push_back(Vec3(p[0], p[1], p[2]));
            body_of_.push_back(b);
        }
        for (std::uint64_t f = 0; f < bodies[b].face_count; ++f) {
            const std::uint32_t* v = bodies[b].faces + 3 * f;
            faces_.push_back({first + v[0], first + v[1], first + v[2]});
        }
        // A facet of exactly one tetrahedron.
        Array<std::array<std::uint32_t, 6>> facets(&memory_);
        for (std::uint64_t t = 0; t < bodies[b].tet_count; ++t)
            for (const auto& k : {Corners{1, 2, 3}, Corners{0, 3, 2}, Corners{0, 1, 3}, Corners{0, 2, 1}}) {
                const std::uint32_t* v = bodies[b].tets + 4 * t;
                Corners f{v[k[0]], v[k[1]], v[k[2]]}, sorted = f;
                std::sort(sorted.begin(), sorted.end());
                facets.push_back({sorted[0], sorted[1], sorted[2], f[0], f[1], f[2]});
            }
        std::sort(facets.begin(), facets.end());
        const auto same = [&](std::size_t i, std::size_t j) {
            return j < facets.size() && std::equal(facets[i].begin(), facets[i].begin() + 3, facets[j].begin());
        };
        for (std::size_t i = 0, end; i < facets.size(); i = end) {
            for (end = i + 1; same(i, end);) ++end;
            if (end == i + 1) faces_.push_back({first + facets[i][3], first + facets[i][4], first + facets[i][5]});
        }
    }
    first_.push_back(static_cast<std::uint32_t>(all_.size()));
    start_ = Array<Vec3>(all_, &memory_);
    clear_.resize(all_.size());
    part_.resize(all_.size());
    wrong_.resize(all_.size(), false);
    part_size_.resize(all_.size());
    vox_surface_desc desc = vox_default_surface_desc();
    desc.worker_count = desc_.worker_count;
    desc.vertex_count = all_.size();
    desc.face_count = faces_.size();
    desc.faces = faces_.empty() ? nullptr : faces_[0].data();
    desc.byte_budget = UINT64_MAX;
    desc.allocator = desc_.allocator;
    vox_surface* made = nullptr;
    check(vox_surface_create(&desc, &made));
    surface_.reset(made);
    check(vox_surface_get_features(made, VOX_FEATURE_EDGE, &edges_));
    // The corners across each edge.
    struct Side {
        std::uint32_t a, b, opposite;
        auto operator<=>(const Side&) const = default;
    };
    Array<Side> list(&memory_);
    for (const Corners& f : faces_)
        for (std::size_t k = 0; k < 3; ++k)
            list.push_back({std::min(f[k], f[(k + 1) % 3]), std::max(f[k], f[(k + 1) % 3]), f[(k + 2) % 3]});
    std::sort(list.begin(), list.end());
    for (std::size_t e = 0; e < edges_.count; ++e) {
        first_opposite_.push_back(static_cast<std::uint32_t>(opposites_.size()));
        const std::uint32_t a = std::min(edges_.vertices[2 * e], edges_.vertices[2 * e + 1]);
        const std::uint32_t b = std::max(edges_.vertices[2 * e], edges_.vertices[2 * e + 1]);
        for (auto at = std::lower_bound(list.begin(), list.end(), Side{a, b, 0}); at != list.end() && at->a == a && at->b == b; ++at)
            opposites_.push_back(at->opposite);
    }
    first_opposite_.push_back(static_cast<std::uint32_t>(opposites_.size()));
}

void Resolver::make_grid() {
    vox_grid_desc desc = vox_default_grid_desc();
    desc.flags = VOX_GRID_CONSTRAINTS | VOX_GRID_EDGES;
    desc.worker_count = desc_.worker_count;
    desc.byte_budget = UINT64_MAX;
    desc.allocator = desc_.allocator;
    grid_ = create_grid(desc);
    for (const auto& handle : bodies_) {
        SoftBody& body = *handle;
        vox_mesh_desc mesh = vox_mesh_desc_doubles(body.positions[0].data(), body.positions.size(), body.tets.data(),
                                                   body.tets.size() / 4);
        mesh.flags = VOX_MESH_BORROW_TETS;
        if (!body.tets.empty()) mesh.filter.flags = VOX_FILTER_SELF_COLLISION;
        check(vox_mesh_insert(grid_.get(), &mesh, &body.mesh));
        body.is_exact_in_grid = true;
    }
}

// ---- detection --------------------------------------------------------------------------------------

void Resolver::move_surface() {
    for (std::size_t b = 0; b < place_.size(); ++b)
        std::copy(bodies_[place_[b]]->positions.begin(), bodies_[place_[b]]->positions.end(), all_.begin() + first_[b]);
    vox_motion motion = vox_default_motion();
    motion.from = vox_double_positions(all_[0].data(), all_.size());
    check(vox_surface_move(surface_.get(), &motion));
}

std::span<const vox_crossing> Resolver::find_crossings() {
    vox_crossing_view view{};
    check(vox_surface_find_crossings(surface_.get(), &view));
    return {view.data, static_cast<std::size_t>(view.count)};
}

void Resolver::note(std::uint32_t vertex_a, std::uint32_t vertex_b, const double position[3], double distance) {
    if (report_.place_count < desc_.place_capacity)
        desc_.places[report_.place_count] = {body_of_[vertex_a], body_of_[vertex_b], distance,
                                             {position[0], position[1], position[2]}};
    ++report_.place_count;
    report_.least_distance = std::min(report_.least_distance, distance);
}

std::uint32_t Resolver::part_of(std::uint32_t v) {
    while (part_[v] != v) v = part_[v] = part_[part_[v]];
    return v;
}

// The parts of the surfaces between contours of intersection.
void Resolver::find_parts(std::span<const vox_crossing> crossings) {
    const auto all = crossings;
    std::iota(part_.begin(), part_.end(), 0u);
    for (std::uint32_t e = 0; e < edges_.count; ++e) {
        while (!crossings.empty() && crossings.front().edge < e) crossings = crossings.subspan(1);
        if (!crossings.empty() && crossings.front().edge == e) continue;
        const std::uint32_t a = part_of(edges_.vertices[2 * std::size_t{e}]), b = part_of(edges_.vertices[2 * std::size_t{e} + 1]);
        part_[std::max(a, b)] = std::min(a, b);
    }
    std::fill(part_size_.begin(), part_size_.end(), 0u);
    for (std::uint32_t v = 0; v < part_.size(); ++v) ++part_size_[part_of(v)];
    if (report_.iterations > 0) return;
    Array<bool> is_wrong(part_.size(), false, &memory_);
    for (const vox_crossing& crossing : all) {
        const std::uint32_t* edge = edges_.vertices + 2 * std::size_t{crossing.edge};
        const std::uint32_t end = wrong_end(edge[0], edge[1]);
        if (end != VOX_NONE) is_wrong[part_of(end)] = true;
    }
    for (std::uint32_t v = 0; v < part_.size(); ++v) wrong_[v] = is_wrong[part_of(v)];
}

// The end of a crossed edge that has to go back, or VOX_NONE if its surface does not tell. The first contours decide,
// as later ones may have gaps.
std::uint32_t Resolver::wrong_end(std::uint32_t p, std::uint32_t q) {
    if (wrong_[p] != wrong_[q]) return wrong_[p] ? p : q;
    const std::uint32_t of_p = part_of(p), of_q = part_of(q);
    if (of_p == of_q) return VOX_NONE;
    return std::tuple(part_size_[of_p], of_p) < std::tuple(part_size_[of_q], of_q) ? p : q;
}

void Resolver::add_crossing(const vox_crossing& crossing) {
    const std::uint32_t* edge = edges_.vertices + 2 * std::size_t{crossing.edge};
    const Corners& face = faces_[crossing.face];
    SoftBody& a = *bodies_[place_[body_of_[edge[0]]]];
    SoftBody& b = *bodies_[place_[body_of_[face[0]]]];
    if (!a.tets.empty() && !b.tets.empty()) return; // the grid knows the depth
    const Vec3 p = all_[edge[0]], q = all_[edge[1]], along = (q - p).normalized();
    const Vec3 normal = (all_[face[1]] - all_[face[0]]).cross(all_[face[2]] - all_[face[0]]).normalized();
    // If the contour cuts the surface in two, the smaller part is on the wrong side.
    const std::uint32_t wrong = wrong_end(edge[0], edge[1]);
    if (wrong != VOX_NONE) {
        const double high_p = normal.dot(p - all_[face[0]]), high_q = normal.dot(q - all_[face[0]]);
        const double high = wrong == edge[0] ? high_p : high_q;
        if (high_p * high_q < 0) {
            Contact c{};
            c.a = &a;
            c.b = &b;
            c.count_a = 1;
            c.count = 4;
            c.vertices[0] = wrong - first_[body_of_[wrong]];
            c.weights[0] = 1;
            for (std::uint32_t i = 0; i < 3; ++i) {
                c.vertices[1 + i] = face[i] - first_[body_of_[face[0]]];
                c.weights[1 + i] = -crossing.face_weights[i];
            }
            c.direction = high > 0 ? Vec3(-normal) : normal;
            finish(c, std::min(std::abs(high), step_of_edge * (q - p).norm()) + desc_.gap);
            return;
        }
    }
    const double slope = along.dot(normal);
    Vec3 shortening = Vec3::Zero();
    for (std::uint32_t i = first_opposite_[crossing.edge]; i < first_opposite_[crossing.edge + 1]; ++i) {
        const Vec3 into = all_[opposites_[i]] - p;
        Vec3 line = normal.cross(along.cross(into));
        const double length = line.norm();
        if (!(length > 0)) continue;
        line /= length;
        if (line.dot(into - into.dot(along) * along) < 0) line = -line;
        shortening += line - 2 * along.dot(line) / std::copysign(std::max(std::abs(slope), 0.1), slope) * normal;
    }
    const double length = shortening.norm();
    if (!(length > 1e-9)) return;
    Contact c{};
    c.a = &a;
    c.b = &b;
    c.count_a = 2;
    c.count = 5;
    for (std::uint32_t i = 0; i < 2; ++i) {
        c.vertices[i] = edge[i] - first_[body_of_[edge[0]]];
        c.weights[i] = crossing.edge_weights[i];
    }
    for (std::uint32_t i = 0; i < 3; ++i) {
        c.vertices[2 + i] = face[i] - first_[body_of_[face[0]]];
        c.weights[2 + i] = -crossing.face_weights[i];
    }
    c.direction = shortening / length;
    finish(c, step_of_edge * (q - p).norm() + desc_.gap);
}

void Resolver::add_close(vox_feature a, vox_feature b) {
    vox_proximity_view view{};
    check(vox_surface_find_proximities(surface_.get(), a, b, desc_.gap, &view));
    const auto corners = [&](vox_feature kind, const std::uint32_t& index) -> std::span<const std::uint32_t> {
        if (kind == VOX_FEATURE_VERTEX) return {&index, 1};
        if (kind == VOX_FEATURE_EDGE) return {edges_.vertices + 2 * std::size_t{index}, 2};
        return faces_[index];
    };
    for (const vox_proximity& near : std::span(view.data, static_cast<std::size_t>(view.count))) {
        if (near.distance >= desc_.gap) continue;
        ++report_.close_pairs;
        const auto of_a = corners(a, near.a), of_b = corners(b, near.b);
        Contact c{};
        c.a = bodies_[place_[body_of_[of_a[0]]]].get();
        c.b = bodies_[place_[body_of_[of_b[0]]]].get();
        c.count_a = static_cast<std::uint32_t>(of_a.size());
        for (std::size_t i = 0; i < of_a.size(); ++i) {
            c.vertices[c.count] = of_a[i] - first_[body_of_[of_a[0]]];
            c.weights[c.count++] = near.weights_a[i];
        }
        for (std::size_t i = 0; i < of_b.size(); ++i) {
            c.vertices[c.count] = of_b[i] - first_[body_of_[of_b[0]]];
            c.weights[c.count++] = -near.weights_b[i];
        }
        const Vec3 d = Vec3(near.point_a[0] - near.point_b[0], near.point_a[1] - near.point_b[1],
                            near.point_a[2] - near.point_b[2]);
        note(of_a[0], of_b[0], near.point_a, near.distance);
        if (!(d.norm() > 0)) continue;
        c.direction = d.normalized();
        c.depth = 1.1 * desc_.gap;
        for (std::uint32_t i = 0; i < c.count; ++i)
            c.inverse_mass += c.weights[i] * c.weights[i] * c.body(i).inverse_masses[c.vertices[i]];
        if (c.inverse_mass > 0) contacts_.push_back(c);
    }
}

// ---- movement ---------------------------------------------------------------------------------------

// Moves whole bodies, as sweeps over edges and volumes would only after many iterations: contacts by projected
// Gauss-Seidel for the six degrees of freedom of each.
void Resolver::move_rigidly() {
    struct Rigid {
        Vec3 centre = Vec3::Zero(), shift = Vec3::Zero(), turn = Vec3::Zero();
        double inverse_mass = 0;
        Eigen::Matrix3d inverse_inertia = Eigen::Matrix3d::Zero();
    };
    Array<Rigid> rigid(bodies_.size(), &memory_);
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
        const SoftBody& body = *bodies_[b];
        Rigid& r = rigid[b];
        r = Rigid{};
        if (body.fixed || !solid_[b]) continue;
        double mass = 0;
        for (std::size_t v = 0; v < body.positions.size(); ++v) {
            mass += body.masses[v];
            r.centre += body.masses[v] * body.positions[v];
        }
        r.centre /= mass;
        Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
        for (std::size_t v = 0; v < body.positions.size(); ++v) {
            const Vec3 d = body.positions[v] - r.centre;
            inertia += body.masses[v] * (d.squaredNorm() * Eigen::Matrix3d::Identity() - d * d.transpose());
        }
        r.inverse_mass = 1 / mass;
        r.inverse_inertia = inertia.inverse();
    }
    struct Row {
        std::size_t a, b;
        Vec3 normal, turn_a, turn_b; // arm x normal
        double depth, denominator, impulse;
    };
    Array<Row> rows(&memory_);
    double deepest = 0;
    for (const Contact& c : contacts_) {
        Row row{};
        row.a = c.a->slot;
        row.b = c.b->slot;
        const auto stays_or_is_solid = [&](const SoftBody& body) { return body.fixed || solid_[body.slot]; };
        if (row.a == row.b || !stays_or_is_solid(*c.a) || !stays_or_is_solid(*c.b)) continue;
        row.normal = c.direction;
        row.depth = c.depth - c.slop;
        Vec3 point = Vec3::Zero();
        for (std::uint32_t i = 0; i < c.count; ++i) {
            const Vec3& x = c.body(i).positions[c.vertices[i]];
            row.depth -= c.weights[i] * c.direction.dot(x);
            if (i < c.count_a) point += c.weights[i] * x;
        }
        row.turn_a = (point - rigid[row.a].centre).cross(row.normal);
        row.turn_b = (point - rigid[row.b].centre).cross(row.normal);
        row.denominator = rigid[row.a].inverse_mass + rigid[row.b].inverse_mass +
                          row.turn_a.dot(rigid[row.a].inverse_inertia * row.turn_a) +
                          row.turn_b.dot(rigid[row.b].inverse_inertia * row.turn_b);
        if (!(row.denominator > 0)) continue;
        deepest = std::max(deepest, row.depth);
        rows.push_back(row);
    }
    for (int sweep = 0; sweep < 10; ++sweep)
        for (Row& row : rows) {
            Rigid &a = rigid[row.a], &b = rigid[row.b];
            const double rest = row.depth - row.normal.dot(a.shift - b.shift) - row.turn_a.dot(a.turn) + row.turn_b.dot(b.turn);
            const double impulse = std::max(-row.impulse, rest / row.denominator);
            row.impulse += impulse;
            a.shift += (impulse * a.inverse_mass) * row.normal;
            b.shift -= (impulse * b.inverse_mass) * row.normal;
            a.turn += impulse * (a.inverse_inertia * row.turn_a);
            b.turn -= impulse * (b.inverse_inertia * row.turn_b);
        }
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
        const Rigid& r = rigid[b];
        const double angle = r.turn.norm();
        if (r.inverse_mass == 0 || angle + r.shift.norm() == 0) continue;
        double size = 0;
        for (const Vec3& x : bodies_[b]->positions) size = std::max(size, (x - r.centre).norm());
        const double part = std::min(1.0, deepest / (r.shift.norm() + angle * size));
        const Eigen::Matrix3d rotation =
            angle > 0 ? Eigen::AngleAxisd(part * angle, r.turn / angle).toRotationMatrix() : Eigen::Matrix3d::Identity();
        for (Vec3& x : bodies_[b]->positions) x = r.centre + part * r.shift + rotation * (x - r.centre);
    }
}

// Gives a closed surface its first volume back.
void Resolver::keep_enclosed(SoftBody& body) {
    const auto& triangles = triangles_[index_[body.slot]];
    gradients_.assign(body.positions.size(), Vec3::Zero());
    const Vec3* x = body.positions.data();
    for (std::size_t t = 0; t < triangles.size(); t += 3) {
        const Vec3 normal = (x[triangles[t + 1]] - x[triangles[t]]).cross(x[triangles[t + 2]] - x[triangles[t]]);
        for (std::size_t k = 0; k < 3; ++k) gradients_[triangles[t + k]] += normal / 6;
    }
    double answer = 0;
    for (std::size_t v = 0; v < gradients_.size(); ++v) answer += body.inverse_masses[v] * gradients_[v].squaredNorm();
    if (!(answer > 0)) return;
    const double lambda = (enclosed_[body.slot] - enclosed(body, triangles)) / answer;
    for (std::size_t v = 0; v < gradients_.size(); ++v) body.positions[v] += (lambda * body.inverse_masses[v]) * gradients_[v];
}

void Resolver::relax(int count) {
    for (const auto& body : bodies_) body->previous = body->positions;
    for (int sweep = 0; sweep < count; ++sweep) {
        for (const auto& body : bodies_) {
            solve_edges(*body);
            solve_volumes(*body);
            if (body->tets.empty() && solid_[body->slot] && !body->fixed) keep_enclosed(*body);
        }
        solve_contacts(contacts_, settings, 1);
    }
    if (desc_.max_move > 0)
        for (std::size_t b = 0; b < place_.size(); ++b)
            for (std::size_t v = 0; v < bodies_[place_[b]]->positions.size(); ++v) {
                Vec3& x = bodies_[place_[b]]->positions[v];
                const Vec3 moved = x - start_[first_[b] + v];
                const double length = moved.norm();
                if (length > desc_.max_move) x = start_[first_[b] + v] + (desc_.max_move / length) * moved;
            }
}

// The insides of closed surfaces as shapes that are where the surfaces are now.
void Resolver::update_shapes() {
    for (std::uint32_t b = 0; b < place_.size(); ++b) {
        const SoftBody& body = *bodies_[place_[b]];
        if (!body.tets.empty() || !solid_[place_[b]]) continue;
        vox_shape_desc desc = vox_default_shape_desc();
        desc.kind = VOX_SHAPE_SOLID;
        desc.positions = vox_double_positions(body.positions[0].data(), body.positions.size());
        desc.triangles = triangles_[b].data();
        desc.triangle_count = triangles_[b].size() / 3;
        vox_body& shape = shapes_[place_[b]];
        if (shape != VOX_NULL_BODY) check(vox_body_remove(grid_.get(), shape));
        shape = VOX_NULL_BODY;
        if (vox_shape_insert(grid_.get(), &desc, &shape) != VOX_OK) {
            solid_[place_[b]] = false;
            continue;
        }
        check(vox_grid_set_pair_enabled(grid_.get(), body.mesh, shape, 0));
    }
}

// Contacts with these. The closest point of the surface takes part.
void Resolver::add_shape_contacts() {
    vox_constraint_view view{};
    check(vox_grid_get_constraints(grid_.get(), &view));
    for (const vox_constraint& from : std::span(view.data, static_cast<std::size_t>(view.count))) {
        const auto shape = std::find(shapes_.begin(), shapes_.end(), from.body_b);
        SoftBody* const a = find_body(bodies_, from.body_a);
        if (shape == shapes_.end() || !a || from.element_b == VOX_NONE) continue;
        Contact c{};
        c.a = a;
        c.b = bodies_[static_cast<std::size_t>(shape - shapes_.begin())].get();
        c.count_a = from.count_a;
        std::copy_n(from.vertices, from.count_a, c.vertices);
        std::copy_n(from.weights, from.count_a, c.weights);
        c.direction = Vec3(from.normal[0], from.normal[1], from.normal[2]);
        const std::uint32_t* corners = triangles_[index_[c.b->slot]].data() + 3 * std::size_t{from.element_b};
        const Vec3 point = Vec3(from.position[0], from.position[1], from.position[2]) - from.gap * c.direction;
        const Vec3 &p = c.b->positions[corners[0]], &q = c.b->positions[corners[1]], &r = c.b->positions[corners[2]];
        const Vec3 normal = (q - p).cross(r - p);
        const double area = normal.squaredNorm();
        if (!(area > 0)) continue;
        double second = std::clamp((point - p).cross(r - p).dot(normal) / area, 0.0, 1.0);
        double third = std::clamp((q - p).cross(point - p).dot(normal) / area, 0.0, 1.0 - second);
        const double weights[3] = {1 - second - third, second, third};
        c.count = c.count_a + 3;
        for (std::uint32_t i = 0; i < 3; ++i) {
            c.vertices[c.count_a + i] = corners[i];
            c.weights[c.count_a + i] = -weights[i];
        }
        finish(c, -from.gap);
    }
}

// Completes a contact that is `depth` deep now.
void Resolver::finish(Contact& c, double depth) {
    c.depth = depth;
    for (std::uint32_t i = 0; i < c.count; ++i) {
        c.depth += c.weights[i] * c.direction.dot(c.body(i).positions[c.vertices[i]]);
        c.inverse_mass += c.weights[i] * c.weights[i] * c.body(i).inverse_masses[c.vertices[i]];
    }
    if (c.inverse_mass > 0) contacts_.push_back(c);
}

bool Resolver::push_out() {
    update_shapes();
    check(vox_grid_step(grid_.get()));
    gather_contacts(grid_.get(), bodies_, settings, contacts_);
    add_shape_contacts();
    double& deepest = deepest_ = 0;
    report_.inside = contacts_.size();
    // A body that did not overlap itself at first was folded by its neighbours, and its shape undoes that.
    if (report_.iterations == 0)
        for (const Contact& c : contacts_) overlaps_itself_[c.a->slot] |= c.a == c.b;
    erase_if(contacts_, [&](const Contact& c) { return c.a == c.b && !overlaps_itself_[c.a->slot]; });
    for (Contact& c : contacts_) {
        double depth = c.depth;
        for (std::uint32_t i = 0; i < c.count; ++i) depth -= c.weights[i] * c.direction.dot(c.body(i).positions[c.vertices[i]]);
        deepest = std::max(deepest, depth);
        c.slop = -1.5 * desc_.gap;
    }
    move_surface();
    const auto crossings = find_crossings();
    report_.crossings = crossings.size();
    report_.place_count = 0;
    if (report_.iterations == 0) {
        report_.crossings_before = crossings.size();
        report_.deepest_before = deepest;
    }
    if (!crossings.empty()) find_parts(crossings);
    for (const vox_crossing& crossing : crossings) {
        if (report_.iterations == 0 && body_of_[edges_.vertices[2 * std::size_t{crossing.edge}]] == body_of_[faces_[crossing.face][0]])
            overlaps_itself_[place_[body_of_[faces_[crossing.face][0]]]] = true;
        note(edges_.vertices[2 * std::size_t{crossing.edge}], faces_[crossing.face][0], crossing.position, 0);
        add_crossing(crossing);
    }
    return report_.inside + report_.crossings > 0;
}

bool Resolver::push_apart() {
    move_surface();
    contacts_.clear();
    report_.close_pairs = report_.place_count = 0;
    report_.least_distance = desc_.gap;
    add_close(VOX_FEATURE_FACE, VOX_FEATURE_VERTEX);
    add_close(VOX_FEATURE_EDGE, VOX_FEATURE_EDGE);
    if (report_.close_pairs == 0) return false;
    check(vox_surface_find_clearances(surface_.get(), 2 * desc_.gap, clear_.data()));
    relax(sweeps);
    for (std::size_t b = 0; b < place_.size(); ++b)
        for (std::size_t v = 0; v < bodies_[place_[b]]->positions.size(); ++v) {
            Vec3& x = bodies_[place_[b]]->positions[v];
            const Vec3& from = all_[first_[b] + v];
            const Vec3 moved = x - from;
            const double length = moved.norm(), most = 0.99 * clear_[first_[b] + v];
            if (length > most) x = from + (most / length) * moved;
        }
    return true;
}

void Resolver::run() {
    if (all_.empty()) return;
    // As long as moving whole bodies helps, they keep their shapes.
    double best = std::numeric_limits<double>::infinity();
    bool rigid = true;
    while (push_out() && report_.iterations < desc_.max_iterations) {
        rigid = rigid && deepest_ > 0 && deepest_ < 0.95 * best;
        best = std::min(best, deepest_);
        move_rigidly();
        ++report_.iterations;
        if (rigid) continue;
        for (Contact& c : contacts_) {
            double depth = c.depth;
            for (std::uint32_t i = 0; i < c.count; ++i) depth -= c.weights[i] * c.direction.dot(c.body(i).positions[c.vertices[i]]);
            c.slop = std::max(c.slop, depth - 0.25 * std::min(c.a->mean_edge, c.b->mean_edge));
        }
        relax(sweeps);
        // Cloth keeps its new folds, and so does what passed through itself.
        for (std::size_t b = 0; b < bodies_.size(); ++b)
            if (bodies_[b]->tets.empty() && (!solid_[b] || overlaps_itself_[b])) rest_as_it_is(*bodies_[b], first_bend_[b]);
    }
    if (report_.crossings > 0 || !(desc_.gap > 0)) return;
    for (const auto& body : bodies_) rest_as_it_is(*body);
    for (std::uint32_t i = 0; i < desc_.max_iterations && push_apart(); ++i) ++report_.iterations;
}

void Resolver::write(std::span<vox_resolve_body> bodies, vox_resolve_report& report) {
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        vox_resolve_body& out = bodies[b];
        const SoftBody& body = *bodies_[place_[b]];
        out.moved_vertices = 0;
        out.largest_move = 0;
        for (std::size_t v = 0; v < body.positions.size(); ++v) {
            const double moved = (body.positions[v] - start_[first_[b] + v]).norm();
            out.moved_vertices += moved > 0;
            out.largest_move = std::max(out.largest_move, moved);
            for (int axis = 0; axis < 3; ++axis) out.positions[3 * v + static_cast<std::size_t>(axis)] = body.positions[v][axis];
        }
        report_.largest_move = std::max(report_.largest_move, out.largest_move);
    }
    report_.resolved = report_.crossings + report_.inside + report_.close_pairs == 0;
    report = report_;
}

} // namespace vox::sim
