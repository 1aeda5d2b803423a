// Size classes are in order of size, and a level takes consecutive ones: the best split is found by dynamic
// programming over where the last level begins (R. Bellman, 1957), over a table of what each class costs at
// each of some cell sizes.
#include "cell_size/levels.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory_resource>
#include <vector>

namespace vox {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
// A further level has to be worth more of the whole than the model can tell.
constexpr double worth = 0.05;
// Sizes in the table: so many an octave, and no more than that.
constexpr double sizes_per_octave = 4;
constexpr std::size_t most_sizes = 160;

// What the classes cost at the sizes of a range, even in the logarithm. Those of one exponent are one group.
class Table {
public:
    Table(const ReferenceModel& cost, std::span<const int> exponents, const CellSizeRange& range,
          std::pmr::memory_resource* memory)
        : range_(range), grid_(memory), sum_(memory) {
        const double octaves = std::log2(range.max / range.min);
        count_ = std::min(static_cast<std::size_t>(octaves * sizes_per_octave) + 2, most_sizes);
        grid_.resize(count_);
        sum_.resize((exponents.size() + 1) * count_);
        for (std::size_t k = 0; k < count_; ++k) {
            const double d = cell_size(static_cast<double>(k)), occupied = cost.occupied(d);
            grid_[k] = cost.of_grid(d);
            for (const SizeClass& c : cost.profile().classes()) {
                const auto group = std::lower_bound(exponents.begin(), exponents.end(), c.exponent);
                sum_[static_cast<std::size_t>(group - exponents.begin() + 1) * count_ + k] +=
                    cost.of_class(c, d, occupied);
            }
            for (std::size_t g = 0; g < exponents.size(); ++g)
                sum_[(g + 1) * count_ + k] += sum_[g * count_ + k];
        }
    }

    // The least cost of a grid for the groups [from, end), and where.
    struct Best {
        double cost = infinity, cell_size = 0;
    };
    Best best(std::size_t from, std::size_t end) const noexcept {
        const auto at = [&](std::size_t k) {
            return grid_[k] + sum_[end * count_ + k] - sum_[from * count_ + k];
        };
        std::size_t place = 0;
        for (std::size_t k = 1; k < count_; ++k)
            if (at(k) < at(place)) place = k;
        double between = 0; // the vertex of the parabola through the place and its neighbours
        if (place > 0 && place + 1 < count_) {
            const double left = at(place - 1) - at(place), right = at(place + 1) - at(place);
            if (left + right > 0) between = (left - right) / (2 * (left + right));
        }
        return {at(place), cell_size(static_cast<double>(place) + between)};
    }

private:
    double cell_size(double k) const noexcept {
        return range_.min * std::pow(range_.max / range_.min, k / static_cast<double>(count_ - 1));
    }

    CellSizeRange range_;
    std::size_t count_ = 0;
    std::pmr::vector<double> grid_; // at each size: what a grid costs before anything looks into it
    std::pmr::vector<double> sum_;  // of the groups before each, at each size
};

// The best cell size for the classes of some exponents near the one of the table, whose sizes are too far
// apart for what regular points make of it.
double refined(const ReferenceModel& cost, int first_exponent, int last_exponent, double cell_size,
               const CellSizeRange& range) {
    const auto of_level = [&](double d) {
        const double occupied = cost.occupied(d);
        double sum = cost.of_grid(d);
        for (const SizeClass& c : cost.profile().classes())
            if (c.exponent >= first_exponent && c.exponent <= last_exponent)
                sum += cost.of_class(c, d, occupied);
        return sum;
    };
    constexpr double around = 1.6;
    return minimise(of_level,
                    {std::max(cell_size / around, range.min), std::min(cell_size * around, range.max)},
                    {.scans_per_octave = 32, .least_scans = 2, .tolerance = 1e-2})
        .cell_size;
}

} // namespace

Levels choose_levels(const ReferenceModel& cost, const CellSizeRange& range) {
    std::pmr::memory_resource* const memory = cost.profile().classes().get_allocator().resource();
    std::pmr::vector<int> exponents(memory);
    for (const SizeClass& c : cost.profile().classes()) exponents.push_back(c.exponent);
    std::sort(exponents.begin(), exponents.end());
    exponents.erase(std::unique(exponents.begin(), exponents.end()), exponents.end());
    const std::size_t n = exponents.size();
    if (n == 0) return {};
    const Table table(cost, exponents, range, memory);

    // best[l][j]: the groups before j in l + 1 levels; the last one begins at `from`.
    constexpr std::size_t most = VOX_CELL_SIZE_LEVEL_CAPACITY;
    struct Split {
        double cost = infinity, cell_size = 0;
        std::size_t from = 0;
    };
    using Splits = std::pmr::vector<Split>;
    static_assert(most == 4);
    std::array<Splits, most> best{Splits(n + 1, memory), Splits(n + 1, memory), Splits(n + 1, memory),
                                  Splits(n + 1, memory)};
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = i + 1; j <= n; ++j) {
            const Table::Best own = table.best(i, j);
            if (i == 0) best[0][j] = {own.cost, own.cell_size, 0};
            for (std::size_t l = 1; l < most && i > 0; ++l) {
                const double sum = best[l - 1][i].cost + own.cost;
                if (sum < best[l][j].cost) best[l][j] = {sum, own.cell_size, i};
            }
        }

    std::size_t chosen = 0;
    const double shared = cost.shared(), least_gain = worth * (best[0][n].cost + shared);
    for (std::size_t l = 1; l < most; ++l)
        if (best[l][n].cost < best[chosen][n].cost - static_cast<double>(l - chosen) * least_gain) chosen = l;
    Levels levels;
    levels.count = static_cast<std::uint32_t>(chosen + 1);
    std::size_t end = n;
    for (std::size_t l = chosen + 1; l-- > 0; end = best[l][end].from) {
        // Sides in a group are below twice its power of two.
        const double side = std::nextafter(std::ldexp(2.0, exponents[end - 1]), 0.0);
        const std::size_t from = best[l][end].from;
        levels.level[l] = {refined(cost, exponents[from], exponents[end - 1], best[l][end].cell_size, range),
                           end == n ? infinity : side};
    }
    levels.cost = cost_of_levels(cost, levels.list());
    return levels;
}

const CellLevel& level_of(const SizeClass& c, std::span<const CellLevel> levels) {
    const double side = std::ldexp(1.0, c.exponent);
    std::size_t l = 0;
    while (l + 1 < levels.size() && side > levels[l].longest_side) ++l;
    return levels[l];
}

double cost_of_levels(const ReferenceModel& cost, std::span<const CellLevel> levels) {
    double sum = cost.shared();
    for (const CellLevel& level : levels) sum += cost.of_grid(level.cell_size);
    for (const SizeClass& c : cost.profile().classes()) {
        const double size = level_of(c, levels).cell_size;
        sum += cost.of_class(c, size, cost.occupied(size));
    }
    return sum;
}

} // namespace vox
