/* A game: 300 soft bodies of about 500 tetrahedra each in one pile, on one thread. A frame has four parts:
 *
 *     contacts       vox_grid_step: which vertex is inside which body
 *     constraints    vox_grid_find_constraints: how deep, and which way is out
 *     sounds         vox_grid_get_pairs: a touch that begins is heard, as loud as the blow
 *     response       substeps of soft_bodies.h, which use the constraints
 *
 * What it prints is the same on every machine. `example_game times` prints what a frame takes, too. */
#include "soft_bodies.h"

#include <time.h>

enum { frames = 120, warm_up = 60, measured = frames - warm_up };

/* ---- memory: the game's own allocator, which counts ---- */

static uint64_t allocations;

static void* take(size_t size, size_t alignment, void* user) {
    (void)user;
    ++allocations;
    char* block = (char*)malloc(size + alignment + sizeof(void*));
    if (!block) return NULL;
    const uintptr_t first = (uintptr_t)block + sizeof(void*);
    void** memory = (void**)((first + alignment - 1) / alignment * alignment);
    memory[-1] = block; /* in front of it: what to free */
    return memory;
}

static void give_back(void* memory, size_t size, size_t alignment, void* user) {
    (void)size;
    (void)alignment;
    (void)user;
    free(((void**)memory)[-1]);
}

/* ---- sounds ---- */

static uint64_t began, ended, loud;

/* How fast the two bodies met, in metres per second. */
static double blow(const vox_constraint* c) {
    double speed = 0;
    for (uint32_t i = 0; i < c->count; ++i) speed -= c->weights[i] * dot(c->normal, v[vertex_of(c, i)]);
    return speed;
}

static void play_sounds(const vox_grid* grid, const vox_constraint_view* found) {
    vox_pair_view pairs;
    must(vox_grid_get_pairs(grid, &pairs));
    for (uint64_t p = 0; p < pairs.count; ++p) {
        began += pairs.data[p].state == VOX_PAIR_BEGAN;
        ended += pairs.data[p].state == VOX_PAIR_ENDED;
        if (pairs.data[p].state != VOX_PAIR_BEGAN) continue;
        double loudness = 0;
        for (uint64_t n = found->pair_offsets[p]; n < found->pair_offsets[p + 1]; ++n)
            loudness = fmax(loudness, blow(&found->data[n]));
        loud += loudness > 1; /* a game plays it here, at the constraint's position */
    }
}

/* ---- figures ---- */

static int ascending(const void* a, const void* b) {
    const double difference = *(const double*)a - *(const double*)b;
    return (difference > 0) - (difference < 0);
}

/* Of one part in each measured frame. */
static double print_times(const char* part, double* ms) {
    qsort(ms, measured, sizeof *ms, ascending);
    fprintf(stderr, "%-18s median %6.2f ms, worst %6.2f ms\n", part, ms[measured / 2], ms[measured - 1]);
    return ms[measured / 2];
}

static double ms_since(clock_t start) { return 1e3 * (double)(clock() - start) / CLOCKS_PER_SEC; }

/* Makes what the grid allocates once. The first search for a closest point in a body makes a tree for it, so
 * each body is put into its neighbours for a step, and out again. */
static void load(vox_grid* grid) {
    vox_constraint_desc desc = vox_default_constraint_desc();
    desc.method = VOX_DEPTH_METHOD_CLOSEST;
    place_bodies(0.8);
    must(vox_grid_step(grid));
    must(vox_grid_find_constraints(grid, &desc));
    place_bodies(2);
    must(vox_grid_step(grid));
    place_bodies(1.02);
}

int main(int argc, char** argv) {
    static double contacts_ms[frames], constraints_ms[frames], response_ms[frames];
    const vox_allocator allocator = {take, give_back, NULL};
    vox_grid_desc desc = vox_default_grid_desc();
    desc.allocator = &allocator;
    vox_grid* grid = NULL;
    must(vox_grid_create(&desc, &grid));
    make_shape();
    insert_bodies(grid);
    load(grid);
    printf("%d bodies, %u tets and %u vertices each\n", bodies, shape.tet_count, shape.vertex_count);

    vox_constraint_view found = {NULL, 0, NULL, 0};
    uint64_t before_measured = 0, in_contact = 0;
    for (int frame = 0; frame < frames; ++frame) {
        if (frame == warm_up) before_measured = allocations;
        clock_t start = clock();
        must(vox_grid_step(grid));
        contacts_ms[frame] = ms_since(start);
        must(vox_grid_find_constraints(grid, NULL));
        constraints_ms[frame] = ms_since(start);
        must(vox_grid_get_constraints(grid, &found));
        play_sounds(grid, &found);
        start = clock();
        for (int i = 0; i < substeps; ++i) substep(&found);
        response_ms[frame] = ms_since(start);
        if (frame >= warm_up) in_contact += found.count;
        if (frame % 30 == 29)
            printf("frame %3d: %5" PRIu64 " contacts, %5" PRIu64 " constraints, %4" PRIu64 " pairs\n",
                   frame + 1, contact_count(grid), found.count, found.pair_count);
    }
    uint64_t hash = 0;
    must(vox_grid_get_hash(grid, &hash));
    printf("touches: %" PRIu64 " began, %" PRIu64 " of them loud; %" PRIu64 " ended\n", began, loud, ended);
    printf("allocations after frame %d: %" PRIu64 "\n", warm_up, allocations - before_measured);
    printf("hash %016" PRIx64 "\n", hash);
    if (argc > 1 && strcmp(argv[1], "times") == 0) {
        const double contacts = print_times("contacts alone", contacts_ms + warm_up),
                     constraints = print_times("with constraints", constraints_ms + warm_up);
        print_times("response", response_ms + warm_up);
        fprintf(stderr, "%.1f ns a tet; constraints: %.0f ns more a vertex in contact\n",
                1e6 * contacts / (bodies * shape.tet_count),
                1e6 * (constraints - contacts) * measured / (double)in_contact);
    }
    vox_grid_destroy(grid);
    free_bodies();
    return 0;
}
