// The search for the closest point of a surface, against all triangles one by one: in bodies and in folds,
// with any instruction set, and whatever positions the tree was fitted to before.
#include "base/vectors.hpp"
#include "depth/closest.hpp"
#include "exact/closest_point.hpp"
#include "exact/facet_normal.hpp"
#include "internal/prepared_mesh.hpp"
#include "internal/scenes.hpp"
#include "internal/stage_checks.hpp"
#include "mesh/topology.hpp"
#include "support/suite.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory_resource>
#include <set>
#include <vector>

using namespace vox;
using namespace vox::depth;

namespace {

std::pmr::memory_resource* memory() { return std::pmr::get_default_resource(); }

bool same(const Closest& x, const Closest& y) {
    return x.at.triangle == y.at.triangle && x.squared == y.squared && x.way.x == y.way.x &&
           x.way.y == y.way.y && x.way.z == y.way.z;
}

// The closest points of all triangles but those with a vertex, nearest first.
std::vector<Closest> in_order(const Solid& solid, const Vec3d& p, std::uint32_t left_out) {
    std::vector<Closest> all;
    for (std::uint32_t t = 0; t < solid.topology->triangles.size(); ++t)
        if (!has_corner(solid.topology->triangles[t], left_out)) all.push_back(closest_point(solid, t, p));
    std::sort(all.begin(), all.end(), [&](const Closest& x, const Closest& y) {
        return x.squared != y.squared ? x.squared < y.squared
                                      : solid.topology->before(x.at.triangle, y.at.triangle);
    });
    return all;
}

void expect_closest(const Prepared& p, const SurfaceTree& tree, const Vec3d& at, std::uint32_t left_out,
                    SearchState& state) {
    const std::vector<Closest> all = in_order(p.solid(), at, left_out);
    Closest found{};
    ck_assert_int_eq(tree.find(at, left_out, state, found), !all.empty());
    if (all.empty()) return;
    ck_assert_msg(same(found, all[0]), "triangle %u at %.17g, expected %u at %.17g", found.at.triangle,
                  std::sqrt(found.squared), all[0].at.triangle, std::sqrt(all[0].squared));
}

// Soups of tetrahedra, in general position, then flat and coincident; a block.
Mesh any_mesh(Random& random, int kind) {
    return kind == 0   ? soup(random, 40, 60, [](Random& r) { return r.uniform(0, 1); })
           : kind == 1 ? soup(random, 60, 80, [](Random& r) { return float(r.below(4)); })
                       : jittered(kuhn_block(6, 5, 7, {0, 0, 0}, 0.5), random, 0.1);
}

START_TEST(closest_of_all_triangles) {
    Random random{std::uint64_t(_i) + 1};
    Prepared p(any_mesh(random, _i % 3));
    SurfaceTree tree(memory());
    for (int pose = 0; pose < 4; ++pose) {
        // The tree follows the body: moved at random, made large, carried far away, pressed to a point.
        for (Vec3f& v : p.mesh.positions) {
            if (pose == 1) v = {v.x + random.uniform(-1, 1), v.y * 1e4f, v.z};
            if (pose == 2) v = {v.x + 1e7f, v.y, v.z * 3};
            if (pose == 3) v = {v.x * 0, v.y * 0, _i % 2 ? v.z * 1e-30f : 0};
        }
        tree.update(p.solid(), false, nullptr);
        SearchState state;
        Vec3d centre{0, 0, 0};
        double size = 0;
        for (std::uint32_t v = 0; v < p.vertex_count(); ++v) {
            centre = centre + 1.0 / p.vertex_count() * p.at(v);
            size = std::max(size, length(p.at(v) - p.at(0)));
        }
        for (int i = 0; i < 100; ++i) {
            const double reach = i % 4 == 0 ? 20 * size : size;
            const auto offset = [&] { return double{random.uniform(-1, 1)} * reach; };
            Vec3d at = centre + Vec3d{offset(), offset(), offset()};
            // Many triangles are equally far from a vertex. Far away, all of them are nearly as far.
            if (i % 5 == 0) at = p.at(random.below(p.vertex_count()));
            if (i == 1) at = {1e30, -1e30, 1e20};
            expect_closest(p, tree, at, SurfaceTree::no_vertex, state);
            expect_closest(p, tree, at, random.below(p.vertex_count()), state);
        }
    }
}
END_TEST

START_TEST(closest_with_double_positions) {
    // Apart by less than a float can tell, far from the origin.
    Random random{std::uint64_t(_i) + 1};
    Prepared p(jittered(kuhn_block(5, 5, 5, {0, 0, 0}, 1), random, 0.2));
    const double scale = std::pow(10.0, _i % 8 * 10 - 40);
    for (const Vec3f& v : p.mesh.positions)
        p.doubles.push_back(scale * (Vec3d{1e3, -1e3, 1e3} + 1e-6 * Vec3d(v)));
    SurfaceTree tree(memory());
    tree.update(p.solid(), false, nullptr);
    SearchState state;
    for (int i = 0; i < 100; ++i) {
        const auto inner = [&] { return double{random.uniform(0, 5)}; };
        const Vec3d at = scale * (Vec3d{1e3, -1e3, 1e3} + 1e-6 * Vec3d{inner(), inner(), inner()});
        expect_closest(p, tree, at, SurfaceTree::no_vertex, state);
    }
    // The boxes tell triangles apart: a small part of them is computed.
    ck_assert_uint_lt(state.visited, 100 * p.topology.triangles.size() / 4);
}
END_TEST

// ---- one triangle -------------------------------------------------------------------------------------

// Thin and thick triangles of every size that doubles have, turned so that nothing is exact, and points above
// them: the closest point is known by its construction.
START_TEST(closest_on_odd_triangles) {
    Random random{7};
    const auto uniform = [&](double least, double most) {
        return double{random.uniform(0, 1)} * (most - least) + least;
    };
    int inner = 0;
    for (int i = 0; i < 100000; ++i) {
        const int scale = static_cast<int>(uniform(-1040, 127)); // down to 2^34 units of the least denormal
        const bool denormal = scale < -950;
        const auto at = [scale](const Vec3d& v) {
            return Vec3d{std::ldexp(v.x, scale), std::ldexp(v.y, scale), std::ldexp(v.z, scale)};
        };
        const Vec3d x = normalised(Vec3d{uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)});
        const Vec3d y = normalised(cross(x, {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)})),
                    z = cross(x, y);
        const double flat = std::pow(10, uniform(denormal ? -1 : -20, 0)),
                     above = std::pow(10, uniform(-5, 1));
        const double b = uniform(0, 1), c = uniform(0, 1 - b), foot = uniform(0, 1);
        const Vec3d corner[3] = {{0, 0, 0}, x, foot * x + flat * y};
        const Vec3d expected = b * corner[1] + c * corner[2], p = expected + above * z;
        const ClosestPoint found = closest_on_triangle(at(p), at(corner[0]), at(corner[1]), at(corner[2]));
        const std::array<double, 3> w = normalised(found.weight);
        for (const double weight : w) ck_assert(weight >= 0 && weight <= 1);
        ck_assert_double_le(std::abs(w[0] + w[1] + w[2] - 1), 1e-15);
        const Vec3d place = w[1] * corner[1] + w[2] * corner[2];
        ck_assert_double_le(length(place - expected), 1e-6);
        inner += w[0] > 0 && w[1] > 0 && w[2] > 0;
    }
    ck_assert_int_gt(inner, 10000);
}
END_TEST

