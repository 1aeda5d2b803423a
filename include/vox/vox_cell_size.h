/* vox_cell_size: the best cell size of a uniform grid, and the reasons for it.
 *
 * The method: write the cost of a grid's work as a function of the cell size, and minimise it. Here it is for
 *   vox_suggest_cell_size   the paper's grid and those of this library, from meshes alone
 *   vox_suggest_for         any other uniform grid, whatever is in it, from a description
 *   vox_cost_fit            the same, from a few timings
 *   vox_cost_tune           the same, by running it at cell sizes that the library chooses
 *   vox_cost_minimise       any other algorithm, from a cost function of the caller's
 * A program that only collides bodies does not need this header: a vox_grid chooses its cell size itself.
 * docs/cell-size.md and docs/your-own-grid.md derive the formulas.
 *
 * Conventions: those of vox.h, and
 *   Threads    Functions without a grid run on any thread, at any time; callbacks on the thread that calls. What
 *              arguments point to is read during the call.
 */
#ifndef VOX_VOX_CELL_SIZE_H
#define VOX_VOX_CELL_SIZE_H

#include <vox/vox.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- weights ---------------------------------------------------------------------------------- */

#define VOX_COST_WEIGHT_CAPACITY 24u /* numbers of vox_cost_weights */

/* How many nanoseconds one unit of each piece of work takes on a machine: what the models REFERENCE and FAST, and the
 * reference engine, choose a cell size by. From vox_cost_calibrate; plain numbers, which may be saved and loaded. */
typedef struct vox_cost_weights {
    uint32_t struct_size;
    uint32_t measured;                   /* 1: by vox_cost_calibrate */
    double ns[VOX_COST_WEIGHT_CAPACITY]; /* in the library's own order, finite, >= 0; 0: the one shipped with the
                                            library */
} vox_cost_weights;

/* ---- reference engine ------------------------------------------------------------------------- */

typedef enum vox_reference_flags {
    VOX_REFERENCE_DENSE = 1,     /* store a list for every cell of a box (linear id k*nx*ny + j*nx + i), instead of
                                    hashing cells into a table */
    VOX_REFERENCE_PAPER_HASH = 2 /* hash by i*73856093 xor j*19349663 xor k*83492791 (Teschner et al. 2003, Sect. 4.1),
                                    instead of by a well-mixed hash */
} vox_reference_flags;

/* The paper's engine (Sect. 3), for vox_grid_desc.reference. It is serial and finds what the fast engine finds. If the
 * grid's cell_size is 0, it chooses by its cost model, at the first step, and again when the counts of its steps show
 * that another size would be better; each change is written to the log and counted in cell_size_changes. If the sizes
 * of the tetrahedra differ so much that a single cell size would be expensive, it uses a few grids in turn: each has a
 * cell size of its own, holds all vertices, and serves the tetrahedra of a range of sizes. Where positions were chosen
 * so that many cells share a bucket, the step finds cells by binary search instead, so its time stays bounded. */
typedef struct vox_reference_desc {
    uint32_t struct_size;
    uint32_t flags;           /* vox_reference_flags, combined with | */
    uint64_t hash_table_size; /* buckets, at most VOX_MAX_VERTICES, raised to the next prime; 0: the first prime that is
                                 at least twice the number of vertices */
    double world_min[3];      /* DENSE: the box that has cells, min < max on each axis. Points outside go to */
    double world_max[3];      /* the nearest cell. All 0: the box of all positions, in every step */
    VOX_OPTIONAL const vox_cost_weights* weights; /* copied; null: those shipped with the library */
} vox_reference_desc;

static inline vox_reference_desc vox_default_reference_desc(void) {
    vox_reference_desc desc = VOX_ZERO;
    desc.struct_size = (uint32_t)sizeof desc;
    return desc;
}

/* ---- cell size -------------------------------------------------------------------------------- */

