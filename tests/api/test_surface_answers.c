/* All answers of a surface: where memory runs out, call by call; budgets; the steady state; the caller's
 * tasks and several workers; pieces; what is left untouched; counters. */
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#include "support/ledger.h"
#include "support/surface_counter.h"

/* Two sheets through each other, which move across each other. */
enum { side = 14, sheet = side * side, vertices = 2 * sheet, faces = 4 * (side - 1) * (side - 1) };
static double at[2][vertices * 3];
static uint32_t corners[faces * 3];

static void make_sheets(void) {
    uint64_t count = 0;
    for (uint32_t k = 0; k < 2; ++k)
        for (uint32_t i = 0; i < sheet; ++i) {
            double* const p = at[0] + 3 * (k * sheet + i);
            const double x = i % side, y = i / side;
            p[0] = x + 0.31 * k;
            p[1] = y + 0.17 * k;
            p[2] = k ? 0.9 * sin(x / 5) * cos(y / 7) : 0.1 * sin(x * y);
            for (int axis = 0; axis < 3; ++axis) at[1][3 * (k * sheet + i) + axis] = p[axis];
            at[1][3 * (k * sheet + i) + 2] += k ? -0.5 : 0.25 * sin(x);
        }
    for (uint32_t k = 0; k < 2; ++k)
        for (uint32_t i = 0; i + side < sheet; ++i)
            if (i % side + 1 < side) {
                const uint32_t v = k * sheet + i;
                const uint32_t two[6] = {v, v + 1, v + side, v + side, v + 1, v + side + 1};
                memcpy(corners + 3 * count, two, sizeof two);
                count += 2;
            }
    ck_assert_uint_eq(count, faces);
}

static vox_surface_desc desc_of_sheets(ledger* book) {
    make_sheets();
    vox_surface_desc desc = vox_default_surface_desc();
    desc.vertex_count = vertices;
    desc.faces = corners;
    desc.face_count = faces;
    if (book) desc.allocator = ledger_allocator(book);
    return desc;
}

/* To and fro; an even step begins with sheets that cross each other. */
static vox_result move_sheets(vox_surface* surface, int step) {
    vox_motion motion = vox_default_motion();
    motion.from.data = at[step & 1];
    motion.to.data = at[!(step & 1)];
    motion.from.count = motion.to.count = vertices;
    motion.from.format = motion.to.format = VOX_FORMAT_DOUBLE;
    motion.radius = 0.01;
    return vox_surface_move(surface, &motion);
}

static vox_surface* sheets(const vox_surface_desc* desc) {
    vox_surface* surface = NULL;
    ck_ok(vox_surface_create(desc, &surface));
    ck_ok(move_sheets(surface, 0));
    return surface;
}

static void add(uint64_t* hash, const void* items, uint64_t bytes) {
    const unsigned char* const p = (const unsigned char*)items;
    for (uint64_t i = 0; i < bytes; ++i) *hash = (*hash ^ p[i]) * 1099511628211u;
}

/* The answers, by number; each adds what it found to `hash`. */
typedef enum answer { PAIRS, CROSSINGS, CLOSE, CLEARANCE, SAFE_STEP, TIMES, SUGGESTION, ANSWERS } answer;
static const char* const names[ANSWERS] = {"pairs",     "crossings", "close",     "clearance",
                                           "safe step", "times",     "suggestion"};

