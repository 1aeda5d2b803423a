// What queries stand on: rounding outwards, the tree of boxes, and answers for shapes as bad as can be, all
// by definition.
#include "base/box_tree.hpp"
#include "base/boxes.hpp"
#include "base/rounding.hpp"
#include "base/vectors.hpp"
#include "internal/meshes.hpp"
#include "internal/query_definition.hpp"
#include "support/locators.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <limits>
#include <vector>

using namespace vox;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// ---- rounding -------------------------------------------------------------------------------------

void check_rounding(double x) {
    const float down = rounded_down(x), up = rounded_up(x);
    const float after = std::nextafter(down, FLT_MAX); // the next float that is finite
    ck_assert(double{down} <= x);
    ck_assert(after == down || double{after} > x);
    ck_assert(up == -rounded_down(-x));
}

START_TEST(rounded_outwards) {
    Random random{1};
    for (int i = 0; i < 200000; ++i) {
        const double x = double{random.any_finite()};
        check_rounding(x);
        check_rounding(x * (1 + random.unit() * 1e-7));
        check_rounding(std::nextafter(x, infinity));
        check_rounding(std::nextafter(x, -infinity));
        ck_assert(rounded_down(x) == static_cast<float>(x) && rounded_up(x) == static_cast<float>(x));
    }
    for (const double x : {0.0, -0.0, 1e-300, -1e-300, double{FLT_TRUE_MIN}, 0.5 * double{FLT_TRUE_MIN},
                           -0.5 * double{FLT_TRUE_MIN}, double{FLT_MIN}, double{FLT_MAX}, 3.40282352e38,
                           -3.40282352e38, 1e300, -1e300, infinity, -infinity})
        check_rounding(x);
    ck_assert(rounded_down(infinity) == FLT_MAX && rounded_up(-infinity) == -FLT_MAX);
    ck_assert(std::isinf(rounded_up(3.40282352e38)) && std::isinf(rounded_down(-3.40282352e38)));
}
END_TEST

// ---- the tree -------------------------------------------------------------------------------------

bool holds(const Box3f& outer, const Box3f& inner) {
    Box3f both = outer;
    extend(both, inner);
    return both.min.x == outer.min.x && both.min.y == outer.min.y && both.min.z == outer.min.z &&
           both.max.x == outer.max.x && both.max.y == outer.max.y && both.max.z == outer.max.z;
}

START_TEST(every_item_once) {
    Random random{2};
    BoxTree tree(std::pmr::get_default_resource());
    Workers workers({}, 1);
    for (std::size_t count = 0; count < 300; ++count) {
        std::vector<Box3f> boxes(count);
        for (Box3f& box : boxes) {
            box = empty_box3f();
            if (random.below(5) == 0) continue;
            const bool wild = count % 7 == 0; // of all sizes, up to infinite ones
            for (int corner = 0; corner < 2; ++corner) {
                const auto number = [&] {
                    if (!wild) return random.uniform(-1, 1);
                    return random.below(9) == 0 ? (random.below(2) ? float_infinity : -float_infinity)
                                                : random.any_finite();
                };
                const Vec3f p = {number(), number(), number()};
                extend(box, Box3f{p, p});
            }
        }
        if (count % 11 == 0) std::fill(boxes.begin(), boxes.end(), Box3f{{1, 1, 1}, {2, 2, 2}}); // one place
        tree.reserve(count);
        tree.build(boxes, workers);
        std::vector<int> seen(count, 0), wanted(count, 0);
        for (std::size_t i = 0; i < count; ++i) wanted[i] = !is_empty(boxes[i]);
        tree.visit_accepted([](const Box3f&) { return true; }, [&](std::uint32_t item) { ++seen[item]; });
        ck_assert(seen == wanted);
        const auto leaves = static_cast<std::size_t>(std::count(wanted.begin(), wanted.end(), 1));
        for (std::size_t node = 1; node < leaves; ++node) {
            ck_assert(!tree.is_leaf(node));
            ck_assert(holds(tree.box(node), tree.box(2 * node)) &&
                      holds(tree.box(node), tree.box(2 * node + 1)));
        }
        for (std::size_t node = leaves; node < 2 * leaves; ++node) {
            ck_assert(tree.is_leaf(node));
            ck_assert(holds(tree.box(node), boxes[tree.item(node)]) &&
                      holds(boxes[tree.item(node)], tree.box(node)));
        }
        // The nearest one, and no more visits than there are items.
        const Vec3d p = {random.unit(), random.unit(), random.unit()};
        double most = infinity, least = infinity;
        std::size_t visits = 0;
        tree.visit_nearest_first(
            most, [&](const Box3f& box) { return squared_distance_bound(p, box); },
            [&](std::uint32_t item) {
                most = std::min(most, squared_distance_bound(p, boxes[item]));
                ++visits;
            });
        for (std::size_t i = 0; i < count; ++i)
            if (wanted[i]) least = std::min(least, squared_distance_bound(p, boxes[i]));
        ck_assert(most == least);
        ck_assert_uint_le(visits, leaves);
    }
}
END_TEST

