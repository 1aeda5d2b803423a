// Counting sorts (Knuth, The Art of Computer Programming 3, Sect. 5.2) of the pairs by either mesh, and of
// runs of contacts by pair: those that follow each other with the same body_a and body_b.
#include "grid/pairs.hpp"

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

// ---- what changed -----------------------------------------------------------------------------------

Pairs::Pairs(std::pmr::memory_resource* memory)
    : buffers_(memory), pairs_{Array<vox_pair>(memory), Array<vox_pair>(memory)}, ended_(memory),
      by_pair_(memory) {}

void Pairs::reserve(std::size_t body_count, std::size_t contact_count) {
    const std::size_t pairs = std::min(8 * body_count, contact_count);
    reserve_growing(buffers_.last_of_slot, body_count);
    reserve_growing(buffers_.directed, 2 * pairs);
    reserve_growing(buffers_.order, 2 * pairs);
    reserve_growing(buffers_.scratch, 2 * pairs);
    reserve_growing(buffers_.place, body_count);
    reserve_growing(ended_, pairs);
    reserve_growing(by_pair_, contact_count);
    for (Array<vox_pair>& list : pairs_) reserve_growing(list, 2 * pairs);
}

void Pairs::compare() {
    Array<vox_pair>&is = next(), &was = pairs_[current_];
    // Room for as many pairs to end while as many begin. So a later step that finds no more than this one
    // allocates nothing.
    const auto touched = static_cast<std::size_t>(std::ranges::count_if(was, touches));
    const std::size_t most = std::max(touched, is.size());
    reserve_growing(ended_, most);
    reserve_growing(is, 2 * most);
    reserve_growing(was, 2 * most);

    ended_.clear();
    std::size_t persisted = 0;
    auto now = is.begin();
    for (const vox_pair& old : was) {
        if (!touches(old)) continue;
        while (now != is.end() && ids_of(*now) < ids_of(old)) ++now;
        if (now != is.end() && ids_of(*now) == ids_of(old) && touches(*now)) {
            now->state = VOX_PAIR_PERSISTED;
            ++persisted;
        } else {
            ended_.push_back(old);
            ended_.back().state = VOX_PAIR_ENDED;
        }
    }
    began_ = static_cast<std::uint64_t>(std::ranges::count_if(is, touches)) - persisted;
    add_pairs(ended_, is);
    is_pending_ = true;
}

void Pairs::commit() noexcept {
    if (is_pending_) {
        current_ = 1 - current_;
        total_began_ += began_;
        total_ended_ += ended_.size();
    }
    is_pending_ = false;
    are_shown_ = true;
}

void Pairs::repeat() {
    Array<vox_pair>& is = pairs_[current_];
    next().reserve(is.size()); // all that can fail comes first: room for a step that finds as much
    erase_if(is, [](const vox_pair& pair) { return !touches(pair); });
    for (vox_pair& pair : is) pair.state = VOX_PAIR_PERSISTED;
}

std::span<const vox_pair> Pairs::all() const noexcept {
    return are_shown_ ? std::span<const vox_pair>(pairs_[current_]) : std::span<const vox_pair>();
}

void Pairs::count(Counters& counters) const noexcept {
    counters.total_touches_began = total_began_;
    counters.total_touches_ended = total_ended_;
}

} // namespace vox
