// Calls of the core library by what is built on it: failures as exceptions, and an owned grid.
#pragma once

#include "base/error.hpp"

#include <vox/vox.h>

#include <memory>

namespace vox {

// Throws the failure of a call.
inline void check(vox_result result) {
    if (result != VOX_OK) throw Error(result, vox_last_error());
}

struct GridDeleter {
    void operator()(vox_grid* grid) const noexcept { vox_grid_destroy(grid); }
};
using GridHandle = std::unique_ptr<vox_grid, GridDeleter>;

inline GridHandle create_grid(const vox_grid_desc& desc) {
    vox_grid* grid = nullptr;
    check(vox_grid_create(&desc, &grid));
    return GridHandle(grid);
}

} // namespace vox
