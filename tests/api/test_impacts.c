/* Impacts: when two bodies that move meet, and what went through, against a search for the roots of all
 * vertices and faces; their life, memory and errors. */
#include <math.h>
#include <string.h>

#include "scenes/bodies.h"
#include "support/constraint_checks.h"
#include "support/ledger.h"

typedef struct moving_body {
    body now;
    float* before;
    vox_body id;
} moving_body;

static vox_grid_desc impact_desc(void) {
    vox_grid_desc desc = engine_desc();
    desc.flags = VOX_GRID_CONSTRAINTS;
    return desc;
}

static vox_grid* impact_grid(void) {
    const vox_grid_desc desc = impact_desc();
    return grid_of(&desc);
}

static uint64_t count_impacts(const vox_grid* grid) { return count_constraints(grid, VOX_CONSTRAINT_IMPACT); }

static void bind_previous(vox_grid* grid, const moving_body* m) {
    ck_ok(bind_previous_array(grid, m->id, m->before, VOX_FORMAT_FLOAT, 0, 0));
}

/* Stands still until it is moved. */
static moving_body insert_moving(vox_grid* grid, body b) {
    moving_body m;
    const vox_mesh_desc desc = body_desc(&b);
    m.now = b;
    m.before = malloc(3 * sizeof(float) * b.vertex_count);
    memcpy(m.before, b.positions, 3 * sizeof(float) * b.vertex_count);
    m.id = insert_mesh(grid, &desc);
    bind_previous(grid, &m);
    return m;
}

static void free_moving(moving_body* m) {
    free_body(&m->now);
    free(m->before);
}

/* ---- by definition ------------------------------------------------------------------------------ */

typedef struct vector {
    double x[3];
} vector;

static vector at(const moving_body* m, uint32_t vertex, double t) {
    vector v;
    for (int c = 0; c < 3; ++c)
        v.x[c] =
            (1 - t) * m->before[3 * vertex + (uint32_t)c] + t * m->now.positions[3 * vertex + (uint32_t)c];
    return v;
}

static vector minus(vector a, vector b) {
    for (int c = 0; c < 3; ++c) a.x[c] -= b.x[c];
    return a;
}

static vector cross_of(vector a, vector b) {
    const vector c = {{a.x[1] * b.x[2] - a.x[2] * b.x[1], a.x[2] * b.x[0] - a.x[0] * b.x[2],
                       a.x[0] * b.x[1] - a.x[1] * b.x[0]}};
    return c;
}

static double dot_of(vector a, vector b) { return a.x[0] * b.x[0] + a.x[1] * b.x[1] + a.x[2] * b.x[2]; }

/* The corners of a face as seen from a vertex, and their volume. */
static double seen_volume(const moving_body* a, uint32_t vertex, const moving_body* b, const uint32_t* face,
                          double t, vector corner[3]) {
    for (int c = 0; c < 3; ++c) corner[c] = minus(at(b, face[c], t), at(a, vertex, t));
    return dot_of(corner[0], cross_of(corner[1], corner[2]));
}

/* How far inside of the triangle, in whose plane it is, the vertex is: its lowest weight. */
static double lowest_weight(const vector corner[3]) {
    const vector n = cross_of(minus(corner[1], corner[0]), minus(corner[2], corner[0]));
    double lowest = INFINITY;
    for (int c = 0; c < 3; ++c)
        lowest = fmin(lowest, dot_of(n, cross_of(corner[(c + 1) % 3], corner[(c + 2) % 3])) / dot_of(n, n));
    return lowest;
}

/* Whether the vertex stays on one side of the face along an axis. */
static int stay_apart(const moving_body* a, uint32_t vertex, const moving_body* b, const uint32_t* face) {
    int sides[3][2] = {{0}};
    for (int c = 0; c < 3; ++c)
        for (int end = 0; end < 2; ++end)
            for (int other = 0; other < 2; ++other) {
                const vector way = minus(at(b, face[c], end), at(a, vertex, other));
                for (int k = 0; k < 3; ++k) sides[k][way.x[k] > 0] += way.x[k] != 0;
            }
    return sides[0][0] == 12 || sides[0][1] == 12 || sides[1][0] == 12 || sides[1][1] == 12 ||
           sides[2][0] == 12 || sides[2][1] == 12;
}

