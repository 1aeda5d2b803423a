// vox_surface_find_crossings against all edges and all faces, each pair decided by find_crossing(), which
// test_crossing compares with rational numbers.
#include "exact/crossing.hpp"
#include "scenes/bodies.h"
#include "support/surface_counter.h"

#include <vox/vox_surface.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

using namespace vox;

namespace {

struct TestSurface {
    std::vector<double> positions;
    std::vector<std::uint32_t> faces, edges, patches; // edges empty: those of the faces
    std::vector<std::uint64_t> categories, masks;

    std::uint64_t vertex_count() const { return positions.size() / 3; }
    Vec3d at(std::uint32_t v) const { return {positions[3 * v], positions[3 * v + 1], positions[3 * v + 2]}; }
};

vox_surface_desc desc_of(const TestSurface& of) {
    vox_surface_desc desc = vox_default_surface_desc();
    desc.vertex_count = of.vertex_count();
    desc.face_count = of.faces.size() / 3;
    desc.faces = of.faces.data();
    desc.edge_count = of.edges.size() / 2;
    desc.edges = of.edges.empty() ? nullptr : of.edges.data();
    if (!of.patches.empty()) {
        desc.patches = of.patches.data();
        desc.patch_count = of.masks.size();
        desc.patch_categories = of.categories.data();
        desc.patch_masks = of.masks.data();
    }
    return desc;
}

vox_surface* surface_of(const vox_surface_desc& desc) {
    vox_surface* surface = nullptr;
    ck_ok(vox_surface_create(&desc, &surface));
    return surface;
}

void move(vox_surface* surface, const TestSurface& of, const void* from, const void* to = nullptr,
          vox_format format = VOX_FORMAT_DOUBLE) {
    vox_motion motion = vox_default_motion();
    motion.from.count = motion.to.count = of.vertex_count();
    motion.from.data = from;
    motion.to.data = to;
    motion.from.format = motion.to.format = format;
    motion.radius = 0.3; // does not count
    ck_ok(vox_surface_move(surface, &motion));
}

std::vector<vox_crossing> crossings_of(vox_surface* surface) {
    vox_crossing_view view{};
    ck_ok(vox_surface_find_crossings(surface, &view));
    return {view.data, view.data + view.count};
}

std::vector<std::uint32_t> edges_of(const vox_surface* surface) {
    vox_feature_view view{};
    ck_ok(vox_surface_get_features(surface, VOX_FEATURE_EDGE, &view));
    return {view.vertices, view.vertices + 2 * view.count};
}

bool may_meet(const TestSurface& s, const std::uint32_t* edge, const std::uint32_t* face) {
    if (s.patches.empty()) return true;
    for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 3; ++j) {
            const std::uint32_t a = s.patches[edge[i]], b = s.patches[face[j]];
            if ((s.categories[a] & s.masks[b]) && (s.categories[b] & s.masks[a])) return true;
        }
    return false;
}

std::vector<vox_crossing> brute_force(const TestSurface& s, const std::vector<std::uint32_t>& edges) {
    std::vector<vox_crossing> all;
    std::uint64_t exact_tests = 0;
    for (std::uint32_t e = 0; e < edges.size() / 2; ++e)
        for (std::uint32_t f = 0; f < s.faces.size() / 3; ++f) {
            const std::uint32_t *u = &edges[2 * e], *v = &s.faces[3 * f];
            bool share = false;
            for (int i = 0; i < 6; ++i) share |= u[i % 2] == v[i / 2];
            if (share || !may_meet(s, u, v)) continue;
            const Crossing found =
                find_crossing(s.at(u[0]), s.at(u[1]), s.at(v[0]), s.at(v[1]), s.at(v[2]), exact_tests);
            if (found.kind == CrossingKind::none) continue;
            vox_crossing crossing{};
            crossing.edge = e;
            crossing.face = f;
            crossing.kind = static_cast<vox_crossing_kind>(static_cast<int>(found.kind) - 1);
            std::copy(found.edge_weights.begin(), found.edge_weights.end(), crossing.edge_weights);
            std::copy(found.face_weights.begin(), found.face_weights.end(), crossing.face_weights);
            crossing.position[0] = found.position.x;
            crossing.position[1] = found.position.y;
            crossing.position[2] = found.position.z;
            all.push_back(crossing);
        }
    return all;
}

