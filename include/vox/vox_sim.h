/* vox_sim: soft bodies that fall, collide and come to rest. A library of its own for examples, demos and tests:
 * small, clear and robust. A product needs its own engine, with vox inside.
 *
 * vox_sim_step divides a time step into substeps. In each substep the grid finds constraints, the particles move
 * freely, and then edges, volumes, contacts and the floor are solved by XPBD in a fixed order (docs/sim.md).
 * Everything is double. The same calls give the same bits, with any number of workers.
 *
 * Conventions: as in vox.h, and
 *   Threads    One thread at a time may use a simulation, even to read it. Different simulations are independent.
 *   Units      One unit of length, mass and time throughout. The defaults suit metres, kilograms and seconds.
 *   Limits     Positions, velocities and gravity are at most 1e15 on each axis, other numbers 1e60.
 */
#ifndef VOX_VOX_SIM_H
#define VOX_VOX_SIM_H

#include <vox/vox.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- simulation ------------------------------------------------------------------------------- */

/* Soft bodies and the grid they collide in. */
typedef struct vox_sim vox_sim;

/* Settings of a simulation. Each comment ends with the default, which vox_default_sim_desc() sets. */
typedef struct vox_sim_desc {
    uint32_t struct_size;
    uint32_t substeps;         /* of a step, 1 to 10000; 10 */
    uint32_t detect_every;     /* substeps from one detection of contacts to the next, or 0 for no detection; 1 */
    uint32_t reserved;         /* 0 */
    double gravity[3];         /* 0, 0, -9.81 */
    double max_time_step;      /* longer steps are shortened to this; 1/30 */
    double floor_normal[3];    /* particles stay where dot(floor_normal, x) >= floor_offset; all 0: no floor; 0, 0, 1 */
    double floor_offset;       /* 0 */
    double friction;           /* Coulomb's coefficient; 0.5 */
    double contact_compliance; /* inverse stiffness of contacts, or 0 for the stiffest that a substep can handle; 0 */
    double max_push_speed;     /* greatest speed at which older overlap is undone; 1 */
    double contact_slop;       /* depth that is tolerated, or -1 for a hundredth of the mean edge; -1 */
    VOX_OPTIONAL const vox_grid_desc* grid; /* settings of the grid inside; null: the defaults */
    VOX_OPTIONAL const vox_log* log;
    VOX_OPTIONAL const vox_allocator* allocator; /* of the simulation and, unless `grid` has one, its grid */
} vox_sim_desc;

static inline vox_sim_desc vox_default_sim_desc(void) {
    vox_sim_desc desc = VOX_ZERO;
    desc.struct_size = (uint32_t)sizeof desc;
    desc.substeps = 10;
    desc.detect_every = 1;
    desc.gravity[2] = -9.81;
    desc.max_time_step = 1.0 / 30;
    desc.floor_normal[2] = 1;
    desc.friction = 0.5;
    desc.max_push_speed = 1;
    desc.contact_slop = -1;
    return desc;
}

/* Creates a simulation without bodies. The caller owns *out_sim and releases it with vox_sim_destroy.
 * Errors: INVALID_ARGUMENT (names the field), OUT_OF_MEMORY, BUDGET. */
VOX_API vox_result vox_sim_create(VOX_OPTIONAL const vox_sim_desc* desc, vox_sim** out_sim);

/* Destroys a simulation with its bodies and its grid. Null does nothing. */
VOX_API void vox_sim_destroy(VOX_OPTIONAL vox_sim* sim);

/* Gets the grid inside, for reading results, for setting cell size and workers, and for rigid shapes: those inserted
 * there hold and push the bodies. A step moves a shape at constant speed from where it was in the step before to where
 * vox_body_set_transform has placed it since; disable it for a step to let it jump. The grid lives as long as the
 * simulation. Do not destroy it, and do not edit, move or bind the bodies' meshes there. */
VOX_API vox_result vox_sim_get_grid(const vox_sim* sim, vox_grid** out_grid);

/* Advances everything by time_step. Errors: INVALID_ARGUMENT (not a finite number of at least 1e-12), and errors of
 * vox_grid_step and vox_grid_find_constraints. After these the bodies are as they were after the last completed
 * substep. */
