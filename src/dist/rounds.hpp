// The rounds that a step and a search for points share: finer boxes go to neighbours, vertices to the ranks
// that may have tetrahedra around them, these step their grids, and the hits come back.
#pragma once

#include "dist/scene.hpp"

#include <utility>

namespace vox::dist {

// Vertices to search for: those that a part owns, or points, which have no part.
struct VertexSource {
    const Part* part;
    const Clusters* clusters;
    Positions positions;
    Box3f box;
};

// A part of a neighbour, with tetrahedra near vertices of this rank.
struct RemotePart {
    std::uint64_t body;
    Filter filter;
    std::uint32_t part; // the neighbour's number
};

// Vertices of one body that a neighbour sent.
struct ForeignGroup {
    std::uint64_t body;
    Filter filter;
    std::uint32_t neighbour;
};

// A vertex that a neighbour sent.
struct ForeignVertex {
    std::uint64_t id;
    std::uint32_t group; // in Rounds::foreign_groups_
    std::uint32_t place; // among those that the neighbour sent
};

// A vertex that a neighbour sent, and that a part of this rank has a copy of.
struct CopiedVertex {
    const Part* part;
    std::uint32_t vertex;
    std::uint32_t neighbour;
    std::uint32_t place;

    std::pair<std::uint64_t, std::uint32_t> key() const noexcept { return {part->body, vertex}; }
};

// A neighbour's vertex in a tetrahedron of this rank.
struct TetHit {
    vox_dist_contact contact; // as in vox_dist_scene::tet_contacts_
    std::uint32_t neighbour;
    std::uint32_t place;
};

// A vertex of this rank in a tetrahedron, here or at a neighbour.
struct VertexHit {
    vox_dist_contact contact; // as in vox_dist_scene::contacts_
    std::uint32_t neighbour;  // or no_neighbour: the tetrahedron is here
    std::uint32_t hit;        // the place among the neighbour's hits, or the index of the tetrahedron
};
constexpr std::uint32_t no_neighbour = UINT32_MAX;

class Rounds {
public:
    // `points`: vertices are points, which collide with all bodies.
    Rounds(vox_dist_scene& scene, SearchGrid& grid, bool points);

    void run(std::span<const VertexSource> sources, Failure& failure);

    Array<TetHit> tet_hits; // by neighbour
    Array<VertexHit> vertex_hits;

private:
    void write_boxes();
    void read_boxes();
    void find_split_bodies();
    void choose_vertices(std::span<const VertexSource> sources);
    void report_split_bodies(std::uint32_t neighbour);
    void send_vertices_to(std::uint32_t neighbour, std::span<const VertexSource> sources);
    void take_vertices();
    void take_points_of_this_rank(std::span<const VertexSource> sources);
    void step_grid();
    void collect_here();
    void collect(const Part& part, const vox_contact& hit, bool interior);
    void collect_foreign(const Part& part, const vox_contact& hit, bool interior);
    void write_hits();
    void read_hits(std::span<const VertexSource> sources);

    struct Sent {
        std::uint32_t source, vertex;
    };

    vox_dist_scene& scene_;
    SearchGrid& grid_;
    const bool points_;
    Memory* memory_;
    Array<Writer> writers_;          // one a neighbour
    Array<RemotePart> remote_parts_; // by neighbour, from remote_begins_[neighbour] on
    Array<std::uint64_t> remote_begins_;
    Array<Box3f> boxes_; // by remote part
    Array<std::uint64_t> box_begins_;
    Array<std::uint64_t> split_bodies_;    // those with tetrahedra on several ranks, as far as this one sees
    Array<std::uint32_t> reported_parts_;  // own parts of bodies that a neighbour reports as split
    Array<std::uint64_t> reported_begins_; // by neighbour
    Array<Sent> sent_;
    Array<std::uint64_t> sent_begins_; // by neighbour
    Array<ForeignGroup> foreign_groups_;
    Array<ForeignVertex> foreign_vertices_;
    Array<Vec3d> foreign_positions_;
    Array<CopiedVertex> copied_vertices_; // by body and vertex
};

} // namespace vox::dist
