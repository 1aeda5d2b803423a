// Hard scenes on the host's loops against the library: all fields of all contacts, in three orders.
#include "base/error.hpp"
#include "gpu/gpu_run.hpp"

#include "scenes/bodies.h"

#include <cmath>
#include <limits>

using namespace vox;
using namespace vox::test;

namespace {

// A grid and the bodies whose positions it borrows.
struct OwnedGrid {
    explicit OwnedGrid(std::vector<body> bodies, const std::vector<vox_filter>& filters = {})
        : all(std::move(bodies)) {
        for (std::size_t b = 0; b < all.size(); ++b) {
            vox_mesh_desc desc = body_desc(&all[b]);
            if (b < filters.size()) desc.filter = filters[b];
            ids.push_back(insert_mesh(grid, &desc));
        }
    }
    ~OwnedGrid() {
        vox_grid_destroy(grid);
        for (body& b : all) free_body(&b);
    }
    OwnedGrid(const OwnedGrid&) = delete;
    OwnedGrid& operator=(const OwnedGrid&) = delete;

    vox_grid* grid = grid_of(nullptr);
    std::vector<body> all;
    std::vector<vox_body> ids;
};

body ball(std::uint32_t radius, std::uint64_t seed, double x = 0, double y = 0, double z = 0,
          double jitter = 0.1) {
    body b = make_lattice_ball(&five_cut, radius, radius);
    jitter_body(&b, jitter, seed);
    move_body(&b, x, y, z);
    return b;
}

vox_filter filter(std::uint32_t flags, std::int32_t group = 0, std::uint64_t category = 0,
                  std::uint64_t mask = 0, std::uint32_t world = 0) {
    vox_filter f = plain_filter();
    f.flags = flags, f.group = group, f.category = category, f.mask = mask, f.world = world;
    return f;
}

constexpr std::uint32_t self = VOX_FILTER_SELF_COLLISION;

std::uint64_t contact_count(const OwnedGrid& g) { return contacts_of(g.grid).count; }

template <class Change>
void for_each_position(body& b, Change&& change) {
    for (std::uint32_t v = 0; v < b.vertex_count; ++v) change(b.positions + 3 * v);
}

} // namespace

START_TEST(touching_in_every_way) {
    OwnedGrid coincident({ball(3, 1), ball(3, 1)}, {filter(self), filter(self)});
    check_against_grids({coincident.grid}, "coincident");
    ck_assert_uint_gt(contact_count(coincident), 100);
    OwnedGrid lattice({ball(3, 1, 0, 0, 0, 0), ball(3, 1, 1, 2, 0, 0), ball(2, 1, 0.5, 0, 0.5, 0)});
    const gpu::StepStatus status = check_against_grids({lattice.grid}, "lattice");
    ck_assert_uint_gt(status.exact_tests, 100);
    ck_assert_uint_gt(contact_count(lattice), 100);
}
END_TEST

START_TEST(slivers) {
    std::vector<body> bodies = {ball(3, 1), ball(3, 2, 2, 1, 1)};
    for_each_position(bodies[0], [](float* p) { p[2] *= 1e-7f; });
    for_each_position(bodies[1], [](float* p) { p[2] = p[2] * 1e-9f, p[0] += 1e-3f * p[1]; });
    OwnedGrid flat(std::move(bodies));
    check_against_grids({flat.grid}, "slivers");
    ck_assert_uint_gt(contact_count(flat), 100);
}
END_TEST

START_TEST(sizes) {
    for (const double factor : {1e-44, 1e-38, 1e-12, 1e12, 1e30, 1e37}) {
        std::vector<body> bodies = {ball(2, 1), ball(2, 2, 1, 1, 1)};
        for (body& b : bodies)
            for_each_position(b, [factor](float* p) {
                for (int a = 0; a < 3; ++a) p[a] = static_cast<float>(p[a] * factor);
            });
        OwnedGrid scaled(std::move(bodies));
        check_against_grids({scaled.grid}, "scaled");
        ck_assert_uint_gt(contact_count(scaled), 10);
    }
    // A stray vertex: its tiles are larger than the world. Tiny coordinates beside huge ones, which no
    // 128-bit integers hold.
    std::vector<body> bodies = {ball(3, 1), ball(3, 2, 2, 1, 1), ball(2, 3, -1, 0, 0, 0)};
    bodies[0].positions[3 * 7] = 1e30f;
    bodies[1].positions[3 * 9 + 2] = -3e38f;
    bodies[1].positions[3 * 11 + 1] = 1e-40f;
    bodies[2].positions[3 * 20] = bodies[2].positions[3 * 21] = 1e-30f;
    OwnedGrid stray(std::move(bodies), {filter(self), filter(0), filter(self)});
    const gpu::StepStatus status = check_against_grids({stray.grid}, "stray");
    ck_assert_uint_gt(contact_count(stray), 50);
    ck_assert_uint_gt(status.levels, 1);
}
END_TEST

