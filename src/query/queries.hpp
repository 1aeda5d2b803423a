// Queries between steps: a copy of the enabled meshes as they were at one moment, and a tree of boxes over
// it. Once prepared it is only read, by any number of threads.
#pragma once

#include "base/scene.hpp"
#include "mesh/tiles.hpp"
#include "mesh/topology.hpp"

#include <vox/vox.h>

#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <span>
#include <vector>

namespace vox {

// A mesh as prepare() takes it.
struct QueryBody {
    Body body;
    const Tiles* tiles;
    const Topology* topology;
};

class Queries {
public:
    explicit Queries(std::pmr::memory_resource* memory);

    // Copies the bodies, whose positions are finite. Throws what the memory throws, and leaves all as it was
    // then.
    void prepare(std::span<const QueryBody> bodies);
    void invalidate() noexcept;
    // Throws Error(INVALID_STATE) when it is not.
    void require_prepared() const;

    // Hits of points[0], points[1], ... in canonical order. Takes memory from `hits`.
    void points(std::span<const Vec3d> points, std::uint64_t mask,
                std::pmr::vector<vox_point_hit>& hits) const;
    // Sorted by mesh and tet.
    void box(const Vec3d& min, const Vec3d& max, std::uint64_t mask,
             std::pmr::vector<vox_tet_hit>& hits) const;
    // mesh 0 where there is none.
    vox_surface_hit closest(const Vec3d& p, double radius, std::uint64_t mask) const noexcept;
    vox_ray_hit ray(const Vec3d& from, const Vec3d& to, std::uint64_t mask) const noexcept;

private:
    struct Mesh {
        vox_mesh id;
        std::uint64_t category;
    };
    // Up to 64 tetrahedra that lie close together: a tile.
    struct Leaf {
        std::uint32_t mesh;         // in meshes_
        std::uint32_t first, count; // in tetrahedra_
        Box3f box;
    };
    // As copied: the tetrahedron's index in its mesh, its corners in vertices_, and bit i for facet i (see
    // facet_corners) on the surface.
    struct Tetrahedron {
        std::uint32_t index;
        std::uint32_t facets;
        std::uint32_t corner[4];
    };
    struct Points {
        std::span<const Vec3d> points;
        std::span<const Box3f> boxes; // around each
        std::uint64_t mask;
    };
    struct PointHit {
        std::uint32_t point, mesh;
        std::uint32_t tetrahedron; // in tetrahedra_
        bool interior;
    };

    void add(const QueryBody& body, std::uint32_t mesh) noexcept;
    void sort_leaves() noexcept;
    void build_trees() noexcept;
    Box3f surface_box(const Leaf& leaf) const noexcept;
    bool wants(const Leaf& leaf, std::uint64_t mask) const noexcept {
        return (meshes_[leaf.mesh].category & mask) != 0;
    }
    std::size_t first_leaf_node() const noexcept { return tree_.size() / 2; }
    void find(std::size_t node, std::span<std::uint32_t> which, const Points& asked,
              std::pmr::vector<PointHit>& found) const;
    void find_in_leaf(const Leaf& leaf, std::uint32_t point, const Points& asked,
                      std::pmr::vector<PointHit>& found) const;
    const Vec3d& corner(const Tetrahedron& t, std::size_t i) const noexcept { return vertices_[t.corner[i]]; }
    void find_first_tet(const Vec3d& from, const Vec3d& to, std::uint64_t mask,
                        vox_ray_hit& hit) const noexcept;
    void find_first_facet(const Vec3d& from, const Vec3d& to, std::uint64_t mask,
                          vox_ray_hit& hit) const noexcept;

    // Bounding boxes with every float rounded outwards, so that what is decided by doubles is never missed.
    std::pmr::vector<Mesh> meshes_;
    std::pmr::vector<Vec3d> vertices_; // mesh after mesh
    std::pmr::vector<Tetrahedron> tetrahedra_;
    std::pmr::vector<Box3f> boxes_; // of tetrahedra_
    std::pmr::vector<Leaf> leaves_; // in the order of a space-filling curve
    // While they are sorted: each one's place on the curve and index, and the leaves themselves.
    std::pmr::vector<std::uint64_t> places_;
    std::pmr::vector<Leaf> unsorted_;
    // A complete binary tree: the root is 1, the children of i are 2 i and 2 i + 1, the leaves its second
    // half.
    std::pmr::vector<Box3f> tree_;
    std::pmr::vector<Box3f>
        surface_tree_; // the same of facets on the surface alone; empty boxes where there are none
    bool prepared_ = false;
};

} // namespace vox
