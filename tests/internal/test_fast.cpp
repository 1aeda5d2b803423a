// The fast engine against the reference engine and against every pair decided exactly, on ordinary scenes and
// on every kind of bad one, at every SIMD level of the machine and several cell sizes.
#include "base/array.hpp"
#include "base/error.hpp"
#include "internal/counting_memory.hpp"
#include "internal/fast_checks.hpp"

#include <cfloat>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

using namespace vox;

namespace {

// ---- scenes ---------------------------------------------------------------------------------------

Scene two_blocks(Random& r, int n, double overlap, bool self) {
    Scene scene;
    for (int i = 0; i < 2; ++i) {
        Mesh mesh = block(n, n, n);
        jitter(mesh, 0.15, r);
        move(mesh, 1, i * (n - overlap), i * 0.123, i * 0.271);
        scene.add(std::move(mesh), self);
    }
    return scene;
}

START_TEST(two_bodies) {
    Random r{1};
    for (const double overlap : {0.0, 0.5, 2.0, 5.0}) {
        Scene scene = two_blocks(r, 6, overlap, false);
        check_exactly(scene, "two blocks");
        scene = two_blocks(r, 5, overlap, true);
        check_exactly(scene, "two blocks with self-collision");
    }
}
END_TEST

START_TEST(numbering_does_not_matter) {
    Random r{2};
    Scene scene = two_blocks(r, 6, 2.0, true);
    for (Mesh& mesh : scene.meshes()) renumber(mesh, r);
    check_exactly(scene, "renumbered blocks");
}
END_TEST

// Everything on a coarse grid: flat tets, coincident vertices, contacts on faces, edges and corners.
START_TEST(snapped_to_a_grid) {
    Random r{3};
    for (const float step : {1.0f, 0.5f, 2.0f}) {
        Scene scene = two_blocks(r, 5, 2.5, true);
        for (Mesh& mesh : scene.meshes())
            for (Vec3f& p : mesh.positions)
                p = {std::round(p.x / step) * step, std::round(p.y / step) * step,
                     std::round(p.z / step) * step};
        check_exactly(scene, "snapped blocks", step);
    }
}
END_TEST

START_TEST(coincident_bodies) {
    Scene scene;
    for (int i = 0; i < 3; ++i) scene.add(block(4, 4, 4), true);
    check_exactly(scene, "three coincident blocks");
}
END_TEST

START_TEST(inverted_tets) {
    Random r{4};
    for (int part = 0; part < 3; ++part) {
        Scene scene = two_blocks(r, 5, 2.0, true);
        for (Mesh& mesh : scene.meshes()) {
            if (part == 0) { // folded
                for (Vec3f& p : mesh.positions)
                    if (r.below(10) == 0)
                        p = {p.x + r.uniform(-2, 2), p.y + r.uniform(-2, 2), p.z + r.uniform(-2, 2)};
            } else if (part == 1) { // mirrored as a whole
                for (Vec3f& p : mesh.positions) p.x = -p.x;
            } else { // winding
                for (Tet& tet : mesh.tets)
                    if (r.below(2)) std::swap(tet.v[0], tet.v[1]);
            }
        }
        check_exactly(scene, "inverted tets");
    }
}
END_TEST

START_TEST(every_size_and_place) {
    Random r{5};
    // Powers of two around what coordinates, differences, areas and volumes can hold in a float.
    for (const double scale : {1e-3, 1e3, 0x1p-30, 0x1p-45, 0x1p-60, 0x1p-120, 0x1p-143, 0x1p30, 0x1p42,
                               0x1p60, 0x1p100, 0x1p123}) {
        Scene scene = two_blocks(r, 4, 1.5, true);
        for (Mesh& mesh : scene.meshes()) move(mesh, scale, 0, 0, 0);
        check_exactly(scene, "scaled blocks", scale);
    }
    for (const double offset : {1e3, 1e6, -3e7}) {
        Scene scene = two_blocks(r, 4, 1.5, true);
        for (Mesh& mesh : scene.meshes()) move(mesh, 1, offset, -offset, offset / 3);
        check_exactly(scene, "blocks far from the origin");
    }
}
END_TEST

START_TEST(vertices_far_away) {
    Random r{6};
    for (const float far : {1e4f, 1e30f, FLT_MAX, -FLT_MAX}) {
        Scene scene = two_blocks(r, 5, 2.0, true);
        for (Mesh& mesh : scene.meshes()) {
            mesh.positions[r.below(std::uint32_t(mesh.positions.size()))].x = far;
            mesh.positions[r.below(std::uint32_t(mesh.positions.size()))] = {far, -far, far};
        }
        check_exactly(scene, "a vertex far away");
    }
}
END_TEST

START_TEST(slivers) {
    Random r{7};
    Scene scene = two_blocks(r, 5, 2.0, true);
    for (Mesh& mesh : scene.meshes())
        for (int i = 0; i < 3; ++i) { // a thousand edges long, next to nothing wide
            const auto v = std::uint32_t(mesh.positions.size());
            for (int c = 0; c < 4; ++c)
                mesh.positions.push_back(
                    {c == 3 ? 1000.0f : r.uniform(-1, 1), r.uniform(2, 2.1), r.uniform(2, 2.1)});
            mesh.tets.push_back({{v, v + 1, v + 2, v + 3}});
        }
    check_exactly(scene, "slivers");

    Scene flat; // a body squeezed to a sheet
    for (int i = 0; i < 2; ++i) {
        Mesh mesh = block(6, 6, 3);
        jitter(mesh, 0.1, r);
        for (Vec3f& p : mesh.positions) p.z *= 1e-3f;
        flat.add(std::move(mesh), true);
    }
    check_exactly(flat, "sheets");
}
END_TEST

START_TEST(odd_meshes) {
    Random r{8};
    Scene scene;
    Mesh& a = scene.add(block(4, 4, 4), true);
    jitter(a, 0.1, r);
    for (int i = 0; i < 40; ++i) a.tets.push_back(a.tets[r.below(320)]); // the same tet again
    for (int i = 0; i < 20; ++i)
        a.positions.push_back(a.positions[r.below(100)]); // loose, coincident vertices
    for (int i = 0; i < 20; ++i) {                        // a corner named twice
        Tet tet = a.tets[r.below(320)];
        tet.v[r.below(4)] = tet.v[r.below(4)];
        a.tets.push_back(tet);
    }
    for (int i = 0; i < 30; ++i) { // tets all over the body: tiles that reach across it
        Tet tet{};
        for (std::uint32_t& v : tet.v) v = r.below(100);
        a.tets.push_back(tet);
    }
    Mesh points; // no tets at all
    for (int i = 0; i < 500; ++i)
        points.positions.push_back({r.uniform(-1, 5), r.uniform(-1, 5), r.uniform(-1, 5)});
    scene.add(points, true);
    scene.add(Mesh{}, true);
    Mesh one;
    one.positions = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4}};
    one.tets = {{{0, 1, 2, 3}}};
    scene.add(one, true);
    Mesh single;
    single.positions = {{0.5f, 0.5f, 0.5f}};
    scene.add(single);
    Mesh star; // 70 tets around one vertex
    star.positions.push_back({2, 2, 2});
    for (int i = 0; i < 70; ++i) {
        const auto v = std::uint32_t(star.positions.size());
        for (int c = 0; c < 3; ++c)
            star.positions.push_back({r.uniform(0, 4), r.uniform(0, 4), r.uniform(0, 4)});
        star.tets.push_back({{0, v, v + 1, v + 2}});
    }
    scene.add(star, true);
    check_exactly(scene, "odd meshes");
}
END_TEST

