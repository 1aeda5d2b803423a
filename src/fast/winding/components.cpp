#include "fast/winding/components.hpp"

#include <utility>

namespace vox::fast {

// While runs are joined, `component` is the index of another run of the same component, a lower one, or of
// the run itself.
std::uint32_t Components::root(std::uint32_t run) noexcept {
    while (runs[run].component != run) {
        runs[run].component = runs[runs[run].component].component; // halves the path for the next search
        run = runs[run].component;
    }
    return run;
}

// Joins the runs of a row with those runs of another one that they touch; its cells have indices lower by
// `cells_between`.
void Components::join(std::uint32_t row, std::uint32_t other, std::uint32_t cells_between) noexcept {
    std::uint32_t i = rows[row], j = rows[other];
    while (i < runs.size() && j < rows[other + 1]) {
        const std::uint32_t first = runs[j].first + cells_between, end = runs[j].end + cells_between;
        if (first < runs[i].end && runs[i].first < end) {
            std::uint32_t a = root(i), b = root(j);
            if (a < b) std::swap(a, b);
            runs[a].component = b;
        }
        if (end < runs[i].end)
            ++j;
        else
            ++i;
    }
}

void Components::find(const std::uint32_t* values, std::uint32_t wanted, const std::uint32_t (&cells)[3]) {
    const std::uint32_t nx = cells[0], ny = cells[1];
    runs.clear();
    rows.clear();
    rows.push_back(0);
    for (std::uint32_t row = 0; row < ny * cells[2]; ++row) {
        const std::uint32_t end = (row + 1) * nx;
        for (std::uint32_t c = row * nx; c < end; ++c) {
            if (values[c] != wanted) continue;
            const std::uint32_t first = c;
            while (c < end && values[c] == wanted) ++c;
            runs.push_back({first, c, static_cast<std::uint32_t>(runs.size())});
        }
        if (row % ny) join(row, row - 1, nx);
        if (row >= ny) join(row, row - ny, nx * ny);
        rows.push_back(static_cast<std::uint32_t>(runs.size()));
    }
    // A root comes before all other runs of its component, so its number is set before theirs.
    count = 0;
    for (std::uint32_t i = 0; i < runs.size(); ++i)
        runs[i].component = runs[i].component == i ? count++ : runs[runs[i].component].component;
}

} // namespace vox::fast