/* The first time at which the vertex is in the face, with all weights above `least`; 2: none. */
static double first_root(const moving_body* a, uint32_t vertex, const moving_body* b, const uint32_t* face,
                         double least) {
    enum { samples = 24 };
    vector corner[3];
    if (stay_apart(a, vertex, b, face)) return 2;
    double last = seen_volume(a, vertex, b, face, 0, corner);
    for (int i = 1; i <= samples; ++i) {
        double low = (double)(i - 1) / samples, high = (double)i / samples;
        const double next = seen_volume(a, vertex, b, face, high, corner), first = last;
        last = next;
        if ((first < 0) == (next < 0)) continue;
        for (int k = 0; k < 60; ++k) {
            const double middle = 0.5 * (low + high);
            if ((seen_volume(a, vertex, b, face, middle, corner) < 0) == (first < 0))
                low = middle;
            else
                high = middle;
        }
        (void)seen_volume(a, vertex, b, face, high, corner);
        if (lowest_weight(corner) > least) return high;
    }
    return 2;
}

/* A facet of one tetrahedron alone: its vertices, and the other one of the tetrahedron. */
typedef struct facet {
    uint32_t v[3], apex;
} facet;

static uint32_t list_faces(const body* b, facet* faces) {
    uint32_t count = 0;
    for (uint32_t t = 0; t < b->tet_count; ++t)
        for (uint32_t f = 0; f < 4; ++f) {
            facet* face = &faces[count];
            int shared = 0;
            face->apex = b->tets[4 * t + f];
            for (uint32_t c = 0; c < 3; ++c) face->v[c] = b->tets[4 * t + (f + c + 1) % 4];
            for (uint32_t o = 0; o < b->tet_count && !shared; ++o) {
                int common = 0;
                for (uint32_t c = 0; c < 4; ++c)
                    for (int i = 0; i < 3; ++i) common += b->tets[4 * o + c] == face->v[i];
                shared = o != t && common == 3;
            }
            count += !shared;
        }
    return count;
}

/* How far the vertex is in front of the plane of the face in the end; the apex is behind it. */
static double height_over(const moving_body* a, uint32_t vertex, const moving_body* b, const facet* face) {
    const vector corner = at(b, face->v[0], 1);
    const vector n = cross_of(minus(at(b, face->v[1], 1), corner), minus(at(b, face->v[2], 1), corner));
    const double height = dot_of(n, minus(at(a, vertex, 1), corner)) / sqrt(dot_of(n, n));
    return dot_of(n, minus(at(b, face->apex, 1), corner)) < 0 ? height : -height;
}

static int same_face(const uint32_t* x, const uint32_t* y) {
    int common = 0;
    for (int i = 0; i < 3; ++i) common += x[i] == y[0] || x[i] == y[1] || x[i] == y[2];
    return common == 3;
}

static int is_inside(const vox_grid* grid, vox_body a, uint32_t vertex, vox_body b) {
    const vox_contact_view view = contacts_of(grid);
    for (uint64_t i = 0; i < view.count; ++i)
        if (view.data[i].body_a == a && view.data[i].vertex == vertex && view.data[i].body_b == b) return 1;
    return 0;
}

