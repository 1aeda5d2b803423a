// A bounding volume hierarchy over the tiles of all meshes. Each call builds the trees again, so that they
// suit bodies that deform; this is quick, as there are few tiles.
#include "query/queries.hpp"

#include "base/error.hpp"
#include "base/room.hpp"
#include "base/rounding.hpp"
#include "base/vectors.hpp"

#include <algorithm>

namespace vox {

namespace {

Box3f box3f(const Box& box) noexcept {
    return {{box.lo[0], box.lo[1], box.lo[2]}, {box.hi[0], box.hi[1], box.hi[2]}};
}

std::size_t group_count(const QueryTets& tets) noexcept {
    return (tets.tiles.tiles.size() + super_tile_size - 1) / super_tile_size;
}

} // namespace

Queries::Queries(std::pmr::memory_resource* memory)
    : meshes_(memory), vertices_(memory), floats_(memory), boxes_(memory), leaves_(memory), tree_(memory),
      surface_tree_(memory), leaf_boxes_(memory), surface_boxes_(memory), tile_boxes_(memory),
      groups_(memory) {}

std::uint64_t Queries::user_data(vox_body body) const {
    const auto found = std::ranges::lower_bound(meshes_, body, {}, &Mesh::id);
    if (found == meshes_.end() || found->id != body)
        throw Error(VOX_ERROR_INVALID_HANDLE,
                    format("body %u is none of the %zu of the locator", body, meshes_.size()));
    return found->user_data;
}

void Queries::prepare(std::span<const QueryBody> bodies, Workers& workers) {
    std::size_t vertices = 0, tets = 0, leaves = 0, groups = 0;
    for (const QueryBody& body : bodies) {
        vertices += body.body.vertex_count;
        tets += body.tets->facets.size();
        leaves += body.tets->tiles.tiles.size();
        groups += group_count(*body.tets);
    }
    // Reserve everything first: nothing below may lack memory.
    reserve_growing(meshes_, bodies.size());
    reserve_growing(vertices_, vertices);
    reserve_growing(floats_, vertices);
    reserve_growing(boxes_, tets);
    reserve_growing(leaves_, leaves);
    reserve_growing(leaf_boxes_, leaves);
    reserve_growing(surface_boxes_, leaves);
    reserve_growing(tile_boxes_, leaves);
    reserve_growing(groups_, groups);
    tree_.reserve(leaves);
    surface_tree_.reserve(leaves);

    meshes_.clear(); // releases shared data, too
    vertices_.resize(vertices);
    floats_.resize(vertices);
    boxes_.resize(tets);
    leaves_.clear();
    leaf_boxes_.resize(leaves);
    surface_boxes_.resize(leaves);
    tile_boxes_.resize(leaves);
    groups_.resize(groups);
    vertices = tets = groups = 0;
    for (const QueryBody& body : bodies) {
        meshes_.push_back({body.body.mesh_id, body.body.filter.category, body.user_data, body.tets, vertices,
                           tets, leaves_.size(), groups, body.body.positions.rounded()});
        for (std::uint32_t tile = 0; tile < body.tets->tiles.tiles.size(); ++tile)
            leaves_.push_back({static_cast<std::uint32_t>(meshes_.size() - 1), tile});
        vertices += body.body.vertex_count;
        tets += body.tets->facets.size();
        groups += group_count(*body.tets);
    }
    constexpr std::size_t least_vertices = 16384, least_leaves = 128; // a task
    workers.for_ranges(vertices, least_vertices, [&](std::size_t begin, std::size_t end, std::uint32_t) {
        copy_positions(bodies, begin, end);
    });
    workers.for_ranges(leaves, least_leaves, [&](std::size_t begin, std::size_t end, std::uint32_t) {
        for (std::size_t l = begin; l < end; ++l) make_boxes(static_cast<std::uint32_t>(l));
    });
    join_tiles();
    tree_.build(leaf_boxes_, workers);
    surface_tree_.build(surface_boxes_, workers);
}

// Copies the positions with indices [begin, end) in vertices_.
void Queries::copy_positions(std::span<const QueryBody> bodies, std::size_t begin, std::size_t end) noexcept {
    const auto after = std::ranges::upper_bound(meshes_, begin, {}, &Mesh::first_vertex);
    for (auto m = static_cast<std::size_t>(after - meshes_.begin()) - 1; begin < end; ++m) {
        const std::size_t first = meshes_[m].first_vertex;
        const std::size_t stop = std::min<std::size_t>(end, first + bodies[m].body.vertex_count);
        const Positions positions = bodies[m].body.positions;
        for (; begin < stop; ++begin) {
            vertices_[begin] = positions.exact(begin - first);
            floats_[begin] = nearest_floats(vertices_[begin]);
        }
    }
}

// Rounds each vertex of the tile once: as rounding is monotonic, the box of rounded corners is the rounded
// box.
void Queries::make_boxes(std::uint32_t leaf) noexcept {
    const Mesh& mesh = meshes_[leaves_[leaf].mesh];
    const Tiles& tiles = mesh.tets->tiles;
    const Tile& tile = tiles.tiles[leaves_[leaf].tile];
    const std::uint32_t* const vertices = tiles.vertices.data() + tile.first_vertex;
    const std::uint8_t* const corners = tiles.corners_of(leaves_[leaf].tile);
    const std::uint8_t* const facets = mesh.tets->facets.data() + tile.first_tet;
    Box3f* const boxes = boxes_.data() + mesh.first_tet + tile.first_tet;

    Box around[tile_size]; // one a vertex
    if (mesh.rounded) {
        for (std::size_t v = 0; v < tile.vertex_count; ++v) {
            const Vec3d& p = vertices_[mesh.first_vertex + vertices[v]];
            around[v] = {{rounded_down(p.x), rounded_down(p.y), rounded_down(p.z), 0},
                         {rounded_up(p.x), rounded_up(p.y), rounded_up(p.z), 0}};
        }
    } else {
        for (std::size_t v = 0; v < tile.vertex_count; ++v) {
            const Vec3f& p = floats_[mesh.first_vertex + vertices[v]];
            around[v] = {{p.x, p.y, p.z, 0}, {p.x, p.y, p.z, 0}};
        }
    }
    Box all = empty_box, surface = empty_box;
    for (std::size_t i = 0; i < tile.tet_count; ++i) {
        const auto corner = [&](std::size_t c) -> const Box& { return around[corners[c * tile_size + i]]; };
        Box box = corner(0);
        vox::add(box, corner(1));
        vox::add(box, corner(2));
        vox::add(box, corner(3));
        boxes[i] = box3f(box);
        vox::add(all, box);
        if (facets[i] == 0) continue;
        for (std::size_t c = 0; c < 4; ++c)
            // A corner is in the three facets that are not opposite to it.
            if (facets[i] & ~(1u << c)) vox::add(surface, corner(c));
    }
    leaf_boxes_[leaf] = box3f(all);
    surface_boxes_[leaf] = box3f(surface);
    tile_boxes_[leaf] = all;
}

// Computes the boxes of groups and meshes, and the sizes of tiles.
void Queries::join_tiles() noexcept {
    std::fill(groups_.begin(), groups_.end(), empty_box);
    for (std::size_t l = 0; l < leaves_.size(); ++l) {
        Mesh& mesh = meshes_[leaves_[l].mesh];
        vox::add(groups_[mesh.first_group + leaves_[l].tile / super_tile_size], tile_boxes_[l]);
        vox::add(mesh.box, tile_boxes_[l]);
        mesh.tile_size.add(tile_boxes_[l]);
    }
}

} // namespace vox