// ---- bad shapes -----------------------------------------------------------------------------------

struct Asked {
    const vox_locator* locator;
    const QueryDefinition& mesh;
};

vox_positions all_of(const std::vector<Vec3d>& points) {
    return vox_double_positions(&points.data()->x, points.size());
}

vox_positions only(const Vec3d& p) { return vox_double_positions(&p.x, 1); }

// All of a list, for which it asks a second time where there are more than `usual`.
template <class Hit, class Ask>
std::vector<Hit> list(Ask&& ask, std::size_t usual = 4096) {
    std::vector<Hit> hits(usual);
    std::uint64_t count = 0;
    ck_ok(ask(hits.data(), hits.size(), &count));
    const bool all = count <= usual;
    hits.resize(count);
    if (!all) ck_ok(ask(hits.data(), hits.size(), &count));
    ck_assert_uint_eq(count, hits.size());
    return hits;
}

std::vector<vox_point_hit> hits_of(const vox_locator* locator, const vox_positions& points,
                                   const vox_query_desc* desc = nullptr) {
    return list<vox_point_hit>([&](vox_point_hit* hits, std::uint64_t room, std::uint64_t* count) {
        return vox_locator_find_point_hits(locator, &points, desc, hits, room, count);
    });
}

std::vector<vox_ray_hit> hits_of(const vox_locator* locator, const vox_positions& from,
                                 const vox_positions& to, std::uint32_t flags = 0) {
    vox_query_desc desc = vox_default_query_desc();
    desc.flags = flags;
    return list<vox_ray_hit>([&](vox_ray_hit* hits, std::uint64_t room, std::uint64_t* count) {
        return vox_locator_find_ray_hits(locator, &from, &to, &desc, hits, room, count);
    });
}

template <class Hit>
void check_equal(const std::vector<Hit>& x, const std::vector<Hit>& y) {
    ck_assert_uint_eq(x.size(), y.size());
    if (!x.empty()) ck_assert_mem_eq(x.data(), y.data(), x.size() * sizeof x[0]);
}

void check_points(const Asked& asked, const std::vector<Vec3d>& points) {
    const std::vector<vox_point_hit> hits = hits_of(asked.locator, all_of(points));
    std::size_t next = 0;
    for (std::uint32_t i = 0; i < points.size(); ++i)
        for (const std::uint32_t tet : asked.mesh.tets_with(points[i])) {
            ck_assert_uint_lt(next, hits.size());
            ck_assert_uint_eq(hits[next].point, i);
            ck_assert_uint_eq(hits[next++].tet, tet);
        }
    ck_assert_uint_eq(next, hits.size());
}

void check_closest(const Asked& asked, const std::vector<Vec3d>& points) {
    std::vector<vox_closest_hit> hits(points.size());
    const vox_positions at = all_of(points);
    ck_ok(vox_locator_find_closest(asked.locator, &at, nullptr, hits.data()));
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto [squared, facet] = asked.mesh.closest(points[i]);
        ck_assert_uint_ne(hits[i].body, VOX_NULL_BODY);
        ck_assert(std::abs(hits[i].distance) == std::sqrt(squared)); // all bits
        ck_assert_uint_eq(hits[i].tet, facet.first);
        ck_assert_uint_eq(hits[i].facet, facet.second);
        ck_assert_uint_eq(hits[i].inside, !asked.mesh.tets_with(points[i]).empty());
        const double* n = hits[i].normal;
        ck_assert(std::abs(n[0] * n[0] + n[1] * n[1] + n[2] * n[2] - 1) < 1e-12);
    }
}

