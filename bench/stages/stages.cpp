// Each stage of the fast engine by itself, under its name (fast/stages.hpp), and parts of stages: nanoseconds
// an element, medians of rounds in which all rows take turns. Processor time of the thread, at the SIMD level
// of the machine or the one asked for.
//
//   bench_stages [--tets N] [--rounds K] [--level portable|sse4|avx2|avx512] [--stage NAME]
#include "fast/stages.hpp"
#include "base/array.hpp"
#include "base/simd.hpp"
#include "fast/broad_phase.hpp"
#include "fast/decide.hpp"
#include "internal/fast_scenes.hpp"
#include "timing.h"

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <memory>
#include <string>

using namespace vox;

namespace {

struct Stage {
    const char* name;
    const char* element;
    std::size_t elements;
    std::function<void()> run;
    std::vector<double> seconds{};
};

class Count final : public fast::Findings {
public:
    std::size_t count = 0;
    void take(std::span<const fast::Finding> findings) override { count += findings.size(); }
};

Positions view(const Mesh& mesh) {
    return {reinterpret_cast<const std::byte*>(mesh.positions.data()), sizeof(Vec3f)};
}

const float* packed(const Mesh& mesh) { return reinterpret_cast<const float*>(mesh.positions.data()); }

// What whole stages read and write. Four balls in a row, each reaching half into the next.
struct WholeStep {
    std::pmr::memory_resource* memory = std::pmr::get_default_resource();
    Scene scene{memory};
    fast::Step step{memory};
    fast::StepBoxes boxes{memory};
    fast::StreamBuffers stream_buffers{memory};
    fast::BroadPhase broad{memory};
    fast::Windows windows{memory};
    fast::LookupBuffers lookup_buffers{memory};
    std::vector<fast::Finding> findings; // in body 0
    Count ignored;
    vox::Array<Hit> hits{memory};
    vox::Array<std::uint64_t> degenerate{memory};
    std::size_t tets = 0, vertices = 0, blocks = 0;

    class Keep final : public fast::Findings {
    public:
        explicit Keep(std::vector<fast::Finding>& kept) : kept_(kept) {}
        void take(std::span<const fast::Finding> findings) override {
            kept_.insert(kept_.end(), findings.begin(), findings.end());
        }

    private:
        std::vector<fast::Finding>& kept_;
    };

    explicit WholeStep(double all_tets) {
        Random random{3};
        for (int b = 0; b < 4; ++b) {
            double radius = 0;
            Mesh mesh = ball(all_tets / 4, &radius);
            jitter(mesh, 0.1, random);
            move(mesh, 1, radius * b, 0.123 * b, 0.271 * b);
            tets += mesh.tets.size();
            vertices += mesh.positions.size();
            scene.add(std::move(mesh));
        }
        scene.prepare();
        stream();
        blocks = step.block_count;
        broad_phase();
        make_windows();
        Keep keep(findings);
        look_up(keep, 1);
    }

