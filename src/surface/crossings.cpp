#include "surface/crossings.hpp"

#include "base/array.hpp"
#include "base/room.hpp"
#include "exact/crossing.hpp"

#include <algorithm>
#include <cstddef>
#include <mutex>
#include <tuple>

namespace vox {

void find_crossings(const SurfaceTopology& topology, std::span<const Vec3d> positions,
                    const FeaturePairs& pairs, Workers& workers, Array<vox_crossing>& out) {
    constexpr std::size_t least_edges = 256; // that are worth a task
    constexpr vox_crossing_kind kinds[] = {VOX_CROSSING_THROUGH, VOX_CROSSING_TOUCHING,
                                           VOX_CROSSING_COPLANAR};
    const std::size_t before = out.size();
    std::mutex mutex;
    const auto look_at = [&](std::uint32_t edge, std::uint32_t face) {
        const SurfaceEdge& e = topology.edges[edge];
        const SurfaceFace& f = topology.faces[face];
        std::uint64_t exact_tests = 0;
        const Crossing found = find_crossing(positions[e[0]], positions[e[1]], positions[f[0]],
                                             positions[f[1]], positions[f[2]], exact_tests);
        if (found.kind == CrossingKind::none) return;
        const auto& [x, y, z] = found.face_weights;
        const Vec3d& p = found.position;
        const vox_crossing crossing{edge,
                                    face,
                                    kinds[static_cast<std::size_t>(found.kind) - 1],
                                    0,
                                    {found.edge_weights[0], found.edge_weights[1]},
                                    {x, y, z},
                                    {p.x, p.y, p.z}};
        const std::lock_guard lock(mutex);
        reserve_sparingly(out, out.size() + 1);
        out.push_back(crossing);
    };
    workers.for_ranges(pairs.count, least_edges, [&](std::size_t begin, std::size_t end, std::uint32_t) {
        for (std::size_t i = begin; i < end; ++i)
            for (std::uint64_t k = pairs.offsets[i]; k < pairs.offsets[i + 1]; ++k)
                look_at(static_cast<std::uint32_t>(pairs.first + i), pairs.partners[k]);
    });
    std::sort(out.begin() + static_cast<std::ptrdiff_t>(before), out.end(),
              [](const vox_crossing& x, const vox_crossing& y) {
                  return std::tie(x.edge, x.face) < std::tie(y.edge, y.face);
              });
}

} // namespace vox
