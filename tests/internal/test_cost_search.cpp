// The search for the least cost, over functions whose least value is known.
#include "cell_size/search.hpp"
#include "support/suite.h"

#include <cmath>

using namespace vox;

namespace {

START_TEST(minimum_of_a_power_law) {
    // a / d^3 + b d^3 is least at (a / b)^(1/6).
    for (const double a : {1e-9, 1.0, 1e30}) {
        const auto cost = [&](double d) { return a / (d * d * d) + d * d * d; };
        const double expected = std::pow(a, 1.0 / 6);
        const CellSizeRange range{expected * 1e-4, expected * 1e5};
        const vox_cost_sample found = minimise(of_size(cost), range);
        ck_assert_double_eq_tol(found.cell_size, expected, 1e-6 * expected);
        const double limit = 1.05 * found.cost;
        const CellSizeRange zone = zone_around(found, limit, of_size(cost), range);
        ck_assert_double_lt(zone.min, expected);
        ck_assert_double_gt(zone.max, expected);
        ck_assert_double_eq_tol(cost(zone.min), limit, 1e-9 * limit);
        ck_assert_double_eq_tol(cost(zone.max), limit, 1e-9 * limit);
    }
}
END_TEST

START_TEST(zones_and_curves) {
    const auto cost = [](double d) { return 3 / (d * d * d) + 5 / d + 2 + 0.5 * d * d * d; };
    const CellSizeRange range{0.05, 40};
    const vox_cost_sample best = minimise(of_size(cost), range);
    const CellSizeRange all = zone_around(best, 1e9 * best.cost, of_size(cost), range);
    const CellSizeRange none = zone_around(best, best.cost, of_size(cost), range);
    ck_assert_double_eq(all.min, range.min);
    ck_assert_double_eq(all.max, range.max);
    ck_assert_double_eq(none.min, best.cell_size);
    ck_assert_double_eq(none.max, best.cell_size);
    // A coarse zone ends within its tolerance of the limit, inside.
    const double limit = 1.05 * best.cost;
    const CellSizeRange zone = zone_around(best, limit, of_size(cost), range, {.zone_tolerance = 1e-5});
    for (const double end : {zone.min, zone.max}) {
        ck_assert_double_le(cost(end), limit);
        ck_assert_double_ge(cost(end), (1 - 1e-5) * limit);
    }
    vox_cost_sample curve[VOX_CURVE_CAPACITY];
    std::uint32_t count = 0;
    draw_curve(of_size(cost), {0.1, 6.4}, curve, count);
    ck_assert_uint_eq(count, VOX_CURVE_CAPACITY);
    for (std::uint32_t i = 0; i < count; ++i) {
        ck_assert_double_eq_tol(curve[i].cell_size, 0.1 * std::pow(64, i / (count - 1.0)),
                                1e-12 * curve[i].cell_size);
        ck_assert_double_eq_tol(curve[i].cost, cost(curve[i].cell_size), 1e-12 * curve[i].cost);
    }
}
END_TEST

START_TEST(minimum_at_an_end_and_where_nothing_is_finite) {
    const CellSizeRange range{0.5, 8};
    ck_assert_double_eq(minimise(of_size([](double d) { return d; }), range).cell_size, 0.5);
    ck_assert_double_eq(minimise(of_size([](double d) { return 1 / d; }), range).cell_size, 8);
    ck_assert_double_eq(minimise(of_size([](double d) { return d; }), {3, 3}).cell_size, 3);
    const vox_cost_sample none = minimise(of_size([](double) { return std::nan(""); }), range);
    ck_assert(std::isinf(none.cost));
    // Not finite on a part of the range: the rest counts.
    const vox_cost_sample part =
        minimise(of_size([](double d) { return d < 2 ? HUGE_VAL : (d - 4) * (d - 4) + 1; }), range);
    ck_assert_double_eq_tol(part.cell_size, 4, 1e-3);
}
END_TEST

} // namespace

SUITE(cost_search) {
    TCase* tests = add_case(suite, "cost_search");
    tcase_add_test(tests, minimum_of_a_power_law);
    tcase_add_test(tests, zones_and_curves);
    tcase_add_test(tests, minimum_at_an_end_and_where_nothing_is_finite);
}
