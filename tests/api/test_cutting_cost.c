/* What edits take: memory that may be refused, and no more than they change; and a body that the culling by
 * winding numbers goes on for. */
#include <string.h>

#include "scenes/bodies.h"
#include "scenes/random.h"
#include "support/ledger.h"
#include "support/suite.h"

static vox_grid* make_grid(ledger* l) {
    vox_grid_desc desc = engine_desc();
    desc.flags = VOX_GRID_CONSTRAINTS;
    if (l) {
        memset(l, 0, sizeof *l);
        desc.allocator = ledger_allocator(l);
    }
    return grid_of(&desc);
}

/* ---- edits ---- */

enum { edit_kinds = 8 };

/* One of several edits of the first mesh of the scene below. */
static vox_result run_edit(vox_grid* grid, vox_body mesh, const body* box, const float* larger, int kind) {
    static const uint32_t tets[3] = {2, 3, 77};
    uint32_t first = 0;
    vox_vertices_desc vertices = vox_default_vertices_desc();
    vox_mesh_desc desc = body_desc(box);
    switch (kind) {
    case 0:
        return vox_mesh_set_tets_enabled(grid, mesh, tets, 3, 0);
    case 1:
        return vox_mesh_remove_tets(grid, mesh, tets, 3);
    case 2:
        return vox_mesh_replace_tets(grid, mesh, tets, 3, box->tets + 400);
    case 3:
        return vox_mesh_append_tets(grid, mesh, box->tets + 400, 3, &first);
    case 4:
        vertices.count = 2;
        vertices.positions = vox_float_positions(larger, box->vertex_count + 2);
        vertices.copies_of = tets;
        return vox_mesh_append_vertices(grid, mesh, &vertices, &first);
    case 5:
        return vox_mesh_set_tets_enabled(grid, mesh, tets, 3, 1);
    case 6:
        first = box->vertex_count - 1;
        return vox_mesh_remove_vertices(grid, mesh, &first, 1);
    default:
        desc.tet_count = 300;
        return vox_mesh_set_topology(grid, mesh, &desc);
    }
}

/* Two bodies that overlap; the last vertex of the first is of no tet. */
static void insert_scene(vox_grid* grid, const body* box, const body* other, vox_body* mesh) {
    vox_mesh_desc a = body_desc(box), b = body_desc(other);
    vox_filter filter = plain_filter();
    filter.flags = VOX_FILTER_SELF_COLLISION;
    filter.self_rings = 1;
    filter.self_rest_distance = 0.01;
    a.filter = filter;
    ck_ok(vox_mesh_insert(grid, &a, mesh));
    insert_mesh(grid, &b);
}

START_TEST(allocation_n_fails) {
    body box = make_box(5, 0.25f, 0, 0, 0), other = make_box(3, 0.25f, 0.4f, 0.3f, 0.2f);
    float* larger = (float*)calloc(3 * (box.vertex_count + 3), sizeof(float));
    const uint32_t point = box.vertex_count++;
    float* positions = (float*)calloc(3 * box.vertex_count, sizeof(float));
    memcpy(positions, box.positions, 3 * sizeof(float) * point);
    free(box.positions);
    box.positions = positions;
    for (int axis = 0; axis < 3; ++axis) positions[3 * point + (uint32_t)axis] = 0.5f;
    memcpy(larger, positions, 3 * sizeof(float) * box.vertex_count);
    for (int first_edit = 0; first_edit < 2; ++first_edit)
        for (int kind = 0; kind < edit_kinds; ++kind) {
            uint64_t hashes[2] = {0, 0}; /* without and with the edit */
            uint64_t failed = 0;
            for (uint64_t n = 0;; ++n) { /* 0: none fails */
                ledger l;
                vox_body mesh = 0;
                vox_grid* grid = make_grid(&l);
                insert_scene(grid, &box, &other, &mesh);
                if (!first_edit)
                    ck_ok(run_edit(grid, mesh, &box, larger, 0)); /* so that this one is the second */
                const uint64_t unedited = hash_of_step(grid), bytes = l.bytes;
                if (n > 0) l.fail_at = l.calls + n;
                const vox_result result = run_edit(grid, mesh, &box, larger, kind);
                const int reached = l.calls >= l.fail_at;
                l.fail_at = 0;
                if (n == 0) {
                    ck_ok(result);
                    hashes[0] = unedited;
                    hashes[1] = hash_of_step(grid);
                    /* What was taken is given back when there is no more need of it. */
                    const uint64_t most = l.bytes;
                    for (int again = 0; again < 3; ++again) (void)hash_of_step(grid);
                    ck_assert_uint_le(l.bytes, most + most / 4);
                } else {
                    ck_assert_msg(result == VOX_OK || result == VOX_ERROR_OUT_OF_MEMORY, "%s",
                                  vox_last_error());
                    failed += result != VOX_OK;
                    if (result != VOX_OK) ck_assert_uint_le(l.bytes, bytes + bytes / 2);
                    ck_assert_uint_eq(hash_of_step(grid), hashes[result == VOX_OK]);
                }
                vox_grid_destroy(grid);
                ck_assert_uint_eq(l.bytes, 0);
                if (n > 0 && !reached) break;
            }
            ck_assert_msg(failed > 0, "edit %d never failed", kind);
        }
    free(larger);
    free_body(&box);
    free_body(&other);
}
END_TEST

