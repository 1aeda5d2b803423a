/* What must hold for every tet mesh that vox_io makes. */
#ifndef VOX_TESTS_SOLID_CHECKS_H
#define VOX_TESTS_SOLID_CHECKS_H

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <vox/vox_io.h>

#include "support/suite.h"

/* The bounds that Labelle and Shewchuk prove for the parameters that make the smallest angle largest. */
#define LEAST_DIHEDRAL 10.78
#define MOST_DIHEDRAL 164.75

typedef struct {
    double min_dihedral, max_dihedral, volume;
    uint64_t boundary_facets;
    uint64_t pinched_edges; /* of the boundary, of more than two facets */
    long long euler;        /* vertices - edges + facets of the boundary */
} solid_facts;

static vox_io_mesh_view solid_view(const vox_io_mesh* mesh) {
    vox_io_mesh_view view;
    ck_ok(vox_io_mesh_get_arrays(mesh, &view));
    return view;
}

static double solid_dot(const double* a, const double* b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/* The angle at the edge p-q between the facets that go on to r and to s, in degrees. */
static double solid_dihedral(const double* p, const double* q, const double* r, const double* s) {
    double e[3], a[3], b[3], cosine;
    for (int k = 0; k < 3; ++k) {
        e[k] = q[k] - p[k];
        a[k] = r[k] - p[k];
        b[k] = s[k] - p[k];
    }
    {
        const double along_a = solid_dot(a, e) / solid_dot(e, e), along_b = solid_dot(b, e) / solid_dot(e, e);
        for (int k = 0; k < 3; ++k) {
            a[k] -= along_a * e[k];
            b[k] -= along_b * e[k];
        }
    }
    cosine = solid_dot(a, b) / sqrt(solid_dot(a, a) * solid_dot(b, b));
    return acos(cosine < -1 ? -1 : cosine > 1 ? 1 : cosine) * 180 / 3.14159265358979323846;
}

static double solid_tet_volume(const double* a, const double* b, const double* c, const double* d) {
    double u[3], v[3], w[3];
    for (int k = 0; k < 3; ++k) {
        u[k] = b[k] - a[k];
        v[k] = c[k] - a[k];
        w[k] = d[k] - a[k];
    }
    return (u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2]) +
            u[2] * (v[0] * w[1] - v[1] * w[0])) /
           6;
}

static int solid_compare(const void* a, const void* b) {
    const uint32_t *p = a, *q = b;
    for (int k = 0; k < 3; ++k)
        if (p[k] != q[k]) return p[k] < q[k] ? -1 : 1;
    return 0;
}

static void solid_sort3(uint32_t* v) {
    uint32_t t;
    if (v[0] > v[1]) t = v[0], v[0] = v[1], v[1] = t;
    if (v[1] > v[2]) t = v[1], v[1] = v[2], v[2] = t;
    if (v[0] > v[1]) t = v[0], v[0] = v[1], v[1] = t;
}

/* Checks that every tet is positive, every vertex used, every facet of one tet or of two on different sides
 * of it, and the boundary closed. */
