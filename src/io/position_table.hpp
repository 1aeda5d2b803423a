// Finds vertices that lie at exactly the same position.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <set>
#include <vector>

namespace vox::io {

// A hash table with linear probing over vertices of `positions`, 3 finite coordinates a vertex. A file can be
// made so that all its positions have the same hash. So a search looks at a few slots only, and what finds no
// place in them goes to a search tree: no vertex costs more than these slots and one way down the tree.
class PositionTable {
public:
    // The positions are borrowed, and may grow between calls.
    explicit PositionTable(const std::vector<double>& positions)
        : positions_(positions), others_(Less{&positions}) {}

    // Makes room for that many vertices at once.
    void reserve(std::size_t vertices) {
        if (2 * vertices > table_.size()) rebuild(2 * vertices);
    }

    // Returns the vertex that was entered with the position of `vertex`. If there is none, enters `vertex`
    // and returns it. Zeros of either sign are the same.
    std::uint32_t enter(std::uint32_t vertex) {
        if (2 * (entered_ + 1) > table_.size()) rebuild(std::max<std::size_t>(2 * table_.size(), 1024));
        return place(vertex);
    }

private:
    static constexpr std::uint32_t empty = 0xffffffffu;
    static constexpr int most_probes = 32; // a cluster of a half-full table is rarely longer

    struct Less {
        const std::vector<double>* positions;
        bool operator()(std::uint32_t a, std::uint32_t b) const {
            const double *p = &(*positions)[3 * std::size_t{a}], *q = &(*positions)[3 * std::size_t{b}];
            return std::lexicographical_compare(p, p + 3, q, q + 3);
        }
    };

    static std::uint64_t hash_of(const double* p) {
        std::uint64_t hash = 0;
        for (int k = 0; k < 3; ++k) { // adding 0.0 turns -0 into 0
            hash = (hash ^ std::bit_cast<std::uint64_t>(p[k] + 0.0)) * 0x9e3779b97f4a7c15u;
            hash ^= hash >> 32;
        }
        return hash;
    }

    std::uint32_t place(std::uint32_t vertex) {
        const double* const p = &positions_[3 * std::size_t{vertex}];
        const std::uint64_t mask = table_.size() - 1;
        std::uint64_t slot = hash_of(p) & mask;
        for (int probe = 0; probe < most_probes; ++probe, slot = (slot + 1) & mask) {
            if (table_[slot] == empty) {
                table_[slot] = vertex;
                ++entered_;
                return vertex;
            }
            if (std::equal(p, p + 3, &positions_[3 * std::size_t{table_[slot]}])) return table_[slot];
        }
        // Slots never become empty again, so an equal position that was entered here is in the tree as well.
        const auto [found, is_new] = others_.insert(vertex);
        entered_ += is_new;
        return *found;
    }

    void rebuild(std::size_t slots) {
        std::vector<std::uint32_t> entries(std::bit_ceil(slots), empty);
        entries.swap(table_);
        std::set<std::uint32_t, Less> others(Less{&positions_});
        others.swap(others_);
        entered_ = 0;
        for (const std::uint32_t vertex : entries)
            if (vertex != empty) place(vertex);
        for (const std::uint32_t vertex : others) place(vertex);
    }

    const std::vector<double>& positions_;
    std::vector<std::uint32_t> table_; // a power of two, at most half full
    std::set<std::uint32_t, Less> others_;
    std::size_t entered_ = 0;
};

} // namespace vox::io
