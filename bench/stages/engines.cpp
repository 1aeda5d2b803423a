// The fast engine beside the reference engine, in one process, interleaved: medians of processor time,
// ratios, nanoseconds and bytes a tetrahedron, and two floors measured in the same run: F1, one pass over all
// positions for their minimum and maximum; F2, the box of every tetrahedron. Checks that both engines find
// the same.
//
//   bench_engines [--tets N] [--frames K] [--scene NAME] [--level portable|sse4|avx2|avx512] [--no-reference]
//                 [--cell-size S] [--csv] [--counters]
#include "base/array.hpp"
#include "base/simd.hpp"
#include "fast/engine.hpp"
#include "grid/contacts.hpp"
#include "internal/counting_memory.hpp"
#include "internal/fast_scenes.hpp"
#include "reference/engine.hpp"
#include "scenes/counters.h"
#include "timing.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <string>

using namespace vox;

namespace {

// ---- scenes ---------------------------------------------------------------------------------------

struct Case {
    std::vector<Mesh> meshes;
    bool self = false;
    double wave_length = 1; // of the deformation that runs through the frames
    double amplitude = 0;
};

// Adds a ball to the scene; its radius sets the waves.
Mesh& add_ball(Case& made, double tets, Random& random, double& radius) {
    Mesh& mesh = made.meshes.emplace_back(ball(tets, &radius));
    jitter(mesh, 0.1, random);
    made.wave_length = 2 * radius;
    made.amplitude = 0.02 * radius;
    return mesh;
}

Case balls_apart(double tets, double distance) {
    Case made;
    Random random{1};
    double radius = 0;
    for (int i = 0; i < 2; ++i) {
        Mesh& mesh = add_ball(made, tets / 2, random, radius);
        move(mesh, 1, i * distance * radius, i * 0.123, i * 0.271);
    }
    return made;
}

Case one_ball(double tets) {
    Case made;
    Random random{1};
    double radius = 0;
    add_ball(made, tets, random, radius);
    made.self = true;
    return made;
}

Case many_balls(double count, double each) {
    Case made;
    Random random{1};
    double radius = 0;
    const int side = int(std::lround(std::cbrt(count)));
    for (int k = 0; k < side; ++k)
        for (int j = 0; j < side; ++j)
            for (int i = 0; i < side; ++i) {
                Mesh& mesh = add_ball(made, each, random, radius);
                const double apart = 1.93 * radius, off = 0.05 * radius;
                move(mesh, 1, i * apart + random.uniform(-off, off), j * apart + random.uniform(-off, off),
                     k * apart + random.uniform(-off, off));
            }
    return made;
}

// A square bar wound up so that its turns touch.
Case coil(double tets) {
    Case made;
    Random random{1};
    const double turn = 6 * 3.14159265358979 * 3.14159265358979; // length of two turns in widths, about
    const int w = std::max(2, int(std::lround(std::cbrt(tets / 5 / (2 * turn)))));
    const int length = int(std::lround(tets / 5 / w / w));
    Mesh mesh = block(w, w, length);
    jitter(mesh, 0.08, random);
    const double radius = 3.0 * w;
    for (Vec3f& p : mesh.positions) {
        const double angle = p.z / radius, around = radius + (p.y - w / 2.0);
        const double z = 1.015 * w * angle / (2 * 3.14159265358979) + (p.x - w / 2.0);
        p = {float(around * std::cos(angle)), float(around * std::sin(angle)), float(z)};
    }
    // The map may mirror: keep all tets positive.
    for (Tet& tet : mesh.tets) std::swap(tet.v[2], tet.v[3]);
    made.meshes.push_back(std::move(mesh));
    made.self = true;
    made.wave_length = 2.1 * w;
    made.amplitude = 0.02 * w;
    return made;
}

// Two bodies of so many balls each, all over the world; every ball of one overlaps one of the other.
Case clumps(double count, double tets) {
    Case made;
    Random random{1};
    double radius = 0;
    Mesh bodies[2];
    for (int i = 0; i < int(count); ++i) {
        const double x = random.uniform(-1e5, 1e5), y = random.uniform(-1e5, 1e5),
                     z = random.uniform(-1e5, 1e5);
        for (int b = 0; b < 2; ++b) {
            Mesh mesh = ball(tets / 2 / count, &radius);
            jitter(mesh, 0.1, random);
            move(mesh, 1, x + b * 1.6 * radius, y, z);
            append(bodies[b], mesh);
        }
    }
    for (Mesh& mesh : bodies) made.meshes.push_back(std::move(mesh));
    made.self = true;
    made.wave_length = 2 * radius;
    made.amplitude = 0.02 * radius;
    return made;
}

struct Named {
    const char* name;
    std::function<Case(double)> make;
};

const Named scenes[] = {
    {"pair_1pct_volume", [](double n) { return balls_apart(n, 1.85); }},
    {"pair_1pct_tets", [](double n) { return balls_apart(n, 1.60); }},
    {"pair_half", [](double n) { return balls_apart(n, 0.70); }},
    {"self_ball", one_ball},
    {"self_coil", coil},
    {"many_216", [](double n) { return many_balls(216, n / 216); }},
    {"many_1000", [](double n) { return many_balls(1000, n / 1000); }},
    {"clumps_2", [](double n) { return clumps(2, n); }},
    {"clumps_500", [](double n) { return clumps(500, n); }},
};

// ---- one scene ------------------------------------------------------------------------------------

struct Options {
    double tets = 100000, cell_size = 0;
    int frames = 9;
    std::string scene;
    bool reference = true, csv = false, counters = false;
};

// Positions of frame f: sine waves that run through the bodies.
void deform(const Case& made, Scene& scene, int frame) {
    const double k = 2 * 3.14159265358979 / made.wave_length, a = made.amplitude;
    for (std::size_t b = 0; b < made.meshes.size(); ++b) {
        const double phase = 0.9 * double(b), w = 0.1 * frame;
        const std::vector<Vec3f>& rest = made.meshes[b].positions;
        std::vector<Vec3f>& out = scene.meshes()[b].positions;
        for (std::size_t v = 0; v < rest.size(); ++v) {
            const Vec3f p = rest[v];
            out[v] = {float(p.x + a * std::sin(k * p.y + w + phase)),
                      float(p.y + a * std::sin(k * p.z + 1.3 * w + phase + 1)),
                      float(p.z + a * std::sin(k * p.x + 0.7 * w + phase + 2))};
        }
    }
}

double mean_edge(const Case& made) {
    double sum = 0, count = 0;
    for (const Mesh& mesh : made.meshes)
        for (std::size_t t = 0; t < mesh.tets.size(); t += 1 + mesh.tets.size() / 1000)
            for (int i = 0; i < 4; ++i)
                for (int j = i + 1; j < 4; ++j) {
                    const Vec3f p = mesh.positions[mesh.tets[t].v[i]], q = mesh.positions[mesh.tets[t].v[j]];
                    sum += std::hypot(p.x - q.x, p.y - q.y, p.z - q.z);
                    count += 1;
                }
    return sum / count;
}

volatile float sink;

double floor1(const Scene& scene_in) {
    Scene& scene = const_cast<Scene&>(scene_in);
    const double start = now();
    for (const Mesh& mesh : scene.meshes()) {
        const float* p = &mesh.positions[0].x;
        const std::size_t n = mesh.positions.size() * 3;
        float lo[48], hi[48];
        for (int i = 0; i < 48; ++i) lo[i] = hi[i] = p[i];
        for (std::size_t i = 0; i + 48 <= n; i += 48)
            for (std::size_t j = 0; j < 48; ++j) {
                lo[j] = p[i + j] < lo[j] ? p[i + j] : lo[j];
                hi[j] = p[i + j] > hi[j] ? p[i + j] : hi[j];
            }
        for (int i = 0; i < 48; ++i) sink = lo[i] + hi[i];
    }
    return now() - start;
}

double floor2(Scene& scene, std::vector<std::array<float, 6>>& boxes) {
    const double start = now();
    std::size_t n = 0;
    for (const Mesh& mesh : scene.meshes())
        for (const Tet& tet : mesh.tets) {
            const Vec3f p = mesh.positions[tet.v[0]];
            std::array<float, 6> box{p.x, p.y, p.z, p.x, p.y, p.z};
            for (int c = 1; c < 4; ++c) {
                const Vec3f q = mesh.positions[tet.v[c]];
                box = {std::min(box[0], q.x), std::min(box[1], q.y), std::min(box[2], q.z),
                       std::max(box[3], q.x), std::max(box[4], q.y), std::max(box[5], q.z)};
            }
            boxes[n++] = box;
        }
    sink = boxes[n / 2][0];
    return now() - start;
}

bool run(const Named& named, const Options& options) {
    const Case made = named.make(options.tets);
    CountingMemory memory, tiles_memory;
    Scene scene(&tiles_memory);
    std::size_t tets = 0, vertices = 0;
    for (const Mesh& mesh : made.meshes) {
        scene.add(mesh, made.self);
        tets += mesh.tets.size();
        vertices += mesh.positions.size();
    }
    double start = now();
    scene.prepare();
    const double insert = now() - start;

    FastEngine fast(&memory);
    ReferenceEngine reference(std::pmr::new_delete_resource());
    vox::Array<Hit> fast_hits(&memory), reference_hits(std::pmr::new_delete_resource());
    vox::Array<vox_contact> contacts(std::pmr::new_delete_resource());
    Counters counters{}, reference_counters{};
    Profile profile{}, reference_profile{};
    FastSettings fast_settings;
    fast_settings.cell_size = options.cell_size;
    ReferenceSettings reference_settings;
    std::vector<std::array<float, 6>> boxes(tets);
    const auto run_reference = [&] {
        const double t = now();
        reference_hits.clear();
        reference.detect(scene.bodies(), reference_settings, reference_hits, reference_counters,
                         reference_profile);
        return now() - t;
    };

    // The reference engine's best cell size.
    const double edge = mean_edge(made);
    if (options.reference) {
        double best = 1e30, best_size = edge;
        for (const double factor : {0.85, 1.0, 1.2, 1.5, 1.8, 2.2}) {
            reference_settings.cell_size = factor * edge;
            const double t = run_reference();
            if (t < best) {
                best = t;
                best_size = factor * edge;
            }
        }
        reference_settings.cell_size = best_size;
    }

    std::vector<double> t_fast, t_contacts, t_reference, t_f1, t_f2, t_bin, t_narrow;
    bool same = true;
    for (int frame = 0; frame < options.frames + 1; ++frame) {
        deform(made, scene, frame);
        start = now();
        fast_hits.clear();
        fast.detect(scene.bodies(), scene.prepared(), fast_settings, fast_hits, counters, profile);
        const double fast_time = now() - start;
        const double f1 = floor1(scene), f2 = floor2(scene, boxes);
        // Less often: it takes so much longer.
        const bool with_reference = options.reference && frame % 3 == 1;
        const double reference_time = with_reference ? run_reference() : 0;
        if (with_reference) same = same && keys(fast_hits) == keys(reference_hits);
        start = now();
        make_contacts(scene.bodies(), fast_hits, contacts);
        const double contacts_time = now() - start;
        if (frame == 0) continue; // everything grows
        t_fast.push_back(fast_time);
        t_contacts.push_back(contacts_time);
        t_f1.push_back(f1);
        t_f2.push_back(f2);
        t_bin.push_back(double(profile.bin_ns) * 1e-9);
        t_narrow.push_back(double(profile.narrow_ns) * 1e-9);
        if (with_reference) t_reference.push_back(reference_time);
    }
    const double f = median(t_fast), r = median(t_reference), f1 = median(t_f1), f2 = median(t_f2);
    const double bytes = double(memory.bytes + tiles_memory.bytes) / double(tets);
    if (options.csv)
        std::printf("%s,%zu,%zu,%zu,%s,%g,%g,%g,%g,%g,%g,%g,%g\n", named.name, tets, vertices,
                    contacts.size(), simd::level_name(simd::level()), f * 1e3, median(t_contacts) * 1e3,
                    r * 1e3, f1 * 1e3, f2 * 1e3, f * 1e9 / double(tets), bytes, double(tets) / insert);
    else
        std::printf("%-17s %8zu %7zu | %8.3f %7.3f %6.3f %6.3f | %8.1f %6.1f | %6.3f %5.1f | %6.3f %5.2f | "
                    "%6.2f %5.1f %5.2f %s\n",
                    named.name, tets, contacts.size(), f * 1e3, median(t_contacts) * 1e3, median(t_bin) * 1e3,
                    median(t_narrow) * 1e3, r * 1e3, r / f, f1 * 1e3, f / f1, f2 * 1e3, f / f2,
                    f * 1e9 / double(tets), bytes, double(tets) / insert * 1e-6,
                    same ? "" : "DIFFERENT HITS");
    if (options.counters)
        std::printf(
            "  cells %llu of %.3g, fullest %llu; visited: cells %.2f, points %.2f, box hits %.2f a tet; "
            "exact %llu\n",
            static_cast<unsigned long long>(counters.cells), fast.cell_size(),
            static_cast<unsigned long long>(counters.fullest_cell),
            double(counters.visited_cells) / double(tets), double(counters.visited_entries) / double(tets),
            double(counters.candidates) / double(tets),
            static_cast<unsigned long long>(counters.exact_tests));
    std::fflush(stdout);
    return same;
}

} // namespace

