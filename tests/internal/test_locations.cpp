// Locations of points, by definition: every tetrahedron and every facet tried, weights by rational numbers.
#include "base/simd.hpp"
#include "base/vectors.hpp"
#include "exact/accurate.hpp"
#include "internal/exact_queries.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

using namespace vox;
using namespace vox::test;

namespace {

std::array<Rational, 4> true_weights(const Vec3d& p, const Vec3d (&corner)[4]) {
    const auto& [a, b, c, d] = corner;
    const Rational all = volume(a, b, c, d);
    return {volume(p, b, c, d) / all, volume(a, p, c, d) / all, volume(a, b, p, d) / all,
            volume(a, b, c, p) / all};
}

// The weights of the point of a triangle of non-zero area that is closest to p.
std::array<Rational, 3> true_closest(const Vec3d& p, const Vec3d (&corner)[3]) {
    const RationalPoint u = between(corner[0], corner[1]), v = between(corner[0], corner[2]),
                        way = between(corner[0], p), normal = cross(u, v);
    const Rational area = dot(normal, normal);
    const Rational b = dot(cross(way, v), normal) / area, c = dot(cross(u, way), normal) / area,
                   a = Rational(1) - b - c;
    if (a.sign() >= 0 && b.sign() >= 0 && c.sign() >= 0) return {a, b, c};
    std::array<Rational, 3> best;
    Rational nearest = -1.0;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3;
        const RationalPoint edge = between(corner[i], corner[j]), to = between(corner[i], p);
        Rational along = dot(to, edge) / dot(edge, edge);
        if (along.sign() < 0) along = 0.0;
        if (Rational(1) < along) along = 1.0;
        const RationalPoint rest = {to[0] - along * edge[0], to[1] - along * edge[1],
                                    to[2] - along * edge[2]};
        const Rational squared = dot(rest, rest);
        if (nearest.sign() >= 0 && !(squared < nearest)) continue;
        nearest = squared;
        best = {};
        best[i] = Rational(1) - along;
        best[j] = along;
    }
    return best;
}

// As promised: rounded once, or off by 2^-58 more.
void check_weight(double weight, const Rational& wanted, double scale = 1) {
    const double error = std::abs((Rational(weight) - wanted).rounded());
    ck_assert_msg(error <= std::abs(weight) * 0x1p-53 * (1 + 0x1p-20) + scale * 0x1p-58, "%.17g is off by %g",
                  weight, error);
}

std::vector<vox_location> locate_all(const OwnLocator& locator, const std::vector<Vec3d>& points,
                                     std::uint32_t flags = 0, double max_distance = 0) {
    std::vector<vox_location> found(points.size());
    vox_query_desc desc = vox_default_query_desc();
    desc.flags = flags;
    desc.max_distance = max_distance;
    const vox_positions at = vox_double_positions(&points.data()->x, points.size());
    ck_ok(vox_locator_locate(locator.get(), &at, &desc, found.data()));
    return found;
}

// A facet that is not too thin or too far away to be weighed accurately.
bool is_thick(const Vec3d (&corner)[3], double squared_distance) {
    const Vec3d u = corner[1] - corner[0], v = corner[2] - corner[0], normal = cross(u, v);
    const double area = dot(normal, normal), longest = std::max({dot(u, u), dot(v, v), dot(v - u, v - u)});
    return area > 0x1p-38 * longest * longest && area > 1e-200 && area > 0x1p-78 * longest * squared_distance;
}

void check_outside(const vox_location& found, const vox_location& beyond, const Vec3d& p,
                   const QueryDefinition& mesh, const std::pair<double, QueryDefinition::Facet>& closest) {
    const auto [tet, facet] = closest.second;
    ck_assert_int_eq(found.state, VOX_LOCATION_OUTSIDE);
    ck_assert_uint_eq(found.tet, tet);
    ck_assert(found.distance == std::sqrt(closest.first)); // all bits
    ck_assert_uint_eq(beyond.tet, tet);
    ck_assert(beyond.distance == found.distance);
    ck_assert(found.weights[facet] == 0 && !std::signbit(found.weights[facet]));
    const std::uint8_t* c = facet_corners[facet];
    const Vec3d triangle[3] = {mesh.corner(tet, c[0]), mesh.corner(tet, c[1]), mesh.corner(tet, c[2])};
    if (is_thick(triangle, closest.first)) {
        const auto wanted = true_closest(p, triangle);
        for (std::size_t n = 0; n < 3; ++n) check_weight(found.weights[c[n]], wanted[n]);
    }
    const Vec3d corner[4] = {mesh.corner(tet, 0), mesh.corner(tet, 1), mesh.corner(tet, 2),
                             mesh.corner(tet, 3)};
    std::uint64_t exact = 0;
    if (orientation(corner[0], corner[1], corner[2], corner[3], exact) == 0) {
        ck_assert_mem_eq(beyond.weights, found.weights, sizeof found.weights);
        return;
    }
    double largest = 1;
    for (const double weight : beyond.weights) largest = std::max(largest, std::abs(weight));
    const auto wanted = true_weights(p, corner);
    for (std::size_t n = 0; n < 4; ++n) check_weight(beyond.weights[n], wanted[n], largest);
}

