#include "cell_size/unlike.hpp"

#include <cmath>
#include <numbers>

namespace bench {
namespace {

// A body that stands at `place` and waves a little.
void add(Scene& scene, const Solid& solid, double scale, const Vec3& place, double radius,
         bool self_collision = false) {
    const Pose pose = [=](const Vec3& p, std::size_t frame) {
        return waved({place.x + scale * p.x, place.y + scale * p.y, place.z + scale * p.z}, p, 0.01 * radius,
                     std::numbers::pi / radius * scale, 0.1 * static_cast<double>(frame));
    };
    bench::add(scene, solid, pose, self_collision);
}

// A ball whose tetrahedra get smaller towards its centre: edges are in proportion to the distance from it to
// the power of `power` - 1, down to that of one edge of the lattice.
Solid graded_ball(double tets, double power, std::uint64_t seed) {
    Solid ball = lattice_ball(tets, seed);
    const double radius = ball_radius(tets);
    for (Vec3& p : ball.positions) {
        const double r = std::hypot(p.x, p.y, p.z);
        if (r == 0) continue;
        const double factor = std::pow(r / radius, power - 1);
        p = {p.x * factor, p.y * factor, p.z * factor};
    }
    return ball;
}

Scene graded_pair(double tets, double power) {
    const double radius = ball_radius(tets / 2);
    Scene scene;
    add(scene, graded_ball(tets / 2, power, 1), 1, {0, 0, 0}, radius);
    add(scene, graded_ball(tets / 2, power, 2), 1, {1.8 * radius, 0.01 * radius, 0.02 * radius}, radius);
    return scene;
}

Scene graded_self(double tets, double power) {
    Scene scene;
    add(scene, graded_ball(tets, power, 1), 1, {0, 0, 0}, ball_radius(tets), true);
    return scene;
}

// A coarse ball and a fine one at its surface, with edges smaller by `ratio`.
Scene unlike_pair(double tets, double ratio) {
    const double coarse = ball_radius(tets / 3), fine = ball_radius(tets * 2 / 3) / ratio;
    Scene scene;
    const Vec3 place{0.37, 0.21, 0.73}; // not at the corner of a cell
    add(scene, lattice_ball(tets / 3, 1), 1, place, coarse);
    add(scene, lattice_ball(tets * 2 / 3, 2), 1 / ratio, {place.x + coarse - 0.3 * fine, place.y, place.z},
        fine);
    return scene;
}

} // namespace

std::vector<SceneMaker> unlike_scenes() {
    std::vector<SceneMaker> makers;
    const auto add_maker = [&](const char* name, const char* title, auto make) {
        makers.push_back({name, title, true, [=](double tets, bool) {
                              Scene scene = make(tets);
                              scene.name = name;
                              scene.mean_edge = mean_edge(scene.bodies);
                              return scene;
                          }});
    };
    add_maker("graded", "two balls, edges as the distance from the centre",
              [](double n) { return graded_pair(n, 2); });
    add_maker("graded-self", "one ball, edges as the distance from the centre, self",
              [](double n) { return graded_self(n, 2); });
    add_maker("graded-100", "two balls, edges as the distance squared",
              [](double n) { return graded_pair(n, 3); });
    add_maker("unlike-10", "two balls, edges 1:10", [](double n) { return unlike_pair(n, 10); });
    add_maker("unlike-100", "two balls, edges 1:100", [](double n) { return unlike_pair(n, 100); });
    return makers;
}

} // namespace bench
