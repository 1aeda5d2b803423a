// Tetrahedra are listed by corner with a counting sort; then every vertex, with its tetrahedra at hand, finds
// its neighbours and matches the facets of which it is the lowest corner. After an edit the same is done for
// the facets and vertices of what changed alone.
#include "mesh/topology.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <utility>

namespace vox {

namespace {

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

void check_tet_count(std::uint64_t tets) {
    if (tets > most_tets)
        throw Error(VOX_ERROR_LIMIT,
                    format("the mesh has %llu tets, a grid with VOX_GRID_PENETRATIONS takes at most %u",
                           static_cast<unsigned long long>(tets), most_tets));
}

void make_topology(std::span<const Tet> tets, std::uint32_t vertex_count, Topology& out) {
    std::pmr::memory_resource* memory = out.across.get_allocator().resource();
    Topology made(memory);
    if (tets.empty()) {
        out = std::move(made);
        return;
    }
    check_tet_count(tets.size());
    IndexLists tets_around(memory);
    std::pmr::vector<std::uint32_t> met(vertex_count, 0, memory);
    std::pmr::vector<Facet> facets(memory);
    tets_around.list_by_vertex(static_cast<std::uint32_t>(tets.size()), vertex_count, [&](std::uint32_t t) {
        return std::span<const std::uint32_t>(tets[t].v, names_a_vertex_twice(tets[t]) ? 0 : 4);
    });
    made.neighbours.reserve(vertex_count);
    made.across.assign(tets.size(),
                       {Topology::nothing, Topology::nothing, Topology::nothing, Topology::nothing});
    for (std::uint32_t v = 0; v < vertex_count; ++v) {
        made.neighbours.begin_list();
        facets.clear();
        for (const std::uint32_t t : std::as_const(tets_around)[v]) {
            for (const std::uint32_t w : tets[t].v)
                if (w != v && std::exchange(met[w], v + 1) != v + 1) made.neighbours.push(w);
            add_facets(tets[t], t, v, facets);
        }
        const std::span<std::uint32_t> neighbours = made.neighbours[v];
        std::sort(neighbours.begin(), neighbours.end());
        match(tets, facets, made);
    }
    made.neighbours.shrink_to_fit();
    made.triangles.shrink_to_fit();
    made.rings.list_by_vertex(
        static_cast<std::uint32_t>(made.triangles.size()), vertex_count,
        [&](std::uint32_t t) { return std::span<const std::uint32_t>(made.triangles[t].v); });
    out = std::move(made);
}

// ---- repair ---------------------------------------------------------------------------------------

namespace {

class Repair {
public:
    Repair(std::span<const Tet> tets, const IndexLists& tets_of, Topology& topology)
        : tets_(tets), tets_of_(tets_of), topology_(topology), facets_(tets_of.memory()),
          found_(tets_of.memory()) {}

    void run(std::span<const TetChange> changes) {
        constexpr std::array<std::uint32_t, 4> nothing{Topology::nothing, Topology::nothing,
                                                       Topology::nothing, Topology::nothing};
        topology_.is_repaired = true;
        topology_.across.resize(tets_.size(), nothing);
        for (const TetChange& change : changes) topology_.across[change.tet] = nothing;
        std::pmr::vector<FacetKey> keys(facets_.get_allocator());
        list_changed_facets(changes, keys);
        for (const FacetKey& key : keys) drop_triangle(key);
        for (const FacetKey& key : keys) match_again(key);
        std::pmr::vector<std::uint32_t> vertices(facets_.get_allocator());
        list_changed_vertices(changes, vertices);
        for (const std::uint32_t v : vertices) find_neighbours(v);
    }

private:
    // The facet is on the surface no more, if it was; the last triangle takes the place of its triangle.
    void drop_triangle(const FacetKey& key) {
        const std::span<const std::uint32_t> ring = topology_.ring_of(key.low);
        const auto found = std::find_if(ring.begin(), ring.end(),
                                        [&](std::uint32_t t) { return topology_.key(t) == key; });
        if (found == ring.end()) return;
        const std::uint32_t hole = *found;
        const auto last = static_cast<std::uint32_t>(topology_.triangles.size() - 1);
        for (const std::uint32_t v : {key.low, key.middle, key.high}) topology_.rings.remove(v, hole);
        if (hole != last) {
            const FacetKey moved = topology_.key(last);
            for (const std::uint32_t v : {moved.low, moved.middle, moved.high})
                for (std::uint32_t& t : topology_.rings[v])
                    if (t == last) t = hole;
            for_tets_at(moved, tets_, tets_of_, [&](std::uint32_t tet, std::uint32_t i) {
                std::uint32_t& across = topology_.across[tet][i];
                if (across == (Topology::surface_bit | last)) across = Topology::surface_bit | hole;
            });
            topology_.triangles[hole] = topology_.triangles[last];
        }
        topology_.triangles.pop_back();
    }

    void match_again(const FacetKey& key) {
        facets_.clear();
        for_tets_at(key, tets_, tets_of_, [&](std::uint32_t tet, std::uint32_t i) {
            topology_.across[tet][i] = Topology::nothing;
            facets_.push_back({std::uint64_t{key.middle} << 32 | key.high, tets_[tet].v[i], 4 * tet + i});
        });
        const auto triangle = static_cast<std::uint32_t>(topology_.triangles.size());
        match(tets_, facets_, topology_);
        if (topology_.triangles.size() == triangle) return;
        for (const std::uint32_t v : {key.low, key.middle, key.high}) {
            const std::span<const std::uint32_t> ring = topology_.ring_of(v);
            const auto place = std::find_if(ring.begin(), ring.end(),
                                            [&](std::uint32_t t) { return topology_.before(triangle, t); });
            topology_.rings.insert(v, static_cast<std::size_t>(place - ring.begin()), triangle);
        }
    }

    void find_neighbours(std::uint32_t vertex) {
        found_.clear();
        for (const std::uint32_t t : tets_of_[vertex]) {
            if (names_a_vertex_twice(tets_[t])) continue;
            for (const std::uint32_t v : tets_[t].v)
                if (v != vertex) found_.push_back(v);
        }
        std::sort(found_.begin(), found_.end());
        found_.erase(std::unique(found_.begin(), found_.end()), found_.end());
        topology_.neighbours.assign(vertex, found_);
    }

    std::span<const Tet> tets_;
    const IndexLists& tets_of_;
    Topology& topology_;
    std::pmr::vector<Facet> facets_;
    std::pmr::vector<std::uint32_t> found_;
};

} // namespace

void add_vertices(std::uint32_t vertex_count, Topology& topology) {
    if (topology.neighbours.empty()) return; // there are no tetrahedra yet
    topology.neighbours.resize(vertex_count);
    topology.rings.resize(vertex_count);
}

void repair_topology(std::span<const Tet> tets, const IndexLists& tets_of, std::span<const TetChange> changes,
                     Topology& topology) {
    topology.neighbours.resize(tets_of.size());
    topology.rings.resize(tets_of.size());
    Repair(tets, tets_of, topology).run(changes);
}

} // namespace vox
