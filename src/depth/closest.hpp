// The search for the closest point of a surface.
#pragma once

#include "base/boxes.hpp"
#include "depth/walk.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <vector>

namespace vox::depth {

struct Box3d {
    Vec3d min, max;
};

struct Closest {
    SurfacePoint at;
    Vec3d way;      // to it, from the point of the query
    double squared; // the squared length of `way`
};

// The closest point of one triangle.
Closest closest_point(const Solid& solid, std::uint32_t triangle, const Vec3d& p);

// For self-contact, the vertex of the query and a tetrahedron of the fold that it has entered.
struct Fold {
    std::uint32_t vertex;
    std::uint32_t tet;
    bool only_straight; // accept only points to which a straight line leads from `tet` inside the mesh
};

class SurfaceTree {
public:
    explicit SurfaceTree(std::pmr::memory_resource* memory)
        : order_(memory), scratch_(memory), boxes_(memory), slabs_(memory) {}

    // Makes room for surfaces of that many triangles.
    void reserve(std::size_t triangles);
    // The number of triangles for which there certainly is room.
    std::size_t capacity() const noexcept { return std::min(order_.capacity(), scratch_.capacity()); }

    // Builds the tree over all triangles of the solid, in time linear in their number.
    void build(const Solid& solid);

    // Finds the closest point to p; of points equally far, that of the first triangle (Topology::before).
    // `fold` may be null; else triangles with its vertex are left out. Returns false when there is no point.
    // Adds the number of triangles it has examined to `visited`.
    bool find(const Vec3d& p, const Fold* fold, Closest& out, std::uint64_t& visited);

    // The same for a vertex at p that is in `tet`. With `self`, the tetrahedron is of the vertex's own mesh,
    // and the point is one of the fold that the vertex has entered, straight ahead if there is one.
    bool find_of_contact(const Vec3d& p, std::uint32_t vertex, std::uint32_t tet, bool self, Closest& out,
                         std::uint64_t& visited);

private:
    // All points between two planes. Where a surface is nearly flat and p is far away, a box many edges long
    // is a poor bound of the distance, and a slab is a good one.
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
    std::pmr::vector<Box3d> boxes_; // a complete binary tree, where i has the children 2i + 1 and 2i + 2
    std::pmr::vector<Slab> slabs_;  // of the same nodes, each made when it is first needed
    std::uint32_t leaves_ = 0;      // their number; they are the last boxes, with leaf_size triangles each
    std::uint32_t last_ = 0;        // the triangle found last, which mostly is close to the next one
    Vec3d middle_{};                // of the box of all triangles, the origin of slabs
    double size_ = 0;               // the diagonal of that box
};

} // namespace vox::depth
