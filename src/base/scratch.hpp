// Memory for one call. It comes from a buffer in the object and, when that is full, from `upstream`, by
// default the heap. Space in the buffer is reused only if allocations are released last to first.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory_resource>

namespace vox {

template <std::size_t bytes>
class Scratch final : public std::pmr::memory_resource {
public:
    // Leaves the buffer uninitialised.
    explicit Scratch(std::pmr::memory_resource* upstream = std::pmr::new_delete_resource()) noexcept
        : upstream_(upstream) {}

private:
    bool is_in_buffer(const void* memory) const noexcept {
        const auto at = reinterpret_cast<std::uintptr_t>(memory),
                   begin = reinterpret_cast<std::uintptr_t>(buffer_);
        return at >= begin && at < begin + bytes;
    }
    void* do_allocate(std::size_t size, std::size_t alignment) override {
        const std::size_t first = (used_ + alignment - 1) / alignment * alignment;
        if (alignment > alignof(std::max_align_t) || first > bytes || size > bytes - first)
            return upstream_->allocate(size, alignment);
        used_ = first + size;
        return buffer_ + first;
    }
    void do_deallocate(void* memory, std::size_t size, std::size_t alignment) override {
        auto* place = static_cast<std::byte*>(memory);
        if (!is_in_buffer(memory))
            upstream_->deallocate(memory, size, alignment);
        else if (place + size == buffer_ + used_)
            used_ -= size;
    }
    bool do_is_equal(const memory_resource& other) const noexcept override { return this == &other; }

    alignas(std::max_align_t) std::byte buffer_[bytes];
    std::size_t used_ = 0;
    std::pmr::memory_resource* upstream_;
};

} // namespace vox
