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
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <memory>
#include <utility>
#include <vector>

namespace vox {

struct JoltSoftContactSettings {
    double margin = 0.01;           // in metres: vertices this close are kept from getting in
    double stiffness = 0.98;        // share of an impulse that moves the whole body as if it were rigid
    double foresight = 0.85;        // share of what drew contacts together last, made up for in this step
    double push = 0.5;              // share of a depth that a step takes away,
    double push_speed = 0.2;        // but at most so many metres in a second
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
    // is forgotten. INVALID_HANDLE: not a soft body of the system. vox_last_error describes other errors.
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
        desc.positions = vox_float_positions(soft.world.data(), soft.world.size() / 3);
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
    struct Vector {
        double x = 0, y = 0, z = 0;
        Vector() = default;
        Vector(double a, double b, double c) : x(a), y(b), z(c) {}
        explicit Vector(const double* p) : x(p[0]), y(p[1]), z(p[2]) {}
        explicit Vector(JPH::Vec3Arg v) : x(double(v.GetX())), y(double(v.GetY())), z(double(v.GetZ())) {}
        friend Vector operator+(const Vector& a, const Vector& b) {
            return {a.x + b.x, a.y + b.y, a.z + b.z};
        }
        friend Vector operator-(const Vector& a, const Vector& b) {
            return {a.x - b.x, a.y - b.y, a.z - b.z};
        }
        friend Vector operator*(double f, const Vector& a) { return {f * a.x, f * a.y, f * a.z}; }
        void operator+=(const Vector& b) { *this = *this + b; }
    };
    static double dot(const Vector& a, const Vector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
    static Vector cross(const Vector& a, const Vector& b) {
        return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    }

    struct Matrix {
        Vector x, y, z; // columns
        friend Vector operator*(const Matrix& m, const Vector& v) {
            return v.x * m.x + v.y * m.y + v.z * m.z;
        }
        void add_outer(double f, const Vector& v) { x += f * v.x * v, y += f * v.y * v, z += f * v.z * v; }
        double trace() const { return x.x + y.y + z.z; }
        Matrix transposed() const { return {{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}}; }
        // Of a symmetric matrix: 0 if it is singular.
        Matrix inverse() const {
            const Vector a = cross(y, z), b = cross(z, x), c = cross(x, y);
            const double size = trace(), determinant = dot(x, a);
            const double f = determinant > 1e-12 * size * size * size ? 1 / determinant : 0;
            return {f * a, f * b, f * c};
        }
    };

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
        Vector linear, angular;
        Vector at(const Vector& arm) const { return linear + cross(angular, arm); }
    };

    struct Soft {
        JPH::BodyID id;
        JPH::Body* body = nullptr;
        vox_body mesh = VOX_NULL_BODY;
        std::vector<float> world;         // positions of the mesh
        std::vector<std::uint32_t> first; // of a filling: where the shares of its vertices begin
        std::vector<Share> shares;
        std::vector<JPH::Vec3> left;         // velocities with which the last step began
        std::vector<std::uint32_t> particle; // of each vertex in contact
        bool touched = false, fixed = false; // in contact; with vertices that never move
        // The body as if it were rigid. The axes are the columns of its rotation; all else is in world axes,
        // or, of the centre, from its origin.
        Matrix axes, inverse_inertia;
        Vector origin, centre;
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
        Vector normal, arm_a, arm_b, velocity, drag;
        double gap = 0, wanted = 0, friction = 0, inverse_mass[2] = {}, inverse_drag = 0;
        double given[2] = {};
    };

    static JPH::SoftBodyMotionProperties& properties_of(const Soft& soft) {
        return *static_cast<JPH::SoftBodyMotionProperties*>(soft.body->GetMotionPropertiesUnchecked());
    }
    static JPH::Vec3 to_local(const Soft& soft, const Vector& v) {
        const Vector local = soft.axes.transposed() * v;
        return JPH::Vec3(static_cast<float>(local.x), static_cast<float>(local.y),
                         static_cast<float>(local.z));
    }

