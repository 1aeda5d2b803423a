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
    Fill fill;
    std::vector<std::string> files;
    vox_suggest_desc desc = vox_default_suggest_desc();
    std::string svg; // path of the picture to write; empty: none
    bool self = false, calibrate = false, json = false;
    ForeignOptions foreign;
};

constexpr Choice<vox_cost_model> models[] = {{"paper", VOX_COST_MODEL_PAPER},
                                             {"reference", VOX_COST_MODEL_REFERENCE},
                                             {"fast", VOX_COST_MODEL_FAST},
                                             {"surface", VOX_COST_MODEL_SURFACE}};
constexpr Choice<vox_size_reading> size_readings[] = {{"mean-edge", VOX_SIZE_MEAN_EDGE},
                                                      {"mean-longest-edge", VOX_SIZE_MEAN_LONGEST_EDGE},
                                                      {"mean-box-side", VOX_SIZE_MEAN_BOX_SIDE}};
constexpr Choice<vox_area_reading> area_readings[] = {{"unique-facets", VOX_AREA_UNIQUE_FACETS},
                                                      {"tet-facets", VOX_AREA_TET_FACETS},
                                                      {"boundary-facets", VOX_AREA_BOUNDARY_FACETS}};

std::string model_words(vox_cost_model model) {
    return model == VOX_COST_MODEL_PAPER ? "cost model of the paper"
           : model == VOX_COST_MODEL_SURFACE
               ? "cost model of surface pairs"
               : "cost model of the " + std::string(model_name(model)) + " engine";
}

void print_rule(const char* name, double cell_size, double cost, const vox_suggestion& found,
                const char* source) {
    if (!(cell_size > 0)) return;
    const double loss = 100 * (cost / found.predicted_cost - 1);
    std::printf("  %-22s %-12.9g %6.2f %+7.0f %%   %s\n", name, cell_size, cell_size / found.stats.mean_edge,
                loss, source);
}

// Prints every term's share of the cost, largest first.
void print_terms(const vox_suggestion& found) {
    std::vector<vox_cost_share> terms(found.terms, found.terms + found.term_count);
    std::sort(terms.begin(), terms.end(),
              [](const vox_cost_share& a, const vox_cost_share& b) { return a.cost > b.cost; });
    std::printf("\nWhat the cost is made of:\n");
    for (const vox_cost_share& term : terms)
        if (term.count > 0)
            std::printf("  %-22s %12.4g times %5.1f %%  %s\n", term.name, term.count, 100 * term.share,
                        bar(term.share, 30).c_str());
}

void print_levels(const vox_suggestion& found) {
    if (found.level_count < 2) return;
    std::printf("\nThe tetrahedra differ so much in size that %u cell sizes are best (", found.level_count);
    for (std::uint32_t i = 0; i < found.level_count; ++i) std::printf(i ? ", %.4g" : "%.4g", found.levels[i]);
    std::printf("); a single one costs %.0f %% more.\n", 100 * found.uniform_loss);
}

void print_suggest(const vox_suggestion& found, std::size_t mesh_count) {
    const double mean_edge = found.stats.mean_edge;
    if (!collides(found)) {
        std::printf("Nothing collides: %s. Every cell size costs the engine the same, which is nothing.\n"
                    "The mean edge is %.9g. --model paper suggests a cell size from the tetrahedra alone.\n",
                    mesh_count == 1 ? "there is one mesh, and --self is not given"
                                    : "the boxes of the meshes do not meet",
                    mean_edge);
        return;
    }
    std::printf("Suggested cell size %.9g, %.2f mean edges.\n", found.cell_size, found.cell_size / mean_edge);
    std::printf("Between %.9g and %.9g the predicted cost stays near its minimum.\n\n", found.zone_min,
                found.zone_max);
    std::printf("Predicted cost over cell size, in units of the minimum (logarithmic in cell size):\n%s\n",
                cost_curve(curve_of(found)).c_str());
    std::printf("  %-22s %-12s %6s %9s\n", "rule", "cell size", "edges", "cost");
    const vox_cell_size_rules& rules = found.rules;
    const vox_cell_size_rules& costs = found.rule_costs;
    print_rule("this suggestion", found.cell_size, found.predicted_cost, found, "least predicted cost");
    print_rule("mean edge", rules.mean_edge, costs.mean_edge, found, "Teschner et al. 2003");
    print_rule("mean edge, multiple", rules.mean_edge_multiple, costs.mean_edge_multiple, found,
               "Gregory et al. 2000");
    print_rule("512 cells an object", rules.object_512, costs.object_512, found, "Garcia-Alonso et al. 1994");
    print_rule("resolution", rules.resolution, costs.resolution, found, "McNeely et al. 1999");
    print_rule("mean volume", rules.mean_volume, costs.mean_volume, found,
               "cube root of the mean tetrahedron volume");
    print_rule("median box side", rules.median_box_side, costs.median_box_side, found, "IPC Toolkit");
    print_terms(found);
    print_levels(found);
    std::printf("\n%zu %s, %llu vertices, %llu tetrahedra, mean edge %.9g, mean facet area %.9g.\n",
                mesh_count, mesh_count == 1 ? "mesh" : "meshes",
                static_cast<unsigned long long>(found.stats.vertices),
                static_cast<unsigned long long>(found.stats.tets), mean_edge, found.stats.mean_facet_area);
    std::printf("%.4g cells along an edge of the world; predicted cost ", found.cells_per_axis);
    if (found.model == VOX_COST_MODEL_PAPER)
        std::printf("%.4g cell visits a tetrahedron.\n", found.predicted_cost);
    else if (found.model == VOX_COST_MODEL_SURFACE)
        std::printf("%.4g ms a search, of the grid alone.\n", found.predicted_cost * 1e-6);
    else
        std::printf("%.4g ms a step.\n", found.predicted_cost * 1e-6);
}