static solid_facts check_solid(const vox_io_mesh* mesh) {
    const vox_io_mesh_view view = solid_view(mesh);
    solid_facts facts = {180, 0, 0, 0, 0, 0};
    uint32_t(*facets)[4] = malloc((size_t)view.tet_count * 4 * sizeof *facets);
    unsigned char* used = calloc((size_t)view.vertex_count, 1);
    uint64_t edge_count = 0, boundary_vertices = 0, boundary_edges = 0;
    ck_assert_uint_gt(view.tet_count, 0);
    ck_assert(facets && used);
    for (uint64_t t = 0; t < view.tet_count; ++t) {
        const uint32_t* v = view.tets + 4 * t;
        const double* p[4];
        double volume;
        for (int k = 0; k < 4; ++k) {
            ck_assert_uint_lt(v[k], view.vertex_count);
            used[v[k]] = 1;
            p[k] = view.positions + 3 * (size_t)v[k];
        }
        volume = solid_tet_volume(p[0], p[1], p[2], p[3]);
        ck_assert_msg(volume > 0, "tet %llu has volume %g", (unsigned long long)t, volume);
        facts.volume += volume;
        for (int i = 0; i < 4; ++i)
            for (int j = i + 1; j < 4; ++j) {
                const int r = i != 0 && j != 0 ? 0 : i != 1 && j != 1 ? 1 : 2;
                const double angle = solid_dihedral(p[i], p[j], p[r], p[6 - i - j - r]);
                if (!(angle >= facts.min_dihedral)) facts.min_dihedral = angle;
                if (!(angle <= facts.max_dihedral)) facts.max_dihedral = angle;
            }
        for (int k = 0; k < 4; ++k) {
            uint32_t* facet = facets[4 * t + (uint64_t)k];
            for (int i = 0, n = 0; i < 4; ++i)
                if (i != k) facet[n++] = v[i];
            facet[3] = (uint32_t)t;
            solid_sort3(facet);
        }
    }
    for (uint64_t i = 0; i < view.vertex_count; ++i)
        ck_assert_msg(used[i], "vertex %llu unused", (unsigned long long)i);
    memset(used, 0, (size_t)view.vertex_count);
    qsort(facets, (size_t)view.tet_count * 4, sizeof *facets, solid_compare);
    for (uint64_t i = 0; i < view.tet_count * 4;) {
        uint64_t end = i + 1;
        while (end < view.tet_count * 4 && solid_compare(facets[i], facets[end]) == 0) ++end;
        ck_assert_msg(end - i <= 2, "facet %u %u %u of %llu tets", facets[i][0], facets[i][1], facets[i][2],
                      (unsigned long long)(end - i));
        if (end - i == 2) {
            /* The two corners across from the facet lie on different sides. */
            double side[2];
            for (int s = 0; s < 2; ++s) {
                const uint32_t* facet = facets[i + (uint64_t)s];
                const uint32_t* v = view.tets + 4 * (size_t)facet[3];
                int across = 0;
                while (v[across] == facet[0] || v[across] == facet[1] || v[across] == facet[2]) ++across;
                side[s] = solid_tet_volume(
                    view.positions + 3 * (size_t)facet[0], view.positions + 3 * (size_t)facet[1],
                    view.positions + 3 * (size_t)facet[2], view.positions + 3 * (size_t)v[across]);
            }
            ck_assert_msg((side[0] > 0) != (side[1] > 0), "tets %u and %u overlap", facets[i][3],
                          facets[i + 1][3]);
        } else {
            /* The boundary facets go to the front. */
            memmove(facets[facts.boundary_facets++], facets[i], sizeof *facets);
        }
        i = end;
    }
    {
        uint32_t(*edges)[3] = malloc((size_t)facts.boundary_facets * 3 * sizeof *edges);
        ck_assert_ptr_nonnull(edges);
        for (uint64_t f = 0; f < facts.boundary_facets; ++f)
            for (int k = 0; k < 3; ++k) {
                const uint32_t a = facets[f][k], b = facets[f][(k + 1) % 3];
                edges[edge_count][0] = a < b ? a : b;
                edges[edge_count][1] = a < b ? b : a;
                edges[edge_count++][2] = 0;
                boundary_vertices += !used[a];
                used[a] = 1;
            }
        qsort(edges, (size_t)edge_count, sizeof *edges, solid_compare);
        for (uint64_t i = 0; i < edge_count;) {
            uint64_t end = i + 1;
            while (end < edge_count && solid_compare(edges[i], edges[end]) == 0) ++end;
            ck_assert_msg((end - i) % 2 == 0, "the boundary is open at edge %u %u", edges[i][0], edges[i][1]);
            facts.pinched_edges += end - i > 2;
            ++boundary_edges;
            i = end;
        }
        free(edges);
    }
    facts.euler = (long long)boundary_vertices - (long long)boundary_edges + (long long)facts.boundary_facets;
    free(facets);
    free(used);
    return facts;
}

/* Checks a solid, and the angles of isosurface stuffing. */
static solid_facts check_stuffed(const vox_io_mesh* mesh) {
    const solid_facts facts = check_solid(mesh);
    ck_assert_msg(facts.min_dihedral >= LEAST_DIHEDRAL && facts.max_dihedral <= MOST_DIHEDRAL,
                  "dihedral angles from %g to %g degrees", facts.min_dihedral, facts.max_dihedral);
    return facts;
}

static inline void check_same(const vox_io_mesh* a, const vox_io_mesh* b) {
    const vox_io_mesh_view p = solid_view(a), q = solid_view(b);
    ck_assert_uint_eq(p.vertex_count, q.vertex_count);
    ck_assert_uint_eq(p.tet_count, q.tet_count);
    ck_assert_mem_eq(p.positions, q.positions, (size_t)p.vertex_count * 3 * sizeof(double));
    ck_assert_mem_eq(p.tets, q.tets, (size_t)p.tet_count * 4 * sizeof(uint32_t));
}

static inline vox_io_quality quality_of(const vox_io_mesh* mesh, const vox_io_mesh* surface) {
    vox_io_quality quality;
    quality.struct_size = sizeof quality;
    ck_ok(vox_io_mesh_measure(mesh, surface, &quality));
    return quality;
}

#endif
