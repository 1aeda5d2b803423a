// The C border of vox_cell_size.h's section on other uniform grids.

#include "base/border.hpp"
#include "base/caller_memory.hpp"
#include "base/structs.hpp"
#include "cell_size/foreign/fit.hpp"
#include "cell_size/foreign/grid.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory_resource>

using namespace vox;

vox_result vox_foreign_grid_suggest(const vox_foreign_grid* grid, vox_cell_size_result* out) {
    return border([&] {
        check_out_struct(out, "out");
        const ForeignGrid described(grid);
        CallerMemory caller(described.desc.allocator);
        // One allocation: the allocator might return freed memory to the system, and fetch it again each
        // time.
        std::pmr::monotonic_buffer_resource memory(quick_look_bytes, &caller);
        ForeignWork work(described, quick_look(described), &memory);
        write_struct(out, suggest_for(described, work), "out");
    });
}

vox_result vox_foreign_grid_count(const vox_foreign_grid* grid, double cell_size, vox_foreign_counts* out) {
    return border([&] {
        require(out, "out");
        const ForeignGrid described(grid);
        if (!(cell_size > 0) || !std::isfinite(cell_size))
            refuse(format("cell_size is %.9g, expected a number above 0", cell_size));
        CallerMemory memory(described.desc.allocator);
        ForeignWork work(described, thorough_look, &memory);
        if (!work.is_countable(cell_size))
            throw Error(VOX_ERROR_LIMIT,
                        format("cell_size is %g, so small that there would be more than %g cells or entries",
                               cell_size, most_counted));
        *out = work.exactly_at(cell_size);
    });
}

// ---- timings --------------------------------------------------------------------------------------

namespace {

// A described grid, and its terms. Only a dense grid touches all cells.
struct DescribedGrid {
    explicit DescribedGrid(const vox_foreign_grid* from_caller)
        : grid(from_caller), memory(grid.desc.allocator), work(grid, quick_look(grid), &memory),
          basis(described_basis(
              [this](double cell_size) {
                  vox_foreign_counts counts = work.at(cell_size);
                  if (!grid.dense()) counts.cells = 0;
                  return counts;
              },
              grid.desc.weights, work.least_cell_size(), grid.desc.zone_loss)) {}
    DescribedGrid(const DescribedGrid&) = delete;
    DescribedGrid& operator=(const DescribedGrid&) = delete;

    ForeignGrid grid;
    CallerMemory memory;
    ForeignWork work;
    CostBasis basis;
};

// The desc with all defaults. The first cell size is that of the desc, or the one suggested, or 0 where no
// grid is described. `least` gives right answers.
vox_tune_desc checked(const vox_tune_desc& desc, double least, double suggested) {
    vox_tune_desc tuned = desc;
    const double first = desc.first > 0 ? desc.first : suggested;
    set_default(tuned.max_runs, 7u);
    set_default(tuned.wanted_loss, 0.02);
    const auto at_least_0 = [](const char* name, double value) {
        if (!(value >= 0) || !std::isfinite(value))
            refuse(format("desc.%s is %g, expected a finite number of at least 0", name, value));
    };
    if (tuned.max_runs < 3 || tuned.max_runs > VOX_TIMING_CAPACITY)
        refuse(format("desc.max_runs is %u, expected 3 to %u", desc.max_runs, VOX_TIMING_CAPACITY));
    at_least_0("min", desc.min);
    at_least_0("max", desc.max);
    at_least_0("first", desc.first);
    at_least_0("wanted_loss", desc.wanted_loss);
    if ((desc.min > 0) != (desc.max > 0) || desc.min > desc.max)
        refuse(
            format("desc.min and max are %g and %g, expected 0 < min <= max, or both 0", desc.min, desc.max));
    if (desc.first > 0 && desc.max > 0 && !(desc.first >= desc.min && desc.first <= desc.max))
        refuse(format("desc.first is %g, expected from min, %g, to max, %g", desc.first, desc.min, desc.max));
    if (!(first > 0)) refuse("desc.first is 0, and no grid is described that a first cell size follows from");
    if (desc.first > 0 && desc.first < least)
        refuse(format("desc.first is %g, the smallest that gives right answers is %g", desc.first, least));
    if (desc.max > 0 && desc.max < least)
        refuse(format("desc.max is %g, the smallest that gives right answers is %g", desc.max, least));
    if (!(desc.max > 0)) {
        tuned.min = first / 8;
        tuned.max = first * 8;
    }
    tuned.min = std::max(tuned.min, least);
    tuned.first = std::clamp(first, tuned.min, tuned.max);
    if (!(tuned.min > 0) || !std::isfinite(tuned.max))
        refuse(format("the first cell size is %g, too far from 1 for an eighth or eight times it", first));
    return tuned;
}

} // namespace

vox_result vox_foreign_grid_fit(const vox_foreign_grid* grid, const vox_timing* timings, uint64_t count,
                                vox_cell_size_result* out) {
    return border([&] {
        check_out_struct(out, "out");
        if (count > 0) require(timings, "timings");
        check_limit(count, UINT32_MAX, "count");
        DescribedGrid described(grid);
        write_struct(
            out, fit_timings(described.basis, {timings, static_cast<std::size_t>(count)}, &described.memory),
            "out");
    });
}

vox_result vox_foreign_grid_tune(const vox_foreign_grid* grid, const vox_tune_desc* desc,
                                 vox_foreign_run* run, void* user, vox_cell_size_result* out) {
    return border([&] {
        check_out_struct(out, "out");
        if (!run) refuse("run is null");
        const vox_tune_desc asked = desc ? read_struct(desc, "desc") : vox_default_tune_desc();
        const GridRun run_of_caller = [&](double cell_size) {
            const CallersFloats floats;
            return run(cell_size, user);
        };
        if (!grid) {
            write_struct(out, tune({}, checked(asked, 0, 0), run_of_caller, std::pmr::new_delete_resource()),
                         "out");
            return;
        }
        DescribedGrid described(grid);
        const double suggested = asked.first > 0 ? 0 : suggest_for(described.grid, described.work).cell_size;
        const vox_tune_desc tuned = checked(asked, described.basis.least_cell_size, suggested);
        write_struct(out, tune(described.basis, tuned, run_of_caller, &described.memory), "out");
    });
}
