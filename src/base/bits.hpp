// A set of numbers as bits. One that was never added to holds no memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <span>
#include <vector>

namespace vox {

inline bool has_bit(std::span<const std::uint64_t> words, std::size_t i) noexcept {
    return i / 64 < words.size() && (words[i / 64] >> i % 64 & 1) != 0;
}

class Bits {
public:
    explicit Bits(std::pmr::memory_resource* memory) noexcept : words_(memory) {}

    bool operator[](std::size_t i) const noexcept { return has_bit(words_, i); }
    std::size_t count() const noexcept { return count_; }
    // Empty, or as long as reserve() made it.
    std::span<const std::uint64_t> words() const noexcept { return words_; }

    // Room for numbers below `end`: adding them cannot fail.
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
    std::pmr::vector<std::uint64_t> words_;
    std::size_t count_ = 0;
};

} // namespace vox
