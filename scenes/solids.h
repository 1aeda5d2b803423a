/* Bodies with positions in doubles, cut from the body-centred cubic lattice: around every face between two
 * cubes, four tetrahedra share the edge between the cubes' centres (e.g. Labelle, Shewchuk, "Isosurface
 * stuffing", SIGGRAPH 2007, Sect. 2). All of them are congruent and none is closer than 0.7 to being flat, so
 * that jitter up to 0.1 inverts none. Whoever makes a solid frees it. */
#ifndef VOX_SCENES_SOLIDS_H
#define VOX_SCENES_SOLIDS_H

#include "scenes/random.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct solid {
    double* positions; /* 3 * vertex_count */
    uint32_t* tets;    /* 4 * tet_count, all positive */
    uint32_t vertex_count;
    uint32_t tet_count;
} solid;

enum { solid_inner_degree = 24 }; /* tetrahedra around a vertex that is not on the boundary */

static inline void free_solid(solid* s) {
    free(s->positions);
    free(s->tets);
    s->positions = NULL;
    s->tets = NULL;
}

/* Without overflow, and the same on every machine, which hypot() need not give. */
static inline double vector_length(double x, double y, double z) {
    const double a = fabs(x), b = fabs(y), c = fabs(z);
    const double most = a < b ? (b < c ? c : b) : (a < c ? c : a);
    if (most == 0) return 0;
    return most * sqrt((a / most) * (a / most) + (b / most) * (b / most) + (c / most) * (c / most));
}

static inline double signed_volume(const solid* s, uint32_t tet) {
    const uint32_t* corner = s->tets + 4 * (size_t)tet;
    double e[3][3];
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
            e[i][k] = s->positions[3 * (size_t)corner[i + 1] + k] - s->positions[3 * (size_t)corner[0] + k];
    return (e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) -
            e[0][1] * (e[1][0] * e[2][2] - e[1][2] * e[2][0]) +
            e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0])) /
           6;
}

/* nx * ny * nz cubes of the lattice, with edge 1, from the origin on: 12 tetrahedra a cube inside. Tetrahedra
 * whose centroid is not within `radius` of the middle are left out, unless `radius` is 0. Every vertex is
 * moved by up to `jitter` on each axis. */
