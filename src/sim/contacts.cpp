#include "sim/contacts.hpp"

#include "base/array.hpp"
#include "base/error.hpp"
#include "base/library.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace vox::sim {

namespace {

// The point of a relative to the point of b.
Vec3 relative(const Contact& c, const Array<Vec3> SoftBody::*positions) {
    Vec3 r = Vec3::Zero();
    for (std::uint32_t i = 0; i < c.count; ++i) r += c.weights[i] * (c.body(i).*positions)[c.vertices[i]];
    return r;
}

// Moves each vertex by its part of `impulse`, over its mass.
void apply(const Contact& c, Array<Vec3> SoftBody::*positions, const Vec3& impulse) {
    for (std::uint32_t i = 0; i < c.count; ++i)
        (c.body(i).*positions)[c.vertices[i]] +=
            (c.weights[i] * c.body(i).inverse_masses[c.vertices[i]]) * impulse;
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

// Throws INVALID_STATE if a constraint does not fit the bodies: it names a vertex that the body does not
// have, or its gap differs. The caller may have cut a body, or bound other positions to it, through
// vox_sim_get_grid.
void check_contact(const SoftBody& a, const SoftBody* b, const vox_constraint& c) {
    const auto changed = [&](const std::string& what) {
        const std::string names = name_of(a) + (b ? " or " + name_of(*b) : "");
        throw Error(VOX_ERROR_INVALID_STATE,
                    format("%s was changed through vox_sim_get_grid: %s", names.c_str(), what.c_str()));
    };
    double gap = c.offset, size = 0, reach = 0;
    for (std::uint32_t i = 0; i < c.count; ++i) {
        const SoftBody& body = i < c.count_a ? a : *b;
        if (c.vertices[i] >= body.positions.size())
            changed(format("a constraint names vertex %u of %zu", c.vertices[i], body.positions.size()));
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::size_t v = c.vertices[i];
            const double x = body.is_exact_in_grid ? body.positions[v][static_cast<Eigen::Index>(axis)]
                                                   : double{body.grid_positions[3 * v + axis]};
            gap += c.weights[i] * c.normal[axis] * x;
            size = std::max(size, std::abs(x - c.position[axis]));
            reach = std::max(reach, std::abs(x));
        }
    }
    if (!(std::abs(gap - c.gap) <= size / 1000 + 1e-9 * reach))
        changed(format("the gap at vertex %u is %g instead of %g", c.vertices[0], gap, c.gap));
}

} // namespace

SoftBody* find_body(std::span<const BodyHandle> bodies, vox_body mesh) {
    const auto found = std::ranges::lower_bound(bodies, mesh, {}, mesh_of);
    return found != bodies.end() && (*found)->mesh == mesh ? found->get() : nullptr;
}

void gather_contacts(const vox_grid* grid, std::span<const BodyHandle> bodies, const Shapes* shapes,
                     const ContactSettings& settings, Array<Contact>& contacts) {
    vox_constraint_view found{};
    contacts.clear();
    check(vox_grid_get_constraints(grid, &found));
    for (const vox_constraint& from : std::span(found.data, found.count)) {
        Contact c{};
        c.a = find_body(bodies, from.body_a);
        c.b = find_body(bodies, from.body_b);
        const bool with_shape = from.count == from.count_a;
        if (!c.a || !(c.b || (with_shape && shapes))) continue;
        check_contact(*c.a, c.b, from);
        c.count_a = from.count_a;
        c.count = from.count;
        std::copy_n(from.vertices, from.count, c.vertices);
        std::copy_n(from.weights, from.count, c.weights);
        c.depth = -from.offset;
        c.direction = Vec3(from.normal[0], from.normal[1], from.normal[2]);
        c.motion = with_shape ? shapes->motion(from.body_b, Vec3(from.position)) : Vec3::Zero();
        c.slop = settings.slop >= 0 ? settings.slop : (c.a->mean_edge + (c.b ? c.b : c.a)->mean_edge) / 200;
        for (std::uint32_t i = 0; i < c.count; ++i)
            c.inverse_mass += c.weights[i] * c.weights[i] * c.body(i).inverse_masses[c.vertices[i]];
        if (c.inverse_mass > 0) contacts.push_back(c);
    }
}

void solve_contacts(std::span<const Contact> contacts, std::uint32_t age, const ContactSettings& settings,
                    double h) {
    for (const Contact& c : contacts) {
        const Vec3 before = relative(c, &SoftBody::previous) - age * c.motion, gone = (age + 1) * c.motion;
        const double depth_before = c.depth - c.direction.dot(before);
        const double depth = c.depth - c.direction.dot(relative(c, &SoftBody::positions) - gone);
        const Answer answer = answer_depth(depth, depth_before, c.slop, c.inverse_mass, settings, h);
        if (answer.whole == 0) continue;
        apply(c, &SoftBody::positions, answer.whole * c.direction);
        apply(c, &SoftBody::previous, answer.push * c.direction);
        const Vec3 moved = relative(c, &SoftBody::positions) - gone - before;
        apply(c, &SoftBody::positions,
              friction_impulse(moved, c.direction, answer.whole - answer.push, c.inverse_mass,
                               settings.friction));
    }
}

std::uint64_t solve_floor(SoftBody& body, const Floor& floor, const ContactSettings& settings, double h) {
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
