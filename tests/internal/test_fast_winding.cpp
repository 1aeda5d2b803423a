// Self-collision with and without culling by winding numbers: the same hits and constraints of edges, those
// of the reference engine, and less work where there is nothing to find.
#include "base/array.hpp"
#include "internal/fast_checks.hpp"

#include <cstring>

using namespace vox;

namespace {

struct SelfEdges {
    std::vector<vox_constraint> constraints;
    std::uint64_t candidates;
};

SelfEdges self_edges(Scene& scene, engine_kind engine, std::uint32_t workers) {
    vox_grid_desc desc = vox_default_grid_desc();
    desc.flags = VOX_GRID_EDGES;
    use_engine(&desc, engine);
    desc.worker_count = workers;
    vox_grid* grid = grid_of(&desc);
    vox_filter filter{};
    filter.flags = VOX_FILTER_SELF_COLLISION;
    for (const Mesh& mesh : scene.meshes()) {
        vox_mesh_desc of = vox_mesh_desc_floats(&mesh.positions[0].x, mesh.positions.size(), mesh.tets[0].v,
                                                mesh.tets.size());
        of.filter = filter;
        insert_mesh(grid, &of);
    }
    ck_ok(vox_grid_step(grid));
    vox_constraint_desc bare = vox_default_constraint_desc();
    bare.method = VOX_DEPTH_METHOD_NONE;
    ck_ok(vox_grid_find_constraints(grid, &bare));
    const vox_constraint_view view = constraints_of(grid);
    SelfEdges found{{}, counters_of(grid).edge_candidates};
    for (std::uint64_t i = 0; i < view.count; ++i)
        if (view.data[i].kind == VOX_CONSTRAINT_EDGE) found.constraints.push_back(view.data[i]);
    vox_grid_destroy(grid);
    return found;
}

// What the reference engine finds, which certifies nothing, after both engines found the same.
SelfEdges check_edges(Scene& scene, const char* name, std::uint64_t* candidates = nullptr) {
    const SelfEdges expected = self_edges(scene, ENGINE_REFERENCE, 1);
    for (const std::uint32_t workers : {1u, 3u}) {
        const SelfEdges found = self_edges(scene, ENGINE_FAST, workers);
        ck_assert_msg(found.constraints.size() == expected.constraints.size() &&
                          (found.constraints.empty() ||
                           std::memcmp(found.constraints.data(), expected.constraints.data(),
                                       found.constraints.size() * sizeof(vox_constraint)) == 0),
                      "%s: %zu edges, expected %zu", name, found.constraints.size(),
                      expected.constraints.size());
        if (candidates) *candidates = found.candidates;
    }
    return expected;
}

// The vertices that a self-collision scene puts into its window, after checking the hits with and without
// culling.
std::uint64_t check_winding(Scene& scene, const char* name) {
    scene.prepare();
    const std::vector<Key> expected = run_reference(scene, 1.2);
    std::uint64_t entries = 0;
    for (const simd::Level level : levels) {
        if (simd::force_level(level) != level) continue;
        FastEngine engine(std::pmr::get_default_resource());
        for (const bool winding : {true, false}) {
            vox::Array<Hit> hits(std::pmr::get_default_resource());
            vox::Counters counters{};
            vox::Profile profile{};
            engine.detect(scene.bodies(), scene.prepared(), {0, winding}, hits, counters, profile);
            const std::vector<Key> found = keys(hits);
            ck_assert_msg(found == expected, "%s, %s, winding %d: %zu hits, expected %zu", name,
                          simd::level_name(level), winding, found.size(), expected.size());
            if (winding) entries = counters.entries;
        }
    }
    simd::force_level(simd::best_level());
    return entries;
}

Scene one_block(Mesh mesh) {
    Scene scene;
    scene.add(std::move(mesh), true);
    return scene;
}

// A bar with its ends through each other.
Mesh ring(Random& r, double turn) {
    Mesh mesh = block(70, 16, 16);
    jitter(mesh, 0.1, r);
    for (Vec3f& p : mesh.positions) {
        const double angle = p.x / 70.0 * turn, around = 14 + p.y;
        p = {float(around * std::cos(angle)), float(around * std::sin(angle)), p.z};
    }
    return mesh;
}

START_TEST(winding_culls_compact_bodies) {
    Random r{20};
    Mesh mesh = block(21, 21, 21);
    jitter(mesh, 0.1, r);
    Scene scene = one_block(mesh);
    ck_assert_uint_eq(check_winding(scene, "a block"), 0);
    for (Tet& tet : mesh.tets) // either winding
        if (r.below(2)) std::swap(tet.v[1], tet.v[3]);
    scene = one_block(mesh);
    ck_assert_uint_eq(check_winding(scene, "a block of both windings"), 0);
    renumber(mesh, r);
    move(mesh, 1e-3, 5, 5, -9);
    scene = one_block(mesh);
    ck_assert_uint_eq(check_winding(scene, "a block far away, renumbered"), 0);
    double radius = 0;
    mesh = ball(90000, &radius);
    jitter(mesh, 0.1, r);
    scene = one_block(mesh);
    const std::size_t vertices = mesh.positions.size();
    ck_assert_uint_lt(check_winding(scene, "a ball"), vertices / 4);
}
END_TEST

START_TEST(edges_of_compact_bodies_are_not_compared) {
    Random r{23};
    Mesh mesh = block(21, 21, 21);
    jitter(mesh, 0.1, r);
    Scene scene = one_block(mesh);
    std::uint64_t candidates = 1;
    const SelfEdges all = check_edges(scene, "a block", &candidates);
    ck_assert_uint_gt(all.candidates, 1000);
    ck_assert_uint_eq(candidates, 0);
}
END_TEST

// Edges of a body through its own faces, little and much, also where no vertex is inside; and pieces that
// touch in a point, along an edge and in a face.
START_TEST(winding_finds_every_edge_contact) {
    Random r{24};
    std::uint64_t found = 0;
    for (const double turn : {5.0, 6.0, 6.2831853, 6.3, 6.4, 7.0}) {
        Scene scene = one_block(ring(r, turn));
        found += check_edges(scene, "a ring").constraints.size();
    }
    ck_assert_uint_gt(found, 100);
    for (int part = 0; part < int(volume_from("VOX_WINDING_BLOCKS", 20)); ++part) {
        Mesh mesh = block(18, 17, 16);
        if (part % 2) jitter(mesh, 0.1, r);
        const auto vertices = std::uint32_t(mesh.positions.size());
        for (int i = 0; i < 1 + part % 4; ++i) { // a spike inward or outward, or a vertex on another
            Vec3f& p = mesh.positions[r.below(vertices)];
            const float far = part % 3 == 0 ? 1.0f : 6.0f;
            p = part % 5 == 0 ? mesh.positions[r.below(vertices)]
                              : Vec3f{p.x + r.uniform(-far, far), p.y + r.uniform(-far, far),
                                      p.z + r.uniform(-far, far)};
        }
        Scene scene = one_block(mesh);
        found += check_edges(scene, "a block with spikes").constraints.size();
    }
    for (int kind = 0; kind<40; kind += test_volume()> 1
                           ? 1
                           : 7) { // two blocks in one mesh, that touch or overlap a little
        Mesh mesh = block(16, 16, 16), other = block(12, 12, 12);
        const float into = kind % 4 == 0 ? 0 : kind % 4 == 1 ? 0x1p-16f : kind % 4 == 2 ? -0x1p-16f : 0.3f;
        const Vec3f by{16 - into,
                       kind % 3 == 0   ? 0.0f
                       : kind % 3 == 1 ? 15.5f
                                       : 16 - into,
                       kind < 20 ? 0.25f * float(kind) : 16 - into};
        const auto first = std::uint32_t(mesh.positions.size());
        for (const Vec3f& p : other.positions) mesh.positions.push_back({p.x + by.x, p.y + by.y, p.z + by.z});
        for (Tet tet : other.tets) {
            for (std::uint32_t& v : tet.v) v += first;
            mesh.tets.push_back(tet);
        }
        if (kind % 5 == 4)
            for (Vec3f& p : mesh.positions) { // turned, so that nothing is on the lattice
                const float x = p.x, y = p.y;
                p.x = 0.8f * x - 0.6f * y;
                p.y = 0.6f * x + 0.8f * y;
            }
        Scene scene = one_block(mesh);
        found += check_edges(scene, "two blocks").constraints.size();
    }
    ck_assert_uint_gt(found, 1000);
}
END_TEST

START_TEST(winding_turned_inside_out) {
    Random r{21};
    Mesh mesh = block(21, 21, 21);
    jitter(mesh, 0.1, r);
    Scene scene = one_block(mesh);
    scene.prepare();
    for (Vec3f& p : scene.meshes()[0].positions) p.x = -p.x; // all tets inverted after they were prepared
    const std::vector<Key> expected = run_reference(scene, 1);
    FastEngine engine(std::pmr::get_default_resource());
    ck_assert(run_fast(engine, scene, 0) == expected);
}
END_TEST

START_TEST(winding_finds_every_contact) {
    Random r{22};
    for (const double turn : {5.0, 6.0, 6.2831853, 6.4, 7.0}) { // apart, near, touching, overlapping
        Scene scene = one_block(ring(r, turn));
        check_winding(scene, "a ring");
    }
    for (int part = 0; part < 6; ++part) {
        Mesh mesh = block(21, 21, 21);
        if (part != 1) jitter(mesh, 0.1, r);
        const auto vertices = std::uint32_t(mesh.positions.size());
        if (part == 0) // some inverted
            for (int i = 0; i < 5; ++i) mesh.positions[r.below(vertices)].y += 2;
        if (part == 1) // pushed onto a neighbour: flat tets, coincident vertices
            for (int i = 0; i < 5; ++i) {
                const std::uint32_t v = r.below(vertices - 1);
                mesh.positions[v] = mesh.positions[v + 1];
            }
        if (part == 2) // loose vertices, inside and out
            for (int i = 0; i < 20; ++i)
                mesh.positions.push_back({r.uniform(-1, 22), r.uniform(-1, 22), r.uniform(-1, 22)});
        if (part == 3) { // cut in two along the lattice, the halves touching
            for (std::uint32_t v = 0; v < vertices; ++v) mesh.positions.push_back(mesh.positions[v]);
            for (std::size_t t = mesh.tets.size() / 2; t < mesh.tets.size(); ++t)
                for (std::uint32_t& v : mesh.tets[t].v) v += vertices;
        }
        if (part == 4) { // the same tet twice; a corner named twice
            mesh.tets.push_back(mesh.tets[77]);
            Tet tet = mesh.tets[99];
            tet.v[2] = tet.v[0];
            mesh.tets.push_back(tet);
        }
        if (part == 5) { // one vertex pulled out through the far side
            mesh.positions[0] = {30, 31, 32};
            mesh.positions[vertices / 2].z = -1e6f;
        }
        Scene scene = one_block(mesh);
        check_winding(scene, "a block with something wrong");
    }
    Scene scene = one_block(ring(r, 6.6)); // two bodies, both through themselves and each other
    Mesh second = ring(r, 6.9);
    move(second, 1, 10, 10, 5);
    scene.add(std::move(second), true);
    check_winding(scene, "two rings");
}
END_TEST

// A body made of two blocks that meet at one point, one edge, one face, or with a vertex in the face of the
// other.
START_TEST(winding_sees_exact_contact) {
    for (int kind = 0; kind < 6; ++kind) {
        Mesh mesh = block(20, 20, 20), other = block(20, 20, 20);
        const float x = 20,
                    y = kind == 0   ? 17.0f
                        : kind == 5 ? 0.5f
                                    : 0,
                    z = kind <= 1   ? 17.0f
                        : kind == 4 ? 19.5f
                                    : 0;
        for (Vec3f& p : other.positions) {
            p = {p.x + x, p.y + y, p.z + z};
            if (kind == 3) p.x = p.x + 0x1p-18f; // next to it
        }
        const auto vertices = std::uint32_t(mesh.positions.size());
        mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
        for (Tet tet : other.tets) {
            for (std::uint32_t& v : tet.v) v += vertices;
            mesh.tets.push_back(tet);
        }
        Scene scene = one_block(mesh);
        check_winding(scene, "two blocks that touch");
    }
}
END_TEST

} // namespace

SUITE(fast_winding) {
    TCase* tests = add_case(suite, "hits");
    tcase_add_each(tests, winding_culls_compact_bodies, winding_turned_inside_out,
                   winding_finds_every_contact, winding_sees_exact_contact,
                   edges_of_compact_bodies_are_not_compared, winding_finds_every_edge_contact);
}
