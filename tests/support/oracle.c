#include "support/oracle.h"

#include <gmp.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Every finite double is an integer multiple of 2^-1074: a mantissa of 53 bits, moved up. */
static void set_coordinate(mpz_t out, double value) {
    int exponent;
    mpz_set_d(out, ldexp(frexp(value, &exponent), 53));
    exponent += 1074 - 53;
    if (exponent >= 0)
        mpz_mul_2exp(out, out, (mp_bitcnt_t)exponent);
    else /* a denormal number: what is cut off is zeros */
        mpz_tdiv_q_2exp(out, out, (mp_bitcnt_t)-exponent);
}

/* out = ((b-a) x (c-a)) . (d-a), in units of 2^-3222 */
static void volume(mpz_t out, const double* a, const double* b, const double* c, const double* d) {
    static mpz_t origin[3], u[3], v[3], w[3], normal;
    static int initialised = 0;
    if (!initialised) {
        for (int i = 0; i < 3; ++i) mpz_inits(origin[i], u[i], v[i], w[i], NULL);
        mpz_init(normal);
        initialised = 1;
    }
    for (int i = 0; i < 3; ++i) {
        set_coordinate(origin[i], a[i]);
        set_coordinate(u[i], b[i]);
        set_coordinate(v[i], c[i]);
        set_coordinate(w[i], d[i]);
        mpz_sub(u[i], u[i], origin[i]);
        mpz_sub(v[i], v[i], origin[i]);
        mpz_sub(w[i], w[i], origin[i]);
    }
    mpz_set_ui(out, 0);
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        mpz_mul(normal, u[j], v[k]);
        mpz_submul(normal, u[k], v[j]);
        mpz_addmul(out, normal, w[i]);
    }
}

int oracle_orientation_d(const double a[3], const double b[3], const double c[3], const double d[3]) {
    mpz_t det;
    mpz_init(det);
    volume(det, a, b, c, d);
    const int sign = mpz_sgn(det);
    mpz_clear(det);
    return sign;
}

oracle_containment oracle_locate_d(const double p[3], const double* const corners[4]) {
    const int whole = oracle_orientation_d(corners[0], corners[1], corners[2], corners[3]);
    if (whole == 0) return ORACLE_DEGENERATE;
    oracle_containment found = ORACLE_INTERIOR;
    for (int i = 0; i < 4; ++i) {
        const double* q[4] = {corners[0], corners[1], corners[2], corners[3]};
        q[i] = p;
        const int part = oracle_orientation_d(q[0], q[1], q[2], q[3]) * whole;
        if (part < 0) return ORACLE_OUTSIDE;
        if (part == 0) found = ORACLE_BOUNDARY;
    }
    return found;
}

void oracle_barycentric_d(const double p[3], const double* const corners[4], double weights[4]) {
    mpz_t det;
    mpq_t whole, weight;
    mpz_init(det);
    mpq_inits(whole, weight, NULL);
    volume(det, corners[0], corners[1], corners[2], corners[3]);
    mpq_set_z(whole, det);
    for (int i = 0; i < 4; ++i) {
        const double* q[4] = {corners[0], corners[1], corners[2], corners[3]};
        q[i] = p;
        volume(det, q[0], q[1], q[2], q[3]);
        mpq_set_z(weight, det);
        mpq_div(weight, weight, whole);
        weights[i] = mpq_get_d(weight);
    }
    mpq_clears(whole, weight, NULL);
    mpz_clear(det);
}

/* Comparing is exact, and a point outside the box is outside the tetrahedron. */
static int outside_box(const double* p, const double* const corners[4]) {
    for (int axis = 0; axis < 3; ++axis) {
        int below = 0, above = 0;
        for (int i = 0; i < 4; ++i) {
            below += p[axis] < corners[i][axis];
            above += p[axis] > corners[i][axis];
        }
        if (below == 4 || above == 4) return 1;
    }
    return 0;
}

static void append(oracle_contact** list, size_t* count, size_t* capacity, const oracle_contact* item) {
    if (*count == *capacity) {
        *capacity = *capacity ? 2 * *capacity : 64;
        *list = realloc(*list, *capacity * sizeof **list);
        if (!*list) {
            fputs("oracle: out of memory\n", stderr);
            exit(1);
        }
    }
    (*list)[(*count)++] = *item;
}

size_t oracle_hits_d(const oracle_mesh_d* meshes, uint32_t mesh_count, oracle_contact** out) {
    oracle_contact* hits = NULL;
    size_t count = 0, capacity = 0;
    for (uint32_t a = 0; a < mesh_count; ++a) {
        for (uint32_t vertex = 0; vertex < meshes[a].vertex_count; ++vertex) {
            const double* p = meshes[a].positions + 3 * (size_t)vertex;
            for (uint32_t b = 0; b < mesh_count; ++b) {
                const oracle_mesh_d* mesh = &meshes[b];
                if (a == b && !mesh->self_collision) continue;
                for (uint32_t tet = 0; tet < mesh->tet_count; ++tet) {
                    const uint32_t* v = mesh->tets + 4 * (size_t)tet;
                    if (a == b && (v[0] == vertex || v[1] == vertex || v[2] == vertex || v[3] == vertex))
                        continue;
                    const double* const corners[4] = {
                        mesh->positions + 3 * (size_t)v[0], mesh->positions + 3 * (size_t)v[1],
                        mesh->positions + 3 * (size_t)v[2], mesh->positions + 3 * (size_t)v[3]};
                    if (outside_box(p, corners)) continue;
                    const oracle_containment where = oracle_locate_d(p, corners);
                    if (where != ORACLE_BOUNDARY && where != ORACLE_INTERIOR) continue;
                    oracle_contact hit = {a, vertex, b, tet, where == ORACLE_INTERIOR, {0, 0, 0, 0}};
                    oracle_barycentric_d(p, corners, hit.barycentric);
                    append(&hits, &count, &capacity, &hit);
                }
            }
        }
    }
    *out = hits;
    return count;
}

