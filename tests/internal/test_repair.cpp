// What is repaired after an edit against the same made anew: lists, topology, rings, tiles and boundary.
#include "internal/counting_memory.hpp"
#include "internal/stage_checks.hpp"

#include "base/bits.hpp"
#include "base/lists.hpp"
#include "mesh/filter.hpp"
#include "mesh/tet_changes.hpp"
#include "mesh/tiled_mesh.hpp"
#include "mesh/topology.hpp"

#include <array>
#include <map>
#include <set>

#include "support/suite.h" // last: it defines macros with common names

using namespace vox;
using namespace stages;

namespace {

std::pmr::memory_resource* heap() { return std::pmr::get_default_resource(); }

// A mesh and which of its tets are on; those that are off name one vertex four times.
struct Edited {
    explicit Edited(Mesh of) : mesh(std::move(of)), given(mesh.tets), off(heap()), tets_of(heap()) {
        off.reserve(mesh.tets.size());
        list_tets(mesh.tets, off.words(), vertex_count(mesh), tets_of);
    }

    void switch_tet(std::uint32_t tet, bool on) {
        if (off[tet] != on) return;
        const Tet &before = mesh.tets[tet], &after = given[tet];
        changes.push_back({tet, !on, on, before, after});
        if (on) {
            off.remove(tet);
            mesh.tets[tet] = given[tet];
        } else {
            off.add(tet);
            mesh.tets[tet] = {{before.v[0], before.v[0], before.v[0], before.v[0]}};
        }
    }

    void replace(std::uint32_t tet, const Tet& corners) {
        if (off[tet]) return;
        changes.push_back({tet, true, true, mesh.tets[tet], corners});
        mesh.tets[tet] = given[tet] = corners;
    }

    void append(Tet corners) {
        const auto tet = static_cast<std::uint32_t>(given.size());
        given.push_back(corners);
        mesh.tets.push_back(corners);
        off.reserve(given.size());
        changes.push_back({tet, false, true, {}, corners});
    }

    // Takes the changes so far for done.
    void apply_all() { apply_changes(changes, tets_of); }

    Body body() const {
        Body body;
        body.vertex_count = vertex_count(mesh);
        body.positions = view(mesh);
        body.tets = mesh.tets;
        body.self_collision = self;
        body.off = off.words();
        body.off_count = off.count();
        return body;
    }

    bool self = true; // keeps which tets of a tile have a vertex
    Mesh mesh;
    std::vector<Tet> given;
    Bits off;
    IndexLists tets_of;
    std::vector<TetChange> changes;
};

// Vertices at random, tets over random vertices: nothing a mesh should be.
Mesh soup(Random& random, std::uint32_t vertices, std::uint32_t tets) {
    Mesh mesh;
    for (std::uint32_t v = 0; v < vertices; ++v)
        mesh.positions.push_back({random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1)});
    for (std::uint32_t t = 0; t < tets; ++t)
        mesh.tets.push_back({{random.below(vertices), random.below(vertices), random.below(vertices),
                              random.below(vertices)}});
    return mesh;
}

Tet any_tet(Random& random, std::uint32_t vertices) {
    return {{random.below(vertices), random.below(vertices), random.below(vertices), random.below(vertices)}};
}

// A few changes of tets that lie together.
void edit(Edited& e, Random& random, std::uint32_t most) {
    const auto tets = static_cast<std::uint32_t>(e.given.size()), vertices = vertex_count(e.mesh);
    const std::uint32_t first = random.below(tets), count = 1 + random.below(most), how = random.below(5);
    for (std::uint32_t t = first; t < std::min(first + count, tets); ++t) {
        if (how == 0) e.switch_tet(t, false);
        if (how == 1) e.switch_tet(t, random.below(2) != 0);
        if (how == 2) e.switch_tet(t, true);
        if (how == 3) {
            Tet corners = e.given[t];
            corners.v[random.below(4)] = random.below(3) ? e.given[first].v[0] : random.below(vertices);
            e.replace(t, corners);
        }
    }
    if (how == 4) {
        Tet corners = e.given[first];
        corners.v[random.below(4)] = random.below(vertices);
        e.append(corners);
        if (random.below(2)) e.append(e.given[first]); // a double
    }
}

