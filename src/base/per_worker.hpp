// The state of each worker: buffers kept from step to step, and counts of the step.
#pragma once

#include "base/array.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <tuple>

namespace vox {

// T is constructed from a memory_resource*. T::buffers() returns a tuple of references to all its buffers,
// which have capacity() and reserve().
template <class T>
class PerWorker {
public:
    explicit PerWorker(std::pmr::memory_resource* memory) : slots_(memory) {}

    // Never shrinks.
    void grow(std::size_t count) {
        while (slots_.size() < count) slots_.emplace_back(slots_.memory());
    }

    T& operator[](std::uint32_t worker) noexcept { return slots_[worker]; }
    auto begin() noexcept { return slots_.begin(); }
    auto end() noexcept { return slots_.end(); }

    // Resizes the buffers of all workers to the largest: in a later step each may have to do what another did
    // in this one, and the steady state must not allocate.
    void level() {
        if (slots_.size() < 2) return;
        using Buffers = decltype(slots_[0].buffers());
        std::array<std::size_t, std::tuple_size_v<Buffers>> most{};
        const auto for_each = [&](auto&& visit) {
            for (T& slot : slots_)
                std::apply(
                    [&](auto&... buffers) {
                        std::size_t i = 0;
                        (visit(buffers, most[i++]), ...);
                    },
                    slot.buffers());
        };
        for_each([](auto& buffer, std::size_t& room) { room = std::max(room, buffer.capacity()); });
        for_each([](auto& buffer, std::size_t& room) { buffer.reserve(room); });
    }

private:
    struct alignas(64) Slot : T { // no two workers write to one cache line
        using T::T;
    };
    Array<Slot> slots_;
};

} // namespace vox
