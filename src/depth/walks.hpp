// Walks along many segments: those of walk_out(), to the last bit, with a segment in each lane of a register.
#pragma once

#include "depth/walk.hpp"

#include <cstdint>
#include <span>

namespace vox::depth {

struct Walk {
    // The segment, and the closed tetrahedron in which it begins.
    Vec3d p, q;
    std::uint32_t tet;
    // What walk_out() returns, sets and counts. `exit` is set only when the segment leaves the mesh.
    bool leaves;
    std::uint64_t visited;
    SurfacePoint exit;
};

// Sets `leaves`, `visited` and `exit` of all walks.
void walk_out(const Solid& solid, std::span<Walk> walks);

} // namespace vox::depth
