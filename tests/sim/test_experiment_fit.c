/* The fit of times over cell sizes, its zone, the order of the samples and the time of their rounds. */
#include "support/suite.h"

#include <math.h>
#include <string.h>
#include <vox/vox_sim.h>

enum { points = 24 };

static double sizes[points], times[points];

static vox_time_fit fit_of(const double* cell_sizes, const double* values, uint64_t count) {
    vox_time_fit fit;
    memset(&fit, 0, sizeof fit);
    fit.struct_size = sizeof fit;
    ck_ok(vox_fit_times(cell_sizes, values, count, &fit));
    return fit;
}

static double fitted(const vox_time_fit* fit, double cell_size) {
    double time = -1;
    ck_ok(vox_fit_time_at(fit, cell_size, &time));
    return time;
}

/* Cells visited and particles met, as functions of the cell size over the size of a tet: least near 1.5. */
static double cost(double x) { return 15 * pow(1.1 / x + 1, 3) + 2 * pow(1.1 + x, 3); }

static void make(double unit, double noise) {
    uint64_t state = 1;
    for (int i = 0; i < points; ++i) {
        const double x = 0.5 * pow(8, (double)i / (points - 1));
        state = state * 6364136223846793005u + 1442695040888963407u;
        const double random = (double)(state >> 11) * 0x1p-53;
        sizes[i] = unit * x;
        times[i] = 1e5 * cost(x) * exp(noise * (2 * random - 1));
    }
}

/* Where `cost` is least, by trying. */
static double true_minimum(void) {
    double best = 1;
    for (double x = 0.5; x < 4; x += 1e-4)
        if (cost(x) < cost(best)) best = x;
    return best;
}

START_TEST(finds_the_minimum_and_the_zone) {
    const double unit = _i == 0 ? 0.1 : _i == 1 ? 1e-6 : 1e9;
    make(unit, 0);
    const vox_time_fit fit = fit_of(sizes, times, points);
    const double x = true_minimum();
    ck_assert_double_eq_tol(fit.cell_size / unit, x, 0.01 * x);
    ck_assert_double_eq_tol(fit.time, 1e5 * cost(x), 1e-3 * 1e5 * cost(x));
    ck_assert_uint_eq(fit.bracketed, 1);
    ck_assert_double_gt(fit.r_squared, 0.9999);
    ck_assert_double_lt(fit.prediction_error, 1e-3);
    ck_assert(fit.range_min == sizes[0] && fit.range_max == sizes[points - 1]);

    double min = 0, max = 0;
    ck_ok(vox_fit_zone(&fit, 1.05 * fit.time, &min, &max));
    ck_assert_double_eq_tol(cost(min / unit), 1.05 * cost(x), 0.004 * cost(x));
    ck_assert_double_eq_tol(cost(max / unit), 1.05 * cost(x), 0.004 * cost(x));
    ck_assert(min < fit.cell_size && fit.cell_size < max);
    ck_assert_double_eq_tol(fitted(&fit, min), 1.05 * fit.time, 1e-9 * fit.time);
    ck_assert_double_eq_tol(fitted(&fit, max), 1.05 * fit.time, 1e-9 * fit.time);

    /* No width at the least time itself; all of the range where nothing in it is too slow. */
    ck_ok(vox_fit_zone(&fit, fit.time, &min, &max));
    ck_assert_double_eq_tol(min / max, 1, 1e-3);
    ck_ok(vox_fit_zone(&fit, 1e9 * fit.time, &min, &max));
    ck_assert(min == fit.range_min && max == fit.range_max);
}
END_TEST

START_TEST(noise_is_not_followed) {
    make(0.1, 0.04);
    const vox_time_fit fit = fit_of(sizes, times, points);
    ck_assert_uint_le(fit.degree, 6);
    ck_assert_double_lt(cost(fit.cell_size / 0.1), 1.01 * cost(true_minimum()));
    ck_assert_double_gt(fit.prediction_error, 0.01);
    ck_assert_double_lt(fit.prediction_error, 0.06);
}
END_TEST

