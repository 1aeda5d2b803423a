// The C border of vox_cell_size.h's section on other uniform grids: functions that take timings.

#include "cell_size/foreign/tune.hpp"
#include "base/border.hpp"
#include "base/caller_memory.hpp"
#include "base/structs.hpp"
#include "cell_size/foreign/fit.hpp"
#include "cell_size/foreign/grid.hpp"
#include "cell_size/foreign/suggest.hpp"

#include <cinttypes>
#include <cstddef>
#include <cstdint>
#include <memory_resource>

using namespace vox;

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
              grid.desc.weights)) {}
    DescribedGrid(const DescribedGrid&) = delete;
    DescribedGrid& operator=(const DescribedGrid&) = delete;

    ForeignGrid grid;
    CallerMemory memory;
    ForeignWork work;
    CostBasis basis;
};

vox_tune_desc read_tune_desc(const vox_tune_desc* desc) {
    vox_tune_desc settings{};
    if (desc) settings = read_struct(desc, "desc");
    complete(settings);
    check_tune_desc(settings);
    return settings;
}

} // namespace

vox_result vox_foreign_grid_fit(const vox_foreign_grid* grid, const vox_timing* timings, uint64_t count,
                                vox_cell_size_result* out) {
    return border([&] {
        check_out_struct(out, "out");
        if (count > 0) require(timings, "timings");
        if (count > UINT32_MAX)
            throw Error(VOX_ERROR_LIMIT,
                        format("count is %" PRIu64 ", the limit is %" PRIu32, count, UINT32_MAX));
        DescribedGrid described(grid);
        const FitSettings settings{described.work.least_cell_size(), described.grid.desc.zone_loss};
        write_struct(out,
                     fit_timings(described.basis, settings, {timings, static_cast<std::size_t>(count)},
                                 &described.memory),
                     "out");
    });
}

vox_result vox_foreign_grid_tune(const vox_foreign_grid* grid, const vox_tune_desc* desc,
                                 vox_foreign_run* run, void* user, vox_cell_size_result* out) {
    return border([&] {
        check_out_struct(out, "out");
        if (!run) refuse("run is null");
        const vox_tune_desc asked = read_tune_desc(desc);
        const GridRun run_of_caller = [&](double cell_size) {
            const CallersFloats floats;
            return run(cell_size, user);
        };
        if (!grid) {
            const TuneSettings settings(asked, default_zone_loss, 0, 0);
            write_struct(out, tune(nullptr, settings, run_of_caller, std::pmr::new_delete_resource()), "out");
            return;
        }
        DescribedGrid described(grid);
        const double suggested = asked.first > 0 ? 0 : suggest_for(described.grid, described.work).cell_size;
        const TuneSettings settings(asked, described.grid.desc.zone_loss, suggested,
                                    described.work.least_cell_size());
        write_struct(out, tune(&described.basis, settings, run_of_caller, &described.memory), "out");
    });
}
