#include "tet_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace play {

namespace {

// The facet opposite to corner f of a tetrahedron, counter-clockwise from outside where the tetrahedron is
// positive.
constexpr std::uint32_t facet_corners[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

struct Facet {
    std::array<std::uint32_t, 3> vertices; // ascending
    std::uint32_t tet, opposite;
};

std::vector<Facet> facets_of(std::span<const std::uint32_t> tets) {
    std::vector<Facet> facets;
    facets.reserve(tets.size());
    for (std::uint32_t t = 0; t < tets.size() / 4; ++t)
        for (std::uint32_t f = 0; f < 4; ++f) {
            Facet facet{{}, t, f};
            for (std::size_t i = 0; i < 3; ++i) facet.vertices[i] = tets[4 * t + facet_corners[f][i]];
            std::sort(facet.vertices.begin(), facet.vertices.end());
            facets.push_back(facet);
        }
    std::sort(facets.begin(), facets.end(), [](const Facet& a, const Facet& b) {
        return std::tie(a.vertices, a.tet, a.opposite) < std::tie(b.vertices, b.tet, b.opposite);
    });
    return facets;
}

// Sets that are joined, each named by its lowest member.
class Sets {
public:
    explicit Sets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }
    std::uint32_t find(std::uint32_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    void join(std::uint32_t a, std::uint32_t b) {
        a = find(a), b = find(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }

private:
    std::vector<std::uint32_t> parent_;
};

std::uint32_t corner_with(std::span<const std::uint32_t> tets, std::uint32_t tet, std::uint32_t vertex) {
    std::uint32_t corner = 4 * tet;
    while (tets[corner] != vertex) ++corner;
    return corner;
}

} // namespace

std::vector<std::uint32_t> surface_of(std::span<const std::uint32_t> tets, std::span<const double> rest) {
    std::vector<std::uint32_t> triangles;
    const std::vector<Facet> facets = facets_of(tets);
    for (std::size_t i = 0, end; i < facets.size(); i = end) {
        for (end = i + 1; end < facets.size() && facets[end].vertices == facets[i].vertices;) ++end;
        if (end - i != 1) continue;
        const std::uint32_t* corners = &tets[4 * facets[i].tet];
        const Vec a = at(rest, corners[0]);
        const double volume =
            dot(cross(at(rest, corners[1]) - a, at(rest, corners[2]) - a), at(rest, corners[3]) - a);
        std::uint32_t triangle[3];
        for (int k = 0; k < 3; ++k) triangle[k] = corners[facet_corners[facets[i].opposite][k]];
        if (volume < 0) std::swap(triangle[1], triangle[2]);
        triangles.insert(triangles.end(), triangle, triangle + 3);
    }
    return triangles;
}

Stroke::Stroke(const Vec& eye, const Vec& first, const Vec& second) : eye_(eye) {
    const Vec a = first - eye, b = second - eye;
    normal_ = cross(a, b);
    normal_ = (1 / std::sqrt(dot(normal_, normal_))) * normal_;
    from_first_ = cross(normal_, a);
    from_second_ = cross(b, normal_);
}

std::vector<Part> cut(std::span<const std::uint32_t> tets, std::span<const double> positions,
                      const Stroke& stroke) {
    const auto tet_count = static_cast<std::uint32_t>(tets.size() / 4);
    std::vector<bool> above(tet_count);
    for (std::uint32_t t = 0; t < tet_count; ++t) {
        Vec sum{};
        for (std::uint32_t c = 0; c < 4; ++c) sum = sum + at(positions, tets[4 * t + c]);
        above[t] = stroke.above(0.25 * sum);
    }
    // Corners of tetrahedra at the same vertex are one vertex still if a facet that was not opened joins
    // them.
    Sets corners(tets.size()), parts(tet_count);
    bool opened = false;
    const std::vector<Facet> facets = facets_of(tets);
    for (std::size_t i = 0; i + 1 < facets.size(); ++i) {
        const Facet &a = facets[i], &b = facets[i + 1];
        if (a.vertices != b.vertices) continue;
        Vec sum{};
        for (const std::uint32_t v : a.vertices) sum = sum + at(positions, v);
        if (above[a.tet] != above[b.tet] && stroke.between_rays((1.0 / 3) * sum)) {
            opened = true;
            continue;
        }
        parts.join(a.tet, b.tet);
        for (const std::uint32_t v : a.vertices)
            corners.join(corner_with(tets, a.tet, v), corner_with(tets, b.tet, v));
    }
    if (!opened) return {};
    constexpr std::uint32_t none = ~0u;
    std::vector<Part> made;
    std::vector<std::uint32_t> part_of(tet_count, none), vertex_of(tets.size(), none);
    for (std::uint32_t t = 0; t < tet_count; ++t) {
        std::uint32_t& part = part_of[parts.find(t)]; // the lowest tetrahedron of a part comes first
        if (part == none) {
            part = static_cast<std::uint32_t>(made.size());
            made.emplace_back();
        }
        for (std::uint32_t c = 4 * t; c < 4 * t + 4; ++c) {
            std::uint32_t& vertex = vertex_of[corners.find(c)];
            if (vertex == none) {
                vertex = static_cast<std::uint32_t>(made[part].old_vertex.size());
                made[part].old_vertex.push_back(tets[c]);
            }
            made[part].tets.push_back(vertex);
        }
    }
    return made;
}

} // namespace play
