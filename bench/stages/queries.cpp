// What queries cost: preparing them and taking views, for floats, doubles and a transform, each query, and
// the search for what is worst.
//
//   bench_queries [--tets N] [--rounds K]
//
// Two balls of N / 2 tetrahedra that overlap a little, and move between rounds. Times are the least of K
// rounds in which everything takes turns, on one thread, since what disturbs a machine only adds. Before that
// the answers for small meshes, bad ones among them, are compared with brute force over every tetrahedron.
#include "internal/meshes.hpp"
#include "internal/query_definition.hpp"
#include "program.hpp"
#include "timing.h"

#include <vox/vox.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

namespace {

using bench::must;
using vox::Vec3d;
using vox::test::QueryDefinition;
using vox::test::Shape;

constexpr std::uint64_t all_meshes = UINT64_MAX;

// Of a mesh that stays where it is.
struct Times {
    double point = 1e9, points = 1e9, box = 1e9, closest = 1e9, closest_points = 1e9, path = 1e9, ray = 1e9,
           ray_hits = 1e9, ray_any = 1e9;
};

// Each call for all points, each point as the beginning of a segment to the next one.
void time_queries(const vox_query_view* view, const std::vector<Vec3d>& points, double box_side,
                  Times& times) {
    const std::size_t n = points.size();
    static std::vector<vox_point_hit> hits;
    static std::vector<vox_tet_hit> tets;
    static std::vector<vox_facet_hit> facets;
    std::vector<vox_closest_hit> closest(n);
    std::vector<Vec3d> path; // slowly along the points
    for (std::size_t i = 0; i < n; ++i) {
        const double t = double(i % 100) / 100;
        path.push_back((1 - t) * points[i / 100] + t * points[i / 100 + 1]);
    }
    hits.resize(64 * n);
    tets.resize(65536);
    facets.resize(65536);
    std::uint64_t count = 0;
    std::uint32_t any = 0;
    const auto each = [&](double& least, auto&& ask) {
        least = std::min(least, 1e9 / double(n) * seconds_of([&] {
                                    for (std::size_t i = 0; i < n; ++i)
                                        must(ask(&points[i].x, &points[(i + 1) % n].x));
                                }));
    };
    const auto batch = [&](double& least, auto&& ask) {
        least = std::min(least, 1e9 / double(n) * seconds_of([&] { must(ask()); }));
    };
    each(times.point, [&](const double* p, const double*) {
        return vox_query_view_point(view, p, all_meshes, hits.data(), hits.size(), &count);
    });
    batch(times.points, [&] {
        return vox_query_view_points(view, points.data(), VOX_FORMAT_DOUBLE, 0, n, all_meshes, hits.data(),
                                     hits.size(), &count);
    });
    each(times.box, [&](const double* p, const double*) {
        const double high[3] = {p[0] + box_side, p[1] + box_side, p[2] + box_side};
        return vox_query_view_box(view, p, high, all_meshes, tets.data(), tets.size(), &count);
    });
    each(times.closest, [&](const double* p, const double*) {
        vox_surface_hit hit;
        return vox_query_view_closest(view, p, INFINITY, all_meshes, &hit);
    });
    vox_closest_desc desc = vox_default_closest_desc();
    desc.format = VOX_FORMAT_DOUBLE;
    desc.point_count = n;
    for (const bool follows : {false, true}) {
        desc.points = follows ? path.data() : points.data();
        batch(follows ? times.path : times.closest_points,
              [&] { return vox_query_view_closest_points(view, &desc, closest.data()); });
    }
    each(times.ray, [&](const double* p, const double* q) {
        vox_ray_hit hit;
        return vox_query_view_ray(view, p, q, all_meshes, &hit);
    });
    each(times.ray_hits, [&](const double* p, const double* q) {
        return vox_query_view_ray_hits(view, p, q, all_meshes, VOX_NULL_BODY, facets.data(), facets.size(),
                                       &count);
    });
    each(times.ray_any, [&](const double* p, const double* q) {
        return vox_query_view_ray_any(view, p, q, all_meshes, VOX_NULL_BODY, &any);
    });
}

void print(const char* name, const Times& t) {
    std::printf("%-10s %8.0f %8.0f %8.0f %8.0f %8.0f %8.0f %8.0f %8.0f %8.0f\n", name, t.point, t.points,
                t.box, t.closest, t.closest_points, t.path, t.ray, t.ray_hits, t.ray_any);
}

void print_header(const char* of) {
    std::printf("%-10s %8s %8s %8s %8s %8s %8s %8s %8s %8s\n", of, "point", "points", "box", "closest",
                "batch", "path", "ray", "hits", "any");
}

// ---- preparing --------------------------------------------------------------------------------------

enum Kind { floats, doubles, transform, kinds };
constexpr const char* kind_names[] = {"floats", "doubles", "transform"};

// Two bodies in a grid, their positions of one kind.
class Scene {
public:
    Scene(Kind kind, const std::vector<vox::test::Mesh>& bodies) : kind_(kind), bodies_(bodies) {
        vox_grid_desc settings = vox_default_grid_desc();
        settings.byte_budget = UINT64_MAX;
        settings.flags = 0;
        must(vox_grid_create(&settings, &grid_));
        for (const vox::test::Mesh& body : bodies_) {
            vox_mesh_desc desc = vox_default_mesh_desc();
            desc.positions.format = kind == doubles ? VOX_FORMAT_DOUBLE : VOX_FORMAT_FLOAT;
            desc.positions.count = body.positions.size();
            desc.tets = body.tets.front().v;
            desc.tet_count = body.tets.size();
            vox_body mesh = VOX_NULL_BODY;
            must(vox_mesh_insert(grid_, &desc, &mesh));
            void* positions = nullptr;
            must(vox_mesh_map_positions(grid_, mesh, &positions));
            positions_.push_back(positions);
            if (kind == transform) {
                const double turned[12] = {0.8, -0.6, 0, 0.1, 0.6, 0.8, 0, 0.2, 0, 0, 1, 0.3};
                must(vox_body_set_transform(grid_, mesh, turned));
            }
        }
    }
    ~Scene() {
        vox_query_view_release(view_);
        vox_grid_destroy(grid_);
    }
    Scene(const Scene&) = delete;
    Scene& operator=(const Scene&) = delete;

