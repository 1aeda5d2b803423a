// Memory that counts what is taken from it, and refuses what does not fit its budget.
#pragma once

#include "base/error.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <memory_resource>

class CountingMemory final : public std::pmr::memory_resource {
public:
    explicit CountingMemory(std::size_t most = std::numeric_limits<std::size_t>::max()) : budget(most) {}

    std::size_t budget;
    std::size_t allocations = 0;
    std::size_t bytes = 0, peak = 0; // in use, and the most there ever were

private:
    void* do_allocate(std::size_t size, std::size_t alignment) override {
        if (size > budget - bytes)
            throw vox::Error(VOX_ERROR_BUDGET, vox::format("%zu bytes do not fit", size));
        ++allocations;
        bytes += size;
        peak = std::max(peak, bytes);
        return std::pmr::new_delete_resource()->allocate(size, alignment);
    }
    void do_deallocate(void* memory, std::size_t size, std::size_t alignment) override {
        bytes -= size;
        std::pmr::new_delete_resource()->deallocate(memory, size, alignment);
    }
    bool do_is_equal(const memory_resource& other) const noexcept override { return this == &other; }
};