START_TEST(unit_of_time_and_order_of_points_do_not_matter) {
    make(0.1, 0.02);
    const vox_time_fit fit = fit_of(sizes, times, points);
    double mixed_sizes[points], mixed_times[points];
    for (int i = 0; i < points; ++i) {
        mixed_sizes[i] = sizes[(i * 7) % points];
        mixed_times[i] = 1e-6 * times[(i * 7) % points];
    }
    const vox_time_fit mixed = fit_of(mixed_sizes, mixed_times, points);
    ck_assert_uint_eq(mixed.degree, fit.degree);
    ck_assert_double_eq_tol(mixed.cell_size / fit.cell_size, 1, 1e-6);
    ck_assert_double_eq_tol(1e6 * mixed.time / fit.time, 1, 1e-9);
}
END_TEST

START_TEST(a_minimum_at_an_end_is_told) {
    for (int i = 0; i < points; ++i) times[i] = pow(sizes[i] = i + 1, 2);
    const vox_time_fit rising = fit_of(sizes, times, points);
    ck_assert_uint_eq(rising.bracketed, 0);
    ck_assert(rising.cell_size == 1);
    for (int i = 0; i < points; ++i) times[i] = pow(sizes[i], -3);
    const vox_time_fit falling = fit_of(sizes, times, points);
    ck_assert_uint_eq(falling.bracketed, 0);
    ck_assert(falling.cell_size == points);
    double min = 0, max = 0;
    ck_ok(vox_fit_zone(&falling, 1.05 * falling.time, &min, &max));
    ck_assert(max == points && min < points && min > points - 1);
}
END_TEST

START_TEST(fit_refuses) {
    make(0.1, 0);
    vox_time_fit fit;
    memset(&fit, 0, sizeof fit);
    fit.struct_size = sizeof fit;
    const vox_result bad = VOX_ERROR_INVALID_ARGUMENT;
    ck_fails(vox_fit_times(NULL, times, points, &fit), bad, "cell_sizes is null");
    ck_fails(vox_fit_times(sizes, NULL, points, &fit), bad, "times is null");
    ck_fails(vox_fit_times(sizes, times, points, NULL), bad, "out_fit is null");
    ck_fails(vox_fit_times(sizes, times, 4, &fit), bad, "4 different cell sizes");
    ck_fails(vox_fit_times(sizes, times, 0, &fit), bad, "0 different cell sizes");
    const double same[6] = {1, 2, 3, 4, 4, 4};
    ck_fails(vox_fit_times(same, times, 6, &fit), bad, "4 different cell sizes");
    const double wrong[] = {0, -1, NAN, INFINITY};
    for (size_t i = 0; i < 4; ++i) {
        const double kept = times[5];
        times[5] = wrong[i];
        ck_fails(vox_fit_times(sizes, times, points, &fit), bad, "times[5]");
        times[5] = kept;
        sizes[7] = wrong[i];
        ck_fails(vox_fit_times(sizes, times, points, &fit), bad, "cell_sizes[7]");
        make(0.1, 0);
    }
    ck_assert_uint_eq(fit.degree, 0); /* untouched */
    fit.struct_size = 3;
    ck_fails(vox_fit_times(sizes, times, points, &fit), bad, "struct_size is 3");

    fit = fit_of(sizes, times, points);
    double time = -1, min = -1, max = -1;
    ck_fails(vox_fit_time_at(NULL, 0.1, &time), bad, "fit is null");
    ck_fails(vox_fit_time_at(&fit, 0.1, NULL), bad, "out_time is null");
    ck_fails(vox_fit_time_at(&fit, 0.01, &time), bad, "the fit holds from");
    ck_fails(vox_fit_time_at(&fit, 1, &time), bad, "the fit holds from");
    ck_fails(vox_fit_time_at(&fit, NAN, &time), bad, "cell_size is nan");
    ck_fails(vox_fit_zone(&fit, 0.5 * fit.time, &min, &max), bad, "limit is");
    ck_fails(vox_fit_zone(&fit, NAN, &min, &max), bad, "limit is nan");
    ck_fails(vox_fit_zone(&fit, fit.time, NULL, &max), bad, "out_min is null");
    ck_fails(vox_fit_zone(&fit, fit.time, &min, NULL), bad, "out_max is null");
    vox_time_fit none;
    memset(&none, 0, sizeof none);
    none.struct_size = sizeof none;
    ck_fails(vox_fit_time_at(&none, 0.1, &time), bad, "fit was not filled by vox_fit_times");
    ck_fails(vox_fit_zone(&none, 1, &min, &max), bad, "fit was not filled by vox_fit_times");
    none = fit;
    none.degree = 99;
    ck_fails(vox_fit_zone(&none, fit.time, &min, &max), bad, "degree 99");
    ck_assert(time == -1 && min == -1 && max == -1);
}
END_TEST

