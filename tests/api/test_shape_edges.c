/* Shapes with flat sides: the same contacts as those of a mesh with the same surface, blades that are found
 * wherever they cross, and snapshots. */
#include <math.h>
#include <string.h>

#include "scenes/bodies.h"
#include "support/constraint_checks.h"
#include "support/snapshot_checks.h"

static vox_grid* edge_grid(void) {
    vox_grid_desc desc = engine_desc();
    desc.flags = VOX_GRID_EDGES | VOX_GRID_CONSTRAINTS;
    return grid_of(&desc);
}

/* ---- a mesh and a solid with its surface --------------------------------------------------------- */

static const int facets[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

static int has_corners(const uint32_t* tet, const uint32_t* v) {
    int common = 0;
    for (int i = 0; i < 4; ++i) common += tet[i] == v[0] || tet[i] == v[1] || tet[i] == v[2];
    return common == 3;
}

static double volume(const body* b, const uint32_t* t) {
    double e[3][3];
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
            e[i][k] = (double)b->positions[3 * t[i + 1] + k] - (double)b->positions[3 * t[0] + k];
    return e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) -
           e[0][1] * (e[1][0] * e[2][2] - e[1][2] * e[2][0]) +
           e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0]);
}

/* The facets of one tetrahedron only, counter-clockwise as seen from outside. */
static uint32_t* surface_of(const body* b, uint64_t* count) {
    uint32_t* out = (uint32_t*)malloc(48 * b->tet_count);
    *count = 0;
    for (uint32_t t = 0; t < b->tet_count; ++t)
        for (int f = 0; f < 4; ++f) {
            uint32_t v[3];
            int tets = 0;
            for (int i = 0; i < 3; ++i) v[i] = b->tets[4 * t + facets[f][i]];
            for (uint32_t u = 0; u < b->tet_count; ++u) tets += has_corners(b->tets + 4 * u, v);
            if (tets != 1) continue;
            if (volume(b, b->tets + 4 * t) < 0) {
                const uint32_t swapped = v[1];
                v[1] = v[2];
                v[2] = swapped;
            }
            memcpy(out + 3 * (*count)++, v, sizeof v);
        }
    return out;
}

typedef struct kind_counts {
    uint64_t inside, edges, of_faces; /* of meshes */
    double sum[3];                    /* of positions of edges */
} kind_counts;

/* Of constraints whose vertices belong to `a`, or to the other with a face of `a`. */
static kind_counts count_kinds(const vox_grid* grid, vox_body a) {
    kind_counts counts = {0, 0, 0, {0, 0, 0}};
    const vox_constraint_view found = constraints_of(grid);
    for (uint64_t i = 0; i < found.count; ++i) {
        const vox_constraint* c = found.data + i;
        if (c->kind == VOX_CONSTRAINT_INSIDE) {
            counts.inside += c->body_a == a;
            continue;
        }
        ck_assert_int_eq(c->kind, VOX_CONSTRAINT_EDGE);
        const int is_edge_of_a = c->body_a == a && c->count_a == 2;
        counts.edges += is_edge_of_a;
        counts.of_faces += !is_edge_of_a;
        for (int k = 0; k < 3; ++k) counts.sum[k] += c->position[k];
    }
    return counts;
}

/* On lattices, vertices lie on faces and edges pass through edges. */
START_TEST(solid_as_mesh) {
    uint64_t all_inside = 0, all_edges = 0;
    for (int turn = 0; turn < 12; ++turn) {
        body a = make_block(&five_cut, 3, 3, 3), b = make_block(&five_cut, 2, 2, 2);
        uint64_t count = 0;
        uint32_t* triangles = surface_of(&b, &count);
        if (turn % 3 == 0) jitter_body(&a, 0.3, 5 + (uint64_t)turn);
        if (turn % 2 == 0) jitter_body(&b, 0.2, 50 + (uint64_t)turn);
        move_body(&b, 0.5 * (turn % 4), 0.25 * (turn % 5), turn % 3);
        kind_counts found[2];
        for (int as_shape = 0; as_shape < 2; ++as_shape) {
            vox_grid* grid = edge_grid();
            const vox_mesh_desc of_a = body_desc(&a), of_b = body_desc(&b);
            const vox_body id = insert_mesh(grid, &of_a);
            vox_body other;
            if (as_shape) {
                vox_shape_desc desc = vox_default_shape_desc();
                desc.kind = VOX_SHAPE_SOLID;
                desc.positions = of_b.positions;
                desc.triangles = triangles;
                desc.triangle_count = count;
                ck_ok(vox_shape_insert(grid, &desc, &other));
            } else {
                insert_mesh(grid, &of_b);
            }
            ck_ok(vox_grid_step(grid));
            found[as_shape] = count_kinds(grid, id);
            vox_grid_destroy(grid);
        }
        ck_assert_uint_eq(found[0].inside, found[1].inside);
        ck_assert_uint_eq(found[0].edges, found[1].edges);
        ck_assert_uint_eq(found[0].of_faces, found[1].of_faces);
        for (int k = 0; k < 3 && turn % 6 == 0; ++k) /* else which of several common points differs */
            ck_assert_double_eq_tol(found[0].sum[k], found[1].sum[k], 1e-9 * (double)(1 + found[0].edges));
        all_inside += found[0].inside;
        all_edges += found[0].edges + found[0].of_faces;
        free(triangles);
        free_body(&a);
        free_body(&b);
    }
    ck_assert_uint_gt(all_inside, 50);
    ck_assert_uint_gt(all_edges, 500);
}
END_TEST

