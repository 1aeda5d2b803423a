// A long run of a grid that chooses its cell size itself, beside grids of the same bodies with fixed sizes:
// two balls in contact are inflated tenfold, sink into each other, are cut in half, a fine ball is added and
// removed. Writes a line of times for each step; bench/cell_size/adaptive.py makes the picture.
//
// All grids make each step once, one after the other, so that each finds the caches as the previous one left
// them.
#include "bodies.hpp"
#include "program.hpp"
#include "scenes/counters.h"
#include "scenes/engines.h"
#include "timing.h"

#include <vox/vox.h>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

namespace bench {
namespace {

// ---- the bodies -----------------------------------------------------------------------------------

struct Ball {
    Solid solid;
    double scale = 1;  // of its edges
    double radius = 0; // undeformed
    Vec3 place{0, 0, 0};
    std::size_t cut = 0;          // tetrahedra that are off
    std::vector<float> positions; // as they are now

    Ball(Solid s, double unit, double r) : solid(std::move(s)), scale(unit), radius(r) {
        positions.resize(3 * solid.positions.size());
    }

    // Waves run through it, so that it never rests.
    void pose(double inflation, int step) {
        for (std::size_t v = 0; v < solid.positions.size(); ++v) {
            const Vec3 &p = solid.positions[v], q{scale * p.x, scale * p.y, scale * p.z};
            const Vec3 moved = waved({place.x + q.x, place.y + q.y, place.z + q.z}, q, 0.01 * radius,
                                     std::numbers::pi / radius, 0.1 * step);
            float* to = &positions[3 * v];
            to[0] = static_cast<float>(inflation * moved.x);
            to[1] = static_cast<float>(inflation * moved.y);
            to[2] = static_cast<float>(inflation * moved.z);
        }
    }
};

// The tetrahedra on one side of a plane through the centre.
std::vector<std::uint32_t> half_of(const Solid& solid) {
    std::vector<std::uint32_t> half;
    for (std::uint32_t t = 0; t < solid.tets.size() / 4; ++t) {
        double z = 0;
        for (std::size_t i = 0; i < 4; ++i) z += solid.positions[solid.tets[4 * t + i]].z;
        if (z < 0) half.push_back(t);
    }
    return half;
}

// ---- the grids ------------------------------------------------------------------------------------

class Grid {
public:
    explicit Grid(engine_kind engine) {
        vox_grid_desc desc = vox_default_grid_desc();
        use_engine(&desc, engine);
        desc.flags = 0; // contacts alone
        desc.byte_budget = UINT64_MAX;
        must(vox_grid_create(&desc, &grid_));
    }
    ~Grid() { vox_grid_destroy(grid_); }
    Grid(const Grid&) = delete;
    Grid& operator=(const Grid&) = delete;

    void insert(const Ball& ball) {
        vox_mesh_desc desc = vox_default_mesh_desc();
        desc.positions.data = ball.positions.data();
        desc.positions.count = ball.positions.size() / 3;
        desc.tets = ball.solid.tets.data();
        desc.tet_count = ball.solid.tets.size() / 4;
        vox_body mesh = 0;
        must(vox_mesh_insert(grid_, &desc, &mesh));
        meshes_.push_back(mesh);
    }
    void cut(std::size_t i, const std::vector<std::uint32_t>& tets) {
        must(vox_mesh_set_tets_enabled(grid_, meshes_[i], tets.data(), tets.size(), 0));
    }
    void remove(std::size_t i) {
        must(vox_body_remove(grid_, meshes_[i]));
        meshes_.erase(meshes_.begin() + static_cast<std::ptrdiff_t>(i));
    }

