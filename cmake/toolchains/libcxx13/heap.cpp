// The functions of <experimental/memory_resource>. Emscripten's library has them in some of its variants
// only, and there new_delete_resource() refuses alignments above that of a double.
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

memory_resource* null_memory_resource() noexcept {
    class None final : public memory_resource {
        void* do_allocate(size_t, size_t) override { throw bad_alloc(); }
        void do_deallocate(void*, size_t, size_t) override {}
        bool do_is_equal(const memory_resource& other) const noexcept override { return this == &other; }
    };
    static None none;
    return &none;
}

memory_resource* get_default_resource() noexcept { return new_delete_resource(); }

} // namespace pmr
} // namespace fundamentals_v1
} // namespace experimental
} // namespace std
