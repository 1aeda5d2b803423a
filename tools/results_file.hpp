// The results of a step as files: meshes with what collided for ParaView, and a table of the contacts.
#pragma once

#include "body.hpp"
#include "grid.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace tool {

// A mesh of the grid as it is drawn.
struct DrawnMesh {
    vox_body id;
    std::vector<double> positions;        // 3 for each vertex
    std::vector<std::uint32_t> tets;      // 4 corners each
    std::vector<std::uint32_t> numbers;   // of the tets in the grid; empty: 0, 1, 2, ...
    std::vector<std::uint32_t> triangles; // 3 corners each
};

DrawnMesh drawn_mesh(const Body& body, vox_body id);

// Writes the meshes, one behind the other, to a .vtu or .msh file. For each vertex: `mesh` (index in
// `meshes`), `vertex` (its number there), `contacts` (tetrahedra that it is in), and of its deepest
// penetration `depth`, `direction` and `state` (vox_penetration_state; -1: none); in a grid with edge
// contacts `edge_contacts` (those of its edges); in a grid with a margin the `margin_distance` (-1: none) and
// `margin_normal` of its closest margin contact; with `moving` the `passage_time` of its first passage (-1:
// none). For each cell: `mesh`, `tet` (its number; -1: a triangle), `contacts` (vertices in it). Throws
// Failure.
void write_results(const std::string& path, std::span<const DrawnMesh> meshes, const vox_grid* grid,
                   bool moving = false);

// Writes one line for each contact, in a grid without filters. Throws Failure.
void write_contacts(const std::string& path, const std::vector<vox_body>& ids, const vox_grid* grid);

// The text of a .pvd file, ParaView's list of files with a time each.
std::string pvd_series(std::span<const std::string> files, std::span<const std::uint64_t> times);

} // namespace tool
