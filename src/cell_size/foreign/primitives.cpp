#include "cell_size/foreign/primitives.hpp"

#include "base/sampling.hpp"
#include "base/structs.hpp"
#include "mesh/check.hpp"

#include <algorithm>
#include <cinttypes>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace vox {

namespace {

constexpr int corners_of_type[] = {1, 2, 3, 4, 2};

void check_length(double value, const char* where, const char* name) {
    if (!(value >= 0) || !std::isfinite(value))
        refuse(format("%s%s is %.9g, expected 0 or a length", where, name, value));
}

// A stride of 0 means tightly packed.
std::size_t checked_stride(std::uint64_t stride, std::uint64_t size, std::uint64_t count, const char* where,
                           const char* name) {
    if (stride == 0) stride = size;
    if (stride < size)
        refuse(format("%s%s is %" PRIu64 ", expected 0 or at least %" PRIu64 " bytes", where, name, stride,
                      size));
    constexpr std::uint64_t most_bytes = std::numeric_limits<std::ptrdiff_t>::max();
    if (stride > most_bytes / count)
        refuse(
            format("%s%s is %" PRIu64 ", too large for %" PRIu64 " primitives", where, name, stride, count));
    return static_cast<std::size_t>(stride);
}

} // namespace

Primitives::Primitives(const vox_primitives& desc, const char* where) : where_(where) {
    check_enum(desc.type, VOX_PRIMITIVE_BOX, format("%stype", where).c_str());
    check_enum(desc.radius_format, VOX_FORMAT_DOUBLE, format("%sradius_format", where).c_str());
    if (desc.count == 0) refuse(format("%scount is 0, expected at least one primitive", where));
    if (desc.count > std::numeric_limits<std::uint32_t>::max())
        throw Error(VOX_ERROR_LIMIT,
                    format("%scount is %" PRIu64 ", the limit is 2^32 - 1", where, desc.count));
    count_ = desc.count;
    corners_ = corners_of_type[enum_value(desc.type)];
    is_box_ = enum_value(desc.type) == VOX_PRIMITIVE_BOX;
    if (desc.reserved != 0) refuse(format("%sreserved is %" PRIu32 ", expected 0", where, desc.reserved));
    vertex_count_ = desc.positions.count;
    if (!desc.positions.data) refuse(format("%spositions.data is null", where));
    positions_ = check_positions(desc.positions, format("%spositions", where).c_str());
    indices_ = reinterpret_cast<const std::byte*>(desc.indices);
    const auto corners = static_cast<std::uint64_t>(corners_);
    index_stride_ = checked_stride(desc.index_byte_stride, corners * sizeof(std::uint32_t), count_, where,
                                   "index_byte_stride");
    if (!indices_ && vertex_count_ / corners < count_)
        throw Error(VOX_ERROR_INVALID_MESH, format("%s%" PRIu64 " primitives of %" PRIu64
                                                   " vertices each, but positions.count is %" PRIu64,
                                                   where, count_, corners, vertex_count_));
    radii_ = static_cast<const std::byte*>(desc.radii);
    double_radii_ = enum_value(desc.radius_format) == VOX_FORMAT_DOUBLE;
    radius_stride_ = checked_stride(desc.radius_byte_stride, double_radii_ ? sizeof(double) : sizeof(float),
                                    count_, where, "radius_byte_stride");
    check_length(desc.radius, where, "radius");
    radius_ = desc.radius;
}

std::uint64_t Primitives::vertex(std::uint64_t primitive, int corner) const noexcept {
    if (!indices_)
        return primitive * static_cast<std::uint64_t>(corners_) + static_cast<std::uint64_t>(corner);
    std::uint32_t index;
    std::memcpy(&index,
                indices_ + primitive * index_stride_ + static_cast<std::size_t>(corner) * sizeof index,
                sizeof index);
    return index;
}

double Primitives::radius(std::uint64_t primitive) const {
    if (!radii_) return radius_;
    double own;
    const std::byte* from = radii_ + primitive * radius_stride_;
    if (double_radii_) {
        std::memcpy(&own, from, sizeof own);
    } else {
        float single;
        std::memcpy(&single, from, sizeof single);
        own = double{single};
    }
    if (!std::isfinite(own))
        throw Error(VOX_ERROR_NON_FINITE,
                    format("%sradius %" PRIu64 " is %g, not finite", where_, primitive, own));
    if (own < 0) refuse(format("%sradius %" PRIu64 " is %g, expected 0 or a length", where_, primitive, own));
    return own + radius_;
}

void Primitives::refuse_position(std::uint64_t primitive, std::uint64_t v) const {
    const Vec3d p = positions_.exact(static_cast<std::size_t>(v));
    const bool finite = std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
    throw Error(finite ? VOX_ERROR_LIMIT : VOX_ERROR_NON_FINITE,
                format("%sprimitive %" PRIu64 " has vertex %" PRIu64 " at (%g, %g, %g), %s", where_,
                       primitive, v, p.x, p.y, p.z, finite ? "too large for a float" : "not finite"));
}

