// What queries cost: taking a locator, for floats, doubles and a transform, each question, those of
// instruments one by one, and the search for what is worst.
//
//   bench_queries [--tets N] [--rounds K]
//
// Two balls of N / 2 tetrahedra that overlap a little, and move between rounds. Times are the least of K
// rounds in which everything takes turns, on one thread, since what disturbs a machine only adds. That the
// answers are right is tested by tests/internal/test_query_search.cpp and its neighbours.
#include "internal/meshes.hpp"
#include "internal/query_definition.hpp"
#include "program.hpp"
#include "timing.h"

#include <vox/vox_query.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

namespace {

using bench::must;
using vox::Vec3d;
using vox::test::QueryDefinition;
using vox::test::Shape;

struct Times {
    double point = 1e9, points = 1e9, box = 1e9, closest_one = 1e9, closest = 1e9, path = 1e9,
           first_hit = 1e9, ray_hits = 1e9, blocked = 1e9, inside = 1e9, outside = 1e9, start = 1e9,
           piece = 1e9;
};

vox_positions positions_of(const std::vector<Vec3d>& points) {
    return vox_double_positions(&points.data()->x, points.size());
}

// The points that follow, and then the first.
std::vector<Vec3d> next_ones(std::vector<Vec3d> points) {
    std::rotate(points.begin(), points.begin() + 1, points.end());
    return points;
}

// Each point is the beginning of a ray to the next one.
void time_queries(const vox_locator* locator, const std::vector<Vec3d>& points, double box_side,
                  Times& times) {
    const std::size_t n = points.size();
    static std::vector<vox_point_hit> hits;
    static std::vector<vox_box_hit> tets;
    static std::vector<vox_ray_hit> facets;
    std::vector<vox_closest_hit> closest(n);
    std::vector<std::uint8_t> blocked(n);
    std::vector<Vec3d> high, path; // path: slowly along the points
    for (std::size_t i = 0; i < n; ++i) {
        const double t = double(i % 100) / 100;
        path.push_back((1 - t) * points[i / 100] + t * points[i / 100 + 1]);
        high.push_back(points[i] + Vec3d{box_side, box_side, box_side});
    }
    hits.resize(64 * n);
    tets.resize(64 * n);
    facets.resize(64 * n);
    const std::vector<Vec3d> ends = next_ones(points);
    const vox_positions all = positions_of(points), to = positions_of(ends), tops = positions_of(high),
                        way = positions_of(path);
    vox_query_desc first = vox_default_query_desc();
    first.flags = VOX_QUERY_FIRST_HIT;
    std::uint64_t count = 0;
    const auto time = [&](double& least, auto&& ask) {
        least = std::min(least, 1e9 / double(n) * seconds_of([&] { must(ask()); }));
    };
    const auto time_each = [&](double& least, auto&& ask) {
        least = std::min(least, 1e9 / double(n) * seconds_of([&] {
                                    for (const Vec3d& p : points) must(ask(vox_double_positions(&p.x, 1)));
                                }));
    };
    time_each(times.point, [&](const vox_positions& p) {
        return vox_locator_find_point_hits(locator, &p, nullptr, hits.data(), hits.size(), &count);
    });
    time(times.points, [&] {
        return vox_locator_find_point_hits(locator, &all, nullptr, hits.data(), hits.size(), &count);
    });
    time(times.box, [&] {
        return vox_locator_find_box_hits(locator, &all, &tops, nullptr, tets.data(), tets.size(), &count);
    });
    time_each(times.closest_one, [&](const vox_positions& p) {
        return vox_locator_find_closest(locator, &p, nullptr, closest.data());
    });
    time(times.closest, [&] { return vox_locator_find_closest(locator, &all, nullptr, closest.data()); });
    time(times.path, [&] { return vox_locator_find_closest(locator, &way, nullptr, closest.data()); });
    time(times.first_hit, [&] {
        return vox_locator_find_ray_hits(locator, &all, &to, &first, facets.data(), facets.size(), &count);
    });
    time(times.ray_hits, [&] {
        return vox_locator_find_ray_hits(locator, &all, &to, nullptr, facets.data(), facets.size(), &count);
    });
    std::vector<vox_location> located(n);
    must(vox_locator_locate(locator, &all, nullptr, located.data()));
    for (const vox_location_state state : {VOX_LOCATION_INSIDE, VOX_LOCATION_OUTSIDE}) {
        std::vector<Vec3d> some, near;
        for (std::size_t i = 0; i < 100 * n && some.size() < n; ++i)
            if (located[i % n].state == state) some.push_back(points[i % n]);
        if (some.size() < n) continue;
        for (std::size_t i = 0; i < n; ++i) near.push_back(some[i] + Vec3d{1e-6 * box_side, 0, 0});
        const vox_positions asked = positions_of(some), beside = positions_of(near);
        time(state == VOX_LOCATION_INSIDE ? times.inside : times.outside,
             [&] { return vox_locator_locate(locator, &asked, nullptr, located.data()); });
        if (state != VOX_LOCATION_INSIDE) continue;
        static std::vector<vox_track_piece> pieces(512 * n);
        const auto track = [&](double& least, const vox_positions& end) {
            time(least, [&] {
                return vox_locator_find_tracks(locator, &asked, &end, nullptr, pieces.data(), pieces.size(),
                                               &count);
            });
        };
        track(times.start, beside);
        double whole = 1e9;
        const std::vector<Vec3d> others = next_ones(some);
        track(whole, positions_of(others));
        times.piece = std::min(times.piece, (whole - times.start) * double(n) / double(count));
        must(vox_locator_locate(locator, &all, nullptr, located.data()));
    }
    time(times.blocked, [&] { return vox_locator_test_rays(locator, &all, &to, nullptr, blocked.data()); });
}

void print(const char* name, const Times& t) {
    std::printf("%-10s", name);
    for (const double ns : {t.point, t.points, t.box, t.closest_one, t.closest, t.path, t.first_hit,
                            t.ray_hits, t.blocked, t.inside, t.outside, t.start, t.piece})
        std::printf(" %8.0f", ns);
    std::puts("");
}

void print_header(const char* of) {
    std::printf("%-10s", of);
    for (const char* name : {"point", "points", "box", "closest", "batch", "path", "first", "hits", "test",
                             "inside", "outside", "start", "piece"})
        std::printf(" %8s", name);
    std::puts("");
}

// ---- taking them -------------------------------------------------------------------------------------

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
        vox_locator_release(locator_);
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

