// Pairs within a distance against loops over all; and that nothing touches while vertices move within their
// clearances.
#include "internal/feature_distance.hpp"
#include "internal/random.hpp"

#include <vox/vox_surface.h>

#include <cmath>
#include <limits>
#include <vector>

#include "support/suite.h" // last: it defines macros with common names

using namespace vox;

namespace {

// Crumpled pieces of sheets, or loose triangles, some of them degenerate.
struct Soup {
    std::vector<Vec3d> at;
    std::vector<std::uint32_t> faces, patches;

    Soup(std::uint64_t seed, bool degenerate) {
        test::Random random{seed};
        const std::uint32_t count = 24 + random.below(40);
        for (std::uint32_t v = 0; v < count; ++v) {
            at.push_back({random.unit(), random.unit(), random.unit()});
            if (degenerate && random.below(3) == 0)
                at.back() = {random.below(3) / 2., random.below(3) / 2., random.below(3) / 2.};
        }
        for (std::uint32_t f = 0; f < count; ++f) {
            const std::uint32_t v = random.below(count - 3);
            faces.insert(faces.end(), {v, v + 1, degenerate && random.below(4) == 0 ? v : v + 2});
        }
        if (seed % 3 == 0)
            for (std::uint32_t v = 0; v < count; ++v) patches.push_back(v % 2);
    }
};

vox_surface* surface_of(const Soup& s, std::uint32_t workers, std::uint64_t budget = 1u << 30) {
    const std::uint64_t masks[2] = {1, 1}, categories[2] = {1, 2}; // the second kind meets nothing of its own
    vox_surface_desc desc = vox_default_surface_desc();
    desc.worker_count = workers;
    desc.vertex_count = s.at.size();
    desc.faces = s.faces.data();
    desc.face_count = s.faces.size() / 3;
    desc.byte_budget = budget;
    if (!s.patches.empty()) {
        desc.patches = s.patches.data();
        desc.patch_count = 2;
        desc.patch_masks = masks;
        desc.patch_categories = categories;
    }
    vox_surface* surface = nullptr;
    ck_ok(vox_surface_create(&desc, &surface));
    return surface;
}

void put(vox_surface* surface, const std::vector<Vec3d>& at) {
    vox_motion motion = vox_default_motion();
    motion.from.data = at.data();
    motion.from.count = motion.to.count = at.size();
    motion.from.format = motion.to.format = VOX_FORMAT_DOUBLE;
    ck_ok(vox_surface_move(surface, &motion));
}

std::vector<std::vector<std::uint32_t>> features_of(vox_surface* surface, std::size_t vertices, int kind) {
    std::vector<std::vector<std::uint32_t>> found;
    if (kind == 0) {
        for (std::uint32_t v = 0; v < vertices; ++v) found.push_back({v});
        return found;
    }
    vox_feature_view view{};
    ck_ok(vox_surface_get_features(surface, vox_feature(kind), &view));
    const auto corners = std::uint64_t(kind) + 1;
    for (std::uint64_t i = 0; i < view.count; ++i)
        found.emplace_back(view.vertices + i * corners, view.vertices + (i + 1) * corners);
    return found;
}

// Of features of up to three and one corners, or two and two: corners are repeated.
double distance_of(const Soup& s, std::vector<std::uint32_t> a, std::vector<std::uint32_t> b) {
    if (a.size() < b.size()) a.swap(b);
    const bool edges = a.size() == 2 && b.size() == 2;
    if (!edges)
        while (a.size() < 3) a.push_back(a.back());
    const Vec3d p[4] = {s.at[a[0]], s.at[a[1]], edges ? s.at[b[0]] : s.at[a[2]],
                        edges ? s.at[b[1]] : s.at[b[0]]};
    return test::feature_distance(p, edges);
}

bool may_pair(const Soup& s, const std::vector<std::uint32_t>& a, const std::vector<std::uint32_t>& b) {
    bool may = s.patches.empty();
    for (const std::uint32_t v : a)
        for (const std::uint32_t w : b) {
            if (v == w) return false;
            if (!s.patches.empty())
                may |=
                    s.patches[v] == 0 || s.patches[w] == 0 ? (s.patches[v] == 0 && s.patches[w] == 0) : false;
        }
    return may;
}

START_TEST(close_pairs_are_those_within_the_distance) {
    std::uint64_t pairs = 0;
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        const Soup s(seed, seed % 2 == 0);
        vox_surface* const surface = surface_of(s, std::uint32_t(1 + seed % 3));
        put(surface, s.at);
        const double distance = seed % 5 == 0 ? 0 : 0.02 * double(seed % 7);
        const int kinds[][2] = {{2, 0}, {0, 2}, {1, 1}, {1, 0}, {0, 1}, {0, 0}};
        for (const auto& kind : kinds) {
            const auto a = features_of(surface, s.at.size(), kind[0]),
                       b = features_of(surface, s.at.size(), kind[1]);
            vox_proximity_view view{};
            ck_ok(vox_surface_find_proximities(surface, vox_feature(kind[0]), vox_feature(kind[1]), distance,
                                               &view));
            std::uint64_t next = 0;
            for (std::uint32_t i = 0; i < a.size(); ++i)
                for (std::uint32_t j = kind[0] == kind[1] ? i + 1 : 0; j < b.size(); ++j) {
                    if (!may_pair(s, a[i], b[j])) continue;
                    const double expected = distance_of(s, a[i], b[j]);
                    const bool is_there =
                        next < view.count && view.data[next].a == i && view.data[next].b == j;
                    if (std::abs(expected - distance) > 1e-9)
                        ck_assert_msg(is_there == (expected < distance), "seed %d, kinds %d %d: %u %u at %g",
                                      int(seed), kind[0], kind[1], i, j, expected);
                    if (!is_there) continue;
                    const vox_proximity& pair = view.data[next++];
                    ck_assert(std::abs(pair.distance - expected) < 1e-9);
                    const Vec3d p{pair.point_a[0], pair.point_a[1], pair.point_a[2]},
                        q{pair.point_b[0], pair.point_b[1], pair.point_b[2]};
                    ck_assert(std::abs(length(p - q) - pair.distance) < 1e-12);
                    Vec3d by_weights = -1 * p;
                    double sum = 0;
                    for (std::size_t c = 0; c < a[i].size(); ++c) {
                        by_weights = by_weights + pair.weights_a[c] * s.at[a[i][c]];
                        sum += pair.weights_a[c];
                        ck_assert(pair.weights_a[c] >= 0);
                    }
                    ck_assert(length(by_weights) < 1e-12 && std::abs(sum - 1) < 1e-12);
                }
            ck_assert_uint_eq(next, view.count);
            pairs += view.count;
        }
        vox_surface_destroy(surface);
    }
    ck_assert_uint_gt(pairs, 500);
}
END_TEST