// ---- lists ----------------------------------------------------------------------------------------

START_TEST(lists_change) {
    Random random{std::uint64_t(_i)};
    IndexLists lists(heap());
    std::vector<std::vector<std::uint32_t>> expected(1 + random.below(30));
    for (std::vector<std::uint32_t>& list : expected) {
        lists.begin_list();
        for (std::uint32_t n = random.below(4); n > 0; --n) {
            list.push_back(random.below(9));
            lists.push(list.back());
        }
    }
    for (int step = 0; step < 3000; ++step) {
        const std::uint32_t i = random.below(static_cast<std::uint32_t>(expected.size())),
                            value = random.below(9);
        std::vector<std::uint32_t>& list = expected[i];
        const std::uint32_t place = random.below(static_cast<std::uint32_t>(list.size() + 1));
        switch (random.below(5)) {
        case 0:
            lists.insert(i, place, value);
            list.insert(list.begin() + place, value);
            break;
        case 1:
            lists.add(i, value);
            list.push_back(value);
            break;
        case 2:
            list.assign(random.below(12), value);
            lists.assign(i, list);
            break;
        case 3:
            if (step % 50 == 0) expected.emplace_back();
            lists.resize(expected.size());
            break;
        default:
            lists.remove(i, value);
            if (const auto found = std::find(list.begin(), list.end(), value); found != list.end())
                list.erase(found);
        }
        ck_assert_uint_eq(lists.size(), expected.size());
        for (std::size_t k = 0; k < expected.size(); ++k)
            ck_assert(std::ranges::equal(std::as_const(lists)[k], expected[k]));
    }
}
END_TEST

START_TEST(lists_do_not_grow_for_ever) {
    CountingMemory memory;
    IndexLists lists(&memory);
    for (std::uint32_t i = 0; i < 100; ++i) {
        lists.begin_list();
        for (std::uint32_t k = 0; k < 20; ++k) lists.push(k);
    }
    Random random{7};
    for (int round = 0; round < 20000; ++round) {
        const std::vector<std::uint32_t> values(random.below(40), 1u);
        lists.assign(random.below(100), values);
    }
    ck_assert_uint_lt(memory.bytes, 100 * 40 * 2 * 4 * sizeof(std::uint32_t));
}
END_TEST

// ---- topology -------------------------------------------------------------------------------------

void check_topology(const Edited& e, const Topology& repaired) {
    Topology anew(heap());
    make_topology(e.mesh.tets, vertex_count(e.mesh), anew);
    ck_assert_uint_eq(repaired.triangles.size(), anew.triangles.size());
    std::vector<std::uint32_t> number(anew.triangles.size()); // of a repaired triangle among those made anew
    std::map<FacetKey, std::uint32_t> numbers;
    for (std::uint32_t t = 0; t < anew.triangles.size(); ++t) numbers[anew.key(t)] = t;
    for (std::uint32_t t = 0; t < repaired.triangles.size(); ++t) {
        ck_assert(numbers.count(repaired.key(t)) == 1);
        number[t] = numbers[repaired.key(t)];
        const Triangle &is = repaired.triangles[t], &was = anew.triangles[number[t]];
        ck_assert(std::equal(is.v, is.v + 3, was.v) && is.apex == was.apex);
        for (std::uint32_t u = 0; u < t; ++u) ck_assert(repaired.before(u, t) == (number[u] < number[t]));
    }
    for (std::uint32_t v = 0; v < vertex_count(e.mesh); ++v) {
        ck_assert(std::ranges::equal(repaired.neighbours_of(v), anew.neighbours_of(v)));
        std::vector<std::uint32_t> ring;
        for (const std::uint32_t t : repaired.ring_of(v)) ring.push_back(number[t]);
        ck_assert(std::ranges::equal(ring, anew.ring_of(v)));
    }
    ck_assert_uint_eq(repaired.across.size(), anew.across.size());
    for (std::size_t t = 0; t < anew.across.size(); ++t)
        for (std::size_t i = 0; i < 4; ++i) {
            std::uint32_t across = repaired.across[t][i];
            if (across != Topology::nothing && across & Topology::surface_bit)
                across = Topology::surface_bit | number[across & ~Topology::surface_bit];
            ck_assert_uint_eq(across, anew.across[t][i]);
        }
}

