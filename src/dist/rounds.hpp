// The rounds that a step and a search for points have in common: finer boxes to neighbours, vertices to the
// ranks that may have tetrahedra around them, a step of the grid there, and the hits back.
#pragma once

#include "dist/scene.hpp"

namespace vox::dist {

// Vertices to be searched for: those that a part owns, or points, which have no part.
struct Source {
    const Part* part;
    const Clusters* clusters;
    Positions positions;
    Box box;
};

// A part of a neighbour's with tetrahedra near here.
struct Remote {
    std::uint64_t body;
    Filter filter;
    std::uint32_t part; // its number there
};

// A vertex that another rank sent.
struct Stranger {
    std::uint64_t id;
    std::uint32_t group; // in Rounds::groups
    std::uint32_t place; // among those that the rank sent
};

// A vertex that another rank sent, and of which a copy is here.
struct Known {
    const Part* part;
    std::uint32_t vertex;
    std::uint32_t neighbour;
    std::uint32_t place;
};

// Vertices of one body that a neighbour sent.
struct Group {
    std::uint64_t body;
    Filter filter;
    std::uint32_t neighbour;
};

// A hit here, of a vertex of a neighbour's.
struct Outgoing {
    vox_dist_contact contact; // as the side of the tetrahedron sees it
    std::uint32_t neighbour;
    std::uint32_t place;
    std::uint32_t part; // in vox_dist_scene::parts_
};

// A hit of a vertex of this rank, here or at a neighbour's.
struct Found {
    vox_dist_contact contact; // as the side of the vertex sees it
    std::uint32_t neighbour;  // none: here
    std::uint32_t hit;        // its place among the neighbour's hits; here: the index of the tetrahedron
};
constexpr std::uint32_t no_neighbour = UINT32_MAX;

class Rounds {
public:
    // `points`: each vertex collides with all bodies.
    Rounds(vox_dist_scene& scene, Side& side, bool points);

    void run(std::span<const Source> sources, Failure& failure);

    Array<Outgoing> outgoing; // of a neighbour after those of the one before
    Array<Found> found;

private:
    void write_boxes();
    void read_boxes();
    void find_split_bodies();
    void choose_vertices(std::span<const Source> sources);
    void tell_split_bodies(std::uint32_t neighbour);
    void send_vertices_to(std::uint32_t neighbour, std::span<const Source> sources);
    void take_vertices();
    void take_points_of_this_rank(std::span<const Source> sources);
    void step_grid();
    void collect_here();
    void collect(const Part& part, const vox_contact& hit, bool interior);
    void collect_stranger(const Part& part, const vox_contact& hit, bool interior);
    void write_hits();
    void read_hits(std::span<const Source> sources);
    void send_nothing() noexcept;

    struct Sent {
        std::uint32_t source, vertex;
    };

    vox_dist_scene& scene_;
    Side& side_;
    const bool points_;
    Memory* memory_;
    Array<Writer> writers_;             // one a neighbour
    Array<Remote> remote_;              // of each neighbour after those of the one before
    Array<std::uint64_t> remote_begin_; // of each neighbour
    Array<Box> boxes_;
    Array<std::uint64_t> boxes_begin_; // of each remote part
    Array<std::uint64_t> split_;       // bodies with tetrahedra on more than one rank, as far as seen here
    Array<std::uint32_t> told_split_;  // parts of this rank that a neighbour says are of such bodies
    Array<std::uint64_t> told_split_begin_; // of each neighbour
    Array<Sent> sent_;
    Array<std::uint64_t> sent_begin_; // of each neighbour
    Array<Group> groups_;
    Array<Stranger> strangers_;
    Array<double> xyz_;
    Array<Known> known_;
};

} // namespace vox::dist
