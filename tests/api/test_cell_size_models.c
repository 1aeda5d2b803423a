/* The cost models through the C interface: what a suggestion explains, weights, predictions, the grid's own,
 * and the method for cost functions of others. */
#include "support/suggest_scenes.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const vox_cost_model models[] = {VOX_COST_MODEL_PAPER, VOX_COST_MODEL_REFERENCE, VOX_COST_MODEL_FAST,
                                        VOX_COST_MODEL_SURFACE};

/* Two boxes that overlap, moved about. */
typedef struct pair {
    body boxes[2];
    vox_mesh_desc meshes[2];
} pair;

static pair make_pair(float h) {
    pair p;
    uint32_t state = 7;
    for (int b = 0; b < 2; ++b) {
        p.boxes[b] = make_box(8, h, b ? 6 * h : 0, b ? 0.3f * h : 0, 0);
        for (uint32_t i = 0; i < 3 * p.boxes[b].vertex_count; ++i)
            p.boxes[b].positions[i] += ((float)(random_quick(&state) >> 16) / 65536.0f - 0.5f) * 0.3f * h;
        p.meshes[b] = body_desc(&p.boxes[b]);
    }
    return p;
}

static void free_pair(pair* p) {
    for (int b = 0; b < 2; ++b) free_body(&p->boxes[b]);
}

/* ---- suggestions ------------------------------------------------------------------------------ */

START_TEST(a_suggestion_explains_itself) {
    pair p = make_pair(0.5f);
    vox_cell_size_desc desc = vox_default_cell_size_desc();
    desc.model = models[_i];
    const vox_cell_size_result found = suggest_ok(&desc, p.meshes, 2);
    ck_assert_uint_eq(found.warnings, 0);
    ck_assert_str_eq(found.note, "");
    ck_assert_double_lt(found.zone_min, found.cell_size);
    ck_assert_double_gt(found.zone_max, found.cell_size);
    ck_assert_uint_ge(found.term_count, 2);

    double cost = 0;
    for (uint32_t i = 0; i < found.term_count; ++i) {
        ck_assert_uint_gt(strlen(found.terms[i].name), 0);
        ck_assert_double_ge(found.terms[i].count, 0);
        cost += found.terms[i].cost;
    }
    ck_assert_double_eq_tol(cost, found.cost, 1e-9 * cost);

    /* What a rule would cost is no less than the least. */
    ck_assert_uint_eq(found.rule_count, 5);
    for (uint32_t i = 0; i < found.rule_count; ++i) {
        ck_assert_double_gt(found.rules[i].cell_size, 0);
        ck_assert_double_ge(found.rules[i].cost, found.cost * (1 - 1e-9));
    }
    for (uint32_t i = 0; i < found.curve_count; ++i)
        ck_assert_double_ge(found.curve[i].cost, found.cost * (1 - 1e-9));
    ck_assert_double_eq(found.min_cell_size, 0);
    ck_assert_uint_eq(found.timing_count, 0);
    free_pair(&p);
}
END_TEST

/* A scene in metres, in millimetres and in between is the same scene. */
START_TEST(units_do_not_matter) {
    pair one = make_pair(1), other = make_pair(1024);
    vox_cell_size_desc desc = vox_default_cell_size_desc();
    desc.model = models[_i];
    const vox_cell_size_result a = suggest_ok(&desc, one.meshes, 2), b = suggest_ok(&desc, other.meshes, 2);
    ck_assert_double_eq_tol(b.cell_size / 1024, a.cell_size, 1e-4 * a.cell_size); /* as near as is searched */
    ck_assert_double_eq_tol(b.cost, a.cost, 1e-4 * a.cost);
    free_pair(&one);
    free_pair(&other);
}
END_TEST

START_TEST(self_collision_counts) {
    pair p = make_pair(0.5f);
    vox_cell_size_desc desc = vox_default_cell_size_desc();
    desc.model = models[_i];
    const vox_cell_size_result apart = suggest_ok(&desc, p.meshes, 1);
    p.meshes[0].filter.flags = VOX_FILTER_SELF_COLLISION;
    const vox_cell_size_result self = suggest_ok(&desc, p.meshes, 1);
    if (models[_i] == VOX_COST_MODEL_PAPER || models[_i] == VOX_COST_MODEL_SURFACE)
        ck_assert_double_eq(self.cost, apart.cost);
    else
        ck_assert_double_gt(self.cost, apart.cost);
    free_pair(&p);
}
END_TEST

