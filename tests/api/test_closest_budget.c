/* closest_budget: which penetrations get a closest point, and what becomes of the others. */
#include <stdio.h>

#include "scenes/random.h"
#include "support/depth_checks.h"
#include "support/ledger.h"

/* A ball inside a box, and a body tangled with itself. */
typedef struct scene {
    body outer, inner, tangled;
} scene;

static scene make_scene(void) {
    scene s = {make_box(5, 0.25f, 0, 0, 0), make_lattice_ball(&five_cut_exchanged, 4, 3.3),
               make_box(5, 0.25f, 3, 0, 0)};
    for (uint32_t i = 0; i < 3 * s.inner.vertex_count; ++i)
        s.inner.positions[i] = 0.12f * s.inner.positions[i] + 0.61f;
    uint64_t random = 3;
    for (uint32_t i = 0; i < 3 * s.tangled.vertex_count; ++i)
        s.tangled.positions[i] += random_float(&random, -0.2f, 0.2f);
    return s;
}

static void free_scene(scene* s) {
    free_body(&s->outer);
    free_body(&s->inner);
    free_body(&s->tangled);
}

static void insert_scene(vox_grid* grid, const scene* s) {
    vox_mesh_desc tangled = body_desc(&s->tangled), inner = body_desc(&s->inner),
                  outer = body_desc(&s->outer);
    tangled.filter.flags = VOX_FILTER_SELF_COLLISION;
    insert_mesh(grid, &inner);
    insert_mesh(grid, &tangled);
    insert_mesh(grid, &outer);
}

typedef struct messages {
    int count;
    char last[256];
} messages;

static void write_message(vox_log_level level, const char* text, void* user) {
    messages* to = (messages*)user;
    if (level != VOX_LOG_WARNING) return;
    ++to->count;
    snprintf(to->last, sizeof to->last, "%s", text);
}

/* Whether each penetration of a scene takes a search: the first one, and all that are UNKNOWN with a budget
 * of 1. */
static uint8_t* searched_ones(const scene* s, uint64_t count) {
    uint8_t* searched = (uint8_t*)calloc(count, 1);
    vox_grid_desc desc = engine_desc();
    desc.closest_budget = 1;
    vox_grid* grid = grid_of(&desc);
    insert_scene(grid, s);
    ck_ok(vox_grid_step(grid));
    const vox_penetration_view view = penetrations_of(grid);
    ck_assert_uint_eq(view.count, count);
    ck_assert_int_eq(penetration_at(view, 0)->state, VOX_PENETRATION_ENCLOSED); /* of the ball in the box */
    searched[0] = 1;
    for (uint64_t i = 1; i < count; ++i)
        searched[i] = penetration_at(view, i)->state == VOX_PENETRATION_UNKNOWN;
    vox_grid_destroy(grid);
    return searched;
}

START_TEST(the_first_ones_in_order) {
    scene s = make_scene();
    vox_grid_desc desc = engine_desc();
    ck_assert_uint_eq(desc.closest_budget, 0);
    messages log = {0, ""};
    const vox_log log_lines = {write_message, &log};
    desc.log = &log_lines;
    vox_grid* unlimited = grid_of(&desc);
    insert_scene(unlimited, &s);
    ck_ok(vox_grid_step(unlimited));
    check_penetrations(unlimited);
    const vox_penetration_view all = penetrations_of(unlimited);
    const uint64_t searches = counters_of(unlimited).closest_searches;
    ck_assert_uint_gt(searches, 100);
    ck_assert_uint_eq(counters_of(unlimited).unknown_penetrations, 0);
    ck_assert_int_eq(log.count, 0);
    uint64_t hash = 0;
    ck_ok(vox_grid_get_hash(unlimited, &hash));
    uint8_t* is_searched = searched_ones(&s, all.count);
    uint64_t sum = 0;
    for (uint64_t i = 0; i < all.count; ++i) sum += is_searched[i];
    ck_assert_uint_eq(sum, searches);

    const uint64_t budgets[] = {1, 2, searches / 2, searches - 1, searches, searches + 1, UINT64_MAX};
    for (int k = 0; k < 7; ++k)
        for (uint32_t workers = 1; workers <= 4; workers += 3) {
            log.count = 0;
            desc.closest_budget = budgets[k];
            desc.worker_count = workers;
            vox_grid* grid = grid_of(&desc);
            insert_scene(grid, &s);
            ck_ok(vox_grid_step(grid));
            const vox_penetration_view view = penetrations_of(grid);
            ck_assert_uint_eq(view.count, all.count);
            uint64_t left = budgets[k], unknown = 0;
            for (uint64_t i = 0; i < all.count; ++i) {
                const vox_penetration *expected = penetration_at(all, i), *found = penetration_at(view, i);
                if (!is_searched[i] || left > 0) {
                    if (is_searched[i]) --left;
                    ck_assert_mem_eq(found, expected, sizeof *found);
                    continue;
                }
                ++unknown;
                ck_assert_int_eq(found->state, VOX_PENETRATION_UNKNOWN);
                ck_assert(found->depth == 0);
                ck_assert(fabs(norm(direction_of(found)) - 1) < 1e-6);
                ck_assert_uint_eq(found->contact, expected->contact);
            }
            const grid_counts counters = counters_of(grid);
            ck_assert_uint_eq(counters.unknown_penetrations, unknown);
            ck_assert_uint_eq(counters.closest_searches, searches - unknown);
            ck_assert_int_eq(log.count, unknown > 0);
            if (unknown > 0) ck_assert_ptr_nonnull(strstr(log.last, "closest_budget"));
            uint64_t other = 0;
            ck_ok(vox_grid_get_hash(grid, &other));
            ck_assert_uint_eq(other, hash);
            vox_grid_destroy(grid);
        }
    vox_grid_destroy(unlimited);
    free(is_searched);
    free_scene(&s);
}
END_TEST