static void check_impact(const vox_constraint* c, const moving_body* a, const moving_body* b,
                         const facet* faces, uint32_t face_count) {
    /* At its time the vertex is in the face, up to rounding errors, at the point that the weights say. */
    vector corner[3], off = {{0, 0, 0}};
    const double volume = seen_volume(a, c->vertices[0], b, c->vertices + 1, c->time, corner);
    ck_assert(fabs(volume) < 1e-9 && lowest_weight(corner) > -1e-9);
    for (int k = 0; k < 3; ++k)
        for (int i = 0; i < 3; ++i) off.x[k] -= c->weights[1 + i] * corner[i].x[k];
    ck_assert(dot_of(off, off) < 1e-12);
    ck_assert_int_eq(c->state, VOX_DEPTH_PLANE);
    uint32_t f = 0;
    while (f < face_count && !same_face(c->vertices + 1, faces[f].v)) ++f;
    ck_assert_uint_lt(f, face_count);
    ck_assert_double_eq_tol(c->gap, height_over(a, c->vertices[0], b, &faces[f]), 1e-9);
    const vector n = {{c->normal[0], c->normal[1], c->normal[2]}};
    ck_assert(dot_of(n, minus(at(b, faces[f].apex, 1), at(b, faces[f].v[0], 1))) < 1e-9);
}

/* Each vertex that certainly met a face has a time, not too late; which of them went through is decided by
 * the face that they met first. Returns how many went through. */
static uint64_t check_motion(const vox_grid* grid, const moving_body* bodies, uint32_t count) {
    const vox_constraint_view view = checked_constraints(grid);
    uint64_t impacts = 0, inside = 0, met = 0;
    for (uint32_t b = 0; b < count; ++b) {
        facet* faces = malloc(4 * sizeof(facet) * bodies[b].now.tet_count);
        const uint32_t face_count = list_faces(&bodies[b].now, faces);
        for (uint32_t a = 0; a < count; ++a)
            for (uint32_t v = 0; v < bodies[a].now.vertex_count && a != b; ++v) {
                const vox_constraint* c = find_constraint(grid, bodies[a].id, v, bodies[b].id);
                const int in = is_inside(grid, bodies[a].id, v, bodies[b].id);
                double first = 2;
                for (uint32_t f = 0; f < face_count; ++f)
                    first = fmin(first, first_root(&bodies[a], v, &bodies[b], faces[f].v, 1e-7));
                met += first <= 1;
                ck_assert_int_eq(c && c->kind == VOX_CONSTRAINT_INSIDE, in);
                if (c) ck_assert_double_le(c->time, fmin(first + 1e-14, 1));
                inside += (uint64_t)in;
                if (c && !in) {
                    ck_assert_int_eq(c->kind, VOX_CONSTRAINT_IMPACT);
                    check_impact(c, &bodies[a], &bodies[b], faces, face_count);
                    ++impacts;
                }
                if (in || first > 1) continue;
                /* The faces that it may have met first, which mostly is one. */
                double least = 1, most = -1;
                for (uint32_t f = 0; f < face_count; ++f) {
                    if (first_root(&bodies[a], v, &bodies[b], faces[f].v, -1e-7) > first + 1e-9) continue;
                    least = fmin(least, height_over(&bodies[a], v, &bodies[b], &faces[f]));
                    most = fmax(most, height_over(&bodies[a], v, &bodies[b], &faces[f]));
                }
                if (most < -1e-9) ck_assert_ptr_nonnull(c);
                if (least > 1e-9) ck_assert_ptr_null(c);
            }
        free(faces);
    }
    ck_assert_uint_eq(impacts + inside, view.count);
    ck_assert_uint_ge(counters_of(grid).passages, met);
    /* So do their bodies touch. */
    const vox_pair_view pairs = pairs_of(grid);
    for (uint64_t p = 0; p < pairs.count; ++p)
        ck_assert_uint_eq(pairs.data[p].state == VOX_PAIR_ENDED,
                          view.pair_offsets[p] == view.pair_offsets[p + 1]);
    return impacts;
}