// ---- folds ------------------------------------------------------------------------------------------

using Place = std::set<std::uint32_t>; // the corners with a weight

Place place_of(const Solid& solid, const Closest& found) {
    Place place;
    for (int i = 0; i < 3; ++i)
        if (found.at.weight[i] != 0) place.insert(solid.topology->triangles[found.at.triangle].v[i]);
    return place;
}

Vec3d way_to(const Solid& solid, const Place& place, const Vec3d& p, const Closest& found) {
    if (place.size() == 3) return found.way;
    const Vec3d a = solid.at(*place.begin()), b = solid.at(*place.rbegin()), ab = b - a;
    if (place.size() == 1) return a - p;
    const double squared = dot(ab, ab);
    return (a - p) + (squared > 0 ? std::clamp(dot(p - a, ab) / squared, 0.0, 1.0) : 0) * ab;
}

bool is_reached(const Solid& solid, std::uint32_t vertex, std::uint32_t tet, const Vec3d& p,
                const Vec3d& way) {
    SurfacePoint out;
    std::uint64_t tets = 0;
    if (dot(way, way) == 0) return true;
    if (!walk_out(solid, tet, p, p + 2.0 * way, out, tets)) return false;
    const Vec3d whole = out.point - p, rest = whole - way;
    return !has_corner(solid.topology->triangles[out.triangle], vertex) &&
           dot(rest, rest) <= 1e-12 * dot(whole, whole);
}

