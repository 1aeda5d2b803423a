// Compares the reference engine with brute force in exact arithmetic, on scenes of every kind, for all
// storages and for cell sizes from absurdly small to absurdly large.
#include "base/array.hpp"
#include "base/error.hpp"
#include "grid/contacts.hpp"
#include "internal/counting_memory.hpp"
#include "internal/scenes.hpp"
#include "reference/engine.hpp"
#include "support/suite.h"

#include <cstring>
#include <string>
#include <tuple>

using namespace vox;

namespace {

// The engine with all that it keeps from step to step.
struct Engine {
    CountingMemory memory{std::size_t(1) << 26};
    ReferenceEngine reference{&memory};
    vox::Array<Hit> hits{&memory};
    vox::Array<vox_contact> contacts{&memory};
    vox::Counters counters{};
    vox::Profile profile{};

    void detect(const Meshes& scene, const ReferenceSettings& settings) {
        hits.clear();
        reference.detect(bodies(scene), settings, hits, counters, profile);
    }
    void step(const Meshes& scene, const ReferenceSettings& settings) {
        detect(scene, settings);
        make_contacts(bodies(scene), hits, contacts);
    }
};

struct Storage {
    bool dense, paper_hash;
    std::uint64_t table_size;
    bool small_world; // dense storage in a box that leaves out much of the scene
};

constexpr Storage storages[] = {
    {false, false, 0, false}, {false, true, 0, false},
    {false, false, 1, false}, // two buckets: nearly every cell collides
    {false, true, 7, false},  {true, false, 0, false},
    {true, false, 0, true},
};

// In units of the mean edge.
constexpr double cell_sizes[] = {0.2, 0.5, 1, 1.5, 3, 8, 1e-6, 1e6};

ReferenceSettings settings_of(const Storage& storage, double cell_size) {
    ReferenceSettings settings{cell_size, storage.dense, storage.paper_hash, storage.table_size, {}, {}};
    if (storage.small_world) {
        settings.world_min = {-1.5 * cell_size, -1.5 * cell_size, 0};
        settings.world_max = {1.5 * cell_size, 2 * cell_size, 0.5 * cell_size};
    }
    return settings;
}

// The number of cells that dense storage needs for the box of all positions.
double dense_cells(const Meshes& scene, double cell_size) {
    double count = 1;
    for (int axis = 0; axis < 3; ++axis) {
        double min = 0, max = 0;
        bool first = true;
        for (const Mesh& mesh : scene)
            for (const Vec3f& p : mesh.positions) {
                const double x = axis == 0 ? p.x : axis == 1 ? p.y : p.z;
                min = first ? x : std::min(min, x);
                max = first ? x : std::max(max, x);
                first = false;
            }
        count *= std::max(1.0, std::ceil((max - min) / cell_size));
    }
    return count;
}

void check_contacts(const vox::Array<vox_contact>& found, const oracle_contact* expected, std::size_t count) {
    ck_assert_uint_eq(found.size(), count);
    for (std::size_t i = 0; i < count; ++i) {
        ck_assert_uint_eq(found[i].body_a, expected[i].body_a);
        ck_assert_uint_eq(found[i].vertex, expected[i].vertex);
        ck_assert_uint_eq(found[i].body_b, expected[i].body_b);
        ck_assert_uint_eq(found[i].tet, expected[i].tet);
    }
}

// Checks that every storage and cell size gives the oracle's contacts, and returns their number.
std::size_t check_scene(Engine& engine, const Meshes& scene) {
    const std::vector<oracle_mesh> meshes = oracle_meshes(scene);
    const auto mesh_count = static_cast<std::uint32_t>(meshes.size());
    oracle_contact* expected;
    const std::size_t count = oracle_contacts(meshes.data(), mesh_count, &expected);
    const std::size_t degenerate = oracle_degenerate_tets(meshes.data(), mesh_count);
    std::size_t vertices = 0;
    for (const Mesh& mesh : scene) vertices += mesh.positions.size();

    const double edge = mean_edge(scene);
    std::uint64_t hash = 0;
    bool first = true;
    for (const double factor : cell_sizes) {
        for (const Storage& storage : storages) {
            const ReferenceSettings settings = settings_of(storage, factor * edge);
            try {
                engine.step(scene, settings);
            } catch (const Error& error) {
                // Only dense storage may refuse, and only when there are too many cells.
                ck_assert(storage.dense && !storage.small_world);
                ck_assert_double_gt(dense_cells(scene, settings.cell_size), 1e6);
                ck_assert(error.result() == VOX_ERROR_LIMIT || error.result() == VOX_ERROR_BUDGET);
                ck_assert_ptr_nonnull(std::strstr(error.what(), "cells of size"));
                continue;
            }
            check_contacts(engine.contacts, expected, count);
            if (first) hash = hash_contacts(engine.contacts);
            first = false;
            ck_assert_uint_eq(hash_contacts(engine.contacts), hash);

            const vox::Counters& c = engine.counters;
            ck_assert_uint_eq(c.skipped_degenerate, degenerate);
            ck_assert_uint_eq(c.entries, vertices);
            ck_assert_uint_le(c.cells, c.entries);
            ck_assert_uint_le(c.fullest_cell, c.entries);
            ck_assert_uint_ge(c.fullest_cell * c.cells, c.entries);
            ck_assert_uint_le(c.candidates, c.visited_entries);
            ck_assert_uint_ge(c.candidates, count);
        }
    }
    free(expected);
    return count;
}

float unit_range(Random& r) { return r.uniform(-1, 1); }
float quantised(Random& r) { return static_cast<float>(r.below(9)) / 4.0f - 1.0f; }
float any_bits(Random& r) { return r.any_finite(); }
float far_quantised(Random& r) { return -1e6f + static_cast<float>(r.below(16)) / 16.0f; }

Meshes two_blocks(const Vec3d& offset) {
    return {kuhn_block(2, 2, 2, {0, 0, 0}, 1), kuhn_block(2, 2, 2, offset, 1)};
}

// ---- against brute force --------------------------------------------------------------------------

START_TEST(random_soups) {
    Engine engine;
    Random random{11};
    std::size_t contacts = 0;
    for (int i = 0; i < 60; ++i) {
        for (float (*coordinate)(Random&) : {unit_range, quantised, any_bits, far_quantised}) {
            Meshes scene;
            for (int mesh = 0; mesh < 2; ++mesh) {
                const std::uint32_t vertices = 4 + random.below(30), tets = random.below(60);
                scene.push_back(soup(random, vertices, tets, coordinate));
            }
            if (random.below(2))
                scene.push_back(soup(random, 1 + random.below(9), 0, coordinate)); // points only
            for (Mesh& mesh : scene) mesh.self_collision = random.below(2);
            contacts += check_scene(engine, scene);
        }
    }
    ck_assert_uint_gt(contacts, 3000);
}
END_TEST

START_TEST(jittered_blocks_in_all_units) {
    Engine engine;
    Random random{12};
    std::size_t contacts = 0;
    for (int i = 0; i < 15; ++i) {
        const Vec3d offset{1.5 * random.unit(), 1.5 * random.unit(), 1.5 * random.unit()};
        Meshes scene = two_blocks(offset);
        for (Mesh& mesh : scene) {
            mesh = jittered(mesh, random, 0.6); // many tetrahedra fold over
            mesh.self_collision = true;
        }
        contacts += check_scene(engine, scene);
        for (const float scale : {1e-3f, 1e3f, 1e-30f, 1e30f})
            contacts += check_scene(engine, mapped(scene, [=](const Vec3f& p) {
                                        return Vec3f{p.x * scale, p.y * scale, p.z * scale};
                                    }));
        for (const float far :
             {1e6f, -1e6f}) // few bits are left, so vertices coincide and tetrahedra are flat
            contacts += check_scene(engine, mapped(scene, [=](const Vec3f& p) {
                                        return Vec3f{p.x + far, p.y - far, p.z + far};
                                    }));
    }
    ck_assert_uint_gt(contacts, 1000);
}
END_TEST

START_TEST(aligned_blocks) {
    Engine engine;
    for (double x = -2; x <= 2; x += 0.5)
        for (const double y : {0.0, 0.25, 1.0})
            for (const double z : {0.0, 0.5, 2.0}) {
                Meshes scene = two_blocks({x, y, z});
                check_scene(engine, scene);
                ck_assert_uint_eq(check_scene(engine, swapped_winding(scene)), check_scene(engine, scene));
            }
}
END_TEST

START_TEST(one_mesh_inside_another) {
    Engine engine;
    const Meshes scene{kuhn_block(3, 3, 3, {-3, -3, -3}, 2),
                       kuhn_block(1, 1, 1, {0.25, 0.375, 0.3125}, 0.125)};
    ck_assert_uint_eq(check_scene(engine, scene), 8);
}
END_TEST

START_TEST(coincident_bodies_and_duplicate_tets) {
    Engine engine;
    Meshes scene{kuhn_block(2, 2, 2, {0, 0, 0}, 1), kuhn_block(2, 2, 2, {0, 0, 0}, 1)};
    scene[0].tets.insert(scene[0].tets.end(), scene[1].tets.begin(), scene[1].tets.end());
    scene[0].self_collision = true;
    // Every vertex of each body is at a corner of the other, which gives one contact each. Within a body, all
    // tetrahedra that touch a vertex own it.
    ck_assert_uint_eq(check_scene(engine, scene), 2 * 27);
}
END_TEST

START_TEST(shared_parts_give_one_contact) {
    Engine engine;
    Meshes scene{kuhn_block(2, 2, 2, {0, 0, 0}, 1), Mesh{}};
    const Vec3f on_face{1, 0.25f, 0.5f}, on_edge{1, 1, 0.5f}, on_corner{1, 1, 1}, inside{0.25f, 0.5f, 0.75f};
    for (const Vec3f& p : {on_face, on_edge, on_corner, inside}) {
        scene[1].positions = {p};
        ck_assert_uint_eq(check_scene(engine, scene), 1);
    }
    // The vertex is in the interior of two new tetrahedra and on a face of old ones. Only the new ones are
    // reported.
    scene[1].positions = {on_face};
    scene[0].positions.insert(scene[0].positions.end(), {{0, 0, 0}, {8, 0, 0}, {0, 8, 0}, {0, 0, 8}});
    scene[0].tets.push_back({{27, 28, 29, 30}});
    scene[0].tets.push_back({{27, 29, 28, 30}});
    ck_assert_uint_eq(check_scene(engine, scene), 2);
    ck_assert_uint_eq(engine.contacts[0].tet, 48);
    ck_assert_uint_eq(engine.contacts[1].tet, 49);
}
END_TEST

START_TEST(flat_tets_hold_nothing) {
    Engine engine;
    Meshes scene = two_blocks({0.5, 0.5, 0.5});
    for (Vec3f& p : scene[0].positions) p.z = 0.5f;
    check_scene(engine, scene); // the flat body's vertices are still in the other one
    ck_assert_uint_gt(engine.contacts.size(), 0);
    for (const vox_contact& contact : engine.contacts) ck_assert_uint_eq(contact.body_b, 1);
    ck_assert_uint_eq(engine.counters.skipped_degenerate, 48);
    for (Vec3f& p : scene[1].positions) p = {0.5f, 0.5f, 0.5f};
    ck_assert_uint_eq(check_scene(engine, scene), 0);
    ck_assert_uint_eq(engine.counters.skipped_degenerate, 96);
}
END_TEST

START_TEST(far_vertices_and_slivers) {
    Engine engine;
    Random random{13};
    for (const float far : {1e30f, -3e38f, 1000.0f}) {
        for (std::uint32_t i = 0; i < 9; ++i) {
            Meshes scene = two_blocks({0.5, 0.25, 0.75});
            for (Mesh& mesh : scene) {
                mesh = jittered(mesh, random, 0.2);
                mesh.self_collision = true;
            }
            (&scene[0].positions[3 * i].x)[i % 3] = far; // all tetrahedra at this vertex become slivers
            check_scene(engine, scene);
        }
    }
}
END_TEST

START_TEST(empty_and_minimal_scenes) {
    Engine engine;
    ck_assert_uint_eq(check_scene(engine, {}), 0);
    ck_assert_uint_eq(check_scene(engine, {Mesh{}, Mesh{}}), 0);
    ck_assert_uint_eq(
        check_scene(engine, {Mesh{{{1, 2, 3}}, {}, true}, Mesh{}, Mesh{{{1, 2, 3}}, {}, false}}), 0);
    const Mesh tet{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{{0, 1, 2, 3}}}, true};
    ck_assert_uint_eq(check_scene(engine, {tet}), 0);
    ck_assert_uint_eq(check_scene(engine, {tet, Mesh{}, Mesh{{{0.25f, 0.25f, 0.25f}}, {}, false}}), 1);
}
END_TEST

