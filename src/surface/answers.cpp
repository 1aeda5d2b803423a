#include "surface/answers.hpp"

#include "exact/crossing.hpp"
#include "surface/distance.hpp"

#include <cmath>
#include <limits>
#include <mutex>

namespace vox {

namespace {

constexpr std::size_t least_features = 64; // that a worker takes at once

// The corners of a feature.
std::span<const std::uint32_t> corners_in(const SurfaceTopology& topology, vox_feature kind,
                                          const std::uint32_t& index) {
    return {kind == VOX_FEATURE_VERTEX ? &index : topology.corners(kind, index), corners_of(kind)};
}

// A feature's corners, and where they are at the end of the motion.
struct CornersAt {
    CornersAt(const Candidates& of, vox_feature kind, const std::uint32_t& index) noexcept
        : vertices(corners_in(of.topology, kind, index)) {
        for (std::size_t i = 0; i < vertices.size(); ++i) at[i] = of.motion.to[vertices[i]];
    }
    std::span<const Vec3d> positions() const noexcept { return {at, vertices.size()}; }

    std::span<const std::uint32_t> vertices;
    Vec3d at[3];
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

void add_crossings(const Candidates& candidates, Workers& workers, Answers<vox_crossing>& out) {
    constexpr vox_crossing_kind kinds[] = {VOX_CROSSING_THROUGH, VOX_CROSSING_TOUCHING,
                                           VOX_CROSSING_COPLANAR};
    const auto find = [&](std::uint32_t i, Array<vox_crossing>& found) {
        candidates.for_partners(i, [&](std::uint32_t edge, std::uint32_t face) {
            const SurfaceEdge& e = candidates.topology.edges[edge];
            const SurfaceFace& f = candidates.topology.faces[face];
            const std::span<const Vec3d> at = candidates.motion.to;
            std::uint64_t exact_tests = 0;
            const Crossing crossing =
                find_crossing(at[e[0]], at[e[1]], at[f[0]], at[f[1]], at[f[2]], exact_tests);
            if (crossing.kind == CrossingKind::none) return;
            const auto& [x, y, z] = crossing.face_weights;
            const Vec3d& p = crossing.position;
            found.push_back({edge,
                             face,
                             kinds[static_cast<std::size_t>(crossing.kind) - 1],
                             0,
                             {crossing.edge_weights[0], crossing.edge_weights[1]},
                             {x, y, z},
                             {p.x, p.y, p.z}});
        });
    };
    out.gathered.run(candidates.count(), workers, find, out.all);
}

// A pair whose boxes are more than `distance` apart may be closer by rounding (closest_features).
double proximity_radius(std::span<const Vec3d> positions, double distance) noexcept {
    double largest = 0;
    for (const Vec3d& p : positions) largest = std::max(largest, largest_coordinate(p));
    return distance / 2 + distance * 0x1p-40 + largest * 0x1p-44 + std::numeric_limits<double>::denorm_min();
}

void add_proximities(const Candidates& candidates, double distance, Workers& workers,
                     Answers<vox_proximity>& out) {
    const auto find = [&](std::uint32_t i, Array<vox_proximity>& found) {
        const auto own_index = static_cast<std::uint32_t>(candidates.pairs.first + i);
        const CornersAt own(candidates, candidates.a, own_index);
        candidates.for_partners(i, [&](std::uint32_t, std::uint32_t partner) {
            const CornersAt other(candidates, candidates.b, partner);
            const CloseFeatures at = closest_features(own.positions(), other.positions());
            if (!(at.distance <= distance)) return;
            vox_proximity& pair = found.emplace_back();
            pair.a = own_index;
            pair.b = partner;
            pair.distance = at.distance;
            copy(at.weights_a, pair.weights_a);
            copy(at.weights_b, pair.weights_b);
            copy(at.point_a, pair.point_a);
            copy(at.point_b, pair.point_b);
        });
    };
    out.gathered.run(candidates.count(), workers, find, out.all);
}

void add_impacts(const Candidates& candidates, const ContactTimeRule& rule, Workers& workers,
                 Answers<vox_impact>& out) {
    const SurfaceTopology& topology = candidates.topology;
    const SurfaceMotion& motion = candidates.motion;
    const vox_feature a = candidates.a, b = candidates.b;
    const auto find = [&](std::uint32_t i, Array<vox_impact>& found) {
        candidates.for_partners(i, [&](std::uint32_t own, std::uint32_t partner) {
            const ContactTime contact =
                contact_time(motion, corners_in(topology, a, own), corners_in(topology, b, partner), rule, 1);
            if (contact.touches) found.push_back({own, partner, contact.time});
        });
    };
    out.gathered.run(candidates.count(), workers, find, out.all);
}

void lower_safe_step(const Candidates& candidates, const ContactTimeRule& rule, Workers& workers,
                     vox_safe_step& found) {
    const SurfaceTopology& topology = candidates.topology;
    const SurfaceMotion& motion = candidates.motion;
    const vox_feature a = candidates.a, b = candidates.b;
    std::atomic<double> latest = found.step; // no later contact matters
    std::mutex mutex;
    const auto look_at = [&](std::uint32_t own, std::uint32_t partner) {
        const ContactTime contact =
            contact_time(motion, corners_in(topology, a, own), corners_in(topology, b, partner), rule,
                         latest.load(std::memory_order_relaxed));
        if (!contact.touches) return;
        const std::lock_guard lock(mutex);
        if (contact.time > found.step) return;
        if (contact.time == found.step &&
            (found.kind_a != a || std::tie(found.a, found.b) <= std::tie(own, partner)))
            return; // of an earlier kind, or before it; times are below 1
        found.step = contact.time;
        found.kind_a = a;
        found.kind_b = b;
        found.a = own;
        found.b = partner;
        found.unfinished = !contact.finished;
        latest.store(contact.time, std::memory_order_relaxed);
    };
    workers.for_ranges(candidates.count(), least_features,
                       [&](std::size_t begin, std::size_t end, std::uint32_t) {
                           for (std::size_t i = begin; i < end; ++i) candidates.for_partners(i, look_at);
                       });
}

// Proof. Let every vertex move by at most its clearance, and let d > 0 be a lower bound of the distance of a
// face and a vertex, or of two edges. Each of their vertices moves by less than d / 2, and so does each point
// of them, being a convex combination; so no two points, at least d apart, can meet. Where nothing moves
// further than `most`, only pairs closer than 2 * most can: those whose boxes, grown by `most`, overlap.
void lower_clearances(const Candidates& candidates, double most, Workers& workers,
                      Array<SharedLeast>& clearances) {
    const auto lower_all = [&](std::size_t begin, std::size_t end, std::uint32_t) {
        for (std::size_t i = begin; i < end; ++i) {
            const auto own_index = static_cast<std::uint32_t>(candidates.pairs.first + i);
            const CornersAt own(candidates, candidates.a, own_index);
            candidates.for_partners(i, [&](std::uint32_t, std::uint32_t partner) {
                const CornersAt other(candidates, candidates.b, partner);
                const double half = distance_at_least(own.positions(), other.positions()) / 2;
                if (!(half <= most)) return;
                const double least = half > 0 ? std::nextafter(half, 0.0) : 0;
                for (const std::uint32_t v : own.vertices) lower(clearances[v].number, least);
                for (const std::uint32_t v : other.vertices) lower(clearances[v].number, least);
            });
        }
    };
    workers.for_ranges(candidates.count(), least_features, lower_all);
}

} // namespace vox
