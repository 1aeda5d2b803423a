#include "solid_tetrahedralize.hpp"

#include "error.hpp"
#include "solid_cubes.hpp"
#include "solid_stuff.hpp"
#include "solid_surface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vox::io {
namespace {

// A surface is refused when more than this share of the lines ends inside of it, or of the nodes is inside
// for one axis and outside for another.
constexpr double kMostDoubtful = 0.01;

struct Box {
    std::array<double, 3> min, max;
};

Box bounds_of_triangles(const vox_io_mesh_view& surface) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Box box = {{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
    for (std::size_t i = 0; i < 3 * surface.triangle_count; ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            const double x = surface.positions[3 * std::size_t{surface.triangles[i]} + k];
            box.min[k] = std::min(box.min[k], x);
            box.max[k] = std::max(box.max[k], x);
        }
    return box;
}

void refuse_open(const SurfaceLines& lines, double doubtful) {
    throw Error(
        VOX_ERROR_INVALID_MESH,
        format("the surface is open: %llu of its %llu edges have an odd number of triangles, and for %.1f %% "
               "of the lattice inside and outside cannot be told apart (at most %.0f %%)",
               static_cast<unsigned long long>(lines.check().open_edges),
               static_cast<unsigned long long>(lines.check().edges), 100 * doubtful, 100 * kMostDoubtful));
}

} // namespace

MeshData tetrahedralize(const vox_io_mesh_view& surface, const vox_io_tetrahedralize_desc& desc) {
    const Progress progress(desc.progress, desc.progress_user);
    progress.report(0);
    const Box box = bounds_of_triangles(surface);
    double longest = 0;
    for (std::size_t k = 0; k < 3; ++k) longest = std::max(longest, box.max[k] - box.min[k]);
    const double cell = desc.cell > 0 ? desc.cell : longest / 50;
    if (!std::isfinite(longest) || !(cell / 2 >= std::numeric_limits<double>::min()))
        throw Error(VOX_ERROR_INVALID_ARGUMENT,
                    format("the surface is %g long: no cells can be laid through it", longest));
    const Frame frame = make_frame(box.min, box.max, cell);
    const SurfaceLines lines(surface, frame, progress, 0.3);
    double doubtful = 0;
    NodeSet inside = lines.inside(frame, doubtful);

    MeshData mesh;
    if (desc.kind == VOX_IO_SOLID_CUBES) {
        mesh = make_cubes(surface, frame, inside, desc.max_tets);
        progress.report(1);
    } else {
        if (doubtful > kMostDoubtful || (inside.size() == 0 && lines.check().open_edges > 0))
            refuse_open(lines, lines.check().open_edges > 0 && inside.size() == 0 ? 1 : doubtful);
        Body body = {frame, std::move(inside), [&lines](const Node& node, unsigned neighbour) {
                         return lines.leaves(node, neighbour);
                     }};
        mesh = stuff(body, desc.coarsen, desc.max_tets, progress, 0.3);
    }
    if (mesh.tets.empty())
        throw Error(
            VOX_ERROR_INVALID_ARGUMENT,
            format("no tet fits into the surface with a cell of %g (its longest side is %g)", cell, longest));
    if (lines.check().open_edges > 0)
        mesh.notes.push_back(format("the surface has %llu open edges; the holes were closed",
                                    static_cast<unsigned long long>(lines.check().open_edges)));
    else if (!lines.check().oriented)
        mesh.notes.push_back(
            "the surface's triangles do not agree on an orientation; parity told inside from outside");
    return mesh;
}

} // namespace vox::io