START_TEST(nothing_touches_within_the_clearance) {
    std::uint64_t free_vertices = 0, halves = 0;
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
        const Soup s(3 * seed + 1, seed % 2 == 0); // without patches
        const double most = seed % 4 == 0 ? 1e-3 : 10;
        vox_surface* const surface = surface_of(s, std::uint32_t(1 + seed % 4));
        put(surface, s.at);
        std::vector<double> clearance(s.at.size(), -1);
        ck_ok(vox_surface_find_clearances(surface, most, clearance.data()));
        // By definition: half of the least distance, capped.
        std::vector<double> expected(s.at.size(), most);
        struct Pair {
            std::vector<std::uint32_t> a, b;
            double distance;
        };
        std::vector<Pair> all;
        for (int k = 0; k < 2; ++k) {
            const auto a = features_of(surface, s.at.size(), k ? 1 : 2),
                       b = features_of(surface, s.at.size(), k ? 1 : 0);
            for (std::size_t i = 0; i < a.size(); ++i)
                for (std::size_t j = k ? i + 1 : 0; j < b.size(); ++j) {
                    if (!may_pair(s, a[i], b[j])) continue;
                    all.push_back({a[i], b[j], distance_of(s, a[i], b[j])});
                    for (const auto* corners : {&a[i], &b[j]})
                        for (const std::uint32_t v : *corners)
                            expected[v] = std::min(expected[v], all.back().distance / 2);
                }
        }
        for (std::size_t v = 0; v < s.at.size(); ++v) {
            ck_assert(clearance[v] >= 0 && clearance[v] <= most && clearance[v] <= expected[v] + 1e-15);
            ck_assert(clearance[v] >= expected[v] * (1 - 1e-6) - 1e-9);
            free_vertices += clearance[v] > 0;
            halves += clearance[v] < most;
        }
        test::Random random{seed};
        for (int round = 0; round < 20; ++round) {
            Soup moved = s;
            for (std::size_t v = 0; v < s.at.size(); ++v) {
                const Vec3d way{random.unit() - .5, random.unit() - .5, random.unit() - .5};
                moved.at[v] = s.at[v] + clearance[v] * (1 - 1e-12) / length(way) * way;
            }
            for (const Pair& pair : all)
                if (pair.distance > 1e-12) ck_assert(distance_of(moved, pair.a, pair.b) > 0);
        }
        vox_surface_destroy(surface);
    }
    ck_assert_uint_gt(free_vertices, 1000);
    ck_assert_uint_gt(halves, 1000);
}
END_TEST