    // Fills the faces of a body with tetrahedra, whose vertices move with those of the body.
    static vox_result fill(Soft& soft, std::vector<std::uint32_t>& tets) {
        std::vector<Vector> at;
        for (const JPH::SoftBodyVertex& v : properties_of(soft).GetVertices()) at.emplace_back(v.mPosition);
        std::vector<std::uint32_t> triangles;
        double edges = 0;
        for (const auto& face : properties_of(soft).GetSettings()->mFaces) {
            triangles.insert(triangles.end(), std::begin(face.mVertex), std::end(face.mVertex));
            const Vector edge = at[face.mVertex[1]] - at[face.mVertex[0]];
            edges += std::sqrt(dot(edge, edge));
        }
        vox_io_mesh_view mesh{};
        mesh.positions = at.empty() ? nullptr : &at[0].x;
        mesh.vertex_count = at.size();
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
            for (std::uint64_t i = 0; i < mesh.vertex_count; ++i)
                share_out(soft, at, Vector(mesh.positions + 3 * i));
        }
        vox_io_mesh_destroy(surface);
        vox_io_mesh_destroy(solid);
        return result;
    }

    // Weights of a body's vertices for a point, by moving least squares (P. Lancaster and K. Salkauskas,
    // 1981): they sum up to 1 and to the point, so that a filling turns, shears and stretches as its body
    // does.
    static void share_out(Soft& soft, const std::vector<Vector>& at, const Vector& point) {
        std::vector<double> nearness;
        double total = 0, kept = 0;
        Vector mean;
        for (const Vector& x : at) {
            const double square = dot(x - point, x - point);
            nearness.push_back(1 / (square * square + 1e-24));
            total += nearness.back();
            mean += nearness.back() * x;
        }
        mean = 1 / total * mean;
        Matrix spread;
        for (std::size_t i = 0; i < at.size(); ++i) spread.add_outer(nearness[i] / total, at[i] - mean);
        const Vector slope = spread.inverse() * (point - mean);
        const std::size_t begin = soft.shares.size();
        for (std::size_t i = 0; i < at.size(); ++i) {
            const double weight = nearness[i] / total * (1 + dot(at[i] - mean, slope));
            if (std::abs(weight) < 1e-3) continue;
            soft.shares.push_back({static_cast<std::uint32_t>(i), weight});
            kept += weight;
        }
        for (std::size_t s = begin; s < soft.shares.size(); ++s) soft.shares[s].weight /= kept;
        soft.first.push_back(static_cast<std::uint32_t>(soft.shares.size()));
    }

