// A mesh file as the commands use it: the file's arrays in double, and positions in float for the grid.
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

struct Body {
    std::string name; // the path given, or what a made body is called
    std::unique_ptr<vox_io_mesh, MeshDeleter> mesh;
    vox_io_mesh_view view{};      // arrays of `mesh`
    std::vector<float> positions; // 3 * view.vertex_count
    std::vector<double> exact;    // the same before they were rounded, to be used instead; or empty
};

// Where a body stands: each coordinate is read as double, scaled, then offset, and rounded once to float
// unless doubles are kept.
struct Placement {
    double scale = 1;
    std::array<double, 3> offset{};
    bool keep_doubles = false;
};

// What becomes of a surface: its vertices alone take part, or the tetrahedra it is filled with (lattice cells
// of edge `cell`; 0: the library's default) take its place.
struct Fill {
    bool surfaces = false;
    double cell = 0;
};

// Throws Failure in the reader's words, or when a placed coordinate is beyond the range of float.
Body load_body(const std::string& path, const Placement& placement = {}, const Fill& fill = {});
// Takes over a mesh that was made rather than read.
Body own_body(const std::string& name, vox_io_mesh* mesh);

// Describes the body to the library; the positions are borrowed from it.
vox_mesh_desc mesh_desc(const Body& body);

} // namespace tool
