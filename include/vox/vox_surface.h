/* vox_surface: vertices, edges and triangles of deforming surfaces, with or without tetrahedra behind them: whose boxes
 * overlap while they move, which cross, which are close, and how far everything may move before anything touches. For
 * solvers with a barrier or a time of contact (IPC, OGC), for cloth, and for tools.
 *
 * A surface is made once from its topology. vox_surface_move gives it positions, or two sets of positions between which
 * every vertex moves along a straight line; the other functions then answer for that motion. It is part of the library
 * vox. The conventions of vox.h hold here too: vox_result, vox_last_error(), struct_size, untouched out-parameters on
 * failure.
 *
 * Everything that this header declares is experimental for one release (docs/abi.md).
 *
 *   Order     Answers come in one canonical order, whatever the cell size, the number of workers and the SIMD level.
 *   Exact     Boxes are compared as they are, in the format of the positions. Crossings are decided as if in infinite
 *             precision. Distances are rounded; which pairs are close is decided by the rounded distance.
 *   Threads   One thread at a time may use a surface, or anything that reads it. Different surfaces are independent.
 *   Ownership Everything that is passed in is copied, except for positions, which are read during vox_surface_move.
 *             Views live as their comment says.
 *   Units     Lengths are in the caller's own unit, times are fractions of the motion, from 0 to 1.
 */
#ifndef VOX_VOX_SURFACE_H
#define VOX_VOX_SURFACE_H

#include <vox/vox_cell_size.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- surface ---------------------------------------------------------------------------------- */

#define VOX_MAX_FEATURES 2147483647u /* vertices, edges or faces of a surface; each. More: VOX_ERROR_LIMIT */
#define VOX_MAX_PATCHES 65536u       /* patches of a surface. More: VOX_ERROR_LIMIT */

/* What a surface consists of. */
typedef enum vox_feature {
    VOX_FEATURE_VERTEX = 0,
    VOX_FEATURE_EDGE = 1, /* of 2 vertices */
    VOX_FEATURE_FACE = 2  /* a triangle, of 3 vertices */
} vox_feature;

/* Vertices, edges and faces, and the positions of the last vox_surface_move. */
typedef struct vox_surface vox_surface;

/* What a surface is made of. Faces may have any winding; edges and faces may be degenerate (name a vertex twice) and
 * duplicated. A feature never makes a pair with itself, nor with one that has a vertex in common with it. */
typedef struct vox_surface_desc {
    uint32_t struct_size;
    uint32_t worker_count; /* as in vox_grid_desc */
    uint64_t vertex_count; /* at least 1 */
    uint64_t edge_count;
    uint64_t face_count;
    /* 2 * edge_count indices of vertices, copied. Null, with edge_count 0: the edges are those of the faces, each once,
     * lower vertex first, ascending (vox_surface_get_features lists them). Not null, with edge_count 0: no edges. */
    VOX_OPTIONAL const uint32_t* edges;
    VOX_OPTIONAL const uint32_t* faces; /* 3 * face_count indices of vertices, copied */
    /* The patch of each vertex, below patch_count, copied; null: all vertices are in one patch. Two features make no
     * pair unless some vertex of one and some vertex of the other may meet (as in IPC Toolkit). Two vertices may meet
     * if the category of the patch of each has a bit in common with the mask of the patch of the other. So static
     * obstacles are patches of a category that their own masks leave out. */
    VOX_OPTIONAL const uint32_t* patches;
    VOX_OPTIONAL const uint64_t* patch_categories; /* copied; null: 1 each */
    VOX_OPTIONAL const uint64_t* patch_masks;      /* copied; null: all bits */
    uint64_t patch_count;
    /* Edge length of a cell of the grid in which pairs are looked for. 0: chosen at every motion by the cost model. No
     * answer depends on it. */
    double cell_size;
    /* Most bytes the surface may hold at any time, its answers included. A call that would exceed it fails with
     * VOX_ERROR_BUDGET. 0: 4 GiB; UINT64_MAX: no limit. */
    uint64_t byte_budget;
    VOX_OPTIONAL const vox_allocator* allocator; /* copied; null: the C++ runtime's heap */
    /* Copied; null: the built-in scheduler. A call enqueues as often as the size of its answer needs, and waits for
     * each before the next. */
    VOX_OPTIONAL const vox_task_system* tasks;
} vox_surface_desc;

static inline vox_surface_desc vox_default_surface_desc(void) {
    vox_surface_desc desc = VOX_ZERO;
    desc.struct_size = (uint32_t)sizeof desc;
    return desc;
}

