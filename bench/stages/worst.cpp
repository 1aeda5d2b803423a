// Looks for the scene in which something beyond the contacts costs most beside them alone: constraints of
// vertices inside, which need the depth stage; edges through faces; vertices within a margin; or passages of
// vertices through surfaces.
//
//   bench_worst [--what depth|edges|margin|passages] [--tets N] [--samples K] [--climb K] [--steps K]
//               [--seed S] [--scene NAME] [--meshes FOLDER] [--budget SEARCHES]
//
// Every kind of scene has up to four parameters in [0, 1]. Of each, K are drawn at random (the first has all
// parameters 1/2), then K more are drawn around the worst so far, ever closer. A scene's ratio is the time of
// a step that finds more over that of a grid that finds contacts alone: least times of steps in
// which the two take turns. Both have to find the same contacts. The margin is half an edge; for passages,
// every other body came 2 edges along x within the step, and the others stood still. Columns: what was found
// beyond contacts, the share of penetrations that needed a closest point, the nanoseconds for each that was
// found, and a hash of the constraints, so that two versions of the library can be compared.
//
// FOLDER has bunny.msh and cow.msh for one more scene.
#include "base/boxes.hpp"
#include "base/vectors.hpp"
#include "internal/meshes.hpp"
#include "program.hpp"
#include "scenes/counters.h"
#include "stages/smooth_ball.hpp"
#include "timing.h"

#include <vox/vox.h>
#if defined(BENCH_IO)
#include <vox/vox_io.h>
#endif

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