START_TEST(cells) {
    OwnedGrid pair({ball(3, 1), ball(3, 2, 2, 1, 1)}, {filter(self), filter(0)});
    ck_ok(vox_grid_step(pair.grid));
    const WeighedContacts expected = expected_contacts(pair.grid);
    ck_assert_uint_gt(expected.size(), 20);
    // Tiles that are long and thin meet few cells, some of which are in one slot.
    std::vector<body> bodies = {ball(3, 1), ball(3, 2, 2, 1, 1)};
    for (body& b : bodies) for_each_position(b, [](float* p) { p[0] *= 16; });
    OwnedGrid stretched(std::move(bodies));
    ck_ok(vox_grid_step(stretched.grid));
    const WeighedContacts expected_of_stretched = expected_contacts(stretched.grid);
    gpu::u32 levels = 0;
    for (const double cell_size : {1e-3, 1e-2, 0.1, 0.5, 1.0, 2.0, 4.0, 10.0, 1e3})
        for (const gpu::u64 bricks : {gpu::u64{0}, gpu::u64{1}, gpu::u64{8}}) {
            HostScenes scenes({pair.grid}, orders[1], cell_size, {0, 0, 0, bricks});
            levels |= scenes.step_completely().levels;
            check_contacts(expected, scenes.contacts(0), "cells");
            HostScenes thin({stretched.grid}, orders[1], cell_size, {0, 0, 0, bricks});
            thin.step_completely();
            check_contacts(expected_of_stretched, thin.contacts(0), "cells of thin tiles");
        }
    ck_assert_uint_gt(levels, 7); // several of them, and those in which cells are larger
}
END_TEST

START_TEST(small_scenes) {
    OwnedGrid nothing({}), one({make_box(1, 1, 0, 0, 0)}, {filter(self)});
    body points = make_box(2, 0.5f, 0.25f, 0.25f, 0.25f);
    points.tet_count = 0;
    OwnedGrid cloud({points, make_box(1, 1, 0, 0, 0)});
    check_against_grids({nothing.grid}, "nothing");
    check_against_grids({one.grid}, "one box");
    check_against_grids({cloud.grid, nothing.grid, one.grid}, "points in a box");
    ck_assert_uint_gt(contact_count(cloud), 5);
    const std::vector<vox_grid*> none;
    HostScenes scenes(none);
    ck_assert_uint_eq(scenes.step_completely().contact_count, 0);
}
END_TEST

START_TEST(many_scenes) {
    std::vector<std::unique_ptr<OwnedGrid>> owned;
    std::vector<vox_grid*> grids;
    std::size_t tets = 0;
    for (std::uint64_t i = 0; i < 64; ++i) {
        const double apart = 1.5 + 0.01 * static_cast<double>(i);
        std::vector<body> bodies = {ball(1 + i % 2, 2 * i + 1), ball(1, 2 * i + 2, apart, 0.1, 0.2)};
        if (i % 8 == 7) bodies.push_back(make_box(2, 1, 0, 0, 0));
        owned.push_back(std::make_unique<OwnedGrid>(std::move(bodies)));
        grids.push_back(owned.back()->grid);
        for (const body& b : owned.back()->all) tets += b.tet_count;
    }
    check_against_grids(grids, "many scenes");
    std::size_t with_contacts = 0;
    for (const auto& g : owned) with_contacts += contact_count(*g) > 0;
    ck_assert_uint_gt(with_contacts, 32);
    // Equal topology once: two balls and a box.
    HostScenes scenes(grids);
    ck_assert_uint_lt(scenes.data().tets.size(), tets / 10);
}
END_TEST

