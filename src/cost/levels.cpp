// The classes are in order of size, and a level takes consecutive ones: the best split is found by dynamic
// programming over where the last level begins (R. Bellman, 1957).
#include "levels.hpp"

#include "minimise.hpp"

#include <algorithm>
#include <limits>
#include <vector>

namespace vox {

Levels choose_levels(const ReferenceCost& cost) {
    std::vector<const SizeClass*> classes;
    for (const SizeClass& c : cost.profile().classes()) classes.push_back(&c);
    std::sort(classes.begin(), classes.end(),
              [](const SizeClass* a, const SizeClass* b) { return a->exponent < b->exponent; });
    CellSizeRange range{};
    const std::size_t n = classes.size();
    if (n == 0 || !cost.range(range.min, range.max)) return {};

    // best[l][j]: the classes before j in l + 1 levels; the last one begins at from[l][j].
    constexpr std::size_t most = VOX_CELL_SIZE_LEVEL_CAPACITY;
    struct Best {
        double cost = std::numeric_limits<double>::infinity();
        double cell_size = 0;
        std::size_t from = 0;
    };
    std::array<std::vector<Best>, most> best;
    for (std::vector<Best>& of_count : best) of_count.resize(n + 1);
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = i + 1; j <= n; ++j) {
            const std::span<const SizeClass* const> level(classes.data() + i, j - i);
            const CostMinimum own = minimise([&](double d) { return cost.level(level, d); }, range);
            if (i == 0) best[0][j] = {own.cost, own.cell_size, 0};
            for (std::size_t l = 1; l < most && i > 0; ++l) {
                const double sum = best[l - 1][i].cost + own.cost;
                if (sum < best[l][j].cost) best[l][j] = {sum, own.cell_size, i};
            }
        }

    // A further level has to be worth more than the model can tell.
    constexpr double worth = 0.02;
    std::size_t chosen = 0;
    for (std::size_t l = 1; l < most; ++l)
        if (best[l][n].cost < (1 - worth) * best[chosen][n].cost) chosen = l;
    Levels levels;
    levels.cost = best[chosen][n].cost + cost.shared();
    levels.count = static_cast<std::uint32_t>(chosen + 1);
    std::size_t end = n;
    for (std::size_t l = chosen + 1; l-- > 0; end = best[l][end].from)
        levels.cell_size[l] = best[l][end].cell_size;
    return levels;
}

} // namespace vox
