#include "fast/winding/orientation.hpp"
#include "base/simd.hpp"

#include "base/parallel.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fast/winding/orientation.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "fast/tile-inl.hpp"

#ifndef VOX_FAST_ORIENTATION_ONCE
#define VOX_FAST_ORIENTATION_ONCE
namespace vox::fast {

// Where a super-tile is, and an affine map of its Shape with what the map leaves of the displacements.
struct Motion {
    Box box;
    float column[4][4]; // of the map
    float lo[3], hi[3]; // the box of the rest
};

} // namespace vox::fast
#endif

HWY_BEFORE_NAMESPACE();
namespace vox::fast {
namespace HWY_NAMESPACE {

// ---- super-tiles followed by affine maps ---------------------------------------------------------------

template <class Load>
HWY_INLINE void LoadPoints(const float* positions, const ShapePoints& points, std::size_t i, Load load,
                           V* xyz) {
    LoadLanes([&](std::size_t lane) HWY_ATTR { return load(positions, points.vertex[i + lane]); }, xyz);
}

// A box as it is found, with a vertex in each lane.
struct BoxInLanes {
    V lo[3], hi[3];

    HWY_INLINE BoxInLanes() {
        for (int a = 0; a < 3; ++a) {
            lo[a] = hn::Set(Floats(), float_infinity);
            hi[a] = hn::Set(Floats(), -float_infinity);
        }
    }
    HWY_INLINE void Add(int a, V c) {
        lo[a] = hn::Min(lo[a], c);
        hi[a] = hn::Max(hi[a], c);
    }
    HWY_INLINE void Store(float* to_lo, float* to_hi) const {
        for (int a = 0; a < 3; ++a) {
            to_lo[a] = hn::GetLane(hn::MinOfLanes(Floats(), lo[a]));
            to_hi[a] = hn::GetLane(hn::MaxOfLanes(Floats(), hi[a]));
        }
    }
};

template <class Load>
HWY_INLINE void FollowShape(const float* HWY_RESTRICT positions, const Shape& shape,
                            const ShapePoints* HWY_RESTRICT points, Load load, Motion& motion) {
    const Four d4;
    const Floats d;
    const hn::RebindToSigned<Floats> di;
    const hn::Rebind<std::int16_t, Floats> d16;
    for (std::size_t k = 0; k < 4; ++k) {
        auto sum = hn::Zero(d4);
        for (std::size_t i = 0; i < Shape::samples; ++i)
            sum =
                hn::Add(sum, hn::Mul(load(positions, points[0].vertex[i]), hn::Set(d4, shape.weight[k][i])));
        hn::StoreU(sum, d4, motion.column[k]);
    }
    BoxInLanes box, rest;
    for (std::uint32_t p = 0; p < shape.count; ++p)
        for (std::size_t i = 0; i < ShapePoints::size; i += hn::Lanes(d)) {
            V x[3], q[3];
            LoadPoints(positions, points[p], i, load, x);
            for (int a = 0; a < 3; ++a)
                q[a] = hn::ConvertTo(d, hn::PromoteTo(di, hn::LoadU(d16, points[p].place[a] + i)));
            for (int a = 0; a < 3; ++a) {
                box.Add(a, x[a]);
                V r = hn::Sub(x[a], hn::Set(d, motion.column[3][a]));
                for (int k = 0; k < 3; ++k) r = hn::Sub(r, hn::Mul(q[k], hn::Set(d, motion.column[k][a])));
                rest.Add(a, r);
            }
        }
    box.Store(motion.box.lo, motion.box.hi);
    motion.box.lo[3] = motion.box.hi[3] = 0;
    rest.Store(motion.lo, motion.hi);
}

void Follow(const float* HWY_RESTRICT positions, const Shape& shape, const ShapePoints* HWY_RESTRICT points,
            Motion& motion) {
    if (shape.holds_last_vertex)
        FollowShape(positions, shape, points, VertexLoader<true>(), motion);
    else
        FollowShape(positions, shape, points, VertexLoader<false>(), motion);
}

// Puts the points where the vertices are. Returns how many points of the lattice a unit of length is; 0 where
// the super-tile is too small or too large for a lattice.
template <class Load>
HWY_INLINE float PlaceShape(const float* HWY_RESTRICT positions, std::uint32_t count,
                            ShapePoints* HWY_RESTRICT points, Load load) {
    const Floats d;
    const hn::Rebind<std::int16_t, Floats> d16;
    BoxInLanes found;
    for (std::uint32_t p = 0; p < count; ++p)
        for (std::size_t i = 0; i < ShapePoints::size; i += hn::Lanes(d)) {
            V x[3];
            LoadPoints(positions, points[p], i, load, x);
            for (int a = 0; a < 3; ++a) found.Add(a, x[a]);
        }
    float lo[3], hi[3], middle[3], half = 0;
    found.Store(lo, hi);
    for (int a = 0; a < 3; ++a) {
        middle[a] = lo[a] / 2 + hi[a] / 2;
        for (const float end : {hi[a] - middle[a], middle[a] - lo[a]}) half = end > half ? end : half;
    }
    const float scale = half > 0x1p-60f && half < 0x1p60f ? 32000 / half : 0;
    for (std::uint32_t p = 0; p < count; ++p)
        for (std::size_t i = 0; i < ShapePoints::size; i += hn::Lanes(d)) {
            V x[3];
            LoadPoints(positions, points[p], i, load, x);
            for (int a = 0; a < 3; ++a) {
                const V place = hn::Mul(hn::Sub(x[a], hn::Set(d, middle[a])), hn::Set(d, scale));
                hn::StoreU(hn::DemoteTo(d16, hn::NearestInt(place)), d16, points[p].place[a] + i);
            }
        }
    return scale;
}

float Place(const float* HWY_RESTRICT positions, bool holds_last_vertex, std::uint32_t count,
            ShapePoints* HWY_RESTRICT points) {
    return holds_last_vertex ? PlaceShape(positions, count, points, VertexLoader<true>())
                             : PlaceShape(positions, count, points, VertexLoader<false>());
}

// ---- tiles oriented ------------------------------------------------------------------------------------

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
// From tables in registers.
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
    const std::uint8_t* corners = tiles.corners.data() + std::size_t{t} * 4 * tile_size;
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

constexpr float nothing_known = float_infinity; // of a change
constexpr std::uint32_t pause = 32;             // steps

// A symmetric matrix with entries {xx, yy, zz, xy, yz, zx}, known up to roundings of doubles.
using Symmetric = std::array<double, 6>;

// Of c - l: two leading minors, the determinant, and the sum of all three minors of two rows.
std::array<double, 4> minors(const Symmetric& c, double l) noexcept {
    const double x = c[0] - l, y = c[1] - l, z = c[2] - l;
    const double xy = x * y - c[3] * c[3], yz = y * z - c[4] * c[4], zx = z * x - c[5] * c[5];
    return {x, xy, x * yz - c[3] * (c[3] * z - c[4] * c[5]) + c[5] * (c[3] * c[4] - y * c[5]), xy + yz + zx};
}

// Whether all eigenvalues are certainly above `l`: the leading minors of c - l are positive, by far more than
// their errors of a few 2^-53 of a power of the trace.
bool is_above(const Symmetric& c, double l) noexcept {
    const double trace = c[0] + c[1] + c[2];
    const auto m = minors(c, l);
    return m[0] > 0x1p-40 * trace && m[1] > 0x1p-40 * trace * trace && m[2] > 0x1p-40 * trace * trace * trace;
}

// A lower bound on the eigenvalues by Gershgorin's circles; not above 0 where they say nothing.
double gershgorin(const Symmetric& c) noexcept {
    const double xy = std::abs(c[3]), yz = std::abs(c[4]), zx = std::abs(c[5]);
    return std::min({c[0] - xy - zx, c[1] - xy - yz, c[2] - yz - zx});
}

// A better one, for the eigenvalues of matrices far from diagonal: Newton's iteration on the characteristic
// polynomial ascends from any lower bound to the least of them.
double ascend(const Symmetric& c, double least) noexcept {
    least = std::max(least, 0.0);
    for (int i = 0; i < 4; ++i) {
        const auto m = minors(c, least);
        if (!(m[2] > 0 && m[3] > 0)) break;
        least += m[2] / m[3];
    }
    return least;
}

// What slack tets must have had to be certainly positive. Where that is less than `enough`, how much less
// does not matter. Roundings of the rest: with S the sum of the magnitudes of the three products and R the
// largest of the rest, the coordinate less that of the middle and the differences are below S + R, and each
// collects a relative error u; so the rest is off by at most 8 u (S + R), and a side of its box by twice
// that. Underflow takes away less than what is added.
float change_of(const Motion& motion, float rounding, float enough) noexcept {
    constexpr float most = 0x1p60f; // below, nothing overflows
    double square = 0, f[3][3];
    Symmetric c{}; // its eigenvalues are the squares of the map's singular values
    for (int a = 0; a < 3; ++a) {
        const float largest = std::max({-motion.box.lo[a], motion.box.hi[a], std::abs(motion.column[3][a])});
        if (!(largest < most)) return nothing_known;
        double reach = 0;
        for (int k = 0; k < 3; ++k) {
            f[k][a] = motion.column[k][a];
            reach += std::abs(f[k][a]) * 0x1p15;
        }
        if (!(reach < most)) return nothing_known;
        reach += std::max(-motion.lo[a], motion.hi[a]);
        const double side = double{motion.hi[a]} - motion.lo[a] + reach * 0x1p-20 + 0x1p-80;
        square += side * side;
    }
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t a = 0; a < 3; ++a) {
            c[k] += f[k][a] * f[k][a];
            c[3 + k] += f[k][a] * f[(k + 1) % 3][a];
        }
    const double determinant = f[0][0] * (f[1][1] * f[2][2] - f[1][2] * f[2][1]) +
                               f[0][1] * (f[1][2] * f[2][0] - f[1][0] * f[2][2]) +
                               f[0][2] * (f[1][0] * f[2][1] - f[1][1] * f[2][0]);
    if (!(determinant > 0)) return nothing_known;
    const double diagonal = std::sqrt(square) + rounding;
    const auto change = [&](double least) { // infinite unless the eigenvalues are certainly above this
        least -= 0x1p-12 * (c[0] + c[1] + c[2]);
        return least > 0 && is_above(c, least)
                   ? static_cast<float>(diagonal / std::sqrt(least) * (1 + 0x1p-20))
                   : nothing_known;
    };
    const double first = gershgorin(c);
    const float by_circles = change(first);
    return by_circles < enough ? by_circles : std::min(by_circles, change(ascend(c, first)));
}

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
    const auto follow = VOX_SIMD_DISPATCH(Follow);
    for (std::uint32_t s = first; s < last; ++s) {
        change[s] = nothing_known;
        positive[s] = 0;
        if (!cache.is_used || !cache.shapes[s].is_known) {
            super_boxes[s] = box_of(tiles.blocks[s], blocks);
            continue;
        }
        const Shape& shape = cache.shapes[s];
        Motion motion;
        follow(positions, shape, cache.points.data() + shape.first, motion);
        super_boxes[s] = motion.box;
        change[s] = change_of(motion, rounding, shape.least_slack);
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

// Lists the vertices of super-tiles, each once.
class ShapeLister {
public:
    ShapeLister(const Tiles& tiles, const float* positions, std::uint32_t vertex_count,
                OrientationCache& cache)
        : tiles_(tiles), positions_(positions), vertex_count_(vertex_count), cache_(cache),
          seen_(cache.points.get_allocator().resource()), list_(cache.points.get_allocator().resource()) {}

    void list(std::uint32_t super) {
        find_vertices(super);
        put_samples_first();
        Shape& shape = cache_.shapes[super];
        shape.first = static_cast<std::uint32_t>(cache_.points.size());
        shape.count = static_cast<std::uint32_t>((list_.size() + ShapePoints::size - 1) / ShapePoints::size);
        shape.holds_last_vertex = std::find(list_.begin(), list_.end(), vertex_count_ - 1) != list_.end();
        cache_.points.resize(cache_.points.size() + shape.count);
        for (std::size_t i = 0; i < std::size_t{shape.count} * ShapePoints::size; ++i)
            cache_.points[shape.first + i / ShapePoints::size].vertex[i % ShapePoints::size] =
                list_[std::min(i, list_.size() - 1)];
    }

private:
    // A table with open addressing, at most half full.
    void find_vertices(std::uint32_t super) {
        std::size_t most = 0;
        const std::uint32_t first = tiles_.super_first[super], last = tiles_.super_first[super + 1];
        for (std::uint32_t t = first; t < last; ++t) most += tiles_.tiles[t].vertex_count;
        const std::size_t size = std::bit_ceil(2 * most);
        seen_.assign(size, none);
        list_.clear();
        for (std::uint32_t t = first; t < last; ++t)
            for (std::uint32_t i = 0; i < tiles_.tiles[t].vertex_count; ++i) {
                const std::uint32_t v = tiles_.vertices[tiles_.tiles[t].first_vertex + i];
                std::size_t at = v * std::size_t{2654435761u} >> 8 & (size - 1);
                while (seen_[at] != none && seen_[at] != v) at = (at + 1) & (size - 1);
                if (seen_[at] == v) continue;
                seen_[at] = v;
                list_.push_back(v);
            }
    }

    // The outermost vertices along the diagonals of space fit best.
    void put_samples_first() {
        std::size_t found[Shape::samples] = {};
        float most[Shape::samples];
        std::fill(std::begin(most), std::end(most), -float_infinity);
        for (std::size_t i = 0; i < list_.size(); ++i) {
            const float* p = positions_ + std::size_t{list_[i]} * 3;
            const float sums[4] = {p[0] + p[1] + p[2], p[0] + p[1] - p[2], p[0] - p[1] + p[2],
                                   p[0] - p[1] - p[2]};
            for (std::size_t k = 0; k < Shape::samples; ++k) {
                const float along = k < 4 ? sums[k] : -sums[k - 4];
                if (!(along > most[k])) continue;
                most[k] = along;
                found[k] = i;
            }
        }
        for (std::size_t k = 0; k < Shape::samples; ++k) list_.push_back(list_[found[k]]);
        std::rotate(list_.begin(), list_.end() - Shape::samples, list_.end());
    }

    static constexpr std::uint32_t none = ~0u;

    const Tiles& tiles_;
    const float* positions_;
    std::uint32_t vertex_count_;
    OrientationCache& cache_;
    std::pmr::vector<std::uint32_t> seen_, list_;
};

// The affine map that fits the samples best, in the sense of least squares (e.g. M. Mueller, B.
// Heidelberger, M. Teschner, M. Gross, Meshless deformations based on shape matching, SIGGRAPH 2005, Sect.
// 4.2): its columns as sums over the samples. Any other map would do as well, if not as far.
void weigh_samples(const ShapePoints& points, Shape& shape) noexcept {
    constexpr std::size_t n = Shape::samples;
    double mean[3] = {}, d[3][n], m[3][3] = {}, inverse[3][3];
    for (std::size_t a = 0; a < 3; ++a) {
        for (std::size_t i = 0; i < n; ++i) mean[a] += double{1} / n * points.place[a][i];
        for (std::size_t i = 0; i < n; ++i) d[a][i] = points.place[a][i] - mean[a];
    }
    for (std::size_t a = 0; a < 3; ++a)
        for (std::size_t b = 0; b < 3; ++b)
            for (std::size_t i = 0; i < n; ++i) m[a][b] += d[a][i] * d[b][i];
    for (std::size_t a = 0; a < 3; ++a)
        for (std::size_t b = 0; b < 3; ++b) {
            const std::size_t a1 = (a + 1) % 3, a2 = (a + 2) % 3, b1 = (b + 1) % 3, b2 = (b + 2) % 3;
            inverse[a][b] = m[a1][b1] * m[a2][b2] - m[a1][b2] * m[a2][b1];
        }
    const double determinant = m[0][0] * inverse[0][0] + m[0][1] * inverse[0][1] + m[0][2] * inverse[0][2];
    const double scale = determinant > 0 ? 1 / determinant : 0; // 0: they lie in a plane, and the map too
    for (std::size_t i = 0; i < n; ++i) {
        double of_middle = double{1} / n;
        for (std::size_t k = 0; k < 3; ++k) {
            const double weight =
                (inverse[k][0] * d[0][i] + inverse[k][1] * d[1][i] + inverse[k][2] * d[2][i]) * scale;
            shape.weight[k][i] = static_cast<float>(weight);
            of_middle -= weight * mean[k];
        }
        shape.weight[3][i] = static_cast<float>(of_middle);
    }
}

// Tets of a super-tile are measured where they are; on the lattice they are at most 0.51 of its units off
// along each axis, so widths 1.77.
void measure(const OrientedBody& body, std::uint32_t super, OrientationCache& cache, std::uint64_t* bad) {
    Shape& shape = cache.shapes[super];
    ShapePoints* points = cache.points.data() + shape.first;
    const float scale =
        VOX_SIMD_DISPATCH(Place)(body.positions, shape.holds_last_vertex, shape.count, points);
    weigh_samples(*points, shape);
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

// Whether a super-tile is to be measured. Tiles with tets far flatter than the others would soon fail again.
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
    for (std::uint32_t s = 0; s < supers; ++s) {
        Shape& shape = cache.shapes[s];
        shape.is_due = wants_reference(body, s, cache);
        if (!shape.is_due || shape.count > 0) continue;
        if (!lister) lister.emplace(body.tiles, body.positions, body.vertex_count, cache);
        lister->list(s);
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
    if (workers)
        workers->for_ranges(supers, task_supers, part);
    else
        part(0, supers, 0);
}

} // namespace vox::fast
#endif
