// Times are fitted as sums of counts times weights by least squares with weights that are not negative (C. L.
// Lawson, R. J. Hanson, Solving Least Squares Problems, 1974), solved by coordinate descent, since there are
// only six of them. Weights that a few short steps cannot separate stay near those shipped, scaled to the
// machine's speed.
#include "base/array.hpp"
#include "cell_size/weights.hpp"

#include "base/clock.hpp"
#include "base/sampling.hpp"
#include "cell_size/fast_model.hpp"
#include "cell_size/reference_model.hpp"
#include "fast/engine.hpp"
#include "mesh/cube_lattice.h"
#include "reference/engine.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace vox {

namespace {

constexpr std::size_t unknowns = 6; // at most; the rest have a count of 0

// A time in nanoseconds, and how often each piece of work was done in it.
struct Timing {
    double time;
    std::array<double, unknowns> count;
};

// The weights that fit the timings best, relative to each. The scene is small and stays in the cache, which
// larger ones do not, so weights are drawn towards the proportions of the shipped ones, which come from
// scenes of all sizes, and stay within a factor of three of what those would be on a machine of this speed.
std::array<double, unknowns> fit(const std::vector<Timing>& timings,
                                 const std::array<double, unknowns>& shipped) {
    // How much slower the machine is than the one the shipped weights are for.
    double ratio = 0;
    for (const Timing& t : timings) {
        double predicted = 0;
        for (std::size_t i = 0; i < unknowns; ++i) predicted += t.count[i] * shipped[i];
        ratio += t.time / predicted / static_cast<double>(timings.size());
    }
    constexpr double leeway = 3, pull = 0.3;
    std::array<double, unknowns> x{};
    for (std::size_t i = 0; i < unknowns; ++i) x[i] = 1; // in units of shipped * ratio
    const auto part = [&](const Timing& t, std::size_t i) {
        return t.count[i] * shipped[i] * ratio / t.time;
    };
    for (int round = 0; round < 200; ++round)
        for (std::size_t i = 0; i < unknowns; ++i) {
            double square = pull, product = pull; // towards 1
            for (const Timing& t : timings) {
                double rest = 1;
                for (std::size_t j = 0; j < unknowns; ++j)
                    if (j != i) rest -= part(t, j) * x[j];
                square += part(t, i) * part(t, i);
                product += part(t, i) * rest;
            }
            x[i] = std::clamp(product / square, 1 / leeway, leeway);
        }
    for (std::size_t i = 0; i < unknowns; ++i) x[i] *= shipped[i] * ratio;
    return x;
}

// A block of n * n * n cubes from `corner` on along x, six tetrahedra around the diagonal of each (Kuhn), its
// vertices moved about a little.
struct Block {
    std::vector<Vec3f> positions;
    std::vector<Tet> tets;

    Block(std::uint32_t n, float corner) : positions((n + 1) * (n + 1) * (n + 1)), tets(6 * n * n * n) {
        write_lattice_positions(n, n, n, &positions[0].x);
        write_lattice_tets(&kuhn_cut, n, n, n, tets[0].v);
        std::uint64_t random = 1;
        const auto jitter = [&] {
            return static_cast<float>(next_below(random, 65536)) * (0.2f / 65536) - 0.1f;
        };
        for (Vec3f& p : positions) {
            const float x = jitter(), y = jitter(), z = jitter();
            p = {corner + p.x + x, p.y + y, p.z + z};
        }
    }
};

struct Scene {
    Scene(std::uint32_t n, float overlap)
        : blocks{Block(n, 0), Block(n, static_cast<float>(n) - overlap)},
          meshes{TiledMesh(memory()), TiledMesh(memory())}, states{fast::MeshState(memory()),
                                                                   fast::MeshState(memory())} {
        for (std::size_t b = 0; b < 2; ++b) {
            bodies[b].mesh_id = static_cast<std::uint32_t>(b);
            bodies[b].vertex_count = static_cast<std::uint32_t>(blocks[b].positions.size());
            bodies[b].positions = {reinterpret_cast<const std::byte*>(blocks[b].positions.data()),
                                   sizeof(Vec3f)};
            bodies[b].tets = blocks[b].tets;
            bodies[b].self_collision = true; // some of what is prepared is only for that
            make_tiled_mesh(bodies[b], meshes[b]);
            states[b].update(meshes[b], 1, bodies[b].vertex_count);
            prepared[b] = {&meshes[b].tiles, &meshes[b].boundary, &states[b]};
        }
    }
    Scene(const Scene&) = delete;
    Scene& operator=(const Scene&) = delete;

