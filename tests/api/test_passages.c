/* Passages: what two bodies that move report, against a search for the roots of all vertices and faces; their
 * life, memory and errors. */
#include <math.h>
#include <string.h>

#include "scenes/bodies.h"
#include "support/ledger.h"
#include "support/suite.h"

typedef struct moving_body {
    body now;
    float* before;
    vox_body id;
} moving_body;

static vox_passage_view passages_of(const vox_grid* grid) {
    vox_passage_view view = {NULL, 0, 99, 0}; /* a count that is not written shows */
    ck_ok(vox_grid_passages(grid, &view));
    ck_assert_uint_eq(view.byte_stride, sizeof(vox_passage));
    return view;
}

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

/* The first time at which the vertex is certainly in the face; 2: none. */
static double first_root(const moving_body* a, uint32_t vertex, const moving_body* b, const uint32_t* face) {
    enum { samples = 24 };
    vector corner[3];
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
        if (lowest_weight(corner) > 1e-7) return high;
    }
    return 2;
}

/* The facets of one tetrahedron alone, as 3 vertices each. */
static uint32_t list_faces(const body* b, uint32_t* faces) {
    static const int corners[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
    uint32_t count = 0;
    for (uint32_t t = 0; t < b->tet_count; ++t)
        for (int f = 0; f < 4; ++f) {
            uint32_t* v = faces + 3 * count;
            int shared = 0;
            for (int c = 0; c < 3; ++c) v[c] = b->tets[4 * t + (uint32_t)corners[f][c]];
            for (uint32_t o = 0; o < b->tet_count && !shared; ++o) {
                int common = 0;
                for (int c = 0; c < 4; ++c)
                    for (int i = 0; i < 3; ++i) common += b->tets[4 * o + (uint32_t)c] == v[i];
                shared = o != t && common == 3;
            }
            count += !shared;
        }
    return count;
}

/* Each vertex that is certainly in a face at some time is reported, not too late; where one is reported, it
 * is. */
static uint64_t check_passages(const vox_grid* grid, const moving_body* bodies, uint32_t count) {
    const vox_passage_view view = passages_of(grid);
    uint64_t next = 0;
    for (uint32_t a = 0; a < count; ++a)
        for (uint32_t v = 0; v < bodies[a].now.vertex_count; ++v)
            for (uint32_t b = 0; b < count; ++b) {
                if (a == b) continue;
                uint32_t* faces = malloc(12 * sizeof(uint32_t) * bodies[b].now.tet_count);
                const uint32_t face_count = list_faces(&bodies[b].now, faces);
                double first = 2;
                for (uint32_t f = 0; f < face_count; ++f)
                    first = fmin(first, first_root(&bodies[a], v, &bodies[b], faces + 3 * f));
                free(faces);
                const vox_passage* found = next < view.count ? &view.data[next] : NULL;
                const int is_found = found && found->body_a == bodies[a].id && found->vertex == v &&
                                     found->body_b == bodies[b].id;
                if (first <= 1) ck_assert(is_found);
                if (!is_found) continue;
                ck_assert(found->time >= 0 && found->time <= 1);
                ck_assert_double_le(found->time, first + 1e-14);
                /* Then the vertex is in the face, up to rounding errors. */
                vector corner[3];
                const double volume =
                    seen_volume(&bodies[a], v, &bodies[b], found->face, found->time, corner);
                ck_assert(fabs(volume) < 1e-9 && lowest_weight(corner) > -1e-9);
                for (int c = 0; c < 3; ++c) {
                    static const int corners[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
                    ck_assert_uint_eq(
                        found->face[c],
                        bodies[b].now.tets[4 * found->tet + (uint32_t)corners[found->facet][c]]);
                }
                ++next;
            }
    ck_assert_uint_eq(next, view.count);
    ck_assert_uint_eq(counters_of(grid).passages, view.count);
    return view.count;
}

START_TEST(random_motions) {
    uint64_t found = 0;
    for (uint64_t seed = 1; seed <= 100; ++seed) {
        uint64_t state = seed;
        vox_grid* grid = engine_grid();
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
        found += check_passages(grid, bodies, 3);
        vox_grid_destroy(grid);
        for (int i = 0; i < 3; ++i) free_moving(&bodies[i]);
    }
    ck_assert_uint_gt(found, 300);
}
END_TEST

/* A thin plate shot through: the box is on one side before and on the other after. */
START_TEST(plate_shot_through) {
    vox_grid* grid = engine_grid();
    body plate = make_block(&five_cut, 8, 8, 1);
    for (uint32_t v = 0; v < plate.vertex_count; ++v) plate.positions[3 * v + 2] *= 0.0625f;
    moving_body bodies[2] = {insert_moving(grid, plate),
                             insert_moving(grid, make_box(1, 0.5f, 3.625f, 3.25f, 2))};
    move_body(&bodies[1].now, 0, 0, -4);
    ck_ok(vox_grid_step(grid));
    ck_assert_uint_eq(contacts_of(grid).count, 0);
    ck_assert_uint_eq(check_passages(grid, bodies, 2), 8);
    const vox_passage_view view = passages_of(grid);
    for (uint64_t i = 0; i < view.count; ++i) {
        const float z = bodies[1].before[3 * view.data[i].vertex + 2];
        const double exact = ((double)z - 0.0625) / 4; /* at the upper side */
        ck_assert_uint_eq(view.data[i].body_a, bodies[1].id);
        ck_assert_double_le(view.data[i].time, exact);
        ck_assert_double_ge(view.data[i].time, exact - 1e-12);
    }
    /* The plate moves instead, or both do. */
    memcpy(bodies[1].now.positions, bodies[1].before, 24 * sizeof(float));
    move_body(&bodies[0].now, 0, 0, 4);
    ck_ok(vox_grid_step(grid));
    ck_assert_uint_eq(check_passages(grid, bodies, 2), 8);
    move_body(&bodies[1].now, 0, 0, 4);
    ck_ok(vox_grid_step(grid));
    ck_assert_uint_eq(passages_of(grid).count, 0);
    /* Without previous positions, nothing moves. */
    for (int i = 0; i < 2; ++i) ck_ok(bind_previous_array(grid, bodies[i].id, NULL, VOX_FORMAT_FLOAT, 0, 0));
    ck_ok(vox_grid_step(grid));
    ck_assert_uint_eq(passages_of(grid).count, 0);
    vox_grid_destroy(grid);
    for (int i = 0; i < 2; ++i) free_moving(&bodies[i]);
}
END_TEST

/* Doubles in columns give the same as floats in rows; a transform applies to present positions alone. */
START_TEST(formats_and_transforms) {
    vox_grid* grid = engine_grid();
    moving_body bodies[2] = {insert_moving(grid, make_box(2, 1, 0, 0, 0)),
                             insert_moving(grid, make_box(1, 0.5f, 0.375f, 0.25f, 4))};
    move_body(&bodies[1].now, 0.125, 0, -3);
    ck_ok(vox_grid_step(grid));
    const uint64_t count = check_passages(grid, bodies, 2);
    ck_assert_uint_gt(count, 0);
    vox_passage* first = malloc(count * sizeof *first);
    memcpy(first, passages_of(grid).data, count * sizeof *first);
    const uint32_t vertices = bodies[1].now.vertex_count;
    double* columns = malloc(3 * sizeof(double) * vertices);
    for (uint32_t v = 0; v < vertices; ++v)
        for (uint32_t c = 0; c < 3; ++c) columns[c * vertices + v] = bodies[1].before[3 * v + c];
    ck_ok(bind_previous_array(grid, bodies[1].id, columns, VOX_FORMAT_DOUBLE, 8, 8 * (uint64_t)vertices));
    const double down[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, -3};
    for (int turn = 0; turn < 2; ++turn) {
        ck_ok(vox_grid_step(grid));
        ck_assert_uint_eq(passages_of(grid).count, count);
        ck_assert_mem_eq(passages_of(grid).data, first, count * sizeof *first);
        move_body(&bodies[1].now, 0, 0, 3);
        ck_ok(vox_body_set_transform(grid, bodies[1].id, down));
    }
    vox_grid_destroy(grid);
    free(first);
    free(columns);
    for (int i = 0; i < 2; ++i) free_moving(&bodies[i]);
}
END_TEST

START_TEST(filters_and_life) {
    vox_grid* grid = engine_grid();
    moving_body bodies[2] = {insert_moving(grid, make_box(2, 1, 0, 0, 0)),
                             insert_moving(grid, make_box(1, 0.5f, 0.375f, 0.25f, 4))};
    move_body(&bodies[1].now, 0, 0, -3);
    ck_assert_uint_eq(passages_of(grid).count, 0); /* before the first step */
    ck_ok(vox_grid_step(grid));
    const uint64_t count = check_passages(grid, bodies, 2);
    for (int step = 0; step < 3; ++step) { /* positions at rest, but where they come from is read anew */
        ck_ok(vox_grid_step(grid));
        ck_assert_uint_eq(check_passages(grid, bodies, 2), count);
    }
    ck_ok(vox_grid_set_pair_enabled(grid, bodies[0].id, bodies[1].id, 0));
    ck_ok(vox_grid_step(grid));
    ck_assert_uint_eq(passages_of(grid).count, 0);
    ck_ok(vox_grid_set_pair_enabled(grid, bodies[0].id, bodies[1].id, 1));
    const float z = bodies[1].before[2];
    bodies[1].before[2] = NAN;
    ck_fails(vox_grid_step(grid), VOX_ERROR_NON_FINITE, "vertex 0: a coordinate of the previous position");
    ck_assert_uint_eq(passages_of(grid).count, 0);
    vox_failure failure;
    failure.struct_size = sizeof failure;
    ck_ok(vox_grid_get_failure(grid, 0, &failure));
    ck_assert_uint_eq(failure.mesh, bodies[1].id);
    ck_assert_uint_eq(failure.vertex, 0);
    bodies[1].before[2] = z;
    ck_ok(vox_grid_step(grid));
    ck_assert_uint_eq(passages_of(grid).count, count);
    ck_ok(vox_body_remove(grid, bodies[1].id));
    ck_assert_uint_eq(passages_of(grid).count, count); /* until the next step */
    ck_ok(vox_grid_step(grid));
    ck_assert_uint_eq(passages_of(grid).count, 0);
    ck_ok(vox_grid_clear(grid));
    ck_ok(vox_grid_step(grid));
    ck_assert_uint_eq(passages_of(grid).count, 0);
    vox_grid_destroy(grid);
    for (int i = 0; i < 2; ++i) free_moving(&bodies[i]);
}
END_TEST

/* More vertices than the array has: it is not read any more. */
START_TEST(appended_vertices_end_it) {
    vox_grid* grid = engine_grid();
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
    vox_grid* grid = engine_grid();
    moving_body m = insert_moving(grid, make_box(1, 1, 0, 0, 0));
    vox_passage_view view;
    ck_fails(vox_grid_passages(NULL, &view), VOX_ERROR_INVALID_ARGUMENT, "grid");
    ck_fails(vox_grid_passages(grid, NULL), VOX_ERROR_INVALID_ARGUMENT, "out_view");
    ck_fails(bind_previous_array(NULL, m.id, m.before, VOX_FORMAT_FLOAT, 0, 0), VOX_ERROR_INVALID_ARGUMENT,
             "grid");
    ck_fails(bind_previous_array(grid, m.id + 1, m.before, VOX_FORMAT_FLOAT, 0, 0), VOX_ERROR_INVALID_HANDLE,
             "mesh");
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
    vox_passage* first = NULL;
    uint64_t count = 0;
    for (uint32_t workers = 1; workers <= 4; ++workers) {
        ledger l = {0};
        vox_grid_desc desc = engine_desc();
        desc.allocator = ledger_allocator(&l);
        desc.worker_count = workers;
        vox_grid* grid = grid_of(&desc);
        moving_body balls[2];
        for (uint64_t i = 0; i < 2; ++i) {
            body ball = make_lattice_ball(&five_cut, 8, 8);
            jitter_body(&ball, 0.1, i + 1);
            move_body(&ball, 17.5 * (double)i, 0.3, 0.2);
            balls[i] = insert_moving(grid, ball);
        }
        uint64_t calls = 0;
        for (int round = 0; round < 4; ++round) {
            if (round == 3) calls = l.calls;
            move_body(&balls[1].now, round % 2 ? 2 : -2, 0, 0);
            ck_ok(vox_grid_step(grid));
        }
        ck_assert_uint_eq(l.calls, calls);
        move_body(&balls[1].now, -2, 0, 0);
        ck_ok(vox_grid_step(grid));
        const vox_passage_view view = passages_of(grid);
        if (workers == 1) {
            count = view.count;
            ck_assert_uint_gt(count, 20);
            first = malloc(count * sizeof *first);
            memcpy(first, view.data, count * sizeof *first);
        }
        ck_assert_uint_eq(view.count, count);
        ck_assert_mem_eq(view.data, first, count * sizeof *first);
        vox_grid_destroy(grid);
        ck_assert_uint_eq(l.bytes, 0);
        for (int i = 0; i < 2; ++i) free_moving(&balls[i]);
    }
    free(first);
}
END_TEST

static void add_tests(TCase* tests) {
    tcase_add_each(tests, random_motions, plate_shot_through, formats_and_transforms, filters_and_life,
                   appended_vertices_end_it, arguments, workers_and_memory);
}

SUITE(passages) { add_for_each_engine(suite, add_tests); }
