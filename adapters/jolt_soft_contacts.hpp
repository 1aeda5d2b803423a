// Contacts between soft bodies of Jolt Physics (https://github.com/jrouwe/JoltPhysics), which has none of its own. Header
// only, C++17 without exceptions and RTTI, as Jolt is; link vox::vox and vox::io. Tried with Jolt 5.5.1 (commit
// 3b47ec39, 2026-06-30); CI tests it against a stand-in of what it uses.
//
//     #include <vox/adapters/jolt_soft_contacts.hpp>
//     vox::JoltSoftContacts contacts(physics_system); // listens to its steps
//     contacts.add(body_id);                          // for each soft body, while the system is not updated
//
// Before each step of the system, vertices inside another soft body, edges that cross, and vertices within a margin
// get impulses that end their approach, with friction, and are moved out. Linear and angular momentum of the bodies
// together are kept, and results do not depend on the number of threads.
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
    double margin = 0.02;    // in metres: vertices this close are kept from getting in
    double stiffness = 0.9;  // share of an impulse that moves the whole body as if it were rigid; the rest, its vertices
    double push = 0.2;       // share of a depth that a step takes away,
    double push_speed = 1;   // but at most so many metres in a second
    double foresight = 0.8;  // share of what drew contacts together within the last step that this step makes up for
    int iterations = 8;      // over all contacts of a step
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

    // Takes a soft body of the system in. Its tetrahedra are the given ones (four vertices each), else its volume
    // constraints, else a filling of its faces, which have to be closed. A body that leaves the system is forgotten.
    // VOX_OK, or an error that vox_last_error describes.
    vox_result add(const JPH::BodyID& id, std::vector<std::uint32_t> tets = {}, const vox_filter& filter = {}) {
        if (!grid_) return result_;
        JPH::Body* body = system_.GetBodyLockInterfaceNoLock().TryGetBody(id);
        if (!body || !body->IsSoftBody()) return VOX_ERROR_INVALID_HANDLE;
        Soft soft;
        soft.id = id;
        soft.body = body;
        const JPH::SoftBodySharedSettings& shared = *properties(*body).GetSettings();
        if (tets.empty())
            for (const auto& volume : shared.mVolumeConstraints)
                tets.insert(tets.end(), std::begin(volume.mVertex), std::end(volume.mVertex));
        if (tets.empty())
            if (const vox_result result = fill(soft, *body, tets)) return result;
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

    // What the last step found, for sounds or pictures: user_data of a body is its place in the order of `add`.
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

    // A change of velocity, or of place, of a body as if it were rigid.
    struct Motion {
        Vector linear, angular;
    };

    struct Soft {
        JPH::BodyID id;
        vox_body mesh = VOX_NULL_BODY;
        JPH::Body* body = nullptr;
        const void* bound = nullptr;         // the positions that the grid borrows
        std::vector<std::uint32_t> first;    // of a filling: where the shares of its vertices begin
        std::vector<Share> shares;
        std::vector<double> filling;         // positions of a filling
        std::vector<std::uint32_t> particle; // of each vertex in contact
        std::vector<JPH::Vec3> left;         // velocities with which the last step began
        bool touched = false;
        // Of the body as if it were rigid, in world axes:
        Matrix axes{}, inverse_inertia{};
        Vector centre{};
        double inverse_mass = 0, softness = 1;
        Motion impulse{}, move{};
    };

    // A vertex in contact: its velocity, how much Jolt changed that in the last step, and how it is changed now.
    struct Particle {
        std::uint32_t soft, vertex;
        double inverse_mass;
        Vector velocity, drawn;
        Vector impulse{}, move{};
    };

    struct Entry {
        std::uint32_t particle;
        double weight;
    };

    // A constraint, and how much it has given so far.
    struct Row {
        std::size_t begin, end; // entries_
        Soft *a, *b;
        Vector normal, arm_a, arm_b, velocity;
        double gap, wanted, inverse_mass, inverse_drag, friction;
        double impulse, push;
        Vector drag;
    };

    static JPH::SoftBodyMotionProperties& properties(JPH::Body& body) {
        return *static_cast<JPH::SoftBodyMotionProperties*>(body.GetMotionPropertiesUnchecked());
    }
    static Vector vector(JPH::Vec3Arg v) {
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
    static JPH::Vec3 to_local(const Soft& soft, const Vector& v) {
        return JPH::Vec3(static_cast<float>(dot(soft.axes[0], v)), static_cast<float>(dot(soft.axes[1], v)),
                         static_cast<float>(dot(soft.axes[2], v)));
    }

    // Fills the faces of a body with tetrahedra, whose vertices move with those of the body.
    static vox_result fill(Soft& soft, JPH::Body& body, std::vector<std::uint32_t>& tets) {
        std::vector<double> at;
        for (const JPH::SoftBodyVertex& v : properties(body).GetVertices())
            for (const double x : vector(v.mPosition)) at.push_back(x);
        std::vector<std::uint32_t> triangles;
        for (const auto& face : properties(body).GetSettings()->mFaces)
            triangles.insert(triangles.end(), std::begin(face.mVertex), std::end(face.mVertex));
        vox_io_mesh_view mesh{};
        mesh.positions = at.data();
        mesh.vertex_count = at.size() / 3;
        mesh.triangles = triangles.data();
        mesh.triangle_count = triangles.size() / 3;
        vox_io_mesh *surface = nullptr, *solid = nullptr;
        vox_io_tetrahedralize_desc desc = vox_default_io_tetrahedralize_desc();
        desc.cell = mean_edge(at, triangles);
        vox_result result = vox_io_mesh_create(&mesh, &surface);
        if (result == VOX_OK) result = vox_io_tetrahedralize(surface, &desc, &solid);
        if (result == VOX_OK) result = vox_io_mesh_get_arrays(solid, &mesh);
        if (result == VOX_OK) {
            tets.assign(mesh.tets, mesh.tets + 4 * mesh.tet_count);
            soft.filling.resize(3 * mesh.vertex_count);
            soft.first.push_back(0);
            for (const double* x = mesh.positions; x != mesh.positions + 3 * mesh.vertex_count; x += 3)
                share_out(soft, at, {x[0], x[1], x[2]});
        }
        vox_io_mesh_destroy(surface);
        vox_io_mesh_destroy(solid);
        return result;
    }

    static double mean_edge(const std::vector<double>& at, const std::vector<std::uint32_t>& triangles) {
        double sum = 0;
        for (std::size_t i = 0; i + 2 < triangles.size(); i += 3) {
            const double *a = &at[3 * triangles[i]], *b = &at[3 * triangles[i + 1]];
            sum += std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
        }
        return triangles.empty() ? 0 : 3 * sum / static_cast<double>(triangles.size());
    }

    // Weights of vertices for a point: the least squares of those that sum up to 1 and to the point, each measured by the
    // square of its vertex's distance. So a filling turns, shears and stretches as its body does (J. Warren and others use
    // such weights under the name of moving least squares; D. Shepard, 1968, the distances).
    static void share_out(Soft& soft, const std::vector<double>& at, const Vector& point) {
        const std::size_t count = at.size() / 3;
        std::vector<double> nearness(count);
        double system[4][5] = {};
        for (std::size_t i = 0; i < count; ++i) {
            const double row[4] = {1, at[3 * i] - point[0], at[3 * i + 1] - point[1], at[3 * i + 2] - point[2]};
            const double square = row[1] * row[1] + row[2] * row[2] + row[3] * row[3];
            nearness[i] = 1 / (square * square + 1e-24);
            for (int r = 0; r < 4; ++r)
                for (int c = 0; c < 4; ++c) system[r][c] += nearness[i] * row[r] * row[c];
        }
        system[0][4] = 1;
        solve(system);
        for (std::size_t i = 0; i < count; ++i) {
            const double weight = nearness[i] * (system[0][4] + system[1][4] * (at[3 * i] - point[0]) +
                                                 system[2][4] * (at[3 * i + 1] - point[1]) +
                                                 system[3][4] * (at[3 * i + 2] - point[2]));
            if (std::abs(weight) > 1e-3) soft.shares.push_back({static_cast<std::uint32_t>(i), weight});
        }
        double sum = 0;
        for (std::size_t s = soft.first.back(); s < soft.shares.size(); ++s) sum += soft.shares[s].weight;
        for (std::size_t s = soft.first.back(); s < soft.shares.size(); ++s) soft.shares[s].weight /= sum;
        soft.first.push_back(static_cast<std::uint32_t>(soft.shares.size()));
    }

    // Gauss's elimination with the largest pivots.
    static void solve(double (&a)[4][5]) {
        for (int k = 0; k < 4; ++k) {
            int pivot = k;
            for (int r = k; r < 4; ++r)
                if (std::abs(a[r][k]) > std::abs(a[pivot][k])) pivot = r;
            for (int c = 0; c < 5; ++c) std::swap(a[k][c], a[pivot][c]);
            if (a[k][k] == 0) continue;
            for (int r = 0; r < 4; ++r) {
                const double factor = r == k ? 0 : a[r][k] / a[k][k];
                for (int c = k; c < 5; ++c) a[r][c] -= factor * a[k][c];
            }
        }
        for (int k = 0; k < 4; ++k) a[k][4] = a[k][k] == 0 ? 0 : a[k][4] / a[k][k];
    }

    // Jolt's own array or, of a filling, its positions now.
    static vox_positions positions_of(Soft& soft) {
        const auto& vertices = properties(*soft.body).GetVertices();
        vox_positions positions{};
        if (soft.first.empty()) {
            positions.data = &vertices[0].mPosition;
            positions.count = vertices.size();
            positions.byte_stride = sizeof vertices[0];
        } else {
            std::fill(soft.filling.begin(), soft.filling.end(), 0.0);
            for (std::size_t i = 0; i + 1 < soft.first.size(); ++i)
                for (std::uint32_t s = soft.first[i]; s < soft.first[i + 1]; ++s) {
                    const Vector at = vector(vertices[soft.shares[s].vertex].mPosition);
                    for (std::size_t k = 0; k < 3; ++k) soft.filling[3 * i + k] += soft.shares[s].weight * at[k];
                }
            positions = vox_double_positions(soft.filling.data(), soft.filling.size() / 3);
        }
        soft.bound = positions.data;
        return positions;
    }

    // Tells the grid where the bodies are, and finds their contacts.
    vox_result find() {
        for (Soft& soft : bodies_) {
            soft.body = system_.GetBodyLockInterfaceNoLock().TryGetBody(soft.id);
            if (!soft.body) {
                if (vox_body_is_valid(grid_.get(), soft.mesh)) vox_body_remove(grid_.get(), soft.mesh);
                continue;
            }
            const void* before = soft.bound;
            const vox_positions positions = positions_of(soft);
            if (positions.data != before)
                if (const vox_result result = vox_mesh_bind_positions(grid_.get(), soft.mesh, &positions)) return result;
            const JPH::RMat44 m = soft.body->GetCenterOfMassTransform();
            double matrix[12];
            for (JPH::uint r = 0; r < 3; ++r) {
                for (JPH::uint c = 0; c < 3; ++c)
                    matrix[4 * r + c] = soft.axes[c][r] = static_cast<double>(m.GetColumn3(c)[r]);
                matrix[4 * r + 3] = static_cast<double>(m.GetTranslation()[r]);
            }
            if (const vox_result result = vox_body_set_transform(grid_.get(), soft.mesh, matrix)) return result;
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
            if (soft.body) finish(soft);
    }

    void add_row(const vox_constraint& c, double seconds) {
        Soft &a = bodies_[c.user_data_a], &b = bodies_[c.user_data_b];
        if (!a.body->IsActive() && !b.body->IsActive()) return;
        if (!a.body->IsActive()) system_.GetBodyInterfaceNoLock().ActivateBody(a.id);
        if (!b.body->IsActive()) system_.GetBodyInterfaceNoLock().ActivateBody(b.id);
        if (!a.touched) touch(a);
        if (!b.touched) touch(b);
        Row row{};
        row.a = &a;
        row.b = &b;
        row.begin = entries_.size();
        for (std::uint32_t i = 0; i < c.count; ++i) {
            Soft& soft = i < c.count_a ? a : b;
            const std::uint32_t v = c.vertices[i];
            if (soft.first.empty())
                entries_.push_back({particle(soft, v), c.weights[i]});
            else
                for (std::uint32_t s = soft.first[v]; s < soft.first[v + 1]; ++s)
                    entries_.push_back({particle(soft, soft.shares[s].vertex), c.weights[i] * soft.shares[s].weight});
        }
        row.end = entries_.size();
        std::copy(std::begin(c.normal), std::end(c.normal), row.normal.begin());
        const Vector at = {c.position[0], c.position[1], c.position[2]};
        row.arm_a = sum(at, -1, a.centre);
        row.arm_b = sum(sum(at, -c.gap, row.normal), -1, b.centre);
        row.gap = c.gap;
        Vector drawn{};
        for (std::size_t e = row.begin; e < row.end; ++e) {
            const Particle& p = particles_[entries_[e].particle];
            row.velocity = sum(row.velocity, entries_[e].weight, p.velocity);
            drawn = sum(drawn, entries_[e].weight, p.drawn);
            row.inverse_mass += entries_[e].weight * entries_[e].weight * p.inverse_mass;
        }
        row.inverse_drag = row.inverse_mass;
        for (const auto& [soft, arm] : {std::pair<Soft*, Vector>(&a, row.arm_a), {&b, row.arm_b}}) {
            const Vector turn = cross(arm, row.normal);
            row.inverse_mass += soft->inverse_mass + dot(turn, times(soft->inverse_inertia, turn));
            row.inverse_drag += soft->inverse_mass + dot(arm, arm) * (soft->inverse_inertia[0][0] + soft->inverse_inertia[1][1] +
                                                                      soft->inverse_inertia[2][2]);
        }
        row.friction = std::sqrt(static_cast<double>(a.body->GetFriction() * b.body->GetFriction())); // as Jolt does
        // Jolt solves what holds the bodies together after this, and that draws points onto each other: presumably as
        // much as in the last step.
        row.wanted = settings_.foresight * std::max(0.0, -dot(drawn, row.normal)) - std::max(0.0, c.gap) / seconds;
        if (row.inverse_mass > 0) rows_.push_back(row);
    }

    // Readies a body for contacts: mass, centre and inertia. A body with fixed vertices is not moved as a whole.
    void touch(Soft& soft) {
        const auto& vertices = properties(*soft.body).GetVertices();
        soft.touched = true;
        soft.particle.assign(vertices.size(), VOX_NONE);
        soft.left.resize(vertices.size(), JPH::Vec3::sZero());
        soft.impulse = soft.move = {};
        soft.inverse_mass = 0;
        soft.inverse_inertia = {};
        double mass = 0;
        Vector first{}, square{}, mixed{};
        bool fixed = false;
        for (const JPH::SoftBodyVertex& v : vertices) {
            fixed = fixed || !(v.mInvMass > 0);
            const double m = 1 / static_cast<double>(v.mInvMass);
            const Vector x = vector(v.mPosition);
            mass += m;
            first = sum(first, m, x);
            square = sum(square, m, {x[0] * x[0], x[1] * x[1], x[2] * x[2]});
            mixed = sum(mixed, m, {x[1] * x[2], x[2] * x[0], x[0] * x[1]});
        }
        soft.softness = fixed ? 1 : 1 - settings_.stiffness;
        if (fixed) return;
        const Vector c = {first[0] / mass, first[1] / mass, first[2] / mass};
        Matrix inertia;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
            inertia[k][k] = square[i] + square[j] - mass * (c[i] * c[i] + c[j] * c[j]);
            inertia[i][j] = inertia[j][i] = mass * c[i] * c[j] - mixed[k];
        }
        // The inverse: its rows are products of the columns. Then from the body's axes to the world's.
        Matrix inverse = {cross(inertia[1], inertia[2]), cross(inertia[2], inertia[0]), cross(inertia[0], inertia[1])};
        const double determinant = dot(inertia[0], inverse[0]);
        soft.inverse_mass = settings_.stiffness / mass;
        const JPH::RVec3 origin = soft.body->GetCenterOfMassTransform().GetTranslation();
        soft.centre = sum({static_cast<double>(origin.GetX()), static_cast<double>(origin.GetY()), static_cast<double>(origin.GetZ())},
                          1, times(soft.axes, c));
        if (determinant > 0)
            for (std::size_t k = 0; k < 3; ++k) {
                const Vector axis = {soft.axes[0][k], soft.axes[1][k], soft.axes[2][k]};
                soft.inverse_inertia[k] = sum({}, settings_.stiffness / determinant, times(soft.axes, times(inverse, axis)));
            }
    }

    // The place of a vertex among those in contact.
    std::uint32_t particle(Soft& soft, std::uint32_t v) {
        std::uint32_t& place = soft.particle[v];
        if (place == VOX_NONE) {
            place = static_cast<std::uint32_t>(particles_.size());
            const JPH::SoftBodyVertex& vertex = properties(*soft.body).GetVertex(v);
            particles_.push_back({static_cast<std::uint32_t>(&soft - bodies_.data()), v,
                                  soft.softness * static_cast<double>(vertex.mInvMass),
                                  times(soft.axes, vector(vertex.mVelocity)),
                                  times(soft.axes, vector(vertex.mVelocity - soft.left[v]))});
        }
        return place;
    }

    // How a row's point of body a was moved, as seen from body b.
    Vector change(const Row& row, Vector Particle::*part, Motion Soft::*whole) const {
        const Motion &a = row.a->*whole, &b = row.b->*whole;
        Vector total = sum(sum(a.linear, 1, cross(a.angular, row.arm_a)), -1, sum(b.linear, 1, cross(b.angular, row.arm_b)));
        for (std::size_t e = row.begin; e < row.end; ++e)
            total = sum(total, entries_[e].weight, particles_[entries_[e].particle].*part);
        return total;
    }

    // Gives a momentum, or a mass times a way, to a row's point of body a, and its opposite to that of body b.
    void give(const Row& row, Vector Particle::*part, Motion Soft::*whole, double factor, const Vector& direction) {
        for (std::size_t e = row.begin; e < row.end; ++e) {
            Particle& p = particles_[entries_[e].particle];
            p.*part = sum(p.*part, factor * entries_[e].weight * p.inverse_mass, direction);
        }
        turn(*row.a, whole, row.arm_a, factor, direction);
        turn(*row.b, whole, row.arm_b, -factor, direction);
    }
    static void turn(Soft& soft, Motion Soft::*whole, const Vector& arm, double factor, const Vector& direction) {
        Motion& motion = soft.*whole;
        motion.linear = sum(motion.linear, factor * soft.inverse_mass, direction);
        motion.angular = sum(motion.angular, factor, times(soft.inverse_inertia, cross(arm, direction)));
    }

    // Ends the approach of the two points, and their sliding by Coulomb's law.
    void brake(Row& row) {
        Vector v = sum(row.velocity, 1, change(row, &Particle::impulse, &Soft::impulse));
        const double impulse = std::max(0.0, row.impulse + (row.wanted - dot(v, row.normal)) / row.inverse_mass);
        if (impulse != row.impulse) give(row, &Particle::impulse, &Soft::impulse, impulse - row.impulse, row.normal);
        row.impulse = impulse;
        if (impulse == 0 && dot(row.drag, row.drag) == 0) return;
        v = sum(row.velocity, 1, change(row, &Particle::impulse, &Soft::impulse));
        Vector drag = sum(row.drag, -1 / row.inverse_drag, sum(v, -dot(v, row.normal), row.normal));
        const double most = row.friction * row.impulse, size = std::sqrt(dot(drag, drag));
        if (size > most) drag = sum({}, most / size, drag);
        give(row, &Particle::impulse, &Soft::impulse, 1, sum(drag, -1, row.drag));
        row.drag = drag;
    }

    void push_out(Row& row, double seconds) {
        const double way = std::min(-settings_.push * row.gap, settings_.push_speed * seconds);
        const double left = way - dot(change(row, &Particle::move, &Soft::move), row.normal);
        const double push = std::max(0.0, row.push + left / row.inverse_mass);
        if (push != row.push) give(row, &Particle::move, &Soft::move, push - row.push, row.normal);
        row.push = push;
    }

    void finish(Soft& soft) {
        auto& vertices = properties(*soft.body).GetVertices();
        soft.left.resize(vertices.size());
        if (soft.touched) {
            const Vector origin = [&] { const JPH::RVec3 o = soft.body->GetCenterOfMassTransform().GetTranslation(); return Vector{static_cast<double>(o.GetX()), static_cast<double>(o.GetY()), static_cast<double>(o.GetZ())}; }();
            const JPH::Vec3 centre = to_local(soft, sum(soft.centre, -1, origin));
            const JPH::Vec3 velocity = to_local(soft, soft.impulse.linear), spin = to_local(soft, soft.impulse.angular);
            const JPH::Vec3 way = to_local(soft, soft.move.linear), turn = to_local(soft, soft.move.angular);
            for (std::size_t v = 0; v < vertices.size(); ++v) {
                JPH::SoftBodyVertex& vertex = vertices[v];
                const JPH::Vec3 arm = vertex.mPosition - centre;
                JPH::Vec3 impulse = velocity + spin.Cross(arm), move = way + turn.Cross(arm);
                if (soft.particle[v] != VOX_NONE) {
                    impulse += to_local(soft, particles_[soft.particle[v]].impulse);
                    move += to_local(soft, particles_[soft.particle[v]].move);
                }
                vertex.mVelocity += impulse;
                vertex.mPosition += move;
            }
            soft.touched = false;
        }
        for (std::size_t v = 0; v < vertices.size(); ++v) soft.left[v] = vertices[v].mVelocity;
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