bool is_local_minimum(const Solid& solid, const Place& place, const Vec3d& way) {
    if (place.size() == 3) return true;
    const Vec3d a = solid.at(*place.begin()), ab = solid.at(*place.rbegin()) - a;
    for (const Triangle& t : solid.topology->triangles) {
        if (!std::all_of(place.begin(), place.end(), [&](std::uint32_t v) { return has_corner(t, v); }))
            continue;
        for (const std::uint32_t v : t.v) {
            if (place.contains(v)) continue;
            Vec3d into = solid.at(v) - a;
            if (dot(ab, ab) > 0) into = into - (dot(into, ab) / dot(ab, ab)) * ab;
            const double nearer = -dot(way, into);
            if (nearer > 0 && nearer * nearer > 1e-24 * dot(way, way) * dot(into, into)) return false;
        }
    }
    return true;
}

// The rule of docs/depth-method.md, for a mesh of one part. `squared_exit` is where a line to the closest
// point leaves the fold.
Closest by_definition(const Solid& solid, std::uint32_t vertex, std::uint32_t tet, const Vec3d& p,
                      const std::vector<Closest>& all) {
    const auto reached = [&](const Vec3d& way) { return is_reached(solid, vertex, tet, p, way); };
    if (reached(all[0].way)) return all[0];
    SurfacePoint out;
    std::uint64_t tets = 0;
    double squared_exit = 0;
    if (walk_out(solid, tet, p, p + 0x1p12 * all[0].way, out, tets) &&
        !has_corner(solid.topology->triangles[out.triangle], vertex))
        squared_exit = dot(out.point - p, out.point - p);
    std::set<Place> places, minima;
    for (const Closest& found : all) {
        const Place place = place_of(solid, found);
        const Vec3d way = way_to(solid, place, p, found);
        const bool is_new = !places.contains(place);
        places.insert(place);
        if (!is_new) continue;
        const bool is_minimum = found.squared <= squared_exit && is_local_minimum(solid, place, way);
        if (is_minimum) minima.insert(place);
        if (places.size() > 1 && (places.size() <= 4 || (is_minimum && minima.size() <= 8)) && reached(way))
            return found;
    }
    return all[0];
}

// A block tangled with itself: its vertices are moved by up to `amount` edges.
Prepared tangled(Random& random, double amount) {
    return Prepared(jittered(kuhn_block(6, 5, 6, {0, 0, 0}, 1), random, amount));
}