/* ---- blades and needles ----------------------------------------------------------------------------- */

/* Two triangles in the plane x = 0, wider than the ball; `steps` of them through it. */
static vox_body insert_blade(vox_grid* grid, double half) {
    const double positions[12] = {0, -half, -half, 0, half, -half, 0, half, half, 0, -half, half};
    const uint32_t triangles[6] = {0, 1, 2, 0, 2, 3};
    vox_shape_desc desc = vox_default_shape_desc();
    vox_body id = VOX_NULL_BODY;
    desc.kind = VOX_SHAPE_SHEET;
    desc.positions = vox_double_positions(positions, 4);
    desc.triangles = triangles;
    desc.triangle_count = 2;
    ck_ok(vox_shape_insert(grid, &desc, &id));
    return id;
}

/* Wherever the plane is, each edge with its ends on either side has a constraint, once, and no other has. */
START_TEST(blade_through_a_ball) {
    body ball = make_lattice_ball(&five_cut, 4, 3.7);
    uint64_t count = 0;
    uint32_t* triangles = surface_of(&ball, &count);
    vox_grid* grid = edge_grid();
    const vox_mesh_desc desc = body_desc(&ball);
    const vox_body id = insert_mesh(grid, &desc), blade = insert_blade(grid, 50);
    for (int step = 0; step < 53; ++step) {
        const double x = -3.897 + step * 0.149;
        const double at[12] = {1, 0, 0, x, 0, 1, 0, 0.0137, 0, 0, 1, 0.0253};
        uint64_t crossed = 0, found = 0;
        ck_ok(vox_body_set_transform(grid, blade, at));
        ck_ok(vox_grid_step(grid));
        for (uint64_t t = 0; t < count; ++t)
            for (int i = 0; i < 3; ++i) { /* each edge has two triangles, one for each way */
                const double from = (double)ball.positions[3 * triangles[3 * t + i]],
                             to = (double)ball.positions[3 * triangles[3 * t + (i + 1) % 3]];
                crossed += from < x && to > x;
            }
        const vox_constraint_view all = constraints_of(grid);
        for (uint64_t i = 0; i < all.count; ++i) {
            const vox_constraint* c = all.data + i;
            ck_assert_uint_eq(c->body_a, id);
            ck_assert_uint_eq(c->body_b, blade);
            if (c->kind != VOX_CONSTRAINT_EDGE || c->count_a != 2) continue;
            ++found;
            ck_assert_uint_eq(c->count, 2);
            ck_assert_uint_lt(c->element_b, 2);
            ck_assert_double_eq_tol(c->position[0], x, 1e-12);
            ck_assert_double_eq_tol(fabs(c->normal[0]), 1, 1e-15);
            ck_assert_double_le(c->gap, 0);
            ck_assert_double_eq_tol(c->weights[0] + c->weights[1], 1, 1e-15);
            /* The end that has to move less. */
            const double one = (double)ball.positions[3 * c->vertices[0]] - x,
                         two = (double)ball.positions[3 * c->vertices[1]] - x;
            ck_assert_double_eq_tol(-c->gap, fmin(fabs(one), fabs(two)), 1e-12);
        }
        ck_assert_uint_eq(found, crossed);
        if (step > 2 && step < 50) ck_assert_uint_gt(crossed, 0);
    }
    free(triangles);
    vox_grid_destroy(grid);
    free_body(&ball);
}
END_TEST

/* A needle of one segment through a block enters and leaves by a face each, or by more where it meets edges.
 */
