// Cost of vox_grid_find_constraints by each method, and of steps whose bodies rest in contact.
//
//   bench_constraints [--tets N] [--rounds K]
//
// Two smooth balls of N / 2 tetrahedra each, at several overlaps, and many small ones; every row is one
// scene. Times are the least of K rounds in which the rows take turns, on one thread, in nanoseconds a
// constraint. Each method has a step of its own before it, as one leaves what another can use. `copy` is a
// plain copy of the constraints, for comparison. What is timed is checked: those of a pair are among all, bit
// for bit, without depth there are the same stencils, and closest points are those of
// vox_locator_find_closest.
#include "internal/meshes.hpp"
#include "program.hpp"
#include "scenes/counters.h"
#include "stages/smooth_ball.hpp"
#include "timing.h"

#include <vox/vox_query.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using bench::must;
using vox::test::Mesh;

constexpr vox_depth_method methods[] = {VOX_DEPTH_METHOD_CONSISTENT, VOX_DEPTH_METHOD_CLOSEST,
                                        VOX_DEPTH_METHOD_NONE};

struct Times {
    double step = 1e18, of_method[3] = {1e18, 1e18, 1e18}, pair = 1e18, copy = 1e18;
};

void require(bool holds, const char* what) {
    if (!holds) throw std::runtime_error(what);
}

vox_body insert(vox_grid* grid, const Mesh& body) {
    vox_mesh_desc desc = vox_default_mesh_desc();
    desc.positions.data = body.positions.data();
    desc.positions.count = body.positions.size();
    desc.tets = body.tets.front().v;
    desc.tet_count = body.tets.size();
    if (body.self_collision) desc.filter.flags = VOX_FILTER_SELF_COLLISION;
    vox_body id = VOX_NULL_BODY;
    must(vox_mesh_insert(grid, &desc, &id));
    return id;
}

class Scene {
public:
    Scene(std::string name, std::vector<Mesh> bodies) : name_(std::move(name)), bodies_(std::move(bodies)) {
        must(vox_grid_create(nullptr, &grid_));
        for (const Mesh& body : bodies_) ids_.push_back(insert(grid_, body));
        check();
    }
    ~Scene() { vox_grid_destroy(grid_); }
    Scene(const Scene&) = delete;
    Scene& operator=(const Scene&) = delete;

    void run() {
        for (const vox_depth_method method : methods) {
            step();
            least(times_.of_method[method], [&] { find(method); });
            const vox_constraint_view found = view();
            copy_.resize(found.count);
            least(times_.copy, [&] { std::copy_n(found.data, found.count, copy_.data()); });
        }
        step();
        const vox_pair pair = pairs().data[pairs().count / 2];
        least(times_.pair, [&] { find(VOX_DEPTH_METHOD_CONSISTENT, pair.body_a, pair.body_b); });
        of_pair_ = view().count;
    }

    void print() const {
        const auto n = double(copy_.size());
        std::printf("%-10s %11zu %9.1f %10.0f %8.0f %8.1f %8.1f %8.0f %8.2f\n", name_.c_str(), copy_.size(),
                    times_.step * 1e-3, times_.of_method[0] / n, times_.of_method[1] / n,
                    times_.of_method[2] / n, times_.copy / n, times_.pair / double(of_pair_),
                    times_.of_method[0] / times_.step);
    }

private:
    template <class Work>
    static void least(double& nanoseconds, const Work& work) {
        nanoseconds = std::min(nanoseconds, 1e9 * seconds_of(work));
    }

    void step() {
        for (Mesh& body : bodies_) // another pose, mirrored: as much work
            for (vox::Vec3f& p : body.positions) p.y = -p.y;
        least(times_.step, [&] { must(vox_grid_step(grid_)); });
    }

    void find(vox_depth_method method, vox_body a = VOX_NULL_BODY, vox_body b = VOX_NULL_BODY) {
        vox_constraint_desc desc = vox_default_constraint_desc();
        desc.method = method;
        desc.body_a = a;
        desc.body_b = b;
        must(vox_grid_find_constraints(grid_, &desc));
    }

