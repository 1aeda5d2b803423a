#include "sim/contacts.hpp"

#include "base/array.hpp"
#include "base/error.hpp"
#include "sim/library.hpp"

#include <algorithm>
#include <cmath>

namespace vox::sim {

namespace {

template <class T>
const T& element(const T* data, std::size_t byte_stride, std::uint64_t i) {
    return *reinterpret_cast<const T*>(reinterpret_cast<const std::byte*>(data) + i * byte_stride);
}

// The position of the vertex relative to the point of the tet at which it was found.
Vec3 relative(const Contact& c, const Array<Vec3> Body::*positions) {
    Vec3 r = (c.a->*positions)[c.vertex];
    for (int k = 0; k < 4; ++k) r -= c.weights[k] * (c.b->*positions)[c.corners[k]];
    return r;
}

// Moves the vertex by `impulse` / its mass, and the tet's corners in the opposite direction.
void apply(const Contact& c, Array<Vec3> Body::*positions, const Vec3& impulse) {
    (c.a->*positions)[c.vertex] += c.a->inverse_masses[c.vertex] * impulse;
    for (int k = 0; k < 4; ++k)
        (c.b->*positions)[c.corners[k]] -= (c.weights[k] * c.b->inverse_masses[c.corners[k]]) * impulse;
}

// The impulse against a penetration. Its part `push` undoes earlier penetration; the rest stops the motion.
struct Answer {
    double whole = 0;
    double push = 0;
};

Answer answer_depth(double depth, double depth_before, double slop, double inverse_mass,
                    const ContactSettings& settings, double h) {
    const double allowed = std::max(slop, depth_before - settings.push_speed * h);
    const double rigid = (depth - allowed) / inverse_mass;
    const double soft = (depth - slop) / (inverse_mass + settings.compliance / (h * h));
    const double whole = std::min(rigid, soft);
    if (!(whole > 0)) return {};
    return {whole, std::clamp((depth_before - allowed) / inverse_mass, 0.0, whole)};
}

// The impulse that undoes the tangential part of `moved`, up to the bound of Coulomb's law for
// `normal_impulse`.
Vec3 friction_impulse(const Vec3& moved, const Vec3& normal, double normal_impulse, double inverse_mass,
                      double friction) {
    const Vec3 slipped = moved - moved.dot(normal) * normal;
    const double length = slipped.norm(), bound = friction * normal_impulse;
    if (length <= bound * inverse_mass) return -slipped / inverse_mass;
    return (-bound / length) * slipped;
}

// The caller may have cut a body, or bound other positions to it, through vox_sim_get_grid. Its contacts are
// not those of the particles that move here then. Throws INVALID_STATE where that shows: a contact names a
// vertex or tet that the body does not have, or the weights do not give the vertex. (They are within 2^-20,
// see vox_contact.)
void check_contact(const Body& a, std::uint32_t vertex, const Body& b, std::uint32_t tet,
                   const float weights[4]) {
    const std::size_t vertices = a.positions.size(), tets = b.tets.size() / 4;
    const auto changed = [&](const std::string& what) {
        throw Error(VOX_ERROR_INVALID_STATE, format("%s or %s was changed through vox_sim_get_grid: %s",
                                                    name_of(a).c_str(), name_of(b).c_str(), what.c_str()));
    };
    if (vertex >= vertices || tet >= tets)
        changed(
            format("a contact names vertex %u (of %zu) and tet %u (of %zu)", vertex, vertices, tet, tets));
    double size = 0, miss = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        double sum = 0;
        for (std::size_t k = 0; k < 4; ++k) {
            const double side =
                static_cast<double>(b.grid_positions[3 * b.tets[4 * std::size_t{tet} + k] + axis]) -
                static_cast<double>(a.grid_positions[3 * std::size_t{vertex} + axis]);
            sum += static_cast<double>(weights[k]) * side;
            size = std::max(size, std::abs(side));
        }
        miss = std::max(miss, std::abs(sum));
    }
    if (!(miss <= size / 1000)) changed(format("vertex %u is %g off its place in tet %u", vertex, miss, tet));
}

} // namespace

