// Pairs of surface features against loops over all of them, in the numbers of the caller's format.
#include "base/simd.hpp"
#include "internal/random.hpp"

#include <vox/vox_surface.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <set>
#include <utility>
#include <vector>

#include "support/surface_counter.h" // last: it defines macros with common names

using namespace vox;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

struct Scene {
    std::uint32_t vertex_count = 0;
    std::vector<std::uint32_t> edges, faces, patches;
    std::vector<std::uint64_t> categories, masks;
    std::vector<double> from, to; // rounded to floats where the format is
    bool doubles = false, moves = false, columns = false, no_edges_given = false;
    double radius = 0;

    std::uint32_t count(int kind) const {
        return kind == 0 ? vertex_count : std::uint32_t(kind == 1 ? edges.size() / 2 : faces.size() / 3);
    }
    std::vector<std::uint32_t> corners(int kind, std::uint32_t i) const {
        if (kind == 0) return {i};
        const auto& all = kind == 1 ? edges : faces;
        const std::uint32_t width = std::uint32_t(kind) + 1;
        return {all.begin() + width * i, all.begin() + width * (i + 1)};
    }
};

struct TestBox {
    double lo[3], hi[3];
};

// As vox_motion.radius has it.
TestBox box_of(const Scene& s, int kind, std::uint32_t i) {
    TestBox box{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
    for (const std::uint32_t v : s.corners(kind, i))
        for (int a = 0; a < 3; ++a)
            for (const std::vector<double>* at : {&s.from, &s.to}) {
                if (at == &s.to && !s.moves) continue;
                const double x = (*at)[3 * v + std::uint32_t(a)];
                const double lo = s.doubles ? std::nextafter(x - s.radius, -infinity)
                                            : double{std::nextafter(float(x - s.radius), -float(infinity))};
                const double hi = s.doubles ? std::nextafter(x + s.radius, infinity)
                                            : double{std::nextafter(float(x + s.radius), float(infinity))};
                box.lo[a] = std::min(box.lo[a], lo);
                box.hi[a] = std::max(box.hi[a], hi);
            }
    return box;
}

bool make_a_pair(const Scene& s, int a, std::uint32_t i, const TestBox& p, int b, std::uint32_t j,
                 const TestBox& q) {
    for (int k = 0; k < 3; ++k)
        if (!(p.lo[k] <= q.hi[k] && q.lo[k] <= p.hi[k])) return false;
    bool may_meet = s.patches.empty();
    for (const std::uint32_t v : s.corners(a, i))
        for (const std::uint32_t w : s.corners(b, j)) {
            if (v == w) return false;
            if (s.patches.empty()) continue;
            const std::uint32_t x = s.patches[v], y = s.patches[w];
            may_meet |= (s.categories[x] & s.masks[y]) != 0 && (s.categories[y] & s.masks[x]) != 0;
        }
    return may_meet;
}

std::vector<std::vector<std::uint32_t>> by_definition(const Scene& s, int a, int b) {
    std::vector<std::vector<std::uint32_t>> lists(s.count(a));
    std::vector<TestBox> boxes;
    for (std::uint32_t j = 0; j < s.count(b); ++j) boxes.push_back(box_of(s, b, j));
    for (std::uint32_t i = 0; i < s.count(a); ++i) {
        const TestBox box = box_of(s, a, i);
        for (std::uint32_t j = a == b ? i + 1 : 0; j < s.count(b); ++j)
            if (make_a_pair(s, a, i, box, b, j, boxes[j])) lists[i].push_back(j);
    }
    return lists;
}

// Positions as the caller has them: floats or doubles, rows or columns.
struct CallerPositions {
    CallerPositions(const Scene& s, const std::vector<double>& from) {
        const std::size_t size = s.doubles ? 8 : 4, n = s.vertex_count;
        bytes.resize(from.size() * size);
        for (std::size_t v = 0; v < n; ++v)
            for (std::size_t c = 0; c < 3; ++c) {
                const std::size_t at = s.columns ? c * n + v : 3 * v + c;
                const double x = from[3 * v + c];
                const float f = float(x);
                if (s.doubles)
                    std::memcpy(bytes.data() + at * size, &x, size);
                else
                    std::memcpy(bytes.data() + at * size, &f, size);
            }
    }
    std::vector<char> bytes;
};

vox_surface* surface_of(const Scene& s, std::uint32_t workers, double cell_size, std::uint64_t budget) {
    vox_surface_desc desc = vox_default_surface_desc();
    desc.worker_count = workers;
    desc.vertex_count = s.vertex_count;
    desc.edge_count = s.no_edges_given ? 0 : s.edges.size() / 2;
    desc.face_count = s.faces.size() / 3;
    desc.edges = s.no_edges_given ? nullptr : s.edges.data();
    desc.faces = s.faces.data();
    if (!s.patches.empty()) {
        desc.patches = s.patches.data();
        desc.patch_categories = s.categories.data();
        desc.patch_masks = s.masks.data();
        desc.patch_count = s.categories.size();
    }
    desc.cell_size = cell_size;
    desc.byte_budget = budget;
    vox_surface* surface = nullptr;
    ck_assert_msg(vox_surface_create(&desc, &surface) == VOX_OK, "%s", vox_last_error());
    return surface;
}

void move(vox_surface* surface, const Scene& s, std::uint32_t flags = 0) {
    const CallerPositions from(s, s.from), to(s, s.moves ? s.to : s.from);
    vox_motion motion = vox_default_motion();
    motion.flags = flags;
    motion.from.data = from.bytes.data();
    motion.to.data = s.moves ? to.bytes.data() : nullptr;
    motion.from.count = motion.to.count = s.vertex_count;
    motion.from.format = motion.to.format = s.doubles ? VOX_FORMAT_DOUBLE : VOX_FORMAT_FLOAT;
    if (s.columns) {
        motion.from.byte_stride = motion.to.byte_stride = s.doubles ? 8 : 4;
        motion.from.component_byte_stride = motion.to.component_byte_stride =
            motion.from.byte_stride * s.vertex_count;
    }
    motion.radius = s.radius;
    ck_assert_msg(vox_surface_move(surface, &motion) == VOX_OK, "%s", vox_last_error());
}

// All lists of a kind, asked for in as many pieces as it takes.
std::vector<std::vector<std::uint32_t>> asked(vox_surface* surface, int a, int b,
                                              std::uint64_t step = ~0ull) {
    std::vector<std::vector<std::uint32_t>> lists;
    for (;;) {
        vox_partner_lists view{};
        ck_assert_msg(vox_surface_find_pairs(surface, vox_feature(a), vox_feature(b), lists.size(), step,
                                             &view) == VOX_OK,
                      "%s", vox_last_error());
        ck_assert_uint_eq(view.first, lists.size());
        if (view.count == 0) return lists;
        for (std::uint64_t i = 0; i < view.count; ++i)
            lists.emplace_back(view.partners + view.offsets[i], view.partners + view.offsets[i + 1]);
    }
}

// A number that others often have too, so that boxes touch, or differ in the last place.
double coordinate(Random& random, bool doubles, double scale, double origin) {
    double x = origin + scale * double(random.below(9)) / 8;
    if (random.below(3) == 0) x += scale * random.unit() / 4;
    if (random.below(4) == 0)
        x = doubles ? std::nextafter(x, infinity) : double{std::nextafter(float(x), 1e30f)};
    return doubles ? x : double{float(x)};
}

Scene random_scene(Random& random) {
    Scene s;
    s.vertex_count = 1 + std::uint32_t(random.below(random.below(4) == 0 ? 400 : 40));
    s.doubles = random.below(2) == 0;
    s.moves = random.below(2) == 0;
    s.columns = s.vertex_count > 1 && random.below(3) == 0;
    const double scale = random.below(8) == 0 ? 1e-30 : random.below(8) == 0 ? 1e30 : 1;
    s.radius = random.below(3) == 0 ? 0 : random.below(20) == 0 ? infinity : scale * random.unit() / 16;
    double origin[3] = {0, 0, 0}; // far away, so that floats are coarse, and doubles at last
    if (random.below(4) == 0)
        for (double& x : origin)
            x = random.below(3) == 0 ? 0 : scale * std::pow(10.0, double(random.below(scale > 1 ? 8 : 16)));
    for (std::uint32_t i = 0; i < 3 * s.vertex_count; ++i)
        s.from.push_back(coordinate(random, s.doubles, scale, origin[i % 3]));
    if (random.below(16) == 0) // sizes of all orders in one scene
        for (double& x : s.from) {
            const double scaled = x * std::pow(10.0, double(random.below(60)) - 30) / scale;
            x = std::abs(scaled) < 3e38 ? (s.doubles ? scaled : double{float(scaled)}) : FLT_MAX;
        }
    for (std::uint32_t i = 0; i < 3 * s.vertex_count; ++i)
        s.to.push_back(random.below(3) == 0 ? coordinate(random, s.doubles, scale, origin[i % 3])
                                            : s.from[i]);
    const auto vertex = [&] { return std::uint32_t(random.below(s.vertex_count)); };
    for (std::uint64_t i = random.below(2 * s.vertex_count + 1); i > 0; --i) {
        const std::uint32_t v = vertex();
        s.edges.insert(s.edges.end(),
                       {v, random.below(3) == 0 ? vertex() : std::min(v + 1, s.vertex_count - 1)});
    }
    for (std::uint64_t i = random.below(2 * s.vertex_count + 1); i > 0; --i) {
        const std::uint32_t v = vertex(), w = std::min(v + 1, s.vertex_count - 1);
        s.faces.insert(s.faces.end(),
                       {v, random.below(9) == 0 ? vertex() : w, std::min(w + 1, s.vertex_count - 1)});
    }
    if (s.edges.empty()) { // those of the faces, then
        s.no_edges_given = true;
        std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
        for (std::size_t f = 0; f < s.faces.size(); f += 3)
            for (std::size_t i = 0; i < 3; ++i)
                edges.insert(std::minmax({s.faces[f + i], s.faces[f + (i + 1) % 3]}));
        for (const auto& [v, w] : edges) s.edges.insert(s.edges.end(), {v, w});
    }
    if (random.below(3) == 0) {
        const std::uint32_t patches = 1 + random.below(4);
        for (std::uint64_t p = 0; p < patches; ++p) {
            s.categories.push_back(std::uint64_t{1} << random.below(3));
            s.masks.push_back(random.below(8));
        }
        const std::uint32_t run = 1 + random.below(20);
        for (std::uint32_t v = 0; v < s.vertex_count; ++v)
            s.patches.push_back(
                std::uint32_t(run < 10 ? v / run % patches : random.below(std::uint32_t(patches))));
    }
    return s;
}

std::uint64_t scenes_wanted() { return volume_from("VOX_SURFACE_SCENES", 200); }

START_TEST(pairs_are_those_whose_boxes_overlap) {
    Random random{number_from("VOX_SURFACE_SEED", 1)};
    std::uint64_t pairs = 0;
    for (std::uint64_t n = 0; n < scenes_wanted(); ++n) {
        const Scene s = random_scene(random);
        simd::force_level(static_cast<simd::Level>(random.below(4)));
        const double cell_size = random.below(2) == 0 ? 0 : std::pow(10.0, double(random.below(12)) - 6);
        const auto workers = std::uint32_t(1 + random.below(8));
        vox_surface* const surface = surface_of(s, workers, cell_size, 1u << 30);
        move(surface, s);
        for (int a = 0; a < 3; ++a)
            for (int b = 0; b < 3; ++b) {
                const auto expected = by_definition(s, a, b);
                const auto found = asked(surface, a, b, random.below(2) == 0 ? ~0ull : 1 + random.below(50));
                ck_assert_msg(found == expected, "scene %llu, kinds %d and %d",
                              static_cast<unsigned long long>(n), a, b);
                for (const auto& list : found) pairs += list.size();
            }
        vox_surface_destroy(surface);
    }
    simd::force_level(simd::best_level());
    ck_assert_uint_gt(pairs, 1000);
}
END_TEST

// A point of a feature at a time, by weights that may be anything that adds up to 1.
void point_of(const Scene& s, const std::vector<std::uint32_t>& corners, const double* weights, double time,
              const double* origin, double (&out)[3]) {
    for (std::uint32_t k = 0; k < 3; ++k) {
        out[k] = 0;
        for (std::size_t c = 0; c < corners.size(); ++c) {
            const std::uint32_t at = 3 * corners[c] + k;
            const double from = s.from[at] - origin[k], to = s.moves ? s.to[at] - origin[k] : from;
            out[k] += weights[c] * (from + time * (to - from));
        }
    }
}

// An upper bound of the distance between two features during the motion, up to a time: by points in a raster,
// at some times.
double raster_distance(const Scene& s, const std::vector<std::uint32_t>& a,
                       const std::vector<std::uint32_t>& b, double end = 1) {
    static constexpr double raster[][3] = {{1, 0, 0},
                                           {0, 1, 0},
                                           {0, 0, 1},
                                           {.5, .5, 0},
                                           {.5, 0, .5},
                                           {0, .5, .5},
                                           {1. / 3, 1. / 3, 1. / 3},
                                           {.25, .75, 0},
                                           {.75, .25, 0},
                                           {.25, .25, .5}};
    double least = infinity;
    const double* const origin =
        &s.from[3 * a[0]]; // far from that of the scene, much would be lost in rounding
    for (int t = 0; t <= 8; ++t)
        for (const auto& u : raster) {
            bool fits = true;
            for (std::size_t c = a.size(); c < 3; ++c) fits = fits && u[c] == 0;
            if (!fits) continue;
            double p[3];
            point_of(s, a, u, end * t / 8, origin, p);
            for (const auto& w : raster) {
                fits = true;
                for (std::size_t c = b.size(); c < 3; ++c) fits = fits && w[c] == 0;
                if (!fits) continue;
                double q[3];
                point_of(s, b, w, end * t / 8, origin, q);
                least = std::min(least, std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]));
            }
        }
    return least;
}

