// Stage 5: points in the cells that a tile meets, against the tile's box, the boxes of its tets, and the
// filter of fast/narrow-inl.hpp in single precision, which is explained there.
#pragma once

#include "gpu/kernels/cells.hpp"

#include <limits>

namespace vox::gpu {

VOX_HD float least_of(float a, float b) { return b < a ? b : a; }
VOX_HD float most_of(float a, float b) { return b > a ? b : a; }

// A bound on errors by underflow in tets of a box, infinite where a product could overflow.
VOX_HD float underflow_bound(const FloatBox& box) {
    const float x = box.hi[0] - box.lo[0], y = box.hi[1] - box.lo[1], z = box.hi[2] - box.lo[2];
    const float sums = (x + y + z) + 4 * (x * y + y * z + z * x) + 1, largest = x * y * z * 64;
    constexpr float infinity = std::numeric_limits<float>::infinity();
    return sums < infinity && largest < infinity ? sums * 0x1p-120f : infinity;
}

enum class Separation { apart, open, inside };

// Point p, in the box of the tet with corners v, and the tet.
VOX_HD Separation separate(const float (&v)[4][3], const float (&p)[3], float underflow) {
    float e[4][3], bound = 256 * 0x1p-24f;
    for (int a = 0; a < 3; ++a) {
        const float lo = least_of(least_of(v[0][a], v[1][a]), least_of(v[2][a], v[3][a]));
        const float hi = most_of(most_of(v[0][a], v[1][a]), most_of(v[2][a], v[3][a]));
        bound *= hi - lo;
        for (int k = 1; k < 4; ++k) e[k][a] = v[k][a] - v[0][a];
        e[0][a] = p[a] - v[0][a];
    }
    bound += underflow;
    const float *q = e[0], *e1 = e[1], *e2 = e[2], *e3 = e[3];
    const float nx = e2[1] * e3[2] - e2[2] * e3[1], ny = e2[2] * e3[0] - e2[0] * e3[2],
                nz = e2[0] * e3[1] - e2[1] * e3[0];
    const float mx = e1[1] * q[2] - e1[2] * q[1], my = e1[2] * q[0] - e1[0] * q[2],
                mz = e1[0] * q[1] - e1[1] * q[0];
    const float u1 = q[0] * nx + q[1] * ny + q[2] * nz, u2 = e3[0] * mx + e3[1] * my + e3[2] * mz;
    const float u3 = -(e2[0] * mx + e2[1] * my + e2[2] * mz);
    const float u0 = e1[0] * nx + e1[1] * ny + e1[2] * nz - u1 - u2 - u3;
    const float least = least_of(least_of(u0, u1), least_of(u2, u3));
    const float most = most_of(most_of(u0, u1), most_of(u2, u3));
    if (least < -bound && most > bound) return Separation::apart;
    return least > bound || most < -bound ? Separation::inside : Separation::open;
}

// Over tiles.
struct LookUp {
    SceneArrays s;

    static constexpr u32 queue = 64, pair_room = 96;
    struct Shared {
        SharedArray<float, 64> x, y, z; // of the tile's vertices
        SharedArray<u32, 64> corners;
        SharedArray<float, queue> candidate_x, candidate_y, candidate_z;
        SharedArray<u32, queue> risk;
        SharedArray<u32, pair_room> pairs; // candidate << 6 | tet
        SharedArray<float, 1> underflow;
    };

    // How far a tile is.
    struct Work {
        const Group& g;
        Shared& w;
        u32 tile, body;
        u32 candidates, pairs;
        bool loaded;
    };

