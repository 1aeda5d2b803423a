// How much work a grid's suggestion does and how much memory it allocates, both counted. A step of a small
// scene takes ten microseconds, and a suggestion should take less.
#include "base/vectors.hpp"
#include "cell_size/fast_model.hpp"
#include "cell_size/weights.hpp"
#include "grid/grid.hpp"
#include "internal/fast_scenes.hpp"
#include "mesh/sample.hpp"
#include "support/failing_heap.hpp"
#include "support/suite.h"

#include <vox/vox_cell_size.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <map>
#include <set>
#include <vector>

using namespace vox;

namespace {

using vox::test::Mesh; // of a test scene, not of a grid

std::pmr::memory_resource* const heap = std::pmr::new_delete_resource();

constexpr std::size_t sizes[] = {2500, 20000, 80000}; // tetrahedra of a body

Mesh jittered_ball(double tets, double x, std::uint64_t seed) {
    Random random{seed};
    Mesh mesh = ball(tets);
    jitter(mesh, 0.12, random);
    move(mesh, 1, x, 0.1, 0.2);
    return mesh;
}

void fill(Scene& scene, std::size_t tets, double distance, bool self) {
    scene.add(jittered_ball(double(tets), 0, 1), self);
    scene.add(jittered_ball(double(tets), distance * std::cbrt(double(tets) / 5 * 3 / (4 * 3.14159265)), 2),
              self);
    scene.prepare();
}

// ---- what is looked at ----------------------------------------------------------------------------

// The model examines about as many points near sampled tiles, and makes about as many lookups for each cell
// size, in a large scene as in a small one. This holds in light contact, deep contact and self-collision.
START_TEST(the_model_looks_at_few) {
    const double distances[] = {1.95, 0.8, 1.9};
    for (const std::size_t tets : sizes)
        for (int kind = 0; kind < 3; ++kind) {
            Scene scene;
            fill(scene, tets, distances[kind], kind == 2);
            CellSizeScene described(heap);
            described.bodies.assign(scene.bodies().begin(), scene.bodies().end());
            for (const Tiles* of : scene.tiles()) described.tiles.push_back(of);
            described.budget = quick(VOX_COST_MODEL_FAST, 2 * tets);
            described.prepare(VOX_COST_MODEL_FAST);
            const FastModel cost(described, shipped_weights);
            const std::uint64_t points = cost.points_looked_at(), looks = cost.looks_per_call();
            // All pools together: windows of unlike sizes have one each.
            ck_assert_uint_gt(points, 0);
            ck_assert_uint_gt(looks, 0);
            ck_assert_msg(points <= 6000 && looks <= 2 * described.budget.cells,
                          "%zu tets, kind %d: %llu points, %llu looks", tets, kind,
                          static_cast<unsigned long long>(points), static_cast<unsigned long long>(looks));
            if (tets == sizes[0])
                ck_assert_msg(points <= 1500, "kind %d: %llu points", kind,
                              static_cast<unsigned long long>(points));
        }
}
END_TEST

void ck_share(double estimate, double value, double tolerance, const char* what, std::size_t tets) {
    ck_assert_msg(std::abs(estimate - value) <= tolerance * value, "%zu tets, %s: %g for %g", tets, what,
                  estimate, value);
}

// vox_suggest_cell_size makes no tiles: a sketch has about as many, and what the model looks at is bounded.
START_TEST(a_suggestion_looks_at_samples) {
    for (const std::size_t tets : sizes) {
        Scene scene;
        fill(scene, tets, 1.9, true);
        CellSizeScene described(heap);
        described.bodies.assign(scene.bodies().begin(), scene.bodies().end());
        described.budget = usual(VOX_COST_MODEL_FAST, 2 * tets);
        described.prepare(VOX_COST_MODEL_FAST);
        const FastModel cost(described, shipped_weights);
        ck_assert_uint_gt(cost.points_looked_at(), 0);
        ck_assert_msg(cost.points_looked_at() <= 50000, "%zu tets: %llu points", tets,
                      static_cast<unsigned long long>(cost.points_looked_at()));
        for (std::size_t b = 0; b < 2; ++b) {
            const double sketched =
                double(described.tiles[b] ? 0 : described.step().of[b].tiles->tiles.size());
            ck_share(sketched, double(scene.tiles()[b]->tiles.size()), 0.1, "tiles", tets);
        }
    }
    ck_assert_uint_le(usual(VOX_COST_MODEL_REFERENCE, 1u << 30).summed, 8192);
    ck_assert_uint_le(usual(VOX_COST_MODEL_REFERENCE, 1u << 30).chosen, 256);
    ck_assert_uint_le(usual(VOX_COST_MODEL_FAST, 1u << 30).chosen, 128);
}
END_TEST

START_TEST(samples_of_meshes_are_small) {
    for (const std::size_t tets : sizes) {
        Scene scene;
        fill(scene, tets, 3, false);
        const std::size_t all = scene.bodies()[0].tets.size();
        const MeshSample sample = make_sample(scene.bodies()[0], kept_sample(all), heap);
        ck_assert_uint_eq(sample.tets.size(), sampled_tets(all));
        ck_assert_uint_le(sample.tets.size(), 256);
        ck_assert_uint_le(sample.edges.size(), sample.tets.size());
        ck_assert_uint_le(sample.facets.size(), sample.tets.size());
        ck_assert_uint_le(sample.boundary_facets.size(), sample.tets.size() / 2);
        ck_assert_uint_ge(sample.edges.size(), 96);
        ck_assert_uint_ge(sample.facets.size(), 96);
        ck_assert_uint_ge(sample.boundary_facets.size(), 24);
    }
    ck_assert_uint_eq(sampled_tets(0), sampled_tets(4000));
    ck_assert_uint_eq(sampled_tets(1u << 30), 256);
}
END_TEST

// Counts and means over all edges and facets, each once.
struct Exact {
    double edges = 0, facets = 0, boundary = 0;
    double mean_edge = 0, mean_facet = 0, mean_boundary = 0;
};

Exact exact(const Mesh& mesh) {
    using Facet = std::array<std::uint32_t, 3>;
    std::set<std::array<std::uint32_t, 2>> edges;
    std::map<Facet, int> facets;
    const auto at = [&](std::uint32_t v) { return Vec3d(mesh.positions[v]); };
    for (Tet tet : mesh.tets) {
        std::sort(tet.v, tet.v + 4);
        for (int i = 0; i < 4; ++i)
            for (int j = i + 1; j < 4; ++j) edges.insert({tet.v[i], tet.v[j]});
        for (int i = 0; i < 4; ++i) {
            Facet facet{};
            for (std::size_t j = 0, n = 0; j < 4; ++j)
                if (j != std::size_t(i)) facet[n++] = tet.v[j];
            ++facets[facet];
        }
    }
    Exact all;
    all.edges = double(edges.size());
    all.facets = double(facets.size());
    for (const auto& [a, b] : edges) all.mean_edge += length(at(b) - at(a)) / all.edges;
    for (const auto& [f, tets] : facets) {
        const double area = length(cross(at(f[1]) - at(f[0]), at(f[2]) - at(f[0]))) / 2;
        all.mean_facet += area / all.facets;
        all.boundary += tets == 1;
        all.mean_boundary += tets == 1 ? area : 0;
    }
    all.mean_boundary /= all.boundary;
    return all;
}

void ck_same(const MeshSample& a, const MeshSample& b) {
    ck_assert_uint_eq(a.edge_count, b.edge_count);
    ck_assert_uint_eq(a.facet_count, b.facet_count);
    ck_assert_uint_eq(a.boundary_facet_count, b.boundary_facet_count);
    ck_assert(a.unused_vertices == b.unused_vertices);
    const auto same = [](const auto& x, const auto& y) { return x.v == y.v && x.tets == y.tets; };
    ck_assert(std::ranges::equal(a.edges, b.edges, same));
    ck_assert(std::ranges::equal(a.facets, b.facets, same));
    ck_assert(std::ranges::equal(a.boundary_facets, b.boundary_facets, same));
    ck_assert(std::ranges::equal(
        a.tets, b.tets, {}, [](const Tet& t) { return std::to_array(t.v); },
        [](const Tet& t) { return std::to_array(t.v); }));
}

// The paper's model measures whole meshes of up to 200,000 tetrahedra, the others those of up to 1500. A
// sample is near the whole in any order of the tetrahedra, where few of the vertices are used, and where the
// mesh is finer in its middle. A grid's samples are smaller.
START_TEST(samples_are_near_the_whole) {
    for (const std::size_t tets :
         {std::size_t{1400}, std::size_t{4500}, std::size_t{12000}, std::size_t{60000}})
        for (int kind = 0; kind < 4; ++kind) {
            Mesh mesh = jittered_ball(double(tets), 0, 1);
            Random random{9};
            if (kind == 1)
                for (std::size_t t = mesh.tets.size() - 1; t > 0; --t)
                    std::swap(mesh.tets[t], mesh.tets[random.next() % (t + 1)]);
            if (kind == 2)
                for (Vec3f& p : mesh.positions) {
                    const float far = std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z);
                    p = {p.x * far, p.y * far, p.z * far};
                }
            if (kind == 3) mesh.positions.resize(mesh.positions.size() * 40, mesh.positions[0]);
            const Exact all = exact(mesh);
            Scene scene;
            scene.add(std::move(mesh), false);
            scene.prepare();
            CellSizeScene described(heap);
            described.bodies.assign(scene.bodies().begin(), scene.bodies().end());
            const std::size_t count = scene.bodies()[0].tets.size();
            for (const std::uint64_t most_whole : {whole_for_rules, whole_for_paper}) {
                const vox_geometry found = measure(described, most_whole).stats;
                const double near = count <= most_whole ? 1e-12 : kind == 2 ? 0.04 : 0.015;
                ck_share(double(found.edges), all.edges, 1.7 * near, "edges", count);
                ck_share(double(found.facets), all.facets, near, "facets", count);
                ck_share(double(found.boundary_facets), all.boundary, (count <= 5000 ? 12 : 10) * near,
                         "boundary facets", count);
                ck_share(found.mean_edge, all.mean_edge, near, "mean edge", count);
                ck_share(found.mean_facet_area, all.mean_facet, 2 * near, "mean facet area", count);
                ck_share(found.mean_boundary_facet_area, all.mean_boundary, 4 * near, "mean boundary facet",
                         count);
            }

            const MeshSample kept = make_sample(scene.bodies()[0], kept_sample(count), heap);
            ck_share(double(kept.edge_count), all.edges, count <= 1500 ? 0.07 : 0.05, "edges by a grid",
                     count);
            ck_share(double(kept.facet_count), all.facets, count <= 1500 ? 0.04 : 0.02, "facets by a grid",
                     count);

            // From tiles it is the same.
            Scene tiled;
            tiled.add(scene.meshes()[0], false);
            tiled.prepare();
            ck_same(kept, make_sample(tiled.bodies()[0], kept_sample(count), heap, tiled.tiles()[0]));
        }
}
END_TEST

