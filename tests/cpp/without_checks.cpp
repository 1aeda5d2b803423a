// A file with exceptions and without checks, linked with files that have both.
#define VOX_HPP_CHECKED 0
#include <vox/vox.hpp>

static_assert(VOX_HPP_THROWS && !VOX_HPP_CHECKED);

void fail_without_checks(vox_grid* grid);

// Throws vox::error.
void fail_without_checks(vox_grid* grid) { vox::grid::borrow(grid).set_cell_size(-1); }