namespace {

using bench::must;
using vox::Vec3d;
using vox::Vec3f;

using Parameters = std::array<double, 4>;

enum class What { depth, edges, margin, passages };
constexpr const char* names[] = {"depth", "edges", "margin", "passages"};

struct Setting {
    double tets;         // of the whole scene
    Mesh bunny{}, cow{}; // empty without --meshes
};

using Bodies = std::vector<Mesh>; // a cell of theirs is about 1

Vec3f turned(const Vec3f& p, double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    return {float(c * double{p.x} - s * double{p.y}), float(s * double{p.x} + c * double{p.y}), p.z};
}

Mesh self(Mesh mesh) {
    mesh.self_collision = true;
    return mesh;
}

// One body whose vertices are moved at random, by up to 1.5 cells.
Bodies noise(const Setting& setting, const Parameters& p, Random& random) {
    Mesh mesh = ball(setting.tets * (0.2 + 0.8 * p[1]));
    jitter(mesh, 1.5 * p[0], random);
    return {self(std::move(mesh))};
}

// One body folded over along the middle, as a sheet or as a bar.
Bodies fold(const Setting& setting, const Parameters& p, Random& random) {
    const double width = 2 + 10 * p[1];
    const int n = int(width), length = std::max(8, int(setting.tets / 5 / n / n));
    Mesh mesh = block(length, n, n);
    const double angle = std::numbers::pi * (0.5 + 0.6 * p[0]), bend = double(length) / (1 + 8 * p[2]);
    for (Vec3f& v : mesh.positions) {
        const double s = std::clamp((double{v.x} - (length - bend) / 2) / bend, 0.0, 1.0);
        const double a = s * angle, r = bend / angle;
        const double before = std::min(double{v.x}, (length - bend) / 2),
                     after = std::max(double{v.x} - (length + bend) / 2, 0.0);
        const double h = r - double{v.y};
        v = {float(before + h * std::sin(a) + after * std::cos(a)),
             float(r - h * std::cos(a) + after * std::sin(a)), v.z};
    }
    jitter(mesh, 0.1 * p[3], random);
    return {self(std::move(mesh))};
}

// One body inside another: parts of one mesh, or two meshes.
Bodies inside(const Setting& setting, const Parameters& p, Random& random, bool one_mesh) {
    const double radius = std::cbrt(setting.tets / 5);
    Mesh outer = smooth_ball(setting.tets / 2, radius),
         inner = smooth_ball(setting.tets / 2, radius * (0.01 + 0.9 * p[0]));
    move(inner, 1, radius * 0.5 * p[1] * (1 - p[0]), 0.01 * p[2], 0.02 * p[2]);
    jitter(outer, 0.3 * p[3], random);
    if (!one_mesh) return {std::move(outer), std::move(inner)};
    append(outer, inner);
    return {self(std::move(outer))};
}
Bodies swallow(const Setting& setting, const Parameters& p, Random& random) {
    return inside(setting, p, random, false);
}
Bodies pregnant(const Setting& setting, const Parameters& p, Random& random) {
    return inside(setting, p, random, true);
}

// A bunny in a cow ten times its size.
Bodies swallow_bunny(const Setting& setting, const Parameters& p, Random&) {
    Mesh bunny = setting.bunny;
    move(bunny, 0.05 + 0.1 * p[0], 0.2 * (p[1] - 0.5), 0.2 * (p[2] - 0.5), 0.2 * (p[3] - 0.5));
    return {setting.cow, std::move(bunny)};
}

// Copies of one body at the same place, or nearly.
Bodies coincident(const Setting& setting, const Parameters& p, Random& random) {
    const int count = 2 + int(6 * p[0]);
    Bodies bodies;
    for (int i = 0; i < count; ++i) {
        Mesh mesh = ball(setting.tets / count);
        if (i > 0) move(mesh, 1, 0.3 * p[1] * i, 0, 0.1 * p[1] * i);
        jitter(mesh, p[2] * p[2], random);
        if (p[3] > 0.7) mesh.self_collision = true;
        bodies.push_back(std::move(mesh));
    }
    return bodies;
}

// Long thin bars through one another, or through a ball.
Bodies needles(const Setting& setting, const Parameters& p, Random& random) {
    const int count = 2 + int(10 * p[0]), length = std::max(4, int(setting.tets / 5 / count));
    Bodies bodies;
    for (int i = 0; i < count; ++i) {
        Mesh mesh = block(length, 1, 1);
        const double thin = std::pow(10, -2 * p[1]);
        for (Vec3f& v : mesh.positions)
            v = turned({v.x - float(length) / 2, float((double{v.y} - 0.5) * (1 - p[2] * 0.9)),
                        float((double{v.z} - 0.5) * thin)},
                       std::numbers::pi * p[3] * i / count);
        jitter(mesh, 0.3 * p[2] * thin, random);
        bodies.push_back(std::move(mesh));
    }
    return bodies;
}

// Two bodies that overlap, with vertices moved at random.
Bodies noisy_pair(const Setting& setting, const Parameters& p, Random& random) {
    double radius = 0;
    Mesh a = ball(setting.tets / 2, &radius), b = a;
    move(b, 1, 2 * radius * p[0], 0.1, 0.2);
    jitter(a, p[1], random);
    jitter(b, p[2], random);
    return {std::move(a), std::move(b)};
}

// Points without tetrahedra in a body: all of them need a closest point.
Bodies points(const Setting& setting, const Parameters& p, Random& random) {
    double radius = 0;
    Mesh body = ball(setting.tets, &radius), cloud;
    const double reach = radius * (0.001 + p[0]);
    for (int i = 0; i < 200 + int(setting.tets * 0.2 * p[1]); ++i)
        cloud.positions.push_back(
            {random.uniform(-reach, reach), random.uniform(-reach, reach), random.uniform(-reach, reach)});
    return {std::move(body), std::move(cloud)};
}

// A body of one layer of flat tetrahedra crumpled up.
Bodies crumple(const Setting& setting, const Parameters& p, Random& random) {
    const int n = std::max(4, int(std::sqrt(setting.tets / 5)));
    Mesh mesh = block(n, n, 1);
    const double thick = 0.05 + p[0], wave = 1 + 6 * p[1], high = n * 0.3 * p[2];
    for (Vec3f& v : mesh.positions) {
        const double x = double{v.x} / n * 2 - 1, y = double{v.y} / n * 2 - 1;
        v = {float(n * (1 - 0.8 * p[3]) * x * std::cos(wave * y)), float(n * (1 - 0.8 * p[3]) * y),
             float(double{v.z} * thick + high * std::sin(wave * x) * std::cos(wave * y))};
    }
    jitter(mesh, 0.2 * p[0], random);
    return {self(std::move(mesh))};
}

// Two sheets of long thin tetrahedra, at an angle to each other and to the axes.
Bodies slivers(const Setting& setting, const Parameters& p, Random&) {
    Bodies bodies(2);
    const auto count = std::uint32_t(setting.tets / 2);
    const double length = count * std::pow(10, -2 * p[2]);
    for (std::uint32_t i = 0; i < 2 * count; ++i) {
        const double side = i / count, y = i % count - count / 2.0, z = 1.5 * p[1] * side;
        Mesh& mesh = bodies[i / count];
        const auto v = std::uint32_t(mesh.positions.size());
        for (const Vec3f& c : {Vec3f{-1, 0, 0}, {-1, 0.5f, 0}, {1, 0, 0.25f}, {1, 0.5f, 0.25f}}) {
            const Vec3f at = turned({float(length / 2) * c.x, float(y) + c.y, float(z) + c.z},
                                    std::numbers::pi / 2 * p[0] * side),
                        on = turned({at.y, at.z, at.x}, std::numbers::pi / 2 * p[3]);
            mesh.positions.push_back(turned({on.z, on.x, on.y}, 0.6));
        }
        mesh.tets.push_back({{v, v + 1, v + 2, v + 3}});
    }
    return bodies;
}

// Two fans of needles in each other: rulings of one saddle, across each other, that hardly touch.
Bodies fans(const Setting& setting, const Parameters& p, Random&) {
    Bodies bodies(2);
    const auto count = std::uint32_t(setting.tets / 2);
    const double twist = 2 * p[0], thick = 0.02 + 0.5 * p[1] * p[1], width = 0.5 + p[2],
                 high = 2.0 * thick * (p[0] + p[3]) + 1e-3;
    for (std::uint32_t i = 0; i < 2 * count; ++i) {
        const double side = i / count, at = width * (i % count + 0.5 - count / 2.0);
        Mesh& mesh = bodies[i / count];
        const auto v = std::uint32_t(mesh.positions.size());
        for (const Vec3d& c : {Vec3d{-0.5, 0, 0}, {-0.5, 1, 0}, {0.5, 0, 1}, {0.5, 1, 1}}) {
            const double x = count * c.x, y = at + thick * c.y,
                         z = twist * x * y / count + thick * c.z + side * (high + thick);
            const Vec3f on = turned({float(z), float(side > 0 ? y : x), float(side > 0 ? x : y)}, 0.7);
            mesh.positions.push_back(turned({on.y, on.z, on.x}, 0.6));
        }
        mesh.tets.push_back({{v, v + 1, v + 2, v + 3}});
    }
    return bodies;
}

struct Kind {
    const char* name;
    Bodies (*make)(const Setting&, const Parameters&, Random&);
};
constexpr Kind kinds[] = {{"noise", noise},
                          {"fold", fold},
                          {"crumple", crumple},
                          {"swallow", swallow},
                          {"part in part", pregnant},
                          {"coincident", coincident},
                          {"needles", needles},
                          {"noisy pair", noisy_pair},
                          {"points", points},
                          {"slivers", slivers},
                          {"fans", fans},
                          {"bunny in cow", swallow_bunny}};

// ---- measuring --------------------------------------------------------------------------------------

// The length of an edge is about 1 in all scenes.
constexpr double margin = 0.5, step_length = 2;

Bodies before(Bodies bodies) {
    for (std::size_t b = 1; b < bodies.size(); b += 2)
        for (Vec3f& p : bodies[b].positions) p.x += float{step_length};
    return bodies;
}

class Grid {
public:
    // Contacts alone.
    explicit Grid(const Bodies& bodies) : Grid(bodies, nullptr, {}) {}
    Grid(const Bodies& bodies, What what, const Bodies& previous, std::uint64_t budget)
        : Grid(bodies, what == What::passages ? &previous : nullptr, [&] {
              vox_grid_desc desc = vox_default_grid_desc();
              desc.flags = what == What::edges ? VOX_GRID_EDGES : 0;
              desc.margin = what == What::margin ? margin : 0;
              return desc;
          }()) {
        if (what == What::depth) method_ = VOX_DEPTH_METHOD_CONSISTENT;
        budget_ = budget;
    }
    Grid(const Bodies& bodies, const Bodies* previous, const std::optional<vox_grid_desc>& with) {
        vox_grid_desc desc = vox_default_grid_desc();
        if (with) desc = *with;
        must(vox_grid_create(&desc, &grid_));
        for (std::size_t b = 0; b < bodies.size(); ++b) {
            const Mesh& mesh = bodies[b];
            vox_mesh_desc mesh_desc = vox_default_mesh_desc();
            mesh_desc.positions.data = mesh.positions.data();
            mesh_desc.positions.count = mesh.positions.size();
            mesh_desc.tets = mesh.tets.empty() ? nullptr : mesh.tets.front().v;
            mesh_desc.tet_count = mesh.tets.size();
            if (mesh.self_collision) mesh_desc.filter.flags |= VOX_FILTER_SELF_COLLISION;
            vox_body id = VOX_NULL_BODY;
            must(vox_mesh_insert(grid_, &mesh_desc, &id));
            mesh_desc.positions.data = previous ? (*previous)[b].positions.data() : nullptr;
            if (previous) must(vox_mesh_bind_previous_positions(grid_, id, &mesh_desc.positions));
        }
    }
    ~Grid() { vox_grid_destroy(grid_); }
    Grid(const Grid&) = delete;
    Grid& operator=(const Grid&) = delete;