    void update(double& least) {
        least = std::min(least, seconds_of([&] { must(vox_grid_update_locator(grid_, &locator_)); }));
    }
    const vox_locator* locator() const { return locator_; }

private:
    Kind kind_;
    const std::vector<vox::test::Mesh>& bodies_;
    vox_grid* grid_ = nullptr;
    std::vector<void*> positions_;
    vox_locator* locator_ = nullptr;
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
    double first[kinds], later[kinds];
    std::array<Times, kinds> times;
    std::vector<Vec3d> points;
    for (int i = 0; i < 2000; ++i)
        points.push_back(Vec3d{0.95 * radius, 0, 0} + Vec3d{2 * radius * (2 * random.unit() - 1),
                                                            1.2 * radius * (2 * random.unit() - 1),
                                                            1.2 * radius * (2 * random.unit() - 1)});
    Scene scenes[kinds] = {{floats, bodies}, {doubles, bodies}, {transform, bodies}};
    for (int k = 0; k < kinds; ++k) {
        first[k] = later[k] = 1e9;
        scenes[k].move(0);
        scenes[k].update(first[k]);
    }
    for (int round = 1; round <= rounds; ++round)
        for (int k = 0; k < kinds; ++k) {
            scenes[k].move(round);
            scenes[k].update(later[k]);
            time_queries(scenes[k].locator(), points, 1, times[std::size_t(k)]);
        }
    std::printf("two balls, %.0f tets: ns a tet of a locator\n%-10s %8s %8s\n", count, "positions", "first",
                "later");
    for (int k = 0; k < kinds; ++k)
        std::printf("%-10s %8.1f %8.1f\n", kind_names[k], 1e9 * first[k] / count, 1e9 * later[k] / count);
    std::printf(
        "ns a question; path: points along a way; start, piece: of tracks, and of a tetrahedron more\n");
    print_header("positions");
    for (int k = 0; k < kinds; ++k) print(kind_names[k], times[std::size_t(k)]);
}

// ---- instruments -------------------------------------------------------------------------------------

vox_locator* locator_of(const QueryDefinition& mesh, double* seconds = nullptr);

// The mean and the 95th of a hundred of the least times, in microseconds, of questions that are asked one by
// one.
template <class Ask>
void time_each_alone(const char* name, std::size_t count, int rounds, const Ask& ask) {
    std::vector<double> least(count, 1e9);
    for (int round = 0; round < rounds; ++round)
        for (std::size_t i = 0; i < count; ++i)
            least[i] = std::min(least[i], 1e6 * seconds_of([&] { must(ask(i)); }));
    double sum = 0;
    for (const double one : least) sum += one;
    std::sort(least.begin(), least.end());
    std::printf("%-32s %8.1f %8.1f %8.1f\n", name, sum / double(count), least[count * 95 / 100],
                least.back());
}

