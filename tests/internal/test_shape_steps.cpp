// Steps with rigid shapes against loops over all vertices: nothing that is inside, near or went through is
// left out, whatever the transforms, the formats, the engine, the workers and the level of SIMD.
#include "base/simd.hpp"
#include "base/vectors.hpp"
#include "internal/random.hpp"
#include "scenes/bodies.h"
#include "shape/shape.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <memory_resource>
#include <string>
#include <vector>

#include "support/suite.h" // last: it defines macros with common names

using namespace vox;

namespace {

using Matrix = std::array<double, 12>;

double symmetric(Random& random) { return 2 * random.unit() - 1; }

// A rotation, rounded to `noise`, times a scale; moves to `to`.
Matrix any_place(Random& random, double scale, double noise, const Vec3d& to) {
    double q[4], length = 0;
    for (double& x : q) {
        x = symmetric(random);
        length += x * x;
    }
    for (double& x : q) x /= std::sqrt(length);
    const auto [w, x, y, z] = q;
    const double turn[9] = {1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),
                            2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
                            2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y)};
    Matrix m;
    for (std::size_t i = 0; i < 9; ++i) m[i / 3 * 4 + i % 3] = scale * (turn[i] + noise * symmetric(random));
    m[3] = to.x, m[7] = to.y, m[11] = to.z;
    return m;
}

Vec3d transformed(const Matrix& m, const Vec3d& p) {
    return {((m[0] * p.x + m[1] * p.y) + m[2] * p.z) + m[3], ((m[4] * p.x + m[5] * p.y) + m[6] * p.z) + m[7],
            ((m[8] * p.x + m[9] * p.y) + m[10] * p.z) + m[11]};
}

// ---- a scene --------------------------------------------------------------------------------------

// Of a ring around the z axis: not convex.
void ring(const double* points, std::uint64_t count, double* distances, double* gradients, void* user) {
    const double radius = *static_cast<const double*>(user);
    for (std::uint64_t i = 0; i < count; ++i) {
        const double x = points[3 * i], y = points[3 * i + 1], z = points[3 * i + 2], flat = std::hypot(x, y);
        const double out = flat - radius;
        distances[i] = std::hypot(out, z) - 0.4 * radius;
        gradients[3 * i] = flat > 0 ? x / flat * out : 0;
        gradients[3 * i + 1] = flat > 0 ? y / flat * out : 0;
        gradients[3 * i + 2] = z;
    }
}

struct Shape {
    vox_shape_desc desc = vox_default_shape_desc();
    std::vector<double> points, heights;
    std::vector<std::uint32_t> triangles;
    std::shared_ptr<const RigidShape> rigid;
    Matrix now, before;
    bool moves = false;
    vox_body id = VOX_NULL_BODY;
};

// About as large as `size`.
Shape any_shape(vox_shape_kind kind, double size, Random& random) {
    Shape s;
    vox_shape_desc& d = s.desc;
    d.kind = kind;
    d.radius = kind == VOX_SHAPE_SHEET ? (random.below(2) ? 0 : 0.05 * size) : size * random.unit();
    d.half_length = size * random.unit();
    for (double& half : d.half_size) half = size * random.unit();
    if (kind == VOX_SHAPE_HEIGHTFIELD) {
        d.columns = 3 + random.below(6);
        d.rows = 3 + random.below(6);
        d.spacing[0] = size / d.columns;
        d.spacing[1] = size / d.rows;
        for (std::uint32_t i = 0; i < d.columns * d.rows; ++i)
            s.heights.push_back(0.3 * size * random.unit());
    }
    if (kind == VOX_SHAPE_SOLID || kind == VOX_SHAPE_SHEET) {
        for (int i = 0; i < 18; ++i) s.points.push_back(size * symmetric(random));
        for (std::uint32_t i = 0; i < (kind == VOX_SHAPE_SOLID ? 8 : 4); ++i) {
            const std::uint32_t x = i & 1, y = 2 + (i >> 1 & 1), z = 4 + (i >> 2);
            const bool is_odd = ((i ^ i >> 1 ^ i >> 2) & 1) != 0;
            for (const std::uint32_t v : {is_odd ? y : x, is_odd ? x : y, z}) s.triangles.push_back(v);
        }
        if (kind == VOX_SHAPE_SHEET && random.below(2)) // a needle beside
            for (const std::uint32_t v : {3u, 5u, 5u}) s.triangles.push_back(v);
    }
    double volume = 0;
    for (std::size_t t = 0; kind == VOX_SHAPE_SOLID && t < s.triangles.size(); t += 3) {
        const auto corner = [&](std::size_t i) { return s.points.data() + 3 * s.triangles[t + i]; };
        const auto vector = [](const double* p) { return Vec3d{p[0], p[1], p[2]}; };
        volume += determinant(vector(corner(0)), vector(corner(1)), vector(corner(2)));
    }
    for (std::size_t t = 0; volume < 0 && t < s.triangles.size(); t += 3) // inside out
        std::swap(s.triangles[t], s.triangles[t + 1]);
    static const double ring_radius = 1; // alike for all sizes
    d.field = ring;
    d.field_user = const_cast<double*>(&ring_radius);
    if (kind == VOX_SHAPE_FIELD) std::ranges::fill(d.half_size, 1.5);
    d.positions = vox_double_positions(s.points.data(), s.points.size() / 3);
    d.triangles = s.triangles.data();
    d.triangle_count = s.triangles.size() / 3;
    d.heights = s.heights.data();
    s.rigid = make_shape(d, std::pmr::get_default_resource());
    return s;
}

