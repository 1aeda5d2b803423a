// Tests each part of the depth stage by itself: topology, the walk out of a mesh, normals.
#include "base/vectors.hpp"
#include "depth/normals.hpp"
#include "depth/walk.hpp"
#include "internal/prepared_mesh.hpp"
#include "internal/scenes.hpp"
#include "mesh/topology.hpp"
#include "support/suite.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory_resource>
#include <set>
#include <vector>

using namespace vox;
using namespace vox::depth;

namespace {

std::pmr::memory_resource* memory() { return std::pmr::get_default_resource(); }

std::array<std::uint32_t, 3> facet(const Tet& tet, int left_out) {
    std::array<std::uint32_t, 3> f{};
    std::size_t n = 0;
    for (int i = 0; i < 4; ++i)
        if (i != left_out) f[n++] = tet.v[i];
    std::sort(f.begin(), f.end());
    return f;
}

// ---- topology -------------------------------------------------------------------------------------

START_TEST(topology_of_anything) {
    // With few vertices and many tets, there are duplicate tets, facets of many tets, tets that name a vertex
    // twice, and vertices in no tet.
    Random random{std::uint64_t(_i)};
    const std::uint32_t vertices = 4 + random.below(20), tets = random.below(60);
    const Prepared p(soup(random, vertices, tets, [](Random& r) { return r.uniform(0, 1); }));
    const Topology& t = p.topology;
    std::vector<std::set<std::uint32_t>> neighbours(vertices);
    std::map<std::array<std::uint32_t, 3>, std::set<std::uint32_t>> opposite;
    for (const Tet& tet : p.mesh.tets) {
        if (std::set<std::uint32_t>(tet.v, tet.v + 4).size() < 4) continue;
        for (int i = 0; i < 4; ++i) {
            opposite[facet(tet, i)].insert(tet.v[i]);
            for (int j = 0; j < 4; ++j)
                if (i != j) neighbours[tet.v[i]].insert(tet.v[j]);
        }
    }
    for (std::uint32_t v = 0; v < vertices; ++v) {
        const auto found = t.neighbours_of(v);
        ck_assert(std::equal(found.begin(), found.end(), neighbours[v].begin(), neighbours[v].end()));
        std::vector<std::uint32_t> ring;
        for (std::uint32_t k = 0; k < t.triangles.size(); ++k)
            if (has_corner(t.triangles[k], v)) ring.push_back(k);
        ck_assert(std::ranges::equal(t.ring_of(v), ring));
    }
    std::size_t boundary = 0;
    for (const auto& [f, others] : opposite) boundary += others.size() == 1;
    ck_assert_uint_eq(t.triangles.size(), boundary);
    for (std::size_t k = 0; k < p.mesh.tets.size(); ++k) {
        const Tet& tet = p.mesh.tets[k];
        const bool ignored = std::set<std::uint32_t>(tet.v, tet.v + 4).size() < 4;
        for (int i = 0; i < 4; ++i) {
            const std::uint32_t across =
                t.across(static_cast<std::uint32_t>(k), static_cast<std::uint32_t>(i));
            const std::size_t sides = ignored ? 0 : opposite[facet(tet, i)].size();
            if (sides == 1) {
                ck_assert_uint_ne(across & Topology::surface_bit, 0);
                const Triangle& triangle = t.triangles[across & ~Topology::surface_bit];
                for (int j = 0; j < 4; ++j) ck_assert_int_eq(has_corner(triangle, tet.v[j]), i != j);
                ck_assert_uint_eq(triangle.apex, tet.v[i]);
            } else if (sides == 2) {
                const Tet& other = p.mesh.tets[across];
                int shared = 0;
                for (const std::uint32_t v : other.v) shared += std::count(tet.v, tet.v + 4, v) > 0;
                ck_assert_int_eq(shared, 3);
                ck_assert_int_eq(std::count(other.v, other.v + 4, tet.v[i]), 0);
            } else {
                ck_assert_uint_eq(across, Topology::nothing);
            }
        }
    }
}
END_TEST

START_TEST(no_tets_no_topology) {
    Topology t{memory()};
    make_topology({}, 7, t);
    ck_assert_uint_eq(t.neighbours_of(3).size() + t.ring_of(6).size() + t.triangles.size(), 0);
    // And no memory either.
    ck_assert_uint_eq(t.links.bytes() + t.across.bytes() + t.triangles.capacity(), 0);
}
END_TEST

// ---- the walk -------------------------------------------------------------------------------------

double volume(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
    return dot(cross(b - a, c - a), d - a);
}

// A tetrahedron of the mesh that holds the point. The test fails when there is none.
std::uint32_t tet_with(const Prepared& p, const Vec3d& point) {
    for (std::uint32_t t = 0; t < p.mesh.tets.size(); ++t) {
        const std::uint32_t* v = p.mesh.tets[t].v;
        const Vec3d corner[4] = {p.at(v[0]), p.at(v[1]), p.at(v[2]), p.at(v[3])};
        const double whole = volume(corner[0], corner[1], corner[2], corner[3]);
        bool inside = true;
        for (const auto& [x, y, z] : facet_corners)
            inside &= volume(corner[x], corner[y], corner[z], point) * (whole > 0 ? 1 : -1) <= 0;
        if (inside) return t;
    }
    ck_abort_msg("no tetrahedron holds (%g, %g, %g)", point.x, point.y, point.z);
    return 0;
}

// Where the segment from p, inside the box [0, side]^3, to q outside leaves the box.
Vec3d exit_of_box(const Vec3d& p, const Vec3d& q, double side) {
    double t = 1;
    const double from[3] = {p.x, p.y, p.z}, to[3] = {q.x, q.y, q.z};
    for (int i = 0; i < 3; ++i) {
        if (to[i] > side) t = std::min(t, (side - from[i]) / (to[i] - from[i]));
        if (to[i] < 0) t = std::min(t, from[i] / (from[i] - to[i]));
    }
    return p + t * (q - p);
}

bool outside_box(const Vec3d& q, double side) {
    return std::max({q.x, q.y, q.z}) > side || std::min({q.x, q.y, q.z}) < 0;
}

void expect_exit(const Prepared& p, const Vec3d& from, const Vec3d& to, const Vec3d& expected) {
    SurfacePoint out{};
    std::uint64_t visited = 0;
    const bool left = walk_out(p.solid(), tet_with(p, from), from, to, out, visited);
    ck_assert_msg(left, "no way out from (%g, %g, %g) to (%g, %g, %g)", from.x, from.y, from.z, to.x, to.y,
                  to.z);
    ck_assert_msg(length(out.point - expected) < 1e-9, "out %g away from where it should be",
                  length(out.point - expected));
    ck_assert(length(p.at(out) - out.point) < 1e-7);
    ck_assert(std::abs(out.weight[0] + out.weight[1] + out.weight[2] - 1) < 1e-12);
    ck_assert_uint_ge(visited, 1);
}

START_TEST(walks_leave_where_the_segment_does) {
    // Inner vertices are moved at random. Some segments are long, and some leave at once.
    Random random{std::uint64_t(_i) + 1};
    Mesh box = kuhn_block(5, 5, 5, {0, 0, 0}, 1);
    for (Vec3f& v : box.positions)
        if (!outside_box(Vec3d(v) - Vec3d{0.5, 0.5, 0.5}, 4)) // an inner vertex
            v = {v.x + random.uniform(-0.15, 0.15), v.y + random.uniform(-0.15, 0.15),
                 v.z + random.uniform(-0.15, 0.15)};
    if (_i % 2) // wind all the other way, or every third
        for (std::size_t t = 0; t < box.tets.size(); t += std::size_t(_i % 4))
            std::swap(box.tets[t].v[1], box.tets[t].v[2]);
    const Prepared p(std::move(box));
    for (int i = 0; i < 300; ++i) {
        const auto inner = [&] { return double{random.uniform(0.01, 4.99)}; };
        const auto anywhere = [&] { return double{random.uniform(-9, 14)}; };
        const Vec3d from{inner(), inner(), inner()}, to{anywhere(), anywhere(), anywhere()};
        if (outside_box(to, 5)) expect_exit(p, from, to, exit_of_box(from, to, 5));
    }
}
END_TEST

START_TEST(walks_along_facets_edges_and_through_vertices) {
    // From points in the interior of a tetrahedron in directions that meet the lattice in every special way.
    const Prepared p(kuhn_block(3, 3, 3, {0, 0, 0}, 1));
    const Vec3d from[] = {{1.5, 1.25, 1.125}, {1.5, 1.75, 1.375}, {1.375, 1.625, 1.25}};
    int walks = 0;
    for (const Vec3d& start : from)
        for (int x = -8; x <= 20; x += 4)
            for (int y = -8; y <= 20; y += 4)
                for (int z = -8; z <= 20; z += 4) {
                    // Through the lattice point (x, y, z) / 4, and eight times as far.
                    const Vec3d through{x / 4.0, y / 4.0, z / 4.0};
                    const Vec3d to = start + 8.0 * (through - start);
                    if (!outside_box(to, 3)) continue;
                    expect_exit(p, start, to, exit_of_box(start, to, 3));
                    ++walks;
                }
    ck_assert_int_gt(walks, 1000);
}
END_TEST

START_TEST(walks_that_lead_nowhere) {
    const Prepared p(kuhn_block(3, 3, 3, {0, 0, 0}, 1));
    const Vec3d from{1.4, 1.3, 1.1};
    SurfacePoint out{};
    std::uint64_t visited = 0;
    const std::uint32_t tet = tet_with(p, from);
    ck_assert(!walk_out(p.solid(), tet, from, from, out, visited));
    ck_assert(!walk_out(p.solid(), tet, from, {2.6, 2.1, 1.9}, out, visited)); // ends inside
    ck_assert_uint_le(visited, 20);
}
END_TEST

START_TEST(walks_through_inverted_tets) {
    // One inner vertex is pulled far out of its star. Walks through the fold still find the surface, or
    // return false.
    for (int i = 0; i < 200; ++i) {
        Random random{std::uint64_t(i) + 1};
        Mesh box = kuhn_block(4, 4, 4, {0, 0, 0}, 1);
        box.positions[2 * 25 + 2 * 5 + 2] = {random.uniform(0.5, 3.5), random.uniform(0.5, 3.5),
                                             random.uniform(0.5, 3.5)};
        const Prepared p(std::move(box));
        const Vec3d from{0.3, 0.4, 0.2}; // outside the star
        const Vec3d to{random.uniform(-9, 13), random.uniform(-9, 13), random.uniform(-9, 13)};
        if (!outside_box(to, 4)) continue;
        SurfacePoint out{};
        std::uint64_t visited = 0;
        if (walk_out(p.solid(), tet_with(p, from), from, to, out, visited))
            ck_assert(length(out.point - exit_of_box(from, to, 4)) < 1e-9);
        ck_assert_uint_le(visited, p.mesh.tets.size());
    }
}
END_TEST

START_TEST(walks_do_not_go_round) {
    // All five tetrahedra of five vertices. Every facet has one on either side of it, so there is no surface,
    // and a line that leaves one of them is in another, for ever.
    Mesh box = kuhn_block(12, 12, 12, {0, 0, 0}, 1);
    const auto first = static_cast<std::uint32_t>(box.positions.size());
    for (const Vec3f& v : {Vec3f{20, 0, 0}, {24, 0, 0}, {20, 4, 0}, {20, 0, 4}, {23, 3, 3}})
        box.positions.push_back(v);
    for (std::uint32_t left_out = 0; left_out < 5; ++left_out) {
        Tet tet{};
        for (std::uint32_t i = 0, n = 0; i < 5; ++i)
            if (i != left_out) tet.v[n++] = first + i;
        box.tets.push_back(tet);
    }
    const auto tet = static_cast<std::uint32_t>(box.tets.size() - 1); // the first four vertices
    const Prepared p(std::move(box));
    for (const Vec3d& to : {Vec3d{90, 1, 1}, {21, 90, 1}, {21, 1, 90}, {90, 90, 90}}) {
        SurfacePoint out{};
        std::uint64_t visited = 0;
        ck_assert(!walk_out(p.solid(), tet, {21, 1, 1}, to, out, visited));
        ck_assert_uint_le(visited, 16);
    }
}
END_TEST

// ---- normals --------------------------------------------------------------------------------------

START_TEST(normals_on_a_sphere) {
    // A lattice cube is pushed onto the unit ball. Normals are exact at its corners, and nearly exact between
    // them.
    Mesh ball = kuhn_block(12, 12, 12, {-1, -1, -1}, 2.0 / 12);
    for (Vec3f& v : ball.positions) {
        const double most = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}), l = length(Vec3d(v));
        const double s = l > 0 ? most / l : 0;
        v = {float(s * double{v.x}), float(s * double{v.y}), float(s * double{v.z})};
    }
    const Prepared p(std::move(ball));
    Normals normals(memory());
    normals.begin(p.solid());
    for (std::uint32_t t = 0; t < p.topology.triangles.size(); ++t)
        for (int i = 0; i < 4; ++i) {
            SurfacePoint point{t, {1 / 3.0, 1 / 3.0, 1 / 3.0}, {0, 0, 0}};
            for (int k = 0; k < 3 && i < 3; ++k) point.weight[k] = k == i;
            const Vec3d at = p.at(point), normal = normals.at(point, at),
                        inward = normals.at(point, -1.0 * at);
            ck_assert(std::abs(length(normal) - 1) < 1e-12);
            ck_assert(length(normal + inward) == 0); // of the other side
            ck_assert_msg(length(normal - normalised(at)) < (i < 3 ? 0.01 : 0.02), "corner %d: %g off", i,
                          length(normal - normalised(at)));
        }
}
END_TEST