START_TEST(filters) {
    const auto bodies = [] {
        return std::vector<body>{ball(2, 1), ball(2, 2, 1, 1, 1), ball(2, 3, -1, 1, 0)};
    };
    std::uint64_t counts[6];
    const std::vector<vox_filter> of[6] = {{},
                                           {filter(0, 0, 1, 2), filter(0, 0, 2, 1), filter(0, 0, 4, 4)},
                                           {filter(0, -3), filter(0, -3), filter(0, 3)},
                                           {filter(0, 0, 1, 2, 0), filter(0, 5, 1, 2), filter(self, 5, 4, 8)},
                                           {filter(self), filter(self, 0, 0, 0, 7), filter(0)},
                                           {filter(0, 0, 1, 2), filter(0, 0, 1, 2), filter(0, 0, 1, 2)}};
    for (int i = 0; i < 6; ++i) {
        OwnedGrid filtered(bodies(), of[i]);
        check_against_grids({filtered.grid}, "filtered");
        counts[i] = contact_count(filtered);
    }
    ck_assert(counts[0] > counts[1] && counts[0] > counts[2] && counts[1] > 0 && counts[2] > 0 &&
              counts[5] == 0);
}
END_TEST

START_TEST(parts_of_scenes) {
    OwnedGrid g({ball(2, 1), ball(2, 2, 1, 1, 1), ball(2, 3, -1, 1, 0)});
    const std::uint32_t off[] = {0, 3, 17, 30};
    ck_ok(vox_mesh_set_tets_enabled(g.grid, g.ids[0], off, 4, 0));
    check_against_grids({g.grid}, "tets that are off");
    const std::uint64_t before = contact_count(g);
    ck_ok(vox_body_set_enabled(g.grid, g.ids[1], 0));
    g.all[1].positions[4] = std::numeric_limits<float>::quiet_NaN(); // is not read
    check_against_grids({g.grid}, "a body that is off");
    ck_assert(contact_count(g) > 0 && contact_count(g) < before);
    vox_shape_desc sphere = vox_default_shape_desc();
    sphere.kind = VOX_SHAPE_SPHERE;
    sphere.radius = 1;
    vox_body shape;
    ck_ok(vox_shape_insert(g.grid, &sphere, &shape));
    check_against_grids({g.grid}, "a shape, which has no contacts");
}
END_TEST

START_TEST(records) {
    OwnedGrid g({ball(2, 1), ball(2, 2, 1, 1, 1)});
    ck_ok(vox_grid_step(g.grid));
    HostScenes scenes({g.grid}, orders[2]);
    scenes.bind();
    // With records of 16 bytes.
    const std::vector<float> packed = scenes.packed();
    std::vector<float> wide(packed.size() / 3 * 4, std::numeric_limits<float>::quiet_NaN());
    for (std::size_t i = 0; i < packed.size(); ++i) wide[i / 3 * 4 + i % 3] = packed[i];
    scenes.pipeline().bind(wide.data(), 16);
    ck_assert_uint_eq(scenes.step().faults, 0);
    check_contacts(expected_contacts(g.grid), scenes.contacts(0), "records");
}
END_TEST

START_TEST(not_finite) {
    OwnedGrid g({ball(2, 1), ball(2, 2, 1, 1, 1)});
    for (const gpu::HostOrder& order : orders)
        for (const float bad :
             {std::numeric_limits<float>::quiet_NaN(), -std::numeric_limits<float>::infinity()}) {
            HostScenes scenes({g.grid}, order);
            scenes.step_completely();
            const WeighedContacts sound = scenes.contacts(0);
            ck_assert_uint_gt(sound.size(), 0);
            const std::uint32_t vertex = g.all[0].vertex_count + 5;
            for (const std::uint32_t v : {vertex, vertex + 1}) scenes.packed()[3 * v + 1] = bad;
            gpu::StepStatus status = scenes.step();
            ck_assert_uint_eq(status.faults, gpu::non_finite_position);
            ck_assert_uint_eq(status.non_finite_vertex, vertex);
            ck_assert(status.contact_count == 0 && scenes.contacts(0).empty());
            status = scenes.step_completely();
            check_contacts(sound, scenes.contacts(0), "finite again");
        }
}
END_TEST

