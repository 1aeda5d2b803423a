/* Questions about points and boxes against brute force over every tetrahedron, exact where the answer is
 * exact; the errors of all questions. */
#include <pthread.h>

#include "support/oracle.h"
#include "support/query_checks.h"

/* The hits of one point by definition; returns how many. */
static size_t hits_by_definition(const world* w, const float p[3], uint32_t point, const vox_query_desc* desc,
                                 vox_point_hit* hits) {
    size_t count = 0;
    for (int b = 0; b < w->count; ++b) {
        if (!takes_part(w, b, desc)) continue;
        const size_t begin = count;
        int interior = 0;
        for (uint32_t t = 0; t < w->bodies[b].tet_count; ++t) {
            const float* corners[4];
            corners_of(&w->bodies[b], t, corners);
            if (apart(p, p, corners, 4)) continue;
            const oracle_containment where = oracle_locate(p, corners);
            if (where != ORACLE_INTERIOR && (where != ORACLE_BOUNDARY || interior || count > begin)) continue;
            if (where == ORACLE_INTERIOR && !interior)
                count = begin; /* what was on a boundary does not count */
            interior |= where == ORACLE_INTERIOR;
            vox_point_hit hit = {point, w->meshes[b], t, 0, {0}};
            oracle_barycentric(p, corners, hit.weights);
            hits[count++] = hit;
        }
    }
    return count;
}

static void check_hits(const vox_point_hit* found, const vox_point_hit* expected, size_t count) {
    for (size_t i = 0; i < count; ++i) {
        ck_assert_mem_eq(&found[i], &expected[i], offsetof(vox_point_hit, weights));
        for (int c = 0; c < 4; ++c) {
            const double weight = found[i].weights[c];
            ck_assert(weight >= 0 && weight <= 1);
            ck_assert_double_le(fabs(weight - expected[i].weights[c]),
                                0x1p-52 * expected[i].weights[c] + 0x1p-57);
        }
    }
}

START_TEST(points_by_definition) {
    enum { n = 200, room = 16384 };
    static vox_point_hit expected[room], together[room], others[room];
    uint64_t random = 3, all = 0;
    for (int scene = 0; scene < 24; ++scene) {
        const int coarse = scene % 2;
        world w = new_world(&random, coarse);
        const vox_query_desc desc = random_bodies(&random, &w);
        float points[n][4]; /* three and a hole */
        double exact[n][3];
        uint64_t total = 0, count = 0, wanted = 0, singly = 0;
        for (uint32_t i = 0; i < n; ++i) {
            random_point(&random, coarse, points[i]);
            widen(points[i], exact[i]);
            wanted += hits_by_definition(&w, points[i], i, &desc, expected + wanted);
        }
        vox_positions asked = vox_float_positions(points[0], n);
        asked.byte_stride = sizeof points[0];
        ck_ok(vox_locator_find_point_hits(w.locator, &asked, &desc, together, room, &total));
        ck_assert_uint_eq(total, wanted);
        check_hits(together, expected, total);
        for (uint32_t i = 0; i < n; ++i) {
            asked = vox_double_positions(exact[i], 1);
            ck_ok(vox_locator_find_point_hits(w.locator, &asked, &desc, others + singly, room - singly,
                                              &count));
            for (; count > 0; --count) {
                ck_assert_uint_eq(others[singly].point, 0);
                others[singly++].point = i;
            }
        }
        ck_assert_uint_eq(singly, total);
        ck_assert_mem_eq(others, together, total * sizeof *others);
        memset(others, 0, sizeof others);
        asked = vox_double_positions(exact[0], n); /* with room for some */
        ck_ok(vox_locator_find_point_hits(w.locator, &asked, &desc, others, total / 2, &count));
        ck_assert_uint_eq(count, total);
        ck_assert_mem_eq(others, together, total / 2 * sizeof *others);
        ck_assert_uint_eq(others[total / 2].body, VOX_NULL_BODY);
        all += total;
        end_world(&w);
    }
    ck_assert_uint_gt(all, 200);
}
END_TEST

/* Points that no float is: between a facet and the next float on either side. */
START_TEST(points_in_double) {
    const double in[3] = {0.25, 0.25, 1e-300}, out[3] = {0.25, 0.25, -1e-300}, on[3] = {0.25, 0.25, 0};
    vox_grid* grid = engine_grid();
    const vox_mesh_desc tet = vox_mesh_desc_floats(unit_tet_positions, 4, unit_tet, 1);
    insert_mesh(grid, &tet);
    vox_locator* locator = take_locator(grid);
    ck_assert_uint_eq(count_at(locator, in), 1);
    ck_assert_uint_eq(count_at(locator, on), 1);
    ck_assert_uint_eq(count_at(locator, out), 0);
    vox_locator_release(locator);
    vox_grid_destroy(grid);
}
END_TEST

