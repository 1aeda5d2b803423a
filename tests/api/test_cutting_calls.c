/* The functions that cut and grow meshes one by one: arguments, what an edit changes and what it leaves
 * alone, what else sees it. */
#include <string.h>

#include "scenes/bodies.h"
#include "support/locators.h"

/* ---- arguments ---- */

START_TEST(arguments) {
    const uint32_t zero[4] = {0, 0, 0, 0}, five[1] = {5}, corners[4] = {0, 1, 2, 8};
    uint32_t first = 77;
    body box = make_box(1, 1, 0, 0, 0);
    vox_mesh_desc desc = body_desc(&box);
    vox_vertices_desc vertices = vox_default_vertices_desc();
    vox_grid_desc grid_desc = engine_desc();
    grid_desc.flags = VOX_GRID_CONSTRAINTS;
    vox_grid* grid = grid_of(&grid_desc);
    vox_body mesh = insert_mesh(grid, &desc);

    ck_fails(vox_mesh_set_topology(NULL, mesh, &desc), VOX_ERROR_INVALID_ARGUMENT, "grid is null");
    ck_fails(vox_mesh_set_tets_enabled(NULL, mesh, zero, 1, 0), VOX_ERROR_INVALID_ARGUMENT, "grid is null");
    ck_fails(vox_mesh_replace_tets(NULL, mesh, zero, 1, zero), VOX_ERROR_INVALID_ARGUMENT, "grid is null");
    ck_fails(vox_mesh_append_tets(NULL, mesh, zero, 1, &first), VOX_ERROR_INVALID_ARGUMENT, "grid is null");
    ck_fails(vox_mesh_remove_tets(NULL, mesh, zero, 1), VOX_ERROR_INVALID_ARGUMENT, "grid is null");
    ck_fails(vox_mesh_append_vertices(NULL, mesh, &vertices, &first), VOX_ERROR_INVALID_ARGUMENT,
             "grid is null");
    ck_fails(vox_mesh_remove_vertices(NULL, mesh, zero, 1), VOX_ERROR_INVALID_ARGUMENT, "grid is null");

    ck_fails(vox_mesh_set_topology(grid, 0, &desc), VOX_ERROR_INVALID_HANDLE, "body id is 0");
    ck_fails(vox_mesh_set_tets_enabled(grid, 2, zero, 1, 0), VOX_ERROR_INVALID_HANDLE, "body id 2");
    ck_fails(vox_mesh_replace_tets(grid, 2, zero, 1, zero), VOX_ERROR_INVALID_HANDLE, "body id 2");
    ck_fails(vox_mesh_append_tets(grid, 2, zero, 1, &first), VOX_ERROR_INVALID_HANDLE, "body id 2");
    ck_fails(vox_mesh_remove_tets(grid, 2, zero, 1), VOX_ERROR_INVALID_HANDLE, "body id 2");
    ck_fails(vox_mesh_append_vertices(grid, 2, &vertices, &first), VOX_ERROR_INVALID_HANDLE, "body id 2");
    ck_fails(vox_mesh_remove_vertices(grid, 2, zero, 1), VOX_ERROR_INVALID_HANDLE, "body id 2");

    ck_fails(vox_mesh_set_topology(grid, mesh, NULL), VOX_ERROR_INVALID_ARGUMENT, "desc is null");
    ck_fails(vox_mesh_set_tets_enabled(grid, mesh, NULL, 1, 0), VOX_ERROR_INVALID_ARGUMENT, "tets is null");
    ck_fails(vox_mesh_set_tets_enabled(grid, mesh, zero, 1, 2), VOX_ERROR_INVALID_ARGUMENT, "enabled is 2");
    ck_fails(vox_mesh_replace_tets(grid, mesh, NULL, 1, zero), VOX_ERROR_INVALID_ARGUMENT, "tets is null");
    ck_fails(vox_mesh_replace_tets(grid, mesh, zero, 1, NULL), VOX_ERROR_INVALID_ARGUMENT, "corners is null");
    ck_fails(vox_mesh_append_tets(grid, mesh, NULL, 1, &first), VOX_ERROR_INVALID_ARGUMENT,
             "corners is null");
    ck_fails(vox_mesh_append_tets(grid, mesh, zero, 1, NULL), VOX_ERROR_INVALID_ARGUMENT,
             "out_first is null");
    ck_fails(vox_mesh_remove_tets(grid, mesh, NULL, 1), VOX_ERROR_INVALID_ARGUMENT, "tets is null");
    ck_fails(vox_mesh_append_vertices(grid, mesh, NULL, &first), VOX_ERROR_INVALID_ARGUMENT, "desc is null");
    ck_fails(vox_mesh_append_vertices(grid, mesh, &vertices, NULL), VOX_ERROR_INVALID_ARGUMENT,
             "out_first is null");
    ck_fails(vox_mesh_remove_vertices(grid, mesh, NULL, 1), VOX_ERROR_INVALID_ARGUMENT, "vertices is null");

    ck_fails(vox_mesh_set_tets_enabled(grid, mesh, five, 1, 0), VOX_ERROR_INVALID_ARGUMENT,
             "tets[0] is 5, the mesh has 5 tets");
    ck_fails(vox_mesh_set_tets_enabled(grid, mesh, five, 1ull << 60, 0), VOX_ERROR_LIMIT,
             "count is 1152921504606846976, the limit is 2147483647");
    ck_fails(vox_mesh_append_tets(grid, mesh, zero, VOX_MAX_TETS, &first), VOX_ERROR_LIMIT,
             "the grid holds 5 tets and cannot take 2147483647 more");
    ck_fails(vox_mesh_append_tets(grid, mesh, zero, 400000000, &first), VOX_ERROR_LIMIT,
             "the mesh has 400000005 tets, a grid with VOX_GRID_CONSTRAINTS takes at most 357913941");
    ck_fails(vox_mesh_append_tets(grid, mesh, corners, 1, &first), VOX_ERROR_INVALID_MESH,
             "tet 5 names vertex 8 of 8");
    ck_fails(vox_mesh_replace_tets(grid, mesh, five, 1, zero), VOX_ERROR_INVALID_ARGUMENT, "tets[0] is 5");
    ck_fails(vox_mesh_replace_tets(grid, mesh, zero, 1, corners), VOX_ERROR_INVALID_MESH,
             "tet 0 names vertex 8 of 8");
    ck_fails(vox_mesh_remove_vertices(grid, mesh, corners + 3, 1), VOX_ERROR_INVALID_ARGUMENT,
             "vertices[0] is 8, the mesh has 8 vertices");
    ck_fails(vox_mesh_remove_vertices(grid, mesh, zero, 1), VOX_ERROR_INVALID_ARGUMENT,
             "vertex 0 is a corner of tet 0, which is on");
    desc.tet_count = 1;
    desc.tets = corners;
    ck_fails(vox_mesh_set_topology(grid, mesh, &desc), VOX_ERROR_INVALID_MESH, "tet 0 names vertex 8 of 8");

    vertices.count = 1ull << 40;
    ck_fails(vox_mesh_append_vertices(grid, mesh, &vertices, &first), VOX_ERROR_LIMIT,
             "vertices and cannot take");
    vertices.count = 1;
    ck_fails(vox_mesh_append_vertices(grid, mesh, &vertices, &first), VOX_ERROR_INVALID_ARGUMENT,
             "the mesh borrows its positions, and needs all 9");
    vertices.copies_of = corners + 3;
    ck_fails(vox_mesh_append_vertices(grid, mesh, &vertices, &first), VOX_ERROR_INVALID_ARGUMENT,
             "copies_of[0] is 8, the mesh has 8 vertices");
    vertices.positions = vox_float_positions(unit_tet_positions, 9);
    vertices.positions.byte_stride = 5;
    ck_fails(vox_mesh_append_vertices(grid, mesh, &vertices, &first), VOX_ERROR_INVALID_ARGUMENT,
             "positions.byte_stride is 5");
    vertices.reserved = 1;
    ck_fails(vox_mesh_append_vertices(grid, mesh, &vertices, &first), VOX_ERROR_INVALID_ARGUMENT,
             "reserved is 1");
    ck_assert_uint_eq(first, 77);

    /* Nothing to do is no error. */
    ck_ok(vox_mesh_set_tets_enabled(grid, mesh, NULL, 0, 0));
    ck_ok(vox_mesh_remove_tets(grid, mesh, NULL, 0));
    ck_ok(vox_mesh_remove_vertices(grid, mesh, NULL, 0));
    ck_ok(vox_mesh_replace_tets(grid, mesh, NULL, 0, NULL));
    ck_ok(vox_mesh_append_tets(grid, mesh, NULL, 0, &first));
    ck_assert_uint_eq(first, 5);
    vertices = vox_default_vertices_desc();
    ck_ok(vox_mesh_append_vertices(grid, mesh, &vertices, &first));
    ck_assert_uint_eq(first, 8);

    /* What was removed is no more. */
    static const uint32_t all[5] = {0, 1, 2, 3, 4};
    ck_ok(vox_mesh_remove_tets(grid, mesh, all, 5));
    ck_fails(vox_mesh_remove_tets(grid, mesh, all + 3, 1), VOX_ERROR_INVALID_ARGUMENT,
             "tets[0] is 3, which was removed");
    ck_fails(vox_mesh_replace_tets(grid, mesh, all, 1, zero), VOX_ERROR_INVALID_ARGUMENT,
             "which was removed");
    ck_ok(vox_mesh_remove_vertices(grid, mesh, all + 1, 1));
    ck_fails(vox_mesh_remove_vertices(grid, mesh, all + 1, 1), VOX_ERROR_INVALID_ARGUMENT,
             "vertices[0] is 1, which was removed");
    ck_fails(vox_mesh_append_tets(grid, mesh, all, 1, &first), VOX_ERROR_INVALID_MESH,
             "tet 5 names vertex 1, which was removed");
    ck_ok(vox_grid_step(grid));
    ck_assert_uint_eq(counters_of(grid).tets, 0);
    vox_grid_destroy(grid);
    free_body(&box);
}
END_TEST