/* An edit takes memory in proportion to its size: in a body of 40,000 tets, a thousand small edits together
 * request less memory than preparing the whole body a few times would. */
START_TEST(edits_cost_what_they_change) {
    ledger l;
    body box = make_box(20, 0.25f, 0, 0, 0);
    vox_mesh_desc desc = body_desc(&box);
    uint64_t random = 5;
    vox_filter filter = plain_filter();
    vox_grid* grid = make_grid(&l);
    filter.flags = VOX_FILTER_SELF_COLLISION;
    filter.self_rings = 1;
    desc.filter = filter;
    desc.flags = VOX_MESH_COPY_POSITIONS;
    vox_body mesh = insert_mesh(grid, &desc);
    ck_ok(vox_grid_step(grid));
    const uint64_t whole = 16ull * box.tet_count; /* the tets alone */
    for (int round = 0; round < 1000; ++round) {
        const uint32_t v = random_below(&random, box.vertex_count);
        uint32_t tet = random_below(&random, box.tet_count), first = 0, corners[4];
        vox_vertices_desc vertices = vox_default_vertices_desc();
        vertices.count = 1;
        vertices.copies_of = &v;
        ck_ok(vox_mesh_set_tets_enabled(grid, mesh, &tet, 1, (uint32_t)round % 3 == 2));
        ck_ok(vox_mesh_append_vertices(grid, mesh, &vertices, &first));
        memcpy(corners, box.tets + 4 * tet, sizeof corners);
        corners[round % 4] = first;
        ck_ok(vox_mesh_replace_tets(grid, mesh, &tet, 1, corners));
        if (round == 0) l.taken = 0; /* the first edit is in proportion to the mesh */
    }
    /* Arrays that double once or twice, and 1000 edits of a few kilobytes. */
    ck_assert_msg(l.taken < 20 * whole, "%llu bytes, the body has %llu", (unsigned long long)l.taken,
                  (unsigned long long)whole);
    filter.flags = 0; /* contacts take memory, too */
    ck_ok(vox_body_set_filter(grid, mesh, &filter));
    l.taken = 0;
    ck_ok(vox_grid_step(grid)); /* to which nothing was left but buffers of more vertices */
    ck_assert_msg(l.taken < 4 * whole, "%llu bytes in the step", (unsigned long long)l.taken);
    vox_grid_destroy(grid);
    ck_assert_uint_eq(l.bytes, 0);
    free_body(&box);
}
END_TEST

/* A body that is culled by winding numbers, cut to and fro: as the reference engine and a new grid find it.
 */
