/* Readings by part and by pair are parts of all readings, in every detail. */
#include <stddef.h>

#include "support/ledger.h"
#include "support/reading_checks.h"

enum { all_parts = VOX_READING_POSITION | VOX_READING_SURFACE | VOX_READING_DEPTH };

static vox_reading_view readings_of(const vox_grid* grid) {
    vox_reading_view view = {NULL, 0, 99, 0};
    ck_ok(vox_grid_readings(grid, &view));
    ck_assert_uint_eq(view.byte_stride, sizeof(vox_reading));
    return view;
}

static vox_depth_view depths_of(const vox_grid* grid) {
    vox_depth_view view = {NULL, 0, 99, 0};
    ck_ok(vox_grid_reading_depths(grid, &view));
    ck_assert_uint_eq(view.byte_stride, sizeof(vox_depth));
    return view;
}

static void prepare(vox_grid* grid, uint32_t what, vox_body a, vox_body b) {
    vox_readings_desc desc = vox_default_readings_desc();
    desc.what = what;
    desc.body_a = a;
    desc.body_b = b;
    ck_ok(vox_grid_prepare_readings_of(grid, &desc));
}

/* A reading with only some of its parts. */
static vox_reading part_of(const vox_reading* whole, uint32_t what) {
    vox_reading part;
    memset(&part, 0, sizeof part);
    part.contact = whole->contact;
    part.known = whole->known & what;
    part.user_data_a = whole->user_data_a;
    part.user_data_b = whole->user_data_b;
    if (what & VOX_READING_POSITION) memcpy(part.position, whole->position, sizeof part.position);
    if (what & VOX_READING_DEPTH) {
        part.state = whole->state;
        part.depth = whole->depth;
        memcpy(part.direction, whole->direction, sizeof part.direction);
    }
    if (what & VOX_READING_SURFACE) {
        part.distance = whole->distance;
        memcpy(part.surface_position, whole->surface_position, sizeof part.surface_position);
        memcpy(part.barycentric, whole->barycentric, sizeof part.barycentric);
        memcpy(part.normal, whole->normal, sizeof part.normal);
        memcpy(part.triangle, whole->triangle, sizeof part.triangle);
    }
    return part;
}

/* What was prepared are the wanted parts of `all`, for the contacts of `a` or of `a` and `b`. */
static uint64_t check_parts(const vox_grid* grid, const vox_reading* all, uint32_t what, vox_body a,
                            vox_body b) {
    const vox_contact_view contacts = contacts_of(grid);
    const vox_reading_view view = readings_of(grid);
    const vox_depth_view depths = depths_of(grid);
    uint64_t n = 0;
    ck_assert_uint_eq(view.epoch, contacts.epoch);
    ck_assert_uint_eq(depths.count, what & VOX_READING_DEPTH ? view.count : 0);
    for (uint64_t i = 0; i < contacts.count; ++i) {
        const vox_contact* c = &contacts.data[i];
        const int of_a = c->body_a == a || c->body_b == a;
        const int of_both = (c->body_a == a && c->body_b == b) || (c->body_a == b && c->body_b == a);
        if (a && !(b ? of_both : of_a)) continue;
        ck_assert_uint_lt(n, view.count);
        const vox_reading expected = part_of(&all[i], what);
        ck_assert_mem_eq(&view.data[n], &expected, sizeof expected);
        if (what & VOX_READING_DEPTH) {
            const vox_depth* exact = &depths.data[n];
            ck_assert(expected.depth == (float)exact->depth);
            for (int axis = 0; axis < 3; ++axis)
                ck_assert(expected.direction[axis] == (float)exact->direction[axis]);
            if (!(expected.known & VOX_READING_DEPTH))
                ck_assert_double_eq(exact->depth + exact->direction[0], 0);
        }
        ++n;
    }
    ck_assert_uint_eq(n, view.count);
    return n;
}