    // Seconds of a step, and of depths where these are looked for.
    double step() {
        return seconds_of([&] {
            must(vox_grid_step(grid_));
            if (method_ != VOX_DEPTH_METHOD_NONE) find_constraints();
        });
    }
    std::uint64_t hash() const {
        std::uint64_t hash = 0;
        must(vox_grid_get_hash(grid_, &hash));
        return hash;
    }
    // FNV-1a over the bytes of the constraints.
    std::uint64_t hash_of_constraints() {
        if (method_ == VOX_DEPTH_METHOD_NONE) find_constraints();
        vox_constraint_view view{};
        must(vox_grid_get_constraints(grid_, &view));
        std::uint64_t hash = 0xcbf29ce484222325u;
        const auto* const bytes = reinterpret_cast<const unsigned char*>(view.data);
        for (std::size_t i = 0; i < view.count * sizeof *view.data; ++i)
            hash = (hash ^ bytes[i]) * 0x100000001b3u;
        return hash;
    }
    grid_counts counters() const { return counters_of(grid_); }

private:
    void find_constraints() {
        vox_constraint_desc desc = vox_default_constraint_desc();
        desc.method = method_;
        desc.closest_budget = budget_;
        must(vox_grid_find_constraints(grid_, &desc));
    }

    vox_depth_method method_ = VOX_DEPTH_METHOD_NONE;
    std::uint64_t budget_ = 0;
    vox_grid* grid_ = nullptr;
};

struct Result {
    Parameters parameters{};
    double ratio = 0, alone = 1e9, whole = 1e9; // seconds
    grid_counts counters{};
    std::uint64_t hash = 0;
};

std::uint64_t found(What what, const grid_counts& counters) {
    return what == What::depth    ? counters.penetrations
           : what == What::edges  ? counters.edge_contacts
           : what == What::margin ? counters.proximities
                                  : counters.passages;
}

Result measure(What what, const Kind& kind, const Setting& setting, const Parameters& parameters, int steps,
               std::uint64_t budget) {
    Random random{7};
    Bodies bodies = kind.make(setting, parameters, random);
    const Bodies first = bodies;
    Bodies previous = before(bodies);
    Grid alone(bodies), whole(bodies, what, previous, budget);
    Result result;
    result.parameters = parameters;
    Random motion{11};
    for (int step = 0; step < steps; ++step) {
        // Everything moves, a little, by the same amounts in every run.
        for (std::size_t b = 0; b < bodies.size(); ++b)
            for (std::size_t v = 0; v < bodies[b].positions.size(); ++v) {
                const Vec3f& p = first[b].positions[v];
                bodies[b].positions[v] = {p.x * (1 + motion.uniform(-1e-5, 1e-5)),
                                          p.y * (1 + motion.uniform(-1e-5, 1e-5)),
                                          p.z * (1 + motion.uniform(-1e-5, 1e-5))};
            }
        if (what == What::passages) {
            const Bodies now = before(bodies); // the grid knows where the arrays of `previous` are
            for (std::size_t b = 0; b < bodies.size(); ++b)
                std::copy(now[b].positions.begin(), now[b].positions.end(), previous[b].positions.begin());
        }
        const double alone_seconds = alone.step(), whole_seconds = whole.step();
        if (alone.hash() != whole.hash()) throw std::runtime_error("the two grids found different contacts");
        if (step > 0) { // the first one makes room
            result.alone = std::min(result.alone, alone_seconds);
            result.whole = std::min(result.whole, whole_seconds);
        }
        result.hash = 31 * result.hash + whole.hash_of_constraints();
    }
    result.counters = whole.counters();
    result.ratio = result.whole / result.alone;
    return result;
}

void print(What what, const char* name, const Result& r) {
    const std::uint64_t count = found(what, r.counters);
    const double n = double(std::max<std::uint64_t>(count, 1));
    std::printf("%-13s %5.3f %5.3f %5.3f %5.3f %9llu %9llu %8.2f %8.2f %7.2f %8.3f %8.0f  %016llx\n", name,
                r.parameters[0], r.parameters[1], r.parameters[2], r.parameters[3],
                static_cast<unsigned long long>(r.counters.tets), static_cast<unsigned long long>(count),
                1e3 * r.alone, 1e3 * r.whole, r.ratio, double(r.counters.closest_searches) / n,
                1e9 * (r.whole - r.alone) / n, static_cast<unsigned long long>(r.hash));
    std::fflush(stdout);
}

Mesh read_mesh([[maybe_unused]] const std::string& path) {
#if defined(BENCH_IO)
    vox_io_mesh* file = nullptr;
    must(vox_io_load(path.c_str(), nullptr, &file));
    vox_io_mesh_view view;
    must(vox_io_mesh_get_arrays(file, &view));
    Mesh mesh;
    for (std::uint64_t v = 0; v < view.vertex_count; ++v)
        mesh.positions.push_back({float(view.positions[3 * v]), float(view.positions[3 * v + 1]),
                                  float(view.positions[3 * v + 2])});
    for (std::uint64_t t = 0; t < view.tet_count; ++t)
        mesh.tets.push_back(
            {{view.tets[4 * t], view.tets[4 * t + 1], view.tets[4 * t + 2], view.tets[4 * t + 3]}});
    vox_io_mesh_destroy(file);
    // Around the origin, 1 wide at most.
    vox::Box3f box = vox::empty_box3f();
    for (const Vec3f& p : mesh.positions) extend(box, p);
    const double side =
        double{std::max({box.max.x - box.min.x, box.max.y - box.min.y, box.max.z - box.min.z})};
    move(mesh, 1 / side, -double{box.min.x + box.max.x} / 2 / side, -double{box.min.y + box.max.y} / 2 / side,
         -double{box.min.z + box.max.z} / 2 / side);
    return mesh;
#else
    throw std::runtime_error("built without vox_io, which --meshes needs");
#endif
}

struct Options {
    What what = What::depth;
    double tets = 15000;
    int samples = 8, climb = 8, steps = 4;
    std::uint64_t seed = 1, budget = 0;
    std::string scene, meshes;
};

void run(const Options& options) {
    Setting setting{options.tets};
    if (!options.meshes.empty()) {
        setting.bunny = read_mesh(options.meshes + "/bunny.msh");
        setting.cow = read_mesh(options.meshes + "/cow.msh");
    }
    std::printf("%-13s %23s %9s %9s %8s %8s %7s %8s %8s  %s\n", "scene", "parameters", "tets", "found",
                "alone ms", "step ms", "ratio", "searched", "ns each", "hash");
    Result worst;
    const char* worst_name = "";
    for (const Kind& kind : kinds) {
        if (!options.scene.empty() && options.scene != kind.name) continue;
        if (kind.make == swallow_bunny && options.meshes.empty()) continue;
        Random random{options.seed};
        Result best;
        for (int i = 0; i < options.samples + options.climb; ++i) {
            Parameters parameters;
            const double reach = 0.3 * std::pow(0.85, i - options.samples);
            for (std::size_t k = 0; k < parameters.size(); ++k)
                parameters[k] =
                    i == 0 ? 0.5
                    : i < options.samples
                        ? random.unit()
                        : std::clamp(best.parameters[k] + double{random.uniform(-reach, reach)}, 0.0, 1.0);
            const Result result =
                measure(options.what, kind, setting, parameters, options.steps, options.budget);
            print(options.what, kind.name, result);
            if (result.ratio > best.ratio) best = result;
        }
        if (best.ratio > worst.ratio) {
            worst = best;
            worst_name = kind.name;
        }
    }
    std::printf("worst:\n");
    print(options.what, worst_name, worst);
}

} // namespace

