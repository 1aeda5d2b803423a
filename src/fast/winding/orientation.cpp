#include "fast/winding/orientation.hpp"
#include "base/simd.hpp"

#include "base/parallel.hpp"

#include <algorithm>
#include <optional>

#undef VOX_SOURCE
#define VOX_SOURCE "fast/winding/orientation.cpp"
#include "base/each_target.hpp"

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

// The corners of tets of a tile, one tet in each lane.
#if HWY_TARGET == HWY_AVX3
// Coordinates come from tables in registers.
class TileCorners {
public:
    using Buffer = TileVertices;
    static HWY_INLINE void Read(const Tiles& tiles, const float* positions, const Tile& tile, Buffer& buffer,
                                Box& box) {
        LoadTile(tiles, positions, tile, buffer, box);
    }
    explicit HWY_INLINE TileCorners(const Buffer& b) : table_{Table(b.x), Table(b.y), Table(b.z)} {}
    HWY_INLINE void Load(const std::uint8_t* corners, V* out) const {
        const auto index = hn::PromoteTo(Words(), hn::LoadU(hn::Rebind<std::uint8_t, Floats>(), corners));
        for (int a = 0; a < 3; ++a) out[a] = table_[a](index);
    }

private:
    Table table_[3];
};
#else
// Loaded vertex by vertex and transposed: gathers take several times as long.
class TileCorners {
public:
    struct Buffer {
        alignas(16) float xyz[4 * tile_size];
    };
    static HWY_INLINE void Read(const Tiles& tiles, const float* positions, const Tile& tile, Buffer& buffer,
                                Box& box) {
        const std::uint32_t* vertices = tiles.vertices.data() + tile.first_vertex;
        if (tile.holds_last_vertex)
            Read(positions, vertices, tile.vertex_count, VertexLoader<true>(), buffer, box);
        else
            Read(positions, vertices, tile.vertex_count, VertexLoader<false>(), buffer, box);
    }
    explicit HWY_INLINE TileCorners(const Buffer& b) : xyz_(b.xyz) {}
    HWY_INLINE void Load(const std::uint8_t* corners, V* out) const {
        LoadLanes([&](std::size_t lane) HWY_ATTR { return hn::Load(Four(), xyz_ + 4 * corners[lane]); }, out);
    }

private:
    template <class LoadOne>
    static HWY_INLINE void Read(const float* positions, const std::uint32_t* vertices, std::uint32_t count,
                                LoadOne load, Buffer& buffer, Box& box) {
        const Four d;
        auto lo = hn::Set(d, float_infinity), hi = hn::Set(d, -float_infinity);
        for (std::uint32_t i = 0; i < count; ++i) {
            const auto p = load(positions, vertices[i]);
            lo = hn::Min(lo, p);
            hi = hn::Max(hi, p);
            hn::Store(p, d, buffer.xyz + 4 * i);
        }
        hn::Store(lo, d, box.lo);
        hn::Store(hi, d, box.hi);
    }

    const float* xyz_;
};
#endif

