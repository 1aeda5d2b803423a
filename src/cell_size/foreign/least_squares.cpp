// The active-set method of C. L. Lawson, R. J. Hanson, Solving Least Squares Problems, 1974, ch. 23, on the
// normal equations (R. Bro, S. De Jong, A fast non-negativity-constrained least squares algorithm, J. of
// Chemometrics 11, 1997), which are scaled to a diagonal of ones.
#include "cell_size/foreign/fit.hpp"

#include <cmath>
#include <cstddef>

namespace vox {

namespace {

// Solves for the columns of `free` alone, by Cholesky's method. False where they depend on each other.
bool solve_free(const NormalEquations& squares, const Coefficients& targets,
                std::span<const std::size_t> free, Coefficients& x) noexcept {
    constexpr double least_pivot = 1e-11; // of the diagonal, which is 1
    NormalEquations l{};
    Coefficients y{};
    for (std::size_t i = 0; i < free.size(); ++i) {
        for (std::size_t j = 0; j <= i; ++j) {
            double sum = squares[free[i]][free[j]];
            for (std::size_t k = 0; k < j; ++k) sum -= l[i][k] * l[j][k];
            if (i != j)
                l[i][j] = sum / l[j][j];
            else if (sum > least_pivot)
                l[i][i] = std::sqrt(sum);
            else
                return false;
        }
        double sum = targets[free[i]];
        for (std::size_t k = 0; k < i; ++k) sum -= l[i][k] * y[k];
        y[i] = sum / l[i][i];
    }
    x = {};
    for (std::size_t i = free.size(); i-- > 0;) {
        double sum = y[i];
        for (std::size_t k = i + 1; k < free.size(); ++k) sum -= l[k][i] * x[free[k]];
        x[free[i]] = sum / l[i][i];
    }
    return true;
}

} // namespace

void add_row(const Coefficients& row, NormalEquations& equations) noexcept {
    for (std::size_t i = 0; i < row.size(); ++i)
        for (std::size_t j = 0; j < row.size(); ++j) equations[i][j] += row[i] * row[j];
}

Coefficients solve_non_negative(const NormalEquations& equations, std::size_t columns) noexcept {
    Coefficients scale{}, targets{};
    NormalEquations squares{};
    for (std::size_t i = 0; i < columns; ++i)
        scale[i] = equations[i][i] > 0 ? 1 / std::sqrt(equations[i][i]) : 0;
    double largest = 0;
    for (std::size_t i = 0; i < columns; ++i) {
        targets[i] = equations[i][columns] * scale[i];
        largest = std::fmax(largest, std::fabs(targets[i]));
        for (std::size_t j = 0; j < columns; ++j) squares[i][j] = equations[i][j] * scale[i] * scale[j];
    }
    Coefficients x{};
    std::array<bool, std::tuple_size_v<Coefficients>> is_free{}, refused{};
    std::array<std::size_t, std::tuple_size_v<Coefficients>> free{};
    const auto list_free = [&] {
        std::size_t count = 0;
        for (std::size_t i = 0; i < columns; ++i)
            if (is_free[i]) free[count++] = i;
        return std::span<const std::size_t>(free.data(), count);
    };
    // Each round frees one column; the sum of squares falls with each, so no set of columns comes twice. The
    // limit is for rounding.
    for (std::size_t round = 0; round < 8 * columns; ++round) {
        // The column along which the sum of squares falls most steeply.
        std::size_t entering = columns;
        double steepest = 1e-12 * largest;
        for (std::size_t i = 0; i < columns; ++i) {
            if (is_free[i] || refused[i] || scale[i] == 0) continue;
            double slope = targets[i];
            for (std::size_t j = 0; j < columns; ++j) slope -= squares[i][j] * x[j];
            if (slope > steepest) {
                steepest = slope;
                entering = i;
            }
        }
        if (entering == columns) break;
        is_free[entering] = true;
        Coefficients next{};
        if (!solve_free(squares, targets, list_free(), next) || !(next[entering] > 0)) {
            is_free[entering] = false;
            refused[entering] = true;
            continue;
        }
        // As far towards the solution as no coefficient becomes negative; those that become 0 are fixed
        // there.
        for (;;) {
            double step = 1;
            std::size_t leaving = columns;
            for (std::size_t i = 0; i < columns; ++i)
                if (is_free[i] && next[i] <= 0 && x[i] / (x[i] - next[i]) < step) {
                    step = x[i] / (x[i] - next[i]);
                    leaving = i;
                }
            for (std::size_t i = 0; i < columns; ++i)
                if (is_free[i]) x[i] += step * (next[i] - x[i]);
            if (leaving == columns) break;
            x[leaving] = 0;
            is_free[leaving] = false;
            if (!solve_free(squares, targets, list_free(), next)) break;
        }
        refused = {};
    }
    for (std::size_t i = 0; i < columns; ++i) x[i] *= scale[i];
    return x;
}

} // namespace vox
