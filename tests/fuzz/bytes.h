/* What fuzz targets share: a condition that must hold, and the input, byte by byte. */
#ifndef VOX_TESTS_FUZZ_BYTES_H
#define VOX_TESTS_FUZZ_BYTES_H

#include <stdint.h>
#include <stdlib.h>

static inline void demand(int condition) {
    if (!condition) abort();
}

typedef struct bytes {
    const uint8_t* data;
    size_t size;
} bytes;

/* The next byte, 0 after the last. */
static inline uint32_t next(bytes* b) {
    if (b->size == 0) return 0;
    --b->size;
    return *b->data++;
}

#endif
