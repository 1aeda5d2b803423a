// Several cell sizes in one step: tetrahedra of very unlike sizes look into grids of their own.
#pragma once

#include "base/scene.hpp"

#include <algorithm>

namespace vox {

// A grid that holds every vertex, and into which the tetrahedra look whose boxes have no longer side than
// this and a longer one than that of the level before.
struct CellLevel {
    double cell_size;    // > 0, finite
    double longest_side; // infinite for the last level
};

// The same number wherever a level is chosen by it.
inline double longest_side(const Box3f& box) noexcept {
    return std::max({double{box.max.x} - double{box.min.x}, double{box.max.y} - double{box.min.y},
                     double{box.max.z} - double{box.min.z}});
}

} // namespace vox
