// The pairs of bodies that touch, and what changed since the last successful step: the difference of two
// sorted sets, so that nothing between two steps loses an event.
#pragma once

#include "base/array.hpp"
#include "base/counters.hpp"
#include "grid/contact_pairs.hpp"

#include <vox/vox.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <span>

namespace vox {

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
