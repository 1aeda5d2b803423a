// Stages 2 to 4: vertices in cells with a tile of another body are at risk, and are sorted into these cells.
#pragma once

#include "gpu/kernels/cells.hpp"

namespace vox::gpu {

VOX_HD bool is_at_risk(const SceneArrays& s, u32 body, u32 slot) {
    const u32 lowest = s.cell_lowest[slot], highest = s.cell_highest[slot];
    return lowest != none && (lowest != body || highest != body);
}

// f(slot, level) for the cell of each level in use in which the vertex is at risk.
template <class F>
VOX_HD void for_each_risk(const SceneArrays& s, u32 v, F&& f) {
    const u32 body = s.vertex_body[v];
    const CellsOfBody cells = s.cells[body];
    if (cells.scene == none) return;
    for (u32 left = s.status->levels; left != 0; left &= left - 1) {
        const u32 level = lowest_bit(left), slot = slot_of_point(s, cells, level, s.position(v));
        if (is_at_risk(s, body, slot)) f(slot, level);
    }
}

// Over vertices. Finds positions that are not finite, too.
struct FindRisk {
    SceneArrays s;

    VOX_HD void operator()(u32 v) const {
        const float* p = s.position(v);
        const float zero = (p[0] - p[0]) + (p[1] - p[1]) + (p[2] - p[2]);
        if (!(zero == 0) && s.cells[s.vertex_body[v]].scene != none)
            atomic_lowest(&s.status->non_finite_vertex, v);
        bool any = false;
        for_each_risk(s, v, [&](u32 slot, u32) {
            atomic_add(&s.cell_count[slot], 1);
            any = true;
        });
        s.vertex_flag[v] = any;
    }
};

// Over vertices, after sums over flags and counts, which it counts down.
struct PlacePoints {
    SceneArrays s;

    VOX_HD void operator()(u32 v) const {
        if (!s.vertex_flag[v]) return;
        const float* p = s.position(v);
        const u32 risk = s.vertex_risk[v];
        s.risk_vertex[risk] = v;
        s.risk_body[risk] = s.vertex_body[v];
        if (s.cell_begin[s.slots()] > s.point_room) return;
        for_each_risk(s, v, [&](u32 slot, u32 level) {
            const u32 place = atomic_add(&s.cell_count[slot], none) - 1; // one less
            s.points[s.cell_begin[slot] + place] = {p[0], p[1], p[2], level << 29 | risk};
        });
    }
};

} // namespace vox::gpu
