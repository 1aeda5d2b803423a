/* vox_foreign_grid_fit and vox_foreign_grid_tune: arguments, errors, callbacks that fail or stop, and what
 * they promise of a real description. The numbers are in tests/internal/test_tune.cpp. */
#include "support/suite.h"

#include <math.h>
#include <stddef.h>
#include <string.h>
#include <vox/vox_cell_size.h>

/* 1000 boxes of edge 1 in a cube of edge 10. */
enum { count = 1000 };
static float corners[count][2][3];
static vox_primitives boxes;
static vox_foreign_grid grid;

static void make_grid(void) {
    int i, axis;
    for (i = 0; i < count; ++i)
        for (axis = 0; axis < 3; ++axis) {
            const double place = 9.0 * fmod((i + 1) * (axis == 0   ? 0.7548776662
                                                       : axis == 1 ? 0.5698402910
                                                                   : 0.3247179572),
                                            1.0);
            corners[i][0][axis] = (float)place;
            corners[i][1][axis] = (float)(place + 1);
        }
    boxes = vox_default_primitives();
    boxes.type = VOX_PRIMITIVE_BOX;
    boxes.positions.data = corners;
    boxes.positions.count = 2 * count;
    boxes.count = count;
    grid = vox_default_foreign_grid();
    grid.stored = &boxes;
    grid.weights.run = 1e4;
    grid.weights.store = 20;
    grid.weights.visit = 10;
    grid.weights.read = 3;
}

/* What a run of that grid takes, by its own counts. */
static double seconds_at(double cell_size) {
    vox_foreign_counts work;
    ck_ok(vox_foreign_grid_count(&grid, cell_size, &work));
    return 1e-9 * (1e4 + 20 * work.stored + 10 * work.visits + 3 * work.reads);
}

/* ---- fit -------------------------------------------------------------------------------------- */

static vox_timing timings[4];

static void make_timings(void) {
    static const double sizes[4] = {0.6, 1.2, 2.4, 1.2};
    int i;
    make_grid();
    for (i = 0; i < 4; ++i) {
        timings[i].cell_size = sizes[i];
        timings[i].seconds = seconds_at(sizes[i]);
    }
}

static void fit_fails(const vox_foreign_grid* described, const vox_timing* given, uint64_t given_count,
                      vox_result code, const char* words) {
    vox_cell_size_result out, before;
    memset(&out, 0x5a, sizeof out);
    out.struct_size = sizeof out;
    before = out;
    ck_fails(vox_foreign_grid_fit(described, given, given_count, &out), code, words);
    ck_assert_mem_eq(&out, &before, sizeof out);
}

START_TEST(fit) {
    vox_cell_size_result out, small, suggestion;
    make_timings();
    out.struct_size = sizeof out;
    ck_ok(vox_foreign_grid_fit(&grid, timings, 4, &out));
    ck_assert_uint_eq(out.warnings, 0);
    ck_assert_double_le(out.fit_error, 0.05);
    ck_assert_uint_eq(out.curve_count, VOX_CURVE_CAPACITY);
    ck_assert_double_le(out.zone_min, out.cell_size);
    ck_assert_double_ge(out.zone_max, out.cell_size);
    ck_assert_double_eq_tol(out.cost, seconds_at(out.cell_size), 0.05 * out.cost);
    ck_assert_double_eq(out.expected_loss, 0);
    ck_assert_uint_eq(out.timing_count | out.term_count | out.rule_count, 0);
    /* The zone is as wide as the grid says. */
    grid.zone_loss = 0.01;
    small.struct_size = sizeof small;
    ck_ok(vox_foreign_grid_fit(&grid, timings, 4, &small));
    ck_assert_double_gt(small.zone_min, out.zone_min);
    ck_assert_double_lt(small.zone_max, out.zone_max);
    /* The weights can be put into the description, and lead to the same size. */
    grid.weights = out.weights;
    suggestion.struct_size = sizeof suggestion;
    ck_ok(vox_foreign_grid_suggest(&grid, &suggestion));
    ck_assert_double_eq_tol(suggestion.cell_size, out.cell_size, 0.05 * out.cell_size);
    ck_assert_double_eq_tol(suggestion.cost, out.cost, 0.02 * out.cost);
    /* An older caller's struct. */
    memset(&small, 0x5a, sizeof small);
    small.struct_size = offsetof(vox_cell_size_result, zone_min);
    make_timings();
    ck_ok(vox_foreign_grid_fit(&grid, timings, 4, &small));
    ck_assert_double_eq(small.cell_size, out.cell_size);
    ck_assert_int_eq(((unsigned char*)&small.zone_min)[0], 0x5a);
}
END_TEST