struct Mesh {
    std::vector<double> now, before; // x y z each
    std::vector<float> single;
    std::vector<std::uint32_t> tets;
    bool is_single = false, moves = false, is_placed = false;
    Matrix place;
    vox_body id = VOX_NULL_BODY;

    std::uint32_t count() const { return static_cast<std::uint32_t>(now.size() / 3); }
    Vec3d end(std::uint32_t v) const {
        const Vec3d p{now[3 * v], now[3 * v + 1], now[3 * v + 2]};
        return is_placed ? transformed(place, p) : p;
    }
    Vec3d begin(std::uint32_t v) const {
        return moves ? Vec3d{before[3 * v], before[3 * v + 1], before[3 * v + 2]} : end(v);
    }
};

Mesh any_mesh(const Vec3d& centre, double size, Random& random) {
    body ball = make_lattice_ball(&five_cut, 4, 4);
    jitter_body(&ball, 0.2, random.next());
    Mesh m;
    m.is_single = random.below(2) != 0;
    m.tets.assign(ball.tets, ball.tets + 4 * ball.tet_count);
    if (random.below(4) == 0) m.tets.clear(); // points
    for (std::uint32_t i = 0; i < 3 * ball.vertex_count; ++i) {
        const double at = i % 3 == 0 ? centre.x : i % 3 == 1 ? centre.y : centre.z;
        m.now.push_back(at + size * ball.positions[i] / 4);
        m.single.push_back(static_cast<float>(m.now.back()));
        if (m.is_single) m.now.back() = m.single.back();
    }
    free_body(&ball);
    return m;
}

struct Scene {
    std::vector<Mesh> meshes;
    std::vector<Shape> shapes;
    double margin = 0, size = 1, most = 1; // `most`: the largest coordinate, about
};

