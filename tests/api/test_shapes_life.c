/* Rigid shapes in a grid: pairs and events, filters, what is refused, warm starts, failures, memory. */
#include "scenes/bodies.h"
#include "support/ledger.h"
#include "support/shape_checks.h"

/* A vertex, one unit below a floor. */
typedef struct floor_scene {
    double at[3];
    vox_grid* grid;
    vox_body floor, points;
} floor_scene;

static void begin_floor(floor_scene* s) {
    const vox_shape_desc floor = shape_desc(VOX_SHAPE_HALF_SPACE);
    s->at[0] = s->at[1] = 0;
    s->at[2] = -1;
    s->grid = constraint_grid();
    s->points = insert_points(s->grid, s->at, 1);
    s->floor = insert_shape(s->grid, &floor);
}

/* ---- pairs -------------------------------------------------------------------------------------- */

START_TEST(events) {
    floor_scene s;
    begin_floor(&s);
    ck_assert_int_eq(stepped_pair(s.grid), VOX_PAIR_BEGAN);
    const vox_pair_view view = pairs_of(s.grid);
    ck_assert(view.data[0].body_a == s.points && view.data[0].body_b == s.floor);
    ck_assert_uint_eq(view.data[0].contact_count, 0);
    ck_assert_int_eq(stepped_pair(s.grid), VOX_PAIR_PERSISTED);
    s.at[2] = 0.5;
    ck_assert_int_eq(stepped_pair(s.grid), VOX_PAIR_ENDED);
    ck_assert_int_eq(stepped_pair(s.grid), -1);
    ck_ok(vox_grid_set_margin(s.grid, 0.75));
    for (int i = 0; i < 3; ++i) { /* at rest, too */
        ck_assert_int_eq(stepped_pair(s.grid), VOX_PAIR_NEAR);
        ck_assert_uint_eq(count_constraints(s.grid, VOX_CONSTRAINT_PROXIMITY), 1);
    }
    s.at[2] = 0;
    ck_assert_int_eq(stepped_pair(s.grid), VOX_PAIR_BEGAN);
    s.at[2] = 0.5;
    ck_assert_int_eq(stepped_pair(s.grid), VOX_PAIR_ENDED); /* and near */
    ck_assert_uint_eq(constraints_of(s.grid).count, 1);
    ck_assert_int_eq(stepped_pair(s.grid), VOX_PAIR_NEAR);
    ck_ok(vox_grid_set_margin(s.grid, 0));
    ck_assert_int_eq(stepped_pair(s.grid), -1);
    s.at[2] = -1; /* by the floor's move */
    move_shape(s.grid, s.floor, 0, 0, -2);
    ck_assert_int_eq(stepped_pair(s.grid), -1);
    move_shape(s.grid, s.floor, 0, 0, -1);
    ck_assert_int_eq(stepped_pair(s.grid), VOX_PAIR_BEGAN);
    ck_assert_uint_eq(grid_info(s.grid).total_began, 3);
    ck_assert_uint_eq(grid_info(s.grid).total_ended, 2);
    vox_grid_destroy(s.grid);
}
END_TEST

