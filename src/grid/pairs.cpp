#include "grid/pairs.hpp"

#include "base/room.hpp"

namespace vox {

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