    vox_constraint_view view() const {
        vox_constraint_view found{};
        must(vox_grid_get_constraints(grid_, &found));
        return found;
    }
    std::vector<vox_constraint> all(vox_depth_method method) {
        find(method);
        return {view().data, view().data + view().count};
    }
    vox_pair_view pairs() const {
        vox_pair_view found{};
        must(vox_grid_get_pairs(grid_, &found));
        if (found.count == 0) throw std::runtime_error(name_ + ": no contacts; more tetrahedra are needed");
        return found;
    }

    void check() {
        must(vox_grid_step(grid_));
        const std::vector<vox_constraint> consistent = all(VOX_DEPTH_METHOD_CONSISTENT),
                                          closest = all(VOX_DEPTH_METHOD_CLOSEST),
                                          bare = all(VOX_DEPTH_METHOD_NONE);
        require(consistent.size() == bare.size() && closest.size() == bare.size(), "the same constraints");
        for (std::size_t i = 0; i < bare.size(); ++i) {
            vox_constraint without = consistent[i];
            without.state = VOX_DEPTH_UNKNOWN;
            without.gap = without.offset = 0;
            std::fill_n(without.normal, 3, 0.0);
            require(std::memcmp(&without, &bare[i], sizeof without) == 0,
                    "without depth, all else is the same");
        }
        const std::uint64_t pair_count = pairs().count;
        find(VOX_DEPTH_METHOD_CONSISTENT);
        const std::vector<std::uint64_t> offsets(view().pair_offsets, view().pair_offsets + pair_count + 1);
        for (std::uint64_t p = 0; p < pair_count; p += 1 + pair_count / 7) {
            find(VOX_DEPTH_METHOD_CONSISTENT, pairs().data[p].body_b, pairs().data[p].body_a);
            require(view().count == offsets[p + 1] - offsets[p], "the pair's constraints");
            require(std::memcmp(view().data, &consistent[offsets[p]], view().count * sizeof bare[0]) == 0,
                    "a pair's constraints are among all");
        }
        check_closest(closest);
    }

    // Some gaps against queries.
    void check_closest(const std::vector<vox_constraint>& closest) {
        for (std::size_t b = 0; b < ids_.size(); ++b) { // so that a query can ask one mesh
            vox_body_info info{};
            info.struct_size = sizeof info;
            must(vox_body_get_info(grid_, ids_[b], &info));
            info.filter.category = std::uint64_t{1} << b % 64;
            must(vox_body_set_filter(grid_, ids_[b], &info.filter));
        }
        vox_locator* locator = nullptr;
        must(vox_grid_update_locator(grid_, &locator));
        vox_query_desc one = vox_default_query_desc();
        for (std::size_t i = 0; i < closest.size() && ids_.size() <= 64; i += 1 + closest.size() / 200) {
            const vox_constraint& c = closest[i];
            if (c.body_a == c.body_b) continue; // another rule
            const auto b = std::find(ids_.begin(), ids_.end(), c.body_b) - ids_.begin();
            one.mask = std::uint64_t{1} << b;
            const vox_positions at = vox_double_positions(c.position, 1);
            vox_closest_hit hit{};
            must(vox_locator_find_closest(locator, &at, &one, &hit));
            require(std::abs(std::abs(hit.distance) + c.gap) <= 1e-12 * std::abs(c.gap),
                    "gaps are distances of queries");
        }
        vox_locator_release(locator);
    }

    std::string name_;
    std::vector<Mesh> bodies_;
    std::vector<vox_body> ids_;
    std::vector<vox_constraint> copy_;
    vox_grid* grid_ = nullptr;
    Times times_;
    std::uint64_t of_pair_ = 0;
};

std::unique_ptr<Scene> two_balls(const char* name, double tets, double overlap, double factor = 1,
                                 double radius = 1) {
    std::vector<Mesh> bodies{smooth_ball(tets / 2, 1), smooth_ball(tets / 2 * factor, radius)};
    vox::test::move(bodies[1], 1, 1 + radius - overlap, 0.0123, 0.0271);
    return std::make_unique<Scene>(name, std::move(bodies));
}

