// The fit of times over cell sizes and its zone: against the plain way, which is normal equations in long
// double and leave-one-out by leaving out, and for a cost with a known minimum.
#include "support/suite.h"

#include "tools/experiment/fit.hpp"
#include "tools/failure.hpp"

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <vector>

using namespace tool;

namespace {

using Real = long double;

// Coefficients of u^0 ... u^degree by Gauss elimination with pivots.
std::vector<Real> plain_fit(const std::vector<Real>& u, const std::vector<Real>& y, std::size_t degree) {
    const std::size_t n = degree + 1;
    std::vector<std::vector<Real>> a(n, std::vector<Real>(n + 1, 0));
    for (std::size_t p = 0; p < u.size(); ++p)
        for (std::size_t i = 0; i < n; ++i) {
            for (std::size_t j = 0; j < n; ++j) a[i][j] += std::pow(u[p], Real(i + j));
            a[i][n] += std::pow(u[p], Real(i)) * y[p];
        }
    for (std::size_t i = 0; i < n; ++i) {
        std::size_t pivot = i;
        for (std::size_t r = i + 1; r < n; ++r)
            if (std::abs(a[r][i]) > std::abs(a[pivot][i])) pivot = r;
        std::swap(a[i], a[pivot]);
        for (std::size_t r = 0; r < n; ++r) {
            if (r == i) continue;
            const Real factor = a[r][i] / a[i][i];
            for (std::size_t c = i; c <= n; ++c) a[r][c] -= factor * a[i][c];
        }
    }
    std::vector<Real> coefficients;
    for (std::size_t i = 0; i < n; ++i) coefficients.push_back(a[i][n] / a[i][i]);
    return coefficients;
}

Real value(const std::vector<Real>& coefficients, Real u) {
    Real sum = 0;
    for (std::size_t k = coefficients.size(); k-- > 0;) sum = sum * u + coefficients[k];
    return sum;
}

// Root mean square of what each point is off from the fit to all others.
Real leave_one_out(const std::vector<Real>& u, const std::vector<Real>& y, std::size_t degree) {
    Real squares = 0;
    for (std::size_t left = 0; left < u.size(); ++left) {
        std::vector<Real> some_u = u, some_y = y;
        some_u.erase(some_u.begin() + std::ptrdiff_t(left));
        some_y.erase(some_y.begin() + std::ptrdiff_t(left));
        const Real off = y[left] - value(plain_fit(some_u, some_y, degree), u[left]);
        squares += off * off;
    }
    return std::sqrt(squares / Real(u.size()));
}

struct Data {
    std::vector<double> sizes, times;
    std::vector<Real> u, y;
};

// A cost like the real one with relative noise, at uneven cell sizes.
Data made(unsigned seed, std::size_t count, double noise) {
    std::srand(seed);
    const auto random = [] { return double(std::rand()) / RAND_MAX; };
    Data data;
    for (std::size_t i = 0; i < count; ++i) {
        const double x = 0.5 * std::pow(8, (double(i) + 0.6 * random()) / double(count));
        const double cost = std::pow(1 / x + 1, 3) + 0.2 * std::pow(1 + x, 3);
        data.sizes.push_back(0.07 * x);
        data.times.push_back(1e6 * cost * std::exp(noise * (2 * random() - 1)));
    }
    const Real low = std::log(Real(data.sizes.front())), high = std::log(Real(data.sizes.back()));
    for (std::size_t i = 0; i < count; ++i) {
        data.u.push_back(2 * (std::log(Real(data.sizes[i])) - low) / (high - low) - 1);
        data.y.push_back(std::log(Real(data.times[i])));
    }
    return data;
}

constexpr int points = 24;

std::vector<double> sizes(points), times(points);

// Cells visited and particles met, as functions of the cell size over the size of a tet: least near 1.5.
double cost(double x) { return 15 * std::pow(1.1 / x + 1, 3) + 2 * std::pow(1.1 + x, 3); }

void make(double unit, double noise) {
    std::uint64_t state = 1;
    for (int i = 0; i < points; ++i) {
        const double x = 0.5 * std::pow(8, double(i) / (points - 1));
        state = state * 6364136223846793005u + 1442695040888963407u;
        const double random = double(state >> 11) * 0x1p-53;
        sizes[i] = unit * x;
        times[i] = 1e5 * cost(x) * std::exp(noise * (2 * random - 1));
    }
}

// Where `cost` is least, by trying.
double true_minimum() {
    double best = 1;
    for (double x = 0.5; x < 4; x += 1e-4)
        if (cost(x) < cost(best)) best = x;
    return best;
}

} // namespace

START_TEST(same_as_the_plain_way) {
    for (const std::size_t count : {std::size_t{5}, std::size_t{7}, std::size_t{12}, std::size_t{30}}) {
        const Data data = made(unsigned(_i), count, 0.01 * _i);
        const TimeFit fit = fit_times(data.sizes, data.times);
        const std::size_t most = std::min<std::size_t>(8, count - 2);
        std::size_t best = 2;
        for (std::size_t degree = 3; degree <= most; ++degree)
            if (leave_one_out(data.u, data.y, degree) < leave_one_out(data.u, data.y, best)) best = degree;
        ck_assert_uint_eq(fit.degree, best);
        ck_assert_double_eq_tol(fit.prediction_error, double(leave_one_out(data.u, data.y, best)),
                                1e-9 + 1e-6 * fit.prediction_error);
        const std::vector<Real> plain = plain_fit(data.u, data.y, best);
        for (std::size_t i = 0; i < count; ++i)
            ck_assert_double_eq_tol(std::log(fitted_time(fit, data.sizes[i])),
                                    double(value(plain, data.u[i])), 1e-9);
    }
}
END_TEST