START_TEST(random_motions) {
    uint64_t found = 0;
    for (uint64_t seed = 1; seed <= 100; ++seed) {
        uint64_t state = seed;
        vox_grid* grid = impact_grid();
        moving_body bodies[3];
        for (int i = 0; i < 3; ++i) {
            body b = make_box(i == 0 ? 2 : 1, 0.75f, 0, 0, 0);
            jitter_body(&b, 0.15, seed + (uint64_t)i);
            move_body(&b, random_symmetric(&state), random_symmetric(&state), random_symmetric(&state));
            bodies[i] = insert_moving(grid, b);
            /* As a whole, and each vertex as well. */
            move_body(&bodies[i].now, random_symmetric(&state), random_symmetric(&state),
                      random_symmetric(&state));
            if (seed % 2) jitter_body(&bodies[i].now, 0.3, seed + 100);
        }
        ck_ok(vox_grid_step(grid));
        found += check_motion(grid, bodies, 3);
        vox_grid_destroy(grid);
        for (int i = 0; i < 3; ++i) free_moving(&bodies[i]);
    }
    ck_assert_uint_gt(found, 150);
}
END_TEST

/* A thin plate shot through: the box is on one side before and on the other after. */
START_TEST(plate_shot_through) {
    vox_grid* grid = impact_grid();
    body plate = make_block(&five_cut, 8, 8, 1);
    for (uint32_t v = 0; v < plate.vertex_count; ++v) plate.positions[3 * v + 2] *= 0.0625f;
    moving_body bodies[2] = {insert_moving(grid, plate),
                             insert_moving(grid, make_box(1, 0.5f, 3.625f, 3.25f, 2))};
    move_body(&bodies[1].now, 0, 0, -4);
    ck_ok(vox_grid_step(grid));
    ck_assert_uint_eq(check_motion(grid, bodies, 2), 8);
    const vox_constraint_view view = constraints_of(grid);
    ck_assert_uint_eq(view.count, 8);
    for (uint64_t i = 0; i < view.count; ++i) {
        const vox_constraint* c = &view.data[i];
        const float z = bodies[1].before[3 * c->vertices[0] + 2];
        const double exact = ((double)z - 0.0625) / 4; /* at the upper side */
        ck_assert_uint_eq(c->body_a, bodies[1].id);
        ck_assert_double_le(c->time, exact);
        ck_assert_double_ge(c->time, exact - 1e-12);
        ck_assert_double_eq(c->normal[2], 1); /* back to where it came from */
        ck_assert_double_eq_tol(c->gap, (double)z - 4 - 0.0625, 1e-12);
    }
    /* No vertex is inside, but the two touch. */
    ck_assert_uint_eq(contacts_of(grid).count, 0);
    ck_assert_uint_eq(pairs_of(grid).count, 1);
    ck_assert_uint_eq(pairs_of(grid).data[0].contact_count, 0);
    ck_assert_int_eq(pairs_of(grid).data[0].state, VOX_PAIR_BEGAN);
    /* The plate moves instead, or both do. */
    memcpy(bodies[1].now.positions, bodies[1].before, 24 * sizeof(float));
    move_body(&bodies[0].now, 0, 0, 4);
    ck_ok(vox_grid_step(grid));
    ck_assert_uint_eq(check_motion(grid, bodies, 2), 8);
    ck_assert_int_eq(pairs_of(grid).data[0].state, VOX_PAIR_PERSISTED);
    move_body(&bodies[1].now, 0, 0, 4);
    ck_ok(vox_grid_step(grid));
    ck_assert_uint_eq(constraints_of(grid).count, 0);
    ck_assert_int_eq(pairs_of(grid).data[0].state, VOX_PAIR_ENDED);
    /* Without previous positions, nothing moves. */
    for (int i = 0; i < 2; ++i) ck_ok(bind_previous_array(grid, bodies[i].id, NULL, VOX_FORMAT_FLOAT, 0, 0));
    memcpy(bodies[1].now.positions, bodies[1].before, 24 * sizeof(float));
    ck_ok(vox_grid_step(grid));
    ck_assert_uint_eq(pairs_of(grid).count, 0);
    vox_grid_destroy(grid);
    for (int i = 0; i < 2; ++i) free_moving(&bodies[i]);
}
END_TEST

/* A small box within a large one, and beside it: on the way in its vertices are inside, with a time; on the
 * way out they have met the surface, but nothing holds them back. */
