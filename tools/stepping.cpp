#include "stepping.hpp"

#include "failure.hpp"
#include "terminal.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace tool {

namespace {

// A body that wobbles about its positions: each coordinate follows a wave of the body's length along the next
// axis. The strain is below 1 %.
class Wobble {
public:
    explicit Wobble(const Body& body) : floats_(body.positions), doubles_(body.exact) {
        const auto measure = [this](const auto& positions) {
            for (std::size_t i = 0; i < positions.size(); ++i) {
                const double x = positions[i];
                least_[i % 3] = i < 3 ? x : std::min(least_[i % 3], x);
                most_[i % 3] = i < 3 ? x : std::max(most_[i % 3], x);
            }
        };
        doubles_.empty() ? measure(floats_) : measure(doubles_);
        for (std::size_t axis = 0; axis < 3; ++axis) size_ = std::max(size_, most_[axis] - least_[axis]);
    }

    void move(Body& body, double time) const {
        doubles_.empty() ? move(floats_, body.positions, time) : move(doubles_, body.exact, time);
    }
    // Keeps the arrays in place, as the grid borrows them.
    void restore(Body& body) const {
        std::copy(floats_.begin(), floats_.end(), body.positions.begin());
        std::copy(doubles_.begin(), doubles_.end(), body.exact.begin());
    }

private:
    template <class Real>
    void move(const std::vector<Real>& rest, std::vector<Real>& moved, double time) const {
        if (!(size_ > 0)) return;
        const double waves = 2 * std::numbers::pi / size_;
        for (std::size_t i = 0; i < rest.size(); ++i) {
            const std::size_t along = i % 3 == 2 ? i - 2 : i + 1;
            const double phase = waves * (static_cast<double>(rest[along]) - least_[along % 3]) + time;
            const double x = static_cast<double>(rest[i]) + 0.001 * size_ * std::sin(phase);
            // Coordinates near the largest float do not move.
            if (std::abs(x) < static_cast<double>(std::numeric_limits<float>::max()))
                moved[i] = static_cast<Real>(x);
        }
    }

    std::vector<float> floats_;
    std::vector<double> doubles_;
    std::array<double, 3> least_{}, most_{};
    double size_ = 0;
};

} // namespace

Counters measure_steps(vox_grid* grid, std::span<Body> bodies, std::span<const vox_body> ids,
                       std::uint32_t repeat) {
    Progress progress;
    progress.show("first step");
    check(vox_grid_step(grid));
    std::vector<Wobble> wobbles(bodies.begin(), bodies.end());
    std::vector<Counters> steps;
    for (std::uint32_t i = 0; i < repeat; ++i) {
        progress.show("step " + std::to_string(i + 1) + " of " + std::to_string(repeat));
        for (std::size_t b = 0; b < bodies.size(); ++b) wobbles[b].move(bodies[b], i + 1);
        step_anew(grid, ids);
        steps.push_back(counters_of(grid));
    }
    for (std::size_t b = 0; b < bodies.size(); ++b) wobbles[b].restore(bodies[b]);
    step_anew(grid, ids);
    return median(steps);
}

} // namespace tool