/* Dense storage: a byte budget makes the cells larger; one sliver does not make them smaller. */
START_TEST(byte_budget_caps_the_cells) {
    pair p = make_pair(0.5f);
    vox_cell_size_desc desc = vox_default_cell_size_desc();
    desc.model = VOX_COST_MODEL_REFERENCE;
    desc.reference_flags = VOX_REFERENCE_DENSE;
    const vox_cell_size_result free_choice = suggest_ok(&desc, p.meshes, 2);
    ck_assert_double_eq(free_choice.min_cell_size, 0);
    desc.byte_budget = 4 * 100; /* a hundred cells */
    const vox_cell_size_result capped = suggest_ok(&desc, p.meshes, 2);
    ck_assert_double_gt(capped.cell_size, free_choice.cell_size);
    ck_assert_double_ge(capped.cell_size, capped.min_cell_size);
    ck_assert_double_ge(capped.zone_min, capped.min_cell_size);
    const vox_geometry stats = geometry_of(p.meshes, 2);
    double cells = 1;
    for (int axis = 0; axis < 3; ++axis)
        cells *= ceil((stats.bounds_max[axis] - stats.bounds_min[axis]) / capped.cell_size);
    ck_assert_double_le(cells, 100);
    free_pair(&p);
}
END_TEST

START_TEST(a_sliver_does_not_matter) {
    pair p = make_pair(0.5f);
    vox_cell_size_desc desc = vox_default_cell_size_desc();
    desc.model = models[_i];
    const vox_cell_size_result without = suggest_ok(&desc, p.meshes, 2);
    /* One tet of the first box reaches a thousand edges out. */
    p.boxes[0].positions[0] = -500;
    const vox_cell_size_result with = suggest_ok(&desc, p.meshes, 2);
    ck_assert_double_gt(with.cell_size, 0.5 * without.cell_size);
    ck_assert_double_lt(with.cell_size, 2 * without.cell_size);
    free_pair(&p);
}
END_TEST

/* The longest side of the box of all. */
static double world_of(const vox_cell_size_result* found) { return found->cells_per_axis * found->cell_size; }

/* ---- the grid --------------------------------------------------------------------------------- */

START_TEST(the_grid_suggests_by_its_engine) {
    pair p = make_pair(0.5f);
    vox_grid_desc grid_desc = vox_default_grid_desc();
    use_engine(&grid_desc, _i ? ENGINE_FAST : ENGINE_REFERENCE);
    vox_cell_size_result found, given;
    found.struct_size = given.struct_size = sizeof found;
    vox_grid* grid = grid_of(&grid_desc);
    ck_fails(vox_grid_suggest_cell_size(grid, NULL, &found), VOX_ERROR_INVALID_ARGUMENT, "no tetrahedra");
    for (int b = 0; b < 2; ++b) insert_mesh(grid, &p.meshes[b]);
    ck_ok(vox_grid_suggest_cell_size(grid, NULL, &found));
    vox_cell_size_desc desc = vox_default_cell_size_desc();
    desc.model = _i ? VOX_COST_MODEL_FAST : VOX_COST_MODEL_REFERENCE;
    given = suggest_ok(&desc, p.meshes, 2);
    /* A grid is quick about it: from a sample, but not far off. */
    ck_assert_double_ge(found.cell_size, given.zone_min);
    ck_assert_double_le(found.cell_size, given.zone_max);
    ck_assert_double_eq_tol(found.cost, given.cost, 0.5 * given.cost);
    ck_assert_uint_eq(found.rule_count, given.rule_count);
    for (uint32_t i = 0; i < found.rule_count; ++i)
        ck_assert_double_eq_tol(found.rules[i].cell_size, given.rules[i].cell_size,
                                0.05 * given.rules[i].cell_size);
    ck_assert_double_eq_tol(world_of(&found), world_of(&given), 1e-12 * world_of(&given)); /* it is exact */

    /* The paper's model hears of the share of tets without contact from the last step. */
    desc.model = VOX_COST_MODEL_PAPER;
    ck_ok(vox_grid_step(grid));
    ck_ok(vox_grid_suggest_cell_size(grid, &desc, &found));
    given = suggest_ok(&desc, p.meshes, 2);
    ck_assert_double_lt(found.cell_size, given.cell_size);
    desc.p_nc = 0.9;
    ck_ok(vox_grid_suggest_cell_size(grid, &desc, &found));
    given = suggest_ok(&desc, p.meshes, 2);
    ck_assert_double_eq_tol(found.cell_size, given.cell_size, 0.05 * given.cell_size);

    ck_fails(vox_grid_suggest_cell_size(NULL, NULL, &found), VOX_ERROR_INVALID_ARGUMENT, "grid is null");
    vox_mesh_desc no_positions = p.meshes[0];
    no_positions.positions.data = NULL;
    insert_mesh(grid, &no_positions);
    ck_fails(vox_grid_suggest_cell_size(grid, NULL, &found), VOX_ERROR_INVALID_STATE, "no positions");
    vox_grid_destroy(grid);
    free_pair(&p);
}
END_TEST

