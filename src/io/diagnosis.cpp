// Facets, edges and tets are sorted into buckets of equal lowest vertex by counting, and compared within a
// bucket. This takes linear time, and 32 bytes a tet during the call.
#include "io/mesh.hpp"

#include "base/error.hpp"
#include "base/llu.hpp"
#include "exact/predicates.hpp"
#include "io/buckets.hpp"
#include "io/determinant.hpp"
#include "io/position_table.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace vox::io {
namespace {

using Index = std::uint32_t;

std::uint64_t pack(Index high, Index low) { return static_cast<std::uint64_t>(high) << 32 | low; }

std::array<Index, 4> sorted_corners(const Index* tet) {
    std::array<Index, 4> v = {tet[0], tet[1], tet[2], tet[3]};
    std::sort(v.begin(), v.end());
    return v;
}

bool repeats(const std::array<Index, 4>& v) { return v[0] == v[1] || v[1] == v[2] || v[2] == v[3]; }

void count_facets(const MeshData& data, vox_io_report& report) {
    const auto each = [&](const auto& put) {
        for (std::size_t t = 0; t < data.tets.size(); t += 4) {
            const auto v = sorted_corners(&data.tets[t]);
            if (repeats(v)) continue; // it has no proper facets
            put(v[0], pack(v[1], v[2]));
            put(v[0], pack(v[1], v[3]));
            put(v[0], pack(v[2], v[3]));
            put(v[1], pack(v[2], v[3]));
        }
    };
    for_each_run<std::uint64_t>(report.vertices, each, [&](Index, std::uint64_t, std::ptrdiff_t tets) {
        report.boundary_facets += tets == 1;
        report.non_manifold_facets += tets > 2;
    });
}

void count_duplicate_tets(const MeshData& data, vox_io_report& report) {
    using Others = std::array<Index, 3>;
    const auto each = [&](const auto& put) {
        for (std::size_t t = 0; t < data.tets.size(); t += 4) {
            const auto v = sorted_corners(&data.tets[t]);
            put(v[0], Others{v[1], v[2], v[3]});
        }
    };
    for_each_run<Others>(report.vertices, each, [&](Index, const Others&, std::ptrdiff_t copies) {
        report.duplicate_tets += static_cast<std::uint64_t>(copies - 1);
    });
}

void count_edges(const MeshData& data, vox_io_report& report) {
    // An item is the higher vertex, which is below 2^31, with the direction in the lowest bit.
    const auto each = [&](const auto& put) {
        for (std::size_t t = 0; t < data.triangles.size(); t += 3) {
            const Index* v = &data.triangles[t];
            if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) continue;
            for (int i = 0; i < 3; ++i) {
                const Index a = v[i], b = v[(i + 1) % 3];
                put(std::min(a, b), std::max(a, b) << 1 | (a < b));
            }
        }
    };
    sort_in_buckets<Index>(report.vertices, each, [&](Index, const Index* first, const Index* last) {
        while (first != last) {
            const Index* run = first;
            while (run != last && *run >> 1 == *first >> 1) ++run;
            report.open_edges += run - first == 1;
            report.non_manifold_facets += run - first > 2;
            report.misoriented_edges += run - first == 2 && first[0] == first[1];
            first = run;
        }
    });
}

void count_duplicate_vertices(const MeshData& data, vox_io_report& report) {
    PositionTable table(data.positions);
    table.reserve(report.vertices);
    for (Index v = 0; v < report.vertices; ++v) report.duplicate_vertices += table.enter(v) != v;
}

// Counts components (by union-find over the vertices of each element, with path halving) and unused vertices,
// and finds the bounds.
void count_components(const MeshData& data, vox_io_report& report) {
    std::vector<Index> parent(report.vertices);
    std::vector<bool> used(report.vertices, false);
    for (Index v = 0; v < parent.size(); ++v) parent[v] = v;
    const auto root = [&](Index v) {
        while (parent[v] != v) v = parent[v] = parent[parent[v]];
        return v;
    };
    const auto connect = [&](const std::vector<Index>& elements, std::size_t corners) {
        for (std::size_t i = 0; i < elements.size(); ++i) {
            used[elements[i]] = true;
            const Index a = root(elements[i]), b = root(elements[i - i % corners]);
            if (a < b) parent[b] = a;
            if (b < a) parent[a] = b;
        }
    };
    connect(data.tets, 4);
    connect(data.triangles, 3);
    for (Index v = 0; v < parent.size(); ++v) {
        report.components += used[v] && parent[v] == v;
        report.unused_vertices += !used[v];
    }

    const bool none_used = report.unused_vertices == report.vertices;
    bool first = true;
    for (std::uint64_t v = 0; v < report.vertices; ++v) {
        if (!used[v] && !none_used) continue;
        for (int k = 0; k < 3; ++k) {
            const double x = data.positions[3 * v + static_cast<std::size_t>(k)];
            report.bounds_min[k] = first ? x : std::min(report.bounds_min[k], x);
            report.bounds_max[k] = first ? x : std::max(report.bounds_max[k], x);
        }
        first = false;
    }
}