// Culling leaves pairs out, but none whose thickened features touch; the same ones at every SIMD level.
START_TEST(culling_loses_no_pair_that_touches) {
    Random random{2};
    std::uint64_t kept = 0, all = 0, touching = 0;
    for (std::uint64_t n = 0; n < scenes_wanted() / 2; ++n) {
        const Scene s = random_scene(random);
        vox_surface* const surface = surface_of(s, 1 + random.below(3), 0, 1u << 30);
        for (int a = 0; a < 3; ++a)
            for (int b = 0; b < 3; ++b) {
                move(surface, s);
                const auto overlapping = asked(surface, a, b);
                move(surface, s, VOX_MOTION_CULL);
                simd::force_level(simd::best_level());
                const auto found = asked(surface, a, b);
                simd::force_level(static_cast<simd::Level>(random.below(4)));
                ck_assert(asked(surface, a, b) == found);
                for (std::uint32_t i = 0; i < found.size(); ++i) {
                    ck_assert(std::includes(overlapping[i].begin(), overlapping[i].end(), found[i].begin(),
                                            found[i].end()));
                    all += overlapping[i].size();
                    kept += found[i].size();
                    if (overlapping[i].size() > 20) continue; // it takes long
                    for (const std::uint32_t j : overlapping[i])
                        if (raster_distance(s, s.corners(a, i), s.corners(b, j)) <=
                            2 * s.radius * (1 - 1e-9)) {
                            ++touching;
                            ck_assert_msg(std::binary_search(found[i].begin(), found[i].end(), j),
                                          "scene %llu, kinds %d and %d: %u and %u are lost",
                                          static_cast<unsigned long long>(n), a, b, i, j);
                        }
                }
            }
        vox_surface_destroy(surface);
    }
    simd::force_level(simd::best_level());
    ck_assert_uint_gt(touching, 100);
    ck_assert_uint_lt(kept, all - all / 10);
}
END_TEST