int main(int argc, char** argv) {
    Options options;
    const std::map<std::string, int*> numbers = {
        {"--samples", &options.samples}, {"--climb", &options.climb}, {"--steps", &options.steps}};
    const std::map<std::string, std::string*> texts = {{"--scene", &options.scene},
                                                       {"--meshes", &options.meshes}};
    bool known = argc % 2 == 1;
    for (int i = 1; i + 1 < argc && known; i += 2) {
        const std::string option = argv[i], value = argv[i + 1];
        if (option == "--what") {
            const auto* const name = std::find(std::begin(names), std::end(names), value);
            known = name != std::end(names);
            options.what = static_cast<What>(name - std::begin(names));
        } else if (option == "--tets")
            options.tets = std::atof(value.c_str());
        else if (option == "--seed" || option == "--budget")
            (option == "--seed" ? options.seed : options.budget) = std::strtoull(value.c_str(), nullptr, 10);
        else if (numbers.count(option))
            *numbers.at(option) = std::atoi(value.c_str());
        else if (texts.count(option))
            *texts.at(option) = value;
        else
            known = false;
    }
    if (!known || !(options.tets >= 1000) || options.samples < 1 || options.climb < 0 || options.steps < 2) {
        std::fprintf(stderr, "usage: bench_worst [--what depth|edges|margin|passages] [--tets N >= 1000] "
                             "[--samples K] [--climb K] [--steps K >= 2] "
                             "[--seed S] [--scene NAME] [--meshes FOLDER] [--budget SEARCHES]\n");
        return 2;
    }
    return bench::run_program("bench_worst", [&] {
        run(options);
        return 0;
    });
}
