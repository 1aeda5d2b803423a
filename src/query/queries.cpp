// A bounding volume hierarchy over the tiles of all meshes. The trees are built in every call, so that they
// suit bodies that deform; this is quick, as there are few tiles.
#include "query/queries.hpp"

#include "base/boxes.hpp"
#include "base/error.hpp"
#include "base/room.hpp"
#include "query/rounding.hpp"

#include <algorithm>
#include <cmath>

namespace vox {

namespace {

Box3f box3f(const Box& box) noexcept {
    return {{box.lo[0], box.lo[1], box.lo[2]}, {box.hi[0], box.hi[1], box.hi[2]}};
}

} // namespace

Queries::Queries(std::pmr::memory_resource* memory)
    : meshes_(memory), vertices_(memory), boxes_(memory), leaves_(memory), tree_(memory),
      surface_tree_(memory), leaf_boxes_(memory), surface_boxes_(memory) {}

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
    // Reserve everything first, so that no memory can be missing after it.
    reserve_growing(meshes_, bodies.size());
    reserve_growing(vertices_, vertices);
    reserve_growing(boxes_, tets);
    reserve_growing(leaves_, leaves);
    reserve_growing(leaf_boxes_, leaves);
    reserve_growing(surface_boxes_, leaves);
    tree_.reserve(leaves);
    surface_tree_.reserve(leaves);

    invalidate();
    vertices_.resize(vertices);
    boxes_.resize(tets);
    leaves_.clear();
    leaf_boxes_.resize(leaves);
    surface_boxes_.resize(leaves);
    vertices = tets = 0;
    for (const QueryBody& body : bodies) {
        for (std::uint32_t tile = 0; tile < body.tets->tiles.size(); ++tile)
            leaves_.push_back({static_cast<std::uint32_t>(meshes_.size()), tile});
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
        for (std::size_t l = begin; l < end; ++l) make_boxes(static_cast<std::uint32_t>(l));
    });
    tree_.build(leaf_boxes_, workers);
    surface_tree_.build(surface_boxes_, workers);
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
void Queries::make_boxes(std::uint32_t leaf) noexcept {
    const Mesh& mesh = meshes_[leaves_[leaf].mesh];
    const Tile& tile = mesh.tets->tiles[leaves_[leaf].tile];
    const std::uint32_t* const vertices = mesh.tets->vertices.data() + tile.first_vertex;
    const std::array<std::uint8_t, 4>* const corners = mesh.tets->corners.data() + tile.first_tet;
    const std::uint8_t* const facets = mesh.tets->facets.data() + tile.first_tet;
    Box3f* const boxes = boxes_.data() + mesh.first_tet + tile.first_tet;

    Box around[tile_size]; // each vertex
    for (std::size_t v = 0; v < tile.vertex_count; ++v) {
        const Vec3d& p = vertices_[mesh.first_vertex + vertices[v]];
        around[v] = {{rounded_down(p.x), rounded_down(p.y), rounded_down(p.z), 0},
                     {rounded_up(p.x), rounded_up(p.y), rounded_up(p.z), 0}};
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
    leaf_boxes_[leaf] = box3f(all);
    surface_boxes_[leaf] = box3f(surface);
}

} // namespace vox
