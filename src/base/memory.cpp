#include "base/memory.hpp"

#include "base/error.hpp"
#include "base/float_environment.hpp"
#include "base/llu.hpp"

#include <algorithm>
#include <new>

#if defined(__linux__)
#include <cerrno>
#include <cstdint>
#include <sys/mman.h>
#endif

namespace vox {

namespace {

// Asks for huge pages within a large block. The arrays of a large scene are read in the order of tiles, not
// of addresses, so with small pages every other read would miss the TLB. Nothing depends on the answer.
void advise_huge_pages([[maybe_unused]] void* memory, [[maybe_unused]] std::size_t size) noexcept {
#if defined(__linux__) && defined(MADV_HUGEPAGE)
    constexpr std::uintptr_t page = std::uintptr_t{1} << 21; // on x86-64, and on Arm with pages of 4 KiB
    const auto begin = (reinterpret_cast<std::uintptr_t>(memory) + page - 1) & ~(page - 1),
               end = (reinterpret_cast<std::uintptr_t>(memory) + size) & ~(page - 1);
    if (!memory || end <= begin) return;
    const int error = errno;
    (void)madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
    errno = error;
#endif
}

} // namespace

void* allocate(const vox_allocator& allocator, std::size_t size, std::size_t alignment) noexcept {
    if (allocator.allocate) {
        const CallersFloats floats;
        return allocator.allocate(size, alignment, allocator.user);
    }
    void* memory = ::operator new(size, std::align_val_t(alignment), std::nothrow);
    advise_huge_pages(memory, size);
    return memory;
}

void release(const vox_allocator& allocator, void* memory, std::size_t size, std::size_t alignment) noexcept {
    if (allocator.release) {
        const CallersFloats floats;
        allocator.release(memory, size, alignment, allocator.user);
    } else {
        ::operator delete(memory, std::align_val_t(alignment));
    }
}

namespace {

void* allocated(const vox_allocator& allocator, std::size_t size, std::size_t alignment) {
    void* memory = vox::allocate(allocator, size, alignment);
    if (!memory) throw std::bad_alloc();
    return memory;
}

} // namespace

MemoryShare::MemoryShare(const vox_allocator* caller, std::uint64_t byte_budget)
    : MemoryShare(caller ? *caller : vox_allocator{}, byte_budget) {}

MemoryShare::MemoryShare(const vox_allocator& allocator, std::uint64_t byte_budget)
    : memory_(*new (allocated(allocator, sizeof(GridMemory), alignof(GridMemory)))
                  GridMemory(allocator, byte_budget)) {}

MemoryShare::~MemoryShare() {
    if (memory_.shares_.fetch_sub(1, std::memory_order_acq_rel) > 1) return;
    const vox_allocator allocator = memory_.allocator_;
    memory_.~GridMemory();
    release(allocator, &memory_, sizeof(GridMemory), alignof(GridMemory));
}

void* GridMemory::do_allocate(std::size_t size, std::size_t alignment) {
    const std::lock_guard lock(mutex_);
    if (size > budget_ || bytes_ > budget_ - size)
        throw Error(VOX_ERROR_BUDGET,
                    format("%llu bytes are held and %llu more are needed; the byte budget is %llu",
                           llu(bytes_), llu(size), llu(budget_)));
    void* memory = allocated(allocator_, size, alignment);
    bytes_ += size;
    peak_bytes_ = std::max(peak_bytes_, bytes_);
    return memory;
}

void GridMemory::do_deallocate(void* memory, std::size_t size, std::size_t alignment) {
    const std::lock_guard lock(mutex_);
    vox::release(allocator_, memory, size, alignment);
    bytes_ -= size;
}

} // namespace vox
