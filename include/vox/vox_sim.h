/* vox_sim: deformable bodies that fall, collide and rest, built on the public interface of vox. A separate library; the
 * core does not need it.
 *
 * It serves the paper's experiment (vox sweep), the examples and the demo, and is small, clear and robust rather than
 * complete. A game or a film needs an engine of its own, with vox inside.
 *
 * Bodies are particles joined by tetrahedra. vox_sim_step divides the time step into substeps. In each of them the grid
 * finds the constraints (VOX_GRID_CONSTRAINTS), the particles move freely, and then constraints for edge lengths,
 * volumes, contacts and the floor are solved by XPBD, one sweep each in a fixed order (docs/sim.md).
 *
 * The conventions of vox.h hold here too: vox_result, vox_last_error(), struct_size, untouched out-parameters on
 * failure. Everything is double; the same calls give the same bits, for any number of workers of the grid.
 *
 *   Threads   One thread at a time may use a sim. Different ones are independent.
 *   Units     One unit of length, mass and time throughout. The defaults suit metres, kilograms and seconds.
 *   Ownership Everything that is passed in is copied. Views live as their comment says.
 *   Limits    Positions, velocities and accelerations are at most 1e15 in size on each axis, other numbers at most
 *             1e60, and a body's mass at least 1e-60.
 */
#ifndef VOX_VOX_SIM_H
#define VOX_VOX_SIM_H

#include <vox/vox.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- simulation ------------------------------------------------------------------------------- */

/* Bodies, and the grid they collide in. */
typedef struct vox_sim vox_sim;