START_TEST(normals_of_a_box_are_those_of_its_faces) {
    Mesh box = kuhn_block(3, 3, 3, {0, 0, 0}, 0.7);
    for (std::size_t t = 0; t < box.tets.size(); t += 3) std::swap(box.tets[t].v[0], box.tets[t].v[1]);
    const Prepared p(std::move(box));
    Normals normals(memory());
    normals.begin(p.solid());
    for (std::uint32_t t = 0; t < p.topology.triangles.size(); ++t) {
        const SurfacePoint point{t, {0.7, 0.2, 0.1}, {0, 0, 0}};
        const std::uint32_t* v = p.topology.triangles[t].v;
        const Vec3d face = normalised(cross(p.at(v[1]) - p.at(v[0]), p.at(v[2]) - p.at(v[0])));
        ck_assert(length(normals.at(point, face) - face) < 1e-12);
    }
}
END_TEST

START_TEST(normals_of_a_tetrahedron_are_those_of_its_faces) {
    // Edges sharper than those of a box, where normals point nearly opposite ways.
    for (const float height : {1.0f, 0.01f, -1.0f, -0.01f}) {
        const Prepared p(Mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.3f, 0.3f, height}}, {{{0, 1, 2, 3}}}});
        const Vec3d middle = 0.25 * ((p.at(0) + p.at(1)) + (p.at(2) + p.at(3)));
        Normals normals(memory());
        normals.begin(p.solid());
        for (std::uint32_t t = 0; t < 4; ++t) {
            // The upper faces of a flat tetrahedron are nearly one face.
            if (std::abs(height) < 1 && p.topology.triangles[t].apex != 3) continue;
            const SurfacePoint point{t, {0.2, 0.1, 0.7}, {0, 0, 0}};
            const std::uint32_t* v = p.topology.triangles[t].v;
            const Vec3d face = normalised(cross(p.at(v[1]) - p.at(v[0]), p.at(v[2]) - p.at(v[0])));
            const Vec3d out = dot(face, p.at(v[0]) - middle) > 0 ? face : -1.0 * face;
            ck_assert(length(normals.at(point, p.at(v[0]) - middle) - out) < 1e-12);
        }
    }
}
END_TEST

} // namespace

SUITE(depth_parts) {
    TCase* tests = add_case(suite, "parts");
    tcase_add_loop_test(tests, topology_of_anything, 0, 200);
    tcase_add_test(tests, no_tets_no_topology);
    tcase_add_loop_test(tests, walks_leave_where_the_segment_does, 0, 8);
    tcase_add_each(tests, walks_along_facets_edges_and_through_vertices, walks_that_lead_nowhere,
                   walks_through_inverted_tets, walks_do_not_go_round, normals_on_a_sphere,
                   normals_of_a_box_are_those_of_its_faces, normals_of_a_tetrahedron_are_those_of_its_faces);
}
