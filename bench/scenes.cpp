#include "scenes.hpp"

#include "program.hpp"
#include "scenes/random.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace bench {
namespace {

constexpr std::size_t frame_count = 4;
constexpr double pi = std::numbers::pi;

// ---- placing and deforming ------------------------------------------------------------------------

std::vector<float> frame_positions(const Solid& solid, const Pose& pose, std::size_t frame) {
    std::vector<float> positions;
    positions.reserve(3 * solid.positions.size() + 1);
    for (const Vec3& rest : solid.positions) {
        const Vec3 p = pose(rest, frame);
        positions.insert(positions.end(),
                         {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
    }
    positions.push_back(0);
    return positions;
}

// Three waves across a body of the given radius, moved by `offset`. In each frame they advance a little, and
// vertices by at most `speed` of the amplitude. The strain is 3 % with the default amplitude.
Pose waves(double radius, const Vec3& offset, double phase, double amplitude = 0.01, double speed = 0.1) {
    return [=](const Vec3& p, std::size_t frame) {
        return waved({offset.x + p.x, offset.y + p.y, offset.z + p.z}, p, amplitude * radius, pi / radius,
                     speed * static_cast<double>(frame) + phase);
    };
}

// Waves so high that vertices move by up to 0.15 edges, of length 1, in each frame.
Pose lively_waves(double radius, double height) {
    constexpr double edges_a_frame = 0.15;
    return waves(radius, {0, 0, 0}, 0, height / radius, edges_a_frame / height);
}

// The poses of two bodies side by side, `distance` apart and a little off the common axis.
Pose beside(double radius, std::size_t body, double distance, double amplitude = 0.01) {
    return body == 0 ? waves(radius, {0, 0, 0}, 0, amplitude)
                     : waves(radius, {distance, 0.01 * radius, 0.02 * radius}, 0.9, amplitude);
}

// Where f, which falls from f(low) to f(high), passes `target`.
double bisect(double low, double high, double target, const std::function<double(double)>& f) {
    for (int i = 0; i < 20 && high - low > 1e-4 * high; ++i) {
        const double middle = (low + high) / 2;
        (f(middle) > target ? low : high) = middle;
    }
    return (low + high) / 2;
}

// The distance, in [0, far], at which `share` of the tetrahedra of two bodies hold a vertex of the other one.
double place_by_contacts(const Solid (&solids)[2], const std::function<Pose(std::size_t body, double)>& pose,
                         double far, double share) {
    vox_grid* grid = nullptr;
    must(vox_grid_create(nullptr, &grid));
    std::vector<float> positions[2];
    vox_body meshes[2] = {};
    for (std::size_t b = 0; b < 2; ++b) {
        positions[b] = frame_positions(solids[b], pose(b, far), 0);
        vox_mesh_desc desc = vox_default_mesh_desc();
        desc.positions = vox_float_positions(positions[b].data(), solids[b].positions.size());
        desc.tets = solids[b].tets.data();
        desc.tet_count = solids[b].tets.size() / 4;
        must(vox_mesh_insert(grid, &desc, &meshes[b]));
    }
    const double distance = bisect(0, far, share, [&](double d) {
        for (std::size_t b = 0; b < 2; ++b)
            std::ranges::copy(frame_positions(solids[b], pose(b, d), 0), positions[b].begin());
        must(vox_grid_step(grid));
        vox_contact_view view;
        must(vox_grid_get_contacts(grid, &view));
        std::vector<bool> hit[2];
        for (std::size_t b = 0; b < 2; ++b) hit[b].resize(solids[b].tets.size() / 4);
        for (std::uint64_t c = 0; c < view.count; ++c)
            hit[view.data[c].body_b == meshes[1]][view.data[c].tet] = true;
        const auto hits = std::ranges::count(hit[0], true) + std::ranges::count(hit[1], true);
        return static_cast<double>(hits) / static_cast<double>(hit[0].size() + hit[1].size());
    });
    vox_grid_destroy(grid);
    return distance;
}

// ---- the scenes -----------------------------------------------------------------------------------

// Two balls side by side. The small offset keeps their lattices from lining up.
Scene two_balls(double tets, bool shuffled, const std::function<double(const Solid (&)[2])>& place) {
    Solid solids[2] = {lattice_ball(tets / 2, 1), lattice_ball(tets / 2, 2)};
    if (shuffled)
        for (std::size_t b = 0; b < 2; ++b) shuffle(solids[b], b);
    const double distance = place(solids);
    Scene scene;
    for (std::size_t b = 0; b < 2; ++b) add(scene, solids[b], beside(ball_radius(tets / 2), b, distance));
    return scene;
}

Scene two_balls_by_volume(double tets, bool shuffled, double share) {
    return two_balls(tets, shuffled, [=](const Solid(&)[2]) {
        // Two unit balls at distance d have pi (4 + d) (2 - d)^2 / 12 in common.
        return ball_radius(tets / 2) *
               bisect(0, 2, share, [](double d) { return (4 + d) * (2 - d) * (2 - d) / 16; });
    });
}

Scene two_balls_by_contacts(double tets, bool shuffled, double share) {
    return two_balls(tets, shuffled, [=](const Solid(&solids)[2]) {
        const double radius = ball_radius(tets / 2);
        const auto pose = [=](std::size_t b, double d) { return beside(radius, b, d); };
        return place_by_contacts(solids, pose, 2.2 * radius, share);
    });
}

// One body, whose waves advance from frame to frame.
Scene alone(Solid solid, const Pose& pose, bool shuffled) {
    if (shuffled) shuffle(solid, 1);
    Scene scene;
    add(scene, solid, pose, true);
    scene.bodies[0].later = [solid = std::move(solid), pose](std::size_t frame) {
        return frame_positions(solid, pose, frame);
    };
    return scene;
}

Scene one_ball(double tets, bool shuffled) {
    return alone(lattice_ball(tets, 1), waves(ball_radius(tets), {0, 0, 0}, 0), shuffled);
}

constexpr double lively_height = 0.5; // edges

Scene lively_ball(double tets, bool shuffled) {
    return alone(lattice_ball(tets, 1), lively_waves(ball_radius(tets), lively_height), shuffled);
}

// Edges are stretched and sheared by up to 40 %.
Scene strained_ball(double tets, bool shuffled) {
    const double radius = ball_radius(tets);
    return alone(lattice_ball(tets, 1), lively_waves(radius, 0.4 * radius / pi), shuffled);
}

#if defined(BENCH_IO)
Scene lively_cube_ball(double tets, bool shuffled) {
    return alone(cube_ball(tets), lively_waves(cube_ball_radius(tets), lively_height), shuffled);
}
#endif

// Balls in a cubic lattice, 3.5 % closer than touching, each a little off its place.
Scene many_balls(double tets, bool shuffled, double tets_each) {
    const int n = std::max(2, static_cast<int>(std::lround(std::cbrt(tets / tets_each))));
    const double radius = ball_radius(tets_each), spacing = 1.93 * radius;
    std::uint64_t random = 7;
    Scene scene;
    for (int i = 0; i < n * n * n; ++i) {
        Solid ball = lattice_ball(tets_each, static_cast<std::uint64_t>(i));
        if (shuffled) shuffle(ball, static_cast<std::uint64_t>(i));
        const double off = 0.05 * radius;
        const Vec3 place{spacing * (i % n) + off * random_symmetric(&random),
                         spacing * (i / n % n) + off * random_symmetric(&random),
                         spacing * (i / n / n) + off * random_symmetric(&random)};
        add(scene, ball, waves(radius, place, 0.9 * i));
    }
    return scene;
}

// The same, all but ten at rest.
Scene balls_at_rest(double tets, bool shuffled, double tets_each) {
    Scene scene = many_balls(tets, shuffled, tets_each);
    const std::size_t count = scene.bodies.size(), moving = 10;
    for (std::size_t b = 0; b < count; ++b)
        if (b * moving / count == (b + 1) * moving / count) // no tenth part of all ends here
            std::ranges::fill(scene.bodies[b].frames, scene.bodies[b].frames[0]);
    return scene;
}

// Centres of unit balls that fell into a shaft and came to rest about `distance` apart: all move down, and
// those too close or outside are pushed apart and back, again and again.
std::vector<Vec3> settled(std::size_t count, double distance, std::uint64_t seed) {
    const double half = 3.2,
                 height = 0.26 * static_cast<double>(count); // of the shaft, and what they fall from
    std::vector<Vec3> centres(count);
    for (Vec3& c : centres)
        c = {half * random_symmetric(&seed), half * random_symmetric(&seed), height * random_unit(&seed)};
    for (int round = 0; round < 400; ++round) {
        for (Vec3& c : centres) c.z -= 0.05;
        for (std::size_t i = 0; i < count; ++i)
            for (std::size_t j = 0; j < i; ++j) {
                Vec3 &a = centres[i], &b = centres[j];
                const Vec3 d{a.x - b.x, a.y - b.y, a.z - b.z};
                const double square = d.x * d.x + d.y * d.y + d.z * d.z;
                if (square >= distance * distance || square == 0) continue;
                const double push = 0.5 * (distance / std::sqrt(square) - 1);
                a = {a.x + push * d.x, a.y + push * d.y, a.z + push * d.z};
                b = {b.x - push * d.x, b.y - push * d.y, b.z - push * d.z};
            }
        for (Vec3& c : centres)
            c = {std::clamp(c.x, -half, half), std::clamp(c.y, -half, half), std::max(c.z, 0.0)};
    }
    return centres;
}

// A pile of a game: 300 balls of 500 tetrahedra at random angles, which press into each other until a fifth
// of all vertices are inside another one. Each keeps turning, and waves run through it.
Scene pile(bool shuffled) {
    constexpr std::size_t count = 300;
    constexpr double tets_each = 500, distance = 1.78, turn = 0.02; // radii, radians a frame
    const double radius = ball_radius(tets_each);
    const std::vector<Vec3> centres = settled(count, distance, 17);
    std::uint64_t random = 19;
    Scene scene;
    for (std::size_t i = 0; i < count; ++i) {
        Solid ball = lattice_ball(tets_each, i);
        if (shuffled) shuffle(ball, i);
        const double angle = pi * random_symmetric(&random), tilt = pi * random_symmetric(&random);
        const Vec3& c = centres[i];
        const Pose wave = waves(radius, {0, 0, 0}, 0.9 * static_cast<double>(i));
        add(scene, ball, [=](const Vec3& rest, std::size_t frame) {
            const Vec3 p = wave(rest, frame);
            const double a = angle + turn * static_cast<double>(frame);
            const double x = p.x * std::cos(a) - p.y * std::sin(a), y = p.x * std::sin(a) + p.y * std::cos(a);
            return Vec3{radius * c.x + x, radius * c.y + y * std::cos(tilt) - p.z * std::sin(tilt),
                        radius * c.z + y * std::sin(tilt) + p.z * std::cos(tilt)};
        });
    }
    return scene;
}

// A beam of w * w cubes wound up to a coil of six turns that touch here and there.
Scene coil(double tets, bool shuffled) {
    const double turns = 6, bend = 3; // radius of the coil in widths
    const double length_in_widths = 2 * pi * bend * turns;
    const int width = std::max(2, static_cast<int>(std::lround(std::cbrt(tets / (12 * length_in_widths)))));
    const int length = static_cast<int>(std::lround(tets / (12.0 * width * width)));
    Solid beam = lattice_beam(width, width, length, 0.08, 5);
    if (shuffled) shuffle(beam, 5);
    const Pose wind = [=](const Vec3& p, std::size_t frame) {
        const double w = width, angle = p.z / (bend * w), radius = bend * w + p.y - w / 2;
        // Neighbouring turns swing against each other.
        const double swing = 0.02 * w * std::sin(5.5 * angle + 0.1 * static_cast<double>(frame));
        return Vec3{radius * std::cos(angle), radius * std::sin(angle),
                    1.015 * w * angle / (2 * pi) + p.x - w / 2 + swing};
    };
    Scene scene;
    add(scene, beam, wind, true);
    return scene;
}

constexpr double file_amplitude = 0.005; // less: they have thin parts

double half_longest_side(const Solid& solid) {
    Vec3 low = solid.positions.front(), high = low;
    for (const Vec3& p : solid.positions) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    return std::max({high.x - low.x, high.y - low.y, high.z - low.z}) / 2;
}

// A body and its copy, turned by a right angle and put beside it until `share` of the tetrahedra hold a
// vertex.
Scene file_pair(const std::string& path, bool shuffled, double share) {
    Solid solids[2] = {read_solid(path), read_solid(path)};
    for (Vec3& p : solids[1].positions) p = {p.z, p.y, -p.x};
    if (shuffled)
        for (std::size_t b = 0; b < 2; ++b) shuffle(solids[b], b);
    const double radius = half_longest_side(solids[0]);
    const auto pose = [=](std::size_t b, double d) { return beside(radius, b, d, file_amplitude); };
    const double distance = place_by_contacts(solids, pose, 2.2 * radius, share);
    Scene scene;
    for (std::size_t b = 0; b < 2; ++b) add(scene, solids[b], pose(b, distance));
    return scene;
}

Scene file_self(const std::string& path, bool shuffled) {
    const Solid solid = read_solid(path);
    return alone(solid, waves(half_longest_side(solid), {0, 0, 0}, 0, file_amplitude), shuffled);
}

} // namespace

vox_mesh_desc Body::desc() const {
    vox_mesh_desc desc = vox_default_mesh_desc();
    if (self_collision) desc.filter.flags = VOX_FILTER_SELF_COLLISION;
    desc.positions = vox_float_positions(positions.data(), vertex_count());
    desc.tets = tets.data();
    desc.tet_count = tet_count();
    return desc;
}

void add(Scene& scene, const Solid& solid, const Pose& pose, bool self_collision) {
    Body body;
    for (std::size_t frame = 0; frame < frame_count; ++frame)
        body.frames.push_back(frame_positions(solid, pose, frame));
    body.positions = body.frames[0];
    body.tets = solid.tets;
    body.self_collision = self_collision;
    scene.bodies.push_back(std::move(body));
}

double mean_edge(std::span<const Body> bodies) {
    double sum = 0, count = 0;
    for (const Body& body : bodies)
        for (std::size_t t = 0; t < body.tets.size(); t += 4)
            for (std::size_t i = 0; i < 4; ++i)
                for (std::size_t j = 0; j < i; ++j, count += 1) {
                    const float* a = &body.positions[3 * body.tets[t + i]];
                    const float* b = &body.positions[3 * body.tets[t + j]];
                    sum += std::hypot(double(a[0]) - b[0], double(a[1]) - b[1], double(a[2]) - b[2]);
                }
    return sum / count;
}

std::size_t Scene::vertex_count() const {
    std::size_t count = 0;
    for (const Body& body : bodies) count += body.vertex_count();
    return count;
}

std::size_t Scene::tet_count() const {
    std::size_t count = 0;
    for (const Body& body : bodies) count += body.tet_count();
    return count;
}

void Scene::pose(std::size_t frame) {
    for (Body& body : bodies)
        if (frame >= body.frames.size() && body.later)
            std::ranges::copy(body.later(frame), body.positions.begin());
        else
            std::ranges::copy(body.frames[frame % body.frames.size()], body.positions.begin());
}

Scene pair_from_file(const std::string& path, double share) {
    Scene scene = file_pair(path, false, share);
    scene.mean_edge = mean_edge(scene.bodies);
    return scene;
}

std::vector<SceneMaker> named(std::vector<SceneMaker> makers) {
    for (SceneMaker& maker : makers)
        maker.make = [name = maker.name, make = maker.make](double tets, bool shuffled) {
            Scene scene = make(tets, shuffled);
            scene.name = name;
            scene.mean_edge = mean_edge(scene.bodies);
            return scene;
        };
    return makers;
}

std::vector<SceneMaker> scene_makers(const std::string& mesh_folder) {
    std::vector<SceneMaker> makers = {
        {"overlap-1", "two bodies, 1 % overlap volume", true,
         [](double n, bool s) { return two_balls_by_volume(n, s, 0.01); }},
        {"contact-1", "two bodies, 1 % of tets in contact", true,
         [](double n, bool s) { return two_balls_by_contacts(n, s, 0.01); }},
        {"self", "one compact body, self, no contact", true, [](double n, bool s) { return one_ball(n, s); }},
        {"self-lively", "one compact body, self, waves of half an edge", true,
         [](double n, bool s) { return lively_ball(n, s); }},
        {"self-strain", "one compact body, self, strained by 40 %", true,
         [](double n, bool s) { return strained_ball(n, s); }},
#if defined(BENCH_IO)
        {"self-cubes", "ball of the paper with flat tets, self, waves of half an edge", true,
         [](double n, bool s) { return lively_cube_ball(n, s); }},
#endif
        {"coil", "coil, self, in contact", true, [](double n, bool s) { return coil(n, s); }},
        {"bodies-5k", "bodies of 5k, light contact", true,
         [](double n, bool s) { return many_balls(n, s, 5000); }},
        {"bodies-1k", "bodies of 1k, light contact", true,
         [](double n, bool s) { return many_balls(n, s, 1000); }},
        {"bodies-1k-rest", "bodies of 1k, light contact, ten of them moving", true,
         [](double n, bool s) { return balls_at_rest(n, s, 1000); }},
        {"pile", "a pile of 300 bodies of 500", false, [](double, bool s) { return pile(s); }},
        {"overlap-50", "two bodies, 50 % overlap volume", true,
         [](double n, bool s) { return two_balls_by_volume(n, s, 0.5); }},
    };
    if (!mesh_folder.empty())
        for (const std::string name : {"bunny", "cow", "armadillo"}) {
            const std::string path = mesh_folder + "/" + name + ".msh";
            makers.push_back({name + "-light", name + " pair, 0.5 % of tets in contact", false,
                              [=](double, bool s) { return file_pair(path, s, 0.005); }});
            makers.push_back({name + "-deep", name + " pair, 5 % of tets in contact", false,
                              [=](double, bool s) { return file_pair(path, s, 0.05); }});
            makers.push_back({name + "-self", name + ", self, no contact", false,
                              [=](double, bool s) { return file_self(path, s); }});
        }
    return named(std::move(makers));
}

} // namespace bench
