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

// Adds those of `more`, which ascend, that `pairs` lacks, without contacts and user data.
void add_pairs(std::span<const IdPair> more, vox_pair_state state, Array<vox_pair>& pairs);
// The same for pairs that touch no more; those that `pairs` has, as they are near, get that state.
void add_ended(std::span<const vox_pair> ended, Array<vox_pair>& pairs);

// Replaces `pairs` by those of contacts or the like, each once, in order.
template <class Contact>
void list_pairs(std::span<const Contact> contacts, Array<IdPair>& pairs) {
    pairs.clear();
    for (const Contact& contact : contacts) {
        const IdPair pair{std::min(contact.body_a, contact.body_b), std::max(contact.body_a, contact.body_b)};
        if (!pairs.empty() && pairs.back() == pair) continue;
        reserve_growing(pairs, pairs.size() + 1);
        pairs.push_back(pair);
    }
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
}

// Makes what vox_pair_view has of `contacts` in canonical order: the pairs, BEGAN and without user data, and
// the indices of the contacts, pair by pair; `slots` is above the slot of every mesh. Throws Error(LIMIT)
// beyond VOX_MAX_CONTACTS.
void find_touching(std::span<const vox_contact> contacts, std::size_t slots, TouchingBuffers& buffers,
                   Array<vox_pair>& pairs, Array<std::uint32_t>& by_pair);

} // namespace vox