/* Edits of nothing leave a mesh at rest, as the fast engine counts it. */
START_TEST(nothing_to_do) {
    body box = make_box(2, 1, 0, 0, 0), other = make_box(2, 1, 0.75f, 0.5f, 0.25f);
    vox_mesh_desc desc = body_desc(&box), more = body_desc(&other);
    const vox_vertices_desc vertices = vox_default_vertices_desc();
    uint32_t first = 0;
    vox_grid* grid = engine_grid();
    vox_body mesh = insert_mesh(grid, &desc);
    insert_mesh(grid, &more);
    for (int step = 0; step < 3; ++step) ck_ok(vox_grid_step(grid));
    const grid_counts before = counters_of(grid);
    ck_assert_uint_eq(before.moved_bodies, suite_engine == ENGINE_FAST ? 0 : 2);
    for (int kind = 0; kind < 6; ++kind) {
        if (kind == 0) ck_ok(vox_mesh_set_tets_enabled(grid, mesh, NULL, 0, 0));
        if (kind == 1) ck_ok(vox_mesh_remove_tets(grid, mesh, NULL, 0));
        if (kind == 2) ck_ok(vox_mesh_replace_tets(grid, mesh, NULL, 0, NULL));
        if (kind == 3) ck_ok(vox_mesh_append_tets(grid, mesh, NULL, 0, &first));
        if (kind == 4) ck_ok(vox_mesh_append_vertices(grid, mesh, &vertices, &first));
        if (kind == 5) ck_ok(vox_mesh_remove_vertices(grid, mesh, NULL, 0));
        ck_ok(vox_grid_step(grid));
        const grid_counts after = counters_of(grid);
        ck_assert_uint_eq(after.moved_bodies, before.moved_bodies);
        ck_assert_uint_eq(after.carried_contacts, before.carried_contacts);
        ck_assert_uint_eq(after.bytes, before.bytes);
    }
    vox_grid_destroy(grid);
    free_body(&box);
    free_body(&other);
}
END_TEST

