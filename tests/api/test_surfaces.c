/* Surfaces, motions and pairs: what is refused, in words and with nothing changed; degenerate scenes; memory.
 */
#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "support/ledger.h"
#include "support/surface_counter.h"

/* Two triangles that cross each other. */
static const double crossed[18] = {0, 0, 0, 1, 0, 0, 0, 1, 0, .25, .25, -1, .25, .25, 1, 2, 2, 0};
static const uint32_t two_faces[6] = {0, 1, 2, 3, 4, 5};

static vox_surface_desc desc_of(uint64_t vertices, const uint32_t* faces, uint64_t count) {
    vox_surface_desc desc = vox_default_surface_desc();
    desc.vertex_count = vertices;
    desc.faces = faces;
    desc.face_count = count;
    return desc;
}

static vox_surface* surface_from(const vox_surface_desc* desc) {
    vox_surface* surface = NULL;
    ck_ok(vox_surface_create(desc, &surface));
    return surface;
}

static vox_motion motion_of(const double* from, const double* to, uint64_t vertices) {
    vox_motion motion = vox_default_motion();
    motion.from.data = from;
    motion.to.data = to;
    motion.from.count = motion.to.count = vertices;
    motion.from.format = motion.to.format = VOX_FORMAT_DOUBLE;
    return motion;
}

static uint64_t pair_count(vox_surface* surface, vox_feature a, vox_feature b) {
    vox_partner_lists lists;
    ck_ok(vox_surface_find_pairs(surface, a, b, 0, UINT64_MAX, &lists));
    return lists.offsets[lists.count];
}

START_TEST(descriptions_that_are_refused) {
    vox_surface* surface = (vox_surface*)(void*)&surface;
    vox_surface_desc desc = desc_of(6, two_faces, 2);
    ck_fails(vox_surface_create(NULL, &surface), VOX_ERROR_INVALID_ARGUMENT, "desc");
    ck_fails(vox_surface_create(&desc, NULL), VOX_ERROR_INVALID_ARGUMENT, "out_surface");
    desc.vertex_count = 0;
    ck_fails(vox_surface_create(&desc, &surface), VOX_ERROR_INVALID_ARGUMENT, "vertex_count is 0");
    desc.vertex_count = 5;
    ck_fails(vox_surface_create(&desc, &surface), VOX_ERROR_INVALID_MESH, "face 1 names vertex 5 of 5");
    desc.vertex_count = (uint64_t)VOX_MAX_FEATURES + 1;
    ck_fails(vox_surface_create(&desc, &surface), VOX_ERROR_LIMIT, "2147483648");
    desc.vertex_count = 6;
    desc.face_count = (uint64_t)VOX_MAX_FEATURES + 1;
    ck_fails(vox_surface_create(&desc, &surface), VOX_ERROR_LIMIT, "face_count");
    desc = desc_of(6, NULL, 2);
    ck_fails(vox_surface_create(&desc, &surface), VOX_ERROR_INVALID_ARGUMENT, "faces is null");
    desc = desc_of(6, two_faces, 2);
    desc.edge_count = 1;
    ck_fails(vox_surface_create(&desc, &surface), VOX_ERROR_INVALID_ARGUMENT, "edges is null");
    const uint32_t patches[6] = {0, 0, 0, 1, 1, 2};
    const uint64_t masks[3] = {1, 1, 1};
    desc = desc_of(6, two_faces, 2);
    desc.patch_masks = masks;
    ck_fails(vox_surface_create(&desc, &surface), VOX_ERROR_INVALID_ARGUMENT, "patches is null");
    desc.patches = patches;
    ck_fails(vox_surface_create(&desc, &surface), VOX_ERROR_INVALID_ARGUMENT, "patch_count is 0");
    desc.patch_count = 2;
    ck_fails(vox_surface_create(&desc, &surface), VOX_ERROR_INVALID_ARGUMENT, "vertex 5 is in patch 2 of 2");
    desc.patch_count = (uint64_t)VOX_MAX_PATCHES + 1;
    ck_fails(vox_surface_create(&desc, &surface), VOX_ERROR_LIMIT, "65537");
    const double sizes[] = {-1, NAN, INFINITY};
    for (int i = 0; i < 3; ++i) {
        desc = desc_of(6, two_faces, 2);
        desc.cell_size = sizes[i];
        ck_fails(vox_surface_create(&desc, &surface), VOX_ERROR_INVALID_ARGUMENT, "cell_size");
    }
    desc = desc_of(6, two_faces, 2);
    desc.worker_count = VOX_MAX_WORKERS + 1;
    ck_fails(vox_surface_create(&desc, &surface), VOX_ERROR_INVALID_ARGUMENT, "worker_count");
    desc.worker_count = 1;
    desc.byte_budget = 100;
    ck_fails(vox_surface_create(&desc, &surface), VOX_ERROR_BUDGET, "100");
    ck_assert_ptr_eq(surface, (vox_surface*)(void*)&surface); /* never written */
    vox_surface_destroy(NULL);
}
END_TEST

