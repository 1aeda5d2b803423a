// Means over a part of the scene: the samples of its meshes, or of many meshes some of these.
#include "cell_size/geometry.hpp"

#include "base/bits.hpp"
#include "exact/predicates.hpp"
#include "fast/last_positions.hpp"
#include "fast/stream.hpp"
#include "mesh/check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory_resource>
#include <span>
#include <utility>
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

constexpr double infinity = std::numeric_limits<double>::infinity();

struct Means {
    explicit Means(std::pmr::memory_resource* memory) : box_sides(memory) {}

    Mean edge, longest_edge, box_side, facet, tet_facet, boundary_facet, volume, degenerate;
    std::pmr::vector<std::pair<double, double>> box_sides; // and their weights
};

// at(v) is the exact position of a vertex, here and below.
template <class At>
void add_tet(const MeshSample::SampledTet& sampled, const At& at, double weight, Means& means) {
    const std::uint32_t* v = sampled.tet.v;
    const Vec3d p[4] = {at(v[0]), at(v[1]), at(v[2]), at(v[3])};
    const Vector a = between(p[0], p[1]), b = between(p[0], p[2]), c = between(p[0], p[3]);
    const auto extent = [](double first, double second, double third) { // of three numbers and 0
        return std::max(std::max(first, second), std::max(third, 0.0)) -
               std::min(std::min(first, second), std::min(third, 0.0));
    };
    const double side =
        std::max(extent(a.x, b.x, c.x), std::max(extent(a.y, b.y, c.y), extent(a.z, b.z, c.z)));
    means.box_side.add(side, weight);
    means.box_sides.emplace_back(side, weight);
    const Vector ab = between(p[1], p[2]), ac = between(p[1], p[3]), bc = between(p[2], p[3]);
    const double longest =
        std::max(std::max(std::max(dot(a, a), dot(b, b)), std::max(dot(c, c), dot(ab, ab))),
                 std::max(dot(ac, ac), dot(bc, bc)));
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
    for (std::uint32_t f = 0; f < 4; ++f) {
        const double facet = length(facets[f]) / 2;
        const double part = (sampled.shared >> f & 1) != 0 ? 0.5 : 1.0;
        all += facet;
        own += facet * part;
        count += part;
    }
    means.tet_facet.add(all / 4, weight);
    if (sampled.shared != MeshSample::SampledTet::no_facets) means.facet.add(own / count, weight * count);
}

// Takes some of a mesh's samples: of so many in the scene about `wanted`, as large a part as the mesh has of
// `all`, and one at least.
struct Share {
    double wanted;
    double place; // in the parts that a list is cut into, 0 to 1: another one for each mesh, as many may be
                  // alike

    // Calls visit(item, weight) for the items, which stand for `count`.
    template <class Items, class Visit>
    void take(const Items& items, std::uint64_t count, std::uint64_t all, Visit&& visit) const {
        if (items.empty()) return;
        const auto size = static_cast<double>(items.size());
        const double share = wanted * (static_cast<double>(count) / static_cast<double>(all));
        const double used = std::min(size, std::floor(share) + 1), part = size / used;
        for (double i = 0; i < used; ++i)
            visit(items[std::min(static_cast<std::size_t>((i + place) * part), items.size() - 1)],
                  static_cast<double>(count) / used);
    }
};

// `stats` has how many there are of all.
template <class At>
void add_mesh(const Body& body, const MeshSample& sample, const At& at, const Share& share,
              const vox_geometry_stats& stats, Means& means) {
    share.take(sample.tets, body.tets.size() - body.off_count, stats.tets,
               [&](const MeshSample::SampledTet& tet, double weight) { add_tet(tet, at, weight, means); });
    share.take(sample.edges, sample.edge_count, stats.edges,
               [&](const MeshSample::Edge& edge, double weight) {
                   means.edge.add(length(between(at(edge[0]), at(edge[1]))), weight);
               });
    const Share half{share.wanted / 2, share.place};
    half.take(sample.facets, sample.boundary_facet_count, stats.boundary_facets,
              [&](const MeshSample::Facet& facet, double weight) {
                  means.boundary_facet.add(area(at(facet[0]), at(facet[1]), at(facet[2])), weight);
              });
}