START_TEST(bad_timings) {
    static const double bad_sizes[] = {0, -1, NAN, INFINITY};
    static const double bad_seconds[] = {0, -1, NAN, INFINITY, 1e31, 1e-31};
    int i;
    make_timings();
    ck_fails(vox_foreign_grid_fit(&grid, timings, 3, NULL), VOX_ERROR_INVALID_ARGUMENT, "out is null");
    fit_fails(NULL, timings, 3, VOX_ERROR_INVALID_ARGUMENT, "grid is null");
    fit_fails(&grid, NULL, 3, VOX_ERROR_INVALID_ARGUMENT, "timings is null");
    fit_fails(&grid, NULL, 0, VOX_ERROR_INVALID_ARGUMENT, "0 different cell sizes, expected at least 3");
    fit_fails(&grid, timings + 1, 3, VOX_ERROR_INVALID_ARGUMENT,
              "2 different cell sizes, expected at least 3");
    fit_fails(&grid, timings, UINT64_MAX, VOX_ERROR_LIMIT, "count is 18446744073709551615");
    for (i = 0; i < 4; ++i) {
        make_timings();
        timings[1].cell_size = bad_sizes[i];
        fit_fails(&grid, timings, 3, VOX_ERROR_INVALID_ARGUMENT, "timings[1].cell_size is");
    }
    for (i = 0; i < 6; ++i) {
        make_timings();
        timings[2].seconds = bad_seconds[i];
        fit_fails(&grid, timings, 3, VOX_ERROR_INVALID_ARGUMENT, "timings[2].seconds is");
    }
    make_timings();
    grid.min_cell_size = 1;
    fit_fails(&grid, timings, 3, VOX_ERROR_INVALID_ARGUMENT,
              "timings[0].cell_size is 0.6, expected at least the smallest that gives right answers, 1");
    make_timings();
    timings[1].cell_size = 1e-150;
    fit_fails(&grid, timings, 3, VOX_ERROR_LIMIT, "the smallest cell size timed is 1e-150, so small");
    make_timings();
    grid.stored = NULL;
    fit_fails(&grid, timings, 3, VOX_ERROR_INVALID_ARGUMENT, "grid.stored is null");
}
END_TEST

/* ---- tune ------------------------------------------------------------------------------------- */

struct machine {
    int calls;
    int stop_after;   /* runs; 0: never */
    double too_small; /* cannot run below this */
    double answer;    /* instead, if it is not 0 */
};

static double run(double cell_size, void* user) {
    struct machine* machine = user;
    ++machine->calls;
    if (machine->stop_after && machine->calls > machine->stop_after) return NAN;
    if (machine->answer != 0) return machine->answer;
    if (cell_size < machine->too_small) return INFINITY;
    return seconds_at(cell_size);
}

static void tune_fails(const vox_tune_desc* desc, vox_result code, const char* words, int calls) {
    struct machine machine = {0, 0, 0, 0};
    vox_cell_size_result out, before;
    memset(&out, 0x5a, sizeof out);
    out.struct_size = sizeof out;
    before = out;
    ck_fails(vox_foreign_grid_tune(&grid, desc, run, &machine, &out), code, words);
    ck_assert_mem_eq(&out, &before, sizeof out);
    ck_assert_int_eq(machine.calls, calls);
}