START_TEST(motions_that_are_refused) {
    const vox_surface_desc desc = desc_of(6, two_faces, 2);
    vox_surface* const surface = surface_from(&desc);
    vox_partner_lists lists;
    ck_fails(vox_surface_find_pairs(surface, VOX_FEATURE_EDGE, VOX_FEATURE_FACE, 0, 1, &lists),
             VOX_ERROR_INVALID_STATE, "no positions");
    vox_motion good = motion_of(crossed, NULL, 6);
    ck_ok(vox_surface_move(surface, &good));
    const uint64_t pairs = pair_count(surface, VOX_FEATURE_EDGE, VOX_FEATURE_FACE);
    ck_assert_uint_gt(pairs, 0);

    vox_motion bad = good;
    bad.from.data = NULL;
    ck_fails(vox_surface_move(surface, &bad), VOX_ERROR_INVALID_ARGUMENT, "from.data is null");
    bad = good;
    bad.from.count = bad.to.count = 7;
    ck_fails(vox_surface_move(surface, &bad), VOX_ERROR_INVALID_ARGUMENT, "from.count is 7, expected 6");
    bad = good;
    bad.flags = 2;
    ck_fails(vox_surface_move(surface, &bad), VOX_ERROR_INVALID_ARGUMENT, "flags");
    bad = good;
    bad.from.reserved = 99;
    ck_fails(vox_surface_move(surface, &bad), VOX_ERROR_INVALID_ARGUMENT, "from.reserved is 99");
    bad = good;
    bad.from.format = bad.to.format = (vox_format)7;
    ck_fails(vox_surface_move(surface, &bad), VOX_ERROR_INVALID_ARGUMENT, "from.format is 7");
    bad = good;
    bad.to.data = crossed;
    bad.to.format = VOX_FORMAT_FLOAT;
    ck_fails(vox_surface_move(surface, &bad), VOX_ERROR_INVALID_ARGUMENT, "to.format is 0, from.format 1");
    bad = good;
    bad.from.byte_stride = bad.to.byte_stride = 23;
    ck_fails(vox_surface_move(surface, &bad), VOX_ERROR_INVALID_ARGUMENT,
             "byte_stride is 23, expected 0 or at least 24");
    bad = good;
    bad.from.component_byte_stride = bad.to.component_byte_stride = 40;
    ck_fails(vox_surface_move(surface, &bad), VOX_ERROR_INVALID_ARGUMENT, "component_byte_stride is 40");
    bad = good;
    bad.from.byte_stride = bad.to.byte_stride = UINT64_MAX / 2;
    ck_fails(vox_surface_move(surface, &bad), VOX_ERROR_INVALID_ARGUMENT, "too large for 6 positions");
    const double radii[] = {-1, NAN};
    for (int i = 0; i < 2; ++i) {
        bad = good;
        bad.radius = radii[i];
        ck_fails(vox_surface_move(surface, &bad), VOX_ERROR_INVALID_ARGUMENT, "radius");
    }
    double broken[18];
    memcpy(broken, crossed, sizeof broken);
    const double values[] = {NAN, INFINITY, -INFINITY, 1e39};
    for (int i = 0; i < 4; ++i) {
        broken[4] = values[i];
        bad = motion_of(broken, NULL, 6);
        ck_fails(vox_surface_move(surface, &bad), i < 3 ? VOX_ERROR_NON_FINITE : VOX_ERROR_LIMIT,
                 "from: vertex 1");
        bad = motion_of(crossed, broken, 6);
        ck_fails(vox_surface_move(surface, &bad), i < 3 ? VOX_ERROR_NON_FINITE : VOX_ERROR_LIMIT,
                 "to: vertex 1");
    }
    ck_assert_uint_eq(pair_count(surface, VOX_FEATURE_EDGE, VOX_FEATURE_FACE),
                      pairs); /* the motion of before */
    vox_surface_destroy(surface);
}
END_TEST