START_TEST(orders) {
    enum { count = 100, rounds = 200 };
    uint64_t first[count], again[count], other[count];
    ck_ok(vox_experiment_order(count, 1, 0, first));
    ck_ok(vox_experiment_order(count, 1, 0, again));
    ck_assert(memcmp(first, again, sizeof first) == 0);
    ck_ok(vox_experiment_order(count, 2, 0, other));
    ck_assert(memcmp(first, other, sizeof first) != 0);
    double mean[count] = {0}; /* place of each number */
    for (uint64_t round = 0; round < rounds; ++round) {
        uint64_t order[count];
        int seen[count] = {0};
        ck_ok(vox_experiment_order(count, 1, round, order));
        if (round > 0) ck_assert(memcmp(first, order, sizeof first) != 0);
        for (int i = 0; i < count; ++i) {
            ck_assert_uint_lt(order[i], count);
            ck_assert_int_eq(seen[order[i]]++, 0);
            mean[order[i]] += (double)i / rounds;
        }
    }
    /* Each number is everywhere equally often: the standard deviation of a mean is 28.9 / sqrt(200) = 2. */
    for (int i = 0; i < count; ++i) ck_assert_double_eq_tol(mean[i], 49.5, 10);
    uint64_t one = 7;
    ck_ok(vox_experiment_order(1, 5, 5, &one));
    ck_assert_uint_eq(one, 0);
    ck_fails(vox_experiment_order(0, 1, 0, first), VOX_ERROR_INVALID_ARGUMENT, "count is 0");
    ck_fails(vox_experiment_order(1, 1, 0, NULL), VOX_ERROR_INVALID_ARGUMENT, "out_order is null");
}
END_TEST

/* A disturbance in one frame of one round does not show; one in most rounds does. */
START_TEST(time_of_rounds) {
    const uint64_t ns[3 * 4] = {10, 900, 30, 61, 11, 20, 800, 42, 700, 21, 31, 63};
    double time = -1;
    ck_ok(vox_experiment_time(ns, 3, 4, &time));
    ck_assert_double_eq_tol(time, (11 + 21 + 31 + 61) / 4.0, 1e-12);
    ck_ok(vox_experiment_time(ns, 2, 4, &time));
    ck_assert_double_eq_tol(time, (10.5 + 460 + 415 + 51.5) / 4.0, 1e-12);
    ck_ok(vox_experiment_time(ns, 1, 4, &time));
    ck_assert_double_eq_tol(time, (10 + 900 + 30 + 61) / 4.0, 1e-12);
    time = -1;
    ck_fails(vox_experiment_time(ns, 0, 4, &time), VOX_ERROR_INVALID_ARGUMENT, "0 rounds of 4 frames");
    ck_fails(vox_experiment_time(ns, 3, 0, &time), VOX_ERROR_INVALID_ARGUMENT, "3 rounds of 0 frames");
    ck_fails(vox_experiment_time(NULL, 3, 4, &time), VOX_ERROR_INVALID_ARGUMENT, "frame_ns is null");
    ck_fails(vox_experiment_time(ns, 3, 4, NULL), VOX_ERROR_INVALID_ARGUMENT, "out_ns is null");
    ck_assert(time == -1);
}
END_TEST

SUITE(experiment_fit) {
    TCase* tests = add_case(suite, "experiment_fit");
    tcase_add_loop_test(tests, finds_the_minimum_and_the_zone, 0, 3);
    tcase_add_each(tests, noise_is_not_followed, unit_of_time_and_order_of_points_do_not_matter,
                   a_minimum_at_an_end_is_told, fit_refuses, orders, time_of_rounds);
}