/* A struct of an older program ends before the rest positions. */
START_TEST(smaller_struct) {
    body box = make_box(1, 1, 0, 0, 0);
    vox_mesh_desc desc = body_desc(&box);
    vox_grid* grid = engine_grid();
    const float place[3] = {0.5f, 0.5f, 0.5f};
    uint32_t first = 0;
    desc.flags = VOX_MESH_COPY_POSITIONS;
    vox_body mesh = insert_mesh(grid, &desc);
    vox_vertices_desc vertices;
    memset(&vertices, 0xff, sizeof vertices);
    const vox_vertices_desc defaults = vox_default_vertices_desc();
    memcpy(&vertices, &defaults, offsetof(vox_vertices_desc, rest_positions));
    vertices.struct_size = offsetof(vox_vertices_desc, rest_positions);
    vertices.count = 1;
    vertices.positions = vox_float_positions(place, 1);
    ck_ok(vox_mesh_append_vertices(grid, mesh, &vertices, &first));
    ck_assert_uint_eq(first, 8);
    vox_grid_destroy(grid);
    free_body(&box);
}
END_TEST

/* ---- what an edit does to the next step, and what it leaves alone ---- */

START_TEST(off_and_on) {
    body box = make_box(2, 1, 0, 0, 0);
    const float point[3] = {0.5f, 0.5f, 0.5f}; /* in the middle tet of the first cube */
    vox_mesh_desc desc = body_desc(&box), sensor = vox_mesh_desc_floats(point, 1, NULL, 0);
    vox_grid* grid = engine_grid();
    vox_body solid = insert_mesh(grid, &desc);
    insert_mesh(grid, &sensor);
    ck_ok(vox_grid_step(grid));
    vox_contact_view view = contacts_of(grid);
    ck_assert_uint_eq(view.count, 1);
    const uint32_t tet = view.data[0].tet;
    for (int round = 0; round < 3; ++round) {
        ck_ok(vox_mesh_set_tets_enabled(grid, solid, &tet, 1, 0));
        ck_ok(vox_grid_get_contacts(grid, &view));
        ck_assert_uint_eq(view.count, 1); /* until the next step */
        ck_ok(vox_grid_step(grid));
        ck_ok(vox_grid_get_contacts(grid, &view));
        ck_assert_uint_eq(view.count, 0);
        ck_assert(count_pairs(grid, VOX_PAIR_ENDED) == 1 && pairs_of(grid).count == 1);
        ck_assert_uint_eq(counters_of(grid).tets, 39);
        ck_assert_uint_eq(counters_of(grid).skipped_degenerate, 0);
        ck_ok(vox_mesh_set_tets_enabled(grid, solid, &tet, 1, 1));
        ck_ok(vox_grid_step(grid));
        ck_ok(vox_grid_get_contacts(grid, &view));
        ck_assert(view.count == 1 && view.data[0].tet == tet);
    }
    /* Cut and restored between two steps: the pair persists. */
    ck_ok(vox_mesh_set_tets_enabled(grid, solid, &tet, 1, 0));
    ck_ok(vox_mesh_set_tets_enabled(grid, solid, &tet, 1, 1));
    ck_ok(vox_grid_step(grid));
    ck_assert(count_pairs(grid, VOX_PAIR_PERSISTED) == 1 && pairs_of(grid).count == 1);
    vox_grid_destroy(grid);
    free_body(&box);
}
END_TEST

