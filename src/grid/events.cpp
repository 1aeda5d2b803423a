#include "grid/events.hpp"

#include "base/array.hpp"
#include "base/error.hpp"
#include "base/room.hpp"

#include <algorithm>
#include <functional>
#include <tuple>

namespace vox {

namespace {

bool pair_before(const vox_pair& x, const vox_pair& y) {
    return std::tie(x.body_a, x.body_b) < std::tie(y.body_a, y.body_b);
}

// Merges two sorted sets and calls function(element) for those that began (in `is` alone), persist (in both:
// that of `is`) or ended (in `was` alone), in order.
template <class Set, class Before, class Function>
void for_each_of_kind(vox_touch kind, const Set& was, const Set& is, Before before, Function&& function) {
    auto old = was.begin();
    auto now = is.begin();
    while (old != was.end() || now != is.end()) {
        if (old == was.end() || (now != is.end() && before(*now, *old))) {
            if (kind == VOX_TOUCH_BEGAN) function(*now);
            ++now;
        } else if (now == is.end() || before(*old, *now)) {
            if (kind == VOX_TOUCH_ENDED) function(*old);
            ++old;
        } else {
            if (kind == VOX_TOUCH_PERSISTED) function(*now);
            ++old;
            ++now;
        }
    }
}

} // namespace

Events::Events(std::pmr::memory_resource* memory, bool of_contacts)
    : buffers_(memory), touching_{Array<vox_pair>(memory), Array<vox_pair>(memory)},
      by_pair_(memory), inside_{Array<Inside>(memory), Array<Inside>(memory)}, of_contacts_(of_contacts),
      touch_events_(memory), contact_events_(memory) {}

void Events::hide_events() noexcept {
    touch_events_.clear();
    contact_events_.clear();
    began_ = persisted_ = contacts_began_ = 0;
}

void Events::set_of_contacts(bool of_contacts) noexcept {
    if (of_contacts == of_contacts_) return;
    of_contacts_ = of_contacts;
    std::pmr::memory_resource* memory = contact_events_.memory();
    for (Array<Inside>& inside : inside_) inside = Array<Inside>(memory);
    contact_events_ = Array<vox_contact_event>(memory);
    contacts_began_ = 0;
}

void Events::reserve(std::size_t mesh_count, std::size_t contact_count) {
    const std::size_t pairs = std::min(8 * mesh_count, contact_count);
    reserve_growing(buffers_.last_of_slot, mesh_count);
    reserve_growing(buffers_.directed, 2 * pairs);
    reserve_growing(buffers_.order, 2 * pairs);
    reserve_growing(buffers_.scratch, 2 * pairs);
    reserve_growing(buffers_.place, mesh_count);
    reserve_growing(touch_events_, 2 * pairs);
    reserve_growing(by_pair_, contact_count);
    for (Array<vox_pair>& touching : touching_) reserve_growing(touching, pairs);
    if (!of_contacts_) return;
    reserve_growing(contact_events_, 2 * contact_count);
    for (Array<Inside>& inside : inside_) reserve_growing(inside, contact_count);
}

void Events::compare(std::span<const vox_contact> contacts) {
    // Both halves get room for what one of them has, and the events for all of it to end while as much
    // begins. So a later step that finds no more than this one allocates nothing.
    const Array<vox_pair>& is = next();
    Array<vox_pair>& was = touching_[current_];
    reserve_growing(was, is.size());
    reserve_growing(touch_events_, 2 * std::max(was.size(), is.size()));
    try {
        compare_pairs();
        if (of_contacts_) compare_contacts(contacts);
    } catch (...) {
        hide_events();
        throw;
    }
    current_ = 1 - current_;
    pairs_are_shown_ = true;
    touches_.began += began_;
    touches_.ended += touch_events_.size() - began_ - persisted_;
    vertices_.began += contacts_began_;
    vertices_.ended += contact_events_.size() - contacts_began_;
}

void Events::repeat() {
    // All that can fail comes first: room for this step, and for one that finds as much, all of it new.
    touch_events_.reserve(touching_[current_].size());
    next().reserve(touching_[current_].size());
    inside_[1 - current_].reserve(inside_[current_].size());
    for (const vox_pair& pair : touching_[current_]) {
        const auto index = static_cast<std::uint32_t>(touch_events_.size());
        touch_events_.push_back(
            {pair.body_a, pair.body_b, pair.user_data_a, pair.user_data_b, VOX_TOUCH_PERSISTED, index});
    }
    persisted_ = touch_events_.size();
    pairs_are_shown_ = true;
}

void Events::compare_pairs() {
    const Array<vox_pair>&was = touching_[current_], &is = next();
    for (const vox_touch kind : {VOX_TOUCH_BEGAN, VOX_TOUCH_PERSISTED, VOX_TOUCH_ENDED})
        for_each_of_kind(kind, was, is, pair_before, [&](const vox_pair& pair) {
            const auto index =
                kind == VOX_TOUCH_ENDED ? VOX_NO_PAIR : static_cast<std::uint32_t>(&pair - is.data());
            touch_events_.push_back(
                {pair.body_a, pair.body_b, pair.user_data_a, pair.user_data_b, kind, index});
            began_ += kind == VOX_TOUCH_BEGAN;
            persisted_ += kind == VOX_TOUCH_PERSISTED;
        });
}

void Events::compare_contacts(std::span<const vox_contact> contacts) {
    const Array<Inside>& was = inside_[current_];
    Array<Inside>& is = inside_[1 - current_];
    is.clear();
    for (const vox_contact& contact : contacts) {
        const Inside inside{contact.body_a, contact.vertex, contact.body_b};
        if (is.empty() || is.back() != inside)
            is.push_back(inside); // in the interior of several tets at once
    }
    reserve_growing(inside_[current_], is.size());
    reserve_growing(contact_events_, 2 * std::max(was.size(), is.size()));
    for (const vox_touch kind : {VOX_TOUCH_BEGAN, VOX_TOUCH_ENDED})
        for_each_of_kind(kind, was, is, std::less<>(), [&](const Inside& inside) {
            contact_events_.push_back({inside.body_a, inside.vertex, inside.body_b, kind});
            contacts_began_ += kind == VOX_TOUCH_BEGAN;
        });
}

std::span<const vox_pair> Events::pairs() const noexcept {
    return pairs_are_shown_ ? std::span<const vox_pair>(touching_[current_]) : std::span<const vox_pair>();
}

std::span<const vox_pair> Events::pairs_of(std::span<const vox_body> meshes) const noexcept {
    if (meshes.size() < 2) return pairs();
    vox_pair wanted{};
    std::tie(wanted.body_a, wanted.body_b) = std::minmax(meshes[0], meshes[1]);
    const auto [first, last] = std::equal_range(pairs().begin(), pairs().end(), wanted, pair_before);
    return {first, last};
}

vox_touch_view Events::touch_events(std::uint64_t epoch) const noexcept {
    const std::uint64_t count = touch_events_.size();
    return {.data = touch_events_.data(),
            .byte_stride = sizeof(vox_touch_event),
            .count = count,
            .epoch = epoch,
            .began = began_,
            .persisted = persisted_,
            .ended = count - began_ - persisted_};
}

void Events::count(Counters& counters) const noexcept {
    counters.total_touches_began = touches_.began;
    counters.total_touches_ended = touches_.ended;
    counters.total_contacts_began = vertices_.began;
    counters.total_contacts_ended = vertices_.ended;
}

vox_contact_event_view Events::contact_events(std::uint64_t epoch) const {
    if (!of_contacts_)
        throw Error(VOX_ERROR_INVALID_STATE, "the flags of the grid lack VOX_GRID_CONTACT_EVENTS");
    const std::uint64_t count = contact_events_.size();
    return {.data = contact_events_.data(),
            .byte_stride = sizeof(vox_contact_event),
            .count = count,
            .epoch = epoch,
            .began = contacts_began_,
            .ended = count - contacts_began_};
}

} // namespace vox
