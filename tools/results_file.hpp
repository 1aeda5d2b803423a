// The results of a step as files: meshes with their contacts for ParaView, and a table of the constraints.
#pragma once

#include "body.hpp"
#include "grid.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace tool {

// A mesh of the grid, to be drawn.
struct DrawnMesh {
    vox_body id;
    std::vector<double> positions;        // 3 for each vertex
    std::vector<std::uint32_t> tets;      // 4 corners each
    std::vector<std::uint32_t> numbers;   // of tets in the grid; empty: 0, 1, 2, ...
    std::vector<std::uint32_t> triangles; // 3 corners each
    std::string name;
};

DrawnMesh drawn_mesh(const Body& body, vox_body id);

// A name that ends with .html: a page to look at (view_file.hpp). Else writes the meshes one after the other
// to a .vtu or .msh file, with the constraints found last.
// For each vertex: `mesh` (index in `meshes`), `vertex` (its number there), `contacts` (tetrahedra that it is
// in), and `kind`, `state` (-1: none), `gap` and `normal` of the constraint with the least gap that has it
// among the vertices of body_a. For each cell: `mesh`, `tet` (its number; -1: a triangle), `contacts`
// (vertices in it). Throws Failure.
void write_results(const std::string& path, std::span<const DrawnMesh> meshes, const vox_grid* grid);

// Writes one line for each constraint. Throws Failure.
void write_constraints(const std::string& path, const std::vector<vox_body>& ids, const vox_grid* grid);

// The text of a .pvd file, ParaView's list of files with a time each.
std::string pvd_series(std::span<const std::string> files, std::span<const std::uint64_t> times);

} // namespace tool
