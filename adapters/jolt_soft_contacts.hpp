// Contacts between soft bodies of Jolt Physics (https://github.com/jrouwe/JoltPhysics), which has none of its
// own. Header only, C++17 without exceptions and RTTI, as Jolt is; link vox::vox and vox::io. Tried with
// Jolt 5.5.1 (commit 3b47ec39, 2026-06-30); CI tests it against a stand-in of what it uses.
//
//     #include <vox/adapters/jolt_soft_contacts.hpp>
//     vox::JoltSoftContacts contacts(physics_system); // listens to its steps
//     contacts.add(body_id);                          // for each soft body, while the system is not updated
//
// Before each step of the system, vertices inside another soft body, edges that cross, and vertices within a
// margin get impulses that end their approach, with friction, and are moved out. Linear and angular momentum
// of the bodies together are kept, and results do not depend on the number of threads.
#pragma once

#include <Jolt/Jolt.h>

#include <Jolt/Physics/Body/Body.h>
#include <Jolt/Physics/Body/BodyInterface.h>
#include <Jolt/Physics/Body/BodyLockInterface.h>
#include <Jolt/Physics/PhysicsStepListener.h>
#include <Jolt/Physics/PhysicsSystem.h>
#include <Jolt/Physics/SoftBody/SoftBodyMotionProperties.h>
#include <Jolt/Physics/SoftBody/SoftBodySharedSettings.h>

#include <vox/vox.h>
#include <vox/vox_io.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <memory>
#include <utility>
#include <vector>

namespace vox {

struct JoltSoftContactSettings {
    double margin = 0.01;    // in metres: vertices this close are kept from getting in
    double stiffness = 0.98; // share of an impulse that moves the whole body as if it were rigid
    double foresight =
        0.9;           // share of what drew contacts together in the last step that this one makes up for
    double push = 0.5; // share of a depth that a step takes away,
    double push_speed = 0.5;        // but at most so many metres in a second
    int iterations = 8;             // over all contacts of a step
    std::uint32_t worker_count = 1; // threads that look for contacts; VOX_ALL_CORES
};

class JoltSoftContacts final : public JPH::PhysicsStepListener {
public:
    explicit JoltSoftContacts(JPH::PhysicsSystem& system, const JoltSoftContactSettings& settings = {})
        : system_(system), settings_(settings) {
        vox_grid_desc desc = vox_default_grid_desc();
        desc.flags = VOX_GRID_CONSTRAINTS | VOX_GRID_EDGES;
        desc.margin = settings.margin;
        desc.worker_count = settings.worker_count;
        vox_grid* grid = nullptr;
        result_ = vox_grid_create(&desc, &grid);
        grid_.reset(grid);
        system_.AddStepListener(this);
    }
    ~JoltSoftContacts() override { system_.RemoveStepListener(this); }
    JoltSoftContacts(const JoltSoftContacts&) = delete;
    JoltSoftContacts& operator=(const JoltSoftContacts&) = delete;

    // Takes a soft body of the system in. Its tetrahedra are the given ones (four vertices each), else its
    // volume constraints, else a filling of its faces, which have to be closed. A body that leaves the system
    // is forgotten. VOX_OK, or an error that vox_last_error describes.
    vox_result add(const JPH::BodyID& id, std::vector<std::uint32_t> tets = {},
                   const vox_filter& filter = {}) {
        if (!grid_) return result_;
        Soft soft;
        soft.id = id;
        soft.body = system_.GetBodyLockInterfaceNoLock().TryGetBody(id);
        if (!soft.body || !soft.body->IsSoftBody()) return VOX_ERROR_INVALID_HANDLE;
        const JPH::SoftBodyMotionProperties& properties = properties_of(soft);
        if (tets.empty())
            for (const auto& volume : properties.GetSettings()->mVolumeConstraints)
                tets.insert(tets.end(), std::begin(volume.mVertex), std::end(volume.mVertex));
        if (tets.empty())
            if (const vox_result result = fill(soft, tets)) return result;
        place(soft);
        remember(soft);
        vox_mesh_desc desc = vox_default_mesh_desc();
        desc.positions = positions_of(soft);
        desc.tets = tets.data();
        desc.tet_count = tets.size() / 4;
        desc.user_data = bodies_.size();
        desc.filter = filter;
        if (const vox_result result = vox_mesh_insert(grid_.get(), &desc, &soft.mesh)) return result;
        bodies_.push_back(std::move(soft));
        return VOX_OK;
    }

