// Consistent penetration depths of the colliding vertices of one body in another.
#pragma once

#include "base/bits.hpp"
#include "depth/normals.hpp"
#include "depth/points.hpp"

#include <cstdint>
#include <memory_resource>
#include <span>
#include <tuple>
#include <vector>

namespace vox::depth {

// Vertices as bits, and for each word with a bit the place of its first vertex in a list that ascends.
class VertexPlaces {
public:
    explicit VertexPlaces(std::pmr::memory_resource* memory) : words_(memory) {}

    static constexpr std::uint32_t none = 0xffffffffu;

    auto& buffer() noexcept { return words_; }
    // For vertices below `vertex_count`. Throws what the memory throws.
    void reserve(std::size_t vertex_count) {
        if (words_.size() < vertex_count / 64 + 1) words_.resize(vertex_count / 64 + 1);
    }
    // Adds the next vertex of the list.
    void add(std::uint32_t vertex, std::uint32_t place) noexcept {
        Word& word = words_[vertex / 64];
        if (word.bits == 0) word.first = place;
        word.bits |= bit(vertex);
    }
    void remove(std::uint32_t vertex) noexcept { words_[vertex / 64].bits = 0; } // and others, all in the end
    bool has(std::uint32_t vertex) const noexcept { return (words_[vertex / 64].bits & bit(vertex)) != 0; }
    std::uint32_t operator[](std::uint32_t vertex) const noexcept {
        const Word& word = words_[vertex / 64];
        if (!(word.bits & bit(vertex))) return none;
        return word.first + bit_count(word.bits & (bit(vertex) - 1));
    }

private:
    static std::uint64_t bit(std::uint32_t vertex) noexcept { return std::uint64_t{1} << vertex % 64; }

    struct Word {
        std::uint64_t bits = 0;
        std::uint32_t first = 0;
    };
    std::pmr::vector<Word> words_;
};

// What find_consistent_depths() keeps from call to call.
struct ConsistentScratch {
    explicit ConsistentScratch(std::pmr::memory_resource* memory)
        : places(memory), waves(memory), queue(memory), normals(memory) {}

    VertexPlaces places;                          // empty between calls
    std::pmr::vector<std::uint32_t> waves, queue; // of points
    Normals normals;

    auto buffers() { return std::tuple_cat(std::tie(places.buffer(), waves, queue), normals.buffers()); }
};

// Sets the states of `points`, which are in the order of their vertices, and depth and direction of all that
// do not end as ENCLOSED or CROSSING. Throws what the memory throws.
void find_consistent_depths(const BodyPair& pair, std::span<Point> points, ConsistentScratch& scratch,
                            Counts& counts);

} // namespace vox::depth