void check_locations(const std::vector<QueryDefinition>& meshes, const std::vector<Vec3d>& points,
                     Random& random) {
    std::vector<vox_body> ids;
    const OwnLocator locator = locator_of(meshes, ids);
    const std::vector<vox_location> found = locate_all(locator, points),
                                    beyond = locate_all(locator, points, VOX_QUERY_EXTRAPOLATE);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Vec3d& p = points[i];
        std::size_t inside = meshes.size(), outside = 0; // the mesh that has it, or the nearest one
        std::uint32_t tet = 0;
        std::pair<double, QueryDefinition::Facet> closest{std::numeric_limits<double>::infinity(), {}};
        for (std::size_t m = 0; m < meshes.size() && inside == meshes.size(); ++m) {
            const std::vector<std::uint32_t> tets = meshes[m].tets_with(p);
            if (!tets.empty()) {
                inside = m;
                tet = tets[0];
            } else if (const auto its = meshes[m].closest(p); its.first < closest.first) {
                closest = its;
                outside = m;
            }
        }
        if (inside == meshes.size()) {
            ck_assert_uint_eq(found[i].body, ids[outside]);
            check_outside(found[i], beyond[i], p, meshes[outside], closest);
            continue;
        }
        ck_assert_int_eq(found[i].state, VOX_LOCATION_INSIDE);
        ck_assert_uint_eq(found[i].body, ids[inside]);
        ck_assert_uint_eq(found[i].tet, tet);
        ck_assert(found[i].distance == 0);
        ck_assert_mem_eq(&found[i], &beyond[i], sizeof found[i]);
        const QueryDefinition& mesh = meshes[inside];
        const auto wanted = true_weights(
            p, {mesh.corner(tet, 0), mesh.corner(tet, 1), mesh.corner(tet, 2), mesh.corner(tet, 3)});
        for (std::size_t n = 0; n < 4; ++n) {
            check_weight(found[i].weights[n], wanted[n]);
            ck_assert(found[i].weights[n] >= 0 && !std::signbit(found[i].weights[n]));
        }
    }
    for (const simd::Level level : {simd::Level::portable, simd::Level::sse4, simd::Level::avx2}) {
        simd::force_level(level);
        const std::vector<vox_location> again = locate_all(locator, points);
        ck_assert_mem_eq(again.data(), found.data(), found.size() * sizeof found[0]);
    }
    simd::force_level(simd::best_level());
    // Any order and any split.
    std::vector<std::uint32_t> order = permutation(random, points.size());
    std::vector<Vec3d> others;
    for (const std::uint32_t i : order) others.push_back(points[i]);
    for (std::size_t begin = 0, size = 1; begin < others.size();
         begin += size, size = 1 + random.below(200)) {
        size = std::min(size, others.size() - begin);
        const auto first = others.begin() + std::ptrdiff_t(begin);
        const std::vector<vox_location> some = locate_all(locator, {first, first + std::ptrdiff_t(size)});
        for (std::size_t i = 0; i < size; ++i)
            ck_assert_mem_eq(&some[i], &found[order[begin + i]], sizeof some[i]);
    }
}

// On vertices, edges and facets, in tetrahedra, and around the mesh.
std::vector<Vec3d> places_in(const QueryDefinition& mesh, Random& random, std::size_t count) {
    std::vector<Vec3d> points;
    while (points.size() < count) {
        const std::uint32_t tet = random.below(std::uint32_t(mesh.tets().size()));
        const auto corner = [&] { return mesh.corner(tet, random.below(4)); };
        switch (points.size() % 5) {
        case 0:
            points.push_back(corner());
            break;
        case 1:
            points.push_back(0.5 * corner() + 0.5 * corner());
            break;
        case 2:
            points.push_back(0.5 * corner() + 0.25 * corner() + 0.25 * corner());
            break;
        case 3:
            points.push_back(random.unit() * (corner() - corner()) + corner());
            break;
        default:
            points.push_back(random.unit() * random_vector(random, 5) + corner());
        }
    }
    return points;
}

