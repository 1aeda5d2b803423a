// The boundary of tetrahedra.
#pragma once

#include "overlaps.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace tool {

// The facets that only one tetrahedron has; a tetrahedron given twice counts once. Outward if the tetrahedron
// has a positive volume.
std::vector<Triangle> boundary_of(std::span<const std::uint32_t> tets);

} // namespace tool