// Answers that do not fit into the budget come in pieces, and are the same.
START_TEST(a_budget_is_kept_in_pieces) {
    Random random{3};
    Scene s;
    s.vertex_count = 4000;
    for (std::uint32_t i = 0; i < 3 * s.vertex_count; ++i) s.from.push_back(random.unit());
    s.doubles = true;
    s.radius = 0.1;
    vox_surface* const whole = surface_of(s, 1, 0, 0);
    move(whole, s);
    const auto expected = asked(whole, 0, 0);
    const std::uint64_t budget = surface_counter(whole, "peak_bytes") / 3;
    vox_surface* const tight = surface_of(s, 1, 0, budget);
    move(tight, s);
    vox_partner_lists first{};
    ck_ok(vox_surface_find_pairs(tight, VOX_FEATURE_VERTEX, VOX_FEATURE_VERTEX, 0, ~0ull, &first));
    ck_assert_uint_gt(first.count, 0);
    ck_assert_uint_lt(first.count, s.vertex_count);
    ck_assert(asked(tight, 0, 0) == expected);
    ck_assert_uint_le(surface_counter(tight, "peak_bytes"), budget);
    vox_surface_destroy(tight);
    vox_surface_destroy(whole);
}
END_TEST

// What a caller gets to see of an answer, as bytes: no struct of these has gaps.
struct Bytes : std::vector<unsigned char> {
    template <class T>
    void add(const T* items, std::uint64_t count) {
        const auto* const begin = reinterpret_cast<const unsigned char*>(items);
        insert(end(), begin, begin + count * sizeof(T));
    }
};

