/* VOX_DEPTH_METHOD_CLOSEST against brute force over every triangle, and against locators. */
#include "support/constraint_scenes.h"
#include "support/locators.h"

static vox_constraint_view find(vox_grid* grid) {
    vox_constraint_desc desc = vox_default_constraint_desc();
    desc.method = VOX_DEPTH_METHOD_CLOSEST;
    ck_ok(vox_grid_find_constraints(grid, &desc));
    return check_depths(grid);
}

/* The surface of a body as it is in the grid. */
static surface placed_surface(const world* w, int index, uint32_t tets_a_part) {
    const model* m = &w->models[index];
    surface s = surface_of_parts(&m->shape, tets_a_part ? tets_a_part : m->shape.tet_count + 1);
    placed_body placed = place_body(w->grid, m->id);
    free(s.positions);
    s.positions = placed.x;
    free(placed.tets);
    return s;
}

static const facet* facet_of(const surface* s, const uint32_t triangle[3]) {
    for (uint32_t f = 0; f < s->count; ++f) {
        int same = 0;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) same += triangle[i] == s->facets[f].v[j];
        if (same == 3) return &s->facets[f];
    }
    return NULL;
}

/* The point of body_b. */
static vector point_of(const vox_constraint* c, const surface* b) {
    vector at = {0, 0, 0};
    for (uint32_t i = 1; i < c->count; ++i) at = plus_times(at, -c->weights[i], corner(b, c->vertices[i]));
    return at;
}

/* Checks one against all triangles of body_b or, for a body of parts with itself, of the part that the vertex
 * is in. `exact`: all distances are exact, so that ties are too. Returns 1 when there is a surface. */
static uint64_t check_one(const vox_constraint* c, const surface* b, uint32_t tets_a_part, int exact) {
    const vector p = vector_of(c->position);
    const uint32_t part = c->body_a == c->body_b && tets_a_part ? c->element_b / tets_a_part : all_parts;
    vector way = {0, 0, 0};
    const facet* wanted = closest_facet(b, p, part, &way);
    if (!wanted) {
        ck_assert_uint_eq(c->count, 5);
        ck_assert(c->gap == 0);
        return 0;
    }
    ck_assert_uint_eq(c->count, 4);
    const facet* found = facet_of(b, c->vertices + 1);
    ck_assert_ptr_nonnull(found);
    ck_assert_uint_eq(found->part, wanted->part);
    if (exact) ck_assert_mem_eq(found->v, wanted->v, sizeof found->v);
    const double depth = depth_of(c), least = norm(way), rounding = 1e-12 + 1e-9 * least;
    ck_assert_double_le(fabs(depth - least), rounding);
    ck_assert_int_eq(c->state, depth > 0 ? VOX_DEPTH_CLOSEST : VOX_DEPTH_TOUCHING);
    const vector to = minus(point_of(c, b), p);
    ck_assert_double_le(norm(minus(to, plus_times((vector){0, 0, 0}, depth, normal_of(c)))), rounding);
    return 1;
}

static uint64_t check_all(const world* w, uint32_t tets_a_part, int exact) {
    const vox_constraint_view view = find(w->grid);
    surface surfaces[most_bodies];
    uint64_t found = 0;
    for (int b = 0; b < w->count; ++b) surfaces[b] = placed_surface(w, b, tets_a_part);
    for (uint64_t i = 0; i < view.count; ++i)
        found += check_one(&view.data[i], &surfaces[index_of(w, view.data[i].body_b)], tets_a_part, exact);
    for (int b = 0; b < w->count; ++b) free_surface(&surfaces[b]);
    /* Where consistent depth takes the closest point it is this one. */
    kept_constraints closest = keep_constraints(w->grid);
    ck_ok(vox_grid_find_constraints(w->grid, NULL));
    const vox_constraint_view consistent = check_depths(w->grid);
    ck_assert_uint_eq(consistent.count, closest.count);
    for (uint64_t i = 0; i < closest.count; ++i) {
        const vox_constraint *c = &consistent.data[i], *expected = &closest.data[i];
        ck_assert_uint_eq(c->count, 5);
        if (c->state != VOX_DEPTH_CLOSEST) continue;
        ck_assert_double_eq(c->gap, expected->gap);
        ck_assert_mem_eq(c->normal, expected->normal, sizeof c->normal);
    }
    free(closest.data);
    (void)find(w->grid);
    return found;
}