static double term(const vox_cell_size_result* s, const char* name) {
    for (uint32_t i = 0; i < s->term_count; ++i)
        if (strcmp(s->terms[i].name, name) == 0) return s->terms[i].count;
    ck_abort_msg("no term %s", name);
    return 0;
}

/* The fast engine does nothing for bodies at rest, and the suggestion knows it from the last step. */
START_TEST(bodies_at_rest_cost_nothing) {
    pair p = make_pair(0.5f);
    vox_cell_size_result moving, resting;
    moving.struct_size = resting.struct_size = sizeof moving;
    vox_grid* grid = grid_of(NULL);
    for (int b = 0; b < 2; ++b) insert_mesh(grid, &p.meshes[b]);
    ck_ok(vox_grid_step(grid));
    ck_ok(vox_grid_suggest_cell_size(grid, NULL, &moving));
    ck_assert_double_gt(term(&moving, "visit a row"), 0);
    for (int i = 0; i < 3; ++i) ck_ok(vox_grid_step(grid));
    ck_assert_uint_eq(counters_of(grid).moved_bodies, 0);
    ck_ok(vox_grid_suggest_cell_size(grid, NULL, &resting));
    ck_assert_double_eq(resting.cost, 0);
    ck_assert_double_gt(resting.cell_size, 0);
    p.boxes[0].positions[0] += 0.01f;
    ck_ok(vox_grid_step(grid));
    ck_ok(vox_grid_suggest_cell_size(grid, NULL, &resting));
    ck_assert_double_eq_tol(term(&resting, "bin a vertex"), (double)counters_of(grid).entries, 0.5);
    vox_grid_destroy(grid);
    free_pair(&p);
}
END_TEST

/* A grid's suggestion looks at positions as they are now, also where the last step found others. */
START_TEST(a_grid_suggests_for_positions_as_they_are) {
    for (int m = 0; m < 3; ++m) {
        pair p = make_pair(0.5f);
        vox_cell_size_desc desc = vox_default_cell_size_desc();
        desc.model = models[m];
        vox_cell_size_result moved, fresh;
        moved.struct_size = fresh.struct_size = sizeof moved;
        vox_grid* grids[2] = {grid_of(NULL), grid_of(NULL)};
        for (int b = 0; b < 2; ++b) insert_mesh(grids[0], &p.meshes[b]);
        ck_ok(vox_grid_step(grids[0]));
        for (int b = 0; b < 2; ++b)
            for (uint32_t i = 0; i < 3 * p.boxes[b].vertex_count; ++i) p.boxes[b].positions[i] *= 4;
        for (int b = 0; b < 2; ++b) insert_mesh(grids[1], &p.meshes[b]);
        /* a share of tets without contact that no step can change */
        desc.p_nc = 0.9;
        ck_ok(vox_grid_suggest_cell_size(grids[0], &desc, &moved));
        ck_ok(vox_grid_suggest_cell_size(grids[1], &desc, &fresh));
        ck_assert_double_eq_tol(moved.cell_size, fresh.cell_size, 1e-3 * fresh.cell_size);
        ck_assert_double_eq_tol(moved.cells_per_axis, fresh.cells_per_axis, 1e-3 * fresh.cells_per_axis);
        ck_assert_double_eq(rule_size(&moved, "512"), rule_size(&fresh, "512"));
        for (int g = 0; g < 2; ++g) vox_grid_destroy(grids[g]);
        free_pair(&p);
    }
}
END_TEST

/* A vertex that no tetrahedron uses is outside of the geometry, wherever it lies: beyond the box of the
 * others, at an end of it, or inside. The first tetrahedra and vertices are those of the body without it. */