/* Whatever parts two bodies ends their pair, once, and what brings them together again begins it. */
START_TEST(parted) {
    floor_scene s;
    begin_floor(&s);
    const vox_filter all = plain_filter();
    for (int way = 0; way < 8; ++way) {
        const vox_body who = way % 2 ? s.floor : s.points;
        vox_filter filter = plain_filter();
        ck_assert_int_eq(stepped_pair(s.grid), VOX_PAIR_BEGAN);
        ck_assert_int_eq(stepped_pair(s.grid), VOX_PAIR_PERSISTED);
        if (way / 2 == 0) ck_ok(vox_body_set_enabled(s.grid, who, 0));
        if (way / 2 == 1) ck_ok(vox_grid_set_pair_enabled(s.grid, who, way % 2 ? s.points : s.floor, 0));
        if (way / 2 == 2) filter.world = 3;
        if (way / 2 == 3) filter.mask = 2;
        if (way / 2 > 1) ck_ok(vox_body_set_filter(s.grid, who, &filter));
        ck_assert_int_eq(stepped_pair(s.grid), VOX_PAIR_ENDED);
        ck_assert_uint_eq(constraints_of(s.grid).count, 0);
        ck_assert_int_eq(stepped_pair(s.grid), -1);
        ck_ok(vox_body_set_enabled(s.grid, who, 1));
        ck_ok(vox_grid_set_pair_enabled(s.grid, s.points, s.floor, 1));
        ck_ok(vox_body_set_filter(s.grid, who, &all));
    }
    /* A sensor has pairs and no constraints. */
    vox_filter sensor = plain_filter();
    sensor.flags = VOX_FILTER_SENSOR;
    for (int who = 0; who < 2; ++who) {
        ck_ok(vox_body_set_filter(s.grid, who ? s.floor : s.points, &sensor));
        ck_assert_int_eq(stepped_pair(s.grid), who ? VOX_PAIR_PERSISTED : VOX_PAIR_BEGAN);
        ck_assert_uint_eq(constraints_of(s.grid).count, 0);
        ck_ok(vox_body_set_filter(s.grid, who ? s.floor : s.points, &all));
        ck_assert_int_eq(stepped_pair(s.grid), VOX_PAIR_PERSISTED);
        ck_assert_uint_eq(constraints_of(s.grid).count, 1);
    }
    for (int way = 0; way < 3; ++way) {
        if (way == 0) ck_ok(vox_body_remove(s.grid, s.points));
        if (way == 1) ck_ok(vox_body_remove(s.grid, s.floor));
        if (way == 2) ck_ok(vox_grid_clear(s.grid));
        ck_assert_int_eq(stepped_pair(s.grid), VOX_PAIR_ENDED);
        ck_assert_int_eq(stepped_pair(s.grid), -1);
        const vox_shape_desc floor = shape_desc(VOX_SHAPE_HALF_SPACE);
        if (way != 1) s.points = insert_points(s.grid, s.at, 1);
        if (way != 0) s.floor = insert_shape(s.grid, &floor);
        ck_assert_int_eq(stepped_pair(s.grid), VOX_PAIR_BEGAN);
    }
    vox_grid_destroy(s.grid);
}
END_TEST

/* Ids of shapes above and below those of meshes; shapes do not collide with each other. */
START_TEST(order_and_user_data) {
    static const double at[6] = {0, 0, -1, 0, 0, -2};
    vox_grid* grid = constraint_grid();
    vox_shape_desc floor = shape_desc(VOX_SHAPE_HALF_SPACE), ball = round_shape(VOX_SHAPE_SPHERE, 4, 0);
    floor.user_data = 77;
    ball.user_data = 88;
    const vox_body low = insert_shape(grid, &floor), points = insert_points(grid, at, 2),
                   high = insert_shape(grid, &ball);
    ck_ok(vox_grid_step(grid));
    const vox_pair_view pairs = pairs_of(grid);
    ck_assert_uint_eq(pairs.count, 2);
    ck_assert(pairs.data[0].body_a == low && pairs.data[0].body_b == points);
    ck_assert(pairs.data[0].user_data_a == 77 && pairs.data[1].user_data_b == 88);
    const vox_constraint_view view = constraints_of(grid);
    ck_assert_uint_eq(view.count, 4);
    for (uint64_t i = 0; i < 4; ++i) {
        const vox_constraint* c = &view.data[i];
        ck_assert(c->body_a == points && c->body_b == (i < 2 ? low : high) && c->vertices[0] == i % 2);
        ck_assert_uint_eq(c->pair, i / 2);
        ck_assert(c->user_data_a == 0 && c->user_data_b == (i < 2 ? 77u : 88u));
    }
    /* Only some of them. */
    vox_constraint_desc desc = vox_default_constraint_desc();
    desc.body_a = high;
    ck_ok(vox_grid_find_constraints(grid, &desc));
    ck_assert_uint_eq(constraints_of(grid).count, 2);
    desc.body_b = low;
    ck_ok(vox_grid_find_constraints(grid, &desc));
    ck_assert_uint_eq(constraints_of(grid).count, 0);
    vox_grid_destroy(grid);
}
END_TEST

/* ---- from step to step -------------------------------------------------------------------------- */

static vox_body insert_body(vox_grid* grid, const body* b) {
    const vox_mesh_desc desc = body_desc(b);
    return insert_mesh(grid, &desc);
}

