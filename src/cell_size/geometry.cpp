#include "base/array.hpp"
#include "cell_size/scene.hpp"

#include "base/bits.hpp"
#include "base/sampling.hpp"
#include "base/vectors.hpp"
#include "exact/predicates.hpp"
#include "fast/last_positions.hpp"
#include "fast/stream.hpp"
#include "mesh/check.hpp"
#include "mesh/facets.hpp"
#include "mesh/sample.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

namespace vox {

namespace {

// Differences of coordinates below 2^128 do not overflow in double, nor do products of up to six of them:
// areas and volumes of the largest coordinates are finite, and those of the smallest floats are not flushed
// to zero.
double area(const Vec3d& a, const Vec3d& b, const Vec3d& c) { return length(cross(b - a, c - a)) / 2; }

// The mean of items that each stand for `weight` items. Ten million of them lose at most 1e-9 of it to
// rounding.
struct Mean {
    double sum = 0, weight = 0;

    void add(double value, double weight_of_value) {
        sum += value * weight_of_value;
        weight += weight_of_value;
    }
    double value() const { return weight > 0 ? sum / weight : 0; }
};

// The mean over edges or facets, each once, of which tetrahedra share some. More tetrahedra are looked at
// than edges are listed, so what is estimated from the latter is not the mean itself but its ratio to the
// mean over those of all tetrahedra, which varies little (ratio estimate: W. G. Cochran, Sampling Techniques,
// 1977, ch. 6).
struct SharedMean {
    Mean once, shared; // of those listed: each once, and as often as tetrahedra have it
    Mean of_tets;      // over tetrahedra, of the mean over their own

    void add(double value, double weight, std::uint32_t tets) {
        once.add(value, weight);
        shared.add(value, weight * tets);
    }
    double value(bool is_whole) const {
        const double listed = once.value(), by_tets = shared.value();
        return is_whole || !(by_tets > 0) ? listed : listed / by_tets * of_tets.value();
    }
};

struct Means {
    explicit Means(std::pmr::memory_resource* memory) : box_sides(memory) {}

    Mean longest_edge, box_side, tet_facet, boundary_facet, volume, object_side;
    SharedMean edge, facet;
    double degenerate = 0;
    Array<std::pair<double, double>> box_sides; // and their weights
};

// A box of doubles.
struct Bounds {
    static constexpr double infinity = std::numeric_limits<double>::infinity();
    Vec3d lo{infinity, infinity, infinity}, hi{-infinity, -infinity, -infinity};

