// The pairs of bodies that touch, and what changed since the last successful step: the difference of two
// sorted sets, so that nothing between two steps loses an event.
#pragma once

#include "base/array.hpp"
#include "base/counters.hpp"
#include "base/room.hpp"

#include <vox/vox.h>

#include <algorithm>
#include <array>
#include <compare>
#include <cstddef>
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

// Whether the bodies of a pair touch now.
inline bool touches(const vox_pair& pair) noexcept {
    return pair.state == VOX_PAIR_BEGAN || pair.state == VOX_PAIR_PERSISTED;
}

// Finds pairs, vox_pair or IdPair, among those of a step. Calls with the same few bodies follow each other as
// a rule.
template <class Pair>
class PairIndex {
public:
    explicit PairIndex(std::span<const Pair> pairs) noexcept : pairs_(pairs) {}

    // The index of the pair of two bodies, in either order. If there is none, that of the next one.
    std::size_t operator()(vox_body a, vox_body b) noexcept {
        const IdPair pair{std::min(a, b), std::max(a, b)};
        const std::uint64_t both = std::uint64_t{pair.body_a} << 32 | pair.body_b;
        auto& [known, index] = known_[both * 0x9e3779b97f4a7c15u >> 56]; // multiplicative hashing
        if (pair != known) {
            known = pair;
            const auto ids = [](const Pair& p) { return IdPair{p.body_a, p.body_b}; };
            index =
                static_cast<std::size_t>(std::ranges::lower_bound(pairs_, pair, {}, ids) - pairs_.begin());
        }
        return index;
    }

private:
    struct Known {
        IdPair pair;
        std::size_t index;
    };
    std::span<const Pair> pairs_;
    std::array<Known, 256> known_{};
};

class Pairs {
public:
    explicit Pairs(std::pmr::memory_resource* memory);

    // When a step begins, or the grid is cleared: no pairs until a step ends.
    void hide() noexcept { are_shown_ = is_pending_ = false; }

    // Pairs with contacts, and others that for_others(add) adds by add(pairs), which take the place of
    // the last step's with commit(). Calls user_data(body) for each body of a pair.
    template <class ForOthers, class UserData>
    void update(std::span<const vox_contact> contacts, ForOthers&& for_others, std::size_t slots,
                UserData&& user_data) {
        find_touching(contacts, slots, buffers_, next(), by_pair_);
        for_others([this](std::span<const vox_pair> pairs) { add_pairs(pairs, next()); });
        for (vox_pair& pair : next()) {
            pair.user_data_a = user_data(pair.body_a);
            pair.user_data_b = user_data(pair.body_b);
        }
        compare();
    }

    // The same for a step with the contacts of the last one, where no pair is near.
    void repeat();
    // Those of the step so far.
    std::span<const vox_pair> pending() const noexcept { return pairs_[current_ ^ std::size_t{is_pending_}]; }
    // When the step has succeeded: from now on they are shown, and the next step is compared with them.
    void commit() noexcept;

    // Room for what so many contacts need, and the pairs of so many bodies (eight each).
    void reserve(std::size_t body_count, std::size_t contact_count);

    std::span<const vox_pair> all() const noexcept;
    // Their contacts, as vox_pair_view.contacts.
    const std::uint32_t* contacts() const noexcept { return by_pair_.data(); }
    // Sets total_touches_began and total_touches_ended.
    void count(Counters& counters) const noexcept;

private:
    friend class Snapshot;

    Array<vox_pair>& next() noexcept { return pairs_[1 - current_]; }
    void compare();

    TouchingBuffers buffers_;
    std::array<Array<vox_pair>, 2> pairs_; // of this step and of the last one
    Array<vox_pair> ended_;
    Array<std::uint32_t> by_pair_; // contacts, of this step
    std::size_t current_ = 0;      // of the two
    bool are_shown_ = false, is_pending_ = false;
    std::uint64_t began_ = 0; // of the pending ones
    std::uint64_t total_began_ = 0, total_ended_ = 0;
};

} // namespace vox
