#include "cell_size/geometry.hpp"

#include "exact/predicates.hpp"
#include "mesh/check.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory_resource>
#include <vector>

namespace vox {

namespace {

// Differences of coordinates below 2^128 do not overflow in double, nor do products of up to six of them: areas and
// volumes of the largest coordinates are finite, and those of the smallest floats are not flushed to zero.
using Eigen::Vector3d;
using Box3d = Eigen::AlignedBox3d;

Vector3d point(const Vec3d& p) { return {p.x, p.y, p.z}; }

double facet_area(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
    return (b - a).cross(c - a).norm() / 2;
}

// A mean whose rounding error does not grow with the number of terms (Kahan 1965).
class Mean {
public:
    void add(double term) {
        const double corrected = term - lost_;
        const double sum = sum_ + corrected;
        lost_ = (sum - sum_) - corrected;
        sum_ = sum;
        ++count_;
    }
    std::uint64_t count() const { return count_; }
    double value() const { return count_ ? sum_ / static_cast<double>(count_) : 0; }

private:
    double sum_ = 0;
    double lost_ = 0;
    std::uint64_t count_ = 0;
};

// The mean of the two middle values where their number is even.
double median(std::pmr::vector<double>& values) {
    if (values.empty()) return 0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    if (values.size() % 2) return *middle;
    return (*std::max_element(values.begin(), middle) + *middle) / 2;
}

// ---- unique edges and facets ----------------------------------------------------------------------

constexpr int edge_corners[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
constexpr int facet_corners[4][3] = {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}};

// Corners in ascending order, so that one edge or facet has one name whatever tetrahedron it is met in.
Tet sorted(const Tet& tet) {
    Tet result = tet;
    std::sort(result.v, result.v + 4);
    return result;
}

// Calls visit(first, rest, multiplicity) once for every different (first, rest) pair that `generate(emit)`
// emits. A counting sort by `first` (a vertex) makes short lists, which are then sorted by `rest`; `generate`
// is called twice, to count and to place.
template <class Rest, class Generate, class Visit>
void for_each_unique(std::uint32_t vertex_count, std::pmr::memory_resource* memory, Generate&& generate,
                     Visit&& visit) {
    std::pmr::vector<std::uint64_t> ends(std::size_t{vertex_count} + 1, 0, memory);
    generate([&](std::uint32_t first, Rest) { ++ends[std::size_t{first} + 1]; });
    for (std::size_t v = 0; v < vertex_count; ++v) ends[v + 1] += ends[v];

    std::pmr::vector<Rest> rests(static_cast<std::size_t>(ends[vertex_count]), memory);
    // Placing moves ends[v] from the start of list v to its end, the start of list v + 1.
    generate([&](std::uint32_t first, Rest rest) { rests[static_cast<std::size_t>(ends[first]++)] = rest; });

    std::size_t begin = 0;
    for (std::uint32_t v = 0; v < vertex_count; ++v) {
        const auto end = static_cast<std::size_t>(ends[v]);
        std::sort(rests.begin() + static_cast<std::ptrdiff_t>(begin),
                  rests.begin() + static_cast<std::ptrdiff_t>(end));
        while (begin < end) {
            std::size_t next = begin + 1;
            while (next < end && rests[next] == rests[begin]) ++next;
            visit(v, rests[begin], next - begin);
            begin = next;
        }
    }
}

// ---- one pass over a scene ------------------------------------------------------------------------

struct Sums {
    explicit Sums(std::pmr::memory_resource* memory) : box_sides(memory) {}

    Mean edge, longest_edge, box_side, facet, tet_facet, boundary_facet, volume;
    std::pmr::vector<double> box_sides;
    std::uint64_t degenerate = 0;

