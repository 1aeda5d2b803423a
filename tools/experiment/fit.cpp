// Least squares with polynomials that are orthogonal over the measured points, by their three-term
// recurrence: G. E. Forsythe, "Generation and use of orthogonal polynomials for data-fitting with a digital
// computer", J. SIAM 5, 1957. Their coefficients do not change as the degree grows, so all degrees are tried
// in one pass. The chosen degree is the one that best predicts points left out of the fit, one at a time.
// This needs no second fit: D. M. Allen, "The relationship between variable selection and data augmentation
// and a method for prediction", Technometrics 16, 1974.
//
// Both axes are logarithms. The cost is a sum of falling and rising powers of the cell size. Its logarithm
// over the logarithm of the cell size is a smooth bowl between two straight lines, which polynomials
// approximate well. The noise of a time is proportional to it, so all points get the same weight.
#include "experiment/fit.hpp"

#include "failure.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace tool {

namespace {

double dot(std::span<const double> a, std::span<const double> b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
}

std::size_t count_distinct(std::span<const double> values) {
    std::vector<double> sorted(values.begin(), values.end());
    std::sort(sorted.begin(), sorted.end());
    return std::size_t(std::unique(sorted.begin(), sorted.end()) - sorted.begin());
}

// One orthonormal polynomial, as its values at the points and as a power series.
struct Basis {
    std::vector<double> values;
    double powers[max_fit_degree + 1] = {};

    void scale(double factor) {
        for (double& value : values) value *= factor;
        for (double& power : powers) power *= factor;
    }
};

// u times `last`, made orthogonal to `last` and to the one `before` it; it is already orthogonal to all
// others.
Basis next_basis(std::span<const double> u, const Basis& last, const Basis& before) {
    Basis next;
    next.values.resize(u.size());
    for (std::size_t i = 0; i < u.size(); ++i) next.values[i] = u[i] * last.values[i];
    for (std::size_t k = 0; k < max_fit_degree; ++k) next.powers[k + 1] = last.powers[k];
    for (const Basis* other : {&last, &before}) {
        const double along = dot(next.values, other->values);
        for (std::size_t i = 0; i < u.size(); ++i) next.values[i] -= along * other->values[i];
        for (std::size_t k = 0; k <= max_fit_degree; ++k) next.powers[k] -= along * other->powers[k];
    }
    next.scale(1 / std::sqrt(dot(next.values, next.values)));
    return next;
}

double power_series(const double (&coefficients)[max_fit_degree + 1], std::size_t degree, double u) {
    double sum = coefficients[degree];
    for (std::size_t k = degree; k-- > 0;) sum = sum * u + coefficients[k];
    return sum;
}

double cell_size_at(const TimeFit& fit, double u) {
    if (u == -1) return fit.range_min;
    if (u == 1) return fit.range_max;
    return fit.range_min * std::pow(fit.range_max / fit.range_min, (u + 1) / 2);
}

double place_of(const TimeFit& fit, double cell_size) {
    return 2 * std::log(cell_size / fit.range_min) / std::log(fit.range_max / fit.range_min) - 1;
}

// The fit of least leave-one-out error; sets degree, coefficients, r_squared and prediction_error.
void fit_polynomial(std::span<const double> u, std::span<const double> y, TimeFit& fit) {
    const std::size_t count = u.size();
    Basis last, before;
    last.values.assign(count, 1);
    last.powers[0] = 1;
    last.scale(1 / std::sqrt(double(count)));
    before.values.assign(count, 0);

    // If the fit had not included a point, its residual would be residual / (1 - leverage).
    std::vector<double> residual(y.begin(), y.end()), leverage(count, 0);
    double series[max_fit_degree + 1] = {};
    double spread = 0; // sum of squares about the mean
    double least = -1;
    const std::size_t max_degree = std::min(max_fit_degree, count_distinct(u) - 2);
    for (std::size_t degree = 0; degree <= max_degree; ++degree) {
        const double weight = dot(residual, last.values);
        for (std::size_t i = 0; i < count; ++i) {
            residual[i] -= weight * last.values[i];
            leverage[i] += last.values[i] * last.values[i];
        }
        for (std::size_t k = 0; k <= degree; ++k) series[k] += weight * last.powers[k];
        const double left = dot(residual, residual);
        if (degree == 0) spread = left;
        double squares = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const double unseen = residual[i] / (1 - leverage[i]);
            squares += unseen * unseen;
        }
        // A straight line has no minimum inside the range.
        if (degree >= 2 && (least < 0 || squares < least)) {
            least = squares;
            fit.degree = degree;
            std::copy(std::begin(series), std::end(series), fit.coefficients);
            fit.r_squared = spread > 0 ? 1 - left / spread : 1;
            fit.prediction_error = std::sqrt(squares / double(count));
        }
        if (degree == max_degree) break;
        Basis next = next_basis(u, last, before);
        before = std::move(last);
        last = std::move(next);
    }
}