// ---- the grid -------------------------------------------------------------------------------------

class Grid {
public:
    Grid(Scene& scene, std::uint32_t flags) {
        vox_grid_desc desc = vox_default_grid_desc();
        desc.flags = flags;
        ck_assert_int_eq(vox_grid_create(&desc, &grid), VOX_OK);
        for (const Body& body : scene.bodies()) {
            vox_mesh_desc mesh = vox_default_mesh_desc();
            mesh.positions.data = body.positions.data;
            mesh.positions.count = body.vertex_count;
            mesh.tets = body.tets[0].v;
            mesh.tet_count = body.tets.size();
            vox_body id = 0;
            ck_assert_int_eq(vox_mesh_insert(grid, &mesh, &id), VOX_OK);
            meshes.push_back(id);
        }
    }
    ~Grid() { vox_grid_destroy(grid); }
    Grid(const Grid&) = delete;
    Grid& operator=(const Grid&) = delete;

    void step() { ck_assert_int_eq(vox_grid_step(grid), VOX_OK); }
    vox_cell_size_result suggest() const {
        vox_cell_size_result found{};
        found.struct_size = sizeof found;
        ck_assert_int_eq(vox_grid_suggest_cell_size(grid, nullptr, &found), VOX_OK);
        return found;
    }

    vox_geometry geometry() const {
        CellSizeScene scene(heap);
        grid->describe(scene);
        scene.prepare(VOX_COST_MODEL_FAST);
        return scene.geometry.stats;
    }

