// What a step of bodies on many ranks sends, beside what one grid bins and beside a floor:
// docs/evidence/distributed.md. Counts, so no machine matters. usage: bench_dist [TETS]: of each rank in the
// scenes that grow; default 100000
#include "dist/ranks.hpp" // of tests/
#include "dist/whole.hpp"
#include "scenes/counters.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <set>
#include <span>
#include <string_view>

using namespace scenes;

namespace {

// What the ranks of a run found together.
struct Run {
    const Scene* scene = nullptr;
    std::vector<std::vector<Share>> shares; // of each body, of each rank
    std::mutex mutex;
    std::uint64_t vertices = 0, bytes = 0, floor = 0, contacts = 0, remote = 0;
    std::uint64_t most_bytes = 0, most_messages = 0, most_neighbours = 0;
    double most_seconds = 0, all_seconds = 0;
    std::uint64_t hash[2] = {};
    bool failed = false;
};

void rank(const vox_dist_transport* transport, Run& run) {
    Ranked mine(transport);
    bool good = mine.result == VOX_OK;
    for (std::size_t b = 0; b < run.scene->size() && good; ++b)
        good = mine.insert((*run.scene)[b], run.shares[b][transport->rank]) == VOX_OK;
    std::uint64_t hash[2], parts = 0;
    good = good && vox_dist_scene_step(mine.scene) == VOX_OK &&
           vox_dist_scene_get_hash(mine.scene, hash) == VOX_OK;
    if (!good) {
        std::printf("%s\n", vox_last_error());
        run.failed = true;
        return;
    }
    vox_dist_contact_view contacts{};
    const auto counter = [&](std::string_view name) {
        vox_counter_view view{};
        (void)vox_dist_scene_get_counters(mine.scene, &view);
        for (const vox_counter& c : std::span(view.data, view.count))
            if (c.name == name) return c.value;
        return std::uint64_t{0};
    };
    (void)vox_dist_scene_get_contacts(mine.scene, VOX_DIST_VERTICES, &contacts);
    (void)vox_dist_scene_get_costs(mine.scene, nullptr, 0, &parts);
    std::vector<vox_dist_cost> costs(parts);
    (void)vox_dist_scene_get_costs(mine.scene, costs.data(), parts, &parts);
    double seconds = 0;
    for (const vox_dist_cost& cost : costs) seconds += cost.seconds;
    std::set<std::array<std::uint64_t, 3>> pairs; // body, vertex, rank
    std::uint64_t remote = 0;
    for (std::uint64_t i = 0; i < contacts.count; ++i) {
        const vox_dist_contact& c = contacts.data[i];
        if (c.rank == transport->rank) continue;
        pairs.insert({c.body_a, c.vertex, c.rank});
        ++remote;
    }
    const std::uint64_t bytes = counter("box_bytes") + counter("vertex_bytes") + counter("hit_bytes");
    const std::lock_guard lock(run.mutex);
    run.vertices += counter("vertices_sent");
    run.bytes += bytes;
    run.floor += 16 * pairs.size() + 28 * remote;
    run.contacts += contacts.count;
    run.remote += remote;
    run.most_bytes = std::max(run.most_bytes, bytes);
    run.most_messages = std::max(run.most_messages, counter("messages"));
    run.most_neighbours = std::max(run.most_neighbours, counter("neighbours"));
    run.most_seconds = std::max(run.most_seconds, seconds);
    run.all_seconds += seconds;
    std::copy_n(hash, 2, run.hash);
}

// Counts of one grid of the whole.
struct One {
    std::uint64_t entries, contacts, hash[2];
};

One one_grid(const Scene& scene) {
    std::vector<std::vector<float>> floats;
    vox_grid* grid = whole(scene, floats);
    One one{};
    if (!grid || vox_grid_step(grid) != VOX_OK) {
        std::printf("%s\n", vox_last_error());
        std::exit(EXIT_FAILURE);
    }
    const grid_counts counters = counters_of(grid);
    one.entries = counters.entries;
    const std::vector<vox_dist_contact> contacts = global_contacts(scene, grid);
    one.contacts = contacts.size();
    hash_of(contacts, one.hash);
    vox_grid_destroy(grid);
    return one;
}

void run_on(Run& run, std::uint32_t size) {
    run_ranks(size, 1, [&](const vox_dist_transport* transport) { rank(transport, run); });
    if (run.failed) std::exit(EXIT_FAILURE);
}

// How the tetrahedra of a scene are dealt out to ranks.
enum class Dealt {
    together,     // by bisection of all bodies at once
    each_body,    // by bisection of each body
    at_random,    // each tetrahedron
    whole_bodies, // to ranks in the order of bodies, which is that of places
};

// The rank of each tetrahedron of each body.
std::vector<std::vector<std::uint32_t>> deal(const Scene& scene, std::uint32_t size, Dealt how,
                                             Random& random) {
    std::vector<std::vector<std::uint32_t>> ranks;
    Body all;
    for (const Body& body : scene) {
        const auto number = static_cast<std::uint32_t>(std::uint64_t{ranks.size()} * size / scene.size());
        ranks.push_back(how == Dealt::whole_bodies
                            ? std::vector<std::uint32_t>(body.tet_count(), number)
                            : cut(body, size, how == Dealt::at_random ? Cut::random : Cut::rcb, random));
        const auto first = static_cast<std::uint32_t>(all.vertices());
        for (const std::uint32_t corner : body.tets) all.tets.push_back(first + corner);
        all.xyz.insert(all.xyz.end(), body.xyz.begin(), body.xyz.end());
    }
    if (how != Dealt::together) return ranks;
    const std::vector<std::uint32_t> together = cut(all, size, Cut::rcb, random);
    auto next = together.begin();
    for (auto& of_body : ranks)
        for (std::uint32_t& rank : of_body) rank = *next++;
    return ranks;
}

void compare(const char* name, const Scene& scene, const One& one, std::uint32_t size, Dealt how) {
    Run run;
    run.scene = &scene;
    Random random(size);
    const auto ranks = deal(scene, size, how, random);
    for (std::size_t b = 0; b < scene.size(); ++b)
        run.shares.push_back(shares(scene[b], ranks[b], size, random));
    run_on(run, size);
    if (run.hash[0] != one.hash[0] || run.hash[1] != one.hash[1])
        std::printf("another hash\n"), std::exit(EXIT_FAILURE);
    std::printf("| %s | %u | %llu | %llu | %.2f | %.1f | %llu | %.1f | %.2f |\n", name, size,
                static_cast<unsigned long long>(run.contacts), static_cast<unsigned long long>(run.remote),
                static_cast<double>(run.vertices) / static_cast<double>(one.entries),
                run.floor ? static_cast<double>(run.bytes) / static_cast<double>(run.floor) : 0.0,
                static_cast<unsigned long long>(run.most_neighbours),
                static_cast<double>(run.most_messages) /
                    static_cast<double>(std::max<std::uint64_t>(run.most_neighbours, 1)),
                run.most_seconds * size / run.all_seconds);
    std::fflush(stdout);
}

Body box(std::uint32_t n, double x, double y, double z, double edge, std::uint64_t number) {
    const std::uint32_t cubes[3] = {n, n, n};
    const double origin[3] = {x, y, z};
    Body body = block(cubes, origin, edge);
    body.number = number;
    return body;
}

// Two blocks with one layer of cubes of each in the other.
Scene contact(std::uint32_t n) {
    return {box(n, 0, 0, 0, 1, 0), box(n, n - 1 + 0.3125, 0.28125, 0.21875, 1, 1)};
}

// 1000 blocks close to each other, numbered along x, then y, then z.
Scene bodies() {
    Scene scene;
    Random random(1);
    const auto jitter = [&] { return below(random, 1024) / 4096.0; };
    for (int x = 0; x < 10; ++x)
        for (int y = 0; y < 10; ++y)
            for (int z = 0; z < 10; ++z)
                scene.push_back(
                    box(3, 2.8 * x + jitter(), 2.8 * y + jitter(), 2.8 * z + jitter(), 1, scene.size()));
    return scene;
}

// One block a rank, in a row or in a cube of ranks.
void grow(std::uint32_t tets) {
    const auto n = static_cast<std::uint32_t>(std::cbrt(tets / 6.0));
    std::printf("\n| ranks | arranged | bytes of the busiest | messages | neighbours | predicted ms | model "
                "of the network, ms |\n"
                "|---|---|---|---|---|---|---|\n");
    for (const bool in_cube : {false, true})
        for (const std::uint32_t side : {1u, 2u, 3u, 4u}) {
            const std::uint32_t size = side * side * side;
            Run run;
            Scene scene;
            for (std::uint32_t r = 0; r < size; ++r) {
                const double step = n - 0.4375;
                const std::uint32_t at[3] = {in_cube ? r % side : r, in_cube ? r / side % side : 0,
                                             in_cube ? r / side / side : 0};
                scene.push_back(box(n, step * at[0], step * at[1], step * at[2], 1, r));
                scene.back().doubles = false;
            }
            run.scene = &scene;
            Random random(size);
            for (std::uint32_t r = 0; r < size; ++r)
                run.shares.push_back(
                    shares(scene[r], std::vector<std::uint32_t>(scene[r].tet_count(), r), size, random));
            run_on(run, size);
            std::printf("| %u | in a %s | %llu | %llu | %llu | %.2f | %.2f |\n", size,
                        in_cube ? "cube" : "row", static_cast<unsigned long long>(run.most_bytes),
                        static_cast<unsigned long long>(run.most_messages),
                        static_cast<unsigned long long>(run.most_neighbours), run.most_seconds * 1e3,
                        2e-3 * static_cast<double>(run.most_messages) +
                            1e-7 * static_cast<double>(run.most_bytes));
            std::fflush(stdout);
        }
}

// 10^6 points on vertices, in the middle of edges, facets and cubes of one block.
struct Points {
    static constexpr std::uint32_t count = 1000000;
    std::vector<double> xyz;
    Scene scene{box(24, 0, 0, 0, 1, 0)};
    std::vector<std::vector<Share>> shares;
    std::vector<std::uint64_t> tets; // of each point; UINT64_MAX: in none
    double seconds = 0;              // on one rank
    bool failed = false;

