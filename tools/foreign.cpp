#include "foreign.hpp"

#include "curve_svg.hpp"
#include "failure.hpp"
#include "output_file.hpp"
#include "report.hpp"

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

constexpr Choice<vox_known_grid> known_grids[] = {{"none", VOX_KNOWN_GRID_NONE},
                                                  {"sorted", VOX_KNOWN_GRID_SORTED},
                                                  {"hashed", VOX_KNOWN_GRID_HASHED},
                                                  {"warp", VOX_KNOWN_GRID_WARP},
                                                  {"ipc", VOX_KNOWN_GRID_IPC},
                                                  {"ipc-pairs", VOX_KNOWN_GRID_IPC_PAIRS},
                                                  {"vtk", VOX_KNOWN_GRID_VTK},
                                                  {"pbat", VOX_KNOWN_GRID_PBAT},
                                                  {"point-voxels", VOX_KNOWN_GRID_POINT_VOXELS},
                                                  {"numpy", VOX_KNOWN_GRID_NUMPY}};

// ---- primitives of files --------------------------------------------------------------------------

struct Primitives {
    std::vector<double> positions;
    std::vector<std::uint32_t> indices; // empty: points
    vox_primitives desc = vox_default_primitives();
    const char* word = "points";
};

// The primitives of all bodies together: of the requested kind, or else tetrahedra, triangles or points.
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

// ---- the user's program ----------------------------------------------------------------------

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
    bool quiet; // shows only failures
    std::uint32_t runs = 0;
};

#if defined(_WIN32)
std::FILE* open_output(const std::string& command) { return _wpopen(path_of(command).c_str(), L"r"); }
int close_output(std::FILE* output) { return _pclose(output); }
#else
std::FILE* open_output(const std::string& command) { return popen(command.c_str(), "r"); }
int close_output(std::FILE* output) { return pclose(output); }
#endif

// Runs the command once. Returns the seconds on the last line that it prints, or else those that it took.
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

void print_suggestion(const vox_cell_size_result& found, const Primitives& stored) {
    std::printf(
        "Suggested cell size %.4g for %llu %s.\nBetween %.4g and %.4g the predicted cost stays near its "
        "minimum.\n\n",
        found.cell_size, llu(stored.desc.count), stored.word, found.zone_min, found.zone_max);
    print_reasons(found);
}

void print_tuning(const vox_cell_size_result& found) {
    std::printf(
        "Best cell size %.4g: %.4g s a run, after %u runs. At most about %.1f %% slower than the best "
        "there is.\nBetween %.4g and %.4g a run takes nearly as little.\n\n",
        found.cell_size, found.cost, found.timing_count, 100 * found.expected_loss, found.zone_min,
        found.zone_max);
    print_reasons(found);
}

} // namespace

void add_foreign(Command& command, ForeignOptions& options) {
    command.choice("--grid", options.known, known_grids,
                   "For another library's grid, or one of your own: which of these it resembles");
    command.flag("--points", options.points, "The grid stores the vertices of the files");
    command.flag("--triangles", options.triangles, "The grid stores the triangles of the files");
    command.option("--querying", options.querying,
                   "Mesh file whose elements are the queries; else the stored ones query each other");
    command.option("--radius", options.radius, "Grows the boxes of the queries by this much").not_negative();
    command.option(
        "--tune", options.tune,
        "Run this command, {} standing for the cell size, to find the best size. Its last line may be "
        "the seconds it took");
    command.option("--max-runs", options.max_runs, "Most runs of --tune").range(3, VOX_TIMING_CAPACITY);
    command.option("--first", options.first, "Cell size at which --tune begins; needed without a MESH")
        .positive();
}

void suggest_foreign(const ForeignOptions& options, const std::vector<Body>& bodies, double zone_loss,
                     const std::string& svg, bool json) {
    if (options.points && options.triangles) throw WrongUsage("--points and --triangles exclude each other");
    if (!options.tune.empty() && options.tune.find("{}") == std::string::npos)
        throw WrongUsage("--tune: the command does not say where the cell size goes: {}");
    if (bodies.empty() && !(options.first > 0)) throw WrongUsage("--tune without a MESH needs --first SIZE");
    Primitives stored, querying;
    vox_foreign_grid grid = vox_default_foreign_grid();
    grid.known = options.known.value_or(VOX_KNOWN_GRID_NONE);
    grid.radius = options.radius;
    grid.zone_loss = zone_loss;
    if (!bodies.empty()) {
        gather(bodies, options, stored);
        grid.stored = &stored.desc;
    }
    if (!options.querying.empty()) {
        std::vector<Body> those;
        for (const std::string& file : options.querying) those.push_back(load_body(file));
        gather(those, options, querying);
        grid.querying = &querying.desc;
    }
    std::vector<std::string> files;
    for (const Body& body : bodies) files.push_back(body.name);
    std::string words = short_names(files);
    auto found = sized<vox_cell_size_result>();
    const bool tune = !options.tune.empty();
    if (tune) {
        vox_tune_desc desc = vox_default_tune_desc();
        desc.max_runs = options.max_runs;
        desc.first = options.first;
        Program program{options.tune, json};
        check(vox_foreign_grid_tune(bodies.empty() ? nullptr : &grid, &desc, run_program, &program, &found));
        words += (words.empty() ? "" : "; ") + ("fitted to " + std::to_string(found.timing_count)) + " runs";
    } else {
        check(vox_foreign_grid_suggest(&grid, &found));
        words += std::string("; a grid of ") + stored.word;
    }
    if (!svg.empty()) write_file(svg, curve_svg(found, {"Predicted cost over cell size", words}));
    if (!json) return tune ? print_tuning(found) : print_suggestion(found, stored);
    Json all = Json::object();
    if (!bodies.empty()) all.add("meshes", body_list(bodies));
    add_suggestion(all, found);
    if (!bodies.empty()) all.add("primitives", {{"type", stored.word}, {"count", stored.desc.count}});
    print(all);
}

} // namespace tool