/* By the description, by a first size alone, and twice the same. */
START_TEST(tune) {
    struct machine machine = {0, 0, 0, 0};
    vox_tune_desc desc = vox_default_tune_desc();
    vox_cell_size_result suggestion, out, again, blind;
    make_grid();
    memset(&out, 0, sizeof out);
    memset(&again, 0, sizeof again);
    out.struct_size = again.struct_size = blind.struct_size = sizeof out;
    suggestion.struct_size = sizeof suggestion;
    ck_ok(vox_foreign_grid_suggest(&grid, &suggestion));
    ck_ok(vox_foreign_grid_tune(&grid, NULL, run, &machine, &out));
    ck_assert_int_eq(machine.calls, (int)out.timing_count);
    ck_assert_uint_le(out.timing_count, 7);
    ck_assert_double_eq(out.timings[0].cell_size, suggestion.cell_size);
    ck_assert_double_eq(out.timings[0].seconds, seconds_at(suggestion.cell_size));
    ck_assert_uint_eq(out.warnings, 0);
    ck_assert_double_le(seconds_at(out.cell_size), 1.02 * seconds_at(suggestion.cell_size));
    ck_assert_double_eq_tol(out.cost, seconds_at(out.cell_size), 0.05 * out.cost);
    ck_assert_double_le(out.expected_loss, 0.02);
    ck_assert_double_le(out.fit_error, 0.05);
    ck_assert_double_gt(out.weights.store + out.weights.visit, 0);
    ck_ok(vox_foreign_grid_tune(&grid, &desc, run, &machine, &again));
    ck_assert_mem_eq(&again, &out, sizeof out);

    /* The zone is as wide as the grid says. */
    grid.zone_loss = 0.01;
    ck_ok(vox_foreign_grid_tune(&grid, &desc, run, &machine, &again));
    ck_assert_double_eq(again.cell_size, out.cell_size);
    ck_assert_double_gt(again.zone_min, out.zone_min);
    ck_assert_double_lt(again.zone_max, out.zone_max);

    desc.first = 1.5;
    ck_ok(vox_foreign_grid_tune(NULL, &desc, run, &machine, &blind));
    ck_assert_double_eq(blind.timings[0].cell_size, 1.5);
    ck_assert_double_le(seconds_at(blind.cell_size), 1.05 * seconds_at(out.cell_size));
    ck_assert_double_eq(blind.weights.store, 0);
}
END_TEST

START_TEST(tune_that_stops_or_fails) {
    struct machine machine = {0, 2, 0, 0};
    vox_cell_size_result out;
    make_grid();
    out.struct_size = sizeof out;
    ck_ok(vox_foreign_grid_tune(&grid, NULL, run, &machine, &out));
    ck_assert_uint_eq(out.timing_count, 2);
    ck_assert_uint_ne(out.warnings & VOX_CELL_SIZE_STOPPED, 0);
    ck_assert_ptr_nonnull(strstr(out.note, "stopped at run 3"));
    /* Small sizes cannot run. */
    memset(&machine, 0, sizeof machine);
    machine.too_small = out.timings[0].cell_size;
    ck_ok(vox_foreign_grid_tune(&grid, NULL, run, &machine, &out));
    ck_assert_double_ge(out.cell_size, machine.too_small);
    ck_assert_ptr_nonnull(strstr(out.note, "cannot run at cell size"));
    ck_assert(isinf(out.timings[1].seconds));
    /* Nothing ran, and a clock that is too coarse. */
    memset(&out, 0x5a, sizeof out);
    out.struct_size = sizeof out;
    machine.answer = -1;
    ck_fails(vox_foreign_grid_tune(&grid, NULL, run, &machine, &out), VOX_ERROR_INVALID_STATE,
             "no run succeeded");
    machine.answer = INFINITY;
    ck_fails(vox_foreign_grid_tune(&grid, NULL, run, &machine, &out), VOX_ERROR_INVALID_STATE,
             "7 could not run");
    machine.answer = 1e-40;
    ck_fails(vox_foreign_grid_tune(&grid, NULL, run, &machine, &out), VOX_ERROR_INVALID_ARGUMENT,
             "expected at least 1e-30");
    ck_assert_int_eq(out.note[0], 0x5a);
}
END_TEST