// Tools of a tenth of the ball's size, at a share of its radius from its middle.
void time_instruments(double tets, int rounds) {
    Random random{9};
    double radius = 0;
    const vox::test::Mesh ball = vox::test::jittered(vox::test::ball(tets, &radius), random, 0.15);
    vox_locator* const locator = locator_of({{ball.positions.begin(), ball.positions.end()}, ball.tets});
    std::printf("instruments, one by one, in a ball of %zu tets: us a question\n%-32s %8s %8s %8s\n",
                ball.tets.size(), "", "mean", "p95", "most");
    constexpr std::size_t count = 1000;
    std::uint64_t hit_count = 0, all_hits = 0;
    std::vector<vox_triangle_hit> hits(100000);
    vox_closest_hit closest{};
    constexpr std::pair<const char*, std::pair<double, double>> places[] = {{"outside", {1.05, 1.3}},
                                                                            {"at the surface", {0.95, 1.05}},
                                                                            {"inside", {0.5, 0.9}},
                                                                            {"deep", {0, 0.4}}};
    for (const auto& [name, range] : places) {
        std::vector<Vec3d> from, to;
        while (from.size() < 3 * count) {
            Vec3d at = vox::test::random_vector(random, 1);
            if (const double length = std::sqrt(dot(at, at)); length > 0.1 && length < 1)
                at = (radius * (range.first + (range.second - range.first) * random.unit()) / length) * at;
            else
                continue;
            for (int c = 0; c < 3; ++c) {
                from.push_back(at + vox::test::random_vector(random, 0.1 * radius));
                to.push_back(from.back() + vox::test::random_vector(random, 0.02 * radius));
            }
        }
        const auto title = [&](const char* of) { return std::string(of) + ", " + name; };
        time_each_alone(title("capsule").c_str(), count, rounds, [&](std::size_t i) {
            const vox_positions begin = vox_double_positions(&from[3 * i].x, 1),
                                end = vox_double_positions(&from[3 * i + 1].x, 1);
            return vox_locator_find_closest_to_segments(locator, &begin, &end, nullptr, &closest);
        });
        time_each_alone(title("point").c_str(), count, rounds, [&](std::size_t i) {
            const vox_positions begin = vox_double_positions(&from[3 * i].x, 1);
            return vox_locator_find_closest(locator, &begin, nullptr, &closest);
        });
        const auto time_triangles = [&](const char* of, bool moves) {
            all_hits = 0;
            time_each_alone(title(of).c_str(), count, rounds, [&](std::size_t i) {
                const vox_positions begin = vox_double_positions(&from[3 * i].x, 3),
                                    end = vox_double_positions(&to[3 * i].x, 3);
                const vox_result result = vox_locator_find_triangle_hits(
                    locator, &begin, moves ? &end : nullptr, nullptr, hits.data(), hits.size(), &hit_count);
                all_hits += hit_count;
                return result;
            });
            std::printf("%32s %8.1f\n", "hits", double(all_hits) / double(count) / rounds);
        };
        time_triangles("triangle", false);
        time_triangles("moving triangle", true);
        for (std::size_t i = 0; i < count; ++i) {
            from[3 * i + 2] = from[3 * i + 1];
            to[3 * i + 2] = to[3 * i + 1];
        }
        time_triangles("moving needle", true);
    }
    vox_locator_release(locator);
}

// ---- the worst ---------------------------------------------------------------------------------------

vox_locator* locator_of(const QueryDefinition& mesh, double* seconds) {
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
    vox_locator* locator = nullptr;
    for (int i = 0; i < (seconds ? 9 : 1); ++i) {
        const double taken = seconds_of([&] { must(vox_grid_update_locator(grid, &locator)); });
        if (seconds) *seconds = std::min(*seconds, taken);
    }
    vox_grid_destroy(grid);
    return locator;
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

// Meshes as bad as can be: what a locator of them costs, and how much more a question does.
void time_worst(std::size_t tets, int rounds) {
    Random random{7};
    std::printf("bad shapes, %zu tets each that share no vertices: ns a tet for a locator, ns a question\n",
                tets);
    print_header("shape");
    for (int s = 0; s < vox::test::shape_count; ++s) {
        const QueryDefinition soup = vox::test::make_soup(random, Shape(s), tets);
        double taken = 1e9;
        vox_locator* locator = locator_of(soup, &taken);
        const std::vector<Vec3d> points = points_near(soup, random, 100);
        Times times;
        for (int round = 0; round < rounds; ++round) time_queries(locator, points, 1e-3, times);
        print(vox::test::shape_names[s], times);
        std::printf("%10s locator %.1f\n", "", 1e9 * taken / double(tets));
        vox_locator_release(locator);
    }
}

} // namespace

int main(int argc, char** argv) {
    bench::Size size{300000, 11};
    if (!bench::read_size(argc, argv, "bench_queries", size)) return 2;
    const double tets = size.tets;
    const int rounds = size.rounds;
    return bench::run_program("bench_queries", [&] {
        std::printf("least of %d rounds\n", rounds);
        time_all(tets, rounds);
        time_instruments(100000, std::min(rounds, 5));
        time_worst(10000, std::min(rounds, 3));
        return 0;
    });
}
