/* What rigid shapes cost: a floor under a ball, at several depths, beside a slab of five tetrahedra in its
 * place; round tools, the worst there are, as all triangles are about as far from the middle, and a blade, at
 * many places in the ball. Prints Markdown tables; times are the least of many steps.
 *
 *     bench_shapes [half]     cells from the middle of the ball to its surface; 25 makes 316,160 tetrahedra
 */
#include "scenes/bodies.h"
#include "scenes/counters.h"
#include "timing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { rounds = 15 };

static void must_(vox_result result) {
    if (result == VOX_OK) return;
    fprintf(stderr, "%s\n", vox_last_error());
    exit(EXIT_FAILURE);
}

typedef struct cost {
    double step, shapes, constraints; /* seconds */
    uint64_t found;
} cost;

/* The least of some steps in which the ball moves. */
static cost cost_of(vox_grid* grid, vox_body ball) {
    cost least = {INFINITY, INFINITY, INFINITY, 0};
    for (int round = 0; round < rounds; ++round) {
        vox_constraint_view found;
        must_(vox_body_mark_moved(grid, ball));
        const double start = now();
        must_(vox_grid_step(grid));
        least.step = fmin(least.step, now() - start);
        least.shapes = fmin(least.shapes, 1e-9 * (double)counter_of(grid, "shapes_ns"));
        least.constraints = fmin(least.constraints, 1e-9 * (double)(counter_of(grid, "constraints_ns") +
                                                                    counter_of(grid, "depth_ns")));
        must_(vox_grid_get_constraints(grid, &found));
        least.found = found.count;
    }
    return least;
}

static vox_grid* grid_with(uint32_t flags, const body* ball, vox_body* id) {
    vox_grid_desc desc = vox_default_grid_desc();
    const vox_mesh_desc mesh = body_desc(ball);
    vox_grid* grid = NULL;
    desc.flags = VOX_GRID_CONSTRAINTS | flags;
    must_(vox_grid_create(&desc, &grid));
    must_(vox_mesh_insert(grid, &mesh, id));
    return grid;
}

static void place(vox_grid* grid, vox_body id, double x, double z) {
    const double at[12] = {1, 0, 0, x, 0, 1, 0, 0, 0, 0, 1, z};
    must_(vox_body_set_transform(grid, id, at));
}

static void time_floors(const body* ball, double half) {
    const double parts[] = {-0.1, 0.02, 0.1, 0.3, 0.5};
    printf("| floor | vertices in it | finding, a vertex outside | finding, a vertex inside | with its "
           "constraint | slab |\n"
           "|---|---:|---:|---:|---:|---:|\n");
    for (size_t i = 0; i < sizeof parts / sizeof *parts; ++i) {
        const double z = -half + 2 * half * parts[i];
        vox_body id, floor, under;
        vox_grid* grid = grid_with(0, ball, &id);
        vox_shape_desc desc = vox_default_shape_desc();
        desc.kind = VOX_SHAPE_HALF_SPACE;
        must_(vox_shape_insert(grid, &desc, &floor));
        place(grid, floor, 0, z);
        const cost found = cost_of(grid, id);
        vox_grid_destroy(grid);
        grid = grid_with(0, ball, &id);
        const cost alone = cost_of(grid, id);
        body slab = make_block(&five_cut, 1, 1, 1);
        for (uint32_t v = 0; v < slab.vertex_count; ++v)
            for (int k = 0; k < 3; ++k)
                slab.positions[3 * v + k] =
                    (float)(4 * half * ((double)slab.positions[3 * v + k] - (k < 2 ? 0.5 : 1)) +
                            (k < 2 ? 0 : z));
        const vox_mesh_desc mesh = body_desc(&slab);
        must_(vox_mesh_insert(grid, &mesh, &under));
        const cost of_slab = cost_of(grid, id);
        vox_grid_destroy(grid);
        free_body(&slab);
        const double n = (double)found.found;
        printf("| %.0f %% | %llu | ", 100 * parts[i], (unsigned long long)found.found);
        if (n < 0.01 * ball->vertex_count)
            printf("%.2f ns | - | - | - |\n", 1e9 * found.shapes / ball->vertex_count);
        else
            printf("- | %.1f ns | %.1f ns | %.0f ns |\n", 1e9 * found.shapes / n,
                   1e9 * (found.shapes + found.constraints) / n,
                   1e9 * (of_slab.step - alone.step) / (double)of_slab.found);
    }
}