START_TEST(topology_keeps_what_is_not_topology) {
    body box = make_box(2, 1, 0, 0, 0), other = make_box(1, 1, 0.25f, 0.25f, 0.25f);
    vox_mesh_desc desc = body_desc(&box), more = body_desc(&other);
    uint64_t user_data = 0;
    vox_filter filter = plain_filter();
    vox_grid* grid = engine_grid();
    desc.user_data = 41;
    filter.category = 6;
    desc.filter = filter;
    vox_body a = insert_mesh(grid, &desc);
    vox_body b = insert_mesh(grid, &more);
    vox_body c = insert_mesh(grid, &more);
    ck_ok(vox_grid_set_pair_enabled(grid, a, c, 0));
    const double up[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0.125};
    ck_ok(vox_body_set_transform(grid, a, up));
    ck_ok(vox_grid_step(grid));
    ck_assert_uint_eq(count_pairs(grid, VOX_PAIR_BEGAN), 2); /* a and b, b and c */

    vox_mesh_desc anew = body_desc(&box);
    anew.tet_count = 5; /* the first cube alone */
    anew.user_data = 99;
    ck_ok(vox_mesh_set_topology(grid, a, &anew));
    ck_ok(vox_body_get_user_data(grid, a, &user_data));
    ck_assert_uint_eq(user_data, 41);
    ck_ok(get_filter(grid, a, &filter));
    ck_assert_uint_eq(filter.category, 6);
    ck_ok(vox_grid_step(grid));
    ck_assert(count_pairs(grid, VOX_PAIR_PERSISTED) == 2 &&
              pairs_of(grid).count == 2); /* a and c still do not collide */
    ck_assert_uint_eq(counters_of(grid).tets, 15);
    const double away[12] = {1, 0, 0, 50, 0, 1, 0, 0, 0, 0, 1, 0};
    ck_ok(vox_body_set_transform(grid, a, away));
    anew.positions.data = NULL; /* those it has; the transform stays, too */
    anew.tet_count = 40;
    ck_ok(vox_mesh_set_topology(grid, a, &anew));
    ck_ok(vox_grid_step(grid));
    ck_assert(count_pairs(grid, VOX_PAIR_PERSISTED) == 1 && count_pairs(grid, VOX_PAIR_ENDED) == 1);

    anew = vox_default_mesh_desc(); /* nothing at all */
    ck_ok(vox_mesh_set_topology(grid, b, &anew));
    ck_ok(vox_grid_step(grid));
    ck_assert(count_pairs(grid, VOX_PAIR_ENDED) == 1 && pairs_of(grid).count == 1);
    anew.positions.count = 3; /* without positions */
    ck_ok(vox_mesh_set_topology(grid, b, &anew));
    ck_fails(vox_grid_step(grid), VOX_ERROR_INVALID_STATE, "has no positions");
    vox_grid_destroy(grid);
    free_body(&box);
    free_body(&other);
}
END_TEST