VOX_API vox_result vox_sim_step(vox_sim* sim, double time_step);

/* ---- bodies ----------------------------------------------------------------------------------- */

typedef enum vox_sim_body_flags {
    VOX_SIM_BODY_SELF_COLLISION = 1,
    VOX_SIM_BODY_FIXED = 2 /* never moves; others collide with it */
} vox_sim_body_flags;

/* A soft body, which is copied. Numbers in comments are the defaults, which vox_default_sim_body_desc() sets. */
typedef struct vox_sim_body_desc {
    uint32_t struct_size;
    uint32_t flags; /* vox_sim_body_flags, combined with | */
    const double* positions;                   /* 3 * vertex_count */
    VOX_OPTIONAL const double* rest_positions; /* 3 * vertex_count: the undeformed shape; null: positions */
    VOX_OPTIONAL const double* velocities;     /* 3 * vertex_count; null: 0 */
    const uint32_t* tets;                      /* 4 * tet_count vertex indices, in either winding */
    uint64_t vertex_count;
    uint64_t tet_count; /* at least 1 */
    double density;        /* mass over rest volume; 1000 */
    double youngs_modulus; /* resistance to stretching; 1e6 */
    double bulk_modulus;   /* resistance to changes of volume, beyond what the edges have; 1e6 */
    double damping;        /* a time: damping of the edges over their stiffness; 0.01 */
    uint64_t user_data;    /* of the body in the grid */
} vox_sim_body_desc;

static inline vox_sim_body_desc vox_default_sim_body_desc(void) {
    vox_sim_body_desc desc = VOX_ZERO;
    desc.struct_size = (uint32_t)sizeof desc;
    desc.density = 1000;
    desc.youngs_modulus = 1e6;
    desc.bulk_modulus = 1e6;
    desc.damping = 0.01;
    return desc;
}

/* Adds a body. *out_body is also its id in the grid.
 * Errors: INVALID_ARGUMENT (also a body without volume), INVALID_MESH, NON_FINITE, LIMIT, BUDGET, OUT_OF_MEMORY. */
VOX_API vox_result vox_sim_body_insert(vox_sim* sim, const vox_sim_body_desc* desc, vox_body* out_body);

/* Removes a body from the simulation and its grid. */
VOX_API vox_result vox_sim_body_remove(vox_sim* sim, vox_body body);

/* The arrays of a body. The pointers stay valid until the body is removed; steps change the contents. */
typedef struct vox_sim_body_view {
    const double* positions;     /* 3 * vertex_count */
    const double* velocities;    /* 3 * vertex_count */
    const double* masses;        /* vertex_count */
    const float* grid_positions; /* 3 * vertex_count: positions rounded to float; the grid borrows them, or `positions`
                                    once floats round by more than 2^-14 of a mean edge, far from the origin */
    const uint32_t* tets;        /* 4 * tet_count */
    uint64_t vertex_count;
    uint64_t tet_count;
} vox_sim_body_view;

/* Gets the arrays of a body. They live until the body is removed. */
VOX_API vox_result vox_sim_body_get_view(const vox_sim* sim, vox_body body, vox_sim_body_view* out_view);

/* Sets positions and velocities of a body, 3 * vertex_count numbers each; null leaves them as they are.
 * Errors: NON_FINITE, INVALID_ARGUMENT (beyond 1e15). */
VOX_API vox_result vox_sim_body_set_state(vox_sim* sim, vox_body body, VOX_OPTIONAL const double* positions,
                                          VOX_OPTIONAL const double* velocities);

/* ---- measurements ----------------------------------------------------------------------------- */

/* Energy and motion. */
typedef struct vox_sim_energy {
    double kinetic;
    double potential;  /* in gravity, 0 at the origin */
    double elastic;
    double mass;
    double momentum[3];
    double centre[3]; /* of mass */
    double max_speed; /* of the fastest particle */
} vox_sim_energy;

/* Gets energy and motion of a body, or of all bodies that are not fixed (VOX_NULL_BODY), in the middle of the last
 * substep. */
VOX_API vox_result vox_sim_get_energy(const vox_sim* sim, vox_body body, vox_sim_energy* out_energy);