/* All readings, copied. The caller frees. */
static vox_reading* all_readings(vox_grid* grid) {
    ck_ok(vox_grid_prepare_readings(grid));
    const vox_reading_view view = readings_of(grid);
    vox_reading* copy = (vox_reading*)calloc(view.count + 1, sizeof *copy);
    if (view.count) memcpy(copy, view.data, view.count * sizeof *copy);
    return copy;
}

START_TEST(parts_and_pairs) {
    uint64_t random = 61, seen = 0, of_pairs = 0, without_depth = 0;
    for (int scene = 0; scene < 24; ++scene) {
        world w = random_world(&random, scene % 2);
        vox_filter filter = plain_filter(); /* one mesh has contacts alone */
        filter.flags |= VOX_FILTER_SENSOR;
        if (scene % 3 == 0) ck_ok(vox_body_set_filter(w.grid, w.models[0].mesh, &filter));
        ck_ok(vox_grid_step(w.grid));
        vox_reading* all = all_readings(w.grid);
        const uint64_t count = readings_of(w.grid).count;
        for (uint64_t i = 0; i < count; ++i) without_depth += !(all[i].known & VOX_READING_DEPTH);
        ck_ok(vox_grid_prepare_readings_of(w.grid, NULL));
        ck_assert_uint_eq(check_parts(w.grid, all, all_parts, 0, 0), count);
        for (uint32_t what = 1; what <= all_parts; ++what) {
            prepare(w.grid, what, 0, 0);
            ck_assert_uint_eq(check_parts(w.grid, all, what, 0, 0), count);
            for (int a = 0; a < w.count; ++a) {
                const vox_body ma = w.models[a].mesh;
                prepare(w.grid, what, ma, 0);
                seen += check_parts(w.grid, all, what, ma, 0);
                for (int b = 0; b < w.count; ++b) {
                    prepare(w.grid, what, ma, w.models[b].mesh);
                    of_pairs += check_parts(w.grid, all, what, ma, w.models[b].mesh);
                }
            }
        }
        free(all);
        end_world(&w);
    }
    ck_assert_uint_gt(seen, 5000);
    ck_assert_uint_gt(of_pairs, 5000);
    ck_assert_uint_gt(without_depth, 50);
}
END_TEST

/* Copies give the readings that there are, in the order of the contacts' copies. */
START_TEST(copies_of_a_part) {
    uint64_t random = 67, copied = 0;
    for (int scene = 0; scene < 60; ++scene) {
        world w = random_world(&random, 0);
        if (w.count < 3) {
            end_world(&w);
            continue;
        }
        ck_ok(vox_grid_step(w.grid));
        vox_reading* all = all_readings(w.grid);
        const size_t room = (size_t)readings_of(w.grid).count + 1;
        vox_reading* some = (vox_reading*)calloc(room, sizeof *some);
        vox_reading* expected = (vox_reading*)calloc(room, sizeof *expected);
        const vox_body a = w.models[0].mesh, b = w.models[1].mesh, c = w.models[2].mesh;
        uint64_t pair = 0, count = 0;
        ck_ok(vox_pair_copy_readings(w.grid, a, b, expected, room, &pair));
        prepare(w.grid, VOX_READING_SURFACE | VOX_READING_POSITION, b, a);
        ck_ok(vox_pair_copy_readings(w.grid, a, b, some, room, &count));
        ck_assert_uint_eq(count, pair);
        for (uint64_t i = 0; i < count; ++i) {
            const vox_reading part = part_of(&expected[i], VOX_READING_SURFACE | VOX_READING_POSITION);
            ck_assert_mem_eq(&some[i], &part, sizeof part);
        }
        ck_ok(vox_mesh_copy_readings(w.grid, a, some, room, &count));
        ck_assert_uint_eq(count, pair); /* the others of a were not asked for */
        ck_ok(vox_pair_copy_readings(w.grid, a, c, some, room, &count));
        ck_assert_uint_eq(count, 0);
        ck_ok(vox_mesh_copy_readings(w.grid, c, some, room, &count));
        ck_assert_uint_eq(count, 0);
        copied += pair;
        free(all);
        free(some);
        free(expected);
        end_world(&w);
    }
    ck_assert_uint_gt(copied, 100);
}
END_TEST

