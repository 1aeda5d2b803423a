// A hash table of numbers in the order in which they were added (multiplicative hashing and linear probing,
// D. E. Knuth, The Art of Computer Programming 3, Sect. 6.4). Emptying it takes no time.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <utility>
#include <vector>

namespace vox {

class PlaceMap {
public:
    explicit PlaceMap(std::pmr::memory_resource* memory) noexcept : slots_(memory) {}

    static constexpr std::uint32_t none = 0xffffffffu;

    std::uint32_t size() const noexcept { return size_; }
    void clear() {
        size_ = 0;
        if (++age_ != 0) return;
        std::fill(slots_.begin(), slots_.end(), Slot{}); // after 2^32 times
        age_ = 1;
    }

    // The place of a number, which is size() as it was before when the number is new. Throws what the memory
    // throws, and changes nothing then.
    std::uint32_t add(std::uint32_t number) {
        if (2 * (std::size_t{size_} + 1) > slots_.size())
            reserve(std::max<std::size_t>(2 * slots_.size(), 64));
        Slot& slot = slots_[slot_of(number)];
        if (slot.age != age_) slot = {number, size_++, age_};
        return slot.place;
    }
    // The place of a number, or none.
    std::uint32_t operator[](std::uint32_t number) const noexcept {
        if (slots_.empty()) return none;
        const Slot& slot = slots_[slot_of(number)];
        return slot.age == age_ ? slot.place : none;
    }

    // The length of the table, a power of two.
    std::size_t capacity() const noexcept { return slots_.size(); }
    void reserve(std::size_t capacity) {
        if (capacity <= slots_.size()) return;
        std::pmr::vector<Slot> before(std::bit_ceil(capacity), slots_.get_allocator());
        slots_.swap(before);
        shift_ = 64 - static_cast<int>(std::bit_width(slots_.size() - 1));
        for (const Slot& slot : before)
            if (slot.age == age_) slots_[slot_of(slot.number)] = slot;
    }

private:
    struct Slot {
        std::uint32_t number = 0, place = 0;
        std::uint32_t age = 0; // age_ when it was used last
    };

    // The slot of a number, or the free one where it belongs.
    std::size_t slot_of(std::uint32_t number) const noexcept {
        std::size_t i = number * std::uint64_t{0x9e3779b97f4a7c15u} >> shift_;
        while (slots_[i].age == age_ && slots_[i].number != number) i = (i + 1) & (slots_.size() - 1);
        return i;
    }

    std::pmr::vector<Slot> slots_;
    std::uint32_t size_ = 0, age_ = 1;
    int shift_ = 64;
};

} // namespace vox