START_TEST(warm_start) {
    vox_grid* grid = constraint_grid();
    body box = make_box(4, 0.5f, 0, 0, -1), still = make_box(3, 0.5f, 9, 0, -0.5f);
    const vox_shape_desc floor = shape_desc(VOX_SHAPE_HALF_SPACE), ball = round_shape(VOX_SHAPE_SPHERE, 2, 0);
    (void)insert_shape(grid, &floor);
    (void)insert_body(grid, &box);
    (void)insert_body(grid, &still);
    const vox_body moving = insert_shape(grid, &ball);
    ck_ok(vox_grid_set_margin(grid, 0.25));
    ck_ok(vox_grid_step(grid));
    uint64_t kept_ones = 0;
    for (int step = 0; step < 8; ++step) {
        kept_constraints last = keep_constraints(grid);
        if (step % 2) move_body(&box, 0.125, 0, 0.25 * (step - 4));
        if (step % 3 == 2) move_shape(grid, moving, 0.5 * step, 0, 0);
        ck_ok(vox_grid_step(grid));
        check_previous(grid, &last);
        for (uint64_t i = 0; i < constraints_of(grid).count; ++i)
            kept_ones += constraints_of(grid).data[i].previous != VOX_NONE;
        /* What was carried over is what is found anew. */
        kept_constraints now = keep_constraints(grid);
        vox_body bodies[8];
        uint64_t count = 0;
        ck_ok(vox_grid_get_bodies(grid, bodies, 8, &count));
        for (uint64_t i = 0; i < count; ++i) ck_ok(vox_body_mark_moved(grid, bodies[i]));
        ck_ok(vox_grid_step(grid));
        ck_assert_uint_eq(counter_of(grid, "carried_shape_contacts"), 0);
        same_constraints(grid, &now);
        ck_ok(vox_grid_step(grid));
        same_constraints(grid, &now);
        free(last.data);
        free(now.data);
    }
    ck_assert_uint_gt(kept_ones, 200);
    vox_grid_destroy(grid);
    free_body(&box);
    free_body(&still);
}
END_TEST

START_TEST(removed_vertices) {
    double at[9] = {0, 0, -1, 1, 0, -2, 2, 0, -3};
    static const uint32_t second = 1;
    vox_grid* grid = constraint_grid();
    const vox_shape_desc floor = shape_desc(VOX_SHAPE_HALF_SPACE);
    const vox_body shape = insert_shape(grid, &floor), points = insert_points(grid, at, 3);
    ck_ok(vox_grid_step(grid));
    ck_assert_uint_eq(constraints_of(grid).count, 3);
    ck_ok(vox_mesh_remove_vertices(grid, points, &second, 1));
    ck_ok(vox_grid_step(grid));
    ck_assert_uint_eq(constraints_of(grid).count, 2);
    ck_assert_ptr_null(find_constraint(grid, points, 1, shape));
    vox_grid_destroy(grid);
}
END_TEST

/* ---- what is refused ---------------------------------------------------------------------------- */