START_TEST(arguments) {
    world w;
    two_in_each_other(&w, 2, VOX_GRID_PENETRATIONS);
    ck_ok(vox_grid_step(w.grid));
    vox_readings_desc desc = vox_default_readings_desc();
    ck_assert_uint_eq(desc.struct_size, sizeof desc);
    ck_assert_uint_eq(desc.body_a + desc.body_b, 0);
    vox_depth_view depths = {NULL, 7, 7, 7};
    ck_fails(vox_grid_reading_depths(w.grid, &depths), VOX_ERROR_INVALID_STATE, "vox_grid_prepare_readings");
    ck_fails(vox_grid_reading_depths(NULL, &depths), VOX_ERROR_INVALID_ARGUMENT, "grid is null");
    ck_fails(vox_grid_reading_depths(w.grid, NULL), VOX_ERROR_INVALID_ARGUMENT, "out_view is null");
    ck_assert_uint_eq(depths.count, 7);
    prepare(w.grid, VOX_READING_POSITION, w.models[0].mesh, 0);
    const vox_reading_view before = readings_of(w.grid);
    ck_fails(vox_grid_prepare_readings_of(NULL, &desc), VOX_ERROR_INVALID_ARGUMENT, "grid is null");
    desc.what = 0x13;
    ck_fails(vox_grid_prepare_readings_of(w.grid, &desc), VOX_ERROR_INVALID_ARGUMENT,
             "of which 0x10 is unknown");
    desc = vox_default_readings_desc();
    desc.body_b = w.models[1].mesh;
    ck_fails(vox_grid_prepare_readings_of(w.grid, &desc), VOX_ERROR_INVALID_ARGUMENT, "there is no body_a");
    desc.body_a = 0x5001;
    ck_fails(vox_grid_prepare_readings_of(w.grid, &desc), VOX_ERROR_INVALID_HANDLE, "20481");
    desc.body_a = w.models[0].mesh;
    desc.body_b = 0x5001;
    ck_fails(vox_grid_prepare_readings_of(w.grid, &desc), VOX_ERROR_INVALID_HANDLE, "20481");
    desc.struct_size = 2;
    ck_fails(vox_grid_prepare_readings_of(w.grid, &desc), VOX_ERROR_INVALID_ARGUMENT, "struct_size is 2");
    const vox_reading_view after = readings_of(w.grid); /* those read before are still there */
    ck_assert_uint_eq(after.count, before.count);
    ck_assert_ptr_eq(after.data, before.data);
    for (uint64_t i = 0; i < after.count; ++i) ck_assert_uint_eq(after.data[i].known, VOX_READING_POSITION);
    /* A program that knows the first two fields. */
    desc.struct_size = (uint32_t)offsetof(vox_readings_desc, body_a);
    desc.what = VOX_READING_DEPTH;
    ck_ok(vox_grid_prepare_readings_of(w.grid, &desc));
    ck_assert_uint_eq(readings_of(w.grid).count, contacts_of(w.grid).count);
    ck_assert_uint_eq(readings_of(w.grid).data[0].known, VOX_READING_DEPTH);
    /* A mesh that was removed since cannot be named, only be part of all. */
    ck_ok(vox_body_remove(w.grid, w.models[1].mesh));
    desc.struct_size = sizeof desc;
    desc.body_b = w.models[1].mesh;
    ck_fails(vox_grid_prepare_readings_of(w.grid, &desc), VOX_ERROR_INVALID_HANDLE, "stale");
    prepare(w.grid, all_parts, w.models[0].mesh, 0);
    ck_assert_uint_eq(readings_of(w.grid).count, contacts_of(w.grid).count);
    end_world(&w);
}
END_TEST