size_t oracle_contacts_d(const oracle_mesh_d* meshes, uint32_t mesh_count, oracle_contact** out) {
    oracle_contact* hits;
    const size_t hit_count = oracle_hits_d(meshes, mesh_count, &hits);
    size_t count = 0;
    for (size_t begin = 0, end; begin < hit_count; begin = end) {
        const oracle_contact first = hits[begin];
        int interior = 0;
        for (end = begin; end < hit_count && hits[end].body_a == first.body_a &&
                          hits[end].vertex == first.vertex && hits[end].body_b == first.body_b;
             ++end)
            interior += hits[end].interior;
        if (interior == 0) hits[count++] = first;
        for (size_t h = begin; h < end; ++h)
            if (hits[h].interior) hits[count++] = hits[h];
    }
    *out = hits;
    return count;
}

size_t oracle_degenerate_tets_d(const oracle_mesh_d* meshes, uint32_t mesh_count) {
    size_t count = 0;
    for (uint32_t m = 0; m < mesh_count; ++m) {
        for (uint32_t tet = 0; tet < meshes[m].tet_count; ++tet) {
            const uint32_t* v = meshes[m].tets + 4 * (size_t)tet;
            const double* x = meshes[m].positions;
            count += oracle_orientation_d(x + 3 * (size_t)v[0], x + 3 * (size_t)v[1], x + 3 * (size_t)v[2],
                                          x + 3 * (size_t)v[3]) == 0;
        }
    }
    return count;
}

/* ---- floats: the same, as doubles ---------------------------------------------------------------------- */

static void widen(const float* from, size_t count, double* to) {
    for (size_t i = 0; i < count; ++i) to[i] = (double)from[i];
}

int oracle_orientation(const float a[3], const float b[3], const float c[3], const float d[3]) {
    const float* const from[4] = {a, b, c, d};
    double q[4][3];
    for (int i = 0; i < 4; ++i) widen(from[i], 3, q[i]);
    return oracle_orientation_d(q[0], q[1], q[2], q[3]);
}

oracle_containment oracle_locate(const float p[3], const float* const corners[4]) {
    double at[3], q[4][3];
    widen(p, 3, at);
    for (int i = 0; i < 4; ++i) widen(corners[i], 3, q[i]);
    const double* const wide[4] = {q[0], q[1], q[2], q[3]};
    return oracle_locate_d(at, wide);
}

void oracle_barycentric(const float p[3], const float* const corners[4], double weights[4]) {
    double at[3], q[4][3];
    widen(p, 3, at);
    for (int i = 0; i < 4; ++i) widen(corners[i], 3, q[i]);
    const double* const wide[4] = {q[0], q[1], q[2], q[3]};
    oracle_barycentric_d(at, wide, weights);
}

static void* checked(void* memory) {
    if (!memory) {
        fputs("oracle: out of memory\n", stderr);
        exit(1);
    }
    return memory;
}

/* The caller frees them with release(). */
static oracle_mesh_d* widened(const oracle_mesh* meshes, uint32_t mesh_count) {
    oracle_mesh_d* wide = checked(malloc((mesh_count + 1) * sizeof *wide));
    for (uint32_t m = 0; m < mesh_count; ++m) {
        const size_t count = 3 * (size_t)meshes[m].vertex_count;
        double* positions = checked(malloc((count + 1) * sizeof *positions));
        widen(meshes[m].positions, count, positions);
        wide[m] = (oracle_mesh_d){positions, meshes[m].tets, meshes[m].vertex_count, meshes[m].tet_count,
                                  meshes[m].self_collision};
    }
    return wide;
}

static void release(oracle_mesh_d* wide, uint32_t mesh_count) {
    for (uint32_t m = 0; m < mesh_count; ++m) free((void*)wide[m].positions);
    free(wide);
}

size_t oracle_hits(const oracle_mesh* meshes, uint32_t mesh_count, oracle_contact** out) {
    oracle_mesh_d* wide = widened(meshes, mesh_count);
    const size_t count = oracle_hits_d(wide, mesh_count, out);
    release(wide, mesh_count);
    return count;
}

size_t oracle_contacts(const oracle_mesh* meshes, uint32_t mesh_count, oracle_contact** out) {
    oracle_mesh_d* wide = widened(meshes, mesh_count);
    const size_t count = oracle_contacts_d(wide, mesh_count, out);
    release(wide, mesh_count);
    return count;
}

size_t oracle_degenerate_tets(const oracle_mesh* meshes, uint32_t mesh_count) {
    oracle_mesh_d* wide = widened(meshes, mesh_count);
    const size_t count = oracle_degenerate_tets_d(wide, mesh_count);
    release(wide, mesh_count);
    return count;
}