START_TEST(growing_from_nothing) {
    /* Vertex by vertex and tet by tet, from an empty mesh, in positions of its own. */
    body box = make_box(2, 1, 0, 0, 0);
    vox_mesh_desc desc = vox_default_mesh_desc(), whole = body_desc(&box);
    uint64_t hash = 0, expected = 0;
    void* mapped = NULL;
    vox_grid* grid = engine_grid();
    vox_grid* other = engine_grid();
    body small = make_box(2, 0.5f, 0.25f, 0.375f, 0.125f);
    vox_mesh_desc moving = body_desc(&small);
    vox_body grown = insert_mesh(grid, &desc);
    vox_body probe = insert_mesh(grid, &moving);
    ck_ok(vox_mesh_insert(other, &whole, &grown));
    ck_ok(vox_mesh_insert(other, &moving, &probe));
    expected = hash_of_step(other);
    for (uint32_t v = 0; v < box.vertex_count; ++v) {
        vox_vertices_desc vertices = vox_default_vertices_desc();
        uint32_t first = 0;
        vertices.count = 1;
        vertices.positions = vox_float_positions(box.positions + 3 * v, 1);
        ck_ok(vox_mesh_append_vertices(grid, grown, &vertices, &first));
        ck_assert_uint_eq(first, v);
        if (v == 0) ck_ok(vox_mesh_map_positions(grid, grown, &mapped)); /* borrowed until here */
        ck_ok(vox_grid_step(grid));
    }
    for (uint32_t t = 0; t < box.tet_count; ++t) {
        uint32_t first = 0;
        ck_ok(vox_mesh_append_tets(grid, grown, box.tets + 4 * t, 1, &first));
        ck_assert_uint_eq(first, t);
        hash = hash_of_step(grid);
    }
    ck_assert_uint_eq(hash, expected);
    vox_grid_destroy(grid);
    vox_grid_destroy(other);
    free_body(&box);
    free_body(&small);
}
END_TEST