Scene any_scene(std::uint64_t seed, bool moves) {
    Random random{seed};
    Scene scene;
    const double sizes[] = {1, 1, 1e-12, 1e6, 1e30, 1}, far[] = {0, 1e6, 0, 3, 0, 1e13};
    const std::size_t pick = seed % 6;
    const double size = scene.size = sizes[pick], at = far[pick] * size;
    scene.most = at + 10 * size;
    scene.margin = random.below(2) ? 0 : 0.2 * size * random.unit();
    const auto around = [&](double reach) {
        return Vec3d{at + reach * size * symmetric(random), reach * size * symmetric(random) - at,
                     reach * size * symmetric(random)};
    };
    for (int i = 0; i < 2; ++i) {
        Mesh m = any_mesh(around(2), size, random);
        if (random.below(3) == 0) {
            m.is_placed = true;
            m.place = any_place(random, 1, 0.1, around(0.5)); // any affine map
            for (std::size_t k = 0; k < 3; ++k)
                m.place[4 * k + 3] -= m.place[4 * k] * at - m.place[4 * k + 1] * at;
        }
        if (moves && random.below(3) != 0) {
            m.moves = true;
            const Vec3d by = around(3);
            for (std::uint32_t v = 0; v < m.count(); ++v) {
                const Vec3d p = m.end(v);
                const double jitter = 0.1 * size;
                m.before.push_back(p.x + (by.x - at) + jitter * symmetric(random));
                m.before.push_back(p.y + (by.y + at) + jitter * symmetric(random));
                m.before.push_back(p.z + by.z + jitter * symmetric(random));
            }
        }
        scene.meshes.push_back(std::move(m));
    }
    for (int kind = VOX_SHAPE_HALF_SPACE; kind <= VOX_SHAPE_FIELD; ++kind) {
        const double scales[] = {1, 1, 0.01, 100}, noises[] = {0, 1e-16, 6e-8, 2e-6};
        const bool is_field = kind == VOX_SHAPE_FIELD;
        const double scale = is_field ? size : scales[random.below(4)], noise = noises[random.below(4)];
        Shape s = any_shape(static_cast<vox_shape_kind>(kind), size / scale, random);
        s.now = any_place(random, scale, noise, around(2));
        s.moves = moves && random.below(2);
        s.before =
            s.moves ? any_place(random, scale * (random.below(2) ? 1 : 1.25), noise, around(2)) : s.now;
        scene.shapes.push_back(std::move(s));
    }
    return scene;
}

vox_grid* grid_with(Scene& scene, const vox_grid_desc& settings) {
    vox_grid_desc desc = settings;
    desc.flags = VOX_GRID_CONSTRAINTS;
    desc.margin = scene.margin;
    vox_grid* grid = grid_of(&desc);
    for (std::size_t i = 0; i < scene.shapes.size() || i < scene.meshes.size(); ++i) {
        if (i < scene.meshes.size()) {
            Mesh& m = scene.meshes[i];
            vox_mesh_desc of =
                vox_mesh_desc_doubles(m.now.data(), m.count(), m.tets.data(), m.tets.size() / 4);
            if (m.is_single) of.positions = vox_float_positions(m.single.data(), m.count());
            m.id = insert_mesh(grid, &of);
            if (m.is_placed) ck_ok(vox_body_set_transform(grid, m.id, m.place.data()));
            if (m.moves) ck_ok(bind_previous_array(grid, m.id, m.before.data(), VOX_FORMAT_DOUBLE, 0, 0));
        }
        if (i >= scene.shapes.size()) continue;
        Shape& s = scene.shapes[i];
        ck_ok(vox_shape_insert(grid, &s.desc, &s.id));
        ck_ok(vox_body_set_transform(grid, s.id, s.now.data()));
        if (s.moves) ck_ok(vox_shape_set_previous_transform(grid, s.id, s.before.data()));
    }
    return grid;
}

std::vector<vox_constraint> constraints_with_shapes(const vox_grid* grid, const Scene& scene) {
    const vox_constraint_view view = constraints_of(grid);
    std::vector<vox_constraint> found;
    for (std::uint64_t i = 0; i < view.count; ++i)
        if (std::ranges::any_of(scene.shapes, [&](const Shape& s) { return s.id == view.data[i].body_b; }))
            found.push_back(view.data[i]);
    return found;
}

const vox_constraint* find(const std::vector<vox_constraint>& all, const Mesh& m, std::uint32_t vertex,
                           const Shape& s) {
    const auto at = std::ranges::find_if(all, [&](const vox_constraint& c) {
        return c.body_a == m.id && c.vertices[0] == vertex && c.body_b == s.id;
    });
    return at == all.end() ? nullptr : &*at;
}

std::string named(const Shape& s, std::uint32_t vertex) {
    return "kind " + std::to_string(s.desc.kind) + ", vertex " + std::to_string(vertex);
}

// ---- at one moment --------------------------------------------------------------------------------

