// vox replay: runs steps of the grid in a snapshot, for bug reports.
#include "commands.hpp"
#include "failure.hpp"
#include "options.hpp"
#include "report.hpp"
#include "snapshot_file.hpp"
#include "stepping.hpp"

#include <cstdio>

namespace tool {

namespace {

struct Options {
    std::string file;
    vox_grid_desc grid = vox_default_grid_desc();
    std::uint32_t steps = 1;
    bool json = false;
};

std::uint64_t epoch_of(const vox_grid* grid) {
    std::uint64_t epoch = 0;
    check(vox_grid_epoch(grid, &epoch));
    return epoch;
}

void run(const Options& options) {
    const Grid grid = load_snapshot(options.file, options.grid);
    const std::uint64_t epoch = epoch_of(grid.get());
    for (std::uint32_t step = 0; step < options.steps; ++step) check(vox_grid_step(grid.get()));
    const vox_profile profile = profile_of(grid.get());
    if (options.json) {
        Json json = {{"file", options.file}, {"saved_epoch", epoch}, {"steps", options.steps}};
        json["contact_count"] = contacts_of(grid.get()).count;
        add_result(json, grid.get(), profile);
        print(json);
        return;
    }
    const vox_counters counters = counters_of(grid.get());
    std::printf("%s: %u meshes, %llu vertices, %llu tetrahedra, saved at epoch %llu\n", options.file.c_str(),
                counters.meshes, static_cast<unsigned long long>(counters.vertices),
                static_cast<unsigned long long>(counters.tets), static_cast<unsigned long long>(epoch));

    std::printf("%llu %s, hash %s, cell size %.9g, last of %u %s in %.3f ms\n",
                static_cast<unsigned long long>(counters.contacts),
                counters.contacts == 1 ? "contact" : "contacts", hash_of(grid.get()).c_str(),
                cell_size_of(grid.get()), options.steps, options.steps == 1 ? "step" : "steps",
                static_cast<double>(profile.step_ns) * 1e-6);
}

} // namespace

void add_replay(CommandLine& line) {
    const auto options = std::make_shared<Options>();
    Command command = line.add("replay", "Run steps of the grid in a snapshot");
    command.option("FILE", options->file, "Snapshot written by collide --save").required();
    command.option("--steps", options->steps, "Number of steps to run").range(1u, 1000000u);
    command.choice("--engine", options->grid.engine, engines, "Algorithm; auto: that of the snapshot");
    add_threads(command, options->grid);
    command.flag("--json", options->json, "Print one JSON object");
    command.runs([options] { run(*options); });
}

} // namespace tool