// Where the least value over [-1, 1] is, by a scan and then a golden-section search around its best point.
double minimiser(const TimeFit& fit) {
    const auto value = [&](double u) { return power_series(fit.coefficients, fit.degree, u); };
    constexpr int steps = 1024;
    const auto scan = [](int i) { return double(2 * i - steps) / steps; };
    int best = 0;
    for (int i = 1; i <= steps; ++i)
        if (value(scan(i)) < value(scan(best))) best = i;
    double low = scan(std::max(best - 1, 0)), high = scan(std::min(best + 1, steps));
    const double section = (std::sqrt(5.0) - 1) / 2;
    while (high - low > 1e-9) {
        const double left = high - section * (high - low), right = low + section * (high - low);
        if (value(left) <= value(right))
            high = right;
        else
            low = left;
    }
    const double inside = (low + high) / 2;
    for (const double end : {-1.0, 1.0})
        if (std::abs(inside - end) < 1e-6) return end;
    return inside;
}

// Where the fitted logarithm first exceeds `limit` on the way from `inside`, where it does not, to `end`.
double crossing(const TimeFit& fit, double limit, double inside, double end) {
    const auto over = [&](double u) { return power_series(fit.coefficients, fit.degree, u) > limit; };
    constexpr int steps = 1024;
    const double start = inside;
    double outside = start;
    for (int i = 1; i <= steps && !over(outside); ++i) {
        inside = outside;
        outside = i == steps ? end : start + (end - start) * i / steps;
    }
    if (!over(outside)) return end;
    for (;;) {
        const double middle = inside + (outside - inside) / 2;
        if (middle == inside || middle == outside) return inside;
        (over(middle) ? outside : inside) = middle;
    }
}

} // namespace

double fitted_time(const TimeFit& fit, double cell_size) {
    return std::exp(power_series(fit.coefficients, fit.degree, place_of(fit, cell_size)));
}

TimeFit fit_times(std::span<const double> cell_sizes, std::span<const double> times) {
    if (const std::size_t distinct = count_distinct(cell_sizes); distinct < 5)
        throw Failure(std::to_string(distinct) + " different cell sizes, expected at least 5");
    // A clock may be too coarse for what it measures.
    if (!(*std::min_element(times.begin(), times.end()) > 0))
        throw Failure("the time of a cell size is 0, expected more");
    TimeFit fit{};
    const auto [smallest, largest] = std::minmax_element(cell_sizes.begin(), cell_sizes.end());
    fit.range_min = *smallest;
    fit.range_max = *largest;
    std::vector<double> u, y;
    for (const double size : cell_sizes) u.push_back(place_of(fit, size));
    for (const double time : times) y.push_back(std::log(time));
    fit_polynomial(u, y, fit);
    const double best = minimiser(fit);
    fit.cell_size = cell_size_at(fit, best);
    fit.time = std::exp(power_series(fit.coefficients, fit.degree, best));
    fit.bracketed = best > -1 && best < 1;
    return fit;
}

FitZone fit_zone(const TimeFit& fit, double limit) {
    const double best = std::clamp(place_of(fit, fit.cell_size), -1.0, 1.0);
    const double log_limit = std::max(std::log(limit), power_series(fit.coefficients, fit.degree, best));
    return {std::min(cell_size_at(fit, crossing(fit, log_limit, best, -1)), fit.cell_size),
            std::max(cell_size_at(fit, crossing(fit, log_limit, best, 1)), fit.cell_size)};
}

} // namespace tool
