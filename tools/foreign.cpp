#include "foreign.hpp"

#include "curve_svg.hpp"
#include "failure.hpp"
#include "output_file.hpp"
#include "report.hpp"
#include "terminal.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <optional>

#if defined(_WIN32)
#include "paths.hpp"
#else
#include <sys/wait.h>
#endif

namespace tool {

namespace {

constexpr Choice<vox_known_grid> known_grids[] = {{"any", VOX_KNOWN_GRID_ANY},
                                                  {"sorted", VOX_KNOWN_GRID_SORTED},
                                                  {"hashed", VOX_KNOWN_GRID_HASHED},
                                                  {"warp", VOX_KNOWN_GRID_WARP},
                                                  {"ipc", VOX_KNOWN_GRID_IPC},
                                                  {"ipc-pairs", VOX_KNOWN_GRID_IPC_PAIRS},
                                                  {"vtk", VOX_KNOWN_GRID_VTK},
                                                  {"pbat", VOX_KNOWN_GRID_PBAT},
                                                  {"point-voxels", VOX_KNOWN_GRID_POINT_VOXELS},
                                                  {"numpy", VOX_KNOWN_GRID_NUMPY}};

// ---- what the files hold --------------------------------------------------------------------------

struct Primitives {
    std::vector<double> positions;
    std::vector<std::uint32_t> indices; // empty: points
    vox_primitives desc = vox_default_primitives();
    const char* word = "points";
};

// The primitives of all bodies together: tetrahedra, else triangles, else points; or the kind that was asked
// for.
void gather(const std::vector<Body>& bodies, const ForeignOptions& options, Primitives& out) {
    bool tets = false, triangles = false;
    for (const Body& body : bodies) {
        tets = tets || body.view.tet_count > 0;
        triangles = triangles || body.view.triangle_count > 0;
        if (options.triangles && body.view.triangle_count == 0)
            throw Failure(body.name + " has no triangles");
    }
    if (options.points)
        tets = triangles = false;
    else if (options.triangles)
        tets = false;
    const std::uint32_t corners = tets ? 4 : 3;
    std::uint64_t first = 0;
    for (const Body& body : bodies) {
        const vox_io_mesh_view& view = body.view;
        out.positions.insert(out.positions.end(), view.positions, view.positions + 3 * view.vertex_count);
        const std::uint32_t* from = tets ? view.tets : view.triangles;
        const std::uint64_t count = tets ? view.tet_count : triangles ? view.triangle_count : 0;
        for (std::uint64_t i = 0; i < corners * count; ++i)
            out.indices.push_back(static_cast<std::uint32_t>(first + from[i]));
        first += view.vertex_count;
    }
    out.desc.type = tets ? VOX_PRIMITIVE_TET : triangles ? VOX_PRIMITIVE_TRIANGLE : VOX_PRIMITIVE_POINT;
    out.word = tets ? "tetrahedra" : triangles ? "triangles" : "points";
    out.desc.positions = vox_double_positions(out.positions.data(), first);
    out.desc.indices = tets || triangles ? out.indices.data() : nullptr;
    out.desc.count = tets || triangles ? out.indices.size() / corners : first;
}

// ---- a program of the user's ----------------------------------------------------------------------

std::string with_cell_size(const std::string& command, double cell_size) {
    char number[32];
    std::snprintf(number, sizeof number, "%.9g", cell_size);
    std::string text = command;
    for (std::size_t at = text.find("{}"); at != std::string::npos; at = text.find("{}", at))
        text.replace(at, 2, number);
    return text;
}

// The last line that is not blank, if it is a number.
std::optional<double> last_number(const std::string& output) {
    const std::size_t end = output.find_last_not_of(" \t\r\n");
    if (end == std::string::npos) return std::nullopt;
    const std::size_t before = output.find_last_of('\n', end);
    const std::string line =
        output.substr(before == std::string::npos ? 0 : before + 1, end + 1 - (before + 1));
    char* rest = nullptr;
    const double value = std::strtod(line.c_str(), &rest);
    while (*rest == ' ' || *rest == '\t') ++rest;
    if (rest == line.c_str() || *rest != '\0' || !std::isfinite(value)) return std::nullopt;
    return value;
}

struct Program {
    const std::string& command;
    bool quiet; // only failures are shown
    std::uint32_t runs = 0;
};

#if defined(_WIN32)
std::FILE* open_output(const std::string& command) { return _wpopen(path_of(command).c_str(), L"r"); }
int close_output(std::FILE* output) { return _pclose(output); }
#else
std::FILE* open_output(const std::string& command) { return popen(command.c_str(), "r"); }
int close_output(std::FILE* output) { return pclose(output); }
#endif

// Runs the command once. The seconds are those on the last line that it prints, or else those that it took.
double run_program(double cell_size, void* user) {
    Program& program = *static_cast<Program*>(user);
    std::fflush(nullptr);
    const auto begin = std::chrono::steady_clock::now();
    std::FILE* output = open_output(with_cell_size(program.command, cell_size));
    if (!output) {
        std::fprintf(stderr, "vox: the command cannot be run\n");
        return -1;
    }
    std::string text;
    char part[4096];
    while (const std::size_t size = std::fread(part, 1, sizeof part, output)) text.append(part, size);
    const int status = close_output(output);
    const double taken = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
#if !defined(_WIN32)
    if (WIFSIGNALED(status) && WTERMSIG(status) == SIGINT) return -1; // the user stops
#endif
    if (status != 0) {
        std::fprintf(stderr, "vox: run %u, cell size %.6g: the command failed\n", ++program.runs, cell_size);
        return std::numeric_limits<double>::infinity();
    }
    const double seconds = last_number(text).value_or(taken);
    ++program.runs;
    if (!program.quiet)
        std::fprintf(stderr, "vox: run %u, cell size %.6g: %.6g s\n", program.runs, cell_size, seconds);
    return seconds;
}

// ---- output ---------------------------------------------------------------------------------------

struct RuleWords {
    const char* name;
    double vox_foreign_rules::*field;
};
constexpr RuleWords foreign_rules[] = {{"mean_edge", &vox_foreign_rules::mean_edge},
                                       {"mean_box_side", &vox_foreign_rules::mean_box_side},
                                       {"median_box_side", &vox_foreign_rules::median_box_side},
                                       {"spacing", &vox_foreign_rules::spacing},
                                       {"radius", &vox_foreign_rules::radius}};
constexpr const char* shown_rules[] = {"mean edge", "mean box side", "median box side", "spacing", "radius"};

Json weights_json(const vox_grid_weights& w) {
    return {{"fixed", w.fixed}, {"entries", w.entries},   {"visits", w.visits}, {"found", w.found},
            {"reads", w.reads}, {"occupied", w.occupied}, {"cells", w.cells}};
}

Json zone_json(double min, double max) { return {{"min", min}, {"max", max}}; }

void print_note(const char* note) {
    if (*note) std::printf("\n%s\n", note);
}

void print_suggestion(const vox_foreign_suggestion& found, const CostCurve& curve, const Primitives& held,
                      bool json) {
    if (json) {
        Json all = Json::object();
        all.add("cell_size", found.cell_size);
        all.add("zone", zone_json(found.zone_min, found.zone_max));
        all.add("least_cell_size", found.least_cell_size);
        all.add("predicted_ns", found.predicted_cost);
        all.add("rule", found.rule == VOX_RULE_NONE ? Json() : Json(foreign_rules[found.rule - 1].name));
        all.add("note", found.note);
        all.add("primitives", {{"type", held.word}, {"count", held.desc.count}});
        const vox_grid_work& w = found.work;
        all.add("work", {{"entries", w.entries},
                         {"visits", w.visits},
                         {"empty", w.empty},
                         {"reads", w.reads},
                         {"occupied", w.occupied},
                         {"cells", w.cells}});
        all.add("weights", weights_json(found.weights));
        Json sizes = Json::object(), costs = Json::object(), terms = Json::array();
        for (const RuleWords& rule : foreign_rules) {
            sizes.add(rule.name, found.rules.*rule.field);
            costs.add(rule.name, found.rule_costs.*rule.field);
        }
        all.add("rules", sizes);
        all.add("rule_costs", costs);
        all.add("curve", tool::curve(curve.samples));
        for (std::uint32_t i = 0; i < found.term_count; ++i)
            terms.push_back({{"name", found.terms[i].name},
                             {"count", found.terms[i].count},
                             {"cost", found.terms[i].cost},
                             {"share", found.terms[i].share}});
        all.add("terms", terms);
        return print(all);
    }
    std::printf(
        "Suggested cell size %.9g for %llu %s.\nBetween %.9g and %.9g the predicted cost stays near its "
        "minimum.\n\nPredicted cost over cell size, in units of the minimum (logarithmic in cell "
        "size):\n%s\n",
        found.cell_size, static_cast<unsigned long long>(held.desc.count), held.word, found.zone_min,
        found.zone_max, cost_curve(curve).c_str());
    for (const CostCurve::Rule& rule : curve.rules)
        if (rule.cell_size > 0)
            std::printf("  %-22s %-12.9g %+7.0f %%\n", rule.name, rule.cell_size,
                        100 * (rule.cost / found.predicted_cost - 1));
    std::printf("\nWhat the cost is made of:\n");
    for (std::uint32_t i = 0; i < found.term_count; ++i)
        if (found.terms[i].cost > 0)
            std::printf("  %-22s %12.4g times %5.1f %%  %s\n", found.terms[i].name, found.terms[i].count,
                        100 * found.terms[i].share, bar(found.terms[i].share, 30).c_str());
    print_note(found.note);
}

void print_tuning(const vox_tuning& found, const CostCurve& curve, bool json) {
    if (json) {
        Json all = Json::object();
        all.add("cell_size", found.cell_size);
        all.add("zone", zone_json(found.zone_min, found.zone_max));
        all.add("seconds", found.seconds);
        all.add("expected_loss", found.expected_loss);
        all.add("noise", found.noise);
        all.add("note", found.note);
        all.add("weights", weights_json(found.weights));
        Json runs = Json::array();
        for (std::uint32_t i = 0; i < found.run_count; ++i)
            runs.push_back({{"cell_size", found.runs[i].cell_size}, {"seconds", found.runs[i].seconds}});
        all.add("runs", runs);
        all.add("curve", tool::curve(curve.samples));
        return print(all);
    }
    std::printf(
        "Best cell size %.9g: %.4g s a run, after %u runs. At most about %.1f %% slower than the best "
        "there is.\nBetween %.9g and %.9g a run takes nearly as little.\n\n%s",
        found.cell_size, found.seconds, found.run_count, 100 * found.expected_loss, found.zone_min,
        found.zone_max, cost_curve(curve).c_str());
    print_note(found.note);
}

} // namespace

void add_foreign(Command& command, ForeignOptions& options) {
    command.choice("--grid", options.known, known_grids,
                   "For another library's grid, or one of your own: which of these it resembles");
    command.flag("--points", options.points, "The grid holds the vertices of the files");
    command.flag("--triangles", options.triangles, "The grid holds the triangles of the files");
    command.option("--asked-by", options.asking,
                   "Mesh file whose elements ask the grid; else those it holds do");
    command.option("--radius", options.radius, "What asks is a ball, or a box grown by this much")
        .not_negative();
    command.option(
        "--tune", options.tune,
        "Run this command, {} standing for the cell size, to find the best size. Its last line may be "
        "the seconds it took");
    command.option("--runs", options.most_runs, "Most runs of --tune").range(3, VOX_TUNE_RUN_CAPACITY);
    command.option("--first", options.first, "Cell size at which --tune begins; needed without a MESH")
        .positive();
}

void suggest_foreign(const ForeignOptions& options, const std::vector<Body>& bodies, double zone_loss,
                     const std::string& svg, bool json) {
    if (options.points && options.triangles) throw WrongUsage("--points and --triangles exclude each other");
    if (!options.tune.empty() && options.tune.find("{}") == std::string::npos)
        throw WrongUsage("--tune: the command does not say where the cell size goes: {}");
    if (bodies.empty() && !(options.first > 0)) throw WrongUsage("--tune without a MESH needs --first SIZE");
    Primitives held, asking;
    vox_foreign_grid grid = vox_default_foreign_grid();
    check(vox_foreign_grid_set_known(&grid, options.known.value_or(VOX_KNOWN_GRID_ANY)));
    grid.radius = options.radius;
    grid.zone_loss = zone_loss;
    if (!bodies.empty()) {
        gather(bodies, options, held);
        grid.held = &held.desc;
    }
    if (!options.asking.empty()) {
        std::vector<Body> those;
        for (const std::string& file : options.asking) those.push_back(load_body(file));
        gather(those, options, asking);
        grid.asking = &asking.desc;
    }
    std::vector<std::string> files;
    for (const Body& body : bodies) files.push_back(body.name);
    const std::string names = short_names(files);
    if (!options.tune.empty()) {
        vox_tune_desc desc = vox_default_tune_desc();
        desc.most_runs = options.most_runs;
        desc.first = options.first;
        desc.zone_loss = zone_loss;
        vox_tuning found{};
        found.struct_size = sizeof found;
        Program program{options.tune, json};
        check(vox_cost_tune(bodies.empty() ? nullptr : &grid, &desc, run_program, &program, &found));
        const CostCurve curve{{found.curve, found.curve_count},
                              found.cell_size,
                              found.seconds,
                              found.zone_min,
                              found.zone_max,
                              {}};
        if (!svg.empty())
            write_file(svg, curve_svg(curve, (names.empty() ? "" : names + "; ") + "fitted to " +
                                                 std::to_string(found.run_count) + " runs"));
        return print_tuning(found, curve, json);
    }
    vox_foreign_suggestion found{};
    found.struct_size = sizeof found;
    check(vox_suggest_for(&grid, &found));
    CostCurve curve{{found.curve, found.curve_count},
                    found.cell_size,
                    found.predicted_cost,
                    found.zone_min,
                    found.zone_max,
                    {}};
    for (std::size_t i = 0; i < std::size(foreign_rules); ++i)
        curve.rules.push_back(
            {shown_rules[i], found.rules.*foreign_rules[i].field, found.rule_costs.*foreign_rules[i].field});
    if (!svg.empty()) write_file(svg, curve_svg(curve, names + "; a grid of " + held.word));
    print_suggestion(found, curve, held, json);
}

} // namespace tool