// Orients a tile. Returns the least width of its tets; 0 unless `kMeasure`, or when one is in the set.
template <bool kMeasure>
HWY_INLINE float OrientTile(const Tiles& tiles, const Boundary& boundary, const float* HWY_RESTRICT positions,
                            bool rounded, std::uint32_t t, Box& box, std::uint64_t& bad) {
    const Floats d;
    const Tile& tile = tiles.tiles.data()[t];
    TileCorners::Buffer buffer;
    TileCorners::Read(tiles, positions, tile, buffer, box);
    const TileCorners corner(buffer);
    const std::uint8_t* corners = tiles.corners_of(t);
    const FilterConstants constants = MakeConstants(box, rounded);
    const std::uint64_t counted = tile.all_tets() & ~boundary.ignored.data()[t];
    std::uint64_t not_positive = 0, not_negative = 0;
    V least = hn::Set(d, float_infinity);
    for (std::uint32_t i = 0; i < tile.tet_count; i += static_cast<std::uint32_t>(hn::Lanes(d))) {
        V va[3], vb[3], vc[3], vd[3];
        corner.Load(corners + i, va);
        corner.Load(corners + tile_size + i, vb);
        corner.Load(corners + 2 * tile_size + i, vc);
        corner.Load(corners + 3 * tile_size + i, vd);
        V e1[3], e2[3], e3[3], side[3], bound = hn::Set(d, 256 * 0x1p-24f);
        for (int a = 0; a < 3; ++a) {
            e1[a] = hn::Sub(vb[a], va[a]);
            e2[a] = hn::Sub(vc[a], va[a]);
            e3[a] = hn::Sub(vd[a], va[a]);
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
        least = hn::Min(least, hn::IfThenElse(hn::LoadMaskBits(d, bits), width, hn::Set(d, float_infinity)));
    }
    const std::uint64_t mirrored = boundary.mirrored.data()[t];
    bad = ((not_positive & ~mirrored) | (not_negative & mirrored)) & counted;
    return kMeasure && !bad ? hn::GetLane(hn::MinOfLanes(d, least)) : 0;
}

float Orient(const Tiles& tiles, const Boundary& boundary, const float* HWY_RESTRICT positions, bool rounded,
             std::uint32_t t, Box& box, std::uint64_t& bad) {
    return OrientTile<false>(tiles, boundary, positions, rounded, t, box, bad);
}

float Measure(const Tiles& tiles, const Boundary& boundary, const float* HWY_RESTRICT positions, bool rounded,
              std::uint32_t t, Box& box, std::uint64_t& bad) {
    return OrientTile<true>(tiles, boundary, positions, rounded, t, box, bad);
}

} // namespace HWY_NAMESPACE
} // namespace vox::fast
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vox::fast {

namespace {

constexpr std::uint32_t pause = 32; // steps

Box box_of(std::span<const std::uint32_t> items, const Box* boxes) noexcept {
    Box box = empty_box;
    for (const std::uint32_t i : items) add(box, boxes[i]);
    return box;
}

} // namespace

// Positions rounded to floats are off by r = u M along an axis, where M is the largest magnitude of a
// coordinate. So the extents of tets, and their widths, are off by at most 2 sqrt(3) r, and so are diagonals
// of boxes around what is left of displacements.
float slack_of_rounding(const Box& box) noexcept {
    float largest = 0;
    for (int a = 0; a < 3; ++a) largest = std::max({largest, -box.lo[a], box.hi[a]});
    return largest * (4 * 1.125f * 0x1p-24f) + 0x1p-100f;
}

void track_orientation(const Tiles& tiles, const OrientationCache& cache, const float* positions,
                       const Box* blocks, float rounding, std::uint32_t first, std::uint32_t last,
                       Box* super_boxes, float* change, std::uint8_t* positive) {
    for (std::uint32_t s = first; s < last; ++s) {
        change[s] = nothing_known;
        positive[s] = 0;
        if (!cache.is_used || !cache.shapes[s].is_known) {
            super_boxes[s] = box_of(tiles.blocks[s], blocks);
            continue;
        }
        const Shape& shape = cache.shapes[s];
        change[s] = follow(positions, shape, cache.points.data() + shape.first, rounding, shape.least_slack,
                           super_boxes[s]);
        positive[s] = change[s] < shape.least_slack;
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
        track_orientation(
            *body.tiles, *body.orientation, body.positions, boxes.blocks.data() + body.first_block,
            body.rounded ? slack_of_rounding(boxes.bodies[piece.body]) : 0, piece.first, piece.last,
            boxes.super_tiles.data() + body.first_super, boxes.super_change.data() + body.first_super,
            boxes.super_positive.data() + body.first_super);
    });
}

// ---- reference steps -----------------------------------------------------------------------------------

void OrientationCache::prepare(const Tiles& tiles) {
    shapes.resize(tiles.super_tile_count());
    slack.resize(tiles.tiles.size());
    if (2 * abandoned <= points.size()) return;
    for (std::uint32_t s = 0; s < shapes.size(); ++s) forget(s);
    points.clear();
    abandoned = 0;
}

void OrientationCache::forget(std::uint32_t super_tile) noexcept {
    shapes[super_tile].is_known = false;
    abandoned += shapes[super_tile].count;
    shapes[super_tile].count = 0;
}

bool wants_reference(Shape& shape, std::uint32_t failed, std::uint32_t flat, std::uint32_t tiles,
                     std::uint32_t step) noexcept {
    // Measuring costs about as much as orienting twice, so it has to serve several steps. A super-tile for
    // which it did not deforms too fast, and is left alone for a while. Tiles that fail at once will do so
    // again after the next reference, and flat ones may stay flat; it is tried now and then.
    constexpr std::uint32_t young = 4; // steps
    if (!shape.is_known) return step >= shape.resumes;
    const std::uint32_t age = step - shape.measured;
    if (age == 1) shape.failed_at_first = failed;
    const std::uint32_t expected = shape.failed_at_first + tiles / 4;
    if (age < young && failed > (age == 1 ? tiles / 2 : expected)) {
        shape.is_known = false;
        shape.resumes = step + pause;
        return false;
    }
    return (age >= young && failed > expected) || (age >= pause && failed + flat > tiles / 4);
}