START_TEST(every_room) {
    OwnedGrid g({ball(2, 1), ball(2, 2, 1, 1, 1), ball(1, 3)}, {filter(self)});
    ck_ok(vox_grid_step(g.grid));
    const WeighedContacts expected = expected_contacts(g.grid);
    HostScenes whole({g.grid});
    const gpu::StepStatus needed = whole.step_completely();
    ck_assert_msg(needed.contact_count > 20 && needed.needed_findings >= needed.contact_count &&
                      needed.needed_points > 20,
                  "%u contacts, %u findings, %u points", needed.contact_count, needed.needed_findings,
                  needed.needed_points);
    for (int list = 0; list < 3; ++list) {
        const gpu::u32 most = list == 0   ? needed.needed_points
                              : list == 1 ? needed.needed_findings
                                          : needed.needed_contacts;
        for (gpu::u64 room = 1; room <= most + 1; room += room + 8 < most ? 3 : 1) {
            gpu::StepRooms rooms{needed.needed_points, needed.needed_findings, needed.needed_contacts, 0};
            (list == 0 ? rooms.points : list == 1 ? rooms.findings : rooms.contacts) = room;
            HostScenes scenes({g.grid}, orders[room % 3], 0, rooms);
            scenes.bind();
            const gpu::StepStatus status = scenes.step();
            ck_assert_uint_eq(status.faults, room >= most ? 0 : 1u << list);
            if (status.faults)
                ck_assert(status.contact_count == 0 && scenes.contacts(0).empty());
            else
                check_contacts(expected, scenes.contacts(0), "with room");
            scenes.step_completely();
            check_contacts(expected, scenes.contacts(0), "with more room");
        }
    }
}
END_TEST

START_TEST(refusals) {
    using Grids = std::vector<vox_grid*>;
    const auto check_refused = [](vox_grid* grid, vox_result code, const char* words) {
        vox_result result = VOX_OK;
        std::string text;
        try {
            HostScenes scenes(Grids{grid});
        } catch (const Error& error) {
            result = error.result();
            text = error.what();
        }
        ck_assert_msg(result == code && text.find(words) != std::string::npos, "%d: %s, expected %s", result,
                      text.c_str(), words);
    };
    static const double moved[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 5};
    OwnedGrid transformed({ball(1, 1)}), doubles({ball(1, 1)}), unbound({ball(1, 1)});
    ck_ok(vox_body_set_transform(transformed.grid, transformed.ids[0], moved));
    check_refused(transformed.grid, VOX_ERROR_UNSUPPORTED, "a transform");
    std::vector<double> wide(3 * std::size_t{doubles.all[0].vertex_count});
    ck_ok(vox_mesh_bind_doubles(doubles.grid, doubles.ids[0], wide.data(), doubles.all[0].vertex_count));
    check_refused(doubles.grid, VOX_ERROR_UNSUPPORTED, "double precision");
    vox_filter rings = filter(self);
    rings.self_rings = 1;
    OwnedGrid ringed({ball(1, 1)}, {rings});
    check_refused(ringed.grid, VOX_ERROR_UNSUPPORTED, "self_rings");
    vox_mesh_desc desc = body_desc(&unbound.all[0]);
    desc.positions.data = nullptr;
    insert_mesh(unbound.grid, &desc);
    check_refused(unbound.grid, VOX_ERROR_INVALID_STATE, "has no positions");
    OwnedGrid sound({ball(1, 1)});
    HostScenes scenes(Grids{sound.grid});
    vox_result result = VOX_OK;
    try {
        scenes.pipeline().step(nullptr);
    } catch (const Error& error) {
        result = error.result();
    }
    ck_assert_int_eq(result, VOX_ERROR_INVALID_STATE);
    result = VOX_OK;
    try {
        gpu::Pipeline small(gpu::make_host_backend({}), scenes.data(), {}, scenes.pipeline().bytes() - 1);
    } catch (const Error& error) {
        result = error.result();
    }
    ck_assert_int_eq(result, VOX_ERROR_BUDGET);
    gpu::Pipeline enough(gpu::make_host_backend({}), scenes.data(), {}, scenes.pipeline().bytes());
}
END_TEST

SUITE(gpu_scenes) {
    TCase* tests = add_case(suite, "scenes");
    tcase_add_each(tests, touching_in_every_way, slivers, sizes, cells, small_scenes, many_scenes, filters,
                   parts_of_scenes, records, not_finite, every_room, refusals);
}
