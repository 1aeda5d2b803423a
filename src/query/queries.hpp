// Queries on a copy of the enabled meshes at one moment, with a tree of boxes: the content of a locator. Any
// number of threads may read it.
#pragma once

#include "base/array.hpp"
#include "base/box_tree.hpp"
#include "base/boxes.hpp"
#include "base/parallel.hpp"
#include "base/scene.hpp"
#include "exact/closest_point.hpp"
#include "mesh/tiles.hpp"
#include "query/tets.hpp"

#include <vox/vox_query.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <memory_resource>
#include <span>
#include <tuple>

namespace vox {

// A mesh for prepare().
struct QueryBody {
    Body body;
    std::shared_ptr<const QueryTets> tets;
    std::uint64_t user_data;
};

// The meshes that take part in a query.
struct QueryMeshes {
    std::uint64_t mask;
    vox_body excluded;
};

// An answer that any thread may find.
class LazyAnswer {
public:
    LazyAnswer() = default;
    LazyAnswer(const LazyAnswer& other) noexcept : state_(other.state_.load()) {}
    LazyAnswer& operator=(const LazyAnswer& other) noexcept { return state_ = other.state_.load(), *this; }

    template <class Find>
    bool get(bool may_find, Find&& find) {
        std::uint8_t state = state_.load(std::memory_order_relaxed);
        if (state == 0 && may_find) state_.store(state = find() ? 2 : 1, std::memory_order_relaxed);
        return state == 2;
    }

private:
    std::atomic<std::uint8_t> state_ = 0; // 1: no, 2: yes
};

// A caller's list: the first `capacity` hits are kept, all are counted.
template <class Hit>
class HitList {
public:
    HitList(Hit* hits, std::uint64_t capacity) noexcept : hits_(hits), capacity_(capacity) {}
    // The place of the next hit; null if there is no room.
    Hit* add() noexcept { return ++count_ <= capacity_ ? hits_ + (count_ - 1) : nullptr; }
    std::uint64_t count() const noexcept { return count_; }

private:
    Hit* hits_;
    std::uint64_t capacity_, count_ = 0;
};

class Queries {
public:
    explicit Queries(std::pmr::memory_resource* memory);

    // Copies the bodies, which ascend in id and must have finite positions. If it throws what the memory
    // resource throws, nothing has changed; if it throws what the workers throw, the object must be prepared
    // again. Enqueues at most four tasks.
    void prepare(std::span<const QueryBody> bodies, Workers& workers);
    // Throws INVALID_HANDLE for a body that is not in the copy.
    std::uint64_t user_data(vox_body body) const;