// So many points that they are asked another way: hits, closest points and locations are those of each point
// alone, all bits.
void check_together(const vox_locator* locator, const std::vector<Vec3d>& points, std::uint64_t mask = 0) {
    vox_query_desc desc = query_of(mask, VOX_NULL_BODY);
    desc.max_distance = 1;
    const vox_positions at = all_of(points);
    const std::vector<vox_point_hit> together = hits_of(locator, at, &desc);
    std::vector<vox_point_hit> singly;
    std::vector<vox_closest_hit> closest(points.size());
    std::vector<vox_location> located(points.size());
    ck_ok(vox_locator_find_closest(locator, &at, &desc, closest.data()));
    ck_ok(vox_locator_locate(locator, &at, &desc, located.data()));
    for (std::uint32_t i = 0; i < points.size(); ++i) {
        for (vox_point_hit& hit : hits_of(locator, only(points[i]), &desc)) {
            hit.point = i;
            singly.push_back(hit);
        }
        if (i % 16 == 0) {
            const vox_closest_hit alone = closest_to(locator, &points[i].x, &desc);
            ck_assert_mem_eq(&alone, &closest[i], sizeof alone);
            vox_location location;
            const vox_positions at_one = only(points[i]);
            ck_ok(vox_locator_locate(locator, &at_one, &desc, &location));
            ck_assert_mem_eq(&location, &located[i], sizeof location);
        }
    }
    check_equal(together, singly);
    std::vector<vox_point_hit> some(together.size() + 1); // room for half of them
    std::uint64_t count = 0;
    const std::size_t half = together.size() / 2;
    ck_ok(vox_locator_find_point_hits(locator, &at, &desc, some.data(), half, &count));
    ck_assert_uint_eq(count, together.size());
    if (half > 0) ck_assert_mem_eq(some.data(), together.data(), half * sizeof some[0]);
    ck_assert_uint_eq(some[half].body, VOX_NULL_BODY);
}

// The segments from each point to the next.
void check_segments(const Asked& asked, const std::vector<Vec3d>& points) {
    const vox_positions from = vox_double_positions(&points[0].x, points.size() - 1);
    const vox_positions to = vox_double_positions(&points[1].x, points.size() - 1);
    const std::vector<vox_ray_hit> hits = hits_of(asked.locator, from, to);
    std::vector<vox_ray_hit> firsts;
    std::vector<std::uint8_t> blocked(points.size() - 1);
    ck_ok(vox_locator_test_rays(asked.locator, &from, &to, nullptr, blocked.data()));
    std::size_t next = 0;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        std::vector<QueryDefinition::Facet> found;
        if (next < hits.size() && hits[next].ray == i) firsts.push_back(hits[next]);
        for (; next < hits.size() && hits[next].ray == i; ++next)
            found.emplace_back(hits[next].tet, hits[next].facet);
        std::sort(found.begin(), found.end());
        ck_assert(found == asked.mesh.hits(points[i], points[i + 1]));
        ck_assert_uint_eq(blocked[i], asked.mesh.any(points[i], points[i + 1]));
    }
    ck_assert_uint_eq(next, hits.size());
    check_equal(hits_of(asked.locator, from, to, VOX_QUERY_FIRST_HIT), firsts);
}

// The boxes around each point and the next.
void check_boxes(const Asked& asked, const std::vector<Vec3d>& points) {
    std::vector<Vec3d> lows, highs;
    for (std::size_t i = 1; i < points.size(); ++i) {
        lows.push_back(min(points[i - 1], points[i]));
        highs.push_back(max(points[i - 1], points[i]));
    }
    const vox_positions low = all_of(lows), high = all_of(highs);
    const auto hits = list<vox_box_hit>([&](vox_box_hit* found, std::uint64_t room, std::uint64_t* count) {
        return vox_locator_find_box_hits(asked.locator, &low, &high, nullptr, found, room, count);
    });
    std::size_t next = 0;
    for (std::uint32_t i = 0; i < lows.size(); ++i)
        for (const std::uint32_t tet : asked.mesh.near(lows[i], highs[i])) {
            ck_assert_uint_lt(next, hits.size());
            ck_assert_uint_eq(hits[next].box, i);
            ck_assert_uint_eq(hits[next++].tet, tet);
        }
    ck_assert_uint_eq(next, hits.size());
}

// The same mesh; its tiles, and so the trees, are those of other positions.
vox_grid* grid_with_other_tiles(const QueryDefinition& mesh, vox_mesh_desc desc, Random& random) {
    std::vector<Vec3d> others;
    while (others.size() < mesh.positions().size()) others.push_back(random_vector(random, 1));
    vox_grid* grid = engine_grid();
    desc.positions.data = others.data();
    const vox_body id = insert_mesh(grid, &desc);
    vox_locator_release(take_locator(grid));
    ck_ok(bind_array(grid, id, mesh.positions().data(), VOX_FORMAT_DOUBLE, 0, 0));
    return grid;
}

