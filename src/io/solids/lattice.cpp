#include "io/solids/lattice.hpp"

#include "io/throw_error.hpp"

#include <algorithm>
#include <cmath>

namespace vox::io {

Frame make_frame(const Eigen::AlignedBox3d& box, double cell) {
    constexpr double margin = 4; // both sides together
    Frame frame;
    frame.half_cell = cell / 2;
    for (unsigned k = 0; k < 3; ++k) {
        const double cells = std::ceil(box.sizes()[k] / cell);
        if (!(cells <= max_cells))
            throw_error(VOX_ERROR_LIMIT, "a cell of %g makes %.0f cells along %c, at most %d are possible",
                        cell, cells, static_cast<int>('x' + k), max_cells);
        frame.cells[k] = static_cast<std::int32_t>(cells + margin);
        frame.origin[k] = (box.min()[k] + box.max()[k]) / 2 - (cells + margin) * frame.half_cell;
    }
    return frame;
}

NodeSet::NodeSet(const Frame& frame, std::vector<Run> runs)
    : rows_y_(frame.cells[1] + 1), rows_z_(frame.cells[2] + 1) {
    const auto before = [](const Run& a, const Run& b) {
        if ((a.z & 1) != (b.z & 1)) return (a.z & 1) < (b.z & 1);
        if (a.z != b.z) return a.z < b.z;
        if (a.y != b.y) return a.y < b.y;
        return a.first < b.first;
    };
    if (!std::is_sorted(runs.begin(), runs.end(), before)) std::sort(runs.begin(), runs.end(), before);
    row_start_.assign(2 * static_cast<std::size_t>(rows_y_) * static_cast<std::size_t>(rows_z_) + 1, 0);
    std::uint64_t size = 0;
    for (std::size_t at = 0; at < runs.size();) {
        Run run = runs[at++];
        // Runs that overlap or touch become one.
        for (;
             at < runs.size() && runs[at].y == run.y && runs[at].z == run.z && runs[at].first <= run.last + 1;
             ++at)
            run.last = std::max(run.last, runs[at].last);
        spans_.push_back({run.first, run.last, static_cast<std::uint32_t>(size)});
        size += static_cast<std::uint64_t>(run.last - run.first + 1);
        if (size >= none)
            throw_error(VOX_ERROR_LIMIT,
                        "the lattice would hold more than 4294967294 points: choose larger cells");
        ++row_start_[row_of(run.y & 1, run.y >> 1, run.z >> 1) + 1];
    }
    for (std::size_t row = 1; row < row_start_.size(); ++row) row_start_[row] += row_start_[row - 1];
    size_ = static_cast<std::uint32_t>(size);
}

NodeSet with_neighbours(const Frame& frame, const NodeSet& nodes) {
    std::vector<Run> runs;
    nodes.for_each_run([&](std::uint32_t, const Run& run) {
        runs.push_back({run.y, run.z, run.first - 1, run.last + 1});
        for (const std::int32_t step : {-2, 2}) {
            runs.push_back({run.y + step, run.z, run.first, run.last});
            runs.push_back({run.y, run.z + step, run.first, run.last});
        }
        // Along the diagonals x changes by one, and thus its parity: 2 i + parity +- 1.
        const std::int32_t parity = run.y & 1;
        for (const std::int32_t y : {-1, 1})
            for (const std::int32_t z : {-1, 1})
                runs.push_back({run.y + y, run.z + z, run.first - 1 + parity, run.last + parity});
    });
    return NodeSet(frame, std::move(runs));
}

} // namespace vox::io