START_TEST(a_vertex_of_no_tetrahedron_is_no_part_of_the_box) {
    body box = make_box(12, 0.25f, 0, 0, 0); /* more tetrahedra than are measured in full */
    const vox_mesh_desc without = body_desc(&box);
    const vox_geometry box_alone = geometry_of(&without, 1);
    const uint32_t count = box.vertex_count;
    float* positions = (float*)malloc((count + 1) * 3 * sizeof *positions);
    memcpy(positions, box.positions, 3 * count * sizeof *positions);
    /* Beyond an end, at one (where others are as well), inside; the added vertex is the last one or the
     * first. */
    const float places[][3] = {{-100, 1, 1}, {1, 1, 100}, {3, 1, 1}, {0, 0, 0}, {1, 1, 1}};
    uint32_t* tets = (uint32_t*)malloc(4 * box.tet_count * sizeof *tets);
    for (int first = 0; first < 2; ++first)
        for (size_t i = 0; i < sizeof places / sizeof places[0]; ++i)
            for (int m = 0; m < 3; ++m) {
                memcpy(positions + (first ? 3 : 0), box.positions, 3 * count * sizeof *positions);
                memcpy(positions + (first ? 0 : 3 * count), places[i], sizeof places[i]);
                for (uint32_t c = 0; c < 4 * box.tet_count; ++c) tets[c] = box.tets[c] + (first ? 1u : 0u);
                vox_mesh_desc with = without;
                with.positions.data = positions;
                with.tets = tets;
                with.positions.count = count + 1;
                vox_cell_size_desc desc = vox_default_cell_size_desc();
                desc.model = models[m];
                const vox_cell_size_result given = suggest_ok(&desc, &without, 1),
                                           found = suggest_ok(&desc, &with, 1);
                vox_grid* grid = grid_of(NULL);
                insert_mesh(grid, &with);
                vox_cell_size_result of_grid;
                of_grid.struct_size = sizeof of_grid;
                ck_ok(vox_grid_suggest_cell_size(grid, &desc, &of_grid));
                const double world = world_of(&given);
                ck_assert_double_eq_tol(world_of(&found), world, 1e-12 * world);
                ck_assert_double_eq_tol(world_of(&of_grid), world, 1e-12 * world);
                ck_assert_double_eq(rule_size(&found, "512"), rule_size(&given, "512"));
                const vox_geometry stats = geometry_of(&with, 1);
                ck_assert_mem_eq(stats.bounds_min, box_alone.bounds_min, sizeof stats.bounds_min);
                ck_assert_mem_eq(stats.bounds_max, box_alone.bounds_max, sizeof stats.bounds_max);
                vox_grid_destroy(grid);
            }
    free(tets);
    free(positions);
    free_body(&box);
}
END_TEST

/* What is off counts for nothing; where all is, there is no size to suggest. */
START_TEST(cut_bodies_are_what_is_left_of_them) {
    pair p = make_pair(0.5f);
    vox_grid_desc desc = vox_default_grid_desc();
    use_engine(&desc, _i ? ENGINE_FAST : ENGINE_REFERENCE);
    vox_body meshes[2];
    vox_cell_size_result whole, part;
    whole.struct_size = part.struct_size = sizeof whole;
    vox_grid* grid = grid_of(&desc);
    for (int b = 0; b < 2; ++b) ck_ok(vox_mesh_insert(grid, &p.meshes[b], &meshes[b]));
    ck_ok(vox_grid_suggest_cell_size(grid, NULL, &whole));
    const uint32_t count = p.boxes[0].tet_count;
    uint32_t* tets = (uint32_t*)malloc(count * sizeof *tets);
    for (uint32_t t = 0; t < count; ++t) tets[t] = t;
    ck_ok(vox_mesh_set_tets_enabled(grid, meshes[0], tets, count / 2, 0));
    ck_ok(vox_grid_suggest_cell_size(grid, NULL, &part));
    ck_assert_double_lt(part.cost, 0.9 * whole.cost);
    const double edge = rule_size(&whole, "mean edge");
    ck_assert_double_eq_tol(rule_size(&part, "mean edge"), edge, 0.1 * edge);
    ck_assert_double_gt(part.cell_size, 0.7 * whole.cell_size);
    ck_assert_double_lt(part.cell_size, 1.4 * whole.cell_size);
    ck_ok(vox_grid_step(grid));
    for (int b = 0; b < 2; ++b) ck_ok(vox_mesh_set_tets_enabled(grid, meshes[b], tets, count, 0));
    ck_fails(vox_grid_suggest_cell_size(grid, NULL, &part), VOX_ERROR_INVALID_ARGUMENT, "no tetrahedra");
    ck_ok(vox_grid_step(grid));
    free(tets);
    vox_grid_destroy(grid);
    free_pair(&p);
}
END_TEST

