// vox replay: runs steps of the grid in a snapshot, for bug reports.
#include "commands.hpp"
#include "failure.hpp"
#include "grid.hpp"
#include "options.hpp"
#include "output_file.hpp"
#include "paths.hpp"
#include "report.hpp"
#include "results_file.hpp"
#include "snapshot_file.hpp"
#include "terminal.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <numeric>

namespace tool {

namespace {

struct ReplayOptions {
    std::vector<std::string> files;
    GridOptions grid;
    std::uint32_t steps = 1;
    std::string out;
    bool json = false;
};

bool is_series(const std::string& out) { return has_ending(out, ".pvd"); }

// The name of the file of one step of a series: run_0007.vtu for run.pvd.
std::string file_in_series(const std::string& out, std::size_t index) {
    char number[32];
    std::snprintf(number, sizeof number, "_%04zu.vtu", index);
    return out.substr(0, out.size() - 4) + number;
}

std::uint64_t shape_count(const vox_grid* grid) {
    std::uint64_t count = 0;
    check(vox_grid_get_bodies(grid, nullptr, 0, &count));
    std::vector<vox_body> bodies(count);
    check(vox_grid_get_bodies(grid, bodies.data(), count, &count));
    return static_cast<std::uint64_t>(std::ranges::count_if(bodies, [&](vox_body body) {
        vox_body_info info{};
        info.struct_size = sizeof info;
        check(vox_body_get_info(grid, body, &info));
        return info.shape != VOX_SHAPE_NONE;
    }));
}

void print_replay(const ReplayOptions& options, const std::string& file, std::uint64_t epoch,
                  const vox_grid* grid) {
    const Counters counters = counters_of(grid);
    const auto count = [&](const char* name) { return llu(value_of(counters, name)); };
    const std::uint64_t shapes = shape_count(grid);
    std::printf("%s: %llu meshes, ", shown(file).c_str(), count("bodies") - llu(shapes));
    if (shapes > 0) std::printf("%llu %s, ", llu(shapes), shapes == 1 ? "shape" : "shapes");
    std::printf("%llu vertices, %llu tetrahedra, saved at epoch %llu\n", count("vertices"), count("tets"),
                llu(epoch));
    std::printf("%llu %s, hash %s, cell size %.9g, last of %u %s in %.3f ms\n", count("contacts"),
                count("contacts") == 1 ? "contact" : "contacts", hexadecimal(hash_of(grid)).c_str(),
                info_of(grid).cell_size, options.steps, options.steps == 1 ? "step" : "steps",
                static_cast<double>(info_of(grid).step_ns) * 1e-6);
}

void check_replay_usage(const ReplayOptions& options) {
    if (options.out.empty()) return;
    if (options.files.size() > 1 && !is_series(options.out))
        throw WrongUsage(
            "--output: several snapshots make a series; expected a name that ends with .pvd, found " +
            options.out);
    check_output(options.out, {".pvd", ".vtu", ".msh", ".html"});
}

void run_replay(const ReplayOptions& options) {
    check_replay_usage(options);
    GridOptions settings = options.grid;
    Progress progress;
    std::vector<Json> grids;
    std::vector<std::string> series;
    std::vector<std::uint64_t> times;
    for (std::size_t i = 0; i < options.files.size(); ++i) {
        const std::string& file = options.files[i];
        if (options.files.size() > 1)
            progress.show("snapshot " + std::to_string(i + 1) + " of " +
                          std::to_string(options.files.size()));
        const Snapshot snapshot = load_snapshot(file, settings.grid_desc());
        vox_grid* const grid = snapshot.grid.get();
        const std::uint64_t epoch = info_of(grid).epoch;
        for (std::uint32_t step = 0; step < options.steps; ++step) check(vox_grid_step(grid));
        if (!options.out.empty()) {
            const std::string drawing = is_series(options.out) ? file_in_series(options.out, i) : options.out;
            check(vox_grid_find_constraints(grid, nullptr));
            write_results(drawing, drawn_meshes(snapshot.bytes), grid);
            series.push_back(utf8_of(path_of(drawing).filename()));
            times.push_back(epoch);
        }
        if (!options.json) {
            progress.hide();
            print_replay(options, file, epoch, grid);
            continue;
        }
        Json json = {{"file", file},
                     {"saved_epoch", epoch},
                     {"steps", options.steps},
                     {"cell_size", info_of(grid).cell_size}};
        json.add("contact_count", contacts_of(grid).size());
        add_result(json, grid, counters_of(grid));
        grids.push_back(json);
    }
    progress.hide();
    // Files with the same time would be drawn over each other.
    if (std::adjacent_find(times.begin(), times.end(), std::greater_equal<>()) != times.end())
        std::iota(times.begin(), times.end(), 0u);
    if (is_series(options.out)) write_file(options.out, pvd_series(series, times));
    if (options.json) print(grids.size() == 1 ? grids.front() : Json{{"snapshots", Json::array_of(grids)}});
}

} // namespace

void add_replay(CommandLine& line) {
    static constexpr Choice<Engine> engines_of_replay[] = {{"auto", Engine::automatic},
                                                           {"reference", Engine::reference}};
    const auto options = std::make_shared<ReplayOptions>();
    Command command = line.add("replay", "Run steps of the grids in snapshots");
    command.option("FILE", options->files, "Snapshots written by collide --save or vox_grid_save").required();
    command.option("--steps", options->steps, "Number of steps to run").range(1, 1000000);
    command.choice("--engine", options->grid.engine, engines_of_replay,
                   "Algorithm; auto: that of the snapshot");
    add_threads(command, options->grid);
    command
        .option("-o,--output", options->out,
                "Write meshes, contacts and constraints: .vtu, .msh or .html, or a series of snapshots, .pvd")
        .shown_as("FILE");
    command.flag("--json", options->json, "Print one JSON object");
    command.examples("  vox replay grid.vox\n  vox replay grid.vox --json");
    command.runs([options] { run_replay(*options); });
}

} // namespace tool
