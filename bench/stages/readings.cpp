// Cost of reading contacts, by part and by pair, and of steps whose bodies rest in contact.
//
//   bench_readings [--tets N] [--rounds K]
//
// Two smooth balls of N / 2 tetrahedra each, at several overlaps, and many small ones; every row is one
// scene. Times are the least of K rounds in which the rows take turns, on one thread, in nanoseconds a
// contact. `copy` is a plain copy of the readings, for comparison. What is timed is checked: parts of
// readings are parts of all, bit for bit, and distances are those of vox_locator_find_closest.
#include "internal/meshes.hpp"
#include "program.hpp"
#include "scenes/counters.h"
#include "stages/smooth_ball.hpp"
#include "timing.h"

#include <vox/vox_query.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using bench::must;
using vox::test::Mesh;

constexpr std::uint32_t whole = VOX_READING_POSITION | VOX_READING_SURFACE | VOX_READING_DEPTH;

struct Times {
    double step = 1e18, all = 1e18, surface = 1e18, depth = 1e18, position = 1e18, pair = 1e18, copy = 1e18;
};

void require(bool holds, const char* what) {
    if (!holds) throw std::runtime_error(what);
}

class Scene {
public:
    Scene(std::string name, std::vector<Mesh> bodies) : name_(std::move(name)), bodies_(std::move(bodies)) {
        must(vox_grid_create(nullptr, &grid_));
        for (const Mesh& body : bodies_) {
            vox_mesh_desc desc = vox_default_mesh_desc();
            desc.positions.data = body.positions.data();
            desc.positions.count = body.positions.size();
            desc.tets = body.tets.front().v;
            desc.tet_count = body.tets.size();
            if (body.self_collision) desc.filter.flags = VOX_FILTER_SELF_COLLISION;
            vox_body id = VOX_NULL_BODY;
            must(vox_mesh_insert(grid_, &desc, &id));
            ids_.push_back(id);
        }
        check();
    }
    ~Scene() { vox_grid_destroy(grid_); }
    Scene(const Scene&) = delete;
    Scene& operator=(const Scene&) = delete;

    void run() {
        for (Mesh& body : bodies_) // another pose, mirrored: as much work
            for (vox::Vec3f& p : body.positions) p.y = -p.y;
        least(times_.step, [&] { must(vox_grid_step(grid_)); });
        least(times_.all, [&] { must(vox_grid_prepare_readings(grid_)); });
        const vox_reading_view readings = view();
        copy_.resize(readings.count);
        least(times_.copy, [&] { std::copy_n(readings.data, readings.count, copy_.data()); });
        least(times_.surface, [&] { prepare(VOX_READING_SURFACE, 0, 0); });
        least(times_.depth, [&] { prepare(VOX_READING_POSITION | VOX_READING_DEPTH, 0, 0); });
        least(times_.position, [&] { prepare(VOX_READING_POSITION, 0, 0); });
        vox_pair_view pairs{};
        must(vox_grid_get_pairs(grid_, &pairs));
        if (pairs.count == 0) throw std::runtime_error(name_ + ": no contacts; more tetrahedra are needed");
        const vox_pair& pair = pairs.data[pairs.count / 2];
        of_pair_ = pair.a_in_b + pair.b_in_a;
        least(times_.pair, [&] { prepare(whole, pair.body_a, pair.body_b); });
    }

    void print() const {
        vox_contact_view contacts{};
        must(vox_grid_get_contacts(grid_, &contacts));
        const auto n = double(contacts.count);
        std::printf("%-10s %9llu %9.1f %8.0f %8.0f %8.1f %8.1f %8.1f %8.0f %8.2f\n", name_.c_str(),
                    static_cast<unsigned long long>(contacts.count), times_.step * 1e-3, times_.all / n,
                    times_.surface / n, times_.depth / n, times_.position / n, times_.copy / n,
                    times_.pair / double(of_pair_), times_.all / times_.step);
    }

private:
    template <class Work>
    static void least(double& nanoseconds, const Work& work) {
        nanoseconds = std::min(nanoseconds, 1e9 * seconds_of(work));
    }

    void prepare(std::uint32_t what, vox_body a, vox_body b) {
        vox_readings_desc desc = vox_default_readings_desc();
        desc.what = what;
        desc.body_a = a;
        desc.body_b = b;
        must(vox_grid_prepare_readings_of(grid_, &desc));
    }

    vox_reading_view view() const {
        vox_reading_view readings{};
        must(vox_grid_readings(grid_, &readings));
        return readings;
    }

