// What queries stand on: rounding outwards, the tree of boxes, and answers for shapes as bad as can be, all
// by definition.
#include "base/boxes.hpp"
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
    ck_ok(vox_grid_query_points(asked.grid, points.data(), VOX_FORMAT_DOUBLE3, 0, points.size(), UINT64_MAX,
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
    desc.format = VOX_FORMAT_DOUBLE3;
    desc.point_count = points.size();
    ck_ok(vox_grid_query_closest_points(asked.grid, &desc, hits.data()));
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto [squared, facet] = asked.mesh.closest(points[i]);
        ck_assert_uint_ne(hits[i].mesh, VOX_NULL_MESH);
        ck_assert(std::abs(hits[i].distance) == std::sqrt(squared)); // all bits
        ck_assert_uint_eq(hits[i].tet, facet.first);
        ck_assert_uint_eq(hits[i].facet, facet.second);
        ck_assert_uint_eq(hits[i].inside, !asked.mesh.tets_with(points[i]).empty());
        const double* n = hits[i].normal;
        ck_assert(std::abs(n[0] * n[0] + n[1] * n[1] + n[2] * n[2] - 1) < 1e-12);
    }
}

void check_segment(const Asked& asked, const Vec3d& from, const Vec3d& to) {
    std::vector<vox_facet_hit> hits(4 * asked.mesh.tets().size());
    std::vector<QueryDefinition::Facet> found;
    std::uint64_t count = 0;
    std::uint32_t any = 7;
    vox_ray_hit first;
    ck_ok(vox_grid_query_ray_hits(asked.grid, &from.x, &to.x, UINT64_MAX, VOX_NULL_MESH, hits.data(),
                                  hits.size(), &count));
    for (std::uint64_t h = 0; h < count; ++h) found.emplace_back(hits[h].tet, hits[h].facet);
    std::sort(found.begin(), found.end());
    ck_assert(found == asked.mesh.hits(from, to));
    const bool meets = asked.mesh.any(from, to);
    ck_ok(vox_grid_query_ray_any(asked.grid, &from.x, &to.x, UINT64_MAX, VOX_NULL_MESH, &any));
    ck_assert_uint_eq(any, meets);
    ck_ok(vox_grid_query_ray(asked.grid, &from.x, &to.x, UINT64_MAX, &first));
    ck_assert_int_eq(first.mesh != VOX_NULL_MESH, meets);
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
    desc.positions = others.data();
    const vox_mesh id = insert_mesh(grid, &desc);
    ck_ok(vox_grid_prepare_queries(grid));
    ck_ok(vox_mesh_bind_positions(grid, id, mesh.positions().data(), VOX_FORMAT_DOUBLE3, 0));
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
    ck_ok(vox_grid_query_ray_hits(x, &from.x, &to.x, UINT64_MAX, VOX_NULL_MESH, of_x.data(), of_x.size(),
                                  &count_x));
    ck_ok(vox_grid_query_ray_hits(y, &from.x, &to.x, UINT64_MAX, VOX_NULL_MESH, of_y.data(), of_y.size(),
                                  &count_y));
    ck_assert_uint_eq(count_x, count_y);
    ck_assert_mem_eq(of_x.data(), of_y.data(),
                     std::min<std::uint64_t>(count_x, of_x.size()) * sizeof of_x[0]);
}

START_TEST(bad_shapes_by_definition) {
    Random random{3};
    for (int shape = 0; shape < shape_count; ++shape)
        for (int round = 0; round < 6; ++round) {
            const QueryDefinition soup = make_soup(random, Shape(shape), 20 + random.below(300));
            vox_grid* grid = engine_grid();
            vox_mesh_desc mesh = vox_default_mesh_desc();
            mesh.positions = soup.positions().data();
            mesh.position_format = VOX_FORMAT_DOUBLE3;
            mesh.vertex_count = soup.positions().size();
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

void add_tests(TCase* tests) { tcase_add_test(tests, bad_shapes_by_definition); }

} // namespace

int main() {
    Suite* suite = suite_create("query search");
    tcase_add_each(add_case(suite, "parts"), rounded_outwards, every_item_once);
    add_for_each_engine(suite, add_tests);
    return run_suite(suite);
}