typedef enum vox_cost_model {
    VOX_COST_MODEL_PAPER = 0,     /* the paper's z(delta) (Sect. 4, Eqs. 3-8), from means; in cell visits */
    VOX_COST_MODEL_REFERENCE = 1, /* the reference engine, counted tet by tet; in nanoseconds of a step */
    VOX_COST_MODEL_FAST = 2,      /* the fast engine with one cell size in all windows; in nanoseconds of a step */
    VOX_COST_MODEL_SURFACE = 3    /* the searches of vox_surface.h in the meshes' surfaces, for pairs of edges and of
                                     faces and vertices; in nanoseconds, of their grids alone */
} vox_cost_model;

/* How s, the size of a tetrahedron in Eq. 4, is measured. */
typedef enum vox_size_reading {
    VOX_SIZE_MEAN_EDGE = 0,         /* mean length of the unique edges; reproduces the paper's tables */
    VOX_SIZE_MEAN_LONGEST_EDGE = 1, /* mean over tets of the longest edge; as worded in Sect. 4.2 */
    VOX_SIZE_MEAN_BOX_SIDE = 2      /* mean over tets of the longest side of the bounding box */
} vox_size_reading;

/* How A, the facet area in Eqs. 5-7, is measured. */
typedef enum vox_area_reading {
    VOX_AREA_UNIQUE_FACETS = 0,   /* mean over all facets, shared ones counted once; reproduces the paper's tables */
    VOX_AREA_TET_FACETS = 1,      /* mean over the four facets of every tet */
    VOX_AREA_BOUNDARY_FACETS = 2  /* mean over the facets of exactly one tet */
} vox_area_reading;

typedef struct vox_suggest_desc {
    uint32_t struct_size;
    vox_cost_model model;
    vox_size_reading size_reading;
    vox_area_reading area_reading;
    double p_nc;               /* probability that a tet has no collision, in (0, 1); 0: 0.99 */
    double cost_ratio;         /* the paper's r: cost of a particle test divided by that of a cell visit; 0: 5 */
    double world_edge;         /* edge of the cubic world, for cells_per_axis; 0: longest side of the bounds */
    double zone_loss;          /* the zone is where predicted cost <= (1 + zone_loss) * minimum; at most 1e6; 0: 0.05 */
    double mean_edge_factor;   /* for rules.mean_edge_multiple (Gregory et al. 2000); 0: 2 */
    double resolution;         /* for rules.resolution (McNeely et al. 1999): the required detail; 0: none */
    uint64_t byte_budget;      /* REFERENCE with DENSE cells: most bytes that these may take; 0: no limit */
    uint32_t reference_flags;  /* REFERENCE: vox_reference_flags, combined with | */
    uint32_t reserved;         /* 0 */
    VOX_OPTIONAL const vox_cost_weights* weights; /* REFERENCE and FAST; null: those shipped with the library */
    VOX_OPTIONAL const vox_allocator* allocator;  /* of the call's memory; null: the C++ runtime's heap */
} vox_suggest_desc;

static inline vox_suggest_desc vox_default_suggest_desc(void) {
    vox_suggest_desc desc = VOX_ZERO;
    desc.struct_size = (uint32_t)sizeof desc;
    return desc;
}

/* Geometry of all meshes together, in the caller's unit. Above 1500 tets, and in grids, the means and the counts of
 * edges, facets and flat tets are estimates from samples. Tets that name a vertex twice have no edges and facets. */
typedef struct vox_geometry_stats {
    uint64_t vertices;
    uint64_t tets;
    uint64_t edges;           /* unique */
    uint64_t facets;          /* unique triangles */
    uint64_t boundary_facets; /* facets of exactly one tet */
    uint64_t degenerate_tets; /* of exactly zero volume */
    double mean_edge;
    double mean_longest_edge;
    double mean_box_side;
    double median_box_side; /* median over tets of the longest side of the bounding box */
    double mean_facet_area;
    double mean_tet_facet_area;
    double mean_boundary_facet_area;
    double mean_volume; /* mean over tets of |volume| */
    double bounds_min[3]; /* of the vertices that tets use; of all vertices for a mesh without tets */
    double bounds_max[3];
} vox_geometry_stats;