START_TEST(needle_through_a_block) {
    body block = make_block(&five_cut, 2, 2, 2);
    const double positions[6] = {0.3, 0.4, -5, 0.3, 0.4, 5};
    const uint32_t segment[3] = {0, 1, 1};
    vox_grid* grid = edge_grid();
    const vox_mesh_desc desc = body_desc(&block);
    vox_shape_desc needle = vox_default_shape_desc();
    vox_body id;
    insert_mesh(grid, &desc);
    needle.kind = VOX_SHAPE_SHEET;
    needle.positions = vox_double_positions(positions, 2);
    needle.triangles = segment;
    needle.triangle_count = 1;
    ck_ok(vox_shape_insert(grid, &needle, &id));
    ck_ok(vox_grid_step(grid));
    const vox_constraint_view all = constraints_of(grid);
    ck_assert_uint_eq(all.count, 2);
    for (uint64_t i = 0; i < 2; ++i) {
        ck_assert_int_eq(all.data[i].kind, VOX_CONSTRAINT_EDGE);
        ck_assert_uint_eq(all.data[i].count_a, 3);
        ck_assert_double_eq_tol(fabs(all.data[i].normal[2]), 1, 1e-15);
        ck_assert_double_eq_tol(all.data[i].gap, -1, 1e-12); /* to the middle of the part inside */
        /* The face moves into the block: out of the needle's way. */
        ck_assert_double_eq(all.data[i].normal[2], all.data[i].position[2] > 1 ? -1 : 1);
    }
    vox_grid_destroy(grid);
    free_body(&block);
}
END_TEST

/* A needle through a ball of some thousand faces, which several tasks search: one finds where it enters,
 * another where it leaves. Any number of workers finds the same. */
START_TEST(needle_through_many_faces) {
    body ball = make_lattice_ball(&five_cut, 10, 9.7);
    const double positions[12] = {0.3, 0.4, -50, 0.3, 0.4, 50, 2.3, -50, 0.2, 2.3, 50, 0.2};
    const uint32_t segments[6] = {0, 1, 1, 2, 3, 3};
    vox_shape_desc needles = vox_default_shape_desc();
    kept_constraints first = {NULL, 0};
    needles.kind = VOX_SHAPE_SHEET;
    needles.positions = vox_double_positions(positions, 4);
    needles.triangles = segments;
    needles.triangle_count = 2;
    for (uint32_t workers = 1; workers <= 4; ++workers) {
        vox_grid_desc of_grid = engine_desc();
        of_grid.flags = VOX_GRID_EDGES | VOX_GRID_CONSTRAINTS;
        of_grid.worker_count = workers;
        vox_grid* grid = grid_of(&of_grid);
        const vox_mesh_desc desc = body_desc(&ball);
        vox_body id;
        insert_mesh(grid, &desc);
        ck_ok(vox_shape_insert(grid, &needles, &id));
        (void)insert_blade(grid, 5);
        ck_ok(vox_grid_step(grid));
        if (workers == 1)
            first = keep_constraints(grid);
        else
            same_constraints(grid, &first);
        const vox_constraint_view all = constraints_of(grid);
        double ends[2][2] = {{0, 0}, {0, 0}}; /* of each needle in the ball */
        for (int pass = 0; pass < 2; ++pass)
            for (uint64_t i = 0; i < all.count; ++i) {
                const vox_constraint* c = all.data + i;
                if (c->body_b != id) continue;
                const int one = (int)c->element_b;
                const double at = c->position[one == 0 ? 2 : 1];
                ck_assert_uint_eq(c->count_a, 3);
                if (pass == 0)
                    ends[one][at > 0] = at;
                else
                    ck_assert_double_eq_tol(
                        c->gap, -0.5 * (ends[one][1] - ends[one][0]) * fabs(c->normal[one == 0 ? 2 : 1]),
                        1e-9);
            }
        for (int one = 0; one < 2; ++one) ck_assert(ends[one][0] < -5 && ends[one][1] > 5);
        vox_grid_destroy(grid);
    }
    free(first.data);
    free_body(&ball);
}
END_TEST

/* ---- life --------------------------------------------------------------------------------------------- */

/* Edges at rest are carried over, with or without other meshes that move. */
START_TEST(at_rest) {
    body ball = make_lattice_ball(&five_cut, 3, 2.7), other = make_block(&five_cut, 1, 1, 1);
    vox_grid* grid = edge_grid();
    const vox_mesh_desc desc = body_desc(&ball), of_other = body_desc(&other);
    insert_mesh(grid, &desc);
    const vox_body moving = insert_mesh(grid, &of_other);
    (void)insert_blade(grid, 50);
    ck_ok(vox_grid_step(grid));
    const uint64_t edges = count_constraints(grid, VOX_CONSTRAINT_EDGE);
    ck_assert_uint_gt(edges, 0);
    for (int step = 0; step < 4; ++step) {
        kept_constraints before = keep_constraints(grid);
        if (step % 2 == 1) ck_ok(vox_body_mark_moved(grid, moving));
        ck_ok(vox_grid_step(grid));
        same_constraints(grid, &before);
        if (suite_engine == ENGINE_FAST) ck_assert_uint_ge(counter_of(grid, "carried_shape_contacts"), 1);
        free(before.data);
    }
    ck_ok(vox_grid_set_flags(grid, VOX_GRID_CONSTRAINTS));
    ck_ok(vox_grid_step(grid));
    ck_assert_uint_eq(count_constraints(grid, VOX_CONSTRAINT_EDGE), 0);
    vox_grid_destroy(grid);
    free_body(&ball);
    free_body(&other);
}
END_TEST

