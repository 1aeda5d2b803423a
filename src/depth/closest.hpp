// The search for the closest point of a surface.
#pragma once

#include "base/array.hpp"
#include "depth/near.hpp"
#include "depth/walk.hpp"

#include <algorithm>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory_resource>
#include <span>

namespace vox {
class Workers;
}

namespace vox::depth {

inline constexpr double infinity = std::numeric_limits<double>::infinity();

struct Closest {
    SurfacePoint at;
    Vec3d way;      // to it, from the point of the query
    double squared; // the squared length of `way`
};

// The closest point of one triangle.
Closest closest_point(const Solid& solid, std::uint32_t triangle, const Vec3d& p);

// State that one search leaves to the next, and counts. The answers do not depend on it.
struct SearchState {
    static constexpr std::uint32_t none = ~0u;

    std::uint32_t near = none; // a triangle that is probably close to the next point, of the same tree
    std::uint64_t visited = 0; // triangles whose closest point was computed
};

// A tree over the triangles of a surface. It is built once for a topology, and fitted to the positions of
// each step. Searches only read it.
class SurfaceTree {
public:
    explicit SurfaceTree(std::pmr::memory_resource* memory)
        : triangles_(memory), leaves_(memory), nodes_(memory), levels_(memory), part_(memory),
          part_of_nodes_(memory) {}

    // Fits the tree to the positions of the solid, in time linear in the number of triangles. Where that was
    // not done for its topology, the tree is built, and with `folds` the parts of the mesh are found, in time
    // linear in its size. `workers` may be null.
    void update(const Solid& solid, bool folds, Workers* workers);

    // Call it when the topology has changed.
    void invalidate() noexcept;

    // Vertices connected by edges make a part of the mesh. This is the name of the one with a tetrahedron, or
    // all_parts where there is only one, or they were not found.
    std::uint32_t part_of(std::uint32_t tet) const noexcept {
        return part_.empty() ? all_parts : part_[solid_.tets[tet].v[0]];
    }
    static constexpr std::uint32_t all_parts = TreeView::mixed;

    // A number that is close for points close to each other.
    std::uint32_t place_on_curve(const Vec3d& p) const noexcept;

    // Finds the closest point to p; of points equally far, that of the first triangle (Topology::before).
    // Triangles with the vertex `left_out` are left out. Returns false when there is no point.
    bool find(const Vec3d& p, std::uint32_t left_out, SearchState& state, Closest& out) const {
        return find_among(p, left_out, all_parts, state, out);
    }

    // Finds the closest point of the part that holds `tet`, which a vertex at p of the same mesh has entered,
    // or of all parts where that one has no triangle without the vertex.
    bool find_in_part(const Vec3d& p, std::uint32_t vertex, std::uint32_t tet, SearchState& state,
                      Closest& out) const;

    // Finds the point of the fold that a vertex at p has entered, which is in `tet` of the vertex's own mesh.
    // docs/depth-method.md has the rule. Returns false when all triangles have the vertex.
    bool find_in_fold(const Vec3d& p, std::uint32_t vertex, std::uint32_t tet, SearchState& state,
                      Closest& out) const;

    static constexpr std::uint32_t no_vertex = ~0u;

private:
    struct Key {
        std::uint32_t part, code, triangle;

        auto operator<=>(const Key&) const = default;
    };
    class Query;
    class Receiver;
    class NearestOne;
    class NearestPlaces;
    class NearestMinima;

    void reserve(std::size_t triangles);
    void take_frame();
    Array<Key> sort_along_curve() const;
    void lay_out(std::span<const Key> order);
    void name_parts_of_nodes();
    void fit(Workers* workers);
    void fit_leaves(std::size_t begin, std::size_t end);
    bool fits_frame();
    void find_parts();
    bool is_in(std::uint32_t part, const Triangle& triangle) const noexcept {
        return part == all_parts || part_[triangle.v[0]] == part;
    }
    bool find_among(const Vec3d& p, std::uint32_t left_out, std::uint32_t part, SearchState& state,
                    Closest& out) const;

    struct Line { // from a vertex at p, in `tet`
        Vec3d p;
        std::uint32_t vertex, tet;
    };
    bool reaches(const Line& line, const Vec3d& way) const;
    double squared_exit(const Line& line, const Vec3d& way) const;

    Solid solid_{};
    Array<std::uint32_t> triangles_; // of the lanes of leaves_
    Array<TreeLeaf> leaves_;
    Array<TreeNode> nodes_;
    Array<TreeLevel> levels_; // the root's is the last
    TreeView view_{};
    // The tree's coordinates are scale_ * (x - middle_), mostly at most 1 in magnitude.
    Vec3d middle_{};
    double scale_ = 1;
    float most_ = 0; // the largest coordinate, in magnitude
    // For each vertex the lowest vertex of its part; empty when there is only one part, or folds were not
    // asked for. And for each leaf and node the part of its triangles, as TreeView has it.
    Array<std::uint32_t> part_, part_of_nodes_;
    bool is_built_ = false, has_parts_ = false;
};

// The trees over surfaces that were searched, one for each such mesh, kept from step to step. Depths of
// vertices and of edges share them.
class SurfaceTrees {
public:
    explicit SurfaceTrees(std::pmr::memory_resource* memory) : trees_(memory) {}

    // Adds one for a mesh, unless it has one. Throws what the memory throws.
    void add(std::uint32_t mesh_id);
    // The tree of a mesh that has one, until another is added or forgotten. update() must fit it before
    // each search, even if positions are the same: it refers to the arrays of the mesh.
    SurfaceTree& operator[](std::uint32_t mesh_id) noexcept;

    void topology_changed(std::uint32_t mesh_id) noexcept;
    void forget(std::uint32_t mesh_id) noexcept;
    void forget_all() noexcept;

private:
    struct Tree {
        std::uint32_t mesh_id;
        SurfaceTree tree;
    };
    // The place of a mesh's tree, or where it would be.
    Tree* place(std::uint32_t mesh_id) noexcept;

    Array<Tree> trees_; // by body id
};

} // namespace vox::depth
