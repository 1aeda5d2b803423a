// The response to contacts between bodies and with the floor in a substep: penalty forces and friction.
//
// A vertex that the depth stage found inside another body (Heidelberger et al. 2004) is pushed along the
// stage's direction with a force linear in its depth. The tetrahedron that contains it is pushed with the
// opposite force, distributed by the vertex's barycentric weights. The force is integrated implicitly, as an
// XPBD constraint on the depth (Macklin et al. 2016), so that any stiffness is stable. Two rules, both as in
// Box2D 3, keep contacts calm. Penetration from before the substep is undone at a bounded speed, which does
// not add to the velocities. A small depth, the slop, is tolerated, so that a resting contact is found again
// in every substep. Friction opposes the relative tangential motion of the substep, up to Coulomb's bound.
#pragma once

#include "base/array.hpp"
#include "sim/body.hpp"

#include <memory>
#include <span>

namespace vox::sim {

// Vertex of body a in a tet of body b; a = b for self-contact.
struct Contact {
    Body* a;
    Body* b;
    std::uint32_t vertex;
    std::uint32_t corners[4];
    double weights[4]; // barycentric weights of the vertex when it was found
    Vec3 direction;    // out of b
    double depth;      // depth when it was found
    double slop;
    double inverse_mass; // of the relative motion of vertex and tet
};

struct ContactSettings {
    double friction;
    double compliance;
    double push_speed;
    double slop; // negative: a hundredth of the mean edge of the two bodies
};

// The floor fills the half-space normal . x < offset. There is none if normal is zero.
struct Floor {
    Vec3 normal;
    double offset;
};

// The body of a mesh, or null if there is none. `bodies` must ascend in mesh.
Body* find_body(std::span<const BodyHandle> bodies, vox_body mesh);

// Reads the contacts of the grid's last step, except those of meshes not in `bodies` and of pairs of fixed
// bodies.
void gather_contacts(const vox_grid* grid, std::span<const BodyHandle> bodies,
                     const ContactSettings& settings, Array<Contact>& contacts);

void solve_contacts(std::span<const Contact> contacts, const ContactSettings& settings, double h);

// Returns how many particles the floor held.
std::uint64_t solve_floor(Body& body, const Floor& floor, const ContactSettings& settings, double h);

} // namespace vox::sim