START_TEST(boxes_by_definition) {
    enum { n = 40, room = 65536 };
    static vox_box_hit found[room], some[room];
    uint64_t random = 4, all = 0;
    for (int scene = 0; scene < 40; ++scene) {
        world w = new_world(&random, scene % 2);
        double min[n][3], max[n][3];
        for (int i = 0; i < n; ++i) {
            float p[3], q[3];
            random_point(&random, scene % 2, p);
            random_point(&random, scene % 2, q);
            if (i % 5 == 0) memcpy(q, p, sizeof q); /* a point now and then */
            for (int axis = 0; axis < 3; ++axis) {
                min[i][axis] = i % 7 == 0 ? -INFINITY : (double)fminf(p[axis], q[axis]);
                max[i][axis] = i % 11 == 0 ? INFINITY : (double)fmaxf(p[axis], q[axis]);
            }
        }
        const vox_query_desc desc = random_bodies(&random, &w);
        const vox_positions lows = vox_double_positions(min[0], n), highs = vox_double_positions(max[0], n);
        uint64_t count = 0, next = 0;
        ck_ok(vox_locator_find_box_hits(w.locator, &lows, &highs, &desc, found, room, &count));
        ck_assert_uint_le(count, room);
        for (uint32_t i = 0; i < n; ++i)
            for (int b = 0; b < w.count; ++b)
                for (uint32_t t = 0; t < w.bodies[b].tet_count && takes_part(&w, b, &desc); ++t) {
                    const float* corners[4];
                    int meets = 1;
                    corners_of(&w.bodies[b], t, corners);
                    for (int axis = 0; axis < 3; ++axis) {
                        float lo = corners[0][axis], hi = lo;
                        for (int c = 1; c < 4; ++c) {
                            lo = fminf(lo, corners[c][axis]);
                            hi = fmaxf(hi, corners[c][axis]);
                        }
                        meets &= (double)lo <= max[i][axis] && (double)hi >= min[i][axis];
                    }
                    if (!meets) continue;
                    const vox_box_hit expected = {i, w.meshes[b], t};
                    ck_assert_uint_lt(next, count);
                    ck_assert_mem_eq(&found[next++], &expected, sizeof expected);
                }
        ck_assert_uint_eq(next, count);
        memset(some, 0, sizeof some);
        ck_ok(vox_locator_find_box_hits(w.locator, &lows, &highs, &desc, some, count / 2, &next));
        ck_assert_uint_eq(next, count);
        ck_assert_mem_eq(some, found, count / 2 * sizeof *some);
        ck_assert_uint_eq(some[count / 2].body, VOX_NULL_BODY);
        all += count;
        end_world(&w);
    }
    ck_assert_uint_gt(all, 5000);
}
END_TEST

/* Many threads at once: questions and suggestions, of which the first look at the meshes, are reads. */
typedef struct asker {
    const world* w;
    uint64_t seed;
    uint64_t sum;
} asker;

static void* ask_many(void* context) {
    asker* a = (asker*)context;
    uint64_t random = a->seed;
    vox_cell_size_result suggestion;
    suggestion.struct_size = sizeof suggestion;
    if (vox_grid_suggest_cell_size(a->w->grid, NULL, &suggestion)) return NULL;
    a->sum = (uint64_t)(suggestion.cell_size * 1e9);
    for (int i = 0; i < 300; ++i) {
        float p[3], q[3];
        random_point(&random, 0, p);
        random_point(&random, 0, q);
        const vox_positions from = vox_float_positions(p, 1), to = vox_float_positions(q, 1);
        const vox_locator* locator = a->w->locator;
        vox_point_hit hits[8];
        vox_closest_hit closest;
        vox_ray_hit rays[8];
        uint8_t blocked = 0;
        uint64_t count = 0, boxes = 0, met = 0;
        memset(rays, 0, sizeof rays);
        if (vox_locator_find_point_hits(locator, &from, NULL, hits, 8, &count) ||
            vox_locator_find_box_hits(locator, &from, &from, NULL, NULL, 0, &boxes) ||
            vox_locator_find_closest(locator, &from, NULL, &closest) ||
            vox_locator_find_ray_hits(locator, &from, &to, NULL, rays, 8, &met) ||
            vox_locator_test_rays(locator, &from, &to, NULL, &blocked))
            return NULL;
        a->sum = a->sum * 31 + count + boxes + closest.tet + met + rays[0].tet + blocked;
    }
    return context;
}