START_TEST(in_and_out) {
    for (int out = 0; out < 2; ++out) {
        vox_grid* grid = impact_grid();
        moving_body bodies[2] = {insert_moving(grid, make_box(2, 1, 0, 0, 0)),
                                 insert_moving(grid, make_box(1, 0.5f, 0.25f, 0.375f, out ? 0.75f : 3.75f))};
        move_body(&bodies[1].now, 0, 0, out ? 3 : -3);
        ck_ok(vox_grid_step(grid));
        ck_assert_uint_eq(check_motion(grid, bodies, 2), 0);
        ck_assert_uint_eq(counters_of(grid).passages, 8);
        const vox_constraint_view view = constraints_of(grid);
        ck_assert_uint_eq(view.count, out ? 0 : 8);
        ck_assert_uint_eq(pairs_of(grid).count, out ? 0 : 1);
        for (uint64_t i = 0; i < view.count; ++i) {
            const double z = (double)bodies[1].before[3 * view.data[i].vertices[0] + 2];
            ck_assert_int_eq(view.data[i].kind, VOX_CONSTRAINT_INSIDE);
            ck_assert_double_eq_tol(view.data[i].time, (z - 2) / 3, 1e-12);
        }
        vox_grid_destroy(grid);
        for (int i = 0; i < 2; ++i) free_moving(&bodies[i]);
    }
}
END_TEST

/* Doubles in columns give the same as floats in rows; a transform applies to present positions alone. */
START_TEST(formats_and_transforms) {
    vox_grid* grid = impact_grid();
    moving_body bodies[2] = {insert_moving(grid, make_box(2, 1, 0, 0, 0)),
                             insert_moving(grid, make_box(1, 0.5f, 0.375f, 0.25f, 4))};
    move_body(&bodies[1].now, 0.125, 0, -5);
    ck_ok(vox_grid_step(grid));
    ck_assert_uint_eq(check_motion(grid, bodies, 2), 8);
    kept_constraints first = keep_constraints(grid);
    const uint32_t vertices = bodies[1].now.vertex_count;
    double* columns = malloc(3 * sizeof(double) * vertices);
    for (uint32_t v = 0; v < vertices; ++v)
        for (uint32_t c = 0; c < 3; ++c) columns[c * vertices + v] = bodies[1].before[3 * v + c];
    ck_ok(bind_previous_array(grid, bodies[1].id, columns, VOX_FORMAT_DOUBLE, 8, 8 * (uint64_t)vertices));
    const double down[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, -5};
    for (int turn = 0; turn < 2; ++turn) {
        ck_ok(vox_grid_step(grid));
        same_constraints(grid, &first);
        move_body(&bodies[1].now, 0, 0, 5);
        ck_ok(vox_body_set_transform(grid, bodies[1].id, down));
    }
    vox_grid_destroy(grid);
    free(first.data);
    free(columns);
    for (int i = 0; i < 2; ++i) free_moving(&bodies[i]);
}
END_TEST