struct Corners {
    Corners(const MeshData& data, const Index* tet) {
        for (int i = 0; i < 4; ++i) p[i] = &data.positions[3 * static_cast<std::size_t>(tet[i])];
    }
    const double* p[4];
};

// The error bound of orientation() holds for coordinates below 2^128.
int volume_sign(const double* const (&p)[4]) {
    bool bounded = true;
    for (const double* corner : p)
        for (int k = 0; k < 3; ++k) bounded = bounded && std::fabs(corner[k]) < 0x1p128;
    const auto at = [&](int i) { return Vec3d{p[i][0], p[i][1], p[i][2]}; };
    std::uint64_t exact_tests = 0;
    return bounded ? orientation(at(0), at(1), at(2), at(3), exact_tests)
                   : exact_orientation(at(0), at(1), at(2), at(3));
}

void measure_tets(const MeshData& data, vox_io_report& report) {
    for (std::size_t t = 0; t < data.tets.size(); t += 4) {
        const Corners corners(data, &data.tets[t]);
        const auto& p = corners.p;
        const int sign = volume_sign(p);
        report.inverted_tets += sign < 0;
        report.degenerate_tets += sign == 0;
        if (sign == 0) continue;

        // Coordinates are halved so that differences stay finite, and the differences are scaled if their
        // products would overflow or underflow.
        double e[3][3], largest = 0;
        for (int i = 0; i < 3; ++i)
            for (int k = 0; k < 3; ++k) {
                e[i][k] = 0.5 * p[i + 1][k] - 0.5 * p[0][k];
                largest = std::max(largest, std::fabs(e[i][k]));
            }
        const int scale = largest > 1e-90 && largest < 1e90 ? 0 : std::ilogb(largest);
        if (scale != 0)
            for (auto& edge : e)
                for (double& x : edge) x = std::ldexp(x, -scale);
        const double det = std::fabs(determinant(e[0], e[1], e[2]));
        double longest = 0;
        for (int i = 0; i < 3; ++i) {
            double own = 0, next = 0;
            for (int k = 0; k < 3; ++k) {
                const double to_next = e[(i + 1) % 3][k] - e[i][k];
                own += e[i][k] * e[i][k];
                next += to_next * to_next;
            }
            longest = std::max({longest, own, next});
        }
        report.nearly_flat_tets += det < 1e-9 * longest * std::sqrt(longest);
        report.volume += std::ldexp(det, 3 * scale + 3) / 6;
    }
}

void measure_surface(const MeshData& data, vox_io_report& report) {
    if (report.open_edges || report.non_manifold_facets || report.misoriented_edges) return;
    const double* origin = report.bounds_min; // near the surface, to avoid cancellation
    for (std::size_t t = 0; t < data.triangles.size(); t += 3) {
        double e[3][3];
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t k = 0; k < 3; ++k)
                e[i][k] = data.positions[3 * static_cast<std::size_t>(data.triangles[t + i]) + k] - origin[k];
        report.volume += determinant(e[0], e[1], e[2]) / 6;
    }
    if (!std::isfinite(report.volume)) report.volume = 0; // it exceeds the range of doubles
}

std::string counted(std::uint64_t number, const char* singular, const char* plural) {
    return format("%llu %s", llu(number), number == 1 ? singular : plural);
}

} // namespace

int volume_sign(const MeshData& data, const std::uint32_t* tet) { return volume_sign(Corners(data, tet).p); }

