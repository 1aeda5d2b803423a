#include "sim/constraints.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace vox::sim {

namespace {

// Least ratio of compliance / h^2 to the constraint's own term, grad C M^-1 grad C^T. With 4, the total
// energy of a ball dropped on the floor never rose above its first value, whatever its stiffness; with 1 it
// did, by 6 %.
constexpr double least_softness = 4;

// The position of a particle in the middle of the substep, which is the time its velocity belongs to.
Vec3 middle(const SoftBody& body, std::uint32_t v) { return (body.positions[v] + body.previous[v]) / 2; }

} // namespace

void set_substep(SoftBody& body, double h) {
    if (body.substep == h) return;
    body.substep = h;
    body.softened = 0;
    const auto softness = [&](double compliance, double answer) {
        const double least = least_softness * answer, wanted = compliance / (h * h);
        if (wanted < least) ++body.softened;
        return std::max(wanted, least);
    };
    const double* w = body.inverse_masses.data();
    for (EdgeConstraint& edge : body.edges) edge.softness = softness(edge.compliance, w[edge.a] + w[edge.b]);
    for (VolumeConstraint& tet : body.volumes) tet.softness = softness(tet.compliance, tet.rest_answer);
}

void move_freely(SoftBody& body, const Vec3& gravity, double h) {
    body.previous = body.positions;
    if (body.fixed) return;
    const Vec3 gained = h * gravity;
    for (std::size_t v = 0; v < body.positions.size(); ++v) {
        body.velocities[v] += gained;
        body.positions[v] += h * body.velocities[v];
    }
}

// With one sweep a substep, the multipliers start at 0, and Eq. 18 becomes
//     lambda = -C / (grad C M^-1 grad C^T + compliance / h^2).

void solve_edges(SoftBody& body) {
    if (body.fixed) return;
    const double* w = body.inverse_masses.data();
    Vec3* x = body.positions.data();
    for (const EdgeConstraint& edge : body.edges) {
        const Vec3 d = x[edge.a] - x[edge.b];
        const double length = d.norm();
        if (length == 0) continue; // there is no direction in which to separate them
        const Vec3 direction = d / length;
        const double lambda = -(length - edge.rest_length) / (w[edge.a] + w[edge.b] + edge.softness);
        x[edge.a] += (w[edge.a] * lambda) * direction;
        x[edge.b] -= (w[edge.b] * lambda) * direction;
    }
}

// When a tet collapses, its gradients vanish but its constraint does not, which would move its corners
// arbitrarily far. Therefore the sum over the gradients is never taken as less than a quarter of its value at
// rest. Then no corner moves farther than about the tet's height. Momentum is kept, since this only scales
// the multiplier.
void solve_volumes(SoftBody& body) {
    if (body.fixed) return;
    const double* w = body.inverse_masses.data();
    Vec3* x = body.positions.data();
    for (const VolumeConstraint& tet : body.volumes) {
        const std::uint32_t* c = tet.corners;
        const Vec3 e1 = x[c[1]] - x[c[0]], e2 = x[c[2]] - x[c[0]], e3 = x[c[3]] - x[c[0]];
        const Vec3 g1 = e2.cross(e3), g2 = e3.cross(e1), g3 = e1.cross(e2);
        const Vec3 g0 = -(g1 + g2 + g3);
        const double answer = w[c[0]] * g0.squaredNorm() + w[c[1]] * g1.squaredNorm() +
                              w[c[2]] * g2.squaredNorm() + w[c[3]] * g3.squaredNorm();
        const double lambda =
            -(e1.dot(g1) - tet.rest_volume6) / (std::max(answer, tet.rest_answer / 4) + tet.softness);
        x[c[0]] += (w[c[0]] * lambda) * g0;
        x[c[1]] += (w[c[1]] * lambda) * g1;
        x[c[2]] += (w[c[2]] * lambda) * g2;
        x[c[3]] += (w[c[3]] * lambda) * g3;
    }
}

void take_velocities(SoftBody& body, double h) {
    if (body.fixed) return;
    const double per_h = 1 / h;
    for (std::size_t v = 0; v < body.positions.size(); ++v)
        body.velocities[v] = per_h * (body.positions[v] - body.previous[v]);
}

// The Kelvin-Voigt model: each spring has a parallel dashpot of `damping` times its stiffness. It is
// integrated implicitly and takes the share 1 - 1 / (1 + g) of the edge's rate, so that no damping can
// overshoot.
void damp(SoftBody& body, double h) {
    if (body.fixed || body.damping == 0) return;
    const double* w = body.inverse_masses.data();
    Vec3* velocities = body.velocities.data();
    for (const EdgeConstraint& edge : body.edges) {
        const Vec3 d = middle(body, edge.a) - middle(body, edge.b);
        const double length2 = d.squaredNorm();
        if (length2 == 0) continue;
        const double weight = w[edge.a] + w[edge.b];
        const double g = body.damping / h * weight / (edge.softness + weight);
        const double rate = d.dot(velocities[edge.a] - velocities[edge.b]) / length2;
        const Vec3 impulse = (rate * g / ((1 + g) * weight)) * d;
        velocities[edge.a] -= w[edge.a] * impulse;
        velocities[edge.b] += w[edge.b] * impulse;
    }
}

// With a single sweep a substep, a constraint responds with the force of a spring of compliance
// compliance + h^2 grad C M^-1 grad C^T, also at rest, so the energy is that of this spring. It is computed
// for the middle of the substep, to which velocities belong.
double elastic_energy(const SoftBody& body) {
    const double h2 = body.substep * body.substep;
    const double* w = body.inverse_masses.data();
    const auto at = [&](std::uint32_t v) { return middle(body, v); };
    double energy = 0;
    for (const EdgeConstraint& edge : body.edges) {
        const double change = (at(edge.a) - at(edge.b)).norm() - edge.rest_length;
        const double compliance = h2 > 0 ? h2 * (edge.softness + w[edge.a] + w[edge.b]) : edge.compliance;
        energy += change * change / (2 * compliance);
    }
    for (const VolumeConstraint& tet : body.volumes) {
        const std::uint32_t* c = tet.corners;
        const double change = volume6(at(c[0]), at(c[1]), at(c[2]), at(c[3])) - tet.rest_volume6;
        const double compliance = h2 > 0 ? h2 * (tet.softness + tet.rest_answer) : tet.compliance;
        energy += change * change / (2 * compliance);
    }
    return energy;
}

} // namespace vox::sim
