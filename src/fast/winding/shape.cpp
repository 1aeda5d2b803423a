#include "fast/winding/shape.hpp"
#include "base/simd.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#undef VOX_SOURCE
#define VOX_SOURCE "fast/winding/shape.cpp"
#include "base/each_target.hpp"

#include "fast/tile-inl.hpp"

#ifndef VOX_FAST_SHAPE_ONCE
#define VOX_FAST_SHAPE_ONCE
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

} // namespace HWY_NAMESPACE
} // namespace vox::fast
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vox::fast {

namespace {

// A symmetric matrix with entries {xx, yy, zz, xy, yz, zx}, known up to roundings of doubles.
using Symmetric = std::array<double, 6>;

// Two leading minors of c - l, its determinant, and the sum of all three minors of two rows.
std::array<double, 4> minors(const Symmetric& c, double l) noexcept {
    const double x = c[0] - l, y = c[1] - l, z = c[2] - l;
    const double xy = x * y - c[3] * c[3], yz = y * z - c[4] * c[4], zx = z * x - c[5] * c[5];
    return {x, xy, x * yz - c[3] * (c[3] * z - c[4] * c[5]) + c[5] * (c[3] * c[4] - y * c[5]), xy + yz + zx};
}

// True if all eigenvalues are certainly above `l`: the leading minors of c - l are positive, by far more than
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

} // namespace

float follow(const float* positions, const Shape& shape, const ShapePoints* points, float rounding,
             float enough, Box& box) noexcept {
    Motion motion;
    VOX_SIMD_DISPATCH(Follow)(positions, shape, points, motion);
    box = motion.box;
    return change_of(motion, rounding, enough);
}

// ---- reference steps -----------------------------------------------------------------------------------

namespace {

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

} // namespace

float place(const float* positions, Shape& shape, ShapePoints* points) noexcept {
    const float scale = VOX_SIMD_DISPATCH(Place)(positions, shape.holds_last_vertex, shape.count, points);
    weigh_samples(*points, shape);
    return scale;
}

void ShapeLister::list(std::uint32_t super_tile, Shape& shape, Array<ShapePoints>& points) {
    find_vertices(super_tile);
    put_samples_first();
    shape.first = static_cast<std::uint32_t>(points.size());
    shape.count = static_cast<std::uint32_t>((list_.size() + ShapePoints::size - 1) / ShapePoints::size);
    shape.holds_last_vertex = std::find(list_.begin(), list_.end(), vertex_count_ - 1) != list_.end();
    points.resize(points.size() + shape.count);
    for (std::size_t i = 0; i < std::size_t{shape.count} * ShapePoints::size; ++i)
        points[shape.first + i / ShapePoints::size].vertex[i % ShapePoints::size] =
            list_[std::min(i, list_.size() - 1)];
}

// By a table with open addressing, at most half full.
void ShapeLister::find_vertices(std::uint32_t super_tile) {
    constexpr std::uint32_t none = ~0u;
    std::size_t most = 0;
    const std::uint32_t first = tiles_.super_first[super_tile], last = tiles_.super_first[super_tile + 1];
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
void ShapeLister::put_samples_first() {
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

} // namespace vox::fast
#endif
