/* vox_cell_size: the best cell size of a uniform grid, and the reasons for it.
 *
 * The method: write the cost of a grid's work as a function of the cell size, and minimise it. Here it is:
 *   vox_suggest_cell_size       the paper's grid and this library's grids, from meshes alone
 *   vox_foreign_grid_suggest    any other uniform grid, whatever it stores, from a description
 *   vox_foreign_grid_fit        the same, from a few timings
 *   vox_foreign_grid_tune       the same, by running it at cell sizes that the library chooses
 *   vox_cost_minimise           any other algorithm, from a cost function of yours
 * All of them fill a vox_cell_size_result. A program that only collides bodies does not need this header: a vox_grid
 * chooses its cell size itself. docs/cost-models.md and docs/grid-counts.md derive the formulas.
 *
 * Conventions: as in vox.h, and
 *   Threads    Functions run on any thread at any time, and callbacks on the thread that calls. The process keeps no
 *              state.
 *   Memory     comes from the allocator of the description, and is released when the call returns.
 */
#ifndef VOX_VOX_CELL_SIZE_H
#define VOX_VOX_CELL_SIZE_H

#include <vox/vox.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- results ---------------------------------------------------------------------------------- */

#define VOX_CURVE_CAPACITY 64u  /* most samples of a curve */
#define VOX_TERM_CAPACITY 12u   /* most terms of a cost */
#define VOX_RULE_CAPACITY 8u    /* most rules that are compared */
#define VOX_TIMING_CAPACITY 32u /* most runs of vox_foreign_grid_tune */
#define VOX_NOTE_CAPACITY 256u  /* bytes of a note, its zero included; it is cut to that */

/* What a result depends on, combined with |. vox_cell_size_result.note says it in words, with numbers. */
typedef enum vox_cell_size_warnings {
    VOX_CELL_SIZE_GUESSED_WEIGHTS = 1,   /* nothing is known of the grid's times; a few timings would help */
    VOX_CELL_SIZE_BY_RULE = 2,           /* it is the mean edge: the weights do not show for certain that another is
                                            better */
    VOX_CELL_SIZE_AT_MINIMUM = 4,        /* it is min_cell_size, though a smaller one would cost less */
    VOX_CELL_SIZE_FROM_SPACING = 8,      /* the primitives have no size; it follows from the distances between them */
    VOX_CELL_SIZE_ONE_PLACE = 16,        /* all primitives are in one place; any large enough cell size will do */
    VOX_CELL_SIZE_MODEL_DISAGREES = 32,  /* the timings do not follow the counts of the described grid */
    VOX_CELL_SIZE_TIMINGS_DISAGREE = 64, /* timings at the same cell size differ widely */
    VOX_CELL_SIZE_OUT_OF_RANGE = 128,    /* the best cell size lies beyond those that were timed */
    VOX_CELL_SIZE_STOPPED = 256          /* the callback stopped, or could not run at a cell size */
} vox_cell_size_warnings;

/* A point of a cost curve. */
typedef struct vox_cost_sample {
    double cell_size;
    double cost;
} vox_cost_sample;

/* One kind of work: how often it is done at the suggested cell size, and what that costs. */
typedef struct vox_cost_term {
    const char* name; /* static text, e.g. "visit a cell" */
    double count;
    double cost;
} vox_cost_term;

/* The cell size that a rule of thumb gives, and the predicted cost there. */
typedef struct vox_cell_size_rule {
    const char* name; /* static text, e.g. "mean edge (Teschner et al. 2003)" */
    double cell_size; /* 0: the rule does not apply */
    double cost;      /* 0: not known */
} vox_cell_size_rule;

/* A run at one cell size, and how long it took. */
typedef struct vox_timing {
    double cell_size; /* > 0 */
    double seconds;   /* 1e-30 to 1e30; in a result infinity if the run was impossible */
} vox_timing;

/* How many nanoseconds a foreign grid takes for each kind of work, >= 0. */
typedef struct vox_foreign_weights {
    double run;      /* for a run, whatever the cell size */
    double store;    /* to store a primitive in a cell */
    double visit;    /* to visit a cell in a query */
    double found;    /* extra, to visit a cell that is not empty */
    double read;     /* to read a primitive in a visited cell */
    double occupied; /* to create and drop a cell that is not empty */
    double cell;     /* to clear a cell of a dense grid */
} vox_foreign_weights;