    VOX_HD void operator()(const Group& g, u32 t, Shared& w) const {
        if (s.cell_begin[s.slots()] > s.point_room) return; // not all points are there
        Work work{g, w, t, s.tiles[t].body, 0, 0, false};
        for (u32 first = 0; first < most_cells_of_tile; first += lanes) {
            const CellsOfBox cells(s.cells[work.body], s.boxes[t]); // again, as it takes many registers
            const u32 level = cells.level;
            if (first >= cells.count) break;
            PerLane<u32> begin, end;
            PerLane<bool> some;
            g.each([&](u32 lane) {
                begin[lane] = end[lane] = 0;
                if (first + lane < cells.count) find_points(cells, first + lane, begin[lane], end[lane]);
                some[lane] = begin[lane] != end[lane];
            });
            for (u32 left = g.ballot(some); left != 0; left &= left - 1) {
                const u32 lane = lowest_bit(left), last = g.of_lane(end, lane);
                for (u32 i = g.of_lane(begin, lane); i < last; i += lanes) take_points(work, level, i, last);
            }
        }
        if (work.candidates) test(work);
    }

private:
    // Two cells may be in one slot: the first has its points.
    VOX_HD void find_points(const CellsOfBox& cells, u32 cell, u32& begin, u32& end) const {
        const u32 slot = cells.slot(s.brick_mask, cell);
        begin = s.cell_begin[slot];
        end = s.cell_begin[slot + 1];
        if (begin == end || !cells.may_share()) return;
        for (u32 before = 0; before < cell; ++before)
            if (cells.slot(s.brick_mask, before) == slot) end = begin;
    }

    VOX_HD bool may_meet(u32 tile_body, u32 risk) const {
        const u32 body = s.risk_body[risk];
        const BodyOfScene& of_tile = s.bodies[tile_body];
        if (body == tile_body) return of_tile.self_collision;
        if (body < of_tile.first_of_scene || body >= of_tile.end_of_scene) return false; // in the same slot
        return !s.any_filter || collide(of_tile.filter, s.bodies[body].filter);
    }

    // Up to 32 points.
    VOX_HD void take_points(Work& work, u32 level, u32 first, u32 end) const {
        const Group& g = work.g;
        const FloatBox box = s.boxes[work.tile];
        PerLane<bool> in;
        PerLane<CellPoint> point;
        g.each([&](u32 lane) {
            in[lane] = false;
            if (first + lane >= end) return;
            const CellPoint p = s.points[first + lane];
            point[lane] = p;
            in[lane] = p.x >= box.lo[0] && p.x <= box.hi[0] && p.y >= box.lo[1] && p.y <= box.hi[1] &&
                       p.z >= box.lo[2] && p.z <= box.hi[2] && p.level_risk >> 29 == level &&
                       may_meet(work.body, p.level_risk & (most_vertices - 1));
        });
        const u32 mask = g.ballot(in);
        if (mask == 0) return;
        if (!work.loaded) load(work);
        Shared& w = work.w;
        g.each([&](u32 lane) {
            if (!(mask >> lane & 1)) return;
            const u32 at = work.candidates + count_bits(mask & below(lane));
            w.candidate_x.set(at, point[lane].x);
            w.candidate_y.set(at, point[lane].y);
            w.candidate_z.set(at, point[lane].z);
            w.risk.set(at, point[lane].level_risk & (most_vertices - 1));
        });
        work.candidates += count_bits(mask);
        if (work.candidates > queue - lanes) test(work);
    }

    VOX_HD void load(Work& work) const {
        const TileOfBody tile = s.tiles[work.tile];
        Shared& w = work.w;
        work.g.each([&](u32 lane) {
            for (u32 i = lane; i < tile.vertex_count; i += lanes) {
                const float* p = s.position(s.vertex_of_tile(tile, i));
                w.x.set(i, p[0]);
                w.y.set(i, p[1]);
                w.z.set(i, p[2]);
            }
            for (u32 i = lane; i < tile.tet_count; i += lanes)
                w.corners.set(i, s.corners[tile.first_tet + i]);
            if (lane == 0) w.underflow.set(0, underflow_bound(s.boxes[work.tile]));
        });
        work.loaded = true;
    }

    VOX_HD FloatBox box_of_tet(const Work& work, u32 tet) const {
        const Shared& w = work.w;
        if (tet >= s.tiles[work.tile].tet_count) return {{1, 1, 1}, {0, 0, 0}};
        const u32 corners = w.corners[tet], first = corners & 255;
        FloatBox box{{w.x[first], w.y[first], w.z[first]}, {w.x[first], w.y[first], w.z[first]}};
        for (u32 k = 1; k < 4; ++k) {
            const u32 i = corners >> (8 * k) & 255;
            const float p[3] = {w.x[i], w.y[i], w.z[i]};
            for (int a = 0; a < 3; ++a) {
                box.lo[a] = least_of(box.lo[a], p[a]);
                box.hi[a] = most_of(box.hi[a], p[a]);
            }
        }
        return box;
    }

