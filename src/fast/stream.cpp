// Minimum and maximum of positions, with a position or several in a register. Whether all coordinates are
// finite is a maximum too, of their bits.
#include "fast/stream.hpp"

#include "base/error.hpp"
#include "base/simd.hpp"
#include "fast/last_positions.hpp"
#include "mesh/check.hpp"
#include "mesh/tiles.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <limits>

#undef VOX_SOURCE
#define VOX_SOURCE "fast/stream.cpp"
#include "base/each_target.hpp"

#include "fast/tile-inl.hpp"

#ifndef VOX_FAST_STREAM_ONCE
#define VOX_FAST_STREAM_ONCE
namespace vox::fast {

constexpr double beyond_floats = 0x1.ffffffp127; // the smallest double that rounds to an infinite float
constexpr float largest_float = std::numeric_limits<float>::max();

inline float nearest_float(double value, double origin) {
    if (!(std::abs(value) < beyond_floats)) return std::numeric_limits<float>::quiet_NaN();
    return static_cast<float>(std::clamp(value - origin, -double{largest_float}, double{largest_float}));
}

} // namespace vox::fast
#endif

HWY_BEFORE_NAMESPACE();
namespace vox::fast {
namespace HWY_NAMESPACE {

// True if all of `values` are finite: without the sign, their bits are below those of infinity.
HWY_INLINE bool AllFinite(const float* HWY_RESTRICT values, std::size_t count) {
    const hn::CappedTag<std::uint32_t, 16> du;
    const hn::RebindToFloat<decltype(du)> df;
    const auto magnitude = hn::Set(du, 0x7fffffffu);
    auto largest = hn::Zero(du);
    std::size_t i = 0;
    for (; i + hn::Lanes(du) <= count; i += hn::Lanes(du))
        largest = hn::Max(largest, hn::And(hn::BitCast(du, hn::LoadU(df, values + i)), magnitude));
    bool finite = hn::GetLane(hn::MaxOfLanes(du, largest)) < 0x7f800000u;
    for (; i < count; ++i) finite &= values[i] - values[i] == 0; // false for infinities and NaN
    return finite;
}

// Adds the positions load(i), i < count, to the box from `lo` to `hi`.
template <class Load>
HWY_INLINE void BoxOf(std::uint32_t count, Load load, hn::Vec<Four>& lo, hn::Vec<Four>& hi) {
    std::uint32_t i = 0;
    for (; i + 4 <= count; i += 4) {
        const auto p0 = load(i), p1 = load(i + 1), p2 = load(i + 2), p3 = load(i + 3);
        lo = hn::Min(lo, hn::Min(hn::Min(p0, p1), hn::Min(p2, p3)));
        hi = hn::Max(hi, hn::Max(hn::Max(p0, p1), hn::Max(p2, p3)));
    }
    for (; i < count; ++i) {
        const auto p = load(i);
        lo = hn::Min(lo, p);
        hi = hn::Max(hi, p);
    }
}

// Several positions in a register, three lanes each, and a third as many lanes of the positions that follow.
// Where registers are wide, all positions of a block take two or four of them. These overlap where the block
// has fewer than block_size positions, which does not change a minimum.
using Wide = hn::CappedTag<float, 16>;
constexpr std::uint32_t wide_lanes = hn::MaxLanes(Wide());
constexpr std::uint32_t wide_positions = wide_lanes / 4;

template <class Vec>
HWY_INLINE hn::Vec<Four> FirstFour(Vec v) {
    if constexpr (sizeof(Vec) > sizeof(hn::Vec<Four>))
        return FirstFour(hn::LowerHalf(v));
    else
        return v;
}

// Returns the result over all positions of a register in the first lanes.
template <class Reduce>
HWY_INLINE hn::Vec<Four> Fold(hn::Vec<Wide> v, Reduce reduce) {
    const Wide d;
    const hn::RebindToSigned<Wide> di;
    for (std::uint32_t positions = wide_positions / 2; positions; positions /= 2) {
        alignas(64) std::int32_t from[wide_lanes];
        for (std::uint32_t i = 0; i < wide_lanes; ++i)
            from[i] = static_cast<std::int32_t>((i + 3 * positions) % wide_lanes);
        v = reduce(v, hn::TableLookupLanes(v, hn::IndicesFromVec(d, hn::Load(di, from))));
    }
    return FirstFour(v);
}

bool StreamBoxes(const float* HWY_RESTRICT positions, const std::uint32_t* HWY_RESTRICT first,
                 std::size_t blocks, Box* HWY_RESTRICT boxes, Box* HWY_RESTRICT groups, Box& all) {
    const Four d;
    bool finite = true;
    const std::uint32_t count = first[blocks];
    std::uint32_t checked = first[0];
    const auto nothing_lo = hn::Set(d, float_infinity), nothing_hi = hn::Set(d, -float_infinity);
    auto all_lo = nothing_lo, all_hi = nothing_hi, group_lo = nothing_lo, group_hi = nothing_hi;
    const Wide dw;
    const auto least = [](auto a, auto b) HWY_ATTR { return hn::Min(a, b); };
    const auto most = [](auto a, auto b) HWY_ATTR { return hn::Max(a, b); };
    const auto put = [&](std::size_t b, hn::Vec<Four> lo, hn::Vec<Four> hi) HWY_ATTR {
        hn::Store(lo, d, boxes[b].lo);
        hn::Store(hi, d, boxes[b].hi);
        group_lo = hn::Min(group_lo, lo);
        group_hi = hn::Max(group_hi, hi);
        if ((b + 1) % group_blocks != 0 && b + 1 != blocks) return;
        hn::Store(group_lo, d, groups[b / group_blocks].lo);
        hn::Store(group_hi, d, groups[b / group_blocks].hi);
        all_lo = hn::Min(all_lo, group_lo);
        all_hi = hn::Max(all_hi, group_hi);
        group_lo = nothing_lo;
        group_hi = nothing_hi;
    };
    for (std::size_t b = 0; b < blocks; ++b) {
        const std::uint32_t end = first[b + 1];
        if (end > checked) { // a few kilobytes at a time, which are in the cache for the boxes then
            const std::uint32_t next = count - end > 256 ? end + 256 : count;
            finite &= AllFinite(positions + std::size_t{checked} * 3, std::size_t{next - checked} * 3);
            checked = next;
        }
        const float* p = positions + std::size_t{first[b]} * 3;
        const std::uint32_t n = end - first[b];
        if (wide_positions > 1 && n >= wide_positions && n <= block_size && count - end >= 2) {
            auto lo = hn::LoadU(dw, p + std::size_t{3} * (n - wide_positions)), hi = lo;
            for (std::uint32_t i = 0; i + wide_positions < block_size; i += wide_positions) {
                const std::uint32_t at = i + wide_positions < n ? i : n - wide_positions;
                const auto some = hn::LoadU(dw, p + std::size_t{3} * at);
                lo = hn::Min(lo, some);
                hi = hn::Max(hi, some);
            }
            put(b, Fold(lo, least), Fold(hi, most));
            continue;
        }
        std::uint32_t left = n;
        auto lo = hn::Set(d, float_infinity), hi = hn::Set(d, -float_infinity);
        if (end == count) {
            --left;
            lo = hi = LoadLastVertex(p, left);
        }
        BoxOf(
            left, [&](std::uint32_t i) HWY_ATTR { return LoadVertex(p, i); }, lo, hi);
        put(b, lo, hi);
    }
    hn::Store(all_lo, d, all.lo);
    hn::Store(all_hi, d, all.hi);
    return finite;
}

// nearest_float() of the coordinates of positions that are three packed doubles.
void RoundPacked(const double* HWY_RESTRICT from, const double* HWY_RESTRICT origin, std::size_t count,
                 float* HWY_RESTRICT to) {
    std::size_t i = 0;
#if HWY_HAVE_FLOAT64
    const hn::CappedTag<double, 8> d;
    const hn::Rebind<float, decltype(d)> df;
    constexpr std::size_t lanes = hn::MaxLanes(d);
    alignas(64) double pattern[3 * lanes]; // the origin, repeated: three registers of it
    for (std::size_t j = 0; j < 3 * lanes; ++j) pattern[j] = origin[j % 3];
    const auto limit = hn::Set(d, beyond_floats), most = hn::Set(d, double{largest_float});
    const auto nan = hn::NaN(d);
    for (; i + 3 * lanes <= count; i += 3 * lanes)
        for (std::size_t j = 0; j < 3 * lanes; j += lanes) {
            const auto x = hn::LoadU(d, from + i + j);
            const auto moved = hn::Sub(x, hn::Load(d, pattern + j));
            const auto kept = hn::Max(hn::Min(moved, most), hn::Neg(most));
            hn::StoreU(hn::DemoteTo(df, hn::IfThenElse(hn::Lt(hn::Abs(x), limit), kept, nan)), df,
                       to + i + j);
        }
#endif
    for (; i < count; ++i) to[i] = nearest_float(from[i], origin[i % 3]);
}

} // namespace HWY_NAMESPACE
} // namespace vox::fast
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vox::fast {

void round_positions(const Positions& positions, const Vec3d& origin, std::uint32_t first, std::uint32_t last,
                     float* out) {
    const auto round = VOX_SIMD_DISPATCH(RoundPacked);
    const double o[3] = {origin.x, origin.y, origin.z};
    out += std::size_t{first} * 3;
    if (positions.doubles && !positions.transform && positions.byte_stride == sizeof(Vec3d) &&
        positions.component_gap == 0 &&
        reinterpret_cast<std::uintptr_t>(positions.data) % alignof(double) == 0) {
        const auto* from = reinterpret_cast<const double*>(positions.data) + std::size_t{first} * 3;
        round(from, o, std::size_t{last - first} * 3, out);
        return;
    }
    constexpr std::uint32_t chunk = 64;
    double exact[3 * chunk];
    for (std::uint32_t v = first; v < last;) {
        const std::uint32_t count = std::min(chunk, last - v);
        for (std::uint32_t i = 0; i < count; ++i, ++v) {
            const Vec3d p = positions.exact(v);
            exact[3 * i] = p.x;
            exact[3 * i + 1] = p.y;
            exact[3 * i + 2] = p.z;
        }
        round(exact, o, std::size_t{count} * 3, out);
        out += std::size_t{count} * 3;
    }
}

bool stream_boxes(const float* positions, std::span<const std::uint32_t> first, Box* boxes, Box* groups,
                  Box& all) {
    return VOX_SIMD_DISPATCH(StreamBoxes)(positions, first.data(), first.size() - 1, boxes, groups, all);
}

namespace {

bool is_in_place(const Step& step, std::size_t body) {
    return !step.of[body].rounded && is_packed(step.bodies[body].positions);
}

// Where the packed positions of each body are going to be.
void place_positions(Step& step, StreamBuffers& buffers) {
    std::size_t room = 0;
    for (std::size_t b = 0; b < step.of.size(); ++b)
        if (!step.of[b].last && !is_in_place(step, b)) room += std::size_t{step.bodies[b].vertex_count} * 3;
    buffers.packed.resize(room);
    float* next = buffers.packed.data();
    for (std::size_t b = 0; b < step.of.size(); ++b) {
        StepBody& body = step.of[b];
        const bool in_place = is_in_place(step, b);
        if (body.last) {
            body.last->expect(body.rounded);
            body.packed = body.last->positions.data();
        } else if (!in_place) {
            body.packed = next;
            next += std::size_t{step.bodies[b].vertex_count} * 3;
        }
        body.positions =
            in_place ? reinterpret_cast<const float*>(step.bodies[b].positions.data) : body.packed;
    }
}

// The part of a body's vertices that are in some of its blocks. False when one is not finite.
bool stream_piece(const Step& step, const Piece& piece, StepBoxes& boxes, Box& box, bool& moved) {
    const StepBody& body = step.of[piece.body];
    const Positions& positions = step.bodies[piece.body].positions;
    const std::span<const std::uint32_t> first =
        std::span(body.tiles->block_first).subspan(piece.first, piece.last - piece.first + 1);
    const std::uint32_t begin = first.front(), end = first.back();
    const std::size_t part = piece.first / piece_blocks;
    const bool in_place = is_in_place(step, piece.body);
    if (body.rounded)
        round_positions(positions, step.origin, begin, end, body.packed);
    else if (!in_place && body.last)
        moved = !copy_strided(*body.last, part, positions, begin, end);
    else if (!in_place)
        for (std::uint32_t v = begin; v < end; ++v) {
            const Vec3f p = positions.floats(v);
            std::memcpy(body.packed + std::size_t{v} * 3, &p, sizeof p);
        }
    Box* out = boxes.blocks.data() + body.first_block + piece.first;
    Box* groups = boxes.groups.data() + body.first_group + piece.first / group_blocks;
    const bool finite = stream_boxes(body.positions, first, out, groups, box);
    if (in_place && body.last) moved = !compare_packed(*body.last, part, body.positions, begin, end, box);
    if (body.rounded && body.last) moved = !compare_exact(*body.last, part, positions, begin, end, box);
    return finite;
}

} // namespace

void stream(Step& step, StepBoxes& boxes, StreamBuffers& buffers) {
    place_positions(step, buffers);
    std::atomic<bool> finite{true};
    buffers.piece_boxes.resize(step.block_pieces.size());
    buffers.piece_moved.resize(step.block_pieces.size());
    step.for_each(step.block_pieces.size(), step.block_count, piece_blocks,
                  [&](std::size_t p, std::uint32_t) {
                      bool moved = false;
                      if (!stream_piece(step, step.block_pieces[p], boxes, buffers.piece_boxes[p], moved))
                          finite.store(false, std::memory_order_relaxed);
                      buffers.piece_moved[p] = moved;
                  });
    if (!finite) {
        for (const Body& body : step.bodies) check_finite(body);
        throw Error(VOX_ERROR_INTERNAL, "positions changed during the step");
    }
    boxes.bodies.assign(step.bodies.size(), empty_box);
    for (std::size_t p = 0; p < step.block_pieces.size(); ++p) {
        const std::uint32_t body = step.block_pieces[p].body;
        add(boxes.bodies[body], buffers.piece_boxes[p]);
        step.of[body].moved |= buffers.piece_moved[p] != 0;
    }
}

} // namespace vox::fast
#endif