START_TEST(meshes_and_shapes) {
    floor_scene s;
    begin_floor(&s);
    vox_body_info info;
    info.struct_size = sizeof info;
    ck_ok(vox_body_get_info(s.grid, s.floor, &info));
    ck_assert_uint_eq(info.shape, VOX_SHAPE_HALF_SPACE);
    ck_assert_uint_eq(info.positions.count, 0);
    ck_assert_uint_eq(info.enabled, 1);
    ck_assert_mem_eq(info.transform, unmoved, sizeof unmoved);
    ck_ok(vox_body_get_info(s.grid, s.points, &info));
    ck_assert_uint_eq(info.shape, VOX_SHAPE_NONE);
    const vox_result wrong = VOX_ERROR_INVALID_ARGUMENT;
    const vox_positions positions = vox_double_positions(s.at, 1);
    const vox_mesh_desc mesh = vox_mesh_desc_doubles(s.at, 1, NULL, 0);
    const vox_vertices_desc vertices = vox_default_vertices_desc();
    const uint32_t index[4] = {0, 0, 0, 0};
    uint32_t first = 0;
    uint64_t count = 0;
    void* mapped = NULL;
    const char* const words = "is a shape, expected a mesh";
    ck_fails(vox_mesh_bind_positions(s.grid, s.floor, &positions), wrong, words);
    ck_fails(vox_mesh_bind_previous_positions(s.grid, s.floor, &positions), wrong, words);
    ck_fails(vox_mesh_map_positions(s.grid, s.floor, &mapped), wrong, words);
    ck_fails(vox_mesh_set_topology(s.grid, s.floor, &mesh), wrong, words);
    ck_fails(vox_mesh_append_vertices(s.grid, s.floor, &vertices, &first), wrong, words);
    ck_fails(vox_mesh_remove_vertices(s.grid, s.floor, index, 1), wrong, words);
    ck_fails(vox_mesh_append_tets(s.grid, s.floor, index, 1, &first), wrong, words);
    ck_fails(vox_mesh_remove_tets(s.grid, s.floor, index, 1), wrong, words);
    ck_fails(vox_mesh_replace_tets(s.grid, s.floor, index, 1, index), wrong, words);
    ck_fails(vox_mesh_set_tets_enabled(s.grid, s.floor, index, 1, 0), wrong, words);
    ck_fails(vox_mesh_get_tets(s.grid, s.floor, NULL, NULL, 0, &count), wrong, words);
    ck_fails(vox_shape_set_previous_transform(s.grid, s.points, unmoved), wrong,
             "is a mesh, expected a shape");
    ck_fails(vox_shape_set_previous_transform(s.grid, 99, unmoved), VOX_ERROR_INVALID_HANDLE, "99");
    ck_fails(vox_shape_set_previous_transform(NULL, s.floor, unmoved), wrong, "grid");
    ck_assert_int_eq(stepped_pair(s.grid), VOX_PAIR_BEGAN);
    vox_grid_destroy(s.grid);
}
END_TEST

static void refuses(const vox_shape_desc* desc, vox_result result, const char* words) {
    vox_grid* grid = engine_grid();
    const uint64_t bytes = grid_info(grid).bytes;
    vox_body shape = 5;
    ck_fails(vox_shape_insert(grid, desc, &shape), result, words);
    ck_assert_uint_eq(shape, 5);
    ck_assert_uint_eq(grid_info(grid).bytes, bytes);
    ck_ok(vox_grid_step(grid));
    vox_grid_destroy(grid);
}