START_TEST(questions_that_are_refused) {
    const vox_surface_desc desc = desc_of(6, two_faces, 2);
    vox_surface* const surface = surface_from(&desc);
    const vox_motion motion = motion_of(crossed, NULL, 6);
    ck_ok(vox_surface_move(surface, &motion));
    vox_partner_lists lists;
    lists.count = 77;
    ck_fails(vox_surface_find_pairs(surface, (vox_feature)3, VOX_FEATURE_EDGE, 0, 1, &lists),
             VOX_ERROR_INVALID_ARGUMENT, "3");
    ck_fails(vox_surface_find_pairs(surface, VOX_FEATURE_EDGE, (vox_feature)-1, 0, 1, &lists),
             VOX_ERROR_INVALID_ARGUMENT, "-1");
    ck_fails(vox_surface_find_pairs(surface, VOX_FEATURE_EDGE, VOX_FEATURE_EDGE, 7, 1, &lists),
             VOX_ERROR_INVALID_ARGUMENT, "first is 7 of 6");
    ck_fails(vox_surface_find_pairs(NULL, VOX_FEATURE_EDGE, VOX_FEATURE_EDGE, 0, 1, &lists),
             VOX_ERROR_INVALID_ARGUMENT, "surface");
    ck_fails(vox_surface_find_pairs(surface, VOX_FEATURE_EDGE, VOX_FEATURE_EDGE, 0, 1, NULL),
             VOX_ERROR_INVALID_ARGUMENT, "out_lists");
    ck_assert_uint_eq(lists.count, 77);
    ck_ok(vox_surface_find_pairs(surface, VOX_FEATURE_EDGE, VOX_FEATURE_EDGE, 6, 1,
                                 &lists)); /* at the end: none */
    ck_assert_uint_eq(lists.count, 0);
    ck_fails(vox_surface_set_cell_size(surface, -1), VOX_ERROR_INVALID_ARGUMENT, "-1");
    ck_fails(vox_surface_set_cell_size(surface, NAN), VOX_ERROR_INVALID_ARGUMENT, "nan");
    vox_feature_view view;
    ck_fails(vox_surface_get_features(surface, VOX_FEATURE_VERTEX, &view), VOX_ERROR_INVALID_ARGUMENT,
             "VERTEX");
    ck_ok(vox_surface_get_features(surface, VOX_FEATURE_EDGE, &view));
    ck_assert_uint_eq(view.count, 6);
    ck_assert_uint_eq(view.vertices[0], 0);
    ck_assert_uint_eq(view.vertices[1], 1);
    vox_cell_size_result suggestion;
    suggestion.struct_size = sizeof suggestion;
    ck_ok(vox_surface_suggest_cell_size(surface, VOX_FEATURE_EDGE, VOX_FEATURE_EDGE, &suggestion));
    ck_assert(suggestion.cell_size > 0);
    vox_surface_destroy(surface);
}
END_TEST

/* Features without a size, twice the same, all in one place, of sizes from 1 to 10^12, at the ends of the
 * range. */
