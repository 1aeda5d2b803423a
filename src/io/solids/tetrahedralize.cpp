#include "io/solids/bodies.hpp"

#include "base/llu.hpp"
#include "io/solids/cubes.hpp"
#include "io/solids/stuff.hpp"
#include "io/solids/surface.hpp"
#include "io/throw_error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vox::io {
namespace {

// A surface is refused if more than this share of the lines end inside of it, or more than this share of the
// nodes are inside for one axis and outside for another.
constexpr double most_doubtful = 0.01;

void refuse_open(const SurfaceLines& lines, double doubtful) {
    throw_error(
        VOX_ERROR_INVALID_MESH,
        "the surface is open: %llu of its %llu edges have an odd number of triangles, and for %.1f %% "
        "of the lattice inside and outside cannot be told apart (at most %.0f %%)",
        llu(lines.check().open_edges), llu(lines.check().edges), 100 * doubtful, 100 * most_doubtful);
}

struct Attempt {
    const vox_io_mesh_view& surface;
    const vox_io_tetrahedralize_desc& desc;
    const Eigen::AlignedBox3d& box;
    double cell;
    std::uint32_t coarsen;
};

MeshData run(const Attempt& attempt, const Progress& progress) {
    const auto& [surface, desc, box, cell, coarsen] = attempt;
    const Frame frame = make_frame(box, cell);
    SurfaceLines lines(surface, frame);
    double doubtful = 0;
    NodeSet inside = lines.inside(frame, doubtful);
    const bool open = lines.check().open_edges > 0;

    MeshData mesh;
    if (desc.kind == VOX_IO_SOLID_CUBES) {
        mesh = make_cubes(surface, frame, inside, desc.max_tets);
    } else {
        if (open && inside.size() == 0) refuse_open(lines, 1);
        if (doubtful > most_doubtful) refuse_open(lines, doubtful);
        check_tet_count(inside, frame, coarsen, desc.max_tets);
        lines.cast_rest(progress.part(0, 0.3));
        const SolidShape body = {frame, std::move(inside), [&lines](const Node& node, unsigned neighbour) {
                                     return lines.leaves(node, neighbour);
                                 }};
        mesh = stuff(body, coarsen, desc.max_tets, progress.part(0.3, 1));
    }
    if (open)
        mesh.notes.emplace_back(
            format("the surface has %llu open edges; the holes were closed", llu(lines.check().open_edges)));
    else if (!lines.check().oriented)
        mesh.notes.emplace_back(
            "the surface's triangles do not agree on an orientation; inside was decided by parity");
    return mesh;
}

// What rounds of half the cell size have reached. Where two in a row came closer by about the same factor,
// the next ones will, too.
class Approach {
public:
    explicit Approach(const vox_io_tetrahedralize_desc& desc) : desc_(desc) {}

    // Throws LIMIT if that needs many more tets than there may be, so that nobody waits for it.
    void check(double cell, std::uint64_t tets, double distance) {
        const double factor = distance_ / distance, before = factor_;
        distance_ = distance;
        factor_ = factor;
        constexpr double least = 1.5,
                         most = 4.5; // linear at edges and tips: 2; where the surface is smooth: 4
        if (!(std::min(factor, before) > least && std::max(factor, before) < most)) return;
        const double halvings =
            std::ceil(std::log(distance / desc_.max_distance) / std::log(std::max(factor, before)));
        const double needed = static_cast<double>(tets) * std::pow(4, halvings);
        constexpr double margin = 4;
        if (needed > margin * static_cast<double>(desc_.max_tets))
            throw_error(VOX_ERROR_LIMIT,
                        "cells of %g, %llu tets, come within %g of the surface, and cells of half the size "
                        "%.3g times "
                        "as close; %g (max_distance) would take about %.2g tets, more than %llu (max_tets)",
                        cell, llu(tets), distance, factor, desc_.max_distance, needed, llu(desc_.max_tets));
    }

private:
    const vox_io_tetrahedralize_desc& desc_;
    double distance_ = 0, factor_ = 0; // of the round before
};

} // namespace

MeshData tetrahedralize(const vox_io_mesh_view& surface, const vox_io_tetrahedralize_desc& desc) {
    const Progress progress(desc.progress, desc.progress_user);
    progress.report(0);
    Eigen::AlignedBox3d box;
    for (std::size_t i = 0; i < 3 * surface.triangle_count; ++i)
        box.extend(Eigen::Vector3d(surface.positions + 3 * std::size_t{surface.triangles[i]}));
    const double longest = box.sizes().maxCoeff();
    double cell = desc.cell > 0 ? desc.cell : longest / 50;
    if (!std::isfinite(longest) || !(cell / 2 >= std::numeric_limits<double>::min()))
        refuse(format("no cells of %g fit a surface that is %g long", cell, longest));
    Approach approach(desc);
    const bool to_distance = desc.max_distance > 0 && desc.kind == VOX_IO_SOLID_STUFFED;
    for (std::uint32_t halvings = 0;; ++halvings, cell /= 2) {
        // The number of rounds is not known, so each counts as half of what is left.
        const double begin = 1 - std::ldexp(1.0, -static_cast<int>(halvings));
        const Progress round = to_distance ? progress.part(begin, (1 + begin) / 2) : progress;
        MeshData mesh = run({surface, desc, box, cell, std::min(desc.coarsen, 16u) + halvings}, round);
        // Halving the cells makes at least four times as many tets at the boundary.
        const bool last = 2 * longest / cell > max_cells || 4 * (mesh.tets.size() / 4) > desc.max_tets;
        if (mesh.tets.empty() && (!to_distance || last))
            refuse(format("no tet fits into the surface with a cell of %g (its longest side is %g)", cell,
                          longest));
        const double reached =
            to_distance && !mesh.tets.empty() ? measure_quality(view_of(mesh), &surface).hausdorff : 0;
        if (!mesh.tets.empty() && (!to_distance || reached <= desc.max_distance)) {
            progress.report(1);
            return mesh;
        }
        if (last)
            throw_error(VOX_ERROR_LIMIT,
                        "cells of %g, %llu tets, come within %g of the surface; %g (max_distance) needs more "
                        "than %llu tets (max_tets) or %d cells along an axis",
                        cell, llu(mesh.tets.size() / 4), reached, desc.max_distance, llu(desc.max_tets),
                        max_cells);
        if (!mesh.tets.empty()) approach.check(cell, mesh.tets.size() / 4, reached);
    }
}

} // namespace vox::io
