/* The cell size of grids that are not this library's: what is described, what is answered, every bad argument
 * with its code and a text with numbers, and answers with a warning where there is no best size. */
#include "scenes/random.h"
#include "support/ledger.h"
#include "support/suggest_scenes.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#define SIDE 12 /* boxes along an axis */
#define COUNT (SIDE * SIDE * SIDE)

static float corners[COUNT][2][3]; /* of overlapping boxes, irregularly placed */

static vox_primitives boxes(void) {
    uint64_t random = 1;
    for (int i = 0; i < COUNT; ++i)
        for (int a = 0; a < 3; ++a) {
            const int cell = a == 0 ? i % SIDE : a == 1 ? i / SIDE % SIDE : i / SIDE / SIDE;
            corners[i][0][a] = (float)(cell + random_unit(&random));
            corners[i][1][a] = corners[i][0][a] + (float)(1 + 0.5 * random_unit(&random));
        }
    vox_primitives primitives = vox_default_primitives();
    primitives.type = VOX_PRIMITIVE_BOX;
    primitives.positions.data = corners;
    primitives.positions.count = 2 * COUNT;
    primitives.count = COUNT;
    return primitives;
}

static vox_foreign_grid with_stored(const vox_primitives* stored) {
    vox_foreign_grid grid = vox_default_foreign_grid();
    grid.stored = stored;
    return grid;
}

static vox_cell_size_result suggest(const vox_foreign_grid* grid) {
    vox_cell_size_result found;
    found.struct_size = sizeof found;
    ck_assert_msg(vox_foreign_grid_suggest(grid, &found) == VOX_OK, "%s", vox_last_error());
    ck_assert_double_gt(found.cell_size, 0);
    ck_assert(isfinite(found.cell_size) && isfinite(found.cost));
    ck_assert_double_le(found.zone_min, found.cell_size);
    ck_assert_double_ge(found.zone_max, found.cell_size);
    return found;
}

static vox_foreign_counts count(const vox_foreign_grid* grid, double cell_size) {
    vox_foreign_counts work;
    ck_assert_msg(vox_foreign_grid_count(grid, cell_size, &work) == VOX_OK, "%s", vox_last_error());
    return work;
}

static void fails(const vox_foreign_grid* grid, vox_result code, const char* words) {
    vox_cell_size_result out, before;
    memset(&out, 0x5a, sizeof out);
    out.struct_size = sizeof out;
    before = out;
    ck_fails(vox_foreign_grid_suggest(grid, &out), code, words);
    ck_assert_mem_eq(&out, &before, sizeof out);
}

/* ---- answers ---------------------------------------------------------------------------------- */

START_TEST(defaults) {
    const vox_foreign_grid grid = vox_default_foreign_grid();
    ck_assert_uint_eq(grid.struct_size, sizeof grid);
    ck_assert_int_eq(grid.cells_stored, VOX_CELLS_STORED_DEFAULT);
    ck_assert_int_eq(grid.cells_queried, VOX_CELLS_QUERIED_DEFAULT);
    ck_assert_int_eq(grid.cells_kept, VOX_CELLS_KEPT_DEFAULT);
    ck_assert_int_eq(grid.known, VOX_KNOWN_GRID_NONE);
    ck_assert_ptr_null(grid.stored);
    const vox_primitives primitives = vox_default_primitives();
    ck_assert_int_eq(primitives.type, VOX_PRIMITIVE_POINT);
    ck_assert_double_eq(primitives.radius, 0);
}
END_TEST

