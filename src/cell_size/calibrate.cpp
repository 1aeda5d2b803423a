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
#include <numeric>
#include <vector>

namespace vox {

namespace {

constexpr std::size_t most_terms = VOX_TERM_CAPACITY;
// The terms of a cost, and their weights in that order. Terms of one group have one unknown: those of group 0
// do not depend on the cell size.
using Weights = std::array<double CostWeights::*, most_terms>;
using Groups = std::array<std::size_t, most_terms>;
constexpr Weights of_reference{&CostWeights::classify_vertex, &CostWeights::prepare_tet,
                               &CostWeights::visit_cell,      &CostWeights::changed_list,
                               &CostWeights::scan_cell,       &CostWeights::read_vertex,
                               &CostWeights::fetch_vertex,    &CostWeights::test_box,
                               &CostWeights::test_tet,        &CostWeights::clear_bucket};
constexpr Groups groups_of_reference{0, 0, 1, 2, 1, 3, 4, 5, 0, 0};
constexpr Weights of_fast{&CostWeights::bin_vertex, &CostWeights::clear_cell,   &CostWeights::visit_tile,
                          &CostWeights::visit_row,  &CostWeights::found_vertex, &CostWeights::test_vertex};
constexpr Groups groups_of_fast{0, 1, 0, 2, 3, 0};

// The costs of the groups with the shipped weights, over the time that a step took.
constexpr std::size_t unknowns = 6; // at most
using Timing = std::array<double, unknowns>;

Timing timed(const CostTerms& terms, const Groups& groups, double time) {
    Timing timing{};
    const std::size_t* group = groups.data();
    for (const vox_cost_term& term : terms) timing[*group++] += term.cost / time;
    return timing;
}

// Multiplies the weights by what fits the timings best, relative to each. The scene is small and stays in the
// cache, which larger ones do not, so weights are drawn towards the proportions of the shipped ones, which
// come from scenes of all sizes, and stay within a factor of three of what those would be on a machine of
// this speed.
void fit(const std::vector<Timing>& timings, const Weights& of, const Groups& groups, CostWeights& weights) {
    // How much slower the machine is than the one the shipped weights are for.
    double ratio = 0;
    for (const Timing& t : timings)
        ratio += 1 / std::accumulate(t.begin(), t.end(), 0.0) / static_cast<double>(timings.size());
    constexpr double leeway = 3, pull = 0.3;
    Timing x; // in units of shipped * ratio
    x.fill(1);
    for (int round = 0; round < 200; ++round)
        for (std::size_t i = 0; i < unknowns; ++i) {
            double square = pull, product = pull; // towards 1
            for (const Timing& t : timings) {
                double rest = 1;
                for (std::size_t j = 0; j < unknowns; ++j)
                    if (j != i) rest -= t[j] * ratio * x[j];
                square += t[i] * ratio * (t[i] * ratio);
                product += t[i] * ratio * rest;
            }
            x[i] = std::clamp(product / square, 1 / leeway, leeway);
        }
    for (std::size_t i = 0; i < most_terms && of[i]; ++i) weights.*of[i] *= x[groups[i]] * ratio;
}

// A block of n * n * n cubes from `corner` on along x, six tetrahedra around the diagonal of each (Kuhn), its
// vertices moved about a little.
void make_block(std::uint32_t n, float corner, std::vector<Vec3f>& positions, std::vector<Tet>& tets) {
    positions.resize((n + 1) * (n + 1) * (n + 1));
    tets.resize(6 * n * n * n);
    write_lattice_positions(n, n, n, &positions[0].x);
    write_lattice_tets(&kuhn_cut, n, n, n, tets[0].v);
    std::uint64_t random = 1;
    const auto jitter = [&] { return static_cast<float>(next_below(random, 65536)) * (0.2f / 65536) - 0.1f; };
    for (Vec3f& p : positions) {
        const float x = jitter(), y = jitter(), z = jitter();
        p = {corner + p.x + x, p.y + y, p.z + z};
    }
}

// Two blocks that overlap.
struct Scene {
    Scene(std::uint32_t n, float overlap)
        : meshes{TiledMesh(memory()), TiledMesh(memory())}, states{fast::MeshState(memory()),
                                                                   fast::MeshState(memory())},
          described(memory()) {
        for (std::size_t b = 0; b < 2; ++b) {
            make_block(n, b == 0 ? 0 : static_cast<float>(n) - overlap, positions[b], tets[b]);
            bodies[b].mesh_id = static_cast<std::uint32_t>(b);
            bodies[b].vertex_count = static_cast<std::uint32_t>(positions[b].size());
            bodies[b].positions = {reinterpret_cast<const std::byte*>(positions[b].data()), sizeof(Vec3f)};
            bodies[b].tets = tets[b];
            bodies[b].self_collision = true; // some of what is prepared is only for that
            make_tiled_mesh(bodies[b], meshes[b]);
            states[b].update(meshes[b], 1, bodies[b].vertex_count);
            prepared[b] = {&meshes[b].tiles, &meshes[b].boundary, &states[b]};
            described.tiles.push_back(&meshes[b].tiles);
        }
        described.bodies.resize(2);
    }
    Scene(const Scene&) = delete;
    Scene& operator=(const Scene&) = delete;