// Constraints of vertices that are inside or near, by a look at each.
std::uint64_t check_places(const vox_grid* grid, const Scene& scene) {
    const std::vector<vox_constraint> all = constraints_with_shapes(grid, scene);
    std::uint64_t expected = 0;
    for (const Mesh& m : scene.meshes)
        for (const Shape& s : scene.shapes) {
            const ShapePlace place(s.now.data());
            for (std::uint32_t v = 0; v < m.count(); ++v) {
                ShapePoint seen;
                const Vec3d x = m.end(v);
                const bool is_near = s.rigid->look(place.to_shape(x), scene.margin / place.scale(), seen);
                const vox_constraint* const c = find(all, m, v, s);
                const bool is_expected = is_near && (seen.is_inside || scene.margin > 0);
                ck_assert_msg(is_expected == (c != nullptr), "%s: %d", named(s, v).c_str(), is_expected);
                expected += is_expected;
                if (!c) continue;
                ck_assert_int_eq(c->kind, seen.is_inside ? VOX_CONSTRAINT_INSIDE : VOX_CONSTRAINT_PROXIMITY);
                ck_assert_int_eq(c->state, c->gap == 0 ? VOX_DEPTH_TOUCHING : VOX_DEPTH_CLOSEST);
                const Vec3d normal = place.to_world(seen.normal);
                ck_assert(c->gap == seen.distance * place.scale() && c->element_b == seen.element);
                ck_assert(c->normal[0] == normal.x && c->normal[1] == normal.y && c->normal[2] == normal.z);
                ck_assert(c->position[0] == x.x && c->position[1] == x.y && c->position[2] == x.z);
                ck_assert(c->count == 1 && c->count_a == 1 && c->weights[0] == 1 && c->time == 1);
                const double at[3] = {x.x, x.y, x.z};
                vox_constraint alone = *c;
                alone.vertices[0] = 0;
                ck_assert_double_eq_tol(vox_constraint_gap(&alone, at, nullptr), c->gap, 1e-15 * scene.most);
            }
        }
    ck_assert_uint_eq(all.size(), expected);
    return expected;
}

START_TEST(every_vertex) {
    std::uint64_t found = 0;
    for (std::uint64_t seed = 1; seed <= volume_from("VOX_SHAPE_SCENES", 24); ++seed) {
        Scene scene = any_scene(seed, false);
        vox_grid* const grid = grid_with(scene, engine_desc());
        for (int step = 0; step < 2; ++step) { // carried over in the second
            ck_ok(vox_grid_step(grid));
            found += check_places(grid, scene);
            if (suite_engine == ENGINE_FAST)
                ck_assert_uint_eq(counter_of(grid, "carried_shape_contacts"),
                                  step ? counter_of(grid, "shape_contacts") : 0);
        }
        for (Mesh& m : scene.meshes) // one moves, and then the other
            for (int i = 0; i < 2; ++i) {
                for (std::uint32_t k = 0; k < m.now.size(); k += 3)
                    m.now[k] = m.single[k] = static_cast<float>(m.now[k] + 0.25 * scene.size);
                ck_ok(vox_grid_step(grid));
                found += check_places(grid, scene);
            }
        Shape& moved = scene.shapes[seed % scene.shapes.size()];
        moved.now[3] += 0.5 * scene.size;
        ck_ok(vox_body_set_transform(grid, moved.id, moved.now.data()));
        ck_ok(vox_grid_step(grid));
        found += check_places(grid, scene);
        vox_grid_destroy(grid);
    }
    ck_assert_uint_gt(found, 5000);
}
END_TEST

// Axes that are off by as much as a transform may be, or rounding errors, far from the shape's origin: small
// meshes near the surface are not taken to be beyond it.
START_TEST(far_along_surfaces) {
    constexpr double off = 9e-6;
    std::uint64_t found = 0;
    for (std::uint64_t seed = 1; seed <= volume_from("VOX_SHAPE_SCENES", 600); ++seed) {
        Random random{seed};
        Scene scene;
        const bool is_off = seed % 8 == 0;
        const double size = is_off ? 1e3 : 1e13, spread = 3e-16 * size;
        scene.most = 4 * size;
        const auto kind = static_cast<vox_shape_kind>(VOX_SHAPE_HALF_SPACE + (is_off ? seed / 8 : seed) % 8);
        Shape s = any_shape(kind, size, random);
        s.now = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
        if (is_off)
            s.now[random.below(3) * 4 + random.below(3)] += random.below(2) ? off : -off;
        else
            s.now = any_place(random, 1, 0, {0, 0, 0});
        s.before = s.now;
        const ShapePlace place(s.now.data());
        for (int i = 0; i < 60 && (is_off || scene.meshes.empty()); ++i) {
            Vec3d p; // on the surface, nearly, by bisection of a way through it
            Vec3d low{2 * size * symmetric(random), 2 * size * symmetric(random),
                      2 * size * symmetric(random)},
                high{2 * size * symmetric(random), 2 * size * symmetric(random),
                     2 * size * symmetric(random)};
            const auto is_inside = [&](const Vec3d& x) {
                ShapePoint seen;
                return s.rigid->look(place.to_shape(x), 0, seen) && seen.is_inside;
            };
            if (is_inside(low) == is_inside(high)) continue;
            for (int k = 0; k < 60; ++k) {
                p = 0.5 * (low + high);
                (is_inside(p) == is_inside(low) ? low : high) = p;
            }
            Mesh m;
            for (int v = 0; v < 2; ++v)
                for (const double x : {p.x, p.y, p.z})
                    m.now.push_back(x + (v ? spread * symmetric(random) : 0));
            scene.meshes.push_back(std::move(m));
        }
        scene.shapes.push_back(std::move(s));
        vox_grid* const grid = grid_with(scene, engine_desc());
        ck_ok(vox_grid_step(grid));
        found += check_places(grid, scene);
        vox_grid_destroy(grid);
    }
    ck_assert_uint_gt(found, 500);
}
END_TEST

