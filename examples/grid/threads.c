/* Threads: a task system of one's own (here it runs its ranges one after another, last first), and the
 * built-in one. The contacts are the same. */
#include "example.h"

enum { workers = 4, cubes = 300 };

typedef struct queue {
    vox_task* task;
    void* context;
    uint64_t items, range;
} queue;

/* Cuts the work in ranges; a real one would hand them to its threads now. */
static void* enqueue(vox_task* task, uint64_t item_count, uint64_t min_range, void* context, void* user) {
    queue* q = (queue*)user;
    q->task = task;
    q->context = context;
    q->items = item_count;
    q->range = item_count / workers + 1 > min_range ? item_count / workers + 1 : min_range;
    return q;
}

/* ... and would wait for them here. No two ranges that run at the same time may have the same worker. */
static void finish(void* handle, void* user) {
    const queue* q = (const queue*)handle;
    (void)user;
    for (uint64_t r = (q->items + q->range - 1) / q->range; r-- > 0;) {
        const uint64_t end = (r + 1) * q->range < q->items ? (r + 1) * q->range : q->items;
        q->task(r * q->range, end, (uint32_t)(r % workers), q->context);
    }
}

static uint64_t hash_of_step(const vox_grid_desc* desc, const cube* many) {
    vox_grid* grid = NULL;
    uint64_t hash = 0;
    must(vox_grid_create(desc, &grid));
    for (int i = 0; i < cubes; ++i) insert_cube(grid, &many[i]);
    must(vox_grid_step(grid));
    must(vox_grid_get_hash(grid, &hash));
    printf("%" PRIu64 " contacts\n", contact_count(grid));
    vox_grid_destroy(grid);
    return hash;
}

int main(void) {
    static cube many[cubes];
    queue q = {NULL, NULL, 0, 0};
    for (int i = 0; i < cubes; ++i)
        many[i] = cube_at(0.8f * (float)(i % 10), 0.7f * (float)(i / 10 % 6), 0.9f * (float)(i / 60));
    vox_grid_desc serial = vox_default_grid_desc(), built_in = serial, own = serial;
    built_in.worker_count = VOX_ALL_CORES; /* a thread a core */
    own.worker_count = workers;
    const vox_task_system tasks = {enqueue, finish, &q};
    own.tasks = &tasks;
    const uint64_t one = hash_of_step(&serial, many), two = hash_of_step(&built_in, many),
                   three = hash_of_step(&own, many);
    printf("%s\n", one == two && two == three ? "the same contacts" : "DIFFERENT CONTACTS");
    return one == two && two == three ? 0 : 1;
}