    // What the last step found, for sounds or pictures: user_data of a body is its place in the order of
    // `add`.
    const vox_grid* grid() const { return grid_.get(); }

    // Of the last step. A step that fails, e.g. by a position that is not finite, gives no impulses.
    vox_result result() const { return result_; }

    void OnStep(const JPH::PhysicsStepListenerContext& context) override {
        if (!grid_) return;
        result_ = find();
        if (result_ == VOX_OK) respond(static_cast<double>(context.mDeltaTime));
    }

private:
    using Vector = std::array<double, 3>;
    using Matrix = std::array<Vector, 3>; // of columns

    struct GridDeleter {
        void operator()(vox_grid* grid) const { vox_grid_destroy(grid); }
    };

    // A share of a vertex of the mesh in a vertex of the body.
    struct Share {
        std::uint32_t vertex;
        double weight;
    };

    // What contacts change: a body as if it were rigid, and each vertex beyond that.
    enum Change : std::size_t { VELOCITY, PLACE };

    struct Motion {
        Vector linear{}, angular{};
    };

    struct Soft {
        JPH::BodyID id;
        JPH::Body* body = nullptr;
        vox_body mesh = VOX_NULL_BODY;
        std::vector<JPH::Real> world;     // positions of the mesh
        std::vector<std::uint32_t> first; // of a filling: where the shares of its vertices begin
        std::vector<Share> shares;
        std::vector<JPH::Vec3> left;         // velocities with which the last step began
        std::vector<std::uint32_t> particle; // of each vertex in contact
        bool touched = false, fixed = false; // in contact; with vertices that never move
        // The body as if it were rigid. The axes are the columns of its rotation; all else is in world axes,
        // or, of the centre, from its origin.
        Matrix axes{}, inverse_inertia{};
        Vector origin{}, centre{};
        double inverse_mass = 0;
        Motion changes[2];
    };

    // A vertex in contact: its velocity, and how much Jolt changed that in the last step.
    struct Particle {
        Vector velocity, drawn;
        double inverse_mass[2];
        Vector changes[2];
    };

    struct Entry {
        std::uint32_t particle;
        double weight;
    };

    // A constraint, and how much it has given so far.
    struct Row {
        std::size_t begin = 0, end = 0; // of its entries
        Soft *a = nullptr, *b = nullptr;
        Vector normal{}, arm_a{}, arm_b{}, velocity{};
        double gap = 0, wanted = 0, friction = 0, inverse_mass[2] = {}, inverse_drag = 0;
        double given[2] = {};
        Vector drag{};
    };

    static JPH::SoftBodyMotionProperties& properties_of(const Soft& soft) {
        return *static_cast<JPH::SoftBodyMotionProperties*>(soft.body->GetMotionPropertiesUnchecked());
    }
    static vox_positions positions_of(const Soft& soft) {
        return positions_of(soft.world.data(), soft.world.size() / 3);
    }
    static vox_positions positions_of(const float* xyz, std::size_t count) {
        return vox_float_positions(xyz, count);
    }
    static vox_positions positions_of(const double* xyz, std::size_t count) {
        return vox_double_positions(xyz, count);
    }