    void stream() {
        fast::begin_step(scene.bodies(), nullptr, step);
        for (std::size_t b = 0; b < step.of.size(); ++b) {
            const fast::PreparedBody& prepared = scene.prepared()[b];
            step.of[b].tiles = prepared.tiles;
            step.of[b].last = &prepared.state->last_positions;
            step.of[b].moved = true;
        }
        fast::lay_out(step, boxes);
        fast::stream(step, boxes, stream_buffers);
    }
    void broad_phase() {
        std::fill(boxes.tile_known.begin(), boxes.tile_known.end(), std::uint8_t{0});
        fast::find_regions(step, boxes, broad);
    }
    void make_windows() { fast::make_windows(step, broad, 0, false, boxes, windows); }
    void look_up(fast::Findings& out, std::uint32_t bodies) {
        for (const fast::Piece& piece : step.super_pieces)
            if (piece.body < bodies) fast::look_up(step, broad, windows, piece, boxes, lookup_buffers, out);
    }
    void decide() {
        hits.clear();
        degenerate.clear();
        fast::Decided decided{hits, degenerate};
        fast::DecideCounts counts;
        fast::ExactDecisions(step.bodies, 0, counts, decided).take(findings);
    }
};

// What parts of stages read and write. Two balls, the second reaching half into the first.
struct Bodies {
    std::pmr::memory_resource* memory = std::pmr::get_default_resource();
    Mesh a, b;
    std::uint32_t vertices;
    Tiles tiles{memory};
    Boundary surface{memory};
    std::vector<Box> blocks, groups, super_boxes, tile_boxes, many;
    std::vector<float> change, followed;
    std::vector<std::uint8_t> known, positive, all_positive, sides;
    std::vector<std::uint64_t> bad;
    fast::OrientationCache turning{memory}, unknown{memory}, known_before{memory};
    Box box_a{}, box_b{}, region{};
    fast::PairBuffers pair_buffers{memory};
    vox::Array<fast::Pair> pairs{memory};
    fast::Points points{memory}, sparse{memory};
    fast::WindowLattice lattice{};
    fast::Bins bins{memory}, sparse_bins{memory};
    fast::Window window{};
    std::unique_ptr<fast::LookupScratch> scratch = std::make_unique<fast::LookupScratch>();
    fast::Certificate certificate{memory};
    fast::LastPositions rest{memory};
    std::uint64_t exact_tests = 0;
    Count found;

    explicit Bodies(double tets) {
        Random random{1};
        double radius = 0;
        a = ball(tets / 2, &radius);
        jitter(a, 0.1, random);
        b = ball(tets / 2);
        jitter(b, 0.1, random);
        move(b, 1, radius, 0.123, 0.271);
        vertices = std::uint32_t(a.positions.size());
        make_tiles(a.tets, vertices, view(a), tiles);
        blocks.resize(tiles.block_count());
        sides.resize(blocks.size());
        tile_boxes.resize(tiles.tiles.size());
        known.resize(tiles.tiles.size());
        groups.resize((blocks.size() + fast::group_blocks - 1) / fast::group_blocks);
        fast::stream_boxes(packed(a), tiles.block_first, blocks.data(), groups.data(), box_a);
        make_boundary(a.tets, vertices, view(a), tiles, surface);
        super_boxes.resize(tiles.super_tile_count());
        positive.resize(super_boxes.size());
        all_positive.resize(super_boxes.size());
        followed.resize(super_boxes.size());
        change.assign(super_boxes.size(), float_infinity);
        bad.resize(tiles.tiles.size());
        fast::track_orientation(tiles, turning, packed(a), blocks.data(), 0, 0, tiles.super_tile_count(),
                                super_boxes.data(), change.data(), positive.data());
        orient(known_before); // measures
        unknown.prepare(tiles);
        for (fast::Shape& shape : unknown.shapes) shape.resumes = ~0u;
        std::fill(positive.begin(), positive.end(), std::uint8_t{1});
        rest.positions.resize(std::size_t{vertices} * 3);
        rest.parts.resize(1);
        box_b = empty_box;
        for (const Vec3f& p : b.positions) add(box_b, {{p.x, p.y, p.z, 0}, {p.x, p.y, p.z, 0}});
        region = box_a;
        intersect(region, box_b);
        const double side = 2 * std::cbrt(tets / 1000); // boxes of bodies, each meeting a few others
        for (double i = 0; i < tets / 100; ++i) {
            const float x = random.uniform(0, side), y = random.uniform(0, side), z = random.uniform(0, side);
            many.push_back({{x, y, z, 0}, {x + 1, y + 1, z + 1, 0}});
        }
        collect();
        lattice = fast::make_lattice(points, fast::bounds(points), cell_size, 2 * std::size_t{points.count});
        bin();
        scatter();
    }

    void orient(fast::OrientationCache& cache) {
        fast::orient({tiles, surface, packed(a), vertices, false, 0, change.data(), positive.data(),
                      tile_boxes.data(), known.data()},
                     cache, bad.data(), nullptr);
    }

