// Which tets may have turned over: widths against their definition, what is reported as positive against exact
// orientation, and the engine over many steps of bodies that deform, a little or until they are a knot.
#include "internal/fast_checks.hpp"
#include "internal/stage_checks.hpp"

#include "support/suite.h" // last: it defines macros with common names

using namespace vox;
using namespace stages;

namespace {

// A body, its tiles, and what is kept from step to step.
struct Tracked {
    Mesh mesh;
    Tiles tiles = tiles_of(mesh);
    Boundary surface = Boundary(std::pmr::get_default_resource());
    fast::OrientationCache cache = fast::OrientationCache(std::pmr::get_default_resource());
    std::vector<Box> blocks{tiles.block_count()}, moves{tiles.block_count()};
    std::vector<Box> super_boxes{tiles.super_tile_count()}, tile_boxes{tiles.tiles.size()};
    std::vector<std::uint8_t> positive = std::vector<std::uint8_t>(tiles.super_tile_count());
    std::vector<std::uint8_t> known = std::vector<std::uint8_t>(tiles.tiles.size());
    std::vector<std::uint64_t> bad = std::vector<std::uint64_t>(tiles.tiles.size());

    explicit Tracked(Mesh from) : mesh(std::move(from)) {
        make_boundary(mesh.tets, vertex_count(mesh), view(mesh), tiles, surface);
        ck_assert(surface.is_closed);
    }

    float measure(std::uint32_t super) {
        return fast::orient(tiles, surface, packed(mesh), false, tiles.super_first[super],
                            tiles.super_first[super + 1], tile_boxes.data(), known.data(), bad.data(), true);
    }

    void take_reference() {
        Box all;
        fast::stream_boxes(packed(mesh), tiles.block_first, blocks.data(), all);
        cache.reference.assign(packed(mesh), packed(mesh) + 3 * mesh.positions.size());
        fast::track_orientation(tiles, cache, blocks.data(), nullptr, 0, 0, tiles.super_tile_count(),
                     super_boxes.data(), positive.data());
        cache.boxes.assign(super_boxes.begin(), super_boxes.end());
        cache.slack.resize(tiles.super_tile_count());
        for (std::uint32_t s = 0; s < tiles.super_tile_count(); ++s) cache.slack[s] = measure(s);
    }

