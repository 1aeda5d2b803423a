// The search for the least cost, and costs from a table, over functions whose least value is known.
#include "cell_size/search.hpp"
#include "support/suite.h"

#include <cmath>
#include <memory_resource>

using namespace vox;

namespace {

std::pmr::memory_resource* const heap = std::pmr::new_delete_resource();

START_TEST(minimum_of_a_power_law) {
    // a / d^3 + b d^3 is least at (a / b)^(1/6).
    for (const double a : {1e-9, 1.0, 1e30}) {
        const auto cost = [&](double d) { return a / (d * d * d) + d * d * d; };
        const double expected = std::pow(a, 1.0 / 6);
        const CellSizeRange range{expected * 1e-4, expected * 1e5};
        const CostMinimum found = minimise(of_size(cost), range);
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

// A table of two costs an octave gives the others and the place of the least, with few calls of the function.
START_TEST(table_of_a_cost) {
    int calls = 0;
    const auto cost = [&](double d) {
        ++calls;
        return 3 / (d * d * d) + 5 / d + 2 + 0.5 * d * d * d;
    };
    const CellSizeRange range{0.05, 40};
    const CostMinimum best = minimise(of_size(cost), range);
    CostTable table(of_size(cost), range, heap);
    const CostFunction tabulated = [&](double d) { return table(d); };
    calls = 0;
    CostMinimum found =
        minimise(tabulated, range, {.scans_per_octave = 4, .least_scans = 8, .tolerance = 1e-4});
    found.cost = cost(found.cell_size);
    ck_assert_double_le(found.cost, 1.0005 * best.cost);
    for (double d = 0.02; d < 100; d *= 1.01) (void)table(std::log2(d));
    ck_assert_int_le(calls, 2 + 2 * 15);
    for (double d = 0.02; d < 100; d *= 1.01)
        ck_assert_double_eq_tol(table(std::log2(d)), cost(d), 0.01 * cost(d));
    ck_assert_double_eq_tol(table(std::log2(1e-6)), cost(1e-6), 1e-12 * cost(1e-6)); // beyond the table
    ck_assert_double_eq_tol(table(std::log2(1e9)), cost(1e9), 1e-12 * cost(1e9));
    // The zone, and points of the curve.
    const CellSizeRange zone = zone_around(found, 1.05 * found.cost, tabulated, range);
    const CellSizeRange expected = zone_around(best, 1.05 * best.cost, of_size(cost), range);
    ck_assert_double_eq_tol(zone.min, expected.min, 0.01 * expected.min);
    ck_assert_double_eq_tol(zone.max, expected.max, 0.01 * expected.max);
    const CellSizeRange all = zone_around(found, 1e9 * found.cost, tabulated, range);
    const CellSizeRange none = zone_around(found, found.cost, tabulated, range);
    ck_assert_double_eq(all.min, range.min);
    ck_assert_double_eq(all.max, range.max);
    ck_assert_double_eq(none.min, found.cell_size);
    ck_assert_double_eq(none.max, found.cell_size);
    vox_cost_sample curve[VOX_CURVE_CAPACITY];
    std::uint32_t count = 0;
    draw_curve(tabulated, {0.1, 6.4}, curve, count);
    ck_assert_uint_eq(count, VOX_CURVE_CAPACITY);
    for (std::uint32_t i = 0; i < count; ++i) {
        ck_assert_double_eq_tol(curve[i].cell_size, 0.1 * std::pow(64, i / (count - 1.0)),
                                1e-12 * curve[i].cell_size);
        ck_assert_double_eq_tol(curve[i].cost, cost(curve[i].cell_size), 0.01 * curve[i].cost);
    }
    // All that a suggestion asks of it, with few calls.
    calls = 0;
    CostTable asked(of_size(cost), range, heap);
    const CostFunction again = [&](double d) { return asked(d); };
    const CostMinimum least =
        minimise(again, range, {.scans_per_octave = 4, .least_scans = 8, .tolerance = 1e-4});
    (void)zone_around(least, 1.05 * least.cost, again, range);
    draw_curve(again, {least.cell_size / 8, least.cell_size * 8}, curve, count);
    ck_assert_int_le(calls, 2 + 2 * 12);
    CostTable point(of_size(cost), {3, 3}, heap);
    ck_assert_double_eq(minimise([&](double d) { return point(d); }, {3, 3}).cell_size, 3);
    const CostFunction nothing = [](double) { return 0.0; };
    ck_assert_double_eq(CostTable(nothing, range, heap)(1), 0);
}
END_TEST

START_TEST(minimum_at_an_end_and_where_nothing_is_finite) {
    const CellSizeRange range{0.5, 8};
    ck_assert_double_eq(minimise(of_size([](double d) { return d; }), range).cell_size, 0.5);
    ck_assert_double_eq(minimise(of_size([](double d) { return 1 / d; }), range).cell_size, 8);
    ck_assert_double_eq(minimise(of_size([](double d) { return d; }), {3, 3}).cell_size, 3);
    const CostMinimum none = minimise(of_size([](double) { return std::nan(""); }), range);
    ck_assert(std::isinf(none.cost));
    // Not finite on a part of the range: the rest counts.
    const CostMinimum part =
        minimise(of_size([](double d) { return d < 2 ? HUGE_VAL : (d - 4) * (d - 4) + 1; }), range);
    ck_assert_double_eq_tol(part.cell_size, 4, 1e-3);
}
END_TEST

} // namespace

SUITE(cost_search) {
    TCase* tests = add_case(suite, "cost_search");
    tcase_add_test(tests, minimum_of_a_power_law);
    tcase_add_test(tests, table_of_a_cost);
    tcase_add_test(tests, minimum_at_an_end_and_where_nothing_is_finite);
}