/* Everything in an answer fits together. */
START_TEST(an_answer_has_its_reasons) {
    const vox_primitives stored = boxes();
    vox_foreign_grid grid = with_stored(&stored);
    grid.known = VOX_KNOWN_GRID_HASHED;
    const vox_cell_size_result found = suggest(&grid);
    ck_assert_uint_eq(found.warnings, 0);
    ck_assert_str_eq(found.note, "");
    ck_assert_double_eq(found.min_cell_size, 0);
    ck_assert_uint_eq(found.timing_count, 0);
    double sum = 0;
    for (uint32_t t = 0; t < found.term_count; ++t) sum += found.terms[t].cost;
    ck_assert_uint_gt(found.term_count, 3);
    ck_assert_double_eq_tol(sum, found.cost, 1e-3 * sum);
    ck_assert_uint_eq(found.curve_count, VOX_CURVE_CAPACITY);
    for (uint32_t i = 0; i < found.curve_count; ++i) {
        ck_assert_double_ge(found.curve[i].cost, found.cost);
        if (i > 0) ck_assert_double_gt(found.curve[i].cell_size, found.curve[i - 1].cell_size);
    }
    ck_assert_double_gt(rule_size(&found, "mean box side"), 1.1);
    ck_assert_double_lt(rule_size(&found, "median box side"), 1.5);
    ck_assert_double_ge(rule_of(&found, "mean box side").cost, 0.999 * found.cost);
    /* A rule that does not apply is there, too. */
    ck_assert_uint_eq(found.rule_count, 5);
    ck_assert_double_eq(rule_of(&found, "mean radius").cell_size, 0);
    ck_assert_double_eq(rule_of(&found, "mean radius").cost, 0);
    /* Weights are nanoseconds, and costs seconds. */
    const vox_foreign_counts real = count(&grid, found.cell_size);
    const vox_foreign_weights* w = &found.weights;
    ck_assert_double_gt(w->store, 0);
    const double seconds = 1e-9 * (w->run + w->store * real.stored + w->visit * real.visits +
                                   w->found * (real.visits - real.empty) + w->read * real.reads +
                                   w->occupied * real.occupied + w->cell * real.cells);
    ck_assert_double_eq_tol(found.cost, seconds, 0.1 * seconds);
}
END_TEST

/* The same boxes in any form: doubles, apart, in columns, as indexed edges, as points with a radius. */
START_TEST(primitives_in_any_form) {
    static double doubles[COUNT][2][4], columns[3][2 * COUNT];
    static uint32_t indices[COUNT][3];
    const vox_primitives floats = boxes();
    for (uint32_t i = 0; i < COUNT; ++i)
        for (uint32_t c = 0; c < 2; ++c) {
            indices[i][c] = 2 * i + 1 - c;
            for (int a = 0; a < 3; ++a) doubles[i][c][a] = columns[a][2 * i + c] = (double)corners[i][c][a];
        }
    vox_foreign_grid grid = with_stored(&floats);
    const vox_foreign_counts wanted = count(&grid, 1.3);
    vox_primitives other = floats;
    other.positions.data = doubles;
    other.positions.format = VOX_FORMAT_DOUBLE;
    other.positions.byte_stride = sizeof doubles[0][0];
    grid.stored = &other;
    vox_foreign_counts work = count(&grid, 1.3);
    ck_assert_double_eq_tol(work.reads, wanted.reads, 1e-6 * wanted.reads);
    ck_assert_double_eq_tol(work.stored, wanted.stored, 1e-5 * wanted.stored);
    other.positions.data = columns;
    other.positions.byte_stride = 0;
    other.positions.component_byte_stride = sizeof columns[0];
    work = count(&grid, 1.3);
    ck_assert_double_eq_tol(work.reads, wanted.reads, 1e-6 * wanted.reads);
    other = floats;
    other.type = VOX_PRIMITIVE_EDGE;
    other.indices = indices[0];
    other.index_byte_stride = sizeof indices[0];
    work = count(&grid, 1.3);
    ck_assert_double_eq_tol(work.reads, wanted.reads, 1e-6 * wanted.reads);
    vox_cell_size_result found = suggest(&grid);
    ck_assert_double_gt(rule_size(&found, "mean edge"), 1.5);

    /* A point with a radius is a box. */
    static double centres[COUNT][3];
    static float radii[COUNT];
    for (int i = 0; i < COUNT; ++i) {
        radii[i] = 0.25f + 0.001f * (float)(i % 100);
        for (int a = 0; a < 3; ++a) {
            centres[i][a] = (double)corners[i][0][a];
            doubles[i][0][a] = centres[i][a] - (double)radii[i] - 0.125;
            doubles[i][1][a] = centres[i][a] + (double)radii[i] + 0.125;
        }
    }
    other = floats;
    other.positions.data = doubles;
    other.positions.format = VOX_FORMAT_DOUBLE;
    other.positions.byte_stride = sizeof doubles[0][0];
    const vox_foreign_counts as_boxes = count(&grid, 0.9);
    vox_primitives balls = vox_default_primitives();
    balls.positions.data = centres;
    balls.positions.format = VOX_FORMAT_DOUBLE;
    balls.positions.count = balls.count = COUNT;
    balls.radii = radii;
    balls.radius = 0.125;
    grid.stored = &balls;
    work = count(&grid, 0.9);
    ck_assert_double_eq_tol(work.stored, as_boxes.stored, 1e-9 * as_boxes.stored);
    ck_assert_double_eq_tol(work.reads, as_boxes.reads, 1e-9 * as_boxes.reads);
    found = suggest(&grid);
    ck_assert_double_eq_tol(rule_size(&found, "mean radius"), 0.4245, 0.01);
}
END_TEST