static const struct {
    uint32_t max_runs;
    double min, max, first, wanted_loss;
    const char* words;
} bad_descs[] = {
    {2, 0, 0, 0, 0.02, "max_runs is 2, expected 3 to 32"},
    {33, 0, 0, 0, 0.02, "max_runs is 33, expected 3 to 32"},
    {7, 2, 1, 0, 0.02, "min and max are 2 and 1,"},
    {7, 2, 0, 0, 0.02, "min and max are 2 and 0,"},
    {7, 0, 2, 0, 0.02, "min and max are 0 and 2,"},
    {7, -1, 2, 0, 0.02, "min is -1,"},
    {7, NAN, 2, 0, 0.02, "min is nan,"},
    {7, 1, INFINITY, 0, 0.02, "max is inf,"},
    {7, 1, 2, 3, 0.02, "first is 3, expected from min, 1, to max, 2"},
    {7, 0, 0, -3, 0.02, "first is -3,"},
    {7, 0, 0, NAN, 0.02, "first is nan,"},
    {7, 0, 0, 1e308, 0.02, "first cell size is 1e+308"},
    {7, 0, 0, 0.5, 0.02, "first is 0.5, the smallest that gives right answers is 0.75"},
    {7, 0.1, 0.7, 0, 0.02, "max is 0.7, the smallest that gives right answers is 0.75"},
    {7, 0, 0, 0, -1, "wanted_loss is -1,"},
    {7, 0, 0, 0, NAN, "wanted_loss is nan,"},
};

START_TEST(bad_desc) {
    vox_tune_desc desc = vox_default_tune_desc();
    make_grid();
    grid.min_cell_size = 0.75;
    desc.max_runs = bad_descs[_i].max_runs;
    desc.min = bad_descs[_i].min;
    desc.max = bad_descs[_i].max;
    desc.first = bad_descs[_i].first;
    desc.wanted_loss = bad_descs[_i].wanted_loss;
    tune_fails(&desc, VOX_ERROR_INVALID_ARGUMENT, bad_descs[_i].words, 0);
}
END_TEST

START_TEST(bad_tune_arguments) {
    vox_cell_size_result out;
    vox_tune_desc desc = vox_default_tune_desc();
    make_grid();
    out.struct_size = sizeof out;
    ck_fails(vox_foreign_grid_tune(&grid, NULL, run, NULL, NULL), VOX_ERROR_INVALID_ARGUMENT, "out is null");
    ck_fails(vox_foreign_grid_tune(&grid, NULL, NULL, NULL, &out), VOX_ERROR_INVALID_ARGUMENT, "run is null");
    ck_fails(vox_foreign_grid_tune(NULL, NULL, run, NULL, &out), VOX_ERROR_INVALID_ARGUMENT,
             "first is 0, and no grid is described");
    out.struct_size = 2;
    ck_fails(vox_foreign_grid_tune(&grid, NULL, run, NULL, &out), VOX_ERROR_INVALID_ARGUMENT,
             "out.struct_size is 2");
    desc.first = 1e-150;
    tune_fails(&desc, VOX_ERROR_LIMIT, "the smallest cell size to be tried is 1.25e-151, so small", 0);
    desc.struct_size = 0;
    tune_fails(&desc, VOX_ERROR_INVALID_ARGUMENT, "desc.struct_size is 0", 0);
    boxes.count = 0;
    tune_fails(NULL, VOX_ERROR_INVALID_ARGUMENT, "", 0);
}
END_TEST

SUITE(cost_tune) {
    TCase* tests = add_case(suite, "tune");
    tcase_add_each(tests, fit, bad_timings, tune, tune_that_stops_or_fails, bad_tune_arguments);
    tcase_add_loop_test(tests, bad_desc, 0, sizeof bad_descs / sizeof bad_descs[0]);
}