    void move(int round) {
        for (std::size_t b = 0; b < bodies_.size(); ++b)
            for (std::size_t v = 0; v < bodies_[b].positions.size(); ++v) {
                const vox::Vec3f& p = bodies_[b].positions[v];
                const Vec3d to = {double{p.x}, double{p.y} + 0.01 * std::sin(round + 0.3 * double{p.x}),
                                  double{p.z}};
                if (kind_ == doubles)
                    static_cast<Vec3d*>(positions_[b])[v] = to;
                else
                    static_cast<vox::Vec3f*>(positions_[b])[v] = {float(to.x), float(to.y), float(to.z)};
            }
    }

    void prepare(double& least) {
        least = std::min(least, seconds_of([&] { must(vox_grid_prepare_queries(grid_)); }));
    }
    // Instead of the view that is there, as in a frame.
    void take(double& least) {
        vox_query_view* taken = nullptr;
        least = std::min(least, seconds_of([&] { must(vox_grid_take_query_view(grid_, &taken)); }));
        vox_query_view_release(view_);
        view_ = taken;
    }
    const vox_query_view* view() const { return view_; }

private:
    Kind kind_;
    const std::vector<vox::test::Mesh>& bodies_;
    vox_grid* grid_ = nullptr;
    std::vector<void*> positions_;
    vox_query_view* view_ = nullptr;
};

void time_all(double tets, int rounds) {
    double radius = 0;
    std::vector<vox::test::Mesh> bodies;
    Random random{5};
    for (int b = 0; b < 2; ++b) {
        bodies.push_back(vox::test::jittered(vox::test::ball(tets / 2, &radius), random, 0.15));
        for (vox::Vec3f& p : bodies.back().positions) p.x += float(b * 1.9 * radius);
    }
    const double count = double(bodies[0].tets.size() + bodies[1].tets.size());
    double first[kinds], prepare[kinds], take[kinds];
    std::array<Times, kinds> times;
    std::vector<Vec3d> points;
    for (int i = 0; i < 2000; ++i)
        points.push_back(Vec3d{0.95 * radius, 0, 0} + Vec3d{2 * radius * (2 * random.unit() - 1),
                                                            1.2 * radius * (2 * random.unit() - 1),
                                                            1.2 * radius * (2 * random.unit() - 1)});
    Scene scenes[kinds] = {{floats, bodies}, {doubles, bodies}, {transform, bodies}};
    for (int k = 0; k < kinds; ++k) {
        first[k] = prepare[k] = take[k] = 1e9;
        scenes[k].move(0);
        scenes[k].prepare(first[k]);
    }
    for (int round = 1; round <= rounds; ++round)
        for (int k = 0; k < kinds; ++k) {
            scenes[k].move(round);
            scenes[k].prepare(prepare[k]);
            scenes[k].take(take[k]);
            time_queries(scenes[k].view(), points, 1, times[std::size_t(k)]);
        }
    std::printf("two balls, %.0f tets: ns a tet\n%-10s %8s %8s %8s\n", count, "positions", "first", "prepare",
                "view");
    for (int k = 0; k < kinds; ++k)
        std::printf("%-10s %8.1f %8.1f %8.1f\n", kind_names[k], 1e9 * first[k] / count,
                    1e9 * prepare[k] / count, 1e9 * take[k] / count);
    std::printf("the queries of a view, ns each; path: a batch of points along a way\n");
    print_header("positions");
    for (int k = 0; k < kinds; ++k) print(kind_names[k], times[std::size_t(k)]);
}

// ---- brute force, and the worst ---------------------------------------------------------------------

void agree(bool same, const char* what, const char* where) {
    if (!same) throw std::runtime_error(std::string(what) + " differ from brute force: " + where);
}

vox_query_view* view_of(const QueryDefinition& mesh, double* seconds = nullptr) {
    vox_grid_desc settings = vox_default_grid_desc();
    settings.flags = 0;
    vox_grid* grid = nullptr;
    must(vox_grid_create(&settings, &grid));
    vox_mesh_desc desc = vox_default_mesh_desc();
    desc.positions.data = mesh.positions().data();
    desc.positions.format = VOX_FORMAT_DOUBLE;
    desc.positions.count = mesh.positions().size();
    desc.tets = mesh.tets().front().v;
    desc.tet_count = mesh.tets().size();
    vox_body id = VOX_NULL_BODY;
    must(vox_mesh_insert(grid, &desc, &id));
    vox_query_view* view = nullptr;
    for (int i = 0; i < (seconds ? 9 : 1); ++i) {
        vox_query_view_release(view);
        const double taken = seconds_of([&] { must(vox_grid_take_query_view(grid, &view)); });
        if (seconds) *seconds = std::min(*seconds, taken);
    }
    vox_grid_destroy(grid);
    return view;
}

std::vector<Vec3d> points_near(const QueryDefinition& mesh, Random& random, std::size_t count) {
    std::vector<Vec3d> points;
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t a = random.below(std::uint32_t(mesh.tets().size())),
                            b = i % 2 ? a : random.below(a + 1);
        points.push_back(0.5 * mesh.corner(a, 0) + 0.5 * mesh.corner(b, random.below(4)));
    }
    return points;
}