/* ---- sizes far apart -------------------------------------------------------------------------- */

static void remember(vox_log_level level, const char* text, void* user) {
    (void)level;
    strncat((char*)user, text, 255);
}

/* A coarse box and a fine one, edges 20 : 1: the reference engine takes several cell sizes, for less work and
 * the same contacts. */
START_TEST(several_cell_sizes_where_they_pay) {
    body boxes[2] = {make_box(10, 1, 0, 0, 0), make_box(16, 0.05f, 4.2f, 4.3f, 4.1f)};
    vox_grid_desc desc = vox_default_grid_desc();
    desc.reference = reference_with(_i ? VOX_REFERENCE_DENSE : 0u);
    char log[4096] = "";
    const vox_log log_lines = {remember, log};
    desc.log = &log_lines;
    vox_grid *several = NULL, *one = NULL;
    ck_ok(vox_grid_create(&desc, &several));
    vox_mesh_desc meshes[2];
    for (int b = 0; b < 2; ++b) meshes[b] = body_desc(&boxes[b]);
    vox_cell_size_desc suggest = vox_default_cell_size_desc();
    suggest.model = VOX_COST_MODEL_REFERENCE;
    suggest.reference_flags = desc.reference->flags;
    const vox_cell_size_result found = suggest_ok(&suggest, meshes, 2);
    desc.cell_size = found.cell_size;
    ck_ok(vox_grid_create(&desc, &one));
    for (int b = 0; b < 2; ++b) {
        vox_body mesh = insert_mesh(several, &meshes[b]);
        ck_ok(vox_mesh_insert(one, &meshes[b], &mesh));
    }
    ck_ok(vox_grid_step(several));
    ck_ok(vox_grid_step(one));
    uint64_t hash = 0, expected = 1;
    ck_ok(vox_grid_get_hash(several, &hash));
    ck_ok(vox_grid_get_hash(one, &expected));
    ck_assert_uint_eq(hash, expected);
    const grid_counts with = counters_of(several), without = counters_of(one);
    ck_assert_uint_gt(with.contacts, 0);
    ck_assert_uint_eq(with.candidates, without.candidates);
    ck_assert_uint_eq(with.entries % without.entries, 0);
    ck_assert_uint_ge(with.entries / without.entries, 2);
    ck_assert_uint_lt(10 * with.visited_cells + with.visited_entries,
                      (10 * without.visited_cells + without.visited_entries) * 8 / 10);
    /* The grid tells the smallest of its sizes. */
    ck_assert_double_lt(grid_info(several).cell_size, 0.5 * found.cell_size);
    ck_assert_ptr_nonnull(strstr(log, "chosen for"));
    ck_assert_ptr_nonnull(strstr(log, ", ")); /* all sizes */
    vox_grid_destroy(several);
    vox_grid_destroy(one);
    for (int b = 0; b < 2; ++b) free_body(&boxes[b]);
}
END_TEST

static const float outlier_reach[] = {5e5f, 1e30f};

/* One tetrahedron a million times longer than the others, or out to 1e30: a grid that chooses its cells does
 * neither explode in memory nor in work, and finds what another one finds. */