void check_equal(const std::vector<vox_crossing>& found, const std::vector<vox_crossing>& expected) {
    ck_assert_uint_eq(found.size(), expected.size());
    if (!found.empty()) ck_assert_mem_eq(found.data(), expected.data(), found.size() * sizeof found[0]);
}

// Appends a bar of 8 vertices and 12 faces.
void add_bar(TestSurface& s, double x0, double x1, double y0, double y1, double z0, double z1) {
    static const std::uint32_t faces[36] = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                            2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
    const auto first = static_cast<std::uint32_t>(s.vertex_count());
    for (int i = 0; i < 8; ++i)
        s.positions.insert(s.positions.end(), {i & 1 ? x1 : x0, i & 2 ? y1 : y0, i & 4 ? z1 : z0});
    for (const std::uint32_t v : faces) s.faces.push_back(first + v);
}

// Triangles between random points; many coincide, or are degenerate, on a lattice.
TestSurface random_surface(std::uint64_t& random, bool on_lattice) {
    TestSurface s;
    const std::uint32_t vertices = 6 + random_below(&random, 40), faces = 1 + random_below(&random, 60);
    for (std::uint32_t i = 0; i < 3 * vertices; ++i)
        s.positions.push_back(on_lattice ? double(random_below(&random, 4)) : random_unit(&random));
    for (std::uint32_t i = 0; i < 3 * faces; ++i) s.faces.push_back(random_below(&random, vertices));
    if (random_below(&random, 2))
        for (std::uint32_t i = 0; i < 2 * faces; ++i) s.edges.push_back(random_below(&random, vertices));
    if (random_below(&random, 2)) {
        for (std::uint32_t v = 0; v < vertices; ++v) s.patches.push_back(random_below(&random, 3));
        s.categories = {1, 2, 4};
        for (int p = 0; p < 3; ++p) s.masks.push_back(random_below(&random, 8));
    }
    return s;
}

START_TEST(random_surfaces_equal_brute_force) {
    std::uint64_t random = 5, kinds[3] = {0, 0, 0};
    for (int round = 0; round < 400; ++round) {
        const bool on_lattice = round % 2 == 0;
        TestSurface s = random_surface(random, on_lattice);
        vox_surface_desc desc = desc_of(s);
        desc.worker_count = round % 3 == 0 ? 4 : 1;
        vox_surface* surface = surface_of(desc);
        const std::vector<std::uint32_t> edges = edges_of(surface);
        for (int step = 0; step < 2; ++step) {
            std::vector<double> from = s.positions;
            for (double& x : from) x += random_symmetric(&random);
            move(surface, s, from.data(), s.positions.data()); // the end of the motion is what counts
            const std::vector<vox_crossing> found = crossings_of(surface);
            check_equal(found, brute_force(s, edges));
            check_equal(crossings_of(surface), found);
            for (const vox_crossing& c : found) ++kinds[c.kind];
            for (double& x : s.positions)
                if (!on_lattice) x += 0.1 * random_symmetric(&random);
        }
        // Floats give what their doubles give.
        std::vector<float> floats(s.positions.begin(), s.positions.end());
        s.positions.assign(floats.begin(), floats.end());
        move(surface, s, floats.data(), nullptr, VOX_FORMAT_FLOAT);
        check_equal(crossings_of(surface), brute_force(s, edges));
        vox_surface_destroy(surface);
    }
    for (const std::uint64_t count : kinds) ck_assert_uint_gt(count, 1000);
}
END_TEST

START_TEST(crossed_bars) {
    TestSurface s;
    add_bar(s, -4, 4, -1, 1, -1, 1);
    add_bar(s, -1, 1, -4, 4, 0.5, 2.5);
    vox_surface* surface = surface_of(desc_of(s));
    move(surface, s, s.positions.data());
    std::vector<vox_crossing> found = crossings_of(surface);
    ck_assert_uint_gt(found.size(), 0);
    for (const vox_crossing& c : found) {
        // The edges of one bar pass through the sides of the other, between z = 0.5 and 1.
        ck_assert(c.position[2] >= 0.5 && c.position[2] <= 1);
        ck_assert_double_le(std::abs(c.position[0]), 1);
        ck_assert_double_le(std::abs(c.position[1]), 1);
    }
    // One bar alone is free of intersections; so are the two when they are apart.
    for (std::size_t v = 8; v < 16; ++v) s.positions[3 * v + 2] += 0.6;
    move(surface, s, s.positions.data());
    ck_assert_uint_eq(crossings_of(surface).size(), 0);
    // The lower one's top face and the upper one's bottom face in one plane.
    for (std::size_t v = 8; v < 16; ++v) s.positions[3 * v + 2] -= 0.1;
    move(surface, s, s.positions.data());
    found = crossings_of(surface);
    ck_assert_uint_gt(found.size(), 0);
    for (const vox_crossing& c : found) ck_assert_int_ne(c.kind, VOX_CROSSING_THROUGH);
    vox_surface_destroy(surface);
}
END_TEST