START_TEST(filters_and_life) {
    vox_grid* grid = impact_grid();
    moving_body bodies[2] = {insert_moving(grid, make_box(2, 1, 0, 0, 0)),
                             insert_moving(grid, make_box(1, 0.5f, 0.375f, 0.25f, 4))};
    move_body(&bodies[1].now, 0, 0, -5);
    ck_ok(vox_grid_step(grid));
    ck_assert_uint_eq(check_motion(grid, bodies, 2), 8);
    for (int step = 0; step < 3; ++step) { /* positions at rest, but where they come from is read anew */
        kept_constraints before = keep_constraints(grid);
        ck_ok(vox_grid_step(grid));
        ck_assert_uint_eq(check_motion(grid, bodies, 2), 8);
        check_previous(grid, &before);
        ck_assert_uint_eq(constraints_of(grid).data[0].previous, 0);
        free(before.data);
    }
    ck_ok(vox_grid_set_pair_enabled(grid, bodies[0].id, bodies[1].id, 0));
    ck_ok(vox_grid_step(grid));
    ck_assert_uint_eq(count_impacts(grid), 0);
    ck_ok(vox_grid_set_pair_enabled(grid, bodies[0].id, bodies[1].id, 1));
    vox_filter filter = plain_filter();
    filter.flags = VOX_FILTER_SENSOR; /* a pair, but no constraints */
    ck_ok(vox_body_set_filter(grid, bodies[0].id, &filter));
    ck_ok(vox_grid_step(grid));
    ck_assert_uint_eq(count_impacts(grid), 0);
    ck_assert_uint_eq(count_pairs(grid, VOX_PAIR_BEGAN), 1);
    filter.flags = 0;
    ck_ok(vox_body_set_filter(grid, bodies[0].id, &filter));
    const float z = bodies[1].before[2];
    bodies[1].before[2] = NAN;
    ck_fails(vox_grid_step(grid), VOX_ERROR_NON_FINITE, "vertex 0: a coordinate of the previous position");
    ck_assert_uint_eq(pairs_of(grid).count, 0);
    vox_failure failure;
    failure.struct_size = sizeof failure;
    ck_ok(vox_grid_get_failure(grid, 0, &failure));
    ck_assert_uint_eq(failure.body, bodies[1].id);
    ck_assert_uint_eq(failure.vertex, 0);
    bodies[1].before[2] = z;
    ck_ok(vox_grid_step(grid));
    ck_assert_uint_eq(count_impacts(grid), 8);
    ck_ok(vox_body_remove(grid, bodies[1].id));
    ck_assert_uint_eq(count_impacts(grid), 8); /* until the next step */
    ck_ok(vox_grid_step(grid));
    ck_assert_uint_eq(count_impacts(grid), 0);
    ck_ok(vox_grid_clear(grid));
    ck_ok(vox_grid_step(grid));
    ck_assert_uint_eq(constraints_of(grid).count, 0);
    vox_grid_destroy(grid);
    for (int i = 0; i < 2; ++i) free_moving(&bodies[i]);
}
END_TEST

/* At rest, a pair that had nothing but impacts ends with the last previous positions. */
START_TEST(ends_without_previous) {
    vox_grid* grid = impact_grid();
    moving_body bodies[2] = {insert_moving(grid, make_box(2, 1, 0, 0, 0)),
                             insert_moving(grid, make_box(1, 0.5f, 0.375f, 0.25f, 4))};
    move_body(&bodies[1].now, 0, 0, -5);
    for (int step = 0; step < 3; ++step) ck_ok(vox_grid_step(grid));
    ck_assert_int_eq(pairs_of(grid).data[0].state, VOX_PAIR_PERSISTED);
    for (int i = 0; i < 2; ++i) ck_ok(bind_previous_array(grid, bodies[i].id, NULL, VOX_FORMAT_FLOAT, 0, 0));
    ck_ok(vox_grid_step(grid));
    ck_assert_int_eq(pairs_of(grid).data[0].state, VOX_PAIR_ENDED);
    ck_ok(vox_grid_step(grid));
    ck_assert_uint_eq(pairs_of(grid).count, 0);
    vox_grid_destroy(grid);
    for (int i = 0; i < 2; ++i) free_moving(&bodies[i]);
}
END_TEST

/* A vertex that went through and is still near the surface has one constraint, by what it went through. */
START_TEST(impacts_within_the_margin) {
    vox_grid* grid = impact_grid();
    body plate = make_block(&five_cut, 8, 8, 1);
    for (uint32_t v = 0; v < plate.vertex_count; ++v) plate.positions[3 * v + 2] *= 0.0625f;
    moving_body bodies[2] = {insert_moving(grid, plate),
                             insert_moving(grid, make_box(1, 0.5f, 3.625f, 3.25f, 0.125f))};
    ck_ok(vox_grid_set_margin(grid, 1));
    ck_ok(vox_grid_step(grid));
    ck_assert_uint_eq(count_pairs(grid, VOX_PAIR_NEAR), 1);
    kept_constraints near = keep_constraints(grid);
    move_body(&bodies[1].now, 0, 0, -1);
    ck_ok(vox_grid_step(grid));
    (void)checked_constraints(grid);
    check_previous(grid, &near);
    ck_assert_uint_eq(count_impacts(grid), 8);
    ck_assert_uint_eq(count_pairs(grid, VOX_PAIR_BEGAN), 1);
    for (uint64_t i = 0; i < constraints_of(grid).count; ++i)
        if (constraints_of(grid).data[i].kind == VOX_CONSTRAINT_IMPACT) /* it was near before */
            ck_assert_uint_ne(constraints_of(grid).data[i].previous, VOX_NONE);
    vox_grid_destroy(grid);
    free(near.data);
    for (int i = 0; i < 2; ++i) free_moving(&bodies[i]);
}
END_TEST