/* Creates a surface without positions. The caller owns *out_surface and releases it with vox_surface_destroy.
 * Errors: INVALID_ARGUMENT (names the field and its value), INVALID_MESH ("face 17 names vertex 900 of 812"),
 * UNSUPPORTED (an x86-64 without SSE4.2), LIMIT, BUDGET, OUT_OF_MEMORY. */
VOX_EXPERIMENTAL vox_result vox_surface_create(const vox_surface_desc* desc, vox_surface** out_surface);

/* Destroys a surface. Its views become invalid. Null does nothing. */
VOX_EXPERIMENTAL void vox_surface_destroy(VOX_OPTIONAL vox_surface* surface);

/* The vertices of the edges or faces of a surface. */
typedef struct vox_feature_view {
    uint32_t struct_size;
    uint32_t vertices_each; /* 2 of an edge, 3 of a face */
    uint64_t count;         /* edges or faces */
    const uint32_t* vertices; /* vertices_each * count numbers */
} vox_feature_view;

/* The edges or faces of a surface, numbered as everywhere in this header. Set out_view->struct_size first. The view
 * lives as long as the surface. Errors: INVALID_ARGUMENT (also for VOX_FEATURE_VERTEX, whose numbers are those of the
 * positions). */
VOX_EXPERIMENTAL vox_result vox_surface_get_features(const vox_surface* surface, vox_feature feature,
                                                 vox_feature_view* out_view);

/* ---- motion ----------------------------------------------------------------------------------- */

typedef enum vox_motion_flags {
    /* Leave out pairs that are proven to stay further apart than twice the radius, that is, whose features thickened by
     * the radius never touch. No other pair is left out. */
    VOX_MOTION_CULL = 1
} vox_motion_flags;

/* Positions of all vertices of a surface, or two, between which each vertex moves along a straight line at constant
 * speed. */
typedef struct vox_motion {
    uint32_t struct_size;
    uint32_t flags; /* vox_motion_flags, combined with | */
    vox_positions from; /* at time 0, copied; as many as the surface has vertices */
    vox_positions to;   /* at time 1, copied, in the same format; none: everything stands still */
    /* The box of a vertex holds both its positions and reaches further by this on each side, rounded outward: to the
     * next number of their format below and above. That of an edge or a face holds those of its vertices. >= 0, may be
     * infinite. */
    double radius;
} vox_motion;

static inline vox_motion vox_default_motion(void) {
    vox_motion motion = VOX_ZERO;
    motion.struct_size = (uint32_t)sizeof motion;
    return motion;
}

/* Sets the motion that the other functions answer for. Views of answers end. The arrays are needed during the call
 * only.
 * Errors: INVALID_ARGUMENT (names the field and its value), NON_FINITE (names the vertex, and which of its positions),
 * LIMIT (the same, for a coordinate of 2^128 or more), BUDGET, OUT_OF_MEMORY; the motion is then the one of before. */
VOX_EXPERIMENTAL vox_result vox_surface_move(vox_surface* surface, const vox_motion* motion);

/* ---- pairs ------------------------------------------------------------------------------------ */

/* The partners of features [first, first + count): those of feature first + i are
 * partners[offsets[i]] to partners[offsets[i + 1] - 1], ascending. */
typedef struct vox_pair_lists {
    uint32_t struct_size;
    uint32_t reserved; /* 0 */
    uint64_t first;
    uint64_t count;      /* features answered; where there is a byte budget they may be fewer than asked */
    uint64_t pair_count; /* offsets[count] */
    const uint64_t* offsets;  /* count + 1 numbers */
    const uint32_t* partners; /* pair_count numbers */
} vox_pair_lists;

/* All features `b` whose boxes overlap those of the features [first, first + count) of kind `a`; boxes that touch
 * overlap. Where a and b are the same kind, each pair comes once, in the list of its lower feature. Left out: pairs
 * with a vertex in common, pairs that patches rule out, and with VOX_MOTION_CULL those proven to stay apart. Ranges
 * that reach beyond the last feature end there, and may not begin beyond it.
 * If not all of it fits into the byte budget, the features up to lists->first + lists->count are answered, at least
 * one; ask again from there. So any number of pairs can be had from any budget that holds the lists of one feature. Set
 * out_lists->struct_size first. The view lives until the next vox_surface_find_pairs or vox_surface_move, or the end of
 * the surface. Errors: INVALID_ARGUMENT, INVALID_STATE (no positions yet), BUDGET, OUT_OF_MEMORY. */
VOX_EXPERIMENTAL vox_result vox_surface_find_pairs(vox_surface* surface, vox_feature a, vox_feature b, uint64_t first,
                                              uint64_t count, vox_pair_lists* out_lists);

