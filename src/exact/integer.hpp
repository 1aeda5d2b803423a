// Integers of as many words as they need (D. E. Knuth, The Art of Computer Programming 2, 1997, Sect. 4.3.1),
// and doubles as such. Words are 32 bits, the least significant one first.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vox {

// Room for volumes. Doubles are multiples of 2^-1074 below 2^1024, so a difference takes 66 words, a product
// of three 198, and a sum of six of these no more than 199.
class VolumeWords {
public:
    void make_room(int) noexcept {}
    std::uint32_t* data() noexcept { return at_; }
    const std::uint32_t* data() const noexcept { return at_; }

private:
    std::uint32_t at_[199];
};

// Room for anything, on the heap if it is much. Making room loses the content.
class AnyWords {
public:
    void make_room(int words) {
        if (words > few && static_cast<std::size_t>(words) > more_.size())
            more_.resize(static_cast<std::size_t>(words));
    }
    std::uint32_t* data() noexcept { return more_.empty() ? at_ : more_.data(); }
    const std::uint32_t* data() const noexcept { return more_.empty() ? at_ : more_.data(); }

private:
    static constexpr int few = 24;
    std::uint32_t at_[few];
    std::vector<std::uint32_t> more_;
};

// Sign and magnitude.
template <class Words>
struct IntegerIn {
    int size = 0; // the top word is not zero
    bool negative = false;
    Words words;

    std::uint32_t* word() noexcept { return words.data(); }
    const std::uint32_t* word() const noexcept { return words.data(); }
    int sign() const noexcept { return size == 0 ? 0 : negative ? -1 : 1; }
    int bits() const noexcept { return size == 0 ? 0 : 32 * size - std::countl_zero(word()[size - 1]); }
    void trim() noexcept {
        while (size > 0 && word()[size - 1] == 0) --size;
    }
};

template <class Words>
bool smaller_magnitude(const IntegerIn<Words>& a, const IntegerIn<Words>& b) {
    if (a.size != b.size) return a.size < b.size;
    for (int i = a.size; i-- > 0;)
        if (a.word()[i] != b.word()[i]) return a.word()[i] < b.word()[i];
    return false;
}

template <class Words>
void add_magnitudes(const IntegerIn<Words>& longer, const IntegerIn<Words>& shorter, IntegerIn<Words>& out) {
    out.words.make_room(longer.size + 1);
    const std::uint32_t *const a = longer.word(), *const b = shorter.word();
    std::uint32_t* const sum = out.word();
    std::uint64_t carry = 0;
    for (int i = 0; i < longer.size; ++i, carry >>= 32) {
        carry += std::uint64_t{a[i]} + (i < shorter.size ? b[i] : 0);
        sum[i] = static_cast<std::uint32_t>(carry);
    }
    out.size = longer.size;
    if (carry) sum[out.size++] = static_cast<std::uint32_t>(carry);
}

// `out` may be the larger one.
template <class Words>
void subtract_magnitudes(const IntegerIn<Words>& larger, const IntegerIn<Words>& smaller,
                         IntegerIn<Words>& out) {
    if (&out != &larger) out.words.make_room(larger.size);
    const std::uint32_t *const a = larger.word(), *const b = smaller.word();
    std::uint32_t* const rest = out.word();
    std::uint64_t borrow = 0;
    for (int i = 0; i < larger.size; ++i) {
        const std::uint64_t difference = std::uint64_t{a[i]} - (i < smaller.size ? b[i] : 0) - borrow;
        rest[i] = static_cast<std::uint32_t>(difference);
        borrow = difference >> 63;
    }
    out.size = larger.size;
    out.trim();
}

template <class Words>
IntegerIn<Words> sum(const IntegerIn<Words>& a, const IntegerIn<Words>& b, bool b_negative) {
    IntegerIn<Words> result;
    const bool swap = smaller_magnitude(a, b);
    const IntegerIn<Words>&larger = swap ? b : a, &smaller = swap ? a : b;
    if (a.negative == b_negative)
        add_magnitudes(larger, smaller, result);
    else
        subtract_magnitudes(larger, smaller, result);
    result.negative = swap ? b_negative : a.negative;
    return result;
}

