#include "sim/resolve.hpp"

#include "sim/constraints.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace vox::sim {

namespace {

constexpr int sweeps = 4;               // over the constraints, from one detection to the next
constexpr double step_part = 0.25;      // of the mean edge: how far a contact pushes in these
constexpr std::uint64_t patience = 120; // iterations without progress before it gives up
constexpr double turn_cost = 4; // times the inertia, as a turn moves far ends further than the contact

// Lets edges from `first` on, and all volumes, keep their present sizes.
void rest_as_it_is(SoftBody& body, std::size_t first) {
    const Vec3* x = body.positions.data();
    for (EdgeConstraint& edge : std::span(body.edges).subspan(first))
        edge.rest_length = (x[edge.a] - x[edge.b]).norm();
    for (VolumeConstraint& tet : body.volumes) {
        const std::uint32_t* c = tet.corners;
        tet.rest_volume6 = volume6(x[c[0]], x[c[1]], x[c[2]], x[c[3]]);
    }
}

// A body that moves as a whole, or stays if its inverse mass is 0.
struct Rigid {
    Vec3 centre = Vec3::Zero(), shift = Vec3::Zero(), turn = Vec3::Zero();
    double inverse_mass = 0;
    Eigen::Matrix3d inverse_inertia = Eigen::Matrix3d::Zero();
};

Rigid rigid_of(const SoftBody& body) {
    Rigid r;
    double mass = 0;
    for (std::size_t v = 0; v < body.positions.size(); ++v) {
        mass += body.masses[v];
        r.centre += body.masses[v] * body.positions[v];
    }
    r.centre /= mass;
    Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
    for (std::size_t v = 0; v < body.positions.size(); ++v) {
        const Vec3 d = body.positions[v] - r.centre;
        inertia += body.masses[v] * (d.squaredNorm() * Eigen::Matrix3d::Identity() - d * d.transpose());
    }
    r.inverse_mass = 1 / mass;
    if (inertia.determinant() > 0) r.inverse_inertia = inertia.inverse() / turn_cost;
    return r;
}

// Moves a body by its shift and turn, but no vertex further than about `most`.
void move(SoftBody& body, const Rigid& r, double most) {
    const double angle = r.turn.norm();
    if (r.inverse_mass == 0 || angle + r.shift.norm() == 0) return;
    double size = 0;
    for (const Vec3& x : body.positions) size = std::max(size, (x - r.centre).norm());
    const double part = std::min(1.0, most / (r.shift.norm() + angle * size));
    Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
    if (angle > 0) rotation = Eigen::AngleAxisd(part * angle, r.turn / angle).toRotationMatrix();
    for (Vec3& x : body.positions) x = r.centre + part * r.shift + rotation * (x - r.centre);
}

// A contact between such bodies.
struct Row {
    std::uint32_t a, b;
    Vec3 normal, turn_a, turn_b; // arm x normal
    double depth, denominator, impulse;
};

// Projected Gauss-Seidel.
void solve(Array<Rigid>& rigid, Array<Row>& rows) {
    for (int sweep = 0; sweep < 10; ++sweep)
        for (Row& row : rows) {
            Rigid &a = rigid[row.a], &b = rigid[row.b];
            const double rest = row.depth - row.normal.dot(a.shift - b.shift) - row.turn_a.dot(a.turn) +
                                row.turn_b.dot(b.turn);
            const double impulse = std::max(-row.impulse, rest / row.denominator);
            row.impulse += impulse;
            a.shift += (impulse * a.inverse_mass) * row.normal;
            b.shift -= (impulse * b.inverse_mass) * row.normal;
            a.turn += impulse * (a.inverse_inertia * row.turn_a);
            b.turn -= impulse * (b.inverse_inertia * row.turn_b);
        }
}

// Six times the volume of a tetrahedron.
double volume6_at(const Vec3* x, const std::uint32_t* c) {
    return volume6(x[c[0]], x[c[1]], x[c[2]], x[c[3]]);
}

} // namespace