START_TEST(more_candidates_than_any_block) {
    Engine engine;
    Random random{14};
    Meshes scene{soup(random, 9000, 0, unit_range), Mesh{}};
    scene[1].positions = {{-9, -9, -9}, {9, -9, -9}, {-9, 9, -9}, {-9, -9, 9}};
    scene[1].tets = {{{0, 1, 2, 3}}, {{0, 2, 1, 3}}};
    for (Vec3f& p : scene[0].positions) p = {p.x - 6, p.y - 6, p.z - 6};
    for (const double cell_size : {0.01, 1.0, 100.0}) {
        engine.step(scene, settings_of(storages[0], cell_size));
        ck_assert_uint_eq(engine.counters.candidates, 18000);
        ck_assert_uint_eq(engine.contacts.size(), 18000);
    }
}
END_TEST

// ---- properties -----------------------------------------------------------------------------------

// The part of the hits that does not change when a scene is moved, scaled, or turned inside out.
std::vector<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t, bool>>
sorted_hits(Engine& engine, const Meshes& scene, double cell_size) {
    engine.detect(scene, settings_of(storages[0], cell_size));
    std::vector<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t, bool>> hits;
    for (const Hit& hit : engine.hits)
        hits.emplace_back(hit.body_a, hit.vertex, hit.body_b, hit.tet, hit.interior);
    std::sort(hits.begin(), hits.end());
    return hits;
}

