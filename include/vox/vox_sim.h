/* vox_sim: deformable bodies that fall, collide and rest, built on the public interface of vox. A separate library; the
 * core does not need it.
 *
 * It serves the experiment (time of detection against cell size), the examples and the demo, and is small, clear and
 * robust rather than complete. A game or a film needs an engine of its own, with vox inside.
 *
 * Bodies are particles joined by tetrahedra. vox_sim_step divides the time step into substeps. In each of them the grid
 * finds the penetrations (vox_grid_penetrations), the particles move freely, and then constraints for edge lengths,
 * volumes, contacts and the floor are solved by XPBD, one sweep each in a fixed order (docs/sim.md).
 *
 * The conventions of vox.h hold here too: vox_result, vox_last_error(), struct_size, untouched out-parameters on
 * failure. Everything is double; the same calls give the same bits, for any number of workers of the grid.
 *
 *   Threads   One thread at a time may use a sim, or an experiment. Different ones are independent.
 *   Units     One unit of length, mass and time throughout. The defaults suit metres, kilograms and seconds.
 *   Ownership Everything that is passed in is copied. Views live as their comment says.
 *   Limits    Positions, velocities and accelerations are at most 1e15 in size on each axis, other numbers at most
 *             1e60, and a body's mass at least 1e-60.
 */
#ifndef VOX_VOX_SIM_H
#define VOX_VOX_SIM_H

#include <vox/vox_cell_size.h>

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

/* The grid inside, for reading the contacts and penetrations of the last detection, counters and profile, and for
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

typedef struct vox_sim_counts {
    uint32_t struct_size;
    uint32_t bodies;
    uint64_t vertices;
    uint64_t tets;
    uint64_t edges;         /* edge constraints */
    uint64_t volumes;       /* volume constraints */
    uint64_t flat_tets;     /* tets of zero rest volume */
    uint64_t inverted_tets; /* tets of negative rest volume */
    uint64_t raised_masses; /* vertices that would have been lighter than a hundredth of the body's mean */
    uint64_t softened;      /* constraints that were softened, as the last step's substeps cannot handle their
                             * stiffness */
    uint64_t steps;         /* total since the creation, like the next three */
    uint64_t substeps;
    uint64_t detections;
    uint64_t clamped_steps; /* steps that were clamped to max_time_step */
    uint64_t penetrations;  /* penetrations of the last detection */
    uint64_t floor_contacts; /* particles that the floor held in the last substep */
    uint64_t step_ns;       /* nanoseconds of the last step */
    uint64_t detect_ns;     /* its part in vox_grid_step */
    uint64_t solve_ns;      /* the rest of it */
} vox_sim_counts;

/* Writes the fields that out_counts->struct_size covers (set it first). */
VOX_API vox_result vox_sim_get_counters(const vox_sim* sim, vox_sim_counts* out_counts);

/* ---- the experiment --------------------------------------------------------------------------- */

/* Time of detection against cell size, as in Sect. 5 of the paper. Two bodies are placed so that about 1 % of their
 * tetrahedra are in contact; the response pushes them apart and deforms them; the detection of ten frames is timed.
 *
 * Contacts do not depend on the cell size, so the motion does not either. It is simulated once, when the experiment is
 * created, and every sample detects the contacts of the same recorded frames. A complete experiment calls
 * vox_experiment_create; then, for each round and each cell size in the order of vox_experiment_order,
 * vox_experiment_measure; then, for each cell size, vox_experiment_time over its rounds; and at last vox_fit_times,
 * vox_fit_zone and vox_experiment_suggest. `vox sweep` does exactly that. */
typedef struct vox_experiment vox_experiment;

