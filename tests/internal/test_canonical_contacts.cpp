// Hits to contacts: the order, the rule for shared boundaries, the hash.
#include "base/array.hpp"
#include "base/parallel.hpp"
#include "base/simd.hpp"
#include "exact/predicates.hpp"
#include "grid/contacts.hpp"
#include "internal/scenes.hpp"
#include "support/suite.h"

#include <algorithm>
#include <set>
#include <tuple>

using namespace vox;

namespace {

constexpr Vec3f corner_positions[4] = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4}};

// All vertices at (1, 1, 1) but for the first four, all tetrahedra (0, 1, 2, 3): only the indices differ.
Mesh uniform_mesh(std::size_t vertices, std::size_t tets) {
    Mesh mesh;
    mesh.positions.assign(corner_positions, corner_positions + 4);
    mesh.positions.resize(vertices, Vec3f{1, 1, 1});
    mesh.tets.assign(tets, Tet{{0, 1, 2, 3}});
    return mesh;
}

std::pmr::memory_resource* const heap = std::pmr::get_default_resource();

using Key = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t>;

Key key(const Hit& hit) { return {hit.body_a, hit.vertex, hit.body_b, hit.tet}; }

// The rule of vox_contact, read literally.
std::vector<Hit> expected_hits(const std::vector<Hit>& hits) {
    std::vector<Hit> expected;
    for (const Hit& hit : hits) {
        bool first = true, any_interior = false;
        for (const Hit& other : hits) {
            if (other.body_a != hit.body_a || other.vertex != hit.vertex || other.body_b != hit.body_b)
                continue;
            any_interior |= other.interior != 0;
            first &= other.tet >= hit.tet;
        }
        if (hit.interior || (!any_interior && first)) expected.push_back(hit);
    }
    std::sort(expected.begin(), expected.end(), [](const Hit& x, const Hit& y) { return key(x) < key(y); });
    return expected;
}

// The hits are between 300 bodies that all look like `mesh`.
void check(const Mesh& mesh, const std::vector<Hit>& found) {
    const std::vector<Hit> expected = expected_hits(found);
    vox::Array<Hit> hits(found.begin(), found.end(), heap);
    const Positions positions{reinterpret_cast<const std::byte*>(mesh.positions.data()), sizeof(Vec3f)};
    const Body view{0, static_cast<std::uint32_t>(mesh.positions.size()), positions, mesh.tets, true};
    std::vector<Body> views(300, view);
    for (std::size_t b = 0; b < views.size(); ++b)
        views[b].mesh_id = static_cast<std::uint32_t>(1000 + 3 * b);
    vox::Array<vox_contact> contacts(5, heap); // left-overs of another step
    make_contacts(views, hits, contacts);
    ck_assert_uint_eq(contacts.size(), expected.size());
    for (std::size_t i = 0; i < contacts.size(); ++i) {
        ck_assert_uint_eq(contacts[i].body_a, 1000 + 3 * expected[i].body_a);
        ck_assert_uint_eq(contacts[i].vertex, expected[i].vertex);
        ck_assert_uint_eq(contacts[i].body_b, 1000 + 3 * expected[i].body_b);
        ck_assert_uint_eq(contacts[i].tet, expected[i].tet);
    }
}

Hit hit(std::uint32_t body_a, std::uint32_t vertex, std::uint32_t body_b, std::uint32_t tet, bool interior) {
    return {body_a, vertex, body_b, tet & 0x7fffffffu, interior};
}

START_TEST(any_order_of_hits_becomes_canonical) {
    const Mesh mesh = uniform_mesh(80000, 70000); // indices of one, two and three bytes
    Random random{21};
    for (const std::uint32_t count : {0u, 1u, 2u, 100u, 255u, 256u, 257u, 1500u}) {
        for (const std::uint32_t spread : {1u, 2u, 300u}) {        // of bodies
            for (const std::uint32_t range : {3u, 200u, 66000u}) { // of vertices and tets
                std::set<Key> keys;
                for (std::uint32_t i = 0; i < count; ++i)
                    keys.insert(Key{random.below(spread), 4 + random.below(range), random.below(spread),
                                    random.below(range)});
                std::vector<Hit> sorted_hits, hits;
                for (const auto& [body_a, vertex, body_b, tet] : keys)
                    sorted_hits.push_back(hit(body_a, vertex, body_b, tet, random.below(3) == 0));
                check(mesh, sorted_hits);
                for (const std::uint32_t i : permutation(random, sorted_hits.size()))
                    hits.push_back(sorted_hits[i]);
                check(mesh, hits);
                std::stable_sort(hits.begin(), hits.end(),
                                 [](const Hit& x, const Hit& y) { // as an engine gives them
                                     return std::pair(x.body_b, std::uint32_t(x.tet)) <
                                            std::pair(y.body_b, std::uint32_t(y.tet));
                                 });
                check(mesh, hits);
            }
        }
    }
}
END_TEST

START_TEST(interior_hits_hide_boundary_ones) {
    const Mesh mesh = uniform_mesh(10, 10);
    check(mesh, {hit(0, 4, 1, 7, false), hit(0, 4, 1, 3, false), hit(0, 4, 1, 5, false)});
    check(mesh, {hit(0, 4, 1, 7, true), hit(0, 4, 1, 3, false), hit(0, 4, 1, 5, true)});
    check(mesh,
          {hit(0, 4, 1, 7, true), hit(0, 4, 2, 3, false), hit(0, 5, 1, 5, false), hit(1, 4, 1, 2, false)});
}
END_TEST