vox_safe_step safe_step(vox_surface* surface, double distance, std::uint32_t max_iterations) {
    vox_impact_desc rule = vox_default_impact_desc();
    rule.distance = distance;
    rule.max_iterations = max_iterations;
    vox_safe_step step{};
    ck_assert_msg(vox_surface_find_safe_step(surface, &rule, &step) == VOX_OK, "%s", vox_last_error());
    return step;
}

// Everything but pairs: crossings, what is close, clearance, times.
Bytes all_else(vox_surface* surface, const Scene& s, double distance) {
    Bytes all;
    const auto ok = [](vox_result result) { ck_assert_msg(result == VOX_OK, "%s", vox_last_error()); };
    vox_crossing_view crossings{};
    ok(vox_surface_find_crossings(surface, &crossings));
    all.add(crossings.data, crossings.count);
    for (const auto& [a, b] : {std::pair(2, 0), {1, 1}, {1, 0}, {0, 0}, {0, 1}, {0, 2}}) {
        vox_proximity_view close{};
        ok(vox_surface_find_proximities(surface, vox_feature(a), vox_feature(b), distance, &close));
        all.add(close.data, close.count);
    }
    std::vector<double> clearance(s.vertex_count);
    ok(vox_surface_find_clearances(surface, distance > 0 ? distance : 1, clearance.data()));
    all.add(clearance.data(), clearance.size());
    for (const double contact : {0.0, distance})
        for (const std::uint32_t iterations : {1u, 10000u}) {
            const vox_safe_step step = safe_step(surface, contact, iterations);
            all.add(&step, 1);
        }
    for (const auto& [a, b] : {std::pair(2, 0), {1, 1}}) {
        vox_impact_view times{};
        ok(vox_surface_find_impacts(surface, vox_feature(a), vox_feature(b), nullptr, &times));
        all.add(times.data, times.count);
    }
    return all;
}