/* Cell sizes that other rules would choose; 0 where a rule does not apply. */
typedef struct vox_cell_size_rules {
    double mean_edge;          /* Teschner et al. 2003 */
    double mean_edge_multiple; /* Gregory et al. 2000: a constant times the mean edge */
    double object_512;         /* Garcia-Alonso et al. 1994: 512 voxels in an object's box, mean over meshes
                                  whose box has a volume */
    double resolution;         /* McNeely et al. 1999: the required resolution */
    double mean_volume;        /* cube root of the mean tet volume (tried and rejected in Sect. 5) */
    double median_box_side;    /* IPC Toolkit: median of the longest box sides */
} vox_cell_size_rules;

/* A point of a curve of costs. */
typedef struct vox_cost_sample {
    double cell_size;
    double cost;
} vox_cost_sample;

#define VOX_COST_CURVE_CAPACITY 64u     /* most samples of a curve */
#define VOX_COST_TERM_CAPACITY 12u      /* most terms of a cost, in any model */
#define VOX_CELL_SIZE_LEVEL_CAPACITY 4u /* most entries of vox_suggestion.levels */

/* One term of a cost: a piece of work, how often it is done, and what that costs. */
typedef struct vox_cost_share {
    char name[24]; /* what is done, e.g. "visit a cell"; zero-terminated */
    double count;
    double cost;  /* count times the weight */
    double share; /* fraction of the whole cost, 0 to 1 */
} vox_cost_share;

/* A cell size and the reasons for it. Costs are in cell visits per tetrahedron (PAPER), or nanoseconds. */
typedef struct vox_suggestion {
    uint32_t struct_size;
    vox_cost_model model;
    double cell_size;
    double cells_per_axis; /* world edge / cell size, as the paper counts */
    double zone_min;       /* smallest and largest cell size of the zone */
    double zone_max;
    double predicted_cost; /* at cell_size */
    vox_cell_size_rules rules;
    vox_geometry_stats stats;
    vox_cost_sample curve[VOX_COST_CURVE_CAPACITY]; /* ascending in cell_size, evenly spaced in its logarithm */
    uint32_t curve_count;
    uint32_t term_count;
    vox_cost_share terms[VOX_COST_TERM_CAPACITY]; /* at cell_size; their costs add up to predicted_cost */
    vox_cell_size_rules rule_costs; /* predicted cost at the cell size of each rule; 0 if the rule does not apply */
    double budget_cell_size; /* smallest cell size within the byte budget; 0: the budget does not limit it */
    /* REFERENCE: the loss of using one cell size for tetrahedra of all sizes. It is predicted_cost divided by the
     * predicted cost of a few grids, each with the cell size that is best for its share of the tetrahedra, minus 1.
     * About 0 if one size is as good as several, and for the other models. A vox_grid with cell_size 0 uses several
     * sizes if there are several `levels`. */
    double uniform_loss;
    double levels[VOX_CELL_SIZE_LEVEL_CAPACITY]; /* level_count cell sizes, that of the smallest tets first */
    uint32_t level_count;
    uint32_t reserved;
} vox_suggestion;

/* The cell size that minimises the cost model for these meshes (their positions as they are now).
 * desc null: defaults. Set out->struct_size first; the fields it covers are written.
 * `meshes` is an array whose elements are meshes[0].struct_size bytes apart, a multiple of 8, and all have that
 * struct_size. Of their filters, only VOX_FILTER_SELF_COLLISION is used, by REFERENCE and FAST. Errors name a mesh by
 * its index in the array and its user data. All tets and vertices are checked; the models look at samples of them
 * (docs/cell-size.md has times). Memory is from desc->allocator until the end of the call.
 * SURFACE suggests the cell size of one surface (vox_surface.h) of all meshes, standing still with the radius 0: the
 * facets of exactly one enabled tetrahedron, duplicates counted once, their edges and their vertices. It reads all of
 * them. For surfaces without tetrahedra behind them, and for motions, vox_surface.h has a function of its own.
 * Errors: INVALID_ARGUMENT (also if there is no tetrahedron, or all have zero size; SURFACE: no such facet),
 * INVALID_MESH, NON_FINITE, LIMIT (SURFACE: a mesh of more than 357913941 tets), OUT_OF_MEMORY; UNSUPPORTED for SURFACE
 * in a build without surfaces, as for WebAssembly. */