typedef struct vox_experiment_desc {
    uint32_t struct_size;
    uint32_t frames;               /* detections in a sample, 1 to 1000; default 10 */
    const vox_sim_body_desc* a;    /* keeps its place */
    /* Is moved until it touches a; null (the default): a copy of a. */
    VOX_OPTIONAL const vox_sim_body_desc* b;
    /* Settings of the motion; null (the default): vox_sim's defaults, without a floor. */
    VOX_OPTIONAL const vox_sim_desc* sim;
    /* Settings of the grid that is measured, except its cell size; null (the default): vox's defaults with the
     * reference engine. */
    VOX_OPTIONAL const vox_grid_desc* grid;
    double axis[3];                /* direction from a to b. The centre of b moves along this line through the centre
                                    * of a (centres of the bounding boxes); default 1, 0, 0 */
    double contact_share;          /* required share of all tets that contain a vertex of the other body, as the mean
                                    * over the frames, in (0, 1); default 0.01 */
    double time_step;              /* duration of a frame, > 0; default 1/100 */
    uint32_t turn;                 /* 1 (the default): both bodies are first rotated about their centres by fixed
                                    * angles, which differ, so that bodies cut from a lattice align neither with the
                                    * cells nor with each other; 0: they are not rotated */
    uint32_t reserved;             /* 0 */
} vox_experiment_desc;

static inline vox_experiment_desc vox_default_experiment_desc(void) {
    vox_experiment_desc desc = VOX_ZERO;
    desc.struct_size = (uint32_t)sizeof desc;
    desc.frames = 10;
    desc.axis[0] = 1;
    desc.contact_share = 0.01;
    desc.time_step = 0.01;
    desc.turn = 1;
    return desc;
}

/* Places the bodies, simulates the frames and records them. What `desc` points to is read during the call. The caller
 * owns *out_experiment and releases it with vox_experiment_destroy.
 * The position is found by bisection from outside, so that b stands where the required share is first reached. Then the
 * frames are simulated. Both are repeated a few times until the mean share over the frames is the required one. It is
 * met only roughly, since the number of tets is finite and the bodies may part quickly; vox_experiment_facts has the
 * result. Errors: INVALID_ARGUMENT (names the field and its value), INVALID_STATE (the share cannot be reached on this
 * axis; gives the largest that can), and those of vox_sim_create, vox_sim_body_insert and vox_grid_step. */
VOX_API vox_result vox_experiment_create(const vox_experiment_desc* desc, vox_experiment** out_experiment);

/* Destroys an experiment. Null does nothing. */
VOX_API void vox_experiment_destroy(VOX_OPTIONAL vox_experiment* experiment);

/* Placement and motion of the two bodies. */
typedef struct vox_experiment_facts {
    uint32_t struct_size;
    uint32_t frames;
    uint64_t vertices; /* of both bodies together */
    uint64_t tets;     /* of both bodies together */
    uint64_t contacts; /* sum over all frames */
    uint64_t hash;     /* combines vox_grid_get_hash of all frames; the same for every cell size and engine */
    double distance;   /* initial distance of the centres, along the axis */
    double mean_share; /* mean over the frames of the share of tets in contact */
    /* That share in each frame; lives until vox_experiment_destroy. */
    const double* shares;
    double bounds_min[3]; /* bounding box of all vertices in all frames */
    double bounds_max[3];
} vox_experiment_facts;

/* Writes the fields that out_facts->struct_size covers (set it first); the shares live as long as the experiment. */
VOX_API vox_result vox_experiment_get(const vox_experiment* experiment, vox_experiment_facts* out_facts);

/* vox_suggest_cell_size for the two bodies as they are in the first frame, with its errors. */
VOX_API vox_result vox_experiment_suggest(const vox_experiment* experiment,
                                          VOX_OPTIONAL const vox_suggest_desc* desc, vox_suggestion* out);

/* One sample: the detection of all frames at one cell size. The counts are sums over the frames. */
typedef struct vox_experiment_sample {
    uint32_t struct_size;
    uint32_t reserved;
    double cell_size;
    double mean_ns; /* mean time of detection in a frame (vox_profile's bin, broad, narrow and contacts, without depth),
                     * without the motion. Of a grid with one worker, the processor time of the calling thread, which a
                     * busy machine lengthens much less; of several, the time that passes */
    uint64_t contacts;
    uint64_t visited_cells;
    uint64_t visited_entries;
    uint64_t candidates;
} vox_experiment_sample;