START_TEST(topology_is_repaired) {
    Random random{std::uint64_t(_i)};
    const std::uint32_t long_side = 1 + random.below(3), vertices = 5 + random.below(10),
                        tets = 1 + random.below(40);
    Edited e(_i % 2 ? block(static_cast<int>(long_side), 2, 2) : soup(random, vertices, tets));
    Topology topology(heap());
    make_topology(e.mesh.tets, vertex_count(e.mesh), topology);
    for (int step = 0; step < 40; ++step) {
        edit(e, random, 5);
        e.apply_all();
        repair_topology(e.mesh.tets, e.tets_of, e.changes, topology);
        check_topology(e, topology);
        e.changes.clear();
    }
}
END_TEST

START_TEST(rings_are_repaired) {
    Random random{std::uint64_t(_i)};
    Edited e(_i % 2 ? block(4, 3, 2) : soup(random, 30, 25));
    const std::uint32_t count = 1 + random.below(3);
    Rings rings(e.mesh.tets, vertex_count(e.mesh), count, heap());
    for (int step = 0; step < 30; ++step) {
        edit(e, random, 4);
        e.apply_all();
        rings.repair(e.mesh.tets, e.tets_of, e.changes, count);
        const Rings anew(e.mesh.tets, vertex_count(e.mesh), count, heap());
        for (std::uint32_t v = 0; v < vertex_count(e.mesh); ++v)
            ck_assert(std::ranges::equal(std::as_const(rings.near)[v], anew.near[v]));
        e.changes.clear();
    }
}
END_TEST

// ---- tiles and surface ----------------------------------------------------------------------------

// Each tet that is on is in one place, with its corners; boxes of blocks cover every super-tile.
void check_tiles(const Edited& e, const Tiles& tiles, const TilePlaces& places) {
    std::vector<int> seen(e.mesh.tets.size());
    std::vector<std::uint32_t> block_of(e.mesh.positions.size());
    const auto& first = tiles.block_first;
    ck_assert_uint_eq(first.back(), vertex_count(e.mesh));
    for (std::uint32_t b = 0; b < tiles.block_count(); ++b) {
        ck_assert(first[b] < first[b + 1] && first[b + 1] - first[b] <= block_size);
        for (std::uint32_t v = first[b]; v < first[b + 1]; ++v) block_of[v] = b;
    }
    ck_assert(e.self || tiles.own.empty());
    ck_assert_uint_eq(tiles.super_first.front(), 0);
    ck_assert_uint_eq(tiles.super_first.back(), tiles.tiles.size());
    ck_assert_uint_eq(tiles.blocks.size(), tiles.super_tile_count());
    std::set<std::pair<std::uint32_t, std::uint32_t>> taken; // of tets and vertices, no two tiles share room
    for (std::uint32_t s = 0; s < tiles.super_tile_count(); ++s)
        for (std::uint32_t t = tiles.super_first[s]; t < tiles.super_first[s + 1]; ++t) {
            const Tile& tile = tiles.tiles[t];
            ck_assert(tile.tet_count <= tile_size && tile.vertex_count <= tile_size);
            ck_assert_uint_eq(tile.first_vertex % 4, 0);
            const std::uint32_t* vertices = tiles.vertices.data() + tile.first_vertex;
            std::vector<std::uint64_t> own(tile.vertex_count);
            for (std::uint32_t i = 0; i < tile.tet_count; ++i) {
                const std::uint32_t tet = tiles.tets[tile.first_tet + i];
                ck_assert_uint_eq(places.of_tet[tet], t * tile_size + i);
                ck_assert(taken.insert({0, tile.first_tet + i}).second);
                ++seen[tet];
                for (std::uint32_t c = 0; c < 4; ++c) {
                    const std::uint8_t local = tiles.corners[(t * 4 + c) * tile_size + i];
                    ck_assert_uint_lt(local, tile.vertex_count);
                    ck_assert_uint_eq(vertices[local], e.mesh.tets[tet].v[c]);
                    own[local] |= std::uint64_t{1} << i;
                }
            }
            for (std::uint32_t i = 0; i < tile.vertex_count; ++i) {
                if (e.self) ck_assert_uint_eq(tiles.own[tile.first_vertex + i], own[i]);
                ck_assert(tile.holds_last_vertex || vertices[i] != vertex_count(e.mesh) - 1);
                ck_assert(taken.insert({1, tile.first_vertex + i}).second);
                const std::span<const std::uint32_t> blocks = tiles.blocks[s];
                ck_assert(std::binary_search(blocks.begin(), blocks.end(), block_of[vertices[i]]));
            }
            for (std::uint32_t i = tile.vertex_count; i % 4; ++i)
                ck_assert_uint_eq(vertices[i], vertices[tile.vertex_count - 1]);
        }
    for (std::size_t t = 0; t < seen.size(); ++t) ck_assert_int_eq(seen[t], !e.off[t]);
}