/* A new vertex close to a facet splits a tetrahedron inside a compact body; a small step later it is beyond
 * the facet. All others are far from turning over, which the engine may know; of a sliver that came with a
 * cut it knows nothing. */
START_TEST(sliver_that_came_turns_over) {
    const uint32_t n = 20, m = n + 1, cube = (10 * n + 10) * n + 10;
    body box = make_box(n, 1, 0, 0, 0);
    const uint32_t *middle = box.tets + 4 * (5 * cube + 4), corner_tet = 5 * cube, p = box.vertex_count;
    float* positions = (float*)malloc(3 * sizeof(float) * (p + 1));
    const uint32_t a = middle[0], b = middle[1], c = middle[2], d = middle[3];
    const uint32_t split[4][4] = {{a, b, c, p}, {a, b, p, d}, {a, p, c, d}, {p, b, c, d}};
    const uint32_t replaced = 5 * cube + 4;
    uint32_t first = 0;
    ck_assert_uint_eq(a + b + c + d,
                      ((10 * m + 10) * m + 10) * 4 + 2 + 2 * m + 2 * m * m); /* 1, 2, 4, 7 of 8 */
    vox_mesh_desc desc = body_desc(&box);
    vox_contact_view view;
    vox_grid* grid = engine_grid();
    memcpy(positions, box.positions, 3 * sizeof(float) * p);
    for (int i = 0; i < 3; ++i) {
        const float facet = (positions[3 * a + i] + positions[3 * b + i] + positions[3 * c + i]) / 3;
        positions[3 * p + i] = facet + 0.01f * (positions[3 * d + i] - facet);
    }
    desc.positions.data = positions;
    desc.positions.count = p + 1;
    desc.filter.flags = VOX_FILTER_SELF_COLLISION;
    vox_body mesh = insert_mesh(grid, &desc);
    for (int i = 0; i < 3; ++i) {
        ck_ok(vox_grid_step(grid));
        ck_ok(vox_grid_get_contacts(grid, &view));
        ck_assert_uint_eq(view.count, 1);
        ck_assert_uint_eq(view.data[0].tet, replaced);
    }
    ck_ok(vox_mesh_replace_tets(grid, mesh, &replaced, 1, split[0]));
    ck_ok(vox_mesh_append_tets(grid, mesh, split[1], 3, &first));
    for (int i = 0; i < 2; ++i) {
        ck_ok(vox_grid_step(grid));
        ck_ok(vox_grid_get_contacts(grid, &view));
        ck_assert_uint_eq(view.count, 0);
    }

    for (int i = 0; i < 3; ++i) {
        const float facet = (positions[3 * a + i] + positions[3 * b + i] + positions[3 * c + i]) / 3;
        positions[3 * p + i] = facet - 0.01f * (positions[3 * d + i] - facet);
    }
    ck_ok(vox_grid_step(grid));
    ck_ok(vox_grid_get_contacts(grid, &view));
    ck_assert_uint_eq(view.count, 1);
    ck_assert_uint_eq(view.data[0].vertex, p);
    ck_assert_uint_eq(view.data[0].tet, corner_tet);
    vox_grid_destroy(grid);
    free(positions);
    free_body(&box);
}
END_TEST

