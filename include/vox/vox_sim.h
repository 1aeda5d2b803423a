/* vox_sim: deformable bodies that fall, collide and rest, on the public interface of vox. A library of its own; the
 * core does not need it.
 *
 * It is there for the experiment (time of detection against cell size), the examples and the demo: small, clear and
 * hard to upset rather than complete. A game or a film wants an engine of its own, with vox inside.
 *
 * Bodies are particles joined by tetrahedra. vox_sim_step cuts the time step into substeps; in each, the grid finds the
 * penetrations (vox_grid_penetrations), the particles move freely, and then edge lengths, volumes, contacts and the
 * floor are answered by XPBD, one sweep each in a fixed order (docs/sim.md).
 *
 * The conventions of vox.h hold here too: vox_result, vox_last_error(), struct_size, untouched out-parameters on
 * failure. Everything is double; the same calls give the same bits, for any number of workers of the grid.
 *
 *   Threads   One thread at a time may use a sim, or an experiment. Different ones are independent.
 *   Units     One unit of length, mass and time throughout. The defaults suit metres, kilograms and seconds.
 *   Ownership What is given is copied. Views live as their comment says.
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
    /* Of a step, 1 to 10000; default 10. The stiffness that a body can have goes with their square, and with that of
     * the length of its edges; what is above it is cut down to it, with a log line. */
    uint32_t substeps;
    /* Detections: before the first substep of a step and after every `detect_every` substeps of it. 1 (the default):
     * in every substep; the number of substeps or more: once a step. 0: never, bodies pass through each other. */
    uint32_t detect_every;
    uint32_t reserved;    /* 0 */
    double gravity[3];    /* acceleration; default 0, 0, -9.81 */
    double max_time_step; /* a longer step is cut down to this, with a log line; 1e-12 to 1e12, default 1/30 */
    /* The floor: particles stay where floor_normal . x >= floor_offset. Default normal 0, 0, 1 and offset 0; it is
     * brought to unit length (floor_offset is taken with the unit normal). All zero: no floor. */
    double floor_normal[3];
    double floor_offset;
    double friction; /* Coulomb's coefficient, between bodies and with the floor; >= 0, default 0.5 */
    /* A penetrating vertex is pushed out by a force of depth / contact_compliance along the direction of the depth
     * stage, integrated implicitly, so that no stiffness can explode. >= 0; 0 (the default): the stiffest that a
     * substep can answer. */
    double contact_compliance;
    double max_push_speed; /* at which old penetrations are undone, >= 0; default 1. They gain no speed from it */
    double contact_slop;   /* depth that is left alone, so that resting contacts stay; >= 0, negative (the default
                            * is -1): a hundredth of the mean rest edge of the two bodies */
    const vox_grid_desc* grid; /* settings of the grid inside, read during create; null: defaults */
    vox_log log;               /* of the simulation; the grid's own is in its desc */
} vox_sim_desc;

/* Fills `desc` with the defaults for the fields that `struct_size` covers. */
VOX_API vox_result vox_sim_desc_init(vox_sim_desc* desc, uint32_t struct_size);

static inline vox_sim_desc vox_default_sim_desc(void) {
    vox_sim_desc desc;
    (void)vox_sim_desc_init(&desc, (uint32_t)sizeof desc);
    return desc;
}

/* Creates a simulation without bodies. desc null: all defaults. The caller owns *out_sim and ends it with
 * vox_sim_destroy. Errors: INVALID_ARGUMENT (names the field and its value), OUT_OF_MEMORY, BUDGET. */
VOX_API vox_result vox_sim_create(const vox_sim_desc* desc, vox_sim** out_sim);

/* Ends a simulation with its bodies and its grid; all views are invalid. Null does nothing. */
VOX_API void vox_sim_destroy(vox_sim* sim);

/* The grid inside, where the contacts and penetrations of the last detection can be read, the cell size and the
 * number of workers set, and counters and profile had. It borrows the bodies' positions and belongs to the sim: do
 * not destroy or clear it, and remove none of its meshes. Meshes inserted by others are detected, but not answered. */
VOX_API vox_result vox_sim_grid(const vox_sim* sim, vox_grid** out_grid);

/* Moves everything forward by `time_step`, or by max_time_step if that is less.
 * Errors: INVALID_ARGUMENT (not a finite number of at least 1e-12), and those of vox_grid_step; then the bodies are
 * as after the last substep that was completed. */
VOX_API vox_result vox_sim_step(vox_sim* sim, double time_step);

/* ---- bodies ----------------------------------------------------------------------------------- */

/* A body is named by its mesh in the grid of the sim, so contacts name bodies. */