    bool empty() const { return lo.x > hi.x; }
    void add(const Vec3d& from, const Vec3d& to) {
        lo = min(lo, from);
        hi = max(hi, to);
    }
};

// `proper`: it names no vertex twice.
void add_tet(const Vec3d (&p)[4], double weight, bool proper, Means& means) {
    const Vec3d a = p[1] - p[0], b = p[2] - p[0], c = p[3] - p[0];
    const auto extent = [](double first, double second, double third) { // of three numbers and 0
        return std::max(std::max(first, second), std::max(third, 0.0)) -
               std::min(std::min(first, second), std::min(third, 0.0));
    };
    const double side =
        std::max(extent(a.x, b.x, c.x), std::max(extent(a.y, b.y, c.y), extent(a.z, b.z, c.z)));
    means.box_side.add(side, weight);
    means.box_sides.emplace_back(side, weight);
    const Vec3d ab = p[2] - p[1], ac = p[3] - p[1], bc = p[3] - p[2];
    const double edges[6] = {length(a), length(b), length(c), length(ab), length(ac), length(bc)};
    means.longest_edge.add(*std::max_element(edges, edges + 6), weight);
    const Vec3d base = cross(a, b);
    const double facet =
        (length(cross(ab, ac)) + length(cross(b, c)) + length(cross(a, c)) + length(base)) / 8;
    means.tet_facet.add(facet, weight);
    if (proper) {
        means.edge.of_tets.add((edges[0] + edges[1] + edges[2] + edges[3] + edges[4] + edges[5]) / 6, weight);
        means.facet.of_tets.add(facet, weight);
    }
    const double volume = std::abs(dot(base, c));
    means.volume.add(volume / 6, weight);
    // The exact test is only needed where rounding may have changed the sign.
    std::uint64_t exact_tests = 0;
    if (!(volume > 1e-12 * side * side * side) && orientation(p[0], p[1], p[2], p[3], exact_tests) == 0)
        means.degenerate += weight;
}

// By halving (C. A. R. Hoare, Algorithm 65: Find, CACM 4, 1961), with weights. The mean of the two middle
// values where the weights below and above are equal.
double median(std::span<std::pair<double, double>> values) {
    double half = 0;
    for (const auto& [value, weight] : values) half += weight / 2;
    auto first = values.begin(), last = values.end();
    while (last - first > 1) {
        const auto middle = first + (last - first) / 2;
        std::nth_element(first, middle, last);
        double below = 0;
        for (auto at = first; at != middle; ++at) below += at->second;
        if (half <= below) {
            last = middle;
        } else {
            half -= below;
            first = middle;
        }
    }
    if (first == last) return 0;
    if (half < first->second || last == values.end()) return first->first;
    return (first->first + std::min_element(last, values.end())->first) / 2;
}

// ---- samples of meshes ----------------------------------------------------------------------------

// Calls visit(item, weight) for about `wanted` of the items, which together stand for `count` of their kind.
template <class Items, class Visit>
void for_sample(const Items& items, std::uint64_t count, double wanted, double place, Visit&& visit) {
    if (items.empty()) return;
    const auto used = std::min<std::uint64_t>(items.size(), static_cast<std::uint64_t>(wanted) + 1);
    const double weight = static_cast<double>(count) / static_cast<double>(used);
    for_stratified(items.size(), used, place,
                   [&](std::uint64_t i) { visit(items[static_cast<std::size_t>(i)], weight); });
}

// Adds the part of a mesh's sample that it has of the scene's tetrahedra, edges and facets (`stats`). at(v)
// is the exact position of a vertex.
template <class At>
void add_sample(const Body& body, const MeshSample& sample, const vox_geometry& stats, double samples,
                double place, Means& means, At&& at) {
    const auto share = [&](std::uint64_t own, std::uint64_t all) {
        return samples * (static_cast<double>(own) / static_cast<double>(std::max<std::uint64_t>(all, 1)));
    };
    const std::uint64_t tets = body.tets.size() - body.off_count;
    for_sample(sample.tets, tets, share(tets, stats.tets), place, [&](const Tet& tet, double weight) {
        const std::uint32_t* v = tet.v;
        add_tet({at(v[0]), at(v[1]), at(v[2]), at(v[3])}, weight, !names_a_vertex_twice(tet), means);
    });
    for_sample(sample.edges, sample.edge_count, share(sample.edge_count, stats.edges), place,
               [&](const MeshSample::Edge& edge, double weight) {
                   means.edge.add(length(at(edge.v[1]) - at(edge.v[0])), weight, edge.tets);
               });
    const auto for_facets = [&](const auto& facets, std::uint64_t count, double wanted, auto&& add) {
        for_sample(facets, count, wanted, place, [&](const MeshSample::Facet& facet, double weight) {
            add(area(at(facet.v[0]), at(facet.v[1]), at(facet.v[2])), weight, facet.tets);
        });
    };
    for_facets(sample.facets, sample.facet_count, share(sample.facet_count, stats.facets),
               [&](double area, double weight, std::uint32_t tets) { means.facet.add(area, weight, tets); });
    for_facets(sample.boundary_facets, sample.boundary_facet_count,
               share(sample.boundary_facet_count, stats.boundary_facets) / 2,
               [&](double area, double weight, std::uint32_t) { means.boundary_facet.add(area, weight); });
}

// The box of the vertices of a body without `unused` ones (bits; empty: all are used). `known` is the box of
// all vertices, or null.
Bounds bounds_of(const Body& body, std::span<const std::uint64_t> unused, const Box* known) {
    Bounds bounds;
    if (body.vertex_count == 0) return bounds;
    if (unused.empty() && fast::is_packed(body.positions)) {
        Box all = empty_box, block{}, group{};
        if (known) {
            all = *known;
        } else {
            const std::uint32_t ends[2] = {0, body.vertex_count};
            if (!fast::stream_boxes(reinterpret_cast<const float*>(body.positions.data), ends, &block, &group,
                                    all))
                check_finite(body);
        }
        bounds.add({double{all.lo[0]}, double{all.lo[1]}, double{all.lo[2]}},
                   {double{all.hi[0]}, double{all.hi[1]}, double{all.hi[2]}});
        return bounds;
    }
    check_finite(body);
    for (std::uint32_t v = 0; v < body.vertex_count; ++v) {
        if (has_bit(unused, v)) continue;
        const Vec3d p = body.positions.exact(v);
        bounds.add(p, p);
    }
    return bounds;
}

// The first vertex from `v` on that is at an end of a box, along any axis.
std::uint32_t next_at_end(const Body& body, std::uint32_t v, const Bounds& bounds) {
    const auto is_at_end = [&](const Vec3d& p) {
        return p.x == bounds.lo.x || p.x == bounds.hi.x || p.y == bounds.lo.y || p.y == bounds.hi.y ||
               p.z == bounds.lo.z || p.z == bounds.hi.z;
    };
    if (fast::is_packed(body.positions)) { // some at a time, without a branch
        constexpr std::size_t some = 16, numbers = 12;
        const auto* const p = reinterpret_cast<const float*>(body.positions.data);
        float lo[numbers], hi[numbers];
        for (std::size_t i = 0; i < numbers; ++i) {
            lo[i] = static_cast<float>((&bounds.lo.x)[i % 3]);
            hi[i] = static_cast<float>((&bounds.hi.x)[i % 3]);
        }
        for (; v + some <= body.vertex_count; v += some) {
            std::uint32_t at_end[numbers] = {};
            for (std::size_t first = 3 * std::size_t{v}, n = 0; n < 3 * some; n += numbers)
                for (std::size_t i = 0; i < numbers; ++i)
                    at_end[i] |= static_cast<std::uint32_t>(p[first + n + i] == lo[i]) |
                                 static_cast<std::uint32_t>(p[first + n + i] == hi[i]);
            if (std::any_of(at_end, at_end + numbers, [](std::uint32_t is) { return is != 0; })) break;
        }
    }
    while (v < body.vertex_count && !is_at_end(body.positions.exact(v))) ++v;
    return v;
}

// Whether some vertex at each end of a box of all vertices, along each axis, is used by a tetrahedron: the
// box is that of the used ones, then. Looks at one vertex for each.
bool is_of_used(const Bounds& bounds, const Body& body) {
    bool found[3][2] = {};
    int left = 6;
    for (std::uint32_t v = 0; left > 0; ++v) {
        v = next_at_end(body, v, bounds);
        if (v == body.vertex_count) return false;
        const Vec3d p = body.positions.exact(v);
        for (int a = 0; a < 3; ++a)
            for (int end = 0; end < 2; ++end) {
                if (found[a][end] || (&p.x)[a] != (&(end == 0 ? bounds.lo : bounds.hi).x)[a]) continue;
                if (!is_used(body, v)) return false;
                found[a][end] = true;
                --left;
            }
    }
    return true;
}

constexpr double everything = 1e18;

// In a scene that is not a grid's and has more tetrahedra than are measured in full, tetrahedra are sampled,
// and vertices whose edges and facets are listed.

std::uint64_t some_vertices(std::uint64_t tets) { return std::clamp<std::uint64_t>(tets / 100, 192, 1024); }
std::uint64_t some_tets(std::uint64_t tets) { return std::clamp<std::uint64_t>(tets / 32, 640, 4096); }

// A body's part of the sample of such a scene.
SampleSize sample_size(const Body& body, const vox_geometry& stats, std::uint64_t most_whole) {
    if (stats.tets <= most_whole) return {body.vertex_count, body.tets.size()};
    const auto part = [&](std::uint64_t of_all) {
        const double own = static_cast<double>(body.tets.size()) / static_cast<double>(stats.tets);
        return static_cast<std::size_t>(static_cast<double>(of_all) * own) + 8;
    };
    return {part(some_vertices(stats.tets)), part(some_tets(stats.tets))};
}

} // namespace

Geometry measure(const CellSizeScene& scene, std::uint64_t most_whole) {
    Geometry result{};
    vox_geometry& stats = result.stats;
    for (const Body& body : scene.bodies) {
        stats.vertices += body.vertex_count;
        stats.tets += body.tets.size() - body.off_count;
    }
    const bool kept = !scene.meshes.empty() && stats.tets > 2 * sampled_tets(stats.tets);
    const double samples = kept ? static_cast<double>(sampled_tets(stats.tets)) : everything;

    Means means(scene.memory);
    const std::uint64_t measured = kept                       ? sampled_tets(stats.tets)
                                   : stats.tets <= most_whole ? stats.tets
                                                              : some_tets(stats.tets);
    means.box_sides.reserve(static_cast<std::size_t>(measured) + 9 * scene.bodies.size());
    Array<MeshSample> made(scene.memory);
    made.reserve(kept ? 0 : scene.bodies.size());
    const auto sample_of = [&](std::size_t b) -> const MeshSample& {
        return kept ? scene.meshes[b]->sample() : made[b];
    };
    Bounds bounds;
    bool whole = !kept; // all edges and facets are looked at
    for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
        const Body& body = scene.bodies[b];
        if (!kept) made.push_back(make_sample(body, sample_size(body, stats, most_whole), scene.memory));
        const MeshSample& sample = sample_of(b);
        stats.edges += sample.edge_count;
        stats.facets += sample.facet_count;
        stats.boundary_facets += sample.boundary_facet_count;
        whole = whole && sample.is_whole;
        // Where the boxes of the bodies are not known yet, this finds positions that are not finite.
        Bounds own = bounds_of(body, sample.unused_vertices, scene.box(b));
        if (!kept && body.tets.size() > body.off_count && !(body.off.empty() && is_of_used(own, body)))
            own = bounds_of(body, unused_vertices(body, scene.memory), scene.box(b));
        if (own.empty()) continue;
        bounds.add(own.lo, own.hi);
        const Vec3d sides = own.hi - own.lo;
        const double volume = sides.x * sides.y * sides.z;
        if (volume > 0) means.object_side.add(std::cbrt(volume), 1);
    }