    // Hits of points[0], points[1], ... in canonical order; `memory` is for temporary use.
    void points(std::span<const Vec3d> points, QueryMeshes which, std::pmr::memory_resource* memory,
                HitList<vox_point_hit>& hits) const;
    // One location a point; `memory` is for temporary use.
    void locations(std::span<const Vec3d> points, double max_distance, bool extrapolate, QueryMeshes which,
                   std::pmr::memory_resource* memory, vox_location* out) const;
    // One hit a point; `memory` is for temporary use.
    void closest_points(std::span<const Vec3d> points, double max_distance, QueryMeshes which,
                        std::pmr::memory_resource* memory, vox_closest_hit* hits) const;
    // One hit a segment, likewise.
    void closest_to_segments(std::span<const Vec3d> from, std::span<const Vec3d> to, double max_distance,
                             QueryMeshes which, std::pmr::memory_resource* memory,
                             vox_closest_hit* hits) const;
    // The hits of box 0, sorted by (body, tet), into an empty `hits`.
    void box(const Vec3d& min, const Vec3d& max, QueryMeshes which, Array<vox_box_hit>& hits) const;
    // The hits of ray 0, sorted by (t, body, tet, facet), into an empty `hits`.
    void ray_hits(const Vec3d& from, const Vec3d& to, QueryMeshes which, bool first_only,
                  Array<vox_ray_hit>& hits) const;
    // True if a tetrahedron with a volume is on the ray.
    bool blocks(const Vec3d& from, const Vec3d& to, QueryMeshes which) const noexcept;
    // The pieces of segments in canonical order; `memory` is for temporary use.
    void tracks(std::span<const Vec3d> from, std::span<const Vec3d> to, QueryMeshes which,
                std::pmr::memory_resource* memory, HitList<vox_track_piece>& pieces) const;
    // The hits of triangle 0, of three corners, sorted by (body, t, tet), into an empty `hits`. `to` may be
    // null.
    void triangle_hits(const Vec3d* from, const Vec3d* to, QueryMeshes which,
                       Array<vox_triangle_hit>& hits) const;

private:
    struct Mesh {
        vox_body id;
        std::uint64_t category, user_data;
        std::shared_ptr<const QueryTets> tets;
        std::size_t first_vertex, first_tet, first_leaf; // in vertices_, boxes_ and leaves_
        std::size_t first_group;                         // in groups_
        bool rounded;                                    // floats_ are not exact
        Box box = empty_box;
        TileSize tile_size{};
        mutable LazyAnswer walkable{}; // see is_walkable()
    };
    // A tile of a mesh, that is, up to 64 tetrahedra that are close together.
    struct Leaf {
        std::uint32_t mesh, tile; // in meshes_; in the tiles of its tets
    };
    class LeafTets;
    struct Points {
        std::span<const Vec3d> points;
        std::span<const Box3f> boxes; // one around each
        QueryMeshes which;
    };
    struct PointHit {
        std::uint32_t point, mesh, tet; // the mesh in meshes_
        bool interior;
        std::uint32_t leaf, place; // of the tetrahedron in leaves_, and in the tile
    };
    class Batch;
    class Weigher;
    class Tracker;
    using FacetKey = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>; // mesh in meshes_, tet, facet
    struct ClosestFacet;
    struct ClosestToSegment;

    void copy_positions(std::span<const QueryBody> bodies, std::size_t begin, std::size_t end) noexcept;
    void make_boxes(std::uint32_t leaf) noexcept;
    // True if the two tetrahedra at each facet are certainly on opposite sides, so that from one to the next
    // on a segment there is only one way, forwards. Looked up if it is known, or `may_find`.
    bool is_walkable(const Mesh& mesh, bool may_find, std::pmr::memory_resource* memory) const;
    static bool wants(const Mesh& mesh, QueryMeshes which) noexcept {
        return (mesh.category & which.mask) != 0 && mesh.id != which.excluded;
    }
    bool wants(const Leaf& leaf, QueryMeshes which) const noexcept {
        return wants(meshes_[leaf.mesh], which);
    }
    LeafTets tets_of(const Leaf& leaf) const noexcept;
    void join_tiles() noexcept;
    // Calls visit(point, found) for each point and each mesh that contains it, in canonical order. `found`
    // are the tetrahedra that contain the point; with the point on their boundary, all but the lowest may be
    // missing.
    template <class Visit>
    void for_found(std::span<const Vec3d> points, QueryMeshes which, std::pmr::memory_resource* memory,
                   Visit&& visit) const;
    // Appends all of them.
    void find_all(std::span<const Vec3d> points, QueryMeshes which, std::pmr::memory_resource* memory,
                  Array<PointHit>& hits) const;
    static void sort_found(Array<PointHit>& found, std::size_t points);
    // Sets the signs of distances and the counts of meshes that contain the points in `hits`.
    void count_inside(std::span<const Vec3d> points, QueryMeshes which, std::pmr::memory_resource* memory,
                      vox_closest_hit* hits) const;
    void find_few(std::span<const Vec3d> points, QueryMeshes which, std::pmr::memory_resource* memory,
                  Array<PointHit>& found) const;
    void find(std::size_t node, std::span<std::uint32_t> which, const Points& asked,
              Array<PointHit>& found) const;
    void find_in_leaf(std::uint32_t leaf, std::uint32_t point, const Points& asked,
                      Array<PointHit>& found) const;
    template <class Bound, class Visit>
    void visit_facets(QueryMeshes which, const double& most, const Bound& bound, Visit&& visit) const;
    void find_closest(const Vec3d& p, QueryMeshes which, ClosestFacet& closest) const noexcept;
    // The closest point of p, as seen from it, on a facet of a tetrahedron: see PointHit.
    void write_closest(const Vec3d& p, const FacetKey& key, std::uint32_t leaf, std::size_t place,
                       const SeenPoint& seen, double distance, vox_closest_hit& hit) const;
    // Calls answer(index, closest facet) for each point, in any order.
    template <class Answer>
    void for_closest(std::span<const Vec3d> points, double max_distance, QueryMeshes which,
                     std::pmr::memory_resource* memory, Answer&& answer) const;
    // For the points that were not located.
    void locate_outside(std::span<const Vec3d> points, double max_distance, bool extrapolate,
                        QueryMeshes which, std::pmr::memory_resource* memory, vox_location* out) const;

