/* The best cell size of a grid that is not vox's, in three ways: from what it stores, from three timings, and
 * by running it. The grid puts boxes into all cells that they meet; then each box looks at its cells for
 * others that it overlaps. */
#include <vox/vox_cell_size.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

/* ---- the grid --------------------------------------------------------------------------------- */

enum {
    count = 3000,
    most_along = 160,
    most_cells = most_along * most_along * most_along,
    most_entries = 1 << 22
};

static float boxes[count][2][3];  /* opposite corners, in a cube of side 1 */
static int begin[most_cells + 2]; /* where the list of each cell begins in `list` */
static int list[most_entries];
static vox_foreign_counts done; /* what the last run did */
static int overlaps;

static int cell_of(float x, double d) { return (int)(x / d); }

/* For each cell that a box meets. */
#define for_cells(box, d, x, y, z)                                                                           \
    for (int z = cell_of(boxes[box][0][2], d); z <= cell_of(boxes[box][1][2], d); ++z)                       \
        for (int y = cell_of(boxes[box][0][1], d); y <= cell_of(boxes[box][1][1], d); ++y)                   \
            for (int x = cell_of(boxes[box][0][0], d); x <= cell_of(boxes[box][1][0], d); ++x)

static int larger(int a, int b) { return a > b ? a : b; }

/* Whether two boxes overlap, and this is the lowest cell that both meet: so each pair is counted once. */
static int counts_here(int i, int j, double d, const int cell[3]) {
    for (int k = 0; k < 3; ++k) {
        if (boxes[i][0][k] > boxes[j][1][k] || boxes[j][0][k] > boxes[i][1][k]) return 0;
        if (larger(cell_of(boxes[i][0][k], d), cell_of(boxes[j][0][k], d)) != cell[k]) return 0;
    }
    return i < j;
}

/* A whole run. 0: it cannot be done with cells as small as these. */
static int run(double d) {
    if (!(d * most_along > 1.001)) return 0;
    const int n = (int)(1 / d) + 1;
    for (int c = 0; c <= n * n * n + 1; ++c) begin[c] = 0;
    for (int i = 0; i < count; ++i) /* how many there are in each cell, */
        for_cells(i, d, x, y, z)++ begin[(z * n + y) * n + x + 2];
    for (int c = 2; c <= n * n * n + 1; ++c) begin[c] += begin[c - 1];
    if (begin[n * n * n + 1] > most_entries) return 0;
    for (int i = 0; i < count; ++i) /* and which */
        for_cells(i, d, x, y, z) list[begin[(z * n + y) * n + x + 1]++] = i;

    done.stored = begin[n * n * n];
    done.visits = done.reads = overlaps = 0;
    for (int i = 0; i < count; ++i) for_cells(i, d, x, y, z) {
            const int c = (z * n + y) * n + x, cell[3] = {x, y, z};
            ++done.visits;
            done.reads += begin[c + 1] - begin[c];
            for (int at = begin[c]; at < begin[c + 1]; ++at) overlaps += counts_here(i, list[at], d, cell);
        }
    return 1;
}

/* Seconds of a run, of as many as a coarse clock needs. */
static double seconds_of(double d, void* user) {
    (void)user;
    const clock_t start = clock();
    for (int runs = 1;; ++runs) {
        if (!run(d)) return INFINITY;
        const double taken = (double)(clock() - start) / CLOCKS_PER_SEC;
        if (taken >= 0.02) return taken / runs;
    }
}

/* ---- its cell size ---------------------------------------------------------------------------- */

static void must(vox_result result) {
    if (result == VOX_OK) return;
    fprintf(stderr, "%s\n", vox_last_error());
    exit(EXIT_FAILURE);
}

static int near(double predicted, double counted) {
    return predicted < 1.1 * counted && predicted > 0.9 * counted;
}

int main(void) {
    unsigned state = 1;
    for (int i = 0; i < count; ++i)
        for (int k = 0; k < 3; ++k) {
            float random[2];
            for (int r = 0; r < 2; ++r)
                random[r] = (float)((state = state * 1664525u + 1013904223u) >> 8) / (1 << 24);
            const float side = 0.02f + 0.03f * random[0];
            boxes[i][0][k] = (1 - side) * random[1];
            boxes[i][1][k] = boxes[i][0][k] + side;
        }

    /* What it is like. */
    vox_primitives stored = vox_default_primitives();
    stored.type = VOX_PRIMITIVE_BOX;
    stored.positions = vox_float_positions(boxes[0][0], 2 * count);
    stored.count = count;
    vox_foreign_grid grid = vox_default_foreign_grid();
    grid.known = VOX_KNOWN_GRID_SORTED; /* boxes in cells, a dense lattice */
    grid.stored = &stored;

    vox_cell_size_result from_boxes;
    from_boxes.struct_size = sizeof from_boxes;
    must(vox_foreign_grid_suggest(&grid, &from_boxes));
    printf("described: %.4f, good from %.4f to %.4f\n", from_boxes.cell_size, from_boxes.zone_min,
           from_boxes.zone_max);

    /* What it does at some cell sizes, beside what vox says. */
    int found = -1;
    for (double d = 0.01; d < 0.2; d *= 1.7) {
        vox_foreign_counts counts;
        must(vox_foreign_grid_count(&grid, d, &counts));
        if (!run(d) || !near(counts.stored, done.stored) || !near(counts.visits, done.visits) ||
            !near(counts.reads, done.reads) || (found >= 0 && overlaps != found)) {
            printf("at %.4f: %.0f visits, %.0f predicted; %.0f reads, %.0f predicted; %d overlaps\n", d,
                   done.visits, counts.visits, done.reads, counts.reads, overlaps);
            return 1;
        }
        found = overlaps;
    }

    /* Three timings. The weights that they lead to hold for other boxes, too. */
    const double edge = from_boxes.rules[0].cell_size; /* the mean edge */
    vox_timing timings[3] = {{0.6 * edge, 0}, {1.2 * edge, 0}, {2.4 * edge, 0}};
    for (int i = 0; i < 3; ++i) timings[i].seconds = seconds_of(timings[i].cell_size, NULL);
    vox_cell_size_result fit;
    fit.struct_size = sizeof fit;
    must(vox_foreign_grid_fit(&grid, timings, 3, &fit));
    printf("fitted: %.4f, %.3g ms a run\n", fit.cell_size, 1e3 * fit.cost);

    /* Runs where vox wants them. */
    vox_cell_size_result tuned;
    tuned.struct_size = sizeof tuned;
    must(vox_foreign_grid_tune(&grid, NULL, seconds_of, NULL, &tuned));
    printf("tuned in %u runs: %.4f, %.3g ms a run, at most about %.0f %% more than the best\n",
           tuned.timing_count, tuned.cell_size, 1e3 * tuned.cost, 100 * tuned.expected_loss);
    printf("%d overlaps at every cell size, and what runs do as predicted within 10 %%\n", found);
    return 0;
}
