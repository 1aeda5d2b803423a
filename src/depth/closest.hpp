// The closest point of a surface.
#pragma once

#include "base/boxes.hpp"
#include "depth/walk.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <vector>

namespace vox::depth {

struct Closest {
    SurfacePoint at;
    Vec3d way;      // from the point asked for
    double squared; // its length
};

// The closest point of one triangle.
Closest closest_point(const Solid& solid, std::uint32_t triangle, const Vec3d& p);

// For self-contact: the vertex that asks, and a tetrahedron of the fold that it is in.
struct Fold {
    std::uint32_t vertex;
    std::uint32_t tet;
    bool only_straight; // only points to which a straight line leads inside the mesh from `tet` on
};

class SurfaceTree {
public:
    explicit SurfaceTree(std::pmr::memory_resource* memory)
        : order_(memory), scratch_(memory), boxes_(memory), slabs_(memory) {}

    // Room for surfaces of that many triangles.
    void reserve(std::size_t triangles);
    // Triangles for which there is room for sure.
    std::size_t capacity() const noexcept { return std::min(order_.capacity(), scratch_.capacity()); }

    // Of all triangles of the solid, in time linear in them.
    void build(const Solid& solid);

    // The closest point to p, of points equally far that of the first triangle (Topology::before). `fold` may
    // be null; triangles with its vertex are left out. False when there is none. Adds the triangles it has
    // looked at to `visited`.
    bool find(const Vec3d& p, const Fold* fold, Closest& out, std::uint64_t& visited);

    // The same for a vertex at p in `tet`; `self`: of its own mesh, where a point of the fold it has entered
    // is wanted, straight ahead if there is one.
    bool find_of_contact(const Vec3d& p, std::uint32_t vertex, std::uint32_t tet, bool self, Closest& out,
                         std::uint64_t& visited);

private:
    // All points between two planes. Where a surface is nearly flat and p far away, a box of many edges'
    // length says little about how far it is, but this does.
    struct Slab {
        bool is_made = false;
        Vec3d normal{}; // unit, or zero
        double low = 0, high = 0;
    };
    struct Key {
        std::uint32_t code, triangle;
    };
    static constexpr std::uint32_t leaf_size = 4;

    static std::uint32_t leaves_of(std::size_t triangles);
    Box3d box_of(std::uint32_t triangle) const;
    void sort_along_curve();
    bool is_beyond_slab(std::size_t node, const Vec3d& p, double distance);
    bool accept(const Vec3d& p, const Fold& fold, const Closest& found) const;

    Solid solid_{};
    std::pmr::vector<Key> order_, scratch_;
    std::pmr::vector<Box3d> boxes_; // of a complete binary tree: the children of i are 2i + 1 and 2i + 2
    std::pmr::vector<Slab> slabs_;  // of the same, made where they are asked for
    std::uint32_t leaves_ = 0;      // the last boxes, each of leaf_size triangles in order_
    std::uint32_t last_ = 0;        // found: close to the next one, mostly
    Vec3d middle_{};                // of all, the origin of slabs
    double size_ = 0;               // of the box of all
};

} // namespace vox::depth
