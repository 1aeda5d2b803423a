#include "constraints.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>

namespace vox::sim {

void move_freely(Body& body, const Vec3& gravity, double h) {
    body.previous = body.positions;
    if (body.fixed) return;
    const Vec3 gained = h * (gravity + body.acceleration);
    for (std::size_t v = 0; v < body.positions.size(); ++v) {
        body.velocities[v] += gained;
        body.positions[v] += h * body.velocities[v];
    }
}

// With one iteration a substep the multipliers start at 0, so Eq. 26 becomes
//     lambda = -(C + g grad C . (x - x_previous)) / ((1 + g) grad C M^-1 grad C^T + compliance / h^2),
// with g = damping / h: a dashpot beside the spring, of `damping` times its stiffness.

void solve_edges(Body& body, double h) {
    if (body.fixed) return;
    const double* w = body.inverse_masses.data();
    Vec3* x = body.positions.data();
    const Vec3* previous = body.previous.data();
    const double per_h2 = 1 / (h * h), g = body.damping / h;
    for (const EdgeConstraint& edge : body.edges) {
        const Vec3 d = x[edge.a] - x[edge.b];
        const double length = d.norm();
        if (length == 0) continue; // no direction to part them in
        const Vec3 direction = d / length;
        const double rate = direction.dot(d - (previous[edge.a] - previous[edge.b]));
        const double lambda = -(length - edge.rest_length + g * rate) /
                              ((1 + g) * (w[edge.a] + w[edge.b]) + edge.compliance * per_h2);
        x[edge.a] += (w[edge.a] * lambda) * direction;
        x[edge.b] -= (w[edge.b] * lambda) * direction;
    }
}

// The gradients of a tet that collapses vanish while its constraint does not, which would throw its corners
// anywhere. So what they sum to never counts for less than a quarter of its value at rest: then no corner
// moves farther than about the tet's height, and momentum is kept as the multiplier is only scaled.
void solve_volumes(Body& body, double h) {
    if (body.fixed) return;
    const double* w = body.inverse_masses.data();
    Vec3* x = body.positions.data();
    const double per_h2 = 1 / (h * h);
    for (const VolumeConstraint& tet : body.volumes) {
        const std::uint32_t* c = tet.corners;
        const Vec3 e1 = x[c[1]] - x[c[0]], e2 = x[c[2]] - x[c[0]], e3 = x[c[3]] - x[c[0]];
        const Vec3 g1 = e2.cross(e3), g2 = e3.cross(e1), g3 = e1.cross(e2);
        const Vec3 g0 = -(g1 + g2 + g3);
        const double stiffness = w[c[0]] * g0.squaredNorm() + w[c[1]] * g1.squaredNorm() +
                                 w[c[2]] * g2.squaredNorm() + w[c[3]] * g3.squaredNorm();
        const double lambda = -(e1.dot(g1) - tet.rest_volume6) /
                              (std::max(stiffness, tet.least_stiffness) + tet.compliance * per_h2);
        x[c[0]] += (w[c[0]] * lambda) * g0;
        x[c[1]] += (w[c[1]] * lambda) * g1;
        x[c[2]] += (w[c[2]] * lambda) * g2;
        x[c[3]] += (w[c[3]] * lambda) * g3;
    }
}

void take_velocities(Body& body, double h) {
    if (body.fixed) return;
    const double per_h = 1 / h;
    for (std::size_t v = 0; v < body.positions.size(); ++v)
        body.velocities[v] = per_h * (body.positions[v] - body.previous[v]);
}

double elastic_energy(const Body& body) {
    double energy = 0;
    for (const EdgeConstraint& edge : body.edges) {
        const double change = (body.positions[edge.a] - body.positions[edge.b]).norm() - edge.rest_length;
        energy += change * change / (2 * edge.compliance);
    }
    for (const VolumeConstraint& tet : body.volumes) {
        const std::uint32_t* c = tet.corners;
        const double change =
            volume6(body.positions[c[0]], body.positions[c[1]], body.positions[c[2]], body.positions[c[3]]) -
            tet.rest_volume6;
        energy += change * change / (2 * tet.compliance);
    }
    return energy;
}

} // namespace vox::sim