/* The direction of an unknown penetration is the normal of a facet of the contact's tetrahedron, outwards. */
START_TEST(normals_of_facets) {
    scene s = make_scene();
    vox_grid_desc desc = engine_desc();
    desc.closest_budget = 1;
    vox_grid* grid = grid_of(&desc);
    const vox_mesh_desc first = body_desc(&s.inner), second = body_desc(&s.outer);
    insert_mesh(grid, &first);
    insert_mesh(grid, &second);
    ck_ok(vox_grid_step(grid));
    const vox_penetration_view view = penetrations_of(grid);
    const vox_contact_view contacts = contacts_of(grid);
    uint64_t unknown = 0;
    for (uint64_t i = 0; i < view.count; ++i) {
        const vox_penetration* p = penetration_at(view, i);
        if (p->state != VOX_PENETRATION_UNKNOWN) continue;
        ++unknown;
        const vox_contact* c =
            (const vox_contact*)(const void*)((const char*)contacts.data + p->contact * contacts.byte_stride);
        const uint32_t* v = s.outer.tets + 4 * (c->tet & 0x7fffffffu);
        int is_normal = 0;
        for (int apex = 0; apex < 4; ++apex) {
            const vector a = place(s.outer.positions, v[(apex + 1) % 4]),
                         b = place(s.outer.positions, v[(apex + 2) % 4]),
                         d = place(s.outer.positions, v[(apex + 3) % 4]),
                         inside = place(s.outer.positions, v[apex]);
            vector n = outer(minus(b, a), minus(d, a));
            if (inner(n, minus(inside, a)) > 0) n = minus((vector){0, 0, 0}, n);
            is_normal |= degrees_between(n, direction_of(p)) < 0.01;
        }
        ck_assert(is_normal);
    }
    ck_assert_uint_gt(unknown, 50);
    vox_grid_destroy(grid);
    free_scene(&s);
}
END_TEST

/* Trees are kept, counted, and take nothing more while bodies move; removing a mesh gives its tree back. */
START_TEST(memory_is_steady) {
    scene s = make_scene();
    for (uint32_t workers = 1; workers <= 4; workers += 3) {
        ledger l = {0};
        vox_grid_desc desc = engine_desc();
        desc.allocator = ledger_allocator(&l);
        desc.worker_count = workers;
        vox_grid* grid = grid_of(&desc);
        insert_scene(grid, &s);
        ck_ok(vox_grid_step(grid));
        ck_assert_uint_gt(counters_of(grid).closest_searches, 100);
        for (int step = 0; step < 2; ++step) {
            for (uint32_t i = 0; i < 3 * s.inner.vertex_count; ++i)
                s.inner.positions[i] += step % 2 ? -0.001f : 0.001f;
            ck_ok(vox_grid_step(grid));
        }
        const uint64_t calls = l.calls;
        for (int step = 0; step < 6; ++step) {
            for (uint32_t i = 0; i < 3 * s.inner.vertex_count; ++i)
                s.inner.positions[i] += step % 2 ? -0.001f : 0.001f;
            ck_ok(vox_grid_step(grid));
            ck_assert_uint_eq(counters_of(grid).bytes, l.bytes);
        }
        ck_assert_uint_eq(l.calls, calls);
        ck_ok(vox_grid_clear(grid));
        const uint64_t rest = l.bytes;
        insert_scene(grid, &s);
        ck_ok(vox_grid_step(grid));
        ck_ok(vox_grid_clear(grid));
        ck_assert_uint_le(l.bytes, rest);
        vox_grid_destroy(grid);
        ck_assert_uint_eq(l.bytes, 0);
    }
    free_scene(&s);
}
END_TEST

/* What a step finds does not depend on the steps before, nor on meshes that came and went. */
START_TEST(steps_before_do_not_matter) {
    scene s = make_scene();
    vox_grid_desc desc = engine_desc();
    vox_grid *fresh = grid_of(&desc), *old = grid_of(&desc);
    insert_scene(fresh, &s);
    insert_scene(old, &s);
    uint64_t random = 5;
    float* rest = (float*)malloc(3 * sizeof(float) * s.tangled.vertex_count);
    memcpy(rest, s.tangled.positions, 3 * sizeof(float) * s.tangled.vertex_count);
    for (int step = 0; step < 4; ++step) {
        for (uint32_t i = 0; i < 3 * s.tangled.vertex_count; ++i)
            s.tangled.positions[i] = rest[i] * (step == 2 ? 50 : 1) + random_float(&random, -0.3f, 0.3f);
        ck_ok(vox_grid_step(old));
    }
    memcpy(s.tangled.positions, rest, 3 * sizeof(float) * s.tangled.vertex_count);
    ck_ok(vox_grid_step(old));
    ck_ok(vox_grid_step(fresh));
    const vox_penetration_view a = penetrations_of(old), b = penetrations_of(fresh);
    ck_assert_uint_eq(a.count, b.count);
    ck_assert_mem_eq(a.data, b.data, a.count * sizeof(vox_penetration));
    vox_grid_destroy(fresh);
    vox_grid_destroy(old);
    free(rest);
    free_scene(&s);
}
END_TEST

static void add_tests(TCase* tests) {
    tcase_add_each(tests, the_first_ones_in_order, normals_of_facets, memory_is_steady,
                   steps_before_do_not_matter);
}

SUITE(closest_budget) { add_for_each_engine(suite, add_tests); }
