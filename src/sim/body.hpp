// A deformable body: the plain arrays of particles and constraints that the stages of a substep work on.
#pragma once

#include "base/array.hpp"
#include "base/eigen.hpp"

#include <vox/vox_sim.h>

#include <cstdint>
#include <memory>
#include <memory_resource>
#include <string>

namespace vox::sim {

using Vec3 = Eigen::Vector3d;

// Keeps its two particles at a distance.
struct EdgeConstraint {
    std::uint32_t a, b;
    double rest_length;
    double compliance; // to a change of length
    double softness;   // compliance / substep^2, raised to what the substep can handle (see set_substep)
};

// Keeps the signed volume of its four particles. The "six-fold volume" is the determinant of the three edges
// from corner 0.
struct VolumeConstraint {
    std::uint32_t corners[4];
    double rest_volume6;
    double compliance; // to a change of the six-fold volume
    double softness;
    double rest_answer; // sum at rest of the squares of the constraint's gradients divided by the masses
};

struct SoftBody {
    explicit SoftBody(std::pmr::memory_resource* memory)
        : positions(memory), previous(memory), velocities(memory), masses(memory), inverse_masses(memory),
          grid_positions(memory), tets(memory), edges(memory), volumes(memory) {}

    vox_body mesh = VOX_NULL_BODY;
    std::uint32_t slot = 0;
    std::uint64_t user_data = 0;
    bool fixed = false;

    // particles
    Array<Vec3> positions;
    Array<Vec3> previous; // positions at the beginning of the substep
    Array<Vec3> velocities;
    Array<double> masses;
    Array<double> inverse_masses;  // all 0 for a fixed body
    Array<float> grid_positions;   // 3 a particle; the grid borrows them, or `positions`
    double most_rounded = 0;       // a coordinate of these
    bool is_exact_in_grid = false; // it borrows `positions`

    // constraints
    Array<std::uint32_t> tets; // 4 a tet
    Array<EdgeConstraint> edges;
    Array<VolumeConstraint> volumes;
    double damping = 0;
    double substep = 0;         // length of the substep that the constraints are set up for; 0: not yet
    std::uint64_t softened = 0; // constraints whose stiffness that substep cannot handle

    double mean_edge = 0;
    std::uint64_t flat_tets = 0;
    std::uint64_t inverted_tets = 0;
    std::uint64_t raised_masses = 0;
};

struct DestroyBody {
    void operator()(SoftBody* body) const noexcept;
};
using BodyHandle = std::unique_ptr<SoftBody, DestroyBody>; // allocated where its arrays are

inline vox_body mesh_of(const BodyHandle& body) noexcept { return body->mesh; }

// Checks the caller's arrays and numbers (throws) and computes masses and constraints from them.
BodyHandle make_body(const vox_sim_body_desc& desc, std::pmr::memory_resource* memory);

// The name of the body in messages.
std::string name_of(const SoftBody& body);

// Replaces positions and velocities (3 a particle; null: keeps them). Changes nothing if it throws.
void set_state(SoftBody& body, const double* positions, const double* velocities);

// Rounds the positions for the grid.
void write_grid_positions(SoftBody& body);
// Whether it is so far from the origin that their rounding would move the body.
bool is_far_away(const SoftBody& body) noexcept;

// Determinant of the edges from corner 0: six times the signed volume.
double volume6(const Vec3& p0, const Vec3& p1, const Vec3& p2, const Vec3& p3);

} // namespace vox::sim