static inline solid make_lattice_solid(uint32_t nx, uint32_t ny, uint32_t nz, double radius, double jitter,
                                       uint64_t seed) {
    /* In half units: corners of cubes have three even coordinates, centres three odd ones. */
    static const int around[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    const int size[3] = {2 * (int)nx + 1, 2 * (int)ny + 1, 2 * (int)nz + 1};
    const size_t points = (size_t)size[0] * (size_t)size[1] * (size_t)size[2];
    const size_t most =
        12 * (size_t)nx * ny * nz; /* four a face between two cubes, three such faces a cube */
    solid s = {NULL, NULL, 0, 0};
    uint32_t* number = (uint32_t*)calloc(points, sizeof(uint32_t)); /* of every point of the lattice */
    s.tets = (uint32_t*)malloc(4 * sizeof(uint32_t) * (most + 1));
    int c[3];
    for (c[2] = 1; c[2] < size[2]; c[2] += 2)
        for (c[1] = 1; c[1] < size[1]; c[1] += 2)
            for (c[0] = 1; c[0] < size[0]; c[0] += 2)
                for (int axis = 0; axis < 3; ++axis)
                    for (int i = 0; i < 4 && c[axis] + 2 < size[axis]; ++i) {
                        int tet[4][3];
                        double sum[3] = {0, 0, 0};
                        for (int k = 0; k < 4; ++k) memcpy(tet[k], c, sizeof c);
                        tet[1][axis] += 2;
                        for (int k = 2; k < 4; ++k) {
                            tet[k][axis] += 1;
                            tet[k][(axis + 1) % 3] += around[(i + k - 2) % 4][0];
                            tet[k][(axis + 2) % 3] += around[(i + k - 2) % 4][1];
                        }
                        for (int k = 0; k < 12; ++k) sum[k % 3] += tet[k / 3][k % 3];
                        if (radius > 0 && !(vector_length(sum[0] / 8 - nx / 2.0, sum[1] / 8 - ny / 2.0,
                                                          sum[2] / 8 - nz / 2.0) < radius))
                            continue;
                        for (int k = 0; k < 4; ++k) {
                            const size_t point =
                                ((size_t)tet[k][2] * (size_t)size[1] + (size_t)tet[k][1]) * (size_t)size[0] +
                                (size_t)tet[k][0];
                            number[point] = 1;
                            s.tets[4 * (size_t)s.tet_count + (size_t)k] = (uint32_t)point;
                        }
                        ++s.tet_count;
                    }
    for (size_t i = 0; i < points; ++i) s.vertex_count += number[i];
    s.positions = (double*)malloc(3 * sizeof(double) * ((size_t)s.vertex_count + 1));
    uint32_t vertices = 0;
    for (size_t i = 0; i < points; ++i) {
        if (!number[i]) continue;
        double* p = s.positions + 3 * (size_t)vertices;
        p[0] = (double)(i % (size_t)size[0]) / 2;
        p[1] = (double)(i / (size_t)size[0] % (size_t)size[1]) / 2;
        p[2] = (double)(i / (size_t)size[0] / (size_t)size[1]) / 2;
        for (int k = 0; k < 3; ++k) p[k] += jitter * random_symmetric(&seed);
        number[i] = vertices++;
    }
    for (size_t i = 0; i < 4 * (size_t)s.tet_count; ++i) s.tets[i] = number[s.tets[i]];
    free(number);
    return s;
}

/* The radius of a ball of about `tets` tetrahedra. */
static inline double solid_ball_radius(double tets) {
    return cbrt(tets / 12 * 3 / (4 * 3.14159265358979323846));
}

/* Moves the vertices on the boundary onto a sphere around the origin, as far as no tetrahedron around them
 * gets too flat. */
static inline void round_solid(solid* s, double radius) {
    static const double parts[] = {1, 0.75, 0.5, 0.25, 0};
    const double least_volume = 0.25 / 12;
    /* The tetrahedra around vertex v are of[first[v]] .. of[first[v + 1] - 1]. */
    uint32_t* first = (uint32_t*)calloc((size_t)s->vertex_count + 2, sizeof(uint32_t));
    uint32_t* of = (uint32_t*)malloc(4 * sizeof(uint32_t) * ((size_t)s->tet_count + 1));
    for (size_t i = 0; i < 4 * (size_t)s->tet_count; ++i) ++first[s->tets[i] + 2];
    for (uint32_t v = 0; v < s->vertex_count; ++v) first[v + 2] += first[v + 1];
    for (uint32_t i = 0; i < 4 * s->tet_count; ++i) of[first[s->tets[i] + 1]++] = i / 4;
    for (uint32_t v = 0; v < s->vertex_count; ++v) {
        if (first[v + 1] - first[v] == solid_inner_degree) continue;
        double* p = s->positions + 3 * (size_t)v;
        const double x = p[0], y = p[1], z = p[2], factor = radius / vector_length(x, y, z) - 1;
        for (int part = 0, flat = 1; flat && part < 5; ++part) {
            const double scale = 1 + parts[part] * factor;
            p[0] = scale * x;
            p[1] = scale * y;
            p[2] = scale * z;
            flat = 0;
            for (uint32_t i = first[v]; i < first[v + 1] && !flat; ++i)
                flat = !(signed_volume(s, of[i]) > least_volume);
        }
    }
    free(first);
    free(of);
}

/* A ball of about `tets` tetrahedra around the origin. */
static inline solid make_solid_ball(double tets, uint64_t seed) {
    const double radius = solid_ball_radius(tets);
    const uint32_t n = 2 * (uint32_t)ceil(radius + 1);
    solid ball = make_lattice_solid(n, n, n, radius, 0.1, seed);
    for (size_t i = 0; i < 3 * (size_t)ball.vertex_count; ++i) ball.positions[i] -= n / 2.0;
    round_solid(&ball, radius);
    return ball;
}

#endif
