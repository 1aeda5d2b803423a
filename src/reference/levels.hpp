// Several cell sizes in one step, for scenes whose tetrahedra have very different sizes.
#pragma once

#include "base/scene.hpp"

#include <algorithm>

namespace vox {

// A grid that holds every vertex. It serves the tetrahedra whose boxes have a longest side of at most
// `longest_side`, and above that of the level before.
struct CellLevel {
    double cell_size;    // > 0, finite
    double longest_side; // infinite for the last level
};

// Whatever chooses a level for a box uses this function, so that all agree.
inline double longest_side(const Box3f& box) noexcept {
    return std::max({double{box.max.x} - double{box.min.x}, double{box.max.y} - double{box.min.y},
                     double{box.max.z} - double{box.min.z}});
}

} // namespace vox