Body* find_body(std::span<const BodyHandle> bodies, vox_body mesh) {
    const auto found = std::lower_bound(bodies.begin(), bodies.end(), mesh,
                                        [](const auto& body, vox_body id) { return body->mesh < id; });
    return found != bodies.end() && (*found)->mesh == mesh ? found->get() : nullptr;
}

void gather_contacts(const vox_grid* grid, std::span<const BodyHandle> bodies,
                     const ContactSettings& settings, Array<Contact>& contacts) {
    vox_contact_view found{};
    vox_penetration_view penetrations{};
    contacts.clear();
    check(vox_grid_get_contacts(grid, &found));
    check(vox_grid_penetrations(grid, &penetrations));
    for (std::uint64_t i = 0; i < penetrations.count; ++i) {
        const vox_penetration& p = element(penetrations.data, penetrations.byte_stride, i);
        const vox_contact& in_tet = element(found.data, found.byte_stride, p.contact);
        Contact c{};
        c.a = find_body(bodies, p.body_a);
        c.b = find_body(bodies, p.body_b);
        if (!c.a || !c.b || (c.a->fixed && c.b->fixed)) continue;
        check_contact(*c.a, p.vertex, *c.b, in_tet.tet, in_tet.barycentric);
        c.vertex = p.vertex;
        c.depth = static_cast<double>(p.depth);
        c.direction = Vec3(static_cast<double>(p.direction[0]), static_cast<double>(p.direction[1]),
                           static_cast<double>(p.direction[2]));
        c.slop = settings.slop >= 0 ? settings.slop : (c.a->mean_edge + c.b->mean_edge) / 200;
        c.inverse_mass = c.a->inverse_masses[c.vertex];
        for (std::size_t k = 0; k < 4; ++k) {
            c.corners[k] = c.b->tets[4 * std::size_t{in_tet.tet} + k];
            c.weights[k] = static_cast<double>(in_tet.barycentric[k]);
            c.inverse_mass += c.weights[k] * c.weights[k] * c.b->inverse_masses[c.corners[k]];
        }
        if (c.inverse_mass > 0) contacts.push_back(c);
    }
}

void solve_contacts(std::span<const Contact> contacts, const ContactSettings& settings, double h) {
    for (const Contact& c : contacts) {
        const Vec3 before = relative(c, &Body::previous);
        const double depth_before = c.depth - c.direction.dot(before);
        const double depth = c.depth - c.direction.dot(relative(c, &Body::positions));
        const Answer answer = answer_depth(depth, depth_before, c.slop, c.inverse_mass, settings, h);
        if (answer.whole == 0) continue;
        apply(c, &Body::positions, answer.whole * c.direction);
        apply(c, &Body::previous, answer.push * c.direction);
        const Vec3 moved = relative(c, &Body::positions) - before;
        apply(c, &Body::positions,
              friction_impulse(moved, c.direction, answer.whole - answer.push, c.inverse_mass,
                               settings.friction));
    }
}

std::uint64_t solve_floor(Body& body, const Floor& floor, const ContactSettings& settings, double h) {
    if (body.fixed || floor.normal.isZero(0)) return 0;
    std::uint64_t held = 0;
    for (std::size_t v = 0; v < body.positions.size(); ++v) {
        Vec3& x = body.positions[v];
        const double depth = floor.offset - floor.normal.dot(x);
        if (depth <= 0) continue;
        const double w = body.inverse_masses[v];
        const Answer answer =
            answer_depth(depth, floor.offset - floor.normal.dot(body.previous[v]), 0, w, settings, h);
        if (answer.whole == 0) continue;
        ++held;
        const Vec3 before = body.previous[v];
        x += (w * answer.whole) * floor.normal;
        body.previous[v] += (w * answer.push) * floor.normal;
        x += w * friction_impulse(x - before, floor.normal, answer.whole - answer.push, w, settings.friction);
    }
    return held;
}

} // namespace vox::sim