/* A ball of triangles: an octahedron, divided. */
static vox_shape_desc make_tool(int divisions, double radius, double** positions, uint32_t** triangles) {
    const int n = divisions;
    const size_t count = 8 * (size_t)n * n;
    vox_shape_desc desc = vox_default_shape_desc();
    *positions = (double*)malloc(count * 9 * sizeof(double));
    *triangles = (uint32_t*)malloc(count * 3 * sizeof(uint32_t));
    uint32_t vertices = 0, corner = 0;
    for (int face = 0; face < 8; ++face)
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < 2 * (n - i) - 1; ++j)
                for (int c = 0; c < 3; ++c) {
                    const int down = j % 2, flip = (face & 1) ^ (face >> 1 & 1) ^ (face >> 2 & 1),
                              k = flip ? 2 - c : c;
                    const int u = j / 2 + (down ? (k != 2) : k == 1), v = i + (down ? (k != 0) : k == 2);
                    double p[3] = {(double)u, (double)v, (double)(n - u - v)};
                    const double length = sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
                    for (int axis = 0; axis < 3; ++axis)
                        p[axis] *= (face >> axis & 1 ? -radius : radius) / length;
                    uint32_t same = 0;
                    while (same < vertices && memcmp(*positions + 3 * same, p, sizeof p) != 0) {
                        const double* q = *positions + 3 * same;
                        if (fabs(q[0] - p[0]) + fabs(q[1] - p[1]) + fabs(q[2] - p[2]) < 1e-12 * radius) break;
                        ++same;
                    }
                    if (same == vertices) memcpy(*positions + 3 * vertices++, p, sizeof p);
                    (*triangles)[corner++] = same;
                }
    desc.kind = VOX_SHAPE_SOLID;
    desc.positions = vox_double_positions(*positions, vertices);
    desc.triangles = *triangles;
    desc.triangle_count = corner / 3;
    return desc;
}

static void time_tools(const body* ball, double half) {
    printf("\n| tool | triangles | found, mean | step, mean | without it |\n|---|---:|---:|---:|---:|\n");
    enum { tool_ball, large_ball, blade_at_rest, blade_that_moves, kinds };
    static const char* const names[kinds] = {"a ball", "a large ball", "a blade, edges",
                                             "a blade that moves, edges and impacts"};
    for (int kind = 0; kind < kinds; ++kind) {
        const int is_blade = kind >= blade_at_rest;
        vox_body id, tool;
        vox_grid* grid = grid_with(is_blade ? VOX_GRID_EDGES : 0, ball, &id);
        const cost alone = cost_of(grid, id);
        double *positions = NULL, edge = 0.8 * half,
               blade[12] = {0, -edge, 0, 0, edge, 0, 0, edge, 2 * half, 0, -edge, 2 * half};
        uint32_t *triangles = NULL, two[6] = {0, 1, 2, 0, 2, 3};
        vox_shape_desc desc = make_tool(kind == large_ball ? 60 : 11, (kind == large_ball ? 0.6 : 0.3) * half,
                                        &positions, &triangles);
        if (is_blade) {
            desc.kind = VOX_SHAPE_SHEET;
            desc.positions = vox_double_positions(blade, 4);
            desc.triangles = two;
            desc.triangle_count = 2;
        }
        must_(vox_shape_insert(grid, &desc, &tool));
        double step = 0, found = 0;
        enum { places = 20 };
        for (int i = 0; i < places; ++i) {
            const double x = half * (2 * (i + 0.5) / places - 1),
                         before[12] = {1, 0, 0, x - 0.05 * half, 0, 1, 0, 0, 0, 0, 1, 0.9 * half};
            place(grid, tool, x, is_blade ? 0 : 0.9 * half);
            if (kind == blade_that_moves) must_(vox_shape_set_previous_transform(grid, tool, before));
            const cost here = cost_of(grid, id);
            step += here.step / places;
            found += (double)here.found / places;
        }
        printf("| %s | %llu | %.0f | %.3f ms | %.3f ms |\n", names[kind],
               (unsigned long long)desc.triangle_count, found, 1e3 * step, 1e3 * alone.step);
        free(positions);
        free(triangles);
        vox_grid_destroy(grid);
    }
}

int main(int argc, char** argv) {
    const uint32_t half = argc > 1 ? (uint32_t)strtoul(argv[1], NULL, 10) : 25;
    body ball = make_lattice_ball(&five_cut, half, half - 0.3);
    printf("%u tetrahedra, %u vertices\n\n", ball.tet_count, ball.vertex_count);
    time_floors(&ball, half);
    time_tools(&ball, half);
    free_body(&ball);
    return 0;
}
