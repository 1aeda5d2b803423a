// vox suggest: the cell size for a set of meshes, and why.
#include "body.hpp"
#include "commands.hpp"
#include "failure.hpp"
#include "options.hpp"
#include "report.hpp"
#include "terminal.hpp"

#include <cstdio>

namespace tool {

namespace {

struct Options {
    Fill fill;
    std::vector<std::string> files;
    vox_suggest_desc desc = vox_default_suggest_desc();
    bool json = false;
};

const Choices<vox_cost_model> models = {{"paper", VOX_COST_MODEL_PAPER}};
const Choices<vox_size_reading> size_readings = {{"mean-edge", VOX_SIZE_MEAN_EDGE},
                                                 {"mean-longest-edge", VOX_SIZE_MEAN_LONGEST_EDGE},
                                                 {"mean-box-side", VOX_SIZE_MEAN_BOX_SIDE}};
const Choices<vox_area_reading> area_readings = {{"unique-facets", VOX_AREA_UNIQUE_FACETS},
                                                 {"tet-facets", VOX_AREA_TET_FACETS},
                                                 {"boundary-facets", VOX_AREA_BOUNDARY_FACETS}};

void print_rule(const char* name, double cell_size, double mean_edge, const char* source) {
    if (cell_size > 0)
        std::printf("  %-22s %-12.9g %6.2f   %s\n", name, cell_size, cell_size / mean_edge, source);
}

void print_text(const vox_suggestion& found, std::size_t mesh_count) {
    const double mean_edge = found.stats.mean_edge;
    std::printf("Suggested cell size %.9g, %.2f mean edges.\n", found.cell_size, found.cell_size / mean_edge);
    std::printf("Between %.9g and %.9g the predicted cost stays near its minimum.\n\n", found.zone_min,
                found.zone_max);
    std::printf("Predicted cost over cell size, in units of the minimum (logarithmic in cell size):\n%s\n",
                cost_curve(found).c_str());
    std::printf("  %-22s %-12s %6s\n", "rule", "cell size", "edges");
    const vox_cell_size_rules& rules = found.rules;
    print_rule("this suggestion", found.cell_size, mean_edge, "least predicted cost");
    print_rule("mean edge", rules.mean_edge, mean_edge, "Teschner et al. 2003");
    print_rule("mean edge, multiple", rules.mean_edge_multiple, mean_edge, "Gregory et al. 2000");
    print_rule("512 cells an object", rules.object_512, mean_edge, "Garcia-Alonso et al. 1994");
    print_rule("resolution", rules.resolution, mean_edge, "McNeely et al. 1999");
    print_rule("mean volume", rules.mean_volume, mean_edge, "cube root of the mean tetrahedron volume");
    print_rule("median box side", rules.median_box_side, mean_edge, "IPC Toolkit");
    std::printf("\n%zu %s, %llu vertices, %llu tetrahedra, mean edge %.9g, mean facet area %.9g.\n",
                mesh_count, mesh_count == 1 ? "mesh" : "meshes",
                static_cast<unsigned long long>(found.stats.vertices),
                static_cast<unsigned long long>(found.stats.tets), mean_edge, found.stats.mean_facet_area);
    std::printf("%.4g cells along an edge of the world; predicted cost %.4g cell visits a tetrahedron.\n",
                found.cells_per_axis, found.predicted_cost);
}

void run(const Options& options) {
    std::vector<Body> bodies;
    std::vector<vox_mesh_desc> meshes;
    for (const std::string& file : options.files) bodies.push_back(load_body(file, {}, options.fill));
    for (const Body& body : bodies) meshes.push_back(mesh_desc(body));
    vox_suggestion found{};
    found.struct_size = sizeof found;
    check(vox_suggest_cell_size(&options.desc, meshes.data(), meshes.size(), &found));
    if (!options.json) return print_text(found, meshes.size());
    Json json;
    add_suggestion(json, found);
    print(json);
}

} // namespace

void add_suggest(CLI::App& app) {
    const auto options = std::make_shared<Options>();
    vox_suggest_desc& desc = options->desc;
    CLI::App* command = app.add_subcommand("suggest", "The best cell size for meshes, and why");
    command->add_option("MESH", options->files, "Mesh files with tetrahedra")->required();
    add_fill(*command, options->fill);
    add_choice(*command, "--model", desc.model, models, "Cost model to minimise");
    command
        ->add_option("--p-nc", desc.p_nc, "Probability that a tetrahedron has no collision, between 0 and 1")
        ->check(
            number_check([](double value) { return value > 0 && value < 1; }, "a number between 0 and 1"));
    command->add_option("--ratio", desc.cost_ratio, "Cost of a particle test over that of a cell visit")
        ->check(positive());
    add_choice(*command, "--size-reading", desc.size_reading, size_readings,
               "What the size of a tetrahedron is in the cost model");
    add_choice(*command, "--area-reading", desc.area_reading, area_readings,
               "What the area of a facet is in the cost model");
    command
        ->add_option("--world", desc.world_edge,
                     "Edge of the cubic world, for the cells per axis; 0: longest side of the bounds")
        ->check(not_negative());
    command->add_option("--zone-loss", desc.zone_loss, "Loss of predicted cost that ends the zone")
        ->check(not_negative());
    command->add_option("--factor", desc.mean_edge_factor, "Factor of the rule 'mean edge, multiple'")
        ->check(positive());
    command->add_option("--resolution", desc.resolution, "Cell size of the rule 'resolution'; 0: none")
        ->check(not_negative());
    command->add_flag("--json", options->json, "Print one JSON object");
    command->callback([options] { run(*options); });
}

} // namespace tool
