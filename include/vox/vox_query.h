/* vox_query: which tetrahedra are at a point, in a box, on a line? Where is the closest surface?
 *
 * A locator holds the meshes of a grid as they were at one moment and answers questions about them, many at a time. It
 * has copies of all that it needs, so it may be asked while the grid steps, and after the grid is destroyed:
 *
 *     vox_locator* locator = NULL;
 *     vox_grid_update_locator(grid, &locator);         after every step whose bodies are asked about
 *     vox_locator_find_closest(locator, &points, NULL, hits);
 *     vox_locator_release(locator);                    at the end
 *
 * To ask about meshes and nothing else: create a grid, insert the meshes, take a locator, destroy the grid. No step is
 * needed.
 *
 * Conventions: as in vox.h, and
 *   Threads    Any number of threads may ask, retain and release a locator at any time, also while another thread
 *              changes or destroys its grid. Taking a locator changes the grid.
 *   Bodies     A locator has the enabled meshes with tetrahedra. Nothing that happens to them later changes its
 *              answers.
 *   Points     All arrays of positions are read during the call. Their `data` may be null if `count` is 0.
 *   Answers    do not depend on engine, cell size, workers or machine. Whether a tetrahedron contains a point, and what
 *              a segment meets, is decided exactly. Weights, distances and t are computed in double.
 *   Lists      A function that fills a list writes its first `capacity` elements, and sets *out_count to the number of
 *              all. The list may be null if capacity is 0.
 *   Errors     of all questions: INVALID_ARGUMENT, NON_FINITE (a coordinate), LIMIT (a coordinate of 2^128 or more;
 *              more than 2^32 - 1 questions), OUT_OF_MEMORY. Their temporary memory is from the C++ runtime's heap.
 */
#ifndef VOX_VOX_QUERY_H
#define VOX_VOX_QUERY_H

#include <vox/vox.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- locators --------------------------------------------------------------------------------- */

/* The meshes of a grid at one moment. */
typedef struct vox_locator vox_locator;

/* Takes a locator of the grid as it is now, and releases what *locator held before, if anything. The caller owns
 * *locator and releases it with vox_locator_release. The first call after a mesh was inserted or edited takes longer.
 * If the call fails, *locator stays as it is.
 * A locator uses the grid's memory, within its byte budget: about 36 bytes a vertex and 28 a tetrahedron, and 12 a
 * tetrahedron that all locators of a grid share. The memory of released locators is used again, so that a program that
 * takes one in every frame soon allocates nothing; vox_grid_clear and vox_grid_destroy return it. If a locator outlives
 * its grid, its last release returns its memory, on the thread that calls.
 * Errors: INVALID_STATE (a mesh without positions), NON_FINITE, LIMIT, INVALID_ARGUMENT (doubles under
 * VOX_FORMAT_FLOAT, see vox_mesh_insert; a defective task system), BUDGET, OUT_OF_MEMORY. */
VOX_API vox_result vox_grid_update_locator(vox_grid* grid, vox_locator** locator);

/* Adds an owner, who has to release the locator as well: so one thread can still ask it while another takes the next
 * one. The caller must be sure that nobody releases the last owner meanwhile. */
VOX_API vox_result vox_locator_retain(vox_locator* locator);

/* Removes an owner. The locator ends with its last owner. Null does nothing. */
VOX_API void vox_locator_release(VOX_OPTIONAL vox_locator* locator);

/* Gets vox_grid_info.epoch of the moment when the locator was taken. */
VOX_API vox_result vox_locator_get_epoch(const vox_locator* locator, uint64_t* out_epoch);

/* Gets the user_data of a body, even if it was removed since. Errors: INVALID_HANDLE (the locator does not have it). */
VOX_API vox_result vox_locator_get_user_data(const vox_locator* locator, vox_body body, uint64_t* out_user_data);

/* ---- which bodies answer ---------------------------------------------------------------------- */

typedef enum vox_query_flags {
    VOX_QUERY_FIRST_HIT = 1,  /* vox_locator_find_ray_hits: report only the first hit of each ray */
    VOX_QUERY_EXTRAPOLATE = 2 /* vox_locator_locate: for a point outside, compute the weights of the point itself, some of
                                 which are negative, rather than of the closest point */
} vox_query_flags;

