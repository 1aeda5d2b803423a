/* Threads, in the module that has them: a pool for all grids of it. Each thread is a Worker that has
 * instantiated the same module over the same memory (lib/thread.js); they are started when the module is
 * loaded, and never return.
 *
 * The thread that calls the library is worker 0. It offers a task, takes part, withdraws the offer when
 * nothing is left to take, and waits for those who accepted, as the built-in scheduler does
 * (src/base/scheduler.cpp). But it waits awake, as the thread of a page must not sleep. */
#include <vox/vox.h>

#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

#define IMPORT(name) __attribute__((import_module("env"), import_name(#name)))
#define EXPORT __attribute__((used, visibility("default")))

enum {
    STACK_BYTES = 1 << 20,
    PATIENCE = 20000 /* looks for a task before a thread sleeps: the next mostly comes soon */
};

/* ---- what the C library asks of JavaScript ---- */

IMPORT(voxtet_now) double voxtet_now(void); /* milliseconds */

int clock_gettime(clockid_t clock, struct timespec* out) {
    (void)clock;
    const double now = voxtet_now();
    out->tv_sec = (time_t)(now / 1e3);
    out->tv_nsec = (long)((now - 1e3 * (double)out->tv_sec) * 1e6);
    return 0;
}

double emscripten_get_now(void);
int emscripten_resize_heap(size_t size);
void* emscripten_memcpy_big(void* to, const void* from, size_t size);
void emscripten_check_blocking_allowed(void);

double emscripten_get_now(void) { return voxtet_now(); }

/* Makes the memory at least `size` bytes large. */
int emscripten_resize_heap(size_t size) {
    const size_t page = 1 << 16, pages = __builtin_wasm_memory_size(0);
    const size_t wanted = size / page + (size % page != 0),
                 more = pages / 8; /* so that there are few of these calls */
    if (wanted <= pages) return 1;
    if (wanted - pages < more && pages + more <= 65536 && __builtin_wasm_memory_grow(0, more) != (size_t)-1)
        return 1;
    return __builtin_wasm_memory_grow(0, wanted - pages) != (size_t)-1;
}

void* emscripten_memcpy_big(void* to, const void* from, size_t size) {
    return __builtin_memcpy(to, from, size); /* an instruction, where there are threads */
}

void emscripten_check_blocking_allowed(void) {}

/* In 64 KiB, as that of 4 GiB is no number of 32 bits. */
EXPORT uint32_t voxtet_memory_pages(void) { return (uint32_t)__builtin_wasm_memory_size(0); }

/* ---- the pool ---- */

/* The two halves of `state`: threads that may still join the task; those that have joined and not left. */
#define ONE_OFFER (UINT32_C(1) << 16)
#define MEMBERS (ONE_OFFER - 1)

static struct {
    vox_task* task; /* written while nobody is a member */
    void* context;
    uint64_t items, least;
    _Alignas(64) _Atomic uint64_t taken; /* items that were handed out */
    _Alignas(64) _Atomic uint32_t state;
    _Atomic uint32_t asleep;
    _Atomic bool failed; /* a thread has ended in the middle of a task */
} pool;
static uint32_t thread_count;

/* Ranges become smaller towards the end, for all to end together. */
static bool take(uint64_t* begin, uint64_t* end) {
    const uint64_t shares = 4 * ((uint64_t)thread_count + 1);
    uint64_t at = atomic_load(&pool.taken);
    do {
        if (at >= pool.items) return false;
        const uint64_t left = pool.items - at, share = left / shares,
                       size = share > pool.least ? share : pool.least;
        *begin = at;
        *end = left <= size || left - size < pool.least ? pool.items : at + size;
    } while (!atomic_compare_exchange_weak(&pool.taken, &at, *end));
    return true;
}

static void work(uint32_t worker) {
    for (uint64_t begin, end; take(&begin, &end);) pool.task(begin, end, worker, pool.context);
}

static void* run(vox_task* task, uint64_t item_count, uint64_t min_range, void* context, void* user) {
    (void)user;
    pool.task = task;
    pool.context = context;
    pool.items = item_count;
    pool.least = min_range ? min_range : 1;
    atomic_store(&pool.taken, 0);
    const uint64_t ranges = item_count / pool.least;
    const uint32_t offers = ranges <= 1                 ? 0
                            : ranges - 1 < thread_count ? (uint32_t)(ranges - 1)
                                                        : thread_count;
    atomic_store(&pool.state, offers * ONE_OFFER);
    /* A thread counts itself as asleep before its last look at `state`; so one of the two sees the other. */
    if (offers && atomic_load(&pool.asleep)) __builtin_wasm_memory_atomic_notify((int*)&pool.state, offers);
    work(0);
    atomic_fetch_and(&pool.state, MEMBERS);
    while (atomic_load(&pool.state) != 0)
        if (atomic_load(&pool.failed)) abort();
    return NULL; /* all calls have returned */
}

static void finish(void* handle, void* user) {
    (void)handle;
    (void)user;
}

/* The grid uses all threads. */
EXPORT void voxtet_set_threads(vox_grid_desc* desc) {
    static const vox_task_system tasks = {run, finish, NULL};
    if (thread_count == 0) return;
    desc->tasks = &tasks;
    desc->worker_count = thread_count + 1;
}

/* ---- the threads ---- */

/* What a Worker is told; JavaScript reads `stack`. */
struct start {
    char* stack; /* its high end */
    uint32_t worker;
};

static void* serve(void* argument) {
    const uint32_t worker = ((const struct start*)argument)->worker;
    for (;;) {
        uint32_t state = atomic_load(&pool.state);
        for (int i = 0; state < ONE_OFFER && i < PATIENCE; ++i) state = atomic_load(&pool.state);
        if (state < ONE_OFFER) {
            atomic_fetch_add(&pool.asleep, 1);
            state = atomic_load(&pool.state);
            if (state < ONE_OFFER) __builtin_wasm_memory_atomic_wait32((int*)&pool.state, (int)state, -1);
            atomic_fetch_sub(&pool.asleep, 1);
            continue;
        }
        if (!atomic_compare_exchange_strong(&pool.state, &state, state - ONE_OFFER + 1)) continue;
        work(worker);
        atomic_fetch_sub(&pool.state, 1);
    }
    return NULL;
}

/* Asks JavaScript for `count` Workers, by __pthread_create_js, and returns how many there will be. */
EXPORT uint32_t voxtet_start_threads(uint32_t count) {
    while (thread_count < count) {
        struct start* const start = malloc(sizeof *start);
        char* const stack = aligned_alloc(16, STACK_BYTES);
        pthread_attr_t attributes;
        pthread_t thread;
        if (!start || !stack) break;
        *start = (struct start){stack + STACK_BYTES, thread_count + 1};
        pthread_attr_init(&attributes);
        pthread_attr_setstack(&attributes, stack, STACK_BYTES);
        if (pthread_create(&thread, &attributes, serve, start) != 0) break;
        ++thread_count;
    }
    return thread_count;
}

EXPORT void voxtet_run_thread(void* start) { serve(start); }

/* A thread has trapped. Who waits for it must not wait for ever. */
EXPORT void voxtet_thread_failed(void) { atomic_store(&pool.failed, true); }
