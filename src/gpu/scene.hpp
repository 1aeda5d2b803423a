// The arrays of a step, as plain pointers that a kernel takes by value.
#pragma once

#include "base/scene.hpp"
#include "gpu/group.hpp"

#include <vox/vox_gpu.h>

namespace vox::gpu {

constexpr u32 none = ~0u;

// A tile of mesh/tiles.hpp of one body.
struct TileOfBody {
    u32 first_vertex; // in SceneArrays::tile_vertices
    u32 first_tet;    // in SceneArrays::tile_tets and corners
    u32 body;
    u8 vertex_count, tet_count;
};

// What a vertex has to know of its body: 8 bytes.
struct CellsOfBody {
    u32 scene;     // `none`: the body takes no part
    float inverse; // of the size of a cell
};

struct BodyOfScene {
    u32 id, first_vertex, vertex_count, first_tet; // its tets in SceneArrays::tets
    u32 first_of_scene, end_of_scene;              // bodies of its scene
    bool self_collision;
    PairFilter filter;
};

struct FloatBox {
    float lo[3], hi[3];
};

// A vertex at risk in a cell of a level.
struct CellPoint {
    float x, y, z;
    u32 level_risk; // level << 29 | its number among the vertices at risk
};
constexpr u32 most_vertices = 1u << 29;

// A vertex at risk and a tet that the look-up could not separate.
struct TileFinding {
    u32 risk;
    u32 certain : 1, tile : 25, place : 6; // of the tet in the tile
};
constexpr u32 most_tiles = 1u << 25;

// A tetrahedron that contains a vertex, as a number that ascends with body and tet.
using HitOfVertex = u64;
VOX_HD HitOfVertex hit_of(u32 body, u32 tet, bool interior) {
    return u64{body} << 32 | u64{tet} << 1 | u64{interior};
}
VOX_HD u32 body_of(HitOfVertex hit) { return static_cast<u32>(hit >> 32); }
VOX_HD u32 tet_of(HitOfVertex hit) { return static_cast<u32>(hit) >> 1; }
VOX_HD bool is_interior(HitOfVertex hit) { return (hit & 1) != 0; }

using StepStatus = vox_gpu_status; // on the device
constexpr u32 too_many_points = VOX_GPU_FAULT_POINTS, too_many_findings = VOX_GPU_FAULT_FINDINGS,
              too_many_contacts = VOX_GPU_FAULT_CONTACTS, non_finite_position = VOX_GPU_FAULT_NON_FINITE;

struct SceneArrays {
    // What does not change between two updates.
    u32 vertex_count, tile_count, body_count, scene_count;
    bool any_filter; // else bodies of one scene collide
    bool gathers;    // positions are not packed
    const BodyOfScene* bodies;
    const CellsOfBody* cells;
    const u32* first_body;  // of each scene, and the end
    const u32* vertex_body; // of each vertex
    const TileOfBody* tiles;
    const u32* tile_vertices; // numbers in their body
    const u32* tile_tets;     // likewise
    const u32* corners;       // four places in the tile's vertices a tet, 8 bits each
    const Tet* tets;          // numbers in their body
    u32 brick_mask;           // bricks of 4 x 4 x 4 cells, less 1

    const float* positions; // x y z of all vertices
    float* gathered;        // the same place, where there is a gather: from `source`
    const char* source;
    u64 byte_stride;

    // What a step writes.
    FloatBox* boxes;                 // of tiles
    u32 *cell_lowest, *cell_highest; // body with a tile there
    u32 *cell_count, *cell_begin;
    u32 *vertex_flag, *vertex_risk; // at risk or not; how many before it
    u32 *risk_vertex, *risk_body;
    CellPoint* points;
    TileFinding* findings;
    u32* finding_place; // 0 if it is no hit, else its place among those of its vertex + 1, twice, + interior
    u32 *hits_of, *hits_begin, *kept_of, *kept_begin;
    HitOfVertex* hits;
    vox_contact* contacts;
    float (*weights)[4];
    u8* interiors;
    u32* contact_begin; // of each scene, and the end
    StepStatus* status;
    u32 point_room, finding_room, contact_room;

    VOX_HD u32 slots() const { return (brick_mask + 1) << 6; }
    VOX_HD const float* position(u32 vertex) const {
        return positions + 3 * static_cast<std::size_t>(vertex);
    }
    VOX_HD Vec3d exact(u32 vertex) const {
        const float* p = position(vertex);
        return {double{p[0]}, double{p[1]}, double{p[2]}};
    }
    VOX_HD u32 vertex_of_tile(const TileOfBody& tile, u32 place) const {
        return bodies[tile.body].first_vertex + tile_vertices[tile.first_vertex + place];
    }
};

} // namespace vox::gpu