/* With 27 cells around, min_cell_size is that of all boxes, however many there are and wherever the
 * largest is. */
START_TEST(the_least_size_is_exact) {
    enum { many = 300000 };
    static float points[2 * many][3];
    uint64_t random = 1;
    for (int i = 0; i < 2 * many; ++i)
        for (int a = 0; a < 3; ++a)
            points[i][a] = i % 2 == 0 ? (float)(100 * random_unit(&random))
                                      : points[i - 1][a] + (float)random_unit(&random);
    points[2 * 123457 + 1][1] = points[2 * 123457][1] + 7;
    vox_primitives stored = vox_default_primitives();
    stored.type = VOX_PRIMITIVE_BOX;
    stored.positions.data = points;
    stored.positions.count = 2 * many;
    stored.count = many;
    vox_foreign_grid grid = with_stored(&stored);
    grid.known = VOX_KNOWN_GRID_PBAT;
    vox_cell_size_result found = suggest(&grid);
    ck_assert_double_eq_tol(found.min_cell_size, 7, 1e-5);
    ck_assert_double_ge(found.cell_size, found.min_cell_size);
    ck_assert_double_ge(found.zone_min, found.min_cell_size);
    ck_assert_uint_ne(found.warnings & VOX_CELL_SIZE_AT_MINIMUM, 0);
    ck_assert_ptr_nonnull(strstr(found.note, "7 is the smallest cell size that gives right answers"));
    grid.radius = 0.5; /* of the boxes of queries */
    ck_assert_double_eq_tol(suggest(&grid).min_cell_size, 7.5, 1e-5);
    grid.min_cell_size = 0.25; /* the caller knows better */
    ck_assert_double_eq(suggest(&grid).min_cell_size, 0.25);
    vox_primitives querying = vox_default_primitives();
    querying.positions.data = points;
    querying.positions.count = querying.count = 1000;
    grid.querying = &querying;
    grid.min_cell_size = grid.radius = 0;
    ck_assert_double_eq_tol(suggest(&grid).min_cell_size, 3.5, 1e-5);
}
END_TEST

static void same_counts(const vox_foreign_grid* a, const vox_foreign_grid* b) {
    const vox_foreign_counts of_a = count(a, 1.25), of_b = count(b, 1.25);
    ck_assert_mem_eq(&of_a, &of_b, sizeof of_a);
}

static const struct {
    vox_known_grid known;
    vox_cells_stored stored;
    vox_cells_queried queried;
    vox_cells_kept kept;
} layouts[] = {
    {VOX_KNOWN_GRID_NONE, VOX_CELLS_STORED_BOX, VOX_CELLS_QUERIED_BOX, VOX_CELLS_KEPT_OCCUPIED},
    {VOX_KNOWN_GRID_SORTED, VOX_CELLS_STORED_BOX, VOX_CELLS_QUERIED_BOX, VOX_CELLS_KEPT_DENSE},
    {VOX_KNOWN_GRID_HASHED, VOX_CELLS_STORED_BOX, VOX_CELLS_QUERIED_BOX, VOX_CELLS_KEPT_OCCUPIED},
    {VOX_KNOWN_GRID_WARP, VOX_CELLS_STORED_CENTRE, VOX_CELLS_QUERIED_BOX, VOX_CELLS_KEPT_OCCUPIED},
    {VOX_KNOWN_GRID_IPC, VOX_CELLS_STORED_BOX, VOX_CELLS_QUERIED_BOX, VOX_CELLS_KEPT_OCCUPIED},
    {VOX_KNOWN_GRID_IPC_PAIRS, VOX_CELLS_STORED_BOX, VOX_CELLS_QUERIED_PAIRS, VOX_CELLS_KEPT_OCCUPIED},
    {VOX_KNOWN_GRID_VTK, VOX_CELLS_STORED_BOX, VOX_CELLS_QUERIED_BOX, VOX_CELLS_KEPT_DENSE},
    {VOX_KNOWN_GRID_PBAT, VOX_CELLS_STORED_CENTRE, VOX_CELLS_QUERIED_27, VOX_CELLS_KEPT_OCCUPIED},
    {VOX_KNOWN_GRID_POINT_VOXELS, VOX_CELLS_STORED_CENTRE, VOX_CELLS_QUERIED_BOX, VOX_CELLS_KEPT_OCCUPIED},
    {VOX_KNOWN_GRID_NUMPY, VOX_CELLS_STORED_BOX, VOX_CELLS_QUERIED_BOX, VOX_CELLS_KEPT_OCCUPIED},
};
enum { layout_count = sizeof layouts / sizeof layouts[0] };

