/* Memory at an alignment, on POSIX and on Windows, where it has a function of its own that frees it. */
#ifndef VOX_TESTS_ALIGNED_H
#define VOX_TESTS_ALIGNED_H

#include <stdlib.h>
#if defined(_WIN32)
#include <malloc.h>
#endif

/* Null where there is none. */
static inline void* allocate_aligned(size_t size, size_t alignment) {
#if defined(_WIN32)
    return _aligned_malloc(size ? size : 1, alignment);
#else
    void* memory = NULL;
    if (posix_memalign(&memory, alignment < sizeof(void*) ? sizeof(void*) : alignment, size ? size : 1) != 0)
        return NULL;
    return memory;
#endif
}

static inline void free_aligned(void* memory) {
#if defined(_WIN32)
    _aligned_free(memory);
#else
    free(memory);
#endif
}

#endif
