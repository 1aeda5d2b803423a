/* Contacts by brute force in exact integer arithmetic (GMP): every vertex against every tetrahedron, nothing
 * shared with the library's code. Slow, plain, and right by inspection. Not for use by several threads at
 * once. */
#ifndef VOX_TESTS_ORACLE_H
#define VOX_TESTS_ORACLE_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum oracle_containment {
    ORACLE_OUTSIDE,
    ORACLE_BOUNDARY,
    ORACLE_INTERIOR,
    ORACLE_DEGENERATE /* the tetrahedron has exactly zero volume */
} oracle_containment;

/* Sign of ((b-a) x (c-a)) . (d-a). */
int oracle_orientation(const float a[3], const float b[3], const float c[3], const float d[3]);

/* Where p lies with respect to the closed tetrahedron of four corners. */
oracle_containment oracle_locate(const float p[3], const float* const corners[4]);

/* The weights of the corners, each rounded to double once. The volume must not be zero. */
void oracle_barycentric(const float p[3], const float* const corners[4], double weights[4]);

typedef struct oracle_mesh {
    const float* positions; /* 3 per vertex */
    const uint32_t* tets;   /* 4 per tetrahedron */
    uint32_t vertex_count;
    uint32_t tet_count;
    int self_collision;
} oracle_mesh;

/* Meshes by their index. `interior`: strictly inside the tetrahedron. */
typedef struct oracle_contact {
    uint32_t body_a, vertex, body_b, tet;
    int interior;
    double barycentric[4];
} oracle_contact;

/* All pairs of a vertex and a closed tetrahedron that contains it without having it as a corner, sorted by
 * (body_a, vertex, body_b, tet). The caller frees *out with free(). Returns their number; ends the program if
 * memory runs out. */
size_t oracle_hits(const oracle_mesh* meshes, uint32_t mesh_count, oracle_contact** out);

/* Contacts by the rule of vox_contact: per (body_a, vertex, body_b) the interior ones, or else the first. */
size_t oracle_contacts(const oracle_mesh* meshes, uint32_t mesh_count, oracle_contact** out);

/* Tetrahedra of exactly zero volume. */
size_t oracle_degenerate_tets(const oracle_mesh* meshes, uint32_t mesh_count);

/* For doubles. */
typedef struct oracle_mesh_d {
    const double* positions;
    const uint32_t* tets;
    uint32_t vertex_count;
    uint32_t tet_count;
    int self_collision;
} oracle_mesh_d;

int oracle_orientation_d(const double a[3], const double b[3], const double c[3], const double d[3]);
oracle_containment oracle_locate_d(const double p[3], const double* const corners[4]);
void oracle_barycentric_d(const double p[3], const double* const corners[4], double weights[4]);
size_t oracle_hits_d(const oracle_mesh_d* meshes, uint32_t mesh_count, oracle_contact** out);
size_t oracle_contacts_d(const oracle_mesh_d* meshes, uint32_t mesh_count, oracle_contact** out);
size_t oracle_degenerate_tets_d(const oracle_mesh_d* meshes, uint32_t mesh_count);

#ifdef __cplusplus
}
#endif

#endif