START_TEST(bad_descriptions) {
    const vox_result wrong = VOX_ERROR_INVALID_ARGUMENT, mesh = VOX_ERROR_INVALID_MESH;
    vox_shape_desc desc = vox_default_shape_desc();
    refuses(&desc, wrong, "VOX_SHAPE_NONE");
    desc.kind = (vox_shape_kind)10;
    refuses(&desc, wrong, "shape kind is 10");
    desc = round_shape(VOX_SHAPE_SPHERE, NAN, 0);
    refuses(&desc, wrong, "shape radius is nan");
    desc.radius = -1;
    refuses(&desc, wrong, "shape radius is -1");
    desc = round_shape(VOX_SHAPE_CAPSULE, 1, INFINITY);
    refuses(&desc, wrong, "shape half_length is inf");
    desc = round_shape(VOX_SHAPE_CYLINDER, 4e38, 1);
    refuses(&desc, wrong, "shape radius is 4e+38");
    desc = box_shape(1, -2, 1);
    refuses(&desc, wrong, "shape half_size[1] is -2");
    desc = box_shape(1, 2, 1);
    desc.filter.flags = 1u << 30;
    refuses(&desc, wrong, "flags");
    desc = shape_desc(VOX_SHAPE_FIELD);
    refuses(&desc, wrong, "shape field is null");

    desc = cube_solid();
    desc.triangle_count = 11;
    refuses(&desc, mesh, "has no other triangle");
    uint32_t turned[36];
    memcpy(turned, cube_triangles, sizeof turned);
    turned[0] = cube_triangles[1];
    turned[1] = cube_triangles[0];
    desc = cube_solid();
    desc.triangles = turned;
    refuses(&desc, mesh, "runs the same way in triangles");
    for (int i = 0; i < 36; ++i) turned[i] = cube_triangles[i - i % 3 + 2 - i % 3];
    refuses(&desc, mesh, "the volume is -8: the triangles of a SOLID have to be counter-clockwise");
    turned[7] = 8;
    refuses(&desc, mesh, "shape triangle 2 names vertex 8 of 8");
    desc = cube_solid();
    desc.triangles = NULL;
    refuses(&desc, wrong, "shape triangles");
    desc.triangle_count = 0;
    refuses(&desc, wrong, "shape triangle_count is 0");
    desc = cube_solid();
    desc.positions.data = NULL;
    refuses(&desc, wrong, "shape positions");
    desc = cube_solid();
    desc.triangle_count = (uint64_t)VOX_MAX_SURFACE_TETS + 1;
    refuses(&desc, VOX_ERROR_LIMIT, "357913942 triangles");
    double points[24];
    memcpy(points, cube_points, sizeof points);
    desc = cube_solid();
    desc.positions.data = points;
    points[17] = NAN;
    refuses(&desc, VOX_ERROR_NON_FINITE, "shape position 5 is nan");
    points[17] = 1e39;
    refuses(&desc, VOX_ERROR_LIMIT, "shape position 5 is 1e+39");
    desc.kind = VOX_SHAPE_SHEET;
    points[17] = 1;
    desc.radius = -INFINITY;
    refuses(&desc, wrong, "shape radius is -inf");

    static const double heights[4] = {0, 1, 2, INFINITY};
    desc = shape_desc(VOX_SHAPE_HEIGHTFIELD);
    desc.spacing[0] = desc.spacing[1] = 1;
    desc.columns = 2;
    desc.rows = 1;
    refuses(&desc, wrong, "2 columns and 1 rows");
    desc.rows = 2;
    refuses(&desc, wrong, "shape heights");
    desc.heights = heights;
    refuses(&desc, VOX_ERROR_NON_FINITE, "shape height 3 is inf");
    desc.spacing[1] = 0;
    refuses(&desc, wrong, "shape spacing[1] is 0");
    desc.spacing[1] = 3e38;
    refuses(&desc, wrong, "shape spacing[1] is 3e+38");
    desc.columns = desc.rows = 3037000500u; /* twice the product is little, without its 65th bit */
    refuses(&desc, VOX_ERROR_LIMIT, "9223372037000250000 heights");

    vox_grid* grid = engine_grid();
    vox_body shape = 0;
    ck_fails(vox_shape_insert(grid, NULL, &shape), wrong, "desc");
    ck_fails(vox_shape_insert(grid, &desc, NULL), wrong, "out_body");
    ck_fails(vox_shape_insert(NULL, &desc, &shape), wrong, "grid");
    vox_grid_destroy(grid);
}
END_TEST

/* ---- steps that fail ---------------------------------------------------------------------------- */

/* The distance is z; or as the caller wants. */
static void height(const double* points, uint64_t count, double* distances, double* gradients, void* user) {
    const double* replaced = (const double*)user; /* distance and gradient */
    for (uint64_t i = 0; i < count; ++i) {
        distances[i] = points[3 * i + 2] + replaced[0];
        for (int k = 0; k < 3; ++k) gradients[3 * i + (uint64_t)k] = (k == 2) + replaced[1];
    }
}

START_TEST(field_that_fails) {
    for (uint32_t workers = 1; workers <= 3; ++workers) {
        double replaced[2] = {0, 0}, at[300];
        for (int i = 0; i < 300; ++i) at[i] = i % 3 == 2 ? -1 : 0.01 * i;
        vox_grid_desc grid_desc = engine_desc();
        grid_desc.flags = VOX_GRID_CONSTRAINTS;
        grid_desc.worker_count = workers;
        vox_grid* grid = grid_of(&grid_desc);
        vox_shape_desc desc = box_shape(10, 10, 10);
        desc.kind = VOX_SHAPE_FIELD;
        desc.field = height;
        desc.field_user = replaced;
        const vox_body shape = insert_shape(grid, &desc);
        for (int i = 0; i < 20; ++i) (void)insert_points(grid, at, 100);
        for (int turn = 0; turn < 3; ++turn) {
            ck_ok(vox_body_mark_moved(grid, shape)); /* the function is another now */
            ck_ok(vox_grid_step(grid));
            ck_assert_uint_eq(constraints_of(grid).count, 2000);
            replaced[turn == 0] = turn == 2 ? -INFINITY : NAN;
            ck_ok(vox_body_mark_moved(grid, shape));
            if (turn == 2) { /* infinitely deep */
                ck_ok(vox_grid_step(grid));
            } else {
                ck_fails(vox_grid_step(grid), VOX_ERROR_NON_FINITE, "the field of a shape has distance");
                ck_assert_uint_eq(pairs_of(grid).count, 0);
                ck_fails(vox_grid_find_constraints(grid, NULL), VOX_ERROR_INVALID_STATE, "step");
            }
            replaced[0] = replaced[1] = 0;
        }
        vox_grid_destroy(grid);
    }
}
END_TEST

