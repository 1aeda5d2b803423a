// Which pairs of meshes touch: the contacts of a step ordered by pairs.
#pragma once

#include "base/array.hpp"

#include <vox/vox.h>

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
struct EdgePair {
    vox_body body_a, body_b;

    auto operator<=>(const EdgePair&) const = default;
};

// Throws Error(LIMIT) where a step has more than VOX_MAX_CONTACTS of `what`, e.g. "edge contacts".
void check_contact_count(std::size_t count, const char* what);

// Adds those of `touching`, which ascend, that `pairs` lacks: pairs without contacts.
void add_pairs(std::span<const EdgePair> touching, Array<vox_pair>& pairs);

// Makes what vox_pair_view has of `contacts` in canonical order: the pairs, without user data, and the
// indices of the contacts, pair by pair; `slots` is above the slot of every mesh. Throws Error(LIMIT) beyond
// VOX_MAX_CONTACTS.
void find_touching(std::span<const vox_contact> contacts, std::size_t slots, TouchingBuffers& buffers,
                   Array<vox_pair>& pairs, Array<std::uint32_t>& by_pair);

} // namespace vox
