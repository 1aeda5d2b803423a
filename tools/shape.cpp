#include "shape.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace tool {

namespace {

using Vector = std::array<double, 3>;
using Facet = std::array<std::uint32_t, 3>;
using Edge = std::array<std::uint32_t, 2>;

Vector operator-(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vector cross(const Vector& a, const Vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
double length(const Vector& a) { return std::hypot(a[0], a[1], a[2]); }

template <class Element>
void keep_unique(std::vector<Element>& elements) {
    for (Element& element : elements) std::sort(element.begin(), element.end());
    std::sort(elements.begin(), elements.end());
    elements.erase(std::unique(elements.begin(), elements.end()), elements.end());
}

template <class Element, class Size>
std::optional<double> mean(const std::vector<Element>& elements, Size size) {
    if (elements.empty()) return std::nullopt;
    double sum = 0;
    for (const Element& element : elements) sum += size(element);
    return sum / static_cast<double>(elements.size());
}

} // namespace

Shape measure_shape(const vox_io_mesh_view& mesh) {
    // Scales by a power of two so that coordinates are below 1 and no product overflows. Only the means may.
    double largest = 0;
    for (std::size_t i = 0; i < 3 * mesh.vertex_count; ++i)
        largest = std::max(largest, std::abs(mesh.positions[i]));
    const int exponent = largest > 0 ? std::clamp(std::ilogb(largest) + 2, -1000, 1000) : 0;
    const double scale = std::ldexp(1.0, -exponent);
    const auto point = [&](std::uint32_t vertex) {
        const double* p = mesh.positions + 3 * std::size_t{vertex};
        return Vector{scale * p[0], scale * p[1], scale * p[2]};
    };
    const auto edge_length = [&](const Edge& edge) { return length(point(edge[1]) - point(edge[0])); };

    const bool solid = mesh.tet_count > 0;
    const std::size_t corners = solid ? 4 : 3;
    const std::span<const std::uint32_t> indices(solid ? mesh.tets : mesh.triangles,
                                                 corners * (solid ? mesh.tet_count : mesh.triangle_count));
    std::vector<Edge> edges;
    std::vector<Facet> facets;
    std::vector<double> longest, volumes;
    for (std::size_t first = 0; first < indices.size(); first += corners) {
        const auto element = indices.subspan(first, corners);
        double longest_edge = 0;
        for (std::size_t i = 0; i < corners; ++i)
            for (std::size_t j = i + 1; j < corners; ++j) {
                edges.push_back({element[i], element[j]});
                longest_edge = std::max(longest_edge, edge_length(edges.back()));
                for (std::size_t k = j + 1; k < corners; ++k)
                    facets.push_back({element[i], element[j], element[k]});
            }
        longest.push_back(longest_edge);
        if (solid) {
            const Vector a = point(element[0]);
            const Vector normal = cross(point(element[1]) - a, point(element[2]) - a);
            volumes.push_back(std::abs(dot(normal, point(element[3]) - a)) / 6);
        }
    }
    keep_unique(edges);
    keep_unique(facets);

    const auto itself = [](double value) { return value; };
    const auto area = [&](const Facet& facet) {
        const Vector a = point(facet[0]);
        return length(cross(point(facet[1]) - a, point(facet[2]) - a)) / 2;
    };
    const auto unscaled = [exponent](std::optional<double> value, int dimensions) {
        return value ? std::ldexp(*value, dimensions * exponent) : value;
    };
    return {unscaled(mean(edges, edge_length), 1), unscaled(mean(longest, itself), 1),
            unscaled(mean(facets, area), 2), unscaled(mean(volumes, itself), 3)};
}

} // namespace tool
