/* Memory and log: a grid that lives in memory of one's own, under a budget, and logs what it does. */
#include "example.h"

#include <vox/vox_cell_size.h>

typedef struct arena {
    uint64_t bytes, calls;
} arena;

/* Alignment is at most that of a cache line; malloc gives less, so the block's start is kept in front of it.
 */
static void* take(size_t size, size_t alignment, void* user) {
    arena* a = (arena*)user;
    char* block = (char*)malloc(size + alignment + sizeof(void*));
    if (!block) return NULL; /* the call that needed it fails with VOX_ERROR_OUT_OF_MEMORY */
    const uintptr_t first = (uintptr_t)block + sizeof(void*);
    void** memory = (void**)((first + alignment - 1) / alignment * alignment);
    memory[-1] = block;
    a->bytes += size;
    a->calls += 1;
    return memory;
}

static void give_back(void* memory, size_t size, size_t alignment, void* user) {
    (void)alignment;
    ((arena*)user)->bytes -= size;
    free(((void**)memory)[-1]);
}

static void print(vox_log_level level, const char* text, void* user) {
    (void)user;
    printf("%s: %s\n", level == VOX_LOG_WARNING ? "warning" : "log", text);
}

int main(void) {
    arena a = {0, 0};
    vox_grid_desc desc = vox_default_grid_desc();
    const vox_allocator allocator = {take, give_back, &a};
    desc.allocator = &allocator;
    const vox_log log = {print, NULL};
    desc.log = &log;
    desc.byte_budget = 1 << 20;
    const vox_reference_desc reference = vox_default_reference_desc();
    desc.reference = &reference; /* it logs the cell size that it chooses */

    vox_grid* grid = NULL;
    must(vox_grid_create(&desc, &grid));
    cube first = cube_at(0, 0, 0), second = cube_at(0.5f, 0.5f, 0.5f);
    insert_cube(grid, &first);
    insert_cube(grid, &second);
    must(vox_grid_step(grid));
    must(vox_grid_step(grid));
    const uint64_t calls = a.calls;
    for (int frame = 0; frame < 100; ++frame) {
        move_cube(&second, 0.001f, 0, 0);
        must(vox_grid_step(grid));
    }
    printf("%s held; allocations in 100 steps: %" PRIu64 "\n", a.bytes > 0 ? "some bytes" : "no bytes",
           a.calls - calls);
    vox_grid_destroy(grid);
    printf("bytes left: %" PRIu64 "\n", a.bytes);
    return 0;
}
