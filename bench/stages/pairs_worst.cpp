// Looks for the arrangement of bodies and filters in which finding pairs of bodies costs most.
//
//   bench_pairs_worst [--bodies N] [--samples K] [--seed S] [--kind NAME] [--filter NAME]
//
// Every body is one tetrahedron. Of each kind of arrangement with each kind of filter, K are drawn at random,
// with N/16 to N bodies (a tenth of that where all boxes may overlap). Printed are the one in which a step of
// the fast engine takes longest for each body and contact, and the one in which it takes longest beside the
// reference engine: least processor times of steps in which all bodies, or half of them, have moved. Both
// engines have to find the same contacts. The last column is the most memory that the grid of the fast engine
// held, a body.
#include "internal/random.hpp"
#include "program.hpp"
#include "scenes/counters.h"
#include "scenes/engines.h"
#include "timing.h"

#include <vox/vox.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

namespace {

using bench::must;

struct BoxShape {
    double lo[3], side[3];
};

struct Scene {
    std::vector<BoxShape> boxes;
    std::vector<vox_filter> filters;
    bool half_at_rest = false;
};

// ---- arrangements; parameters p, q in [0, 1] ---------------------------------------------------------

BoxShape cube(double x, double y, double z, double side) { return {{x, y, z}, {side, side, side}}; }

BoxShape lattice(std::size_t i, std::size_t n, double p, double q, Random& random) {
    const auto w = std::size_t(std::ceil(std::cbrt(double(n))));
    const auto place = [&](std::size_t k) { return double(k) + q * random.unit(); };
    return cube(place(i % w), place(i / w % w), place(i / w / w), 1.5 * p);
}

BoxShape rods(std::size_t i, std::size_t n, double p, double q, Random& random) {
    const auto w = std::size_t(std::ceil(std::sqrt(double(n) / 3)));
    const std::size_t axis = i % 3, k = i / 3;
    BoxShape box{};
    box.side[axis] = double(w);
    const std::size_t across[2] = {(axis + 1) % 3, (axis + 2) % 3};
    const double at[2] = {double(k % w), double(k / w)};
    for (int a = 0; a < 2; ++a) {
        box.lo[across[a]] = at[a] + double(axis) / 3 + 0.2 * q * random.unit();
        box.side[across[a]] = 0.3 * p;
    }
    return box;
}

BoxShape plates(std::size_t i, std::size_t n, double p, double q, Random& random) {
    const auto w = std::size_t(std::ceil(std::cbrt(double(n))));
    BoxShape box = lattice(i, n, 0, 0.2 * q, random);
    const std::size_t axis = i % 3;
    for (std::size_t a = 0; a < 3; ++a) box.side[a] = a == axis ? 0.01 : 1 + p * p * p * double(w);
    return box;
}

BoxShape of_all_sizes(std::size_t, std::size_t n, double p, double q, Random& random) {
    const double side = std::exp(-12 * p * random.unit()) * (0.1 + q) / std::cbrt(double(n));
    return cube(random.unit(), random.unit(), random.unit(), side);
}

BoxShape row(std::size_t i, std::size_t, double p, double q, Random& random) {
    return {{double(i), q * random.unit(), 0}, {4 * p, 1, 1}};
}

BoxShape stairs(std::size_t i, std::size_t n, double p, double q, Random&) {
    const double at = double(i), long_side = p * p * p * double(n);
    return {{at, q * at, -at}, {long_side, 1, 0.5}};
}

BoxShape floor(std::size_t i, std::size_t n, double p, double q, Random& random) {
    const auto w = std::size_t(std::ceil(std::sqrt(double(n))));
    return {{double(i % w) + q * random.unit(), double(i / w), 0}, {1.2 * p, 1.2 * p, 0.1 + random.unit()}};
}

BoxShape pile(std::size_t, std::size_t, double p, double q, Random& random) {
    return cube(p * random.unit(), q * random.unit(), 0, 1);
}

BoxShape needles_in_place(std::size_t i, std::size_t n, double p, double q, Random& random) {
    BoxShape box{{0, 0, 0}, {1, 1, 1}};
    const std::size_t axis = q < 0.5 ? 2 : i % 3;
    box.lo[axis] = (double(i) + p * random.unit()) / double(n);
    box.side[axis] = 0.1 / double(n);
    return box;
}

struct Kind {
    const char* name;
    BoxShape (*box)(std::size_t i, std::size_t n, double p, double q, Random& random);
    bool dense; // most boxes may overlap
};
constexpr Kind kinds[] = {
    {"lattice", lattice, false},    {"rods", rods, false}, {"plates", plates, false},
    {"sizes", of_all_sizes, false}, {"row", row, false},   {"stairs", stairs, false},
    {"floor", floor, false},        {"pile", pile, true},  {"needles", needles_in_place, true}};

// ---- filters ----------------------------------------------------------------------------------------

void collide_all(std::size_t, double, Random&, vox_filter&) {}
void one_group(std::size_t, double, Random&, vox_filter& filter) { filter.group = -1; }
void groups(std::size_t i, double p, Random&, vox_filter& filter) {
    filter.group = -1 - std::int32_t(i % std::size_t(1 + p * p * 200));
}
void layers(std::size_t i, double p, Random&, vox_filter& filter) { // each collides with another one
    const auto count = std::size_t(2 + 60 * p);
    filter.category = std::uint64_t{1} << i % count;
    filter.mask = (i % count) % 2 ? 0 : std::uint64_t{2} << i % count;
}
void masks(std::size_t, double p, Random& random,
           vox_filter& filter) { // of a few bits: most pairs are excluded
    filter.category = std::uint64_t{1} << random.below(1 + std::uint32_t(63 * p));
    filter.mask = std::uint64_t{1} << random.below(64);
}
void one_collider(std::size_t i, double, Random&, vox_filter& filter) {
    filter.category = i == 0 ? 2 : 1;
    filter.mask = i == 0 ? 1 : 2;
}

struct Filter {
    const char* name;
    void (*set)(std::size_t i, double p, Random& random, vox_filter& filter);
    bool half_at_rest;
};
constexpr Filter filters[] = {{"none", collide_all, false},
                              {"one group", one_group, false},
                              {"groups", groups, false},
                              {"layers", layers, false},
                              {"masks", masks, false},
                              {"one collider", one_collider, false},
                              {"half at rest", collide_all, true}};

// ---- measuring --------------------------------------------------------------------------------------

struct Result {
    double fast = 0, reference = 0; // seconds of a step
    double bytes = 0;               // the most, fast engine
    std::uint64_t contacts = 0;
    std::size_t bodies = 0;
    double p = 0, q = 0;