    // Parts and pairs against all readings; some distances against queries.
    void check() {
        must(vox_grid_step(grid_));
        must(vox_grid_prepare_readings(grid_));
        const std::vector<vox_reading> all(view().data, view().data + view().count);
        vox_contact_view contacts{};
        must(vox_grid_get_contacts(grid_, &contacts));
        require(all.size() == contacts.count, "one reading for each contact");
        prepare(VOX_READING_POSITION | VOX_READING_DEPTH, 0, 0);
        vox_depth_view depths{};
        must(vox_grid_reading_depths(grid_, &depths));
        for (std::size_t i = 0; i < all.size(); ++i) {
            const vox_reading &part = view().data[i], &from = all[i];
            require(std::memcmp(part.position, from.position, sizeof part.position) == 0 &&
                        std::memcmp(part.direction, from.direction, sizeof part.direction) == 0 &&
                        part.depth == from.depth && part.user_data_b == from.user_data_b,
                    "position and depth are those of all readings");
            require(float(depths.data[i].depth) == from.depth, "the depth in double is that in float");
        }
        vox_pair_view pairs{};
        must(vox_grid_get_pairs(grid_, &pairs));
        for (std::uint64_t p = 0; p < pairs.count; p += 1 + pairs.count / 7) {
            prepare(whole, pairs.data[p].body_b, pairs.data[p].body_a);
            require(view().count == pairs.data[p].a_in_b + pairs.data[p].b_in_a, "the pair's readings");
            for (std::uint64_t i = 0; i < view().count; ++i)
                require(std::memcmp(&view().data[i], &all[view().data[i].contact], sizeof all[0]) == 0,
                        "a pair's readings are among all");
        }
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
        for (std::size_t i = 0; i < all.size() && ids_.size() <= 64; i += 1 + all.size() / 200) {
            if (contacts.data[i].body_a == contacts.data[i].body_b) continue; // another rule
            const auto b = std::find(ids_.begin(), ids_.end(), contacts.data[i].body_b) - ids_.begin();
            one.mask = std::uint64_t{1} << b;
            const vox_positions at = vox_double_positions(all[i].position, 1);
            vox_closest_hit hit{};
            must(vox_locator_find_closest(locator, &at, &one, &hit));
            require(std::abs(std::abs(hit.distance) - all[i].distance) <= 1e-12 * all[i].distance,
                    "distances are those of queries");
        }
        vox_locator_release(locator);
    }

    std::string name_;
    std::vector<Mesh> bodies_;
    std::vector<vox_body> ids_;
    std::vector<vox_reading> copy_;
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

// A lattice of balls that overlap their neighbours.
std::unique_ptr<Scene> many_balls(const char* name, double tets, int across) {
    std::vector<Mesh> bodies;
    for (int i = 0; i < across * across * across; ++i) {
        bodies.push_back(smooth_ball(tets / (across * across * across), 1));
        vox::test::move(bodies.back(), 1, 1.9 * (i % across), 1.9 * (i / across % across),
                        1.9 * (i / across / across));
    }
    return std::make_unique<Scene>(name, std::move(bodies));
}

// What a step takes whose bodies touch and rest, all but one of them, without and with penetrations.
void time_rest(double tets, int rounds) {
    constexpr int across = 4;
    double least[2] = {1e18, 1e18};
    grid_counts counters{};
    for (std::uint32_t flags = 0; flags < 2; ++flags) {
        vox_grid* grid = nullptr;
        vox_grid_desc desc = vox_default_grid_desc();
        desc.flags = flags;
        must(vox_grid_create(&desc, &grid));
        std::vector<Mesh> bodies;
        for (int i = 0; i < across * across * across; ++i) {
            bodies.push_back(smooth_ball(tets / (across * across * across), 1));
            vox::test::move(bodies.back(), 1, 1.6 * (i % across), 1.6 * (i / across % across),
                            1.6 * (i / across / across));
            vox_mesh_desc mesh = vox_default_mesh_desc();
            mesh.positions.data = bodies.back().positions.data();
            mesh.positions.count = bodies.back().positions.size();
            mesh.tets = bodies.back().tets.front().v;
            mesh.tet_count = bodies.back().tets.size();
            vox_body id = VOX_NULL_BODY;
            must(vox_mesh_insert(grid, &mesh, &id));
        }
        for (int round = 0; round < 4 * rounds; ++round) {
            for (vox::Vec3f& p : bodies[0].positions) p.x += round % 2 ? 0.001f : -0.001f;
            const double seconds = seconds_of([&] { must(vox_grid_step(grid)); });
            if (round > 3) least[flags] = std::min(least[flags], 1e6 * seconds);
        }
        counters = counters_of(grid);
        vox_grid_destroy(grid);
    }
    std::printf(
        "one of %d balls moves: %.0f us a step, %.0f without penetrations; %llu of %llu carried over\n",
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
    scenes.push_back(many_balls("many", tets, 4));
    scenes.push_back(tangled_ball("tangled", tets / 6));
    for (int round = 0; round < rounds; ++round)
        for (const std::unique_ptr<Scene>& scene : scenes) scene->run();
    std::printf("%-10s %9s %9s %8s %8s %8s %8s %8s %8s %8s\n", "scene", "contacts", "step us", "all",
                "surface", "+depth", "position", "copy", "a pair", "of step");
    for (const std::unique_ptr<Scene>& scene : scenes) scene->print();
    time_rest(tets, rounds);
    return 0;
}

} // namespace

int main(int argc, char** argv) {
    bench::Size size{100000, 11};
    if (!bench::read_size(argc, argv, "bench_readings", size)) return 2;
    const double tets = size.tets;
    const int rounds = size.rounds;
    return bench::run_program("bench_readings", [&] { return run(tets, rounds); });
}