    static constexpr double cell_size = 1.7; // 0.6 sides of a tile, about

    void collect() {
        points.count = 0;
        const auto count = std::uint32_t(b.positions.size());
        points.reserve(count);
        fast::collect(packed(b), 0, count, count, region, points);
    }

    void bin() {
        bins.clear();
        window = fast::bin(points, lattice, region, bins);
    }

    // The points of b in a thousand places far apart, neighbours staying together. (The order that bin_tree
    // leaves is as good for the next round.)
    void scatter() {
        sparse.count = 0;
        sparse.reserve(b.positions.size());
        Random random{2};
        float x = 0, y = 0, z = 0;
        for (std::uint32_t v = 0; v < b.positions.size(); ++v) {
            if (v % (b.positions.size() / 1000 + 1) == 0) {
                x = random.uniform(-1e5, 1e5);
                y = random.uniform(-1e5, 1e5);
                z = random.uniform(-1e5, 1e5);
            }
            const Vec3f p = b.positions[v];
            sparse.x[v] = p.x + x;
            sparse.y[v] = p.y + y;
            sparse.z[v] = p.z + z;
            sparse.id[v] = v;
        }
        sparse.count = std::uint32_t(b.positions.size());
    }

    void look_up() {
        fast::TiledBody q{};
        q.tiles = &tiles;
        q.positions = packed(a);
        q.boxes = q.made = tile_boxes.data();
        q.known = known.data();
        const fast::Source source{window, region, 1};
        fast::look_up_tiles(q, {&source, 1}, 0, std::uint32_t(tiles.tiles.size()), *scratch, found);
        fast::flush(*scratch, found);
    }
};

std::vector<Stage> stages_of(WholeStep& w, Bodies& s) {
    const std::size_t tets = s.a.tets.size();
    return {
        {"stream", "vertex", w.vertices, [&w] { w.stream(); }},
        {"winding", "tet", tets,
         [&s] {
             const fast::WindingBody body{{s.tiles, s.surface, packed(s.a), s.vertices, false, 0,
                                           s.change.data(), s.positive.data(), s.tile_boxes.data(),
                                           s.known.data()},
                                          s.box_a,
                                          2.3,
                                          s.super_boxes.data(),
                                          s.turning,
                                          nullptr};
             fast::certify(body, s.certificate, s.exact_tests);
         }},
        {"broad_phase", "block", w.blocks, [&w] { w.broad_phase(); }},
        {"windows", "vertex", w.vertices, [&w] { w.make_windows(); }},
        {"lookup", "tet", w.tets, [&w] { w.look_up(w.ignored, 4); }},
        {"decide", "finding", w.findings.size(), [&w] { w.decide(); }},
        {"tiles", "tet", tets,
         [&s] {
             Tiles tiles(s.memory);
             make_tiles(s.a.tets, s.vertices, view(s.a), tiles);
         }},
        {"boundary", "tet", tets,
         [&s] {
             Boundary boundary(s.memory);
             make_boundary(s.a.tets, s.vertices, view(s.a), s.tiles, boundary);
         }},
        {"block boxes", "vertex", s.vertices,
         [&s] {
             fast::stream_boxes(packed(s.a), s.tiles.block_first, s.blocks.data(), s.groups.data(), s.box_a);
         }},
        {"pairs", "box", s.many.size(), [&s] { fast::find_pairs(s.many, {}, s.pair_buffers, s.pairs); }},
        {"sides", "block", s.blocks.size(),
         [&s] { fast::find_sides(s.blocks.data(), s.blocks.size(), s.region, s.sides.data()); }},
        {"tile boxes", "tet", tets,
         [&s] {
             std::fill(s.known.begin(), s.known.end(), std::uint8_t{0});
             fast::make_tile_boxes(s.tiles, packed(s.a), 0, std::uint32_t(s.tiles.tiles.size()),
                                   s.tile_boxes.data(), s.known.data());
         }},
        {"compare", "vertex", s.vertices,
         [&s] { fast::compare_packed(s.rest, 0, packed(s.a), 0, s.vertices, s.box_a); }},
        {"collect", "vertex", s.b.positions.size(), [&s] { s.collect(); }},
        {"bin", "point", s.points.count, [&s] { s.bin(); }},
        {"bin sparse", "point", s.sparse.count,
         [&s] {
             s.sparse_bins.clear();
             fast::bin_tree(s.sparse, Bodies::cell_size, s.sparse_bins);
         }},
        {"look up tiles", "tet", tets, [&s] { s.look_up(); }},
        {"follow", "tet", tets,
         [&s] {
             const auto supers = s.tiles.super_tile_count();
             fast::track_orientation(s.tiles, s.known_before, packed(s.a), s.blocks.data(), 0, 0, supers,
                                     s.super_boxes.data(), s.followed.data(), s.all_positive.data());
         }},
        {"orient", "tet", tets,
         [&s] {
             std::fill(s.positive.begin(), s.positive.end(), std::uint8_t{0});
             s.orient(s.unknown);
             std::fill(s.positive.begin(), s.positive.end(), std::uint8_t{1});
         }},
    };
}

} // namespace