START_TEST(bad_bodies_are_skipped) {
    double good[3] = {0, 0, -1}, bad[3] = {0, NAN, -1};
    vox_grid* grid = constraint_grid();
    const vox_shape_desc floor = shape_desc(VOX_SHAPE_HALF_SPACE);
    const vox_body first = insert_points(grid, bad, 1), shape = insert_shape(grid, &floor),
                   second = insert_points(grid, good, 1);
    ck_fails(vox_grid_step(grid), VOX_ERROR_NON_FINITE, "vertex 0");
    ck_ok(vox_grid_set_flags(grid, VOX_GRID_CONSTRAINTS | VOX_GRID_SKIP_BAD_BODIES));
    for (int turn = 0; turn < 3; ++turn) {
        bad[1] = turn == 1 ? 0 : NAN;
        ck_ok(vox_grid_step(grid));
        ck_assert_uint_eq(grid_info(grid).skipped_bodies, turn != 1);
        ck_assert_uint_eq(constraints_of(grid).count, turn == 1 ? 2 : 1);
        ck_assert((find_constraint(grid, first, 0, shape) != NULL) == (turn == 1));
        ck_assert_ptr_nonnull(find_constraint(grid, second, 0, shape));
        if (turn) ck_assert_uint_eq(count_pairs(grid, turn == 1 ? VOX_PAIR_BEGAN : VOX_PAIR_ENDED), 1);
    }
    vox_grid_destroy(grid);
}
END_TEST

/* ---- memory ------------------------------------------------------------------------------------- */

/* Each kind once, around the origin. */
static void insert_kinds(vox_grid* grid, vox_result* result, vox_body shapes[8]) {
    static const double heights[9] = {0.5, 0.25, 0.5, 0.5, 0.75, 0.5, 0.5, 0.25, 0.5};
    vox_shape_desc all[8] = {shape_desc(VOX_SHAPE_HALF_SPACE),
                             round_shape(VOX_SHAPE_SPHERE, 1, 0),
                             round_shape(VOX_SHAPE_CAPSULE, 0.5, 1),
                             round_shape(VOX_SHAPE_CYLINDER, 0.75, 1),
                             box_shape(1, 0.5, 0.25),
                             shape_desc(VOX_SHAPE_HEIGHTFIELD),
                             cube_solid(),
                             rectangle(VOX_SHAPE_SHEET)};
    all[5].heights = heights;
    all[5].columns = all[5].rows = 3;
    all[5].spacing[0] = all[5].spacing[1] = 0.5;
    all[7].radius = 0.125;
    for (int i = 0; i < 8 && *result == VOX_OK; ++i) {
        if (!shapes[i]) *result = vox_shape_insert(grid, &all[i], &shapes[i]);
        if (*result == VOX_OK) *result = vox_shape_set_previous_transform(grid, shapes[i], unmoved);
    }
}

static vox_grid_desc counted_desc(ledger* l) {
    vox_grid_desc desc = engine_desc();
    desc.flags = VOX_GRID_CONSTRAINTS;
    desc.margin = 0.25;
    desc.allocator = ledger_allocator(l);
    return desc;
}