Meshes quantised_scene(Random& random) {
    Meshes scene{soup(random, 40, 60, quantised), kuhn_block(2, 3, 1, {-1, -1.25, -0.5}, 0.75)};
    for (Mesh& mesh : scene) mesh.self_collision = true;
    return scene;
}

START_TEST(moving_and_scaling_change_nothing) {
    Engine engine;
    Random random{15};
    for (int i = 0; i < 20; ++i) {
        const Meshes scene = quantised_scene(random);
        const auto expected = sorted_hits(engine, scene, 0.7);
        ck_assert_uint_gt(expected.size(), 0);
        for (const float d : {1.0f, -1024.0f, 65536.0f}) // exact, because coordinates are multiples of 1/4
            ck_assert(sorted_hits(engine,
                                  mapped(scene,
                                         [=](const Vec3f& p) {
                                             return Vec3f{p.x + d, p.y - d, p.z + 2 * d};
                                         }),
                                  0.7) == expected);
        for (const int exponent : {-120, -20, 1, 20, 120})
            ck_assert(sorted_hits(engine,
                                  mapped(scene,
                                         [=](const Vec3f& p) {
                                             return Vec3f{std::ldexp(p.x, exponent),
                                                          std::ldexp(p.y, exponent),
                                                          std::ldexp(p.z, exponent)};
                                         }),
                                  std::ldexp(0.7, exponent)) == expected);
        ck_assert(sorted_hits(engine, swapped_winding(scene), 0.7) == expected);
    }
}
END_TEST

