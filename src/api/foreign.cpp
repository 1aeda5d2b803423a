// The C border of vox.h's section on the cell size of any grid. What needs timings is in tune.cpp.

#include "base/border.hpp"
#include "base/caller_memory.hpp"
#include "base/structs.hpp"
#include "cell_size/foreign/grid.hpp"
#include "cell_size/foreign/known_grids.hpp"
#include "cell_size/foreign/suggest.hpp"

#include <cmath>
#include <cstddef>
#include <memory_resource>

using namespace vox;

vox_result vox_foreign_grid_set_known(vox_foreign_grid* grid, vox_known_grid known) {
    return border([&] {
        vox_foreign_grid filled = read_struct(grid, "grid");
        check_enum(known, VOX_KNOWN_GRID_NUMPY, "known");
        const KnownGrid& described = known_grid(known);
        filled.content = described.content;
        filled.look = described.look;
        filled.flags = described.flags;
        filled.known = known;
        filled.weights = described.weights;
        write_struct(grid, filled, "grid");
    });
}

vox_result vox_suggest_for(const vox_foreign_grid* grid, vox_foreign_suggestion* out) {
    return border([&] {
        check_out_struct(out, "out");
        const ForeignGrid described(grid);
        CallerMemory caller(described.desc.allocator);
        // In one piece: an allocator that gives what is free back to the system would fetch it anew each
        // time.
        std::pmr::monotonic_buffer_resource memory(quick_look_bytes, &caller);
        ForeignWork work(described, quick_look(described), &memory);
        write_struct(out, suggest_for(described, work), "out");
    });
}

vox_result vox_count_for(const vox_foreign_grid* grid, double cell_size, vox_grid_work* out) {
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
