// vox tetrahedralize: fills a closed surface with tetrahedra and writes them to a file.
#include "body.hpp"
#include "commands.hpp"
#include "failure.hpp"
#include "options.hpp"
#include "output_file.hpp"
#include "report.hpp"
#include "terminal.hpp"

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

Mesh fill(const vox_io_mesh* surface, vox_io_tetrahedralize_desc desc) {
    Progress progress;
    desc.progress = [](double fraction, void* user) -> std::int32_t {
        static_cast<Progress*>(user)->show("filled " + std::to_string(static_cast<int>(100 * fraction)) +
                                           " %");
        return 0;
    };
    desc.progress_user = &progress;
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
    command.runs([options] { run_tetrahedralize(*options); });
}

} // namespace tool
