// What bodies do to each other and to the floor in a substep: penalty response and friction.
//
// A vertex that the depth stage found inside another body (Heidelberger et al. 2004) is pushed along the
// stage's direction with a force linear in its depth, the tetrahedron that holds it with the opposite one,
// spread by the vertex's barycentric weights. The force is integrated implicitly, as an XPBD constraint on
// the depth (Macklin et al. 2016), so that its stiffness may be anything. Two rules keep contacts calm, both
// in the manner of Box2D 3: what was penetrated before the substep is undone at a bounded speed and adds
// nothing to the velocities; a small depth, the slop, is left alone, so that a resting contact is found again
// in every substep. Friction holds the relative tangential motion of the substep, up to Coulomb's bound.
#pragma once

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
    double weights[4]; // of the corners, where the vertex was when it was found
    Vec3 direction;    // out of b
    double depth;      // when it was found
    double slop;
    double inverse_mass; // of vertex and tet against each other
};

struct ContactSettings {
    double friction;
    double compliance;
    double push_speed;
    double slop; // negative: a hundredth of the mean edge of the two bodies
};

// A half-space: floor where normal . x < offset. A zero normal is no floor.
struct Floor {
    Vec3 normal;
    double offset;
};

// The body of a mesh, null when there is none. `bodies` ascend in mesh.
Body* find_body(std::span<const std::unique_ptr<Body>> bodies, vox_mesh mesh);

// Contacts of the grid's last step. Meshes that are not in `bodies` and pairs of fixed bodies are left out.
void gather_contacts(const vox_grid* grid, std::span<const std::unique_ptr<Body>> bodies,
                     const ContactSettings& settings, std::vector<Contact>& contacts);

void solve_contacts(std::span<const Contact> contacts, const ContactSettings& settings, double h);

// Returns how many particles the floor held.
std::uint64_t solve_floor(Body& body, const Floor& floor, const ContactSettings& settings, double h);

} // namespace vox::sim