// ---- on their way ---------------------------------------------------------------------------------

// When the way from a to b meets the plane of a triangle well within it; 2: it does not.
double crossing(const Vec3d& from, const Vec3d& to, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    const Vec3d way = to - from, normal = cross(b - a, c - a);
    const double speed = dot(way, normal), time = dot(a - from, normal) / speed;
    if (!(time > 1e-9 && time < 1 - 1e-9)) return 2;
    const Vec3d p = from + time * way, corner[3] = {a, b, c};
    for (int i = 0; i < 3; ++i) {
        const Vec3d edge = corner[(i + 1) % 3] - corner[i];
        if (!(dot(cross(edge, p - corner[i]), normal) > 1e-6 * dot(normal, normal))) return 2;
    }
    return time;
}

// A time at which the point, which begins outside, is inside for sure, by samples or by triangles; 2: none.
double meets_by(const Shape& s, const Vec3d& from, const Vec3d& to) {
    constexpr int samples = 300;
    double earliest = 2;
    const auto corner = [&](std::size_t t, std::size_t i) {
        const std::size_t v = 3 * s.triangles[3 * t + i];
        return Vec3d{s.points[v], s.points[v + 1], s.points[v + 2]};
    };
    if (s.desc.kind == VOX_SHAPE_SHEET)
        for (std::size_t t = 0; t < s.triangles.size() / 3; ++t)
            earliest = std::min(earliest, crossing(from, to, corner(t, 0), corner(t, 1), corner(t, 2)));
    for (int i = 1; i <= samples; ++i) {
        const double time = double(i) / samples;
        ShapePoint seen;
        if (time > earliest) break;
        if (s.rigid->look(from + time * (to - from), 0, seen) && seen.is_inside) return time;
    }
    return earliest;
}

