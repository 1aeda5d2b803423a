// Axis-aligned boxes. The fast engine's have four floats a corner and fit two vector registers; those of the
// reference engine and of trees have three floats or doubles.
#pragma once

#include "base/scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace vox {

struct alignas(16) Box {
    float lo[4], hi[4]; // lo[3] and hi[3] are padding
};

inline constexpr float float_infinity = std::numeric_limits<float>::infinity();
inline constexpr Box empty_box{{float_infinity, float_infinity, float_infinity, float_infinity},
                               {-float_infinity, -float_infinity, -float_infinity, -float_infinity}};

inline void add(Box& a, const Box& b) noexcept {
    for (int i = 0; i < 4; ++i) a.lo[i] = b.lo[i] < a.lo[i] ? b.lo[i] : a.lo[i];
    for (int i = 0; i < 4; ++i) a.hi[i] = b.hi[i] > a.hi[i] ? b.hi[i] : a.hi[i];
}

inline void intersect(Box& a, const Box& b) noexcept {
    for (int i = 0; i < 4; ++i) a.lo[i] = b.lo[i] > a.lo[i] ? b.lo[i] : a.lo[i];
    for (int i = 0; i < 4; ++i) a.hi[i] = b.hi[i] < a.hi[i] ? b.hi[i] : a.hi[i];
}

inline bool is_empty(const Box& a) noexcept {
    return (a.lo[0] > a.hi[0]) | (a.lo[1] > a.hi[1]) | (a.lo[2] > a.hi[2]);
}

inline bool overlap(const Box& a, const Box& b) noexcept {
#if defined(__SSE2__)
    // Compilers do not turn the comparisons below into this.
    const __m128 apart = _mm_or_ps(_mm_cmpgt_ps(_mm_load_ps(a.lo), _mm_load_ps(b.hi)),
                                   _mm_cmpgt_ps(_mm_load_ps(b.lo), _mm_load_ps(a.hi)));
    return (_mm_movemask_ps(apart) & 7) == 0;
#else
    return !((a.lo[0] > b.hi[0]) | (a.lo[1] > b.hi[1]) | (a.lo[2] > b.hi[2]) | (b.lo[0] > a.hi[0]) |
             (b.lo[1] > a.hi[1]) | (b.lo[2] > a.hi[2]));
#endif
}

// True if all sides are finite.
inline bool has_ends(const Box& a) noexcept {
    bool all = true;
    for (int i = 0; i < 3; ++i) all &= std::isfinite(a.lo[i]) && std::isfinite(a.hi[i]);
    return all;
}

inline bool contains(const Box& outer, const Box& inner) noexcept {
    return (inner.lo[0] >= outer.lo[0]) & (inner.lo[1] >= outer.lo[1]) & (inner.lo[2] >= outer.lo[2]) &
           (inner.hi[0] <= outer.hi[0]) & (inner.hi[1] <= outer.hi[1]) & (inner.hi[2] <= outer.hi[2]);
}

// The sides of `region` beyond which a whole box lies. Bits 0 to 2 are set if it is above hi[0], hi[1] and
// hi[2] of the region, bits 4 to 6 if it is below lo[0], lo[1] and lo[2]; no bit is set if the two overlap.
// Boxes with a common bit are all on that side.
inline unsigned sides_of(const Box& box, const Box& region) noexcept {
#if defined(__SSE2__)
    const int above = _mm_movemask_ps(_mm_cmpgt_ps(_mm_load_ps(box.lo), _mm_load_ps(region.hi))) & 7;
    const int below = _mm_movemask_ps(_mm_cmpgt_ps(_mm_load_ps(region.lo), _mm_load_ps(box.hi))) & 7;
    return static_cast<unsigned>(above | below << 4);
#else
    unsigned sides = 0;
    for (unsigned a = 0; a < 3; ++a)
        sides |= unsigned{box.lo[a] > region.hi[a]} << a | unsigned{region.lo[a] > box.hi[a]} << (a + 4);
    return sides;
#endif
}
inline constexpr unsigned all_sides = 0x77;

// ---- boxes of three numbers a corner ----------------------------------------------------------------

inline Box3f empty_box3f() noexcept {
    return {{float_infinity, float_infinity, float_infinity},
            {-float_infinity, -float_infinity, -float_infinity}};
}

template <class AnyBox>
void extend(AnyBox& box, const AnyBox& by) noexcept {
    box.min = {std::min(box.min.x, by.min.x), std::min(box.min.y, by.min.y), std::min(box.min.z, by.min.z)};
    box.max = {std::max(box.max.x, by.max.x), std::max(box.max.y, by.max.y), std::max(box.max.z, by.max.z)};
}

inline bool overlap(const Box3f& a, const Box3f& b) noexcept {
    return (a.min.x <= b.max.x) & (a.min.y <= b.max.y) & (a.min.z <= b.max.z) & (b.min.x <= a.max.x) &
           (b.min.y <= a.max.y) & (b.min.z <= a.max.z);
}

inline bool is_empty(const Box3f& box) noexcept { return box.min.x > box.max.x; }

inline void extend(Box3f& box, const Vec3f& p) noexcept {
    box.min = {std::min(box.min.x, p.x), std::min(box.min.y, p.y), std::min(box.min.z, p.z)};
    box.max = {std::max(box.max.x, p.x), std::max(box.max.y, p.y), std::max(box.max.z, p.z)};
}

// A lower bound of the squared distance from p to a box, infinite for an empty box. It is a few roundings too
// small, so that the distance computed to a point in the box is always greater.
template <class AnyBox>
double squared_distance_bound(const Vec3d& p, const AnyBox& box) noexcept {
    constexpr double slack = 1 - 0x1p-48;
    const auto outside = [](double x, double min, double max) { return std::max({min - x, x - max, 0.0}); };
    const double x = outside(p.x, box.min.x, box.max.x), y = outside(p.y, box.min.y, box.max.y),
                 z = outside(p.z, box.min.z, box.max.z);
    return (x * x + y * y + z * z) * slack;
}

template <class Point>
bool contains(const Box3f& box, const Point& p) noexcept {
    // No &&: most vertices fail one of the six comparisons at random, and one branch is cheaper than six.
    return bool(int(p.x >= box.min.x) & int(p.x <= box.max.x) & int(p.y >= box.min.y) &
                int(p.y <= box.max.y) & int(p.z >= box.min.z) & int(p.z <= box.max.z));
}

} // namespace vox
