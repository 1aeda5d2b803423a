// The C border of vox_cell_size.h's section on other uniform grids. Functions that take timings are in
// tune.cpp.

#include "base/border.hpp"
#include "base/caller_memory.hpp"
#include "base/structs.hpp"
#include "cell_size/foreign/grid.hpp"

#include <cmath>
#include <cstddef>
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
