// Triangles that lie on each other and share vertices, which no edge through a triangle shows.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace tool {

using Triangle = std::array<std::uint32_t, 3>;

enum class OverlapKind : std::uint8_t {
    folded,  // they share an edge and lie in one plane, on the same side of it
    doubled, // the same three vertices, the same way round
    opposite // and the other way round
};
constexpr const char* overlap_names[] = {"folded", "doubled", "opposite"};

struct Overlap {
    std::size_t first, second; // triangles
    OverlapKind kind;
};

// Each of several triangles on each other is listed with one before it. Decided exactly, for 3 coordinates a
// vertex; but a triangle flatter than 1e-12 of its length is in no fold.
std::vector<Overlap> find_overlaps(const std::vector<double>& positions,
                                   const std::vector<Triangle>& triangles);

} // namespace tool
