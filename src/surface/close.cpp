#include "surface/close.hpp"

#include "base/array.hpp"
#include "surface/distance.hpp"
#include "surface/surface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vox {

namespace {

// The positions of the corners of a feature.
struct CornersAt {
    CornersAt(const SurfaceTopology& topology, std::span<const Vec3d> positions, vox_feature kind,
              std::uint32_t index) noexcept
        : count(corners_of(kind)) {
        for (unsigned i = 0; i < count; ++i)
            at[i] =
                positions[vertex[i] = kind == VOX_FEATURE_VERTEX ? index : topology.corners(kind, index)[i]];
    }
    std::span<const Vec3d> positions() const noexcept { return {at, count}; }
    std::span<const std::uint32_t> vertices() const noexcept { return {vertex, count}; }

    Vec3d at[3];
    std::uint32_t vertex[3];
    unsigned count;
};

void copy(const double (&from)[3], double (&to)[3]) noexcept { std::copy(from, from + 3, to); }
void copy(const Vec3d& from, double (&to)[3]) noexcept {
    to[0] = from.x;
    to[1] = from.y;
    to[2] = from.z;
}

void lower(std::atomic<double>& least, double value) noexcept {
    double current = least.load(std::memory_order_relaxed);
    while (value < current && !least.compare_exchange_weak(current, value, std::memory_order_relaxed)) {
    }
}

} // namespace

CloseSearch::CloseSearch(std::pmr::memory_resource* memory) noexcept
    : gathered_(memory), found_(memory), clearance_(memory) {}

std::span<const vox_proximity> CloseSearch::find(vox_surface& surface, vox_feature a, vox_feature b,
                                                 double distance) {
    const SurfaceTopology& topology = surface.topology();
    const std::span<const Vec3d> positions = surface.motion().to;
    double largest = 0;
    for (const Vec3d& p : positions) largest = std::max(largest, largest_number(p));
    // A pair whose boxes are more than `distance` apart may be closer by rounding (closest_features): boxes
    // that are larger by more than that find all that count.
    const double radius =
        distance / 2 + distance * 0x1p-40 + largest * 0x1p-44 + std::numeric_limits<double>::denorm_min();
    const SurfaceMotion still = surface.at_end(radius);
    found_.clear();
    surface.for_pieces(still, a, b, [&](const FeaturePairs& pairs) {
        const auto find_partners = [&](std::uint32_t i, Array<vox_proximity>& found) {
            const std::uint64_t begin = pairs.offsets[i], end = pairs.offsets[i + 1];
            if (begin == end) return;
            const std::uint32_t own_index = static_cast<std::uint32_t>(pairs.first) + i;
            const CornersAt own(topology, positions, a, own_index);
            for (std::uint64_t k = begin; k < end; ++k) {
                const std::uint32_t partner = pairs.partners[k];
                const CornersAt other(topology, positions, b, partner);
                const CloseFeatures at = closest_features(own.positions(), other.positions());
                if (!(at.distance <= distance)) continue;
                vox_proximity& pair = found.emplace_back();
                pair.a = own_index;
                pair.b = partner;
                pair.distance = at.distance;
                copy(at.weights_a, pair.weights_a);
                copy(at.weights_b, pair.weights_b);
                copy(at.point_a, pair.point_a);
                copy(at.point_b, pair.point_b);
            }
        };
        gathered_.run(static_cast<std::size_t>(pairs.count), surface.workers(), find_partners, found_);
    });
    return found_;
}

bool CloseSearch::release_found() noexcept {
    if (found_.capacity() == 0) return false;
    found_.clear();
    found_.shrink_to_fit();
    return true;
}

// Proof. Let every vertex move by at most its clearance, and let d > 0 be a lower bound of the distance of a
// face and a vertex, or of two edges. Each of their vertices moves by less than d / 2, and so does each point
// of them, being a convex combination; so no two points, at least d apart, can meet. Where nothing moves
// further than `most`, only pairs closer than 2 * most can: those whose boxes, grown by `most`, overlap.
void CloseSearch::clearance(vox_surface& surface, double most, double* out_distances) {
    const SurfaceTopology& topology = surface.topology();
    const SurfaceMotion still = surface.at_end(most);
    clearance_.resize(topology.vertex_count);
    for (SharedLeast& of_vertex : clearance_) of_vertex.number.store(most, std::memory_order_relaxed);
    for (const vox_feature kind_a : {VOX_FEATURE_FACE, VOX_FEATURE_EDGE}) {
        const vox_feature kind_b = kind_a == VOX_FEATURE_FACE ? VOX_FEATURE_VERTEX : VOX_FEATURE_EDGE;
        surface.for_pieces(still, kind_a, kind_b, [&](const FeaturePairs& pairs) {
            constexpr std::size_t least_features = 64; // that a worker takes at once
            const auto lower_all = [&](std::size_t begin, std::size_t end, std::uint32_t) {
                for (std::size_t i = begin; i < end; ++i) {
                    const CornersAt own(topology, still.to, kind_a,
                                        static_cast<std::uint32_t>(pairs.first + i));
                    for (std::uint64_t k = pairs.offsets[i]; k < pairs.offsets[i + 1]; ++k) {
                        const CornersAt other(topology, still.to, kind_b, pairs.partners[k]);
                        const double half = distance_at_least(own.positions(), other.positions()) / 2;
                        if (!(half <= most)) continue;
                        const double least = half > 0 ? std::nextafter(half, 0.0) : 0;
                        for (const std::uint32_t v : own.vertices()) lower(clearance_[v].number, least);
                        for (const std::uint32_t v : other.vertices()) lower(clearance_[v].number, least);
                    }
                }
            };
            surface.workers().for_ranges(static_cast<std::size_t>(pairs.count), least_features, lower_all);
        });
    }
    for (std::uint32_t v = 0; v < topology.vertex_count; ++v)
        out_distances[v] = clearance_[v].number.load(std::memory_order_relaxed);
}

} // namespace vox