START_TEST(an_outlier_does_not_explode_the_grid) {
    const int storage = _i / 2 % 3;
    pair p = make_pair(0.5f);
    p.boxes[0].positions[0] = -outlier_reach[_i % 2]; /* a corner: of few tetrahedra */
    vox_grid_desc desc = vox_default_grid_desc();
    desc.reference = storage == 2 ? NULL : reference_with(storage == 1 ? VOX_REFERENCE_DENSE : 0u);
    desc.byte_budget = 16 << 20;
    vox_grid *chosen = NULL, *fixed = NULL;
    ck_ok(vox_grid_create(&desc, &chosen));
    use_engine(&desc, ENGINE_REFERENCE);
    desc.cell_size = 0.7;
    ck_ok(vox_grid_create(&desc, &fixed));
    for (int b = 0; b < 2; ++b) {
        p.meshes[b].filter.flags = VOX_FILTER_SELF_COLLISION;
        vox_body mesh = insert_mesh(chosen, &p.meshes[b]);
        ck_ok(vox_mesh_insert(fixed, &p.meshes[b], &mesh));
    }
    ck_ok(vox_grid_step(fixed));
    for (int i = 0; i < 3; ++i) {
        ck_ok(vox_grid_step(chosen));
        uint64_t hash = 0, expected = 1;
        ck_ok(vox_grid_get_hash(chosen, &hash));
        ck_ok(vox_grid_get_hash(fixed, &expected));
        ck_assert_uint_eq(hash, expected);
        const grid_counts counters = counters_of(chosen);
        ck_assert_uint_le(counters.peak_bytes, desc.byte_budget);
        ck_assert_uint_lt(counters.visited_cells, 200 * counters.tets);
        /* Dense storage may have to lay everything into one cell: all vertices for each tetrahedron, no more.
         */
        ck_assert_uint_le(counters.visited_entries, counters.tets * counters.vertices);
        if (storage != 1) ck_assert_uint_lt(counters.visited_entries, 500 * counters.tets);
    }
    vox_grid_destroy(chosen);
    vox_grid_destroy(fixed);
    free_pair(&p);
}
END_TEST

static uint64_t changes_of(const vox_grid* grid) { return counters_of(grid).cell_size_changes; }

/* The bodies grow threefold step by step: the cells grow with them, and the contacts are those of a grid with
 * a fixed cell size. At rest nothing changes. */
START_TEST(the_grid_follows_its_bodies) {
    pair p = make_pair(0.5f);
    vox_grid_desc desc = vox_default_grid_desc();
    use_engine(&desc, ENGINE_REFERENCE);
    vox_grid *grid = NULL, *fixed = NULL;
    ck_ok(vox_grid_create(&desc, &grid));
    desc.cell_size = 0.7;
    ck_ok(vox_grid_create(&desc, &fixed));
    for (int b = 0; b < 2; ++b) {
        vox_body mesh = insert_mesh(grid, &p.meshes[b]);
        ck_ok(vox_mesh_insert(fixed, &p.meshes[b], &mesh));
    }
    for (int step = 0; step < 10; ++step) ck_ok(vox_grid_step(grid));
    ck_assert_uint_eq(changes_of(grid), 0);
    double first = 0, last = 0;
    first = grid_info(grid).cell_size;
    for (int step = 0; step < 60; ++step) {
        for (int b = 0; b < 2; ++b)
            for (uint32_t i = 0; i < 3 * p.boxes[b].vertex_count; ++i)
                p.boxes[b].positions[i] *= 1.01848f; /* the 60th root of 3 */
        uint64_t hash = 0, expected = 1;
        ck_ok(vox_grid_step(grid));
        ck_ok(vox_grid_step(fixed));
        ck_ok(vox_grid_get_hash(grid, &hash));
        ck_ok(vox_grid_get_hash(fixed, &expected));
        ck_assert_uint_eq(hash, expected);
    }
    last = grid_info(grid).cell_size;
    ck_assert_double_gt(last / first, 2.5);
    ck_assert_double_lt(last / first, 3.5);
    ck_assert_uint_ge(changes_of(grid), 3);
    ck_assert_uint_le(changes_of(grid), 30); /* 3 % or more each: two steps or more */
    vox_grid_destroy(grid);
    vox_grid_destroy(fixed);
    free_pair(&p);
}
END_TEST

/* ---- weights ---------------------------------------------------------------------------------- */