    // Returns how many super-tiles are positive, after checking each of those.
    std::size_t track(const char* name) {
        Box all;
        fast::stream_boxes(packed(mesh), tiles.block_first, blocks.data(), all, cache.reference.data(),
                           moves.data());
        fast::track_orientation(tiles, cache, blocks.data(), moves.data(), 0, 0, tiles.super_tile_count(),
                     super_boxes.data(), positive.data());
        std::size_t count = 0;
        std::uint64_t exact_tests = 0;
        for (std::uint32_t s = 0; s < tiles.super_tile_count(); ++s) {
            count += positive[s];
            for (std::uint32_t t = tiles.super_first[s]; t < tiles.super_first[s + 1]; ++t)
                for (std::uint32_t i = 0; i < tiles.tiles[t].tet_count; ++i) {
                    const Tet& tet = mesh.tets[tiles.tets[tiles.tiles[t].first_tet + i]];
                    Vec3f q[4];
                    for (int c = 0; c < 4; ++c) {
                        q[c] = mesh.positions[tet.v[c]];
                        ck_assert_msg(overlap(super_boxes[s], box_around(q[c])),
                                      "%s: a vertex is outside of the box of its super-tile", name);
                    }
                    const int sign = surface.mirrored[t] >> i & 1 ? -1 : 1;
                    ck_assert_msg(!positive[s] || orientation(q[0], q[1], q[2], q[3], exact_tests) * sign > 0,
                                  "%s: a tet that turned over is called positive", name);
                }
        }
        return count;
    }
};

double width(const Vec3d (&p)[4]) {
    const auto minus = [](const Vec3d& a, const Vec3d& b) { return Vec3d{a.x - b.x, a.y - b.y, a.z - b.z}; };
    const auto cross = [](const Vec3d& a, const Vec3d& b) {
        return Vec3d{a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    };
    const Vec3d e[6] = {minus(p[1], p[0]), minus(p[2], p[0]), minus(p[3], p[0]),
                        minus(p[2], p[1]), minus(p[3], p[1]), minus(p[3], p[2])};
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 6; ++i) // normals of planes along two edges
        for (int j = 0; j < i; ++j) {
            const Vec3d n = cross(e[i], e[j]);
            const double length = std::hypot(n.x, n.y, n.z);
            double lo = std::numeric_limits<double>::infinity(), hi = -lo;
            for (const Vec3d& q : p) {
                const Vec3d from = minus(q, p[0]);
                const double along = (n.x * from.x + n.y * from.y + n.z * from.z) / length;
                lo = std::min(lo, along);
                hi = std::max(hi, along);
            }
            if (length > 0) least = std::min(least, hi - lo);
        }
    return least;
}

START_TEST(widths_are_lower_bounds) {
    Random r{1};
    for (int round = 0; round < 3000; ++round) {
        Mesh mesh;
        const double size = std::pow(10, r.uniform(-5, 5)), flat = std::pow(10, r.uniform(-7, 0));
        for (int v = 0; v < 4; ++v) {
            const float x = r.uniform(0, size), y = r.uniform(0, size), z = r.uniform(0, size * flat);
            mesh.positions.push_back({x, y, z});
        }
        mesh.tets.push_back({{0, 1, 2, 3}});
        Tracked one(mesh);
        Vec3d p[4];
        for (int v = 0; v < 4; ++v) p[v] = Vec3d(mesh.positions[std::size_t(v)]);
        const double exact = width(p);
        float first = 0;
        at_each_level([&](const char* level) {
            const float found = one.measure(0);
            if (simd::level() == simd::Level::portable) first = found;
            ck_assert_msg(found == first, "%s: width %.9g, %.9g elsewhere", level, double(found),
                          double(first));
            ck_assert_msg(found <= exact, "%s: width %.9g of a tet with width %.9g", level, double(found),
                          exact);
            ck_assert_msg(found > 0.99 * exact || exact < 0.02 * size,
                          "%s: width %.9g of a tet with width %.9g", level, double(found), exact);
        });
        std::swap(one.mesh.positions[0], one.mesh.positions[1]);
        ck_assert(one.measure(0) == 0);
    }
}
END_TEST

START_TEST(tets_called_positive_are) {
    Random r{2};
    for (int round = 0; round < 30; ++round) {
        Mesh mesh = block(8, 8, 8);
        jitter(mesh, 0.15, r);
        if (round % 2) renumber(mesh, r);
        if (round % 3 == 1)
            for (Tet& tet : mesh.tets)
                if (r.below(2)) std::swap(tet.v[2], tet.v[1]);
        if (round % 5 == 4) move(mesh, 1e-2, 77, -5, 1e3);
        const double edge = round % 5 == 4 ? 1e-2 : 1;
        Tracked body(mesh);
        body.take_reference();
        const Mesh before = body.mesh;
        std::size_t seen_positive = 0, seen_doubtful = 0;
        for (int step = 0; step < 12; ++step) {
            const double amount = edge * std::pow(10, r.uniform(-4, 0));
            const float x = r.uniform(-9, 9), y = r.uniform(-9, 9), z = r.uniform(-9, 9);
            body.mesh = before;
            for (Vec3f& p : body.mesh.positions) p = {p.x + x, p.y + y, p.z + z}; // costs no slack
            jitter(body.mesh, amount, r);
            const std::size_t positive = body.track("a block");
            seen_positive += positive;
            seen_doubtful += body.positive.size() - positive;
            if (amount < 0.01 * edge && edge == 1) ck_assert_uint_eq(positive, body.positive.size());
        }
        ck_assert_uint_gt(seen_positive, 0);
        ck_assert_uint_gt(seen_doubtful, 0);
    }
}
END_TEST

// Displacements straight at a facet, just short of it and just beyond.
START_TEST(positive_to_the_last) {
    for (const float far : {0.0f, 64.0f, 4096.0f}) {
        Mesh mesh;
        mesh.positions = {{far, 0, 0}, {far + 1, 0, 0}, {far, 1, 0}, {far, 0, 1}};
        mesh.tets.push_back({{0, 1, 2, 3}});
        Tracked one(mesh);
        one.take_reference();
        const double exact = 1 / std::sqrt(3.0);
        ck_assert(one.cache.slack[0] > 0.999 * exact && one.cache.slack[0] <= exact);
        for (int i = 0; i <= 2000; ++i) {
            const float step = float(i) * 0.0005f;
            one.mesh = mesh;
            one.mesh.positions[3].z -= step;
            const std::size_t positive = one.track("a tet");
            if (step < 0.998 * exact) ck_assert_uint_eq(positive, 1);
            if (step > exact) ck_assert_uint_eq(positive, 0);
        }
    }
}
END_TEST

START_TEST(a_body_too_fast_to_track) {
    fast::OrientationCache cache(std::pmr::get_default_resource());
    int references = 0, steps = 0;
    for (; steps < 400; ++steps) { // every tet doubtful in every step
        if (!fast::wants_reference(cache, 100, 100)) continue;
        ++references;
        cache.is_known = true;
    }
    ck_assert_int_gt(references, 5); // it may calm down
    ck_assert_int_lt(references, 20);
    references = 0;
    cache = fast::OrientationCache(std::pmr::get_default_resource());
    for (steps = 0; steps < 400; ++steps) { // a few more in each step
        if (!fast::wants_reference(cache, cache.is_known ? cache.age * 2 : 100, 100)) continue;
        ++references;
        cache.is_known = true;
    }
    ck_assert_int_gt(references, 40);
}
END_TEST

// The engine and what it keeps, step after step.
START_TEST(engine_tracks_deforming_bodies) {
    Random r{3};
    for (int round = 0; round < 6; ++round) { // the last two: doubles, the last one far away
        const double far = round == 5 ? 1e7 : 0;
        Mesh mesh = block(12, 12, 12);
        jitter(mesh, 0.1, r);
        if (round % 2) renumber(mesh, r);
        Scene scene;
        scene.add(mesh, true);
        scene.prepare();
        FastEngine engine(std::pmr::get_default_resource());
        std::size_t found_some = 0, found_none = 0;
        double phase = 0;
        for (int step = 0; step < 60; ++step) {
            // Calm, faster, folded through itself, and back; now and then a few vertices jump.
            const double amplitude = step < 15 ? 0.3 : step < 30 ? 1.5 : step < 40 ? 9 : 0.5;
            phase += step < 15 ? 0.05 : 0.4;
            for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
                const Vec3f p = mesh.positions[v];
                scene.meshes()[0].positions[v] = {float(p.x + amplitude * std::sin(0.5 * p.y + phase)),
                                                  float(p.y + amplitude * std::sin(0.4 * p.z + 2 * phase)),
                                                  float(p.z + amplitude * std::sin(0.6 * p.x - phase))};
            }
            if (step % 7 == 6)
                for (int i = 0; i < 3; ++i)
                    scene.meshes()[0].positions[r.below(vertex_count(mesh))].x += r.uniform(-2, 2);
            std::vector<Vec3d> doubles;
            for (const Vec3f& p : scene.meshes()[0].positions)
                doubles.push_back({far + p.x + 1e-9 * r.unit(), p.y + 1e-9 * r.unit(), far + p.z});
            if (round >= 4)
                scene.bodies()[0].positions = {reinterpret_cast<const std::byte*>(doubles.data()),
                                               sizeof(Vec3d), true};
            simd::force_level(levels[step % 4]);
            const std::vector<Key> found = run_fast(engine, scene, 0), expected = run_reference(scene, 1);
            ck_assert_msg(found == expected, "round %d, step %d: %zu hits, expected %zu", round, step,
                          found.size(), expected.size());
            (found.empty() ? found_none : found_some) += 1;
        }
        simd::force_level(simd::best_level());
        ck_assert_uint_gt(found_some, 10);
        ck_assert_uint_gt(found_none, 10);
    }
}
END_TEST

} // namespace

int main() {
    Suite* suite = suite_create("orientation");
    TCase* tests = add_case(suite, "orientation");
    tcase_add_each(tests, widths_are_lower_bounds, tets_called_positive_are, positive_to_the_last,
                   a_body_too_fast_to_track, engine_tracks_deforming_bodies);
    return run_suite(suite);
}
