// Means over a part of the scene: tetrahedra, edges, facets and boundary triangles, each from as many equal
// parts of their lists, so that large meshes are described in next to no time.
#include "geometry.hpp"

#include "bits.hpp"
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

void sample_tet(const Body& body, const depth::Topology& topology, std::size_t t, double weight,
                Means& means) {
    const Tet& tet = body.tets[t];
    const Vec3d p[4] = {body.positions.exact(tet.v[0]), body.positions.exact(tet.v[1]),
                        body.positions.exact(tet.v[2]), body.positions.exact(tet.v[3])};
    const auto [x0, x1] = std::minmax({p[0].x, p[1].x, p[2].x, p[3].x});
    const auto [y0, y1] = std::minmax({p[0].y, p[1].y, p[2].y, p[3].y});
    const auto [z0, z1] = std::minmax({p[0].z, p[1].z, p[2].z, p[3].z});
    const double side = std::max({x1 - x0, y1 - y0, z1 - z0});
    means.box_side.add(side, weight);
    means.box_sides.emplace_back(side, weight);
    double longest = 0;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < i; ++j) longest = std::max(longest, length(between(p[i], p[j])));
    means.longest_edge.add(longest, weight);
    const Vector a = between(p[0], p[1]), b = between(p[0], p[2]), c = between(p[0], p[3]);
    means.volume.add(std::abs(dot(cross(a, b), c)) / 6, weight);
    std::uint64_t exact_tests = 0;
    means.degenerate.add(orientation(p[0], p[1], p[2], p[3], exact_tests) == 0, weight);
    for (std::size_t f = 0; f < 4; ++f) {
        const auto& corner = depth::facet_corners[f];
        const double facet = area(p[corner[0]], p[corner[1]], p[corner[2]]);
        means.tet_facet.add(facet, weight);
        // One that two tetrahedra share is met from both of them.
        const bool shared = (topology.across[t][f] & depth::Topology::surface_bit) == 0;
        means.facet.add(facet, shared ? weight / 2 : weight);
    }
}

double median(std::vector<std::pair<double, double>>& values) {
    std::sort(values.begin(), values.end());
    double half = 0;
    for (const auto& [value, weight] : values) half += weight / 2;
    for (const auto& [value, weight] : values)
        if ((half -= weight) <= 0) return value;
    return values.empty() ? 0 : values.back().first;
}

} // namespace

Geometry estimate(std::span<const Body> bodies, std::span<const depth::Topology* const> topologies,
                  std::size_t samples) {
    Geometry result{};
    vox_geometry_stats& stats = result.stats;
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        check_finite(bodies[b]);
        stats.vertices += bodies[b].vertex_count;
        stats.tets += bodies[b].tets.size() - bodies[b].off_count;
        stats.boundary_facets += topologies[b]->triangles.size();
    }
    constexpr double infinity = std::numeric_limits<double>::infinity();
    double lo[3] = {infinity, infinity, infinity}, hi[3] = {-infinity, -infinity, -infinity};
    Means means;
    Mean object_side;
    const auto wanted = static_cast<double>(samples);
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        const Body& body = bodies[b];
        const depth::Topology& topology = *topologies[b];
        const auto at = [&](std::size_t v) { return body.positions.exact(v); };
        for_some(body.tets.size(), wanted, static_cast<double>(stats.tets),
                 [&](std::size_t t, double weight) {
                     if (!has_bit(body.off, t)) sample_tet(body, topology, t, weight, means);
                 });
        // A few edges around each of some vertices; each edge is met from both of its ends.
        for_some(body.vertex_count, wanted / 2, static_cast<double>(stats.vertices),
                 [&](std::size_t v, double weight) {
                     for (const std::uint32_t w : topology.neighbours_of(static_cast<std::uint32_t>(v)))
                         means.edge.add(length(between(at(v), at(w))), weight / 2);
                 });
        for_some(topology.triangles.size(), wanted, static_cast<double>(stats.boundary_facets),
                 [&](std::size_t i, double weight) {
                     const std::uint32_t* v = topology.triangles[i].v;
                     means.boundary_facet.add(area(at(v[0]), at(v[1]), at(v[2])), weight);
                 });

        double own_lo[3] = {infinity, infinity, infinity}, own_hi[3] = {-infinity, -infinity, -infinity};
        std::uint64_t ends = 0;
        for (std::uint32_t v = 0; v < body.vertex_count; ++v) {
            const std::size_t neighbours = topology.neighbours_of(v).size();
            ends += neighbours;
            if (!body.tets.empty() && neighbours == 0) continue;
            const Vec3d p = at(v);
            const double x[3] = {p.x, p.y, p.z};
            for (int a = 0; a < 3; ++a) {
                own_lo[a] = std::min(own_lo[a], x[a]);
                own_hi[a] = std::max(own_hi[a], x[a]);
            }
        }
        stats.edges += ends / 2;
        double volume = 1;
        for (int a = 0; a < 3; ++a) {
            lo[a] = std::min(lo[a], own_lo[a]);
            hi[a] = std::max(hi[a], own_hi[a]);
            volume *= std::max(own_hi[a] - own_lo[a], 0.0);
        }
        if (volume > 0) object_side.add(std::cbrt(volume), 1);
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