START_TEST(degenerate_scenes) {
    const uint32_t faces[] = {0, 0, 0, 0, 1, 0, 0, 1, 2, 0, 1, 2, 3, 4, 5, 5, 4, 3};
    const uint32_t edges[] = {0, 0, 0, 1, 1, 0, 2, 3, 4, 5, 4, 5};
    const double scales[] = {1, 1e-40, 1e-300, 1e30, 3e38, 0};
    const double radii[] = {0, 1e-3, INFINITY};
    for (int s = 0; s < 6; ++s)
        for (int r = 0; r < 3; ++r)
            for (int cull = 0; cull < 2; ++cull) {
                double at[18], to[18];
                for (int i = 0; i < 18; ++i) {
                    at[i] = scales[s] * crossed[i] / 2;
                    to[i] = i < 9 ? at[i] : -at[i];
                }
                if (s == 0) at[15] = 1e12;
                vox_surface_desc desc = desc_of(6, faces, 6);
                desc.edges = edges;
                desc.edge_count = 6;
                vox_surface* const surface = surface_from(&desc);
                vox_motion motion = motion_of(at, to, 6);
                motion.radius = radii[r];
                motion.flags = cull ? VOX_MOTION_CULL : 0;
                ck_ok(vox_surface_move(surface, &motion));
                for (int a = 0; a < 3; ++a)
                    for (int b = 0; b < 3; ++b) {
                        const uint64_t pairs = pair_count(surface, (vox_feature)a, (vox_feature)b);
                        if (r == 2 && a == 0 && b == 0) ck_assert_uint_eq(pairs, 15); /* all */
                    }
                vox_surface_destroy(surface);
            }
}
END_TEST

/* Features longer than any float, beside ones shorter than its reciprocal. */
START_TEST(sizes_beyond_floats) {
    const uint32_t faces[] = {0, 1, 2, 3, 4, 5}, edges[] = {0, 1, 1, 2, 3, 4, 4, 5};
    for (int s = 0; s < 4; ++s)
        for (int doubles = 0; doubles < 2; ++doubles) {
            const double large = s < 2 ? 3e38 : 1e5, small = s % 2 ? 1e-35 : 1e-44;
            double at[18];
            float floats[18];
            for (int i = 0; i < 18; ++i) at[i] = i < 9 ? large * crossed[i] : small * crossed[i];
            at[0] = -large;
            at[3] = large;
            for (int i = 0; i < 18; ++i) floats[i] = (float)at[i];
            vox_surface_desc desc = desc_of(6, faces, 2);
            desc.edges = edges;
            desc.edge_count = 4;
            vox_surface* const surface = surface_from(&desc);
            vox_motion motion = motion_of(at, NULL, 6);
            if (!doubles) {
                motion.from.data = floats;
                motion.from.format = motion.to.format = VOX_FORMAT_FLOAT;
            }
            ck_ok(vox_surface_move(surface, &motion));
            for (int a = 0; a < 3; ++a)
                for (int b = 0; b < 3; ++b) (void)pair_count(surface, (vox_feature)a, (vox_feature)b);
            vox_crossing_view crossings;
            ck_ok(vox_surface_find_crossings(surface, &crossings));
            vox_surface_destroy(surface);
        }
}
END_TEST

/* A radius without an end: every pair is answered, but no cell size is better than another. */
START_TEST(suggestions_that_are_refused) {
    vox_surface_desc desc = desc_of(6, two_faces, 2);
    vox_surface* const surface = surface_from(&desc);
    vox_motion motion = motion_of(crossed, NULL, 6);
    const double radii[] = {INFINITY, 1e300};
    for (int i = 0; i < 2; ++i) {
        motion.radius = radii[i];
        ck_ok(vox_surface_move(surface, &motion));
        vox_cell_size_result out = {.struct_size = sizeof out};
        ck_fails(vox_surface_suggest_cell_size(surface, VOX_FEATURE_EDGE, VOX_FEATURE_EDGE, &out),
                 VOX_ERROR_INVALID_ARGUMENT, i == 0 ? "radius is inf" : "radius is 1e+300");
    }
    vox_surface_destroy(surface);
    desc = desc_of(6, NULL, 0);
    vox_surface* const points = surface_from(&desc);
    motion.radius = 0;
    ck_ok(vox_surface_move(points, &motion));
    vox_cell_size_result out = {.struct_size = sizeof out};
    ck_fails(vox_surface_suggest_cell_size(points, VOX_FEATURE_FACE, VOX_FEATURE_VERTEX, &out),
             VOX_ERROR_INVALID_ARGUMENT, "no features");
    vox_surface_destroy(points);
}
END_TEST