void check(const QueryDefinition& mesh, const char* name, Random& random) {
    vox_query_view* view = view_of(mesh);
    const std::vector<Vec3d> points = points_near(mesh, random, 120);
    std::vector<vox_point_hit> hits(mesh.tets().size());
    std::vector<vox_facet_hit> facets(4 * mesh.tets().size());
    std::vector<vox_closest_hit> closest(points.size());
    vox_closest_desc desc = vox_default_closest_desc();
    desc.points = points.data();
    desc.format = VOX_FORMAT_DOUBLE;
    desc.point_count = points.size();
    must(vox_query_view_closest_points(view, &desc, closest.data()));
    std::uint64_t count = 0;
    std::uint32_t any = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Vec3d &p = points[i], &q = points[(i + 1) % points.size()];
        must(vox_query_view_point(view, &p.x, all_meshes, hits.data(), hits.size(), &count));
        std::vector<std::uint32_t> tets;
        for (std::uint64_t h = 0; h < count; ++h) tets.push_back(hits[h].tet);
        agree(tets == mesh.tets_with(p), "tetrahedra with a point", name);
        const auto [squared, facet] = mesh.closest(p);
        agree(std::abs(closest[i].distance) == std::sqrt(squared) && closest[i].tet == facet.first &&
                  closest[i].facet == facet.second && closest[i].inside == !tets.empty(),
              "closest points", name);
        must(vox_query_view_ray_hits(view, &p.x, &q.x, all_meshes, VOX_NULL_BODY, facets.data(),
                                     facets.size(), &count));
        std::vector<QueryDefinition::Facet> met;
        for (std::uint64_t h = 0; h < count; ++h) met.emplace_back(facets[h].tet, facets[h].facet);
        std::sort(met.begin(), met.end());
        agree(met == mesh.hits(p, q), "facets on a segment", name);
        must(vox_query_view_ray_any(view, &p.x, &q.x, all_meshes, VOX_NULL_BODY, &any));
        agree(any == mesh.any(p, q), "segments that hit anything", name);
    }
    vox_query_view_release(view);
}