double distance_in(Random& random, const Scene& s) {
    double size = 0;
    for (std::uint32_t i = 3; i < 3 * s.vertex_count; ++i)
        size = std::max(size, std::abs(s.from[i] - s.from[i % 3]));
    return std::min(size, 1e30) * random.unit() / 8;
}

START_TEST(other_answers_are_the_same_everywhere) {
    Random random{3};
    std::uint64_t bytes = 0;
    for (int n = 0; n < 60; ++n) {
        const Scene s = random_scene(random);
        const double distance = distance_in(random, s);
        Bytes first;
        for (int level = 0; level <= int(simd::best_level()); ++level)
            for (const std::uint32_t workers : {1u, 3u, 8u}) {
                simd::force_level(simd::Level(level));
                vox_surface* const surface = surface_of(s, workers, 0, 1u << 30);
                move(surface, s);
                const Bytes answers = all_else(surface, s, distance);
                vox_surface_destroy(surface);
                if (level == 0 && workers == 1) first = answers;
                ck_assert_msg(answers == first, "scene %d, level %d, %u workers", n, level, workers);
            }
        bytes += first.size();
    }
    simd::force_level(simd::best_level());
    ck_assert_uint_gt(bytes, 100000);
}
END_TEST

// Up to the step nothing comes as close as the distance, whatever is left out before; one that is given up
// after an iteration is no longer, and says so.
START_TEST(a_safe_step_keeps_the_distance) {
    Random random{4};
    std::uint64_t pairs = 0, whole = 0, given_up = 0;
    for (int n = 0; n < 300; ++n) {
        const Scene s = random_scene(random);
        if (!s.moves || s.vertex_count > 60) continue;
        const double distance = distance_in(random, s);
        vox_surface* const surface = surface_of(s, 1 + random.below(3), 0, 1u << 30);
        move(surface, s);
        const vox_safe_step step = safe_step(surface, distance, 10000), one = safe_step(surface, distance, 1);
        ck_assert(one.step <= step.step && step.unfinished == 0);
        given_up += one.unfinished;
        whole += step.step == 1;
        vox_surface_destroy(surface);
        if (step.step == 0) continue;
        for (const auto& [a, b] : {std::pair(2, 0), {1, 1}})
            for (std::uint32_t i = 0; i < s.count(a); ++i)
                for (std::uint32_t j = a == b ? i + 1 : 0; j < s.count(b); ++j) {
                    constexpr TestBox everywhere{{-infinity, -infinity, -infinity},
                                                 {infinity, infinity, infinity}};
                    if (!make_a_pair(s, a, i, everywhere, b, j, everywhere)) continue;
                    const double least = raster_distance(s, s.corners(a, i), s.corners(b, j), step.step);
                    ck_assert_msg(least >= distance * (1 - 1e-9),
                                  "scene %d, kinds %d and %d: %u and %u come as close as %g, not %g", n, a, b,
                                  i, j, least, distance);
                    ++pairs;
                }
    }
    ck_assert_uint_gt(pairs, 1000);
    ck_assert_uint_gt(whole, 3);
    ck_assert_uint_gt(given_up, 10);
}
END_TEST

} // namespace

SUITE(surface_pairs) {
    TCase* tests = add_case(suite, "surface_pairs");
    tcase_add_each(tests, pairs_are_those_whose_boxes_overlap, culling_loses_no_pair_that_touches,
                   a_budget_is_kept_in_pieces, other_answers_are_the_same_everywhere,
                   a_safe_step_keeps_the_distance);
}