typedef enum vox_sim_body_flags {
    VOX_SIM_BODY_SELF_COLLISION = 1, /* collides with itself too */
    VOX_SIM_BODY_FIXED = 2,          /* never moves; others collide with it */
    VOX_SIM_BODY_FLAGS_FORCE_32_BITS = 0x7fffffff
} vox_sim_body_flags;

typedef struct vox_sim_body_desc {
    uint32_t struct_size;
    uint32_t flags;               /* vox_sim_body_flags, combined with | */
    const double* positions;      /* 3 * vertex_count; within 1e15 of the origin on each axis */
    const double* rest_positions; /* the undeformed shape; null (the default): `positions` */
    const double* velocities;     /* 3 * vertex_count; null (the default): at rest */
    const uint32_t* tets;         /* 4 * tet_count; both windings are accepted */
    uint64_t vertex_count;
    uint64_t tet_count; /* at least 1 */
    double density;     /* mass over rest volume, > 0; default 1000. Lumped to the vertices, none of which is made
                         * lighter than a hundredth of their mean; those in no tet weigh as much */
    /* Resistance to stretching. The edges are springs whose stiffness a material of this Young's modulus would have if
     * its edges ran in all directions alike. >= 0, default 1e6. */
    double youngs_modulus;
    double bulk_modulus; /* resistance to change of volume, beyond that of the edges; >= 0, default 1e6 */
    double damping;      /* time: edges resist the rate of their strain with this times the stiffness; >= 0, default
                          * 0.01 */
    uint64_t user_data;  /* given back by vox_mesh_user_data on the sim's grid */
} vox_sim_body_desc;

/* Fills `desc` with the defaults for the fields that `struct_size` covers. */
VOX_API vox_result vox_sim_body_desc_init(vox_sim_body_desc* desc, uint32_t struct_size);

static inline vox_sim_body_desc vox_default_sim_body_desc(void) {
    vox_sim_body_desc desc;
    (void)vox_sim_body_desc_init(&desc, (uint32_t)sizeof desc);
    return desc;
}

/* Adds a body. Tets of zero rest volume get no volume constraint; they and the inverted ones (which keep their
 * negative volume) are counted, and told in one log line.
 * Errors: INVALID_ARGUMENT (names the field and its value; also: no tet, or all of them flat, so that the body has no
 * mass), INVALID_MESH, NON_FINITE (names the vertex), LIMIT, BUDGET, OUT_OF_MEMORY. */
VOX_API vox_result vox_sim_body_insert(vox_sim* sim, const vox_sim_body_desc* desc, vox_mesh* out_body);

/* Takes a body out. */
VOX_API vox_result vox_sim_body_remove(vox_sim* sim, vox_mesh body);

/* Arrays of a body: its state after the last step. The pointers stay the same, and their contents follow the
 * simulation, until the body is removed. */
typedef struct vox_sim_body_view {
    const double* positions;     /* 3 * vertex_count */
    const double* velocities;    /* 3 * vertex_count */
    const double* masses;        /* vertex_count */
    const float* grid_positions; /* 3 * vertex_count: `positions` rounded, which the grid borrows */
    const uint32_t* tets;        /* 4 * tet_count */
    uint64_t vertex_count;
    uint64_t tet_count;
} vox_sim_body_view;

/* The body's arrays. */
VOX_API vox_result vox_sim_body_get(const vox_sim* sim, vox_mesh body, vox_sim_body_view* out_view);

/* Puts a body elsewhere, or back: 3 * vertex_count numbers each, null: as they are. The rest shape stays.
 * Errors: NON_FINITE (names the vertex), INVALID_ARGUMENT (too far out). */
VOX_API vox_result vox_sim_body_set_state(vox_sim* sim, vox_mesh body, const double* positions,
                                          const double* velocities);

/* An acceleration of all particles of a body from now on, in addition to gravity; at first 0, 0, 0.
 * Errors: INVALID_ARGUMENT (not a number of at most 1e15 on an axis). */
VOX_API vox_result vox_sim_body_set_acceleration(vox_sim* sim, vox_mesh body, const double acceleration[3]);

/* ---- measurements ----------------------------------------------------------------------------- */

typedef struct vox_sim_energies {
    uint32_t struct_size;
    uint32_t reserved;
    double kinetic;
    double potential;  /* in gravity, 0 at the origin */
    double elastic;    /* of edges and volumes */
    double mass;
    double momentum[3];
    double centre[3];  /* of mass */
    double max_speed;  /* of a particle */
} vox_sim_energies;

/* Energy and motion of a body, or of all bodies that are not fixed (body VOX_NULL_MESH): of the middle of the last
 * substep, which is what velocities belong to; the positions of vox_sim_body_get are half a substep ahead.
 * Writes the fields that out_energies->struct_size covers (set it first). */
VOX_API vox_result vox_sim_energy(const vox_sim* sim, vox_mesh body, vox_sim_energies* out_energies);