START_TEST(shuffling_renames_and_no_more) {
    Engine engine;
    Random random{16};
    for (int i = 0; i < 20; ++i) {
        const Meshes scene = quantised_scene(random);
        const auto expected = sorted_hits(engine, scene, 0.7);
        Meshes shuffled = scene;
        std::vector<std::vector<std::uint32_t>> old_vertex, old_tet; // by mesh, from new index to old
        for (std::size_t m = 0; m < scene.size(); ++m) {
            old_vertex.push_back(permutation(random, scene[m].positions.size()));
            old_tet.push_back(permutation(random, scene[m].tets.size()));
            std::vector<std::uint32_t> new_vertex(scene[m].positions.size());
            for (std::uint32_t v = 0; v < new_vertex.size(); ++v) {
                new_vertex[old_vertex[m][v]] = v;
                shuffled[m].positions[v] = scene[m].positions[old_vertex[m][v]];
            }
            for (std::size_t t = 0; t < scene[m].tets.size(); ++t)
                for (std::size_t c = 0; c < 4; ++c)
                    shuffled[m].tets[t].v[c] = new_vertex[scene[m].tets[old_tet[m][t]].v[c]];
        }
        auto hits = sorted_hits(engine, shuffled, 0.7);
        for (auto& [body_a, vertex, body_b, tet, interior] : hits) {
            vertex = old_vertex[body_a][vertex];
            tet = old_tet[body_b][tet];
        }
        std::sort(hits.begin(), hits.end());
        ck_assert(hits == expected);
    }
}
END_TEST

