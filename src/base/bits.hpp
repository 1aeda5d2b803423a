// Sets of numbers as bits, and numbers whose bits are interleaved.
#pragma once

#include "base/array.hpp"

#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <span>

namespace vox {

inline bool has_bit(std::span<const std::uint64_t> words, std::size_t i) noexcept {
    return i / 64 < words.size() && (words[i / 64] >> i % 64 & 1) != 0;
}

// std::popcount() without a call, on machines that may have no instruction for it (D. E. Knuth, The Art of
// Computer Programming 4A, Sect. 7.1.3).
inline std::uint32_t bit_count(std::uint64_t x) noexcept {
    x -= x >> 1 & 0x5555555555555555u;
    x = (x & 0x3333333333333333u) + (x >> 2 & 0x3333333333333333u);
    x = (x + (x >> 4)) & 0x0f0f0f0f0f0f0f0fu;
    return static_cast<std::uint32_t>(x * 0x0101010101010101u >> 56);
}

// A set of numbers. It holds no memory before reserve().
class Bits {
public:
    explicit Bits(std::pmr::memory_resource* memory) noexcept : words_(memory) {}

    bool operator[](std::size_t i) const noexcept { return has_bit(words_, i); }
    std::size_t count() const noexcept { return count_; }
    // Empty before reserve().
    std::span<const std::uint64_t> words() const noexcept { return words_; }

    // Makes room for numbers below `end`, so that adding them cannot fail.
    void reserve(std::size_t end) {
        if ((end + 63) / 64 > words_.size()) words_.resize((end + 63) / 64, 0);
    }
    void add(std::size_t i) noexcept {
        count_ += !(*this)[i];
        words_[i / 64] |= std::uint64_t{1} << i % 64;
    }
    void remove(std::size_t i) noexcept {
        if (!(*this)[i]) return;
        words_[i / 64] &= ~(std::uint64_t{1} << i % 64);
        --count_;
    }

private:
    Array<std::uint64_t> words_;
    std::size_t count_ = 0;
};

// The place of a cell on a Z-shaped curve through 2^10 cells an axis (G. M. Morton, "A computer oriented
// geodetic data base", 1966).
inline std::uint32_t morton_code(std::uint32_t x, std::uint32_t y, std::uint32_t z) noexcept {
    const auto to_every_third_bit = [](std::uint32_t i) {
        i = (i | i << 16) & 0x030000ffu;
        i = (i | i << 8) & 0x0300f00fu;
        i = (i | i << 4) & 0x030c30c3u;
        return (i | i << 2) & 0x09249249u;
    };
    return to_every_third_bit(x) | to_every_third_bit(y) << 1 | to_every_third_bit(z) << 2;
}

} // namespace vox
