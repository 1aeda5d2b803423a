/* Many grids in one call. */
#include <stdio.h>
#include <string.h>
#if defined(__linux__)
#include <dirent.h>
#include <unistd.h>
#endif

#include "scenes/bodies.h"
#include "support/suite.h"

enum { count = 40 };

typedef struct scenes {
    body bodies[count][2];
    vox_grid* grids[count];
    uint64_t contacts[count]; /* of steps one by one */
} scenes;

static uint64_t hash_of(const vox_grid* grid) {
    uint64_t hash = 0;
    ck_ok(vox_grid_get_hash(grid, &hash));
    return hash;
}

/* Pairs of boxes, deeper and larger from scene to scene; in the first one they are apart. */
static void make_scenes(scenes* s) {
    vox_grid_desc grid_desc = vox_default_grid_desc();
    grid_desc.flags = VOX_GRID_CONSTRAINTS;
    for (uint32_t i = 0; i < count; ++i) {
        s->bodies[i][0] = make_box(2 + i % 4, 0.25f, 0, 0, 0);
        s->bodies[i][1] = make_box(3, 0.2f, i == 0 ? 3 : 0.4f - 0.01f * (float)i, 0.11f, 0.12f);
        s->grids[i] = grid_of(&grid_desc);
        for (int b = 0; b < 2; ++b) {
            const vox_mesh_desc desc = body_desc(&s->bodies[i][b]);
            insert_mesh(s->grids[i], &desc);
        }
        ck_ok(vox_grid_step(s->grids[i]));
        s->contacts[i] = contacts_of(s->grids[i]).count;
        ck_ok(vox_grid_clear(s->grids[i]));
        for (int b = 0; b < 2; ++b) {
            const vox_mesh_desc desc = body_desc(&s->bodies[i][b]);
            insert_mesh(s->grids[i], &desc);
        }
    }
}

static void free_scenes(scenes* s) {
    for (uint32_t i = 0; i < count; ++i) {
        vox_grid_destroy(s->grids[i]);
        for (int b = 0; b < 2; ++b) free_body(&s->bodies[i][b]);
    }
}

START_TEST(as_one_by_one) {
    static const uint32_t workers[] = {1, 0, 2, 7};
    scenes s;
    make_scenes(&s);
    uint64_t hashes[count], contacts = 0;
    for (size_t w = 0; w < sizeof workers / sizeof *workers; ++w) {
        vox_result results[count];
        memset(results, 0x55, sizeof results);
        ck_ok(vox_grids_step(s.grids, count, workers[w], NULL, results));
        for (uint32_t i = 0; i < count; ++i) {
            /* The ids of meshes are other ones after a clear, and so are hashes. */
            ck_assert_int_eq(results[i], VOX_OK);
            ck_assert_uint_eq(contacts_of(s.grids[i]).count, s.contacts[i]);
            contacts += s.contacts[i];
            if (w == 0) hashes[i] = hash_of(s.grids[i]);
            ck_assert_uint_eq(hash_of(s.grids[i]), hashes[i]);
            if (s.contacts[i] > 0)
                ck_ok(vox_body_mark_moved(s.grids[i], contacts_of(s.grids[i]).data[0].body_a));
        }
    }
    ck_assert_uint_gt(contacts, 4000);
    ck_ok(vox_grids_step(NULL, 0, 2, NULL, NULL));
    free_scenes(&s);
}
END_TEST

START_TEST(failures) {
    scenes s;
    make_scenes(&s);
    const float zero = 0;
    s.bodies[7][0].positions[5] = zero / zero;
    s.bodies[30][1].positions[0] = 1 / zero;
    vox_result results[count];
    for (uint32_t workers = 1; workers <= 2; ++workers) {
        memset(results, 0x55, sizeof results);
        ck_fails(vox_grids_step(s.grids, count, workers, NULL, results), VOX_ERROR_NON_FINITE, "grid 7: ");
        ck_assert_ptr_nonnull(strstr(vox_last_error(), "vertex 1"));
        for (uint32_t i = 0; i < count; ++i) {
            const int bad = i == 7 || i == 30;
            ck_assert_int_eq(results[i], bad ? VOX_ERROR_NON_FINITE : VOX_OK);
            ck_assert_uint_eq(contacts_of(s.grids[i]).count, bad ? 0 : s.contacts[i]);
        }
    }
    ck_fails(vox_grids_step(s.grids, count, 2, NULL, NULL), VOX_ERROR_NON_FINITE, "grid 7: ");
    free_scenes(&s);
}
END_TEST

