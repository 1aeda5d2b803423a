// Many points at once (vox_locator_find_point_hits), beside one by one: which tetrahedra they are in, for
// points and meshes from harmless to as bad as can be.
//
//   bench_points [--tets N] [--rounds K]
//
// A line for each mesh, kind of points and number of points: ns a point at once and one by one (least of K
// rounds, one thread), and a hash of all hits. The hits at once are compared with those one by one. To
// compare two versions of the library, run the program with each by turns (LD_LIBRARY_PATH).
#include "internal/meshes.hpp"
#include "program.hpp"
#include "timing.h"

#include <vox/vox_query.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

namespace {

using bench::must;
using vox::Vec3d;
using vox::Vec3f;
using vox::test::Mesh;

constexpr std::size_t most_singly = 2000; // points that are also asked one by one

struct Scene {
    std::string name;
    std::vector<Mesh> bodies;
    double radius; // of all, around the origin
};

// Long thin tetrahedra in all directions: the box of each reaches across much of the scene.
Mesh needles(std::size_t tets, Random& random) {
    Mesh mesh;
    const auto number = [&random] { return float(random.uniform(-1, 1)); };
    for (std::uint32_t t = 0; t < tets; ++t) {
        const Vec3f at{number(), number(), number()}, way{number(), number(), number()};
        for (std::uint32_t c = 0; c < 4; ++c) {
            const float along = float(c) / 3, thin = 1e-4f;
            mesh.positions.push_back({at.x + along * way.x + thin * number(),
                                      at.y + along * way.y + thin * number(),
                                      at.z + along * way.z + thin * number()});
        }
        mesh.tets.push_back({{4 * t, 4 * t + 1, 4 * t + 2, 4 * t + 3}});
    }
    return mesh;
}

std::vector<Scene> make_scenes(double tets, Random& random) {
    std::vector<Scene> scenes;
    for (const double count : {tets / 16, tets}) {
        double radius = 0;
        Mesh ball = vox::test::jittered(vox::test::ball(count, &radius), random, 0.15f);
        scenes.push_back({"ball " + std::to_string(ball.tets.size()), {std::move(ball)}, radius});
    }
    // Fine in one place, coarse around it.
    Mesh graded = scenes.back().bodies[0];
    for (Vec3f& p : graded.positions) {
        const float r = std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z) / float(scenes.back().radius);
        p = {p.x * r * r * r, p.y * r * r * r, p.z * r * r * r};
    }
    scenes.push_back({"graded", {std::move(graded)}, scenes.back().radius});
    scenes.push_back({"needles", {needles(std::size_t(tets / 16), random)}, 2});
    Scene crumbs{"crumbs", {}, 16};
    for (std::size_t i = 0; i < std::size_t(tets / 64); ++i) {
        Mesh crumb = vox::test::block(1, 1, 1);
        move(crumb, 0.7, 16 * random.uniform(-1, 1), 16 * random.uniform(-1, 1), 16 * random.uniform(-1, 1));
        crumbs.bodies.push_back(std::move(crumb));
    }
    scenes.push_back(std::move(crumbs));
    return scenes;
}

constexpr const char* kinds[] = {"anywhere",  "floats", "inside", "in rows", "cluster", "two clusters",
                                 "one place", "line",   "far",    "around",  "facets",  "vertices"};

std::vector<Vec3d> make_points(const Scene& scene, const std::string& kind, std::size_t count,
                               Random& random) {
    const double r = scene.radius;
    const auto anywhere = [&](double size) {
        return Vec3d{size * random.uniform(-1, 1), size * random.uniform(-1, 1),
                     size * random.uniform(-1, 1)};
    };
    const auto moved = [](const Vec3d& a, const Vec3d& b) { return Vec3d{a.x + b.x, a.y + b.y, a.z + b.z}; };
    std::vector<Vec3d> points;
    for (std::size_t i = 0; i < count; ++i) {
        const Mesh& body = scene.bodies[random.below(std::uint32_t(scene.bodies.size()))];
        const vox::Tet& tet = body.tets[random.below(std::uint32_t(body.tets.size()))];
        Vec3d p = anywhere(r);
        if (kind == "floats") p = Vec3f{float(p.x), float(p.y), float(p.z)};
        if (kind == "inside") p = anywhere(0.55 * r);
        if (kind == "in rows") {
            const auto n = std::size_t(std::ceil(std::cbrt(double(count))));
            const auto at = [&](std::size_t k) { return r * (2 * double(k) / double(n) - 0.99); };
            p = {at(i % n), at(i / n % n), at(i / n / n)};
        }
        if (kind == "cluster") p = moved({0.2 * r, 0.1 * r, 0}, anywhere(0.01 * r));
        if (kind == "two clusters") p = moved({i % 2 ? 0.5 * r : -0.5 * r, 0.1 * r, 0}, anywhere(0.01 * r));
        if (kind == "one place") p = {0.2 * r, 0.1 * r, 0};
        if (kind == "line") p = {p.x, 0.1 * r, 0.05 * r};
        if (kind == "far") p = moved({100 * r, 0, 0}, p);
        if (kind == "around") p = anywhere(20 * r);
        if (kind == "facets" || kind == "vertices") { // on these as exactly as doubles allow
            p = {0, 0, 0};
            for (std::size_t c = 0; c < (kind == "facets" ? 3u : 1u); ++c) {
                const Vec3d q = body.positions[tet.v[c]];
                const double weight = kind == "facets" ? (c == 0 ? 0.5 : 0.25) : 1;
                p = moved(p, {weight * q.x, weight * q.y, weight * q.z});
            }
        }
        points.push_back(p);
    }
    return points;
}

