// Which pairs of meshes touch: the contacts of a step ordered by pairs.
#pragma once

#include <vox/vox.h>

#include <cstdint>
#include <memory_resource>
#include <span>
#include <vector>

namespace vox {

// Buffers kept from step to step.
struct TouchingBuffers {
    explicit TouchingBuffers(std::pmr::memory_resource* memory)
        : runs(memory), directed(memory), order(memory), scratch(memory), place(memory),
          last_of_slot(memory) {}

    // Contacts that follow each other with the same mesh_a and mesh_b.
    struct Run {
        std::uint32_t directed, first, count;
    };
    // All contacts with that mesh_a and mesh_b.
    struct Directed {
        vox_mesh mesh_a, mesh_b;
        std::uint32_t count;
        std::uint32_t next; // where its next contact goes in Touching::contacts
    };
    std::pmr::vector<Run> runs;
    std::pmr::vector<Directed> directed;
    std::pmr::vector<std::uint32_t> order, scratch; // of `directed`, sorted by pair
    std::pmr::vector<std::uint32_t> place;
    std::pmr::vector<std::uint32_t> last_of_slot; // the last of `directed` with mesh_b in that slot
};

struct Touching {
    explicit Touching(std::pmr::memory_resource* memory) : pairs(memory), contacts(memory) {}

    std::pmr::vector<vox_pair> pairs; // without user data, which the caller fills in
    std::pmr::vector<std::uint32_t> contacts;
};

// Makes the pairs of vox_pair_view from `contacts` in canonical order; `slots` is above the slot of every
// mesh. Throws Error(LIMIT) beyond VOX_MAX_CONTACTS.
void find_touching(std::span<const vox_contact> contacts, std::size_t slots, TouchingBuffers& buffers,
                   Touching& out);

} // namespace vox