VOX_API vox_result vox_suggest_cell_size(VOX_OPTIONAL const vox_suggest_desc* desc, const vox_mesh_desc* meshes,
                                         uint64_t mesh_count, vox_suggestion* out);

/* The same for the meshes of a grid. With desc null, the model is that of the grid's engine, with the grid's storage
 * and byte budget. PAPER takes p_nc from the last step if that had contacts and p_nc is 0.
 * FAST takes from the last step which meshes are at rest and which need no cells for self-collision; both cost nothing.
 * It is quicker than vox_suggest_cell_size because its samples are smaller: means are accurate to a few per cent.
 * The first call after a mesh was inserted or edited reads all of that mesh, and keeps up to 11 KB on the C++ runtime's
 * heap (docs/cell-size.md lists what each costs). Where weights are null, those of the grid's reference engine hold.
 * Positions must be bound. Errors: as vox_suggest_cell_size, and INVALID_STATE for a mesh without positions. */
VOX_API vox_result vox_grid_suggest_cell_size(const vox_grid* grid, VOX_OPTIONAL const vox_suggest_desc* desc,
                                              vox_suggestion* out);

/* Measures this machine's weights by steps of both engines over a small built-in scene, in about ten milliseconds. Set
 * out->struct_size first. Errors: UNSUPPORTED (an x86-64 without SSE4.2), OUT_OF_MEMORY. */
VOX_API vox_result vox_cost_calibrate(vox_cost_weights* out);

/* ---- the method for any algorithm ------------------------------------------------------------- */

/* Cost at a cell size. A result that is not a finite number counts as infinite cost. Called on the thread that calls
 * vox_cost_minimise. */
typedef double vox_cost_function(double cell_size, void* user);

/* The least cost, and where it is. */
typedef struct vox_cost_minimum {
    uint32_t struct_size;
    uint32_t curve_count;
    double cell_size;
    double cost;
    double zone_min; /* the range around cell_size, within [min, max], where the cost is at most (1 + zone_loss) times
                        the least */
    double zone_max;
    vox_cost_sample curve[VOX_COST_CURVE_CAPACITY]; /* from min to max, evenly spaced in the logarithm */
} vox_cost_minimum;

/* Finds the cell size between min and max with the least cost: a scan that is even in the logarithm of the cell size,
 * then a golden-section search around its best point. `cost` is called on this thread, some hundred times, and must not
 * throw. zone_loss is as in vox_suggest_desc. Set out->struct_size first.
 * Errors: INVALID_ARGUMENT (unless 0 < min <= max, finite; a bad zone_loss; also if the cost was finite at no cell size
 * that was tried, or if the least cost is negative). */
VOX_API vox_result vox_cost_minimise(vox_cost_function* cost, void* user, double min, double max, double zone_loss,
                                     vox_cost_minimum* out);

/* ---- the cell size of any grid ---------------------------------------------------------------- */

/* The method for uniform grids that are not this library's, whatever is in them. A run of such a grid puts primitives
 * into cells; then each of those that ask looks at cells and reads the lists there. How often it does each of that at a
 * cell size follows from the boxes of the primitives (docs/your-own-grid.md derives it). What each takes is known for
 * some grids, or follows from a few timings of the caller's own.
 *   vox_suggest_for   the best cell size for a grid that is described
 *   vox_cost_fit      the same from timings at three cell sizes or more
 *   vox_cost_tune     runs the grid itself, at the cell sizes that it chooses
 * All functions here: any thread. What the arguments point to is read during the call. */

typedef enum vox_primitive_type {
    VOX_PRIMITIVE_POINT = 0,    /* one vertex */
    VOX_PRIMITIVE_EDGE = 1,     /* two */
    VOX_PRIMITIVE_TRIANGLE = 2, /* three */
    VOX_PRIMITIVE_TET = 3,      /* four */
    VOX_PRIMITIVE_BOX = 4       /* two: opposite corners of a box along the axes, in any order */
} vox_primitive_type;