std::uint64_t check_ways(const vox_grid* grid, const Scene& scene) {
    const std::vector<vox_constraint> all = constraints_with_shapes(grid, scene);
    std::uint64_t impacts = 0;
    for (const Mesh& m : scene.meshes)
        for (const Shape& s : scene.shapes) {
            const ShapePlace now(s.now.data()), before(s.before.data());
            for (std::uint32_t v = 0; v < m.count(); ++v) {
                const Vec3d from = before.to_shape(m.begin(v)), to = now.to_shape(m.end(v));
                const vox_constraint* const c = find(all, m, v, s);
                ShapePoint seen;
                const bool began_inside = s.rigid->look(from, 0, seen) && seen.is_inside;
                const bool is_near = s.rigid->look(to, scene.margin / now.scale(), seen),
                           ends_inside = is_near && seen.is_inside, is_moving = m.moves || s.moves;
                const double latest = began_inside || !is_moving ? 2 : meets_by(s, from, to);
                ck_assert_msg((c && c->kind == VOX_CONSTRAINT_INSIDE) == ends_inside, "%s",
                              named(s, v).c_str());
                if (!c || c->kind != VOX_CONSTRAINT_IMPACT)
                    ck_assert_int_eq(c != nullptr, ends_inside || (is_near && scene.margin > 0));
                if (latest > 1 || s.desc.kind == VOX_SHAPE_HEIGHTFIELD) {
                    // Through the side of terrain, where there is no surface.
                } else if (ends_inside) {
                    ck_assert_msg(c->time <= latest, "%s: %.17g, %.17g", named(s, v).c_str(), c->time,
                                  latest);
                } else {
                    ck_assert_msg(c && c->kind == VOX_CONSTRAINT_IMPACT, "%s: %g", named(s, v).c_str(),
                                  latest);
                    ck_assert_double_le(c->time, latest + 1e-12);
                }
                if (!c || c->kind == VOX_CONSTRAINT_PROXIMITY) continue;
                if (c->kind == VOX_CONSTRAINT_INSIDE) ck_assert(c->gap == seen.distance * now.scale());
                if (c->time == 1 || began_inside) continue;
                // At that time it is at the surface.
                const double size = scene.most / now.scale();
                ck_assert(s.rigid->look(from + c->time * (to - from), unlimited, seen));
                const double close = s.desc.kind == VOX_SHAPE_FIELD ? 1e-6 : 1e-9; // where it grazes
                ck_assert_msg(std::abs(seen.distance) < close * size, "%s: %g at %g", named(s, v).c_str(),
                              seen.distance / size, c->time);
                if (c->kind != VOX_CONSTRAINT_IMPACT) continue;
                ++impacts;
                const Vec3d normal{c->normal[0], c->normal[1], c->normal[2]},
                    rest = now.scale() * (1 - c->time) * (to - from);
                ck_assert(c->gap < 0 && c->state == VOX_DEPTH_PLANE);
                // In the world, with axes that are off by what rounding does to them.
                const Vec3d in_world = now.to_world(rest);
                ck_assert_double_eq_tol(c->gap, dot(normal, length(rest) * in_world),
                                        1e-4 * std::max(length(rest), scene.size));
            }
        }
    return impacts;
}

START_TEST(every_way) {
    std::uint64_t impacts = 0;
    for (std::uint64_t seed = 1; seed <= volume_from("VOX_SHAPE_SCENES", 12); ++seed) {
        Scene scene = any_scene(seed, true);
        vox_grid* const grid = grid_with(scene, engine_desc());
        ck_ok(vox_grid_step(grid));
        impacts += check_ways(grid, scene);
        vox_grid_destroy(grid);
    }
    ck_assert_uint_gt(impacts, 600);
}
END_TEST

// ---- the same everywhere --------------------------------------------------------------------------

START_TEST(same_bits) {
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        Scene scene = any_scene(seed, seed % 2 == 0);
        std::vector<vox_constraint> first;
        std::vector<vox_pair> pairs;
        for (int run = 0; run < 8; ++run) {
            vox_grid_desc desc = vox_default_grid_desc();
            use_engine(&desc, run == 7 ? ENGINE_REFERENCE : ENGINE_FAST);
            desc.worker_count = run < 4 ? static_cast<std::uint32_t>(run) : 2;
            desc.cell_size = run == 5 ? 0.3 * scene.size : 0;
            simd::force_level(run < 4 ? simd::best_level() : static_cast<simd::Level>(run - 4));
            vox_grid* const grid = grid_with(scene, desc);
            ck_ok(vox_grid_step(grid));
            simd::force_level(simd::best_level());
            const vox_constraint_view view = constraints_of(grid);
            const vox_pair_view touching = pairs_of(grid);
            if (run == 0) {
                first.assign(view.data, view.data + view.count);
                pairs.assign(touching.data, touching.data + touching.count);
            }
            ck_assert_uint_eq(view.count, first.size());
            ck_assert_uint_eq(touching.count, pairs.size());
            ck_assert(view.count == 0 || !std::memcmp(view.data, first.data(), view.count * sizeof first[0]));
            ck_assert(pairs.empty() ||
                      !std::memcmp(touching.data, pairs.data(), pairs.size() * sizeof pairs[0]));
            vox_grid_destroy(grid);
        }
    }
}
END_TEST

void add_tests(TCase* tests) { tcase_add_each(tests, every_vertex, far_along_surfaces, every_way); }

} // namespace

SUITE(shape_steps) {
    add_for_each_engine(suite, add_tests);
    tcase_add_test(add_case(suite, "everywhere"), same_bits);
}
