#include "hard_scenes.hpp"

#include "scenes/random.h"

#include <numbers>

namespace bench {
namespace {

Pose waves(double radius, const Vec3& place, double phase) {
    return [=](const Vec3& p, std::size_t frame) {
        return waved({place.x + p.x, place.y + p.y, place.z + p.z}, p, 0.01 * radius,
                     std::numbers::pi / radius, 0.1 * static_cast<double>(frame) + phase);
    };
}

Solid ball(double tets, std::uint64_t seed, bool shuffled) {
    Solid solid = lattice_ball(tets, seed);
    if (shuffled) shuffle(solid, seed);
    return solid;
}

// One body with self-collision whose vertices are moved at random, along each axis by up to an edge of the
// lattice: most of its tetrahedra are inverted or overlap others.
Scene tangled(double tets, bool shuffled) {
    Solid solid = ball(tets, 1, shuffled);
    std::uint64_t random = 11;
    for (Vec3& p : solid.positions) {
        p.x += random_symmetric(&random);
        p.y += random_symmetric(&random);
        p.z += random_symmetric(&random);
    }
    Scene scene;
    add(scene, solid, waves(ball_radius(tets), {0, 0, 0}, 0), true);
    return scene;
}

// A body and its copy in the same place.
Scene coincident(double tets, bool shuffled) {
    const Solid solid = ball(tets / 2, 1, shuffled);
    Scene scene;
    for (int b = 0; b < 2; ++b) add(scene, solid, waves(ball_radius(tets / 2), {0, 0, 0}, 0));
    return scene;
}

// A body inside one of ten times its size.
Scene swallowed(double tets, bool shuffled) {
    const double size[2] = {10 * tets / 11, tets / 11};
    const double radius = ball_radius(size[0]);
    Scene scene;
    add(scene, ball(size[0], 1, shuffled), waves(radius, {0, 0, 0}, 0));
    add(scene, ball(size[1], 2, shuffled), waves(ball_radius(size[1]), {0.3 * radius, 0.1 * radius, 0}, 0.9));
    return scene;
}

} // namespace

std::vector<SceneMaker> hard_scene_makers() {
    return named({{"tangled", "one tangled body, self", true, tangled},
                  {"coincident", "two bodies in the same place", true, coincident},
                  {"swallowed", "a body inside another", true, swallowed}});
}

} // namespace bench