/* Null: those of the faces, each once; else those given, also none of them. */
START_TEST(edges_of_a_surface) {
    static const uint32_t faces[6] = {2, 1, 0, 1, 2, 3}, given[4] = {5, 0, 4, 4};
    static const uint32_t of_faces[10] = {0, 1, 0, 2, 1, 2, 1, 3, 2, 3};
    for (int i = 0; i < 3; ++i) {
        vox_surface_desc desc = desc_of(6, faces, 2);
        desc.edges = i == 0 ? NULL : given;
        desc.edge_count = i == 2 ? 2 : 0;
        vox_surface* const surface = surface_from(&desc);
        vox_feature_view view;
        ck_ok(vox_surface_get_features(surface, VOX_FEATURE_EDGE, &view));
        const uint64_t counts[3] = {5, 0, 2};
        ck_assert_uint_eq(view.count, counts[i]);
        if (i == 0) ck_assert_mem_eq(view.vertices, of_faces, sizeof of_faces);
        if (i == 2) ck_assert_mem_eq(view.vertices, given, sizeof given);
        vox_surface_destroy(surface);
    }
}
END_TEST

/* A time that is given up is earlier, and the pair is reported. */
START_TEST(times_that_are_given_up) {
    static const double from[24] = {0, 0, 0, 4, 0, 1, 0, 4, 0, 1, 1, 3, 9, 9, 9, 9, 9, 9};
    double to[24];
    memcpy(to, from, sizeof to);
    to[11] = -3; /* vertex 3 falls through the face, which turns meanwhile */
    to[5] = -2;
    const vox_surface_desc desc = desc_of(6, two_faces, 1);
    vox_surface* const surface = surface_from(&desc);
    const vox_motion motion = motion_of(from, to, 6);
    ck_ok(vox_surface_move(surface, &motion));
    double times[2];
    for (int i = 0; i < 2; ++i) {
        vox_impact_desc rule = vox_default_impact_desc();
        rule.slack = 1e-6;
        if (i == 0) rule.max_iterations = 1;
        vox_impact_view view;
        ck_ok(vox_surface_find_impacts(surface, VOX_FEATURE_FACE, VOX_FEATURE_VERTEX, &rule, &view));
        ck_assert_uint_eq(view.count, 1);
        ck_assert_uint_eq(view.data[0].b, 3);
        times[i] = view.data[0].time;
    }
    ck_assert(0 < times[0] && times[0] < times[1] && times[1] < 1);
    vox_surface_destroy(surface);
}
END_TEST

/* Static obstacles do not meet each other. */
START_TEST(patches_that_do_not_meet) {
    const uint32_t patches[6] = {0, 0, 0, 1, 1, 1};
    const uint64_t categories[2] = {1, 2}, meet[2] = {3, 3}, apart[2] = {1, 2};
    for (int off = 0; off < 2; ++off) {
        vox_surface_desc desc = desc_of(6, two_faces, 2);
        desc.patches = patches;
        desc.patch_categories = categories;
        desc.patch_masks = off ? apart : meet;
        desc.patch_count = 2;
        vox_surface* const surface = surface_from(&desc);
        const vox_motion motion = motion_of(crossed, NULL, 6);
        ck_ok(vox_surface_move(surface, &motion));
        const uint64_t pairs = pair_count(surface, VOX_FEATURE_FACE, VOX_FEATURE_FACE);
        ck_assert_uint_eq(pairs, off ? 0 : 1);
        vox_surface_destroy(surface);
    }
}
END_TEST

/* Where memory runs out, call by call: an error, nothing lost, and the same answer afterwards. */
START_TEST(memory_that_runs_out) {
    ledger book = {0};
    uint64_t calls = 0;
    for (uint64_t fail_at = 0; fail_at <= calls; ++fail_at) {
        memset(&book, 0, sizeof book);
        vox_surface_desc desc = desc_of(6, two_faces, 2);
        const vox_allocator allocator = {ledger_allocate, ledger_release, &book};
        desc.allocator = &allocator;
        book.fail_at = fail_at;
        vox_surface* surface = NULL;
        vox_result result = vox_surface_create(&desc, &surface);
        if (result == VOX_OK) {
            vox_motion motion = motion_of(crossed, NULL, 6);
            motion.flags = VOX_MOTION_CULL;
            vox_partner_lists lists;
            result = vox_surface_move(surface, &motion);
            if (result == VOX_OK)
                result = vox_surface_find_pairs(surface, VOX_FEATURE_EDGE, VOX_FEATURE_FACE, 0, 6, &lists);
            if (fail_at == 0) {
                calls = book.calls;
                ck_ok(result);
            } else {
                ck_assert_int_eq(result, VOX_ERROR_OUT_OF_MEMORY);
                ck_ok(vox_surface_move(surface, &motion));
                ck_assert_uint_eq(pair_count(surface, VOX_FEATURE_EDGE, VOX_FEATURE_FACE), 2);
            }
            vox_surface_destroy(surface);
        } else {
            ck_assert_int_eq(result, VOX_ERROR_OUT_OF_MEMORY);
        }
        ck_assert_uint_eq(book.bytes, 0);
    }
    ck_assert_uint_gt(calls, 10);
}
END_TEST

