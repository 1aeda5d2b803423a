// vox resolve: moves meshes that overlap apart and writes them.
#include "body.hpp"
#include "commands.hpp"
#include "failure.hpp"
#include "options.hpp"
#include "output_file.hpp"
#include "paths.hpp"
#include "report.hpp"
#include "terminal.hpp"

#include <vox/vox_sim.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <set>

namespace tool {

namespace {

struct ResolveOptions {
    std::vector<std::string> files, fixed;
    std::string out;
    double gap = 0, max_move = 0;
    std::uint32_t threads = 1;
    std::uint32_t iterations = 0;
    std::uint64_t limit = 10;
    Reading reading;
    bool json = false;
};

struct Repaired {
    std::string file, output;
    Loaded loaded;
    vox_io_mesh_view view{};
    std::vector<double> positions;
};

std::string stem_of(const std::string& file) { return utf8_of(path_of(file).stem()); }

// Files with tetrahedra become .msh, surfaces .obj, with the names of the inputs.
std::vector<Repaired> load_all(const ResolveOptions& options) {
    std::vector<Repaired> all;
    std::set<std::string> outputs;
    for (const std::string& file : options.files) {
        Repaired one;
        one.file = file;
        one.loaded = load_mesh(file, options.reading);
        say_warnings(file, one.loaded.warnings);
        check(vox_io_mesh_get_arrays(one.loaded.mesh.get(), &one.view));
        if (one.view.tet_count + one.view.triangle_count == 0)
            throw Failure(file + " has no triangles and no tetrahedra to move");
        one.positions.assign(one.view.positions, one.view.positions + 3 * one.view.vertex_count);
        one.output = utf8_of(path_of(options.out) /
                             path_of(stem_of(file) + (one.view.tet_count > 0 ? ".msh" : ".obj")));
        if (!options.out.empty() && !outputs.insert(one.output).second)
            throw Failure("two meshes would be written to " + one.output);
        all.push_back(std::move(one));
    }
    return all;
}

bool is_fixed(const std::string& file, const ResolveOptions& options) {
    return std::any_of(options.fixed.begin(), options.fixed.end(),
                       [&](const std::string& name) { return name == file || name == stem_of(file); });
}

vox_resolve_body body_of(Repaired& one, bool fixed) {
    vox_resolve_body body = vox_default_resolve_body();
    body.flags = fixed ? VOX_RESOLVE_FIXED : 0;
    body.positions = one.positions.data();
    body.vertex_count = one.view.vertex_count;
    body.tets = one.view.tets;
    body.tet_count = one.view.tet_count;
    if (body.tet_count > 0) return body;
    body.faces = one.view.triangles;
    body.face_count = one.view.triangle_count;
    return body;
}

void write(const Repaired& one) {
    if (one.view.tet_count > 0) {
        vox_io_mesh_view arrays = one.view;
        arrays.positions = one.positions.data();
        vox_io_mesh* made = nullptr;
        check(vox_io_mesh_create(&arrays, &made));
        const Mesh mesh(made);
        return check(vox_io_write(mesh.get(), one.output.c_str(), nullptr));
    }
    std::string text;
    char line[128];
    for (std::size_t i = 0; i < one.positions.size(); i += 3) {
        std::snprintf(line, sizeof line, "v %.17g %.17g %.17g\n", one.positions[i], one.positions[i + 1],
                      one.positions[i + 2]);
        text += line;
    }
    for (std::uint64_t t = 0; t < one.view.triangle_count; ++t) {
        const std::uint32_t* v = one.view.triangles + 3 * t;
        std::snprintf(line, sizeof line, "f %llu %llu %llu\n", llu(v[0]) + 1, llu(v[1]) + 1, llu(v[2]) + 1);
        text += line;
    }
    write_file(one.output, text);
}

void print_resolve(const std::vector<Repaired>& all, const std::vector<vox_resolve_body>& bodies,
                   const vox_resolve_report& report, const std::vector<vox_resolve_place>& places) {
    std::printf("%llu crossings before, depth %.9g; %llu left, %llu vertices inside, %llu pairs too close\n",
                llu(report.first_crossings), report.first_depth, llu(report.crossings),
                llu(report.inside_vertices), llu(report.close_pairs));
    for (std::size_t b = 0; b < all.size(); ++b) {
        std::printf("  %s: %llu of %llu vertices moved, at most %.9g", shown(all[b].file).c_str(),
                    llu(bodies[b].moved_vertices), llu(bodies[b].vertex_count), bodies[b].largest_move);
        if (bodies[b].volume_before > 0)
            std::printf(", volume %+.2g %%", 100 * (bodies[b].volume / bodies[b].volume_before - 1));
        if (bodies[b].inverted_tets > 0)
            std::printf(", %llu tetrahedra inverted", llu(bodies[b].inverted_tets));
        std::printf("\n");
    }
    const auto shown_count =
        static_cast<std::size_t>(std::min<std::uint64_t>(places.size(), report.place_count));
    for (std::size_t i = 0; i < shown_count; ++i)
        std::printf("  left: %s and %s, %.9g apart at %.9g %.9g %.9g\n",
                    shown(all[places[i].body_a].file).c_str(), shown(all[places[i].body_b].file).c_str(),
                    places[i].distance, places[i].position[0], places[i].position[1], places[i].position[2]);
    print_rest(report.place_count - shown_count);
}

Json resolve_json(const std::vector<Repaired>& all, const std::vector<vox_resolve_body>& bodies,
                  const ResolveOptions& options, const vox_resolve_report& report,
                  const std::vector<vox_resolve_place>& places) {
    Json meshes = Json::array(), left = Json::array();
    for (std::size_t b = 0; b < all.size(); ++b)
        meshes.push_back({{"file", all[b].file},
                          {"output", options.out.empty() ? Json() : Json(all[b].output)},
                          {"fixed", bodies[b].flags != 0},
                          {"vertices", bodies[b].vertex_count},
                          {"moved_vertices", bodies[b].moved_vertices},
                          {"largest_move", bodies[b].largest_move},
                          {"volume_before", bodies[b].volume_before},
                          {"volume", bodies[b].volume},
                          {"inverted_tets", bodies[b].inverted_tets},
                          {"report", report_json(all[b].loaded.report, all[b].loaded.warnings)}});
    for (std::size_t i = 0; i < std::min<std::uint64_t>(places.size(), report.place_count); ++i)
        left.push_back({{"meshes", Json::array({places[i].body_a, places[i].body_b})},
                        {"distance", places[i].distance},
                        {"position", Json::array_of(places[i].position)}});
    return {{"resolved", report.resolved != 0},        {"crossings_before", report.first_crossings},
            {"deepest_before", report.first_depth},    {"crossings", report.crossings},
            {"inside", report.inside_vertices},        {"close_pairs", report.close_pairs},
            {"least_distance", report.least_distance}, {"largest_move", report.largest_move},
            {"iterations", report.iterations},         {"meshes", meshes},
            {"place_count", report.place_count},       {"places", left}};
}

void run_resolve(const ResolveOptions& options) {
    for (const std::string& name : options.fixed)
        if (std::none_of(options.files.begin(), options.files.end(),
                         [&](const std::string& file) { return name == file || name == stem_of(file); }))
            throw WrongUsage("--fixed " + name + " names none of the meshes");
    std::vector<Repaired> all = load_all(options);
    if (!options.out.empty()) {
        std::error_code error;
        std::filesystem::create_directories(path_of(options.out), error);
        if (error) throw Failure(options.out + ": cannot be made: " + error.message());
        for (const Repaired& one : all) check_output(one.output, {});
    }
    std::vector<vox_resolve_body> bodies;
    for (Repaired& one : all) bodies.push_back(body_of(one, is_fixed(one.file, options)));
    std::vector<vox_resolve_place> places(options.limit);
    vox_resolve_desc desc = vox_default_resolve_desc();
    desc.worker_count = options.threads == 0 ? VOX_ALL_CORES : options.threads;
    desc.max_iterations = options.iterations;
    desc.gap = options.gap;
    desc.max_move = options.max_move;
    desc.places = places.data();
    desc.place_capacity = places.size();
    auto report = sized<vox_resolve_report>();
    check(vox_resolve(&desc, bodies.data(), bodies.size(), &report));
    if (!options.out.empty())
        for (const Repaired& one : all) write(one);
    if (options.json)
        print(resolve_json(all, bodies, options, report, places));
    else
        print_resolve(all, bodies, report, places);
    if (!report.resolved) throw Verdict{3};
}

} // namespace

void add_resolve(CommandLine& line) {
    const auto options = std::make_shared<ResolveOptions>();
    Command command = line.add("resolve", "Move meshes apart until none passes through another or itself");
    command.option("MESH", options->files, "Mesh files: bodies of tetrahedra, or surfaces").required();
    command.option("-o,--output", options->out, "Folder to write the moved meshes to: .msh, surfaces .obj")
        .shown_as("DIR");
    command.option("--gap", options->gap, "Least distance between parts that share no vertex").not_negative();
    command
        .option("--fixed", options->fixed, "A mesh that does not move: its file, or the name without ending")
        .each();
    command.option("--max-move", options->max_move, "No vertex moves further than this; 0: no limit")
        .not_negative();
    command.option("--max-iterations", options->iterations,
                   "Most steps for overlaps, and as many for the gap; 0: 400");
    command.option("--threads", options->threads, "Threads; 0: one per core").range(0, VOX_MAX_WORKERS);
    command.option("--limit", options->limit, "Most places to list where something is left")
        .range(0, 1000000);
    add_what_is_read(command, options->reading);
    command.flag("--json", options->json, "Print one JSON object");
    command.examples("  vox resolve liver.msh cloth.obj -o out --gap 1e-3 --fixed liver\n"
                     "  vox resolve shirt.obj --json");
    command.runs([options] { run_resolve(*options); });
}

} // namespace tool