static vox_result ask(vox_surface* surface, int which, uint64_t* hash) {
    vox_result result;
    if (which == PAIRS) {
        for (uint64_t first = 0;;) {
            vox_partner_lists lists;
            result = vox_surface_find_pairs(surface, VOX_FEATURE_EDGE, VOX_FEATURE_EDGE, first, UINT64_MAX,
                                            &lists);
            if (result != VOX_OK) return result;
            if (lists.count == 0) break;
            for (uint64_t i = 0; i < lists.count; ++i) { /* the same for any pieces */
                const uint64_t length = lists.offsets[i + 1] - lists.offsets[i];
                add(hash, &length, sizeof length);
                add(hash, lists.partners + lists.offsets[i], length * sizeof *lists.partners);
            }
            first += lists.count;
        }
        return VOX_OK;
    }
    if (which == CROSSINGS) {
        vox_crossing_view view;
        result = vox_surface_find_crossings(surface, &view);
        if (result == VOX_OK) add(hash, view.data, view.count * sizeof *view.data);
        return result;
    }
    if (which == CLOSE) {
        vox_proximity_view view;
        result = vox_surface_find_proximities(surface, VOX_FEATURE_FACE, VOX_FEATURE_VERTEX, 0.4, &view);
        if (result == VOX_OK) add(hash, view.data, view.count * sizeof *view.data);
        return result;
    }
    if (which == CLEARANCE) {
        static double each[vertices];
        for (int i = 0; i < vertices; ++i) each[i] = -7;
        result = vox_surface_find_clearances(surface, 1, each);
        for (int i = 0; i < vertices; ++i) ck_assert(result == VOX_OK ? each[i] >= 0 : each[i] == -7);
        add(hash, each, sizeof each);
        return result;
    }
    if (which == SAFE_STEP) {
        vox_safe_step step;
        result = vox_surface_find_safe_step(surface, NULL, &step);
        if (result == VOX_OK) add(hash, &step, sizeof step);
        return result;
    }
    if (which == TIMES) {
        vox_impact_view view;
        result = vox_surface_find_impacts(surface, VOX_FEATURE_EDGE, VOX_FEATURE_EDGE, NULL, &view);
        if (result == VOX_OK) add(hash, view.data, view.count * sizeof *view.data);
        return result;
    }
    vox_cell_size_result suggestion = {.struct_size = sizeof suggestion};
    result = vox_surface_suggest_cell_size(surface, VOX_FEATURE_EDGE, VOX_FEATURE_EDGE, &suggestion);
    if (result == VOX_OK) add(hash, &suggestion.cell_size, sizeof suggestion.cell_size);
    return result;
}

static uint64_t hash_of(vox_surface* surface, int which) {
    uint64_t hash = 14695981039346656037u;
    ck_ok(ask(surface, which, &hash));
    return hash;
}

/* Each of them from a surface of its own. */
static void expect(uint64_t expected[ANSWERS]) {
    const vox_surface_desc desc = desc_of_sheets(NULL);
    for (int which = 0; which < ANSWERS; ++which) {
        vox_surface* const surface = sheets(&desc);
        expected[which] = hash_of(surface, which);
        vox_surface_destroy(surface);
    }
}

/* Where memory runs out, call by call: an error, and the same answer afterwards, the others too. */
START_TEST(memory_that_runs_out) {
    uint64_t expected[ANSWERS], ignored = 0;
    expect(expected);
    for (uint32_t workers = 1; workers <= 3; workers += 2) {
        ledger book = {0};
        vox_surface_desc desc = desc_of_sheets(&book);
        desc.worker_count = workers;
        uint64_t failures = 0;
        for (uint64_t n = 1;; ++n) { /* the call that fails, counted from the question on */
            memset(&book, 0, sizeof book);
            desc.allocator = ledger_allocator(&book);
            vox_surface* const surface = sheets(&desc);
            book.fail_at = book.calls + n;
            const vox_result result = ask(surface, _i, &ignored);
            const bool failed = book.calls >= book.fail_at;
            book.fail_at = 0;
            ck_assert_int_eq(result, failed ? VOX_ERROR_OUT_OF_MEMORY : VOX_OK);
            ck_assert_msg(hash_of(surface, _i) == expected[_i], "%s after call %u", names[_i], (unsigned)n);
            const int other = (_i + 1) % ANSWERS;
            ck_assert_msg(hash_of(surface, other) == expected[other], "%s after %s", names[other], names[_i]);
            vox_surface_destroy(surface);
            ck_assert_uint_eq(book.bytes, 0);
            if (!failed) break;
            ++failures;
        }
        ck_assert_uint_gt(failures, 5);
    }
}
END_TEST

