// Events: pairs of meshes, and vertices in meshes, that began or ended touching. They are the differences of
// two sorted sets, those of the last successful step and of this one, so that nothing between two steps loses
// an event.
#pragma once

#include "base/array.hpp"
#include "base/counters.hpp"
#include "grid/contact_pairs.hpp"

#include <vox/vox.h>

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <span>

namespace vox {

class Events {
public:
    // `of_contacts`: whether there are events of single vertices, too.
    Events(std::pmr::memory_resource* memory, bool of_contacts);

    // When a step begins, or the grid is cleared: no pairs until a step ends.
    void hide_pairs() noexcept { pairs_are_shown_ = false; }
    void hide_events() noexcept;

    // The last stage of a step. `by_edges` are the pairs that have edge contacts. If it throws, the state of
    // the step before is kept. Calls user_data(mesh_id) for every mesh that touches another.
    template <class UserData>
    void update(std::span<const vox_contact> contacts, std::span<const EdgePair> by_edges, std::size_t slots,
                UserData&& user_data) {
        find_touching(contacts, slots, buffers_, next(), by_pair_);
        add_pairs(by_edges, next());
        for (vox_pair& pair : next()) {
            pair.user_data_a = user_data(pair.body_a);
            pair.user_data_b = user_data(pair.body_b);
        }
        compare(contacts);
    }

    // The same for a step with the contacts of the last one.
    void repeat();

    // Room for what so many contacts need, and the pairs of so many meshes (eight each).
    void reserve(std::size_t mesh_count, std::size_t contact_count);

    std::span<const vox_pair> pairs() const noexcept;
    // Their contacts, as vox_pair_view.contacts.
    const std::uint32_t* pair_contacts() const noexcept { return by_pair_.data(); }
    std::span<const std::uint32_t> contacts_of(const vox_pair& pair) const noexcept {
        return {pair_contacts() + pair.first, static_cast<std::size_t>(pair.a_in_b + pair.b_in_a)};
    }
    // Calls visit(pair) for all pairs, in order, those of one mesh, or that of two meshes.
    template <class Visit>
    void for_pairs_of(std::span<const vox_body> meshes, Visit&& visit) const {
        for (const vox_pair& pair : pairs_of(meshes))
            if (meshes.empty() || pair.body_a == meshes[0] || pair.body_b == meshes[0]) visit(pair);
    }
    // Calls visit(index) for each contact of these pairs, pair by pair.
    template <class Visit>
    void for_contacts_of(std::span<const vox_body> meshes, Visit&& visit) const {
        for_pairs_of(meshes, [&](const vox_pair& pair) {
            for (const std::uint32_t index : contacts_of(pair)) visit(index);
        });
    }
    vox_touch_view touch_events(std::uint64_t epoch) const noexcept;
    // Whether there are events of single vertices. Where that changes, all of them begin in the next step, or
    // their memory is given back.
    bool of_contacts() const noexcept { return of_contacts_; }
    void set_of_contacts(bool of_contacts) noexcept;
    // Throws Error(INVALID_STATE) without `of_contacts`.
    vox_contact_event_view contact_events(std::uint64_t epoch) const;
    // Sets the counters from `total_touches_began` to `total_contacts_ended`.
    void count(Counters& counters) const noexcept;

private:
    friend class Snapshot;

    // A vertex in some mesh.
    struct Inside {
        vox_body body_a;
        std::uint32_t vertex;
        vox_body body_b;

        auto operator<=>(const Inside&) const = default;
    };

    // The pair of two meshes, in either order, if they touch; all pairs where less are given.
    std::span<const vox_pair> pairs_of(std::span<const vox_body> meshes) const noexcept;

    Array<vox_pair>& next() noexcept { return touching_[1 - current_]; }
    void compare(std::span<const vox_contact> contacts);
    void compare_pairs();
    void compare_contacts(std::span<const vox_contact> contacts);

    TouchingBuffers buffers_;
    std::array<Array<vox_pair>, 2> touching_; // this step's and the last one's
    Array<std::uint32_t> by_pair_;            // contacts, of this step's
    std::array<Array<Inside>, 2> inside_;
    std::size_t current_ = 0; // of the two
    bool pairs_are_shown_ = false;
    bool of_contacts_;
    Array<vox_touch_event> touch_events_;
    Array<vox_contact_event> contact_events_;
    std::uint64_t began_ = 0, persisted_ = 0; // of touch_events_
    std::uint64_t contacts_began_ = 0;        // of contact_events_
    // Of all steps: how many pairs, and vertices in meshes, began and ended.
    struct Totals {
        std::uint64_t began = 0, ended = 0;
    };
    Totals touches_, vertices_;
};

} // namespace vox