/* Sets vox_surface_desc.cell_size, from the next call on. Changes no answer. Errors: INVALID_ARGUMENT when negative,
 * infinite or NaN. */
VOX_EXPERIMENTAL vox_result vox_surface_set_cell_size(vox_surface* surface, double cell_size);

/* The cell size that minimises the cost of finding the pairs of kind `a` with kind `b` for the motion that is set. The
 * grid holds the boxes of tiles (at most 64 neighbouring features each) of kind b in all cells that they meet, and is
 * asked by those of kind a: described as a vox_foreign_grid, with weights of its own (docs/surface-pairs.md). Set
 * out->struct_size first. Errors: INVALID_ARGUMENT (also where there are no such features, or the radius is so large
 * that boxes have no ends), INVALID_STATE (no positions yet), BUDGET, OUT_OF_MEMORY. */
VOX_EXPERIMENTAL vox_result vox_surface_suggest_cell_size(vox_surface* surface, vox_feature a, vox_feature b,
                                                          vox_foreign_suggestion* out);

/* What the last search for pairs did, also one by vox_surface_find_crossings and the like, and what the surface holds.
 * */
typedef struct vox_pair_counters {
    uint32_t struct_size;
    uint32_t reserved;       /* 0 */
    double cell_size;        /* that was used; 0 where no grid was needed */
    uint64_t cells;          /* with something in them; those that share a place in the hash table count once */
    uint64_t tile_pairs;     /* tiles (at most 64 features each) whose boxes overlap those of tiles of the other kind */
    uint64_t boxes_compared; /* features compared with the 64 of a tile at once */
    uint64_t overlaps;       /* pairs whose boxes overlap, before VOX_MOTION_CULL */
    uint64_t culled;         /* of these, left out by VOX_MOTION_CULL */
    uint64_t bytes;          /* held now */
    uint64_t peak_bytes;
} vox_pair_counters;

/* Writes the fields that out_counters->struct_size covers (set it first). */
VOX_EXPERIMENTAL vox_result vox_surface_get_counters(const vox_surface* surface, vox_pair_counters* out_counters);

/* ---- crossings -------------------------------------------------------------------------------- */

/* An edge and a face that have a point in common. Of several such points it is an end of the edge if one is, the first
 * one first, or else one of the first side of the face that the edge meets. */
typedef struct vox_crossing {
    uint32_t edge;
    uint32_t face;
    vox_crossing_kind kind; /* of vox.h */
    uint32_t reserved;      /* 0 */
    double edge_weights[2]; /* of a common point; they add up to 1 */
    double face_weights[3]; /* of the same point */
    double position[3];     /* of the point, rounded */
} vox_crossing;

typedef struct vox_crossing_view {
    uint32_t struct_size;
    uint32_t byte_stride; /* from one element to the next */
    uint64_t count;
    const vox_crossing* crossings; /* by edge, then face */
} vox_crossing_view;

/* All edges and faces that have a point in common and no vertex, at the end of the motion: whether the surface is free
 * of intersections, and where it is not. Decided exactly. Patches rule out pairs as for vox_surface_find_pairs; the
 * radius does not count. Set out_view->struct_size first. The view lives until the next vox_surface_find_crossings or
 * vox_surface_move, or the end of the surface. Errors: INVALID_STATE (no positions yet), BUDGET, OUT_OF_MEMORY. */
VOX_EXPERIMENTAL vox_result vox_surface_find_crossings(vox_surface* surface, vox_crossing_view* out_view);

/* ---- distance --------------------------------------------------------------------------------- */

/* Two features and their closest points. */
typedef struct vox_close_pair {
    uint32_t a;
    uint32_t b;
    double distance;
    double weights_a[3]; /* of the closest point on a: one for each of its vertices, then 0 */
    double weights_b[3];
    double point_a[3];   /* the closest points, rounded */
    double point_b[3];
} vox_close_pair;

typedef struct vox_close_view {
    uint32_t struct_size;
    uint32_t byte_stride; /* from one element to the next */
    uint64_t count;
    const vox_close_pair* pairs; /* by a, then b */
} vox_close_view;

/* All pairs of features of kinds a and b that are at most `distance` apart, at the end of the motion: face and vertex,
 * edge and edge, edge and vertex, vertex and vertex, in either order. Which pairs are left out is as for
 * vox_surface_find_pairs; the radius does not count. Set out_view->struct_size first. The view lives until the next
 * vox_surface_find_proximities or vox_surface_move, or the end of the surface. While it grows, it may take more than
 * twice the bytes that it has in the end.
 * Errors: INVALID_ARGUMENT (other kinds; a distance that is negative, infinite or NaN), INVALID_STATE (no positions
 * yet), BUDGET, OUT_OF_MEMORY. */