/* After the first answers, the same motions take no more memory. */
START_TEST(no_memory_in_the_steady_state) {
    enum { side = 40 };
    static double at[2][side * side * 3];
    static uint32_t faces[side * side * 6];
    uint64_t count = 0;
    for (uint32_t i = 0; i < side * side; ++i)
        for (int k = 0; k < 2; ++k) {
            at[k][3 * i] = i % side;
            at[k][3 * i + 1] = i / side;
            at[k][3 * i + 2] = sin(i / 50.) * 3 + k;
        }
    for (uint32_t i = 0; i + side + 1 < side * side; ++i)
        if (i % side + 1 < side) {
            const uint32_t two[6] = {i, i + 1, i + side, i + side, i + 1, i + side + 1};
            memcpy(faces + 3 * count, two, sizeof two);
            count += 2;
        }
    ledger book = {0};
    vox_surface_desc desc = desc_of(side * side, faces, count);
    const vox_allocator allocator = {ledger_allocate, ledger_release, &book};
    desc.allocator = &allocator;
    vox_surface* const surface = surface_from(&desc);
    uint64_t calls = 0;
    for (int step = 0; step < 6; ++step) {
        vox_motion motion = motion_of(at[step & 1], at[!(step & 1)], side * side);
        motion.flags = VOX_MOTION_CULL;
        motion.radius = 0.01;
        ck_ok(vox_surface_move(surface, &motion));
        (void)pair_count(surface, VOX_FEATURE_EDGE, VOX_FEATURE_EDGE);
        const uint64_t overlaps = surface_counter(surface, "overlaps");
        ck_assert_uint_gt(overlaps, 0);
        ck_assert_uint_eq(surface_counter(surface, "culled"), overlaps); /* it moves as a whole */
        (void)pair_count(surface, VOX_FEATURE_FACE, VOX_FEATURE_VERTEX);
        if (step == 2) calls = book.calls;
        if (step > 2) ck_assert_uint_eq(book.calls, calls);
    }
    vox_surface_destroy(surface);
}
END_TEST

static vox_surface* many_in_one_place(uint64_t vertices, uint64_t byte_budget) {
    float* at = (float*)calloc(3 * vertices, sizeof *at);
    vox_surface_desc desc = desc_of(vertices, NULL, 0);
    desc.byte_budget = byte_budget;
    vox_surface* const surface = surface_from(&desc);
    vox_motion motion = vox_default_motion();
    motion.from.data = at;
    motion.from.count = motion.to.count = vertices;
    ck_ok(vox_surface_move(surface, &motion));
    free(at);
    return surface;
}

/* What answers as a whole says that it does not fit, with numbers; what was answered before, and the pairs in
 * ranges, are still to be had. */
START_TEST(answers_beyond_the_budget) {
    enum { n = 3000 };
    vox_surface* const surface = many_in_one_place(n, 4 << 20);
    vox_proximity_view close;
    close.count = 77;
    ck_fails(vox_surface_find_proximities(surface, VOX_FEATURE_VERTEX, VOX_FEATURE_VERTEX, 1, &close),
             VOX_ERROR_BUDGET, "4194304");
    ck_assert_uint_eq(close.count, 77);
    uint64_t pairs = 0;
    for (uint64_t first = 0; first < n;) {
        vox_partner_lists lists;
        ck_ok(vox_surface_find_pairs(surface, VOX_FEATURE_VERTEX, VOX_FEATURE_VERTEX, first, UINT64_MAX,
                                     &lists));
        ck_assert_uint_gt(lists.count, 0);
        ck_assert_uint_le(surface_counter(surface, "peak_bytes"), 4 << 20);
        pairs += lists.offsets[lists.count];
        first += lists.count;
    }
    ck_assert_uint_eq(pairs, n * (n - 1) / 2);
    vox_surface_destroy(surface);

    /* Less than a search of one feature needs. */
    vox_surface* const tight = many_in_one_place(n, 300 << 10);
    vox_partner_lists lists;
    ck_fails(vox_surface_find_pairs(tight, VOX_FEATURE_VERTEX, VOX_FEATURE_VERTEX, 0, 1, &lists),
             VOX_ERROR_BUDGET, "307200");
    ck_assert_uint_le(surface_counter(tight, "peak_bytes"), 300 << 10);
    vox_surface_destroy(tight);
}
END_TEST