static uint64_t epoch_of(const vox_grid* grid) {
    uint64_t epoch = 0;
    epoch = grid_info(grid).epoch;
    return epoch;
}

static void* runs_nothing(vox_task* task, uint64_t items, uint64_t min_range, void* context, void* user) {
    (void)task, (void)min_range, (void)context;
    *(uint64_t*)user += items;
    return NULL;
}
static void waits_for_nothing(void* handle, void* user) { (void)handle, (void)user; }

START_TEST(arguments) {
    scenes s;
    make_scenes(&s);
    vox_result results[count];
    uint64_t items = 0;
    const uint64_t epoch = epoch_of(s.grids[0]);
    vox_grid *const second = s.grids[2], *const last = s.grids[count - 1];
    const vox_task_system half = {runs_nothing, NULL, &items},
                          whole = {runs_nothing, waits_for_nothing, &items};
    memset(results, 0x55, sizeof results);
    ck_fails(vox_grids_step(NULL, 1, 1, NULL, NULL), VOX_ERROR_INVALID_ARGUMENT, "grids is null");
    ck_fails(vox_grids_step(s.grids, count, VOX_MAX_WORKERS + 1, NULL, results), VOX_ERROR_INVALID_ARGUMENT,
             "worker_count is 257");
    ck_fails(vox_grids_step(s.grids, count, 2, &half, results), VOX_ERROR_INVALID_ARGUMENT, "one of enqueue");
    ck_fails(vox_grids_step(s.grids, count, VOX_ALL_CORES, &whole, results), VOX_ERROR_INVALID_ARGUMENT,
             "worker_count is VOX_ALL_CORES");
    s.grids[2] = s.grids[count - 1];
    ck_fails(vox_grids_step(s.grids, count, 1, NULL, results), VOX_ERROR_INVALID_ARGUMENT,
             "grids[2] and grids[39] are the same");
    s.grids[2] = second;
    s.grids[count - 1] = NULL;
    ck_fails(vox_grids_step(s.grids, count, 1, NULL, results), VOX_ERROR_INVALID_ARGUMENT,
             "grids[39] is null");
    s.grids[count - 1] = last;
    ck_assert_uint_eq(items, 0);
    for (uint32_t i = 0; i < count; ++i) ck_assert_int_eq(results[i], 0x55555555);
    ck_assert_uint_eq(epoch_of(s.grids[0]), epoch);
    /* A task system that loses the grids. */
    ck_fails(vox_grids_step(s.grids, count, 2, &whole, results), VOX_ERROR_INVALID_ARGUMENT,
             "ran 0 of 40 items");
    ck_assert_uint_eq(items, count);
    free_scenes(&s);
}
END_TEST

#if defined(__linux__)
static int threads_of_process(void) {
    DIR* const folder = opendir("/proc/self/task");
    ck_assert_ptr_nonnull(folder);
    int found = 0;
    while (readdir(folder)) ++found;
    closedir(folder);
    return found;
}

/* Making threads takes as long as the step of a small scene: those of one call serve the next one. */
START_TEST(threads_are_kept) {
    if (!strstr(vox_build_info(), "std::thread") || sysconf(_SC_NPROCESSORS_ONLN) < 2) return;
    scenes s;
    make_scenes(&s);
    ck_ok(vox_grids_step(s.grids, count, 1, NULL, NULL));
    const int before = threads_of_process();
    for (int times = 0; times < 5; ++times) {
        ck_ok(vox_grids_step(s.grids, count, 2, NULL, NULL));
        /* The first thread may bring one of a sanitizer. */
        ck_assert_int_ge(threads_of_process(), before + 1);
        ck_assert_int_le(threads_of_process(), before + 2);
    }
    free_scenes(&s);
    ck_assert_int_ge(threads_of_process(), before + 1); /* not of any grid */
}
END_TEST
#endif

SUITE(grids) {
    TCase* tests = add_case(suite, "many grids");
    tcase_add_each(tests, as_one_by_one, failures, arguments);
#if defined(__linux__)
    tcase_add_test(tests, threads_are_kept);
#endif
}