    template <typename Three> // JPH::Vec3 or RVec3
    static Vector vector(const Three& v) {
        return {static_cast<double>(v.GetX()), static_cast<double>(v.GetY()), static_cast<double>(v.GetZ())};
    }
    static double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
    static Vector cross(const Vector& a, const Vector& b) {
        return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    }
    static Vector sum(const Vector& a, double factor, const Vector& b) {
        return {a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]};
    }
    static Vector times(const Matrix& m, const Vector& v) {
        return sum(sum(sum({}, v[0], m[0]), v[1], m[1]), v[2], m[2]);
    }
    // Of a symmetric matrix: 0 if it is singular.
    static Matrix inverse(const Matrix& m) {
        Matrix i = {cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1])};
        const double determinant = dot(m[0], i[0]), size = m[0][0] + m[1][1] + m[2][2];
        for (Vector& column : i)
            column = sum({}, determinant > 1e-12 * size * size * size ? 1 / determinant : 0, column);
        return i;
    }
    static JPH::Vec3 to_local(const Soft& soft, const Vector& v) {
        return JPH::Vec3(static_cast<float>(dot(soft.axes[0], v)), static_cast<float>(dot(soft.axes[1], v)),
                         static_cast<float>(dot(soft.axes[2], v)));
    }

    // Fills the faces of a body with tetrahedra, whose vertices move with those of the body.
    static vox_result fill(Soft& soft, std::vector<std::uint32_t>& tets) {
        std::vector<double> at;
        for (const JPH::SoftBodyVertex& v : properties_of(soft).GetVertices())
            for (const double x : vector(v.mPosition)) at.push_back(x);
        std::vector<std::uint32_t> triangles;
        double edges = 0;
        for (const auto& face : properties_of(soft).GetSettings()->mFaces) {
            triangles.insert(triangles.end(), std::begin(face.mVertex), std::end(face.mVertex));
            const double *a = &at[3 * face.mVertex[0]], *b = &at[3 * face.mVertex[1]];
            edges += std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
        }
        vox_io_mesh_view mesh{};
        mesh.positions = at.data();
        mesh.vertex_count = at.size() / 3;
        mesh.triangles = triangles.data();
        mesh.triangle_count = triangles.size() / 3;
        vox_io_mesh *surface = nullptr, *solid = nullptr;
        vox_io_tetrahedralize_desc desc = vox_default_io_tetrahedralize_desc();
        desc.cell = mesh.triangle_count ? edges / static_cast<double>(mesh.triangle_count) : 0;
        vox_result result = vox_io_mesh_create(&mesh, &surface);
        if (result == VOX_OK) result = vox_io_tetrahedralize(surface, &desc, &solid);
        if (result == VOX_OK) result = vox_io_mesh_get_arrays(solid, &mesh);
        if (result == VOX_OK) {
            tets.assign(mesh.tets, mesh.tets + 4 * mesh.tet_count);
            soft.first.push_back(0);
            for (const double* x = mesh.positions; x != mesh.positions + 3 * mesh.vertex_count; x += 3)
                share_out(soft, at, {x[0], x[1], x[2]});
        }
        vox_io_mesh_destroy(surface);
        vox_io_mesh_destroy(solid);
        return result;
    }

    // Weights of a body's vertices for a point, by moving least squares (P. Lancaster and K. Salkauskas,
    // 1981): they sum up to 1 and to the point, so that a filling turns, shears and stretches as its body
    // does.
    static void share_out(Soft& soft, const std::vector<double>& at, const Vector& point) {
        std::vector<double> nearness;
        double total = 0;
        Vector mean{};
        for (std::size_t i = 0; i < at.size(); i += 3) {
            const Vector x = {at[i], at[i + 1], at[i + 2]}, to = sum(x, -1, point);
            nearness.push_back(1 / (dot(to, to) * dot(to, to) + 1e-24));
            total += nearness.back();
            mean = sum(mean, nearness.back(), x);
        }
        mean = sum({}, 1 / total, mean);
        Matrix spread{};
        for (std::size_t i = 0; i < at.size(); i += 3) {
            const Vector to = sum({at[i], at[i + 1], at[i + 2]}, -1, mean);
            for (std::size_t k = 0; k < 3; ++k)
                spread[k] = sum(spread[k], nearness[i / 3] / total * to[k], to);
        }
        const Vector slope = times(inverse(spread), sum(point, -1, mean));
        const std::size_t begin = soft.shares.size();
        double kept = 0;
        for (std::size_t i = 0; i < at.size(); i += 3) {
            const Vector to = sum({at[i], at[i + 1], at[i + 2]}, -1, mean);
            const double weight = nearness[i / 3] / total * (1 + dot(to, slope));
            if (std::abs(weight) < 1e-3) continue;
            soft.shares.push_back({static_cast<std::uint32_t>(i / 3), weight});
            kept += weight;
        }
        for (std::size_t s = begin; s < soft.shares.size(); ++s) soft.shares[s].weight /= kept;
        soft.first.push_back(static_cast<std::uint32_t>(soft.shares.size()));
    }

    // Where the body and its mesh are.
    static void place(Soft& soft) {
        const auto& vertices = properties_of(soft).GetVertices();
        const JPH::RMat44 m = soft.body->GetCenterOfMassTransform();
        for (JPH::uint k = 0; k < 3; ++k) soft.axes[k] = vector(m.GetColumn3(k));
        soft.origin = vector(m.GetTranslation());
        const std::size_t count = soft.first.empty() ? vertices.size() : soft.first.size() - 1;
        soft.world.resize(3 * count);
        for (std::size_t i = 0; i < count; ++i) {
            Vector at{};
            if (soft.first.empty())
                at = vector(vertices[i].mPosition);
            else
                for (std::uint32_t s = soft.first[i]; s < soft.first[i + 1]; ++s)
                    at = sum(at, soft.shares[s].weight, vector(vertices[soft.shares[s].vertex].mPosition));
            at = sum(soft.origin, 1, times(soft.axes, at));
            for (std::size_t k = 0; k < 3; ++k) soft.world[3 * i + k] = static_cast<JPH::Real>(at[k]);
        }
    }

    static void remember(Soft& soft) {
        soft.left.clear();
        for (const JPH::SoftBodyVertex& v : properties_of(soft).GetVertices())
            soft.left.push_back(v.mVelocity);
    }

    // Tells the grid where the bodies are, and finds their contacts.
    vox_result find() {
        for (Soft& soft : bodies_) {
            soft.body = system_.GetBodyLockInterfaceNoLock().TryGetBody(soft.id);
            if (!vox_body_is_valid(grid_.get(), soft.mesh)) continue;
            if (soft.body) {
                place(soft);
                const bool there = soft.body->IsInBroadPhase();
                if (const vox_result result = vox_body_set_enabled(grid_.get(), soft.mesh, there))
                    return result;
            } else {
                vox_body_remove(grid_.get(), soft.mesh);
                soft = {};
            }
        }
        return vox_grid_step(grid_.get());
    }

    void respond(double seconds) {
        vox_constraint_view found{};
        vox_grid_get_constraints(grid_.get(), &found);
        rows_.clear();
        entries_.clear();
        particles_.clear();
        for (std::uint64_t n = 0; n < found.count; ++n) add_row(found.data[n], seconds);
        for (int i = 0; i < settings_.iterations; ++i)
            for (Row& row : rows_) {
                brake(row);
                if (row.gap < 0) push_out(row, seconds);
            }
        for (Soft& soft : bodies_)
            if (soft.body) {
                if (soft.touched) finish(soft);
                remember(soft);
            }
    }

    void add_row(const vox_constraint& c, double seconds) {
        Row row;
        row.a = &bodies_[c.user_data_a];
        row.b = &bodies_[c.user_data_b];
        JPH::Body &a = *row.a->body, &b = *row.b->body;
        if (!a.IsActive() && !b.IsActive()) return;
        for (Soft* soft : {row.a, row.b}) {
            if (!soft->body->IsActive()) system_.GetBodyInterfaceNoLock().ActivateBody(soft->id);
            if (c.gap < -settings_.margin) soft->body->ResetSleepTimer();
            if (!soft->touched) touch(*soft);
        }
        row.begin = entries_.size();
        for (std::uint32_t i = 0; i < c.count; ++i)
            add_entries(i < c.count_a ? *row.a : *row.b, c.vertices[i], c.weights[i]);
        row.end = entries_.size();
        std::copy(std::begin(c.normal), std::end(c.normal), row.normal.begin());
        row.gap = c.gap;
        row.arm_a =
            sum(sum({c.position[0], c.position[1], c.position[2]}, -1, row.a->origin), -1, row.a->centre);
        row.arm_b = sum(sum(row.a->origin, -1, row.b->origin), 1,
                        sum(sum(row.arm_a, 1, row.a->centre), -1, row.b->centre));
        row.arm_b = sum(row.arm_b, -c.gap, row.normal);
        Vector drawn{};
        for (std::size_t e = row.begin; e < row.end; ++e) {
            const double weight = entries_[e].weight;
            const Particle& p = particles_[entries_[e].particle];
            row.velocity = sum(row.velocity, weight, p.velocity);
            drawn = sum(drawn, weight, p.drawn);
            for (const Change k : {VELOCITY, PLACE})
                row.inverse_mass[k] += weight * weight * p.inverse_mass[k];
        }
        row.inverse_drag = row.inverse_mass[VELOCITY];
        for (const auto& [soft, arm] : {std::make_pair(row.a, row.arm_a), std::make_pair(row.b, row.arm_b)}) {
            const Matrix& i = soft->inverse_inertia;
            const Vector turn = cross(arm, row.normal);
            for (double& w : row.inverse_mass) w += soft->inverse_mass + dot(turn, times(i, turn));
            row.inverse_drag += soft->inverse_mass + dot(arm, arm) * (i[0][0] + i[1][1] + i[2][2]);
        }
        row.friction = std::sqrt(static_cast<double>(a.GetFriction() * b.GetFriction())); // as Jolt does
        // Jolt solves what holds the bodies together after this, and that draws points onto each other:
        // presumably as much as in the last step.
        row.wanted =
            settings_.foresight * std::max(0.0, -dot(drawn, row.normal)) - std::max(0.0, c.gap) / seconds;
        if (row.inverse_mass[VELOCITY] > 0) rows_.push_back(row);
    }

    // Readies a body for contacts: mass, centre and inertia. One with fixed vertices is not moved as a whole.
    void touch(Soft& soft) {
        const auto& vertices = properties_of(soft).GetVertices();
        soft.touched = true;
        soft.fixed = false;
        soft.particle.assign(vertices.size(), VOX_NONE);
        for (Motion& motion : soft.changes) motion = {};
        double mass = 0;
        Vector first{};
        Matrix second{};
        for (const JPH::SoftBodyVertex& v : vertices) {
            soft.fixed = soft.fixed || !(v.mInvMass > 0);
            const double m = soft.fixed ? 0 : 1 / static_cast<double>(v.mInvMass);
            const Vector x = vector(v.mPosition);
            mass += m;
            first = sum(first, m, x);
            for (std::size_t k = 0; k < 3; ++k) second[k] = sum(second[k], m * x[k], x);
        }
        const double share = soft.fixed ? 0 : settings_.stiffness;
        const Vector centre = sum({}, 1 / std::max(mass, 1e-300), first);
        for (std::size_t k = 0; k < 3; ++k) second[k] = sum(second[k], -mass * centre[k], centre);
        const double trace = second[0][0] + second[1][1] + second[2][2];
        for (std::size_t k = 0; k < 3; ++k) {
            second[k] = sum({}, -1, second[k]);
            second[k][k] += trace;
        }
        const Matrix local = inverse(second);
        for (std::size_t k = 0; k < 3; ++k)
            soft.inverse_inertia[k] =
                sum({}, share,
                    times(soft.axes, times(local, {soft.axes[0][k], soft.axes[1][k], soft.axes[2][k]})));
        soft.inverse_mass = share / std::max(mass, 1e-300);
        soft.centre = times(soft.axes, centre);
    }

    void add_entries(Soft& soft, std::uint32_t v, double weight) {
        if (soft.first.empty())
            entries_.push_back({particle_of(soft, v), weight});
        else
            for (std::uint32_t s = soft.first[v]; s < soft.first[v + 1]; ++s)
                entries_.push_back(
                    {particle_of(soft, soft.shares[s].vertex), weight * soft.shares[s].weight});
    }

    std::uint32_t particle_of(Soft& soft, std::uint32_t v) {
        if (soft.particle[v] == VOX_NONE) {
            soft.particle[v] = static_cast<std::uint32_t>(particles_.size());
            const JPH::SoftBodyVertex& vertex = properties_of(soft).GetVertices()[v];
            const double inverse_mass = static_cast<double>(vertex.mInvMass);
            const Vector velocity = vector(vertex.mVelocity), drawn = sum(velocity, -1, vector(soft.left[v]));
            particles_.push_back({times(soft.axes, velocity),
                                  times(soft.axes, drawn),
                                  // A vertex pushed alone would spring back: that adds energy.
                                  {soft.fixed ? inverse_mass : (1 - settings_.stiffness) * inverse_mass,
                                   soft.fixed ? inverse_mass : 0},
                                  {}});
        }
        return soft.particle[v];
    }

    // How a row's point of body a was changed, as seen from body b.
    Vector changed(const Row& row, Change k) const {
        const Motion &a = row.a->changes[k], &b = row.b->changes[k];
        Vector total = sum(sum(a.linear, 1, cross(a.angular, row.arm_a)), -1,
                           sum(b.linear, 1, cross(b.angular, row.arm_b)));
        for (std::size_t e = row.begin; e < row.end; ++e)
            total = sum(total, entries_[e].weight, particles_[entries_[e].particle].changes[k]);
        return total;
    }

    // Gives a momentum, or a mass times a way, to a row's point of body a, and its opposite to that of body
    // b.
    void give(const Row& row, Change k, double factor, const Vector& direction) {
        for (std::size_t e = row.begin; e < row.end; ++e) {
            Particle& p = particles_[entries_[e].particle];
            p.changes[k] = sum(p.changes[k], factor * entries_[e].weight * p.inverse_mass[k], direction);
        }
        turn(*row.a, k, row.arm_a, factor, direction);
        turn(*row.b, k, row.arm_b, -factor, direction);
    }
    static void turn(Soft& soft, Change k, const Vector& arm, double factor, const Vector& direction) {
        Motion& motion = soft.changes[k];
        motion.linear = sum(motion.linear, factor * soft.inverse_mass, direction);
        motion.angular = sum(motion.angular, factor, times(soft.inverse_inertia, cross(arm, direction)));
    }
    // Gives as much along the normal as `missing` needs, and never pulls in sum.
    void give_normal(Row& row, Change k, double missing) {
        const double given = std::max(0.0, row.given[k] + missing / row.inverse_mass[k]);
        if (given != row.given[k]) give(row, k, given - row.given[k], row.normal);
        row.given[k] = given;
    }

    // Ends the approach of the two points, and their sliding by Coulomb's law.
    void brake(Row& row) {
        give_normal(row, VELOCITY,
                    row.wanted - dot(sum(row.velocity, 1, changed(row, VELOCITY)), row.normal));
        if (row.given[VELOCITY] == 0 && row.drag == Vector{}) return;
        const Vector v = sum(row.velocity, 1, changed(row, VELOCITY));
        Vector drag = sum(row.drag, -1 / row.inverse_drag, sum(v, -dot(v, row.normal), row.normal));
        const double most = row.friction * row.given[VELOCITY], size = std::sqrt(dot(drag, drag));
        if (size > most) drag = sum({}, most / size, drag);
        give(row, VELOCITY, 1, sum(drag, -1, row.drag));
        row.drag = drag;
    }

    void push_out(Row& row, double seconds) {
        const double way = std::min(-settings_.push * row.gap, settings_.push_speed * seconds);
        if (row.inverse_mass[PLACE] > 0) give_normal(row, PLACE, way - dot(changed(row, PLACE), row.normal));
    }

    // Hands the changes to Jolt.
    void finish(Soft& soft) {
        auto& vertices = properties_of(soft).GetVertices();
        const JPH::Vec3 centre = to_local(soft, soft.centre);
        JPH::Vec3 linear[2], angular[2];
        for (const Change k : {VELOCITY, PLACE}) {
            linear[k] = to_local(soft, soft.changes[k].linear);
            angular[k] = to_local(soft, soft.changes[k].angular);
        }
        for (std::size_t v = 0; v < vertices.size(); ++v) {
            const JPH::Vec3 arm = vertices[v].mPosition - centre;
            JPH::Vec3 change[2] = {linear[0] + angular[0].Cross(arm), linear[1] + angular[1].Cross(arm)};
            if (soft.particle[v] != VOX_NONE)
                for (const Change k : {VELOCITY, PLACE})
                    change[k] += to_local(soft, particles_[soft.particle[v]].changes[k]);
            vertices[v].mVelocity += change[VELOCITY];
            vertices[v].mPosition += change[PLACE];
        }
        soft.touched = false;
    }

    JPH::PhysicsSystem& system_;
    JoltSoftContactSettings settings_;
    std::unique_ptr<vox_grid, GridDeleter> grid_;
    std::vector<Soft> bodies_; // in the order of `add`
    std::vector<Row> rows_;
    std::vector<Entry> entries_;
    std::vector<Particle> particles_;
    vox_result result_ = VOX_OK;
};

} // namespace vox