START_TEST(weights_are_plain_numbers) {
    vox_cost_weights measured = {.struct_size = sizeof measured}, given = measured;
    ck_ok(vox_cost_calibrate(&measured));
    ck_assert_uint_eq(measured.measured, 1);
    uint32_t count = 0;
    while (count < VOX_COST_WEIGHT_CAPACITY && measured.ns[count] > 0) ++count;
    ck_assert_uint_gt(count, 10);
    for (uint32_t i = count; i < VOX_COST_WEIGHT_CAPACITY; ++i) ck_assert_double_eq(measured.ns[i], 0);

    /* 0 stands for the shipped one; each of the reference engine's counts, and nothing outlives the call. */
    pair p = make_pair(0.5f);
    vox_cell_size_desc desc = vox_default_cell_size_desc();
    desc.model = VOX_COST_MODEL_REFERENCE;
    const vox_cell_size_result shipped = suggest_ok(&desc, p.meshes, 2);
    desc.weights = &given;
    ck_assert_double_eq(suggest_ok(&desc, p.meshes, 2).cost, shipped.cost);
    uint32_t changed = 0, changed_fast = 0;
    for (uint32_t i = 0; i < count; ++i) {
        given = (vox_cost_weights){.struct_size = sizeof given};
        given.ns[i] = 8 * measured.ns[i];
        desc.model = VOX_COST_MODEL_REFERENCE;
        const double cost = suggest_ok(&desc, p.meshes, 2).cost;
        changed += cost != shipped.cost;
        desc.model = VOX_COST_MODEL_FAST;
        changed_fast += suggest_ok(&desc, p.meshes, 2).cost != cost;
    }
    ck_assert_uint_ge(changed, 8);
    ck_assert_uint_gt(changed_fast, 0);
    desc.model = VOX_COST_MODEL_REFERENCE;
    given = measured;
    const double before = suggest_ok(&desc, p.meshes, 2).cell_size;
    given.ns[2] *= 8; /* a visit is expensive: larger cells */
    given.ns[8] *= 8;
    ck_assert_double_gt(suggest_ok(&desc, p.meshes, 2).cell_size, 1.2 * before);
    const vox_cost_weights expensive_visits = given;

    /* Weights are nanoseconds, and costs seconds. */
    for (uint32_t i = 0; i < VOX_COST_WEIGHT_CAPACITY; ++i) given.ns[i] = 1;
    for (int m = VOX_COST_MODEL_REFERENCE; m <= VOX_COST_MODEL_FAST; ++m) {
        desc.model = (vox_cost_model)m;
        const vox_cell_size_result counted = suggest_ok(&desc, p.meshes, 2);
        double counts = 0;
        for (uint32_t i = 0; i < counted.term_count; ++i) counts += counted.terms[i].count;
        ck_assert_double_eq_tol(counted.cost, 1e-9 * counts, 1e-18 * counts);
    }
    desc.model = VOX_COST_MODEL_REFERENCE;

    /* A grid's reference engine has its own. */
    vox_grid_desc of_grid = vox_default_grid_desc();
    vox_reference_desc reference = vox_default_reference_desc();
    of_grid.reference = &reference;
    double sizes[2];
    for (int own = 0; own < 2; ++own) {
        reference.weights = own ? &expensive_visits : &measured;
        vox_grid* grid = grid_of(&of_grid);
        for (int b = 0; b < 2; ++b) (void)insert_mesh(grid, &p.meshes[b]);
        vox_cell_size_result found = {.struct_size = sizeof found};
        ck_ok(vox_grid_suggest_cell_size(grid, NULL, &found));
        sizes[own] = found.cell_size;
        ck_ok(vox_grid_step(grid));
        ck_assert_double_gt(grid_info(grid).cell_size, 0);
        vox_grid_destroy(grid);
    }
    ck_assert_double_gt(sizes[1], 1.1 * sizes[0]);

    vox_cell_size_result found = {.struct_size = sizeof found};
    desc.weights = NULL;
    ck_assert_double_eq(suggest_ok(&desc, p.meshes, 2).cost, shipped.cost);
    const double bad[] = {-1, NAN, INFINITY};
    for (int i = 0; i < 3; ++i) {
        given.ns[3] = bad[i];
        desc.weights = &given;
        ck_fails(vox_suggest_cell_size(&desc, p.meshes, 2, &found), VOX_ERROR_INVALID_ARGUMENT,
                 "weights.ns[3] is ");
        vox_grid* grid = NULL;
        reference.weights = &given;
        ck_fails(vox_grid_create(&of_grid, &grid), VOX_ERROR_INVALID_ARGUMENT, "weights.ns[3] is ");
        ck_assert_ptr_null(grid);
    }
    ck_fails(vox_cost_calibrate(NULL), VOX_ERROR_INVALID_ARGUMENT, "out is null");
    free_pair(&p);
}
END_TEST

/* ---- the method for others -------------------------------------------------------------------- */

static double power_law(double d, void* user) {
    const double* c = (const double*)user;
    return c[0] / (d * d * d) + c[1] * d * d;
}

static double nowhere(double d, void* user) {
    (void)d;
    (void)user;
    return NAN;
}

static double negative(double d, void* user) {
    (void)user;
    return d - 2;
}

