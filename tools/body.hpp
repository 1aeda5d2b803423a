// A mesh file in the form the commands use: the file's arrays in double, and positions in float for the grid.
#pragma once

#include <vox/vox_io.h>

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace tool {

struct MeshDeleter {
    void operator()(vox_io_mesh* mesh) const noexcept { vox_io_mesh_destroy(mesh); }
};

using Mesh = std::unique_ptr<vox_io_mesh, MeshDeleter>;

struct Body {
    std::string name; // the path of the file, or the name of a body made by the tool
    Mesh mesh;
    vox_io_report report{};            // of the file
    std::vector<std::string> warnings; // of the file
    vox_io_mesh_view view{};           // arrays of `mesh`
    std::vector<float> positions;      // 3 * view.vertex_count
    std::vector<double> exact;         // if not empty, the positions before rounding, which are used instead
};

// The placement of a body. Each coordinate is read as double, scaled, then offset, and rounded once to float
// unless doubles are kept.
struct Placement {
    double scale = 1;
    std::array<double, 3> offset{};
    bool keep_doubles = false;
};

// How a file is read. Of a surface, either only the vertices take part, or it is filled with tetrahedra
// (lattice cells of edge `cell`; 0: the library's default).
struct Reading {
    bool fill_surfaces = false;
    double cell = 0;
    bool keep_unused = false; // vertices that belong to no tetrahedron
    bool split_cells = false; // hexahedra, wedges and pyramids
};

// What load_mesh finds.
struct Loaded {
    Mesh mesh;
    vox_io_report report{};
    std::vector<std::string> warnings;
};

// Reads a mesh file. Throws Failure with the reader's error text.
Loaded load_mesh(const std::string& path, const Reading& reading = {});
// Says the warnings in a line on standard error, if there are any.
void say_warnings(const std::string& path, const std::vector<std::string>& warnings);

// Reads a file and says its warnings. Throws Failure with the reader's error text, or if a placed coordinate
// is beyond the range of float.
Body load_body(const std::string& path, const Placement& placement = {}, const Reading& reading = {});
// Makes a body of a mesh that was not read from a file, and takes ownership of the mesh.
Body own_body(const std::string& name, vox_io_mesh* mesh);

// Describes the body to the library; the positions are borrowed from it.
vox_mesh_desc mesh_desc(const Body& body);

} // namespace tool
