// The benchmark's entrant "vox contacts" is the grid that a user gets; "vox" is the same with constraints,
// and finds the same contacts.
#include "base/simd.hpp"
#include "entrant.hpp"
#include "hard_scenes.hpp"
#include "scenes/counters.h"
#include "support/suite.h"

#include <algorithm>
#include <cstring>

// What the entrants call instead of vox_grid_step (CMakeLists.txt): the same, and it is seen at which level.
extern "C" vox_result watched_step(vox_grid* grid);

namespace {

vox::simd::Level level_of_step;

using bench::Entrant;
using bench::Scene;

bool same(const vox_grid_desc& x, const vox_grid_desc& y) { return std::memcmp(&x, &y, sizeof x) == 0; }

START_TEST(names_and_descriptions) {
    const auto makers = bench::vox_entrants();
    ck_assert_uint_eq(makers.size(), 4);
    ck_assert_str_eq(makers[0].name.c_str(), "vox"); // first, which all others are compared with
    ck_assert_str_eq(makers[1].name.c_str(), "vox contacts");
    ck_assert_str_eq(makers[2].name.c_str(), "vox AVX2");
    ck_assert_str_eq(makers[3].name.c_str(), "vox reference");

    const vox_grid_desc usual = vox_default_grid_desc();
    ck_assert(same(bench::grid_desc("vox contacts"), usual));

    vox_grid_desc constraints = bench::grid_desc("vox");
    ck_assert(same(bench::grid_desc("vox AVX2"), constraints));
    ck_assert_uint_eq(constraints.flags, VOX_GRID_CONSTRAINTS);
    constraints.flags = usual.flags;
    ck_assert(same(constraints, usual));

    vox_grid_desc reference = bench::grid_desc("vox reference");
    ck_assert(reference.reference != nullptr);
    reference.reference = nullptr;
    ck_assert(same(reference, usual));
}
END_TEST

// A grid as a user makes it, with no description at all.
struct UserGrid {
    explicit UserGrid(const Scene& scene) {
        ck_ok(vox_grid_create(nullptr, &grid));
        for (const bench::Body& body : scene.bodies) {
            const vox_mesh_desc desc = body.desc();
            insert_mesh(grid, &desc);
        }
    }
    ~UserGrid() { vox_grid_destroy(grid); }

    vox_grid* grid = nullptr;
};

void check_steps(Scene scene) {
    UserGrid user(scene);
    std::unique_ptr<Entrant> entrants[3]; // the last one at AVX2
    const auto makers = bench::vox_entrants();
    for (std::size_t i = 0; i < 3; ++i) {
        entrants[i] = makers[i].make();
        entrants[i]->setup(scene);
    }
    for (std::size_t frame = 0; frame < scene.frame_count(); ++frame) {
        scene.pose(frame);
        ck_ok(vox_grid_step(user.grid));
        const vox::simd::Level level = vox::simd::level();
        for (auto& entrant : entrants) {
            entrant->step();
            const bool limited = entrant == entrants[2];
            ck_assert(level_of_step == (limited ? std::min(level, vox::simd::Level::avx2) : level));
            ck_assert(vox::simd::level() == level);
        }
        const std::vector<vox_contact> with = entrants[0]->contacts(), without = entrants[1]->contacts();
        ck_assert_uint_gt(with.size(), 0);
        ck_assert_uint_eq(with.size(), without.size());
        ck_assert_mem_eq(with.data(), without.data(), with.size() * sizeof(vox_contact));
        // The user's grid held the same at every moment, which it would not if it did something else in its
        // steps.
        ck_assert_uint_eq(entrants[1]->bytes(), counters_of(user.grid).bytes);
        ck_assert_uint_gt(entrants[0]->bytes(), counters_of(user.grid).bytes);
        const std::vector<vox_contact> at_avx2 = entrants[2]->contacts();
        ck_assert_uint_eq(at_avx2.size(), with.size());
        ck_assert_mem_eq(at_avx2.data(), with.data(), with.size() * sizeof(vox_contact));
    }
}

START_TEST(steps_of_a_user) {
    for (const auto& maker : bench::scene_makers(""))
        if (maker.name == "contact-1" || maker.name == "coil" || maker.name == "bodies-1k-rest")
            check_steps(maker.make(6000, false));
    for (const auto& maker : bench::hard_scene_makers()) check_steps(maker.make(2000, true));
}
END_TEST

} // namespace

vox_result watched_step(vox_grid* grid) {
    level_of_step = vox::simd::level();
    return vox_grid_step(grid);
}

SUITE(bench_entrants) {
    TCase* tests = add_case(suite, "vox");
    tcase_add_test(tests, names_and_descriptions);
    tcase_add_test(tests, steps_of_a_user);
}
