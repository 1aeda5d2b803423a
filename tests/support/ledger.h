/* An allocator that keeps count of what a grid takes, and fails at a chosen call. */
#ifndef VOX_TESTS_LEDGER_H
#define VOX_TESTS_LEDGER_H

#include <stdint.h>
#include <vox/vox.h>

#include "support/aligned.h"

typedef struct ledger {
    uint64_t bytes;   /* held now */
    uint64_t peak;    /* most ever held */
    uint64_t taken;   /* all that were ever taken */
    uint64_t calls;   /* to allocate, failed ones included */
    uint64_t fail_at; /* the one of these calls that fails; 0: none */
    vox_allocator allocator;
} ledger;

static inline void* ledger_allocate(size_t size, size_t alignment, void* user) {
    ledger* l = (ledger*)user;
    if (++l->calls == l->fail_at) return NULL;
    void* memory = allocate_aligned(size, alignment);
    if (!memory) return NULL;
    l->bytes += size;
    l->taken += size;
    if (l->bytes > l->peak) l->peak = l->bytes;
    return memory;
}

static inline void ledger_release(void* memory, size_t size, size_t alignment, void* user) {
    (void)alignment;
    ((ledger*)user)->bytes -= size;
    free_aligned(memory);
}

/* For vox_grid_desc.allocator; lives as long as the ledger. */
static inline const vox_allocator* ledger_allocator(ledger* l) {
    const vox_allocator allocator = {ledger_allocate, ledger_release, l};
    l->allocator = allocator;
    return &l->allocator;
}

#endif
