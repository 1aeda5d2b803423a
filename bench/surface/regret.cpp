// What the cell sizes that are suggested for surfaces lose: edges with edges and faces with vertices of one
// surface, standing still or on their way to the next frame, at cell sizes of a sweep, at the one that
// VOX_COST_MODEL_SURFACE suggests for both searches, and at those that the surface chooses for each.
//
// In each round every size has one turn and counts by its time over that of the model's. Which size of the
// sweep is best is decided by one half of the rounds, and what is lost beside it by the other half, and the
// other way round: so a size that was only lucky is no loss to the others. The model's size has two turns;
// by how much they differ is the noise.
//
// Usage: bench_surface_regret [tetrahedra [rounds [scene]]], 30000, 20 and every scene without a file by
// default.
#include "program.hpp"
#include "scenes.hpp"
#include "timing.h"

#include <vox/vox_surface.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>

namespace bench {
namespace {

// All bodies of a scene as one surface, with its positions in two frames.
struct Surface {
    std::vector<float> from, to;
    std::vector<std::uint32_t> faces;
};

Surface surface_of(Scene& scene) {
    Surface surface;
    scene.pose(1 % scene.frame_count());
    for (const Body& body : scene.bodies)
        surface.to.insert(surface.to.end(), body.positions.begin(),
                          body.positions.begin() + static_cast<std::ptrdiff_t>(3 * body.vertex_count()));
    scene.pose(0);
    constexpr std::uint8_t corners[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
    for (const Body& body : scene.bodies) {
        const auto first = static_cast<std::uint32_t>(surface.from.size() / 3);
        surface.from.insert(surface.from.end(), body.positions.begin(),
                            body.positions.begin() + static_cast<std::ptrdiff_t>(3 * body.vertex_count()));
        std::map<std::array<std::uint32_t, 3>, std::pair<std::array<std::uint32_t, 3>, int>> facets;
        for (std::size_t t = 0; t < body.tet_count(); ++t)
            for (const auto& c : corners) {
                const std::uint32_t* const tet = body.tets.data() + 4 * t;
                const std::array<std::uint32_t, 3> facet{tet[c[0]], tet[c[1]], tet[c[2]]};
                std::array<std::uint32_t, 3> key = facet;
                std::sort(key.begin(), key.end());
                auto& [corners_of, count] = facets[key];
                corners_of = facet;
                ++count;
            }
        for (const auto& [key, facet] : facets)
            if (facet.second == 1)
                for (const std::uint32_t v : facet.first) surface.faces.push_back(first + v);
    }
    return surface;
}

// The surface without the vertices that no face names: those of the inside.
void drop_inner_vertices(Surface& surface) {
    constexpr std::uint32_t unnamed = ~0u;
    std::vector<std::uint32_t> number(surface.from.size() / 3, unnamed);
    Surface kept;
    for (const std::uint32_t v : surface.faces) {
        if (number[v] == unnamed) {
            number[v] = static_cast<std::uint32_t>(kept.from.size() / 3);
            for (int axis = 0; axis < 3; ++axis) {
                kept.from.push_back(surface.from[3 * v + axis]);
                kept.to.push_back(surface.to[3 * v + axis]);
            }
        }
        kept.faces.push_back(number[v]);
    }
    surface = std::move(kept);
}

class Searches {
public:
    Searches(const Surface& surface, bool moves) {
        vox_surface_desc desc = vox_default_surface_desc();
        desc.vertex_count = surface.from.size() / 3;
        desc.faces = surface.faces.data();
        desc.face_count = surface.faces.size() / 3;
        must(vox_surface_create(&desc, &surface_));
        vox_motion motion = vox_default_motion();
        motion.from.data = surface.from.data();
        motion.to.data = moves ? surface.to.data() : nullptr;
        motion.from.count = motion.to.count = desc.vertex_count;
        motion.from.format = motion.to.format = VOX_FORMAT_FLOAT;
        must(vox_surface_move(surface_, &motion));
    }
    ~Searches() { vox_surface_destroy(surface_); }
    Searches(const Searches&) = delete;
    Searches& operator=(const Searches&) = delete;

    std::uint64_t pairs() {
        vox_partner_lists lists{};
        must(vox_surface_find_pairs(surface_, VOX_FEATURE_EDGE, VOX_FEATURE_EDGE, 0, UINT64_MAX, &lists));
        const std::uint64_t of_edges = lists.offsets[lists.count];
        must(vox_surface_find_pairs(surface_, VOX_FEATURE_FACE, VOX_FEATURE_VERTEX, 0, UINT64_MAX, &lists));
        return of_edges + lists.offsets[lists.count];
    }
    // Seconds of both searches; a turn is long enough to be measured.
    double turn(double cell_size) {
        must(vox_surface_set_cell_size(surface_, cell_size));
        pairs(); // chooses the size, where that is asked for, and makes room
        return seconds_of([&] {
                   for (int i = 0; i < searches_; ++i) pairs();
               }) /
               searches_;
    }
    void set_turn(double seconds) { searches_ = std::max(1, static_cast<int>(5e-3 / seconds)); }

private:
    vox_surface* surface_ = nullptr;
    int searches_ = 1;
};

double half_ratio(const std::vector<double>& a, const std::vector<double>& b, std::size_t half) {
    std::vector<double> ratios;
    for (std::size_t i = half; i < a.size(); i += 2) ratios.push_back(a[i] / b[i]);
    return median(ratios);
}

struct Losses {
    double model, own;
};

Losses measure(Scene& scene, const Surface& surface, bool moves, int rounds) {
    std::vector<vox_mesh_desc> meshes;
    for (const Body& body : scene.bodies) meshes.push_back(body.desc());
    vox_cell_size_desc desc = vox_default_cell_size_desc();
    desc.model = VOX_COST_MODEL_SURFACE;
    vox_cell_size_result suggestion{};
    suggestion.struct_size = sizeof suggestion;
    must(vox_suggest_cell_size(&desc, meshes.data(), meshes.size(), &suggestion));

    constexpr int steps = 12; // three to an octave, in either direction
    enum { MODEL, AGAIN, OWN, SWEEP };
    std::vector<double> sizes{suggestion.cell_size, suggestion.cell_size, 0};
    for (int k = -steps; k <= steps; ++k) sizes.push_back(suggestion.cell_size * std::exp2(k / 3.0));
    Searches searches(surface, moves);
    searches.set_turn(searches.turn(suggestion.cell_size));
    std::vector<std::vector<double>> seconds(sizes.size());
    for (int round = 0; round < rounds; ++round)
        for (std::size_t i = 0; i < sizes.size(); ++i) { // another one begins in each round
            const std::size_t k = (i + static_cast<std::size_t>(round)) % sizes.size();
            seconds[k].push_back(searches.turn(sizes[k]));
        }
    Losses losses{0, 0};
    double best_size = 1;
    for (std::size_t half = 0; half < 2; ++half) {
        std::size_t best = SWEEP;
        for (std::size_t k = SWEEP; k < sizes.size(); ++k)
            if (half_ratio(seconds[k], seconds[MODEL], half) <
                half_ratio(seconds[best], seconds[MODEL], half))
                best = k;
        best_size *= std::sqrt(sizes[best] / suggestion.cell_size);
        losses.model += (half_ratio(seconds[MODEL], seconds[best], 1 - half) - 1) / 2;
        losses.own += (half_ratio(seconds[OWN], seconds[best], 1 - half) - 1) / 2;
    }
    const double noise = std::abs(median(seconds[AGAIN]) / median(seconds[MODEL]) - 1);
    std::printf("| %s | %s | %zu | %llu | %.2f | %.2f | %+.1f %% | %+.1f %% | %.1f %% |\n",
                scene.name.c_str(), moves ? "moves" : "stands still", surface.faces.size() / 3,
                static_cast<unsigned long long>(searches.pairs()), 1e3 * median(seconds[MODEL]), best_size,
                100 * losses.model, 100 * losses.own, 100 * noise);
    std::fflush(stdout);
    return losses;
}

int run(int argc, char** argv) {
    const double tets = argc > 1 ? std::atof(argv[1]) : 30000;
    const int rounds = argc > 2 ? std::atoi(argv[2]) : 20;
    if (!(tets >= 1000) || rounds < 2) throw std::runtime_error("at least 1000 tetrahedra and 2 rounds");
    std::printf("| scene | it | faces | pairs | ms | best size over the model's | the model loses | the "
                "surface's own choices "
                "lose | noise |\n|---|---|---|---|---|---|---|---|---|\n");
    std::vector<double> model, own;
    for (const SceneMaker& maker : named(scene_makers(""))) {
        if (argc > 3 && maker.name != argv[3]) continue;
        if (maker.name.ends_with("-rest")) continue; // the positions of another one
        Scene scene = maker.make(tets, false);
        Surface surface = surface_of(scene);
        drop_inner_vertices(surface);
        for (const bool moves : {false, true}) {
            const Losses losses = measure(scene, surface, moves, rounds);
            model.push_back(losses.model);
            own.push_back(losses.own);
        }
    }
    if (model.empty()) throw std::runtime_error("no such scene");
    for (const auto& [name, losses] : {std::pair("model", model), {"own choices", own}})
        std::printf("%s: median %+.1f %%, worst %+.1f %%\n", name, 100 * median(losses),
                    100 * *std::max_element(losses.begin(), losses.end()));
    return 0;
}

} // namespace
} // namespace bench

int main(int argc, char** argv) {
    return bench::run_program("bench_surface_regret", [&] { return bench::run(argc, argv); });
}
