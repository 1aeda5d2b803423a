// The memory of a grid. It puts the caller's allocator behind std::pmr, counts every byte, and never exceeds
// the budget.
#pragma once

#include <vox/vox.h>

#include <atomic>
#include <cstdint>
#include <memory_resource>
#include <mutex>

namespace vox {

// Many threads may use it at once; it calls the caller's functions from one at a time.
class GridMemory final : public std::pmr::memory_resource {
public:
    std::uint64_t budget() const noexcept { return budget_; }
    std::uint64_t bytes() const noexcept { return bytes_; }
    std::uint64_t peak_bytes() const noexcept { return peak_bytes_; }

private:
    friend class MemoryShare;
    GridMemory(const vox_allocator& allocator, std::uint64_t byte_budget) noexcept
        : allocator_(allocator), budget_(byte_budget), bytes_(sizeof *this), peak_bytes_(sizeof *this) {}

    // Throw Error(BUDGET) or std::bad_alloc.
    void* do_allocate(std::size_t size, std::size_t alignment) override;
    void do_deallocate(void* memory, std::size_t size, std::size_t alignment) override;
    bool do_is_equal(const memory_resource& other) const noexcept override { return this == &other; }

    vox_allocator allocator_;
    std::mutex mutex_;
    std::uint64_t budget_; // 0 for none
    std::uint64_t bytes_;
    std::uint64_t peak_bytes_;
    std::atomic<std::uint64_t> shares_ = 1;
};

// A share in the memory of a grid. The grid has one, and so has each of its locators, which may outlive it;
// the memory lives as long as there is a share. Many threads may copy and destroy shares at once.
class MemoryShare {
public:
    // The first share. Takes the memory for the GridMemory itself from the allocator; throws std::bad_alloc.
    MemoryShare(const vox_allocator* allocator, std::uint64_t byte_budget);
    MemoryShare(const MemoryShare& other) noexcept : memory_(other.memory_) {
        memory_.shares_.fetch_add(1, std::memory_order_relaxed);
    }
    MemoryShare& operator=(const MemoryShare&) = delete;
    ~MemoryShare();

    GridMemory& operator*() const noexcept { return memory_; }
    GridMemory* operator->() const noexcept { return &memory_; }

private:
    MemoryShare(const vox_allocator& allocator, std::uint64_t byte_budget);

    GridMemory& memory_;
};

// The limit that a byte_budget of vox.h stands for.
inline std::uint64_t byte_limit(std::uint64_t byte_budget) noexcept {
    return byte_budget == 0 ? std::uint64_t{4} << 30 : byte_budget;
}

// One allocation by the caller's functions, or from the C++ heap if there are none. Null if there is no
// memory.
void* allocate(const vox_allocator& allocator, std::size_t size, std::size_t alignment) noexcept;
void release(const vox_allocator& allocator, void* memory, std::size_t size, std::size_t alignment) noexcept;

} // namespace vox
