// Contacts between soft bodies for Jolt Physics, against a stand-in of Jolt. Compiled as Jolt is, without
// exceptions and RTTI; the figures of docs/jolt.md are from Jolt itself.
#include "jolt_soft_contacts.hpp"

#include <cmath>
#include <deque>
#include <limits>

#include "support/suite.h" // last: it defines macros with common names

namespace {

// A soft cube of `n` vertices a side, and ten kilograms.
JPH::SoftBodySharedSettings cube_of(int n, std::vector<JPH::SoftBodyVertex>& vertices, bool volumes) {
    JPH::SoftBodySharedSettings s;
    vertices.clear();
    const auto id = [n](int x, int y, int z) { return JPH::uint32((x * n + y) * n + z); };
    const auto edge = [&](JPH::uint32 a, JPH::uint32 b) {
        const float length = (vertices[a].mPosition - vertices[b].mPosition).Length();
        s.mEdgeConstraints.push_back({{a, b}, length, 1e-4f});
    };
    for (int i = 0; i < n * n * n; ++i) {
        const int v[3] = {i / n / n, i / n % n, i % n};
        const auto at = [n](int k) { return float(k) / float(n - 1) - 0.5f; };
        const JPH::Vec3 x(at(v[0]), at(v[1]), at(v[2]));
        vertices.push_back({x, x, JPH::Vec3::sZero(), float(n * n * n) / 10});
    }
    for (int i = 0; i < n * n * n; ++i) {
        const int x = i / n / n, y = i / n % n, z = i % n;
        if (x + 1 < n) edge(id(x, y, z), id(x + 1, y, z));
        if (y + 1 < n) edge(id(x, y, z), id(x, y + 1, z));
        if (z + 1 < n) edge(id(x, y, z), id(x, y, z + 1));
        if (x + 1 == n || y + 1 == n || z + 1 == n) continue;
        // Six tetrahedra around a diagonal.
        static const int ways[6][2] = {{1, 3}, {3, 2}, {2, 6}, {6, 4}, {4, 5}, {5, 1}};
        JPH::uint32 c[8];
        for (int k = 0; k < 8; ++k) c[k] = id(x + (k & 1), y + (k >> 1 & 1), z + (k >> 2 & 1));
        for (const auto& way : ways)
            if (volumes)
                s.mVolumeConstraints.push_back(
                    {{c[0], c[way[0]], c[way[1]], c[7]}, 1 / float((n - 1) * (n - 1) * (n - 1)), 1e-4f});
        for (int k = 0; k < 4; ++k) edge(c[k], c[7 - k]);
    }
    for (int i = 0; i < 6 * (n - 1) * (n - 1); ++i) {
        const int side = i % 6, axis = side / 2, j = i / 6 % (n - 1), k = i / 6 / (n - 1);
        const auto on_side = [&](int a, int b) {
            int v[3];
            v[axis] = side % 2 ? n - 1 : 0;
            v[(axis + 1) % 3] = a;
            v[(axis + 2) % 3] = b;
            return id(v[0], v[1], v[2]);
        };
        JPH::uint32 q[4] = {on_side(j, k), on_side(j + 1, k), on_side(j + 1, k + 1), on_side(j, k + 1)};
        if (side % 2 == 0) std::swap(q[1], q[3]);
        s.mFaces.push_back({{q[0], q[1], q[2]}});
        s.mFaces.push_back({{q[0], q[2], q[3]}});
    }
    return s;
}

// The momentum of all bodies before and after the contacts of each step.
struct World : JPH::PhysicsStepListener {
    struct Item {
        JPH::SoftBodySharedSettings settings;
        JPH::SoftBodyMotionProperties properties;
        JPH::Body body;
    };

    JPH::PhysicsSystem system;
    std::deque<Item> items;
    float gravity = -9.81f;
    std::vector<JPH::Vec3> before;

    World() { system.AddStepListener(this); } // before the contacts

    JPH::BodyID add(float x, float y, float z, bool volumes = true, int n = 5) {
        Item& item = items.emplace_back();
        item.settings = cube_of(n, item.properties.vertices, volumes);
        item.properties.settings = &item.settings;
        item.body.properties = &item.properties;
        const JPH::Mat44 turned = {
            {JPH::Vec3(0.8f, 0, -0.6f), JPH::Vec3(0, 1, 0), JPH::Vec3(0.6f, 0, 0.8f), JPH::Vec3(x, y, z)}};
        item.body.transform = turned;
        system.bodies.bodies.push_back(&item.body);
        return JPH::BodyID(JPH::uint32(items.size() - 1));
    }