// Many degrees, many points, one after another: the recurrence does not lose its way.
START_TEST(many_points) {
    const Data data = made(3, 5000, 0.05);
    const TimeFit fit = fit_times(data.sizes, data.times);
    const std::vector<Real> plain = plain_fit(data.u, data.y, fit.degree);
    for (std::size_t k = 0; k <= fit.degree; ++k)
        ck_assert_double_eq_tol(fit.coefficients[k], double(plain[k]), 1e-8);
}
END_TEST

START_TEST(finds_the_minimum_and_the_zone) {
    const double unit = _i == 0 ? 0.1 : _i == 1 ? 1e-6 : 1e9;
    make(unit, 0);
    const TimeFit fit = fit_times(sizes, times);
    const double x = true_minimum();
    ck_assert_double_eq_tol(fit.cell_size / unit, x, 0.01 * x);
    ck_assert_double_eq_tol(fit.time, 1e5 * cost(x), 1e-3 * 1e5 * cost(x));
    ck_assert(fit.bracketed);
    ck_assert_double_gt(fit.r_squared, 0.9999);
    ck_assert_double_lt(fit.prediction_error, 1e-3);
    ck_assert(fit.range_min == sizes[0] && fit.range_max == sizes[points - 1]);

    auto [min, max] = fit_zone(fit, 1.05 * fit.time);
    ck_assert_double_eq_tol(cost(min / unit), 1.05 * cost(x), 0.004 * cost(x));
    ck_assert_double_eq_tol(cost(max / unit), 1.05 * cost(x), 0.004 * cost(x));
    ck_assert(min < fit.cell_size && fit.cell_size < max);
    ck_assert_double_eq_tol(fitted_time(fit, min), 1.05 * fit.time, 1e-9 * fit.time);
    ck_assert_double_eq_tol(fitted_time(fit, max), 1.05 * fit.time, 1e-9 * fit.time);

    // No width at the least time itself; all of the range where nothing in it is too slow.
    const FitZone none = fit_zone(fit, fit.time), all = fit_zone(fit, 1e9 * fit.time);
    ck_assert_double_eq_tol(none.min / none.max, 1, 1e-3);
    ck_assert(all.min == fit.range_min && all.max == fit.range_max);
}
END_TEST

START_TEST(noise_is_not_followed) {
    make(0.1, 0.04);
    const TimeFit fit = fit_times(sizes, times);
    ck_assert_uint_le(fit.degree, 6);
    ck_assert_double_lt(cost(fit.cell_size / 0.1), 1.01 * cost(true_minimum()));
    ck_assert_double_gt(fit.prediction_error, 0.01);
    ck_assert_double_lt(fit.prediction_error, 0.06);
}
END_TEST

START_TEST(unit_of_time_and_order_of_points_do_not_matter) {
    make(0.1, 0.02);
    const TimeFit fit = fit_times(sizes, times);
    std::vector<double> mixed_sizes(points), mixed_times(points);
    for (int i = 0; i < points; ++i) {
        mixed_sizes[i] = sizes[(i * 7) % points];
        mixed_times[i] = 1e-6 * times[(i * 7) % points];
    }
    const TimeFit mixed = fit_times(mixed_sizes, mixed_times);
    ck_assert_uint_eq(mixed.degree, fit.degree);
    ck_assert_double_eq_tol(mixed.cell_size / fit.cell_size, 1, 1e-6);
    ck_assert_double_eq_tol(1e6 * mixed.time / fit.time, 1, 1e-9);
}
END_TEST

START_TEST(a_minimum_at_an_end_is_told) {
    for (int i = 0; i < points; ++i) times[i] = std::pow(sizes[i] = i + 1, 2);
    const TimeFit rising = fit_times(sizes, times);
    ck_assert(!rising.bracketed);
    ck_assert(rising.cell_size == 1);
    for (int i = 0; i < points; ++i) times[i] = std::pow(sizes[i], -3);
    const TimeFit falling = fit_times(sizes, times);
    ck_assert(!falling.bracketed);
    ck_assert(falling.cell_size == points);
    const auto [min, max] = fit_zone(falling, 1.05 * falling.time);
    ck_assert(max == points && min < points && min > points - 1);
}
END_TEST

START_TEST(refuses) {
    const auto refused = [](const std::vector<double>& cell_sizes, const std::vector<double>& of,
                            const char* words) {
        try {
            fit_times(cell_sizes, of);
            ck_abort_msg("expected: %s", words);
        } catch (const Failure& failure) {
            ck_assert_ptr_nonnull(std::strstr(failure.what(), words));
        }
    };
    refused({}, {}, "0 different cell sizes");
    refused({1, 2, 3, 4, 4, 4}, {1, 2, 3, 4, 5, 6}, "4 different cell sizes");
    refused({1, 2, 3, 4, 5}, {1, 2, 0, 4, 5}, "the time of a cell size is 0");
}
END_TEST

SUITE(fit) {
    TCase* tests = add_case(suite, "fit");
    tcase_add_loop_test(tests, same_as_the_plain_way, 0, 6);
    tcase_add_loop_test(tests, finds_the_minimum_and_the_zone, 0, 3);
    tcase_add_each(tests, many_points, noise_is_not_followed, unit_of_time_and_order_of_points_do_not_matter,
                   a_minimum_at_an_end_is_told, refuses);
}
