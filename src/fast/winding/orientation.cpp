#include "fast/winding/orientation.hpp"
#include "base/simd.hpp"

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fast/winding/orientation.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "fast/tile-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace vox::fast {
namespace HWY_NAMESPACE {

HWY_INLINE V SquaredLength(const V* a) { return Dot(a, a); }

// A lower bound on the widths of tets with edges e1, e2, e3 at the first corner. `longest` is the largest
// difference of coordinates of these; `volume` is six times the volume, less what it may be off by. The width
// is that volume over the longest of seven cross products: of the edges of each facet, and of each two
// opposite edges. A cross product is off by less than 16 u L^2. The bound is zero where squares would leave
// the range of floats.
HWY_INLINE V Width(const V* e1, const V* e2, const V* e3, const V* n23, V longest, V volume) {
    const Floats d;
    V n12[3], n31[3], s[3];
    Cross(e1, e2, n12);
    Cross(e3, e1, n31);
    V square = hn::Max(SquaredLength(n12), hn::Max(SquaredLength(n23), SquaredLength(n31)));
    for (int a = 0; a < 3; ++a) s[a] = hn::Add(n12[a], n23[a]);
    square = hn::Max(square, SquaredLength(s));
    for (int a = 0; a < 3; ++a) s[a] = hn::Add(s[a], n31[a]);
    square = hn::Max(square, SquaredLength(s));
    for (int a = 0; a < 3; ++a) s[a] = hn::Add(n23[a], n31[a]);
    square = hn::Max(square, SquaredLength(s));
    for (int a = 0; a < 3; ++a) s[a] = hn::Add(n31[a], n12[a]);
    square = hn::Max(square, SquaredLength(s));
    const V error = hn::Mul(hn::Mul(longest, longest), hn::Set(d, 64 * 0x1p-24f));
    const V width = hn::Mul(hn::Div(volume, hn::Add(hn::Sqrt(square), error)), hn::Set(d, 1 - 0x1p-16f));
    const auto ordinary =
        hn::And(hn::Gt(longest, hn::Set(d, 0x1p-24f)), hn::Lt(longest, hn::Set(d, 0x1p+24f)));
    return hn::IfThenElseZero(ordinary, width);
}

template <bool kMeasure>
HWY_INLINE float OrientTiles(const Tiles& tiles, const Boundary& boundary,
                             const float* HWY_RESTRICT positions, bool rounded, std::uint32_t first,
                             std::uint32_t last, Box* HWY_RESTRICT boxes, std::uint8_t* HWY_RESTRICT known,
                             std::uint64_t* HWY_RESTRICT bad) {
    const Floats d;
    const Words du;
    const hn::Rebind<std::uint8_t, Floats> db;
    TileVertices vertices;
    V least = hn::Set(d, float_infinity);
    std::uint64_t any_bad = 0;
    for (std::uint32_t t = first; t < last; ++t) {
        const Tile& tile = tiles.tiles.data()[t];
        LoadTile(tiles, positions, tile, vertices, boxes[t]);
        known[t] = 1;
        const std::uint8_t* corners = tiles.corners.data() + std::size_t{t} * 4 * tile_size;
        const Table table[3] = {Table(vertices.x), Table(vertices.y), Table(vertices.z)};
        const FilterConstants constants = MakeConstants(boxes[t], rounded);
        const std::uint64_t counted = tile.all_tets() & ~boundary.ignored.data()[t];
        std::uint64_t not_positive = 0, not_negative = 0;
        for (std::uint32_t i = 0; i < tile.tet_count; i += static_cast<std::uint32_t>(hn::Lanes(d))) {
            const auto ia = hn::PromoteTo(du, hn::LoadU(db, corners + i));
            const auto ib = hn::PromoteTo(du, hn::LoadU(db, corners + tile_size + i));
            const auto ic = hn::PromoteTo(du, hn::LoadU(db, corners + 2 * tile_size + i));
            const auto id = hn::PromoteTo(du, hn::LoadU(db, corners + 3 * tile_size + i));
            V e1[3], e2[3], e3[3], side[3], bound = hn::Set(d, 256 * 0x1p-24f);
            for (int a = 0; a < 3; ++a) {
                const V va = table[a](ia), vb = table[a](ib), vc = table[a](ic), vd = table[a](id);
                e1[a] = hn::Sub(vb, va);
                e2[a] = hn::Sub(vc, va);
                e3[a] = hn::Sub(vd, va);
                // In place of the sides of the filter's box: no edge at the first corner is longer.
                side[a] = hn::Max(hn::Max(hn::Abs(e1[a]), hn::Abs(e2[a])), hn::Abs(e3[a]));
                bound = hn::Mul(bound, side[a]);
            }
            V n[3];
            Cross(e2, e3, n);
            const V volume = Dot(e1, n);
            bound = hn::Add(bound, hn::Set(d, constants.underflow));
            if (rounded) bound = hn::Add(bound, RoundingError(side, constants.rounding));
            std::uint8_t bits[8] = {};
            hn::StoreMaskBits(d, hn::Not(hn::Gt(volume, bound)), bits);
            not_positive |= static_cast<std::uint64_t>(bits[0] | bits[1] << 8) << i;
            hn::StoreMaskBits(d, hn::Not(hn::Lt(volume, hn::Neg(bound))), bits);
            not_negative |= static_cast<std::uint64_t>(bits[0] | bits[1] << 8) << i;
            if constexpr (!kMeasure) continue;
            const V longest = hn::Max(side[0], hn::Max(side[1], side[2]));
            const V width = Width(e1, e2, e3, n, longest, hn::Sub(hn::Abs(volume), bound));
            for (std::size_t byte = 0; byte < 8; ++byte)
                bits[byte] = static_cast<std::uint8_t>(counted >> i >> 8 * byte);
            least =
                hn::Min(least, hn::IfThenElse(hn::LoadMaskBits(d, bits), width, hn::Set(d, float_infinity)));
        }
        const std::uint64_t mirrored = boundary.mirrored.data()[t];
        bad[t] = ((not_positive & ~mirrored) | (not_negative & mirrored)) & counted;
        any_bad |= bad[t];
    }
    return any_bad ? 0 : hn::GetLane(hn::MinOfLanes(d, least));
}

float Orient(const Tiles& tiles, const Boundary& boundary, const float* HWY_RESTRICT positions, bool rounded,
             std::uint32_t first, std::uint32_t last, Box* HWY_RESTRICT boxes,
             std::uint8_t* HWY_RESTRICT known, std::uint64_t* HWY_RESTRICT bad, bool measure) {
    return measure ? OrientTiles<true>(tiles, boundary, positions, rounded, first, last, boxes, known, bad)
                   : OrientTiles<false>(tiles, boundary, positions, rounded, first, last, boxes, known, bad);
}

} // namespace HWY_NAMESPACE
} // namespace vox::fast
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vox::fast {

namespace {

// An upper bound on the diagonal of a box around differences of floats. Such a difference x - y is off by at
// most u |x - y|, and so is, a few times, what is computed here; underflow takes away less than what is
// added.
float diagonal(const Box& moves) noexcept {
    float square = 0;
    for (int a = 0; a < 3; ++a) {
        const float side = (moves.hi[a] - moves.lo[a]) + std::max(-moves.lo[a], moves.hi[a]) * (4 * 0x1p-24f);
        square += side * side;
    }
    return std::sqrt(square) * (1 + 0x1p-20f) + 0x1p-60f;
}

// A box around all that was in `box` before displacements within `moves`, which are differences of floats.
Box moved(const Box& box, const Box& moves) noexcept {
    Box out;
    for (int a = 0; a < 4; ++a) {
        const float margin =
            (std::max(-box.lo[a], box.hi[a]) + std::max(-moves.lo[a], moves.hi[a])) * 0x1p-21f;
        out.lo[a] = (box.lo[a] + moves.lo[a]) - margin;
        out.hi[a] = (box.hi[a] + moves.hi[a]) + margin;
    }
    return out;
}

Box box_of(std::span<const std::uint32_t> items, const Box* boxes) noexcept {
    Box box = empty_box;
    for (const std::uint32_t i : items) add(box, boxes[i]);
    return box;
}

} // namespace

// Positions rounded to floats are off by r = u M along an axis, where M is the largest magnitude of a
// coordinate. So the extents of tets, and their widths, are off by 2 sqrt(3) r for two of them; sides of
// boxes around displacements by 2 r at either end, and their diagonals by 2 sqrt(3) r.
float slack_of_rounding(const Box& box) noexcept {
    float largest = 0;
    for (int a = 0; a < 3; ++a) largest = std::max({largest, -box.lo[a], box.hi[a]});
    return largest * (8 * 1.125f * 0x1p-24f) + 0x1p-100f;
}

void track_orientation(const Tiles& tiles, const OrientationCache& cache, const Box* blocks, const Box* moves,
                       float rounding, std::uint32_t first, std::uint32_t last, Box* super_boxes,
                       std::uint8_t* positive) {
    for (std::uint32_t s = first; s < last; ++s) {
        positive[s] = 0;
        if (!moves || !(cache.slack[s] > 0)) {
            super_boxes[s] = box_of(tiles.blocks[s], blocks);
            continue;
        }
        const Box move = box_of(tiles.blocks[s], moves);
        positive[s] = diagonal(move) + rounding < cache.slack[s];
        super_boxes[s] = moved(cache.boxes[s], move);
    }
}

void track_orientation(Step& step, StepBoxes& boxes) {
    constexpr std::size_t task_tiles = 256; // are worth a task: by bench_stages, six microseconds
    std::size_t tiles = 0;
    for (StepBody& body : step.of) {
        body.has_super_boxes = body.moved && body.boundary;
        if (body.has_super_boxes) tiles += body.tiles->tiles.size();
    }
    if (tiles == 0) return;
    step.for_each(step.super_pieces.size(), tiles, task_tiles, [&](std::size_t p, std::uint32_t) {
        const Piece& piece = step.super_pieces[p];
        const StepBody& body = step.of[piece.body];
        if (!body.has_super_boxes) return;
        track_orientation(*body.tiles, *body.orientation, boxes.blocks.data() + body.first_block,
                          body.has_moves ? boxes.moves.data() + body.first_move : nullptr,
                          body.rounded ? slack_of_rounding(boxes.bodies[piece.body]) : 0, piece.first,
                          piece.last, boxes.super_tiles.data() + body.first_super,
                          boxes.super_positive.data() + body.first_super);
    });
}

bool wants_reference(OrientationCache& cache, std::uint32_t doubtful, std::uint32_t super_tiles) noexcept {
    // Taking a reference costs about as much as orienting all tets once, so it has to serve several steps. A
    // body for which it did not deforms too fast, and is left alone for a while.
    constexpr std::uint32_t young = 4, pause = 32; // steps
    ++cache.age;
    if (cache.wait > 0) {
        --cache.wait;
        return false;
    }
    if (cache.is_known && doubtful <= super_tiles / 8) return false;
    if (cache.is_known && cache.age < young) {
        cache.is_known = false;
        cache.wait = pause;
        return false;
    }
    cache.age = 0;
    return true;
}

float orient(const Tiles& tiles, const Boundary& boundary, const float* positions, bool rounded,
             std::uint32_t first, std::uint32_t last, Box* boxes, std::uint8_t* known, std::uint64_t* bad,
             bool measure) {
    return VOX_SIMD_DISPATCH(Orient)(tiles, boundary, positions, rounded, first, last, boxes, known, bad,
                                     measure);
}

} // namespace vox::fast
#endif
