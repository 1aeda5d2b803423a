#include "cell_size/moments.hpp"

namespace vox {

void PiecewiseMoments::finish() noexcept {
    for (std::size_t c = 1; c < sums_.size(); ++c) sums_[c].add(sums_[c - 1]);
}

// The class of the cell size itself is added in part, so that the sum is continuous.
double PiecewiseMoments::at(double d) const noexcept {
    const double ratio = d * inverse_least_;
    const std::size_t c = class_of(ratio);
    if (c == 0) return std::max(sums_[0].at(d), 0.0); // rounding can leave a little less
    if (c >= sums_.size()) return std::max(sums_.back().at(d), 0.0);
    constexpr std::uint64_t rest = std::uint64_t{1} << (52 - step_bits);
    const double part = static_cast<double>(std::bit_cast<std::uint64_t>(ratio) & (rest - 1)) / double{rest};
    const double below = sums_[c - 1].at(d);
    return std::max(below + part * (sums_[c].at(d) - below), 0.0);
}

} // namespace vox
