#include "facets.hpp"

#include <algorithm>

namespace tool {

std::vector<Triangle> boundary_of(std::span<const std::uint32_t> tets) {
    // Facets sorted by their corners; a facet of a second tetrahedron is no boundary.
    struct Facet {
        Triangle sorted, as_given;
        std::uint32_t opposite;
    };
    std::vector<Facet> facets;
    constexpr int corners[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
    for (std::size_t t = 0; t < tets.size(); t += 4) {
        const std::uint32_t* v = &tets[t];
        for (int i = 0; i < 4; ++i) {
            const Triangle facet{v[corners[i][0]], v[corners[i][1]], v[corners[i][2]]};
            facets.push_back({facet, facet, v[i]});
            std::sort(facets.back().sorted.begin(), facets.back().sorted.end());
        }
    }
    std::stable_sort(facets.begin(), facets.end(),
                     [](const Facet& x, const Facet& y) { return x.sorted < y.sorted; });
    std::vector<Triangle> boundary;
    for (std::size_t first = 0, end; first < facets.size(); first = end) {
        bool has_one_tet = true; // doubled ones count once
        for (end = first; end < facets.size() && facets[end].sorted == facets[first].sorted; ++end)
            has_one_tet &= facets[end].opposite == facets[first].opposite;
        if (has_one_tet) boundary.push_back(facets[first].as_given);
    }
    return boundary;
}

} // namespace tool