    double place = 0.5; // another one for each mesh, since many may be alike
    for (std::size_t b = 0; b < scene.bodies.size(); ++b, place = next_place(place)) {
        const Body& body = scene.bodies[b];
        const Positions& positions = body.positions;
        const auto add = [&](auto&& at) { add_sample(body, sample_of(b), stats, samples, place, means, at); };
        if (positions.rounded()) // a third of the time is reading positions, so floats are read as such
            add([&](std::size_t v) { return positions.exact(v); });
        else
            add([&](std::size_t v) { return Vec3d(positions.floats(v)); });
    }

    stats.degenerate_tets = static_cast<std::uint64_t>(std::llround(means.degenerate));
    stats.mean_edge = means.edge.value(whole);
    stats.mean_longest_edge = means.longest_edge.value();
    stats.mean_box_side = means.box_side.value();
    stats.mean_facet_area = means.facet.value(whole);
    stats.mean_tet_facet_area = means.tet_facet.value();
    stats.mean_boundary_facet_area = means.boundary_facet.value();
    stats.mean_volume = means.volume.value();
    stats.median_box_side = median(means.box_sides);
    if (!bounds.empty()) {
        std::copy_n(&bounds.lo.x, 3, stats.bounds_min);
        std::copy_n(&bounds.hi.x, 3, stats.bounds_max);
    }
    result.mean_object_side = means.object_side.value();
    return result;
}

} // namespace vox