// ---- counters, errors, memory ---------------------------------------------------------------------

START_TEST(counters_of_a_scene_counted_by_hand) {
    // Cells have size 1. The tetrahedron's box is [0.5, 2.5]^3, which gives 27 objective voxels. Two points
    // are in one of these, and one of the two is outside the box. A third point is in another voxel, inside
    // the box but outside the tetrahedron. The last one is elsewhere.
    const Meshes scene{
        Mesh{{{0.5f, 0.5f, 0.5f}, {2.5f, 0.5f, 0.5f}, {0.5f, 2.5f, 0.5f}, {0.5f, 0.5f, 2.5f}},
             {{{0, 1, 2, 3}}},
             false},
        Mesh{{{0.75f, 0.75f, 0.75f}, {0.25f, 0.75f, 0.75f}, {2.25f, 2.25f, 2.25f}, {-5, -5, -5}}, {}, false}};
    Engine engine;
    for (const bool paper_hash : {false, true}) {
        engine.step(scene, {1, false, paper_hash, 0, {}, {}});
        const vox::Counters& c = engine.counters;
        ck_assert_uint_eq(c.entries, 8);
        // (0,0,0) holds three; (2,0,0), (0,2,0), (0,0,2), (2,2,2) and (-5,-5,-5) hold one each.
        ck_assert_uint_eq(c.cells, 6);
        ck_assert_uint_eq(c.fullest_cell, 3);
        // 27 voxels are more than the 6 occupied ones, so the occupied ones in the box are visited instead.
        ck_assert_uint_eq(c.visited_cells, 5);
        ck_assert_uint_eq(c.visited_entries, 7);
        ck_assert_uint_eq(c.candidates, 2);
        ck_assert_uint_eq(c.exact_tests, 0);
        ck_assert_uint_eq(engine.contacts.size(), 1);
    }
    // With two cells an axis, the far point has a cell for itself, and all others share one.
    engine.step(scene, {5, true, false, 0, {-5, -5, -5}, {5, 5, 5}});
    ck_assert_uint_eq(engine.counters.cells, 2);
    ck_assert_uint_eq(engine.counters.visited_cells, 1);
    ck_assert_uint_eq(engine.counters.visited_entries, 7);
    ck_assert_uint_eq(engine.counters.candidates, 2);
}
END_TEST

