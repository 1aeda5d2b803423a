// The two functions of <experimental/memory_resource> that libc++ keeps in a library which Emscripten leaves out.
#include <memory_resource>
#include <new>

namespace std {
namespace experimental {
inline namespace fundamentals_v1 {
namespace pmr {

memory_resource* new_delete_resource() noexcept {
    class Heap final : public memory_resource {
        void* do_allocate(size_t size, size_t alignment) override {
            return ::operator new(size, align_val_t(alignment));
        }
        void do_deallocate(void* memory, size_t, size_t alignment) override {
            ::operator delete(memory, align_val_t(alignment));
        }
        bool do_is_equal(const memory_resource& other) const noexcept override { return this == &other; }
    };
    static Heap heap;
    return &heap;
}

memory_resource* get_default_resource() noexcept { return new_delete_resource(); }

} // namespace pmr
} // namespace fundamentals_v1
} // namespace experimental
} // namespace std