    vox_grid* grid = nullptr;
    std::vector<vox_body> meshes;
};

void ck_same(const vox_cell_size_result& a, const vox_cell_size_result& b) {
    ck_assert_double_eq(a.cell_size, b.cell_size);
    ck_assert_double_eq(a.zone_min, b.zone_min);
    ck_assert_double_eq(a.zone_max, b.zone_max);
    ck_assert_mem_eq(&a.rules, &b.rules, sizeof a.rules);
    ck_assert_mem_eq(&a.curve, &b.curve, sizeof a.curve);
}

// The suggestion is the same with the depth stage and without. After the first one, which measures the
// meshes, the number of allocations does not grow with the scene, except for lists that double.
START_TEST(a_suggestion_allocates_little) {
    for (const std::size_t tets : sizes) {
        Scene scene;
        fill(scene, tets, 1.95, false);
        ck_assert_uint_gt(heap::calls, 0); // that the scene is made of
        Grid with(scene, VOX_GRID_CONSTRAINTS), without(scene, 0);
        for (Grid* grid : {&with, &without}) {
            for (int when = 0; when < 2; ++when) { // before the first step, and after
                (void)grid->suggest();             // looks at the meshes
                const std::uint64_t before = heap::calls;
                (void)grid->suggest();
                ck_assert_msg(heap::calls - before <= (tets == sizes[0] ? 8u : 200u),
                              "%zu tets, flags %d: %llu", tets, grid == &with,
                              static_cast<unsigned long long>(heap::calls - before));
                grid->step();
            }
        }
        ck_same(with.suggest(), without.suggest());
    }
}
END_TEST

