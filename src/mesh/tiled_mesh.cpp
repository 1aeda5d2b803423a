#include "mesh/tiled_mesh.hpp"

#include "base/bits.hpp"

#include <utility>

namespace vox {

void make_tiled_mesh(const Body& body, TiledMesh& out, const MatchedFacets* facets) {
    std::pmr::memory_resource* memory = out.boundary.triangles.memory();
    TiledMesh made(memory);
    make_tiles(body.tets, body.vertex_count, body.positions, made.tiles, body.off);
    if (body.self_collision) {
        make_boundary(body.tets, body.vertex_count, body.positions, made.tiles, made.boundary, facets);
        if (!boundary_pays(made.boundary.triangles.size(), made.tiles.tets.size()))
            made.boundary = Boundary(memory);
        erase_if(made.boundary.loose, [&](std::uint32_t v) { return has_bit(body.removed_vertices, v); });
    }
    // Winding numbers leave few tiles in which vertices of the same body are looked up.
    if (!body.self_collision || made.boundary.is_closed) {
        made.tiles.own.clear();
        made.tiles.own.shrink_to_fit();
    }
    made.places.first_young_super = made.tiles.super_tile_count();
    made.places.first_young_vertex = body.vertex_count;
    out = std::move(made);
}

} // namespace vox