/* Any budget is kept, and gives the whole answer or says that it does not suffice. */
START_TEST(budgets) {
    uint64_t expected[ANSWERS], ignored = 0;
    expect(expected);
    vox_surface_desc desc = desc_of_sheets(NULL);
    vox_surface* surface = sheets(&desc);
    const uint64_t moved = surface_counter(surface, "peak_bytes");
    (void)hash_of(surface, _i);
    const uint64_t most = surface_counter(surface, "peak_bytes");
    vox_surface_destroy(surface);
    uint32_t refused = 0, answered = 0;
    for (uint32_t share = 0; share <= 24; ++share) {
        desc.byte_budget = moved + (most - moved) * share / 20;
        surface = sheets(&desc);
        const vox_result result = ask(surface, _i, &ignored);
        ck_assert(result == VOX_OK || result == VOX_ERROR_BUDGET);
        ++*(result == VOX_OK ? &answered : &refused);
        if (result == VOX_OK) ck_assert_uint_eq(hash_of(surface, _i), expected[_i]);
        ck_assert_uint_le(surface_counter(surface, "peak_bytes"), desc.byte_budget);
        vox_surface_destroy(surface);
    }
    ck_assert_msg(refused > 0 && answered > 4, "%s: refused %u, answered %u", names[_i], refused, answered);
}
END_TEST

/* After the first answers, the same motions take no more memory. */
START_TEST(no_memory_in_the_steady_state) {
    ledger book = {0};
    vox_surface_desc desc = desc_of_sheets(&book);
    vox_surface* const surface = sheets(&desc);
    uint64_t calls = 0;
    for (int step = 0; step < 8; ++step) {
        ck_ok(move_sheets(surface, step));
        for (int which = PAIRS; which < SUGGESTION; ++which) (void)hash_of(surface, which);
        if (step == 3) calls = book.calls;
        if (step > 3) ck_assert_uint_eq(book.calls, calls);
    }
    vox_surface_destroy(surface);
    ck_assert_uint_eq(book.bytes, 0);
}
END_TEST

/* The caller's tasks: they are used, by several workers, with the caller's allocator; what they lose is said.
 */
typedef struct queue {
    uint64_t enqueued;
    bool loses_items;
} queue;

static void* run_in_three(vox_task* task, uint64_t item_count, uint64_t min_range, void* context,
                          void* user) {
    queue* const q = (queue*)user;
    (void)min_range;
    ++q->enqueued;
    task(item_count / 3, item_count / 2, 1, context);
    task(0, item_count / 3, 2, context);
    if (!q->loses_items) task(item_count / 2, item_count, 0, context);
    return NULL;
}

static void finish_nothing(void* handle, void* user) {
    (void)handle;
    (void)user;
}

START_TEST(tasks_of_the_caller) {
    uint64_t expected[ANSWERS], ignored = 0;
    expect(expected);
    ledger book = {0};
    queue q = {0, false};
    vox_surface_desc desc = desc_of_sheets(&book);
    desc.worker_count = 3;
    const vox_task_system tasks = {run_in_three, finish_nothing, &q};
    desc.tasks = &tasks;
    vox_surface* const surface = sheets(&desc);
    for (int which = 0; which < ANSWERS; ++which) {
        const uint64_t before = q.enqueued;
        if (which != SUGGESTION) {
            q.loses_items = true;
            ck_fails(ask(surface, which, &ignored), VOX_ERROR_INVALID_ARGUMENT, "items");
            q.loses_items = false;
            ck_assert_uint_gt(q.enqueued, before);
        }
        ck_assert_msg(hash_of(surface, which) == expected[which], "%s", names[which]);
    }
    ck_assert_uint_gt(book.calls, 10);
    vox_surface_destroy(surface);
    ck_assert_uint_eq(book.bytes, 0);
}
END_TEST

