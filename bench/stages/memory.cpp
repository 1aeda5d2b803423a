// Where the bytes of a grid are: what each of its parts holds after some steps, in bytes a tetrahedron, in
// the scenes of the benchmark. A grid by itself shows one sum (vox_grid_info.bytes), so its parts are put
// together here, each with a memory resource of its own that counts; the last line compares their sum with
// that of a real grid.
//
//   bench_memory [--tets N] [--scene NAME] [--meshes FOLDER] [--contacts] [--copy] [--steps K]
//
// --contacts leaves constraints out, and --copy has meshes copy their tetrahedra. A line that begins
// with a dash is part of the one above it.
#include "base/array.hpp"
#include "depth/stage.hpp"
#include "fast/engine.hpp"
#include "grid/constraints.hpp"
#include "grid/contacts.hpp"
#include "grid/pairs.hpp"
#include "internal/counting_memory.hpp"
#include "mesh/check.hpp"
#include "mesh/filter.hpp"
#include "mesh/ids.hpp"
#include "mesh/mesh.hpp"
#include "program.hpp"
#include "scenes.hpp"
#include "scenes/counters.h"

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <functional>
#include <string>

namespace {

struct Options {
    double tets = 1e6;
    std::string scene, folder;
    bool constraints = true, borrow = true;
    std::size_t steps = 4;
};

class Table {
public:
    explicit Table(double tets) : tets_(tets) {}

    void add(const char* name, double bytes) { std::printf("  %-34s %8.2f\n", name, bytes / tets_); }

private:
    double tets_;
};

template <class... Vectors>
double room(const Vectors&... vectors) {
    return (0.0 + ... + (static_cast<double>(vectors.capacity()) * sizeof(typename Vectors::value_type)));
}

// The parts of a grid of the fast engine, which steps as vox_grid::step does.
struct Parts {
    CountingMemory of_topology, of_meshes, of_states, of_engine, of_hits, of_depth, of_trees, of_penetrations,
        of_constraints, of_pairs;
    std::vector<vox::Mesh> meshes;
    std::vector<vox::fast::MeshState> states;
    std::vector<vox::Topology> topologies;
    vox::FastEngine engine{&of_engine};
    vox::Array<vox::Hit> hits{&of_hits};
    vox::Array<vox_contact> contacts{&of_hits};
    vox::depth::SurfaceTrees trees{&of_trees};
    vox::DepthStage depth{&of_depth, trees};
    vox::Penetrations penetrations{&of_penetrations};
    vox::Constraints constraints{&of_constraints};
    vox::Pairs pairs{&of_pairs};
    vox::Workers workers{{}, 1};

    Parts(const bench::Scene& scene, const Options& options) {
        for (const bench::Body& body : scene.bodies) {
            vox_mesh_desc desc = body.desc();
            desc.flags |= VOX_MESH_BORROW_TETS; // a copy is counted apart
            const vox::Body view = vox::check_mesh(desc, "", vox::NullPositions::rejected);
            meshes.emplace_back(desc, view, vox::checked_filter(desc.filter), &of_meshes);
            states.emplace_back(&of_states);
            topologies.emplace_back(&of_topology);
            if (options.constraints) vox::make_topology(view.tets, view.vertex_count, topologies.back());
            meshes.back().make_tiles();
            states.back().update(meshes.back().tiled(), meshes.back().tiles_version(), view.vertex_count);
        }
    }

    void step(const Options& options) {
        std::vector<vox::Body> bodies;
        std::vector<vox::fast::PreparedBody> prepared;
        std::vector<const vox::Topology*> of_bodies;
        for (std::size_t i = 0; i < meshes.size(); ++i) {
            bodies.push_back(meshes[i].body(vox::make_id(static_cast<std::uint32_t>(i), 1)));
            prepared.push_back({&meshes[i].tiled().tiles, &meshes[i].tiled().boundary, &states[i]});
            of_bodies.push_back(&topologies[i]);
        }
        vox::Counters counters{};
        vox::Profile profile{};
        hits.clear();
        engine.detect(bodies, prepared, {.workers = &workers}, hits, counters, profile);
        vox::make_contacts(bodies, hits, contacts, &workers);
        pairs.update(contacts, {}, {}, meshes.size(), [](vox_body) { return std::uint64_t{0}; });
        constraints.begin_step(true);
        if (options.constraints) {
            depth.find(bodies, of_bodies, hits, false, 0, &workers, penetrations, counters);
            const std::vector<std::uint8_t> all(pairs.pending().size(), 1);
            vox::ConstraintSources sources{};
            sources.bodies = bodies;
            sources.topologies = of_bodies;
            sources.pairs = pairs.pending();
            sources.chosen = all;
            sources.hits = hits;
            sources.penetrations = &penetrations;
            constraints.find(sources, workers);
        }
        pairs.commit();
    }