void run_suggest(const SuggestOptions& options) {
    if (!options.svg.empty()) check_output(options.svg);
    if (options.files.empty() && options.foreign.tune.empty()) throw WrongUsage("MESH is required");
    std::vector<Body> bodies;
    std::vector<vox_mesh_desc> meshes;
    for (const std::string& file : options.files) bodies.push_back(load_body(file, {}, options.fill));
    const bool has_tets =
        std::any_of(bodies.begin(), bodies.end(), [](const Body& body) { return body.view.tet_count > 0; });
    if (!has_tets && options.desc.model == VOX_COST_MODEL_SURFACE)
        throw Failure("--model surface is for the surfaces of tetrahedra, and there are none");
    if (options.foreign.any() || !has_tets) // nothing that a grid of vox's own could be tuned for
        return suggest_foreign(options.foreign, bodies, options.desc.zone_loss, options.svg, options.json);
    for (const Body& body : bodies) meshes.push_back(mesh_desc(body));
    if (options.self)
        for (vox_mesh_desc& mesh : meshes) mesh.filter.flags |= VOX_FILTER_SELF_COLLISION;
    vox_suggest_desc desc = options.desc;
    vox_cost_weights weights{};
    weights.struct_size = sizeof weights;
    if (options.calibrate) {
        check(vox_cost_calibrate(&weights));
        desc.weights = &weights;
    }
    vox_suggestion found{};
    found.struct_size = sizeof found;
    check(vox_suggest_cell_size(&desc, meshes.data(), meshes.size(), &found));
    if (!options.svg.empty()) {
        if (!collides(found))
            throw Failure(options.svg + ": nothing collides, so that there is no cost to draw");
        write_file(options.svg,
                   curve_svg(curve_of(found), short_names(options.files) + "; " + model_words(found.model)));
    }
    if (!options.json) return print_suggest(found, meshes.size());
    Json json = Json::object();
    add_suggestion(json, found);
    print(json);
}

} // namespace

void add_suggest(CommandLine& line) {
    const auto options = std::make_shared<SuggestOptions>();
    vox_suggest_desc& desc = options->desc;
    Command command = line.add("suggest", "Find the best cell size for meshes and explain it");
    command.option("MESH", options->files, "Mesh files: tetrahedra, surfaces or points");
    add_fill(command, options->fill);
    command.choice("--model", desc.model, models, "Cost model to minimise");
    command.option("--p-nc", desc.p_nc, "Probability that a tetrahedron has no collision, between 0 and 1")
        .fraction();
    command.option("--ratio", desc.cost_ratio, "Cost of a particle test divided by that of a cell visit")
        .positive();
    command.choice("--size-reading", desc.size_reading, size_readings,
                   "How the cost model measures the size of a tetrahedron");
    command.choice("--area-reading", desc.area_reading, area_readings,
                   "How the cost model measures the area of a facet");
    command
        .option("--world", desc.world_edge,
                "Edge of the cubic world, for the cells per axis; 0: longest side of the bounds")
        .not_negative();
    command.option("--zone-loss", desc.zone_loss, "Relative loss of predicted cost that ends the zone")
        .not_negative();
    command.option("--factor", desc.mean_edge_factor, "Factor of the rule 'mean edge, multiple'").positive();
    command.option("--resolution", desc.resolution, "Cell size of the rule 'resolution'; 0: none")
        .not_negative();
    command.flag("--self", options->self, "The bodies also collide with themselves");
    command.flag("--calibrate", options->calibrate,
                 "First measure on this machine the costs that the engines' models use");
    add_foreign(command, options->foreign);
    command.option("--svg", options->svg, "Write the cost curve as a picture to this file");
    command.flag("--json", options->json, "Print one JSON object");
    command.runs([options] { run_suggest(*options); });
}

} // namespace tool
