// A file without exceptions and checks, linked with files that have them.
#define VOX_HPP_NO_EXCEPTIONS
#define VOX_HPP_CHECKED 0
#include <vox/vox.hpp>

static_assert(!VOX_HPP_THROWS && !VOX_HPP_CHECKED);

// Steps the grid; 0 if that fails.
extern "C" std::uint64_t hash_without_exceptions(vox_grid* grid) {
    vox::grid borrowed = vox::grid::borrow(grid);
    return borrowed.step() ? borrowed.hash().value_or(0) : 0;
}