/* Fields left at DEFAULT follow the known grid; others, and weights, say how another one differs from it. */
START_TEST(defaults_follow_the_known_grid) {
    vox_primitives stored = boxes();
    stored.count = 2 * SIDE * SIDE;
    vox_foreign_grid known = with_stored(&stored), described = with_stored(&stored);
    known.radius = described.radius = 0.5;
    known.known = layouts[_i].known;
    const vox_cell_size_result found = suggest(&known);
    ck_assert_int_eq((found.warnings & VOX_CELL_SIZE_GUESSED_WEIGHTS) != 0, _i == 0);
    ck_assert_double_gt(found.cell_size, 0.05);
    ck_assert_double_lt(found.cell_size, 10);

    described.cells_stored = layouts[_i].stored;
    described.cells_queried = layouts[_i].queried;
    described.cells_kept = layouts[_i].kept;
    same_counts(&known, &described);
    described.weights = found.weights;
    const vox_cell_size_result same = suggest(&described);
    if (_i > 0) ck_assert_double_eq(same.cell_size, found.cell_size);
    ck_assert_uint_eq(same.warnings & VOX_CELL_SIZE_GUESSED_WEIGHTS, 0);
    ck_assert_mem_eq(&same.weights, &found.weights, sizeof found.weights);

    /* Only dense grids clear cells. */
    known.weights = found.weights;
    known.weights.cell = 7;
    ck_assert_double_eq(suggest(&known).weights.cell, layouts[_i].kept == VOX_CELLS_KEPT_DENSE ? 7 : 0);
    /* What is set is not that of the known grid. */
    known.cells_kept = VOX_CELLS_KEPT_OCCUPIED;
    ck_assert_double_eq(suggest(&known).weights.cell, 0);
    known.cells_kept = VOX_CELLS_KEPT_DENSE;
    ck_assert_double_eq(suggest(&known).weights.cell, 7);
    known.cells_stored = VOX_CELLS_STORED_CENTRE;
    known.cells_queried = VOX_CELLS_QUERIED_BOX;
    const vox_foreign_counts work = count(&known, 3);
    ck_assert_double_eq(work.stored, 2 * SIDE * SIDE);
    ck_assert_double_lt(work.visits, 27 * work.stored);
}
END_TEST

/* Nobody queries: all pairs within a cell, or those of one of either set. */
START_TEST(pairs_of_one_set_or_two) {
    static const float place[3] = {1, 2, 3};
    static uint32_t zeros[50];
    vox_primitives stored = vox_default_primitives(), second;
    stored.positions.data = place;
    stored.positions.count = 1;
    stored.indices = zeros;
    stored.count = 50;
    second = stored;
    second.count = 7;
    vox_foreign_grid grid = with_stored(&stored);
    grid.cells_queried = VOX_CELLS_QUERIED_PAIRS;
    vox_foreign_counts work = count(&grid, 1);
    ck_assert_double_eq(work.stored, 50);
    ck_assert_double_eq(work.reads, 50 * 49 / 2);
    grid.querying = &second;
    work = count(&grid, 1);
    ck_assert_double_eq(work.stored, 50 + 7); /* both are in cells */
    ck_assert_double_eq(work.reads, 50 * 7);
    ck_assert_double_eq(work.visits, 1);
    ck_assert_double_eq(work.empty, 0);
    grid.cells_queried = VOX_CELLS_QUERIED_BOX;
    work = count(&grid, 1);
    ck_assert_double_eq(work.stored, 50);
    ck_assert_double_eq(work.visits, 7);
    ck_assert_double_eq(work.reads, 50 * 7);
}
END_TEST

/* ---- no best size ----------------------------------------------------------------------------- */

START_TEST(one_primitive) {
    vox_primitives stored = boxes();
    stored.count = 1;
    const vox_foreign_grid grid = with_stored(&stored);
    const vox_cell_size_result found = suggest(&grid);
    ck_assert_uint_ne(found.warnings & VOX_CELL_SIZE_ONE_PLACE, 0);
    ck_assert_double_gt(found.cell_size, 1);
}
END_TEST