// By halving (C. A. R. Hoare, Algorithm 65: Find, CACM 4, 1961), with weights.
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
    return first == last ? 0 : first->first;
}

// The box of the vertices that tetrahedra use, of all vertices for a body without tetrahedra.
struct Extent {
    bool any = false;
    double lo[3] = {infinity, infinity, infinity}, hi[3] = {-infinity, -infinity, -infinity};
};

// `box` is that of all vertices, if it is known.
Extent extent_of(const Body& body, const MeshSample& sample, const Box* box) {
    Extent extent;
    const bool some_unused = !sample.unused_vertices.empty();
    if (body.vertex_count > 0 && !some_unused && fast::is_packed(body.positions)) {
        Box all = empty_box, same{};
        if (box) {
            all = *box;
        } else {
            const std::uint32_t ends[2] = {0, body.vertex_count};
            if (!fast::stream_boxes(reinterpret_cast<const float*>(body.positions.data), ends, &all, same))
                check_finite(body);
        }
        extent.any = true;
        for (int a = 0; a < 3; ++a) {
            extent.lo[a] = double{all.lo[a]};
            extent.hi[a] = double{all.hi[a]};
        }
        return extent;
    }
    check_finite(body);
    for (std::uint32_t v = 0; v < body.vertex_count; ++v) {
        if (some_unused && has_bit(sample.unused_vertices, v)) continue;
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

Geometry estimate(std::span<const Body> bodies, std::span<const MeshSample* const> meshes,
                  std::span<const Box> boxes, std::size_t samples, std::pmr::memory_resource* memory) {
    Geometry result{};
    vox_geometry_stats& stats = result.stats;
    Extent bounds;
    Mean object_side;
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        const Extent own = extent_of(bodies[b], *meshes[b], boxes.empty() ? nullptr : &boxes[b]);
        stats.vertices += bodies[b].vertex_count;
        stats.tets += bodies[b].tets.size() - bodies[b].off_count;
        stats.boundary_facets += meshes[b]->boundary_facet_count;
        stats.edges += meshes[b]->edge_count;
        if (!own.any) continue;
        bounds.any = true;
        double volume = 1;
        for (int a = 0; a < 3; ++a) {
            bounds.lo[a] = std::min(bounds.lo[a], own.lo[a]);
            bounds.hi[a] = std::max(bounds.hi[a], own.hi[a]);
            volume *= own.hi[a] - own.lo[a];
        }
        if (volume > 0) object_side.add(std::cbrt(volume), 1);
    }
    Means means(memory);
    constexpr double golden = 0.6180339887498949; // its multiples are spread evenly (H. Weyl, 1916)
    Share share{static_cast<double>(samples), 0.5};
    means.box_sides.reserve(samples + bodies.size());
    for (std::size_t b = 0; b < bodies.size(); ++b, share.place += golden) {
        share.place -= std::floor(share.place);
        const Positions& positions = bodies[b].positions;
        if (positions.rounded())
            add_mesh(
                bodies[b], *meshes[b], [&](std::size_t v) { return positions.exact(v); }, share, stats,
                means);
        else
            add_mesh(
                bodies[b], *meshes[b], [&](std::size_t v) { return Vec3d(positions.floats(v)); }, share,
                stats, means);
    }
    // Each facet of a tetrahedron is on the surface or shared by two, but for the odd one of more.
    stats.facets = (4 * stats.tets + stats.boundary_facets) / 2;
    stats.degenerate_tets = static_cast<std::uint64_t>(std::llround(means.degenerate.sum));
    write_means(means, stats);
    stats.median_box_side = median(means.box_sides);
    for (int a = 0; a < 3 && bounds.any; ++a) {
        stats.bounds_min[a] = bounds.lo[a];
        stats.bounds_max[a] = bounds.hi[a];
    }
    result.mean_object_side = object_side.value();
    return result;
}

} // namespace vox