// ---- movement -------------------------------------------------------------------------------------

// Sweeps over edges would move a whole body only after many iterations.
void Resolver::move_as_a_whole() {
    const auto stays_or_is_solid = [&](const SoftBody& body) { return body.fixed || member_of(body).solid; };
    Array<Rigid> rigid(bodies_.size(), Rigid{}, &memory_);
    for (const auto& body : bodies_)
        if (!body->fixed && member_of(*body).solid) rigid[body->slot] = rigid_of(*body);
    Array<Row> rows(&memory_);
    double deepest = 0;
    for (const Contact& c : contacts_) {
        if (c.a == c.b || !stays_or_is_solid(*c.a) || !stays_or_is_solid(*c.b)) continue;
        Vec3 point = Vec3::Zero();
        for (std::uint32_t i = 0; i < c.count_a; ++i) point += c.weights[i] * c.a->positions[c.vertices[i]];
        const Rigid &a = rigid[c.a->slot], &b = rigid[c.b->slot];
        const Vec3 turn_a = (point - a.centre).cross(c.direction),
                   turn_b = (point - b.centre).cross(c.direction);
        const double denominator = a.inverse_mass + b.inverse_mass + turn_a.dot(a.inverse_inertia * turn_a) +
                                   turn_b.dot(b.inverse_inertia * turn_b);
        rows.push_back({c.a->slot, c.b->slot, c.direction, turn_a, turn_b, depth_of(c), denominator, 0});
        deepest = std::max(deepest, rows.back().depth);
    }
    solve(rigid, rows);
    for (const auto& body : bodies_) move(*body, rigid[body->slot], deepest);
}

// Gives a closed surface the volume back that it had at first.
void Resolver::keep_volume(SoftBody& body) {
    const Member& member = member_of(body);
    if (!body.tets.empty() || !member.solid || body.fixed) return;
    gradients_.assign(body.positions.size(), Vec3::Zero());
    Vec3* x = body.positions.data();
    for (const Corners& t : member.triangles) {
        const Vec3 normal = (x[t[1]] - x[t[0]]).cross(x[t[2]] - x[t[0]]) / 6;
        for (const std::uint32_t v : t) gradients_[v] += normal;
    }
    double answer = 0;
    for (std::size_t v = 0; v < gradients_.size(); ++v)
        answer += body.inverse_masses[v] * gradients_[v].squaredNorm();
    if (!(answer > 0)) return;
    const double lambda = (member.volume - volume_inside(x, member.triangles)) / answer;
    for (std::size_t v = 0; v < gradients_.size(); ++v)
        x[v] += (lambda * body.inverse_masses[v]) * gradients_[v];
}

void Resolver::relax() {
    for (const auto& body : bodies_) body->previous = body->positions;
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        for (const auto& body : bodies_) {
            solve_edges(*body);
            solve_volumes(*body);
            keep_volume(*body);
        }
        solve_contacts(contacts_, 0, {.friction = 0, .compliance = 0, .push_speed = 1e60, .slop = 0}, 1);
    }
}

// Keeps vertices within max_move of `from`, or within `limits`.
void Resolver::keep_near(const Array<Vec3>& from, const Array<double>* limits) {
    for (std::size_t b = 0; b < bodies_.size(); ++b)
        for (std::size_t i = 0; i < bodies_[b]->positions.size(); ++i) {
            const std::size_t v = members_[b].first + i;
            const double most = limits ? 0.99 * (*limits)[v] : desc_.max_move;
            const Vec3 moved = bodies_[b]->positions[i] - from[v];
            const double length = moved.norm();
            if (length > most) bodies_[b]->positions[i] = from[v] + (most / length) * moved;
        }
}