vox_io_report diagnose(const MeshData& data, const Progress& progress) {
    vox_io_report report{};
    report.struct_size = sizeof report;
    report.format = data.format;
    report.vertices = data.positions.size() / 3;
    report.tets = data.tets.size() / 4;
    report.triangles = data.triangles.size() / 3;
    report.skipped_elements = data.skipped_elements;
    report.second_order_tets = data.second_order_tets;
    report.split_cells = data.split_cells;
    report.left_out_tets = data.left_out_tets;
    report.unit_in_metres = data.unit_in_metres;
    report.left_out_vertices = data.left_out_vertices;
    report.left_out_triangles = data.left_out_triangles;
    for (std::size_t t = 0; t < data.triangles.size(); t += 3) {
        const Index* v = &data.triangles[t];
        report.degenerate_triangles += v[0] == v[1] || v[1] == v[2] || v[2] == v[0];
    }
    count_components(data, report);
    progress.report(0.1);
    count_duplicate_vertices(data, report);
    progress.report(0.2);
    if (report.tets > 0) {
        count_facets(data, report);
        progress.report(0.6);
        count_duplicate_tets(data, report);
        progress.report(0.8);
        measure_tets(data, report);
    } else if (report.triangles > 0) {
        report.boundary_facets = report.triangles;
        count_edges(data, report);
        progress.report(0.8);
        measure_surface(data, report);
    }
    return report;
}

std::string warnings_of(const MeshData& data, const vox_io_report& r) {
    std::string out;
    const auto say = [&](const std::string& line) { out.append(line).append("\n"); };
    const auto say_if = [&](std::uint64_t number, const char* singular, const char* plural) {
        if (number > 0) say(counted(number, singular, plural));
    };
    for (const std::string& note : data.notes) say(note);

    say_if(r.left_out_vertices, "vertex belongs to no tet and was left out",
           "vertices belong to no tet and were left out");
    say_if(r.left_out_triangles, "triangle has such a vertex and was left out",
           "triangles have such a vertex and were left out");
    say_if(r.left_out_tets, "tet has more than four nodes but its corners in one plane, and was left out",
           "tets have more than four nodes but their corners in one plane, and were left out");
    say_if(r.second_order_tets, "tet has more than four nodes; only its corners were used",
           "tets have more than four nodes; only their corners were used");
    if (r.inverted_tets > 0 && r.inverted_tets == r.tets)
        say("all tets are inverted (left-handed)");
    else
        say_if(r.inverted_tets, "tet is inverted (of negative volume)",
               "tets are inverted (of negative volume)");
    if (r.degenerate_tets > 0 && r.degenerate_tets == r.tets)
        say("all tets are flat (of zero volume): nothing can collide with them");
    else
        say_if(r.degenerate_tets, "tet is flat (of exactly zero volume)",
               "tets are flat (of exactly zero volume)");
    say_if(r.nearly_flat_tets, "tet is nearly flat", "tets are nearly flat");
    say_if(r.duplicate_tets, "tet repeats an earlier one", "tets repeat earlier ones");
    say_if(r.degenerate_triangles, "triangle names a vertex twice", "triangles name a vertex twice");
    say_if(r.duplicate_vertices, "vertex lies exactly where an earlier one lies",
           "vertices lie exactly where earlier ones lie");
    if (r.tets + r.triangles > 0)
        say_if(r.unused_vertices, "vertex belongs to no element", "vertices belong to no element");
    if (r.tets > 0) {
        say_if(r.non_manifold_facets, "facet is shared by more than two tets",
               "facets are shared by more than two tets");
    } else {
        say_if(r.open_edges, "edge has only one triangle: the surface is open",
               "edges have only one triangle: the surface is open");
        say_if(r.non_manifold_facets, "edge is shared by more than two triangles",
               "edges are shared by more than two triangles");
        say_if(r.misoriented_edges, "edge has two triangles of opposite orientation",
               "edges have two triangles of opposite orientation");
        if (r.volume < 0) say("the surface is inside out");
    }

    // Positions are often rounded to single precision for the core.
    double farthest = 0, extent = 0;
    for (int k = 0; k < 3; ++k) {
        farthest = std::max({farthest, std::fabs(r.bounds_min[k]), std::fabs(r.bounds_max[k])});
        extent = std::max(extent, r.bounds_max[k] - r.bounds_min[k]);
    }
    if (farthest > std::numeric_limits<float>::max())
        say(format("coordinates reach %g, beyond single precision (%g)", farthest,
                   static_cast<double>(std::numeric_limits<float>::max())));
    else if (farthest > 0 && extent < static_cast<double>(std::numeric_limits<float>::min()) /
                                          std::numeric_limits<float>::epsilon())
        say(format("the whole mesh is %g wide, too small for single precision", extent));
    else if (extent < 1e-3 * farthest)
        say(format(
            "the mesh is %g wide but lies %g from the origin, so single precision keeps few of its digits",
            extent, farthest));
    if (r.tets > 0 && r.degenerate_tets < r.tets &&
        (std::isinf(r.volume) || r.volume < std::numeric_limits<double>::min()))
        say("the volume does not fit a double");
    return out;
}

} // namespace vox::io