START_TEST(all_in_one_place) {
    static const float place[3] = {1, 2, 3};
    static uint32_t zeros[50];
    vox_primitives stored = vox_default_primitives();
    stored.positions.data = place;
    stored.positions.count = 1;
    stored.indices = zeros;
    stored.count = 50;
    vox_foreign_grid grid = with_stored(&stored);
    for (int known = VOX_KNOWN_GRID_NONE; known <= VOX_KNOWN_GRID_NUMPY; ++known) {
        grid.known = (vox_known_grid)known;
        const vox_cell_size_result found = suggest(&grid);
        ck_assert_uint_ne(found.warnings & VOX_CELL_SIZE_ONE_PLACE, 0);
        ck_assert_ptr_nonnull(strstr(found.note, "in one place"));
        const vox_foreign_counts work = count(&grid, found.cell_size);
        ck_assert_double_eq(work.occupied, 1);
        ck_assert_double_eq(work.stored, 50);
        const vox_foreign_counts tiny = count(&grid, 1e-300); /* far below the rounding of the positions */
        ck_assert_double_eq(tiny.occupied, 1);
        ck_assert_double_eq(tiny.stored, 50);
    }
}
END_TEST

START_TEST(points_that_query_points) {
    vox_primitives stored = boxes();
    stored.type = VOX_PRIMITIVE_POINT;
    stored.count = 2 * COUNT;
    const vox_foreign_grid grid = with_stored(&stored);
    const vox_cell_size_result found = suggest(&grid);
    ck_assert_uint_ne(found.warnings & VOX_CELL_SIZE_FROM_SPACING, 0);
    ck_assert_ptr_nonnull(strstr(found.note, "no primitive has a size"));
    const double spacing = rule_size(&found, "spacing");
    ck_assert_double_gt(found.cell_size, spacing / 8); /* cells of a few points each */
    ck_assert_double_lt(found.cell_size, spacing * 8);
}
END_TEST

static double least_of_curve(const vox_cell_size_result* found) {
    double least = found->curve[0].cost;
    for (uint32_t i = 1; i < found->curve_count; ++i)
        if (found->curve[i].cost < least) least = found->curve[i].cost;
    return least;
}

/* Times that are a guess: the mean edge where the gain over it is in doubt, else the least cost. In a dense
 * grid that is where it is in the zone, of 5 %; in another one where the gain is below 16 %. */
START_TEST(a_guess_prefers_the_mean_edge) {
    vox_primitives stored = boxes();
    stored.type = VOX_PRIMITIVE_EDGE;
    const double doubt = _i ? 1.05 : 1.16;
    int by_rule = 0, beyond_zone = 0;
    for (int i = 0; i < 40; ++i) {
        stored.radius = 0.02 * i; /* boxes grow, their edges do not */
        vox_foreign_grid grid = with_stored(&stored);
        if (_i) grid.cells_kept = VOX_CELLS_KEPT_DENSE;
        const vox_cell_size_result found = suggest(&grid);
        const vox_cell_size_rule edge = rule_of(&found, "mean edge");
        const int is_edge = (found.warnings & VOX_CELL_SIZE_BY_RULE) != 0;
        ck_assert_int_eq(strstr(found.note, "mean edge") != NULL, is_edge);
        ck_assert_double_le(found.zone_min, found.cell_size);
        ck_assert_double_ge(found.zone_max, found.cell_size);
        if (is_edge) {
            const double least = least_of_curve(&found);
            ck_assert_double_eq(found.cell_size, edge.cell_size);
            ck_assert_double_le(found.cost, doubt * 1.000001 * least);
            beyond_zone += found.cost > 1.06 * least;
        } else
            ck_assert_double_ge(edge.cost, doubt * 0.999999 * found.cost);
        by_rule += is_edge;
        grid.known = VOX_KNOWN_GRID_IPC;
        ck_assert_uint_eq(suggest(&grid).warnings & VOX_CELL_SIZE_BY_RULE, 0);
    }
    ck_assert_int_gt(by_rule, 0);
    ck_assert_int_lt(by_rule, 40);
    ck_assert_int_eq(beyond_zone > 0, _i == 0);
}
END_TEST

/* Its mean edge is so small that no run with it could be counted. */
START_TEST(a_rule_far_from_any_run) {
    static const double both[4][3] = {{0, 0, 0}, {1e-200, 1e-200, 1e-200}, {1, 1, 1}, {1, 1, 1}};
    vox_primitives stored = vox_default_primitives();
    stored.type = VOX_PRIMITIVE_BOX;
    stored.positions = vox_double_positions(both[0], 4);
    stored.count = 2;
    stored.radius = 0.25;
    const vox_foreign_grid grid = with_stored(&stored);
    const vox_cell_size_result found = suggest(&grid);
    const vox_cell_size_rule edge = rule_of(&found, "mean edge");
    ck_assert_double_gt(edge.cell_size, 0);
    ck_assert_double_lt(edge.cell_size, 1e-199);
    ck_assert_double_eq(edge.cost, 0);
    ck_assert_double_gt(rule_of(&found, "mean box side").cost, 0);
}
END_TEST