/* Primitives: each is a few vertices. Only its box counts: that of its vertices, grown by its radius on all sides. */
typedef struct vox_primitives {
    uint32_t struct_size;
    vox_primitive_type type;
    vox_positions positions; /* of vertices */
    /* The vertices of each primitive: two numbers an edge or a box, three a triangle, four a tetrahedron, one a point.
     * Null: 0, 1, 2, and so on, without sharing. */
    VOX_OPTIONAL const uint32_t* indices;
    uint64_t index_byte_stride; /* from one primitive to the next; 0: tightly packed */
    uint64_t count;             /* primitives, at most 2^32 - 1 */
    VOX_OPTIONAL const void* radii; /* one number of each primitive, >= 0; null: 0 */
    uint64_t radius_byte_stride;    /* 0: tightly packed */
    vox_format radius_format;
    uint32_t reserved; /* 0 */
    double radius;     /* of all primitives, added to their own, >= 0 */
} vox_primitives;

static inline vox_primitives vox_default_primitives(void) {
    vox_primitives primitives = VOX_ZERO;
    primitives.struct_size = (uint32_t)sizeof primitives;
    return primitives;
}

/* Which cells hold a primitive. */
typedef enum vox_cell_content {
    VOX_CELLS_HOLD_BOXES = 0,  /* all that its box meets */
    VOX_CELLS_HOLD_CENTRES = 1 /* the one with the centre of its box; for a point, with the point */
} vox_cell_content;

/* Which cells a primitive that asks looks at. */
typedef enum vox_cell_look {
    VOX_LOOK_BOX = 0,    /* those that its box meets: one for a point, those of the ball's box for one with a radius */
    VOX_LOOK_AROUND = 1, /* 27: the one with the centre of its box, and those around. Only with HOLD_CENTRES, and only
                            legal where a cell is as large as the distance that matters along any axis */
    VOX_LOOK_PAIRS = 2   /* nobody asks: the grid goes through the cells and pairs what is in each. With two sets, both
                            are put into cells, and pairs are of one of each */
} vox_cell_look;

/* What a run of a grid does at one cell size. The means over all positions of the lattice. */
typedef struct vox_grid_work {
    double entries;  /* primitives put into a cell */
    double visits;   /* cells looked at; with PAIRS, those that hold something */
    double empty;    /* visits of a cell that holds nothing */
    double reads;    /* entries of the cells looked at; with PAIRS, pairs in a cell */
    double occupied; /* cells that hold something */
    double cells;    /* of the box of all that is held: cells of a dense grid */
} vox_grid_work;

/* Nanoseconds for one of each, >= 0. */
typedef struct vox_grid_weights {
    double fixed;    /* a run, whatever the cell size */
    double entries;
    double visits;
    double found;    /* what a visit of a cell that holds something takes more than one of an empty cell */
    double reads;
    double occupied; /* making and forgetting a cell */
    double cells;    /* for grids with dense storage: clearing one */
} vox_grid_weights;

/* Grids that weights are shipped for, each measured by bench/foreign. */
typedef enum vox_known_grid {
    VOX_KNOWN_GRID_ANY = 0,          /* nothing is known: weights that lose least in the worst of the grids below */
    VOX_KNOWN_GRID_SORTED = 1,       /* a plain grid in C++: a counting sort into a dense lattice */
    VOX_KNOWN_GRID_HASHED = 2,       /* a plain grid in C++: std::unordered_map from cell to list */
    VOX_KNOWN_GRID_WARP = 3,         /* NVIDIA Warp's HashGrid on the processor: points, asked by balls */
    VOX_KNOWN_GRID_IPC = 4,          /* IPC Toolkit's SpatialHash: boxes in all their cells, asked by boxes */
    VOX_KNOWN_GRID_IPC_PAIRS = 5,    /* IPC Toolkit's HashGrid: boxes in all their cells, paired cell by cell */
    VOX_KNOWN_GRID_VTK = 6,          /* VTK's vtkStaticCellLocator: boxes in all their cells, asked by points */
    VOX_KNOWN_GRID_PBAT = 7,         /* PBAT's HashGrid3: centres of boxes, asked from 27 cells */
    VOX_KNOWN_GRID_POINT_VOXELS = 8, /* hashed voxels of points asked by balls, as in PCL and Open3D */
    VOX_KNOWN_GRID_NUMPY = 9         /* a grid of sorted keys in numpy */
} vox_known_grid;