/* With a budget, the first contacts that need a search get the surface, and the readings are the same
 * otherwise. */
START_TEST(budget) {
    for (uint32_t flags = 0; flags <= VOX_GRID_PENETRATIONS; flags += VOX_GRID_PENETRATIONS) {
        world w;
        two_in_each_other(&w, 3, flags);
        ck_ok(vox_grid_step(w.grid));
        vox_readings_desc desc = vox_default_readings_desc();
        ck_assert_uint_eq(desc.closest_budget, 0);
        ck_ok(vox_grid_prepare_readings_of(w.grid, &desc));
        const uint64_t count = readings_of(w.grid).count;
        vox_reading* all = (vox_reading*)malloc(count * sizeof *all);
        memcpy(all, readings_of(w.grid).data, count * sizeof *all);
        const vox_contact_view contacts = contacts_of(w.grid);
        uint64_t least = 0; /* contacts whose surfaces are known without a search */
        for (uint64_t limit = 1; limit < 4 * count; limit = 3 * limit + 1) {
            desc.closest_budget = limit;
            ck_ok(vox_grid_prepare_readings_of(w.grid, &desc));
            const vox_reading_view view = readings_of(w.grid);
            ck_assert_uint_eq(view.count, count);
            uint64_t known = 0, vertices = 0;
            for (uint64_t i = 0; i < count; ++i) {
                vox_reading expected = all[i];
                const int has_surface = (view.data[i].known & VOX_READING_SURFACE) != 0;
                const int is_first = i == 0 || contacts.data[i].vertex != contacts.data[i - 1].vertex ||
                                     contacts.data[i].body_a != contacts.data[i - 1].body_a;
                known += (uint64_t)has_surface;
                vertices += (uint64_t)(has_surface && is_first);
                ck_assert_uint_eq(view.data[i].known | VOX_READING_SURFACE, expected.known);
                if (has_surface)
                    ck_assert_mem_eq(&view.data[i], &expected, sizeof expected);
                else
                    ck_assert(view.data[i].distance == 0 && view.data[i].depth == expected.depth);
            }
            ck_assert_uint_ge(known, least);
            least = known;
            if (flags == 0) ck_assert_uint_le(vertices, limit);
            if (flags == 0 && known < count) ck_assert_uint_eq(vertices, limit);
        }
        ck_assert_uint_eq(least, count);
        free(all);
        end_world(&w);
    }
}
END_TEST

/* A position that is no number any more matters where it is read. */
START_TEST(changed_positions) {
    world w;
    two_in_each_other(&w, 3, VOX_GRID_PENETRATIONS);
    ck_ok(vox_grid_step(w.grid));
    const vox_contact_view contacts = contacts_of(w.grid);
    uint32_t inside = UINT32_MAX, outside = UINT32_MAX;
    for (uint32_t v = 0; v < w.models[0].shape.vertex_count; ++v) {
        int touches = 0;
        for (uint64_t i = 0; i < contacts.count; ++i)
            touches |= contacts.data[i].body_a == w.models[0].mesh && contacts.data[i].vertex == v;
        if (touches)
            inside = v;
        else
            outside = v;
    }
    ck_assert(inside != UINT32_MAX && outside != UINT32_MAX);
    float* const positions = w.models[0].shape.positions;
    const float was[2] = {positions[3 * inside + 1], positions[3 * outside + 2]};
    vox_readings_desc desc = vox_default_readings_desc();
    positions[3 * outside + 2] = NAN;
    prepare(w.grid, VOX_READING_POSITION | VOX_READING_DEPTH, 0, 0);
    ck_fails(vox_grid_prepare_readings_of(w.grid, &desc), VOX_ERROR_NON_FINITE, "not finite");
    positions[3 * inside + 1] = INFINITY;
    prepare(w.grid, VOX_READING_DEPTH, 0, 0);
    desc.what = VOX_READING_POSITION;
    ck_fails(vox_grid_prepare_readings_of(w.grid, &desc), VOX_ERROR_NON_FINITE, "not finite");
    ck_assert_uint_eq(readings_of(w.grid).data[0].known, VOX_READING_DEPTH);
    positions[3 * inside + 1] = was[0];
    positions[3 * outside + 2] = was[1];
    ck_ok(vox_grid_prepare_readings(w.grid));
    end_world(&w);
}
END_TEST

