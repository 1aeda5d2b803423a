// Constraints of edges in random scenes against all edges and all faces, by definition: surfaces found by
// counting facets, every pair decided by find_crossing(), which test_crossing compares with rational numbers.
//
// Environment: VOX_EDGE_SCENES, how many.
#include "base/boxes.hpp"
#include "base/vectors.hpp"
#include "exact/closest_point.hpp"
#include "exact/crossing.hpp"
#include "internal/random.hpp"
#include "scenes/bodies.h"
#include "support/constraint_checks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <tuple>
#include <vector>

using namespace vox;

namespace {

// ---- the definition -------------------------------------------------------------------------------

struct TestMesh {
    std::vector<double> positions;
    std::vector<std::uint32_t> tets;
    std::vector<std::uint8_t> on;
    bool self = false, enabled = true, doubles = false;
    std::vector<float> floats; // what the grid reads unless `doubles`
    vox_filter filter{};
    vox_body id = VOX_NULL_BODY;

    Vec3d at(std::uint32_t v) const {
        const double* p = &positions[3 * v];
        return doubles ? Vec3d{p[0], p[1], p[2]} : Vec3d{floats[3 * v], floats[3 * v + 1], floats[3 * v + 2]};
    }
    std::uint32_t vertex_count() const { return static_cast<std::uint32_t>(positions.size() / 3); }
    std::uint32_t tet_count() const { return static_cast<std::uint32_t>(tets.size() / 4); }
    void round() { floats.assign(positions.begin(), positions.end()); }
};

using Edge = std::array<std::uint32_t, 2>;
using Face = std::array<std::uint32_t, 3>;

struct SurfaceOf {
    std::set<Edge> edges;
    std::map<Face, Edge> faces; // the tet behind and its apex
};

SurfaceOf surface_of(const TestMesh& mesh) {
    std::map<Face, std::map<std::uint32_t, std::uint32_t>> tet_of; // by the opposite vertex, the lowest
    for (std::uint32_t t = 0; t < mesh.tet_count(); ++t) {
        const std::uint32_t* v = &mesh.tets[4 * t];
        if (!mesh.on[t] || std::set<std::uint32_t>(v, v + 4).size() < 4) continue;
        for (int i = 0; i < 4; ++i) {
            Face face;
            for (int j = 0, k = 0; j < 4; ++j)
                if (j != i) face[static_cast<std::size_t>(k++)] = v[j];
            std::sort(face.begin(), face.end());
            tet_of[face].emplace(v[i], t);
        }
    }
    SurfaceOf surface;
    for (const auto& [face, tets] : tet_of) {
        if (tets.size() != 1) continue;
        surface.faces[face] = {tets.begin()->second, tets.begin()->first};
        surface.edges.insert({face[0], face[1]});
        surface.edges.insert({face[0], face[2]});
        surface.edges.insert({face[1], face[2]});
    }
    return surface;
}

struct Expected {
    std::size_t a, b; // meshes
    Edge edge;
    Face face;
    std::uint32_t tet, apex;
    Crossing crossing;
};

using Near = std::vector<std::set<std::uint32_t>>; // vertices within the rings of each

Near rings_of(const TestMesh& mesh) {
    Near near(mesh.vertex_count());
    for (std::uint32_t v = 0; v < near.size(); ++v) near[v] = {v};
    for (std::uint32_t k = 0; k < mesh.filter.self_rings; ++k) {
        const Near before = near;
        for (std::uint32_t t = 0; t < mesh.tet_count(); ++t) {
            if (!mesh.on[t]) continue;
            for (int i = 0; i < 4; ++i)
                for (int j = 0; j < 4; ++j) {
                    const auto& more = before[mesh.tets[4 * t + static_cast<std::uint32_t>(j)]];
                    near[mesh.tets[4 * t + static_cast<std::uint32_t>(i)]].insert(more.begin(), more.end());
                }
        }
    }
    return near;
}

bool may_collide(const TestMesh& a, const TestMesh& b) {
    if (a.filter.group != 0 && a.filter.group == b.filter.group) return a.filter.group > 0;
    const std::uint64_t all = ~std::uint64_t{0};
    return ((b.filter.mask ? b.filter.mask : all) & 1) != 0 &&
           ((a.filter.mask ? a.filter.mask : all) & 1) != 0;
}

std::vector<Expected> brute_force(const std::vector<TestMesh>& meshes, const std::set<Edge>& exceptions) {
    std::vector<SurfaceOf> surfaces;
    for (const TestMesh& mesh : meshes) surfaces.push_back(surface_of(mesh));
    std::vector<Expected> all;
    std::uint64_t exact_tests = 0;
    for (std::size_t a = 0; a < meshes.size(); ++a) {
        const Near near = meshes[a].self && meshes[a].filter.self_rings ? rings_of(meshes[a]) : Near();
        for (const Edge& edge : surfaces[a].edges)
            for (std::size_t b = 0; b < meshes.size(); ++b) {
                if (!meshes[a].enabled || !meshes[b].enabled) continue;
                if (a == b ? !meshes[a].self : !may_collide(meshes[a], meshes[b])) continue;
                const auto low = static_cast<std::uint32_t>(std::min(a, b)),
                           high = static_cast<std::uint32_t>(std::max(a, b));
                if (exceptions.count({low, high})) continue;
                for (const auto& of : surfaces[b].faces) {
                    const Face& face = of.first;
                    const Edge& behind = of.second;
                    const auto names = [&](std::uint32_t v) {
                        return face[0] == v || face[1] == v || face[2] == v;
                    };
                    if (a == b && (names(edge[0]) || names(edge[1]))) continue;
                    const Crossing crossing =
                        find_crossing(meshes[a].at(edge[0]), meshes[a].at(edge[1]), meshes[b].at(face[0]),
                                      meshes[b].at(face[1]), meshes[b].at(face[2]), exact_tests);
                    if (crossing.kind == CrossingKind::none) continue;
                    if (a == b && !near.empty()) {
                        const std::uint32_t* corners = &meshes[b].tets[4 * behind[0]];
                        if (std::any_of(corners, corners + 4, [&](std::uint32_t c) {
                                return near[edge[0]].count(c) || near[edge[1]].count(c);
                            }))
                            continue;
                    }
                    all.push_back({a, b, edge, face, behind[0], behind[1], crossing});
                }
            }
    }
    return all;
}

Vec3d minus(const Vec3d& a, const Vec3d& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
double dotted(const Vec3d& a, const Vec3d& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

void check_normal(const vox_constraint& c, const TestMesh& b, std::uint32_t apex) {
    const std::uint32_t* const face = c.vertices + 2;
    const Vec3d n{c.normal[0], c.normal[1], c.normal[2]};
    const Vec3d u = minus(b.at(face[1]), b.at(face[0])), v = minus(b.at(face[2]), b.at(face[0]));
    const double size = std::max({1e-300, std::sqrt(dotted(u, u)), std::sqrt(dotted(v, v))});
    const Vec3d cross{u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
    if (std::sqrt(dotted(cross, cross)) <= 1e-9 * size * size) return;
    ck_assert_double_le(std::abs(dotted(n, u)), 1e-6 * size);
    ck_assert_double_le(std::abs(dotted(n, v)), 1e-6 * size);
    ck_assert(dotted(n, cross) > 0);
    const Vec3d in = minus(b.at(apex), b.at(face[0]));
    if (std::abs(dotted(n, in)) > 1e-9 * size) ck_assert(dotted(n, in) < 0);
}

void check_edges(const vox_grid* grid, const std::vector<TestMesh>& meshes, std::vector<Expected> expected,
                 bool with_depth) {
    const auto order = [&](const Expected& e) {
        const vox_body a = meshes[e.a].id, b = meshes[e.b].id;
        return std::tuple(std::min(a, b), std::max(a, b), a, e.edge, e.face);
    };
    std::ranges::sort(expected, {}, order);
    const vox_constraint_view view = checked_constraints(grid);
    std::vector<vox_constraint> found;
    std::copy_if(view.data, view.data + view.count, std::back_inserter(found),
                 [](const vox_constraint& c) { return c.kind == VOX_CONSTRAINT_EDGE; });
    ck_assert_uint_eq(found.size(), expected.size());
    ck_assert_uint_eq(counters_of(grid).edge_contacts, expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
        const vox_constraint& c = found[i];
        const Expected& e = expected[i];
        ck_assert(c.body_a == meshes[e.a].id && c.body_b == meshes[e.b].id);
        ck_assert(c.vertices[0] == e.edge[0] && c.vertices[1] == e.edge[1]);
        Face face{c.vertices[2], c.vertices[3], c.vertices[4]};
        ck_assert(face[0] < face[1] && face[0] < face[2]);
        const bool swapped = face[1] > face[2];
        std::sort(face.begin(), face.end());
        ck_assert(face == e.face);
        ck_assert_uint_eq(c.element_b, e.tet);
        ck_assert_mem_eq(c.weights, e.crossing.edge_weights.data(), 2 * sizeof(double));
        std::array<double, 3> weights = e.crossing.face_weights;
        if (swapped) std::swap(weights[1], weights[2]);
        for (std::size_t w = 0; w < 3; ++w) ck_assert_double_eq(c.weights[2 + w], -weights[w]);
        ck_assert_mem_eq(c.position, &e.crossing.position, sizeof c.position);
        const bool through = e.crossing.kind == CrossingKind::through;
        if (!through)
            ck_assert_int_eq(c.state, VOX_DEPTH_TOUCHING);
        else if (!with_depth)
            ck_assert_int_eq(c.state, VOX_DEPTH_UNKNOWN);
        else if (c.gap < 0)
            ck_assert_int_eq(c.state, e.a == e.b ? VOX_DEPTH_PLANE : VOX_DEPTH_CLOSEST);
        else
            ck_assert_int_eq(c.state, VOX_DEPTH_TOUCHING);
        if (!through || c.state == VOX_DEPTH_PLANE) check_normal(c, meshes[e.b], e.apex);
    }
}

// Pairs of bodies that touch, by contacts or edges, and what they did in the step before.
void check_pairs(const vox_grid* grid, const std::vector<TestMesh>& meshes,
                 const std::vector<Expected>& expected, std::set<Edge>& last) {
    std::set<Edge> touching;
    for (const Expected& e : expected)
        touching.insert({std::min(meshes[e.a].id, meshes[e.b].id), std::max(meshes[e.a].id, meshes[e.b].id)});
    const vox_contact_view contacts = contacts_of(grid);
    for (std::uint64_t i = 0; i < contacts.count; ++i)
        touching.insert({std::min(contacts.data[i].body_a, contacts.data[i].body_b),
                         std::max(contacts.data[i].body_a, contacts.data[i].body_b)});
    std::set<Edge> all = touching;
    all.insert(last.begin(), last.end());
    const vox_pair_view pairs = pairs_of(grid);
    ck_assert_uint_eq(pairs.count, all.size());
    std::uint64_t first = 0;
    auto next = all.begin();
    for (std::uint64_t i = 0; i < pairs.count; ++i, ++next) {
        const vox_pair& pair = pairs.data[i];
        ck_assert(*next == Edge({pair.body_a, pair.body_b}));
        ck_assert_int_eq(pair.state, !touching.count(*next) ? VOX_PAIR_ENDED
                                     : last.count(*next)    ? VOX_PAIR_PERSISTED
                                                            : VOX_PAIR_BEGAN);
        if (pair.contact_count > 0) ck_assert_uint_eq(pair.first_contact, first);
        first += pair.contact_count;
    }
    ck_assert_uint_eq(first, contacts.count);
    last = touching;
}

// ---- scenes ---------------------------------------------------------------------------------------

void place(TestMesh& mesh, Random& r, double spread, bool on_lattice) {
    double m[3][3], at[3];
    for (int i = 0; i < 3; ++i) {
        at[i] = on_lattice ? double(r.below(3)) : spread * (2 * r.unit() - 1);
        for (int j = 0; j < 3; ++j) m[i][j] = on_lattice ? double(i == j) : 2 * r.unit() - 1;
    }
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
        double* p = &mesh.positions[3 * v];
        const double q[3] = {p[0], p[1], p[2]};
        for (int i = 0; i < 3; ++i) p[i] = m[i][0] * q[0] + m[i][1] * q[1] + m[i][2] * q[2] + at[i];
    }
    mesh.round();
}

// A block of cubes, or tets between random points.
TestMesh make_mesh(Random& r, bool on_lattice) {
    TestMesh mesh;
    if (r.below(3) > 0) {
        body b = make_block(r.below(2) ? &five_cut : &five_cut_exchanged, 1 + r.below(4), 1 + r.below(2),
                            1 + r.below(2));
        if (!on_lattice) jitter_body(&b, 0.2, r.next());
        mesh.positions.assign(b.positions, b.positions + 3 * b.vertex_count);
        mesh.tets.assign(b.tets, b.tets + 4 * b.tet_count);
        free_body(&b);
    } else {
        const std::uint32_t vertices = 4 + r.below(9), tets = 1 + r.below(12);
        for (std::uint32_t i = 0; i < 3 * vertices; ++i)
            mesh.positions.push_back(on_lattice ? double(r.below(4)) : 3 * r.unit());
        for (std::uint32_t i = 0; i < 4 * tets; ++i) mesh.tets.push_back(r.below(vertices));
    }
    mesh.on.assign(mesh.tet_count(), 1);
    mesh.self = r.below(2) == 0;
    mesh.doubles = r.below(3) == 0;
    if (mesh.self && r.below(4) == 0) mesh.filter.self_rings = 1 + r.below(2);
    if (r.below(6) == 0) mesh.filter.group = static_cast<std::int32_t>(r.below(3)) - 1;
    if (r.below(6) == 0) mesh.filter.mask = ~std::uint64_t{0} << r.below(2);
    mesh.filter.flags = mesh.self ? std::uint32_t{VOX_FILTER_SELF_COLLISION} : 0u;
    place(mesh, r, 2, on_lattice);
    return mesh;
}

vox_body insert(vox_grid* grid, const TestMesh& mesh) {
    vox_mesh_desc desc = mesh.doubles ? vox_mesh_desc_doubles(mesh.positions.data(), mesh.vertex_count(),
                                                              mesh.tets.data(), mesh.tet_count())
                                      : vox_mesh_desc_floats(mesh.floats.data(), mesh.vertex_count(),
                                                             mesh.tets.data(), mesh.tet_count());
    desc.filter = mesh.filter;
    return insert_mesh(grid, &desc);
}

std::uint64_t counts[3], by_edges_alone, carried;

// A scene that changes from step to step, in grids of both engines and several workers.
void run_scene(std::uint64_t seed, int steps) {
    Random r{seed};
    const bool on_lattice = r.below(2) == 0;
    std::vector<TestMesh> meshes;
    const std::uint32_t count = 2 + r.below(4);
    for (std::uint32_t i = 0; i < count; ++i) meshes.push_back(make_mesh(r, on_lattice));
    constexpr int grid_count = 3;
    vox_grid* grids[grid_count];
    std::set<Edge> exceptions, touched[grid_count];
    const bool with_depth = seed % 2 != 0;
    for (int g = 0; g < grid_count; ++g) {
        vox_grid_desc desc = vox_default_grid_desc();
        desc.flags = VOX_GRID_EDGES | (with_depth ? std::uint32_t{VOX_GRID_CONSTRAINTS} : 0u);
        use_engine(&desc, g == 0 ? ENGINE_REFERENCE : ENGINE_FAST);
        desc.worker_count = g == 2 ? 3 : 1;
        grids[g] = grid_of(&desc);
        for (TestMesh& mesh : meshes) mesh.id = insert(grids[g], mesh);
    }
    for (int step = 0; step < steps; ++step) {
        const std::vector<Expected> expected = brute_force(meshes, exceptions);
        for (int g = 0; g < grid_count; ++g) {
            ck_ok(vox_grid_step(grids[g]));
            vox_constraint_desc bare = vox_default_constraint_desc();
            bare.method = VOX_DEPTH_METHOD_NONE;
            if (!with_depth) ck_ok(vox_grid_find_constraints(grids[g], &bare));
            check_edges(grids[g], meshes, expected, with_depth);
            check_pairs(grids[g], meshes, expected, touched[g]);
            const vox_constraint_view found = constraints_of(grids[g]), first = constraints_of(grids[0]);
            ck_assert_uint_eq(found.count, first.count);
            if (found.count > 0) ck_assert_mem_eq(found.data, first.data, found.count * sizeof *found.data);
        }
        for (const Expected& e : expected) ++counts[static_cast<int>(e.crossing.kind) - 1];
        carried += counters_of(grids[1]).carried_edge_contacts;
        by_edges_alone += !expected.empty() && contacts_of(grids[0]).count == 0;

        // Some change, most rest.
        const std::uint32_t m = r.below(count);
        TestMesh& mesh = meshes[m];
        const auto in_all = [&](auto&& change) {
            for (vox_grid* grid : grids) ck_ok(change(grid));
        };
        switch (r.below(8)) {
        case 0: { // an edit
            const std::uint32_t tet = r.below(mesh.tet_count());
            mesh.on[tet] = !mesh.on[tet];
            const std::uint32_t list[1] = {tet};
            in_all([&](vox_grid* g) { return vox_mesh_set_tets_enabled(g, mesh.id, list, 1, mesh.on[tet]); });
            break;
        }
        case 1:
            mesh.enabled = !mesh.enabled;
            in_all([&](vox_grid* g) { return vox_body_set_enabled(g, mesh.id, mesh.enabled); });
            break;
        case 2: {
            const std::uint32_t other = r.below(count);
            if (other == m) break;
            const Edge pair{std::min(m, other), std::max(m, other)};
            const bool on = exceptions.erase(pair) == 1;
            if (!on) exceptions.insert(pair);
            in_all([&](vox_grid* g) {
                return vox_grid_set_pair_enabled(g, meshes[pair[0]].id, meshes[pair[1]].id, on);
            });
            break;
        }
        case 3:
            break; // all rest
        default:
            place(mesh, r, 1, on_lattice);
        }
    }
    for (vox_grid* grid : grids) vox_grid_destroy(grid);
}

START_TEST(random_scenes_equal_the_definition) {
    const std::uint64_t scenes = volume_from("VOX_EDGE_SCENES", 100);
    for (std::uint64_t s = 1; s <= scenes; ++s) run_scene(s, 6);
    for (const std::uint64_t count : counts) ck_assert_uint_gt(count, 1000);
    ck_assert_uint_gt(by_edges_alone, 10);
    ck_assert_uint_gt(carried, 1000);
}
END_TEST

// Bodies of many tiles, deep in each other, and lightly in contact; self-contact of a folded one.
START_TEST(large_bodies_equal_the_definition) {
    for (int kind = 0; kind < 3; ++kind) {
        std::vector<TestMesh> meshes(kind == 2 ? 1 : 2);
        for (std::size_t i = 0; i < meshes.size(); ++i) {
            body b = make_lattice_ball(&five_cut, 7, 7);
            jitter_body(&b, kind == 2 ? 0.9 : 0.1, i + 1);
            move_body(&b, kind == 0 ? 13.1 * double(i) : 3.3 * double(i), 0.123 * double(i),
                      0.271 * double(i));
            meshes[i].positions.assign(b.positions, b.positions + 3 * b.vertex_count);
            meshes[i].tets.assign(b.tets, b.tets + 4 * b.tet_count);
            meshes[i].on.assign(b.tet_count, 1);
            meshes[i].self = kind == 2;
            meshes[i].filter.flags = kind == 2 ? std::uint32_t{VOX_FILTER_SELF_COLLISION} : 0u;
            meshes[i].round();
            free_body(&b);
        }
        const std::vector<Expected> expected = brute_force(meshes, {});
        ck_assert_uint_gt(expected.size(), 100);
        for (const std::uint32_t workers : {1u, 4u}) {
            vox_grid_desc desc = vox_default_grid_desc();
            desc.flags = VOX_GRID_EDGES | VOX_GRID_CONSTRAINTS;
            desc.worker_count = workers;
            vox_grid* grid = grid_of(&desc);
            for (TestMesh& mesh : meshes) mesh.id = insert(grid, mesh);
            ck_ok(vox_grid_step(grid));
            check_edges(grid, meshes, expected, true);
            vox_grid_destroy(grid);
        }
    }
}
END_TEST

// ---- slivers ----------------------------------------------------------------------------------------

// Long thin tetrahedra side by side, turned by `angle`, some of them flat, some twice, under one rotation;
// twisted into a fan.
TestMesh make_slivers(Random& r, double length, double angle, double height, const double (&turn)[3],
                      double scale, double twist = 0) {
    TestMesh mesh;
    mesh.doubles = r.below(2) == 0;
    const double thick = r.below(3) > 0 ? 0.3 * r.unit() : 0, slope = r.below(2) ? 0.1 * r.unit() : 0;
    std::uint64_t same = 0;
    for (int i = 0; i < 48; ++i) {
        if (r.below(8) > 0) same = r.next();
        Random own{same};
        const double y = i - 24.0, tilt = slope * (own.unit() - 0.5);
        const double corners[4][3] = {
            {-0.5, -0.4, 0}, {-0.5, 0.4, 0}, {0.5, tilt, -thick}, {0.5, tilt, thick}};
        for (const auto& corner : corners) {
            double p[3] = {length * corner[0], y + corner[1], height + corner[2]};
            p[2] += twist * p[0] * p[1];
            for (std::size_t axis = 0; axis < 4; ++axis) { // about z, then about each axis
                const double by = axis == 0 ? angle : turn[axis - 1], c = std::cos(by), s = std::sin(by);
                double &u = p[axis % 3], &v = p[(axis + 1) % 3];
                std::tie(u, v) = std::pair(c * u - s * v, s * u + c * v);
            }
            for (const double x : p) mesh.positions.push_back(scale * x);
        }
        const auto v = static_cast<std::uint32_t>(4 * i);
        for (std::uint32_t k = r.below(8) ? 1 : 2; k > 0; --k)
            mesh.tets.insert(mesh.tets.end(), {v, v + 1, v + 2, v + 3});
    }
    mesh.on.assign(mesh.tet_count(), 1);
    mesh.round();
    return mesh;
}

struct BoxOf {
    Vec3d min, max;
};

// How many features there are whose boxes, `reach` apart, overlap; and the proximities, by definition.
struct Slivers {
    std::uint64_t edge_pairs = 0, face_pairs = 0;
    std::map<std::array<std::uint32_t, 3>, double> near; // distance of body_a, vertex, body_b

    Slivers(const vox_grid* grid, const std::vector<TestMesh>& meshes, double margin) {
        const vox_contact_view contacts = contacts_of(grid);
        for (std::size_t a = 0; a < 2; ++a) {
            const TestMesh &of_a = meshes[a], &of_b = meshes[1 - a];
            const SurfaceOf from = surface_of(of_a), surface = surface_of(of_b);
            for (const auto& [face, behind] : surface.faces) {
                const Vec3d u = of_b.at(face[0]), v = of_b.at(face[1]), w = of_b.at(face[2]);
                const BoxOf box{min(min(u, v), w), max(max(u, v), w)};
                const auto overlaps = [&](const Vec3d& p, const Vec3d& q, double reach) {
                    const Vec3d lo = min(p, q) - box.max, hi = box.min - max(p, q);
                    return std::max({lo.x, lo.y, lo.z, hi.x, hi.y, hi.z}) <= reach;
                };
                for (const Edge& edge : from.edges)
                    edge_pairs += overlaps(of_a.at(edge[0]), of_a.at(edge[1]), 0);
                for (std::uint32_t i = 0; i < of_a.vertex_count(); ++i) {
                    const Vec3d p = of_a.at(i);
                    if (!overlaps(p, p, margin)) continue;
                    ++face_pairs;
                    const double squared = std::max(closest_seen_from(p, u, v, w).at.squared_distance,
                                                    squared_distance_bound(p, box));
                    if (squared > margin * margin) continue;
                    const auto at = near.emplace(std::array{of_a.id, i, of_b.id}, HUGE_VAL).first;
                    at->second = std::min(at->second, std::sqrt(squared));
                }
            }
        }
        for (std::uint64_t i = 0; i < contacts.count; ++i)
            near.erase({contacts.data[i].body_a, contacts.data[i].vertex, contacts.data[i].body_b});
    }
};

// Edges that end in a face with two corners that a difference to the third one does not tell apart.
START_TEST(normals_of_mixed_coordinates) {
    for (std::uint32_t first = 0; first < 3; ++first) {
        std::vector<TestMesh> meshes(2);
        meshes[0].positions = {5e29, 0, 5e29, 5e29, -1e30, 5e29, 2e30, -1e30, 0, 2e30, -1e30, 1e30};
        const double corners[3][3] = {{1e30, 0, 1e30}, {1e-30, 0, 0}, {0, 0, 1e-30}};
        for (std::uint32_t i = 0; i < 3; ++i) {
            const double(&c)[3] = corners[(first + i) % 3];
            meshes[1].positions.insert(meshes[1].positions.end(), c, c + 3);
        }
        for (const double apex : {0.0, 1e30, 0.0}) meshes[1].positions.push_back(apex);
        vox_grid_desc desc = vox_default_grid_desc();
        desc.flags = VOX_GRID_EDGES;
        vox_grid* const grid = grid_of(&desc);
        for (TestMesh& mesh : meshes) {
            mesh.tets = {0, 1, 2, 3};
            mesh.doubles = true;
            mesh.id = insert(grid, mesh);
        }
        ck_ok(vox_grid_step(grid));
        vox_constraint_desc bare = vox_default_constraint_desc();
        bare.method = VOX_DEPTH_METHOD_NONE;
        ck_ok(vox_grid_find_constraints(grid, &bare));
        const vox_constraint_view view = constraints_of(grid);
        int found = 0;
        for (std::uint64_t i = 0; i < view.count; ++i) {
            const vox_constraint& c = view.data[i];
            const std::uint32_t* const v = c.vertices;
            if (c.kind != VOX_CONSTRAINT_EDGE || c.body_a != meshes[0].id || v[0] != 0 ||
                v[2] + v[3] + v[4] != 3)
                continue;
            ck_assert_double_eq_tol(c.normal[1], -1, 1e-9);
            ++found;
        }
        ck_assert_int_eq(found, 3);
        vox_grid_destroy(grid);
    }
}
END_TEST

// Sheets of slivers across each other, near the ends of what floats hold, too: the boxes of nearly all
// features overlap, and few are decided.
START_TEST(slivers_equal_the_definition) {
    std::uint64_t edges = 0, near = 0, edge_candidates = 0, face_candidates = 0, edge_pairs = 0,
                  face_pairs = 0, fan_candidates = 0, fan_pairs = 0;
    for (std::uint64_t seed = 1; seed <= 48; ++seed) {
        const bool is_fan = seed > 32; // rulings of one saddle, in each other
        Random r{seed};
        const double length = std::pow(10, 1.5 + 1.5 * r.unit()),
                     turn[3] = {3 * r.unit(), 3 * r.unit(), 3 * r.unit()};
        const double scale = seed % 4 == 0   ? 5e35
                             : seed % 4 == 1 ? 1e-30
                                             : 1,
                     margin = scale * r.unit(), height = r.below(6) ? 0.6 + r.unit() : 0.1;
        std::vector<TestMesh> meshes{make_slivers(r, length, 0, 0, turn, scale),
                                     make_slivers(r, length, 1.5 * r.unit(), height, turn, scale)};
        if (is_fan) {
            const double twist = 0.002 + 0.01 * r.unit();
            meshes = {make_slivers(r, 49, 0, 0, turn, scale, twist),
                      make_slivers(r, 49, 0.5 * std::numbers::pi, height, turn, scale, -twist)};
        }
        const std::vector<Expected> expected = brute_force(meshes, {});
        for (const std::uint32_t workers : {1u, 3u}) {
            vox_grid_desc desc = vox_default_grid_desc();
            desc.flags = VOX_GRID_EDGES;
            desc.margin = margin;
            desc.worker_count = workers;
            vox_grid* const grid = grid_of(&desc);
            for (TestMesh& mesh : meshes) mesh.id = insert(grid, mesh);
            ck_ok(vox_grid_step(grid));
            vox_constraint_desc bare = vox_default_constraint_desc();
            bare.method = VOX_DEPTH_METHOD_NONE;
            ck_ok(vox_grid_find_constraints(grid, &bare));
            check_edges(grid, meshes, expected, false);
            const Slivers slivers(grid, meshes, margin);
            const vox_constraint_view view = constraints_of(grid);
            std::size_t found = 0;
            for (std::uint64_t i = 0; i < view.count; ++i) {
                const vox_constraint& c = view.data[i];
                if (c.kind != VOX_CONSTRAINT_PROXIMITY) continue;
                const auto at = slivers.near.find({c.body_a, c.vertices[0], c.body_b});
                ck_assert(at != slivers.near.end());
                ck_assert_double_eq_tol(c.gap, at->second, 1e-9 * scale);
                ++found;
            }
            ck_assert_uint_eq(found, slivers.near.size());
            edges += expected.size();
            near += found;
            face_pairs += slivers.face_pairs;
            (is_fan ? fan_pairs : edge_pairs) += slivers.edge_pairs;
            (is_fan ? fan_candidates : edge_candidates) += counters_of(grid).edge_candidates;
            face_candidates += counters_of(grid).face_candidates;
            vox_grid_destroy(grid);
        }
    }
    ck_assert_uint_gt(edges, 1000);
    ck_assert_uint_gt(near, 300);
    ck_assert_uint_lt(100 * edge_candidates, edge_pairs);
    ck_assert_uint_gt(fan_pairs, 1000000);
    ck_assert_uint_lt(20 * fan_candidates, fan_pairs);
    ck_assert_uint_lt(5 * face_candidates, face_pairs);
}
END_TEST

} // namespace

SUITE(edge_definition) {
    TCase* tests = add_case(suite, "definition");
    tcase_add_each(tests, random_scenes_equal_the_definition, large_bodies_equal_the_definition,
                   slivers_equal_the_definition, normals_of_mixed_coordinates);
}