template <class Words>
IntegerIn<Words> operator+(const IntegerIn<Words>& a, const IntegerIn<Words>& b) {
    return sum(a, b, b.negative);
}
template <class Words>
IntegerIn<Words> operator-(const IntegerIn<Words>& a, const IntegerIn<Words>& b) {
    return sum(a, b, !b.negative);
}

template <class Words>
IntegerIn<Words> operator*(const IntegerIn<Words>& a, const IntegerIn<Words>& b) {
    IntegerIn<Words> result;
    if (a.size == 0 || b.size == 0) return result;
    result.negative = a.negative != b.negative;
    result.size = a.size + b.size;
    result.words.make_room(result.size);
    const std::uint32_t *const of_a = a.word(), *const of_b = b.word();
    std::uint32_t* const product = result.word();
    std::fill_n(product, b.size, 0u);
    for (int i = 0; i < a.size; ++i) {
        std::uint64_t carry = 0;
        for (int j = 0; j < b.size && of_a[i] != 0; ++j, carry >>= 32) { // many are, of different magnitudes
            carry += std::uint64_t{of_a[i]} * of_b[j] + product[i + j];
            product[i + j] = static_cast<std::uint32_t>(carry);
        }
        product[i + b.size] = static_cast<std::uint32_t>(carry);
    }
    result.trim();
    return result;
}

template <class Words>
IntegerIn<Words> shifted_left(const IntegerIn<Words>& i, int bits) {
    IntegerIn<Words> result;
    const int words = bits / 32, rest = bits % 32;
    result.words.make_room(words + i.size + 1);
    std::uint32_t* const shifted = result.word();
    std::fill_n(shifted, words, 0u);
    std::uint64_t carry = 0;
    for (int w = 0; w < i.size; ++w, carry >>= 32) {
        carry |= std::uint64_t{i.word()[w]} << rest;
        shifted[words + w] = static_cast<std::uint32_t>(carry);
    }
    shifted[words + i.size] = static_cast<std::uint32_t>(carry);
    result.size = words + i.size + 1;
    result.negative = i.negative;
    result.trim();
    return result;
}

// |value| == mantissa * 2^exponent, the mantissa odd; 0 for 0.
struct Parts {
    std::uint64_t mantissa;
    int exponent;
};

// Reads the bits, so that no floating-point environment makes a shift negative.
inline Parts parts(double value) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    const int biased = static_cast<int>(bits >> 52 & 0x7ff);
    const std::uint64_t mantissa = (bits & 0xfffffffffffff) | std::uint64_t{biased != 0} << 52;
    if (mantissa == 0) return {0, 0};
    const int zeros = std::countr_zero(mantissa);
    return {mantissa >> zeros, std::max(biased, 1) - 1075 + zeros};
}

// `value` in units of 2^unit, of which it is a multiple.
template <class Words>
IntegerIn<Words> integer_of(double value, int unit) {
    IntegerIn<Words> result;
    const Parts from = parts(value);
    if (from.mantissa == 0) return result;
    result.negative = std::signbit(value);
    const int words = (from.exponent - unit) / 32, bits = (from.exponent - unit) % 32;
    result.words.make_room(words + 3);
    std::uint32_t* const word = result.word();
    std::fill_n(word, words, 0u);
    const std::uint64_t low = from.mantissa << bits;
    word[words] = static_cast<std::uint32_t>(low);
    word[words + 1] = static_cast<std::uint32_t>(low >> 32);
    word[words + 2] = bits == 0 ? 0 : static_cast<std::uint32_t>(from.mantissa >> (64 - bits));
    result.size = words + 3;
    result.trim();
    return result;
}

} // namespace vox