typedef struct vox_sim_counts {
    uint32_t struct_size;
    uint32_t bodies;
    uint64_t vertices;
    uint64_t tets;
    uint64_t edges;         /* edge constraints */
    uint64_t volumes;       /* volume constraints */
    uint64_t flat_tets;     /* of zero rest volume */
    uint64_t inverted_tets; /* of negative rest volume */
    uint64_t raised_masses; /* vertices that would have been lighter than a hundredth of the body's mean */
    uint64_t softened;      /* constraints stiffer than the last step's substeps can answer, made softer */
    uint64_t steps;         /* so far, as are the following */
    uint64_t substeps;
    uint64_t detections;
    uint64_t clamped_steps; /* cut down to max_time_step */
    uint64_t penetrations;  /* of the last detection */
    uint64_t floor_contacts; /* particles that the floor held in the last substep */
    uint64_t step_ns;       /* time of the last step, whole and in parts */
    uint64_t detect_ns;     /* in vox_grid_step */
    uint64_t solve_ns;      /* the rest */
} vox_sim_counts;

/* Writes the fields that out_counts->struct_size covers (set it first). */
VOX_API vox_result vox_sim_counters(const vox_sim* sim, vox_sim_counts* out_counts);

/* ---- the experiment --------------------------------------------------------------------------- */

/* Time of detection against cell size, as in Sect. 5 of the paper: two bodies where about 1 % of their tetrahedra are
 * in contact; the response pushes them apart and deforms them; the detection of ten frames is timed.
 *
 * Contacts do not depend on the cell size, and so the motion does not either: it is simulated once, when the experiment
 * is created, and every sample detects the contacts of the very same recorded frames. A whole experiment is:
 * vox_experiment_create; for each round and each cell size in the order of vox_experiment_order, one
 * vox_experiment_measure; for each cell size vox_experiment_time over its rounds; vox_fit_times; vox_fit_zone;
 * vox_experiment_suggest and vox_zone_distance. `vox sweep` is just that. */
typedef struct vox_experiment vox_experiment;

typedef struct vox_experiment_desc {
    uint32_t struct_size;
    uint32_t frames;               /* detections in a sample, 1 to 1000; default 10 */
    const vox_sim_body_desc* a;    /* stays where it is */
    const vox_sim_body_desc* b;    /* moved to touch a; null (the default): another one like a */
    const vox_sim_desc* sim;       /* how they move; null (the default): vox_sim's defaults, without a floor */
    const vox_grid_desc* grid;     /* what is measured, but for its cell size; null (the default): vox's defaults with
                                    * the reference engine */
    double axis[3];                /* b comes from here, seen from a: its centre moves along this line through the
                                    * centre of a (centres of the bounding boxes); default 1, 0, 0 */
    double contact_share;          /* wanted mean over the frames of the share of all tets that hold a vertex of the
                                    * other body, in (0, 1); default 0.01 */
    double time_step;              /* of a frame, > 0; default 1/100 */
    uint32_t turn;                 /* 1 (the default): both bodies are turned about their centres by fixed angles
                                    * first, each by its own, so that bodies cut from a lattice line up neither with
                                    * the cells nor with one another; 0: they stay as they are */
    uint32_t reserved;             /* 0 */
} vox_experiment_desc;

/* Fills `desc` with the defaults for the fields that `struct_size` covers. */
VOX_API vox_result vox_experiment_desc_init(vox_experiment_desc* desc, uint32_t struct_size);

static inline vox_experiment_desc vox_default_experiment_desc(void) {
    vox_experiment_desc desc;
    (void)vox_experiment_desc_init(&desc, (uint32_t)sizeof desc);
    return desc;
}

/* Places the bodies, simulates the frames and records them. What `desc` points to is read during the call. The caller
 * owns *out_experiment and ends it with vox_experiment_destroy.
 * The position is found by bisection from outside, so that b stands where the wanted share is reached first; then the
 * frames are simulated, and that is repeated a few times until the mean share over the frames is the wanted one. Tets
 * being countable, and the response quicker or slower, it is met roughly: see vox_experiment_facts.
 * Errors: INVALID_ARGUMENT (names the field and its value), INVALID_STATE (the share cannot be reached on this axis;
 * says what can), and those of vox_sim_create, vox_sim_body_insert and vox_grid_step. */
VOX_API vox_result vox_experiment_create(const vox_experiment_desc* desc, vox_experiment** out_experiment);

/* Ends an experiment. Null does nothing. */
VOX_API void vox_experiment_destroy(vox_experiment* experiment);

