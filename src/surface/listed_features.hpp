// Numbers of features, sorted without comparing any two: each is a bit, and its place is the number of bits
// before it.
#pragma once

#include "base/array.hpp"
#include "base/bits.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <tuple>

namespace vox {

class ListedFeatures {
public:
    explicit ListedFeatures(std::pmr::memory_resource* memory) noexcept : words_(memory), used_(memory) {}
    auto buffers() { return std::tie(words_, used_); }

    // Makes room for numbers below `end`, none of which is listed then.
    void reset(std::size_t end) {
        words_.assign(end / word_bits + 1, Word{});
        used_.assign(end / square + 1, 0u);
        first_ = used_.size();
        last_ = 0;
    }
    // Lists f if `listed` is 1, without a branch, and does nothing if it is 0.
    void add(std::uint32_t f, std::uint64_t listed) noexcept {
        const std::size_t word = f / word_bits;
        words_[word].features |= listed << f % word_bits;
        used_[f / square] |= listed << word % word_bits;
        first_ = std::min<std::size_t>(first_, f / square);
        last_ = std::max<std::size_t>(last_, f / square);
    }
    // When all are listed, before place_of().
    void count() noexcept {
        std::uint32_t before = 0;
        for_each_word([&](Word& word) {
            word.before = before;
            before += bit_count(word.features);
        });
    }
    // How many of those listed are below f.
    std::uint32_t place_of(std::uint32_t f) const noexcept {
        const Word& word = words_[f / word_bits];
        return word.before + bit_count(word.features & ((std::uint64_t{1} << f % word_bits) - 1));
    }
    void clear() noexcept {
        for_each_word([](Word& word) { word.features = 0; });
        for (std::size_t i = first_; i <= last_; ++i) used_[i] = 0;
        first_ = used_.size();
        last_ = 0;
    }

private:
    static constexpr std::size_t word_bits = 64, square = word_bits * word_bits;
    struct Word {
        std::uint64_t features = 0;
        std::uint32_t before = 0; // features in earlier words
    };

    template <class Visit>
    void for_each_word(Visit&& visit) noexcept {
        for (std::size_t i = first_; i <= last_; ++i)
            for (std::uint64_t left = used_[i]; left != 0; left &= left - 1)
                visit(words_[i * word_bits + static_cast<std::size_t>(std::countr_zero(left))]);
    }

    Array<Word> words_;
    Array<std::uint64_t> used_;        // words that list any, as bits
    std::size_t first_ = 0, last_ = 0; // of `used_`, that hold any
};

} // namespace vox
