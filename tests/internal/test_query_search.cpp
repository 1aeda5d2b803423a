// What queries stand on: rounding outwards, the tree of boxes, and answers for shapes as bad as can be, all
// by definition.
#include "base/boxes.hpp"
#include "base/vectors.hpp"
#include "internal/meshes.hpp"
#include "internal/query_definition.hpp"
#include "query/box_tree.hpp"
#include "query/rounding.hpp"
#include "support/suite.h"

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
    vox_grid* grid;
    const QueryDefinition& mesh;
};

void check_points(const Asked& asked, const std::vector<Vec3d>& points) {
    std::vector<vox_point_hit> hits(points.size() * asked.mesh.tets().size());
    std::uint64_t count = 0, next = 0;
    ck_ok(vox_grid_query_points(asked.grid, points.data(), VOX_FORMAT_DOUBLE, 0, points.size(), UINT64_MAX,
                                hits.data(), hits.size(), &count));
    for (std::uint32_t i = 0; i < points.size(); ++i)
        for (const std::uint32_t tet : asked.mesh.tets_with(points[i])) {
            ck_assert_uint_lt(next, count);
            ck_assert_uint_eq(hits[next].point, i);
            ck_assert_uint_eq(hits[next++].tet, tet);
        }
    ck_assert_uint_eq(next, count);
}

void check_closest(const Asked& asked, const std::vector<Vec3d>& points) {
    std::vector<vox_closest_hit> hits(points.size());
    vox_closest_desc desc = vox_default_closest_desc();
    desc.points = points.data();
    desc.format = VOX_FORMAT_DOUBLE;
    desc.point_count = points.size();
    ck_ok(vox_grid_query_closest_points(asked.grid, &desc, hits.data()));
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto [squared, facet] = asked.mesh.closest(points[i]);
        ck_assert_uint_ne(hits[i].mesh, VOX_NULL_BODY);
        ck_assert(std::abs(hits[i].distance) == std::sqrt(squared)); // all bits
        ck_assert_uint_eq(hits[i].tet, facet.first);
        ck_assert_uint_eq(hits[i].facet, facet.second);
        ck_assert_uint_eq(hits[i].inside, !asked.mesh.tets_with(points[i]).empty());
        const double* n = hits[i].normal;
        ck_assert(std::abs(n[0] * n[0] + n[1] * n[1] + n[2] * n[2] - 1) < 1e-12);
    }
}

// So many points that they are asked another way: hits and closest points are those of each point alone, all
// bits.
void check_together(const vox_grid* grid, const std::vector<Vec3d>& points, std::uint64_t mask = UINT64_MAX) {
    std::vector<vox_point_hit> together(16), singly, of_one(4096);
    std::uint64_t count = 0, found = 0;
    const auto ask = [&](std::uint64_t capacity) {
        ck_ok(vox_grid_query_points(grid, points.data(), VOX_FORMAT_DOUBLE, 0, points.size(), mask,
                                    together.data(), capacity, &count));
    };
    ask(16);
    together.assign(count + 1, vox_point_hit{});
    ask(count);
    std::vector<vox_closest_hit> closest(points.size());
    vox_closest_desc desc = vox_default_closest_desc();
    desc.points = points.data();
    desc.format = VOX_FORMAT_DOUBLE;
    desc.point_count = points.size();
    desc.mask = mask;
    desc.max_distance = 1;
    ck_ok(vox_grid_query_closest_points(grid, &desc, closest.data()));
    for (std::uint32_t i = 0; i < points.size(); ++i) {
        ck_ok(vox_grid_query_point(grid, &points[i].x, mask, of_one.data(), of_one.size(), &found));
        for (std::uint64_t h = 0; h < found; ++h) {
            singly.push_back(of_one[h]);
            singly.back().point = i;
        }
        vox_closest_hit alone;
        desc.points = &points[i];
        desc.point_count = 1;
        if (i % 16 == 0) {
            ck_ok(vox_grid_query_closest_points(grid, &desc, &alone));
            ck_assert_mem_eq(&alone, &closest[i], sizeof alone);
        }
    }
    ck_assert_uint_eq(count, singly.size());
    ck_assert_uint_eq(together[count].mesh, VOX_NULL_BODY);
    if (count > 0) ck_assert_mem_eq(together.data(), singly.data(), count * sizeof singly[0]);
    together.assign(count + 1, vox_point_hit{}); // room for some
    const std::uint64_t half = count / 2;
    ask(half);
    ck_assert_uint_eq(count, singly.size());
    if (half > 0) ck_assert_mem_eq(together.data(), singly.data(), half * sizeof singly[0]);
    ck_assert_uint_eq(together[half].mesh, VOX_NULL_BODY);
}

void check_segment(const Asked& asked, const Vec3d& from, const Vec3d& to) {
    std::vector<vox_facet_hit> hits(4 * asked.mesh.tets().size());
    std::vector<QueryDefinition::Facet> found;
    std::uint64_t count = 0;
    std::uint32_t any = 7;
    vox_ray_hit first;
    ck_ok(vox_grid_query_ray_hits(asked.grid, &from.x, &to.x, UINT64_MAX, VOX_NULL_BODY, hits.data(),
                                  hits.size(), &count));
    for (std::uint64_t h = 0; h < count; ++h) found.emplace_back(hits[h].tet, hits[h].facet);
    std::sort(found.begin(), found.end());
    ck_assert(found == asked.mesh.hits(from, to));
    const bool meets = asked.mesh.any(from, to);
    ck_ok(vox_grid_query_ray_any(asked.grid, &from.x, &to.x, UINT64_MAX, VOX_NULL_BODY, &any));
    ck_assert_uint_eq(any, meets);
    ck_ok(vox_grid_query_ray(asked.grid, &from.x, &to.x, UINT64_MAX, &first));
    ck_assert_int_eq(first.mesh != VOX_NULL_BODY, meets);
}