/* A locator finds the same, asked for one body. */
static void check_with_locator(const world* w, int coarse) {
    const vox_constraint_view view = constraints_of(w->grid);
    vox_locator* locator = take_locator(w->grid);
    for (uint64_t i = 0; i < view.count; ++i) {
        const vox_constraint* c = &view.data[i];
        if (c->count == 5) continue;
        const vox_query_desc desc = query_of((uint64_t)1 << index_of(w, c->body_b), VOX_NULL_BODY);
        const vox_closest_hit hit = closest_to(locator, c->position, &desc);
        ck_assert_uint_eq(hit.body, c->body_b);
        ck_assert_double_le(hit.distance, 0);
        ck_assert_double_eq_tol(hit.distance, c->gap, 1e-15 + 1e-12 * fabs(c->gap));
        if (coarse) continue; /* where another point is as close */
        for (int k = 0; k < 3; ++k) {
            ck_assert_double_eq_tol(hit.position[k] - c->position[k], depth_of(c) * c->normal[k], 1e-13);
            for (int j = 1; j < 4; ++j)
                if (hit.face[k] == c->vertices[j])
                    ck_assert_double_eq_tol(hit.weights[k], -c->weights[j], 1e-12);
        }
    }
    vox_locator_release(locator);
}

START_TEST(by_definition) {
    uint64_t random = 17, found = 0, touching = 0;
    for (int scene = 0; scene < 120; ++scene) {
        const int coarse = scene % 2;
        world w;
        make_random_models(&w, &random, coarse);
        for (int b = 0; b < w.count; ++b) w.models[b].filter.category = (uint64_t)1 << b;
        w.grid = new_grid(suite_engine, scene % 3 == 0 ? VOX_GRID_CONSTRAINTS : 0, 1);
        insert_models(w.grid, &w);
        ck_ok(vox_grid_step(w.grid));
        found += check_all(&w, 0, 0);
        check_with_locator(&w, coarse);
        for (int b = 0; b < w.count; ++b) touching += count_state(w.grid, w.models[b].id, VOX_DEPTH_TOUCHING);
        end_world(&w);
    }
    ck_assert_uint_gt(found, 2000);
    ck_assert_uint_gt(touching, 100);
}
END_TEST

/* Boxes on a lattice: distances are exact, and so is which triangle is the lowest of those equally far. */
START_TEST(ties) {
    uint64_t random = 5, found = 0;
    for (int scene = 0; scene < 60; ++scene) {
        world w;
        memset(&w, 0, sizeof w);
        w.count = 3;
        for (int b = 0; b < w.count; ++b) {
            float at[3];
            for (int axis = 0; axis < 3; ++axis) at[axis] = 0.5f * (float)random_below(&random, 5);
            w.models[b].shape = make_box(2, 1, at[0], at[1], at[2]);
        }
        w.grid = engine_grid();
        insert_models(w.grid, &w);
        ck_ok(vox_grid_step(w.grid));
        found += check_all(&w, 0, 1);
        end_world(&w);
    }
    ck_assert_uint_gt(found, 1000);
}
END_TEST

/* ---- self-contact ------------------------------------------------------------------------------- */

/* Two boxes as one body, the second moved. */
static body two_boxes(uint32_t n, float x, float y, float z) {
    body first = make_box(n, 1, 0, 0, 0), second = make_box(n, 1, x, y, z);
    body both = {NULL, NULL, 2 * first.vertex_count, 2 * first.tet_count};
    both.positions = (float*)malloc(6 * sizeof(float) * first.vertex_count);
    both.tets = (uint32_t*)malloc(8 * sizeof(uint32_t) * first.tet_count);
    memcpy(both.positions, first.positions, 3 * sizeof(float) * first.vertex_count);
    memcpy(both.positions + 3 * first.vertex_count, second.positions, 3 * sizeof(float) * first.vertex_count);
    memcpy(both.tets, first.tets, 4 * sizeof(uint32_t) * first.tet_count);
    for (uint32_t i = 0; i < 4 * first.tet_count; ++i)
        both.tets[4 * first.tet_count + i] = second.tets[i] + first.vertex_count;
    free_body(&first);
    free_body(&second);
    return both;
}

