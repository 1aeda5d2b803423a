// The caller's allocator as a memory resource, for objects that are not a grid (see base/memory.hpp). This
// header uses no symbol that is not public, so that vox_io and vox_sim can share it.
#pragma once

#include "base/error.hpp"
#include "base/float_environment.hpp"

#include <vox/vox.h>

#include <cstddef>
#include <memory_resource>
#include <new>

namespace vox {

// Throws INVALID_ARGUMENT for an allocator with only one of its two functions.
inline void check_allocator(const vox_allocator* allocator, const char* name) {
    if (allocator && !allocator->allocate != !allocator->release)
        refuse(format("%s has one of allocate and release, expected both or none", name));
}

// The C++ heap if the allocator is null or has no functions. One thread at a time may use it.
class CallerMemory final : public std::pmr::memory_resource {
public:
    explicit CallerMemory(const vox_allocator* allocator) noexcept
        : allocator_(allocator ? *allocator : vox_allocator{}) {}

private:
    void* do_allocate(std::size_t size, std::size_t alignment) override {
        if (!allocator_.allocate) return std::pmr::new_delete_resource()->allocate(size, alignment);
        const CallersFloats floats;
        void* memory = allocator_.allocate(size, alignment, allocator_.user);
        if (!memory) throw std::bad_alloc();
        return memory;
    }
    void do_deallocate(void* memory, std::size_t size, std::size_t alignment) override {
        if (!allocator_.release) return std::pmr::new_delete_resource()->deallocate(memory, size, alignment);
        const CallersFloats floats;
        allocator_.release(memory, size, alignment, allocator_.user);
    }
    bool do_is_equal(const memory_resource& other) const noexcept override { return this == &other; }

    vox_allocator allocator_;
};

} // namespace vox
