// The core over a C++ heap that fails: every allocation in turn, in the life of a grid without an allocator
// of its own, with queries and suggestions, whose temporary memory always comes from the heap.
#include "scenes/bodies.h"
#include "support/failing_heap.hpp"

#include <vox/vox_query.h>

namespace {

// A task system that runs everything in enqueue, in two ranges on two workers.
void* enqueue(vox_task* task, std::uint64_t items, std::uint64_t, void* context, void*) {
    task(0, items / 2, 0, context);
    task(items / 2, items, 1, context);
    return nullptr;
}
void finish(void*, void*) {}

constexpr std::size_t point_count = 300;

struct Scene {
    body box = make_box(3, 0.25f, 0, 0, 0), other = make_box(3, 0.25f, 0.4f, 0.3f, 0.2f);
    double many[point_count][3]; // along a diagonal of the boxes
    Scene() {
        for (std::size_t i = 0; i < point_count; ++i)
            many[i][0] = many[i][1] = many[i][2] = 1.2 * double(i) / double(point_count) - 0.1;
    }
    ~Scene() {
        free_body(&box);
        free_body(&other);
    }
};

// What a program holds, and releases whatever has failed.
struct Held {
    vox_grid* grid = nullptr;
    vox_grid* loaded = nullptr;
    vox_locator* locator = nullptr;
    void* bytes = nullptr;
    ~Held() {
        vox_grid_destroy(grid);
        vox_grid_destroy(loaded);
        vox_locator_release(locator);
        std::free(bytes);
    }
};

void live(const Scene& scene, const vox_grid_desc& desc, heap::Life& life) {
    Held held;
    vox_body meshes[2];
    if (!life([&] { return vox_grid_create(&desc, &held.grid); })) return;
    for (int i = 0; i < 2; ++i) {
        vox_mesh_desc mesh = body_desc(i == 0 ? &scene.box : &scene.other);
        mesh.flags = VOX_MESH_COPY_POSITIONS;
        mesh.filter.flags = VOX_FILTER_SELF_COLLISION;
        if (!life([&] { return vox_mesh_insert(held.grid, &mesh, &meshes[i]); })) return;
    }
    vox_filter filter{};
    filter.flags = VOX_FILTER_SELF_COLLISION;
    filter.self_rings = 1;
    filter.self_rest_distance = 0.01;
    const std::uint32_t cut[] = {3, 9};
    const vox_vertices_desc grown = vox_default_vertices_desc();
    const double corners[2][3] = {{0.5, 0.4, 0.3}, {3, 2, 1}};
    const vox_positions one = vox_double_positions(corners[0], 1), far = vox_double_positions(corners[1], 1);
    const vox_positions many = vox_double_positions(scene.many[0], point_count);
    const vox_positions from = vox_double_positions(scene.many[0], point_count / 2);
    const vox_positions to = vox_double_positions(scene.many[point_count / 2], point_count / 2);
    vox_closest_hit closest[point_count];
    std::uint8_t blocked[point_count / 2];
    vox_cell_size_result suggestion;
    suggestion.struct_size = sizeof suggestion;
    std::uint64_t count = 0;
    std::uint32_t first = 0;
    vox_constraint_desc by_closest = vox_default_constraint_desc();
    by_closest.method = VOX_DEPTH_METHOD_CLOSEST;
    const auto step = [&] { return vox_grid_step(held.grid); };
    const auto cut_tets = [&] { return vox_mesh_set_tets_enabled(held.grid, meshes[1], cut, 2, 0); };
    const bool done =
        life([&] { return vox_body_set_filter(held.grid, meshes[0], &filter); }) && life(step) &&
        life([&] { return vox_grid_find_constraints(held.grid, &by_closest); }) &&
        life([&] { return vox_grid_update_locator(held.grid, &held.locator); }) &&
        life([&] { return vox_locator_find_point_hits(held.locator, &one, nullptr, nullptr, 0, &count); }) &&
        life([&] { return vox_locator_find_point_hits(held.locator, &many, nullptr, nullptr, 0, &count); }) &&
        life([&] { return vox_locator_find_closest(held.locator, &many, nullptr, closest); }) && life([&] {
            return vox_locator_find_box_hits(held.locator, &one, &far, nullptr, nullptr, 0, &count);
        }) &&
        life([&] {
            return vox_locator_find_ray_hits(held.locator, &from, &to, nullptr, nullptr, 0, &count);
        }) &&
        life([&] { return vox_locator_test_rays(held.locator, &from, &to, nullptr, blocked); }) &&
        life([&] { return vox_grid_update_locator(held.grid, &held.locator); }) && life(cut_tets) &&
        life(step) && life([&] { return vox_mesh_append_vertices(held.grid, meshes[1], &grown, &first); }) &&
        life([&] { return vox_mesh_append_tets(held.grid, meshes[1], scene.other.tets, 1, &first); }) &&
        life(step) && life([&] { return vox_grid_set_pair_enabled(held.grid, meshes[0], meshes[1], 0); }) &&
        life(step) && life([&] { return vox_grid_set_pair_enabled(held.grid, meshes[0], meshes[1], 1); }) &&
        life([&] { return vox_grid_set_flags(held.grid, VOX_GRID_CONSTRAINTS); }) &&
        life([&] { return vox_grid_reserve(held.grid, 4, 1000); }) && life(step) &&
        life([&] { return vox_grid_suggest_cell_size(held.grid, nullptr, &suggestion); });
    if (!done) return;
    std::uint64_t size = 0;
    if (!life([&] { return vox_grid_save(held.grid, nullptr, 0, &size); })) return;
    held.bytes = std::malloc(size);
    if (!life([&] { return vox_grid_save(held.grid, held.bytes, size, &size); })) return;
    if (!life([&] { return vox_grid_load(held.bytes, size, &desc, &held.loaded); })) return;
    if (!life([&] { return vox_grid_step(held.loaded); })) return;
    std::uint64_t hash = 0;
    ck_ok(vox_grid_get_hash(held.grid, &hash));
    ck_ok(vox_grid_get_hash(held.loaded, &life.hash));
    ck_assert_uint_eq(hash, life.hash);
}

START_TEST(each_allocation_of_a_grid) {
    const Scene scene;
    for (const std::uint32_t workers : {1u, 2u}) {
        vox_grid_desc desc = engine_desc();
        desc.worker_count = workers;
        const vox_task_system tasks{enqueue, finish, nullptr};
        if (workers > 1) desc.tasks = &tasks;
        heap::fail_each([&](heap::Life& life) { live(scene, desc, life); });
    }
}
END_TEST

START_TEST(each_allocation_of_a_suggestion) {
    const Scene scene;
    const vox_mesh_desc meshes[] = {body_desc(&scene.box), body_desc(&scene.other)};
    for (const vox_cost_model model :
         {VOX_COST_MODEL_PAPER, VOX_COST_MODEL_REFERENCE, VOX_COST_MODEL_FAST, VOX_COST_MODEL_SURFACE})
        heap::fail_each([&](heap::Life& life) {
            vox_cell_size_desc desc = vox_default_cell_size_desc();
            desc.model = model;
            vox_cell_size_result suggestion;
            suggestion.struct_size = sizeof suggestion;
            if (life([&] { return vox_suggest_cell_size(&desc, meshes, 2, &suggestion); }))
                std::memcpy(&life.hash, &suggestion.cell_size, sizeof life.hash);
        });
}
END_TEST

void add_tests(TCase* tests) { tcase_add_each(tests, each_allocation_of_a_grid); }

} // namespace

SUITE(heap) {
    add_for_each_engine(suite, add_tests);
    tcase_add_test(add_case(suite, "suggestions"), each_allocation_of_a_suggestion);
}