    Points() : tets(count) {
        Random random(2);
        for (std::uint32_t i = 0; i < 3 * count; ++i) xyz.push_back(below(random, 49) / 2.0);
    }
};

void locate_rank(const vox_dist_transport* transport, Points& points) {
    Ranked mine(transport);
    const std::uint64_t begin = std::uint64_t{Points::count} * transport->rank / transport->size;
    const std::uint64_t end = std::uint64_t{Points::count} * (transport->rank + 1) / transport->size;
    std::vector<vox_dist_location> found(end - begin);
    if (mine.insert(points.scene[0], points.shares[0][transport->rank]) != VOX_OK) points.failed = true;
    const vox_positions own = vox_double_positions(points.xyz.data() + 3 * begin, end - begin);
    const auto start = std::chrono::steady_clock::now();
    if (vox_dist_scene_locate(mine.scene, &own, found.data()) != VOX_OK) points.failed = true;
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    if (transport->size == 1) points.seconds = took.count();
    for (std::uint64_t i = begin; i < end; ++i)
        points.tets[i] = found[i - begin].state != VOX_LOCATION_INSIDE ? UINT64_MAX : found[i - begin].tet;
}

// Every point is found, in the same tetrahedron for any number of ranks.
void locate() {
    Points points;
    std::vector<std::uint64_t> first;
    std::printf(
        "\n| ranks | points | found | in another tetrahedron than by one rank |\n|---|---|---|---|\n");
    for (const std::uint32_t size : {1u, 2u, 8u, 64u}) {
        Random random(size);
        points.shares = {shares(points.scene[0], cut(points.scene[0], size, Cut::rcb, random), size, random)};
        run_ranks(size, 1, [&](const vox_dist_transport* transport) { locate_rank(transport, points); });
        if (points.failed) std::exit(EXIT_FAILURE);
        if (first.empty()) first = points.tets;
        std::uint64_t others = 0;
        for (std::uint32_t i = 0; i < Points::count; ++i) others += first[i] != points.tets[i];
        std::printf("| %u | %u | %u | %llu |\n", size, Points::count,
                    Points::count -
                        static_cast<unsigned>(std::count(points.tets.begin(), points.tets.end(), UINT64_MAX)),
                    static_cast<unsigned long long>(others));
        std::fflush(stdout);
    }
    std::printf("%.0f ns a point on one rank, the grid made anew\n", points.seconds * 1e9 / Points::count);
}

} // namespace

int main(int argc, char** argv) {
    std::printf(
        "| scene | ranks | contacts | between ranks | vertices sent / binned by one grid | bytes / floor | "
        "neighbours at most | messages a neighbour | predicted cost, busiest / mean "
        "|\n|---|---|---|---|---|---|---|---|---|\n");
    const Scene two = contact(24), many = bodies();
    const One one_two = one_grid(two), one_many = one_grid(many);
    for (const std::uint32_t size : {2u, 8u, 64u})
        compare("two blocks, bisected together", two, one_two, size, Dealt::together);
    for (const std::uint32_t size : {2u, 8u, 64u})
        compare("two blocks, each bisected", two, one_two, size, Dealt::each_body);
    for (const std::uint32_t size : {2u, 8u})
        compare("two blocks, at random", two, one_two, size, Dealt::at_random);
    for (const std::uint32_t size : {2u, 8u, 64u})
        compare("1000 blocks", many, one_many, size, Dealt::whole_bodies);
    grow(argc > 1 ? static_cast<std::uint32_t>(std::strtoul(argv[1], nullptr, 10)) : 100000u);
    locate();
    return EXIT_SUCCESS;
}
