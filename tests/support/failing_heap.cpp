#include "support/failing_heap.hpp"

void* operator new(std::size_t size) { return heap::take_or_throw(size, 1); }
void* operator new[](std::size_t size) { return heap::take_or_throw(size, 1); }
void* operator new(std::size_t size, const std::nothrow_t&) noexcept { return heap::take(size, 1); }
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept { return heap::take(size, 1); }
void* operator new(std::size_t size, std::align_val_t to) {
    return heap::take_or_throw(size, std::size_t(to));
}
void* operator new[](std::size_t size, std::align_val_t to) {
    return heap::take_or_throw(size, std::size_t(to));
}
void* operator new(std::size_t size, std::align_val_t to, const std::nothrow_t&) noexcept {
    return heap::take(size, std::size_t(to));
}
void* operator new[](std::size_t size, std::align_val_t to, const std::nothrow_t&) noexcept {
    return heap::take(size, std::size_t(to));
}
void operator delete(void* memory) noexcept { heap::give(memory); }
void operator delete[](void* memory) noexcept { heap::give(memory); }
void operator delete(void* memory, std::size_t) noexcept { heap::give(memory); }
void operator delete[](void* memory, std::size_t) noexcept { heap::give(memory); }
void operator delete(void* memory, const std::nothrow_t&) noexcept { heap::give(memory); }
void operator delete[](void* memory, const std::nothrow_t&) noexcept { heap::give(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { heap::give(memory); }
void operator delete[](void* memory, std::align_val_t) noexcept { heap::give(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { heap::give(memory); }
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept { heap::give(memory); }
void operator delete(void* memory, std::align_val_t, const std::nothrow_t&) noexcept { heap::give(memory); }
void operator delete[](void* memory, std::align_val_t, const std::nothrow_t&) noexcept { heap::give(memory); }