START_TEST(minimum_of_a_function) {
    const double c[2] = {3, 5}, min = 1e-3, max = 1e3;
    vox_cell_size_result found, wide;
    found.struct_size = wide.struct_size = sizeof found;
    ck_ok(vox_cost_minimise(power_law, (void*)c, min, max, 0, &found));
    const double expected = pow(1.5 * c[0] / c[1], 0.2);
    ck_assert_double_eq_tol(found.cell_size, expected, 1e-6);
    ck_assert_double_eq_tol(power_law(found.zone_min, (void*)c), 1.05 * found.cost, 1e-9);
    ck_assert_double_eq_tol(power_law(found.zone_max, (void*)c), 1.05 * found.cost, 1e-9);
    ck_assert_double_eq(found.cost, power_law(found.cell_size, (void*)c)); /* in the caller's unit */
    ck_assert_uint_eq(found.warnings | found.term_count | found.rule_count | found.timing_count, 0);
    ck_assert_uint_eq(found.curve_count, VOX_CURVE_CAPACITY);
    ck_assert_double_eq(found.curve[0].cell_size, min);
    ck_assert_double_eq(found.curve[found.curve_count - 1].cell_size, max);
    for (uint32_t i = 0; i < found.curve_count; ++i)
        ck_assert_double_eq(found.curve[i].cost, power_law(found.curve[i].cell_size, (void*)c));
    ck_ok(vox_cost_minimise(power_law, (void*)c, min, max, 0.2, &wide));
    ck_assert_double_eq(wide.cell_size, found.cell_size);
    ck_assert_double_eq_tol(power_law(wide.zone_max, (void*)c), 1.2 * found.cost, 1e-9);
}
END_TEST

START_TEST(bad_functions_and_bounds) {
    double c[2] = {1, 1};
    vox_cell_size_result out, before;
    memset(&out, 0x5a, sizeof out);
    out.struct_size = sizeof out;
    before = out;
    const vox_result argument = VOX_ERROR_INVALID_ARGUMENT;
    ck_fails(vox_cost_minimise(NULL, c, 0.5, 8, 0, &out), argument, "cost is null");
    ck_fails(vox_cost_minimise(power_law, c, 0.5, 8, 0, NULL), argument, "out is null");
    ck_fails(vox_cost_minimise(nowhere, NULL, 0.5, 8, 0, &out), argument, "no finite cost");
    ck_fails(vox_cost_minimise(negative, NULL, 0.5, 8, 0, &out), argument, "the cost is -1.5");
    const double bad[][2] = {{0, 1}, {-1, 1}, {2, 1}, {1, INFINITY}, {NAN, 1}, {1, NAN}};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; ++i)
        ck_fails(vox_cost_minimise(power_law, c, bad[i][0], bad[i][1], 0, &out), argument,
                 "expected 0 < min <= max");
    ck_fails(vox_cost_minimise(power_law, c, 0.5, 8, -1, &out), argument, "zone_loss is -1");
    ck_fails(vox_cost_minimise(power_law, c, 0.5, 8, NAN, &out), argument, "zone_loss is");
    ck_assert_mem_eq(&out, &before, sizeof out);
}
END_TEST

SUITE(cell_size_models) {
    TCase* tests = add_case(suite, "suggest_models");
    tcase_add_loop_test(tests, a_suggestion_explains_itself, 0, 4);
    tcase_add_loop_test(tests, units_do_not_matter, 0, 4);
    tcase_add_loop_test(tests, self_collision_counts, 0, 4);
    tcase_add_test(tests, byte_budget_caps_the_cells);
    tcase_add_loop_test(tests, a_sliver_does_not_matter, 0, 3);
    tcase_add_loop_test(tests, the_grid_suggests_by_its_engine, 0, 2);
    tcase_add_test(tests, bodies_at_rest_cost_nothing);
    tcase_add_test(tests, a_grid_suggests_for_positions_as_they_are);
    tcase_add_test(tests, a_vertex_of_no_tetrahedron_is_no_part_of_the_box);
    tcase_add_loop_test(tests, cut_bodies_are_what_is_left_of_them, 0, 2);
    tcase_add_loop_test(tests, several_cell_sizes_where_they_pay, 0, 2);
    tcase_add_loop_test(tests, an_outlier_does_not_explode_the_grid, 0, 6);
    tcase_add_each(tests, the_grid_follows_its_bodies, weights_are_plain_numbers, minimum_of_a_function,
                   bad_functions_and_bounds);
}