START_TEST(sizes_from_one_to_a_million) {
    static float wide[COUNT][2][3];
    uint64_t random = 1;
    for (int i = 0; i < COUNT; ++i) {
        const float size = powf(10, -6 * (float)i / COUNT);
        for (int a = 0; a < 3; ++a) {
            wide[i][0][a] = (float)random_unit(&random) * size;
            wide[i][1][a] = wide[i][0][a] + size;
        }
    }
    vox_primitives stored = boxes();
    stored.positions.data = wide;
    for (int known = VOX_KNOWN_GRID_NONE; known <= VOX_KNOWN_GRID_NUMPY; ++known) {
        vox_foreign_grid grid = with_stored(&stored);
        grid.radius = 1e-4;
        grid.known = (vox_known_grid)known;
        (void)suggest(&grid);
    }
    /* As far from 1 as floats go. */
    for (int scale = -1; scale <= 1; scale += 2) {
        for (int i = 0; i < COUNT; ++i)
            for (int a = 0; a < 6; ++a)
                wide[i][a / 3][a % 3] = corners[i][a / 3][a % 3] * (scale < 0 ? 1e-30f : 1e30f);
        vox_foreign_grid grid = with_stored(&stored);
        const double unscaled = suggest(&grid).cell_size / (scale < 0 ? 1e-30 : 1e30);
        const vox_primitives plain = boxes();
        grid.stored = &plain;
        ck_assert_double_eq_tol(unscaled, suggest(&grid).cell_size, 0.1);
    }
}
END_TEST

/* ---- bad arguments ---------------------------------------------------------------------------- */

START_TEST(bad_numbers) {
    static const struct {
        size_t offset;
        double value;
        const char* words;
    } bad[] = {
        {offsetof(vox_foreign_grid, radius), -1, "radius is -1,"},
        {offsetof(vox_foreign_grid, radius), NAN, "radius is nan,"},
        {offsetof(vox_foreign_grid, min_cell_size), -2, "min_cell_size is -2,"},
        {offsetof(vox_foreign_grid, min_cell_size), INFINITY, "min_cell_size is inf,"},
        {offsetof(vox_foreign_grid, zone_loss), -0.5, "zone_loss is -0.5,"},
        {offsetof(vox_foreign_grid, weights.store), -3, "weights.store is -3,"},
        {offsetof(vox_foreign_grid, weights.read), NAN, "weights.read is nan,"},
        {offsetof(vox_foreign_grid, weights.cell), INFINITY, "weights.cell is inf,"},
    };
    const vox_primitives stored = boxes();
    for (size_t i = 0; i < sizeof bad / sizeof *bad; ++i) {
        vox_foreign_grid grid = with_stored(&stored);
        memcpy((char*)&grid + bad[i].offset, &bad[i].value, sizeof(double));
        fails(&grid, VOX_ERROR_INVALID_ARGUMENT, bad[i].words);
    }
    const vox_foreign_grid grid = with_stored(&stored);
    vox_foreign_counts work;
    ck_fails(vox_foreign_grid_count(&grid, 0, &work), VOX_ERROR_INVALID_ARGUMENT, "cell_size is 0,");
    ck_fails(vox_foreign_grid_count(&grid, -1, &work), VOX_ERROR_INVALID_ARGUMENT, "cell_size is -1,");
    ck_fails(vox_foreign_grid_count(&grid, NAN, &work), VOX_ERROR_INVALID_ARGUMENT, "cell_size is nan,");
    ck_fails(vox_foreign_grid_count(&grid, 1e-200, &work), VOX_ERROR_LIMIT, "cell_size is 1e-200, so small");
    ck_assert_double_gt(count(&grid, 1e-24).stored, 1e70);
    ck_fails(vox_foreign_grid_count(&grid, 1, NULL), VOX_ERROR_INVALID_ARGUMENT, "out is null");
    ck_fails(vox_foreign_grid_count(NULL, 1, &work), VOX_ERROR_INVALID_ARGUMENT, "grid is null");
}
END_TEST