/* A cell size and the reasons for it. Costs are seconds of a step or a run; for the model PAPER they are visits of
 * cells per tetrahedron. Fields that a function does not know are 0. */
typedef struct vox_cell_size_result {
    uint32_t struct_size;
    uint32_t warnings;     /* vox_cell_size_warnings */
    double cell_size;
    double zone_min;       /* the range around cell_size where the cost is at most (1 + zone_loss) times the least */
    double zone_max;
    double cost;           /* predicted at cell_size */
    double min_cell_size;  /* the smallest that gives right answers, or fits the byte budget; 0: any */
    double cells_per_axis; /* edge of the world divided by cell_size, as the paper counts */
    double fit_error;      /* of fit and tune: root mean square of (fitted time / measured time - 1) */
    double expected_loss;  /* of tune: how much longer a run may take than at the best cell size; 0.03 means 3 % */
    uint32_t curve_count;
    uint32_t term_count;
    uint32_t rule_count;
    uint32_t timing_count;
    vox_cost_sample curve[VOX_CURVE_CAPACITY]; /* ascending, evenly spaced in the logarithm of the cell size */
    vox_cost_term terms[VOX_TERM_CAPACITY];    /* their costs add up to `cost` */
    vox_cell_size_rule rules[VOX_RULE_CAPACITY];
    vox_timing timings[VOX_TIMING_CAPACITY];   /* of tune: the runs, in order */
    vox_foreign_weights weights;               /* of foreign grids: those used, or those found by fit and tune */
    char note[VOX_NOTE_CAPACITY];              /* the warnings in words; "" if there are none */
} vox_cell_size_result;

/* ---- meshes ----------------------------------------------------------------------------------- */

typedef enum vox_cost_model {
    VOX_COST_MODEL_PAPER = 0,     /* the paper's z(delta) (Sect. 4, Eqs. 3-8) */
    VOX_COST_MODEL_REFERENCE = 1, /* a step of the paper's engine, counted tetrahedron by tetrahedron */
    VOX_COST_MODEL_FAST = 2,      /* a step of the fast engine, with the same cell size everywhere */
    VOX_COST_MODEL_SURFACE = 3    /* the searches of vox_surface.h in the meshes' surfaces */
} vox_cost_model;

typedef enum vox_reference_flags {
    VOX_REFERENCE_DENSE = 1,     /* store a list for every cell of a box, instead of hashing cells into a table */
    VOX_REFERENCE_PAPER_HASH = 2 /* hash by i*73856093 xor j*19349663 xor k*83492791 (Teschner et al. 2003, Sect.
                                    4.1), instead of by a well-mixed hash */
} vox_reference_flags;

#define VOX_COST_WEIGHT_CAPACITY 24u /* numbers in vox_cost_weights */

/* How many nanoseconds each kind of work takes on a machine, for the models REFERENCE and FAST. Measured by
 * vox_cost_calibrate; may be saved and loaded. */
typedef struct vox_cost_weights {
    uint32_t struct_size;
    uint32_t measured;                   /* 1 if vox_cost_calibrate filled it */
    double ns[VOX_COST_WEIGHT_CAPACITY]; /* in the library's own order; 0: the value shipped with the library */
} vox_cost_weights;

/* The paper's engine (Sect. 3), for vox_grid_desc.reference. It is serial and finds what the fast engine finds. If
 * the grid's cell_size is 0, it chooses by its cost model, and again when its counters call for another size. */
typedef struct vox_reference_desc {
    uint32_t struct_size;
    uint32_t flags;           /* vox_reference_flags, combined with | */
    uint64_t hash_table_size; /* raised to the next prime; 0: twice the number of vertices */
    double world_min[3];      /* DENSE: the box that has cells. Points outside go to the nearest cell. Both 0: the */
    double world_max[3];      /* box of all positions, in every step */
    VOX_OPTIONAL const vox_cost_weights* weights; /* copied; null: those shipped with the library */
} vox_reference_desc;

static inline vox_reference_desc vox_default_reference_desc(void) {
    vox_reference_desc desc = VOX_ZERO;
    desc.struct_size = (uint32_t)sizeof desc;
    return desc;
}