/* Measures one sample, after one step that is not timed. frame_ns receives the time of each frame; may be null.
 * Set out_sample->struct_size first. The contacts are compared with those found during the simulation.
 * Errors: INVALID_ARGUMENT (a cell size that is not above 0 and finite), those of vox_grid_step, INTERNAL (the contacts
 * differ). */
VOX_API vox_result vox_experiment_measure(vox_experiment* experiment, double cell_size, VOX_OPTIONAL uint64_t* frame_ns,
                                          vox_experiment_sample* out_sample);

/* The order in which a round measures `count` cell sizes: the numbers 0 to count - 1, shuffled. It differs for each
 * round and seed and is the same on every machine. Thus a temporary disturbance of the machine does not always hit the
 * same cell sizes. Errors: INVALID_ARGUMENT (count 0). */
VOX_API vox_result vox_experiment_order(uint64_t count, uint64_t seed, uint64_t round, uint64_t* out_order);

/* The time of one cell size from its rounds: the mean over the frames of the median over the rounds. frame_ns holds
 * `frames` times for each round, round after round. A frame means the same work in every round, so a disturbance
 * affects only the frames in which it happens, not the whole round. Medians are used because on a busy machine the
 * minimum over the rounds depends on a few lucky ones (docs/paper.md has figures).
 * Errors: INVALID_ARGUMENT (no round, no frame), OUT_OF_MEMORY. */
VOX_API vox_result vox_experiment_time(const uint64_t* frame_ns, uint64_t rounds, uint64_t frames, double* out_ns);

#define VOX_FIT_CAPACITY 9u /* most coefficients of a fit */

/* A polynomial fitted to the logarithms of times: ln(time) = sum of coefficients[k] * u^k for k = 0 to degree, where u
 * goes from -1 at range_min to 1 at range_max and is linear in ln(cell size). */
typedef struct vox_time_fit {
    uint32_t struct_size;
    uint32_t degree; /* 2 to VOX_FIT_CAPACITY - 1, the one with the least prediction_error */
    double range_min; /* smallest and largest cell size */
    double range_max;
    double coefficients[VOX_FIT_CAPACITY];
    double r_squared;        /* share of the variance of ln(time) that is explained */
    double prediction_error; /* root mean square error of predicting each point from a fit to all others, in ln(time),
                              * so roughly a relative error */
    double cell_size;        /* cell size of the least fitted time */
    double time;             /* that time, in the unit of the times given */
    uint32_t bracketed;      /* 1: cell_size is inside the range; 0: it is at one end, so the best may be beyond it */
    uint32_t reserved;
} vox_time_fit;

/* Fits times > 0 (in any unit) to cell sizes > 0, which may repeat. Set out_fit->struct_size first.
 * Errors: INVALID_ARGUMENT (a number that is not finite and above 0, named by its index; fewer than five different cell
 * sizes), OUT_OF_MEMORY. */
VOX_API vox_result vox_fit_times(const double* cell_sizes, const double* times, uint64_t count, vox_time_fit* out_fit);

/* The fitted time at a cell size within the range. Errors: INVALID_ARGUMENT (a cell size outside the range, or a `fit`
 * that vox_fit_times did not fill). */
VOX_API vox_result vox_fit_time_at(const vox_time_fit* fit, double cell_size, double* out_time);

/* The zone: the range of cell sizes around the best one in which the fitted time is at most `limit`. It ends at
 * range_min or range_max if the time stays below the limit up to there.
 * Errors: INVALID_ARGUMENT (a limit below fit->time). */
VOX_API vox_result vox_fit_zone(const vox_time_fit* fit, double limit, double* out_min, double* out_max);

#ifdef __cplusplus
}
#endif

#endif