typedef enum vox_foreign_flags {
    VOX_FOREIGN_DENSE = 1 /* the grid keeps a list for each cell of the box of all that it holds */
} vox_foreign_flags;

/* A uniform grid that is not this library's. */
typedef struct vox_foreign_grid {
    uint32_t struct_size;
    uint32_t flags; /* vox_foreign_flags, combined with | */
    vox_cell_content content;
    vox_cell_look look;
    const vox_primitives* held;                 /* what is put into cells */
    VOX_OPTIONAL const vox_primitives* asking;  /* null: those held ask themselves, each of all, itself included */
    double radius;          /* boxes that ask are larger by this on all sides, >= 0. With PAIRS, the boxes
                               of `asking` are, or those held where it is null */
    /* The smallest cell size that gives right answers. 0: with AROUND, half the longest side of a box
     * held, and half that of one that asks with its radius; otherwise none. */
    double least_cell_size;
    double zone_loss;       /* as vox_suggest_desc.zone_loss */
    vox_known_grid known;   /* whose weights are used where `weights` are all 0 */
    uint32_t reserved;      /* 0 */
    vox_grid_weights weights; /* all 0: those of `known` */
    VOX_OPTIONAL const vox_allocator* allocator; /* of the call's memory; null: the C++ runtime's heap */
} vox_foreign_grid;

static inline vox_foreign_grid vox_default_foreign_grid(void) {
    vox_foreign_grid grid = VOX_ZERO;
    grid.struct_size = (uint32_t)sizeof grid;
    return grid;
}

/* Sets what is known of a grid that people have: content, look, flags, known, weights. Other fields keep their
 * values. Set grid->struct_size first. Errors: INVALID_ARGUMENT. */
VOX_API vox_result vox_foreign_grid_set_known(vox_foreign_grid* grid, vox_known_grid known);

/* What an answer was based on, combined with |. `note` says the same in words, with numbers. */
typedef enum vox_foreign_warnings {
    VOX_FOREIGN_WEIGHTS_UNKNOWN = 1,   /* nothing is known of the grid's times: a few timings would help */
    VOX_FOREIGN_BY_RULE = 2,           /* cell_size is that of `rule`: by the weights, a guess, no gain over it is
                                          sure */
    VOX_FOREIGN_AT_LEAST_SIZE = 4,     /* the least legal size; a smaller one would be faster */
    VOX_FOREIGN_NO_SIZE = 8,           /* the primitives have no size: the cell size follows from their distances */
    VOX_FOREIGN_ONE_PLACE = 16,        /* all are in one place: any cell size that is large enough does */
    VOX_FOREIGN_MODEL_DISAGREES = 32,  /* the timings do not follow the counts of the described grid */
    VOX_FOREIGN_TIMINGS_DISAGREE = 64, /* timings at the same cell size differ widely */
    VOX_FOREIGN_OUT_OF_RANGE = 128,    /* the best cell size is beyond those timed */
    VOX_FOREIGN_STOPPED = 256          /* the callback stopped, or failed at a cell size */
} vox_foreign_warnings;

/* Cell sizes that other rules would choose; 0 where a rule does not apply. */
typedef struct vox_foreign_rules {
    double mean_edge;       /* mean length of the edges of the primitives held, shared ones counted each time */
    double mean_box_side;   /* mean of the longest sides of their boxes */
    double median_box_side; /* median of these */
    double spacing;         /* cube root of the volume of the box of all, over their number */
    double radius;          /* mean radius of those that ask */
} vox_foreign_rules;