int main(int argc, char** argv) {
    double tets = 200000;
    int rounds = 11;
    std::string only;
    for (int i = 1; i < argc; i += 2) {
        const std::string option = argv[i], value = i + 1 < argc ? argv[i + 1] : "";
        if (option == "--tets" && std::atof(value.c_str()) >= 1000)
            tets = std::atof(value.c_str());
        else if (option == "--rounds" && std::atoi(value.c_str()) > 0)
            rounds = std::atoi(value.c_str());
        else if (option == "--stage")
            only = value;
        else if (option == "--level" && value == "portable")
            simd::force_level(simd::Level::portable);
        else if (option == "--level" && value == "sse4")
            simd::force_level(simd::Level::sse4);
        else if (option == "--level" && value == "avx2")
            simd::force_level(simd::Level::avx2);
        else if (option == "--level" && value == "avx512")
            simd::force_level(simd::Level::avx512);
        else {
            std::fprintf(stderr,
                         "usage: bench_stages [--tets N >= 1000] [--rounds K] [--level portable|sse4|avx2|"
                         "avx512] [--stage NAME]\n");
            return 2;
        }
    }
    WholeStep step(tets);
    Bodies bodies(tets);
    std::vector<Stage> stages = stages_of(step, bodies);
    for (std::size_t i = 0; i < std::size(fast::stage_names);
         ++i) // the first rows are the stages in their order
        if (std::strcmp(stages[i].name, fast::stage_names[i]) != 0) {
            std::fprintf(stderr, "row %zu is %s, expected stage %s\n", i, stages[i].name,
                         fast::stage_names[i]);
            return 1;
        }
    for (int round = 0; round <= rounds; ++round) // the first is not counted: buffers grow
        for (Stage& stage : stages) {
            if (!only.empty() && only != stage.name) continue;
            // Short ones several times, for at least a millisecond or so.
            const double start = now();
            double taken = 0;
            int times = 0;
            do {
                stage.run();
                ++times;
                taken = now() - start;
            } while (taken < 1e-3);
            if (round > 0) stage.seconds.push_back(taken / times);
        }
    std::printf("stages of the fast engine, %s, medians of %d rounds\n%-12s %10s %-8s %10s %10s\n",
                simd::level_name(simd::level()), rounds, "stage", "elements", "", "ms", "ns each");
    for (const Stage& stage : stages)
        if (!stage.seconds.empty()) {
            const double time = median(stage.seconds);
            std::printf("%-12s %10zu %-8s %10.3f %10.2f\n", stage.name, stage.elements, stage.element,
                        time * 1e3, time * 1e9 / double(stage.elements));
        }
    return 0;
}