/* An answer that has ended is not in the way of another one; one that the caller has a view of stays. */
START_TEST(budget_of_answers_that_ended) {
    enum { n = 3000 };
    vox_surface* const surface = many_in_one_place(n, 4 << 20);
    vox_partner_lists lists;
    ck_ok(vox_surface_find_pairs(surface, VOX_FEATURE_VERTEX, VOX_FEATURE_VERTEX, 0, UINT64_MAX,
                                 &lists)); /* fills it */
    ck_assert_uint_gt(surface_counter(surface, "bytes"), 2 << 20);
    double at[3 * n];
    for (int i = 0; i < 3 * n; ++i) at[i] = i;
    const vox_motion motion = motion_of(at, NULL, n);
    vox_proximity_view close;
    ck_ok(vox_surface_move(surface, &motion));
    ck_ok(vox_surface_find_proximities(surface, VOX_FEATURE_VERTEX, VOX_FEATURE_VERTEX, 20, &close));
    ck_assert_uint_eq(close.count, 3 * n - 6); /* three on each side of a vertex */
    vox_surface_destroy(surface);
}
END_TEST

/* More pairs than 32 bits hold are had in ranges. */
START_TEST(a_thousand_million_pairs) {
    const uint64_t n = 45000, all = n * (n - 1) / 2; /* 1,012,477,500 */
    vox_surface* const surface = many_in_one_place(n, 64 << 20);
    const uint64_t firsts[] = {0, n / 2, n - 300};
    for (int i = 0; i < 3; ++i) {
        const uint64_t first = firsts[i];
        vox_partner_lists lists;
        ck_ok(vox_surface_find_pairs(surface, VOX_FEATURE_VERTEX, VOX_FEATURE_VERTEX, first, UINT64_MAX,
                                     &lists));
        ck_assert_uint_gt(lists.count, 100);
        ck_assert_uint_eq(lists.count == n - first, i == 2);
        for (uint64_t v = 0; v < lists.count; ++v) {
            ck_assert_uint_eq(lists.offsets[v + 1] - lists.offsets[v], n - 1 - (first + v));
            if (first + v + 1 == n) continue;
            ck_assert_uint_eq(lists.partners[lists.offsets[v]], first + v + 1);
            ck_assert_uint_eq(lists.partners[lists.offsets[v + 1] - 1], n - 1);
        }
        if (i == 0) ck_assert_uint_lt(lists.offsets[lists.count], all);
    }
    ck_assert_uint_le(surface_counter(surface, "peak_bytes"), 64 << 20);
    vox_proximity_view close;
    ck_fails(vox_surface_find_proximities(surface, VOX_FEATURE_VERTEX, VOX_FEATURE_VERTEX, 0, &close),
             VOX_ERROR_BUDGET, "67108864");
    vox_surface_destroy(surface);
}
END_TEST

SUITE(surfaces) {
    tcase_add_test(add_tagged_case(suite, "many", "large"), a_thousand_million_pairs);
    TCase* tests = add_case(suite, "surfaces");
    tcase_add_each(tests, descriptions_that_are_refused, motions_that_are_refused, questions_that_are_refused,
                   degenerate_scenes, sizes_beyond_floats, suggestions_that_are_refused,
                   budget_of_answers_that_ended, edges_of_a_surface, times_that_are_given_up,
                   patches_that_do_not_meet, memory_that_runs_out, no_memory_in_the_steady_state,
                   answers_beyond_the_budget);
}
