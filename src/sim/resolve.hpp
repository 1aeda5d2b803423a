// Moves overlapping bodies and surfaces apart, with the constraints of the simulation and no time.
//
// First, what overlaps is pushed out. Tetrahedra have depths, which the grid finds. Surfaces have crossings only; each
// is pushed the way that shortens the contour of the intersection (Volino, Magnenat-Thalmann: "Resolving Surface
// Collisions through Intersection Contour Minimization", 2006). Then features that are closer than the gap are pushed
// apart, and no vertex moves further than is free (Chen et al.: "Offset Geometric Contact", 2025).
#pragma once

#include "base/array.hpp"
#include "base/caller_memory.hpp"
#include "base/library.hpp"
#include "sim/body.hpp"
#include "sim/contacts.hpp"

#include <vox/vox_surface.h>

#include <array>
#include <memory>
#include <span>

namespace vox::sim {

struct SurfaceDeleter {
    void operator()(vox_surface* surface) const noexcept { vox_surface_destroy(surface); }
};

class Resolver {
public:
    // Copies the bodies. Throws for bad input.
    Resolver(const vox_resolve_desc& desc, std::span<const vox_resolve_body> bodies);

    void run();
    // Writes positions and results, which cannot fail.
    void write(std::span<vox_resolve_body> bodies, vox_resolve_report& report);

private:
    using Corners = std::array<std::uint32_t, 3>;

    BodyHandle make(const vox_resolve_body& body, std::uint32_t index);
    void make_surface(std::span<const vox_resolve_body> bodies);
    void make_grid();

    void move_surface();
    std::span<const vox_crossing> find_crossings();
    bool push_out();   // returns whether something overlaps
    bool push_apart(); // returns whether something is closer than the gap
    void add_crossing(const vox_crossing& crossing);
    void add_close(vox_feature a, vox_feature b);
    void note(std::uint32_t vertex_a, std::uint32_t vertex_b, const double position[3], double distance);
    std::uint32_t part_of(std::uint32_t vertex);
    std::uint32_t wrong_end(std::uint32_t p, std::uint32_t q);
    void find_parts(std::span<const vox_crossing> crossings);
    void keep_enclosed(SoftBody& body);
    void update_shapes();
    void add_shape_contacts();
    void finish(Contact& contact, double depth);
    void move_rigidly();
    void relax(int sweeps);

    CallerMemory memory_;
    vox_resolve_desc desc_;
    Array<BodyHandle> bodies_;        // surfaces first, as the grid's bodies ascend in id
    Array<bool> solid_;               // moves as a whole, too
    Array<std::size_t> first_bend_;   // edge constraint of a surface that resists bending
    Array<vox_body> shapes_;          // the inside of a closed surface, in the grid
    Array<bool> overlaps_itself_;     // at first
    Array<std::uint32_t> place_;      // in bodies_, of each of the caller's bodies
    Array<std::uint32_t> index_;      // the caller's, of each of bodies_
    Array<Array<std::uint32_t>> triangles_; // of the caller's bodies without tetrahedra, outward if they are closed
    Array<Vec3> gradients_;
    Array<double> enclosed_;          // volume of each of bodies_ without tetrahedra
    Array<std::uint32_t> part_;       // another vertex of the same part of a surface, or itself
    Array<bool> wrong_;               // vertices on the wrong side of a first contour
    Array<std::uint32_t> part_size_;  // in vertices
    double deepest_ = 0;
    Array<std::uint32_t> first_;      // vertex of each of the caller's bodies in the surface, and the end
    Array<std::uint32_t> body_of_;    // the caller's body of each vertex of the surface
    Array<Vec3> all_;                 // positions of the surface
    Array<Vec3> start_;
    Array<double> clear_;             // how far a vertex may move
    Array<Corners> faces_;
    Array<std::uint32_t> opposites_;  // per edge: offset into these, corners of its faces that are not on it
    Array<std::uint32_t> first_opposite_;
    vox_feature_view edges_{};
    std::unique_ptr<vox_surface, SurfaceDeleter> surface_;
    GridHandle grid_;
    Array<Contact> contacts_;
    vox_resolve_report report_{};
};

} // namespace vox::sim
