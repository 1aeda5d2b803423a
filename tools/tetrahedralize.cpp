// vox tetrahedralize: fills a closed surface with tetrahedra and writes them to a file.
#include "body.hpp"
#include "commands.hpp"
#include "failure.hpp"
#include "options.hpp"
#include "output_file.hpp"
#include "report.hpp"
#include "terminal.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace tool {

namespace {

struct TetrahedralizeOptions {
    std::string surface, out;
    vox_io_tetrahedralize_desc desc{};
    bool binary = false;
    bool json = false;
};

constexpr Choice<vox_io_solid_kind> kinds[] = {{"stuffed", VOX_IO_SOLID_STUFFED},
                                               {"cubes", VOX_IO_SOLID_CUBES}};

// About how many tetrahedra it will be: twelve a cell, or five a cube, and those that the surface cuts.
std::string expected_tets(const vox_io_mesh* surface, const vox_io_tetrahedralize_desc& desc) {
    auto report = sized<vox_io_report>();
    check(vox_io_mesh_get_report(surface, &report));
    vox_io_mesh_view view{};
    check(vox_io_mesh_get_arrays(surface, &view));
    double twice_area = 0, longest = 0;
    for (std::uint64_t t = 0; t < view.triangle_count; ++t) {
        const double* p[3];
        for (std::uint64_t i = 0; i < 3; ++i)
            p[i] = view.positions + 3 * std::uint64_t{view.triangles[3 * t + i]};
        double squares = 0;
        for (int k = 0; k < 3; ++k) {
            const int i = (k + 1) % 3, j = (k + 2) % 3;
            const double n =
                (p[1][i] - p[0][i]) * (p[2][j] - p[0][j]) - (p[1][j] - p[0][j]) * (p[2][i] - p[0][i]);
            squares += n * n;
        }
        twice_area += std::sqrt(squares);
    }
    for (int k = 0; k < 3; ++k) longest = std::max(longest, report.bounds_max[k] - report.bounds_min[k]);
    const double cell = desc.cell > 0 ? desc.cell : longest / 50,
                 cells = std::fabs(report.volume) / (cell * cell * cell), cut = twice_area / (cell * cell);
    const double tets = desc.kind == VOX_IO_SOLID_CUBES ? 5 * (cells + cut / 2) : 12 * cells + cut;
    const char* const how = desc.max_distance > 0 ? "at least" : desc.coarsen > 0 ? "at most" : "about";
    char text[80];
    if (tets < 1e6)
        std::snprintf(text, sizeof text, "%s %.0f,000 tetrahedra", how, std::ceil(tets / 1e3));
    else
        std::snprintf(text, sizeof text, "%s %.*f million tetrahedra", how, tets < 1e7 ? 1 : 0, tets / 1e6);
    constexpr double many = 5e6; // some seconds, and a gigabyte
    if (tets > many && tets <= static_cast<double>(desc.max_tets ? desc.max_tets : 100000000))
        std::fprintf(stderr, "vox: cells of %.3g make %s\n", cell, text);
    return text;
}

Mesh fill(const vox_io_mesh* surface, vox_io_tetrahedralize_desc desc) {
    struct Filling {
        std::string expected;
        Progress progress;
    };
    Filling filling;
    filling.expected = expected_tets(surface, desc);
    desc.progress = [](double fraction, void* user) -> std::int32_t {
        auto& [expected, progress] = *static_cast<Filling*>(user);
        progress.show("filled " + std::to_string(static_cast<int>(100 * fraction)) + " % of " + expected);
        return 0;
    };
    desc.progress_user = &filling;
    vox_io_mesh* filled = nullptr;
    check(vox_io_tetrahedralize(surface, &desc, &filled));
    return Mesh(filled);
}

void write(const vox_io_mesh* mesh, const TetrahedralizeOptions& options) {
    vox_io_write_desc desc = vox_default_io_write_desc();
    desc.binary = options.binary ? 1 : 0;
    check(vox_io_write(mesh, options.out.c_str(), &desc));
}

void print_tetrahedralize(const TetrahedralizeOptions& options, const vox_io_quality& quality) {
    std::printf("%s: %llu tetrahedra, %llu vertices\n", shown(options.out).c_str(), llu(quality.tets),
                llu(quality.vertices));
    std::printf("  %-20s %.9g to %.9g degrees\n", "dihedral angles", quality.min_dihedral,
                quality.max_dihedral);
    std::printf("  %-20s %.9g (of the mesh's boundary and the surface)\n", "Hausdorff distance",
                quality.hausdorff);
    std::printf("  %-20s %.9g (the surface's: %.9g)\n", "volume", quality.volume, quality.surface_volume);
}

void run_tetrahedralize(const TetrahedralizeOptions& options) {
    check_output(options.out, {".msh", ".vtu"});                             // filling may take minutes
    const Loaded loaded = load_mesh(options.surface, {.keep_unused = true}); // triangles beside tets
    say_warnings(options.surface, loaded.warnings);
    const Mesh& surface = loaded.mesh;
    const Mesh mesh = fill(surface.get(), options.desc);
    write(mesh.get(), options);
    auto quality = sized<vox_io_quality>();
    check(vox_io_mesh_measure(mesh.get(), surface.get(), &quality));
    if (!options.json) return print_tetrahedralize(options, quality);
    print({{"file", options.out},
           {"tets", quality.tets},
           {"vertices", quality.vertices},
           {"surface_triangles", quality.boundary_facets},
           {"min_dihedral", quality.min_dihedral},
           {"max_dihedral", quality.max_dihedral},
           {"hausdorff", quality.hausdorff},
           {"mesh_to_surface", quality.mesh_to_surface},
           {"surface_to_mesh", quality.surface_to_mesh},
           {"volume", quality.volume},
           {"surface_volume", quality.surface_volume},
           {"report", report_json(loaded.report, loaded.warnings)}});
}

} // namespace

void add_tetrahedralize(CommandLine& line) {
    const auto options = std::make_shared<TetrahedralizeOptions>();
    options->desc = vox_default_io_tetrahedralize_desc();
    vox_io_tetrahedralize_desc& desc = options->desc;
    Command command = line.add("tetrahedralize", "Fill a closed surface with tetrahedra");
    command.option("SURFACE", options->surface, "Surface file").required();
    command.option("-o,--output", options->out, "File to write, .msh or .vtu").required();
    command.option("--cell", desc.cell, "Edge of a lattice cube; 0: a fiftieth of the surface's longest side")
        .not_negative();
    command.choice("--kind", desc.kind, kinds,
                   "stuffed: follow the surface; cubes: keep whole cubes around it");
    command
        .option("--max-distance", desc.max_distance,
                "Refine until the Hausdorff distance is at most this; 0: do not refine")
        .not_negative();
    command.option("--coarsen", desc.coarsen, "How many times cells inside may be merged");
    command.option("--max-tets", desc.max_tets, "Fail if there are more tetrahedra than this");
    command.flag("--binary", options->binary, "Write binary instead of text");
    command.flag("--json", options->json, "Print one JSON object");
    command.examples(
        "  vox tetrahedralize scan.stl -o scan.msh\n  vox tetrahedralize scan.stl -o scan.vtu --cell 0.01");
    command.runs([options] { run_tetrahedralize(*options); });
}

} // namespace tool
