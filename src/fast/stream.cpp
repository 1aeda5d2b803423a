// Minimum and maximum of positions, with one or two of them in a register.
#include "fast/stream.hpp"

#include "base/error.hpp"
#include "base/simd.hpp"
#include "fast/last_positions.hpp"
#include "fast/winding/orientation.hpp"
#include "mesh/check.hpp"
#include "mesh/tiles.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fast/stream.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

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

// Minimum and maximum of positions, of which a register has one or more; lanes that are not part of any
// position are ignored in the end.
template <class D>
struct MinMax {
    hn::Vec<D> lo, hi;

    HWY_INLINE MinMax() : lo(hn::Set(D(), float_infinity)), hi(hn::Set(D(), -float_infinity)) {}
    HWY_INLINE void add(hn::Vec<D> v) {
        lo = hn::Min(lo, v);
        hi = hn::Max(hi, v);
    }
    HWY_INLINE void add(const MinMax& other) {
        lo = hn::Min(lo, other.lo);
        hi = hn::Max(hi, other.hi);
    }
    HWY_INLINE void store(Box& box) const {
        hn::Store(lo, D(), box.lo);
        hn::Store(hi, D(), box.hi);
    }
};

// Two positions in a register, three lanes each, and two lanes of the one that follows. All positions of a
// block take four such registers, which overlap where the block has fewer than block_size. That does not
// change a minimum.
using Two = hn::CappedTag<float, 8>;
constexpr bool has_two = hn::MaxLanes(Two()) == 8;

// The minimum and maximum over the two positions in each register.
template <class D>
HWY_INLINE MinMax<Four> Fold(const MinMax<D>& v) {
    MinMax<Four> folded;
    if constexpr (hn::MaxLanes(D()) == 8) {
        alignas(32) constexpr std::int32_t second[8] = {3, 4, 5, 6, 7, 0, 1, 2};
        const D d;
        const auto from = hn::SetTableIndices(d, second);
        folded.lo = hn::LowerHalf(hn::Min(v.lo, hn::TableLookupLanes(v.lo, from)));
        folded.hi = hn::LowerHalf(hn::Max(v.hi, hn::TableLookupLanes(v.hi, from)));
    }
    return folded;
}

// Sums up zero times each value: zeros, unless one was not finite.
template <class D>
struct FiniteTest {
    hn::Vec<D> sum;

    HWY_INLINE FiniteTest() : sum(hn::Zero(D())) {}
    HWY_INLINE void add(hn::Vec<D> v) { sum = hn::MulAdd(v, hn::Zero(D()), sum); }
    HWY_INLINE bool passed() const { return hn::AllTrue(D(), hn::Eq(sum, hn::Zero(D()))); }
};

template <bool kMoves>
HWY_INLINE bool Stream(const float* HWY_RESTRICT positions, const float* HWY_RESTRICT reference,
                       const std::uint32_t* HWY_RESTRICT first, std::size_t blocks, Box* HWY_RESTRICT boxes,
                       Box* HWY_RESTRICT moves, Box& all) {
    const std::uint32_t count = first[blocks];
    MinMax<Four> all_blocks;
    FiniteTest<Four> finite;
    FiniteTest<Two> two_finite;
    for (std::size_t b = 0; b < blocks; ++b) {
        const std::uint32_t n = first[b + 1] - first[b];
        const float* p = positions + std::size_t{first[b]} * 3;
        const float* q = kMoves ? reference + std::size_t{first[b]} * 3 : nullptr;
        MinMax<Four> box, move;
        if (has_two && n >= 2 && n <= block_size && first[b + 1] < count) {
            MinMax<Two> two, two_moves;
            const std::uint32_t last = n - 2;
            for (std::uint32_t i = 0; i < block_size; i += 2) {
                const std::size_t at = std::size_t{3} * (i < last ? i : last);
                const auto some = hn::LoadU(Two(), p + at);
                two.add(some);
                two_finite.add(some);
                if constexpr (kMoves) two_moves.add(hn::Sub(some, hn::LoadU(Two(), q + at)));
            }
            box = Fold(two);
            if constexpr (kMoves) move = Fold(two_moves);
        } else {
            for (std::uint32_t i = 0; i < n; ++i) {
                const bool is_last = first[b] + i + 1 == count;
                const auto some = is_last ? LoadLastVertex(p, i) : LoadVertex(p, i);
                box.add(some);
                finite.add(some);
                if constexpr (kMoves)
                    move.add(hn::Sub(some, is_last ? LoadLastVertex(q, i) : LoadVertex(q, i)));
            }
        }
        box.store(boxes[b]);
        all_blocks.add(box);
        if constexpr (kMoves) move.store(moves[b]);
    }
    all_blocks.store(all);
    return finite.passed() && two_finite.passed();
}

bool StreamBoxes(const float* HWY_RESTRICT positions, const float* HWY_RESTRICT reference,
                 const std::uint32_t* HWY_RESTRICT first, std::size_t blocks, Box* HWY_RESTRICT boxes,
                 Box* HWY_RESTRICT moves, Box& all) {
    return reference ? Stream<true>(positions, reference, first, blocks, boxes, moves, all)
                     : Stream<false>(positions, nullptr, first, blocks, boxes, nullptr, all);
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

bool stream_boxes(const float* positions, std::span<const std::uint32_t> first, Box* boxes, Box& all,
                  const float* reference, Box* moves) {
    return VOX_SIMD_DISPATCH(StreamBoxes)(positions, reference, first.data(), first.size() - 1, boxes, moves,
                                          all);
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
    const float* reference = body.has_moves ? body.orientation->reference.data() : nullptr;
    Box* moves = body.has_moves ? boxes.moves.data() + body.first_move + piece.first : nullptr;
    const bool finite = stream_boxes(body.positions, first, out, box, reference, moves);
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
