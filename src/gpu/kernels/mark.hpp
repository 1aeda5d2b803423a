// Stages 0 and 1: what a step counts up from nothing; which bodies have tiles in a cell.
#pragma once

#include "gpu/kernels/cells.hpp"

namespace vox::gpu {

// Over the larger of slots and vertices, and one more: the last of each ends its sum.
struct Clear {
    SceneArrays s;

    VOX_HD u32 count() const { return (s.slots() > s.vertex_count ? s.slots() : s.vertex_count) + 1; }
    VOX_HD void operator()(u32 i) const {
        if (i < s.slots()) {
            s.cell_lowest[i] = none;
            s.cell_highest[i] = 0;
        }
        if (i <= s.slots()) s.cell_count[i] = 0;
        if (i <= s.vertex_count) s.hits_of[i] = s.kept_of[i] = 0;
        if (i == s.vertex_count) s.vertex_flag[i] = 0;
        if (i == 0) {
            *s.status = StepStatus{};
            s.status->non_finite_vertex = none;
            s.status->levels = 1;
        }
    }
};

// Over vertices, where positions are not packed.
struct Gather {
    SceneArrays s;

    VOX_HD void operator()(u32 v) const {
        if (s.cells[s.vertex_body[v]].scene == none) return;
        const auto* from = reinterpret_cast<const float*>(s.source + v * s.byte_stride);
        for (u32 a = 0; a < 3; ++a) s.gathered[3 * static_cast<std::size_t>(v) + a] = from[a];
    }
};

// Over tiles: the box of each, and the least and the greatest body with a tile in each cell. A body that
// collides with itself counts as two.
struct MarkTiles {
    SceneArrays s;
    struct Shared {};

    VOX_HD void operator()(const Group& g, u32 t, Shared&) const {
        const TileOfBody tile = s.tiles[t];
        FloatBox box;
        for (int a = 0; a < 3; ++a) {
            PerLane<float> lo, minus_hi;
            g.each([&](u32 lane) {
                const u32 n = tile.vertex_count;
                const float p = s.position(s.vertex_of_tile(tile, lane < n ? lane : 0))[a];
                const float q = s.position(s.vertex_of_tile(tile, lane + lanes < n ? lane + lanes : 0))[a];
                lo[lane] = p < q ? p : q;
                minus_hi[lane] = -(p > q ? p : q);
            });
            box.lo[a] = g.lowest(lo);
            box.hi[a] = -g.lowest(minus_hi);
        }
        const CellsOfBox cells(s.cells[tile.body], box);
        const u32 highest = s.bodies[tile.body].self_collision ? none - 1 : tile.body;
        g.each([&](u32 lane) {
            if (lane == 0) {
                s.boxes[t] = box;
                if (cells.level > 0) atomic_or(&s.status->levels, 1u << cells.level);
            }
            for (u32 i = lane; i < cells.count; i += lanes) {
                const u32 slot = cells.slot(s.brick_mask, i);
                atomic_lowest(&s.cell_lowest[slot], tile.body);
                atomic_highest(&s.cell_highest[slot], highest);
            }
        });
    }
};

} // namespace vox::gpu