START_TEST(every_objective_voxel_is_counted) {
    // 64 points, each in a cell of its own, and a tetrahedron whose box covers 2 x 2 x 2 cells.
    Meshes scene{Mesh{}, Mesh{}};
    for (int i = 0; i < 64; ++i)
        scene[0].positions.push_back({static_cast<float>(i % 4) + 0.5f, static_cast<float>(i / 4 % 4) + 0.5f,
                                      static_cast<float>(i / 16) - 1.5f});
    scene[1].positions = {
        {0.75f, 0.75f, -0.75f}, {1.25f, 0.75f, -0.75f}, {0.75f, 1.25f, -0.75f}, {0.75f, 0.75f, 0.25f}};
    scene[1].tets = {{{0, 1, 2, 3}}};
    Engine engine;
    for (const Storage& storage : storages) {
        if (storage.small_world) continue;
        ReferenceSettings settings = settings_of(storage, 1);
        if (storage.dense) settings.world_min = {-8, -8, -8}, settings.world_max = {8, 8, 8};
        engine.step(scene, settings);
        ck_assert_uint_eq(engine.counters.cells, 64);
        ck_assert_uint_eq(engine.counters.visited_cells, 8);
        ck_assert_uint_eq(engine.counters.visited_entries, 8 + 4);
        ck_assert_uint_eq(engine.counters.candidates, 0);
    }
}
END_TEST

START_TEST(non_finite_positions_are_named) {
    Engine engine;
    const Meshes scene = two_blocks({0.5, 0.5, 0.5});
    engine.step(scene, settings_of(storages[0], 1));
    const std::size_t expected = engine.contacts.size();
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                            -std::numeric_limits<float>::infinity()}) {
        for (int axis = 0; axis < 3; ++axis) {
            for (const Storage& storage : storages) {
                Meshes broken = scene;
                (&broken[1].positions[17].x)[axis] = bad;
                try {
                    engine.step(broken, settings_of(storage, 1));
                    ck_abort_msg("a non-finite position went through");
                } catch (const Error& error) {
                    ck_assert_int_eq(error.result(), VOX_ERROR_NON_FINITE);
                    ck_assert_ptr_nonnull(
                        std::strstr(error.what(), "mesh 1 (user data 0), vertex 17: position ("));
                }
                engine.step(scene, settings_of(storage, 1)); // the engine is usable again
                ck_assert_uint_eq(engine.contacts.size(), expected);
            }
        }
    }
}
END_TEST

START_TEST(budget_is_named_with_cells_and_bytes) {
    Engine engine;
    engine.memory.budget = 100000;
    const Meshes scene = two_blocks({0.5, 0.5, 0.5}); // 2.5 wide
    try {
        engine.step(scene, {0.01, true, false, 0, {}, {}});
        ck_abort_msg("15 million cells fit in 100000 bytes");
    } catch (const Error& error) {
        ck_assert_int_eq(error.result(), VOX_ERROR_BUDGET);
        ck_assert_ptr_nonnull(
            std::strstr(error.what(), "250 x 250 x 250 cells of size 0.01, 62500000 bytes"));
    }
    engine.step(scene, settings_of(storages[0], 0.01));
    ck_assert_uint_gt(engine.contacts.size(), 0);
}
END_TEST

// ---- hash flooding --------------------------------------------------------------------------------

template <class Address>
std::uint32_t bucket_of(const Address& address, const CellCoord& at) {
    return address.bucket(address.row(at.j, at.k), at.i);
}

// Points in cells of size 1 that this address puts into one bucket, with a tetrahedron around each tenth.
template <class Address>
Meshes flood(std::size_t points, std::size_t tets) {
    const Address address{Modulus(next_prime(2 * (points + 4 * tets)))};
    Meshes scene(2);
    Random random{7};
    const std::uint32_t bucket = bucket_of(address, {3, 4, 5});
    while (scene[0].positions.size() < points) {
        const CellCoord at{std::int32_t(random.below(1024)), std::int32_t(random.below(1024)),
                           std::int32_t(random.below(1024))};
        if (bucket_of(address, at) == bucket)
            scene[0].positions.push_back({float(at.i) + 0.5f, float(at.j) + 0.5f, float(at.k) + 0.5f});
    }
    for (std::uint32_t t = 0; t < tets; ++t) {
        const Vec3f& p = scene[0].positions[t * (points / tets)];
        for (int v = 0; v < 4; ++v)
            scene[1].positions.push_back({p.x + (v == 1 ? 0.75f : -0.25f), p.y + (v == 2 ? 0.75f : -0.25f),
                                          p.z + (v == 3 ? 0.75f : -0.25f)});
        scene[1].tets.push_back({{4 * t, 4 * t + 1, 4 * t + 2, 4 * t + 3}});
    }
    return scene;
}