    void set_self_collision(bool self) {
        for (Body& body : bodies) body.self_collision = self;
        std::ranges::copy(bodies, described.bodies.begin());
    }
    static std::pmr::memory_resource* memory() { return std::pmr::new_delete_resource(); }

    std::array<std::vector<Vec3f>, 2> positions;
    std::array<std::vector<Tet>, 2> tets;
    std::array<TiledMesh, 2> meshes;
    std::array<fast::MeshState, 2> states;
    std::array<fast::PreparedBody, 2> prepared;
    std::array<Body, 2> bodies;
    CellSizeScene described;
};

constexpr double cell_sizes[] = {0.7, 1.1, 1.8, 3};

// The shortest of some runs, since disturbances only add time. Where the clock stands still during a run, as
// the coarse one of a browser may, the run is repeated until it moves: no work takes no time.
template <class Work>
double shortest(int times, Work&& work) {
    double best = std::numeric_limits<double>::infinity();
    for (int i = 0; i < times; ++i) {
        const std::uint64_t start = nanoseconds();
        std::uint64_t passed = 0;
        int runs = 0;
        for (; passed == 0; ++runs, passed = nanoseconds() - start) work();
        best = std::min(best, static_cast<double>(passed) / runs);
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
        scene.set_self_collision(self);
        const ReferenceModel cost(scene.described, false, weights);
        for (const double cell_size : cell_sizes) {
            ReferenceSettings settings;
            settings.cell_size = cell_size;
            const double time = shortest(2, [&] {
                hits.clear();
                engine.detect(scene.bodies, settings, hits, counters, profile);
            });
            timings.push_back(timed(cost.terms(cell_size), groups_of_reference, time));
        }
    }
    fit(timings, of_reference, groups_of_reference, weights);
}

void measure_fast(Scene& scene, CostWeights& weights) {
    FastEngine engine(Scene::memory());
    Array<Hit> hits(Scene::memory());
    Counters counters{};
    Profile profile{};
    scene.set_self_collision(true);
    scene.described.prepare(VOX_COST_MODEL_FAST);
    const FastModel cost(scene.described, weights);
    std::vector<Timing> timings;
    for (const double cell_size : cell_sizes) {
        FastSettings settings;
        settings.cell_size = cell_size;
        settings.winding = false;
        const double time = shortest(4, [&] {
            hits.clear();
            engine.detect(scene.bodies, scene.prepared, settings, hits, counters, profile);
        });
        timings.push_back(timed(cost.terms(cell_size, true), groups_of_fast, time));
    }
    fit(timings, of_fast, groups_of_fast, weights);
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