START_TEST(bad_shapes_by_definition) {
    Random random{3};
    for (int shape = 0; shape < shape_count; ++shape)
        for (std::uint64_t round = 0; round < volume_from("VOX_QUERY_SOUPS", 2); ++round) {
            const QueryDefinition soup = make_soup(random, Shape(shape), 20 + random.below(300));
            vox_grid* grid = engine_grid();
            vox_mesh_desc mesh = vox_default_mesh_desc();
            mesh.positions = vox_double_positions(&soup.positions().data()->x, soup.positions().size());
            mesh.tets = soup.tets().front().v;
            mesh.tet_count = soup.tets().size();
            insert_mesh(grid, &mesh);
            vox_locator* locator = take_locator(grid);
            std::vector<Vec3d> points;
            for (int i = 0; i < 60; ++i) {
                const std::uint32_t tet = random.below(std::uint32_t(soup.tets().size()));
                const auto corner = [&](std::size_t c) { return soup.corner(tet, c); };
                const Vec3d middle = 0.5 * corner(0) + 0.5 * corner(1);
                points.push_back(i % 4 == 0   ? random_place(random, Shape(shape))
                                 : i % 4 == 1 ? corner(random.below(4))
                                 : i % 4 == 2 ? 0.5 * middle + 0.25 * corner(2) + 0.25 * corner(3)
                                              : middle);
            }
            vox_grid* other_grid = grid_with_other_tiles(soup, mesh, random);
            vox_locator* other = take_locator(other_grid);
            const Asked asked{locator, soup};
            check_points(asked, points);
            std::vector<Vec3d> many;
            while (many.size() < 400) many.push_back(points[random.below(std::uint32_t(points.size()))]);
            check_together(locator, many);
            check_together(other, many);
            check_closest(asked, points);
            check_closest({other, soup}, points);
            check_segments(asked, points);
            check_boxes(asked, points);
            const vox_positions from = vox_double_positions(&points[0].x, points.size() - 1);
            const vox_positions to = vox_double_positions(&points[1].x, points.size() - 1);
            check_equal(hits_of(locator, from, to), hits_of(other, from, to));
            vox_locator_release(locator);
            vox_locator_release(other);
            vox_grid_destroy(grid);
            vox_grid_destroy(other_grid);
        }
}
END_TEST

// Meshes of all kinds that overlap, and points in many places; in the end, more points than are handled at a
// time.
START_TEST(many_points_as_alone) {
    Random random{11};
    vox_grid* grid = engine_grid();
    std::vector<Mesh> bodies;
    std::vector<std::vector<Vec3d>> doubles;
    for (int b = 0; b < 40; ++b) {
        Mesh body = b < 3 ? jittered(ball(b == 0 ? 4000 : 700), random, 0.2) : block(1, 1, 1);
        move(body, b < 3 ? 0.5 : 0.25, 4 * random.unit(), 4 * random.unit(), 4 * random.unit());
        if (b == 5) move(body, 0, 2, 2, 2); // of no size
        if (b == 6)
            for (Tet& tet : body.tets) std::swap(tet.v[0], tet.v[1]);
        bodies.push_back(std::move(body));
        doubles.emplace_back(bodies.back().positions.begin(), bodies.back().positions.end());
        for (Vec3d& p : doubles.back()) p.x *= 1 + 1e-12;
    }
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        vox_mesh_desc desc = vox_default_mesh_desc();
        desc.positions.format = b % 3 == 1 ? VOX_FORMAT_DOUBLE : VOX_FORMAT_FLOAT;
        if (b % 3 == 1)
            desc.positions.data = doubles[b].data();
        else
            desc.positions.data = bodies[b].positions.data();
        desc.positions.count = bodies[b].positions.size();
        desc.tets = bodies[b].tets.front().v;
        desc.tet_count = bodies[b].tets.size();
        desc.flags = VOX_MESH_COPY_POSITIONS;
        const vox_body mesh = insert_mesh(grid, &desc);
        vox_filter filter{};
        filter.category = 1u << b % 4;
        ck_ok(vox_body_set_filter(grid, mesh, &filter));
        const double turned[12] = {0.8, -0.6, 0, 1, 0.6, 0.8, 0, -1, 0, 0, 1, 0.1};
        if (b % 7 == 2) ck_ok(vox_body_set_transform(grid, mesh, turned));
        if (b == 8) ck_ok(vox_body_set_enabled(grid, mesh, 0));
        const std::uint32_t off[] = {0, 3, 4};
        if (b == 9) ck_ok(vox_mesh_set_tets_enabled(grid, mesh, off, 3, 0));
    }
    vox_locator* locator = take_locator(grid);
    const auto place = [&](int kind) {
        const Mesh& body = bodies[random.below(std::uint32_t(bodies.size()))];
        const Tet& tet = body.tets[random.below(std::uint32_t(body.tets.size()))];
        const Vec3d a = body.positions[tet.v[0]], b = body.positions[tet.v[1]], c = body.positions[tet.v[2]];
        switch (kind) {
        case 0:
            return 4 * Vec3d{random.unit(), random.unit(), random.unit()};
        case 1:
            return Vec3d(nearest_floats(4 * Vec3d{random.unit(), random.unit(), random.unit()}));
        case 2:
            return a; // a vertex
        case 3:
            return 0.5 * a + 0.25 * b + 0.25 * c;
        case 4:
            return Vec3d{2, 2, 2} + random_vector(random, 1e-3);
        case 5:
            return Vec3d{2, 2, 2};
        case 6:
            return Vec3d{4 * random.unit(), 2, 2};
        case 7:
            return random_vector(random, 1000);
        case 8:
            return random_vector(random, std::ldexp(1.0, 127));
        default:
            return Vec3d{random.below(2) ? 1 : -1 - 1e-300, 1e-310 * random.unit(), -0.0};
        }
    };
    for (int kind = 0; kind < 11; ++kind)
        for (const std::size_t count : {63u, 64u, 65u, 1000u}) {
            std::vector<Vec3d> points;
            while (points.size() < count) points.push_back(place(kind < 10 ? kind : int(random.below(10))));
            check_together(locator, points);
            check_together(locator, points, 2);
        }
    std::vector<Vec3d> points;
    while (points.size() < 150000) points.push_back(place(int(random.below(10))));
    std::vector<vox_point_hit> all = hits_of(locator, all_of(points)), in_parts;
    for (std::size_t first = 0; first < points.size(); first += 10000)
        for (vox_point_hit& hit : hits_of(locator, vox_double_positions(&points[first].x, 10000))) {
            hit.point += std::uint32_t(first);
            in_parts.push_back(hit);
        }
    check_equal(all, in_parts);
    points[149999].y = std::nan("");
    const vox_positions at = all_of(points);
    std::uint64_t count = 77;
    ck_fails(vox_locator_find_point_hits(locator, &at, nullptr, all.data(), all.size(), &count),
             VOX_ERROR_NON_FINITE, "points: position 149999 is");
    ck_assert_uint_eq(count, 77);
    vox_locator_release(locator);
    vox_grid_destroy(grid);
}
END_TEST

