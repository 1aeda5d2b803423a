// The benchmark: vox's engines, other libraries and two floors on the same scenes in one process. First all
// of them must find the same contacts in every frame. Then they take turns, so that a disturbance of the
// machine affects them equally, and medians are compared.
#include "entrant.hpp"
#include "hard_scenes.hpp"
#include "results.hpp"
#include "scenes.hpp"
#include "timing.h"

#include "base/simd.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <exception>
#include <iterator>

#if defined(__linux__)
#include <sched.h>
#endif

namespace bench {
namespace {

struct Options {
    std::vector<double> tets = {84000};
    std::vector<std::string> scenes, entrants;
    std::string mesh_folder, csv, level = "avx512";
    double seconds = 2;
    std::size_t steps = 60;
    bool shuffle = false;
    bool growth = false;
    bool list = false;
};

// As vox::simd::Level; peers are as they were compiled.
const std::vector<std::string> levels = {"portable", "sse4", "avx2", "avx512"};

// For the growth of time with size: only vox, with and without depth, and the floors.
constexpr double growth_sizes[] = {1e4, 3e4, 1e5, 3e5, 1e6, 2e6, 5e6};
const std::vector<std::string> growth_scenes = {"overlap-1", "self", "overlap-50"};

struct Running {
    EntrantMaker maker;
    std::unique_ptr<Entrant> entrant;
    Result result;
    double spent = 0;
};

bool same(const std::vector<vox_contact>& x, const std::vector<vox_contact>& y) {
    static_assert(sizeof(vox_contact) == 16, "no padding");
    return x.size() == y.size() &&
           (x.empty() || std::memcmp(x.data(), y.data(), x.size() * sizeof(vox_contact)) == 0);
}

// Steps all entrants through all frames; marks those that disagree with the first one. Returns the number of
// contacts in the last frame.
std::size_t check(Scene& scene, std::vector<Running>& running) {
    std::size_t count = 0;
    for (std::size_t frame = 0; frame < scene.frame_count(); ++frame) {
        scene.pose(frame);
        std::vector<vox_contact> expected;
        const Running* first = nullptr;
        for (Running& r : running) {
            r.entrant->step();
            if (r.maker.kind == Kind::floor) continue;
            std::vector<vox_contact> found = r.entrant->contacts();
            if (!first) {
                first = &r;
                expected = std::move(found);
                count = expected.size();
            } else if (!same(found, expected)) {
                r.result.agrees = false;
                std::fprintf(stderr, "%s, frame %zu: %s finds %zu contacts, %s finds %zu, not all the same\n",
                             scene.name.c_str(), frame, r.maker.name.c_str(), found.size(),
                             first->maker.name.c_str(), expected.size());
            }
        }
    }
    return count;
}

// Times the entrants in turns. A turn has some consecutive frames, so that fast entrants find their own data
// in the caches, as in a simulation that does little else. Slow ones overflow the caches anyway and get one
// frame.
void time(Scene& scene, std::vector<Running>& running, const Options& options) {
    constexpr std::size_t frames_in_turn = 4, least_steps = 3;
    constexpr double seconds_in_turn = 0.05;
    std::size_t frame = 0;
    for (bool any = true; any;) {
        any = false;
        for (Running& r : running) {
            std::vector<double>& seconds = r.result.seconds;
            double turn = 0;
            for (std::size_t i = 0; i < frames_in_turn && turn < seconds_in_turn; ++i) {
                if (seconds.size() >= options.steps ||
                    (seconds.size() >= least_steps && r.spent > options.seconds))
                    break;
                scene.pose(frame + i);
                seconds.push_back(seconds_of([&] { r.entrant->step(); }));
                turn += seconds.back();
                r.spent += seconds.back();
                any = true;
            }
        }
        frame += frames_in_turn + 1; // slow ones get another one of few frames in each turn
    }
}

bool run(const SceneMaker& maker, double tets, const std::vector<EntrantMaker>& entrants,
         const Options& options, Csv* csv) {
    Scene scene = maker.make(tets, options.shuffle);
    std::vector<Running> running;
    for (const EntrantMaker& entrant : entrants) {
        running.push_back({entrant, entrant.make(), {entrant.name, entrant.kind, {}, 0, 0, 0, true}});
        Running& r = running.back();
        r.result.setup_seconds = seconds_of([&] { r.entrant->setup(scene); });
        r.entrant->tune(scene);
    }
    SceneResult result{scene.name,          maker.title,           scene.tet_count(), scene.vertex_count(),
                       scene.bodies.size(), check(scene, running), scene.mean_edge,   {}};
    time(scene, running, options);
    bool agree = true;
    for (Running& r : running) {
        r.result.bytes = r.entrant->bytes();
        r.result.cell_size = r.entrant->cell_size();
        agree = agree && r.result.agrees;
        result.results.push_back(std::move(r.result));
    }
    print(result);
    if (csv) csv->add(result);
    return agree;
}

// Keeps the whole process on one core, also libraries that start threads of their own.
void stay_on_one_core() {
#if defined(__linux__)
    const int core = sched_getcpu();
    if (core < 0) return;
    cpu_set_t set;
    CPU_ZERO(&set);
    CPU_SET(static_cast<std::size_t>(core), &set);
    sched_setaffinity(0, sizeof set, &set);
#endif
}

bool chosen(const std::vector<std::string>& names, const std::string& name) {
    return names.empty() || std::ranges::find(names, name) != names.end();
}

int run_all(const Options& options, const std::string& command) {
    std::vector<EntrantMaker> all;
    for (auto& part : {vox_entrants(), peers(), floors()}) all.insert(all.end(), part.begin(), part.end());
    std::vector<SceneMaker> makers = scene_makers(options.mesh_folder);
    std::ranges::move(hard_scene_makers(), std::back_inserter(makers));
    if (options.list) {
        std::puts("scenes:");
        for (const SceneMaker& maker : makers)
            std::printf("  %-18s %s\n", maker.name.c_str(), maker.title.c_str());
        std::puts("entrants:");
        for (const EntrantMaker& entrant : all) std::printf("  %s\n", entrant.name.c_str());
        return 0;
    }
    std::erase_if(all, [&](const EntrantMaker& e) { return !chosen(options.entrants, e.name); });
    std::erase_if(makers, [&](const SceneMaker& m) { return !chosen(options.scenes, m.name); });
    if (all.empty() || makers.empty())
        throw std::runtime_error("no such scene or entrant; --list shows them");

    stay_on_one_core();
    const auto level = std::ranges::find(levels, options.level) - levels.begin();
    const char* in_force = vox::simd::level_name(vox::simd::force_level(vox::simd::Level(level)));
    std::printf("%s\n%s, %s in use\n%s\n", cpu_name().c_str(), vox_build_info(), in_force, command.c_str());
    std::unique_ptr<Csv> csv;
    if (!options.csv.empty()) csv = std::make_unique<Csv>(options.csv, command);
    bool agree = true;
    for (const SceneMaker& maker : makers)
        for (double tets : options.tets) {
            agree = run(maker, tets, all, options, csv.get()) && agree;
            if (!maker.sized) break;
        }
    if (options.growth) {
        std::erase_if(all,
                      [](const EntrantMaker& e) { return e.kind == Kind::peer || e.name == reference_name; });
        for (const SceneMaker& maker : makers)
            if (std::ranges::find(growth_scenes, maker.name) != growth_scenes.end())
                for (double tets : growth_sizes) agree = run(maker, tets, all, options, csv.get()) && agree;
    }
    if (!agree) std::fputs("\nnot all entrants found the same contacts\n", stderr);
    return agree ? 0 : 1;
}

// An argument as a shell reads it.
std::string for_shell(const std::string& argument) {
    return argument.find(' ') == std::string::npos ? argument : "'" + argument + "'";
}

} // namespace
} // namespace bench

