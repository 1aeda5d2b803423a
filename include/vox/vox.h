/* vox: exact collision detection for deformable tetrahedral meshes.
 *
 * A whole program: which vertex of one tetrahedron is inside another one? It prints "vertex 3 in tet 0".
 *
 *     #include <stdio.h>
 *     #include <vox/vox.h>
 *     int main(void) {
 *         const float one[] = {5, 5, 5, 6, 5, 5, 5, 6, 5, .2f, .3f, .4f}, two[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
 *         const uint32_t tet[] = {0, 1, 2, 3};
 *         const vox_mesh_desc a = vox_mesh_desc_floats(one, 4, tet, 1), b = vox_mesh_desc_floats(two, 4, tet, 1);
 *         vox_grid* grid = NULL;
 *         vox_body id;
 *         vox_contact_view found;
 *         if (vox_grid_create(NULL, &grid) || vox_mesh_insert(grid, &a, &id) || vox_mesh_insert(grid, &b, &id) ||
 *             vox_grid_step(grid) || vox_grid_get_contacts(grid, &found)) return puts(vox_last_error()), 1;
 *         for (uint64_t i = 0; i < found.count; ++i)
 *             printf("vertex %u in tet %u\n", found.data[i].vertex, found.data[i].tet);
 *         vox_grid_destroy(grid);
 *     }
 *
 * Most programs need ten functions:
 *     vox_grid_create, vox_grid_destroy    a grid: bodies that collide
 *     vox_mesh_insert, vox_body_remove     a tetrahedral mesh in it
 *     vox_mesh_bind_positions              where its vertices are; or write to the array that it borrows
 *     vox_grid_step                        finds all contacts of the bodies as they are now
 *     vox_grid_get_contacts                which vertex is in which tetrahedron
 *     vox_grid_get_pairs                   which bodies touch, began to touch or stopped touching
 *     vox_grid_get_constraints             what a solver needs: vertices, weights, normal, depth (VOX_GRID_CONSTRAINTS)
 *     vox_last_error                       why a call failed
 *
 * Other headers: vox_query.h asks where points, boxes and rays are. vox_cell_size.h finds the best cell size of any
 * grid. vox_surface.h is for triangle surfaces without tetrahedra (cloth, IPC). vox_io.h, vox_sim.h and vox_dist.h
 * are libraries of their own: mesh files, moving bodies, many machines.
 *
 * Conventions
 *   Exact      Which vertex is in which tetrahedron is decided as if in infinite precision, for the coordinates
 *              given. All results come in one order and have the same bits for any cell size, number of threads and
 *              machine.
 *   Errors     A function that can fail returns a vox_result: 0 or an error. After an error nothing has changed
 *              (but a step that fails leaves no results), outputs are not written, and vox_last_error() gives the
 *              reason with numbers in it. Nothing prints, exits or throws. Not repeated below: INVALID_ARGUMENT for a
 *              null pointer that is not VOX_OPTIONAL, and INVALID_HANDLE for an id that names no body of the grid.
 *   Names      vox_X_get_Y reads; vox_X_set_Y and every other verb changes X.
 *   Structs    A struct that begins with struct_size may grow in later versions. Begin with vox_default_X(): it sets
 *              struct_size and leaves the rest 0, the defaults. Where a function fills such a struct, set its
 *              struct_size to its sizeof before the call. Other structs never change.
 *   Ownership  A mesh borrows its positions: write to that array, and step again. All else is copied, unless a flag
 *              says otherwise. What the library hands out belongs to it and lives as long as the comment says. "The
 *              epoch" lasts until the grid is next stepped, cleared, reserved or destroyed, or its flags or margin set.
 *   Threads    One thread at a time may change a grid. Between changes any number of threads may read it: functions
 *              that take a const grid. Different grids are independent. vox_last_error() is per thread.
 *   Floats     Results do not depend on the caller's floating-point environment, which stays as it was.
 *   Units      Lengths are in the caller's unit. No length is built in.
 */
#ifndef VOX_VOX_H
#define VOX_VOX_H

#include <stddef.h>
#include <stdint.h>

#define VOX_VERSION_MAJOR 0
#define VOX_VERSION_MINOR 1
#define VOX_VERSION_PATCH 0
/* A program runs with any library of the ABI version that it was built with (docs/abi.md). */
#define VOX_ABI_VERSION 1

#if defined(VOX_STATIC)
#define VOX_EXPORT
#elif defined(_WIN32) && defined(VOX_BUILD)
#define VOX_EXPORT __declspec(dllexport)
#elif defined(_WIN32)
#define VOX_EXPORT __declspec(dllimport)
#else
#define VOX_EXPORT __attribute__((visibility("default")))
#endif
#define VOX_API VOX_EXPORT          /* stable */
#define VOX_EXPERIMENTAL VOX_EXPORT /* may change in any release */
#define VOX_OPTIONAL                /* may be null; without this mark a pointer may not, unless its array is empty */

