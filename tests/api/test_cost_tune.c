/* vox_cost_fit and vox_cost_tune: arguments, errors, callbacks that fail or stop, and what they promise of a
 * real description. The numbers are in tests/internal/test_tune.cpp. */
#include "support/suite.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

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
    grid.held = &boxes;
    grid.weights.fixed = 1e4;
    grid.weights.entries = 20;
    grid.weights.visits = 10;
    grid.weights.reads = 3;
}

/* What a run of that grid takes, by its own counts. */
static double seconds_at(double cell_size) {
    vox_grid_work work;
    ck_ok(vox_count_for(&grid, cell_size, &work));
    return 1e-9 * (1e4 + 20 * work.entries + 10 * work.visits + 3 * work.reads);
}

/* ---- fit -------------------------------------------------------------------------------------- */

static vox_grid_timing timings[4];

static void make_timings(void) {
    static const double sizes[4] = {0.6, 1.2, 2.4, 1.2};
    int i;
    make_grid();
    for (i = 0; i < 4; ++i) {
        timings[i].cell_size = sizes[i];
        timings[i].seconds = seconds_at(sizes[i]);
    }
}

static void fit_fails(const vox_foreign_grid* described, const vox_grid_timing* given, uint64_t given_count,
                      vox_result code, const char* words) {
    vox_grid_fit out, before;
    memset(&out, 0x5a, sizeof out);
    out.struct_size = sizeof out;
    before = out;
    ck_fails(vox_cost_fit(described, given, given_count, &out), code, words);
    ck_assert_mem_eq(&out, &before, sizeof out);
}

START_TEST(fit) {
    vox_grid_fit out, small;
    vox_foreign_suggestion suggestion;
    make_timings();
    out.struct_size = sizeof out;
    ck_ok(vox_cost_fit(&grid, timings, 4, &out));
    ck_assert_uint_eq(out.warnings, 0);
    ck_assert_double_le(out.residual, 0.05);
    ck_assert_uint_eq(out.curve_count, VOX_COST_CURVE_CAPACITY);
    ck_assert_double_le(out.zone_min, out.cell_size);
    ck_assert_double_ge(out.zone_max, out.cell_size);
    /* The weights can be put into the description, and lead to the same size. */
    grid.weights = out.weights;
    suggestion.struct_size = sizeof suggestion;
    ck_ok(vox_suggest_for(&grid, &suggestion));
    ck_assert_double_eq_tol(suggestion.cell_size, out.cell_size, 0.05 * out.cell_size);
    ck_assert_double_eq_tol(suggestion.predicted_cost, 1e9 * out.predicted_seconds,
                            0.02 * suggestion.predicted_cost);
    /* An older caller's struct. */
    memset(&small, 0x5a, sizeof small);
    small.struct_size = offsetof(vox_grid_fit, zone_min);
    make_timings();
    ck_ok(vox_cost_fit(&grid, timings, 4, &small));
    ck_assert_double_eq(small.cell_size, out.cell_size);
    ck_assert_int_eq(((unsigned char*)&small.zone_min)[0], 0x5a);
}
END_TEST

START_TEST(bad_timings) {
    static const double bad_sizes[] = {0, -1, NAN, INFINITY};
    static const double bad_seconds[] = {0, -1, NAN, INFINITY, 1e31, 1e-31};
    int i;
    make_timings();
    ck_fails(vox_cost_fit(&grid, timings, 3, NULL), VOX_ERROR_INVALID_ARGUMENT, "out is null");
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
    grid.least_cell_size = 1;
    fit_fails(&grid, timings, 3, VOX_ERROR_INVALID_ARGUMENT,
              "timings[0].cell_size is 0.6, expected at least the least legal one, 1");
    make_timings();
    timings[1].cell_size = 1e-150;
    fit_fails(&grid, timings, 3, VOX_ERROR_LIMIT, "the smallest cell size timed is 1e-150, so small");
    make_timings();
    grid.held = NULL;
    fit_fails(&grid, timings, 3, VOX_ERROR_INVALID_ARGUMENT, "held");
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
    vox_tuning out, before;
    memset(&out, 0x5a, sizeof out);
    out.struct_size = sizeof out;
    before = out;
    ck_fails(vox_cost_tune(&grid, desc, run, &machine, &out), code, words);
    ck_assert_mem_eq(&out, &before, sizeof out);
    ck_assert_int_eq(machine.calls, calls);
}

/* By the description, by a first size alone, and twice the same. */
START_TEST(tune) {
    struct machine machine = {0, 0, 0, 0};
    vox_tune_desc desc = vox_default_tune_desc();
    vox_foreign_suggestion suggestion;
    vox_tuning out, again, blind;
    make_grid();
    memset(&out, 0, sizeof out);
    memset(&again, 0, sizeof again);
    out.struct_size = again.struct_size = blind.struct_size = sizeof out;
    suggestion.struct_size = sizeof suggestion;
    ck_ok(vox_suggest_for(&grid, &suggestion));
    ck_ok(vox_cost_tune(&grid, NULL, run, &machine, &out));
    ck_assert_int_eq(machine.calls, (int)out.run_count);
    ck_assert_uint_le(out.run_count, 7);
    ck_assert_double_eq(out.runs[0].cell_size, suggestion.cell_size);
    ck_assert_double_eq(out.runs[0].seconds, seconds_at(suggestion.cell_size));
    ck_assert_uint_eq(out.warnings, 0);
    ck_assert_double_le(seconds_at(out.cell_size), 1.02 * seconds_at(suggestion.cell_size));
    ck_assert_double_le(out.expected_loss, 0.02);
    ck_assert_double_gt(out.weights.entries + out.weights.visits, 0);
    ck_ok(vox_cost_tune(&grid, &desc, run, &machine, &again));
    ck_assert_mem_eq(&again, &out, sizeof out);

    desc.first = 1.5;
    ck_ok(vox_cost_tune(NULL, &desc, run, &machine, &blind));
    ck_assert_double_eq(blind.runs[0].cell_size, 1.5);
    ck_assert_double_le(seconds_at(blind.cell_size), 1.05 * seconds_at(out.cell_size));
    ck_assert_double_eq(blind.weights.entries, 0);
}
END_TEST

