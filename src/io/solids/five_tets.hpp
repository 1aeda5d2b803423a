// Splits a cube into five tetrahedra, four at every other corner and one in the middle. The bits of a
// corner's number are its coordinates, x lowest. Cubes alternate between the two possible splits, so that the
// diagonals of shared faces agree.
#pragma once

#include <array>
#include <cstdint>

namespace vox::io {

using FiveTets = std::array<std::array<std::uint8_t, 4>, 5>;

// The tetrahedra of cube (i, j, k), with `sum` = i + j + k. All five have positive volume.
inline const FiveTets& five_tets(std::int64_t sum) {
    static constexpr FiveTets even = {{{0, 1, 2, 4}, {3, 2, 1, 7}, {5, 1, 4, 7}, {6, 4, 2, 7}, {1, 2, 4, 7}}};
    static constexpr FiveTets odd = {{{1, 0, 5, 3}, {2, 0, 3, 6}, {4, 0, 6, 5}, {7, 3, 5, 6}, {0, 3, 6, 5}}};
    return sum & 1 ? odd : even;
}

// Whether the face diagonals around lattice point (i, j, k) end in it, with `sum` = i + j + k.
inline bool ends_diagonals(std::int64_t sum) { return (sum & 1) != 0; }

} // namespace vox::io
