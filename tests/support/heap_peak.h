/* The most heap that a piece of code has at once. Measured under the address sanitizer, which reports each
 * allocation; in other builds always 0. */
#ifndef VOX_TESTS_HEAP_PEAK_H
#define VOX_TESTS_HEAP_PEAK_H

#include <stddef.h>

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define VOX_TESTS_HEAP_IS_MEASURED 1
#endif
#elif defined(__SANITIZE_ADDRESS__)
#define VOX_TESTS_HEAP_IS_MEASURED 1
#endif

#ifdef VOX_TESTS_HEAP_IS_MEASURED

/* From <sanitizer/allocator_interface.h>, which Debian's gcc lacks. */
size_t __sanitizer_get_allocated_size(const volatile void* pointer);
int __sanitizer_install_malloc_and_free_hooks(void (*allocated)(const volatile void* pointer, size_t size),
                                              void (*freed)(const volatile void* pointer));

static size_t heap_bytes_, heap_peak_;

static void heap_count_(const volatile void* pointer, size_t size) {
    (void)pointer;
    heap_bytes_ += size;
    if (heap_bytes_ > heap_peak_) heap_peak_ = heap_bytes_;
}

static void heap_discount_(const volatile void* pointer) {
    const size_t size = pointer ? __sanitizer_get_allocated_size(pointer) : 0;
    heap_bytes_ -= size < heap_bytes_ ? size : heap_bytes_; /* it may be from before the count */
}

/* Forgets what was allocated so far. */
static inline void heap_begin(void) {
    static int installed = 0;
    if (!installed) __sanitizer_install_malloc_and_free_hooks(heap_count_, heap_discount_);
    installed = 1;
    heap_bytes_ = heap_peak_ = 0;
}
static inline size_t heap_peak(void) { return heap_peak_; }

#else

static inline void heap_begin(void) {}
static inline size_t heap_peak(void) { return 0; }

#endif
#endif