namespace {

// Tets of a super-tile are measured where they are; on the lattice they are at most 0.51 of its units off
// along each axis, so widths 1.77.
void measure(const OrientedBody& body, std::uint32_t super, OrientationCache& cache, std::uint64_t* bad) {
    Shape& shape = cache.shapes[super];
    const float scale = place(body.positions, shape, cache.points.data() + shape.first);
    shape.measured = cache.step;
    shape.failed_at_first = 0;
    shape.least_slack = float_infinity;
    shape.most_slack = 0;
    for (std::uint32_t t = body.tiles.super_first[super]; t < body.tiles.super_first[super + 1]; ++t) {
        const float width = measure_tile(body.tiles, body.boundary, body.positions, body.rounded, t,
                                         body.tile_boxes[t], bad[t]);
        body.tile_known[t] = 1;
        cache.slack[t] = width;
        if (width == float_infinity) continue; // no tets
        cache.slack[t] = (width - body.rounding) * scale * (1 - 0x1p-20f) - 2;
        shape.least_slack = std::min(shape.least_slack, cache.slack[t]);
        shape.most_slack = std::max(shape.most_slack, cache.slack[t]);
    }
    shape.is_known = shape.most_slack > 0;
    shape.resumes = cache.step + pause; // unless it is known
}

void orient_super(const OrientedBody& body, std::uint32_t super, const OrientationCache& cache,
                  std::uint64_t* bad) {
    const auto orient = VOX_SIMD_DISPATCH(Orient);
    for (std::uint32_t t = body.tiles.super_first[super]; t < body.tiles.super_first[super + 1]; ++t) {
        bad[t] = 0;
        if (body.change[super] < cache.slack[t]) continue;
        orient(body.tiles, body.boundary, body.positions, body.rounded, t, body.tile_boxes[t], bad[t]);
        body.tile_known[t] = 1;
    }
}

// True if a super-tile is to be measured. Tiles with tets far flatter than the others would soon fail again.
bool wants_reference(const OrientedBody& body, std::uint32_t super, OrientationCache& cache) noexcept {
    if (body.positive[super]) return false;
    Shape& shape = cache.shapes[super];
    const std::uint32_t first = body.tiles.super_first[super], last = body.tiles.super_first[super + 1];
    std::uint32_t failed = 0, flat = 0;
    for (std::uint32_t t = first; shape.is_known && t < last; ++t) {
        if (body.change[super] < cache.slack[t]) continue;
        (cache.slack[t] < shape.most_slack / 8 ? flat : failed) += 1;
    }
    return wants_reference(shape, failed, flat, last - first, cache.step);
}

} // namespace

float measure_tile(const Tiles& tiles, const Boundary& boundary, const float* positions, bool rounded,
                   std::uint32_t tile, Box& box, std::uint64_t& bad) {
    return VOX_SIMD_DISPATCH(Measure)(tiles, boundary, positions, rounded, tile, box, bad);
}

void orient(const OrientedBody& body, OrientationCache& cache, std::uint64_t* bad, Workers* workers) {
    const std::uint32_t supers = body.tiles.super_tile_count();
    cache.prepare(body.tiles);
    cache.is_used = true;
    ++cache.step;
    std::uint32_t listed = 0;
    std::optional<ShapeLister> lister;
    std::pmr::memory_resource* memory = cache.points.memory();
    for (std::uint32_t s = 0; s < supers; ++s) {
        Shape& shape = cache.shapes[s];
        shape.is_due = wants_reference(body, s, cache);
        if (!shape.is_due || shape.count > 0) continue;
        if (!lister) lister.emplace(body.tiles, body.positions, body.vertex_count, memory);
        lister->list(s, shape, cache.points);
        ++listed;
    }
    if (listed > supers / 2) cache.points.shrink_to_fit();
    const auto part = [&](std::size_t begin, std::size_t end, std::uint32_t) {
        for (auto s = static_cast<std::uint32_t>(begin); s < end; ++s) {
            if (body.positive[s]) continue;
            if (cache.shapes[s].is_due)
                measure(body, s, cache, bad);
            else
                orient_super(body, s, cache, bad);
        }
    };
    constexpr std::size_t task_supers = 16; // are worth a task: by bench_stages, 20 microseconds
    for_ranges(workers, supers, task_supers, part);
}

} // namespace vox::fast
#endif