START_TEST(compact_body) {
    body box = make_box(22, 0.25f, 0, 0, 0);
    vox_mesh_desc desc = body_desc(&box);
    uint64_t random = 9;
    uint8_t* off = (uint8_t*)calloc(box.tet_count, 1);
    uint32_t* kept = (uint32_t*)malloc(4 * sizeof(uint32_t) * box.tet_count);
    vox_grid* grid = make_grid(NULL);
    desc.filter.flags = VOX_FILTER_SELF_COLLISION;
    vox_body mesh = insert_mesh(grid, &desc);
    ck_ok(vox_grid_step(grid));
    for (int round = 0; round < 12; ++round) {
        for (int i = 0; i < 4; ++i) { /* a few cubes off or on, and vertices into the body or back */
            uint32_t tets[15];
            const uint32_t first = 5 * random_below(&random, box.tet_count / 5 - 3),
                           on = random_below(&random, 3) == 0;
            for (uint32_t k = 0; k < 15; ++k) {
                tets[k] = first + k;
                off[first + k] = !on;
            }
            ck_ok(vox_mesh_set_tets_enabled(grid, mesh, tets, 15, on));
        }
        for (int i = 0; i < 3; ++i)
            box.positions[3 * random_below(&random, box.vertex_count)] += round % 2 ? 0.5f : -0.5f;
        uint32_t count = 0;
        for (uint32_t t = 0; t < box.tet_count; ++t)
            if (!off[t]) memcpy(kept + 4 * count++, box.tets + 4 * t, 4 * sizeof(uint32_t));
        vox_mesh_desc rest = vox_mesh_desc_floats(box.positions, box.vertex_count, kept, count);
        vox_grid_desc other_desc = vox_default_grid_desc();
        rest.filter.flags = VOX_FILTER_SELF_COLLISION;
        use_engine(&other_desc, round % 2 ? ENGINE_REFERENCE : ENGINE_FAST);
        vox_grid* other = grid_of(&other_desc);
        insert_mesh(other, &rest);
        ck_ok(vox_grid_step(other));
        ck_ok(vox_grid_step(grid));
        vox_contact_view mine = contacts_of(grid);
        vox_contact_view expected = contacts_of(other);
        ck_assert_uint_eq(mine.count, expected.count);
        for (uint64_t i = 0; i < mine.count; ++i) {
            const uint32_t* was = box.tets + 4 * mine.data[i].tet;
            ck_assert_uint_eq(mine.data[i].vertex, expected.data[i].vertex);
            ck_assert_int_eq(memcmp(was, kept + 4 * expected.data[i].tet, 4 * sizeof(uint32_t)), 0);
        }
        vox_grid_destroy(other);
    }
    vox_grid_destroy(grid);
    free(off);
    free(kept);
    free_body(&box);
}
END_TEST

/* Two tets on the same side of a facet, which then counts twice in the boundary of such a body: the apex of
 * the inner one is found, whether they are smaller than a cell of the culling or larger. */
START_TEST(two_tets_on_one_side) {
    static const uint32_t corners[8] = {0, 1, 2, 3, 0, 1, 2, 4};
    static const float apices[6] = {0.125f, 0.125f, 1, 0.25f, 0.25f, 0.375f};
    const float scale = 0.25f * (float)(1 << _i);
    body box = make_box(22, 0.25f, 0, 0, 0);
    vox_mesh_desc desc = body_desc(&box);
    vox_vertices_desc vertices = vox_default_vertices_desc();
    float positions[15];
    uint32_t first = 0, first_tet = 0, named[8];
    vox_grid* grid = make_grid(NULL);
    desc.flags = VOX_MESH_COPY_POSITIONS;
    desc.filter.flags = VOX_FILTER_SELF_COLLISION;
    vox_body mesh = insert_mesh(grid, &desc);
    ck_ok(vox_grid_step(grid));
    memcpy(positions, unit_tet_positions, 9 * sizeof(float));
    memcpy(positions + 9, apices, sizeof apices);
    for (int i = 0; i < 15; ++i) positions[i] = 10 + scale * positions[i];
    vertices.count = 5;
    vertices.positions = vox_float_positions(positions, 5);
    ck_ok(vox_mesh_append_vertices(grid, mesh, &vertices, &first));
    for (int i = 0; i < 8; ++i) named[i] = first + corners[i];
    ck_ok(vox_mesh_append_tets(grid, mesh, named, 2, &first_tet));
    ck_ok(vox_grid_step(grid));
    vox_contact_view view = contacts_of(grid);
    ck_assert_uint_eq(view.count, 1);
    ck_assert(view.data[0].vertex == first + 4 && view.data[0].tet == first_tet);
    vox_grid_destroy(grid);
    free_body(&box);
}
END_TEST

static void add_tests(TCase* tests) {
    tcase_add_each(tests, allocation_n_fails, edits_cost_what_they_change, compact_body);
    tcase_add_loop_test(tests, two_tets_on_one_side, 0, 5);
}

SUITE(cutting_cost) { add_for_each_engine(suite, add_tests); }