// Coordinates of meshes as large as may be, and of points beyond: their nearest floats are infinite.
START_TEST(many_points_beyond_floats) {
    Random random{12};
    const double most = std::nextafter(0x1p128 - 0x1p103, 0), beyond = 0x1.fffffffffffffp127;
    std::vector<Vec3d> positions;
    std::vector<Tet> tets;
    for (std::uint32_t t = 0; t < 200; ++t) {
        for (int c = 0; c < 4; ++c) {
            const auto number = [&] {
                const double x = random.below(3) ? most * (2 * random.unit() - 1) : random.uniform(-1, 1);
                return random.below(4) ? x : std::copysign(most, x);
            };
            positions.push_back({number(), number(), number()});
        }
        tets.push_back({{4 * t, 4 * t + 1, 4 * t + 2, 4 * t + 3}});
    }
    vox_grid* grid = engine_grid();
    vox_mesh_desc desc = vox_default_mesh_desc();
    desc.positions = vox_double_positions(&positions.data()->x, positions.size());
    desc.tets = tets.front().v;
    desc.tet_count = tets.size();
    insert_mesh(grid, &desc);
    vox_locator* locator = take_locator(grid);
    std::vector<Vec3d> points;
    while (points.size() < 2000) {
        const std::size_t i = random.below(std::uint32_t(positions.size()));
        Vec3d p = 0.5 * positions[i] + 0.5 * positions[i / 4 * 4];
        if (i % 3 == 0) p = 0.5 * p + 0.25 * positions[i / 4 * 4 + 1] + 0.25 * positions[i / 4 * 4 + 2];
        if (i % 7 == 0) p.x = std::copysign(beyond, p.x);
        points.push_back(p);
    }
    check_together(locator, points);
    vox_locator_release(locator);
    vox_grid_destroy(grid);
}
END_TEST

void add_tests(TCase* tests) {
    tcase_add_each(tests, bad_shapes_by_definition, many_points_as_alone, many_points_beyond_floats);
}

} // namespace

SUITE(query_search) {
    tcase_add_each(add_case(suite, "parts"), rounded_outwards, every_item_once);
    add_for_each_engine(suite, add_tests);
}