    double nanoseconds() const { return 1e9 * fast / double(bodies + contacts); }
    double ratio() const { return fast / reference; }
};

double step_time(const Scene& scene, engine_kind engine, Result& result, std::uint64_t& hash) {
    vox_grid_desc desc = vox_default_grid_desc();
    use_engine(&desc, engine);
    desc.flags = 0;
    desc.worker_count = 1;
    vox_grid* grid = nullptr;
    must(vox_grid_create(&desc, &grid));
    std::vector<float> positions;
    positions.reserve(scene.boxes.size() * 12);
    const std::uint32_t tet[4] = {0, 1, 2, 3};
    for (std::size_t i = 0; i < scene.boxes.size(); ++i) {
        const BoxShape& b = scene.boxes[i];
        // Two opposite edges, so that the box of the tetrahedron is this one.
        for (int corner = 0; corner < 4; ++corner) {
            const bool high[3] = {corner == 1 || corner == 3, corner == 1 || corner == 2, corner >= 2};
            for (int a = 0; a < 3; ++a) positions.push_back(float(b.lo[a] + (high[a] ? b.side[a] : 0)));
        }
        vox_mesh_desc mesh = vox_default_mesh_desc();
        mesh.positions.data = &positions[12 * i];
        mesh.positions.count = 4;
        mesh.tets = tet;
        mesh.tet_count = 1;
        mesh.filter = scene.filters[i];
        vox_body id;
        must(vox_mesh_insert(grid, &mesh, &id));
    }
    double least = 1e9;
    for (int s = 0; s < 5; ++s) {
        const double start = now();
        must(vox_grid_step(grid));
        if (s > 0) least = std::min(least, now() - start);
        const std::size_t moved = scene.half_at_rest ? positions.size() / 2 : positions.size();
        for (std::size_t i = 0; i < moved; ++i)
            positions[i] = std::nextafter(positions[i], s % 2 ? -1e9f : 1e9f);
    }
    grid_counts counters{};
    counters = counters_of(grid);
    if (engine == ENGINE_FAST) result.bytes = double(counters.peak_bytes);
    result.contacts = counters.contacts;
    must(vox_grid_get_hash(grid, &hash));
    vox_grid_destroy(grid);
    return least;
}

Result measure(const Kind& kind, const Filter& filter, std::size_t most, std::uint64_t seed) {
    Random random{seed};
    Result result;
    result.p = random.unit();
    result.q = random.unit();
    const double third = random.unit();
    result.bodies = std::size_t(double(kind.dense ? most / 10 : most) * std::exp2(-4 * random.unit()));
    Scene scene;
    for (std::size_t i = 0; i < result.bodies; ++i) {
        scene.boxes.push_back(kind.box(i, result.bodies, result.p, result.q, random));
        scene.filters.push_back(vox_filter{});
        filter.set(i, third, random, scene.filters.back());
    }
    scene.half_at_rest = filter.half_at_rest;
    std::uint64_t hash = 0, reference_hash = 0;
    result.fast = step_time(scene, ENGINE_FAST, result, hash);
    result.reference = step_time(scene, ENGINE_REFERENCE, result, reference_hash);
    if (hash != reference_hash) throw std::runtime_error("the engines find different contacts");
    return result;
}

void print(const char* what, const Kind& kind, const Filter& filter, const Result& r) {
    std::printf("%-8s %-12s %-17s %6zu bodies (%.2f %.2f) %8.2f ms %8llu contacts %8.0f ns %6.2f of "
                "reference %6.0f bytes\n",
                kind.name, filter.name, what, r.bodies, r.p, r.q, 1e3 * r.fast,
                static_cast<unsigned long long>(r.contacts), r.nanoseconds(), r.ratio(),
                r.bytes / double(r.bodies));
    std::fflush(stdout);
}

int run(int argc, char** argv) {
    std::size_t bodies = 16000, samples = 4;
    std::uint64_t seed = 1;
    std::string only, only_filter;
    for (int i = 1; i < argc; i += 2) {
        const std::string option = argv[i];
        const char* const value = argv[i + 1]; // the array ends with null
        if (!value) throw std::runtime_error(option + " needs a value");
        if (option == "--bodies")
            bodies = std::size_t(std::atoll(value));
        else if (option == "--samples")
            samples = std::size_t(std::atoll(value));
        else if (option == "--seed")
            seed = std::uint64_t(std::atoll(value));
        else if (option == "--kind")
            only = value;
        else if (option == "--filter")
            only_filter = value;
        else
            throw std::runtime_error("unknown option " + option);
    }
    for (const Kind& kind : kinds)
        for (const Filter& filter : filters) {
            if ((!only.empty() && only != kind.name) || (!only_filter.empty() && only_filter != filter.name))
                continue;
            Result slowest, behind;
            for (std::size_t s = 0; s < samples; ++s) {
                const Result result = measure(kind, filter, bodies, seed + s);
                if (s == 0 || result.nanoseconds() > slowest.nanoseconds()) slowest = result;
                if (s == 0 || result.ratio() > behind.ratio()) behind = result;
            }
            print("slowest", kind, filter, slowest);
            print("behind reference", kind, filter, behind);
        }
    return 0;
}

} // namespace

int main(int argc, char** argv) {
    return bench::run_program("bench_pairs_worst", [&] { return run(argc, argv); });
}
