// The fit of measured times against the plain way: normal equations in long double, and leave-one-out by
// leaving out.
#include "support/suite.h"

#include "sim/experiment/fit.hpp"

#include <cmath>
#include <cstdlib>
#include <vector>

using namespace vox::sim;

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

} // namespace

START_TEST(same_as_the_plain_way) {
    for (const std::size_t count : {std::size_t{5}, std::size_t{7}, std::size_t{12}, std::size_t{30}}) {
        const Data data = made(unsigned(_i), count, 0.01 * _i);
        const vox_time_fit fit = fit_times(data.sizes, data.times);
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

/* Many degrees, many points, one after another: the recurrence does not lose its way. */
START_TEST(many_points) {
    const Data data = made(3, 5000, 0.05);
    const vox_time_fit fit = fit_times(data.sizes, data.times);
    const std::vector<Real> plain = plain_fit(data.u, data.y, fit.degree);
    for (std::size_t k = 0; k <= fit.degree; ++k)
        ck_assert_double_eq_tol(fit.coefficients[k], double(plain[k]), 1e-8);
}
END_TEST

SUITE(fit) {
    TCase* tests = add_case(suite, "fit");
    tcase_add_loop_test(tests, same_as_the_plain_way, 0, 6);
    tcase_add_test(tests, many_points);
}
