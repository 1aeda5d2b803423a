/* vox_surface: vertices, edges and triangles of moving surfaces, with or without tetrahedra behind them. It finds
 * which of them may meet, which cross, which are close, and how far everything may move before anything touches. It
 * is for cloth, and for solvers with a barrier or a time of impact (IPC, OGC).
 *
 * A surface is created once from its topology. vox_surface_move gives it positions, or two sets of positions between
 * which every vertex moves in a straight line at constant speed. All other functions answer for that motion.
 *
 * Everything here is experimental. Conventions: as in vox.h, and
 *   Exact      Boxes are compared without rounding, and crossings are decided as if in infinite precision. Distances
 *              are rounded. Times of impact are never too late.
 *   Order      The answers do not depend on cell size, workers or machine.
 *   Threads    One thread at a time may use a surface, even to read it. Different surfaces are independent.
 *   Lifetime   A list lives until the function that returned it is called again, the surface is moved, or it is
 *              destroyed.
 *   Time       Times are fractions of the motion, from 0 to 1.
 *   Errors     of all functions after vox_surface_move: INVALID_ARGUMENT, INVALID_STATE (no positions yet), BUDGET,
 *              OUT_OF_MEMORY.
 */
#ifndef VOX_VOX_SURFACE_H
#define VOX_VOX_SURFACE_H

#include <vox/vox_cell_size.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- surface ---------------------------------------------------------------------------------- */

#define VOX_MAX_FEATURES 2147483647u /* vertices, edges or faces of a surface, each */
#define VOX_MAX_PATCHES 65536u       /* patches of a surface */

/* What a surface consists of. */
typedef enum vox_feature { VOX_FEATURE_VERTEX = 0, VOX_FEATURE_EDGE = 1, VOX_FEATURE_FACE = 2 } vox_feature;

/* Vertices, edges and faces, and their motion. */
typedef struct vox_surface vox_surface;

/* The topology of a surface, which is copied. Faces may have any winding. Edges and faces may be degenerate or
 * duplicated. */
typedef struct vox_surface_desc {
    uint32_t struct_size;
    uint32_t worker_count; /* as in vox_grid_desc */
    uint64_t vertex_count; /* at least 1 */
    uint64_t edge_count;
    uint64_t face_count;
    /* 2 * edge_count vertex indices. Null: the edges of the faces, each once. Not null, with edge_count 0: no edges */
    VOX_OPTIONAL const uint32_t* edges;
    VOX_OPTIONAL const uint32_t* faces; /* 3 * face_count vertex indices */
    /* Patches say what may meet. Two features may meet if a vertex of one and a vertex of the other may. Two vertices
     * may meet if the category of the patch of each has a bit in common with the mask of the patch of the other. */
    VOX_OPTIONAL const uint32_t* patches;          /* the patch of each vertex; null: one patch for all */
    VOX_OPTIONAL const uint64_t* patch_categories; /* patch_count numbers; null: 1 each */
    VOX_OPTIONAL const uint64_t* patch_masks;      /* patch_count numbers; null: all bits */
    uint64_t patch_count;
    double cell_size;     /* edge length of a cell; 0: the library chooses it for every motion. Never changes answers */
    uint64_t byte_budget; /* most bytes the surface may hold, lists included; 0: 4 GiB; UINT64_MAX: no limit */
    VOX_OPTIONAL const vox_allocator* allocator; /* copied; null: the C++ runtime's heap */
    VOX_OPTIONAL const vox_task_system* tasks;   /* copied; null: the built-in scheduler */
} vox_surface_desc;

static inline vox_surface_desc vox_default_surface_desc(void) {
    vox_surface_desc desc = VOX_ZERO;
    desc.struct_size = (uint32_t)sizeof desc;
    return desc;
}

/* Creates a surface without positions. The caller owns *out_surface and releases it with vox_surface_destroy.
 * Errors: INVALID_ARGUMENT, INVALID_MESH ("face 17 names vertex 900 of 812"), LIMIT, BUDGET, OUT_OF_MEMORY. */
VOX_EXPERIMENTAL vox_result vox_surface_create(const vox_surface_desc* desc, vox_surface** out_surface);

/* Destroys a surface. Null does nothing. */
VOX_EXPERIMENTAL void vox_surface_destroy(VOX_OPTIONAL vox_surface* surface);

/* The vertices of edges or faces. */
typedef struct vox_feature_view {
    const uint32_t* vertices; /* 2 * count indices for edges, 3 * count for faces */
    uint64_t count;           /* number of edges or faces */
} vox_feature_view;