/* How to suggest a cell size; all 0 by default. */
typedef struct vox_cell_size_desc {
    uint32_t struct_size;
    vox_cost_model model;
    uint32_t reference_flags; /* REFERENCE: vox_reference_flags, combined with | */
    uint32_t reserved;        /* 0 */
    double zone_loss;         /* 0: 0.05 */
    double p_nc;              /* PAPER: the share of tetrahedra without a contact, in (0, 1); 0: 0.99 */
    double cost_ratio;        /* PAPER: r, the cost of a particle test divided by the cost of a cell visit; 0: 5 */
    double world_edge;        /* for cells_per_axis; 0: the longest side of the box of all vertices */
    uint64_t byte_budget;     /* REFERENCE with DENSE cells: most bytes that these may take; 0: no limit */
    VOX_OPTIONAL const vox_cost_weights* weights; /* REFERENCE and FAST; null: those shipped with the library */
    VOX_OPTIONAL const vox_allocator* allocator;  /* null: the C++ runtime's heap */
} vox_cell_size_desc;

static inline vox_cell_size_desc vox_default_cell_size_desc(void) {
    vox_cell_size_desc desc = VOX_ZERO;
    desc.struct_size = (uint32_t)sizeof desc;
    return desc;
}

/* Suggests the cell size with the least cost for these meshes as they are now. Set out->struct_size first. The
 * elements of `meshes` are meshes[0].struct_size bytes apart. Their filters count only for self-collision. Large
 * meshes are sampled: with PAPER, meshes of more than 200,000 tetrahedra.
 * Errors: INVALID_ARGUMENT (also if no tetrahedron has a size), INVALID_MESH, NON_FINITE, LIMIT, OUT_OF_MEMORY,
 * UNSUPPORTED (SURFACE in a build without surfaces). */
VOX_API vox_result vox_suggest_cell_size(VOX_OPTIONAL const vox_cell_size_desc* desc, const vox_mesh_desc* meshes,
                                         uint64_t mesh_count, vox_cell_size_result* out);

/* Suggests a cell size for the meshes of a grid. It is faster, as samples are smaller. Without desc it uses the
 * model of the grid's engine. If p_nc is 0, it is taken from the last step.
 * Errors: as vox_suggest_cell_size; also INVALID_STATE (a mesh without positions). */
VOX_API vox_result vox_grid_suggest_cell_size(const vox_grid* grid, VOX_OPTIONAL const vox_cell_size_desc* desc,
                                              vox_cell_size_result* out);

/* Measures this machine's weights with steps over a small scene, in about ten milliseconds. Set out->struct_size
 * first.
 * Errors: OUT_OF_MEMORY. */
VOX_API vox_result vox_cost_calibrate(vox_cost_weights* out);

/* Sizes in meshes, as in the paper's tables. */
typedef struct vox_geometry {
    uint32_t struct_size;
    uint32_t reserved;
    uint64_t vertices;
    uint64_t tets;
    uint64_t edges;           /* unique */
    uint64_t facets;          /* unique */
    uint64_t boundary_facets; /* of exactly one tetrahedron */
    uint64_t degenerate_tets; /* of zero volume; exact */
    double mean_edge;
    double mean_longest_edge;   /* over tetrahedra */
    double mean_box_side;       /* over tetrahedra, the longest side of the box */
    double median_box_side;
    double mean_facet_area;     /* over unique facets */
    double mean_tet_facet_area; /* over the four facets of each tetrahedron */
    double mean_boundary_facet_area;
    double mean_volume;
    double bounds_min[3];
    double bounds_max[3];
} vox_geometry;

/* Measures meshes, which are given as for vox_suggest_cell_size. Above 200,000 tetrahedra, means are estimated from
 * samples. Set out->struct_size first. Errors: INVALID_ARGUMENT, INVALID_MESH, NON_FINITE, OUT_OF_MEMORY. */
VOX_API vox_result vox_measure_geometry(const vox_mesh_desc* meshes, uint64_t mesh_count, vox_geometry* out);

/* ---- any algorithm ---------------------------------------------------------------------------- */

/* Returns the cost at a cell size; infinity or NaN if it is impossible. Called on the calling thread. Must not
 * throw. */
typedef double vox_cost_function(double cell_size, void* user);

/* Finds the cell size between min and max with the least cost: a scan evenly spaced in the logarithm, then a
 * golden-section search, in about a hundred calls. zone_loss 0 means 0.05. Set out->struct_size first.
 * Errors: INVALID_ARGUMENT (unless 0 < min <= max; no finite cost; a negative least cost). */
VOX_API vox_result vox_cost_minimise(vox_cost_function* cost, void* user, double min, double max, double zone_loss,
                                     vox_cell_size_result* out);

