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
        : positions_(positions), rest_(Less{&positions}) {}

    // Makes room for that many vertices: 8 bytes for each, and 48 for each in the tree.
    void reserve(std::size_t vertices) {
        if (2 * vertices <= slots_) return;
        slots_ = 2 * vertices;
        std::vector<std::uint32_t> entries(slots_ + most_probes, empty);
        entries.swap(table_);
        std::set<std::uint32_t, Less> rest(rest_.key_comp());
        rest.swap(rest_);
        for (const std::uint32_t vertex : entries)
            if (vertex != empty) enter(vertex);
        while (!rest.empty()) enter(rest.extract(rest.begin()).value());
    }

    // Returns the vertex that was entered with the position of `vertex`. If there is none, enters `vertex`,
    // for which there must be room, and returns it. Zeros of either sign are the same.
    std::uint32_t enter(std::uint32_t vertex) {
        const double* const p = &positions_[3 * std::size_t{vertex}];
        std::uint32_t* const first = &table_[(hash_of(p) >> 32) * slots_ >> 32];
        for (std::uint32_t* slot = first; slot != first + most_probes; ++slot) {
            if (*slot == empty) return *slot = vertex;
            if (std::equal(p, p + 3, &positions_[3 * std::size_t{*slot}])) return *slot;
        }
        // Slots never become empty again, so an equal position that was entered here is in the tree as well.
        return *rest_.insert(vertex).first;
    }

private:
    static constexpr std::uint32_t empty = 0xffffffffu;
    static constexpr std::size_t most_probes = 32; // a cluster of a half-full table is rarely longer

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

    const std::vector<double>& positions_;
    std::size_t slots_ = 0;              // where a search begins; at most half of them are in use
    std::vector<std::uint32_t> table_;   // the slots, and as many more as the last search passes
    std::set<std::uint32_t, Less> rest_; // that found no place in their slots
};

} // namespace vox::io
