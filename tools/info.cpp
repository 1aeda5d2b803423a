// vox info: shows what is in a mesh file.
#include "body.hpp"
#include "commands.hpp"
#include "failure.hpp"
#include "report.hpp"
#include "shape.hpp"

#include <cmath>
#include <cstdio>
#include <sstream>

namespace tool {

namespace {

struct InfoOptions {
    std::vector<std::string> files;
    bool json = false;
};

struct Info {
    std::string file;
    Shape shape;
    vox_io_report report{};
    vox_io_quality quality{};
    std::vector<std::string> warnings;
};

Info read_info(const std::string& file) {
    Info info;
    info.file = file;
    info.report.struct_size = sizeof info.report;
    const Mesh mesh = load_mesh(file, &info.report);
    vox_io_mesh_view view{};
    check(vox_io_mesh_get_arrays(mesh.get(), &view));
    info.shape = measure_shape(view);
    info.quality.struct_size = sizeof info.quality;
    check(vox_io_mesh_measure(mesh.get(), nullptr, &info.quality));
    std::istringstream lines(vox_io_mesh_get_warnings(mesh.get()));
    for (std::string line; std::getline(lines, line);)
        if (!line.empty()) info.warnings.push_back(line);
    return info;
}

// An angle of the tetrahedra, if there are any.
Json angle(const Info& info, double degrees) { return info.report.tets > 0 ? Json(degrees) : Json(); }

Json info_json(const Info& info) {
    const vox_io_report& report = info.report;
    return {{"file", info.file},
            {"format", vox_io_format_string(report.format)},
            {"vertices", report.vertices},
            {"tets", report.tets},
            {"surface_triangles", report.boundary_facets},
            {"mean_edge", info.shape.mean_edge},
            {"mean_longest_edge", info.shape.mean_longest_edge},
            {"mean_facet_area", info.shape.mean_facet_area},
            {"mean_volume", info.shape.mean_volume},
            {"volume", report.volume},
            {"min_dihedral", angle(info, info.quality.min_dihedral)},
            {"max_dihedral", angle(info, info.quality.max_dihedral)},
            {"inverted", report.inverted_tets},
            {"degenerate", report.degenerate_tets},
            {"duplicate_vertices", report.duplicate_vertices},
            {"nearly_flat", report.nearly_flat_tets},
            {"duplicate_tets", report.duplicate_tets},
            {"degenerate_triangles", report.degenerate_triangles},
            {"unused_vertices", report.unused_vertices},
            {"non_manifold_facets", report.non_manifold_facets},
            {"open_edges", report.open_edges},
            {"misoriented_edges", report.misoriented_edges},
            {"components", report.components},
            {"skipped_elements", report.skipped_elements},
            {"second_order_tets", report.second_order_tets},
            {"unit_in_metres", report.unit_in_metres > 0 ? Json(report.unit_in_metres) : Json()},
            {"bounds", bounds(report.bounds_min, report.bounds_max)},
            {"warnings", Json::array_of(info.warnings)}};
}

void print_count(const char* name, std::uint64_t value) { std::printf("  %-18s %llu\n", name, llu(value)); }

void print_number(const char* name, std::optional<double> value) {
    if (!value) return;
    std::printf(std::isfinite(*value) ? "  %-18s %.9g\n" : "  %-18s too large for a double\n", name, *value);
}

void print_angles(const Info& info) {
    const vox_io_quality& quality = info.quality;
    if (info.report.tets > 0 && std::isfinite(quality.min_dihedral) && std::isfinite(quality.max_dihedral))
        std::printf("  %-18s %.4g to %.4g degrees\n", "dihedral angles", quality.min_dihedral,
                    quality.max_dihedral);
}

void print_info(const Info& info) {
    const vox_io_report& report = info.report;
    std::printf("%s\n", info.file.c_str());
    std::printf("  %-18s %s\n", "format", vox_io_format_string(report.format));
    print_count("vertices", report.vertices);
    print_count("tetrahedra", report.tets);
    print_count("surface triangles", report.boundary_facets);
    print_count("components", report.components);
    print_number("volume", report.volume);
    print_angles(info);
    print_number("mean edge", info.shape.mean_edge);
    print_number("mean longest edge", info.shape.mean_longest_edge);
    print_number("mean facet area", info.shape.mean_facet_area);
    print_number("mean volume", info.shape.mean_volume);
    if (report.unit_in_metres > 0)
        std::printf("  %-18s %.9g m\n", "unit", report.unit_in_metres);
    else
        std::printf("  %-18s not stated in the file\n", "unit");
    const double *min = report.bounds_min, *max = report.bounds_max;
    std::printf("  %-18s %.9g %.9g %.9g to %.9g %.9g %.9g\n", "bounds", min[0], min[1], min[2], max[0],
                max[1], max[2]);
    for (const std::string& warning : info.warnings) std::printf("  warning: %s\n", warning.c_str());
}

void run_info(const InfoOptions& options) {
    Json meshes = Json::array();
    for (const std::string& file : options.files) {
        const Info info = read_info(file);
        if (options.json)
            meshes.push_back(info_json(info));
        else
            print_info(info);
    }
    if (options.json) print({{"meshes", meshes}});
}

} // namespace

void add_info(CommandLine& line) {
    const auto options = std::make_shared<InfoOptions>();
    Command command = line.add("info", "Show what is in a mesh file");
    command.option("MESH", options->files, "Mesh files").required();
    command.flag("--json", options->json, "Print one JSON object");
    command.runs([options] { run_info(*options); });
}

} // namespace tool