/* ---- other uniform grids ---------------------------------------------------------------------- */

typedef enum vox_primitive_type {
    VOX_PRIMITIVE_POINT = 0,    /* one vertex */
    VOX_PRIMITIVE_EDGE = 1,     /* two */
    VOX_PRIMITIVE_TRIANGLE = 2, /* three */
    VOX_PRIMITIVE_TET = 3,      /* four */
    VOX_PRIMITIVE_BOX = 4       /* two: opposite corners, in any order */
} vox_primitive_type;

/* An array of primitives. Only the box of each one matters: the box of its vertices, grown by its radius on all
 * sides. */
typedef struct vox_primitives {
    uint32_t struct_size;
    vox_primitive_type type;
    vox_positions positions; /* of vertices */
    VOX_OPTIONAL const uint32_t* indices; /* the vertices of each primitive; null: 0, 1, 2, ... in order */
    uint64_t index_byte_stride;           /* from one primitive to the next; 0: packed */
    uint64_t count;                       /* number of primitives */
    VOX_OPTIONAL const void* radii;       /* one number >= 0 for each primitive; null: 0 */
    uint64_t radius_byte_stride;          /* 0: packed */
    vox_format radius_format;
    uint32_t reserved; /* 0 */
    double radius;     /* added to all radii */
} vox_primitives;

static inline vox_primitives vox_default_primitives(void) {
    vox_primitives primitives = VOX_ZERO;
    primitives.struct_size = (uint32_t)sizeof primitives;
    return primitives;
}

/* Grids whose layout and weights are known, as measured by bench/foreign. */
typedef enum vox_known_grid {
    VOX_KNOWN_GRID_NONE = 0,         /* the weights with the smallest worst loss over all grids below */
    VOX_KNOWN_GRID_SORTED = 1,       /* C++: a counting sort into a dense lattice */
    VOX_KNOWN_GRID_HASHED = 2,       /* C++: std::unordered_map from cell to list */
    VOX_KNOWN_GRID_WARP = 3,         /* NVIDIA Warp's HashGrid on the processor */
    VOX_KNOWN_GRID_IPC = 4,          /* IPC Toolkit's SpatialHash */
    VOX_KNOWN_GRID_IPC_PAIRS = 5,    /* IPC Toolkit's HashGrid */
    VOX_KNOWN_GRID_VTK = 6,          /* VTK's vtkStaticCellLocator */
    VOX_KNOWN_GRID_PBAT = 7,         /* PBAT's HashGrid3 */
    VOX_KNOWN_GRID_POINT_VOXELS = 8, /* hashed voxels of points, as in PCL and Open3D */
    VOX_KNOWN_GRID_NUMPY = 9         /* sorted keys in numpy */
} vox_known_grid;

/* The cells that store a primitive. */
typedef enum vox_cells_stored {
    VOX_CELLS_STORED_DEFAULT = 0, /* as in the known grid, else BOX */
    VOX_CELLS_STORED_BOX = 1,     /* all cells that its box meets */
    VOX_CELLS_STORED_CENTRE = 2   /* the cell that contains the centre of its box */
} vox_cells_stored;

/* The cells that a query visits. */
typedef enum vox_cells_queried {
    VOX_CELLS_QUERIED_DEFAULT = 0, /* as in the known grid, else BOX */
    VOX_CELLS_QUERIED_BOX = 1,     /* all cells that its box meets; one for a point */
    VOX_CELLS_QUERIED_27 = 2,      /* the cell that contains its centre, and the 26 cells around it. Only with CENTRE */
    VOX_CELLS_QUERIED_PAIRS = 3    /* none: the grid goes through its cells and reports every pair within a cell */
} vox_cells_queried;

/* The cells that exist. */
typedef enum vox_cells_kept {
    VOX_CELLS_KEPT_DEFAULT = 0,  /* as in the known grid, else OCCUPIED */
    VOX_CELLS_KEPT_OCCUPIED = 1, /* those that store something */
    VOX_CELLS_KEPT_DENSE = 2     /* all cells in the box of the stored primitives */
} vox_cells_kept;

/* A uniform grid of another library. A run stores primitives in cells; then each query visits cells and reads the
 * primitives stored there. */