/* Gets the edges or faces of a surface, in the order of their indices. They live as long as the surface.
 * Errors: INVALID_ARGUMENT (VERTEX). */
VOX_EXPERIMENTAL vox_result vox_surface_get_features(const vox_surface* surface, vox_feature feature,
                                                     vox_feature_view* out_view);

/* ---- motion ----------------------------------------------------------------------------------- */

typedef enum vox_motion_flags {
    VOX_MOTION_CULL = 1 /* leave out pairs of boxes whose features provably stay further apart than twice the radius */
} vox_motion_flags;

/* Positions of all vertices, or a motion from one set of positions to another. */
typedef struct vox_motion {
    uint32_t struct_size;
    uint32_t flags;     /* vox_motion_flags, combined with | */
    vox_positions from; /* at time 0 */
    vox_positions to;   /* at time 1, in the same format; none: everything stands still */
    double radius;      /* grows the box of a vertex on all sides, rounded outward to the next number of the format, by one
                           number also where it is 0; may be infinite */
} vox_motion;

static inline vox_motion vox_default_motion(void) {
    vox_motion motion = VOX_ZERO;
    motion.struct_size = (uint32_t)sizeof motion;
    return motion;
}

/* Sets the motion that all other functions answer for. Positions are read during the call.
 * Errors: INVALID_ARGUMENT, NON_FINITE and LIMIT (name the vertex), BUDGET, OUT_OF_MEMORY. */
VOX_EXPERIMENTAL vox_result vox_surface_move(vox_surface* surface, const vox_motion* motion);

/* ---- pairs of boxes --------------------------------------------------------------------------- */

/* Lists of partners. Feature first + i has partners[offsets[i]] to partners[offsets[i + 1] - 1], ascending. */
typedef struct vox_partner_lists {
    const uint64_t* offsets; /* count + 1 numbers */
    const uint32_t* partners;
    uint64_t first;
    uint64_t count; /* features with a list; fewer than the range has if the byte budget is short */
} vox_partner_lists;

/* Finds, for the features [first, first + count) of kind a, the features of kind b whose boxes overlap or touch
 * theirs. The box of a feature contains it during the whole motion. If a and b are the same kind, the lower feature
 * lists the pair. Pairs with a common vertex, pairs ruled out by patches and culled pairs are left out. The range ends
 * at the last feature. If the byte budget is too short for all lists, call again with first = out_lists->first +
 * out_lists->count. */
VOX_EXPERIMENTAL vox_result vox_surface_find_pairs(vox_surface* surface, vox_feature a, vox_feature b, uint64_t first,
                                                   uint64_t count, vox_partner_lists* out_lists);

/* ---- crossings -------------------------------------------------------------------------------- */

typedef enum vox_crossing_kind {
    VOX_CROSSING_THROUGH = 0,  /* the edge passes through the interior of the face */
    VOX_CROSSING_TOUCHING = 1, /* an end of the edge is on the face, or it passes through a side or a corner of it */
    VOX_CROSSING_COPLANAR = 2  /* it lies in the plane of the face and meets it, or one of them is degenerate */
} vox_crossing_kind;

/* An edge and a face that have a point in common. */
typedef struct vox_crossing {
    uint32_t edge;
    uint32_t face;
    vox_crossing_kind kind;
    uint32_t reserved;      /* 0 */
    double edge_weights[2]; /* of a common point; they add up to 1, as do the next */
    double face_weights[3];
    double position[3];
} vox_crossing;

/* Crossings, sorted by (edge, face). */
typedef struct vox_crossing_view {
    const vox_crossing* data;
    uint64_t count;
} vox_crossing_view;

/* Finds all edges and faces that have a point in common, but no vertex, at the end of the motion: none if the surface
 * does not intersect itself. Decided exactly. Pairs ruled out by patches are left out. The radius does not matter. */
VOX_EXPERIMENTAL vox_result vox_surface_find_crossings(vox_surface* surface, vox_crossing_view* out_view);

/* ---- proximity -------------------------------------------------------------------------------- */

/* Two features and their closest points. */
typedef struct vox_proximity {
    uint32_t a;
    uint32_t b;
    double distance;
    double weights_a[3]; /* of the closest point of a: one for each of its vertices, then 0 */
    double weights_b[3];
    double point_a[3];
    double point_b[3];
} vox_proximity;

/* Proximities, sorted by (a, b). */
typedef struct vox_proximity_view {
    const vox_proximity* data;
    uint64_t count;
} vox_proximity_view;