typedef struct vox_sim_desc {
    uint32_t struct_size;
    /* Substeps of a step, 1 to 10000; default 10. The stiffness that can be simulated grows with the square of this
     * number and of the edge lengths; greater stiffness is reduced to it, with a log line. */
    uint32_t substeps;
    /* Contacts are detected before the first substep of a step and after every `detect_every` substeps of it. 1 (the
     * default): in every substep; the number of substeps or more: once a step; 0: never, so that bodies pass through
     * each other. */
    uint32_t detect_every;
    uint32_t reserved;    /* 0 */
    double gravity[3];    /* acceleration; default 0, 0, -9.81 */
    double max_time_step; /* a longer step is clamped to this, with a log line; 1e-12 to 1e12, default 1/30 */
    /* The floor keeps particles where floor_normal . x >= floor_offset. The default is normal 0, 0, 1 and offset 0. The
     * normal is scaled to unit length, and floor_offset applies to that. All zero: no floor. */
    double floor_normal[3];
    double floor_offset;
    double friction; /* Coulomb's coefficient, between bodies and with the floor; >= 0, default 0.5 */
    /* A penetrating vertex is pushed out by a force of depth / contact_compliance along the direction of the depth
     * stage, integrated implicitly, so that any stiffness is stable. >= 0; 0 (the default): the greatest stiffness that
     * a substep can handle. */
    double contact_compliance;
    double max_push_speed; /* greatest speed at which earlier penetrations are undone, >= 0; default 1. It does not add
                            * to the velocities of the bodies */
    double contact_slop;   /* penetration depth that is tolerated, so that resting contacts persist. Negative (the
                            * default is -1): a hundredth of the mean rest edge of the two bodies */
    VOX_OPTIONAL const vox_grid_desc* grid; /* settings of the grid inside, read during create; null: defaults */
    VOX_OPTIONAL const vox_log* log; /* of the simulation, copied; the grid has one of its own in its desc */
    /* Where the simulation and its bodies live, as does its grid unless `grid` names another allocator. Called only
     * from functions of the simulation and its grid, one call at a time. Copied; null: the C++ runtime's heap. */
    VOX_OPTIONAL const vox_allocator* allocator;
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

/* Creates a simulation without bodies. desc null: all defaults. The caller owns *out_sim and releases it with
 * vox_sim_destroy. Errors: INVALID_ARGUMENT (names the field and its value), OUT_OF_MEMORY, BUDGET. */
VOX_API vox_result vox_sim_create(VOX_OPTIONAL const vox_sim_desc* desc, vox_sim** out_sim);

/* Destroys a simulation with its bodies and its grid. All views become invalid. Null does nothing. */
VOX_API void vox_sim_destroy(VOX_OPTIONAL vox_sim* sim);

/* The grid inside, for reading the contacts and constraints of the last detection and counters, and for
 * setting the cell size and the number of workers. It borrows the bodies' positions and belongs to the sim: do not
 * destroy it. Contacts with other meshes inserted into it are found, but the sim does not respond to them. A body whose
 * mesh was removed there moves on without contacts. Do not cut the mesh of a body there, move it or bind it elsewhere:
 * vox_sim_step fails once a contact does not fit the body. */
VOX_API vox_result vox_sim_get_grid(const vox_sim* sim, vox_grid** out_grid);

/* Moves everything forward by `time_step`, or by max_time_step if that is less.
 * Errors: INVALID_ARGUMENT (not a finite number of at least 1e-12), and those of vox_grid_step, which leave the bodies
 * as they were after the last completed substep; so does INVALID_STATE, for a body or the flags of the grid changed
 * through vox_sim_get_grid, which names the two bodies of a contact. */
VOX_API vox_result vox_sim_step(vox_sim* sim, double time_step);

/* ---- bodies ----------------------------------------------------------------------------------- */

/* A body is identified by its mesh in the grid of the sim, so contacts refer to bodies. */

typedef enum vox_sim_body_flags {
    VOX_SIM_BODY_SELF_COLLISION = 1, /* collides with itself too */
    VOX_SIM_BODY_FIXED = 2           /* never moves; others collide with it */
} vox_sim_body_flags;

typedef struct vox_sim_body_desc {
    uint32_t struct_size;
    uint32_t flags; /* vox_sim_body_flags, combined with | */
    const double* positions; /* within 1e15 of the origin on each axis */
    /* The undeformed shape; null (the default): `positions`. */
    VOX_OPTIONAL const double* rest_positions;
    VOX_OPTIONAL const double* velocities; /* null (the default): at rest */
    const uint32_t* tets; /* both windings are accepted */
    uint64_t vertex_count;
    uint64_t tet_count; /* at least 1 */
    double density;     /* mass per rest volume, > 0; default 1000. Lumped to the vertices. No vertex gets less than a
                         * hundredth of their mean mass; a vertex in no tet gets the mean */
    /* Resistance to stretching. The edges are springs with the stiffness that gives a material of this Young's modulus
     * if the edges run evenly in all directions. >= 0, default 1e6. */
    double youngs_modulus;
    double bulk_modulus; /* resistance to change of volume, beyond that of the edges; >= 0, default 1e6 */
    double damping;      /* a time: edges resist the rate of their strain with damping times their stiffness; >= 0,
                          * default 0.01 */
    uint64_t user_data;  /* returned by vox_body_get_user_data on the sim's grid */
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

/* Adds a body. Tets of zero rest volume get no volume constraint, and inverted ones keep their negative volume; both
 * are counted and reported in one log line.
 * Errors: INVALID_ARGUMENT (names the field and its value; also: no tet, or all of them flat, so that the body has no
 * mass), INVALID_MESH, NON_FINITE (names the vertex), LIMIT, BUDGET, OUT_OF_MEMORY. */
VOX_API vox_result vox_sim_body_insert(vox_sim* sim, const vox_sim_body_desc* desc, vox_body* out_body);

/* Removes a body from the simulation and from its grid. */
VOX_API vox_result vox_sim_body_remove(vox_sim* sim, vox_body body);

/* Arrays of a body with its state after the last step. Until the body is removed, the pointers stay the same and every
 * step updates the contents. */
typedef struct vox_sim_body_view {
    const double* positions;
    const double* velocities;
    const double* masses;
    /* `positions` rounded to float, which the grid borrows. */
    const float* grid_positions;
    const uint32_t* tets;
    uint64_t vertex_count;
    uint64_t tet_count;
} vox_sim_body_view;

/* The body's arrays. */
VOX_API vox_result vox_sim_body_get_view(const vox_sim* sim, vox_body body, vox_sim_body_view* out_view);

/* Sets a body's positions and velocities, 3 * vertex_count numbers each; null leaves them as they are. The rest shape
 * stays. Errors: NON_FINITE (names the vertex), INVALID_ARGUMENT (beyond 1e15). */
VOX_API vox_result vox_sim_body_set_state(vox_sim* sim, vox_body body, VOX_OPTIONAL const double* positions,
                                          VOX_OPTIONAL const double* velocities);

/* Accelerates all particles of a body from now on, in addition to gravity; 0, 0, 0 at first.
 * Errors: INVALID_ARGUMENT (a component that is not a number of at most 1e15 in size). */
VOX_API vox_result vox_sim_body_set_acceleration(vox_sim* sim, vox_body body, const double acceleration[3]);

/* ---- measurements ----------------------------------------------------------------------------- */

typedef struct vox_sim_energies {
    uint32_t struct_size;
    uint32_t reserved;
    double kinetic;
    double potential;  /* energy in gravity, 0 at the origin */
    double elastic;    /* energy of edges and volumes */
    double mass;
    double momentum[3];
    double centre[3];  /* centre of mass */
    double max_speed;  /* speed of the fastest particle */
} vox_sim_energies;

/* Energy and motion of a body, or of all bodies that are not fixed (body VOX_NULL_BODY). They are those of the middle
 * of the last substep, to which the velocities belong; the positions of vox_sim_body_get_view are half a substep later.
 * Writes the fields that out_energies->struct_size covers (set it first). */
VOX_API vox_result vox_sim_get_energy(const vox_sim* sim, vox_body body, vox_sim_energies* out_energies);

/* Gets sizes, totals and times (docs/sim.md lists them). They live until the next call that changes the simulation. */
VOX_API vox_result vox_sim_get_counters(const vox_sim* sim, vox_counter_view* out_view);

#ifdef __cplusplus
}
#endif

#endif