int main(int argc, char** argv) {
    bench::Options options;
    CLI::App app(
        "Times vox beside other libraries on the same scenes, and checks that all find the same contacts.");
    bool full = false;
    app.add_option("--tets", options.tets,
                   "sizes of the scenes in tetrahedra, e.g. 42000,1000000 (default 84000)")
        ->delimiter(',')
        ->check(CLI::Range(1000.0, 5e7));
    app.add_flag("--full", full, "as the documentation shows: --tets 1000000 --growth");
    app.add_flag("--growth", options.growth,
                 "also vox without the others in scenes from 10000 to 5000000 tetrahedra");
    app.add_option("--scenes", options.scenes, "names of the scenes to run (default: all)")->delimiter(',');
    app.add_option("--entrants", options.entrants, "names of the entrants to run (default: all)")
        ->delimiter(',');
    app.add_option("--meshes", options.mesh_folder,
                   "folder with bunny.msh, cow.msh and armadillo.msh, for three more scenes each")
        ->check(CLI::ExistingDirectory);
    app.add_option("--csv", options.csv, "file for the results");
    app.add_option("--seconds", options.seconds, "time for one entrant in one scene (default 2)")
        ->check(CLI::PositiveNumber);
    app.add_option("--steps", options.steps, "most steps of one entrant in one scene (default 60)")
        ->check(CLI::PositiveNumber);
    app.add_option("--level", options.level,
                   "highest instruction set that vox uses: portable, sse4, avx2 or avx512 (default)")
        ->check(CLI::IsMember(bench::levels));
    app.add_flag("--shuffle", options.shuffle, "number vertices and tetrahedra at random");
    app.add_flag("--list", options.list, "name the scenes and entrants, then stop");
    CLI11_PARSE(app, argc, argv);
    if (full) options.tets = {1e6};
    options.growth = options.growth || full;
    std::string command = "./dev bench";
    for (int i = 1; i < argc; ++i)
        if (std::strcmp(argv[i], "--csv") == 0)
            ++i; // where the results go does not change them
        else
            command += ' ' + bench::for_shell(argv[i]);
    try {
        return bench::run_all(options, command);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "vox_bench: %s\n", error.what());
        return 2;
    }
}