/* Pieces go on where the caller asks, also after pieces of other kinds and after a motion. */
START_TEST(pieces_of_several_kinds) {
    vox_surface_desc desc = desc_of_sheets(NULL);
    vox_surface* const whole = sheets(&desc);
    static const vox_feature kinds[3][2] = {{VOX_FEATURE_EDGE, VOX_FEATURE_EDGE},
                                            {VOX_FEATURE_FACE, VOX_FEATURE_VERTEX},
                                            {VOX_FEATURE_EDGE, VOX_FEATURE_FACE}};
    uint64_t pairs = 0;
    for (int k = 0; k < 3; ++k) {
        vox_partner_lists lists;
        ck_ok(vox_surface_find_pairs(whole, kinds[k][0], kinds[k][1], 0, UINT64_MAX, &lists));
        const uint64_t found = lists.offsets[lists.count];
        pairs = pairs > found ? pairs : found;
    }
    desc.byte_budget = surface_counter(whole, "bytes") - pairs * sizeof(uint32_t) / 2;
    vox_surface* const tight = sheets(&desc);
    uint32_t cut = 0, asked = 0;
    for (int step = 0; step < 4; ++step) {
        ck_ok(move_sheets(whole, step));
        ck_ok(move_sheets(tight, step));
        uint64_t first[3] = {0, 0, 0};
        bool done[3] = {false, false, false};
        while (!done[0] || !done[1] || !done[2])
            for (int k = 0; k < 3; ++k) {
                if (done[k]) continue;
                vox_partner_lists all, some;
                ck_ok(vox_surface_find_pairs(whole, kinds[k][0], kinds[k][1], 0, UINT64_MAX, &all));
                ck_ok(vox_surface_find_pairs(tight, kinds[k][0], kinds[k][1], first[k], UINT64_MAX, &some));
                ++asked;
                ck_assert_uint_eq(some.first, first[k]);
                ck_assert_uint_gt(some.count, 0);
                for (uint64_t i = 0; i <= some.count; ++i)
                    ck_assert_uint_eq(some.offsets[i], all.offsets[first[k] + i] - all.offsets[first[k]]);
                ck_assert_mem_eq(some.partners, all.partners + all.offsets[first[k]],
                                 some.offsets[some.count] * sizeof *some.partners);
                first[k] += some.count;
                done[k] = first[k] == all.count;
                cut += !done[k];
                if (asked % 5 == 0) ck_ok(move_sheets(tight, step)); /* the same motion again */
            }
    }
    ck_assert_uint_gt(cut, 3);
    vox_surface_destroy(whole);
    vox_surface_destroy(tight);
}
END_TEST

/* What the counters say of the last search. */
START_TEST(counters) {
    const vox_surface_desc desc = desc_of_sheets(NULL);
    vox_surface* const surface = sheets(&desc);
    vox_partner_lists lists;
    ck_ok(vox_surface_find_pairs(surface, VOX_FEATURE_EDGE, VOX_FEATURE_EDGE, 0, UINT64_MAX, &lists));
    const uint64_t pairs = lists.offsets[lists.count], tiles = (lists.count + 63) / 64; /* at least */
    const uint64_t cells = surface_counter(surface, "cells"), bytes = surface_counter(surface, "bytes"),
                   tile_pairs = surface_counter(surface, "tile_pairs"),
                   compared = surface_counter(surface, "boxes_compared");
    ck_assert_uint_eq(surface_counter(surface, "overlaps"), pairs);
    ck_assert_uint_eq(surface_counter(surface, "culled"), 0);
    ck_assert_uint_ge(tile_pairs, tiles);
    ck_assert_uint_le(tile_pairs, 16 * tiles * tiles);
    ck_assert_uint_ge(compared, tile_pairs);
    ck_assert_uint_le(compared, 64 * tile_pairs);
    ck_assert_uint_ge(surface_counter(surface, "peak_bytes"), bytes);
    ck_assert_uint_gt(bytes, pairs * sizeof *lists.partners);
    /* A part of the features takes a part of the work. */
    ck_ok(vox_surface_find_pairs(surface, VOX_FEATURE_EDGE, VOX_FEATURE_EDGE, 0, 1, &lists));
    ck_assert_uint_lt(surface_counter(surface, "boxes_compared"), compared / 2);
    ck_assert_uint_eq(surface_counter(surface, "overlaps"), lists.offsets[1]);
    /* A cell size that is set is used, and changes no more than how the work is done. */
    ck_ok(vox_surface_set_cell_size(surface, 1000));
    ck_ok(vox_surface_find_pairs(surface, VOX_FEATURE_EDGE, VOX_FEATURE_EDGE, 0, UINT64_MAX, &lists));
    const uint64_t large = surface_counter(surface, "cells");
    ck_assert(0 < large && large <= 8 && large < cells); /* around the origin */
    ck_assert_uint_eq(surface_counter(surface, "tile_pairs"), tile_pairs);
    ck_assert_uint_eq(surface_counter(surface, "overlaps"), pairs);
    vox_surface_destroy(surface);
}
END_TEST

SUITE(surface_answers) {
    TCase* tests = add_case(suite, "surface answers");
    tcase_add_loop_test(tests, memory_that_runs_out, 0, ANSWERS);
    tcase_add_loop_test(tests, budgets, 0, ANSWERS);
    tcase_add_each(tests, no_memory_in_the_steady_state, tasks_of_the_caller, pieces_of_several_kinds,
                   counters);
}