/* More vertices than the array has: it is not read any more. */
START_TEST(appended_vertices_end_it) {
    vox_grid* grid = impact_grid();
    moving_body m = insert_moving(grid, make_box(1, 1, 0, 0, 0));
    float* positions = malloc(3 * sizeof(float) * (m.now.vertex_count + 1));
    memcpy(positions, m.now.positions, 3 * sizeof(float) * m.now.vertex_count);
    for (int c = 0; c < 3; ++c) positions[3 * m.now.vertex_count + (uint32_t)c] = 5;
    vox_vertices_desc desc = vox_default_vertices_desc();
    desc.count = 1;
    desc.positions = vox_float_positions(positions, m.now.vertex_count + 1);
    uint32_t first = 0;
    ck_ok(vox_mesh_append_vertices(grid, m.id, &desc, &first));
    ck_ok(vox_mesh_bind_floats(grid, m.id, positions, m.now.vertex_count + 1));
    m.before[0] = NAN; /* would make the step fail */
    ck_ok(vox_grid_step(grid));
    vox_grid_destroy(grid);
    free(positions);
    free_moving(&m);
}
END_TEST

START_TEST(arguments) {
    vox_grid* grid = impact_grid();
    moving_body m = insert_moving(grid, make_box(1, 1, 0, 0, 0));
    ck_fails(bind_previous_array(NULL, m.id, m.before, VOX_FORMAT_FLOAT, 0, 0), VOX_ERROR_INVALID_ARGUMENT,
             "grid");
    ck_fails(bind_previous_array(grid, m.id + 1, m.before, VOX_FORMAT_FLOAT, 0, 0), VOX_ERROR_INVALID_HANDLE,
             "body");
    ck_fails(bind_previous_array(grid, m.id, m.before, (vox_format)7, 0, 0), VOX_ERROR_INVALID_ARGUMENT,
             "format");
    const vox_positions too_few = vox_float_positions(m.before, m.now.vertex_count - 1);
    ck_fails(vox_mesh_bind_previous_positions(grid, m.id, &too_few), VOX_ERROR_INVALID_ARGUMENT,
             "positions.count is 7, expected 8");
    ck_fails(bind_previous_array(grid, m.id, m.before, VOX_FORMAT_FLOAT, 11, 0), VOX_ERROR_INVALID_ARGUMENT,
             "stride");
    vox_grid_destroy(grid);
    free_moving(&m);
}
END_TEST

/* The same for any number of workers, and no memory from the second time on. */
START_TEST(workers_and_memory) {
    kept_constraints first = {NULL, 0};
    for (uint32_t workers = 1; workers <= 4; ++workers) {
        ledger l = {0};
        vox_grid_desc desc = impact_desc();
        desc.allocator = ledger_allocator(&l);
        desc.worker_count = workers;
        vox_grid* grid = grid_of(&desc);
        moving_body balls[2];
        for (uint64_t i = 0; i < 2; ++i) {
            body ball = make_lattice_ball(&five_cut, 5, 5);
            jitter_body(&ball, 0.1, i + 1);
            move_body(&ball, 11 * (double)i, 0.3, 0.2);
            balls[i] = insert_moving(grid, ball);
        }
        uint64_t calls = 0;
        for (int round = 0; round < 4; ++round) {
            if (round == 3) calls = l.calls;
            move_body(&balls[1].now, round % 2 ? 22 : -22, 0, 0); /* to the other side and back */
            ck_ok(vox_grid_step(grid));
        }
        ck_assert_uint_eq(l.calls, calls);
        move_body(&balls[1].now, -22, 0, 0);
        ck_ok(vox_grid_step(grid));
        if (workers == 1) first = keep_constraints(grid);
        ck_assert_uint_gt(count_impacts(grid), 200);
        same_constraints(grid, &first);
        vox_grid_destroy(grid);
        ck_assert_uint_eq(l.bytes, 0);
        for (int i = 0; i < 2; ++i) free_moving(&balls[i]);
    }
    free(first.data);
}
END_TEST

