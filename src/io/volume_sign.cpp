// Filter: J. R. Shewchuk, "Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric
// Predicates", Discrete & Computational Geometry 18, 1997, bound A of orient3d. If the filter cannot decide,
// the determinant is computed in integers: every double is an integer times a power of two, and a common
// power of two does not change the sign.
#include "io/volume_sign.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace vox::io {
namespace {

// A signed integer of at most 6400 bits: differences of doubles over the smallest denormal have 2099 bits,
// products of three of them 6297, and six of those are added.
struct Integer {
    std::uint32_t limbs[200];
    int size = 0; // without leading zeros; 0 is zero
    bool negative = false;

    Integer() = default; // limbs above size stay uninitialised on purpose
    Integer(const Integer& other) { *this = other; }
    Integer& operator=(const Integer& other) {
        if (this == &other) return *this;
        size = other.size;
        negative = other.negative;
        std::memcpy(limbs, other.limbs, static_cast<std::size_t>(size) * sizeof *limbs);
        return *this;
    }

    // Stores value * 2^-exponent, which must be an integer.
    Integer(double value, int exponent) : negative(value < 0) {
        if (value == 0) return;
        int e;
        const auto mantissa = static_cast<std::uint64_t>(std::ldexp(std::frexp(std::fabs(value), &e), 53));
        int shift = e - 53 - exponent; // mantissa * 2^shift
        std::uint64_t m = mantissa;
        if (shift < 0) {
            m >>= -shift; // the bits shifted out are zero
            shift = 0;
        }
        const int word = shift / 32, bit = shift % 32;
        std::fill_n(limbs, word + 3, 0u);
        const std::uint64_t low = (m & 0xffffffffu) << bit, high = (m >> 32) << bit;
        limbs[word] = static_cast<std::uint32_t>(low);
        const std::uint64_t middle = (low >> 32) + (high & 0xffffffffu);
        limbs[word + 1] = static_cast<std::uint32_t>(middle);
        limbs[word + 2] = static_cast<std::uint32_t>((high >> 32) + (middle >> 32));
        size = word + 3;
        trim();
    }

    void trim() {
        while (size > 0 && limbs[size - 1] == 0) --size;
    }
};

int compare_magnitudes(const Integer& a, const Integer& b) {
    if (a.size != b.size) return a.size < b.size ? -1 : 1;
    for (int i = a.size - 1; i >= 0; --i)
        if (a.limbs[i] != b.limbs[i]) return a.limbs[i] < b.limbs[i] ? -1 : 1;
    return 0;
}

Integer sum(const Integer& a, const Integer& b, bool subtract) {
    const bool b_negative = b.negative != subtract;
    const bool a_larger = compare_magnitudes(a, b) >= 0;
    const Integer& large = a_larger ? a : b;
    const Integer& small = a_larger ? b : a;
    Integer out;
    out.negative = a_larger ? a.negative : b_negative;
    std::int64_t carry = 0;
    const std::int64_t sign = a.negative == b_negative ? 1 : -1;
    for (int i = 0; i < large.size; ++i) {
        const std::int64_t limb =
            static_cast<std::int64_t>(large.limbs[i]) + (i < small.size ? sign * small.limbs[i] : 0) + carry;
        out.limbs[i] = static_cast<std::uint32_t>(limb & 0xffffffff);
        carry = limb >> 32;
    }
    out.size = large.size;
    if (carry > 0) out.limbs[out.size++] = static_cast<std::uint32_t>(carry);
    out.trim();
    return out;
}

Integer product(const Integer& a, const Integer& b) {
    Integer out;
    out.negative = a.negative != b.negative;
    out.size = a.size + b.size;
    std::fill_n(out.limbs, out.size, 0u);
    for (int i = 0; i < a.size; ++i) {
        std::uint64_t carry = 0;
        for (int j = 0; j < b.size; ++j) {
            carry += static_cast<std::uint64_t>(a.limbs[i]) * b.limbs[j] + out.limbs[i + j];
            out.limbs[i + j] = static_cast<std::uint32_t>(carry);
            carry >>= 32;
        }
        out.limbs[i + b.size] = static_cast<std::uint32_t>(carry);
    }
    out.trim();
    return out;
}

// Exponent of the lowest bit that is set in `value`, which must not be zero.
int lowest_bit(double value) {
    int e;
    auto mantissa = static_cast<std::uint64_t>(std::ldexp(std::frexp(std::fabs(value), &e), 53));
    e -= 53;
    while (!(mantissa & 1)) {
        mantissa >>= 1;
        ++e;
    }
    return e;
}

int exact_sign(const double* const corners[4]) {
    int exponent = std::numeric_limits<int>::max();
    for (int i = 0; i < 4; ++i)
        for (int k = 0; k < 3; ++k)
            if (corners[i][k] != 0) exponent = std::min(exponent, lowest_bit(corners[i][k]));
    Integer m[3][3];
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
            m[i][k] = sum(Integer(corners[i + 1][k], exponent), Integer(corners[0][k], exponent), true);
    Integer det;
    for (int k = 0; k < 3; ++k) {
        const int k1 = (k + 1) % 3, k2 = (k + 2) % 3;
        const Integer minor = sum(product(m[1][k1], m[2][k2]), product(m[1][k2], m[2][k1]), true);
        det = sum(det, product(m[0][k], minor), false);
    }
    return det.size == 0 ? 0 : det.negative ? -1 : 1;
}

} // namespace

int volume_sign(const double* a, const double* b, const double* c, const double* d) {
    double u[3], v[3], w[3], largest = 0;
    for (int k = 0; k < 3; ++k) {
        u[k] = b[k] - a[k];
        v[k] = c[k] - a[k];
        w[k] = d[k] - a[k];
        largest = std::max({largest, std::fabs(u[k]), std::fabs(v[k]), std::fabs(w[k])});
    }
    double det = 0, permanent = 0;
    for (int k = 0; k < 3; ++k) {
        const int k1 = (k + 1) % 3, k2 = (k + 2) % 3;
        const double p = v[k1] * w[k2], q = v[k2] * w[k1];
        det += u[k] * (p - q);
        permanent += std::fabs(u[k]) * (std::fabs(p) + std::fabs(q));
    }
    // The bound holds if nothing overflows and all underflow is far below it.
    constexpr double epsilon = std::numeric_limits<double>::epsilon() / 2;
    constexpr double bound = (7 + 56 * epsilon) * epsilon;
    if (largest < 1e100 && permanent > 1e-150 && std::fabs(det) > bound * permanent) return det > 0 ? 1 : -1;
    const double* const corners[4] = {a, b, c, d};
    return exact_sign(corners);
}

} // namespace vox::io