void check_box(const Asked& asked, const Vec3d& p, const Vec3d& q) {
    const Vec3d low = min(p, q), high = max(p, q);
    std::vector<vox_tet_hit> hits(asked.mesh.tets().size());
    std::uint64_t count = 0;
    ck_ok(vox_grid_query_box(asked.grid, &low.x, &high.x, UINT64_MAX, hits.data(), hits.size(), &count));
    const std::vector<std::uint32_t> near = asked.mesh.near(low, high);
    ck_assert_uint_eq(count, near.size());
    for (std::size_t i = 0; i < near.size(); ++i) ck_assert_uint_eq(hits[i].tet, near[i]);
}

// The same mesh; its tiles, and so the trees, are those of other positions.
vox_grid* grid_with_other_tiles(const QueryDefinition& mesh, vox_mesh_desc desc, Random& random) {
    std::vector<Vec3d> others;
    while (others.size() < mesh.positions().size()) others.push_back(random_vector(random, 1));
    vox_grid* grid = engine_grid();
    desc.positions.data = others.data();
    const vox_body id = insert_mesh(grid, &desc);
    ck_ok(vox_grid_prepare_queries(grid));
    ck_ok(bind_array(grid, id, mesh.positions().data(), VOX_FORMAT_DOUBLE, 0, 0));
    ck_ok(vox_grid_prepare_queries(grid));
    return grid;
}

void check_same(const vox_grid* x, const vox_grid* y, const Vec3d& from, const Vec3d& to) {
    std::vector<vox_facet_hit> of_x(2000), of_y(2000);
    vox_ray_hit first_x, first_y;
    std::uint64_t count_x = 0, count_y = 0;
    ck_ok(vox_grid_query_ray(x, &from.x, &to.x, UINT64_MAX, &first_x));
    ck_ok(vox_grid_query_ray(y, &from.x, &to.x, UINT64_MAX, &first_y));
    ck_assert_mem_eq(&first_x, &first_y, sizeof first_x);
    ck_ok(vox_grid_query_ray_hits(x, &from.x, &to.x, UINT64_MAX, VOX_NULL_BODY, of_x.data(), of_x.size(),
                                  &count_x));
    ck_ok(vox_grid_query_ray_hits(y, &from.x, &to.x, UINT64_MAX, VOX_NULL_BODY, of_y.data(), of_y.size(),
                                  &count_y));
    ck_assert_uint_eq(count_x, count_y);
    ck_assert_mem_eq(of_x.data(), of_y.data(),
                     std::min<std::uint64_t>(count_x, of_x.size()) * sizeof of_x[0]);
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
            ck_ok(vox_grid_prepare_queries(grid));
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
            const Asked asked{grid, soup};
            vox_grid* other = grid_with_other_tiles(soup, mesh, random);
            check_points(asked, points);
            std::vector<Vec3d> many;
            while (many.size() < 400) many.push_back(points[random.below(std::uint32_t(points.size()))]);
            check_together(grid, many);
            check_together(other, many);
            check_closest(asked, points);
            check_closest({other, soup}, points);
            for (std::size_t i = 1; i < points.size(); ++i) {
                check_segment(asked, points[i - 1], points[i]);
                check_box(asked, points[i - 1], points[i]);
                check_same(grid, other, points[i - 1], points[i]);
            }
            vox_grid_destroy(grid);
            vox_grid_destroy(other);
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
    ck_ok(vox_grid_prepare_queries(grid));
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
            check_together(grid, points);
            check_together(grid, points, 2);
        }
    std::vector<Vec3d> points;
    while (points.size() < 150000) points.push_back(place(int(random.below(10))));
    std::vector<vox_point_hit> all(4 * points.size()), some(all.size());
    std::uint64_t count = 0, done = 0, next = 0;
    ck_ok(vox_grid_query_points(grid, points.data(), VOX_FORMAT_DOUBLE, 0, points.size(), UINT64_MAX,
                                all.data(), all.size(), &count));
    ck_assert_uint_le(count, all.size());
    for (std::size_t first = 0; first < points.size(); first += 10000) {
        ck_ok(vox_grid_query_points(grid, &points[first], VOX_FORMAT_DOUBLE, 0, 10000, UINT64_MAX,
                                    some.data(), some.size(), &done));
        for (std::uint64_t h = 0; h < done; ++h) some[h].point += std::uint32_t(first);
        ck_assert_uint_le(next + done, count);
        ck_assert_mem_eq(&all[next], some.data(), done * sizeof some[0]);
        next += done;
    }
    ck_assert_uint_eq(next, count);
    points[149999].y = std::nan("");
    ck_fails(vox_grid_query_points(grid, points.data(), VOX_FORMAT_DOUBLE, 0, points.size(), UINT64_MAX,
                                   all.data(), all.size(), &count),
             VOX_ERROR_NON_FINITE, "point 149999");
    ck_assert_uint_eq(count, next);
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
    ck_ok(vox_grid_prepare_queries(grid));
    std::vector<Vec3d> points;
    while (points.size() < 2000) {
        const std::size_t i = random.below(std::uint32_t(positions.size()));
        Vec3d p = 0.5 * positions[i] + 0.5 * positions[i / 4 * 4];
        if (i % 3 == 0) p = 0.5 * p + 0.25 * positions[i / 4 * 4 + 1] + 0.25 * positions[i / 4 * 4 + 2];
        if (i % 7 == 0) p.x = std::copysign(beyond, p.x);
        points.push_back(p);
    }
    check_together(grid, points);
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