// By its definition: the facets that tets on one side have more of than those on the other. Which of the tets
// count as mirrored is for is_negative() to say, of the positions that do not move here.
void check_boundary(const Edited& e, const Boundary& boundary) {
    std::map<FacetKey, int> net;
    std::vector<bool> used(e.mesh.positions.size());
    for (std::size_t t = 0; t < e.mesh.tets.size(); ++t) {
        const Tet& tet = e.mesh.tets[t];
        if (e.off[t] || names_a_vertex_twice(tet)) continue;
        const bool negative = is_negative(tet, view(e.mesh));
        for (const std::uint32_t v : tet.v) used[v] = true;
        for (std::uint32_t i = 0; i < 4; ++i) {
            const SortedFacet facet = sorted_facet(tet, i);
            net[facet.key] += facet.even != negative ? 1 : -1;
        }
    }
    std::size_t expected = 0;
    for (const auto& [key, count] : net) expected += count != 0;
    ck_assert_uint_eq(boundary.triangles.size(), expected);
    std::set<FacetKey> seen;
    for (const auto& t : boundary.triangles) {
        const SortedFacet facet = sorted_facet(t[0], t[1], t[2]);
        ck_assert(seen.insert(facet.key).second);
        ck_assert(net[facet.key] != 0 && (net[facet.key] > 0) == facet.even);
    }
    std::vector<std::uint32_t> loose;
    for (std::uint32_t v = 0; v < used.size(); ++v)
        if (!used[v]) loose.push_back(v);
    ck_assert(std::ranges::equal(boundary.loose, loose));
}

struct Prepared : TiledMesh {
    explicit Prepared(const Edited& e, bool with_boundary) : TiledMesh(heap()) {
        make_tiles(e.mesh.tets, vertex_count(e.mesh), view(e.mesh), tiles, e.off.words());
        if (!e.self) tiles.own.clear();
        if (with_boundary) make_boundary(e.mesh.tets, vertex_count(e.mesh), view(e.mesh), tiles, boundary);
        places.first_young_super = tiles.super_tile_count();
        places.first_young_vertex = vertex_count(e.mesh);
    }

    bool apply(Edited& e) {
        e.apply_all();
        const bool done = repair(*this, e.body(), e.changes, e.tets_of);
        e.changes.clear();
        return done;
    }
};