START_TEST(arguments) {
    TestSurface s;
    add_bar(s, 0, 1, 0, 1, 0, 1);
    vox_surface* surface = surface_of(desc_of(s));
    vox_crossing_view view{};
    view.count = 77;
    ck_fails(vox_surface_find_crossings(nullptr, &view), VOX_ERROR_INVALID_ARGUMENT, "surface is null");
    ck_fails(vox_surface_find_crossings(surface, nullptr), VOX_ERROR_INVALID_ARGUMENT, "out_view is null");
    ck_fails(vox_surface_find_crossings(surface, &view), VOX_ERROR_INVALID_STATE, "no positions yet");
    ck_assert_uint_eq(view.count, 77);
    vox_surface_destroy(surface);

    // No faces; no edges.
    TestSurface none;
    none.positions = {0, 0, 0, 1, 1, 1};
    surface = surface_of(desc_of(none));
    move(surface, none, none.positions.data());
    ck_assert_uint_eq(crossings_of(surface).size(), 0);
    vox_surface_destroy(surface);
}
END_TEST

// Parallel triangles across one box, edges in a corner of it beyond all of them, and one edge through all:
// many candidates, few crossings. These come from any budget that holds them and the candidates of a few
// edges.
START_TEST(budgets) {
    TestSurface s;
    constexpr std::uint32_t n = 1000;
    for (std::uint32_t i = 0; i < n; ++i) {
        const double x = 1 + 1e-4 * i;
        s.positions.insert(s.positions.end(),
                           {x, 0, 0, 0, x, 0, 0, 0, x, 0.9, 0.9, 0.9, 0.9, 0.9, 0.8 + 1e-5 * i});
        s.faces.insert(s.faces.end(), {5 * i, 5 * i + 1, 5 * i + 2});
        s.edges.insert(s.edges.end(), {5 * i + 3, 5 * i + 4});
    }
    s.positions.insert(s.positions.end(), {0, 0, 0.01, 1, 1, 1});
    s.edges.insert(s.edges.end(), {5 * n, 5 * n + 1});
    vox_surface_desc desc = desc_of(s);
    vox_surface* surface = surface_of(desc);
    move(surface, s, s.positions.data());
    const std::vector<vox_crossing> expected = crossings_of(surface);
    ck_assert_uint_eq(expected.size(), n);
    const std::uint64_t most = surface_counter(surface, "peak_bytes");
    vox_surface_destroy(surface);
    int refused = 0, answered = 0;
    for (int share = 1; share <= 20; ++share) {
        desc.byte_budget = most * static_cast<std::uint64_t>(share) / 20;
        vox_motion motion = vox_default_motion();
        motion.from.data = s.positions.data();
        motion.from.count = motion.to.count = s.vertex_count();
        motion.from.format = motion.to.format = VOX_FORMAT_DOUBLE;
        surface = nullptr;
        if (vox_surface_create(&desc, &surface) != VOX_OK) continue;
        if (vox_surface_move(surface, &motion) == VOX_OK) {
            vox_crossing_view view{};
            const vox_result result = vox_surface_find_crossings(surface, &view);
            if (result == VOX_OK) {
                check_equal({view.data, view.data + view.count}, expected);
                ++answered;
            } else {
                ck_assert_int_eq(result, VOX_ERROR_BUDGET);
                ++refused;
            }
            ck_assert_uint_le(surface_counter(surface, "peak_bytes"), desc.byte_budget);
        }
        vox_surface_destroy(surface);
    }
    ck_assert_int_gt(refused, 0);
    ck_assert_int_gt(answered, 10);
}
END_TEST

} // namespace

SUITE(surface_crossings) {
    TCase* tests = add_case(suite, "crossings");
    tcase_add_each(tests, random_surfaces_equal_brute_force, crossed_bars, arguments, budgets);
}
