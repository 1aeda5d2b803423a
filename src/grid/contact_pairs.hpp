// Which pairs of meshes touch: the contacts of a step ordered by pairs.
#pragma once

#include "base/array.hpp"
#include "base/room.hpp"

#include <vox/vox.h>

#include <algorithm>
#include <compare>
#include <cstdint>
#include <memory_resource>
#include <span>

namespace vox {

// Buffers kept from step to step.
struct TouchingBuffers {
    explicit TouchingBuffers(std::pmr::memory_resource* memory)
        : directed(memory), order(memory), scratch(memory), place(memory), last_of_slot(memory) {}

    // All contacts with that body_a and body_b.
    struct Directed {
        vox_body body_a, body_b;
        std::uint32_t count;
        std::uint32_t next; // where its next contact goes in the list by pairs
    };
    Array<Directed> directed;
    Array<std::uint32_t> order, scratch; // of `directed`, sorted by pair
    Array<std::uint32_t> place;
    Array<std::uint32_t> last_of_slot; // one of `directed` with body_b in that slot
};

// Two meshes, the lower id first.
struct IdPair {
    vox_body body_a, body_b;

    auto operator<=>(const IdPair&) const = default;
};

// Throws Error(LIMIT) where a step has more than VOX_MAX_CONTACTS of `what`, e.g. "edges".
void check_contact_count(std::size_t count, const char* what);

inline IdPair ids_of(const vox_pair& pair) noexcept { return {pair.body_a, pair.body_b}; }

// Adds those of `more`, which ascend, that `pairs` lacks, without contacts. Those that it has and that ended
// get that state: they are near.
void add_pairs(std::span<const vox_pair> more, Array<vox_pair>& pairs);

// Replaces `pairs` by those of contacts or the like, each once, in order, without user data.
template <class Contact>
void list_pairs(std::span<const Contact> contacts, vox_pair_state state, Array<vox_pair>& pairs) {
    pairs.clear();
    for (const Contact& contact : contacts) {
        const auto [a, b] = std::minmax(contact.body_a, contact.body_b);
        if (!pairs.empty() && ids_of(pairs.back()) == IdPair{a, b}) continue;
        reserve_growing(pairs, pairs.size() + 1);
        pairs.push_back({a, b, 0, 0, state, 0, 0, 0});
    }
    std::ranges::sort(pairs, {}, ids_of);
    const auto same = [](const vox_pair& x, const vox_pair& y) { return ids_of(x) == ids_of(y); };
    pairs.erase(std::unique(pairs.begin(), pairs.end(), same), pairs.end());
}

// Makes what vox_pair_view has of `contacts` in canonical order: the pairs, BEGAN and without user data, and
// the indices of the contacts, pair by pair; `slots` is above the slot of every mesh. Throws Error(LIMIT)
// beyond VOX_MAX_CONTACTS.
void find_touching(std::span<const vox_contact> contacts, std::size_t slots, TouchingBuffers& buffers,
                   Array<vox_pair>& pairs, Array<std::uint32_t>& by_pair);

} // namespace vox