VOX_EXPERIMENTAL vox_result vox_surface_find_proximities(vox_surface* surface, vox_feature a, vox_feature b, double distance,
                                              vox_close_view* out_view);

/* For each vertex a distance, at most `most`: while no vertex has moved further than its own, from the end of the
 * motion, no face and vertex and no two edges touch that do not touch now (Chen et al. 2025, Offset Geometric Contact,
 * Sect. 3.3). It is half of the least distance of such pairs that the vertex is part of, rounded downwards. Pairs with
 * a vertex in common, and those that patches rule out, do not count, and may touch.
 * vertex_count must be that of the surface. Errors: INVALID_ARGUMENT (another vertex_count; `most` is not above 0, or
 * not finite), INVALID_STATE (no positions yet), BUDGET, OUT_OF_MEMORY. */
VOX_EXPERIMENTAL vox_result vox_surface_find_clearances(vox_surface* surface, double most, double* per_vertex,
                                                        uint64_t vertex_count);

/* ---- time of contact -------------------------------------------------------------------------- */

/* How the time of contact is computed. */
typedef struct vox_contact_time_desc {
    uint32_t struct_size;
    uint32_t most_iterations; /* of one pair; 0: 10000. What is not finished then gives a time that is too
                                 early, never one that is late */
    double distance;          /* contact is where two features come this close, >= 0 */
    /* At the time given, the features are still further apart than `distance` by at most this part of what it was at
     * time 0; below 1; 0: 0.1. Less takes longer and gives greater steps. So a pair that comes that near and does not
     * touch limits the step, too. Where features are closer than some 1e-8 of their size, rounding may end it earlier.
     * */
    double slack;
} vox_contact_time_desc;

static inline vox_contact_time_desc vox_default_contact_time_desc(void) {
    vox_contact_time_desc desc = VOX_ZERO;
    desc.struct_size = (uint32_t)sizeof desc;
    return desc;
}

/* A safe part of the motion, and the pair that ends it. */
typedef struct vox_safe_step {
    uint32_t struct_size;
    uint32_t reserved; /* 0 */
    double step;       /* in [0, 1]: up to this time no two features touch. 1: not within the motion */
    uint64_t pairs;    /* that were examined */
    uint64_t unfinished; /* 1: the time of the pair below was given up after most_iterations; else 0 */
    vox_feature kind_a;  /* the pair with the first time of contact, where step is below 1: FACE and VERTEX, or EDGE and */
    vox_feature kind_b;  /* EDGE. Of several, the first in the order face-vertex, edge-edge, a, b */
    uint32_t a;
    uint32_t b;
} vox_safe_step;

/* How much of the motion is free of contact: the least time of first contact of all pairs of faces and vertices, and of
 * edges and edges. Never later than the exact time. Pairs that touch at time 0 give the step 0. Pairs are left out as
 * for vox_surface_find_pairs. desc null: defaults. Set out->struct_size first. Errors: INVALID_ARGUMENT, INVALID_STATE
 * (no positions yet), BUDGET, OUT_OF_MEMORY. */
VOX_EXPERIMENTAL vox_result vox_surface_find_safe_step(vox_surface* surface,
                                                  VOX_OPTIONAL const vox_contact_time_desc* desc,
                                                  vox_safe_step* out);

/* Two features that come into contact, and when at the earliest. */
typedef struct vox_timed_pair {
    uint32_t a;
    uint32_t b;
    double time; /* in [0, 1], not later than the exact one; earlier where it was given up after most_iterations */
} vox_timed_pair;

typedef struct vox_timed_view {
    uint32_t struct_size;
    uint32_t byte_stride; /* from one element to the next */
    uint64_t count;
    const vox_timed_pair* pairs; /* by a, then b */
} vox_timed_view;

/* All pairs of FACE and VERTEX, or of EDGE and EDGE, that may come into contact within the motion, each with its time;
 * pairs that are left out are proven to stay apart. desc null: defaults. Set out_view->struct_size first. The view
 * lives until the next vox_surface_find_impacts or vox_surface_move, or the end of the surface. Errors:
 * INVALID_ARGUMENT (also for other kinds), INVALID_STATE (no positions yet), BUDGET, OUT_OF_MEMORY. */
VOX_EXPERIMENTAL vox_result vox_surface_find_impacts(vox_surface* surface, vox_feature a, vox_feature b,
                                                      VOX_OPTIONAL const vox_contact_time_desc* desc,
                                                      vox_timed_view* out_view);

#ifdef __cplusplus
}
#endif

#endif