START_TEST(many_threads) {
    uint64_t random = 8;
    world w = new_world(&random, 0);
    asker askers[4];
    pthread_t threads[4];
    for (int i = 0; i < 4; ++i) {
        askers[i] = (asker){&w, 17, 0};
        ck_assert_int_eq(pthread_create(&threads[i], NULL, ask_many, &askers[i]), 0);
    }
    for (int i = 0; i < 4; ++i) {
        void* done = NULL;
        ck_assert_int_eq(pthread_join(threads[i], &done), 0);
        ck_assert_ptr_nonnull(done);
    }
    for (int i = 1; i < 4; ++i) ck_assert_uint_eq(askers[i].sum, askers[0].sum);
    ck_assert_uint_ne(askers[0].sum, 0);
    end_world(&w);
}
END_TEST

/* ---- arguments ---- */

typedef enum question { point_hits, closest, box_hits, ray_hits, test_rays, question_count } question;
static const char* const first_names[] = {"points", "points", "min", "from", "from"};

/* Asks about `a` or, where questions are of pairs, `a` and `b`. What fails writes nothing. */
static vox_result ask(question which, const vox_locator* locator, const vox_positions* a,
                      const vox_positions* b, const vox_query_desc* desc) {
    union {
        vox_point_hit points[4];
        vox_closest_hit closest[4];
        vox_box_hit boxes[4];
        vox_ray_hit rays[4];
        uint8_t blocked[4];
    } out, before;
    uint64_t count = 77;
    memset(&out, 0xaa, sizeof out);
    before = out;
    const vox_result result =
        which == point_hits ? vox_locator_find_point_hits(locator, a, desc, out.points, 4, &count)
        : which == closest  ? vox_locator_find_closest(locator, a, desc, out.closest)
        : which == box_hits ? vox_locator_find_box_hits(locator, a, b, desc, out.boxes, 4, &count)
        : which == ray_hits ? vox_locator_find_ray_hits(locator, a, b, desc, out.rays, 4, &count)
                            : vox_locator_test_rays(locator, a, b, desc, out.blocked);
    if (result != VOX_OK) {
        ck_assert_mem_eq(&out, &before, sizeof out);
        ck_assert_uint_eq(count, 77);
    }
    return result;
}

/* The call fails with this text, where %s is the name of the first array. */
#define ck_question_fails(which, locator, a, b, desc, code, ...)                                             \
    do {                                                                                                     \
        char words_[96];                                                                                     \
        (void)snprintf(words_, sizeof words_, __VA_ARGS__, first_names[which]);                              \
        ck_fails(ask(which, locator, a, b, desc), code, words_);                                             \
    } while (0)