// A ball whose vertices are moved at random by up to an edge: most of it lies in itself.
std::unique_ptr<Scene> tangled_ball(const char* name, double tets) {
    vox::test::Random random{7};
    std::vector<Mesh> bodies{vox::test::ball(tets)};
    vox::test::jitter(bodies[0], 1, random);
    bodies[0].self_collision = true;
    return std::make_unique<Scene>(name, std::move(bodies));
}

// A lattice of balls, `apart` from centre to centre.
std::vector<Mesh> lattice(double tets, int across, double apart) {
    std::vector<Mesh> bodies;
    for (int i = 0; i < across * across * across; ++i) {
        bodies.push_back(smooth_ball(tets / (across * across * across), 1));
        vox::test::move(bodies.back(), 1, apart * (i % across), apart * (i / across % across),
                        apart * (i / across / across));
    }
    return bodies;
}

// What a step takes whose bodies touch and rest, all but one of them, without and with constraints.
void time_rest(double tets, int rounds) {
    constexpr int across = 4;
    double least[2] = {1e18, 1e18};
    grid_counts counters{};
    for (const bool with : {false, true}) {
        vox_grid* grid = nullptr;
        vox_grid_desc desc = vox_default_grid_desc();
        desc.flags = with ? VOX_GRID_CONSTRAINTS : 0;
        must(vox_grid_create(&desc, &grid));
        std::vector<Mesh> bodies = lattice(tets, across, 1.6);
        for (const Mesh& body : bodies) insert(grid, body);
        for (int round = 0; round < 4 * rounds; ++round) {
            for (vox::Vec3f& p : bodies[0].positions) p.x += round % 2 ? 0.001f : -0.001f;
            const double seconds = seconds_of([&] { must(vox_grid_step(grid)); });
            if (round > 3) least[with] = std::min(least[with], 1e6 * seconds);
        }
        counters = counters_of(grid);
        vox_grid_destroy(grid);
    }
    std::printf("one of %d balls moves: %.0f us a step, %.0f without constraints; depths of %llu of %llu "
                "carried over\n",
                across * across * across, least[1], least[0],
                static_cast<unsigned long long>(counters.carried_penetrations),
                static_cast<unsigned long long>(counters.penetrations));
}

int run(double tets, int rounds) {
    std::vector<std::unique_ptr<Scene>> scenes;
    scenes.push_back(two_balls("shallow", tets, 0.02));
    scenes.push_back(two_balls("shallow", tets, 0.1));
    scenes.push_back(two_balls("deep", tets, 0.3));
    scenes.push_back(two_balls("half", tets, 1));
    scenes.push_back(two_balls("fine", tets, 0.1, 8));
    scenes.push_back(two_balls("enclosed", tets, 1, 0.064, 0.4));
    scenes.push_back(two_balls("coincident", tets, 1.999));
    scenes.push_back(std::make_unique<Scene>("many", lattice(tets, 4, 1.9)));
    scenes.push_back(tangled_ball("tangled", tets / 6));
    for (int round = 0; round < rounds; ++round)
        for (const std::unique_ptr<Scene>& scene : scenes) scene->run();
    std::printf("%-10s %11s %9s %10s %8s %8s %8s %8s %8s\n", "scene", "constraints", "step us", "consistent",
                "closest", "none", "copy", "a pair", "of step");
    for (const std::unique_ptr<Scene>& scene : scenes) scene->print();
    time_rest(tets, rounds);
    return 0;
}

} // namespace

int main(int argc, char** argv) {
    bench::Size size{100000, 11};
    if (!bench::read_size(argc, argv, "bench_constraints", size)) return 2;
    const double tets = size.tets;
    const int rounds = size.rounds;
    return bench::run_program("bench_constraints", [&] { return run(tets, rounds); });
}