static world one_body(body b) {
    world w;
    memset(&w, 0, sizeof w);
    w.count = 1;
    w.models[0].shape = b;
    w.models[0].filter.flags = VOX_FILTER_SELF_COLLISION;
    w.grid = engine_grid();
    insert_models(w.grid, &w);
    ck_ok(vox_grid_step(w.grid));
    return w;
}

/* A body of two boxes in each other: the fold that a vertex has entered is the other box. */
START_TEST(self_contact) {
    uint64_t random = 23, found = 0;
    for (int scene = 0; scene < 20; ++scene) {
        const uint32_t n = 2 + random_below(&random, 2);
        const float x = random_float(&random, 0.2f, 0.9f) * (float)n, y = random_float(&random, -0.7f, 0.7f),
                    z = random_float(&random, -0.7f, 0.7f);
        world w = one_body(two_boxes(n, x, y, z));
        found += check_all(&w, w.models[0].shape.tet_count / 2, 0);
        end_world(&w);
    }
    ck_assert_uint_gt(found, 200);
}
END_TEST

/* A fold of one piece: a vertex is never answered by a triangle of which it is a corner. */
START_TEST(self_contact_of_one_piece) {
    body folded = make_box(6, 1, 0, 0, 0);
    uint64_t found = 0;
    for (uint32_t v = 0; v < folded.vertex_count; ++v) { /* the upper half folded down into the lower */
        float* p = folded.positions + 3 * v;
        if (p[2] > 3) p[2] = 6.3f - p[2];
        p[0] += 0.01f * p[1];
    }
    world w = one_body(folded);
    const vox_constraint_view view = find(w.grid);
    surface s = placed_surface(&w, 0, 0);
    for (uint64_t i = 0; i < view.count; ++i) {
        const vox_constraint* c = &view.data[i];
        if (c->count == 5) continue;
        ++found;
        vector on[3];
        for (int k = 0; k < 3; ++k) {
            ck_assert_uint_ne(c->vertices[1 + k], c->vertices[0]);
            on[k] = corner(&s, c->vertices[1 + k]);
        }
        const vector p = vector_of(c->position);
        ck_assert_double_eq_tol(depth_of(c), norm(minus(closest_on_facet(p, on[0], on[1], on[2]), p)), 1e-12);
    }
    ck_assert_uint_gt(found, 100);
    free_surface(&s);
    end_world(&w);
}
END_TEST

/* ---- bodies of any size and shape --------------------------------------------------------------- */

/* A transform counts, to the last bit, and a body scaled to nearly nothing or nearly everything keeps its
 * normals. */
START_TEST(transform_and_scale) {
    static const double scales[] = {1, 1e-60, 1e-30, 1e30};
    for (int s = 0; s < 4; ++s) {
        const double scale = scales[s], c = 0.8 * scale, d = 0.6 * scale;
        vox_grid_desc desc = engine_desc();
        world w = two_in_each_other(2, &desc);
        for (int b = 0; b < 2; ++b) {
            const double matrix[12] = {c,           -d, 0, b * 0.1 * scale, d,          c, 0,
                                       0.2 * scale, 0,  0, scale,           0.3 * scale};
            ck_ok(vox_body_set_transform(w.grid, w.models[b].id, matrix));
        }
        ck_ok(vox_grid_step(w.grid));
        const vox_constraint_view view = find(w.grid);
        surface surfaces[2] = {placed_surface(&w, 0, 0), placed_surface(&w, 1, 0)};
        ck_assert_uint_gt(view.count, 4);
        for (uint64_t i = 0; i < view.count; ++i) {
            const vox_constraint* found = &view.data[i];
            const int a = index_of(&w, found->body_a);
            const vector p = corner(&surfaces[a], found->vertices[0]),
                         to = minus(point_of(found, &surfaces[1 - a]), p);
            ck_assert_mem_eq(found->position, &p, sizeof found->position);
            /* A box: the way to its surface is its normal. */
            ck_assert_double_le(norm(plus_times(to, -depth_of(found), normal_of(found))) / scale, 1e-14);
        }
        for (int b = 0; b < 2; ++b) free_surface(&surfaces[b]);
        end_world(&w);
    }
}
END_TEST

