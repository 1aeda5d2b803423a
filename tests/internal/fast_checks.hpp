// Hits of both engines and of brute force in exact arithmetic, and checks that they are the same.
#pragma once

#include "base/array.hpp"
#include "base/simd.hpp"
#include "exact/predicates.hpp"
#include "internal/fast_scenes.hpp"
#include "reference/engine.hpp"

#include "support/suite.h"

inline std::vector<Key> brute_force(const std::vector<vox::Body>& bodies) {
    std::vector<vox::Hit> hits;
    std::uint64_t exact_tests = 0;
    for (std::uint32_t b = 0; b < bodies.size(); ++b)
        for (std::uint32_t t = 0; t < bodies[b].tets.size(); ++t) {
            const vox::Tet& tet = bodies[b].tets[t];
            vox::Vec3f q[4];
            for (int c = 0; c < 4; ++c) q[c] = bodies[b].positions[tet.v[c]];
            for (std::uint32_t a = 0; a < bodies.size(); ++a) {
                if (a == b && !bodies[a].self_collision) continue;
                for (std::uint32_t v = 0; v < bodies[a].vertex_count; ++v) {
                    if (a == b && std::count(tet.v, tet.v + 4, v)) continue;
                    const vox::Containment where =
                        vox::locate(bodies[a].positions[v], q[0], q[1], q[2], q[3], exact_tests);
                    if (where != vox::Containment::boundary && where != vox::Containment::interior) continue;
                    vox::Hit hit{};
                    hit.body_a = a;
                    hit.vertex = v;
                    hit.body_b = b;
                    hit.tet = t & 0x7fffffffu;
                    hit.interior = where == vox::Containment::interior;
                    hits.push_back(hit);
                }
            }
        }
    return keys(hits);
}

inline std::vector<Key> run_fast(vox::FastEngine& engine, Scene& scene, double cell_size,
                                 vox::Counters* out = nullptr) {
    vox::Array<vox::Hit> hits(std::pmr::get_default_resource());
    vox::Counters counters{};
    vox::Profile profile{};
    vox::FastSettings settings;
    settings.cell_size = cell_size;
    engine.detect(scene.bodies(), scene.prepared(), settings, hits, counters, profile);
    if (out) *out = counters;
    return keys(hits);
}

inline std::vector<Key> run_reference(Scene& scene, double cell_size) {
    vox::Array<vox::Hit> hits(std::pmr::get_default_resource());
    vox::Counters counters{};
    vox::Profile profile{};
    vox::ReferenceSettings settings;
    settings.cell_size = cell_size;
    vox::ReferenceEngine engine(std::pmr::get_default_resource());
    engine.detect(scene.bodies(), settings, hits, counters, profile);
    return keys(hits);
}

inline constexpr vox::simd::Level levels[] = {vox::simd::Level::portable, vox::simd::Level::sse4,
                                              vox::simd::Level::avx2, vox::simd::Level::avx512};

// The fast engine gives `expected` at every level and cell size, with the same counters at every level.
inline void check_scene(Scene& scene, const std::vector<Key>& expected, const char* name, double edge = 1) {
    vox::FastEngine engine(std::pmr::get_default_resource());
    for (const double cells : {0.0, 0.3, 1.0, 3.0, 1e4}) {
        vox::Counters first{};
        for (const vox::simd::Level level : levels) {
            if (vox::simd::force_level(level) != level) continue; // not on this machine
            vox::Counters counters{};
            const std::vector<Key> found = run_fast(engine, scene, cells * edge, &counters);
            ck_assert_msg(found == expected, "%s, cell size %g, %s: %zu hits, expected %zu", name,
                          cells * edge, vox::simd::level_name(level), found.size(), expected.size());
            if (level == vox::simd::least_level) first = counters;
            ck_assert_msg(
                counters.visited_cells == first.visited_cells &&
                    counters.visited_entries == first.visited_entries &&
                    counters.candidates == first.candidates && counters.exact_tests == first.exact_tests,
                "%s, cell size %g: other counters on %s", name, cells * edge, vox::simd::level_name(level));
        }
    }
    vox::simd::force_level(vox::simd::best_level());
}

// Small scenes: against brute force; the reference engine has to agree.
inline void check_exactly(Scene& scene, const char* name, double edge = 1) {
    scene.prepare();
    const std::vector<Key> expected = brute_force(scene.bodies());
    ck_assert_msg(run_reference(scene, edge) == expected, "%s: the reference engine differs", name);
    check_scene(scene, expected, name, edge);
}