    // All candidates against the boxes of all tets: a lane has two tets.
    VOX_HD void test(Work& work) const {
        const Group& g = work.g;
        Shared& w = work.w;
        PerLane<FloatBox> box[2];
        g.each([&](u32 lane) {
            for (u32 half = 0; half < 2; ++half) box[half][lane] = box_of_tet(work, lane + lanes * half);
        });
        for (u32 i = 0; i < work.candidates; ++i) {
            PerLane<bool> in[2];
            g.each([&](u32 lane) {
                const float x = w.candidate_x[i], y = w.candidate_y[i], z = w.candidate_z[i];
                for (u32 half = 0; half < 2; ++half) {
                    const FloatBox& b = box[half][lane];
                    in[half][lane] = x >= b.lo[0] && x <= b.hi[0] && y >= b.lo[1] && y <= b.hi[1] &&
                                     z >= b.lo[2] && z <= b.hi[2];
                }
            });
            for (u32 half = 0; half < 2; ++half) add_pairs(work, i, half, g.ballot(in[half]));
        }
        if (work.pairs) narrow(work, work.pairs);
        work.pairs = work.candidates = 0;
    }

    VOX_HD void add_pairs(Work& work, u32 candidate, u32 half, u32 mask) const {
        if (mask == 0) return;
        Shared& w = work.w;
        work.g.each([&](u32 lane) {
            if (mask >> lane & 1)
                w.pairs.set(work.pairs + count_bits(mask & below(lane)),
                            candidate << 6 | (lane + lanes * half));
        });
        work.pairs += count_bits(mask);
        if (work.pairs < lanes) return;
        narrow(work, lanes);
        work.pairs -= lanes;
        PerLane<u32> rest;
        work.g.each([&](u32 lane) { rest[lane] = lane < work.pairs ? w.pairs[lanes + lane] : 0; });
        work.g.each([&](u32 lane) {
            if (lane < work.pairs) w.pairs.set(lane, rest[lane]);
        });
    }

    // The first `count` pairs, 32 at most.
    VOX_HD void narrow(Work& work, u32 count) const {
        const Group& g = work.g;
        const Shared& w = work.w;
        PerLane<bool> kept, certain;
        g.each([&](u32 lane) {
            kept[lane] = certain[lane] = false;
            if (lane >= count) return;
            const u32 pair = w.pairs[lane], at = pair >> 6, corners = w.corners[pair & 63];
            if (s.bodies[work.body].self_collision &&
                is_corner(s.tiles[work.tile], corners, s.risk_vertex[w.risk[at]]))
                return;
            const float p[3] = {w.candidate_x[at], w.candidate_y[at], w.candidate_z[at]};
            float v[4][3];
            for (u32 k = 0; k < 4; ++k) {
                const u32 i = corners >> (8 * k) & 255;
                v[k][0] = w.x[i], v[k][1] = w.y[i], v[k][2] = w.z[i];
            }
            const Separation separation = separate(v, p, w.underflow[0]);
            kept[lane] = separation != Separation::apart;
            certain[lane] = separation == Separation::inside;
        });
        const u32 mask = g.ballot(kept);
        if (mask == 0) return;
        const u32 first = g.once([&] { return atomic_add(&s.status->needed_findings, count_bits(mask)); });
        g.each([&](u32 lane) {
            if (!(mask >> lane & 1)) return;
            const u32 at = first + count_bits(mask & below(lane)), pair = w.pairs[lane];
            if (at >= s.finding_room) return;
            s.findings[at] = {w.risk[pair >> 6], certain[lane], work.tile & (most_tiles - 1), pair & 63};
        });
    }

    VOX_HD bool is_corner(const TileOfBody& tile, u32 corners, u32 vertex) const {
        for (u32 k = 0; k < 4; ++k)
            if (s.vertex_of_tile(tile, corners >> (8 * k) & 255) == vertex) return true;
        return false;
    }
};

} // namespace vox::gpu