START_TEST(random_soups) {
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        Random r{seed * 77 + 5};
        Scene scene;
        const std::uint32_t bodies = 1 + r.below(4);
        const double grid = r.below(3) == 0 ? 0.5 : 0;
        for (std::uint32_t b = 0; b < bodies; ++b) {
            Mesh mesh;
            const std::uint32_t vertices = 4 + r.below(60), tets = r.below(80);
            for (std::uint32_t v = 0; v < vertices; ++v) {
                Vec3f p{r.uniform(-2, 2), r.uniform(-2, 2), r.uniform(-2, 2)};
                if (grid > 0) p = {std::round(p.x * 2) / 2, std::round(p.y * 2) / 2, std::round(p.z * 2) / 2};
                if (r.below(100) == 0) p.x = r.any_finite();
                if (r.below(200) == 0) p = {r.any_finite(), r.any_finite(), r.any_finite()};
                mesh.positions.push_back(p);
            }
            for (std::uint32_t t = 0; t < tets; ++t) {
                Tet tet{};
                for (std::uint32_t& v : tet.v) v = r.below(vertices);
                mesh.tets.push_back(tet);
            }
            scene.add(std::move(mesh), r.below(2));
        }
        check_exactly(scene, "random soup");
    }
}
END_TEST

// Larger ones, against the reference engine.
START_TEST(larger_bodies) {
    Random r{9};
    double radius = 0;
    Scene scene;
    for (int i = 0; i < 5; ++i) {
        Mesh mesh = ball(8000, &radius);
        jitter(mesh, 0.15, r);
        move(mesh, 1, i % 2 * 1.8 * radius, i / 2 * 1.7 * radius, 0.3 * i);
        if (i % 2) renumber(mesh, r);
        scene.add(std::move(mesh), i < 3);
    }
    Mesh fine = ball(20000, &radius); // five times finer than the rest, and deep inside
    move(fine, 0.2, 2, 1, 0.5);
    scene.add(std::move(fine), true);
    Mesh folded = block(60, 4, 4); // through itself
    jitter(folded, 0.1, r);
    for (Vec3f& p : folded.positions) {
        const double angle = p.x * 0.16, around = 6 + p.y;
        p = {float(around * std::cos(angle)), float(around * std::sin(angle)), float(p.z + 0.3 * angle)};
    }
    scene.add(std::move(folded), true);
    scene.prepare();
    check_scene(scene, run_reference(scene, 1.3), "larger bodies");
}
END_TEST