START_TEST(tune_that_stops_or_fails) {
    struct machine machine = {0, 2, 0, 0};
    vox_tuning out;
    make_grid();
    out.struct_size = sizeof out;
    ck_ok(vox_cost_tune(&grid, NULL, run, &machine, &out));
    ck_assert_uint_eq(out.run_count, 2);
    ck_assert_uint_ne(out.warnings & VOX_FOREIGN_STOPPED, 0);
    ck_assert_ptr_nonnull(strstr(out.note, "stopped at run 3"));
    /* Small sizes cannot run. */
    memset(&machine, 0, sizeof machine);
    machine.too_small = out.runs[0].cell_size;
    ck_ok(vox_cost_tune(&grid, NULL, run, &machine, &out));
    ck_assert_double_ge(out.cell_size, machine.too_small);
    ck_assert_ptr_nonnull(strstr(out.note, "cannot run at cell size"));
    ck_assert(isinf(out.runs[1].seconds));
    /* Nothing ran, and a clock that is too coarse. */
    memset(&out, 0x5a, sizeof out);
    out.struct_size = sizeof out;
    machine.answer = -1;
    ck_fails(vox_cost_tune(&grid, NULL, run, &machine, &out), VOX_ERROR_INVALID_STATE, "no run succeeded");
    machine.answer = INFINITY;
    ck_fails(vox_cost_tune(&grid, NULL, run, &machine, &out), VOX_ERROR_INVALID_STATE, "7 could not run");
    machine.answer = 1e-40;
    ck_fails(vox_cost_tune(&grid, NULL, run, &machine, &out), VOX_ERROR_INVALID_ARGUMENT,
             "expected at least 1e-30");
    ck_assert_int_eq(out.note[0], 0x5a);
}
END_TEST

static const struct {
    uint32_t most_runs;
    double min, max, first, zone_loss, wanted_loss;
    const char* words;
} bad_descs[] = {
    {2, 0, 0, 0, 0.05, 0.02, "most_runs is 2, expected 3 to 32"},
    {33, 0, 0, 0, 0.05, 0.02, "most_runs is 33, expected 3 to 32"},
    {7, 2, 1, 0, 0.05, 0.02, "min and max are 2 and 1,"},
    {7, 2, 0, 0, 0.05, 0.02, "min and max are 2 and 0,"},
    {7, 0, 2, 0, 0.05, 0.02, "min and max are 0 and 2,"},
    {7, -1, 2, 0, 0.05, 0.02, "min is -1,"},
    {7, NAN, 2, 0, 0.05, 0.02, "min is nan,"},
    {7, 1, INFINITY, 0, 0.05, 0.02, "max is inf,"},
    {7, 1, 2, 3, 0.05, 0.02, "first is 3, expected from min, 1, to max, 2"},
    {7, 0, 0, -3, 0.05, 0.02, "first is -3,"},
    {7, 0, 0, NAN, 0.05, 0.02, "first is nan,"},
    {7, 0, 0, 1e308, 0.05, 0.02, "first cell size is 1e+308"},
    {7, 0, 0, 0.5, 0.05, 0.02, "first is 0.5, the least legal cell size is 0.75"},
    {7, 0.1, 0.7, 0, 0.05, 0.02, "max is 0.7, the least legal cell size is 0.75"},
    {7, 0, 0, 0, -1, 0.02, "zone_loss is -1,"},
    {7, 0, 0, 0, NAN, 0.02, "zone_loss is nan,"},
    {7, 0, 0, 0, 0.05, -1, "wanted_loss is -1,"},
    {7, 0, 0, 0, 0.05, NAN, "wanted_loss is nan,"},
};

START_TEST(bad_desc) {
    vox_tune_desc desc = vox_default_tune_desc();
    make_grid();
    grid.least_cell_size = 0.75;
    desc.most_runs = bad_descs[_i].most_runs;
    desc.min = bad_descs[_i].min;
    desc.max = bad_descs[_i].max;
    desc.first = bad_descs[_i].first;
    desc.zone_loss = bad_descs[_i].zone_loss;
    desc.wanted_loss = bad_descs[_i].wanted_loss;
    tune_fails(&desc, VOX_ERROR_INVALID_ARGUMENT, bad_descs[_i].words, 0);
}
END_TEST

START_TEST(bad_tune_arguments) {
    vox_tuning out;
    vox_tune_desc desc = vox_default_tune_desc();
    make_grid();
    out.struct_size = sizeof out;
    ck_fails(vox_cost_tune(&grid, NULL, run, NULL, NULL), VOX_ERROR_INVALID_ARGUMENT, "out is null");
    ck_fails(vox_cost_tune(&grid, NULL, NULL, NULL, &out), VOX_ERROR_INVALID_ARGUMENT, "run is null");
    ck_fails(vox_cost_tune(NULL, NULL, run, NULL, &out), VOX_ERROR_INVALID_ARGUMENT,
             "first is 0, and no grid is described");
    out.struct_size = 2;
    ck_fails(vox_cost_tune(&grid, NULL, run, NULL, &out), VOX_ERROR_INVALID_ARGUMENT, "out.struct_size is 2");
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