/* How the bodies stand and move. */
typedef struct vox_experiment_facts {
    uint32_t struct_size;
    uint32_t frames;
    uint64_t vertices; /* of both bodies, as are the following */
    uint64_t tets;
    uint64_t contacts; /* of all frames */
    uint64_t hash;     /* of vox_grid_hash in all frames: the same for every cell size and engine */
    double distance;   /* of the centres at first, along the axis */
    double mean_share; /* of the tets in contact, over the frames */
    const double* shares; /* `frames` of them, frame by frame; live until vox_experiment_destroy */
    double bounds_min[3]; /* of all vertices in all frames */
    double bounds_max[3];
} vox_experiment_facts;

/* Writes the fields that out_facts->struct_size covers (set it first); the shares live as long as the experiment. */
VOX_API vox_result vox_experiment_get(const vox_experiment* experiment, vox_experiment_facts* out_facts);

/* vox_suggest_cell_size for the two bodies as they are in the first frame, with its errors. */
VOX_API vox_result vox_experiment_suggest(const vox_experiment* experiment, const vox_suggest_desc* desc,
                                          vox_suggestion* out);

/* One sample: all frames at one cell size. Sums over the frames, but for the mean. */
typedef struct vox_experiment_sample {
    uint32_t struct_size;
    uint32_t reserved;
    double cell_size;
    double mean_ns; /* of detection in a frame: bin, broad and narrow phase and contacts; neither depth nor motion */
    uint64_t contacts;
    uint64_t visited_cells;
    uint64_t visited_entries;
    uint64_t candidates;
} vox_experiment_sample;

/* Measures one sample, after one step that is not timed. frame_ns: room for the times of the single frames, or null.
 * Set out_sample->struct_size first. The contacts are compared with those found during the simulation.
 * Errors: INVALID_ARGUMENT (a cell size that is not above 0 and finite), those of vox_grid_step, INTERNAL (the contacts
 * differ). */
VOX_API vox_result vox_experiment_measure(vox_experiment* experiment, double cell_size, uint64_t* frame_ns,
                                          vox_experiment_sample* out_sample);

/* The order in which a round measures `count` cell sizes: the numbers 0 to count - 1, shuffled; another order for each
 * round and seed, the same on every machine. So what disturbs the machine for a while hits no cell size in particular.
 * Errors: INVALID_ARGUMENT (count 0). */
VOX_API vox_result vox_experiment_order(uint64_t count, uint64_t seed, uint64_t round, uint64_t* out_order);

/* The time of one cell size from its rounds: for each frame the median of the rounds, of these the mean. frame_ns holds
 * `frames` times a round, round after round. Every round does the same work in the same frame, so a disturbance costs
 * the frames it falls into and not the whole round. Medians, since on a busy machine the least of the rounds hangs on
 * single lucky ones (docs/paper.md has figures). Errors: INVALID_ARGUMENT (no round, no frame), OUT_OF_MEMORY. */
VOX_API vox_result vox_experiment_time(const uint64_t* frame_ns, uint64_t rounds, uint64_t frames, double* out_ns);

#define VOX_FIT_CAPACITY 9u /* coefficients of a fit */

/* A polynomial through times, in logarithms: ln(time) = sum of coefficients[k] * u^k for k = 0 to degree, where u goes
 * from -1 at range_min to 1 at range_max, linear in ln(cell size). */
typedef struct vox_time_fit {
    uint32_t struct_size;
    uint32_t degree; /* 2 to VOX_FIT_CAPACITY - 1: the one of least prediction_error */
    double range_min; /* smallest and largest cell size */
    double range_max;
    double coefficients[VOX_FIT_CAPACITY];
    double r_squared;        /* share of the variance of ln(time) that is explained */
    double prediction_error; /* of a point by the fit to all others: root mean square in ln(time), so about relative */
    double cell_size;        /* of the least fitted time */
    double time;             /* that time, in the unit of the times given */
    uint32_t bracketed;      /* 1: it lies inside the range; 0: at one end, so that the best size may lie beyond */
    uint32_t reserved;
} vox_time_fit;

/* Fits times > 0 (in any unit) to cell sizes > 0, which may repeat. Set out_fit->struct_size first.
 * Errors: INVALID_ARGUMENT (a number that is not finite and above 0, named by its index; fewer than five different cell
 * sizes), OUT_OF_MEMORY. */
VOX_API vox_result vox_fit_times(const double* cell_sizes, const double* times, uint64_t count,
                                 vox_time_fit* out_fit);

/* The fitted time at a cell size within the range. Errors: INVALID_ARGUMENT (outside of it; a fit that is none). */
VOX_API vox_result vox_fit_time_at(const vox_time_fit* fit, double cell_size, double* out_time);

/* The cell sizes around the best one where the fitted time is at most `limit`: the zone. It ends at range_min or
 * range_max where the time stays below the limit up to there. Errors: INVALID_ARGUMENT (a limit below fit->time). */
VOX_API vox_result vox_fit_zone(const vox_time_fit* fit, double limit, double* out_min, double* out_max);

#ifdef __cplusplus
}
#endif

#endif