// The rule again, for hits of which there are too many to compare each with all others.
std::vector<Key> expected_keys(std::vector<Hit> hits) {
    std::sort(hits.begin(), hits.end(), [](const Hit& x, const Hit& y) { return key(x) < key(y); });
    std::vector<Key> expected;
    for (std::size_t begin = 0, end; begin < hits.size(); begin = end) {
        bool any_interior = false;
        for (end = begin; end < hits.size() && hits[end].body_a == hits[begin].body_a &&
                          hits[end].vertex == hits[begin].vertex && hits[end].body_b == hits[begin].body_b;
             ++end)
            any_interior |= hits[end].interior != 0;
        for (std::size_t i = begin; i < end; ++i)
            if (any_interior ? hits[i].interior != 0 : i == begin) expected.push_back(key(hits[i]));
    }
    return expected;
}

// Runs ranges on this thread, the last one first.
void* run_backwards(vox_task* task, std::uint64_t items, std::uint64_t min_range, void* context, void* user) {
    const std::uint32_t workers = *static_cast<const std::uint32_t*>(user);
    for (std::uint64_t end = items, i = 0; end > 0; ++i) {
        const std::uint64_t begin = end > min_range ? end - min_range : 0;
        task(begin, end, static_cast<std::uint32_t>(i % workers), context);
        end = begin;
    }
    return nullptr;
}

START_TEST(workers_share_many_hits) {
    const Mesh mesh = uniform_mesh(80000, 70000);
    const Positions positions{reinterpret_cast<const std::byte*>(mesh.positions.data()), sizeof(Vec3f)};
    std::vector<Body> views(
        300, Body{0, static_cast<std::uint32_t>(mesh.positions.size()), positions, mesh.tets, true});
    for (std::size_t b = 0; b < views.size(); ++b) views[b].mesh_id = static_cast<std::uint32_t>(b);
    Random random{22};
    for (const std::uint32_t count : {8193u, 40000u, 150000u})
        for (const auto& [spread, range] :
             {std::pair(1u, 66000u), {300u, 200u}, {2u, 9u}}) { // bodies, vertices
            std::vector<Hit> hits;
            for (std::uint32_t i = 0; i < count; ++i) // body_b and tet tell them apart
                hits.push_back(
                    hit(random.below(spread), 4 + random.below(range), i % 4, i / 4, random.below(3) == 0));
            const std::vector<Key> expected = expected_keys(hits);
            for (std::uint32_t workers : {1u, 2u, 5u}) {
                Workers shared({run_backwards, [](void*, void*) {}, &workers}, workers);
                vox::Array<Hit> left(hits.begin(), hits.end(), heap);
                vox::Array<vox_contact> contacts(heap);
                make_contacts(views, left, contacts, &shared);
                ck_assert_uint_eq(contacts.size(), expected.size());
                ck_assert_uint_eq(left.size(), expected.size());
                for (std::size_t i = 0; i < expected.size(); ++i) {
                    ck_assert(key(left[i]) == expected[i]);
                    const vox_contact& c = contacts[i];
                    ck_assert(Key(c.body_a, c.vertex, c.body_b, c.tet) == expected[i]);
                }
            }
        }
}
END_TEST

START_TEST(hash_is_as_documented) {
    // Both numbers from a separate program after the words in contacts.hpp.
    ck_assert_uint_eq(hash_contacts({}), 0);
    const vox_contact two[] = {{1, 2, 3, 4}, {4294967295u, 0, 7, 2147483646u}};
    ck_assert_uint_eq(hash_contacts(two), 0x53ed032a00fc444eu);
}
END_TEST

START_TEST(hash_tells_every_field_and_the_order) {
    std::vector<vox_contact> list(3, vox_contact{1, 2, 3, 4});
    list[1].vertex = 9;
    std::set<std::uint64_t> hashes{hash_contacts(list)};
    const auto differs = [&hashes](std::vector<vox_contact> changed, auto&& change) {
        change(changed);
        ck_assert(hashes.insert(hash_contacts(changed)).second);
    };
    using List = std::vector<vox_contact>&;
    for (std::size_t i = 0; i < list.size(); ++i) {
        differs(list, [i](List l) { ++l[i].body_a; });
        differs(list, [i](List l) { l[i].vertex += 20; });
        differs(list, [i](List l) { ++l[i].body_b; });
        differs(list, [i](List l) { ++l[i].tet; });
    }
    differs(list, [](List l) { std::swap(l[0], l[1]); });
    differs(list, [](List l) { l.pop_back(); });
    differs(list, [](List l) { l.clear(); });
    differs(list, [](List l) { l.push_back(vox_contact{}); });
}
END_TEST

} // namespace

SUITE(canonical_contacts) {
    TCase* tests = add_case(suite, "contacts");
    tcase_add_each(tests, any_order_of_hits_becomes_canonical, interior_hits_hide_boundary_ones,
                   workers_share_many_hits, hash_is_as_documented, hash_tells_every_field_and_the_order);
}