/* Which bodies answer, and how far to look. All fields are 0 by default: all bodies, at any distance. */
typedef struct vox_query_desc {
    uint32_t struct_size;
    uint32_t flags;      /* vox_query_flags, combined with | */
    uint64_t mask;       /* only bodies whose category had a bit in common with it; 0: all */
    vox_body excluded;   /* not this body, e.g. the asking body; an id that the locator does not have excludes none */
    uint32_t reserved;   /* 0 */
    double max_distance; /* vox_locator_locate, vox_locator_find_closest and vox_locator_find_closest_to_segments: no
                            further than this, in the caller's unit; 0: any distance */
} vox_query_desc;

static inline vox_query_desc vox_default_query_desc(void) {
    vox_query_desc desc = VOX_ZERO;
    desc.struct_size = (uint32_t)sizeof desc;
    return desc;
}

/* ---- points ----------------------------------------------------------------------------------- */

typedef enum vox_location_state {
    VOX_LOCATION_NONE = 0,   /* no body is within max_distance; the other fields are 0 */
    VOX_LOCATION_INSIDE = 1, /* the closed tetrahedron contains the point */
    VOX_LOCATION_OUTSIDE = 2 /* no tetrahedron contains the point; this one has the closest point of all surfaces, as
                                vox_locator_find_closest finds it */
} vox_location_state;

/* Where a point is, and the weights that interpolate a field there. If several tetrahedra contain the point, this is one
 * of the lowest body: the lowest that has the point in its interior or, if there is none, the lowest that has it on its
 * boundary. */
typedef struct vox_location {
    vox_body body;
    uint32_t tet;
    vox_location_state state;
    uint32_t reserved; /* 0 */
    /* Of the tetrahedron's corners, for the point or, if it is outside, for the closest point; VOX_QUERY_EXTRAPOLATE asks
     * for the point. Each is rounded from the true weight once, or off by 2^-58 more. Exceptions are the closest points of
     * facets thinner than 2^-20 of their length or with an edge below 2^-40 of the distance, and a flat tetrahedron is not
     * extrapolated. */
    double weights[4];
    double distance; /* to the closest point, in the caller's unit; 0 inside */
} vox_location;

/* Locates points: out_locations[i] is for point i, and depends on no other point. No point inside a mesh is missed, on
 * whatever facet, edge or vertex it is. Many points in one call are located several times as fast as one by one, whatever
 * their order. Errors: also INVALID_ARGUMENT (a negative or NaN max_distance). */
VOX_API vox_result vox_locator_locate(const vox_locator* locator, const vox_positions* points,
                                      VOX_OPTIONAL const vox_query_desc* desc, vox_location* out_locations);

/* A tetrahedron that contains a point. */
typedef struct vox_point_hit {
    uint32_t point; /* index of the point */
    vox_body body;
    uint32_t tet;
    uint32_t reserved; /* 0 */
    double weights[4]; /* of the tetrahedron's corners, in [0, 1], as in vox_location */
} vox_point_hit;

/* Finds the tetrahedra that contain points, by the rule of vox_contact: every tetrahedron of a body that has the point
 * in its interior or, if there is none, the lowest that has it on its boundary. Sorted by (point, body, tet). Many
 * points in one call are found several times as fast as one by one, whatever their order. */
VOX_API vox_result vox_locator_find_point_hits(const vox_locator* locator, const vox_positions* points,
                                               VOX_OPTIONAL const vox_query_desc* desc, vox_point_hit* hits,
                                               uint64_t capacity, uint64_t* out_count);

/* A point of a surface. The surface of a mesh consists of the facets of exactly one of its tetrahedra. Facet k is
 * opposite corner k. The corners of facets are
 *     facet 0: corners 1, 2, 3    1: 0, 3, 2    2: 0, 1, 3    3: 0, 2, 1
 * of the tetrahedron, counter-clockwise as seen from outside if its volume is positive. */