/* Gets sizes, totals and times (docs/sim.md lists them). They live until the next call that changes the simulation. */
VOX_API vox_result vox_sim_get_counters(const vox_sim* sim, vox_counter_view* out_view);

/* ---- repair ----------------------------------------------------------------------------------- */

typedef enum vox_resolve_flags {
    VOX_RESOLVE_FIXED = 1 /* the body does not move */
} vox_resolve_flags;

/* A body whose intersections are to go: tetrahedra, or a surface without any. */
typedef struct vox_resolve_body {
    uint32_t struct_size;
    uint32_t flags;    /* vox_resolve_flags, combined with | */
    double* positions; /* 3 * vertex_count; vox_resolve replaces them */
    uint64_t vertex_count;
    VOX_OPTIONAL const uint32_t* tets; /* 4 * tet_count vertex indices, in either winding */
    uint64_t tet_count;
    VOX_OPTIONAL const uint32_t* faces; /* 3 * face_count vertex indices; a body with tetrahedra has none */
    uint64_t face_count;
    /* Results, which vox_resolve sets: */
    uint64_t moved_vertices;
    double largest_move;  /* of a vertex */
    double volume_before; /* of the tetrahedra or in a closed surface; else 0 */
    double volume;        /* afterwards */
    uint64_t inverted_tets; /* whose signed volume has another sign than before */
} vox_resolve_body;

static inline vox_resolve_body vox_default_resolve_body(void) {
    vox_resolve_body body = VOX_ZERO;
    body.struct_size = (uint32_t)sizeof body;
    return body;
}

/* A place where something is left: an edge that meets a face, or two features closer than the gap. */
typedef struct vox_resolve_place {
    uint32_t body_a; /* indices into the bodies, which may be the same */
    uint32_t body_b;
    double distance; /* 0: they meet */
    double position[3];
} vox_resolve_place;

/* Settings; all 0 by default. */
typedef struct vox_resolve_desc {
    uint32_t struct_size;
    uint32_t worker_count;   /* as in vox_grid_desc */
    uint32_t max_iterations; /* 0: 400 */
    uint32_t reserved;       /* 0 */
    double gap;              /* least distance of features without a common vertex; 0: they only do not meet */
    double max_move;         /* no vertex moves further than this; 0: no limit */
    VOX_OPTIONAL vox_resolve_place* places; /* receives the first place_capacity places where something is left */
    uint64_t place_capacity;
    VOX_OPTIONAL const vox_allocator* allocator;
} vox_resolve_desc;

static inline vox_resolve_desc vox_default_resolve_desc(void) {
    vox_resolve_desc desc = VOX_ZERO;
    desc.struct_size = (uint32_t)sizeof desc;
    return desc;
}

/* What was done and what is left. */
typedef struct vox_resolve_report {
    uint32_t struct_size;
    uint32_t resolved;        /* 1: nothing is left; else 0 */
    uint64_t first_crossings; /* edges that met a face before */
    uint64_t crossings;       /* edges that still do */
    uint64_t inside_vertices; /* vertices and edges that still are in a body */
    uint64_t close_pairs;     /* pairs closer than the gap; 0 if there are crossings */
    double first_depth;       /* greatest depth in a body before */
    double least_distance;    /* of close pairs; 0 if there are crossings; else the gap */
    double largest_move;
    uint64_t iterations;
    uint64_t place_count; /* of crossings and close pairs together */
} vox_resolve_report;

/* Moves bodies apart until no edge meets a face and all features without a common vertex are `gap` apart, by small
 * steps of XPBD that keep the lengths of edges and the volumes of tetrahedra. Once nothing crosses, no step makes a
 * crossing. A closed surface is a body with an inside; other surfaces have two sides. The same input gives the same
 * bits, with any number of workers. Set struct_size of the report first.
 * Errors: INVALID_ARGUMENT, INVALID_MESH, NON_FINITE, LIMIT, BUDGET, OUT_OF_MEMORY; positions are then as before. */
VOX_EXPERIMENTAL vox_result vox_resolve(VOX_OPTIONAL const vox_resolve_desc* desc, vox_resolve_body* bodies,
                                        uint64_t body_count, vox_resolve_report* out_report);

#ifdef __cplusplus
}
#endif

#endif