// What the last step found is used only while it holds. After bodies moved, were inserted or were cut, the
// suggestion is that of the scene as it is now.
START_TEST(what_changed_since_the_step_counts) {
    Scene scene;
    fill(scene, sizes[0], 1.95, false);
    Grid grid(scene, 0);
    grid.step();
    const vox_cell_size_result light = grid.suggest();
    for (Mesh& mesh : scene.meshes()) // moves all and makes them larger
        for (Vec3f& p : mesh.positions) p = {2 * p.x, 2 * p.y, 2 * p.z};
    const vox_cell_size_result moved = grid.suggest();
    const vox_geometry whole = grid.geometry();
    ck_same(moved, Grid(scene, 0).suggest());
    ck_assert_double_gt(moved.cell_size, 1.5 * light.cell_size);
    grid.step();
    const vox_cell_size_result stepped = grid.suggest();
    ck_assert_double_ge(stepped.cell_size, moved.zone_min);
    ck_assert_double_le(stepped.cell_size, moved.zone_max);

    std::vector<std::uint32_t> some;
    for (std::uint32_t t = 0; t < scene.bodies()[0].tets.size(); t += 3) some.push_back(t);
    ck_assert_int_eq(vox_mesh_set_tets_enabled(grid.grid, grid.meshes[0], some.data(), some.size(), 0),
                     VOX_OK);
    const vox_geometry cut = grid.geometry();
    ck_assert_uint_eq(cut.tets, whole.tets - some.size());
    ck_assert_uint_gt(cut.boundary_facets, whole.boundary_facets);
    ck_assert_int_eq(vox_mesh_set_tets_enabled(grid.grid, grid.meshes[0], some.data(), some.size(), 1),
                     VOX_OK);
    ck_assert_uint_eq(grid.geometry().boundary_facets, whole.boundary_facets);
    ck_assert_int_eq(vox_body_remove(grid.grid, grid.meshes[1]), VOX_OK);
    ck_assert_uint_eq(grid.geometry().tets, scene.bodies()[0].tets.size());
}
END_TEST

} // namespace

SUITE(suggest_work) {
    TCase* tests = add_case(suite, "suggest_work");
    tcase_add_test(tests, the_model_looks_at_few);
    tcase_add_test(tests, a_suggestion_looks_at_samples);
    tcase_add_test(tests, samples_of_meshes_are_small);
    tcase_add_test(tests, samples_are_near_the_whole);
    tcase_add_test(tests, a_suggestion_allocates_little);
    tcase_add_test(tests, what_changed_since_the_step_counts);
}
