// Every vertex, with its tetrahedra at hand, finds its neighbours and matches the facets of which it is the
// lowest corner (facets.cpp). After an edit the same is done for the facets and vertices that changed.
#include "mesh/topology.hpp"

#include "base/array.hpp"
#include "base/error.hpp"
#include "mesh/tet_changes.hpp"

#include <algorithm>
#include <utility>

namespace vox {

void check_tet_count(std::uint64_t tets) {
    if (tets > most_tets)
        throw Error(VOX_ERROR_LIMIT,
                    format("the mesh has %llu tets, a grid with VOX_GRID_CONSTRAINTS takes at most %u",
                           static_cast<unsigned long long>(tets), most_tets));
}

namespace {

// Sorts numbers that are all different. Where they are few, each is counted below the others, because a sort
// would mispredict a branch for each of them.
void sort_distinct(std::span<std::uint32_t> numbers) {
    constexpr std::size_t few = 32;
    const std::size_t count = numbers.size();
    if (count > few) return std::sort(numbers.begin(), numbers.end());
    const std::size_t padded = (count + 7) / 8 * 8;
    std::int32_t number[few], below[few];
    for (std::size_t i = 0; i < padded; ++i) {
        number[i] = i < count ? static_cast<std::int32_t>(numbers[i] ^ 0x80000000u) : 0; // in the same order
        below[i] = 0;
    }
    for (std::size_t j = 0; j < count; ++j)
        for (std::size_t i = 0; i < padded; ++i) below[i] += number[j] < number[i];
    for (std::size_t i = 0; i < count; ++i)
        numbers[static_cast<std::size_t>(below[i])] = static_cast<std::uint32_t>(number[i]) ^ 0x80000000u;
}

// The tetrahedra around each vertex, without those that name a vertex twice: list 2 * vertex has those of
// which it is one of the two lowest corners, which may have facets of which it is the lowest, and the next
// one the others.
IndexLists list_tets(std::span<const Tet> tets, std::uint32_t vertex_count,
                     std::pmr::memory_resource* memory) {
    IndexLists lists(memory);
    std::uint32_t corners[4];
    lists.list_by_vertex(static_cast<std::uint32_t>(tets.size()), 2 * vertex_count, [&](std::uint32_t t) {
        const std::uint32_t* v = tets[t].v;
        for (std::size_t i = 0; i < 4; ++i) {
            const int lower = (v[0] < v[i]) + (v[1] < v[i]) + (v[2] < v[i]) + (v[3] < v[i]);
            corners[i] = 2 * v[i] + (lower > 1);
        }
        return std::span<const std::uint32_t>(corners, names_a_vertex_twice(tets[t]) ? 0 : 4);
    });
    return lists;
}

// The triangles around vertices, while triangles are added at their lowest vertices: lists that are linked
// from their last triangle to their first one.
class GrowingRings {
public:
    GrowingRings(std::uint32_t vertex_count, std::pmr::memory_resource* memory)
        : last_(vertex_count, none, memory), before_(memory) {}

    void add(const Array<Triangle>& triangles) {
        for (auto t = static_cast<std::uint32_t>(before_.size()); t < triangles.size(); ++t) {
            std::array<std::uint32_t, 3>& before = before_.emplace_back();
            for (std::size_t i = 0; i < 3; ++i)
                before[i] = std::exchange(last_[triangles[t].v[i]], 4 * t + static_cast<std::uint32_t>(i));
        }
    }
    void list(std::uint32_t vertex, Array<std::uint32_t>& ring) const {
        ring.clear();
        for (std::uint32_t at = last_[vertex]; at != none; at = before_[at / 4][at % 4])
            ring.push_back(at / 4);
        std::reverse(ring.begin(), ring.end());
    }

private:
    static constexpr std::uint32_t none = 0xffffffffu;
    Array<std::uint32_t> last_; // 4 * triangle + corner
    Array<std::array<std::uint32_t, 3>> before_;
};

} // namespace

void make_topology(std::span<const Tet> tets, std::uint32_t vertex_count, Topology& out) {
    std::pmr::memory_resource* memory = out.across.memory();
    Topology made(memory);
    if (tets.empty()) {
        out = std::move(made);
        return;
    }
    check_tet_count(tets.size());
    const IndexLists tets_around = list_tets(tets, vertex_count, memory);
    Array<std::uint32_t> met(vertex_count, 0, memory);
    Array<std::uint32_t> neighbours(memory), ring(memory);
    GrowingRings rings(vertex_count, memory);
    made.clear(tets.size());
    made.links.resize(vertex_count);
    constexpr std::size_t usual_words = 17; // for a vertex with 14 neighbours, and some on the surface
    made.links.reserve(usual_words * vertex_count);
    FacetMatcher matcher(tets, made);
    for (std::uint32_t v = 0; v < vertex_count; ++v) {
        const std::span<const std::uint32_t> low = tets_around[2 * std::size_t{v}],
                                             high = tets_around[2 * std::size_t{v} + 1];
        const std::span<const std::uint32_t> around(low.data(),
                                                    low.size() + high.size()); // they are neighbours
        matcher.match_at(v, low);
        rings.add(made.triangles);
        rings.list(v, ring); // later triangles have higher vertices alone
        if (neighbours.size() < 4 * around.size()) neighbours.resize(4 * around.size());
        std::size_t count = 0;
        met[v] = v + 1;
        for (const std::uint32_t t : around)
            for (const std::uint32_t w : tets[t].v) {
                neighbours[count] = w;
                count += std::exchange(met[w], v + 1) != v + 1;
            }
        sort_distinct(std::span(neighbours).first(count));
        made.links.assign(v, std::span(neighbours).first(count), ring);
    }
    made.across.finish();
    made.links.shrink_to_fit();
    made.triangles.shrink_to_fit();
    out = std::move(made);
}

// ---- repair ---------------------------------------------------------------------------------------

namespace {

class Repair {
public:
    Repair(std::span<const Tet> tets, const IndexLists& tets_of, Topology& topology)
        : tets_(tets), tets_of_(tets_of), topology_(topology), facets_(tets_of.memory()),
          neighbours_(tets_of.memory()), ring_(tets_of.memory()) {}