/* The rules of vox_foreign_rules, in its order. Suggestions are by NONE or MEAN_EDGE so far. */
typedef enum vox_foreign_rule {
    VOX_RULE_NONE = 0, /* the model's minimum */
    VOX_RULE_MEAN_EDGE = 1,
    VOX_RULE_MEAN_BOX_SIDE = 2,
    VOX_RULE_MEDIAN_BOX_SIDE = 3,
    VOX_RULE_SPACING = 4,
    VOX_RULE_RADIUS = 5
} vox_foreign_rule;

#define VOX_NOTE_CAPACITY 256u /* bytes of a note, its zero included */

/* A cell size for a foreign grid, and the reasons for it. Costs are nanoseconds of a run. */
typedef struct vox_foreign_suggestion {
    uint32_t struct_size;
    uint32_t warnings; /* vox_foreign_warnings */
    double cell_size;
    double zone_min; /* as in vox_suggestion, and not below least_cell_size */
    double zone_max;
    double predicted_cost; /* at cell_size */
    double least_cell_size; /* the smallest legal size; 0: any */
    vox_grid_work work;     /* at cell_size */
    vox_grid_weights weights; /* that were used */
    vox_foreign_rules rules;
    vox_foreign_rules rule_costs; /* predicted cost at the cell size of each rule; 0 if it does not apply, or that size
                                     is too small for vox_count_for */
    vox_cost_sample curve[VOX_COST_CURVE_CAPACITY]; /* ascending in cell_size, evenly spaced in its logarithm */
    uint32_t curve_count;
    uint32_t term_count;
    vox_cost_share terms[VOX_COST_TERM_CAPACITY]; /* at cell_size; their costs add up to predicted_cost */
    vox_foreign_rule rule; /* whose size it is */
    uint32_t reserved;
    char note[VOX_NOTE_CAPACITY]; /* zero-terminated; "" if there is no warning */
} vox_foreign_suggestion;

/* The cell size that costs this grid least. Set out->struct_size first; the fields it covers are written.
 * Works on a sample of the primitives where there are many (docs/your-own-grid.md has its loss): those that are not in
 * it are not checked either. Memory (from grid->allocator, released at the end of the call) in proportion to it.
 * Errors: INVALID_ARGUMENT (also for no primitive, or AROUND with HOLD_BOXES), INVALID_MESH (a primitive names a vertex
 * that does not exist), NON_FINITE, LIMIT, OUT_OF_MEMORY. */
VOX_API vox_result vox_suggest_for(const vox_foreign_grid* grid, vox_foreign_suggestion* out);

/* What a run of this grid does at one cell size. Errors: as vox_suggest_for; also INVALID_ARGUMENT for a cell size that
 * is not a finite number above 0, LIMIT for one so small that a count is beyond 1e80. */
VOX_API vox_result vox_count_for(const vox_foreign_grid* grid, double cell_size, vox_grid_work* out);

/* One timing of a grid: a run at this cell size took so long. */
typedef struct vox_grid_timing {
    double cell_size; /* > 0 */
    double seconds;   /* 1e-30 to 1e30 */
} vox_grid_timing;

/* Weights from timings, and the cell size they lead to. */
typedef struct vox_grid_fit {
    uint32_t struct_size;
    uint32_t warnings; /* vox_foreign_warnings */
    vox_grid_weights weights; /* >= 0; the best fit to the timings. To be put into vox_foreign_grid.weights, also for
                                 other scenes of the same grid */
    double residual;          /* root mean square of (fitted time / measured time - 1) over the timings */
    double cell_size;
    double zone_min;
    double zone_max;
    double predicted_seconds; /* at cell_size */
    vox_cost_sample curve[VOX_COST_CURVE_CAPACITY]; /* in seconds */
    uint32_t curve_count;
    uint32_t reserved;
    char note[VOX_NOTE_CAPACITY];
} vox_grid_fit;

/* Fits the weights of a grid to timings of the whole run at three different cell sizes or more (0.6, 1.2 and 2.4 mean
 * edges do), by non-negative least squares, and minimises the cost, from the smallest size timed over 1.2 to 1.2 times
 * the largest. The least legal size, where it was timed, is the answer if less than 3 % is to be gained elsewhere: some
 * grids are much faster at exactly that size. Of several timings at one cell size the shortest counts. Slow timings
 * count less than fast ones, and less still if they are far above the fit. What few timings cannot tell apart is
 * divided as in the weights that the grid has (`weights`, else `known`). Errors: as vox_suggest_for; also
 * INVALID_ARGUMENT for fewer than three different cell sizes (those within a millionth are one), sizes below the least
 * legal one, and timings out of their range, and LIMIT as vox_count_for. */