START_TEST(positions_of_its_own) {
    /* An empty mesh that copies positions: the array given with the first vertices is not read any more. */
    vox_mesh_desc desc = vox_default_mesh_desc(),
                  solid = vox_mesh_desc_floats(unit_tet_positions, 4, unit_tet, 1);
    vox_vertices_desc vertices = vox_default_vertices_desc();
    uint32_t first = 0, copy_of = 0;
    void* mapped = NULL;
    double place[3] = {0.125, 0.25, 0.125};
    vox_grid* grid = engine_grid();
    desc.flags = VOX_MESH_COPY_POSITIONS;
    desc.positions.format = VOX_FORMAT_DOUBLE;
    vox_body mesh = insert_mesh(grid, &desc);
    insert_mesh(grid, &solid);
    vertices.count = 1;
    ck_fails(vox_mesh_append_vertices(grid, mesh, &vertices, &first), VOX_ERROR_INVALID_ARGUMENT,
             "needs 1 more");
    vertices.positions = vox_float_positions((const float*)(const void*)place, 1);
    ck_fails(vox_mesh_append_vertices(grid, mesh, &vertices, &first), VOX_ERROR_INVALID_ARGUMENT,
             "positions.format is VOX_FORMAT_FLOAT, that of the mesh is not");
    vertices.positions = vox_double_positions(place, 2);
    ck_fails(vox_mesh_append_vertices(grid, mesh, &vertices, &first), VOX_ERROR_INVALID_ARGUMENT,
             "positions.count is 2, expected 1");
    vertices.positions.count = 1;
    ck_ok(vox_mesh_append_vertices(grid, mesh, &vertices, &first));
    place[0] = 50;
    vertices.positions.data = NULL;
    vertices.copies_of = &copy_of;
    for (uint32_t i = 1; i < 100; ++i) {
        ck_ok(vox_mesh_append_vertices(grid, mesh, &vertices, &first));
        ck_assert_uint_eq(first, i);
    }
    ck_ok(vox_grid_step(grid));
    vox_contact_view view = contacts_of(grid);
    ck_assert_uint_eq(view.count, 100);
    ck_ok(vox_mesh_map_positions(grid, mesh, &mapped));
    for (int i = 0; i < 100; ++i) ck_assert(((double*)mapped)[3 * i] == 0.125);
    /* Others over the same vertices: the positions stay its own. */
    vox_mesh_desc anew = vox_default_mesh_desc();
    anew.positions.count = 100;
    anew.tets = unit_tet;
    anew.tet_count = 1;
    ck_ok(vox_mesh_set_topology(grid, mesh, &anew));
    void* again = NULL;
    ck_ok(vox_mesh_map_positions(grid, mesh, &again));
    ck_assert(again == mapped);
    ck_ok(vox_grid_step(grid));
    vox_grid_destroy(grid);
}
END_TEST

/* ---- queries, suggestions, cell size ---- */