// ---- borders --------------------------------------------------------------------------------------

START_TEST(strided_positions) {
    Random r{10};
    Scene scene = two_blocks(r, 5, 2.0, true);
    scene.prepare();
    const std::vector<Key> expected = brute_force(scene.bodies());
    for (const std::size_t stride : {std::size_t{16}, std::size_t{13}, std::size_t{40}}) {
        std::vector<std::vector<std::byte>> copies;
        for (std::size_t b = 0; b < 2; ++b) {
            const Mesh& mesh = scene.meshes()[b];
            // Exactly as long as it has to be, and off the alignment of a float.
            std::vector<std::byte> copy((mesh.positions.size() - 1) * stride + sizeof(Vec3f) + 1);
            for (std::size_t v = 0; v < mesh.positions.size(); ++v)
                std::memcpy(copy.data() + 1 + v * stride, &mesh.positions[v], sizeof(Vec3f));
            copies.push_back(std::move(copy));
        }
        for (std::size_t b = 0; b < 2; ++b) scene.bodies()[b].positions = {copies[b].data() + 1, stride};
        check_scene(scene, expected, "strided positions");
    }
}
END_TEST

START_TEST(non_finite_positions) {
    Random r{11};
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                            -std::numeric_limits<float>::infinity()})
        for (int axis = 0; axis < 3; ++axis)
            for (const std::uint32_t vertex :
                 {0u, 63u, 64u, 200u, 215u}) { // of 216: the last block is not full
                Scene scene = two_blocks(r, 5, 2.0, false);
                Vec3f& p = scene.meshes()[1].positions[vertex];
                (axis == 0 ? p.x : axis == 1 ? p.y : p.z) = bad;
                scene.prepare();
                std::string texts[2];
                for (int engine = 0; engine < 2; ++engine) try {
                        FastEngine fast(std::pmr::get_default_resource());
                        if (engine == 0)
                            run_reference(scene, 1);
                        else
                            run_fast(fast, scene, 1);
                    } catch (const Error& error) {
                        ck_assert_int_eq(error.result(), VOX_ERROR_NON_FINITE);
                        texts[engine] = error.what();
                    }
                ck_assert_str_ne(texts[0].c_str(), "");
                ck_assert_str_eq(texts[1].c_str(), texts[0].c_str());
            }
}
END_TEST

START_TEST(steady_state_allocates_nothing) {
    Random r{12};
    Scene scene = two_blocks(r, 8, 2.0, true);
    scene.prepare();
    CountingMemory memory;
    FastEngine engine(&memory);
    vox::Array<Hit> hits(&memory);
    vox::Counters counters{};
    vox::Profile profile{};
    std::size_t allocations = 0;
    for (int step = 0; step < 4; ++step) {
        if (step == 1) allocations = memory.allocations;
        hits.clear();
        engine.detect(scene.bodies(), scene.prepared(), {}, hits, counters, profile);
    }
    ck_assert_uint_gt(allocations, 0);
    ck_assert_uint_eq(memory.allocations, allocations);
}
END_TEST

