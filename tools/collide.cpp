// vox collide: finds the contacts between two mesh files, within one, or of them with rigid shapes.
#include "body.hpp"
#include "commands.hpp"
#include "failure.hpp"
#include "options.hpp"
#include "output_file.hpp"
#include "report.hpp"
#include "results_file.hpp"
#include "rigid.hpp"
#include "snapshot_file.hpp"
#include "stepping.hpp"
#include "terminal.hpp"

#include <algorithm>
#include <cstdio>
#include <set>

namespace tool {

namespace {

struct CollideOptions {
    std::string a, b;
    bool self = false;
    Reading reading;
    std::vector<double> offset = {0, 0, 0};
    double scale = 1;
    bool keep_doubles = false;
    RigidOptions rigid;
    GridOptions grid;
    std::uint32_t repeat = 1;
    std::uint64_t limit = 10;
    bool no_depth = false, edges = false;
    std::string moving, save, out, csv;
    bool json = false;
};

// Names meshes and shapes, in the order of their ids.
std::string letter(std::size_t place) {
    return place < 26 ? std::string(1, static_cast<char>('A' + place)) : "#" + std::to_string(place);
}
std::string letter(const std::vector<vox_body>& ids, vox_body body) { return letter(place_of(ids, body)); }

// The vertices of either body, as "A 3 in B 0 1 2 3"; a shape has none.
std::string vertices_of(const vox_constraint& c, const std::vector<vox_body>& ids) {
    std::string words;
    for (std::uint32_t i = 0; i < c.count; ++i) {
        if (i == 0 || i == c.count_a)
            words += (i == 0 ? "" : " in ") + letter(ids, i == 0 ? c.body_a : c.body_b);
        words += " " + std::to_string(c.vertices[i]);
    }
    if (c.count == c.count_a) words += " in " + letter(ids, c.body_b);
    return words;
}

void print_constraints(const CollideOptions& options, const vox_grid* grid,
                       const std::vector<vox_body>& ids) {
    const std::span<const vox_constraint> all = constraints_of(grid);
    std::printf("%zu %s", all.size(), all.size() == 1 ? "constraint" : "constraints");
    const char* separator = ": ";
    for (const vox_constraint_kind kind :
         {VOX_CONSTRAINT_INSIDE, VOX_CONSTRAINT_EDGE, VOX_CONSTRAINT_PROXIMITY, VOX_CONSTRAINT_IMPACT})
        if (const auto count = std::ranges::count(all, kind, &vox_constraint::kind); count > 0) {
            std::printf("%s%td %s", separator, count, kind_name(kind));
            separator = ", ";
        }
    std::printf("\n");
    std::vector<const vox_constraint*> deepest;
    for (const vox_constraint& c : all) deepest.push_back(&c);
    std::ranges::stable_sort(deepest, {}, &vox_constraint::gap);
    deepest.resize(std::min<std::uint64_t>(deepest.size(), options.limit));
    if (!deepest.empty())
        std::printf("\n  %-9s  %11s  %-32s  %-26s  %-10s  %s\n", "kind", "gap", "at", "out along", "state",
                    "vertices");
    for (const vox_constraint* c : deepest) {
        char at[64], along[64];
        std::snprintf(at, sizeof at, "%.6g %.6g %.6g", c->position[0], c->position[1], c->position[2]);
        std::snprintf(along, sizeof along, "%.4f %.4f %.4f", c->normal[0], c->normal[1], c->normal[2]);
        std::printf("  %-9s  %11.6g  %-32s  %-26s  %-10s  %s", kind_name(c->kind), c->gap, at, along,
                    state_name(c->state), vertices_of(*c, ids).c_str());
        if (c->time < 1) std::printf(", at %.9g of the way", c->time);
        std::printf("\n");
    }
    print_rest(all.size() - deepest.size());
}

// How many contacts and vertices, the deepest and where.
void print_summary(const vox_grid* grid, bool with_shapes) {
    const std::span<const vox_contact> contacts = contacts_of(grid);
    std::set<std::pair<vox_body, std::uint32_t>> vertices;
    for (const vox_contact& contact : contacts) vertices.insert({contact.body_a, contact.vertex});
    char words[200];
    int used = std::snprintf(words, sizeof words, "%zu %s of %zu %s", contacts.size(),
                             contacts.size() == 1 ? "contact" : "contacts", vertices.size(),
                             vertices.size() == 1 ? "vertex" : "vertices");
    const vox_constraint* deepest = nullptr;
    std::size_t in_shapes = 0;
    for (const vox_constraint& c : constraints_of(grid)) {
        if (c.kind != VOX_CONSTRAINT_INSIDE) continue;
        if (c.count == c.count_a) ++in_shapes;
        if (c.gap < (deepest ? deepest->gap : 0)) deepest = &c;
    }
    if (with_shapes)
        used += std::snprintf(words + used, sizeof words - static_cast<std::size_t>(used),
                              ", %zu with shapes", in_shapes);
    if (deepest)
        std::snprintf(words + used, sizeof words - static_cast<std::size_t>(used),
                      "; the deepest is %.4g inside, at (%.4g, %.4g, %.4g)", -deepest->gap,
                      deepest->position[0], deepest->position[1], deepest->position[2]);
    std::printf("\n%s\n", emphasised(words).c_str());
}

void print_contacts(const CollideOptions& options, const vox_grid* grid, const std::vector<vox_body>& ids) {
    const std::span<const vox_contact> contacts = contacts_of(grid);
    const std::size_t shown =
        static_cast<std::size_t>(std::min<std::uint64_t>(contacts.size(), options.limit));
    if (shown > 0) std::printf("  %12s %14s\n", "vertex", "in tet");
    for (const vox_contact& contact : contacts.first(shown))
        std::printf("  %s %10u   %s %10u\n", letter(ids, contact.body_a).c_str(), contact.vertex,
                    letter(ids, contact.body_b).c_str(), contact.tet);
    print_rest(contacts.size() - shown);
}

void print_collide(const CollideOptions& options, const vox_grid* grid, const std::vector<Body>& bodies,
                   const std::vector<Rigid>& shapes, const std::vector<vox_body>& ids,
                   const Counters& times) {
    const auto ms = [&](const char* name) { return static_cast<double>(value_of(times, name)) * 1e-6; };
    for (std::size_t i = 0; i < bodies.size(); ++i)
        std::printf("%s  %s: %llu vertices, %llu tetrahedra%s\n", letter(i).c_str(),
                    shown(bodies[i].name).c_str(), llu(bodies[i].view.vertex_count),
                    llu(bodies[i].view.tet_count),
                    bodies[i].view.tet_count > 0
                        ? ""
                        : " (a surface: its vertices collide, but it has no inside; --fill makes one)");
    for (std::size_t i = 0; i < shapes.size(); ++i)
        std::printf("%s  %s\n", letter(bodies.size() + i).c_str(), name_of(shapes[i]).c_str());
    print_summary(grid, !shapes.empty());
    if (options.no_depth) print_contacts(options, grid, ids);
    if (!options.no_depth || options.edges) print_constraints(options, grid, ids);
    std::printf("\nhash %s, cell size %.4g\n", hexadecimal(hash_of(grid)).c_str(), info_of(grid).cell_size);
    std::printf("step %.3f ms: ", ms("step_ns"));
    if (value_of(times, "stream_ns") > 0) // the fast engine
        std::printf("stream %.3f, winding %.3f, broad phase %.3f, windows %.3f, lookup %.3f, decide %.3f",
                    ms("stream_ns"), ms("winding_ns"), ms("broad_phase_ns"), ms("windows_ns"),
                    ms("lookup_ns"), ms("decide_ns"));
    else
        std::printf("bin %.3f, broad phase %.3f, narrow phase %.3f", ms("bin_ns"), ms("broad_ns"),
                    ms("narrow_ns"));
    if (options.edges) std::printf(", edges %.3f", ms("edges_ns"));
    std::printf(", contacts %.3f, depth %.3f, constraints %.3f (%s)\n", ms("contacts_ns"), ms("depth_ns"),
                ms("constraints_ns"),
                options.repeat == 1
                    ? "one step, in which all vertices move; --repeat N gives medians"
                    : ("medians of " + std::to_string(options.repeat) + " steps, in which all vertices move")
                          .c_str());
}

// Without tetrahedra the answer would always be 0.
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
    const std::vector<Rigid> shapes = options.rigid.shapes();
    if (options.b.empty() && !options.self && shapes.empty())
        throw WrongUsage(
            "collide needs a second mesh, --self for self-collision of the first, or a shape such "
            "as --floor 0,0,1,0");
    if (!options.out.empty()) check_output(options.out, {".vtu", ".msh", ".html"});
    for (const std::string& path : {options.csv, options.save})
        if (!path.empty()) check_output(path);
    std::vector<Body> bodies;
    bodies.push_back(load_body(options.a, {.keep_doubles = options.keep_doubles}, options.reading));
    if (!options.b.empty()) {
        const Placement placement{
            options.scale, {options.offset[0], options.offset[1], options.offset[2]}, options.keep_doubles};
        bodies.push_back(load_body(options.b, placement, options.reading));
    }
    if (shapes.empty()) require_inside(bodies);
    Body before;
    if (!options.moving.empty())
        before = load_body(
            options.moving, {.keep_doubles = options.keep_doubles},
            {.keep_unused = options.reading.keep_unused, .split_cells = options.reading.split_cells});
    std::vector<vox_body> ids;
    GridOptions settings = options.grid;
    vox_grid_desc desc = settings.grid_desc();
    if (!options.no_depth) desc.flags |= VOX_GRID_CONSTRAINTS;
    if (options.edges) desc.flags |= VOX_GRID_EDGES;
    std::vector<vox_mesh_desc> meshes;
    for (const Body& body : bodies) meshes.push_back(mesh_desc(body));
    if (options.self)
        for (vox_mesh_desc& mesh : meshes) mesh.filter.flags |= VOX_FILTER_SELF_COLLISION;
    const Grid grid = make_grid(desc, meshes, ids);
    if (!options.moving.empty()) bind_previous(grid.get(), ids[0], bodies[0], before);
    insert_rigid(grid.get(), shapes, ids);
    const Counters times = measure_steps(grid.get(), bodies, ids, options.repeat);
    if (options.no_depth) {
        vox_constraint_desc bare = vox_default_constraint_desc();
        bare.method = VOX_DEPTH_METHOD_NONE;
        check(vox_grid_find_constraints(grid.get(), &bare));
    }
    if (!options.save.empty()) save_snapshot(grid.get(), options.save);
    if (!options.csv.empty()) write_constraints(options.csv, ids, grid.get());
    if (!options.out.empty()) {
        std::vector<DrawnMesh> drawn;
        for (std::size_t i = 0; i < bodies.size(); ++i) drawn.push_back(drawn_mesh(bodies[i], ids[i]));
        write_results(options.out, drawn, grid.get());
    }
    if (!options.json) return print_collide(options, grid.get(), bodies, shapes, ids, times);
    Json json = {{"meshes", body_list(bodies)},
                 {"shapes", rigid_list(shapes)},
                 {"cell_size", info_of(grid.get()).cell_size}};
    add_collision(json, grid.get(), ids, times);
    print(json);
}

} // namespace

