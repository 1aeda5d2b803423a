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

struct Means {
    explicit Means(std::pmr::memory_resource* memory) : box_sides(memory) {}

    Mean edge, longest_edge, box_side, facet, tet_facet, boundary_facet, volume, object_side;
    double degenerate = 0;
    std::pmr::vector<std::pair<double, double>> box_sides; // and their weights
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

// `facets` gets the areas of the facets opposite each corner.
void add_tet(const Vec3d (&p)[4], double weight, Means& means, double (&facets)[4]) {
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
    const double longest =
        std::max(std::max(std::max(dot(a, a), dot(b, b)), std::max(dot(c, c), dot(ab, ab))),
                 std::max(dot(ac, ac), dot(bc, bc)));
    means.longest_edge.add(std::sqrt(longest), weight);
    const Vec3d base = cross(a, b);
    facets[0] = length(cross(ab, ac)) / 2;
    facets[1] = length(cross(b, c)) / 2;
    facets[2] = length(cross(a, c)) / 2;
    facets[3] = length(base) / 2;
    means.tet_facet.add((facets[0] + facets[1] + facets[2] + facets[3]) / 4, weight);
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

// ---- all of a body --------------------------------------------------------------------------------

constexpr int edge_corners[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};

// Calls visit(a, b) once for every edge, a < b, of tetrahedra that name no vertex twice: a counting sort by
// `a` makes short lists, which are then sorted by `b`.
template <class Visit>
void for_each_edge(std::span<const Tet> tets, std::uint32_t vertex_count, std::pmr::memory_resource* memory,
                   Visit&& visit) {
    std::pmr::vector<std::uint64_t> ends(std::size_t{vertex_count} + 1, 0, memory);
    const auto for_all = [&](auto&& emit) {
        for (Tet tet : tets) {
            if (names_a_vertex_twice(tet)) continue;
            std::sort(tet.v, tet.v + 4);
            for (const auto& edge : edge_corners) emit(tet.v[edge[0]], tet.v[edge[1]]);
        }
    };
    for_all([&](std::uint32_t a, std::uint32_t) { ++ends[std::size_t{a} + 1]; });
    for (std::size_t v = 0; v < vertex_count; ++v) ends[v + 1] += ends[v];
    std::pmr::vector<std::uint32_t> others(static_cast<std::size_t>(ends[vertex_count]), memory);
    // Placing moves ends[a] from the start of list a to its end, the start of list a + 1.
    for_all([&](std::uint32_t a, std::uint32_t b) { others[static_cast<std::size_t>(ends[a]++)] = b; });
    auto first = others.begin();
    for (std::uint32_t v = 0; v < vertex_count; ++v) {
        const auto last = others.begin() + static_cast<std::ptrdiff_t>(ends[v]);
        std::sort(first, last);
        std::for_each(first, std::unique(first, last), [&](std::uint32_t b) { visit(v, b); });
        first = last;
    }
}

// Returns the box of the vertices that tetrahedra use. Those that are off name one vertex four times, and so
// have no edges and facets.
Bounds add_all(const Body& body, std::pmr::memory_resource* memory, Means& means) {
    const auto at = [&](std::uint64_t v) { return body.positions.exact(v); };
    Bounds bounds;
    for (std::size_t t = 0; t < body.tets.size(); ++t) {
        if (has_bit(body.off, t)) continue;
        const std::uint32_t* v = body.tets[t].v;
        const Vec3d p[4] = {at(v[0]), at(v[1]), at(v[2]), at(v[3])};
        double facets[4];
        add_tet(p, 1, means, facets);
        bounds.add(min(min(p[0], p[1]), min(p[2], p[3])), max(max(p[0], p[1]), max(p[2], p[3])));
    }
    for_each_edge(body.tets, body.vertex_count, memory,
                  [&](std::uint32_t a, std::uint32_t b) { means.edge.add(length(at(b) - at(a)), 1); });
    for_each_facet(
        body.tets, body.vertex_count, memory, [&](std::uint32_t v, std::span<const TetFacet> same) {
            const double size = area(at(v), at(same[0].others >> 32), at(same[0].others & 0xffffffffu));
            means.facet.add(size, 1);
            if (same.size() == 1) means.boundary_facet.add(size, 1);
        });
    return bounds;
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

// Adds the part of a mesh's samples that it has of the scene's tetrahedra, edges and boundary facets
// (`stats`). at(v) is the exact position of a vertex.
template <class At>
void add_sample(const Body& body, const MeshSample& sample, const vox_geometry_stats& stats, double samples,
                double place, Means& means, At&& at) {
    const auto share = [&](std::uint64_t own, std::uint64_t all) {
        return samples * (static_cast<double>(own) / static_cast<double>(std::max<std::uint64_t>(all, 1)));
    };
    const std::uint64_t tets = body.tets.size() - body.off_count;
    for_sample(sample.tets, tets, share(tets, stats.tets), place,
               [&](const MeshSample::SampledTet& sampled, double weight) {
                   const std::uint32_t* v = sampled.tet.v;
                   double facets[4];
                   add_tet({at(v[0]), at(v[1]), at(v[2]), at(v[3])}, weight, means, facets);
                   if (sampled.shared == MeshSample::SampledTet::no_facets) return;
                   // A facet of two tetrahedra is met from both.
                   double sum = 0, count = 0;
                   for (std::uint32_t f = 0; f < 4; ++f) {
                       const double part = (sampled.shared >> f & 1) != 0 ? 0.5 : 1.0;
                       sum += facets[f] * part;
                       count += part;
                   }
                   means.facet.add(sum / count, weight * count);
               });
    for_sample(sample.edges, sample.edge_count, share(sample.edge_count, stats.edges), place,
               [&](const MeshSample::Edge& edge, double weight) {
                   means.edge.add(length(at(edge[1]) - at(edge[0])), weight);
               });
    for_sample(sample.facets, sample.boundary_facet_count,
               share(sample.boundary_facet_count, stats.boundary_facets) / 2, place,
               [&](const MeshSample::Facet& facet, double weight) {
                   means.boundary_facet.add(area(at(facet[0]), at(facet[1]), at(facet[2])), weight);
               });
}

// The box of the vertices of a body without `unused` ones (bits; empty: all are used). `known` is the box of
// all vertices, or null.
Bounds bounds_of(const Body& body, std::span<const std::uint64_t> unused, const Box* known) {
    Bounds bounds;
    if (body.vertex_count == 0) return bounds;
    if (unused.empty() && fast::is_packed(body.positions)) {
        Box all = empty_box, block{};
        if (known) {
            all = *known;
        } else {
            const std::uint32_t ends[2] = {0, body.vertex_count};
            if (!fast::stream_boxes(reinterpret_cast<const float*>(body.positions.data), ends, &block, all))
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

} // namespace

Geometry measure(const CellSizeScene& scene) {
    Geometry result{};
    vox_geometry_stats& stats = result.stats;
    for (const Body& body : scene.bodies) {
        stats.vertices += body.vertex_count;
        stats.tets += body.tets.size() - body.off_count;
    }
    const std::size_t samples = sampled_tets(stats.tets);
    const bool sampled =
        !scene.meshes.empty() && stats.tets > 2 * samples &&
        std::ranges::all_of(scene.meshes, [](const Mesh* mesh) { return mesh->may_sample(); });
    if (sampled) {
        for (const Mesh* mesh : scene.meshes) {
            stats.edges += mesh->sample().edge_count;
            stats.boundary_facets += mesh->sample().boundary_facet_count;
        }
    } else {
        for (const Body& body : scene.bodies) check_finite(body);
    }

    Means means(scene.memory);
    means.box_sides.reserve(sampled ? samples + scene.bodies.size() : static_cast<std::size_t>(stats.tets));
    Bounds bounds;
    double place = 0.5; // another one for each mesh, since many may be alike
    for (std::size_t b = 0; b < scene.bodies.size(); ++b, place = next_place(place)) {
        const Body& body = scene.bodies[b];
        Bounds own;
        if (sampled) {
            const MeshSample& sample = scene.meshes[b]->sample();
            const Positions& positions = body.positions;
            const auto add = [&](auto&& at) {
                add_sample(body, sample, stats, static_cast<double>(samples), place, means, at);
            };
            if (positions.rounded()) // a third of the time is reading positions, so floats are read as such
                add([&](std::size_t v) { return positions.exact(v); });
            else
                add([&](std::size_t v) { return Vec3d(positions.floats(v)); });
            own = bounds_of(body, sample.unused_vertices, scene.box(b));
        } else if (body.tets.size() == body.off_count) {
            own = bounds_of(body, {}, nullptr);
        } else {
            own = add_all(body, scene.memory, means);
        }
        if (own.empty()) continue;
        bounds.add(own.lo, own.hi);
        const Vec3d sides = own.hi - own.lo;
        const double volume = sides.x * sides.y * sides.z;
        if (volume > 0) means.object_side.add(std::cbrt(volume), 1);
    }

    if (sampled) {
        // Each facet of a tetrahedron is on the boundary or shared by two, but for the few that more share.
        stats.facets = (4 * stats.tets + stats.boundary_facets) / 2;
    } else {
        stats.edges = static_cast<std::uint64_t>(means.edge.weight);
        stats.facets = static_cast<std::uint64_t>(means.facet.weight);
        stats.boundary_facets = static_cast<std::uint64_t>(means.boundary_facet.weight);
    }
    stats.degenerate_tets = static_cast<std::uint64_t>(std::llround(means.degenerate));
    stats.mean_edge = means.edge.value();
    stats.mean_longest_edge = means.longest_edge.value();
    stats.mean_box_side = means.box_side.value();
    stats.mean_facet_area = means.facet.value();
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