void append_vertices(Edited& e, Prepared& p, Random& random) {
    const std::uint32_t before = vertex_count(e.mesh);
    for (std::uint32_t n = 1 + random.below(10); n > 0; --n)
        e.mesh.positions.push_back(e.mesh.positions[random.below(before)]);
    e.tets_of.resize(e.mesh.positions.size());
    ck_assert(add_vertices(p, before, vertex_count(e.mesh)));
}

START_TEST(tiles_are_repaired) {
    Random random{std::uint64_t(_i)};
    Mesh mesh = block(7, 6, 5);
    jitter(mesh, 0.2, random);
    Edited e(std::move(mesh));
    int anew = 0;
    for (int round = 0; round < 4; ++round) {
        e.self = round % 2;
        Prepared p(e, false);
        std::uint64_t changes = 0;
        for (;; ++anew) {
            if (random.below(4) == 0) append_vertices(e, p, random);
            edit(e, random, random.below(8) ? 4 : 100);
            if (random.below(6) == 0) e.append(any_tet(random, vertex_count(e.mesh)));
            changes += e.changes.size();
            const bool done = p.apply(e);
            ck_assert(done == (changes <= e.given.size() / 4 + tile_size));
            if (!done) break;
            check_tiles(e, p.tiles, p.places);
        }
    }
    ck_assert_int_gt(anew, 40);
}
END_TEST

START_TEST(all_off_and_on_again) {
    Edited e(block(3, 3, 3));
    Prepared p(e, false);
    const auto tets = static_cast<std::uint32_t>(e.given.size());
    for (int round = 0; round < 2; ++round)
        for (std::uint32_t t = 0; t < 50; ++t) { // a whole tile's, and more
            e.switch_tet(p.tiles.tets[t % 2 ? t : 50 - t], round == 1);
            if (!p.apply(e)) p = Prepared(e, false);
            if (p.places.of_tet.empty()) continue;
            check_tiles(e, p.tiles, p.places);
        }
    for (std::uint32_t t = 0; t < tets; ++t) e.switch_tet(t, false);
    e.apply_all();
    const Prepared none(e, true);
    ck_assert_uint_eq(none.tiles.tiles.size(), 0);
    ck_assert_uint_eq(none.boundary.triangles.size(), 0);
}
END_TEST

START_TEST(surface_is_repaired) {
    Random random{std::uint64_t(_i)};
    Mesh mesh = block(24, 24, 24);
    for (Tet& tet : mesh.tets)
        if (random.below(3) == 0) std::swap(tet.v[2], tet.v[3]); // prepared as mirrored
    Edited e(std::move(mesh));
    Prepared p(e, true);
    ck_assert(p.boundary.is_closed);
    check_boundary(e, p.boundary);
    for (int step = 0; step < 60; ++step) {
        if (step % 4 == 0) append_vertices(e, p, random);
        edit(e, random, 5);
        ck_assert(p.apply(e));
        ck_assert(p.boundary.is_closed);
        if (step % 6 == 5) check_boundary(e, p.boundary);
    }
    check_tiles(e, p.tiles, p.places);
    // Where it is most of the body it is given up: every other tet off.
    for (std::uint32_t t = 0; t < 12000; t += 2) e.switch_tet(t, false);
    ck_assert(p.apply(e));
    ck_assert(!p.boundary.is_closed && p.boundary.triangles.empty());
}
END_TEST

} // namespace

SUITE(repair) {
    TCase* tests = add_case(suite, "repair");
    tcase_add_loop_test(tests, lists_change, 0, 10);
    tcase_add_test(tests, lists_do_not_grow_for_ever);
    tcase_add_loop_test(tests, topology_is_repaired, 0, 60);
    tcase_add_loop_test(tests, rings_are_repaired, 0, 20);
    tcase_add_loop_test(tests, tiles_are_repaired, 0, 3);
    tcase_add_test(tests, all_off_and_on_again);
    tcase_add_loop_test(tests, surface_is_repaired, 0, 3);
}