START_TEST(steady_state_allocates_nothing) {
    for (uint32_t workers = 1; workers <= 3; workers += 2) {
        ledger l = {0};
        vox_grid_desc desc = counted_desc(&l);
        desc.flags |= VOX_GRID_EDGES;
        desc.worker_count = workers;
        vox_grid* grid = grid_of(&desc);
        body ball = make_lattice_ball(&five_cut, 5, 5);
        for (uint32_t i = 0; i < 3 * ball.vertex_count; ++i) ball.positions[i] *= 0.25f;
        (void)insert_body(grid, &ball);
        vox_result result = VOX_OK;
        vox_body shapes[8] = {0};
        insert_kinds(grid, &result, shapes);
        ck_ok(result);
        uint64_t calls = 0;
        for (int step = 0; step < 12; ++step) {
            if (step == 4) calls = l.calls;
            for (int i = 0; i < 8; ++i) { /* to and fro */
                move_shape(grid, shapes[i], step % 2, 0, 0);
                ck_ok(vox_shape_set_previous_transform(grid, shapes[i], unmoved));
            }
            move_body(&ball, 0, 0, step % 2 ? 0.25 : -0.25);
            ck_ok(vox_grid_step(grid));
        }
        ck_assert_uint_eq(l.calls, calls);
        ck_assert_uint_eq(grid_info(grid).bytes, l.bytes);
        for (int i = 0; i < 8; ++i) ck_ok(vox_body_remove(grid, shapes[i]));
        vox_grid_destroy(grid);
        ck_assert_uint_eq(l.bytes, 0);
        free_body(&ball);
    }
}
END_TEST

START_TEST(every_allocation_fails) {
    const body box = make_box(4, 0.5f, -1, -1, -1);
    kept_constraints expected = {NULL, 0};
    for (uint64_t fail_at = 0;; ++fail_at) {
        ledger l = {0};
        const vox_grid_desc desc = counted_desc(&l);
        vox_grid* grid = NULL;
        l.fail_at = fail_at;
        if (vox_grid_create(&desc, &grid) == VOX_OK) {
            vox_body mesh = 0, shapes[8] = {0};
            vox_result result;
            for (int again = 0; again < 2; ++again) {
                const vox_mesh_desc of = body_desc(&box);
                result = mesh ? VOX_OK : vox_mesh_insert(grid, &of, &mesh);
                insert_kinds(grid, &result, shapes);
                if (result == VOX_OK) result = vox_grid_step(grid);
                if (result == VOX_OK) break;
                ck_assert_int_eq(result, VOX_ERROR_OUT_OF_MEMORY);
                l.fail_at = 0;
            }
            ck_assert_int_eq(result, VOX_OK);
            if (fail_at == 0) expected = keep_constraints(grid);
            ck_assert_uint_gt(expected.count, 100);
            same_constraints(grid, &expected);
            vox_grid_destroy(grid);
        }
        ck_assert_uint_eq(l.bytes, 0);
        if (fail_at > l.calls) break;
    }
    free(expected.data);
    body freed = box;
    free_body(&freed);
}
END_TEST

/* What a shape takes counts, and a shape that takes too much is refused. */
START_TEST(byte_budget) {
    enum { side = 300 };
    double* heights = calloc((size_t)side * side, sizeof *heights);
    vox_grid_desc desc = engine_desc();
    desc.byte_budget = 1u << 20;
    vox_grid* grid = grid_of(&desc);
    const vox_shape_desc solid = cube_solid();
    vox_shape_desc terrain = shape_desc(VOX_SHAPE_HEIGHTFIELD);
    terrain.heights = heights;
    terrain.columns = terrain.rows = side;
    terrain.spacing[0] = terrain.spacing[1] = 1;
    vox_body shape = 0;
    const uint64_t before = grid_info(grid).bytes;
    ck_fails(vox_shape_insert(grid, &terrain, &shape), VOX_ERROR_BUDGET, "1048576");
    ck_assert_uint_eq(grid_info(grid).bytes, before);
    shape = insert_shape(grid, &solid);
    ck_assert_uint_gt(grid_info(grid).bytes, before + sizeof cube_points + sizeof cube_triangles);
    ck_ok(vox_grid_step(grid));
    vox_grid_destroy(grid);
    free(heights);
}
END_TEST

static void add_tests(TCase* tests) {
    tcase_add_each(tests, events, parted, order_and_user_data, warm_start, removed_vertices,
                   meshes_and_shapes, bad_descriptions, field_that_fails, bad_bodies_are_skipped,
                   steady_state_allocates_nothing, every_allocation_fails, byte_budget);
}

SUITE(shapes_life) { add_for_each_engine(suite, add_tests); }
