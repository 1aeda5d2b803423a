#include "experiment/samples.hpp"

#include <algorithm>
#include <numeric>
#include <random>

namespace tool {

std::vector<std::size_t> order_of_round(std::size_t count, std::uint64_t seed, std::uint64_t round) {
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::mt19937_64 random(seed);
    random.seed(random() + round);
    // Fisher and Yates; std::shuffle may differ from machine to machine.
    for (std::size_t i = count; i > 1; --i) std::swap(order[i - 1], order[random() % i]);
    return order;
}

double time_of_rounds(const std::vector<std::vector<std::uint64_t>>& rounds) {
    const std::size_t frames = rounds.front().size(), middle = rounds.size() / 2;
    std::vector<double> times(rounds.size());
    double sum = 0;
    for (std::size_t frame = 0; frame < frames; ++frame) {
        for (std::size_t round = 0; round < rounds.size(); ++round)
            times[round] = static_cast<double>(rounds[round][frame]);
        std::sort(times.begin(), times.end());
        sum += times.size() % 2 ? times[middle] : (times[middle - 1] + times[middle]) / 2;
    }
    return sum / static_cast<double>(frames);
}

} // namespace tool