QueryDefinition whole_ball(double tets, Random& random) {
    const vox::test::Mesh mesh = vox::test::jittered(vox::test::ball(tets), random, 0.15);
    return {{mesh.positions.begin(), mesh.positions.end()}, mesh.tets};
}

// Meshes as bad as can be: what preparing them costs, and how much more a query does.
void time_worst(std::size_t tets, int rounds) {
    Random random{7};
    std::printf("bad shapes, %zu tets each that share no vertices: ns a tet for a view, ns a query\n", tets);
    print_header("shape");
    for (int s = 0; s < vox::test::shape_count; ++s) {
        const QueryDefinition soup = vox::test::make_soup(random, Shape(s), tets);
        double taken = 1e9;
        vox_query_view* view = view_of(soup, &taken);
        const std::vector<Vec3d> points = points_near(soup, random, 100);
        Times times;
        for (int round = 0; round < rounds; ++round) time_queries(view, points, 1e-3, times);
        print(vox::test::shape_names[s], times);
        std::printf("%10s view %.1f\n", "", 1e9 * taken / double(tets));
        vox_query_view_release(view);
    }
}

} // namespace

int main(int argc, char** argv) {
    bench::Size size{300000, 11};
    if (!bench::read_size(argc, argv, "bench_queries", size)) return 2;
    const double tets = size.tets;
    const int rounds = size.rounds;
    return bench::run_program("bench_queries", [&] {
        Random random{3};
        check(whole_ball(3000, random), "a ball", random);
        for (int s = 0; s < vox::test::shape_count; ++s)
            check(vox::test::make_soup(random, Shape(s), 500), vox::test::shape_names[s], random);
        std::printf("all answers are those of brute force; least of %d rounds\n", rounds);
        time_all(tets, rounds);
        time_worst(10000, std::min(rounds, 3));
        return 0;
    });
}