// A small cell, a body all over the place, a vertex at the end of the world: the window stays small.
START_TEST(memory_is_bounded) {
    Random r{13};
    Scene scene = two_blocks(r, 7, 2.0, true);
    scene.meshes()[0].positions[5] = {1e30f, -1e30f, 1e30f};
    Mesh spread = block(7, 7, 7);
    for (Vec3f& p : spread.positions)
        p = {p.x + r.uniform(-1e6, 1e6), p.y + r.uniform(-1e6, 1e6), p.z + r.uniform(-1e6, 1e6)};
    scene.add(std::move(spread), true);
    scene.prepare();
    const std::vector<Key> expected = brute_force(scene.bodies());
    for (const double cell_size : {0.0, 1e-30, 1e-6, 1e30}) {
        CountingMemory memory;
        FastEngine engine(&memory);
        ck_assert(run_fast(engine, scene, cell_size) == expected);
        ck_assert_uint_lt(memory.peak, 160u << 10); // it takes 96 KiB: 1500 vertices, 5000 tets
    }
}
END_TEST

// Vertices at the end of the world must not put all others into one cell.
START_TEST(outliers_do_not_fill_a_cell) {
    Random r{14};
    Scene scene = two_blocks(r, 14, 14, true);
    for (Mesh& mesh : scene.meshes())
        for (int i = 0; i < 20; ++i)
            mesh.positions[r.below(std::uint32_t(mesh.positions.size()))] = {r.uniform(-1e20, 1e20), 1e12f,
                                                                             -1e30f};
    scene.prepare();
    FastEngine engine(std::pmr::get_default_resource());
    vox::Counters counters{};
    ck_assert(run_fast(engine, scene, 0, &counters) == run_reference(scene, 1.3));
    ck_assert_uint_lt(counters.fullest_cell, 200); // of 6750 vertices
}
END_TEST

// Clumps far apart in one body: the same hits, and no clump in a cell of its own.
START_TEST(clumps_far_apart) {
    Random r{15};
    for (int kind = 0; kind < 3; ++kind) {
        Mesh meshes[2];
        const int clumps = kind == 0 ? 2 : kind == 1 ? 60 : 24;
        for (int i = 0; i < clumps; ++i) {
            const double far = kind == 2 ? std::ldexp(4.0, i) : 1e6;
            const double x = r.uniform(-far, far), y = r.uniform(-far, far), z = r.uniform(-far, far);
            for (int b = 0; b < 2; ++b) {
                const int n = kind == 0 ? 8 : 5;
                Mesh mesh = block(n, n, n);
                jitter(mesh, 0.1, r);
                move(mesh, 1, x + b * 0.4 * n, y, z);
                append(meshes[b], mesh);
            }
        }
        Scene scene;
        for (Mesh& mesh : meshes) scene.add(std::move(mesh), true);
        if (kind == 0) {
            check_exactly(scene, "two clumps far apart");
        } else {
            scene.prepare();
            check_scene(scene, run_reference(scene, 1.3), "clumps far apart");
        }
        CountingMemory memory;
        FastEngine engine(&memory);
        vox::Counters counters{};
        (void)run_fast(engine, scene, 0, &counters);
        ck_assert_uint_lt(counters.fullest_cell, 129);
        ck_assert_uint_lt(counters.visited_entries, 40 * scene.bodies()[0].tets.size());
        ck_assert_uint_lt(memory.peak, 8u << 20); // 25000 vertices, 75000 tets at most
    }
}
END_TEST

} // namespace

SUITE(fast) {
    TCase* tests = add_case(suite, "hits");
    tcase_add_each(tests, two_bodies, numbering_does_not_matter, snapped_to_a_grid, coincident_bodies,
                   inverted_tets, every_size_and_place, vertices_far_away, slivers, odd_meshes, random_soups,
                   larger_bodies, strided_positions, non_finite_positions, steady_state_allocates_nothing,
                   memory_is_bounded, outliers_do_not_fill_a_cell, clumps_far_apart);
}