/* Finds all pairs of features of kinds a and b that are at most `distance` apart at the end of the motion. The kinds
 * are face and vertex, edge and edge, edge and vertex, or vertex and vertex, in either order. Pairs with a common
 * vertex and pairs ruled out by patches are left out. The radius does not matter.
 * Errors: also INVALID_ARGUMENT (other kinds; a negative, infinite or NaN distance). */
VOX_EXPERIMENTAL vox_result vox_surface_find_proximities(vox_surface* surface, vox_feature a, vox_feature b,
                                                         double distance, vox_proximity_view* out_view);

/* Finds a distance for each vertex, at most max_distance, such that nothing new touches while no vertex moves further
 * than its distance from the end of the motion (Chen et al. 2025, Offset Geometric Contact, Sect. 3.3). Pairs with a
 * common vertex and pairs ruled out by patches do not count. out_distances has room for one number per vertex.
 * Errors: also INVALID_ARGUMENT (max_distance is not a finite number above 0). */
VOX_EXPERIMENTAL vox_result vox_surface_find_clearances(vox_surface* surface, double max_distance,
                                                        double* out_distances);

/* ---- time of impact --------------------------------------------------------------------------- */

/* How times of impact are computed; all 0 by default. */
typedef struct vox_impact_desc {
    uint32_t struct_size;
    uint32_t max_iterations; /* for a pair, after which its time is too early; 0: 10000 */
    double distance;         /* two features meet when they come this close */
    double slack;            /* part of their first gap that may be left at the reported time, below 1; 0: 0.1.
                                Smaller values take longer and allow larger steps */
} vox_impact_desc;

static inline vox_impact_desc vox_default_impact_desc(void) {
    vox_impact_desc desc = VOX_ZERO;
    desc.struct_size = (uint32_t)sizeof desc;
    return desc;
}

/* How much of the motion is free of impacts, and which pair ends it. */
typedef struct vox_safe_step {
    double step;         /* nothing meets before this time; 1: nothing meets */
    uint64_t pairs;      /* number of pairs examined */
    vox_feature kind_a;  /* the first pair to meet, if step is below 1: FACE and VERTEX, or EDGE and EDGE */
    vox_feature kind_b;
    uint32_t a;
    uint32_t b;
    uint32_t unfinished; /* 1 if its time is early because of max_iterations, else 0 */
    uint32_t reserved;   /* 0 */
} vox_safe_step;

/* Finds the earliest time at which a face and a vertex, or two edges, may meet. Pairs that touch at time 0 give 0.
 * Pairs with a common vertex and pairs ruled out by patches are left out. */
VOX_EXPERIMENTAL vox_result vox_surface_find_safe_step(vox_surface* surface, VOX_OPTIONAL const vox_impact_desc* desc,
                                                       vox_safe_step* out);

/* Two features that may meet, and the earliest time. */
typedef struct vox_impact {
    uint32_t a;
    uint32_t b;
    double time;
} vox_impact;

/* Impacts, sorted by (a, b). */
typedef struct vox_impact_view {
    const vox_impact* data;
    uint64_t count;
} vox_impact_view;

/* Finds all pairs of FACE and VERTEX, or of EDGE and EDGE, that may meet during the motion. Pairs with a common vertex
 * and pairs ruled out by patches are left out. All other pairs provably stay apart.
 * Errors: also INVALID_ARGUMENT (other kinds). */
VOX_EXPERIMENTAL vox_result vox_surface_find_impacts(vox_surface* surface, vox_feature a, vox_feature b,
                                                     VOX_OPTIONAL const vox_impact_desc* desc,
                                                     vox_impact_view* out_view);

/* ---- cell size and measurements --------------------------------------------------------------- */

/* Sets vox_surface_desc.cell_size for the following calls. Errors: INVALID_ARGUMENT (negative, infinite, NaN). */
VOX_EXPERIMENTAL vox_result vox_surface_set_cell_size(vox_surface* surface, double cell_size);

/* Suggests the cell size with the least cost for finding the pairs of kinds a and b. Set out->struct_size first.
 * Errors: also INVALID_ARGUMENT (no such features, an infinite radius). */
VOX_EXPERIMENTAL vox_result vox_surface_suggest_cell_size(vox_surface* surface, vox_feature a, vox_feature b,
                                                          vox_cell_size_result* out);

/* Gets counts of the last search and the bytes held (docs/surface-pairs.md lists them). They live until the next call
 * that uses the surface. */
VOX_EXPERIMENTAL vox_result vox_surface_get_counters(const vox_surface* surface, vox_counter_view* out_view);

#ifdef __cplusplus
}
#endif

#endif