// The most cells that a search for one may have to look at.
std::uint32_t longest_chain(const CellLists& lists) {
    std::vector<std::uint32_t> length; // a cell's next one in its bucket came before it
    for (const Cell& cell : lists.occupied())
        length.push_back(cell.next == CellLists::none ? 1 : length[cell.next] + 1);
    return *std::max_element(length.begin(), length.end());
}

START_TEST(chosen_cells_do_not_share_a_bucket) {
    constexpr std::size_t points = 2000, tets = 200;
    const auto check = [](const Meshes& scene, bool paper_hash) {
        Engine engine;
        const ReferenceSettings settings{.cell_size = 1, .paper_hash = paper_hash};
        const ReferenceSettings other{.cell_size = 1, .paper_hash = !paper_hash};
        engine.step(scene, other); // a hash that these cells were not chosen for
        ck_assert_uint_le(longest_chain(engine.reference.cells()), 32);
        const std::uint64_t hash = hash_contacts(engine.contacts);
        const vox::Counters expected = engine.counters;
        ck_assert_uint_ge(expected.contacts + engine.contacts.size(), tets);

        std::size_t allocations = 0;
        for (int step = 0; step < 3; ++step) {
            if (step == 2) allocations = engine.memory.allocations;
            engine.step(scene, settings);
            ck_assert_uint_le(longest_chain(engine.reference.cells()), 32);
            ck_assert_uint_eq(hash_contacts(engine.contacts), hash);
            ck_assert_uint_eq(engine.counters.cells, expected.cells);
            ck_assert_uint_eq(engine.counters.fullest_cell, expected.fullest_cell);
            ck_assert_uint_eq(engine.counters.visited_cells, expected.visited_cells);
            ck_assert_uint_eq(engine.counters.visited_entries, expected.visited_entries);
        }
        ck_assert_uint_eq(engine.memory.allocations, allocations);
    };
    check(flood<PaperAddress>(points, tets), true);
    check(flood<MixedAddress>(points, tets), false);
}
END_TEST

START_TEST(steady_state_allocates_nothing) {
    Engine engine;
    Random random{17};
    const Meshes start = two_blocks({0.5, 0.5, 0.5});
    for (const Storage& storage : storages) {
        ReferenceSettings settings = settings_of(storage, 0.4);
        if (storage.dense) settings.world_min = {-1, -1, -1}, settings.world_max = {4, 4, 4};
        engine.step(start, settings);
        for (int i = 0; i < 10; ++i) {
            Meshes moved = start; // less overlap, other cells
            const double shift = random.unit();
            for (Vec3f& p : moved[1].positions) p = {p.x + static_cast<float>(shift), p.y, p.z};
            const std::size_t before = engine.memory.allocations;
            engine.step(moved, settings);
            ck_assert_uint_eq(engine.memory.allocations, before);
        }
    }
}
END_TEST

} // namespace

SUITE(reference) {
    TCase* tests = add_case(suite, "engine");
    for (const TTest* test :
         {random_soups, jittered_blocks_in_all_units, aligned_blocks, one_mesh_inside_another,
          coincident_bodies_and_duplicate_tets, shared_parts_give_one_contact, flat_tets_hold_nothing,
          far_vertices_and_slivers, empty_and_minimal_scenes, more_candidates_than_any_block,
          moving_and_scaling_change_nothing, shuffling_renames_and_no_more,
          counters_of_a_scene_counted_by_hand, every_objective_voxel_is_counted,
          non_finite_positions_are_named, budget_is_named_with_cells_and_bytes,
          chosen_cells_do_not_share_a_bucket, steady_state_allocates_nothing})
        tcase_add_test(tests, test);
}