void add_collide(CommandLine& line) {
    const auto options = std::make_shared<CollideOptions>();
    Command command =
        line.add("collide", "Find the contacts between two meshes, within one, or with rigid shapes");
    command.option("A", options->a, "Mesh file").required();
    Option b = command.option("B", options->b, "Second mesh file");
    command.flag("--self", options->self, "Also find the contacts of a mesh with itself");
    add_reading(command, options->reading);
    command.option("--scale", options->scale, "Scale B by this factor").not_zero().needs(b);
    command.option("--offset", options->offset, "Move B by X Y Z after scaling it")
        .count(3)
        .shown_as("FLOAT")
        .finite()
        .needs(b);
    add_rigid(command, options->rigid);
    command.flag("--double", options->keep_doubles, "Keep positions in double instead of rounding to float");
    command
        .option("--margin", options->grid.desc.margin,
                "Also find vertices outside, but within this distance of a surface")
        .not_negative();
    command
        .option(
            "--moving", options->moving,
            "Mesh file with where the vertices of A were: also find what went through a surface on the way")
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
    command.option("--limit", options->limit,
                   "Most constraints (with --no-depth: contacts) to print as text, the deepest first");
    command.flag("--no-depth", options->no_depth,
                 "Leave out depths: the gaps of vertices inside are 0, and so are their normals");
    command.flag("--edges", options->edges, "Also find edges of one mesh through faces of the other");
    command
        .option("-o,--output", options->out,
                "Write meshes, contacts and constraints to this file: .vtu, .msh, or .html to look at in a "
                "browser")
        .shown_as("FILE");
    command.option("--csv", options->csv, "Write all constraints to this file, a line each").shown_as("FILE");
    command.option("--save", options->save, "Write a snapshot of the grid to this file, for vox replay")
        .shown_as("FILE");
    command.flag("--json", options->json, "Print one JSON object");
    command.examples(
        "  vox collide bunny.msh cow.msh --offset 0.5 0 0\n  vox collide body.msh --self -o contacts.html\n"
        "  vox collide body.msh --floor 0,0,1,0 --sphere 0,0,1,0.5");
    command.runs([options] { run_collide(*options); });
}

} // namespace tool