static void never(const double* points, uint64_t count, double* distances, double* gradients, void* user) {
    (void)points, (void)gradients, (void)user;
    for (uint64_t i = 0; i < count; ++i) distances[i] = 1;
}

/* All kinds but a field come back with the same results. */
START_TEST(snapshots_of_shapes) {
    body block = make_block(&five_cut, 3, 3, 3);
    uint64_t count = 0;
    const double heights[6] = {0.3, 0.1, 0.4, 0.2, 0.6, 0.5};
    const double at[12] = {0, -1, 0, 0.7, 1, 0, 0, 0.2, 0, 0, 1, 0.4};
    vox_grid* grid = edge_grid();
    const vox_mesh_desc desc = body_desc(&block);
    body small = make_block(&five_cut, 1, 1, 1);
    uint32_t* triangles = surface_of(&small, &count);
    vox_body removed = VOX_NULL_BODY;
    insert_mesh(grid, &desc);
    for (int kind = VOX_SHAPE_HALF_SPACE; kind < VOX_SHAPE_FIELD; ++kind) {
        vox_shape_desc shape = vox_default_shape_desc();
        vox_body id;
        shape.kind = (vox_shape_kind)kind;
        shape.radius = kind == VOX_SHAPE_SHEET ? 0.25 : 0.75;
        shape.half_length = 0.5;
        for (int k = 0; k < 3; ++k) shape.half_size[k] = 0.3 + k;
        shape.positions = vox_float_positions(small.positions, small.vertex_count);
        shape.triangles = triangles;
        shape.triangle_count = count;
        shape.heights = heights;
        shape.columns = 3;
        shape.rows = 2;
        shape.spacing[0] = shape.spacing[1] = 1.5;
        shape.user_data = 100 + (uint64_t)kind;
        ck_ok(vox_shape_insert(grid, &shape, &id));
        if (kind % 2 == 0) ck_ok(vox_body_set_transform(grid, id, at));
        if (kind == VOX_SHAPE_CAPSULE) removed = id;
    }
    ck_ok(vox_body_remove(grid, removed));
    ck_ok(vox_grid_step(grid));
    const file f = save(grid);
    vox_grid* loaded = load(f, suite_engine);
    ck_ok(vox_grid_step(loaded));
    ck_ok(vox_grid_step(grid));
    kept_constraints expected = keep_constraints(grid);
    ck_assert_uint_gt(expected.count, 50);
    same_constraints(loaded, &expected);
    vox_body bodies[16];
    uint64_t body_count = 0;
    ck_ok(vox_grid_get_bodies(loaded, bodies, 16, &body_count));
    ck_assert_uint_eq(body_count, 8);
    for (uint64_t i = 0; i < body_count; ++i) {
        vox_body_info was = {.struct_size = sizeof was}, is = {.struct_size = sizeof is};
        ck_ok(vox_body_get_info(grid, bodies[i], &was));
        ck_ok(vox_body_get_info(loaded, bodies[i], &is));
        ck_assert_uint_eq(was.shape, is.shape);
        ck_assert_uint_eq(was.user_data, is.user_data);
        ck_assert_mem_eq(was.transform, is.transform, sizeof was.transform);
    }
    const file again = save(loaded);
    ck_assert_uint_eq(f.size, again.size);
    vox_shape_desc field = vox_default_shape_desc();
    vox_body id;
    uint64_t size;
    field.kind = VOX_SHAPE_FIELD;
    field.field = never;
    ck_ok(vox_shape_insert(grid, &field, &id));
    ck_fails(vox_grid_save(grid, NULL, 0, &size), VOX_ERROR_INVALID_STATE, "cannot be saved");
    free(expected.data);
    free(f.bytes);
    free(again.bytes);
    free(triangles);
    vox_grid_destroy(grid);
    vox_grid_destroy(loaded);
    free_body(&block);
    free_body(&small);
}
END_TEST

static void add_tests(TCase* tests) {
    tcase_add_each(tests, solid_as_mesh, blade_through_a_ball, needle_through_a_block,
                   needle_through_many_faces, at_rest, snapshots_of_shapes);
}

SUITE(shape_edges) { add_for_each_engine(suite, add_tests); }