    static std::pmr::memory_resource* memory() { return std::pmr::new_delete_resource(); }

    std::array<Block, 2> blocks;
    std::array<TiledMesh, 2> meshes;
    std::array<fast::MeshState, 2> states;
    std::array<fast::PreparedBody, 2> prepared;
    std::array<Body, 2> bodies;
};

constexpr double cell_sizes[] = {0.7, 1.1, 1.8, 3};

// The shortest of some runs, since disturbances only add time.
template <class Work>
double shortest(int times, Work&& work) {
    double best = std::numeric_limits<double>::infinity();
    for (int i = 0; i < times; ++i) {
        const std::uint64_t start = nanoseconds();
        work();
        best = std::min(best, static_cast<double>(nanoseconds() - start));
    }
    return best;
}

void measure_reference(Scene& scene, CostWeights& weights) {
    ReferenceEngine engine(Scene::memory());
    Array<Hit> hits(Scene::memory());
    Counters counters{};
    Profile profile{};
    std::vector<Timing> timings;
    for (const bool self : {false, true}) {
        for (Body& body : scene.bodies) body.self_collision = self;
        CellSizeScene described(Scene::memory());
        described.bodies.assign(scene.bodies.begin(), scene.bodies.end());
        const ReferenceModel cost(described, false, weights);
        for (const double cell_size : cell_sizes) {
            ReferenceSettings settings;
            settings.cell_size = cell_size;
            const double time = shortest(2, [&] {
                hits.clear();
                engine.detect(scene.bodies, settings, hits, counters, profile);
            });
            // Everything that does not depend on the cell size is one unknown.
            const double tets =
                static_cast<double>(scene.bodies[0].tets.size() + scene.bodies[1].tets.size());
            const auto vertices = static_cast<double>(counters.entries);
            const double fixed = vertices * (weights.classify_vertex + 2 * weights.clear_bucket) +
                                 tets * weights.prepare_tet + cost.candidates() * weights.test_tet;
            const ReferenceModel::Work work = cost.work(cell_size);
            timings.push_back(
                {time, {fixed, work.visited, work.changed, work.read, work.fetched, work.tested}});
        }
    }
    const std::array<double, unknowns> x =
        fit(timings, {1, weights.visit_cell, weights.changed_list, weights.read_vertex, weights.fetch_vertex,
                      weights.test_box});
    weights.classify_vertex *= x[0];
    weights.prepare_tet *= x[0];
    weights.test_tet *= x[0];
    weights.clear_bucket *= x[0];
    weights.scan_cell *= x[1] / weights.visit_cell;
    weights.visit_cell = x[1];
    weights.changed_list = x[2];
    weights.read_vertex = x[3];
    weights.fetch_vertex = x[4];
    weights.test_box = x[5];
}

void measure_fast(Scene& scene, CostWeights& weights) {
    FastEngine engine(Scene::memory());
    Array<Hit> hits(Scene::memory());
    Counters counters{};
    Profile profile{};
    for (Body& body : scene.bodies) body.self_collision = true;
    CellSizeScene described(Scene::memory());
    described.bodies.assign(scene.bodies.begin(), scene.bodies.end());
    for (const auto& mesh : scene.meshes) described.tiles.push_back(&mesh.tiles);
    described.prepare(VOX_COST_MODEL_FAST);
    const FastModel cost(described, weights);
    std::vector<Timing> timings;
    for (const double cell_size : cell_sizes) {
        FastSettings settings;
        settings.cell_size = cell_size;
        settings.winding = false;
        const double time = shortest(4, [&] {
            hits.clear();
            engine.detect(scene.bodies, scene.prepared, settings, hits, counters, profile);
        });
        const FastModel::Counts c = cost.counts(cell_size, FastModel::Alignment::actual);
        const double fixed =
            c.vertices * weights.bin_vertex + c.looks * weights.visit_tile + c.tested * weights.test_vertex;
        timings.push_back({time, {fixed, c.cells, c.rows, c.read, 0, 0}});
    }
    const std::array<double, unknowns> x =
        fit(timings, {1, weights.clear_cell, weights.visit_row, weights.found_vertex, 1, 1});
    weights.bin_vertex *= x[0];
    weights.visit_tile *= x[0];
    weights.test_vertex *= x[0];
    weights.clear_cell = x[1];
    weights.visit_row = x[2];
    weights.found_vertex = x[3];
}

} // namespace

CostWeights measured_weights() {
    CostWeights weights = shipped_weights;
    Scene scene(6, 1.5f);
    measure_reference(scene, weights);
    measure_fast(scene, weights);
    return weights;
}

} // namespace vox
