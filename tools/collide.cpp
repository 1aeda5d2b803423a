// vox collide: finds the contacts between two mesh files, or within one.
#include "body.hpp"
#include "commands.hpp"
#include "failure.hpp"
#include "options.hpp"
#include "output_file.hpp"
#include "report.hpp"
#include "results_file.hpp"
#include "snapshot_file.hpp"
#include "stepping.hpp"

#include <algorithm>
#include <cstdio>

namespace tool {

namespace {

struct CollideOptions {
    std::string a, b;
    bool self = false;
    Fill fill;
    std::vector<double> offset = {0, 0, 0};
    double scale = 1;
    bool keep_doubles = false;
    GridOptions grid;
    std::uint32_t repeat = 1;
    std::uint64_t limit = 10;
    bool no_depth = false, edges = false;
    std::string moving, save, out, csv;
    bool json = false;
};

double milliseconds(std::uint64_t nanoseconds) { return static_cast<double>(nanoseconds) * 1e-6; }

void print_penetrations(const CollideOptions& options, const vox_grid* grid,
                        const std::vector<vox_body>& ids) {
    const vox_penetration_view view = penetrations_of(grid);
    if (view.count == 0) return;
    std::printf("\n%llu %s\n", static_cast<unsigned long long>(view.count),
                view.count == 1 ? "penetrating vertex" : "penetrating vertices");
    const std::uint64_t shown = std::min(view.count, options.limit);
    if (shown > 0) std::printf("  %12s in        depth   direction out, state\n", "vertex");
    for (std::uint64_t i = 0; i < shown; ++i) {
        const vox_penetration p = penetration_at(view, i);
        std::printf("  %c %10u  %c %12.6g   %9.6f %9.6f %9.6f, %s\n",
                    place_of(ids, p.body_a) == 0 ? 'A' : 'B', p.vertex,
                    place_of(ids, p.body_b) == 0 ? 'A' : 'B', static_cast<double>(p.depth),
                    static_cast<double>(p.direction[0]), static_cast<double>(p.direction[1]),
                    static_cast<double>(p.direction[2]), state_name(p.state));
    }
    if (shown < view.count)
        std::printf("  and %llu more\n", static_cast<unsigned long long>(view.count - shown));
}

void print_edges(const CollideOptions& options, const vox_grid* grid, const std::vector<vox_body>& ids) {
    const vox_edge_contact_view view = edge_contacts_of(grid);
    const vox_depth_view depths = edge_depths_of(grid);
    std::printf("\n%llu %s\n", static_cast<unsigned long long>(view.count),
                view.count == 1 ? "edge contact" : "edge contacts");
    const std::uint64_t shown = std::min(view.count, options.limit);
    if (shown > 0)
        std::printf("  %23s   %34s   position, depth, direction out, kind\n", "edge", "through face");
    for (std::uint64_t i = 0; i < shown; ++i) {
        const vox_edge_contact c = edge_contact_at(view, i);
        const vox_depth depth = depth_at(depths, i);
        std::printf("  %c %10u %10u   %c %10u %10u %10u   %.6g %.6g %.6g, %.6g, %.6f %.6f %.6f, %s\n",
                    place_of(ids, c.body_a) == 0 ? 'A' : 'B', c.edge[0], c.edge[1],
                    place_of(ids, c.body_b) == 0 ? 'A' : 'B', c.face[0], c.face[1], c.face[2], c.position[0],
                    c.position[1], c.position[2], depth.depth, depth.direction[0], depth.direction[1],
                    depth.direction[2], kind_name(c.kind));
    }
    if (shown < view.count)
        std::printf("  and %llu more\n", static_cast<unsigned long long>(view.count - shown));
}

void print_near(const CollideOptions& options, const vox_grid* grid, const std::vector<vox_body>& ids) {
    const auto letter = [&](vox_body mesh) { return place_of(ids, mesh) == 0 ? 'A' : 'B'; };
    const auto title = [](std::size_t count, const char* one, const char* many) {
        std::printf("\n%zu %s\n", count, count == 1 ? one : many);
    };
    if (has_margin(grid)) {
        const std::vector<vox_margin_contact> all = margin_contacts_of(grid);
        title(all.size(), "vertex within the margin", "vertices within the margin");
        for (std::size_t i = 0; i < std::min<std::uint64_t>(all.size(), options.limit); ++i)
            std::printf("  %c %10u  %c %12.6g   %9.6f %9.6f %9.6f\n", letter(all[i].body_a), all[i].vertex,
                        letter(all[i].body_b), all[i].distance, all[i].normal[0], all[i].normal[1],
                        all[i].normal[2]);
    }
    if (!options.moving.empty()) {
        const std::vector<vox_passage> all = passages_of(grid);
        title(all.size(), "vertex met a surface on the way", "vertices met a surface on the way");
        for (std::size_t i = 0; i < std::min<std::uint64_t>(all.size(), options.limit); ++i)
            std::printf("  %c %10u  %c face %u %u %u at %.9g\n", letter(all[i].body_a), all[i].vertex,
                        letter(all[i].body_b), all[i].face[0], all[i].face[1], all[i].face[2], all[i].time);
    }
}

void print_collide(const CollideOptions& options, const vox_grid* grid, const std::vector<Body>& bodies,
                   const std::vector<vox_body>& ids, const Counters& times) {
    for (std::size_t i = 0; i < bodies.size(); ++i)
        std::printf("%c  %s: %llu vertices, %llu tetrahedra%s\n", i == 0 ? 'A' : 'B', bodies[i].name.c_str(),
                    static_cast<unsigned long long>(bodies[i].view.vertex_count),
                    static_cast<unsigned long long>(bodies[i].view.tet_count),
                    bodies[i].view.tet_count > 0
                        ? ""
                        : " (a surface: its vertices collide, but it has no inside; --fill makes one)");
    const vox_contact_view view = contacts_of(grid);
    std::printf("\n%llu %s\n", static_cast<unsigned long long>(view.count),
                view.count == 1 ? "contact" : "contacts");
    const std::uint64_t shown = view.count < options.limit ? view.count : options.limit;
    if (shown > 0) std::printf("  %12s %14s   weights of the corners\n", "vertex", "in tet");
    for (std::uint64_t i = 0; i < shown; ++i) {
        const vox_contact contact = contact_at(view, i);
        const float* weight = contact.barycentric;
        std::printf("  %c %10u   %c %10u   %.9g %.9g %.9g %.9g\n",
                    place_of(ids, contact.body_a) == 0 ? 'A' : 'B', contact.vertex,
                    place_of(ids, contact.body_b) == 0 ? 'A' : 'B', contact.tet,
                    static_cast<double>(weight[0]), static_cast<double>(weight[1]),
                    static_cast<double>(weight[2]), static_cast<double>(weight[3]));
    }
    if (shown < view.count)
        std::printf("  and %llu more (--limit N prints N of them, --json all of them)\n",
                    static_cast<unsigned long long>(view.count - shown));
    if (!options.no_depth) print_penetrations(options, grid, ids);
    if (options.edges) print_edges(options, grid, ids);
    print_near(options, grid, ids);
    std::printf("\nhash %s, cell size %.9g\n", hexadecimal(hash_of(grid)).c_str(), info_of(grid).cell_size);
    std::printf("step %.3f ms: ", milliseconds(value_of(times, "step_ns")));
    if (value_of(times, "stream_ns") > 0) // the fast engine
        std::printf("stream %.3f, winding %.3f, broad phase %.3f, windows %.3f, lookup %.3f, decide %.3f",
                    milliseconds(value_of(times, "stream_ns")), milliseconds(value_of(times, "winding_ns")),
                    milliseconds(value_of(times, "broad_phase_ns")),
                    milliseconds(value_of(times, "windows_ns")), milliseconds(value_of(times, "lookup_ns")),
                    milliseconds(value_of(times, "decide_ns")));
    else
        std::printf("bin %.3f, broad phase %.3f, narrow phase %.3f", milliseconds(value_of(times, "bin_ns")),
                    milliseconds(value_of(times, "broad_ns")), milliseconds(value_of(times, "narrow_ns")));
    if (options.edges) std::printf(", edges %.3f", milliseconds(value_of(times, "edges_ns")));
    std::printf(", contacts %.3f, depth %.3f (%s)\n", milliseconds(value_of(times, "contacts_ns")),
                milliseconds(value_of(times, "depth_ns")),
                options.repeat == 1
                    ? "one step, in which all vertices move; --repeat N gives medians"
                    : ("medians of " + std::to_string(options.repeat) + " steps, in which all vertices move")
                          .c_str());
}

// Without a tetrahedron there is nothing that a vertex can be in, so the answer would be 0 whatever the
// meshes.
void require_inside(const std::vector<Body>& bodies) {
    if (std::any_of(bodies.begin(), bodies.end(), [](const Body& body) { return body.view.tet_count > 0; }))
        return;
    std::string names;
    for (const Body& body : bodies) names += (names.empty() ? "" : " and ") + body.name;
    throw Failure(names + (bodies.size() == 1 ? " is a surface and has" : " are surfaces and have") +
                  " no inside for a vertex to be in; --fill fills them with tetrahedra first");
}

void bind_previous(vox_grid* grid, vox_body mesh, const Body& body, const Body& before) {
    if (before.view.vertex_count != body.view.vertex_count)
        throw Failure(before.name + " has " + std::to_string(before.view.vertex_count) + " vertices, but " +
                      body.name + " has " + std::to_string(body.view.vertex_count));
    const vox_mesh_desc desc = mesh_desc(before);
    check(vox_mesh_bind_previous_positions(grid, mesh, &desc.positions));
}

void run_collide(const CollideOptions& options) {
    if (options.b.empty() && !options.self)
        throw WrongUsage("collide needs a second mesh, or --self for self-collision of the first");
    if (!options.out.empty()) check_output(options.out, {".vtu", ".msh"});
    for (const std::string& path : {options.csv, options.save})
        if (!path.empty()) check_output(path);
    std::vector<Body> bodies;
    bodies.push_back(load_body(options.a, {.keep_doubles = options.keep_doubles}, options.fill));
    if (!options.b.empty()) {
        const Placement placement{
            options.scale, {options.offset[0], options.offset[1], options.offset[2]}, options.keep_doubles};
        bodies.push_back(load_body(options.b, placement, options.fill));
    }
    require_inside(bodies);
    Body before;
    if (!options.moving.empty())
        before = load_body(options.moving, {.keep_doubles = options.keep_doubles}, {});
    std::vector<vox_body> ids;
    GridOptions settings = options.grid;
    vox_grid_desc desc = settings.grid_desc();
    if (options.no_depth) desc.flags &= ~std::uint32_t{VOX_GRID_PENETRATIONS};
    if (options.edges) desc.flags |= VOX_GRID_EDGE_CONTACTS;
    std::vector<vox_mesh_desc> meshes;
    for (const Body& body : bodies) meshes.push_back(mesh_desc(body));
    if (options.self)
        for (vox_mesh_desc& mesh : meshes) mesh.filter.flags |= VOX_FILTER_SELF_COLLISION;
    const Grid grid = make_grid(desc, meshes, ids);
    if (!options.moving.empty()) bind_previous(grid.get(), ids[0], bodies[0], before);
    const Counters times = measure_steps(grid.get(), bodies, ids, options.repeat);
    if (options.edges) check(vox_grid_prepare_edge_depths(grid.get()));
    if (!options.save.empty()) save_snapshot(grid.get(), options.save);
    if (!options.csv.empty()) write_contacts(options.csv, ids, grid.get());
    if (!options.out.empty()) {
        std::vector<DrawnMesh> drawn;
        for (std::size_t i = 0; i < bodies.size(); ++i) drawn.push_back(drawn_mesh(bodies[i], ids[i]));
        write_results(options.out, drawn, grid.get(), !options.moving.empty());
    }
    if (!options.json) return print_collide(options, grid.get(), bodies, ids, times);
    Json json = {{"meshes", body_list(bodies)}, {"cell_size", info_of(grid.get()).cell_size}};
    add_collision(json, grid.get(), ids, times);
    if (has_margin(grid.get())) json.add("margin_contacts", margin_contacts(grid.get(), ids));
    if (!options.moving.empty()) json.add("passages", passages(grid.get(), ids));
    print(json);
}

} // namespace

void add_collide(CommandLine& line) {
    const auto options = std::make_shared<CollideOptions>();
    Command command = line.add("collide", "Find the contacts between two meshes, or within one");
    command.option("A", options->a, "Mesh file").required();
    Option b = command.option("B", options->b, "Second mesh file");
    command.flag("--self", options->self, "Also find the contacts of a mesh with itself");
    add_fill(command, options->fill);
    command.option("--scale", options->scale, "Scale B by this factor").not_zero().needs(b);
    command.option("--offset", options->offset, "Move B by X Y Z after scaling it")
        .count(3)
        .shown_as("FLOAT")
        .finite()
        .needs(b);
    command.flag("--double", options->keep_doubles, "Keep positions in double instead of rounding to float");
    command
        .option("--margin", options->grid.desc.margin,
                "Also find vertices outside, but within this distance of a surface")
        .not_negative();
    command
        .option("--moving", options->moving,
                "Mesh file with where the vertices of A were: also find what meets a surface on the way")
        .shown_as("PREVIOUS");
    command.choice("--engine", options->grid.engine, engines, "Algorithm");
    command.option("--cell-size", options->grid.desc.cell_size, "Edge of a cell; 0: the library chooses")
        .not_negative();
    add_cells(command, options->grid);
    add_threads(command, options->grid);
    command
        .option("--repeat", options->repeat,
                "Number of steps to time, after one to warm up; the bodies wobble, and come back")
        .range(1, 1000000);
    command.option("--limit", options->limit, "Most contacts to print as text");
    command.flag("--no-depth", options->no_depth, "Find contacts only, without depths and directions");
    command.flag("--edges", options->edges, "Also find edges of one mesh through faces of the other");
    command
        .option("-o,--output", options->out, "Write meshes, contacts and depths to this file, .vtu or .msh")
        .shown_as("FILE");
    command.option("--csv", options->csv, "Write all contacts to this file, a line each").shown_as("FILE");
    command.option("--save", options->save, "Write a snapshot of the grid to this file, for vox replay")
        .shown_as("FILE");
    command.flag("--json", options->json, "Print one JSON object");
    command.runs([options] { run_collide(*options); });
}

} // namespace tool
