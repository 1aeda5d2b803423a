// Every vertex, with its tetrahedra at hand, finds its neighbours and matches the facets of which it is the
// lowest corner (facets.cpp). After an edit the same is done for the facets and vertices that changed.
#include "mesh/topology.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <utility>

namespace vox {

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
    const IndexLists tets_around = list_whole_tets(tets, vertex_count, memory);
    std::pmr::vector<std::uint32_t> met(vertex_count, 0, memory);
    std::pmr::vector<TetFacet> facets(memory);
    made.neighbours.reserve(vertex_count);
    made.clear(tets.size());
    for (std::uint32_t v = 0; v < vertex_count; ++v) {
        made.neighbours.begin_list();
        for (const std::uint32_t t : tets_around[v])
            for (const std::uint32_t w : tets[t].v)
                if (w != v && std::exchange(met[w], v + 1) != v + 1) made.neighbours.push(w);
        const std::span<std::uint32_t> neighbours = made.neighbours[v];
        std::sort(neighbours.begin(), neighbours.end());
        list_facets_at(v, tets, tets_around[v], facets);
        for_equal_facets(facets, [&](std::span<const TetFacet> same) { made.match(tets, same); });
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
    // Drops the triangle of a facet that may have been on the surface; the last triangle takes its place.
    void drop_triangle(const FacetKey& key) {
        const std::span<const std::uint32_t> ring = topology_.ring_of(key.low);
        const auto found =
            std::find_if(ring.begin(), ring.end(), [&](std::uint32_t t) { return topology_.key(t) == key; });
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
        std::sort(facets_.begin(), facets_.end());
        if (!facets_.empty()) topology_.match(tets_, facets_);
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
    std::pmr::vector<TetFacet> facets_;
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
