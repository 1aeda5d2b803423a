// Volumes of points whose coordinates are of similar size: exact in three words, without a loop.
//
// On each axis, coordinates are integers in units of 2^-60 of a power of two above the largest. For floats
// this holds if none but zero is below 2^-36 of the largest; for doubles if none is below 2^-7, or enough of
// its last bits are zero. The unit does not change the sign of a volume, a product of three coordinates, one
// an axis. With differences below 2^61, minors are at most 2^123.
#pragma once

#include "base/device.hpp"
#include "base/vectors.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#if defined(__SIZEOF_INT128__)
#define VOX_FIXED_POINT 1

namespace vox {

__extension__ using Int128 = __int128;

// high * 2^64 + low, for any low.
struct FixedVolume {
    Int128 high, low;

    VOX_HD int sign() const {
        const Int128 top = high + (low >> 64);
        if (top != 0) return top > 0 ? 1 : -1;
        return static_cast<std::uint64_t>(low) != 0 ? 1 : 0;
    }
};

template <std::size_t Count>
class FixedPoints {
public:
    // False if the coordinates differ too much in size; the points are unspecified then. Reads the bits of
    // the coordinates, so the floating-point environment does not matter.
    VOX_HD bool read(const std::array<const Vec3d*, Count>& points) {
        std::uint64_t lost = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            std::uint64_t bits[Count], largest = 1; // stored exponent, at least that of denormals
            for (std::size_t i = 0; i < Count; ++i) {
                bits[i] = std::bit_cast<std::uint64_t>(axis == 0   ? points[i]->x
                                                       : axis == 1 ? points[i]->y
                                                                   : points[i]->z);
                largest = std::max(largest, bits[i] >> 52 & 0x7ff);
            }
            for (std::size_t i = 0; i < Count; ++i) {
                const std::uint64_t exponent = bits[i] >> 52 & 0x7ff, normal = exponent != 0;
                const std::uint64_t mantissa = ((bits[i] & 0xfffffffffffff) | normal << 52) << 7;
                const std::uint64_t right = std::min<std::uint64_t>(largest - exponent - (normal ^ 1), 63);
                const std::uint64_t value = mantissa >> right, negative = bits[i] >> 63;
                lost |= value << right ^ mantissa;
                at_[i][axis] = static_cast<std::int64_t>((value ^ (0 - negative)) + negative);
            }
        }
        return lost == 0;
    }

    // det[b-a, c-a, d-a]
    VOX_HD FixedVolume volume(std::size_t a, std::size_t b, std::size_t c, std::size_t d) const {
        std::int64_t u[3], v[3], w[3];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            u[axis] = at_[b][axis] - at_[a][axis];
            v[axis] = at_[c][axis] - at_[a][axis];
            w[axis] = at_[d][axis] - at_[a][axis];
        }
        FixedVolume sum{0, 0}; // three terms: low stays below 3 * 2^125
        add(minor(v, w), u[2], sum);
        add(minor(w, u), v[2], sum);
        add(minor(u, v), w[2], sum);
        return sum;
    }

private:
    VOX_HD static Int128 minor(const std::int64_t* u, const std::int64_t* v) {
        return Int128{u[0]} * v[1] - Int128{v[0]} * u[1];
    }
    VOX_HD static void add(Int128 minor, std::int64_t factor, FixedVolume& sum) {
        sum.high += Int128{static_cast<std::int64_t>(minor >> 64)} * factor;
        sum.low += Int128{static_cast<std::uint64_t>(minor)} * factor;
    }

    std::int64_t at_[Count][3];
};

} // namespace vox
#endif
