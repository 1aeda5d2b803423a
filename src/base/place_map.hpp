// A hash table that numbers its keys in the order in which they were added (multiplicative hashing and linear
// probing, D. E. Knuth, The Art of Computer Programming 3, Sect. 6.4). Clearing it takes constant time.
//
// The author of a mesh can choose vertex numbers with neighbouring hashes. So a number that finds the first
// few slots taken goes to a digital search tree (Sect. 6.3 there), whose depth is bounded by the 32 bits of a
// number.
#pragma once

#include "base/array.hpp"
#include "base/prefetch.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory_resource>

namespace vox {

class PlaceMap {
public:
    explicit PlaceMap(std::pmr::memory_resource* memory) noexcept : slots_(memory), nodes_(memory) {}

    static constexpr std::uint32_t none = 0xffffffffu;
    static constexpr std::uint32_t most_slots = 16, most_nodes = 33; // visited for a number

    std::uint32_t size() const noexcept { return size_; }
    void clear() {
        size_ = 0;
        nodes_.clear();
        if (++age_ != 0) return;
        std::fill(slots_.begin(), slots_.end(), Slot{}); // after 2^32 times
        age_ = 1;
    }

    // The place of a number; a new number gets the next one. If it throws what the memory throws, nothing has
    // changed.
    std::uint32_t add(std::uint32_t number) {
        if (2 * (std::size_t{size_} + 1) > slots_.size())
            reserve(std::max<std::size_t>(2 * slots_.size(), 64));
        const std::uint32_t place = put(number, size_);
        if (place == size_) ++size_;
        return place;
    }
    // The place of a number, or none.
    std::uint32_t operator[](std::uint32_t number) const noexcept {
        return find(number, [] {});
    }
    // Loads the cache line that add() will read.
    void prefetch(std::uint32_t number) const noexcept {
        if (!slots_.empty()) vox::prefetch(&slots_[hash(number)]);
    }
    // How many slots and nodes a search for a number visits.
    std::uint32_t probes(std::uint32_t number) const noexcept {
        std::uint32_t count = 0;
        (void)find(number, [&] { ++count; });
        return count;
    }

    // The length of the table, a power of two.
    std::size_t capacity() const noexcept { return slots_.size(); }
    void reserve(std::size_t capacity) {
        if (capacity <= slots_.size()) return;
        PlaceMap larger(slots_.memory());
        larger.slots_.resize(std::bit_ceil(capacity));
        larger.shift_ = 64 - static_cast<int>(std::bit_width(larger.slots_.size() - 1));
        larger.nodes_.reserve(nodes_.capacity());
        for (const Slot& slot : slots_)
            if (slot.age == age_) larger.put(slot.number, slot.place);
        for (const Node& node : nodes_) larger.put(node.number, node.place);
        slots_.swap(larger.slots_);
        nodes_.swap(larger.nodes_);
        shift_ = larger.shift_;
        age_ = larger.age_;
    }
    auto& tree() noexcept { return nodes_; } // a buffer of its own, which reserve() does not enlarge

private:
    struct Slot {
        std::uint32_t number = 0, place = 0;
        std::uint32_t age = 0; // in use if it equals age_
    };
    struct Node {
        std::uint32_t number, place;
        std::uint32_t child[2]; // by the next bit; the root is the first node
    };

    std::size_t hash(std::uint32_t number) const noexcept {
        return number * std::uint64_t{0x9e3779b97f4a7c15u} >> shift_;
    }

    // Calls look() for each slot and node.
    template <class Look>
    std::uint32_t find(std::uint32_t number, Look&& look) const noexcept {
        if (slots_.empty()) return none;
        std::size_t i = hash(number);
        for (std::uint32_t n = 0; n < most_slots; ++n) {
            const Slot& slot = slots_[i];
            look();
            if (slot.age != age_) return none;
            if (slot.number == number) return slot.place;
            i = (i + 1) & (slots_.size() - 1);
        }
        std::uint32_t node = nodes_.empty() ? none : 0;
        for (std::uint32_t bits = number; node != none; bits >>= 1) {
            look();
            if (nodes_[node].number == number) return nodes_[node].place;
            node = nodes_[node].child[bits & 1];
        }
        return none;
    }

    // The place of a number, which is `place` when the number is new.
    std::uint32_t put(std::uint32_t number, std::uint32_t place) {
        std::size_t i = hash(number);
        for (std::uint32_t n = 0; n < most_slots; ++n) {
            Slot& slot = slots_[i];
            if (slot.age != age_) slot = {number, place, age_};
            if (slot.number == number) return slot.place;
            i = (i + 1) & (slots_.size() - 1);
        }
        return put_in_tree(number, place);
    }
    std::uint32_t put_in_tree(std::uint32_t number, std::uint32_t place) {
        std::uint32_t parent = none, side = 0;
        std::uint32_t node = nodes_.empty() ? none : 0;
        for (std::uint32_t bits = number; node != none; bits >>= 1) {
            if (nodes_[node].number == number) return nodes_[node].place;
            parent = node;
            side = bits & 1;
            node = nodes_[node].child[side];
        }
        nodes_.push_back({number, place, {none, none}});
        if (parent != none) nodes_[parent].child[side] = static_cast<std::uint32_t>(nodes_.size() - 1);
        return place;
    }

    Array<Slot> slots_;
    Array<Node> nodes_;
    std::uint32_t size_ = 0, age_ = 1;
    int shift_ = 64;
};

} // namespace vox