    // 0: with its own choice.
    double step(double cell_size) {
        if (cell_size > 0) must(vox_grid_set_cell_size(grid_, cell_size));
        return seconds_of([&] { must(vox_grid_step(grid_)); });
    }
    double cell_size() const {
        vox_grid_info info;
        info.struct_size = sizeof info;
        must(vox_grid_get_info(grid_, &info));
        return info.cell_size;
    }
    grid_counts counters() const {
        grid_counts counters{};
        counters = counters_of(grid_);
        return counters;
    }
    // Of the last step, outside all stages: where the cell size is chosen.
    double other_seconds() const {
        grid_times p{};
        p = times_of(grid_);
        return 1e-9 * static_cast<double>(p.step_ns - p.bin_ns - p.broad_ns - p.narrow_ns - p.contacts_ns -
                                          p.depth_ns - p.pairs_ns);
    }
    std::uint64_t hash() const {
        std::uint64_t hash = 0;
        must(vox_grid_get_hash(grid_, &hash));
        return hash;
    }

private:
    vox_grid* grid_ = nullptr;
    std::vector<vox_body> meshes_;
};

// ---- the run --------------------------------------------------------------------------------------

struct Phase {
    const char* name;
    int steps;
};
constexpr Phase phases[] = {{"contact", 60}, {"inflated", 80}, {"sinking", 60},
                            {"cut", 50},     {"added", 70},    {"removed", 50}};

// The addresses of a grid's memory alone change times by per cents. So the fixed sizes go round among their
// grids, and of this many grids that choose, the middle time counts.
constexpr int choosing = 3;

// From a quarter of an edge to four.
double fixed_size(std::size_t i, std::size_t sizes) {
    return 0.25 * std::pow(16, static_cast<double>(i) / static_cast<double>(sizes - 1));
}

void run_engine(engine_kind engine, double tets, int sizes, std::FILE* out) {
    const double radius = ball_radius(tets / 2);
    std::vector<std::unique_ptr<Grid>> grids;
    const std::size_t fixed = static_cast<std::size_t>(sizes), all = choosing + fixed;
    for (std::size_t i = 0; i < all; ++i) grids.push_back(std::make_unique<Grid>(engine));
    std::vector<std::unique_ptr<Ball>> balls;
    double inflation = 1;
    int step = 0;
    const auto insert = [&](std::unique_ptr<Ball> ball) {
        ball->pose(inflation, step);
        for (auto& grid : grids) grid->insert(*ball);
        balls.push_back(std::move(ball));
    };
    const auto remove = [&](std::size_t i) {
        for (auto& grid : grids) grid->remove(i);
        balls.erase(balls.begin() + static_cast<std::ptrdiff_t>(i));
    };
    insert(std::make_unique<Ball>(lattice_ball(tets / 2, 1), 1, radius));
    insert(std::make_unique<Ball>(lattice_ball(tets / 2, 2), 1, radius));
    balls[1]->place = {1.8 * radius, 0.01 * radius, 0.02 * radius};

    for (const Phase& phase : phases) {
        const std::string name = phase.name;
        if (name == "cut")
            for (std::size_t i = 0; i < balls.size(); ++i) {
                const std::vector<std::uint32_t> half = half_of(balls[i]->solid);
                for (auto& grid : grids) grid->cut(i, half);
                balls[i]->cut = half.size();
            }
        if (name == "added") {
            const double fine = 0.1 * ball_radius(tets / 2);
            auto ball = std::make_unique<Ball>(lattice_ball(tets / 2, 3), 0.1, fine);
            ball->place = {-0.3 * radius, 0, 0.3 * radius};
            insert(std::move(ball));
        }
        if (name == "removed") remove(2);
        for (int i = 0; i < phase.steps; ++i, ++step) {
            if (name == "inflated") inflation *= std::pow(10, 1.0 / phase.steps);
            if (name == "sinking") balls[1]->place.x -= radius / phase.steps;
            std::size_t all_tets = 0;
            for (auto& ball : balls) {
                ball->pose(inflation, step);
                all_tets += ball->solid.tets.size() / 4 - ball->cut;
            }
            // Each grid's turn is at another place in each step, and each size's grid another one.
            std::vector<double> seconds(all);
            const auto now = static_cast<std::size_t>(step);
            for (std::size_t turn = 0; turn < all; ++turn) {
                const std::size_t g = (turn + 7 * now) % all, size = (g + now) % fixed;
                if (g < choosing)
                    seconds[g] = grids[g]->step(0);
                else
                    seconds[choosing + size] = grids[g]->step(fixed_size(size, fixed) * inflation);
            }
            std::sort(seconds.begin(), seconds.begin() + choosing);
            std::vector<double> other;
            for (std::size_t g = 0; g < choosing; ++g) other.push_back(grids[g]->other_seconds());
            std::sort(other.begin(), other.end());
            for (auto& grid : grids)
                if (grid->hash() != grids[0]->hash())
                    throw std::runtime_error("contacts depend on the cell size");
            const grid_counts counters = grids[0]->counters();
            std::fprintf(out, "%s,%d,%s,%zu,%llu,%llu,%.5g,%.5g,%.4g,%.4g",
                         engine == ENGINE_FAST ? "fast" : "reference", step, phase.name, all_tets,
                         static_cast<unsigned long long>(counters.contacts),
                         static_cast<unsigned long long>(counters.cell_size_changes),
                         grids[0]->cell_size() / inflation, inflation, other[choosing / 2] * 1e3,
                         grids[choosing]->other_seconds() * 1e3);
            std::fprintf(out, ",%.5g", seconds[choosing / 2] * 1e3);
            for (std::size_t i = choosing; i < all; ++i) std::fprintf(out, ",%.5g", seconds[i] * 1e3);
            std::fprintf(out, "\n");
            std::fflush(out);
        }
    }
}

int run(int argc, char** argv) {
    CLI::App app("A grid that chooses its cell size, beside fixed sizes, as its bodies change");
    std::string csv;
    double tets = 40000;
    int sizes = 20;
    std::vector<std::string> engines = {"reference", "fast"};
    app.add_option("--tets", tets, "Of the two balls together");
    app.add_option("--sizes", sizes, "Fixed cell sizes from 0.25 to 4 edges")->check(CLI::Range(2, 100));
    app.add_option("--engine", engines, "reference, fast")->delimiter(',');
    app.add_option("--csv", csv, "Where to write")->required();
    CLI11_PARSE(app, argc, argv);
    std::FILE* out = std::fopen(csv.c_str(), "w");
    if (!out) throw std::runtime_error("cannot write " + csv);
    std::fprintf(
        out, "engine,step,phase,tets,contacts,changes,cell_size,inflation,other_ms,fixed_other_ms,chosen_ms");
    for (int i = 0; i < sizes; ++i)
        std::fprintf(out, ",%.4g", fixed_size(static_cast<std::size_t>(i), static_cast<std::size_t>(sizes)));
    std::fprintf(out, "\n");
    for (const std::string& engine : engines)
        run_engine(engine == "fast" ? ENGINE_FAST : ENGINE_REFERENCE, tets, sizes, out);
    if (std::fclose(out) != 0) throw std::runtime_error("cannot write " + csv);
    return 0;
}

} // namespace
} // namespace bench

int main(int argc, char** argv) {
    return bench::run_program("adaptive", [&] { return bench::run(argc, argv); });
}
