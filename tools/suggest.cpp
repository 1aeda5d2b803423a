// vox suggest: finds the best cell size for a set of meshes and explains it.
#include "body.hpp"
#include "commands.hpp"
#include "curve_svg.hpp"
#include "failure.hpp"
#include "foreign.hpp"
#include "options.hpp"
#include "output_file.hpp"
#include "report.hpp"
#include "terminal.hpp"

#include <algorithm>
#include <cstdio>

namespace tool {

namespace {

struct SuggestOptions {
    Reading reading;
    std::vector<std::string> files;
    vox_cell_size_desc desc = vox_default_cell_size_desc();
    std::string svg; // path of the picture to write; empty: none
    bool self = false, calibrate = false, json = false;
    ForeignOptions foreign;
};

constexpr Choice<vox_cost_model> models[] = {{"paper", VOX_COST_MODEL_PAPER},
                                             {"reference", VOX_COST_MODEL_REFERENCE},
                                             {"fast", VOX_COST_MODEL_FAST},
                                             {"surface", VOX_COST_MODEL_SURFACE}};

std::string model_words(vox_cost_model model) {
    return model == VOX_COST_MODEL_PAPER ? "cost model of the paper"
           : model == VOX_COST_MODEL_SURFACE
               ? "cost model of surface pairs"
               : "cost model of the " + std::string(model_name(model)) + " engine";
}

// Whom a cell size is for.
const char* user_of(vox_cost_model model) {
    switch (model) {
    case VOX_COST_MODEL_PAPER:
        return "the paper's algorithm (the default engine chooses its own: leave cell_size at 0)";
    case VOX_COST_MODEL_REFERENCE:
        return "the reference engine";
    case VOX_COST_MODEL_FAST:
        return "the fast engine";
    case VOX_COST_MODEL_SURFACE:
        break;
    }
    return "surface pairs";
}

void print_suggest(const vox_cell_size_result& found, vox_cost_model model, const vox_geometry& geometry,
                   std::size_t mesh_count) {
    const double mean_edge = geometry.mean_edge;
    if (!collides(found)) {
        std::printf("Nothing collides: %s. Every cell size costs the engine the same, which is nothing.\n"
                    "The mean edge is %.4g. --model paper suggests a cell size from the tetrahedra alone.\n",
                    mesh_count == 1 ? "there is one mesh, and --self is not given"
                                    : "the boxes of the meshes do not meet",
                    mean_edge);
        return;
    }
    char words[160];
    std::snprintf(words, sizeof words, "Suggested cell size %.4g, %.2f mean edges", found.cell_size,
                  found.cell_size / mean_edge);
    std::printf("%s, for %s.\n", emphasised(words).c_str(), user_of(model));
    std::printf("Between %.4g and %.4g the predicted cost stays near its minimum.\n\n", found.zone_min,
                found.zone_max);
    print_reasons(found, mean_edge);
    std::printf("\n%zu %s, %llu vertices, %llu tetrahedra, mean edge %.4g, mean facet area %.4g.\n",
                mesh_count, mesh_count == 1 ? "mesh" : "meshes", llu(geometry.vertices), llu(geometry.tets),
                mean_edge, geometry.mean_facet_area);
    std::printf("%.4g cells along an edge of the world; predicted cost ", found.cells_per_axis);
    if (model == VOX_COST_MODEL_PAPER)
        std::printf("%.4g cell visits a tetrahedron.\n", found.cost);
    else
        std::printf("%.4g ms a %s.\n", found.cost * 1e3,
                    model == VOX_COST_MODEL_SURFACE ? "search, of the grid alone" : "step");
}

void run_suggest(const SuggestOptions& options) {
    if (!options.svg.empty()) check_output(options.svg);
    if (options.files.empty() && options.foreign.tune.empty()) throw WrongUsage("MESH is required");
    std::vector<Body> bodies;
    std::vector<vox_mesh_desc> meshes;
    for (const std::string& file : options.files) bodies.push_back(load_body(file, {}, options.reading));
    const bool has_tets =
        std::any_of(bodies.begin(), bodies.end(), [](const Body& body) { return body.view.tet_count > 0; });
    if (!has_tets && options.desc.model == VOX_COST_MODEL_SURFACE)
        throw Failure("--model surface is for the surfaces of tetrahedra, and there are none");
    if (options.foreign.any() || !has_tets) // not for a grid of vox
        return suggest_foreign(options.foreign, bodies, options.desc.zone_loss, options.svg, options.json);
    for (const Body& body : bodies) meshes.push_back(mesh_desc(body));
    if (options.self)
        for (vox_mesh_desc& mesh : meshes) mesh.filter.flags |= VOX_FILTER_SELF_COLLISION;
    vox_cell_size_desc desc = options.desc;
    auto weights = sized<vox_cost_weights>();
    if (options.calibrate) {
        check(vox_cost_calibrate(&weights));
        desc.weights = &weights;
    }
    auto found = sized<vox_cell_size_result>();
    check(vox_suggest_cell_size(&desc, meshes.data(), meshes.size(), &found));
    auto geometry = sized<vox_geometry>();
    check(vox_measure_geometry(meshes.data(), meshes.size(), &geometry));
    if (!options.svg.empty()) {
        if (!collides(found))
            throw Failure(options.svg + ": nothing collides, so that there is no cost to draw");
        write_file(options.svg,
                   curve_svg(found, {"Predicted cost over cell size",
                                     short_names(options.files) + "; " + model_words(desc.model)}));
    }
    if (!options.json) return print_suggest(found, desc.model, geometry, meshes.size());
    Json json = Json::object();
    json.add("meshes", body_list(bodies));
    add_suggestion(json, found, desc.model, geometry);
    print(json);
}

} // namespace

void add_suggest(CommandLine& line) {
    const auto options = std::make_shared<SuggestOptions>();
    vox_cell_size_desc& desc = options->desc;
    Command command = line.add("suggest", "Find the best cell size for meshes and explain it");
    command.option("MESH", options->files, "Mesh files: tetrahedra, surfaces or points");
    add_reading(command, options->reading);
    command.choice("--model", desc.model, models, "Cost model to minimise");
    command
        .option("--p-nc", desc.p_nc,
                "Probability that a tetrahedron has no collision, between 0 and 1; 0.99 if not given")
        .fraction();
    command
        .option("--ratio", desc.cost_ratio,
                "Cost of a particle test divided by the cost of a cell visit; 5 if not given")
        .positive();
    command
        .option("--world", desc.world_edge,
                "Edge of the cubic world, for the cells per axis; 0: longest side of the bounds")
        .not_negative();
    command
        .option("--zone-loss", desc.zone_loss,
                "Relative loss of predicted cost that ends the zone; 0.05 if not given")
        .not_negative();
    command.flag("--self", options->self, "The bodies also collide with themselves");
    command.flag("--calibrate", options->calibrate,
                 "First measure on this machine the costs that the engines' models use");
    add_foreign(command, options->foreign);
    command.option("--svg", options->svg, "Write the cost curve as a picture to this file");
    command.flag("--json", options->json, "Print one JSON object");
    command.examples(
        "  vox suggest bunny.msh\n  vox suggest cloud.ply --points --radius 0.1 --grid point-voxels");
    command.runs([options] { run_suggest(*options); });
}

} // namespace tool