    // Where the body and its mesh are.
    static void place(Soft& soft) {
        const auto& vertices = properties_of(soft).GetVertices();
        const JPH::RMat44 m = soft.body->GetCenterOfMassTransform();
        const auto origin = m.GetTranslation();
        soft.axes = {Vector(m.GetColumn3(0)), Vector(m.GetColumn3(1)), Vector(m.GetColumn3(2))};
        soft.origin = {double(origin.GetX()), double(origin.GetY()), double(origin.GetZ())};
        const std::size_t count = soft.first.empty() ? vertices.size() : soft.first.size() - 1;
        soft.world.clear();
        for (std::size_t i = 0; i < count; ++i) {
            Vector at;
            if (soft.first.empty())
                at = Vector(vertices[i].mPosition);
            else
                for (std::uint32_t s = soft.first[i]; s < soft.first[i + 1]; ++s)
                    at += soft.shares[s].weight * Vector(vertices[soft.shares[s].vertex].mPosition);
            at = soft.origin + soft.axes * at;
            for (const double x : {at.x, at.y, at.z}) soft.world.push_back(static_cast<float>(x));
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
        row.normal = Vector(c.normal);
        row.gap = c.gap;
        row.arm_a = Vector(c.position) - row.a->origin - row.a->centre;
        row.arm_b = Vector(c.position) - c.gap * row.normal - row.b->origin - row.b->centre;
        Vector drawn;
        for (std::size_t e = row.begin; e < row.end; ++e) {
            const double weight = entries_[e].weight;
            const Particle& p = particles_[entries_[e].particle];
            row.velocity += weight * p.velocity;
            drawn += weight * p.drawn;
            for (const Change k : {VELOCITY, PLACE})
                row.inverse_mass[k] += weight * weight * p.inverse_mass[k];
        }
        row.inverse_drag = row.inverse_mass[VELOCITY];
        for (const auto& [soft, arm] : {std::make_pair(row.a, row.arm_a), std::make_pair(row.b, row.arm_b)}) {
            const Vector turn = cross(arm, row.normal);
            for (double& w : row.inverse_mass)
                w += soft->inverse_mass + dot(turn, soft->inverse_inertia * turn);
            row.inverse_drag +=
                soft->inverse_mass + dot(arm, arm) * soft->inverse_inertia.trace(); // at least
        }
        row.friction = std::sqrt(static_cast<double>(a.GetFriction() * b.GetFriction())); // as Jolt does
        // Jolt solves what holds the bodies together after this, and that draws points onto each other:
        // presumably as much as in the last step. Deep contacts are pushed out alone: their normals may
        // differ, and that adds energy.
        const double foresight = c.gap < -10 * settings_.margin ? 0 : settings_.foresight;
        row.wanted = foresight * std::max(0.0, -dot(drawn, row.normal)) - std::max(0.0, c.gap) / seconds;
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
        Vector first;
        Matrix second, inertia;
        for (const JPH::SoftBodyVertex& v : vertices) {
            soft.fixed = soft.fixed || !(v.mInvMass > 0);
            const double m = soft.fixed ? 0 : 1 / static_cast<double>(v.mInvMass);
            mass += m;
            first += m * Vector(v.mPosition);
            second.add_outer(m, Vector(v.mPosition));
        }
        const double share = soft.fixed ? 0 : settings_.stiffness / mass;
        const Vector centre = 1 / std::max(mass, 1e-300) * first;
        second.add_outer(-mass, centre);
        const double t = second.trace();
        inertia = {Vector(t, 0, 0) - second.x, Vector(0, t, 0) - second.y, Vector(0, 0, t) - second.z};
        const Matrix inverse = inertia.inverse(), rows = soft.axes.transposed();
        const double angular = share * mass;
        soft.inverse_inertia = {angular * (soft.axes * (inverse * rows.x)),
                                angular * (soft.axes * (inverse * rows.y)),
                                angular * (soft.axes * (inverse * rows.z))};
        soft.inverse_mass = share;
        soft.centre = soft.axes * centre;
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
            // A vertex that is pushed alone springs back, and that would add energy.
            particles_.push_back({soft.axes * Vector(vertex.mVelocity),
                                  soft.axes * Vector(vertex.mVelocity - soft.left[v]),
                                  {soft.fixed ? inverse_mass : (1 - settings_.stiffness) * inverse_mass,
                                   soft.fixed ? inverse_mass : 0},
                                  {}});
        }
        return soft.particle[v];
    }

    // How a row's point of body a was changed, as seen from body b.
    Vector changed(const Row& row, Change k) const {
        Vector total = row.a->changes[k].at(row.arm_a) - row.b->changes[k].at(row.arm_b);
        for (std::size_t e = row.begin; e < row.end; ++e)
            total += entries_[e].weight * particles_[entries_[e].particle].changes[k];
        return total;
    }

    // Gives a momentum, or a mass times a way, to body a at a row's point, and its opposite to body b.
    void give(const Row& row, Change k, const Vector& amount) {
        for (std::size_t e = row.begin; e < row.end; ++e) {
            Particle& p = particles_[entries_[e].particle];
            p.changes[k] += entries_[e].weight * p.inverse_mass[k] * amount;
        }
        give(*row.a, k, row.arm_a, amount);
        give(*row.b, k, row.arm_b, -1 * amount);
    }
    static void give(Soft& soft, Change k, const Vector& arm, const Vector& amount) {
        soft.changes[k].linear += soft.inverse_mass * amount;
        soft.changes[k].angular += soft.inverse_inertia * cross(arm, amount);
    }
    // Gives as much along the normal as `missing` needs, and never pulls in sum.
    void give_normal(Row& row, Change k, double missing) {
        const double given = std::max(0.0, row.given[k] + missing / row.inverse_mass[k]);
        if (given != row.given[k]) give(row, k, (given - row.given[k]) * row.normal);
        row.given[k] = given;
    }

    // Ends the approach of the two points, and their sliding by Coulomb's law.
    void brake(Row& row) {
        give_normal(row, VELOCITY, row.wanted - dot(row.velocity + changed(row, VELOCITY), row.normal));
        if (row.given[VELOCITY] == 0 && dot(row.drag, row.drag) == 0) return;
        const Vector v = row.velocity + changed(row, VELOCITY);
        Vector drag = row.drag - 1 / row.inverse_drag * (v - dot(v, row.normal) * row.normal);
        const double most = row.friction * row.given[VELOCITY], size = std::sqrt(dot(drag, drag));
        if (size > most) drag = most / size * drag;
        give(row, VELOCITY, drag - row.drag);
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