typedef struct vox_closest_hit {
    vox_body body;      /* VOX_NULL_BODY: no surface is within max_distance; all other fields but `inside` are 0 */
    uint32_t tet;
    uint32_t facet;
    uint32_t inside;    /* how many bodies contain the point; exact */
    uint32_t face[3];   /* the vertices of the facet, in the order of its corners */
    uint32_t reserved;  /* 0 */
    double weights[3];  /* of these vertices, for the closest point, in [0, 1] */
    double position[3]; /* of the closest point */
    /* A unit vector out of the facet's tetrahedron or, if that is flat, to the side away from the point. If the facet
     * has no area, it points from the point to `position`, or is 0, 0, 1 if both coincide. */
    double normal[3];
    double distance;    /* from the point to `position`; negative if the body contains the point, which is exact */
} vox_closest_hit;

/* Finds the closest point of all surfaces: out_hits[i] is for point i. If several are equally close, the lowest
 * (body, tet, facet) counts. Points that are close together should follow each other: each search begins at the
 * facet found before. Errors: also INVALID_ARGUMENT (a negative or NaN max_distance). */
VOX_API vox_result vox_locator_find_closest(const vox_locator* locator, const vox_positions* points,
                                            VOX_OPTIONAL const vox_query_desc* desc, vox_closest_hit* out_hits);

/* ---- boxes ------------------------------------------------------------------------------------ */

/* A tetrahedron whose bounding box meets a box. */
typedef struct vox_box_hit {
    uint32_t box; /* index of the box */
    vox_body body;
    uint32_t tet;
} vox_box_hit;

/* Finds the tetrahedra whose bounding box has a point in common with the closed box from min[i] to max[i], decided
 * exactly and sorted by (box, body, tet). They include all tetrahedra that meet the box themselves, also tetrahedra of
 * zero volume. Corners may be infinite. Errors: INVALID_ARGUMENT (arrays of different lengths; a min that is not <= its
 * max). */
VOX_API vox_result vox_locator_find_box_hits(const vox_locator* locator, const vox_positions* min,
                                             const vox_positions* max, VOX_OPTIONAL const vox_query_desc* desc,
                                             vox_box_hit* hits, uint64_t capacity, uint64_t* out_count);

/* ---- rays ------------------------------------------------------------------------------------- */

/* Ray i is the closed segment from from[i], where t is 0, to to[i], where t is 1. Both arrays have the same length. */

typedef enum vox_side {
    VOX_SIDE_NONE = 0,   /* the facet's tetrahedron has no volume */
    VOX_SIDE_ENTERS = 1, /* the ray goes into the tetrahedron */
    VOX_SIDE_LEAVES = 2
} vox_side;

/* A facet of a surface that a ray meets; see vox_closest_hit. */
typedef struct vox_ray_hit {
    uint32_t ray; /* index of the ray */
    vox_body body;
    uint32_t tet;
    uint32_t facet;
    vox_side side;
    uint32_t face[3]; /* the vertices of the facet, in the order of its corners */
    double t;
    double weights[3]; /* of these vertices, in [0, 1] */
} vox_ray_hit;

/* Finds the facets of surfaces that rays meet, sorted by (ray, t, body, tet, facet). Which facets a ray meets is exact;
 * t, and so the order, is rounded. A ray through an edge or a vertex meets all facets there. A ray in the plane of a
 * facet does not meet it. */
VOX_API vox_result vox_locator_find_ray_hits(const vox_locator* locator, const vox_positions* from,
                                             const vox_positions* to, VOX_OPTIONAL const vox_query_desc* desc,
                                             vox_ray_hit* hits, uint64_t capacity, uint64_t* out_count);

/* Tests whether each ray meets a tetrahedron that has a volume: out_blocked[i] is 1 or 0, which is exact. The search
 * for a ray ends at the first such tetrahedron. from[i] = to[i] tests a point. */
VOX_API vox_result vox_locator_test_rays(const vox_locator* locator, const vox_positions* from, const vox_positions* to,
                                         VOX_OPTIONAL const vox_query_desc* desc, uint8_t* out_blocked);

/* ---- tracks ----------------------------------------------------------------------------------- */

/* The part of a segment that lies in one tetrahedron. A segment is a closed one, as a ray is. */
typedef struct vox_track_piece {
    uint32_t segment; /* index of the segment */
    vox_body body;
    uint32_t tet;
    uint32_t facet_in;  /* where the segment enters the tetrahedron, the lowest of several; VOX_NONE if the piece begins
                           elsewhere */
    uint32_t facet_out; /* where it leaves; VOX_NONE if the piece ends elsewhere */
    uint32_t reserved;  /* 0 */
    double t_in;        /* the doubles nearest to the true ones */
    double t_out;
} vox_track_piece;