    double of_tiles(const std::function<double(const vox::TiledMesh&)>& bytes) const {
        double sum = 0;
        for (const vox::Mesh& mesh : meshes) sum += bytes(mesh.tiled());
        return sum;
    }
    double of_state(const std::function<double(const vox::fast::MeshState&)>& bytes) const {
        double sum = 0;
        for (const vox::fast::MeshState& state : states) sum += bytes(state);
        return sum;
    }
};

double real_bytes(bench::Scene& scene, const Options& options) {
    vox_grid_desc desc = vox_default_grid_desc();
    desc.byte_budget = UINT64_MAX;
    if (options.constraints) desc.flags = VOX_GRID_CONSTRAINTS;
    vox_grid* grid = nullptr;
    bench::must(vox_grid_create(&desc, &grid));
    for (const bench::Body& body : scene.bodies) {
        vox_mesh_desc mesh = body.desc();
        if (options.borrow) mesh.flags |= VOX_MESH_BORROW_TETS;
        vox_body id;
        bench::must(vox_mesh_insert(grid, &mesh, &id));
    }
    for (std::size_t frame = 0; frame < options.steps; ++frame) {
        scene.pose(frame);
        bench::must(vox_grid_step(grid));
    }
    grid_counts counters{};
    counters = counters_of(grid);
    vox_grid_destroy(grid);
    return static_cast<double>(counters.bytes);
}

void report(bench::Scene& scene, const Options& options) {
    Parts parts(scene, options);
    for (std::size_t frame = 0; frame < options.steps; ++frame) {
        scene.pose(frame);
        parts.step(options);
    }
    const auto held = [](const CountingMemory& memory) { return static_cast<double>(memory.bytes); };
    const double tets = static_cast<double>(scene.tet_count());
    const double copy = options.borrow ? 0 : tets * sizeof(vox::Tet);
    double sum = copy;
    for (const CountingMemory* memory :
         {&parts.of_topology, &parts.of_meshes, &parts.of_states, &parts.of_engine, &parts.of_hits,
          &parts.of_depth, &parts.of_trees, &parts.of_penetrations, &parts.of_constraints, &parts.of_pairs})
        sum += held(*memory);
    const double real = real_bytes(scene, options);
    std::printf("\n%s: %zu tets, %zu vertices, %zu bodies, %zu contacts; bytes a tetrahedron:\n",
                scene.name.c_str(), scene.tet_count(), scene.vertex_count(), scene.bodies.size(),
                parts.contacts.size());
    Table table(tets);
    const auto tiles = [&](const char* name, auto bytes) { table.add(name, parts.of_tiles(bytes)); };
    const auto state = [&](const char* name, auto bytes) { table.add(name, parts.of_state(bytes)); };
    if (!options.borrow) table.add("copy of the tetrahedra", copy);
    table.add("tiles", held(parts.of_meshes));
    tiles("- corners", [](const vox::TiledMesh& mesh) { return room(mesh.tiles.corners); });
    tiles("- numbers of tetrahedra", [](const vox::TiledMesh& mesh) { return room(mesh.tiles.tets); });
    tiles("- numbers of vertices", [](const vox::TiledMesh& mesh) { return room(mesh.tiles.vertices); });
    tiles("- which tetrahedra own a vertex", [](const vox::TiledMesh& mesh) { return room(mesh.tiles.own); });
    tiles("- boundary", [](const vox::TiledMesh& mesh) {
        return room(mesh.boundary.triangles, mesh.boundary.mirrored, mesh.boundary.ignored,
                    mesh.boundary.loose);
    });
    table.add("states", held(parts.of_states));
    state("- last positions", [](const vox::fast::MeshState& s) { return room(s.last_positions.positions); });
    state("- reference of orientation", [](const vox::fast::MeshState& s) {
        return room(s.orientation->points, s.orientation->shapes, s.orientation->slack);
    });
    const vox::fast::StepBoxes& boxes = parts.engine.boxes();
    const vox::fast::Windows& windows = parts.engine.windows();
    table.add("engine", held(parts.of_engine));
    table.add("- boxes", room(boxes.bodies, boxes.blocks, boxes.super_tiles, boxes.tiles,
                              boxes.super_positive, boxes.tile_known));
    double binned = 0;
    for (const vox::fast::Bins& bins : windows.bins)
        binned += room(bins.points.x, bins.points.y, bins.points.z, bins.points.id, bins.begin, bins.windows);
    table.add("- windows", binned);
    table.add("hits and contacts", held(parts.of_hits));
    if (options.constraints) {
        table.add("topology", held(parts.of_topology));
        double across = 0;
        for (const vox::Topology& topology : parts.topologies)
            across += static_cast<double>(topology.across.bytes());
        table.add("- tetrahedra across facets", across);
        table.add("depth stage", held(parts.of_depth));
        table.add("trees of surfaces", held(parts.of_trees));
        table.add("penetrations", held(parts.of_penetrations));
        table.add("constraints", held(parts.of_constraints));
    }
    table.add("pairs", held(parts.of_pairs));
    std::printf("  %-34s %8.2f   (a grid: %.2f)\n", "sum", sum / tets, real / tets);
}

int run(int argc, char** argv) {
    Options options;
    for (int i = 1; i < argc; ++i) {
        const auto value = [&]() -> const char* {
            if (++i == argc) throw std::runtime_error(std::string(argv[i - 1]) + " needs a value");
            return argv[i];
        };
        if (!std::strcmp(argv[i], "--tets"))
            options.tets = std::atof(value());
        else if (!std::strcmp(argv[i], "--scene"))
            options.scene = value();
        else if (!std::strcmp(argv[i], "--meshes"))
            options.folder = value();
        else if (!std::strcmp(argv[i], "--steps"))
            options.steps = static_cast<std::size_t>(std::atoi(value()));
        else if (!std::strcmp(argv[i], "--contacts"))
            options.constraints = false;
        else if (!std::strcmp(argv[i], "--copy"))
            options.borrow = false;
        else
            throw std::runtime_error(std::string("unknown option ") + argv[i]);
    }
    for (const bench::SceneMaker& maker : bench::scene_makers(options.folder)) {
        if (!options.scene.empty() && maker.name != options.scene) continue;
        bench::Scene scene = maker.make(options.tets, false);
        report(scene, options);
    }
    return 0;
}

} // namespace

int main(int argc, char** argv) {
    return bench::run_program("bench_memory", [&] { return run(argc, argv); });
}
