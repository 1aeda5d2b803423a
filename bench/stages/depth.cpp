// Cost of the depth stage per colliding vertex, and of what it adds to the insertion of a mesh.
//
//   bench_depth [--tets N] [--rounds K]
//
// Two balls of N / 2 tetrahedra each approach until they overlap by half; every row is one overlap. Times are
// those of grid_times, on one thread: the least of K steps in which the rows take turns, since what disturbs
// a machine only adds. Between steps the bodies move, so that no step profits from the last one's data more
// than in a simulation.
#include "internal/fast_scenes.hpp"
#include "program.hpp"
#include "scenes/counters.h"
#include "stages/smooth_ball.hpp"
#include "timing.h"

#include <vox/vox.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>

namespace {

using bench::must;

struct Row {
    const char* name;
    double overlap;    // in radii of the first ball
    double tets = 1;   // of the second ball, over those of the first
    double radius = 1; // of the second ball
    std::uint64_t depth_ns = ~std::uint64_t{0}, step_ns = ~std::uint64_t{0};
    grid_counts counters{};
};

vox_body insert(vox_grid* grid, const Mesh& mesh) {
    vox_mesh_desc desc = vox_default_mesh_desc();
    desc.positions.data = mesh.positions.data();
    desc.positions.count = mesh.positions.size();
    desc.tets = mesh.tets.front().v;
    desc.tet_count = mesh.tets.size();
    vox_body id = VOX_NULL_BODY;
    must(vox_mesh_insert(grid, &desc, &id));
    return id;
}

class Scene {
public:
    Scene(double tets, const Row& row)
        : a_(smooth_ball(tets / 2, 1)), b_(smooth_ball(tets / 2 * row.tets, row.radius)) {
        vox_grid_desc desc = vox_default_grid_desc();
        desc.flags = VOX_GRID_CONSTRAINTS;
        must(vox_grid_create(&desc, &grid_));
        for (vox::Vec3f& p : b_.positions)
            p = {p.x + float(1 + row.radius - row.overlap), p.y + 0.0123f, p.z + 0.0271f};
        insert(grid_, a_);
        insert(grid_, b_);
        must(vox_grid_step(grid_));
    }
    ~Scene() { vox_grid_destroy(grid_); }
    Scene(const Scene&) = delete;
    Scene& operator=(const Scene&) = delete;

    void step(Row& row) {
        for (vox::Vec3f& p : b_.positions) p.y = -p.y; // another pose, mirrored: as much work
        must(vox_grid_step(grid_));
        const grid_times profile = times_of(grid_);
        row.counters = counters_of(grid_);
        row.depth_ns = std::min(row.depth_ns, profile.depth_ns);
        row.step_ns = std::min(row.step_ns, profile.step_ns);
    }

private:
    Mesh a_, b_;
    vox_grid* grid_ = nullptr;
};

// Millions of tetrahedra a second, with and without what the depth stage needs.
void time_insertion(double tets, int rounds) {
    const Mesh mesh = ball(tets);
    double seconds[2] = {1e9, 1e9};
    for (int round = 0; round < rounds; ++round)
        for (std::uint32_t flags = 0; flags < 2; ++flags) {
            vox_grid_desc desc = vox_default_grid_desc();
            desc.flags = flags; // 0, or VOX_GRID_CONSTRAINTS
            vox_grid* grid = nullptr;
            must(vox_grid_create(&desc, &grid));
            const double start = now();
            insert(grid, mesh);
            seconds[flags] = std::min(seconds[flags], now() - start);
            vox_grid_destroy(grid);
        }
    const double millions = double(mesh.tets.size()) * 1e-6;
    std::printf("insertion: %.2f M tets/s, %.2f without VOX_GRID_CONSTRAINTS\n", millions / seconds[1],
                millions / seconds[0]);
}

void run(double tets, int rounds) {
    Row rows[] = {{"apart", -0.01},       {"shallow", 0.02},      {"shallow", 0.05},
                  {"shallow", 0.1},       {"deep", 0.3},          {"half", 1},
                  {"fine", 0.1, 8},       {"coarse", 0.1, 0.125}, {"enclosed", 1, 0.064, 0.4},
                  {"enclosed", 1, 1, 0.4}};
    std::vector<std::unique_ptr<Scene>> scenes;
    for (const Row& row : rows) scenes.push_back(std::make_unique<Scene>(tets, row));
    for (int round = 0; round < rounds; ++round)
        for (std::size_t i = 0; i < scenes.size(); ++i)
            for (int step = 0; step < 4; ++step) scenes[i]->step(rows[i]);
    std::printf("%-10s %8s %8s %9s %10s %8s %9s %9s %9s %8s\n", "scene", "overlap", "tets", "vertices",
                "edges", "passed", "closest", "depth ns", "ns each", "of step");
    for (const Row& row : rows) {
        const grid_counts& c = row.counters;
        const double n = double(std::max<std::uint64_t>(c.penetrations, 1));
        std::printf("%-10s %8.2f %8llu %9llu %10.2f %8.2f %9llu %9llu %9.0f %7.1f%%\n", row.name, row.overlap,
                    static_cast<unsigned long long>(c.tets), static_cast<unsigned long long>(c.penetrations),
                    double(c.leaving_edges) / n,
                    double(c.edge_tests) / double(std::max<std::uint64_t>(c.leaving_edges, 1)),
                    static_cast<unsigned long long>(c.closest_searches),
                    static_cast<unsigned long long>(row.depth_ns), double(row.depth_ns) / n,
                    100 * double(row.depth_ns) / double(row.step_ns));
    }
}

} // namespace

int main(int argc, char** argv) {
    bench::Size size{100000, 21};
    if (!bench::read_size(argc, argv, "bench_depth", size)) return 2;
    const double tets = size.tets;
    const int rounds = size.rounds;
    return bench::run_program("bench_depth", [&] {
        std::printf("depth stage: edges a vertex, tetrahedra passed an edge; least of %d rounds\n", rounds);
        run(tets, rounds);
        time_insertion(tets, rounds);
        return 0;
    });
}
