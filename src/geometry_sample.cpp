// Means over a part of the scene: tetrahedra, edges, facets and boundary triangles, each from as many equal
// parts of their lists, so that large meshes are described in next to no time.
#include "geometry.hpp"

#include "bits.hpp"
#include "fast/rest.hpp"
#include "fast/stream.hpp"
#include "mesh_check.hpp"
#include "predicates.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace vox {

namespace {

struct Vector {
    double x, y, z;
};

Vector between(const Vec3d& a, const Vec3d& b) { return {b.x - a.x, b.y - a.y, b.z - a.z}; }
Vector cross(const Vector& a, const Vector& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
double dot(const Vector& a, const Vector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
double length(const Vector& a) { return std::sqrt(dot(a, a)); }

double area(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    return length(cross(between(a, b), between(a, c))) / 2;
}

// Of a sample in which each item stands for `weight` of its like.
struct Mean {
    double sum = 0, count = 0;

    void add(double value, double weight) {
        sum += value * weight;
        count += weight;
    }
    double value() const { return count > 0 ? sum / count : 0; }
};

struct Means {
    Mean edge, longest_edge, box_side, facet, tet_facet, boundary_facet, volume, degenerate;
    std::vector<std::pair<double, double>> box_sides; // and their weights
};

// visit(index, weight) for some of `count` items: as large a part as `wanted` is of `all`, and a few at
// least.
template <class Visit>
void for_some(std::size_t count, double wanted, double all, Visit&& visit) {
    if (count == 0 || !(all > 0)) return; // all > 0 unless every tetrahedron is off
    const double part = std::min(wanted / all, 1.0) * static_cast<double>(count);
    const std::size_t samples = std::min(count, static_cast<std::size_t>(part) + 1);
    const double each = static_cast<double>(count) / static_cast<double>(samples);
    for (std::size_t i = 0; i < samples; ++i)
        visit(static_cast<std::size_t>((static_cast<double>(i) + 0.5) * each), each);
}

// at(v) is the exact position of a vertex, here and below.
template <class At>
void sample_tet(const Body& body, const depth::Topology& topology, const At& at, std::size_t t, double weight,
                Means& means) {
    const Tet& tet = body.tets[t];
    const Vec3d p[4] = {at(tet.v[0]), at(tet.v[1]), at(tet.v[2]), at(tet.v[3])};
    const Vector a = between(p[0], p[1]), b = between(p[0], p[2]), c = between(p[0], p[3]);
    const auto extent = [](double first, double second, double third) { // of three numbers and 0
        return std::max(std::max(first, second), std::max(third, 0.0)) -
               std::min(std::min(first, second), std::min(third, 0.0));
    };
    const double side = std::max({extent(a.x, b.x, c.x), extent(a.y, b.y, c.y), extent(a.z, b.z, c.z)});
    means.box_side.add(side, weight);
    means.box_sides.emplace_back(side, weight);
    const Vector ab = between(p[1], p[2]), ac = between(p[1], p[3]), bc = between(p[2], p[3]);
    const double longest = std::max(std::max({dot(a, a), dot(b, b), dot(c, c)}),
                                    std::max({dot(ab, ab), dot(ac, ac), dot(bc, bc)}));
    means.longest_edge.add(std::sqrt(longest), weight);
    // Twice the facet opposite each corner, but for the sign.
    const Vector facets[4] = {cross(ab, ac), cross(b, c), cross(a, c), cross(a, b)};
    const double volume = std::abs(dot(facets[3], c));
    means.volume.add(volume / 6, weight);
    // Where rounding may have made it what it is, the exact test decides.
    std::uint64_t exact_tests = 0;
    const bool flat =
        !(volume > 1e-12 * side * side * side) && orientation(p[0], p[1], p[2], p[3], exact_tests) == 0;
    means.degenerate.add(flat, weight);
    double all = 0, own = 0, count = 0; // facets that two tetrahedra share are met from both of them
    for (std::size_t f = 0; f < 4; ++f) {
        const double facet = length(facets[f]) / 2;
        const double part = (topology.across[t][f] & depth::Topology::surface_bit) == 0 ? 0.5 : 1.0;
        all += facet;
        own += facet * part;
        count += part;
    }
    means.tet_facet.add(all / 4, weight);
    means.facet.add(own / count, weight * count);
}

// Some edges at each of some vertices, at places in its list that go round by the golden ratio (Weyl).
template <class At>
void sample_edges(const Body& body, const depth::Topology& topology, const At& at, double wanted, double all,
                  Mean& edge) {
    constexpr std::size_t most = 2; // of a vertex
    double place = 0.5;
    for_some(body.vertex_count, wanted / most, all, [&](std::size_t v, double weight) {
        const auto neighbours = topology.neighbours_of(static_cast<std::uint32_t>(v));
        const std::size_t count = std::min(most, neighbours.size());
        const Vec3d p = at(v);
        for (std::size_t i = 0; i < count; ++i) {
            place += 0.6180339887498949;
            place -= std::floor(place);
            const auto n = static_cast<std::size_t>(place * static_cast<double>(neighbours.size()));
            // Each edge is met from both of its ends.
            edge.add(length(between(p, at(neighbours[n]))),
                     weight / 2 * static_cast<double>(neighbours.size()) / static_cast<double>(count));
        }
    });
}

// Its share of so many of all; `stats` has how many there are.
template <class At>
void sample_body(const Body& body, const depth::Topology& topology, const At& at, double wanted,
                 const vox_geometry_stats& stats, Means& means) {
    for_some(body.tets.size(), wanted, static_cast<double>(stats.tets), [&](std::size_t t, double weight) {
        if (!has_bit(body.off, t)) sample_tet(body, topology, at, t, weight, means);
    });
    sample_edges(body, topology, at, wanted, static_cast<double>(stats.vertices), means.edge);
    for_some(topology.triangles.size(), wanted / 2, static_cast<double>(stats.boundary_facets),
             [&](std::size_t i, double weight) {
                 const std::uint32_t* v = topology.triangles[i].v;
                 means.boundary_facet.add(area(at(v[0]), at(v[1]), at(v[2])), weight);
             });
}

// By halving (C. A. R. Hoare, Algorithm 65: Find, CACM 4, 1961), with weights.
double median(std::vector<std::pair<double, double>>& values) {
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
    return first == last ? 0 : first->first;
}

// Edges, each counted from both ends; and the box of the vertices that tetrahedra use, of all vertices for a
// body without tetrahedra.
struct Extent {
    std::uint64_t ends = 0;
    bool any = false;
    double lo[3], hi[3];
};

Extent extent_of(const Body& body, const depth::Topology& topology) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Extent extent{0, false, {infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
    bool some_unused = false;
    for (std::uint32_t v = 0; v < topology.neighbours.size(); ++v) {
        const std::size_t neighbours = topology.neighbours[v].size();
        extent.ends += neighbours;
        some_unused |= neighbours == 0;
    }
    if (body.vertex_count > 0 && !some_unused && fast::is_packed(body.positions)) {
        const std::uint32_t all[2] = {0, body.vertex_count};
        fast::Box box{}, same{};
        if (!fast::stream_boxes(reinterpret_cast<const float*>(body.positions.data), all, &box, same))
            check_finite(body);
        extent.any = true;
        for (int a = 0; a < 3; ++a) {
            extent.lo[a] = double{box.lo[a]};
            extent.hi[a] = double{box.hi[a]};
        }
        return extent;
    }
    check_finite(body);
    for (std::uint32_t v = 0; v < body.vertex_count; ++v) {
        if (!body.tets.empty() && topology.neighbours_of(v).empty()) continue;
        const Vec3d p = body.positions.exact(v);
        const double x[3] = {p.x, p.y, p.z};
        extent.any = true;
        for (int a = 0; a < 3; ++a) {
            extent.lo[a] = std::min(extent.lo[a], x[a]);
            extent.hi[a] = std::max(extent.hi[a], x[a]);
        }
    }
    return extent;
}

} // namespace

Geometry estimate(std::span<const Body> bodies, std::span<const depth::Topology* const> topologies,
                  std::size_t samples) {
    Geometry result{};
    vox_geometry_stats& stats = result.stats;
    constexpr double infinity = std::numeric_limits<double>::infinity();
    double lo[3] = {infinity, infinity, infinity}, hi[3] = {-infinity, -infinity, -infinity};
    Mean object_side;
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        const Extent own = extent_of(bodies[b], *topologies[b]);
        stats.vertices += bodies[b].vertex_count;
        stats.tets += bodies[b].tets.size() - bodies[b].off_count;
        stats.boundary_facets += topologies[b]->triangles.size();
        stats.edges += own.ends / 2;
        if (!own.any) continue;
        double volume = 1;
        for (int a = 0; a < 3; ++a) {
            lo[a] = std::min(lo[a], own.lo[a]);
            hi[a] = std::max(hi[a], own.hi[a]);
            volume *= own.hi[a] - own.lo[a];
        }
        if (volume > 0) object_side.add(std::cbrt(volume), 1);
    }
    Means means;
    const auto wanted = static_cast<double>(samples);
    means.box_sides.reserve(samples + bodies.size());
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        const Positions& positions = bodies[b].positions;
        if (positions.rounded())
            sample_body(
                bodies[b], *topologies[b], [&](std::size_t v) { return positions.exact(v); }, wanted, stats,
                means);
        else
            sample_body(
                bodies[b], *topologies[b], [&](std::size_t v) { return Vec3d(positions.floats(v)); }, wanted,
                stats, means);
    }
    // Each facet of a tetrahedron is on the surface or shared by two, but for the odd one of more.
    stats.facets = (4 * stats.tets + stats.boundary_facets) / 2;
    stats.degenerate_tets = static_cast<std::uint64_t>(std::llround(means.degenerate.sum));
    write_means(means, stats);
    stats.median_box_side = median(means.box_sides);
    for (int a = 0; a < 3 && lo[a] <= hi[a]; ++a) {
        stats.bounds_min[a] = lo[a];
        stats.bounds_max[a] = hi[a];
    }
    result.mean_object_side = object_side.value();
    return result;
}

} // namespace vox
