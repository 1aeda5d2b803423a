// Moves overlapping bodies and surfaces apart, with the constraints of the simulation but without time.
//
// First, what overlaps is pushed out. Tetrahedra and the insides of closed surfaces have depths, which the
// grid finds, and are moved as a whole as long as that helps. Other surfaces have crossings only. If a
// contour of intersection cuts a surface in two, the smaller part is on the wrong side, as in Baraff, Witkin,
// Kass: "Untangling Cloth" (2003). Otherwise an edge goes where the contour becomes shorter: Volino,
// Magnenat-Thalmann: "Resolving Surface Collisions through Intersection Contour Minimization" (2006). Then
// features that are closer than the gap are pushed apart, and no vertex moves further than is free
// (vox_surface_find_clearances).
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
    // Checks and copies the bodies. Throws for bad input.
    Resolver(const vox_resolve_desc& desc, std::span<const vox_resolve_body> bodies);

    void run();
    // Writes positions and results, which cannot fail.
    void write(std::span<vox_resolve_body> bodies, vox_resolve_report& report);

private:
    using Corners = std::array<std::uint32_t, 3>;

    // What is known about a body besides its constraints.
    struct Member {
        std::uint32_t index;      // of the caller's body
        std::uint32_t first;      // vertex in the surface
        bool solid;               // with tetrahedra or closed: it also moves as a whole
        bool overlaps_itself;     // at first
        vox_body shape;           // the inside of a closed surface, in the grid
        std::size_t first_bend;   // edge constraint of a surface that resists bending
        double volume;            // inside a closed surface, at first
        Array<Corners> triangles; // of a surface; outward if it is closed
    };

    void read(const vox_resolve_body& body, std::uint32_t index);
    void make_surface();
    void find_opposites();
    BodyHandle make_solid(const vox_resolve_body& body);
    BodyHandle make_shell(const vox_resolve_body& body, Member& member);
    void insert(SoftBody& body);

    SoftBody& body_at(std::uint32_t surface_vertex) const { return *bodies_[body_of_[surface_vertex]]; }
    const Member& member_of(const SoftBody& body) const { return members_[body.slot]; }
    void move_surface();
    void update_shapes();
    bool find_overlaps();
    void add_shape_contacts();
    void find_parts(std::span<const vox_crossing> crossings);
    std::uint32_t part_of(std::uint32_t vertex);
    std::uint32_t wrong_end(std::uint32_t p, std::uint32_t q);
    void add_crossing(const vox_crossing& crossing);
    bool find_close();
    void add_close(vox_feature a, vox_feature b);
    void add_vertices(Contact& contact, std::span<const std::uint32_t> vertices, const double* weights,
                      double sign) const;
    void add(Contact& contact, double depth);
    void note(std::uint32_t vertex_a, std::uint32_t vertex_b, const double position[3], double distance);

    void push_out();
    void push_apart();
    void move_as_a_whole();
    void relax();
    void keep_near(const Array<Vec3>& from, const Array<double>* limits);
    void keep_volume(SoftBody& body);

    CallerMemory memory_; // first: the other members are released to it
    vox_resolve_desc desc_;
    Array<BodyHandle>
        bodies_;            // surfaces first, as they ascend in id, and surfaces without tetrahedra have none
    Array<Member> members_; // one for each of bodies_; SoftBody::slot is the index of both
    GridHandle grid_;
    Array<Contact> contacts_;

    // All boundaries as one surface.
    std::unique_ptr<vox_surface, SurfaceDeleter> surface_;
    Array<Vec3> all_;
    Array<Vec3> start_;
    Array<std::uint32_t> body_of_; // index into bodies_, of each vertex
    Array<Corners> faces_;
    vox_feature_view edges_{};
    Array<std::uint32_t> first_opposite_; // of each edge, and the end
    Array<std::uint32_t> opposites_;      // corners of the faces at an edge that are not on it
    Array<std::uint32_t> part_;           // another vertex of the same part of a surface, or itself
    Array<std::uint32_t> part_size_;      // in vertices
    Array<bool> wrong_;                   // vertices on the wrong side of a first contour
    Array<double> clearances_;
    Array<Vec3> gradients_;

    double deepest_ = 0;
    vox_resolve_report report_{};
};

// How deep a contact is now, beyond what it tolerates.
double depth_of(const Contact& contact);

// The volume inside closed triangles, positive if they wind counter-clockwise as seen from outside.
double volume_inside(const Vec3* positions, std::span<const std::array<std::uint32_t, 3>> triangles);

} // namespace vox::sim
