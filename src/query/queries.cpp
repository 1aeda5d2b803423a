// A bounding volume hierarchy over the tiles of all meshes: sorted along a Morton curve (G. M. Morton, A
// computer oriented geodetic data base, 1966), halved by count, boxes from the leaves up. The order costs one
// sort of few tiles per call, and follows bodies that deform.
#include "query/queries.hpp"

#include "base/error.hpp"
#include "query/box_tree.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace vox {

namespace {

template <class T>
void reserve(std::pmr::vector<T>& vector, std::size_t count) {
    if (count > vector.capacity()) vector.reserve(count + count / 8);
}

// 21 bits spread out to every third one.
std::uint64_t spread(std::uint64_t x) noexcept {
    x = (x | x << 32) & 0x1f00000000ffffu;
    x = (x | x << 16) & 0x1f0000ff0000ffu;
    x = (x | x << 8) & 0x100f00f00f00f00fu;
    x = (x | x << 4) & 0x10c30c30c30c30c3u;
    return (x | x << 2) & 0x1249249249249249u;
}

} // namespace

Queries::Queries(std::pmr::memory_resource* memory)
    : meshes_(memory), vertices_(memory), tetrahedra_(memory), boxes_(memory), leaves_(memory),
      places_(memory), unsorted_(memory), tree_(memory), surface_tree_(memory) {}

void Queries::require_prepared() const {
    if (!prepared_)
        throw Error(VOX_ERROR_INVALID_STATE, "the grid is not prepared: call vox_grid_prepare_queries first");
}

void Queries::invalidate() noexcept {
    prepared_ = false;
    meshes_.clear();
    vertices_.clear();
    tetrahedra_.clear();
    boxes_.clear();
    leaves_.clear();
    tree_.clear();
    surface_tree_.clear();
}

void Queries::prepare(std::span<const QueryBody> bodies) {
    std::size_t vertices = 0, tets = 0, leaves = 0;
    for (const QueryBody& body : bodies) {
        vertices += body.body.vertex_count;
        tets += body.body.tets.size();
        leaves += body.tiles->tiles.size();
    }
    const std::size_t nodes = 2 * std::bit_ceil(std::max<std::size_t>(leaves, 1));
    // Room for all first: nothing can fail after that.
    reserve(meshes_, bodies.size());
    reserve(vertices_, vertices);
    reserve(tetrahedra_, tets);
    reserve(boxes_, tets);
    reserve(leaves_, leaves);
    reserve(places_, leaves);
    reserve(unsorted_, leaves);
    reserve(tree_, nodes);
    reserve(surface_tree_, nodes);

    invalidate();
    for (const QueryBody& body : bodies) {
        add(body, static_cast<std::uint32_t>(meshes_.size()));
        meshes_.push_back({body.body.mesh_id, body.body.filter.category});
    }
    sort_leaves();
    tree_.resize(nodes);
    surface_tree_.resize(nodes);
    build_trees();
    prepared_ = true;
}

void Queries::add(const QueryBody& from, std::uint32_t mesh) noexcept {
    const Body& body = from.body;
    const auto first_vertex = static_cast<std::uint32_t>(vertices_.size());
    const bool rounded = body.positions.rounded(); // else all are floats
    for (std::uint32_t v = 0; v < body.vertex_count; ++v) vertices_.push_back(body.positions.exact(v));
    for (const Tile& tile : from.tiles->tiles) {
        if (tile.tet_count == 0) continue; // all of them are off
        Leaf leaf{mesh, static_cast<std::uint32_t>(tetrahedra_.size()), tile.tet_count, empty_box3f()};
        for (std::uint32_t i = 0; i < tile.tet_count; ++i) {
            const std::uint32_t index = from.tiles->tets[tile.first_tet + i];
            Tetrahedron t{index, 0, {}};
            Box3f box = empty_box3f();
            for (std::size_t c = 0; c < 4; ++c) {
                t.corner[c] = first_vertex + body.tets[index].v[c];
                const Vec3d& p = vertices_[t.corner[c]];
                if (rounded) {
                    extend(box, p);
                } else {
                    const Vec3f at{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
                    extend(box, {at, at});
                }
                const std::uint32_t across = from.topology->across[index][c];
                if (across != Topology::nothing && (across & Topology::surface_bit))
                    t.facets |= 1u << c;
            }
            tetrahedra_.push_back(t);
            boxes_.push_back(box);
            extend(leaf.box, box);
        }
        leaves_.push_back(leaf);
    }
}

void Queries::sort_leaves() noexcept {
    Box3f all = empty_box3f();
    for (const Leaf& leaf : leaves_) extend(all, leaf.box);
    const auto part = [](float lo, float hi, float min, float max) { // of the way along one axis, in 21 bits
        const double centre = 0.5 * (double{lo} + double{hi}), side = double{max} - double{min};
        return side > 0 ? static_cast<std::uint64_t>((centre - double{min}) / side * 0x1fffff) : 0u;
    };
    unsorted_.clear();
    places_.clear();
    for (const Leaf& leaf : leaves_) {
        const Box3f& b = leaf.box;
        const std::uint64_t code = spread(part(b.min.x, b.max.x, all.min.x, all.max.x)) |
                                   spread(part(b.min.y, b.max.y, all.min.y, all.max.y)) << 1 |
                                   spread(part(b.min.z, b.max.z, all.min.z, all.max.z)) << 2;
        // The upper bits of the place, and the index: no two are equal.
        places_.push_back((code >> 31) << 32 | unsorted_.size());
        unsorted_.push_back(leaf);
    }
    std::sort(places_.begin(), places_.end());
    for (std::size_t i = 0; i < leaves_.size(); ++i) leaves_[i] = unsorted_[places_[i] & 0xffffffffu];
}

Box3f Queries::surface_box(const Leaf& leaf) const noexcept {
    Box3f box = empty_box3f();
    for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i) {
        const Tetrahedron& t = tetrahedra_[i];
        for (std::size_t c = 0; c < 4; ++c)
            // A corner belongs to the three facets that are not opposite to it.
            if (t.facets & ~(1u << c)) extend(box, corner(t, c));
    }
    return box;
}

void Queries::build_trees() noexcept {
    std::fill(tree_.begin(), tree_.end(), empty_box3f());
    std::fill(surface_tree_.begin(), surface_tree_.end(), empty_box3f());
    for (std::size_t i = 0; i < leaves_.size(); ++i) {
        tree_[first_leaf_node() + i] = leaves_[i].box;
        surface_tree_[first_leaf_node() + i] = surface_box(leaves_[i]);
    }
    for (std::pmr::vector<Box3f>* tree : {&tree_, &surface_tree_})
        for (std::size_t node = first_leaf_node() - 1; node > 0; --node) {
            (*tree)[node] = (*tree)[2 * node];
            extend((*tree)[node], (*tree)[2 * node + 1]);
        }
}

} // namespace vox