    template <typename Visit>
    void each_vertex(const Visit& visit) {
        for (Item& item : items)
            for (JPH::SoftBodyVertex& v : item.properties.vertices)
                if (v.mInvMass > 0) visit(v, item.body.transform.GetTranslation().GetY());
    }

    void OnStep(const JPH::PhysicsStepListenerContext&) override {
        before.clear();
        each_vertex([&](const JPH::SoftBodyVertex& v, float) { before.push_back(v.mVelocity); });
    }

    double energy() {
        double sum = 0;
        each_vertex([&](const JPH::SoftBodyVertex& v, float y) {
            sum += double(0.5f * v.mVelocity.Dot(v.mVelocity) - gravity * (y + v.mPosition.GetY())) /
                   double(v.mInvMass);
        });
        return sum;
    }
    void step() { system.Update(1 / 60.f, gravity); }
};

// What the impulses of all steps add up to, and their sizes. It listens after the contacts.
struct Impulses : JPH::PhysicsStepListener {
    World& world;
    double sum[3] = {}, size = 0;

    explicit Impulses(World& of) : world(of) { world.system.AddStepListener(this); }
    void OnStep(const JPH::PhysicsStepListenerContext&) override {
        std::size_t i = 0;
        world.each_vertex([&](const JPH::SoftBodyVertex& v, float) {
            const JPH::Vec3 d = v.mVelocity - world.before[i++];
            const double p[3] = {double(d.GetX()) / double(v.mInvMass), double(d.GetY()) / double(v.mInvMass),
                                 double(d.GetZ()) / double(v.mInvMass)};
            for (int k = 0; k < 3; ++k) sum[k] += p[k];
            size += std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
        });
    }
};

double deepest(const vox::JoltSoftContacts& contacts) {
    const vox_constraint_view found = constraints_of(contacts.grid());
    double depth = 0;
    for (std::uint64_t i = 0; i < found.count; ++i)
        if (found.data[i].kind == VOX_CONSTRAINT_INSIDE) depth = std::max(depth, -found.data[i].gap);
    return depth;
}

void fall(bool volumes) {
    World world;
    const JPH::BodyID low = world.add(0, 0.5f, 0, volumes), high = world.add(0.1f, 1.6f, 0.07f, volumes);
    vox::JoltSoftContacts contacts(world.system);
    ck_ok(contacts.add(low));
    ck_ok(contacts.add(high));
    Impulses impulses(world);
    const double first = world.energy();
    for (int step = 0; step < 300; ++step) {
        world.step();
        ck_ok(contacts.result());
        ck_assert_double_le(world.energy(), first);
        ck_assert_double_le(deepest(contacts), 0.05);
    }
    ck_assert_double_le(deepest(contacts), 0.02);
    ck_assert_double_gt(impulses.size, 10);
    for (const double sum : impulses.sum) ck_assert_double_le(std::abs(sum), 1e-6 * impulses.size);
}

START_TEST(cubes_rest_on_each_other) { fall(true); }
END_TEST

START_TEST(surfaces_are_filled) { fall(false); }
END_TEST

START_TEST(overlapping_bodies_part_slowly) {
    World world;
    world.gravity = 0;
    const JPH::BodyID a = world.add(0, 5, 0), b = world.add(0.1f, 5.6f, 0.05f);
    vox::JoltSoftContacts contacts(world.system);
    ck_ok(contacts.add(a));
    ck_ok(contacts.add(b));
    world.step();
    ck_assert_double_gt(deepest(contacts), 0.2);
    double most = 0;
    for (int step = 0; step < 300; ++step) {
        world.step();
        most = std::max(most, world.energy());
    }
    ck_assert_double_le(deepest(contacts), 0.02);
    ck_assert_double_le(most, 0.5 * 20 * 0.2 * 0.2); // that of both at push_speed
}
END_TEST

START_TEST(sleeping_bodies_wake_up) {
    World world;
    const JPH::BodyID low = world.add(0, 0.5f, 0), high = world.add(0, 1.55f, 0);
    vox::JoltSoftContacts contacts(world.system);
    ck_ok(contacts.add(low));
    ck_ok(contacts.add(high));
    world.items[0].body.active = false;
    world.step();
    ck_assert(!world.items[0].body.active);
    for (int step = 0; step < 20; ++step) world.step();
    ck_assert(world.items[0].body.active);

    // Nothing happens to two that sleep, however they lie.
    for (World::Item& item : world.items) item.body.active = false;
    world.items[1].properties.vertices[0].mVelocity = JPH::Vec3(0, -9, 0);
    Impulses impulses(world);
    world.step();
    ck_assert_uint_gt(constraints_of(contacts.grid()).count, 0);
    ck_assert_double_eq(impulses.size, 0);
}
END_TEST

START_TEST(bodies_leave) {
    World world;
    const JPH::BodyID low = world.add(0, 0.5f, 0), high = world.add(0, 1.45f, 0);
    vox::JoltSoftContacts contacts(world.system);
    ck_ok(contacts.add(low));
    ck_ok(contacts.add(high));
    world.step();
    ck_assert_uint_gt(constraints_of(contacts.grid()).count, 0);
    world.items[1].body.added = false; // removed from the system, not destroyed
    world.step();
    ck_assert_uint_eq(constraints_of(contacts.grid()).count, 0);
    world.items[1].body.added = true;
    world.step();
    ck_assert_uint_gt(constraints_of(contacts.grid()).count, 0);
    world.system.bodies.bodies[1] = nullptr;
    for (int step = 0; step < 3; ++step) {
        world.step();
        ck_ok(contacts.result());
        ck_assert_uint_eq(constraints_of(contacts.grid()).count, 0);
    }
    ck_ok(contacts.add(world.add(0, 1.45f, 0)));
    world.step();
    ck_assert_uint_gt(constraints_of(contacts.grid()).count, 0);
    ck_assert_uint_eq(constraints_of(contacts.grid()).data[0].user_data_b +
                          constraints_of(contacts.grid()).data[0].user_data_a,
                      2); // the first and the third
}
END_TEST

START_TEST(fixed_vertices_stay) {
    World world;
    const JPH::BodyID low = world.add(0, 2, 0), high = world.add(0, 3.1f, 0);
    for (JPH::SoftBodyVertex& v : world.items[0].properties.vertices) v.mInvMass = 0;
    vox::JoltSoftContacts contacts(world.system);
    ck_ok(contacts.add(low));
    ck_ok(contacts.add(high));
    for (int step = 0; step < 200; ++step) world.step();
    ck_assert_double_le(deepest(contacts), 0.02);
    for (const JPH::SoftBodyVertex& v : world.items[0].properties.vertices)
        ck_assert((v.mPosition - v.mPreviousPosition).Length() == 0 && v.mVelocity.Length() == 0);
    const JPH::Vec3 corner = world.items[1].properties.vertices[0].mPosition;
    ck_assert_float_gt(corner.GetY() + 3.1f, 2.4f); // rests on the other
}
END_TEST

START_TEST(bad_positions_are_told) {
    World world;
    const JPH::BodyID low = world.add(0, 0.5f, 0), high = world.add(0, 1.45f, 0);
    vox::JoltSoftContacts contacts(world.system);
    ck_ok(contacts.add(low));
    ck_ok(contacts.add(high));
    Impulses impulses(world);
    JPH::Vec3& position = world.items[1].properties.vertices[7].mPosition;
    const JPH::Vec3 good = position;
    position = JPH::Vec3(std::numeric_limits<float>::quiet_NaN(), 0, 0);
    const JPH::PhysicsStepListenerContext context{1 / 60.f};
    for (JPH::PhysicsStepListener* listener : world.system.listeners) listener->OnStep(context);
    ck_fails(contacts.result(), VOX_ERROR_NON_FINITE, "7");
    ck_assert_double_eq(impulses.size, 0);
    position = good;
    for (int step = 0; step < 2; ++step) world.step();
    ck_ok(contacts.result());
    ck_assert_double_gt(impulses.size, 0);
}
END_TEST

START_TEST(what_is_no_solid_is_refused) {
    World world;
    const JPH::BodyID open = world.add(0, 0.5f, 0, false), rigid = world.add(0, 3, 0);
    world.items[0].settings.mFaces.resize(100); // of 192
    world.items[1].body.soft = false;
    vox::JoltSoftContacts contacts(world.system);
    ck_assert_int_eq(contacts.add(JPH::BodyID()), VOX_ERROR_INVALID_HANDLE);
    ck_assert_int_eq(contacts.add(rigid), VOX_ERROR_INVALID_HANDLE);
    ck_fails(contacts.add(open), VOX_ERROR_INVALID_MESH, "open");
    ck_fails(contacts.add(open, {0, 1, 2, 999}), VOX_ERROR_INVALID_MESH, "999");
    ck_ok(contacts.add(open, {0, 1, 5, 25}));
    world.step();
    ck_ok(contacts.result());
}
END_TEST

} // namespace

SUITE(jolt_soft_contacts) {
    TCase* tests = add_case(suite, "jolt_soft_contacts");
    tcase_add_each(tests, cubes_rest_on_each_other, surfaces_are_filled, overlapping_bodies_part_slowly,
                   sleeping_bodies_wake_up, bodies_leave, fixed_vertices_stay, bad_positions_are_told,
                   what_is_no_solid_is_refused);
}