START_TEST(queries_and_suggestions_see_it) {
    body box = make_box(3, 1, 0, 0, 0);
    vox_mesh_desc desc = body_desc(&box);
    const double middle[3] = {1.5, 1.5, 1.5};
    vox_grid* grid = engine_grid();
    vox_body mesh = insert_mesh(grid, &desc);
    vox_locator* locator = take_locator(grid);
    ck_assert_uint_eq(count_at(locator, middle), 1);
    ck_assert(closest_to(locator, middle, NULL).distance == -1.5);
    uint32_t cube[5]; /* the one in the middle: a cavity */
    for (uint32_t i = 0; i < 5; ++i) cube[i] = 5 * 13 + i;
    ck_ok(vox_mesh_remove_tets(grid, mesh, cube, 5));
    ck_ok(vox_grid_update_locator(grid, &locator));
    ck_assert_uint_eq(count_at(locator, middle), 0);
    ck_assert(closest_to(locator, middle, NULL).distance == 0.5);

    uint32_t all[135];
    for (uint32_t t = 0; t < 135; ++t) all[t] = t;
    ck_ok(vox_mesh_set_tets_enabled(grid, mesh, all, 65, 0));
    ck_ok(vox_mesh_set_tets_enabled(grid, mesh, all + 70, 65, 0));
    ck_ok(vox_grid_update_locator(grid, &locator)); /* none is on */
    ck_assert_uint_eq(closest_to(locator, middle, NULL).body, VOX_NULL_BODY);
    vox_locator_release(locator);
    ck_ok(vox_grid_step(grid));
    vox_cell_size_result suggestion = {.struct_size = sizeof suggestion};
    ck_fails(vox_grid_suggest_cell_size(grid, NULL, &suggestion), VOX_ERROR_INVALID_ARGUMENT, "tet");
    vox_grid_destroy(grid);
    free_body(&box);
}
END_TEST

START_TEST(cell_size_follows_a_cut) {
    /* Large tets and many small ones: without the small ones, larger cells are better. */
    body large = make_box(3, 4, 0, 0, 0), small = make_box(8, 0.125f, 1, 1, 1);
    const uint32_t vertices = large.vertex_count + small.vertex_count,
                   tets = large.tet_count + small.tet_count;
    float* positions = (float*)malloc(3 * sizeof(float) * vertices);
    uint32_t* corners = (uint32_t*)malloc(4 * sizeof(uint32_t) * tets);
    uint32_t* fine = (uint32_t*)malloc(sizeof(uint32_t) * small.tet_count);
    memcpy(positions, large.positions, 3 * sizeof(float) * large.vertex_count);
    memcpy(positions + 3 * large.vertex_count, small.positions, 3 * sizeof(float) * small.vertex_count);
    memcpy(corners, large.tets, 4 * sizeof(uint32_t) * large.tet_count);
    for (uint32_t i = 0; i < 4 * small.tet_count; ++i)
        corners[4 * large.tet_count + i] = small.tets[i] + large.vertex_count;
    for (uint32_t i = 0; i < small.tet_count; ++i) fine[i] = large.tet_count + i;
    vox_mesh_desc desc = vox_mesh_desc_floats(positions, vertices, corners, tets);
    double before = 0, after = 0;
    vox_grid* grid = engine_grid();
    desc.filter.flags = VOX_FILTER_SELF_COLLISION;
    vox_body mesh = insert_mesh(grid, &desc);
    ck_ok(vox_grid_step(grid));
    before = grid_info(grid).cell_size;
    ck_ok(vox_mesh_set_tets_enabled(grid, mesh, fine, small.tet_count, 0));
    for (int step = 0; step < 500 && !(after > 1.5 * before); ++step) {
        positions[0] += 0.001f; /* or it is at rest */
        ck_ok(vox_grid_step(grid));
        after = grid_info(grid).cell_size;
    }
    ck_assert_msg(after > 1.5 * before, "cell size %g after %g", after, before);
    vox_grid_destroy(grid);
    free(positions);
    free(corners);
    free(fine);
    free_body(&large);
    free_body(&small);
}
END_TEST

static void add_tests(TCase* tests) {
    tcase_add_each(tests, arguments, nothing_to_do, smaller_struct, off_and_on,
                   topology_keeps_what_is_not_topology, growing_from_nothing, sliver_that_came_turns_over,
                   positions_of_its_own, queries_and_suggestions_see_it, cell_size_follows_a_cut);
}

SUITE(cutting_calls) { add_for_each_engine(suite, add_tests); }