typedef struct vox_foreign_grid {
    uint32_t struct_size;
    vox_known_grid known;
    vox_cells_stored cells_stored;
    vox_cells_queried cells_queried;
    vox_cells_kept cells_kept;
    uint32_t reserved;            /* 0 */
    const vox_primitives* stored;                /* the primitives in cells; must be set */
    VOX_OPTIONAL const vox_primitives* querying; /* the queries; null: the stored primitives query each other. With
                                                    PAIRS it is a second set: each pair has one of either */
    double radius;               /* grows the boxes of queries on all sides */
    double min_cell_size;        /* the smallest that gives right answers; 0: any, or with 27 what the boxes demand */
    double zone_loss;            /* 0: 0.05 */
    vox_foreign_weights weights; /* all 0: as for the known grid */
    VOX_OPTIONAL const vox_allocator* allocator; /* null: the C++ runtime's heap */
} vox_foreign_grid;

static inline vox_foreign_grid vox_default_foreign_grid(void) {
    vox_foreign_grid grid = VOX_ZERO;
    grid.struct_size = (uint32_t)sizeof grid;
    return grid;
}

/* Suggests the cell size with the least cost. Set out->struct_size first. Many primitives are sampled.
 * Errors: INVALID_ARGUMENT (also for no primitives, and for 27 without CENTRE), INVALID_MESH, NON_FINITE, LIMIT,
 * OUT_OF_MEMORY. */
VOX_API vox_result vox_foreign_grid_suggest(const vox_foreign_grid* grid, vox_cell_size_result* out);

/* How often a run does what, on average over all positions of the lattice. */
typedef struct vox_foreign_counts {
    double stored;   /* primitives stored in a cell */
    double visits;   /* cells visited; with PAIRS, cells that store something */
    double empty;    /* visited cells that store nothing */
    double reads;    /* primitives read in visited cells; with PAIRS, pairs within a cell */
    double occupied; /* cells that store something */
    double cells;    /* cells in the box of the stored primitives */
} vox_foreign_counts;

/* Predicts the counts of a run at a cell size, for comparison with a program's own counters.
 * Errors: as vox_foreign_grid_suggest; also INVALID_ARGUMENT (not a finite number above 0) and LIMIT (much too
 * small). */
VOX_API vox_result vox_foreign_grid_count(const vox_foreign_grid* grid, double cell_size, vox_foreign_counts* out);

/* Finds weights and cell size from timings of whole runs at three or more cell sizes; 0.6, 1.2 and 2.4 mean edges
 * will do. It fits by non-negative least squares of relative errors. The weights also hold for other scenes in the
 * same grid. Set out->struct_size first.
 * Errors: as vox_foreign_grid_suggest; also INVALID_ARGUMENT (too few timings, or one out of range). */
VOX_API vox_result vox_foreign_grid_fit(const vox_foreign_grid* grid, const vox_timing* timings, uint64_t count,
                                        vox_cell_size_result* out);

/* Runs the caller's grid once, and returns how many seconds that took; infinity if this cell size is impossible; a
 * negative number or NaN to stop tuning. Called on the calling thread. Must not throw. */
typedef double vox_foreign_run(double cell_size, void* user);

/* How to tune; all 0 by default. */
typedef struct vox_tune_desc {
    uint32_t struct_size;
    uint32_t max_runs;  /* 3 to VOX_TIMING_CAPACITY; 0: 7 */
    double min;         /* the range of cell sizes to try; both 0: from 1/8 to 8 times the first */
    double max;
    double first;       /* the cell size to begin with; 0: as vox_foreign_grid_suggest says */
    double wanted_loss; /* stop when the expected loss is below this; 0: 0.02 */
} vox_tune_desc;

static inline vox_tune_desc vox_default_tune_desc(void) {
    vox_tune_desc desc = VOX_ZERO;
    desc.struct_size = (uint32_t)sizeof desc;
    return desc;
}

/* Finds the best cell size by running the grid a few times. Without a description of the grid, desc->first must be
 * set. The same times lead to the same runs and the same result. Set out->struct_size first.
 * Errors: as vox_foreign_grid_suggest; also INVALID_STATE (no run succeeded), INVALID_ARGUMENT (a run of less than
 * 1e-30 seconds). */
VOX_API vox_result vox_foreign_grid_tune(VOX_OPTIONAL const vox_foreign_grid* grid,
                                         VOX_OPTIONAL const vox_tune_desc* desc, vox_foreign_run* run, void* user,
                                         vox_cell_size_result* out);

#ifdef __cplusplus
}
#endif

#endif
