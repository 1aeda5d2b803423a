// vox info: shows what is in a mesh file.
#include "body.hpp"
#include "commands.hpp"
#include "failure.hpp"
#include "options.hpp"
#include "report.hpp"
#include "shape.hpp"
#include "terminal.hpp"

#include <cmath>
#include <cstdio>
#include <optional>
#include <set>

namespace tool {

namespace {

struct InfoOptions {
    std::vector<std::string> files;
    Reading reading;
    bool json = false;
};

struct Info {
    std::string file;
    Shape shape;
    vox_io_report report{};
    vox_io_quality quality{};
    std::size_t regions = 0;
    std::vector<std::string> warnings;
};

// The regions of the tetrahedra, each once.
std::size_t count_regions(const vox_io_mesh_view& view) {
    if (!view.tet_regions) return 0;
    return std::set<std::int32_t>(view.tet_regions, view.tet_regions + view.tet_count).size();
}

Info read_info(const std::string& file, const Reading& reading) {
    Loaded loaded = load_mesh(file, reading);
    Info info;
    info.file = file;
    info.report = loaded.report;
    info.warnings = std::move(loaded.warnings);
    vox_io_mesh_view view{};
    check(vox_io_mesh_get_arrays(loaded.mesh.get(), &view));
    info.shape = measure_shape(view);
    info.regions = count_regions(view);
    info.quality.struct_size = sizeof info.quality;
    check(vox_io_mesh_measure(loaded.mesh.get(), nullptr, &info.quality));
    return info;
}

// An angle of the tetrahedra, if there are any.
Json angle(const Info& info, double degrees) { return info.report.tets > 0 ? Json(degrees) : Json(); }

Json info_json(const Info& info) {
    Json json = {{"file", info.file},
                 {"mean_edge", info.shape.mean_edge},
                 {"mean_longest_edge", info.shape.mean_longest_edge},
                 {"mean_facet_area", info.shape.mean_facet_area},
                 {"mean_volume", info.shape.mean_volume},
                 {"min_dihedral", angle(info, info.quality.min_dihedral)},
                 {"max_dihedral", angle(info, info.quality.max_dihedral)},
                 {"regions", info.regions}};
    add_report(json, info.report, info.warnings);
    return json;
}

void print_count(const char* name, std::uint64_t value) { std::printf("  %-18s %llu\n", name, llu(value)); }

void print_number(const char* name, std::optional<double> value) {
    if (!value) return;
    std::printf(std::isfinite(*value) ? "  %-18s %.6g\n" : "  %-18s too large for a double\n", name, *value);
}

void print_angles(const Info& info) {
    const vox_io_quality& quality = info.quality;
    if (info.report.tets > 0 && std::isfinite(quality.min_dihedral) && std::isfinite(quality.max_dihedral))
        std::printf("  %-18s %.4g to %.4g degrees\n", "dihedral angles", quality.min_dihedral,
                    quality.max_dihedral);
}

void print_info(const Info& info) {
    const vox_io_report& report = info.report;
    std::printf("%s\n", shown(info.file).c_str());
    std::printf("  %-18s %s\n", "format", vox_io_format_string(report.format));
    print_count("vertices", report.vertices);
    print_count("tetrahedra", report.tets);
    if (report.split_cells > 0) print_count("split cells", report.split_cells);
    if (info.regions > 1) print_count("regions", info.regions);
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
    for (const std::string& warning : info.warnings) std::printf("  warning: %s\n", shown(warning).c_str());
}

void run_info(const InfoOptions& options) {
    Json meshes = Json::array();
    for (const std::string& file : options.files) {
        const Info info = read_info(file, options.reading);
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
    add_what_is_read(command, options->reading);
    command.flag("--json", options->json, "Print one JSON object");
    command.examples("  vox info bunny.msh\n  vox info *.msh --json");
    command.runs([options] { run_info(*options); });
}

} // namespace tool