// Pushes overlaps out. As long as moving whole bodies makes the greatest depth smaller, they keep their
// shapes.
void Resolver::push_out() {
    double least_depth = std::numeric_limits<double>::infinity();
    std::uint64_t least = UINT64_MAX, since = 0;
    bool only_whole = true;
    for (std::uint32_t i = 0; find_overlaps() && i < desc_.max_iterations && since < patience; ++i) {
        if (contacts_.empty()) break; // nothing that overlaps can move
        const std::uint64_t left = report_.inside_vertices + report_.crossings;
        since = left < least ? 0 : since + 1;
        least = std::min(least, left);
        only_whole = only_whole && deepest_ > 0 && deepest_ < 0.95 * least_depth;
        least_depth = std::min(least_depth, deepest_);
        move_as_a_whole();
        if (!only_whole) {
            for (Contact& c : contacts_)
                c.slop = std::max(c.slop, c.slop + depth_of(c) -
                                              step_part * std::min(c.a->mean_edge, c.b->mean_edge));
            relax();
            // Cloth keeps its new folds, and so does what passed through itself.
            for (const auto& body : bodies_)
                if (body->tets.empty() && (!member_of(*body).solid || member_of(*body).overlaps_itself))
                    rest_as_it_is(*body, member_of(*body).first_bend);
        }
        if (desc_.max_move > 0) keep_near(start_, nullptr);
        ++report_.iterations;
    }
}

// Makes room for the gap, without new overlaps.
void Resolver::push_apart() {
    for (const auto& body : bodies_) rest_as_it_is(*body, 0);
    double best = 0;
    std::uint64_t since = 0;
    for (std::uint32_t i = 0; find_close() && i < desc_.max_iterations && since < patience; ++i) {
        if (contacts_.empty()) break;
        const double distance = report_.least_distance;
        since = distance > best ? 0 : since + 1;
        best = std::max(best, distance);
        check(vox_surface_find_clearances(surface_.get(), 2 * desc_.gap, clearances_.data()));
        relax();
        if (desc_.max_move > 0) keep_near(start_, nullptr);
        keep_near(all_, &clearances_);
        ++report_.iterations;
    }
}

void Resolver::run() {
    push_out();
    if (report_.crossings == 0 && desc_.gap > 0) push_apart();
}

void Resolver::write(std::span<vox_resolve_body> bodies, vox_resolve_report& report) {
    for (std::size_t b = 0; b < members_.size(); ++b) {
        const Member& member = members_[b];
        const SoftBody& body = *bodies_[b];
        vox_resolve_body& out = bodies[member.index];
        const Vec3 *before = &start_[member.first], *now = body.positions.data();
        out.moved_vertices = out.inverted_tets = 0;
        out.largest_move = 0;
        for (std::size_t v = 0; v < body.positions.size(); ++v) {
            const double moved = (now[v] - before[v]).norm();
            out.moved_vertices += moved > 0;
            out.largest_move = std::max(out.largest_move, moved);
            for (Eigen::Index axis = 0; axis < 3; ++axis)
                out.positions[3 * v + static_cast<std::size_t>(axis)] = now[v][axis];
        }
        out.volume_before = out.volume = 0;
        if (body.tets.empty() && member.solid) {
            out.volume_before = member.volume;
            out.volume = volume_inside(now, member.triangles);
        }
        for (std::size_t t = 0; t < body.tets.size(); t += 4) {
            const double first = volume6_at(before, &body.tets[t]), last = volume6_at(now, &body.tets[t]);
            out.volume_before += std::abs(first) / 6;
            out.volume += (first < 0 ? -last : last) / 6;
            out.inverted_tets += (first > 0) != (last > 0);
        }
        report_.largest_move = std::max(report_.largest_move, out.largest_move);
    }
    report_.resolved = report_.crossings + report_.inside_vertices + report_.close_pairs == 0;
    report_.struct_size = report.struct_size;
    std::memcpy(&report, &report_, std::min<std::size_t>(report.struct_size, sizeof report_));
}

} // namespace vox::sim