vox_locator* locator_of(const Scene& scene) {
    vox_grid_desc settings = vox_default_grid_desc();
    settings.byte_budget = UINT64_MAX;
    settings.flags = 0;
    vox_grid* grid = nullptr;
    must(vox_grid_create(&settings, &grid));
    for (const Mesh& body : scene.bodies) {
        vox_mesh_desc desc = vox_default_mesh_desc();
        desc.positions.data = body.positions.data();
        desc.positions.count = body.positions.size();
        desc.tets = body.tets.front().v;
        desc.tet_count = body.tets.size();
        vox_body mesh = VOX_NULL_BODY;
        must(vox_mesh_insert(grid, &desc, &mesh));
    }
    vox_locator* locator = nullptr;
    must(vox_grid_update_locator(grid, &locator));
    vox_grid_destroy(grid);
    return locator;
}

std::uint64_t hash_of(const vox_point_hit* hits, std::size_t count) { // FNV-1a
    std::uint64_t hash = 0xcbf29ce484222325u;
    const auto* bytes = reinterpret_cast<const unsigned char*>(hits);
    for (std::size_t i = 0; i < count * sizeof(vox_point_hit); ++i) hash = (hash ^ bytes[i]) * 0x100000001b3u;
    return hash;
}

void time_points(const vox_locator* locator, const std::string& name, const std::vector<Vec3d>& points,
                 int rounds) {
    std::vector<vox_point_hit> hits(4 * points.size() + 64), singly;
    std::uint64_t count = 0;
    const vox_positions at = vox_double_positions(&points.data()->x, points.size());
    const auto ask = [&] {
        must(vox_locator_find_point_hits(locator, &at, nullptr, hits.data(), hits.size(), &count));
    };
    ask();
    if (count > hits.size()) {
        hits.resize(count);
        ask();
    }
    const std::size_t some = std::min(points.size(), most_singly);
    std::vector<vox_point_hit> one(hits.size());
    double together = 1e9, alone = 1e9;
    for (int round = 0; round < rounds; ++round) {
        const int times = int(1 + 4096 / points.size()); // short ones some times
        together = std::min(together, seconds_of([&] {
                                          for (int i = 0; i < times; ++i) ask();
                                      }) / times);
        singly.clear();
        alone = std::min(
            alone, seconds_of([&] {
                for (std::size_t i = 0; i < some; ++i) {
                    std::uint64_t found = 0;
                    const vox_positions p = vox_double_positions(&points[i].x, 1);
                    must(vox_locator_find_point_hits(locator, &p, nullptr, one.data(), one.size(), &found));
                    for (std::size_t h = 0; h < found && round == 0; ++h) {
                        singly.push_back(one[h]);
                        singly.back().point = std::uint32_t(i);
                    }
                }
            }));
        if (round > 0) continue;
        std::size_t same = 0;
        while (same < count && hits[same].point < some) ++same;
        if (same != singly.size() ||
            std::memcmp(hits.data(), singly.data(), same * sizeof(vox_point_hit)) != 0)
            throw std::runtime_error("hits at once are not those one by one: " + name);
    }
    std::printf("%-32s %8zu %8.0f %8.0f %9llu %016llx\n", name.c_str(), points.size(),
                1e9 * together / double(points.size()), 1e9 * alone / double(some), (unsigned long long)count,
                (unsigned long long)hash_of(hits.data(), count));
    std::fflush(stdout);
}

} // namespace

int main(int argc, char** argv) {
    bench::Size size{200000, 5};
    if (!bench::read_size(argc, argv, "bench_points", size)) return 2;
    return bench::run_program("bench_points", [&] {
        Random random{9};
        std::printf("%-32s %8s %8s %8s %9s\n", "mesh, points", "points", "at once", "alone", "hits");
        for (const Scene& scene : make_scenes(size.tets, random)) {
            vox_locator* locator = locator_of(scene);
            for (const char* kind : kinds)
                for (const std::size_t count : {32u, 256u, 2048u, 20000u, 200000u})
                    time_points(locator, scene.name + ", " + kind, make_points(scene, kind, count, random),
                                size.rounds);
            vox_locator_release(locator);
        }
        return 0;
    });
}