/* Finds the tetrahedra that segments pass through, sorted by (segment, body, t_in, t_out, tet). By the rule of
 * vox_contact, a stretch of a segment belongs to every tetrahedron of a body that has it in its interior. If none has, it
 * belongs to the lowest that has it in a facet or an edge. So the pieces in a body whose tetrahedra do not overlap have
 * no gap inside the body and do not overlap: t_out of one is t_in of the next, bit for bit. Which tetrahedra a segment
 * passes through is exact. A point is no piece: segments that only touch a tetrahedron, and those without length, have
 * none there. Many segments in one call are found about ten times as fast as one by one, apart from those through edges
 * and vertices. The first such call for a mesh takes 16 bytes a tetrahedron from the heap, until it is edited or no
 * locator has it. */
VOX_EXPERIMENTAL vox_result vox_locator_find_tracks(const vox_locator* locator, const vox_positions* from,
                                                    const vox_positions* to, VOX_OPTIONAL const vox_query_desc* desc,
                                                    vox_track_piece* pieces, uint64_t capacity, uint64_t* out_count);

/* ---- instruments ------------------------------------------------------------------------------ */

/* Finds the closest points of segments and all surfaces, e.g. of a capsule's axis: it touches where the distance is less
 * than its radius. out_hits[i] is for the closed segment from from[i] to to[i], as for a point: `position` is the point
 * of the surface that is closest to the segment. If the segment meets the surface, which is exact, the distance is 0.
 * `inside` and the sign say where from[i] is: put the tip of a tool there, and ask vox_locator_find_closest how deep it
 * is. Segments that are close together should follow each other. Errors: as vox_locator_find_closest, and
 * INVALID_ARGUMENT (arrays of different lengths). */
VOX_EXPERIMENTAL vox_result vox_locator_find_closest_to_segments(const vox_locator* locator, const vox_positions* from,
                                                                 const vox_positions* to,
                                                                 VOX_OPTIONAL const vox_query_desc* desc,
                                                                 vox_closest_hit* out_hits);

/* A tetrahedron that a triangle meets, and the edges of it that the triangle cuts. Edges are
 *     0: corners 0, 1    1: 0, 2    2: 0, 3    3: 1, 2    4: 1, 3    5: 2, 3
 * of the tetrahedron. */
typedef struct vox_triangle_hit {
    uint32_t triangle; /* index of the triangle */
    vox_body body;
    uint32_t tet;
    uint32_t edges; /* bit k: the triangle meets edge k, an end of it included */
    double t;       /* when the triangle first meets the tetrahedron; 0 if it does at first. The double nearest to the
                       true time. */
    double s[6];    /* where it first meets edge k, from 0 at the end with the lower vertex index to 1: the
                       same for all tetrahedra that share the edge; 0 for edges that it does not meet */
} vox_triangle_hit;

/* Finds the tetrahedra that triangles meet, sorted by (triangle, body, t, tet): for a cut, in order along the motion.
 * Points 3 i, 3 i + 1 and 3 i + 2 are the corners of triangle i, which may be a segment, e.g. a needle or the edge of a
 * blade, or a point. With `to`, each corner moves on a line and steadily, from its place in `from`, where t is 0, to `to`,
 * where t is 1. A hit is then a tetrahedron that the triangle meets at any time. Without, t is 0.
 * Which tetrahedra and edges a triangle meets is exact, touching included, also for tetrahedra without volume; s is
 * rounded. Errors: also INVALID_ARGUMENT (a count that is no multiple of 3; arrays of different lengths). */
VOX_EXPERIMENTAL vox_result vox_locator_find_triangle_hits(const vox_locator* locator, const vox_positions* from,
                                                           VOX_OPTIONAL const vox_positions* to,
                                                           VOX_OPTIONAL const vox_query_desc* desc,
                                                           vox_triangle_hit* hits, uint64_t capacity,
                                                           uint64_t* out_count);

#ifdef __cplusplus
}
#endif

#endif