    std::pmr::memory_resource* memory() const { return box_sides.get_allocator().resource(); }
};

Box3d measure_tets(const Body& body, Sums& sums) {
    Box3d bounds;
    for (const Tet& tet : body.tets) {
        const Vec3d corner[4] = {body.positions.exact(tet.v[0]), body.positions.exact(tet.v[1]),
                                 body.positions.exact(tet.v[2]), body.positions.exact(tet.v[3])};
        Vector3d p[4];
        Box3d box;
        for (int i = 0; i < 4; ++i) box.extend(p[i] = point(corner[i]));
        bounds.extend(box);
        const double box_side = box.sizes().maxCoeff();
        sums.box_side.add(box_side);
        sums.box_sides.push_back(box_side);

        double longest = 0;
        for (const auto& edge : edge_corners) longest = std::max(longest, (p[edge[1]] - p[edge[0]]).norm());
        sums.longest_edge.add(longest);
        for (const auto& facet : facet_corners)
            sums.tet_facet.add(facet_area(p[facet[0]], p[facet[1]], p[facet[2]]));
        sums.volume.add(std::abs((p[1] - p[0]).cross(p[2] - p[0]).dot(p[3] - p[0])) / 6);
        std::uint64_t exact_tests = 0;
        if (orientation(corner[0], corner[1], corner[2], corner[3], exact_tests) == 0) ++sums.degenerate;
    }
    return bounds;
}

void measure_edges(const Body& body, Sums& sums) {
    const auto generate = [&](auto&& emit) {
        for (const Tet& tet : body.tets) {
            const Tet t = sorted(tet);
            if (names_a_vertex_twice(t)) continue;
            for (const auto& edge : edge_corners) emit(t.v[edge[0]], t.v[edge[1]]);
        }
    };
    for_each_unique<std::uint32_t>(
        body.vertex_count, sums.memory(), generate, [&](std::uint32_t a, std::uint32_t b, std::size_t) {
            sums.edge.add((point(body.positions.exact(b)) - point(body.positions.exact(a))).norm());
        });
}

void measure_facets(const Body& body, Sums& sums) {
    const auto generate = [&](auto&& emit) {
        for (const Tet& tet : body.tets) {
            const Tet t = sorted(tet);
            if (names_a_vertex_twice(t)) continue;
            for (const auto& facet : facet_corners)
                emit(t.v[facet[0]], std::uint64_t{t.v[facet[1]]} << 32 | t.v[facet[2]]);
        }
    };
    for_each_unique<std::uint64_t>(body.vertex_count, sums.memory(), generate,
                                   [&](std::uint32_t a, std::uint64_t rest, std::size_t multiplicity) {
                                       const double area = facet_area(
                                           point(body.positions.exact(a)), point(body.positions.exact(rest >> 32)),
                                           point(body.positions.exact(rest & 0xffffffffu)));
                                       sums.facet.add(area);
                                       if (multiplicity == 1) sums.boundary_facet.add(area);
                                   });
}

} // namespace

Geometry measure(std::span<const Body> bodies, std::pmr::memory_resource* memory) {
    Geometry result{};
    vox_geometry_stats& stats = result.stats;
    for (const Body& body : bodies) {
        check_finite(body);
        stats.vertices += body.vertex_count;
        stats.tets += body.tets.size();
    }

    Sums sums(memory);
    sums.box_sides.reserve(static_cast<std::size_t>(stats.tets));
    Box3d bounds;
    Mean object_side;
    for (const Body& body : bodies) {
        Box3d box = measure_tets(body, sums);
        measure_edges(body, sums);
        measure_facets(body, sums);
        if (body.tets.empty())
            for (std::uint32_t v = 0; v < body.vertex_count; ++v) box.extend(point(body.positions.exact(v)));
        if (box.isEmpty()) continue;
        bounds.extend(box);
        const double volume = box.volume();
        if (volume > 0) object_side.add(std::cbrt(volume));
    }

    stats.edges = sums.edge.count();
    stats.facets = sums.facet.count();
    stats.boundary_facets = sums.boundary_facet.count();
    stats.degenerate_tets = sums.degenerate;
    write_means(sums, stats);
    stats.median_box_side = median(sums.box_sides);
    if (!bounds.isEmpty())
        for (int axis = 0; axis < 3; ++axis) {
            stats.bounds_min[axis] = bounds.min()[axis];
            stats.bounds_max[axis] = bounds.max()[axis];
        }
    result.mean_object_side = object_side.value();
    return result;
}

} // namespace vox
