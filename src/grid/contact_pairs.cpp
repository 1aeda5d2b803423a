// Counting sorts (Knuth, The Art of Computer Programming 3, Sect. 5.2) of the pairs by either mesh, and of
// runs of contacts by pair: those that follow each other with the same body_a and body_b.
#include "grid/contact_pairs.hpp"

#include "base/error.hpp"
#include "mesh/ids.hpp"

#include <numeric>

namespace vox {

namespace {

// Counts, sums, places: `from` stably sorted by the slot of mesh(directed[i]).
template <class MeshOf>
void sort_by_slot(const Array<TouchingBuffers::Directed>& directed, MeshOf mesh, std::size_t slots,
                  const Array<std::uint32_t>& from, Array<std::uint32_t>& to, Array<std::uint32_t>& place) {
    place.assign(slots, 0);
    for (const TouchingBuffers::Directed& d : directed) ++place[slot_of(mesh(d))];
    std::exclusive_scan(place.begin(), place.end(), place.begin(), 0u);
    for (const std::uint32_t i : from) to[place[slot_of(mesh(directed[i]))]++] = i;
}

// Calls visit(first, end) for each run of contacts.
template <class Visit>
void for_runs(std::span<const vox_contact> contacts, Visit&& visit) {
    const auto count = static_cast<std::uint32_t>(contacts.size());
    for (std::uint32_t first = 0, end; first < count; first = end) {
        const vox_body a = contacts[first].body_a, b = contacts[first].body_b;
        for (end = first + 1; end < count && contacts[end].body_a == a && contacts[end].body_b == b;) ++end;
        visit(first, end);
    }
}

} // namespace

// From behind, so that each pair moves once.
void add_pairs(std::span<const vox_pair> more, Array<vox_pair>& pairs) {
    std::size_t added = 0;
    auto at = pairs.begin();
    for (const vox_pair& pair : more) {
        while (at != pairs.end() && ids_of(*at) < ids_of(pair)) ++at;
        if (at == pairs.end() || ids_of(*at) != ids_of(pair))
            ++added;
        else if (pair.state == VOX_PAIR_ENDED)
            at->state = VOX_PAIR_ENDED;
    }
    if (added == 0) return;
    // Those without contacts name the place of the next one's.
    std::uint64_t end = pairs.empty() ? 0 : pairs.back().first_contact + pairs.back().contact_count;
    std::size_t left = pairs.size();
    reserve_growing(pairs, pairs.size() + added);
    pairs.resize(pairs.size() + added);
    std::size_t to = pairs.size();
    for (std::size_t i = more.size(); i-- > 0;) {
        while (left > 0 && ids_of(more[i]) < ids_of(pairs[left - 1])) {
            pairs[--to] = pairs[--left];
            end = pairs[to].first_contact;
        }
        if (left > 0 && ids_of(more[i]) == ids_of(pairs[left - 1])) continue;
        pairs[--to] = more[i];
        pairs[to].first_contact = end;
        pairs[to].contact_count = 0;
    }
}

void check_contact_count(std::size_t count, const char* what) {
    if (count > VOX_MAX_CONTACTS)
        throw Error(VOX_ERROR_LIMIT,
                    format("the step has %zu %s, the limit is %u", count, what, VOX_MAX_CONTACTS));
}

void find_touching(std::span<const vox_contact> contacts, std::size_t slots, TouchingBuffers& buffers,
                   Array<vox_pair>& pairs, Array<std::uint32_t>& by_pair) {
    check_contact_count(contacts.size(), "contacts");
    using Directed = TouchingBuffers::Directed;
    Array<Directed>& directed = buffers.directed;
    directed.clear();
    if (buffers.last_of_slot.size() < slots) buffers.last_of_slot.resize(slots, 0);
    for_runs(contacts, [&](std::uint32_t first, std::uint32_t end) {
        const vox_body a = contacts[first].body_a, b = contacts[first].body_b;
        // An earlier body_a or step may have left the index of another pair here, or one past the end.
        std::uint32_t& index = buffers.last_of_slot[slot_of(b)];
        if (index >= directed.size() || directed[index].body_a != a || directed[index].body_b != b) {
            index = static_cast<std::uint32_t>(directed.size());
            directed.push_back({a, b, 0, 0});
        }
        directed[index].count += end - first;
    });

    // The two directions of a pair become neighbours: body_a ascends in `directed`, and sorting is stable.
    buffers.order.resize(directed.size());
    buffers.scratch.resize(directed.size());
    std::iota(buffers.scratch.begin(), buffers.scratch.end(), 0u);
    const auto low = [](const Directed& d) { return std::min(d.body_a, d.body_b); };
    const auto high = [](const Directed& d) { return std::max(d.body_a, d.body_b); };
    sort_by_slot(directed, high, slots, buffers.scratch, buffers.order, buffers.place);
    buffers.scratch.swap(buffers.order);
    sort_by_slot(directed, low, slots, buffers.scratch, buffers.order, buffers.place);
    pairs.clear();
    std::uint32_t placed = 0;
    for (const std::uint32_t i : buffers.order) {
        Directed& d = directed[i];
        d.next = placed;
        const vox_body a = low(d), b = high(d);
        if (pairs.empty() || pairs.back().body_a != a || pairs.back().body_b != b)
            pairs.push_back({a, b, 0, 0, VOX_PAIR_BEGAN, 0, placed, 0});
        pairs.back().contact_count += d.count;
        placed += d.count;
    }
    // Which of `directed` a run belongs to is found again, as keeping it would take memory for each contact:
    // those with one body_a follow each other.
    by_pair.resize(contacts.size());
    std::uint32_t entered = 0;
    for_runs(contacts, [&](std::uint32_t first, std::uint32_t end) {
        for (; entered < directed.size() && directed[entered].body_a == contacts[first].body_a; ++entered)
            buffers.last_of_slot[slot_of(directed[entered].body_b)] = entered;
        std::uint32_t& next = directed[buffers.last_of_slot[slot_of(contacts[first].body_b)]].next;
        std::iota(by_pair.begin() + next, by_pair.begin() + next + (end - first), first);
        next += end - first;
    });
}

} // namespace vox