    Array<Mesh> meshes_;    // ascending by id
    Array<Vec3d> vertices_; // mesh after mesh
    Array<Vec3f> floats_;   // vertices_, rounded to nearest
    // All boxes are rounded outwards, so that they exclude nothing that doubles decide.
    Array<Box3f> boxes_;                      // around tetrahedra, in the order of tiles, mesh after mesh
    Array<Leaf> leaves_;                      // mesh after mesh
    BoxTree tree_;                            // over leaves_
    BoxTree surface_tree_;                    // over the surface facets of leaves_
    Array<Box3f> leaf_boxes_, surface_boxes_; // from which the trees are built
    Array<Box> tile_boxes_, groups_;          // for Batch: leaf_boxes_ again; boxes of super_tile_size leaves
};

// The tetrahedra of a leaf, 0 to size() - 1.
class Queries::LeafTets {
public:
    LeafTets(const Mesh& mesh, std::uint32_t tile, const Vec3d* vertices, const Box3f* boxes) noexcept
        : tets_(*mesh.tets), tile_(tets_.tiles.tiles[tile]), corners_(tets_.tiles.corners_of(tile)),
          positions_(vertices + mesh.first_vertex), boxes_(boxes + mesh.first_tet + tile_.first_tet) {}

    std::size_t size() const noexcept { return tile_.tet_count; }
    const Box3f& box(std::size_t i) const noexcept { return boxes_[i]; }
    // The index in its mesh.
    std::uint32_t index(std::size_t i) const noexcept { return tets_.tiles.tets[tile_.first_tet + i]; }
    // Bit f is set when facet f is on the surface.
    unsigned facets(std::size_t i) const noexcept { return tets_.facets[tile_.first_tet + i]; }
    // The place of the first one in tiles.tets of its mesh.
    std::size_t first_tet() const noexcept { return tile_.first_tet; }
    std::uint32_t vertex(std::size_t i, std::size_t corner) const noexcept {
        return tets_.tiles.vertices[tile_.first_vertex + corners_[corner * tile_size + i]];
    }
    const Vec3d& at(std::uint32_t vertex) const noexcept { return positions_[vertex]; }
    const Vec3d& corner(std::size_t i, std::size_t corner) const noexcept { return at(vertex(i, corner)); }
    // The vertices of a facet, in the order of its corners.
    void write_face(std::size_t i, std::size_t facet, std::uint32_t (&face)[3]) const noexcept {
        for (std::size_t c = 0; c < 3; ++c) face[c] = vertex(i, facet_corners[facet][c]);
    }

private:
    const QueryTets& tets_;
    const Tile& tile_;
    const std::uint8_t* corners_;
    const Vec3d* positions_;
    const Box3f* boxes_;
};

inline Queries::LeafTets Queries::tets_of(const Leaf& leaf) const noexcept {
    const Mesh& mesh = meshes_[leaf.mesh];
    return {mesh, leaf.tile, vertices_.data(), boxes_.data()};
}

} // namespace vox