VOX_API vox_result vox_cost_fit(const vox_foreign_grid* grid, const vox_grid_timing* timings, uint64_t count,
                                vox_grid_fit* out);

/* Runs the caller's grid once at a cell size. Returns how many seconds that took, at least 1e-30; infinity, or more
 * than 1e30, if it cannot run at this size (it is then tried at others, none of them further away); or a negative
 * number or NaN to stop. Called on the thread that calls vox_cost_tune. Must not throw. */
typedef double vox_grid_run(double cell_size, void* user);

#define VOX_TUNE_RUN_CAPACITY 32u /* most runs of vox_cost_tune */

/* How to tune; all 0 by default. */
typedef struct vox_tune_desc {
    uint32_t struct_size;
    uint32_t most_runs; /* 3 to VOX_TUNE_RUN_CAPACITY; 0: 7 */
    double min;         /* cell sizes to try, 0 < min <= max; both 0: an eighth to eight times the first */
    double max;
    double first;       /* the cell size to begin with; 0: what vox_suggest_for says. Must be set where there is no
                           grid */
    double zone_loss;   /* as vox_suggest_desc.zone_loss */
    double wanted_loss; /* stops where the cell size is within this of the best one, as far as it can tell; 0: 0.02 */
} vox_tune_desc;

static inline vox_tune_desc vox_default_tune_desc(void) {
    vox_tune_desc desc = VOX_ZERO;
    desc.struct_size = (uint32_t)sizeof desc;
    return desc;
}

/* What tuning found. */
typedef struct vox_tuning {
    uint32_t struct_size;
    uint32_t warnings; /* vox_foreign_warnings */
    double cell_size;
    double zone_min;
    double zone_max;
    double seconds;       /* of a run at cell_size, as fitted */
    double expected_loss; /* how much longer a run may take than at the best cell size, as far as it can tell: 0.03
                             for 3 %. The most by any of several fits: without each of the timings, and with each moved
                             by the noise. Infinite if only one cell size of several was timed */
    double noise;         /* relative: how far timings are from the fitted curve, root mean square */
    vox_grid_weights weights; /* as in vox_grid_fit; all 0 where there is no grid */
    vox_grid_timing runs[VOX_TUNE_RUN_CAPACITY]; /* run_count runs, in order; seconds may be infinite */
    uint32_t run_count;
    uint32_t curve_count;
    vox_cost_sample curve[VOX_COST_CURVE_CAPACITY]; /* in seconds */
    char note[VOX_NOTE_CAPACITY];
} vox_tuning;

/* Finds the best cell size by running the grid: at three cell sizes an octave apart first, then where the fit to all
 * timings so far is lowest or least sure, which may be where it was run before, until that is sure enough
 * (desc->wanted_loss, after four runs at the earliest) and it was run a quarter of an octave to either side of the
 * best, or desc->most_runs are made. The answer is never beyond the sizes that were run. The same times give the same
 * runs and the same answer, bit for bit.
 * grid: what is known of it; null: nothing, so the curve is a sum of powers of the cell size, and desc->first must be
 * set. desc null: defaults. If the callback stops, or cannot run at a size, the answer is from the other runs, with a
 * warning. Errors: as vox_suggest_for; also INVALID_STATE if no run succeeded, INVALID_ARGUMENT for a run of less than
 * 1e-30 seconds, as a clock that is too coarse gives, LIMIT as vox_count_for at the smallest size to be tried. */
VOX_API vox_result vox_cost_tune(VOX_OPTIONAL const vox_foreign_grid* grid, VOX_OPTIONAL const vox_tune_desc* desc,
                                 vox_grid_run* run, void* user, vox_tuning* out);

#ifdef __cplusplus
}
#endif

#endif