// Calls visit(vertex, tet) for vertices in tetrahedra that do not have them as a corner.
template <class Visit>
void for_contacts(const Prepared& p, Visit&& visit) {
    const auto volume = [](const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
        return dot(cross(b - a, c - a), d - a);
    };
    for (std::uint32_t v = 0; v < p.vertex_count(); ++v)
        for (std::uint32_t t = 0; t < p.mesh.tets.size(); ++t) {
            const std::uint32_t* corner = p.mesh.tets[t].v;
            if (std::find(corner, corner + 4, v) != corner + 4) continue;
            const Vec3d a = p.at(corner[0]), b = p.at(corner[1]), c = p.at(corner[2]), d = p.at(corner[3]),
                        at = p.at(v);
            const double sides[4] = {volume(at, b, c, d), volume(a, at, c, d), volume(a, b, at, d),
                                     volume(a, b, c, at)};
            const double whole = volume(a, b, c, d);
            if (std::all_of(sides, sides + 4, [&](double side) { return side * whole > 0; })) {
                visit(v, t);
                break;
            }
        }
}

START_TEST(folds_by_definition) {
    Random random{std::uint64_t(_i) + 1};
    const Prepared p = tangled(random, 0.6 + 0.1 * _i);
    SurfaceTree tree(memory());
    tree.update(p.solid(), true, nullptr);
    std::size_t contacts = 0, beyond = 0;
    SearchState state;
    for_contacts(p, [&](std::uint32_t v, std::uint32_t t) {
        const Vec3d at = p.at(v);
        const std::vector<Closest> all = in_order(p.solid(), at, v);
        const Closest expected = by_definition(p.solid(), v, t, at, all);
        Closest found{};
        ck_assert(tree.find_in_fold(at, v, t, state, found));
        ck_assert_msg(same(found, expected), "vertex %u: triangle %u at %.17g, expected %u at %.17g", v,
                      found.at.triangle, std::sqrt(found.squared), expected.at.triangle,
                      std::sqrt(expected.squared));
        ++contacts;
        beyond += !same(expected, all[0]);
    });
    ck_assert_uint_gt(contacts, 30);
    ck_assert_uint_gt(beyond, 2);
}
END_TEST

START_TEST(folds_do_not_depend_on_the_past) {
    // One tree knew other positions before, and searches go backwards.
    Random random{std::uint64_t(_i) + 1};
    Prepared p = tangled(random, 0.8);
    SurfaceTree fresh(memory()), old(memory());
    const std::vector<Vec3f> positions = p.mesh.positions;
    for (int pose = 0; pose < 3; ++pose) {
        jitter(p.mesh, 2, random);
        move(p.mesh, pose == 1 ? 100 : 0.5, 7, 8, 9);
        old.update(p.solid(), true, nullptr);
    }
    p.mesh.positions = positions;
    old.update(p.solid(), true, nullptr);
    fresh.update(p.solid(), true, nullptr);
    std::vector<std::array<std::uint32_t, 2>> contacts;
    for_contacts(p, [&](std::uint32_t v, std::uint32_t t) { contacts.push_back({v, t}); });
    std::vector<Closest> forwards(contacts.size());
    SearchState state;
    for (std::size_t i = 0; i < contacts.size(); ++i)
        ck_assert(
            fresh.find_in_fold(p.at(contacts[i][0]), contacts[i][0], contacts[i][1], state, forwards[i]));
    state = {};
    for (std::size_t i = contacts.size(); i-- > 0;) {
        Closest found{};
        ck_assert(old.find_in_fold(p.at(contacts[i][0]), contacts[i][0], contacts[i][1], state, found));
        ck_assert(same(found, forwards[i]));
    }
}
END_TEST

START_TEST(the_same_with_any_instructions) {
    Random random{17};
    const Prepared p = tangled(random, 0.7);
    std::vector<Closest> first;
    std::uint64_t visited = 0;
    bool is_first = true;
    stages::at_each_level([&](const char* name) {
        SurfaceTree tree(memory());
        tree.update(p.solid(), true, nullptr);
        SearchState state;
        std::size_t i = 0;
        for_contacts(p, [&](std::uint32_t v, std::uint32_t t) {
            Closest found{};
            ck_assert(tree.find_in_fold(p.at(v), v, t, state, found));
            if (is_first)
                first.push_back(found);
            else
                ck_assert_msg(same(found, first[i]), "vertex %u with %s", v, name);
            ++i;
        });
        if (is_first) visited = state.visited;
        ck_assert_uint_eq(state.visited, visited);
        is_first = false;
    });
}
END_TEST