#ifdef __cplusplus
#define VOX_ZERO {} /* initialises a struct with zeros */
extern "C" {
#else
#define VOX_ZERO {0}
#endif

#define VOX_NONE 0xffffffffu      /* as an index: none */
#define VOX_ALL_CORES 0xffffffffu /* as a worker_count: one worker per core */

/* ---- errors ----------------------------------------------------------------------------------- */

typedef enum vox_result {
    VOX_OK = 0,
    VOX_ERROR_INVALID_ARGUMENT = -1, /* a null pointer, an unknown enumerator, a bad number */
    VOX_ERROR_INVALID_HANDLE = -2,   /* an id that is null, stale or of another grid */
    VOX_ERROR_INVALID_MESH = -3,     /* a tetrahedron or triangle names a vertex that does not exist */
    VOX_ERROR_INVALID_STATE = -4,    /* the call does not fit the state, e.g. a mesh has no positions yet */
    VOX_ERROR_NON_FINITE = -5,       /* a position is NaN or infinite */
    VOX_ERROR_LIMIT = -6,            /* a documented limit would be exceeded */
    VOX_ERROR_BUDGET = -7,           /* the byte budget would be exceeded */
    VOX_ERROR_OUT_OF_MEMORY = -8,    /* the allocator returned null */
    VOX_ERROR_UNSUPPORTED = -9,      /* not in this build or version */
    VOX_ERROR_FILE = -10,            /* a file cannot be opened, read or written */
    VOX_ERROR_FORMAT = -11,          /* a file or a snapshot is malformed */
    VOX_ERROR_INTERNAL = -12         /* a defect of the library: please report it */
} vox_result;

/* Compiles only where enums have 32 bits (not with -fshort-enums). */
typedef char vox_enums_have_32_bits[sizeof(vox_result) == 4 ? 1 : -1];

/* Why the last failing call on this thread failed, e.g. "tet 17 names vertex 900 of 812"; "" if no call has failed.
 * Bodies are named by id, slot and user data. Never null. The text lives until the next failing call on this thread. */
VOX_API const char* vox_last_error(void);

/* Name of a result, e.g. "VOX_ERROR_BUDGET". Static text; never null. */
VOX_API const char* vox_result_string(vox_result result);

/* ---- positions -------------------------------------------------------------------------------- */

typedef enum vox_format {
    VOX_FORMAT_FLOAT = 0,
    VOX_FORMAT_DOUBLE = 1 /* magnitudes below 2^128 - 2^103, the largest float */
} vox_format;

/* An array of positions. Coordinate k (0, 1, 2 for x, y, z) of position i is at byte
 *     i * byte_stride + k * component_byte_stride
 * of `data`. With both strides 0 the array is packed: x y z, x y z, ... If positions are part of larger records, set
 * byte_stride to the size of a record. For columns (all x, then all y, then all z, as in Eigen, Julia, Fortran and
 * Matlab), set component_byte_stride to the distance between columns. Strides at which positions would overlap are an
 * INVALID_ARGUMENT everywhere. */
typedef struct vox_positions {
    VOX_OPTIONAL const void* data; /* null: no positions */
    uint64_t count;
    vox_format format;
    uint32_t reserved;              /* 0 */
    uint64_t byte_stride;           /* 0: packed; for columns, the size of a number */
    uint64_t component_byte_stride; /* 0: the size of a number */
} vox_positions;

/* An array of packed floats x y z. */
static inline vox_positions vox_float_positions(const float* xyz, uint64_t count) {
    vox_positions p = VOX_ZERO;
    p.data = xyz;
    p.count = count;
    return p;
}

/* An array of packed doubles x y z. */
static inline vox_positions vox_double_positions(const double* xyz, uint64_t count) {
    vox_positions p = VOX_ZERO;
    p.data = xyz;
    p.count = count;
    p.format = VOX_FORMAT_DOUBLE;
    return p;
}

/* ---- grid ------------------------------------------------------------------------------------- */

/* Limits; exceeding one gives VOX_ERROR_LIMIT. docs/limits.md has all. */
#define VOX_MAX_BODIES 1048576u         /* in a grid at one time */
#define VOX_MAX_VERTICES 2147483647u    /* in a grid */
#define VOX_MAX_TETS 2147483647u        /* in a grid */
#define VOX_MAX_SURFACE_TETS 357913941u /* in a mesh whose surface is needed: constraints, edges, margin, queries */
#define VOX_MAX_CONTACTS 4294967295u    /* in a step */
#define VOX_MAX_WORKERS 256u            /* of a grid */
#define VOX_MAX_CONSTRAINTS_PER_PAIR 256u /* vox_grid_desc.max_constraints_per_pair */

/* A set of bodies, and the settings for finding their contacts. */
typedef struct vox_grid vox_grid;

/* What a step does besides finding contacts and pairs. */
typedef enum vox_grid_flags {
    VOX_GRID_CONSTRAINTS = 1,    /* also find constraints: as vox_grid_find_constraints with the defaults */
    VOX_GRID_EDGES = 2,          /* also find edges that pass through faces. Experimental */
    VOX_GRID_SKIP_BAD_BODIES = 4 /* leave out a body with a bad coordinate (NaN, infinite, too large) instead of
                                    failing (vox_grid_get_failure) */
} vox_grid_flags;

/* Settings of a grid; all 0 by default. What the pointers name is copied. */
typedef struct vox_grid_desc {
    uint32_t struct_size;
    uint32_t flags;        /* vox_grid_flags, combined with | */
    uint32_t worker_count; /* threads that share a step: up to VOX_MAX_WORKERS, or VOX_ALL_CORES; 0: one */
    /* Most constraints of a pair, up to VOX_MAX_CONSTRAINTS_PER_PAIR; 0: all. The deepest stays, then whichever is
     * farthest from all that stay; PROXIMITY only if no others are left. Pairs and contacts do not change. */
    uint32_t max_constraints_per_pair;
    double cell_size;      /* edge length of a cell; 0: the library chooses it in every step. Never changes results */
    double margin;         /* see vox_grid_set_margin */
    uint64_t byte_budget;  /* most bytes the grid may hold; 0: 4 GiB; UINT64_MAX: no limit */
    VOX_OPTIONAL const struct vox_allocator* allocator;      /* null: the C++ runtime's heap */
    VOX_OPTIONAL const struct vox_log* log;                  /* null: no log */
    VOX_OPTIONAL const struct vox_task_system* tasks;        /* null: the built-in scheduler */
    VOX_OPTIONAL const struct vox_reference_desc* reference; /* null: the fast engine; else the paper's engine, which
                                                                is slower and finds the same (vox_cell_size.h) */
} vox_grid_desc;

static inline vox_grid_desc vox_default_grid_desc(void) {
    vox_grid_desc desc = VOX_ZERO;
    desc.struct_size = (uint32_t)sizeof desc;
    return desc;
}

/* Creates a grid. The caller owns *out_grid and releases it with vox_grid_destroy.
 * Errors: INVALID_ARGUMENT (names the field), OUT_OF_MEMORY, BUDGET. */
VOX_API vox_result vox_grid_create(VOX_OPTIONAL const vox_grid_desc* desc, vox_grid** out_grid);

/* Destroys a grid, its bodies and results. Null does nothing. */
VOX_API void vox_grid_destroy(VOX_OPTIONAL vox_grid* grid);

/* ---- meshes ----------------------------------------------------------------------------------- */

/* A body of a grid: a mesh or a rigid shape. An id is never used again in the same grid. Ids ascend with slots, so in
 * a new grid they ascend in the order of insertion. */
typedef uint32_t vox_body;
#define VOX_NULL_BODY 0u /* names no body */

/* The slot of a body: a small index from 0, for arrays with one element per body. Slots of removed bodies are used
 * again. */
static inline uint32_t vox_body_slot(vox_body body) { return body >> 12; }

typedef enum vox_filter_flags {
    VOX_FILTER_SELF_COLLISION = 1, /* the mesh also collides with itself */
    VOX_FILTER_SENSOR = 2          /* the body has contacts and pairs, but no constraints; takes less memory */
} vox_filter_flags;

#define VOX_MAX_RINGS 8u /* vox_filter.self_rings */

/* What a body collides with. With all fields 0, the default, it collides with every other body, but not with itself.
 * Two bodies in different worlds never collide; use worlds for copies of a scene in one grid. Two bodies with the
 * same group other than 0 collide if it is positive and do not collide if it is negative. Any other two collide if
 * the category of each has a bit in common with the mask of the other, as in Box2D. A tetrahedron that is ruled out
 * for a vertex is treated as if it did not exist. */
typedef struct vox_filter {
    uint32_t flags; /* vox_filter_flags, combined with | */
    int32_t group;
    uint64_t category; /* 0: 1 */
    uint64_t mask;     /* 0: all bits */
    uint32_t world;
    /* Self-contact ignores tetrahedra that have a corner within this many edges of the vertex; at most VOX_MAX_RINGS.
     * Takes about 60, 260 or 700 bytes per vertex for 1, 2 or 3. */
    uint32_t self_rings;
    /* Self-contact ignores tetrahedra that are closer to the vertex than this in the rest pose. The rest pose is
     * vox_mesh_desc.rest_positions or, without these, the positions when this distance is first set. */
    double self_rest_distance;
} vox_filter;

typedef enum vox_mesh_flags {
    VOX_MESH_COPY_POSITIONS = 1, /* copy the positions instead of borrowing them */
    VOX_MESH_BORROW_TETS = 2     /* borrow the tetrahedra instead of copying them, 16 bytes each */
} vox_mesh_flags;

/* A mesh: vertices, and tetrahedra between them. A mesh without tetrahedra is a set of points, which collide with
 * tetrahedra and shapes; edges and faces between them collide with nothing. */
typedef struct vox_mesh_desc {
    uint32_t struct_size;
    uint32_t flags; /* vox_mesh_flags, combined with | */
    /* positions.count is the number of vertices. The data is borrowed until the mesh is removed or bound to other
     * positions. Every step reads it: to move the mesh, write to it between steps. If it is null, bind positions
     * before the next step. */
    vox_positions positions;
    VOX_OPTIONAL const uint32_t* tets; /* 4 * tet_count vertex indices, in either winding. Copied; or borrowed until
                                          the mesh is removed or edited */
    uint64_t tet_count;
    uint64_t user_data; /* any number; results repeat it */
    vox_filter filter;
    vox_positions rest_positions; /* copied; see vox_filter.self_rest_distance */
} vox_mesh_desc;

static inline vox_mesh_desc vox_default_mesh_desc(void) {
    vox_mesh_desc desc = VOX_ZERO;
    desc.struct_size = (uint32_t)sizeof desc;
    return desc;
}

/* Describes a mesh with packed floats x y z. */
static inline vox_mesh_desc vox_mesh_desc_floats(const float* xyz, uint64_t vertex_count, const uint32_t* tets,
                                                 uint64_t tet_count) {
    vox_mesh_desc desc = vox_default_mesh_desc();
    desc.positions = vox_float_positions(xyz, vertex_count);
    desc.tets = tets;
    desc.tet_count = tet_count;
    return desc;
}

/* Describes a mesh with packed doubles x y z. */
static inline vox_mesh_desc vox_mesh_desc_doubles(const double* xyz, uint64_t vertex_count, const uint32_t* tets,
                                                  uint64_t tet_count) {
    vox_mesh_desc desc = vox_default_mesh_desc();
    desc.positions = vox_double_positions(xyz, vertex_count);
    desc.tets = tets;
    desc.tet_count = tet_count;
    return desc;
}

/* Adds a mesh, which takes part from the next step on. Positions whose format is FLOAT, but that can only be doubles,
 * are refused when they are first read.
 * Errors: INVALID_ARGUMENT, INVALID_MESH, LIMIT, INVALID_STATE and NON_FINITE (rest pose), BUDGET, OUT_OF_MEMORY. */
VOX_API vox_result vox_mesh_insert(vox_grid* grid, const vox_mesh_desc* desc, vox_body* out_body);

/* Removes a body. The results of the last step stay as they are; the next step ends the body's pairs. */
VOX_API vox_result vox_body_remove(vox_grid* grid, vox_body body);

/* Makes a mesh borrow another array of positions, one for each vertex, in place of its present array.
 * There is no need to bind the same array again after writing to it. Errors: INVALID_ARGUMENT (e.g. another count). */
VOX_API vox_result vox_mesh_bind_positions(vox_grid* grid, vox_body body, const vox_positions* positions);

/* Binds packed floats x y z. */
static inline vox_result vox_mesh_bind_floats(vox_grid* grid, vox_body body, const float* xyz, uint64_t count) {
    const vox_positions positions = vox_float_positions(xyz, count);
    return vox_mesh_bind_positions(grid, body, &positions);
}

/* Binds packed doubles x y z. */
static inline vox_result vox_mesh_bind_doubles(vox_grid* grid, vox_body body, const double* xyz, uint64_t count) {
    const vox_positions positions = vox_double_positions(xyz, count);
    return vox_mesh_bind_positions(grid, body, &positions);
}

/* ---- step ------------------------------------------------------------------------------------- */

/* Finds all contacts of the bodies as they are now, and whatever the flags ask for. This replaces the results of the
 * previous step. If the step fails there are no results, and the grid stays usable. A body that has not moved costs
 * little more than reading its positions. In the steady state a step allocates no memory; but the first search for a
 * closest point in a body makes that body's tree, unless vox_grid_prepare did.
 * Errors: INVALID_STATE (a mesh without positions), NON_FINITE, LIMIT, INVALID_ARGUMENT (doubles read as floats; a
 * task system that broke its rules), BUDGET, OUT_OF_MEMORY. vox_grid_get_failure names the body. */
VOX_API vox_result vox_grid_step(vox_grid* grid);

/* Steps many different grids, several at a time: for many small scenes. worker_count and `tasks` are as in
 * vox_grid_desc; each grid is stepped by one thread and should have a worker_count of 0 itself. If a grid fails, the
 * others are stepped nevertheless; `results` receives the result of each. Returns the first failure, whose text says
 * which grid.
 * Errors: as vox_grid_step; INVALID_ARGUMENT (a null or repeated grid) or OUT_OF_MEMORY before any grid is stepped. */
VOX_API vox_result vox_grids_step(vox_grid* const* grids, uint64_t count, uint32_t worker_count,
                                  VOX_OPTIONAL const struct vox_task_system* tasks, VOX_OPTIONAL vox_result* results);

/* ---- contacts: which vertex is in which tetrahedron ------------------------------------------- */

/* Vertex `vertex` of body_a lies in the closed tetrahedron `tet` of body_b and is not one of its corners. This is
 * decided exactly. For each vertex and body_b there is a contact for every tetrahedron that has the vertex in its
 * interior. If there is none, there is one for the lowest tetrahedron that has it on its boundary. A tetrahedron of
 * zero volume contains nothing. */
typedef struct vox_contact {
    vox_body body_a;
    uint32_t vertex;
    vox_body body_b;
    uint32_t tet;
} vox_contact;

/* Contacts, sorted by (body_a, vertex, body_b, tet). The arrays live until the end of the epoch. */
typedef struct vox_contact_view {
    const vox_contact* data;
    uint64_t count;
    const uint8_t* interiors; /* one for each contact: 1 if the vertex is in the interior, 0 if on the boundary */
} vox_contact_view;

/* Gets the contacts of the last step. There are none before the first step and after a failed one. */
VOX_API vox_result vox_grid_get_contacts(const vox_grid* grid, vox_contact_view* out_view);

/* Gets a hash of the contacts and their order, which is the same on every machine. */
VOX_API vox_result vox_grid_get_hash(const vox_grid* grid, uint64_t* out_hash);

/* ---- pairs: which bodies touch ---------------------------------------------------------------- */

/* What changed since the last successful step. */
typedef enum vox_pair_state {
    VOX_PAIR_NEAR = 0,      /* does not touch, but is within the margin */
    VOX_PAIR_BEGAN = 1,     /* touches now and did not before */
    VOX_PAIR_PERSISTED = 2, /* touches now and did before */
    VOX_PAIR_ENDED = 3      /* touched before and does not now */
} vox_pair_state;

/* Two bodies that touch, or touched in the step before. They touch if a vertex of one is inside the other or went
 * through it within the step, or if an edge of one meets a face of the other. body_a < body_b; they are equal for a
 * mesh that touches itself. A pair that began ends exactly once, even if a body is removed, disabled or filtered out,
 * or the grid is cleared. Its ids may be stale then. */
typedef struct vox_pair {
    vox_body body_a;
    vox_body body_b;
    uint64_t user_data_a;
    uint64_t user_data_b;
    vox_pair_state state;
    uint32_t reserved;
    uint64_t first_contact; /* see vox_pair_view.contacts */
    uint64_t contact_count; /* 0 if the two touch in another way, or no longer */
} vox_pair;

/* Pairs, sorted by (body_a, body_b). The arrays live until the end of the epoch. */
typedef struct vox_pair_view {
    const vox_pair* data;
    uint64_t count;
    const uint32_t* contacts; /* indices of contacts. A pair has contact_count of them, from contacts[first_contact]
                                 on: first for vertices of body_a, then for vertices of body_b */
} vox_pair_view;

/* Gets the pairs of the last step. There are none before the first step and after a failed one. Read them after every
 * step, as each step reports only its own changes. The totals in vox_grid_info show whether a program has missed
 * some. */
VOX_API vox_result vox_grid_get_pairs(const vox_grid* grid, vox_pair_view* out_view);

/* ---- constraints: what a solver needs --------------------------------------------------------- */

/* Why there is a constraint. A vertex has at most one INSIDE, PROXIMITY or IMPACT constraint with each body. */
typedef enum vox_constraint_kind {
    VOX_CONSTRAINT_INSIDE = 0,    /* a vertex of body_a is inside body_b */
    VOX_CONSTRAINT_EDGE = 1,      /* an edge of body_a meets a face of body_b (VOX_GRID_EDGES) */
    VOX_CONSTRAINT_PROXIMITY = 2, /* a vertex of body_a is outside body_b and within the margin (vox_grid_set_margin) */
    VOX_CONSTRAINT_IMPACT = 3     /* a vertex of body_a is not inside body_b, but went in within the step and is
                                     behind the face that it met first
                                     (vox_mesh_bind_previous_positions) */
} vox_constraint_kind;

/* How gap and normal were found, and thus how far to trust them (docs/depth.md). */
typedef enum vox_depth_state {
    VOX_DEPTH_SURFACE = 0,    /* a mean over the edges that lead from the vertex out of body_b */
    VOX_DEPTH_PROPAGATED = 1, /* a mean over neighbouring vertices that are closer to the surface */
    VOX_DEPTH_CLOSEST = 2,    /* the closest point of the surface, which may jump from step to step */
    VOX_DEPTH_AMBIGUOUS = 3,  /* the bodies pass through each other: the nearest way out, which may be the wrong side */
    VOX_DEPTH_TOUCHING = 4,   /* the bodies only touch here: gap 0 */
    VOX_DEPTH_UNKNOWN = 5,    /* closest_budget was used up: gap 0; or no depth was asked for: gap and normal 0 */
    VOX_DEPTH_PLANE = 6       /* the plane of the face: for IMPACT, and for EDGE of a mesh with itself */
} vox_depth_state;

#define VOX_STENCIL_CAPACITY 5u /* most vertices of a constraint */

/* A point of body_a and a point of body_b that must not pass through each other. Each is a weighted sum of vertices.
 * All vertices are in one list: first the vertices of body_a, whose weights add up to 1; then the vertices of body_b,
 * whose weights are negative and add up to -1. When vertex i is at x[i],
 *
 *     gap = offset + dot(normal, sum of weights[i] * x[i])        (vox_constraint_gap)
 *
 * is negative while the two overlap. Its gradient for vertex i is weights[i] * normal, so a solver pushes vertex i in
 * that direction, whatever the kind. With velocities in place of x, the sum is the velocity of the point of body_a
 * relative to the point of body_b, for damping and friction.
 *
 *     kind        vertices of body_a    vertices of body_b                        gap in the step
 *     INSIDE      the vertex            the tetrahedron that contains it          minus the depth
 *     EDGE        the edge              the face                                  minus the depth of its part inside,
 *                                                                                 from the middle of that part
 *     PROXIMITY   the vertex            the face with the closest point           the distance
 *     IMPACT      the vertex            the face that it met first                minus the distance behind its plane
 *
 * A rigid shape has no vertices and is always body_b. The plane of an IMPACT with it moves as the shape does. */
typedef struct vox_constraint {
    vox_body body_a;
    vox_body body_b;
    vox_constraint_kind kind;
    vox_depth_state state;
    uint32_t count_a;                        /* how many vertices of body_a */
    uint32_t count;                          /* how many vertices in all */
    uint32_t vertices[VOX_STENCIL_CAPACITY]; /* those beyond `count` are 0, and so are their weights */
    uint32_t element_b;                      /* tetrahedron of body_b: the lowest that contains the vertex; with a
                                                face, the tetrahedron behind it. Triangle of a shape; VOX_NONE if it
                                                has none */
    double weights[VOX_STENCIL_CAPACITY]; /* of corners of a tetrahedron: rounded as in vox_location (vox_query.h) */
    double normal[3]; /* a unit vector out of body_b, the way for body_a */
    double gap;
    double offset;
    double position[3]; /* of the point of body_a */
    double time;        /* when within the step, from 0 to 1, a vertex met the surface; 1 if that is not known */
    uint64_t user_data_a;
    uint64_t user_data_b;
    uint32_t pair;     /* index of its pair in vox_grid_get_pairs */
    uint32_t previous; /* index of the same constraint in the list of the step before, for a warm start; VOX_NONE if
                          it is new. Same means the same vertex and body_b, or the same edge and face */
    uint64_t left_out; /* how many more its pair would have without max_constraints_per_pair */
} vox_constraint;

/* The gap when the two bodies have these positions: packed doubles x y z, transformed. positions_b is not used for a
 * shape. */
static inline double vox_constraint_gap(const vox_constraint* c, const double* positions_a,
                                        VOX_OPTIONAL const double* positions_b) {
    double gap = c->offset;
    uint32_t i;
    for (i = 0; i < c->count; ++i) {
        const double* x = (i < c->count_a ? positions_a : positions_b) + 3 * (size_t)c->vertices[i];
        gap += c->weights[i] * (c->normal[0] * x[0] + c->normal[1] * x[1] + c->normal[2] * x[2]);
    }
    return gap;
}

/* How the depth of a vertex inside a mesh is found. */
typedef enum vox_depth_method {
    VOX_DEPTH_METHOD_CONSISTENT = 0, /* smooth along the surface; neighbouring vertices leave on the same side: for
                                        response (Heidelberger et al. 2004) */
    VOX_DEPTH_METHOD_CLOSEST = 1,    /* to the closest point of the surface, with the vertices of its face in place of
                                        the tetrahedron's: for finite elements, pictures, reports */
    VOX_DEPTH_METHOD_NONE = 2        /* none: vertices, weights and position alone. Quick */
} vox_depth_method;

/* Which constraints to find. By default all fields are 0: all constraints, with consistent depth. */
typedef struct vox_constraint_desc {
    uint32_t struct_size;
    vox_depth_method method;
    vox_body body_a;         /* only pairs of this body; VOX_NULL_BODY: all pairs */
    vox_body body_b;         /* only its pair with body_a; VOX_NULL_BODY: all pairs of body_a */
    uint64_t mask;           /* only pairs in which the category of a body has a bit in common with it; 0: all pairs */
    uint64_t closest_budget; /* most searches for a closest point; constraints that get none are UNKNOWN, and the log
                                has a warning. 0: no limit */
} vox_constraint_desc;

static inline vox_constraint_desc vox_default_constraint_desc(void) {
    vox_constraint_desc desc = VOX_ZERO;
    desc.struct_size = (uint32_t)sizeof desc;
    return desc;
}

/* Constraints, sorted by pair, then by kind, body_a and vertices; the vertices of a face ascend. Pair p of
 * vox_grid_get_pairs has data[pair_offsets[p]] to data[pair_offsets[p + 1] - 1]. The arrays live until the end of
 * the epoch, or until constraints are found again. */
typedef struct vox_constraint_view {
    const vox_constraint* data;
    uint64_t count;
    const uint64_t* pair_offsets; /* pair_count + 1 */
    uint64_t pair_count;          /* as in vox_pair_view.count */
} vox_constraint_view;

/* Finds the constraints of the last step. This replaces constraints that were found before. With VOX_GRID_CONSTRAINTS
 * every step does so itself. Call it before anything moves: positions must be as they were in the step, and no body of
 * a pair may have been removed or edited. Constraints between bodies at rest are carried over.
 * Errors: INVALID_STATE (no step yet; a body was removed or edited), INVALID_ARGUMENT, NON_FINITE, LIMIT, BUDGET,
 * OUT_OF_MEMORY. */
VOX_API vox_result vox_grid_find_constraints(vox_grid* grid, VOX_OPTIONAL const vox_constraint_desc* desc);

/* Gets the constraints that were found last. Errors: INVALID_STATE if none were looked for since the last step. */
VOX_API vox_result vox_grid_get_constraints(const vox_grid* grid, vox_constraint_view* out_view);

/* ---- bodies: more about them ------------------------------------------------------------------ */

/* Places a body. In the following steps a position x, y, z stands for
 *     x' = ((m[0] * x + m[1] * y) + m[2] * z) + m[3], y' likewise with m[4..7], z' with m[8..11],
 * computed in double in this order. Contacts are exact for x', y', z'. The matrix is copied; null: none. For a mesh it is
 * any affine map; for a shape it rotates, moves, and scales all axes alike, and may be off by rounding to floats.
 * Errors: INVALID_ARGUMENT (a number that is not finite, a map that is not of this kind), BUDGET, OUT_OF_MEMORY. */
VOX_API vox_result vox_body_set_transform(vox_grid* grid, vox_body body, VOX_OPTIONAL const double matrix[12]);

/* Disables a body (0), or enables it again (1). A disabled body takes no part in steps; its positions are not read.
 * Errors: INVALID_ARGUMENT (another number). */
VOX_API vox_result vox_body_set_enabled(vox_grid* grid, vox_body body, uint32_t enabled);

/* Sets what a body collides with from the next step on. Rings and rest distance are prepared in the call.
 * Errors: INVALID_ARGUMENT, LIMIT, INVALID_STATE (no rest pose), NON_FINITE, BUDGET, OUT_OF_MEMORY. */
VOX_API vox_result vox_body_set_filter(vox_grid* grid, vox_body body, const vox_filter* filter);

/* Keeps two bodies from colliding, whatever their filters say (0), or lets their filters decide again (1). Ends when
 * either body is removed. Errors: INVALID_ARGUMENT (another number; twice the same body), BUDGET, OUT_OF_MEMORY. */
VOX_API vox_result vox_grid_set_pair_enabled(vox_grid* grid, vox_body body_a, vox_body body_b, uint32_t enabled);

/* Makes the next step treat a body as if it had moved: for measurements. */
VOX_API vox_result vox_body_mark_moved(vox_grid* grid, vox_body body);

/* Gives a mesh a packed array of its own, in its format, which the caller may write to between steps. It starts with
 * the present positions, or zeros. It belongs to the grid and lives until other positions are bound, vertices are
 * appended or replaced, or the mesh is removed. Calling this again returns the same array. Errors: BUDGET,
 * OUT_OF_MEMORY. */
VOX_API vox_result vox_mesh_map_positions(vox_grid* grid, vox_body body, void** out_positions);

/* Makes a mesh borrow the positions that its vertices had before. In the following steps each vertex moves from there
 * to its position, in a straight line at constant speed, and steps also find IMPACT constraints. None is missed. A
 * vertex that misses a surface by no more than rounding errors may be reported. Bodies without previous positions
 * stand still. The transform does not apply to previous positions. Null ends this, as does a change of the mesh's
 * vertices. Snapshots do not keep it.
 * Errors: INVALID_ARGUMENT. */
VOX_EXPERIMENTAL vox_result vox_mesh_bind_previous_positions(vox_grid* grid, vox_body body,
                                                             VOX_OPTIONAL const vox_positions* positions);

/* A body as it is now. */
typedef struct vox_body_info {
    uint32_t struct_size;
    uint32_t shape;     /* vox_shape_kind; VOX_SHAPE_NONE for a mesh */
    uint64_t user_data;
    uint32_t enabled;   /* 1 or 0 */
    uint32_t flags;     /* vox_mesh_flags: COPY_POSITIONS if the grid owns the positions, BORROW_TETS while the caller
                           owns the tetrahedra */
    uint64_t tet_count; /* with disabled and removed ones: indices are below it */
    uint64_t enabled_tet_count;
    vox_positions positions; /* of a mesh, without its transform; valid as long as they stay bound or mapped */
    vox_filter filter;
    double transform[12];
} vox_body_info;

/* Gets a body's state. Set out_info->struct_size first. `positions` lives as its comment says. */
VOX_API vox_result vox_body_get_info(const vox_grid* grid, vox_body body, vox_body_info* out_info);

/* Gets the user_data that a body was inserted with. */
VOX_API vox_result vox_body_get_user_data(const vox_grid* grid, vox_body body, uint64_t* out_user_data);

/* Returns 1 if `body` names a body of the grid, else 0; gives 0 for a null grid. Cannot fail. */
VOX_API uint32_t vox_body_is_valid(VOX_OPTIONAL const vox_grid* grid, vox_body body);

/* Gets the first `capacity` bodies of the grid in ascending order, disabled ones included; `bodies` may be null if it
 * is 0. *out_count is the number of all. Errors: INVALID_ARGUMENT. */
VOX_API vox_result vox_grid_get_bodies(const vox_grid* grid, vox_body* bodies, uint64_t capacity, uint64_t* out_count);

/* ---- rigid shapes ----------------------------------------------------------------------------- */

/* Shapes are given in a frame of their own. vox_body_set_transform places them, and moves them from step to step. */
typedef enum vox_shape_kind {
    VOX_SHAPE_NONE = 0,
    VOX_SHAPE_HALF_SPACE = 1,  /* z <= 0: a floor */
    VOX_SHAPE_SPHERE = 2,      /* around the origin: radius */
    VOX_SHAPE_CAPSULE = 3,     /* along the z axis, around the origin: radius, half_length */
    VOX_SHAPE_CYLINDER = 4,    /* likewise, with flat ends */
    VOX_SHAPE_BOX = 5,         /* around the origin: half_size */
    VOX_SHAPE_HEIGHTFIELD = 6, /* terrain, solid below, without walls at its ends: heights, columns, rows, spacing */
    VOX_SHAPE_SOLID = 7,       /* the inside of a closed surface: positions, triangles */
    VOX_SHAPE_SHEET = 8,       /* what is within `radius` of triangles: a blade, a wall. A triangle that names a vertex
                                  twice is a segment of a needle: positions, triangles, radius */
    VOX_SHAPE_FIELD = 9        /* where a function of the caller is not positive: field, half_size */
} vox_shape_kind;

/* A rigid shape. It is copied as a whole. Lengths may be 0. */
typedef struct vox_shape_desc {
    uint32_t struct_size;
    vox_shape_kind kind;
    double radius;
    double half_length;  /* of a capsule, between the centres of its round ends */
    double half_size[3]; /* half the sides of a box; of a box around the origin that holds the shape of a field */
    vox_positions positions;
    VOX_OPTIONAL const uint32_t* triangles; /* 3 * triangle_count vertex indices; of a SOLID counter-clockwise as seen
                                               from outside */
    uint64_t triangle_count;
    VOX_OPTIONAL const double* heights; /* columns * rows numbers: z at x = column * spacing[0], y = row * spacing[1]
                                           is heights[row * columns + column]. A cell is two triangles, divided from
                                           the lower left to the upper right */
    uint32_t columns;
    uint32_t rows;
    double spacing[2];
    /* Computes the distances of `count` points, x y z each, from the shape in its frame. For a point outside it is at
     * most the true distance, up to rounding; for a point inside it is not above 0. Gradients, x y z each, point out of
     * the shape; their length does not matter. Steps call it on several threads at once, with at most 8 points. It must
     * not call the grid. */
    VOX_OPTIONAL void (*field)(const double* points, uint64_t count, double* distances, double* gradients, void* user);
    VOX_OPTIONAL void* field_user; /* passed to `field` as `user` */
    uint64_t user_data;
    vox_filter filter; /* self-collision, rings and rest distance have no meaning */
} vox_shape_desc;

static inline vox_shape_desc vox_default_shape_desc(void) {
    vox_shape_desc desc = VOX_ZERO;
    desc.struct_size = (uint32_t)sizeof desc;
    return desc;
}

/* Adds a shape, which takes part from the next step on. The vertices of meshes collide with it. With VOX_GRID_EDGES,
 * so do their edges and faces, with the flat sides of a BOX, HEIGHTFIELD, SOLID or SHEET. Shapes do not collide with
 * each other. A shape has pairs and constraints, but no contacts, and is always body_b.
 *
 * A vertex is looked at in the shape's frame, where its place is computed in double. Whether that place is in the shape
 * is decided exactly, but for a FIELD and a SHEET with a radius. The surface is part of the shape. The gap of a
 * HALF_SPACE, SPHERE or BOX is off by at most one unit in the last place, unless the shape is scaled. The gap of others
 * is rounded in proportion to the coordinates.
 *
 * An EDGE constraint has the two vertices of an edge of the mesh, or the three of a face that an edge of the shape
 * passes through. An edge of the mesh is as deep as the middle of its part in the shape. A SHEET has no inside: the
 * shorter part of the edge has to leave. A face has to move until the middle of the part behind it is on its plane.
 * Errors: INVALID_ARGUMENT, INVALID_MESH (e.g. an open SOLID), NON_FINITE, LIMIT, BUDGET, OUT_OF_MEMORY. */
VOX_EXPERIMENTAL vox_result vox_shape_insert(vox_grid* grid, const vox_shape_desc* desc, vox_body* out_body);

/* Says where a shape was before. In the following steps it moves from there to its transform, and steps also find
 * IMPACT constraints with it. Each vertex moves through the shape's frame in a straight line, at constant speed. A
 * vertex that begins in a shape, or on its surface, does not meet it. On a SHEET without a radius it is on neither
 * side, and may still meet triangles other than those that it begins on. The matrix is as in vox_body_set_transform,
 * and copied; null ends this. Snapshots do not keep it.
 * Errors: INVALID_ARGUMENT (e.g. a mesh, which has vox_mesh_bind_previous_positions), OUT_OF_MEMORY, BUDGET. */
VOX_EXPERIMENTAL vox_result vox_shape_set_previous_transform(vox_grid* grid, vox_body body,
                                                             VOX_OPTIONAL const double matrix[12]);

/* ---- measurements: and settings of a grid ----------------------------------------------------- */

/* Removes all bodies and results, and keeps the settings. The next step ends all pairs. */
VOX_API vox_result vox_grid_clear(vox_grid* grid);

/* Allocates memory for this many bodies and contacts in advance, besides what the bodies themselves need.
 * Errors: LIMIT, BUDGET, OUT_OF_MEMORY. */
VOX_API vox_result vox_grid_reserve(vox_grid* grid, uint32_t body_count, uint64_t contact_count);

/* Makes now what steps make of a mesh once, when they first need it: topology, rings, tiles of its surface and the tree
 * over that, as far as the flags, the margin and its filter ask for them. Meshes without positions are passed over.
 * It takes no room for results, and leaves the results of the last step as they are.
 * Errors: NON_FINITE, LIMIT, INVALID_ARGUMENT (doubles read as floats), BUDGET, OUT_OF_MEMORY. */
VOX_EXPERIMENTAL vox_result vox_grid_prepare(vox_grid* grid);

/* Sets vox_grid_desc.cell_size for the following steps. Errors: INVALID_ARGUMENT (negative, infinite, NaN). */
VOX_API vox_result vox_grid_set_cell_size(vox_grid* grid, double cell_size);

/* Sets vox_grid_desc.worker_count for the following steps. Errors: INVALID_ARGUMENT. */
VOX_API vox_result vox_grid_set_worker_count(vox_grid* grid, uint32_t worker_count);

/* Sets all vox_grid_desc.flags for the following steps. Memory that is no longer needed is released.
 * Errors: INVALID_ARGUMENT, UNSUPPORTED (in this build). */
VOX_API vox_result vox_grid_set_flags(vox_grid* grid, uint32_t flags);

/* Sets the margin for the following steps: vertices outside another body, but no further than this from its surface,
 * have PROXIMITY constraints, and the two bodies are a pair. 0, the default: none, at no cost. Snapshots lack it.
 * Errors: INVALID_ARGUMENT (negative, NaN, above 2^125), UNSUPPORTED (in this build). */
VOX_EXPERIMENTAL vox_result vox_grid_set_margin(vox_grid* grid, double margin);

/* A grid as it is now, and what its last successful step did. */
typedef struct vox_grid_info {
    uint32_t struct_size;
    uint32_t flags;          /* vox_grid_flags */
    uint64_t epoch;          /* counts up when an epoch ends (see Ownership above) */
    double cell_size;        /* as it was set, or else as it was used last; 0 before the first step */
    double margin;
    uint64_t bytes;          /* held now, without the caller's arrays */
    uint64_t peak_bytes;
    uint64_t step_ns;        /* nanoseconds */
    uint64_t moved_bodies;   /* bodies that were not at rest */
    uint64_t skipped_bodies; /* bodies that were left out (VOX_GRID_SKIP_BAD_BODIES) */
    uint64_t total_began;    /* pairs that began, in all steps so far */
    uint64_t total_ended;    /* pairs that ended, in all steps so far */
} vox_grid_info;

/* Gets a grid's state. Set out_info->struct_size first. */
VOX_API vox_result vox_grid_get_info(const vox_grid* grid, vox_grid_info* out_info);

/* A count, or a time in nanoseconds, with its name. */
typedef struct vox_counter {
    const char* name; /* static text, e.g. "candidates" or "lookup_ns" */
    uint64_t value;
} vox_counter;

/* Counters. A library always has the same ones in the same order. */
typedef struct vox_counter_view {
    const vox_counter* data;
    uint64_t count;
} vox_counter_view;

/* Gets counts and times of the last step, stage by stage (docs/engine.md lists them). They live until the end of the
 * epoch. */
VOX_API vox_result vox_grid_get_counters(const vox_grid* grid, vox_counter_view* out_view);

/* A body that made a step fail, or that a step left out. */
typedef struct vox_failure {
    uint32_t struct_size;
    vox_result result;  /* VOX_OK: there is no such body */
    vox_body body;
    uint32_t vertex;    /* the first vertex with a bad coordinate; VOX_NONE if the failure is not about a vertex */
    uint64_t user_data;
    double position[3]; /* of that vertex, transformed */
} vox_failure;

/* Gets the body that made the last step fail, with index 0; or else the bodies that it left out, with indices from 0
 * on. Set out_failure->struct_size first. Errors: INVALID_ARGUMENT. */
VOX_API vox_result vox_grid_get_failure(const vox_grid* grid, uint32_t index, vox_failure* out_failure);

/* ---- cutting and growing ---------------------------------------------------------------------- */

/* Edits of a mesh between steps. Vertices and tetrahedra keep their indices whatever happens to others; the indices
 * of removed ones are not used again. An edit takes time in proportion to what it changes. The first edit of a mesh,
 * and a step after edits of more than an eighth of it, take time in proportion to the mesh. docs/cutting.md shows how
 * to cut a mesh open.
 * Errors of all: INVALID_ARGUMENT (e.g. an index that does not exist or was removed), INVALID_MESH, LIMIT, BUDGET,
 * OUT_OF_MEMORY. */

/* Replaces vertices, tetrahedra and positions by what desc has. Id, user data, filter, transform and disabled pairs
 * stay. If desc has no positions, but as many vertices as the mesh, positions and rest pose stay, too.
 * Errors: also INVALID_STATE and NON_FINITE (rest pose). */
VOX_API vox_result vox_mesh_set_topology(vox_grid* grid, vox_body body, const vox_mesh_desc* desc);

/* Disables tetrahedra (0), or enables them again (1). A disabled tetrahedron contains no vertices and has no edges
 * and faces. Its vertices still collide with others. */
VOX_API vox_result vox_mesh_set_tets_enabled(vox_grid* grid, vox_body body, const uint32_t* tets, uint64_t count,
                                             uint32_t enabled);

/* Gives tetrahedron tets[i] the corners corners[4 * i] to corners[4 * i + 3]. */
VOX_API vox_result vox_mesh_replace_tets(vox_grid* grid, vox_body body, const uint32_t* tets, uint64_t count,
                                         const uint32_t* corners);

/* Adds `count` tetrahedra with four corners each. *out_first is the index of the first; the others follow. */
VOX_API vox_result vox_mesh_append_tets(vox_grid* grid, vox_body body, const uint32_t* corners, uint64_t count,
                                        uint32_t* out_first);

/* Removes tetrahedra. Their vertices stay. */
VOX_API vox_result vox_mesh_remove_tets(vox_grid* grid, vox_body body, const uint32_t* tets, uint64_t count);

/* Vertices to append. */
typedef struct vox_vertices_desc {
    uint32_t struct_size;
    uint32_t reserved; /* 0 */
    uint64_t count;
    /* In the mesh's format. If the mesh borrows its positions: an array for all vertices, the old ones first,
     * borrowed from now on. If it owns them: the positions of the new vertices, copied; or none, with copies_of. */
    vox_positions positions;
    VOX_OPTIONAL const uint32_t* copies_of; /* `count` indices: the vertex whose position and rest position each one
                                               gets */
    vox_positions rest_positions; /* of the new vertices, if the mesh has a rest pose. Default: as copies_of says,
                                     or else `positions` */
} vox_vertices_desc;

static inline vox_vertices_desc vox_default_vertices_desc(void) {
    vox_vertices_desc desc = VOX_ZERO;
    desc.struct_size = (uint32_t)sizeof desc;
    return desc;
}

/* Adds vertices, which belong to no tetrahedron yet. *out_first is the index of the first; the others follow.
 * Errors: also INVALID_STATE (a mesh with a rest pose, a vertex without), NON_FINITE. */
VOX_API vox_result vox_mesh_append_vertices(vox_grid* grid, vox_body body, const vox_vertices_desc* desc,
                                            uint32_t* out_first);

/* Removes vertices that belong to no enabled tetrahedron. Their positions are still read and must stay finite. */
VOX_API vox_result vox_mesh_remove_vertices(vox_grid* grid, vox_body body, const uint32_t* vertices, uint64_t count);

/* Copies the first `capacity` tetrahedra: four corners each, and 1 if it is enabled or 0 if it is disabled or
 * removed. *out_count is the number of all. */
VOX_API vox_result vox_mesh_get_tets(const vox_grid* grid, vox_body body, VOX_OPTIONAL uint32_t* corners,
                                     VOX_OPTIONAL uint8_t* enabled, uint64_t capacity, uint64_t* out_count);

/* ---- snapshots -------------------------------------------------------------------------------- */

/* Writes a grid to `bytes`, in a format that is the same on every machine (docs/snapshot.md): settings, bodies with
 * their ids and positions, and which pairs touch. It does not contain allocator, log, tasks, worker_count,
 * byte_budget, margin, previous positions and results. *out_size is the number of bytes; with `bytes` null nothing is
 * written.
 * Errors: INVALID_ARGUMENT (the capacity is too small), INVALID_STATE (a shape with a FIELD). */
VOX_API vox_result vox_grid_save(const vox_grid* grid, VOX_OPTIONAL void* bytes, uint64_t capacity, uint64_t* out_size);

/* Creates a grid from a snapshot. Ids name the same bodies, and steps give the same results. Meshes own their
 * positions; map or bind positions to move them. desc supplies what snapshots do not contain; its flags, cell_size
 * and max_constraints_per_pair are ignored. The bytes need not be trusted. The caller owns *out_grid and releases it
 * with vox_grid_destroy.
 * Errors: FORMAT (names the place), UNSUPPORTED (a later version), INVALID_ARGUMENT, LIMIT, BUDGET, OUT_OF_MEMORY. */
VOX_API vox_result vox_grid_load(const void* bytes, uint64_t size, VOX_OPTIONAL const vox_grid_desc* desc,
                                 vox_grid** out_grid);

/* ---- memory and log --------------------------------------------------------------------------- */

/* An allocator. `allocate` returns `size` bytes at `alignment` (a power of two), or null. `release` receives the same
 * size and alignment again. If both are null, the C++ runtime's heap is used. They are called only from functions of
 * the object they were given to, one call at a time, on the calling thread or on a thread that runs its tasks. A
 * locator that outlives its grid calls `release` on the thread that releases it. */
typedef struct vox_allocator {
    VOX_OPTIONAL void* (*allocate)(size_t size, size_t alignment, void* user);
    VOX_OPTIONAL void (*release)(void* memory, size_t size, size_t alignment, void* user);
    void* user;
} vox_allocator;

/* How serious a line of the log is. */
typedef enum vox_log_level { VOX_LOG_INFO = 0, VOX_LOG_WARNING = 1 } vox_log_level;

/* Receives lines of text, valid during the call, on the thread that called the library. It must not call the grid. */
typedef struct vox_log {
    VOX_OPTIONAL void (*write)(vox_log_level level, const char* text, void* user);
    void* user;
} vox_log;

/* ---- threads ---------------------------------------------------------------------------------- */

/* Does the items [begin, end) of a task, on any thread. `worker` is below worker_count; two calls at the same time
 * have different ones. */
typedef void vox_task(uint64_t begin, uint64_t end, uint32_t worker, void* context);

/* The caller's scheduler, as in Box3D. `enqueue` splits the items [0, item_count) into ranges, of at least min_range
 * items where possible, and has `task` called once for each, now or later, on any thread. It returns a handle, for
 * which `finish` waits until these calls have returned; or null if they have already. If both are null, the built-in
 * scheduler is used. Both are called on the thread that called the library, at most VOX_MAX_TASKS times in a call. If
 * not every item is done exactly once, the library's call fails with INVALID_ARGUMENT. */
typedef struct vox_task_system {
    VOX_OPTIONAL void* (*enqueue)(vox_task* task, uint64_t item_count, uint64_t min_range, void* context, void* user);
    VOX_OPTIONAL void (*finish)(void* handle, void* user);
    void* user;
} vox_task_system;

#define VOX_MAX_TASKS 64u /* in one call */

/* ---- version: and what libraries over this one need ------------------------------------------- */

/* The version of the library at run time: major * 1000000 + minor * 1000 + patch. Cannot fail. */
VOX_API uint32_t vox_version(void);

/* The VOX_ABI_VERSION of the library at run time. Cannot fail. */
VOX_API uint32_t vox_abi_version(void);

/* Version, compiler, instruction sets, scheduler and options of the library, in one line. Static text; never null. */
VOX_API const char* vox_build_info(void);

/* Sets this thread's vox_last_error() to a copy of `text`, of 1023 bytes at most, and returns `result`: for libraries
 * that report failures in the same way. Null counts as "". Cannot fail itself. */
VOX_API vox_result vox_fail(vox_result result, VOX_OPTIONAL const char* text);

#ifdef __cplusplus
}
#endif

#endif