/* The facets of a simplex in four dimensions: each belongs to two tetrahedra. */
START_TEST(no_surface) {
    static const float positions[15] = {0, 0, 0, 4, 0, 0, 0, 4, 0, 0, 0, 4, 1, 1, 0.5f},
                       point[3] = {0.5f, 0.75f, 0.5f};
    static const uint32_t tets[20] = {0, 1, 2, 3, 0, 1, 2, 4, 0, 1, 3, 4, 0, 2, 3, 4, 1, 2, 3, 4};
    vox_grid* grid = engine_grid();
    vox_mesh_desc desc = vox_mesh_desc_floats(positions, 5, tets, 5);
    insert_mesh(grid, &desc);
    desc = vox_mesh_desc_floats(point, 1, NULL, 0);
    insert_mesh(grid, &desc);
    ck_ok(vox_grid_step(grid));
    const vox_constraint_view view = find(grid);
    ck_assert_uint_eq(view.count, 1);
    ck_assert_uint_eq(view.data[0].count, 5);
    ck_assert_int_eq(view.data[0].state, VOX_DEPTH_CLOSEST);
    ck_assert(view.data[0].gap == 0);
    vox_grid_destroy(grid);
}
END_TEST

/* A double of this kind: usual; of any size; a few units of the least denormal. */
static double odd_double(uint64_t* random, int kind) {
    const double mantissa = random_symmetric(random);
    if (kind == 0) return mantissa;
    if (kind == 1) return ldexp(mantissa, (int)(1100 * random_unit(random)) - 1000);
    return ldexp(floor(16 * mantissa), -1074);
}

/* A vertex in a tetrahedron whose corners are as odd as doubles can be. What is below 1e-70 counts as a
 * point. */
START_TEST(odd_bodies) {
    static const vox_depth_method methods[] = {VOX_DEPTH_METHOD_CONSISTENT, VOX_DEPTH_METHOD_CLOSEST};
    uint64_t random = 11, found = 0;
    for (int scene = 0; scene < 6000; ++scene) {
        double corners[12], inside[3] = {0, 0, 0};
        for (int i = 0; i < 12; ++i) {
            corners[i] = odd_double(&random, (scene + (scene % 2 ? i : 0)) % 3);
            if (fabs(corners[i]) > 1e38) corners[i] = 1e38;
        }
        for (int i = 0; i < 12; ++i) inside[i % 3] += corners[i] / 4;
        vox_grid* grid = engine_grid();
        vox_mesh_desc desc = vox_mesh_desc_doubles(corners, 4, unit_tet, 1);
        insert_mesh(grid, &desc);
        desc = vox_mesh_desc_doubles(inside, 1, NULL, 0);
        insert_mesh(grid, &desc);
        ck_ok(vox_grid_step(grid));
        for (int m = 0; m < 2; ++m) {
            vox_constraint_desc wanted = vox_default_constraint_desc();
            wanted.method = methods[m];
            ck_ok(vox_grid_find_constraints(grid, &wanted));
            const vox_constraint_view view = constraints_of(grid);
            for (uint64_t i = 0; i < view.count; ++i) {
                const vox_constraint* c = &view.data[i];
                double sum = 0, at[3] = {0, 0, 0}, size[3] = {0, 0, 0};
                ck_assert(isfinite(c->offset) && c->gap <= 0 && isfinite(c->gap));
                ck_assert_double_eq_tol(norm(normal_of(c)), 1, 1e-14);
                for (uint32_t k = 1; k < c->count; ++k) {
                    ck_assert(c->weights[k] <= 0 && c->weights[k] >= -1);
                    sum += c->weights[k];
                    for (int axis = 0; axis < 3; ++axis) {
                        const double x = corners[3 * c->vertices[k] + (uint32_t)axis];
                        at[axis] -= c->weights[k] * x;
                        size[axis] = fmax(size[axis], fabs(x));
                    }
                }
                ck_assert_double_eq_tol(sum, -1, 1e-15);
                for (int axis = 0; axis < 3 && c->count == 4; ++axis) {
                    const double bound = depth_of(c) + 1e-6 * fabs(inside[axis]) + 1e-15 * size[axis] + 1e-70;
                    ck_assert_double_le(fabs(at[axis] - inside[axis]), bound);
                }
                found += c->count == 4;
            }
        }
        vox_grid_destroy(grid);
    }
    ck_assert_uint_gt(found, 3000);
}
END_TEST

static void add_tests(TCase* tests) {
    tcase_add_each(tests, by_definition, ties, self_contact, self_contact_of_one_piece, transform_and_scale,
                   no_surface, odd_bodies);
}

SUITE(closest_depth) { add_for_each_engine(suite, add_tests); }
