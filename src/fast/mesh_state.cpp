// What the fast engine keeps of a mesh from step to step: made when it is first needed, and mended after
// edits.
#include "fast/engine.hpp"

#include "base/bits.hpp"
#include "fast/step.hpp"

#include <utility>

namespace vox {

void FastMesh::prepare(const Body& body) {
    std::pmr::memory_resource* memory = surface.triangles.get_allocator().resource();
    FastMesh made(memory);
    make_tiles(body.tets, body.vertex_count, body.positions, made, body.off);
    if (!body.self_collision) {
        made.own.clear();
        made.own.shrink_to_fit();
    } else {
        make_boundary(body.tets, body.vertex_count, body.positions, made, made.surface);
        if (!boundary_pays(made.surface.triangles.size(), made.tets.size()))
            made.surface = Boundary(memory);
        std::erase_if(made.surface.loose, [&](std::uint32_t v) { return has_bit(body.removed_vertices, v); });
    }
    made.expect_vertices(body.vertex_count);
    made.places.first_young_super = made.super_tile_count();
    made.places.first_young_vertex = body.vertex_count;
    *this = std::move(made);
}

void FastMesh::expect_vertices(std::uint32_t vertex_count) {
    rest.positions.resize(std::size_t{vertex_count} * 3);
    rest.parts.resize((block_count() + piece_blocks - 1) / piece_blocks);
}

bool FastMesh::follow(const Body& body, std::span<const TetChange> changes, const IndexLists& tets_of) {
    if (!repair(*this, surface, places, body, changes, tets_of)) return false;
    if (turning.is_known) {
        turning.slack.resize(super_tile_count());
        turning.boxes.resize(super_tile_count());
        for (const TetChange& change : changes)
            if (places.of_tet[change.tet] != TilePlaces::none)
                turning.slack[super_tile_of(places.tile_of(change.tet))] = 0;
    }
    return true;
}

bool FastMesh::follow_vertices(const Body& body, std::uint32_t count_before) {
    if (count_before == 0) return false;
    add_vertices(*this, surface, places, count_before, body.vertex_count);
    expect_vertices(body.vertex_count);
    if (turning.is_known)
        turning.reference.resize(rest.positions.size()); // no matter what: their tets are new
    return true;
}

} // namespace vox