START_TEST(closest_on_the_fold_that_is_entered) {
    // Two parts of one mesh that overlap a little. For a vertex of the upper one in a tetrahedron of the
    // lower one, only the surface of the lower one counts, though that of its own part is closer.
    Mesh mesh = kuhn_block(3, 3, 3, {0, 0, 0}, 1);
    const auto shift = static_cast<std::uint32_t>(mesh.positions.size());
    append(mesh, kuhn_block(3, 3, 3, {0.1, 0.2, 2.6}, 1));
    const Prepared p(std::move(mesh));
    const std::uint32_t vertex = shift + 5; // on the underside of the upper part, not at its rim
    SurfaceTree tree(memory());
    tree.update(p.solid(), true, nullptr);
    bool is_found = false;
    for_contacts(p, [&](std::uint32_t v, std::uint32_t t) {
        if (v != vertex) return;
        ck_assert_uint_lt(t, p.mesh.tets.size() / 2);
        ck_assert_uint_ne(tree.part_of(t), SurfaceTree::all_parts);
        const Vec3d at = p.at(v);
        Closest found{};
        SearchState state;
        ck_assert(tree.find_in_fold(at, v, t, state, found));
        ck_assert(std::abs(std::sqrt(found.squared) - (3 - at.z)) < 1e-9);
        ck_assert(found.way.z > 0 && std::abs(found.way.x) + std::abs(found.way.y) < 1e-12);
        is_found = true;
    });
    ck_assert(is_found);
}
END_TEST

START_TEST(a_tree_follows_edits) {
    // A block loses half of its tetrahedra.
    Random random{3};
    Prepared p(jittered(kuhn_block(4, 4, 6, {0, 0, 0}, 1), random, 0.1));
    SurfaceTree tree(memory());
    tree.update(p.solid(), true, nullptr);
    p.mesh.tets.resize(p.mesh.tets.size() / 2);
    make_topology(p.mesh.tets, p.vertex_count(), p.topology);
    tree.invalidate();
    tree.update(p.solid(), true, nullptr);
    SearchState state;
    for (int i = 0; i < 50; ++i) {
        const auto inner = [&] { return double{random.uniform(0, 4)}; };
        expect_closest(p, tree, {inner(), inner(), inner()}, SurfaceTree::no_vertex, state);
    }
}
END_TEST

// Squares of short ways vanish; their directions are unit vectors all the same.
START_TEST(directions_of_any_length) {
    for (int power = -1070; power <= 128; ++power) {
        const double size = std::ldexp(1, power);
        const Stretch stretch({-2 * size, size, 2 * size});
        ck_assert_double_eq_tol(stretch.length / size, 3, power < -1000 ? 1 : 1e-15);
        ck_assert_double_eq_tol(stretch.direction.x, -2.0 / 3, 1e-15);
        ck_assert_double_eq_tol(length(stretch.direction), 1, 1e-15);
    }
    const Stretch none({0, 0, 0});
    ck_assert(none.length == 0 && none.direction.x == 0 && none.direction.y == 0 && none.direction.z == 0);
}
END_TEST

} // namespace

SUITE(closest) {
    TCase* tests = add_case(suite, "closest");
    tcase_add_test(tests, directions_of_any_length);
    tcase_add_loop_test(tests, closest_of_all_triangles, 0, 24);
    tcase_add_loop_test(tests, closest_with_double_positions, 0, 8);
    tcase_add_loop_test(tests, folds_by_definition, 0, 8);
    tcase_add_loop_test(tests, folds_do_not_depend_on_the_past, 0, 3);
    tcase_add_each(tests, closest_on_odd_triangles, the_same_with_any_instructions,
                   closest_on_the_fold_that_is_entered, a_tree_follows_edits);
}
