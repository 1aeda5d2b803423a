// Steps of a grid with constraints and 1, 2, 4 and 8 workers, whose tasks run one by one on this thread, so
// that an instruction counter can tell what is within a task from what is not: workers.py runs this program
// and reads the counts.
#include "hard_scenes.hpp"
#include "program.hpp"
#include "scenes.hpp"
#include "scenes/counters.h"

#include <vox/vox.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <string>

#if defined(__GNUC__)
#define KEEP __attribute__((noinline, used))
#else
#define KEEP
#endif

// The names that workers.py looks for.
extern "C" {

KEEP void bench_task(vox_task* task, std::uint64_t begin, std::uint64_t end, std::uint32_t worker,
                     void* context) {
    task(begin, end, worker, context);
}

KEEP void bench_step(vox_grid* grid) { bench::must(vox_grid_step(grid)); }

} // extern "C"

namespace {

constexpr std::uint32_t worker_counts[] = {1, 2, 4, 8};

struct Workers {
    std::uint32_t count;
};

// Four ranges a worker, as schedulers make that even out what ranges take.
void* enqueue(vox_task* task, std::uint64_t items, std::uint64_t min_range, void* context, void* user) {
    const std::uint32_t workers = static_cast<const Workers*>(user)->count;
    const std::uint64_t most = items / std::max<std::uint64_t>(min_range, 1);
    const std::uint64_t ranges = std::clamp<std::uint64_t>(most, 1, 4 * workers);
    for (std::uint64_t i = 0; i < ranges; ++i)
        bench_task(task, items * i / ranges, items * (i + 1) / ranges,
                   static_cast<std::uint32_t>(i % workers), context);
    return nullptr; // all done
}

void finish(void*, void*) {}

int run(int argc, char** argv) {
    const std::string name = argc > 1 ? argv[1] : "";
    std::vector<bench::SceneMaker> makers = bench::scene_makers("");
    std::ranges::move(bench::hard_scene_makers(), std::back_inserter(makers));
    const auto maker = std::ranges::find(makers, name, &bench::SceneMaker::name);
    if (argc != 3 || maker == makers.end()) {
        std::fputs("usage: bench_workers SCENE TETS\n", stderr);
        return 2;
    }
    bench::Scene scene = maker->make(std::strtod(argv[2], nullptr), false);

    Workers workers{1};
    const vox_task_system tasks{enqueue, finish, &workers};
    vox_grid_desc desc = vox_default_grid_desc();
    desc.flags = VOX_GRID_CONSTRAINTS;
    desc.tasks = &tasks;
    desc.worker_count = 1;
    vox_grid* grid = nullptr;
    bench::must(vox_grid_create(&desc, &grid));
    for (const bench::Body& body : scene.bodies) {
        const vox_mesh_desc mesh = body.desc();
        vox_body id;
        bench::must(vox_mesh_insert(grid, &mesh, &id));
    }
    std::uint64_t hash = 0;
    for (const std::uint32_t count : worker_counts) {
        workers.count = count;
        bench::must(vox_grid_set_worker_count(grid, count));
        // A step to make room for so many workers, then one that is counted; always the same two frames.
        scene.pose(0);
        bench::must(vox_grid_step(grid));
        scene.pose(1);
        bench_step(grid);
        const std::uint64_t first = hash;
        bench::must(vox_grid_get_hash(grid, &hash));
        if (count > 1 && hash != first)
            throw std::runtime_error("the contacts depend on the number of workers");
    }
    grid_counts counters{};
    counters = counters_of(grid);
    std::printf("%s: %zu tets, %llu contacts, %llu penetrations\n", scene.name.c_str(), scene.tet_count(),
                static_cast<unsigned long long>(counters.contacts),
                static_cast<unsigned long long>(counters.penetrations));
    vox_grid_destroy(grid);
    return 0;
}

} // namespace

int main(int argc, char** argv) {
    return bench::run_program("bench_workers", [&] { return run(argc, argv); });
}
