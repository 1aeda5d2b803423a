// vox sweep: the paper's experiment (Sect. 5), which measures the time of detection against the cell size for
// two bodies in contact.
#include "body.hpp"
#include "commands.hpp"
#include "curve_svg.hpp"
#include "experiment/experiment.hpp"
#include "experiment/fit.hpp"
#include "failure.hpp"
#include "options.hpp"
#include "output_file.hpp"
#include "paths.hpp"
#include "report.hpp"
#include "sweep_log.hpp"
#include "terminal.hpp"
#include "zone_distance.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

namespace tool {

namespace {

struct SweepOptions {
    std::string a, b;
    std::uint64_t ball = 0; // tetrahedra of the balls that replace the files; 0: files
    Reading reading;
    ExperimentSettings experiment;
    GridOptions grid;
    double world = 0;
    std::vector<double> cell_sizes, cells_per_axis;
    std::uint32_t count = 24;
    std::uint32_t rounds = 7;
    std::uint64_t seed = 1;
    std::string csv, resume, svg;
    bool force = false; // replace the file of `csv`
    bool json = false;
};

constexpr Choice<Engine> engine_choices[] = {{"reference", Engine::reference}, {"fast", Engine::fast}};

// Makes one of the paper's spheres.
Body make_ball(std::uint64_t tets) {
    vox_io_mesh* mesh = nullptr;
    check(vox_io_make_lattice_ball(tets, 1, &mesh));
    return own_body("ball of " + std::to_string(tets) + " tetrahedra", mesh);
}

ExperimentBody experiment_body(const Body& body) {
    const vox_io_mesh_view& view = body.view;
    if (view.vertex_count == 0 || view.tet_count == 0)
        throw Failure(body.name + " has " + std::to_string(view.vertex_count) + " vertices and " +
                      std::to_string(view.tet_count) + " tets, expected some of both");
    return {{view.positions, view.positions + 3 * view.vertex_count},
            {view.tets, view.tets + 4 * view.tet_count}};
}

// Measures processor time for one thread, and elapsed time for several, which share
// the work.
const char* clock_name(const GridOptions& grid) { return grid.threads == 1 ? "processor" : "wall"; }

// ---- cell sizes and samples -------------------------------------------------------------------------

struct Size {
    std::string rule; // the rule that it comes from; "" for a size of the range
    double cell_size;
    std::optional<double> time;          // in nanoseconds
    std::vector<double> rounds;          // mean over the frames in each round
    const SweepSample* sample = nullptr; // the first round's sample, for its counts
};

// The names of the library's rules here, which files of samples keep, and how the library's own begin.
constexpr std::pair<const char*, const char*> rule_names[] = {{"traditional", "mean edge"},
                                                              {"mean_edge_multiple", "2 mean edges"},
                                                              {"object_512", "512 voxels"},
                                                              {"mean_volume", "cube root of the mean volume"},
                                                              {"median_box_side", "median box side"}};

// The sizes of the range in ascending order, evenly spaced in the logarithm, and then those of the rules.
std::vector<Size> choose_sizes(const SweepOptions& options, const vox_cell_size_result& suggestion,
                               double mean_edge, double world) {
    std::array<double, 2> range = {0.5 * mean_edge, 4 * mean_edge};
    if (!options.cell_sizes.empty()) range = {options.cell_sizes[0], options.cell_sizes[1]};
    if (!options.cells_per_axis.empty())
        range = {world / options.cells_per_axis[1], world / options.cells_per_axis[0]};
    if (!(range[0] > 0) || !std::isfinite(range[1]))
        throw Failure("the range of cell sizes is " + std::to_string(range[0]) + " to " +
                      std::to_string(range[1]));
    std::vector<Size> sizes;
    for (std::uint32_t i = 0; i < options.count; ++i) {
        const double cell_size =
            i + 1 == options.count
                ? range[1]
                : range[0] * std::pow(range[1] / range[0], double(i) / (options.count - 1));
        sizes.push_back({"", cell_size, {}, {}});
    }
    sizes.push_back({"suggestion", suggestion.cell_size, {}, {}});
    for (const auto& [name, words] : rule_names)
        for (const vox_cell_size_rule& rule : std::span(suggestion.rules).first(suggestion.rule_count))
            if (rule.cell_size > 0 && std::string_view(rule.name).starts_with(words))
                sizes.push_back({name, rule.cell_size, {}, {}});
    return sizes;
}

// A size far from the optimum could take as much time as all others together, and its exact regret does not
// matter.
bool worth_measuring(const Size& size, const vox_cell_size_result& suggestion) {
    constexpr double far = 6;
    return size.rule.empty() ||
           (size.cell_size > suggestion.cell_size / far && size.cell_size < suggestion.cell_size * far);
}

std::string remaining(std::chrono::duration<double> seconds) {
    char text[32];
    const long long whole = std::llround(std::ceil(seconds.count()));
    std::snprintf(text, sizeof text, "%lld:%02lld left", whole / 60, whole % 60);
    return text;
}

void measure(const SweepOptions& options, Experiment& experiment, const vox_cell_size_result& suggestion,
             SweepLog& log, const std::vector<Size>& sizes) {
    Progress progress;
    const auto begin = std::chrono::steady_clock::now();
    const std::clock_t used = std::clock();
    const std::size_t total = sizes.size() * options.rounds;
    std::size_t done = 0, measured = 0;
    for (std::uint32_t round = 0; round < options.rounds; ++round) {
        for (const std::size_t i : order_of_round(sizes.size(), options.seed, round)) {
            const Size& size = sizes[i];
            ++done;
            if (log.find(size.cell_size, round) || !worth_measuring(size, suggestion)) continue;
            const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - begin;
            const double share = double(done) / double(total);
            progress.show(
                bar(share, 24) + " sample " + std::to_string(done) + " of " + std::to_string(total) +
                (measured == 0 ? ""
                               : ", " + remaining(passed / double(measured) * double(total - done + 1))));
            SweepSample sample = experiment.measure(size.cell_size);
            sample.name = size.rule;
            sample.round = round;
            log.add(sample);
            ++measured;
        }
    }
    if (measured > 0)
        warn_if_busy(std::chrono::steady_clock::now() - begin, double(std::clock() - used) / CLOCKS_PER_SEC);
}

void collect(const SweepOptions& options, const SweepLog& log, std::vector<Size>& sizes) {
    for (Size& size : sizes) {
        std::vector<std::vector<std::uint64_t>> times;
        for (std::uint32_t round = 0; round < options.rounds; ++round) {
            const SweepSample* sample = log.find(size.cell_size, round);
            if (!sample) break; // it was not worth measuring
            if (round == 0) size.sample = sample;
            times.push_back(sample->frame_ns);
            size.rounds.push_back(time_of_rounds({sample->frame_ns}));
        }
        if (!times.empty()) size.time = time_of_rounds(times);
    }
    std::stable_sort(sizes.begin(), sizes.end(),
                     [](const Size& x, const Size& y) { return x.cell_size < y.cell_size; });
}

// ---- evaluation -------------------------------------------------------------------------------------

struct Zone {
    double limit; // a time
    double min, max;
};

struct Evaluation {
    TimeFit fit{};
    Zone one_millisecond{}, five_percent{};
    double least_time = HUGE_VAL; // least of all measured times
};

Evaluation evaluate(const std::vector<Size>& sizes, double range_min, double range_max) {
    Evaluation result;
    std::vector<double> cell_sizes, times;
    for (const Size& size : sizes) {
        if (!size.time) continue;
        result.least_time = std::min(result.least_time, *size.time);
        if (size.cell_size < range_min || size.cell_size > range_max) continue;
        cell_sizes.push_back(size.cell_size);
        times.push_back(*size.time);
    }
    result.fit = fit_times(cell_sizes, times);
    for (auto [zone, limit] : {std::pair(&result.one_millisecond, result.fit.time + 1e6),
                               std::pair(&result.five_percent, result.fit.time * 1.05)}) {
        const FitZone found = fit_zone(result.fit, limit);
        *zone = {limit, found.min, found.max};
    }
    return result;
}

std::optional<double> time_in_range(const TimeFit& fit, double cell_size) {
    if (cell_size < fit.range_min || cell_size > fit.range_max) return {};
    return fitted_time(fit, cell_size);
}

// Eq. 9, in cells per axis.
double epsilon(double cell_size, const Evaluation& found, const Zone& zone, double world) {
    return zone_distance(world / cell_size, world / zone.max, world / found.fit.cell_size, world / zone.min);
}

std::optional<double> regret(std::optional<double> time, double best) {
    if (!time) return {};
    return *time / best - 1;
}

// ---- output -----------------------------------------------------------------------------------------

struct Sweep {
    const SweepOptions& options;
    const std::vector<Body>& bodies;
    const Experiment& experiment;
    vox_cell_size_result suggestion;
    vox_geometry geometry;
    double world;
    std::vector<Size> sizes;
    Evaluation found;
};

Json size_json(double cell_size, double world) {
    return {{"cell_size", cell_size}, {"cells_per_axis", world / cell_size}};
}

Json measured_zone(const Zone& zone, double world) {
    return {{"limit_ns", zone.limit},
            {"min", zone.min},
            {"max", zone.max},
            {"n_min", world / zone.max},
            {"n_max", world / zone.min}};
}

Json sample_json(const Size& size, const Sweep& sweep) {
    Json json = size_json(size.cell_size, sweep.world);
    json.add("rule", size.rule.empty() ? Json() : Json(size.rule));
    json.add("time_ns", size.time);
    json.add("fitted_ns", time_in_range(sweep.found.fit, size.cell_size));
    json.add("rounds_ns", Json::array_of(size.rounds));
    json.add("contacts", size.sample->contacts);
    json.add("visited_cells", size.sample->visited_cells);
    json.add("visited_entries", size.sample->visited_entries);
    json.add("candidates", size.sample->candidates);
    return json;
}

Json fit_json(const TimeFit& fit) {
    Json coefficients = Json::array();
    for (std::size_t k = 0; k <= fit.degree; ++k) coefficients.push_back(fit.coefficients[k]);
    return {{"degree", fit.degree},
            {"coefficients", coefficients},
            {"range", {{"min", fit.range_min}, {"max", fit.range_max}}},
            {"r_squared", fit.r_squared},
            {"prediction_error", fit.prediction_error},
            {"bracketed", fit.bracketed}};
}

void print_sweep_json(const Sweep& sweep) {
    const Experiment& experiment = sweep.experiment;
    const Evaluation& found = sweep.found;
    Json json = {{"meshes", body_list(sweep.bodies)}};
    json.add("engine", sweep.options.grid.engine == Engine::fast ? "fast" : "reference");
    json.add("tets", experiment.tets());
    json.add("distance", experiment.distance());
    json.add("frames", experiment.shares().size());
    json.add("rounds", sweep.options.rounds);
    json.add("clock", clock_name(sweep.options.grid));
    json.add("contacts", experiment.contacts());
    json.add("contact_share", {{"wanted", sweep.options.experiment.contact_share},
                               {"mean", experiment.mean_share()},
                               {"frames", Json::array_of(experiment.shares())}});
    json.add("hash", hexadecimal(experiment.hash()));
    json.add("world", sweep.world);
    Json samples = Json::array();
    for (const Size& size : sweep.sizes)
        if (size.time) samples.push_back(sample_json(size, sweep));
    json.add("samples", samples);
    json.add("fit", fit_json(found.fit));
    Json optimum = size_json(found.fit.cell_size, sweep.world);
    optimum.add("time_ns", found.fit.time);
    json.add("optimum", optimum);
    json.add("zone", measured_zone(found.one_millisecond, sweep.world));
    json.add("zone_5_percent", measured_zone(found.five_percent, sweep.world));
    Json epsilon_ms = Json::object(), epsilon_percent = epsilon_ms, measured = epsilon_ms,
         fitted = epsilon_ms, rules = epsilon_ms;
    for (const Size& size : sweep.sizes) {
        if (size.rule.empty()) continue;
        Json rule = size_json(size.cell_size, sweep.world);
        rule.add("time_ns", size.time);
        if (size.rule == "suggestion" || size.rule == "traditional") json.add(size.rule, rule);
        rules.add(size.rule, rule);
        epsilon_ms.add(size.rule, epsilon(size.cell_size, found, found.one_millisecond, sweep.world));
        epsilon_percent.add(size.rule, epsilon(size.cell_size, found, found.five_percent, sweep.world));
        measured.add(size.rule, regret(size.time, found.least_time));
        fitted.add(size.rule, regret(time_in_range(found.fit, size.cell_size), found.fit.time));
    }
    json.add("rules", rules);
    json.add("epsilon", epsilon_ms);
    json.add("epsilon_5_percent", epsilon_percent);
    json.add("regret", measured);
    json.add("regret_fitted", fitted);
    json.add("predicted", {{"geometry", geometry(sweep.geometry)}, {"curve", curve(sweep.suggestion)}});
    print(json);
}

void print_sweep(const Sweep& sweep) {
    const Evaluation& found = sweep.found;
    const double mean_edge = sweep.geometry.mean_edge;
    std::printf("%s against %s, %llu tetrahedra, %.2f %% of them in contact (mean over %u frames).\n\n",
                shown(sweep.bodies.front().name).c_str(), shown(sweep.bodies.back().name).c_str(),
                llu(sweep.experiment.tets()), 100 * sweep.experiment.mean_share(),
                sweep.options.experiment.frames);
    std::printf("  %12s %8s %8s %11s\n", "cell size", "edges", "n", "time (ms)");
    double most = 0;
    for (const Size& size : sweep.sizes) most = std::max(most, size.time.value_or(0));
    for (const Size& size : sweep.sizes)
        if (size.time)
            std::printf("  %12.6g %8.3f %8.2f %11.4f  %s%s%s\n", size.cell_size, size.cell_size / mean_edge,
                        sweep.world / size.cell_size, *size.time * 1e-6, bar(*size.time / most, 24).c_str(),
                        size.rule.empty() ? "" : " ", size.rule.c_str());
    std::printf(
        "\nThe fit, a polynomial of degree %zu in the logarithms, predicts a time left out to %.1f %%.\n",
        found.fit.degree, 100 * found.fit.prediction_error);
    std::printf("Best cell size %.6g, %.2f mean edges, n = %.2f: %.4f ms%s.\n", found.fit.cell_size,
                found.fit.cell_size / mean_edge, sweep.world / found.fit.cell_size, found.fit.time * 1e-6,
                found.fit.bracketed ? "" : " (at the end of the range: measure a wider one)");
    for (const auto& [words, zone] :
         {std::pair("1 ms above it", &found.one_millisecond), std::pair("5 % above it", &found.five_percent)})
        std::printf("At most %s: n = %.2f to %.2f.\n", words, sweep.world / zone->max,
                    sweep.world / zone->min);
    std::printf("\n  %-20s %8s %8s %11s %13s %12s\n", "rule", "edges", "n", "regret", "epsilon 1 ms", "5 %");
    for (const Size& size : sweep.sizes) {
        if (size.rule.empty()) continue;
        char percent[32] = "not measured";
        if (size.time)
            std::snprintf(percent, sizeof percent, "%+.1f %%", 100 * (*size.time / found.least_time - 1));
        std::printf("  %-20s %8.3f %8.2f %11s %13.3f %12.3f\n", size.rule.c_str(), size.cell_size / mean_edge,
                    sweep.world / size.cell_size, percent,
                    epsilon(size.cell_size, found, found.one_millisecond, sweep.world),
                    epsilon(size.cell_size, found, found.five_percent, sweep.world));
    }
}

const char* words_of_rule(const std::string& rule) {
    for (const auto& [name, words] : rule_names)
        if (rule == name) return words;
    return "suggested";
}

// The paper's Fig. 3: the fitted time over the cell size, the times of the sizes measured and of the rules.
std::string sweep_svg(const Sweep& sweep) {
    const TimeFit& fit = sweep.found.fit;
    auto drawn = sized<vox_cell_size_result>();
    drawn.cell_size = fit.cell_size;
    drawn.cost = fit.time;
    drawn.zone_min = sweep.found.five_percent.min;
    drawn.zone_max = sweep.found.five_percent.max;
    drawn.curve_count = VOX_CURVE_CAPACITY;
    for (std::uint32_t i = 0; i < drawn.curve_count; ++i) {
        const double size =
            fit.range_min * std::pow(fit.range_max / fit.range_min, i / (VOX_CURVE_CAPACITY - 1.0));
        drawn.curve[i] = {size, fitted_time(fit, size)};
    }
    const std::size_t every = (sweep.sizes.size() + VOX_TIMING_CAPACITY - 1) / VOX_TIMING_CAPACITY;
    for (std::size_t i = 0; i < sweep.sizes.size(); ++i) {
        const Size& size = sweep.sizes[i];
        if (!size.time) continue;
        if (size.rule.empty() && i % every == 0)
            drawn.timings[drawn.timing_count++] = {size.cell_size, *size.time};
        if (!size.rule.empty() && drawn.rule_count < VOX_RULE_CAPACITY)
            drawn.rules[drawn.rule_count++] = {words_of_rule(size.rule), size.cell_size, *size.time};
    }
    char best[96];
    std::snprintf(best, sizeof best, "; best %.4g ms at n = %.4g, fitted", fit.time * 1e-6,
                  sweep.world / fit.cell_size);
    return curve_svg(drawn, {"Time of detection over cell size",
                             short_names({sweep.bodies.front().name, sweep.bodies.back().name}) + best,
                             "time of detection in a step, ms", 1e6});
}

// ---- the command ------------------------------------------------------------------------------------

std::string engine_name(const GridOptions& grid) {
    return std::string(grid.engine == Engine::fast ? "fast" : "reference") + "/" + clock_name(grid) + "/" +
           std::to_string(static_cast<int>(grid.cells)) + "/" + std::to_string(static_cast<int>(grid.hash)) +
           "/" + std::to_string(grid.threads);
}

void check_sweep_usage(const SweepOptions& options) {
    const auto check_range = [](const std::vector<double>& range, const char* name) {
        if (!range.empty() && !(range[0] < range[1]))
            throw WrongUsage(std::string(name) + ": expected two numbers in ascending order");
    };
    if (options.a.empty() == (options.ball == 0)) throw WrongUsage("sweep needs a mesh file, or --ball");
    check_range(options.cell_sizes, "--cell-sizes");
    check_range(options.cells_per_axis, "--cells-per-axis");
    if (!options.csv.empty() && !options.force && std::filesystem::exists(path_of(options.csv)))
        throw Failure(options.csv + ": there is such a file; --resume continues it, --force replaces it");
    for (const std::string& path : {options.csv, options.resume, options.svg})
        if (!path.empty()) check_output(path);
    const std::vector<double>& axis = options.experiment.axis;
    const double length = std::hypot(axis[0], axis[1], axis[2]);
    if (length == 0 || !std::isfinite(length)) throw WrongUsage("--axis: expected a direction");
}

void run_sweep(const SweepOptions& options) {
    check_sweep_usage(options);
    std::vector<Body> bodies;
    for (const std::string& file : {options.a, options.b.empty() ? options.a : options.b})
        bodies.push_back(options.ball > 0 ? make_ball(options.ball) : load_body(file, {}, options.reading));
    ExperimentSettings settings = options.experiment;
    GridOptions grid = options.grid;
    settings.grid = grid.grid_desc();
    Experiment experiment(settings, experiment_body(bodies[0]), experiment_body(bodies[1]));

    Sweep sweep{options,
                bodies,
                experiment,
                experiment.suggest(vox_default_cell_size_desc()),
                experiment.geometry(),
                options.world,
                {},
                {}};
    if (!(sweep.world > 0)) {
        const Bounds bounds = experiment.bounds();
        for (std::size_t axis = 0; axis < 3; ++axis)
            sweep.world = std::max(sweep.world, bounds.max[axis] - bounds.min[axis]);
    }

    sweep.sizes = choose_sizes(options, sweep.suggestion, sweep.geometry.mean_edge, sweep.world);
    const double range_min = sweep.sizes.front().cell_size,
                 range_max = sweep.sizes[options.count - 1].cell_size;
    const std::string name = hexadecimal(experiment.hash()) + "/" + engine_name(options.grid);
    const std::string& path = options.resume.empty() ? options.csv : options.resume;
    SweepLog log;
    if (!path.empty()) log = SweepLog(path, name, options.experiment.frames, !options.resume.empty());
    measure(options, experiment, sweep.suggestion, log, sweep.sizes);
    collect(options, log, sweep.sizes);
    sweep.found = evaluate(sweep.sizes, range_min, range_max);
    if (!options.svg.empty()) write_file(options.svg, sweep_svg(sweep));
    options.json ? print_sweep_json(sweep) : print_sweep(sweep);
}

} // namespace

void add_sweep(CommandLine& line) {
    const auto options = std::make_shared<SweepOptions>();
    options->grid.engine = Engine::reference;
    Command command =
        line.add("sweep", "Measure the time of detection against cell size (the paper's experiment)");
    command.option("A", options->a, "Mesh file");
    command.option("B", options->b, "Second mesh file; default: A again");
    command
        .option("--ball", options->ball, "Instead of files, use balls of radius 1 with about TETS tetrahedra")
        .shown_as("TETS")
        .range(1, VOX_MAX_TETS / 4);
    add_reading(command, options->reading);
    command.option("--axis", options->experiment.axis, "Direction X Y Z from A to B")
        .count(3)
        .shown_as("FLOAT")
        .finite();
    command.option("--share", options->experiment.contact_share, "Share of the tetrahedra in contact")
        .fraction();
    command.flag("--as-placed", options->experiment.as_placed, "Do not rotate the bodies");
    command.option("--frames", options->experiment.frames, "Number of detections in a sample").range(1, 1000);
    command.option("--time-step", options->experiment.time_step, "Duration of a frame").positive();
    command.choice("--engine", options->grid.engine, engine_choices, "Algorithm");
    add_cells(command, options->grid);
    add_threads(command, options->grid);
    command
        .option("--world", options->world, "Edge of the cubic world, for the cells per axis; 0: longest side")
        .not_negative();
    Option sizes = command.option("--cell-sizes", options->cell_sizes, "Range of cell sizes, MIN MAX");
    Option cells = command.option("--cells-per-axis", options->cells_per_axis,
                                  "Range of cell sizes given in cells per axis, MIN MAX");
    for (Option range : {sizes, cells}) range.count(2).shown_as("FLOAT").positive();
    sizes.excludes(cells);
    command.option("--count", options->count, "Number of cell sizes in the range").range(5, 10000);
    command.option("--rounds", options->rounds, "Number of samples of each cell size").range(1, 10000);
    command.option("--seed", options->seed, "Seed for the order of the samples");
    Option csv = command.option("--csv", options->csv, "Write each sample to this new file");
    command.flag("--force", options->force, "Replace the file of --csv if it exists").needs(csv);
    command.option("--resume", options->resume, "As --csv, but continue the file if it exists").excludes(csv);
    command
        .option("--svg", options->svg,
                "Draw times over the cell size, as in the paper's Fig. 3, to this file")
        .shown_as("FILE");
    command.flag("--json", options->json, "Print one JSON object");
    command.examples("  vox sweep bunny.msh --svg sweep.svg\n  vox sweep --ball 20000 --csv times.csv");
    command.runs([options] { run_sweep(*options); });
}

} // namespace tool