    void run(std::span<const TetChange> changes) {
        topology_.is_repaired = true;
        topology_.across.resize(tets_.size());
        for (const TetChange& change : changes)
            for (std::uint32_t i = 0; i < 4; ++i) topology_.across.set(change.tet, i, Topology::nothing);
        Array<FacetKey> keys(facets_.memory());
        list_changed_facets(changes, keys);
        for (const FacetKey& key : keys) drop_triangle(key);
        for (const FacetKey& key : keys) match_again(key);
        Array<std::uint32_t> vertices(facets_.memory());
        list_changed_vertices(changes, vertices);
        for (const std::uint32_t v : vertices) find_neighbours(v);
    }

private:
    // Drops the triangle of a facet that may have been on the surface; the last triangle takes its place.
    void drop_triangle(const FacetKey& key) {
        const LinkRange ring = topology_.ring_of(key.low);
        const auto found =
            std::find_if(ring.begin(), ring.end(), [&](std::uint32_t t) { return topology_.key(t) == key; });
        if (found == ring.end()) return;
        const std::uint32_t hole = *found;
        const auto last = static_cast<std::uint32_t>(topology_.triangles.size() - 1);
        for (const std::uint32_t v : {key.low, key.middle, key.high}) {
            copy_links(v);
            erase(ring_, hole);
            topology_.links.assign(v, neighbours_, ring_);
        }
        if (hole != last) {
            const FacetKey moved = topology_.key(last);
            for (const std::uint32_t v : {moved.low, moved.middle, moved.high}) {
                copy_links(v);
                std::replace(ring_.begin(), ring_.end(), last, hole);
                topology_.links.assign(v, neighbours_, ring_);
            }
            for_tets_at(moved, tets_, tets_of_, [&](std::uint32_t tet, std::uint32_t i) {
                if (topology_.across(tet, i) == (Topology::surface_bit | last))
                    topology_.across.set(tet, i, Topology::surface_bit | hole);
            });
            topology_.triangles[hole] = topology_.triangles[last];
        }
        topology_.triangles.pop_back();
    }

    void match_again(const FacetKey& key) {
        facets_.clear();
        for_tets_at(key, tets_, tets_of_, [&](std::uint32_t tet, std::uint32_t i) {
            topology_.across.set(tet, i, Topology::nothing);
            facets_.push_back({std::uint64_t{key.middle} << 32 | key.high, tets_[tet].v[i], 4 * tet + i});
        });
        const auto triangle = static_cast<std::uint32_t>(topology_.triangles.size());
        std::sort(facets_.begin(), facets_.end());
        if (!facets_.empty())
            topology_.match(tets_, facets_, [this](std::uint32_t tet, std::uint32_t i, std::uint32_t across) {
                topology_.across.set(tet, i, across);
            });
        if (topology_.triangles.size() == triangle) return;
        for (const std::uint32_t v : {key.low, key.middle, key.high}) {
            copy_links(v);
            ring_.insert(std::find_if(ring_.begin(), ring_.end(),
                                      [&](std::uint32_t t) { return topology_.before(triangle, t); }),
                         triangle);
            topology_.links.assign(v, neighbours_, ring_);
        }
    }

    void find_neighbours(std::uint32_t vertex) {
        copy_links(vertex);
        neighbours_.clear();
        for (const std::uint32_t t : tets_of_[vertex]) {
            if (names_a_vertex_twice(tets_[t])) continue;
            for (const std::uint32_t v : tets_[t].v)
                if (v != vertex) neighbours_.push_back(v);
        }
        std::sort(neighbours_.begin(), neighbours_.end());
        neighbours_.erase(std::unique(neighbours_.begin(), neighbours_.end()), neighbours_.end());
        topology_.links.assign(vertex, neighbours_, ring_);
    }

    void copy_links(std::uint32_t vertex) {
        const LinkRange neighbours = topology_.neighbours_of(vertex), ring = topology_.ring_of(vertex);
        neighbours_.assign(neighbours.begin(), neighbours.end());
        ring_.assign(ring.begin(), ring.end());
    }

    std::span<const Tet> tets_;
    const IndexLists& tets_of_;
    Topology& topology_;
    Array<TetFacet> facets_;
    Array<std::uint32_t> neighbours_, ring_; // of a vertex
};

} // namespace

void add_vertices(std::uint32_t vertex_count, Topology& topology) {
    if (!topology.links.empty()) topology.links.resize(vertex_count); // else there are no tetrahedra yet
}

void repair_topology(std::span<const Tet> tets, const IndexLists& tets_of, std::span<const TetChange> changes,
                     Topology& topology) {
    topology.links.resize(tets_of.size());
    Repair(tets, tets_of, topology).run(changes);
}

} // namespace vox