/* Parts without surfaces prepare no mesh and take the memory of the readings; the second time nothing. */
START_TEST(memory) {
    ledger l = {0};
    world w;
    two_in_each_other(&w, 4, 0);
    vox_grid_destroy(w.grid);
    vox_grid_desc desc = engine_desc();
    desc.flags = 0;
    desc.allocator = ledger_allocator(&l);
    w.grid = grid_of(&desc);
    insert(&w, w.grid);
    ck_ok(vox_grid_step(w.grid));
    uint64_t bytes = l.bytes;
    prepare(w.grid, VOX_READING_POSITION, 0, 0);
    const uint64_t count = readings_of(w.grid).count;
    ck_assert_uint_gt(count, 20);
    ck_assert_uint_le(l.bytes - bytes, (count + 20) * sizeof(vox_reading));
    for (int round = 0; round < 2; ++round) {
        l.calls = 0;
        for (uint32_t what = 1; what <= all_parts; ++what) {
            prepare(w.grid, what, 0, 0);
            prepare(w.grid, what, w.models[0].mesh, 0);
            prepare(w.grid, what, w.models[1].mesh, w.models[0].mesh);
        }
        ck_ok(vox_grid_step(w.grid));
        if (round == 1) ck_assert_uint_eq(l.calls, 0);
    }
    end_world(&w);
    ck_assert_uint_eq(l.bytes, 0);
}
END_TEST

/* Enough contacts that workers share parts without surfaces. */
START_TEST(workers) {
    body bodies[2] = {make_box(26, 1, 0, 0, 0), make_box(26, 1, 3.3f, 2.2f, 1.1f)};
    vox_reading* expected = NULL;
    vox_depth* exact = NULL;
    uint64_t count = 0;
    for (uint32_t workers = 1; workers <= 8; workers *= 2) {
        vox_grid* grid = new_grid(suite_engine, VOX_GRID_PENETRATIONS, workers);
        for (int b = 0; b < 2; ++b) {
            const vox_mesh_desc desc = body_desc(&bodies[b]);
            insert_mesh(grid, &desc);
        }
        ck_ok(vox_grid_step(grid));
        prepare(grid, VOX_READING_POSITION | VOX_READING_DEPTH, 0, 0);
        const vox_reading_view view = readings_of(grid);
        const vox_depth_view depths = depths_of(grid);
        if (!expected) {
            count = view.count;
            ck_assert_uint_gt(count, 2 * 8192);
            expected = (vox_reading*)malloc(count * sizeof *expected);
            exact = (vox_depth*)malloc(count * sizeof *exact);
            memcpy(expected, view.data, count * sizeof *expected);
            memcpy(exact, depths.data, count * sizeof *exact);
        }
        ck_assert_uint_eq(view.count, count);
        ck_assert_mem_eq(view.data, expected, count * sizeof *expected);
        ck_assert_mem_eq(depths.data, exact, count * sizeof *exact);
        vox_grid_destroy(grid);
    }
    free(expected);
    free(exact);
    for (int b = 0; b < 2; ++b) free_body(&bodies[b]);
}
END_TEST

static void add_tests(TCase* tests) {
    tcase_add_each(tests, parts_and_pairs, copies_of_a_part, arguments, budget, changed_positions, memory,
                   workers);
}

SUITE(readings_of) { add_for_each_engine(suite, add_tests); }
