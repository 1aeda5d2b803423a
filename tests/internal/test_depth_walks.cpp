// What the depth stage does for many at once against the same one by one: walks at every SIMD level. And the
// records of vertices and the tables of places against plain containers.
#include "base/place_map.hpp"
#include "base/simd.hpp"
#include "base/vectors.hpp"
#include "depth/walk.hpp"
#include "internal/scenes.hpp"
#include "mesh/topology.hpp"
#include "support/suite.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <map>
#include <memory_resource>
#include <vector>

using namespace vox;
using namespace vox::depth;

namespace {

std::pmr::memory_resource* memory() { return std::pmr::get_default_resource(); }

// ---- walks ----------------------------------------------------------------------------------------

bool same_bits(double a, double b) {
    return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

bool same_bits(const SurfacePoint& a, const SurfacePoint& b) {
    bool same = a.triangle == b.triangle;
    for (int i = 0; i < 3; ++i) same &= same_bits(a.weight[i], b.weight[i]);
    return same && same_bits(a.point.x, b.point.x) && same_bits(a.point.y, b.point.y) &&
           same_bits(a.point.z, b.point.z);
}

// Walks from points in or on tetrahedra, of all lengths, and many through corners and edges.
std::vector<Walk> some_walks(Random& random, const Mesh& mesh, std::size_t count) {
    std::vector<Walk> walks;
    while (walks.size() < count) {
        Walk walk{};
        walk.tet = random.below(std::uint32_t(mesh.tets.size()));
        const std::uint32_t* v = mesh.tets[walk.tet].v;
        double weight[4], sum = 0;
        for (double& w : weight) sum += w = double(1 + random.below(4));
        for (std::size_t i = 0; i < 4; ++i) walk.p = walk.p + weight[i] / sum * Vec3d(mesh.positions[v[i]]);
        if (random.below(8) == 0) walk.p = Vec3d(mesh.positions[v[random.below(4)]]); // at a corner
        const auto any = [&] { return double{random.uniform(-6, 10)}; };
        const Vec3d corner = Vec3d(mesh.positions[random.below(std::uint32_t(mesh.positions.size()))]);
        switch (random.below(5)) {
        case 0: // through a vertex, and beyond
            walk.q = walk.p + 8.0 * (corner - walk.p);
            break;
        case 1:
            walk.q = corner;
            break;
        case 2: // along an axis
            walk.q = walk.p + (random.below(2) ? Vec3d{any(), 0, 0} : Vec3d{0, any(), 0});
            break;
        default:
            walk.q = {any(), any(), any()};
        }
        if (random.below(20) == 0) walk.q = walk.p;
        walks.push_back(walk);
    }
    return walks;
}

Mesh walk_scene(int kind, Random& random) {
    switch (kind % 4) {
    case 0:
        return kuhn_block(4, 4, 4, {0, 0, 0}, 1); // where walks meet corners and edges
    case 1:
        return jittered(kuhn_block(4, 4, 4, {0, 0, 0}, 1), random, 0.2);
    case 2: { // inverted tetrahedra, among which walks may go round
        Mesh mesh = kuhn_block(4, 4, 4, {0, 0, 0}, 1);
        for (Vec3f& p : mesh.positions)
            p = {p.x + random.uniform(-2, 2), p.y + random.uniform(-2, 2), p.z + random.uniform(-2, 2)};
        return mesh;
    }
    default: // flat, doubled, and three or more at a facet
        return soup(random, 12, 60, [](Random& r) { return float(r.below(4)); });
    }
}

START_TEST(walks_side_by_side) {
    Random random{std::uint64_t(_i) + 1};
    const Mesh mesh = walk_scene(_i, random);
    Topology topology(memory());
    make_topology(mesh.tets, std::uint32_t(mesh.positions.size()), topology);
    const Solid solid{&topology, mesh.tets,
                      Positions{reinterpret_cast<const std::byte*>(mesh.positions.data()), sizeof(Vec3f)}};
    std::size_t left = 0;
    for (const std::size_t count : {1u, 2u, 7u, 8u, 9u, 63u, 64u, 65u, 300u}) {
        std::vector<Walk> one_by_one = some_walks(random, mesh, count);
        const std::vector<Walk> asked = one_by_one;
        simd::force_level(simd::least_level);
        for (Walk& walk : one_by_one)
            walk.leaves = walk_out(solid, walk.tet, walk.p, walk.q, walk.exit, walk.visited);
        for (const simd::Level level : {simd::least_level, simd::Level::avx2, simd::Level::avx512}) {
            if (simd::force_level(level) != level) continue;
            std::vector<Walk> walks = asked;
            walk_out(solid, walks);
            for (std::size_t i = 0; i < count; ++i) {
                const Walk &walk = walks[i], &expected = one_by_one[i];
                ck_assert_msg(walk.leaves == expected.leaves && walk.visited == expected.visited,
                              "%s: leaves %d, expected %d; visited %llu, expected %llu",
                              simd::level_name(level), walk.leaves, expected.leaves,
                              static_cast<unsigned long long>(walk.visited),
                              static_cast<unsigned long long>(expected.visited));
                ck_assert_msg(!walk.leaves || same_bits(walk.exit, expected.exit), "%s: another exit",
                              simd::level_name(level));
                left += walk.leaves;
            }
        }
    }
    simd::force_level(simd::best_level());
    ck_assert_uint_gt(left, 20);
}
END_TEST

START_TEST(no_walks) {
    const Mesh mesh = kuhn_block(1, 1, 1, {0, 0, 0}, 1);
    Topology topology(memory());
    make_topology(mesh.tets, std::uint32_t(mesh.positions.size()), topology);
    walk_out(Solid{&topology, mesh.tets, {}}, std::span<Walk>());
}
END_TEST

// ---- records and tables ---------------------------------------------------------------------------

struct Links {
    std::vector<std::uint32_t> neighbours, ring;
};

void expect_links(const VertexLinks& links, const std::vector<Links>& expected) {
    for (std::uint32_t v = 0; v < expected.size(); ++v) {
        const LinkRange neighbours = links.neighbours(v), ring = links.ring(v);
        ck_assert_uint_eq(neighbours.size(), expected[v].neighbours.size());
        ck_assert_uint_eq(ring.size(), expected[v].ring.size());
        ck_assert(std::equal(neighbours.begin(), neighbours.end(), expected[v].neighbours.begin()));
        ck_assert(std::equal(ring.begin(), ring.end(), expected[v].ring.begin()));
    }
}

START_TEST(records_of_vertices) {
    Random random{std::uint64_t(_i) + 1};
    std::vector<Links> expected(60);
    VertexLinks links(memory());
    links.resize(expected.size());
    for (int change = 0; change < 2000; ++change) {
        const std::uint32_t v = random.below(std::uint32_t(expected.size()));
        Links& of = expected[v];
        of = {};
        // Differences of 16 bits, just that, and more; rarely as many as take a longer record.
        const std::uint32_t reach = random.below(3) == 0 ? 1u << 28 : random.below(2) == 0 ? 65536 : 500;
        std::uint32_t count = random.below(30), next = random.below(reach), triangles = random.below(9);
        if (random.below(2) == 0) next = v + random.below(80000) - std::min(v, random.below(40000));
        if (change % 500 == 499) {
            count = 32760 + random.below(20);
            triangles = 65530 + random.below(20);
        }
        for (std::uint32_t i = 0; i < count; ++i) {
            of.neighbours.push_back(next);
            const std::uint32_t step = 1 + random.below(count > 1000 ? 2000 : reach);
            if (next > UINT32_MAX - step) break;
            next += step;
        }
        // In the order of their numbers, or in none, as after edits.
        for (std::uint32_t i = 0; i < triangles; ++i)
            of.ring.push_back(random.below(std::max(reach, 1u << 20)));
        if (random.below(3) > 0) std::sort(of.ring.begin(), of.ring.end());
        links.assign(v, of.neighbours, of.ring);
        if (change % 100 == 0) expect_links(links, expected);
    }
    expect_links(links, expected);
    expected.resize(100);
    links.resize(100);
    expect_links(links, expected);
}
END_TEST

START_TEST(records_that_change_keep_their_room) {
    // A vertex that changes for ever takes no more memory for ever.
    VertexLinks links(memory());
    links.resize(10);
    std::vector<std::uint32_t> many(40), few(3);
    for (std::uint32_t i = 0; i < many.size(); ++i) many[i] = 3 * i;
    few = {1, 2, 3};
    for (int i = 0; i < 10000; ++i) links.assign(std::uint32_t(i) % 10, i / 10 % 2 ? many : few, {});
    ck_assert_uint_lt(links.bytes(), 10000);
}
END_TEST

START_TEST(what_lies_across) {
    // Small meshes, large ones numbered in order, and large ones numbered at random, which take 32 bits.
    Random random{std::uint64_t(_i) + 1};
    const std::uint32_t tets = _i % 3 == 0 ? 1 + random.below(50000) : 60000 + random.below(40000);
    const bool in_order = _i % 3 < 2;
    std::vector<std::array<std::uint32_t, 4>> expected(
        tets, {Across::nothing, Across::nothing, Across::nothing, Across::nothing});
    const auto some_tet = [&](std::uint32_t near) {
        const std::uint32_t reach = in_order && random.below(50) > 0 ? 57344 : 2 * tets;
        const std::int64_t tet = std::int64_t{near} + random.below(reach) - reach / 2;
        return static_cast<std::uint32_t>(std::clamp<std::int64_t>(tet, 0, tets - 1));
    };
    const auto expect = [&](const Across& across) {
        ck_assert_uint_eq(across.size(), expected.size());
        for (std::uint32_t t = 0; t < expected.size(); ++t) {
            ck_assert(across[t] == expected[t]);
            ck_assert_uint_eq(across(t, t % 4), expected[t][t % 4]);
        }
    };
    Across across(memory());
    across.begin(tets);
    for (std::uint32_t t = 0; t < tets; ++t)
        for (std::uint32_t i = 0; i < 4; ++i)
            if (random.below(10) > 0) across.build(t, i, expected[t][i] = some_tet(t));
    std::uint32_t triangle = 0;
    for (std::uint32_t i = 0; i < tets / 5; ++i) { // they ascend, but not as the tetrahedra do
        const std::uint32_t t = in_order ? some_tet(std::min(5 * i, tets - 1)) : random.below(tets);
        std::uint32_t& facet = expected[t][i % 4];
        if (facet != Across::nothing) continue;
        across.build(t, i % 4, facet = Across::surface_bit | triangle++);
    }
    across.finish();
    expect(across);
    if (in_order) ck_assert_uint_lt(across.bytes(), 9 * std::size_t{tets});
    across.widen();
    expect(across);
    ck_assert_uint_le(across.bytes(), 16 * std::size_t{tets});
    across.resize(tets + 3);
    expected.resize(tets + 3, {Across::nothing, Across::nothing, Across::nothing, Across::nothing});
    for (int change = 0; change < 100; ++change) {
        const std::uint32_t t = random.below(tets + 3), i = random.below(4);
        across.set(t, i, expected[t][i] = change % 2 ? random.below(tets) : Across::nothing);
    }
    expect(across);
}
END_TEST

START_TEST(places_of_numbers) {
    Random random{std::uint64_t(_i) + 1};
    PlaceMap map(memory());
    ck_assert_uint_eq(map[7], PlaceMap::none);
    for (int time = 0; time < 50; ++time) {
        map.clear();
        std::map<std::uint32_t, std::uint32_t> expected;
        const std::uint32_t most = 1 + random.below(400), range = 1 + random.below(1000);
        for (std::uint32_t i = 0; i < most; ++i) {
            const std::uint32_t number = random.below(range) * (time % 2 ? 1u : 0x10001u);
            const auto [place, is_new] = expected.try_emplace(number, std::uint32_t(expected.size()));
            ck_assert_uint_eq(map.add(number), place->second);
            ck_assert_uint_eq(map.size(), expected.size());
        }
        for (std::uint32_t i = 0; i < range; ++i) {
            const auto found = expected.find(i);
            ck_assert_uint_eq(map[i], found == expected.end() ? PlaceMap::none : found->second);
        }
    }
}
END_TEST

// Numbers that find others in their slots, as somebody could choose who numbers a mesh: more and more of the
// candidates do. Without a tree beside the slots, a number takes thousands of probes.
START_TEST(numbers_chosen_to_collide) {
    constexpr std::uint32_t most = 8192;
    Random random{std::uint64_t(_i) + 1};
    PlaceMap map(memory());
    map.reserve(2 * most);
    std::vector<std::uint32_t> numbers{random.below(1000)};
    ck_assert_uint_eq(map.add(numbers[0]), 0);
    const std::uint32_t step = _i == 0 ? 1 : 1u << (4 * _i); // with some of the lowest bits in common, too
    for (std::uint32_t n = numbers[0] + step; numbers.size() < most; n += step)
        if (map[n] == PlaceMap::none && map.probes(n) > 1) {
            ck_assert_uint_eq(map.add(n), numbers.size());
            numbers.push_back(n);
        }
    std::uint64_t probes = 0;
    std::uint32_t worst = 0;
    for (std::uint32_t i = 0; i < most; ++i) {
        ck_assert_uint_eq(map[numbers[i]], i);
        probes += map.probes(numbers[i]);
        worst = std::max(worst, map.probes(numbers[i]));
    }
    ck_assert_uint_ge(worst, PlaceMap::most_slots + 8); // so the candidates did what they should
    ck_assert_uint_le(worst, PlaceMap::most_slots + PlaceMap::most_nodes);
    ck_assert_uint_le(probes, 40 * most);
    map.add(1); // makes the table larger
    map.reserve(8 * most);
    for (std::uint32_t i = 0; i < most; ++i) ck_assert_uint_eq(map[numbers[i]], i);
    map.clear();
    ck_assert_uint_eq(map[numbers[most - 1]], PlaceMap::none);
    ck_assert_uint_eq(map.add(numbers[most - 1]), 0);
}
END_TEST

} // namespace

SUITE(depth_walks) {
    TCase* tests = add_case(suite, "depth walks");
    tcase_add_loop_test(tests, walks_side_by_side, 0, 24);
    tcase_add_test(tests, no_walks);
    tcase_add_loop_test(tests, records_of_vertices, 0, 4);
    tcase_add_test(tests, records_that_change_keep_their_room);
    tcase_add_loop_test(tests, what_lies_across, 0, 6);
    tcase_add_loop_test(tests, places_of_numbers, 0, 4);
    tcase_add_loop_test(tests, numbers_chosen_to_collide, 0, 4);
}
