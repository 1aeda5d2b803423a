#ifndef VOX_TESTS_TURNS_H
#define VOX_TESTS_TURNS_H

#include <stdint.h>
#include <vox/vox.h>

/* A task system without threads: one worker does all, or each in turn does as little as it may. Threads would
 * share it in another way in every run. */
typedef struct turns {
    uint32_t worker_count;
    int in_turn;
} turns;

static inline void* take_turns(vox_task* task, uint64_t items, uint64_t min_range, void* context,
                               void* user) {
    const turns* t = (const turns*)user;
    const uint64_t size = !t->in_turn ? items : min_range ? min_range : 1;
    uint32_t worker = 0;
    for (uint64_t begin = 0; begin < items; begin += size, worker = (worker + 1) % t->worker_count)
        task(begin, begin + size < items ? begin + size : items, worker, context);
    return NULL;
}

static inline void taken(void* handle, void* user) { (void)handle, (void)user; }

#endif