START_TEST(arguments) {
    static const double p[4][3] = {{1, 1, 1}, {2, 1, 3}, {0, NAN, 0}, {0, 0, 4e38}};
    uint64_t random = 9;
    world w = new_world(&random, 0);
    const vox_locator* locator = w.locator;
    const vox_positions one = vox_double_positions(p[0], 1), two = vox_double_positions(p[0], 2);
    const vox_positions no_number = vox_double_positions(p[1], 2), large = vox_double_positions(p[3], 1);
    const vox_positions none = vox_float_positions(NULL, 0);
    for (question q = point_hits; q < question_count; ++q) {
        const int pairs = q >= box_hits;
        vox_positions bad = one;
        vox_query_desc desc = vox_default_query_desc();
        ck_ok(ask(q, locator, &none, &none, &desc));
        ck_ok(ask(q, locator, &two, &two, NULL));
        ck_fails(ask(q, NULL, &one, &one, &desc), VOX_ERROR_INVALID_ARGUMENT, "locator is null");
        ck_question_fails(q, locator, NULL, &one, &desc, VOX_ERROR_INVALID_ARGUMENT, "%s is null");
        bad.data = NULL;
        ck_question_fails(q, locator, &bad, &one, &desc, VOX_ERROR_INVALID_ARGUMENT, "%s.data is null");
        ck_fails(ask(q, locator, &bad, &one, &desc), VOX_ERROR_INVALID_ARGUMENT, ".count is 1");
        bad = one;
        bad.count = 1ull << 32;
        ck_question_fails(q, locator, &bad, &bad, &desc, VOX_ERROR_LIMIT, "%s.count is 4294967296");
        bad = two;
        bad.byte_stride = 23;
        ck_question_fails(q, locator, &bad, &two, &desc, VOX_ERROR_INVALID_ARGUMENT, "%s.byte_stride is 23");
        bad = one;
        bad.format = (vox_format)9;
        ck_question_fails(q, locator, &bad, &one, &desc, VOX_ERROR_INVALID_ARGUMENT, "%s.format is 9");
        if (q != box_hits) {
            ck_question_fails(q, locator, &no_number, &two, &desc, VOX_ERROR_NON_FINITE,
                              "%s: position 1 is (0, nan, 0)");
            ck_question_fails(q, locator, &large, &one, &desc, VOX_ERROR_LIMIT,
                              "%s: position 0 is (0, 0, 4e+38)");
        }
        if (pairs) {
            ck_question_fails(q, locator, &one, &two, &desc, VOX_ERROR_INVALID_ARGUMENT, "%s.count is 1, ");
            ck_fails(ask(q, locator, &one, &two, &desc), VOX_ERROR_INVALID_ARGUMENT, ".count is 2");
            ck_fails(ask(q, locator, &one, NULL, &desc), VOX_ERROR_INVALID_ARGUMENT,
                     q == box_hits ? "max is null" : "to is null");
        }
        desc.flags = 6;
        ck_fails(ask(q, locator, &one, &one, &desc), VOX_ERROR_INVALID_ARGUMENT, "desc.flags is 0x6");
        desc.flags = 0;
        desc.reserved = 3;
        ck_fails(ask(q, locator, &one, &one, &desc), VOX_ERROR_INVALID_ARGUMENT, "desc.reserved is 3");
        desc.reserved = 0;
        desc.struct_size = 0;
        ck_fails(ask(q, locator, &one, &one, &desc), VOX_ERROR_INVALID_ARGUMENT, "struct_size");
        desc = vox_default_query_desc();
        ck_assert_uint_eq(desc.struct_size, sizeof desc);
        desc.max_distance = -1;
        ck_fails(ask(q, locator, &one, &one, &desc), VOX_ERROR_INVALID_ARGUMENT, "desc.max_distance is -1");
        desc.max_distance = NAN;
        ck_fails(ask(q, locator, &one, &one, &desc), VOX_ERROR_INVALID_ARGUMENT, "desc.max_distance is");
    }
    ck_fails(ask(ray_hits, locator, &one, &large, NULL), VOX_ERROR_LIMIT, "to: position 0 is (0, 0, 4e+38)");
    ck_fails(ask(test_rays, locator, &two, &no_number, NULL), VOX_ERROR_NON_FINITE, "to: position 1 is");
    ck_fails(ask(box_hits, locator, &no_number, &two, NULL), VOX_ERROR_INVALID_ARGUMENT,
             "box 0 is from (2, 1, 3) to (1, 1, 1)");
    ck_fails(ask(box_hits, locator, &two, &no_number, NULL), VOX_ERROR_INVALID_ARGUMENT,
             "box 1 is from (2, 1, 3) to (0, nan, 0)");
    end_world(&w);
}
END_TEST

START_TEST(null_outputs) {
    static const double p[3] = {1, 1, 1};
    uint64_t random = 9, count = 77;
    world w = new_world(&random, 0);
    const vox_positions one = vox_double_positions(p, 1), none = vox_double_positions(NULL, 0);
    vox_point_hit point;
    vox_box_hit box;
    vox_ray_hit ray;
#define ck_null_outputs(name, hit, ...)                                                                      \
    do {                                                                                                     \
        ck_fails(vox_locator_##name(w.locator, __VA_ARGS__, NULL, NULL, 1, &count),                          \
                 VOX_ERROR_INVALID_ARGUMENT, "hits is null");                                                \
        ck_fails(vox_locator_##name(w.locator, __VA_ARGS__, NULL, &hit, 1, NULL),                            \
                 VOX_ERROR_INVALID_ARGUMENT, "out_count is null");                                           \
        ck_assert_uint_eq(count, 77);                                                                        \
        ck_ok(vox_locator_##name(w.locator, __VA_ARGS__, NULL, NULL, 0, &count));                            \
        ck_assert_uint_ne(count, 77);                                                                        \
        count = 77;                                                                                          \
    } while (0)
    ck_null_outputs(find_point_hits, point, &one);
    ck_null_outputs(find_box_hits, box, &one, &one);
    ck_null_outputs(find_ray_hits, ray, &one, &one);
    ck_fails(vox_locator_find_closest(w.locator, &one, NULL, NULL), VOX_ERROR_INVALID_ARGUMENT,
             "out_hits is null");
    ck_fails(vox_locator_test_rays(w.locator, &one, &one, NULL, NULL), VOX_ERROR_INVALID_ARGUMENT,
             "out_blocked is null");
    ck_ok(vox_locator_find_closest(w.locator, &none, NULL, NULL));
    ck_ok(vox_locator_test_rays(w.locator, &none, &none, NULL, NULL));
    end_world(&w);
}
END_TEST

static void add_tests(TCase* tests) {
    tcase_add_each(tests, points_by_definition, points_in_double, boxes_by_definition, many_threads,
                   arguments, null_outputs);
}

SUITE(queries) { add_for_each_engine(suite, add_tests); }