Vec3d Primitives::corner(std::uint64_t primitive, int corner) const {
    return positions_.exact(static_cast<std::size_t>(vertex(primitive, corner)));
}

PlainBox Primitives::box(std::uint64_t primitive) const {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    // Less than any double that rounds to an infinite float, NaN included.
    constexpr double most = 3.4028235677973362e38;
    PlainBox box{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
    for (int c = 0; c < corners_; ++c) {
        const std::uint64_t v = vertex(primitive, c);
        if (v >= vertex_count_)
            throw Error(VOX_ERROR_INVALID_MESH,
                        format("%sprimitive %" PRIu64 " names vertex %" PRIu64 " of %" PRIu64, where_,
                               primitive, v, vertex_count_));
        const Vec3d p = positions_.exact(static_cast<std::size_t>(v));
        if (!(std::abs(p.x) < most && std::abs(p.y) < most && std::abs(p.z) < most))
            refuse_position(primitive, v);
        box.include({{p.x, p.y, p.z}, {p.x, p.y, p.z}});
    }
    return box;
}

// ---- single precision -----------------------------------------------------------------------------

namespace {

// Four floats, the last of which is of no use. Compilers do not make vectors of plain loops over them.
#if defined(__SSE2__)
struct Four {
    __m128 at;
    static Four read(const std::byte* from) noexcept {
        return {_mm_loadu_ps(reinterpret_cast<const float*>(from))};
    }
    void write(float (&to)[4]) const noexcept { _mm_storeu_ps(to, at); }
};
Four least_of(Four a, Four b) noexcept { return {_mm_min_ps(a.at, b.at)}; }
Four most_of(Four a, Four b) noexcept { return {_mm_max_ps(a.at, b.at)}; }
Four sum_of(Four a, Four b) noexcept { return {_mm_add_ps(a.at, b.at)}; }
Four difference(Four a, Four b) noexcept { return {_mm_sub_ps(a.at, b.at)}; }
Four product(Four a, Four b) noexcept { return {_mm_mul_ps(a.at, b.at)}; }
Four all_equal(float value) noexcept { return {_mm_set1_ps(value)}; }
#else
struct Four {
    float at[4];
    static Four read(const std::byte* from) noexcept {
        Four f;
        std::memcpy(f.at, from, sizeof f.at);
        return f;
    }
    void write(float (&to)[4]) const noexcept { std::memcpy(to, at, sizeof at); }
};
template <class Operation>
Four each_of(const Four& a, const Four& b, Operation operation) noexcept {
    Four r;
    for (int i = 0; i < 4; ++i) r.at[i] = operation(a.at[i], b.at[i]);
    return r;
}
Four least_of(Four a, Four b) noexcept {
    return each_of(a, b, [](float x, float y) { return x < y ? x : y; });
}
Four most_of(Four a, Four b) noexcept {
    return each_of(a, b, [](float x, float y) { return x > y ? x : y; });
}
Four sum_of(Four a, Four b) noexcept {
    return each_of(a, b, [](float x, float y) { return x + y; });
}
Four difference(Four a, Four b) noexcept {
    return each_of(a, b, [](float x, float y) { return x - y; });
}
Four product(Four a, Four b) noexcept {
    return each_of(a, b, [](float x, float y) { return x * y; });
}
Four all_equal(float value) noexcept { return {{value, value, value, value}}; }
#endif

} // namespace

// Primitives whose positions are floats one after the other: a box is a few vectors.
struct PackedPrimitives {
    explicit PackedPrimitives(const Primitives& from)
        : all(from), data(from.positions_.data), indexed(from.indices_), stride(from.positions_.byte_stride),
          index_stride(from.index_stride_), safe(std::max<std::uint64_t>(from.vertex_count_, 1) - 1) {}

    static bool fits(const Primitives& p) noexcept {
        return !p.positions_.doubles && p.positions_.component_gap == 0;
    }

    // Its box, by reading four floats at a time, one of them of the next position, and the sum of its
    // coordinates times 0, which is not 0 where one is not finite. False where there is none.
    template <int corners>
    bool corners_of(std::uint64_t primitive, Four& lo, Four& hi, Four& zero) const noexcept {
        std::uint64_t v[static_cast<std::size_t>(corners)], last = 0;
        for (int c = 0; c < corners; ++c) {
            v[c] = indexed ? index(primitive, c)
                           : primitive * std::uint64_t{corners} + static_cast<std::uint64_t>(c);
            last = std::max(last, v[c]);
        }
        if (last >= safe) return false;
        zero = all_equal(0);
        lo = all_equal(std::numeric_limits<float>::infinity());
        hi = all_equal(-std::numeric_limits<float>::infinity());
        for (int c = 0; c < corners; ++c) {
            const Four p = Four::read(data + v[c] * stride);
            zero = sum_of(zero, product(p, all_equal(0)));
            lo = least_of(lo, p);
            hi = most_of(hi, p);
        }
        return true;
    }

    // Any; throws as Primitives::box().
    template <int corners>
    void box(std::uint64_t primitive, Four& lo, Four& hi) const {
        Four zero;
        if (corners_of<corners>(primitive, lo, hi, zero) && is_zero(zero)) return;
        const PlainBox exact = all.box(primitive);
        float single[2][4]{};
        for (int a = 0; a < 3; ++a) {
            single[0][a] = static_cast<float>(exact.lo[a]);
            single[1][a] = static_cast<float>(exact.hi[a]);
        }
        lo = Four::read(reinterpret_cast<const std::byte*>(single[0]));
        hi = Four::read(reinterpret_cast<const std::byte*>(single[1]));
    }

    static bool is_zero(Four f) noexcept {
        float at[4];
        f.write(at);
        return at[0] + at[1] + at[2] == 0;
    }

    std::uint32_t index(std::uint64_t primitive, int corner) const noexcept {
        std::uint32_t i;
        std::memcpy(&i, indexed + primitive * index_stride + static_cast<std::size_t>(corner) * sizeof i,
                    sizeof i);
        return i;
    }

    const Primitives& all;
    const std::byte *data, *indexed; // the latter may be null
    std::size_t stride, index_stride;
    std::uint64_t safe; // vertices below are followed by another
};

namespace {

// Calls visit(a constant of that number).
template <class Visit>
void with_corners(int corners, Visit&& visit) {
    if (corners == 1) return visit(std::integral_constant<int, 1>());
    if (corners == 2) return visit(std::integral_constant<int, 2>());
    if (corners == 3) return visit(std::integral_constant<int, 3>());
    visit(std::integral_constant<int, 4>());
}

// Calls visit(index) for one place of each part of the list.
template <class Visit>
void for_random_places(std::uint64_t count, std::uint64_t wanted, std::uint64_t seed, Visit&& visit) {
    if (count <= wanted) {
        for (std::uint64_t i = 0; i < count; ++i) visit(i);
        return;
    }
    const double part = static_cast<double>(count) / static_cast<double>(wanted);
    for (std::uint64_t i = 0; i < wanted; ++i) {
        visit(std::min(static_cast<std::uint64_t>((static_cast<double>(i) + next_unit(seed)) * part),
                       count - 1));
    }
}

template <int corners>
double longest_packed(const PackedPrimitives& packed) {
    Four longest = all_equal(0);
    for (std::uint64_t i = 0; i < packed.all.count(); ++i) {
        Four lo, hi, zero;
        if (!packed.corners_of<corners>(i, lo, hi, zero)) packed.box<corners>(i, lo, hi);
        longest = most_of(difference(hi, lo), longest); // leaves out a side that is not a number
    }
    float side[4];
    longest.write(side);
    return std::max(std::max(double{side[0]}, double{side[1]}), double{side[2]});
}

} // namespace

double longest_side(const Primitives& primitives) {
    if (PackedPrimitives::fits(primitives) && !primitives.has_radii()) {
        const PackedPrimitives packed(primitives);
        double longest = 0;
        with_corners(primitives.corners(), [&](auto n) { longest = longest_packed<n()>(packed); });
        if (std::isfinite(longest)) return longest + 2 * primitives.common_radius();
    }
    double longest = 0;
    for (std::uint64_t i = 0; i < primitives.count(); ++i)
        longest = std::max(longest, primitives.box(i).longest_side() + 2 * primitives.radius(i));
    return longest;
}

void sample_boxes(const Primitives& primitives, double grown, std::uint64_t wanted, std::uint64_t seed,
                  SampleTree& sample) {
    sample.reserve(static_cast<std::size_t>(std::min(primitives.count(), wanted)));
    if (PackedPrimitives::fits(primitives) && !primitives.has_radii()) {
        const PackedPrimitives packed(primitives);
        const double radius = primitives.common_radius() + grown;
        with_corners(primitives.corners(), [&](auto n) {
            for_random_places(primitives.count(), wanted, seed, [&](std::uint64_t i) {
                Four lo, hi;
                packed.box<n()>(i, lo, hi);
                float low[4], high[4];
                lo.write(low);
                hi.write(high);
                PlainBox box{{double{low[0]}, double{low[1]}, double{low[2]}},
                             {double{high[0]}, double{high[1]}, double{high[2]}}};
                box.grow(radius);
                sample.add(box, i);
            });
        });
        return;
    }
    for_random_places(primitives.count(), wanted, seed, [&](std::uint64_t i) {
        PlainBox box = primitives.box(i);
        box.grow(primitives.radius(i) + grown);
        sample.add(box, i);
    });
}

} // namespace vox
