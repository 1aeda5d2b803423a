// A level takes consecutive size classes. The best split is found by dynamic programming over where the last
// level begins (R. Bellman, 1957), from what each class costs at each of some cell sizes.
#include "cell_size/levels.hpp"
#include "base/array.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory_resource>

namespace vox {

namespace {

// A further level has to save this part of the cost of one, which is about as accurate as the model is.
constexpr double worth = 0.05;
// Cell sizes among which those of the levels are chosen: none is further than 5 % from a better one, which
// costs a tenth of a per cent.
constexpr double sizes_per_octave = 8;
constexpr double most_sizes = 320;

// The best way to give the first classes to some levels, the last of which begins at class `from`.
struct Split {
    double cost = std::numeric_limits<double>::infinity(), cell_size = 0; // of the last level
    std::size_t from = 0;
};

} // namespace

Levels choose_levels(const ReferenceModel& cost, const CellSizeRange& range) {
    std::pmr::memory_resource* const memory = cost.classes().memory();
    Array<int> exponents(memory);
    for (const auto& c : cost.classes()) exponents.push_back(c.exponent);
    std::sort(exponents.begin(), exponents.end());
    exponents.erase(std::unique(exponents.begin(), exponents.end()), exponents.end());
    const std::size_t n = exponents.size();
    if (n == 0) return {};

    // grid[k]: what a grid costs before anything is looked up in it, at the k-th cell size. sum[g * sizes +
    // k]: what the classes with the first g exponents cost there.
    const double octaves = std::log2(range.max / range.min);
    const auto sizes = static_cast<std::size_t>(std::min(octaves * sizes_per_octave + 2, most_sizes));
    const auto size_at = [&](std::size_t k) {
        return range.min * std::exp2(octaves * static_cast<double>(k) / static_cast<double>(sizes - 1));
    };
    Array<double> grid(sizes, memory), sum((n + 1) * sizes, memory);
    for (std::size_t k = 0; k < sizes; ++k) {
        const double d = size_at(k);
        grid[k] = cost.of_grid(d);
        for (const auto& c : cost.classes()) {
            const auto g =
                std::lower_bound(exponents.begin(), exponents.end(), c.exponent) - exponents.begin();
            sum[static_cast<std::size_t>(g + 1) * sizes + k] += cost.of_class(c, d);
        }
        for (std::size_t g = 0; g < n; ++g) sum[(g + 1) * sizes + k] += sum[g * sizes + k];
    }

    // best(l)[j]: the first j exponents in l + 1 levels.
    constexpr std::size_t most = most_levels;
    Array<Split> splits(most * (n + 1), memory);
    const auto best = [&](std::size_t l) { return splits.data() + l * (n + 1); };
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = i + 1; j <= n; ++j) {
            Split own;
            for (std::size_t k = 0; k < sizes; ++k) {
                const double c = grid[k] + sum[j * sizes + k] - sum[i * sizes + k];
                if (c < own.cost) own = {c, size_at(k), i};
            }
            if (i == 0) best(0)[j] = own;
            for (std::size_t l = 1; l < most && i > 0; ++l) {
                const double all = best(l - 1)[i].cost + own.cost;
                if (all < best(l)[j].cost) best(l)[j] = {all, own.cell_size, i};
            }
        }

    std::size_t chosen = 0;
    const double least_gain = worth * (best(0)[n].cost + cost.shared());
    for (std::size_t l = 1; l < most; ++l)
        if (best(l)[n].cost < best(chosen)[n].cost - static_cast<double>(l - chosen) * least_gain) chosen = l;
    Levels levels;
    levels.count = static_cast<std::uint32_t>(chosen + 1);
    std::size_t end = n;
    for (std::size_t l = chosen + 1; l-- > 0; end = best(l)[end].from) {
        levels.level[l].cell_size = best(l)[end].cell_size;
        // Sides in a class are below twice its power of two.
        levels.level[l].longest_side = end == n ? std::numeric_limits<double>::infinity()
                                                : std::nextafter(std::ldexp(2.0, exponents[end - 1]), 0.0);
    }
    levels.cost = cost_of_levels(cost, levels.list());
    return levels;
}

const CellLevel& level_of(const ReferenceModel::SizeClass& c, std::span<const CellLevel> levels) {
    const double side = std::ldexp(1.0, c.exponent);
    std::size_t l = 0;
    while (l + 1 < levels.size() && side > levels[l].longest_side) ++l;
    return levels[l];
}

double cost_of_levels(const ReferenceModel& cost, std::span<const CellLevel> levels) {
    double sum = cost.shared();
    for (const CellLevel& level : levels) sum += cost.of_grid(level.cell_size);
    for (const auto& c : cost.classes()) sum += cost.of_class(c, level_of(c, levels).cell_size);
    return sum;
}

} // namespace vox