START_TEST(bad_grids) {
    static const struct {
        size_t offset;
        int value;
        const char* words;
    } bad[] = {
        {offsetof(vox_foreign_grid, cells_stored), 3, "cells_stored is 3,"},
        {offsetof(vox_foreign_grid, cells_stored), -1, "cells_stored is -1,"},
        {offsetof(vox_foreign_grid, cells_queried), 4, "cells_queried is 4,"},
        {offsetof(vox_foreign_grid, cells_kept), 3, "cells_kept is 3,"},
        {offsetof(vox_foreign_grid, known), 10, "known is 10,"},
        {offsetof(vox_foreign_grid, reserved), 5, "reserved is 5,"},
        /* 27 without CENTRE */
        {offsetof(vox_foreign_grid, cells_queried), VOX_CELLS_QUERIED_27, "cells_queried is 27"},
    };
    const vox_primitives stored = boxes();
    vox_foreign_grid grid;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; ++i) {
        grid = with_stored(&stored);
        memcpy((char*)&grid + bad[i].offset, &bad[i].value, sizeof bad[i].value);
        fails(&grid, VOX_ERROR_INVALID_ARGUMENT, bad[i].words);
    }
    grid = with_stored(&stored);
    grid.known = VOX_KNOWN_GRID_PBAT; /* 27 */
    grid.cells_stored = VOX_CELLS_STORED_BOX;
    fails(&grid, VOX_ERROR_INVALID_ARGUMENT, "cells_queried is 27");
    grid = with_stored(NULL);
    fails(&grid, VOX_ERROR_INVALID_ARGUMENT, "grid.stored is null");
    fails(NULL, VOX_ERROR_INVALID_ARGUMENT, "grid is null");
    grid = with_stored(&stored);
    ck_fails(vox_foreign_grid_suggest(&grid, NULL), VOX_ERROR_INVALID_ARGUMENT, "out is null");
}
END_TEST

/* As stored primitives, and as queries. */
static void primitives_fail(const vox_primitives* bad, vox_result code, const char* words) {
    char named[200];
    const vox_primitives good = boxes();
    for (int querying = 0; querying < 2; ++querying) {
        vox_foreign_grid grid = with_stored(querying ? &good : bad);
        if (querying) grid.querying = bad;
        snprintf(named, sizeof named, "%s: %s", querying ? "querying" : "stored", words);
        fails(&grid, code, named);
    }
}

START_TEST(bad_primitives) {
    static uint32_t indices[COUNT][2];
    for (uint32_t i = 0; i < COUNT; ++i) {
        indices[i][0] = 2 * i;
        indices[i][1] = 2 * i + 1;
    }
    vox_primitives p = boxes();
    p.count = 0;
    primitives_fail(&p, VOX_ERROR_INVALID_ARGUMENT, "count is 0,");
    p.count = UINT64_C(1) << 32;
    primitives_fail(&p, VOX_ERROR_LIMIT, "count is 4294967296,");
    p.count = COUNT + 1;
    primitives_fail(&p, VOX_ERROR_INVALID_MESH,
                    "1729 primitives of 2 vertices each, but positions.count is 3456");
    p = boxes();
    p.positions.data = NULL;
    primitives_fail(&p, VOX_ERROR_INVALID_ARGUMENT, "positions.data is null");
    p = boxes();
    const int far_off = 5;
    memcpy(&p.type, &far_off, sizeof far_off);
    primitives_fail(&p, VOX_ERROR_INVALID_ARGUMENT, "type is 5,");
    p = boxes();
    memcpy(&p.positions.format, &far_off, sizeof far_off);
    primitives_fail(&p, VOX_ERROR_INVALID_ARGUMENT, "positions.format is 5,");
    p = boxes();
    memcpy(&p.radius_format, &far_off, sizeof far_off);
    primitives_fail(&p, VOX_ERROR_INVALID_ARGUMENT, "radius_format is 5,");
    p = boxes();
    p.positions.byte_stride = 8;
    primitives_fail(&p, VOX_ERROR_INVALID_ARGUMENT, "positions.byte_stride is 8,");
    p = boxes();
    p.indices = indices[0];
    p.index_byte_stride = 4;
    primitives_fail(&p, VOX_ERROR_INVALID_ARGUMENT, "index_byte_stride is 4, expected 0 or at least 8");
    p.index_byte_stride = UINT64_MAX / 2;
    primitives_fail(&p, VOX_ERROR_INVALID_ARGUMENT,
                    "index_byte_stride is 9223372036854775807, too large for 1728 primitives");
    p.index_byte_stride = 0;
    indices[100][1] = 2 * COUNT;
    primitives_fail(&p, VOX_ERROR_INVALID_MESH, "primitive 100 names vertex 3456 of 3456");
    indices[100][1] = 201;
    corners[30][1][2] = NAN;
    p.positions.data = corners;
    {
        const vox_foreign_grid grid = with_stored(&p);
        fails(&grid, VOX_ERROR_NON_FINITE, "stored: primitive 30 has vertex 61 at");
    }
    p = boxes();
    p.radius = -1;
    primitives_fail(&p, VOX_ERROR_INVALID_ARGUMENT, "radius is -1,");
    static float radii[COUNT];
    p = boxes();
    p.radii = radii;
    p.radius_byte_stride = 2;
    primitives_fail(&p, VOX_ERROR_INVALID_ARGUMENT, "radius_byte_stride is 2, expected 0 or at least 4");
    p.radius_byte_stride = 0;
    radii[77] = -2;
    primitives_fail(&p, VOX_ERROR_INVALID_ARGUMENT, "radius 77 is -2,");
    radii[77] = INFINITY;
    primitives_fail(&p, VOX_ERROR_NON_FINITE, "radius 77 is inf,");
    static double large[2][3];
    large[1][1] = 1e39;
    p = boxes();
    p.positions = vox_double_positions(large[0], 2);
    p.count = 1;
    primitives_fail(&p, VOX_ERROR_LIMIT, "primitive 0 has vertex 1 at (0, 1e+39, 0), too large");
}
END_TEST

