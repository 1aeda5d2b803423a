// Least squares with no negative coefficient, for a few columns.
#pragma once

#include <array>
#include <span>

namespace vox {

// Rows are added one by one; then solve() finds the x >= 0 for which the sum of (row . x - target)^2 is
// least.
class NonNegativeLeastSquares {
public:
    static constexpr int most_columns = 16;
    using Coefficients = std::array<double, most_columns>;

    explicit NonNegativeLeastSquares(int columns) noexcept : columns_(columns) {}

    // `row` has a number for each column. All are finite, and so small that their squares are.
    void add(std::span<const double> row, double target) noexcept;

    // A column that is a sum of others, up to rounding, has the coefficient 0, as has one of zeros.
    Coefficients solve() const noexcept;

private:
    int columns_;
    std::array<Coefficients, most_columns> squares_{}; // A'A
    Coefficients targets_{};                           // A'b
};

} // namespace vox
