// The sign of a volume, exact for any coordinates, in registers alone: for the kernels of src/gpu. (The host
// keeps whole integers in memory, which is quicker: predicates.cpp.)
#pragma once

#include "base/device.hpp"
#include "exact/fixed_point.hpp"

#include <bit>
#include <cstdint>

namespace vox {

// |value| == mantissa * 2^(exponent - 1075)
struct BitsOfDouble {
    std::uint64_t mantissa;
    std::uint32_t exponent; // from 1 on
    bool negative;

    VOX_HD explicit BitsOfDouble(double value) {
        const auto bits = std::bit_cast<std::uint64_t>(value);
        const std::uint64_t biased = bits >> 52 & 0x7ff, normal = biased != 0;
        mantissa = (bits & 0xfffffffffffff) | normal << 52;
        exponent = static_cast<std::uint32_t>(biased + 1 - normal);
        negative = bits >> 63 != 0;
    }
};

#if defined(__SIZEOF_INT128__)

// 32 bits of the product of three mantissas, from bit `first` on, which may be negative.
VOX_HD std::uint32_t bits_of_product(std::uint64_t a, std::uint64_t b, std::uint64_t c, int first) {
    __extension__ using Wide = unsigned __int128;
    if (first <= -32 || first >= 160) return 0;
    const Wide ab = Wide{a} * b, low_part = Wide{static_cast<std::uint64_t>(ab)} * c;
    const Wide rest = Wide{static_cast<std::uint64_t>(ab >> 64)} * c + (low_part >> 64);
    const auto low = static_cast<std::uint64_t>(low_part), middle = static_cast<std::uint64_t>(rest),
               high = static_cast<std::uint64_t>(rest >> 64);
    if (first < 0) return static_cast<std::uint32_t>(low << -first);
    const Wide two = first < 64    ? Wide{middle} << 64 | low
                     : first < 128 ? Wide{high} << 64 | middle
                                   : Wide{high};
    return static_cast<std::uint32_t>(two >> (first & 63));
}

// det[b-a, c-a, d-a] is the determinant of four rows 1 x y z: the sum of 24 products of an x, a y and a z of
// three different points. Adds them up 32 bits at a time, the lowest first, and keeps the carry alone.
template <class At>
VOX_HD int sign_by_words(const At& at) {
    const auto x_of = [&](int i) { return BitsOfDouble(at(i).x); };
    const auto y_of = [&](int i) { return BitsOfDouble(at(i).y); };
    const auto z_of = [&](int i) { return BitsOfDouble(at(i).z); };
    int lowest = 3 * 2047, highest = 3; // of the sum of exponents of a product
    VOX_ROLLED for (int i = 0; i < 64; ++i) {
        const int sum =
            static_cast<int>(x_of(i & 3).exponent + y_of(i >> 2 & 3).exponent + z_of(i >> 4).exponent);
        lowest = sum < lowest ? sum : lowest;
        highest = sum > highest ? sum : highest;
    }
    const int words = (highest - lowest + 159 + 5) / 32 + 1;
    std::int64_t carry = 0;
    std::uint32_t any = 0;
    VOX_ROLLED for (int word = 0; word < words; ++word) {
        VOX_ROLLED for (int i = 0; i < 64; ++i) { // x of point i & 3, y of point i / 4 & 3, z of point i / 16
            const int of_x = i & 3, of_y = i >> 2 & 3, of_z = i >> 4;
            if (of_x == of_y || of_y == of_z || of_z == of_x) continue;
            // Inversions of the permutation: the point left out, then these.
            const int out = 6 - of_x - of_y - of_z;
            const int inversions =
                (out > of_x) + (out > of_y) + (out > of_z) + (of_x > of_y) + (of_x > of_z) + (of_y > of_z);
            const BitsOfDouble x = x_of(of_x), y = y_of(of_y), z = z_of(of_z);
            const int shift = static_cast<int>(x.exponent + y.exponent + z.exponent) - lowest;
            const std::int64_t bits = bits_of_product(x.mantissa, y.mantissa, z.mantissa, 32 * word - shift);
            carry += ((inversions & 1) != 0) != (x.negative != (y.negative != z.negative)) ? -bits : bits;
        }
        any |= static_cast<std::uint32_t>(carry);
        carry >>= 32; // rounds down
    }
    return carry < 0 ? -1 : (carry != 0 || any != 0) ? 1 : 0;
}

// det[b-a, c-a, d-a] of the points at(0) to at(3), which it may ask for more than once.
template <class At>
VOX_HD int sign_of_volume(const At& at) {
    const Vec3d a = at(0), b = at(1), c = at(2), d = at(3);
    FixedPoints<4> fixed;
    if (fixed.read({&a, &b, &c, &d})) return fixed.volume(0, 1, 2, 3).sign();
    return sign_by_words(at);
}

#endif

} // namespace vox
