// Tetrahedra are listed by corner with a counting sort; then every vertex, with its tetrahedra at hand, finds
// its neighbours and matches the facets of which it is the lowest corner.
#include "topology.hpp"

#include "../error.hpp"

#include <algorithm>
#include <utility>

namespace vox::depth {

namespace {

// So that lists of three corners of four facets, and of all edges both ways, have 32-bit ends.
constexpr std::uint32_t most_tets = UINT32_MAX / 12;

// A facet with the vertex at hand as lowest corner.
struct Facet {
    std::uint64_t corners;  // the two others, sorted
    std::uint32_t opposite; // the tetrahedron's fourth vertex
    std::uint32_t place;    // 4 * tetrahedron + local index of `opposite`

    bool operator<(const Facet& other) const noexcept {
        if (corners != other.corners) return corners < other.corners;
        if (opposite != other.opposite) return opposite < other.opposite;
        return place < other.place;
    }
};

bool names_a_vertex_twice(const Tet& t) noexcept {
    return t.v[0] == t.v[1] || t.v[0] == t.v[2] || t.v[0] == t.v[3] || t.v[1] == t.v[2] || t.v[1] == t.v[3] ||
           t.v[2] == t.v[3];
}

// For each vertex the items that have it as a corner, ascending. corners_of(item) may be empty.
template <class CornersOf>
void list_by_vertex(std::uint32_t items, std::uint32_t vertex_count, CornersOf corners_of,
                    std::pmr::vector<std::uint32_t>& first, std::pmr::vector<std::uint32_t>& listed) {
    first.assign(std::size_t{vertex_count} + 2, 0); // counted two places on, then filled one place on
    for (std::uint32_t i = 0; i < items; ++i)
        for (const std::uint32_t v : corners_of(i)) ++first[v + 2];
    for (std::size_t v = 2; v < first.size(); ++v) first[v] += first[v - 1];
    listed.resize(first.back());
    for (std::uint32_t i = 0; i < items; ++i)
        for (const std::uint32_t v : corners_of(i)) listed[first[v + 1]++] = i;
    first.pop_back();
}

// Adds the facets of tetrahedron `index` whose lowest corner is v.
void add_facets(const Tet& tet, std::uint32_t index, std::uint32_t v, std::pmr::vector<Facet>& facets) {
    for (std::uint32_t i = 0; i < 4; ++i) {
        if (tet.v[i] == v) continue;
        std::uint32_t others[2], count = 0;
        for (std::uint32_t j = 0; j < 4; ++j)
            if (j != i && tet.v[j] != v) others[count++] = tet.v[j];
        if (others[0] > others[1]) std::swap(others[0], others[1]);
        if (others[0] > v)
            facets.push_back({std::uint64_t{others[0]} << 32 | others[1], tet.v[i], 4 * index + i});
    }
}

// Joins the tetrahedra of each facet, or makes it a triangle of the surface.
void match(std::span<const Tet> tets, std::pmr::vector<Facet>& facets, Topology& made) {
    std::sort(facets.begin(), facets.end());
    const auto set_across = [&](std::size_t first, std::size_t last, std::uint32_t value) {
        for (std::size_t i = first; i < last; ++i)
            made.across[facets[i].place >> 2][facets[i].place & 3] = value;
    };
    for (std::size_t first = 0; first < facets.size();) {
        std::size_t last = first, second = 0;
        std::uint32_t sides = 1; // different tetrahedra; doubled ones follow each other
        for (; last < facets.size() && facets[last].corners == facets[first].corners; ++last)
            if (last > first && facets[last].opposite != facets[last - 1].opposite && ++sides == 2)
                second = last;
        if (sides == 1) {
            const std::uint32_t place = facets[first].place;
            const Tet& tet = tets[place >> 2];
            const std::uint8_t* corner = facet_corners[place & 3];
            set_across(first, last,
                       Topology::surface_bit | static_cast<std::uint32_t>(made.triangles.size()));
            made.triangles.push_back(
                {{tet.v[corner[0]], tet.v[corner[1]], tet.v[corner[2]]}, facets[first].opposite});
        } else if (sides == 2) {
            set_across(first, second, facets[second].place >> 2);
            set_across(second, last, facets[first].place >> 2);
        }
        first = last;
    }
}

} // namespace

void make_topology(std::span<const Tet> tets, std::uint32_t vertex_count, Topology& out) {
    if (tets.empty()) return;
    if (tets.size() > most_tets)
        throw Error(VOX_ERROR_LIMIT,
                    format("the mesh has %zu tets, a grid with VOX_GRID_PENETRATIONS takes at most %u",
                           tets.size(), most_tets));
    std::pmr::memory_resource* memory = out.across.get_allocator().resource();
    Topology made(memory);
    std::pmr::vector<std::uint32_t> first_tet(memory), tets_around(memory), met(vertex_count, 0, memory);
    std::pmr::vector<Facet> facets(memory);
    list_by_vertex(
        static_cast<std::uint32_t>(tets.size()), vertex_count,
        [&](std::uint32_t t) {
            return std::span<const std::uint32_t>(tets[t].v, names_a_vertex_twice(tets[t]) ? 0 : 4);
        },
        first_tet, tets_around);
    made.first_neighbour.reserve(std::size_t{vertex_count} + 1);
    made.across.assign(tets.size(),
                       {Topology::nothing, Topology::nothing, Topology::nothing, Topology::nothing});
    for (std::uint32_t v = 0; v < vertex_count; ++v) {
        const std::size_t first = made.neighbours.size();
        made.first_neighbour.push_back(static_cast<std::uint32_t>(first));
        facets.clear();
        for (std::uint32_t i = first_tet[v]; i < first_tet[v + 1]; ++i) {
            const std::uint32_t t = tets_around[i];
            for (const std::uint32_t w : tets[t].v)
                if (w != v && std::exchange(met[w], v + 1) != v + 1) made.neighbours.push_back(w);
            add_facets(tets[t], t, v, facets);
        }
        std::sort(made.neighbours.begin() + static_cast<std::ptrdiff_t>(first), made.neighbours.end());
        match(tets, facets, made);
    }
    made.first_neighbour.push_back(static_cast<std::uint32_t>(made.neighbours.size()));
    made.neighbours.shrink_to_fit();
    made.triangles.shrink_to_fit();
    list_by_vertex(
        static_cast<std::uint32_t>(made.triangles.size()), vertex_count,
        [&](std::uint32_t t) { return std::span<const std::uint32_t>(made.triangles[t].v); }, made.first_ring,
        made.rings);
    out = std::move(made);
}

} // namespace vox::depth
