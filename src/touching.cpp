// A counting sort of runs of contacts by pair: only the pairs themselves, few beside the contacts, are
// compared.
#include "touching.hpp"

#include "error.hpp"
#include "ids.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace vox {

void find_touching(std::span<const vox_contact> contacts, std::size_t slots, TouchingBuffers& buffers,
                   Touching& out) {
    if (contacts.size() > VOX_MAX_CONTACTS)
        throw Error(VOX_ERROR_LIMIT,
                    format("the step has %zu contacts, the limit is %u", contacts.size(), VOX_MAX_CONTACTS));
    using Run = TouchingBuffers::Run;
    using Directed = TouchingBuffers::Directed;
    std::pmr::vector<Run>& runs = buffers.runs;
    std::pmr::vector<Directed>& directed = buffers.directed;
    runs.clear();
    directed.clear();
    if (buffers.last_of_slot.size() < slots) buffers.last_of_slot.resize(slots, 0);
    const auto count = static_cast<std::uint32_t>(contacts.size());
    for (std::uint32_t first = 0, end; first < count; first = end) {
        const vox_mesh a = contacts[first].mesh_a, b = contacts[first].mesh_b;
        for (end = first + 1; end < count && contacts[end].mesh_a == a && contacts[end].mesh_b == b;) ++end;
        // What an earlier mesh_a or step left here names another pair, or none.
        std::uint32_t& index = buffers.last_of_slot[slot_of(b)];
        if (index >= directed.size() || directed[index].mesh_a != a || directed[index].mesh_b != b) {
            index = static_cast<std::uint32_t>(directed.size());
            directed.push_back({a, b, 0, 0});
        }
        directed[index].count += end - first;
        runs.push_back({index, first, end - first});
    }

    // Both directions of a pair after each other.
    buffers.order.resize(directed.size());
    std::iota(buffers.order.begin(), buffers.order.end(), 0u);
    const auto key = [&](std::uint32_t i) {
        const Directed& d = directed[i];
        return std::tuple(std::min(d.mesh_a, d.mesh_b), std::max(d.mesh_a, d.mesh_b), d.mesh_a);
    };
    std::sort(buffers.order.begin(), buffers.order.end(),
              [&](std::uint32_t i, std::uint32_t j) { return key(i) < key(j); });
    out.pairs.clear();
    std::uint32_t placed = 0;
    for (const std::uint32_t i : buffers.order) {
        Directed& d = directed[i];
        d.next = placed;
        const auto [a, b, vertices_of] = key(i);
        if (out.pairs.empty() || out.pairs.back().mesh_a != a || out.pairs.back().mesh_b != b)
            out.pairs.push_back({a, b, 0, 0, placed, 0, 0});
        (vertices_of == a ? out.pairs.back().a_in_b : out.pairs.back().b_in_a) = d.count;
        placed += d.count;
    }
    out.contacts.resize(contacts.size());
    for (const Run& run : runs) {
        std::uint32_t& next = directed[run.directed].next;
        std::iota(out.contacts.begin() + next, out.contacts.begin() + next + run.count, run.first);
        next += run.count;
    }
}

} // namespace vox