/* An older program's struct is shorter: what it does not know keeps its default, and is not written. */
START_TEST(shorter_structs) {
    const vox_primitives stored = boxes();
    vox_foreign_grid grid = with_stored(&stored);
    grid.min_cell_size = 1000; /* not covered */
    grid.struct_size = offsetof(vox_foreign_grid, min_cell_size);
    vox_cell_size_result out;
    memset(&out, 0x5a, sizeof out);
    out.struct_size = offsetof(vox_cell_size_result, zone_max);
    ck_assert_int_eq(vox_foreign_grid_suggest(&grid, &out), VOX_OK);
    ck_assert_double_lt(out.cell_size, 10);
    unsigned char rest[sizeof out - offsetof(vox_cell_size_result, zone_max)];
    memset(rest, 0x5a, sizeof rest);
    ck_assert_mem_eq((char*)&out + offsetof(vox_cell_size_result, zone_max), rest, sizeof rest);
}
END_TEST

/* ---- memory ----------------------------------------------------------------------------------- */

START_TEST(memory_is_the_callers) {
    const vox_primitives stored = boxes();
    vox_foreign_grid grid = with_stored(&stored);
    grid.known = VOX_KNOWN_GRID_HASHED;
    const vox_cell_size_result wanted = suggest(&grid);
    ledger used = {0};
    grid.allocator = ledger_allocator(&used);
    const vox_cell_size_result found = suggest(&grid);
    ck_assert_double_eq(found.cell_size, wanted.cell_size);
    ck_assert_uint_gt(used.calls, 0);
    ck_assert_uint_eq(used.bytes, 0);
    const uint64_t calls = used.calls;
    for (uint64_t failing = 1; failing <= calls; failing += 3) { /* nothing is lost */
        ledger failed = {0};
        failed.fail_at = failing;
        grid.allocator = ledger_allocator(&failed);
        fails(&grid, VOX_ERROR_OUT_OF_MEMORY, "out of memory");
        ck_assert_uint_eq(failed.bytes, 0);
    }
    grid.allocator = ledger_allocator(&used);
    used.allocator.release = NULL;
    fails(&grid, VOX_ERROR_INVALID_ARGUMENT, "grid.allocator has one of allocate and release");
}
END_TEST

SUITE(foreign) {
    TCase* tests = add_case(suite, "foreign");
    tcase_add_test(tests, defaults);
    tcase_add_test(tests, an_answer_has_its_reasons);
    tcase_add_test(tests, primitives_in_any_form);
    tcase_add_test(tests, the_least_size_is_exact);
    tcase_add_loop_test(tests, defaults_follow_the_known_grid, 0, layout_count);
    tcase_add_test(tests, pairs_of_one_set_or_two);
    tcase_add_test(tests, one_primitive);
    tcase_add_test(tests, all_in_one_place);
    tcase_add_test(tests, points_that_query_points);
    tcase_add_loop_test(tests, a_guess_prefers_the_mean_edge, 0, 2);
    tcase_add_test(tests, a_rule_far_from_any_run);
    tcase_add_test(tests, sizes_from_one_to_a_million);
    tcase_add_test(tests, bad_numbers);
    tcase_add_test(tests, bad_grids);
    tcase_add_test(tests, bad_primitives);
    tcase_add_test(tests, shorter_structs);
    tcase_add_test(tests, memory_is_the_callers);
}