/* What moves far, slantwise, is not compared with all that its boxes sweep over: times are computed of faces
 * that a vertex comes close to before it met another, and of none where nothing approaches anything. */
START_TEST(far_and_slantwise) {
    const float way[3] = {48, 51.2f, 38.4f};
    for (int both = 0; both < 2; ++both) {
        vox_grid* grid = impact_grid();
        moving_body boxes[2];
        for (int i = 0; i < 2; ++i) {
            const float at = i ? 7 : 0;
            boxes[i] = insert_moving(grid, make_box(6, 1, at, at + 0.375f, at - 0.25f));
            for (uint32_t k = 0; (i == 0 || both) && k < 3 * boxes[i].now.vertex_count; ++k)
                boxes[i].before[k] += way[k % 3];
        }
        ck_ok(vox_grid_step(grid));
        const grid_counts counts = counters_of(grid);
        if (both)
            ck_assert_uint_eq(counts.face_candidates, 0);
        else
            ck_assert_uint_gt(count_impacts(grid), 100);
        ck_assert_uint_lt(counts.face_candidates, 3u * counts.vertices);
        vox_grid_destroy(grid);
        for (int i = 0; i < 2; ++i) free_moving(&boxes[i]);
    }
}
END_TEST

/* By less than floats resolve, a vertex goes through an edge of a box: slantwise, where boxes of floats stay
 * apart. */
START_TEST(grazed_by_doubles) {
    static const double tet[4][3] = {{0, 0, 0}, {0.5, 0.5, -0.1}, {0.5, 0.5, 0.1}, {0.6, 0.4, 0}};
    static const uint32_t corners[4] = {0, 1, 2, 3};
    for (int misses = 0; misses < 2; ++misses) {
        const double beside = misses ? 2e-8 : -2e-8;
        double still[24], from[12], to[12];
        vox_grid* grid = impact_grid();
        body box = make_box(1, 1, 0, 0, 0);
        for (int i = 0; i < 24; ++i) still[i] = box.positions[i] + 0.3;
        for (int i = 0; i < 12; ++i) {
            from[i] = tet[i / 3][i % 3] + (i % 3 == 0 ? 0.3 : i % 3 == 1 ? 2.3 + beside : 0.8);
            to[i] = tet[i / 3][i % 3] + (i % 3 == 0 ? 2.3 : i % 3 == 1 ? 0.3 + beside : 0.8);
        }
        const vox_mesh_desc first = vox_mesh_desc_doubles(still, 8, box.tets, box.tet_count),
                            second = vox_mesh_desc_doubles(to, 4, corners, 1);
        (void)insert_mesh(grid, &first);
        const vox_body moving = insert_mesh(grid, &second);
        ck_ok(bind_previous_array(grid, moving, from, VOX_FORMAT_DOUBLE, 0, 0));
        ck_ok(vox_grid_step(grid));
        ck_assert_uint_eq(counters_of(grid).passages, misses ? 0 : 1);
        vox_grid_destroy(grid);
        free_body(&box);
    }
}
END_TEST

static void add_tests(TCase* tests) {
    tcase_add_each(tests, random_motions, plate_shot_through, in_and_out, formats_and_transforms,
                   filters_and_life, ends_without_previous, impacts_within_the_margin,
                   appended_vertices_end_it, arguments, workers_and_memory, far_and_slantwise,
                   grazed_by_doubles);
}

SUITE(impacts) { add_for_each_engine(suite, add_tests); }