START_TEST(by_definition) {
    Random random{1};
    const auto count = std::size_t(volume_from("VOX_LOCATIONS", 1500));
    const QueryDefinition cubes = definition_of(kuhn_block(4, 3, 3, {0.5, 0.5, 0.5}, 0.5));
    const QueryDefinition near =
        definition_of(kuhn_block(2, 2, 2, {2.5, 0.5, 0.5}, 0.5)); // they share a side
    const QueryDefinition over = definition_of(kuhn_block(2, 2, 2, {1.25, 1, 1}, 0.5));
    check_locations({cubes}, places_in(cubes, random, count), random);
    check_locations({cubes, near, over}, places_in(near, random, count), random);
    QueryDefinition round = definition_of(jittered(ball(600), random, 0.2));
    check_locations({round}, places_in(round, random, count), random);
    std::vector<Vec3d> moved = round.positions(); // doubles
    for (Vec3d& p : moved) p = p + random_vector(random, 1e-3);
    round = {moved, round.tets()};
    check_locations({round}, places_in(round, random, count), random);
    for (int shape = 0; shape < shape_count; ++shape) {
        const QueryDefinition soup = make_soup(random, Shape(shape), 40);
        std::vector<Vec3d> points = places_in(soup, random, count / 10);
        for (std::size_t i = 0; i < count / 20; ++i) points.push_back(random_place(random, Shape(shape)));
        for (Vec3d& p : points) p = max({-1e38, -1e38, -1e38}, min({1e38, 1e38, 1e38}, p));
        check_locations({soup}, points, random);
    }
}
END_TEST

// The fields x, y and z of the mesh, at points of all kinds.
START_TEST(linear_fields) {
    Random random{2};
    Mesh mesh = jittered(ball(3000), random, 0.2);
    const QueryDefinition round = definition_of(mesh);
    std::vector<vox_body> ids;
    const OwnLocator locator = locator_of({round}, ids);
    const std::vector<Vec3d> points =
        places_in(round, random, std::size_t(volume_from("VOX_LOCATIONS", 1500)) * 20);
    const std::vector<vox_location> all = locate_all(locator, points, VOX_QUERY_EXTRAPOLATE);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double at[3] = {points[i].x, points[i].y, points[i].z};
        for (int axis = 0; axis < 3; ++axis) {
            double sum = 0, largest = 0;
            for (std::size_t c = 0; c < 4; ++c) {
                const Vec3d& corner = round.corner(all[i].tet, c);
                const double term = all[i].weights[c] * (axis == 0   ? corner.x
                                                         : axis == 1 ? corner.y
                                                                     : corner.z);
                sum += term;
                largest = std::max(largest, std::abs(term));
            }
            const double ulp = std::nextafter(largest, INFINITY) - largest;
            ck_assert_msg(std::abs(sum - at[axis]) <= 4 * ulp, "%.17g, not %.17g", sum, at[axis]);
        }
    }
}
END_TEST

START_TEST(bounds_and_errors) {
    const QueryDefinition cubes = definition_of(kuhn_block(2, 2, 2, {0, 0, 0}, 1));
    std::vector<vox_body> ids;
    const OwnLocator locator = locator_of({cubes, cubes}, ids);
    const std::vector<Vec3d> points = {{1, 1, 1}, {2.5, 1, 1}, {2.75, 1, 1}, {2.5, 2.5, 1}};
    std::vector<vox_location> found = locate_all(locator, points, 0, 0.5);
    ck_assert_int_eq(found[0].state, VOX_LOCATION_INSIDE);
    ck_assert_int_eq(found[1].state, VOX_LOCATION_OUTSIDE); // exactly as far
    ck_assert(found[1].distance == 0.5 && found[1].body == ids[0]);
    const vox_location none{};
    ck_assert_mem_eq(&found[2], &none, sizeof none);
    ck_assert_mem_eq(&found[3], &none, sizeof none);
    const vox_positions at = vox_double_positions(&points.data()->x, points.size());
    vox_query_desc desc = query_of(0, ids[0]);
    ck_ok(vox_locator_locate(locator.get(), &at, &desc, found.data()));
    for (const vox_location& location : found) ck_assert_uint_eq(location.body, ids[1]);
    desc = query_of(1ull << 40, VOX_NULL_BODY);
    ck_ok(vox_locator_locate(locator.get(), &at, &desc, found.data()));
    for (const vox_location& location : found) ck_assert_mem_eq(&location, &none, sizeof none);
    ck_fails(vox_locator_locate(locator.get(), &at, nullptr, nullptr), VOX_ERROR_INVALID_ARGUMENT,
             "out_locations");
    desc.max_distance = -1;
    ck_fails(vox_locator_locate(locator.get(), &at, &desc, found.data()), VOX_ERROR_INVALID_ARGUMENT, "-1");
    const vox_positions nothing = vox_double_positions(nullptr, 0);
    ck_ok(vox_locator_locate(locator.get(), &nothing, nullptr, nullptr));
}
END_TEST

} // namespace

SUITE(locations) {
    tcase_add_each(add_case(suite, "locations"), by_definition, linear_fields, bounds_and_errors);
}
