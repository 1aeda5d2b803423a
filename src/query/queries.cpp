// A bounding volume hierarchy over the tiles of all meshes. The tiles are sorted along a Morton curve
// (morton_code) and halved by count; boxes are made from the leaves up. Sorting is quick, as there are few
// tiles, and is done in every call, so that the order suits bodies that deform.
#include "query/queries.hpp"

#include "base/bits.hpp"
#include "base/boxes.hpp"
#include "base/error.hpp"

#include <algorithm>
#include <cmath>

namespace vox {

namespace {

template <class T>
void reserve(std::pmr::vector<T>& vector, std::size_t count) {
    if (count > vector.capacity()) vector.reserve(count + count / 8);
}

Box3f box3f(const Box& box) noexcept {
    return {{box.lo[0], box.lo[1], box.lo[2]}, {box.hi[0], box.hi[1], box.hi[2]}};
}

} // namespace

Queries::Queries(std::pmr::memory_resource* memory)
    : meshes_(memory), vertices_(memory), boxes_(memory), leaves_(memory), unsorted_(memory), places_(memory),
      tree_(memory), surface_tree_(memory) {}

void Queries::require_prepared() const {
    if (!prepared_)
        throw Error(VOX_ERROR_INVALID_STATE, "the grid is not prepared: call vox_grid_prepare_queries first");
}

void Queries::invalidate() noexcept {
    prepared_ = false;
    meshes_.clear(); // and with it what is shared
}

std::uint64_t Queries::user_data(vox_mesh mesh) const {
    const auto found = std::ranges::lower_bound(meshes_, mesh, {}, &Mesh::id);
    if (found == meshes_.end() || found->id != mesh)
        throw Error(VOX_ERROR_INVALID_HANDLE,
                    format("mesh %u is none of the %zu meshes of the view", mesh, meshes_.size()));
    return found->user_data;
}

void Queries::prepare(std::span<const QueryBody> bodies, Workers& workers) {
    std::size_t vertices = 0, tets = 0, leaves = 0;
    for (const QueryBody& body : bodies) {
        vertices += body.body.vertex_count;
        tets += body.tets->tets.size();
        leaves += body.tets->tiles.size();
    }
    const std::size_t nodes = 2 * std::max<std::size_t>(leaves, 1);
    // Reserve everything first, so that no memory can be missing after it.
    reserve(meshes_, bodies.size());
    reserve(vertices_, vertices);
    reserve(boxes_, tets);
    reserve(leaves_, leaves);
    reserve(unsorted_, leaves);
    reserve(places_, leaves);
    reserve(tree_, nodes);
    reserve(surface_tree_, nodes);

    invalidate();
    vertices_.resize(vertices);
    boxes_.resize(tets);
    leaves_.resize(leaves);
    tree_.resize(nodes);
    surface_tree_.resize(nodes);
    unsorted_.clear();
    vertices = tets = 0;
    for (const QueryBody& body : bodies) {
        for (std::uint32_t tile = 0; tile < body.tets->tiles.size(); ++tile)
            unsorted_.push_back({{static_cast<std::uint32_t>(meshes_.size()), tile}, {}, {}});
        meshes_.push_back(
            {body.body.mesh_id, body.body.filter.category, body.user_data, body.tets, vertices, tets});
        vertices += body.body.vertex_count;
        tets += body.tets->tets.size();
    }
    constexpr std::size_t least_vertices = 16384, least_leaves = 128; // that are worth a task
    workers.for_ranges(vertices, least_vertices, [&](std::size_t begin, std::size_t end, std::uint32_t) {
        copy_positions(bodies, begin, end);
    });
    workers.for_ranges(leaves, least_leaves, [&](std::size_t begin, std::size_t end, std::uint32_t) {
        for (std::size_t l = begin; l < end; ++l) make_boxes(unsorted_[l]);
    });
    sort_leaves();
    build_trees();
    prepared_ = true;
}

// Those with indices [begin, end) in vertices_.
void Queries::copy_positions(std::span<const QueryBody> bodies, std::size_t begin, std::size_t end) noexcept {
    const auto after = std::ranges::upper_bound(meshes_, begin, {}, &Mesh::first_vertex);
    for (auto m = static_cast<std::size_t>(after - meshes_.begin()) - 1; begin < end; ++m) {
        const std::size_t first = meshes_[m].first_vertex;
        const std::size_t stop = std::min<std::size_t>(end, first + bodies[m].body.vertex_count);
        const Positions positions = bodies[m].body.positions;
        for (; begin < stop; ++begin) vertices_[begin] = positions.exact(begin - first);
    }
}

// A vertex is rounded once for all tetrahedra of the tile that share it: as rounding keeps the order of
// numbers, the box of rounded corners is the rounded box.
void Queries::make_boxes(BoxedLeaf& leaf) noexcept {
    const Mesh& mesh = meshes_[leaf.leaf.mesh];
    const Tile& tile = mesh.tets->tiles[leaf.leaf.tile];
    const std::uint32_t* const vertices = mesh.tets->vertices.data() + tile.first_vertex;
    const std::array<std::uint8_t, 4>* const corners = mesh.tets->corners.data() + tile.first_tet;
    const std::uint8_t* const facets = mesh.tets->facets.data() + tile.first_tet;
    Box3f* const boxes = boxes_.data() + mesh.first_tet + tile.first_tet;

    Box around[tile_size]; // each vertex
    for (std::size_t v = 0; v < tile.vertex_count; ++v) {
        const Vec3d& p = vertices_[mesh.first_vertex + vertices[v]];
        around[v] = {{round_down(p.x), round_down(p.y), round_down(p.z), 0},
                     {round_up(p.x), round_up(p.y), round_up(p.z), 0}};
    }
    Box all = empty_box, surface = empty_box;
    for (std::size_t i = 0; i < tile.tet_count; ++i) {
        const std::array<std::uint8_t, 4> corner = corners[i];
        Box box = around[corner[0]];
        for (std::size_t c = 1; c < 4; ++c) vox::add(box, around[corner[c]]);
        boxes[i] = box3f(box);
        vox::add(all, box);
        if (facets[i] == 0) continue;
        for (std::size_t c = 0; c < 4; ++c)
            // A corner belongs to the three facets that are not opposite to it.
            if (facets[i] & ~(1u << c)) vox::add(surface, around[corner[c]]);
    }
    leaf.box = box3f(all);
    leaf.surface_box = box3f(surface);
}

void Queries::sort_leaves() noexcept {
    Box3f all = empty_box3f();
    for (const BoxedLeaf& leaf : unsorted_) extend(all, leaf.box);
    const auto part = [](float lo, float hi, float min, float max) { // 21 bits of the place along one axis
        const double centre = 0.5 * (double{lo} + double{hi}), side = double{max} - double{min};
        const double place = (centre - double{min}) / side; // NaN where a side is 0 or infinite
        return place >= 0 && place <= 1 ? static_cast<std::uint64_t>(place * 0x1fffff) : 0u;
    };
    places_.clear();
    for (const BoxedLeaf& leaf : unsorted_) {
        const Box3f& b = leaf.box;
        const std::uint64_t code = morton_code(part(b.min.x, b.max.x, all.min.x, all.max.x),
                                               part(b.min.y, b.max.y, all.min.y, all.max.y),
                                               part(b.min.z, b.max.z, all.min.z, all.max.z));
        // The upper bits are of the place, the lower ones the index, so no two are equal.
        places_.push_back((code >> 31) << 32 | places_.size());
    }
    std::sort(places_.begin(), places_.end());
}

void Queries::build_trees() noexcept {
    // Where there are no leaves at all, the root is one of nothing.
    tree_[1] = surface_tree_[1] = empty_box3f();
    for (std::size_t i = 0; i < leaves_.size(); ++i) {
        const BoxedLeaf& leaf = unsorted_[places_[i] & 0xffffffffu];
        leaves_[i] = leaf.leaf;
        tree_[first_leaf_node() + i] = leaf.box;
        surface_tree_[first_leaf_node() + i] = leaf.surface_box;
    }
    for (std::pmr::vector<Box3f>* tree : {&tree_, &surface_tree_})
        for (std::size_t node = first_leaf_node() - 1; node > 0; --node) {
            (*tree)[node] = (*tree)[2 * node];
            extend((*tree)[node], (*tree)[2 * node + 1]);
        }
}

} // namespace vox