START_TEST(what_is_refused) {
    const Soup s(1, false);
    vox_surface* const surface = surface_of(s, 1);
    vox_proximity_view view{};
    view.count = 5;
    std::vector<double> clearance(s.at.size());
    ck_fails(vox_surface_find_proximities(surface, VOX_FEATURE_EDGE, VOX_FEATURE_EDGE, 1, &view),
             VOX_ERROR_INVALID_STATE, "no positions");
    ck_fails(vox_surface_find_clearances(surface, 1, clearance.data()), VOX_ERROR_INVALID_STATE,
             "no positions");
    put(surface, s.at);
    for (const double bad : {-1.0, std::numeric_limits<double>::infinity(), std::nan("")}) {
        ck_fails(vox_surface_find_proximities(surface, VOX_FEATURE_EDGE, VOX_FEATURE_EDGE, bad, &view),
                 VOX_ERROR_INVALID_ARGUMENT, "distance");
        ck_fails(vox_surface_find_clearances(surface, bad, clearance.data()), VOX_ERROR_INVALID_ARGUMENT,
                 "max_distance");
    }
    ck_fails(vox_surface_find_clearances(surface, 0, clearance.data()), VOX_ERROR_INVALID_ARGUMENT,
             "max_distance is 0");
    ck_fails(vox_surface_find_clearances(surface, 1, nullptr), VOX_ERROR_INVALID_ARGUMENT,
             "out_distances is null");
    ck_fails(vox_surface_find_proximities(surface, VOX_FEATURE_FACE, VOX_FEATURE_FACE, 1, &view),
             VOX_ERROR_INVALID_ARGUMENT, "FACE and VERTEX");
    ck_assert_uint_eq(view.count, 5);
    vox_surface_destroy(surface);
    vox_surface* const tight = surface_of(s, 1, 20000);
    vox_motion motion = vox_default_motion();
    motion.from.data = s.at.data();
    motion.from.count = motion.to.count = s.at.size();
    motion.from.format = motion.to.format = VOX_FORMAT_DOUBLE;
    if (vox_surface_move(tight, &motion) == VOX_OK)
        ck_fails(vox_surface_find_proximities(tight, VOX_FEATURE_EDGE, VOX_FEATURE_EDGE, 10, &view),
                 VOX_ERROR_BUDGET, "20000");
    vox_surface_destroy(tight);
}
END_TEST

} // namespace

SUITE(surface_close) {
    TCase* tests = add_case(suite, "surface_close");
    tcase_add_each(tests, close_pairs_are_those_within_the_distance, nothing_touches_within_the_clearance,
                   what_is_refused);
}