int main(int argc, char** argv) {
    Options options;
    for (int i = 1; i < argc; ++i) {
        const std::string arg = argv[i];
        const char* value = i + 1 < argc ? argv[i + 1] : "";
        if (arg == "--no-reference")
            options.reference = false;
        else if (arg == "--counters")
            options.counters = true;
        else if (arg == "--csv")
            options.csv = true;
        else if (arg == "--tets")
            options.tets = std::atof(value), ++i;
        else if (arg == "--frames")
            options.frames = std::max(1, std::atoi(value)), ++i;
        else if (arg == "--scene")
            options.scene = value, ++i;
        else if (arg == "--cell-size")
            options.cell_size = std::atof(value), ++i;
        else if (arg == "--level") {
            const std::string level = value;
            ++i;
            simd::force_level(level == "portable" ? simd::Level::portable
                              : level == "sse4"   ? simd::Level::sse4
                              : level == "avx2"   ? simd::Level::avx2
                                                  : simd::Level::avx512);
        } else {
            std::fprintf(stderr, "unknown option %s\n", argv[i]);
            return 2;
        }
    }
    if (options.csv)
        std::printf(
            "scene,tets,vertices,contacts,simd,fast_ms,contacts_ms,reference_ms,f1_ms,f2_ms,ns_per_tet,"
            "bytes_per_tet,inserted_per_s\n");
    else
        std::printf("fast engine on %s, milliseconds\n%-17s %8s %7s | %8s %7s %6s %6s | %8s %6s | %6s %5s | "
                    "%6s %5s | "
                    "%6s %5s %5s\n",
                    simd::level_name(simd::level()), "scene", "tets", "contac.", "fast", "order", "bin",
                    "exact", "refer.", "ratio", "F1", "x F1", "F2", "x F2", "ns/tet", "B/tet", "Mtet/s");
    bool same = true;
    for (const Named& named : scenes)
        if (options.scene.empty() || options.scene == named.name) same = run(named, options) && same;
    return same ? 0 : 1;
}
