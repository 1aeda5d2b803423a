/* vox: exact collision detection for deformable tetrahedral meshes on a voxel grid.
 *
 * This header is the whole core library: plain C99, fixed-width types, no structs by value across
 * the border. Its version is written here and nowhere else.
 *
 * Conventions that hold for every function unless its comment says otherwise
 *   Errors    A function that can fail returns vox_result. On failure the out-parameters are left
 *             untouched, nothing has changed, and vox_last_error() gives the reason with numbers in it.
 *             No function prints, exits, throws or asserts on user input, in any build.
 *             Everywhere: INVALID_ARGUMENT for a null pointer that a comment does not allow, INVALID_HANDLE
 *             for an id that names no mesh of the grid.
 *   Structs   Structs whose first field is struct_size may grow. Fill them with vox_X_init or
 *             vox_default_X; in those that a function writes, set struct_size before. The library reads
 *             and writes only the fields that struct_size covers, so old programs run with new libraries
 *             and the reverse. A struct_size below 4 or above 65536 is an INVALID_ARGUMENT.
 *   Ownership The library copies what it is given, except positions bound as borrowed. Pointers it
 *             hands out belong to it and live as long as their comment says.
 *   Threads   One thread at a time may change a grid. Between changes any number of threads may read
 *             it: a function that takes a const grid reads it, any other changes it. Different grids are
 *             independent. Functions without a grid run on any thread, at any time. vox_last_error() is
 *             per thread.
 *   Units     Lengths are in the caller's own unit; nothing in the library has a length built in.
 */
#ifndef VOX_VOX_H
#define VOX_VOX_H

#include <stddef.h>
#include <stdint.h>

#define VOX_VERSION_MAJOR 0
#define VOX_VERSION_MINOR 1
#define VOX_VERSION_PATCH 0

/* Of the stable interface. A program built with one runs with every library of the same; part of the shared libraries'
 * names (docs/abi.md). */
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

/* VOX_API: part of the stable interface. VOX_EXPERIMENTAL: may change in any release. docs/abi.md lists which. */
#define VOX_API VOX_EXPORT
#define VOX_EXPERIMENTAL VOX_EXPORT

#ifdef __cplusplus
extern "C" {
#endif

/* ---- results ---------------------------------------------------------------------------------- */

typedef enum vox_result {
    VOX_OK = 0,
    VOX_ERROR_INVALID_ARGUMENT = -1, /* a null pointer, an unknown enum, a bad number */
    VOX_ERROR_INVALID_HANDLE = -2,   /* a mesh id that is null, stale or from another grid */
    VOX_ERROR_INVALID_MESH = -3,     /* a tetrahedron names a vertex that does not exist */
    VOX_ERROR_INVALID_STATE = -4,    /* the call does not fit the state, e.g. no positions bound */
    VOX_ERROR_NON_FINITE = -5,       /* a position is NaN or infinite */
    VOX_ERROR_LIMIT = -6,            /* a documented limit would be passed */
    VOX_ERROR_BUDGET = -7,           /* the grid's byte budget would be passed */
    VOX_ERROR_OUT_OF_MEMORY = -8,    /* the allocator returned null */
    VOX_ERROR_UNSUPPORTED = -9,      /* known, but not offered by this build or version */
    VOX_ERROR_FILE = -10,            /* a file cannot be opened, read or written */
    VOX_ERROR_FORMAT = -11,          /* a file is malformed */
    VOX_ERROR_INTERNAL = -12,        /* a defect of the library: please report it */
    VOX_RESULT_FORCE_32_BITS = 0x7fffffff
} vox_result;

/* Name of a result code, e.g. "VOX_ERROR_BUDGET". Static text; never null. Any thread. */
VOX_API const char* vox_result_string(vox_result result);

/* This thread's last failure in words, e.g. "tet 17 names vertex 900 of 812"; "" before the first.
 * The text lives until the thread's next failing call. Successful calls leave it alone. Never null. */
VOX_API const char* vox_last_error(void);

/* Sets this thread's vox_last_error() text (copied, cut at 1023 bytes) and returns `result`, so that
 * libraries built on vox (vox_io among them) fail in the same words. A null text counts as "". Cannot fail itself. */
VOX_EXPERIMENTAL vox_result vox_fail(vox_result result, const char* text);

/* ---- version ---------------------------------------------------------------------------------- */

/* Version of the library that is running: major * 1000000 + minor * 1000 + patch. Cannot fail. */
VOX_API uint32_t vox_version(void);
/* The same as "major.minor.patch". Static text. Cannot fail. */
VOX_API const char* vox_version_string(void);
/* Compiler, language level, instruction sets and options of this build, one line. Static text. Cannot fail. */
VOX_API const char* vox_build_info(void);

/* ---- memory and log --------------------------------------------------------------------------- */

/* Per-grid allocator. `allocate` returns memory of at least `size` bytes at `alignment` (a power of
 * two), or null; `release` gets the same size and alignment back. Both null: the C++ runtime's heap.
 * Called only from functions of the grid it was given to, one call at a time; during a step that may be on a
 * thread that runs its tasks. */
typedef struct vox_allocator {
    void* (*allocate)(size_t size, size_t alignment, void* user);
    void (*release)(void* memory, size_t size, size_t alignment, void* user);
    void* user;
} vox_allocator;

/* What a line of the log is about. */
typedef enum vox_log_level {
    VOX_LOG_INFO = 0,
    VOX_LOG_WARNING = 1,
    VOX_LOG_LEVEL_FORCE_32_BITS = 0x7fffffff
} vox_log_level;

/* Receives one line of text (no newline), valid during the call only. Null: no log. Called on the
 * thread that called the library; it must not call the grid it came from. */
typedef struct vox_log {
    void (*write)(vox_log_level level, const char* text, void* user);
    void* user;
} vox_log;

/* ---- threads ---------------------------------------------------------------------------------- */

/* Handles the items [begin, end). `worker` is below worker_count; two calls that run at the same time have
 * different ones. */
typedef void vox_task(uint64_t begin, uint64_t end, uint32_t worker, void* context);

/* The caller's scheduler, in the manner of Box3D. `enqueue` splits the items [0, item_count) into ranges, of at
 * least min_range items where it can, and has `task` called once for each range, now or later, on any thread; it
 * returns a handle for `finish`, or null when all calls have already returned. `finish` returns when they have.
 * Both are called on the thread that called the library, at most VOX_MAX_TASKS times a step, and at most once by
 * vox_grid_prepare_readings; a call whose items were not all run, or on a worker that there is not, fails with
 * INVALID_ARGUMENT, and leaves no contacts, or no readings. Both null: the built-in scheduler. */
typedef struct vox_task_system {
    void* (*enqueue)(vox_task* task, uint64_t item_count, uint64_t min_range, void* context, void* user);
    void (*finish)(void* handle, void* user);
    void* user;
} vox_task_system;

#define VOX_MAX_TASKS 64u    /* enqueued in one step */
#define VOX_MAX_WORKERS 256u /* of a grid */

/* ---- grid ------------------------------------------------------------------------------------- */

/* Limits; passing one gives VOX_ERROR_LIMIT. docs/limits.md lists these and all others. */
#define VOX_MAX_MESHES 1048576u           /* per grid, at one time, with the slots that were retired */
#define VOX_MAX_GENERATIONS 4095u         /* uses of one mesh slot before it is retired */
#define VOX_MAX_VERTICES 2147483647u      /* per grid */
#define VOX_MAX_TETS 2147483647u          /* per grid */

/* How the reference engine stores cells; the fast engine has its own way. Contacts do not depend on it. */
typedef enum vox_storage {
    VOX_STORAGE_AUTO = 0,   /* the engine's choice */
    VOX_STORAGE_HASHED = 1, /* unbounded space: cells hashed into a table of prime size */
    VOX_STORAGE_DENSE = 2,  /* one list per cell of a box: linear id k*nx*ny + j*nx + i */
    VOX_STORAGE_FORCE_32_BITS = 0x7fffffff
} vox_storage;

/* Hash of a cell (i, j, k) for hashed storage. Contacts do not depend on it. */
typedef enum vox_hash {
    VOX_HASH_MIXED = 0, /* a well-mixed 64-bit hash: the default */
    VOX_HASH_PAPER = 1, /* i*73856093 xor j*19349663 xor k*83492791 (Teschner et al. 2003, Sect. 4.1) */
    VOX_HASH_FORCE_32_BITS = 0x7fffffff
} vox_hash;

/* Which algorithm runs. Contacts do not depend on it. */
typedef enum vox_engine {
    VOX_ENGINE_AUTO = 0,      /* fast, or reference when a storage is asked for */
    VOX_ENGINE_REFERENCE = 1, /* the paper's algorithm as printed (Sect. 3) */
    VOX_ENGINE_FAST = 2,      /* tiles of tets against dense windows of cells, with SIMD */
    VOX_ENGINE_FORCE_32_BITS = 0x7fffffff
} vox_engine;

typedef enum vox_grid_flags {
    VOX_GRID_PENETRATIONS = 1, /* the step's depth stage (vox_grid_penetrations); on by default. For meshes of at
                                  most 357913941 tets; more: VOX_ERROR_LIMIT */
    VOX_GRID_CONTACT_EVENTS = 2, /* events of single vertices too (vox_grid_contact_events) */
    VOX_GRID_FLAGS_FORCE_32_BITS = 0x7fffffff
} vox_grid_flags;

/* An open grid: a set of meshes and the settings they collide under. */
typedef struct vox_grid vox_grid;

typedef struct vox_grid_desc {
    uint32_t struct_size;
    vox_engine engine;
    vox_storage storage;
    vox_hash hash;
    /* Edge length of a cell, > 0. 0 (the default): the library chooses it, by the cost model of the engine. The
     * reference engine does so at the first step and again when the counts of its steps say that another size
     * would be better (bodies deform, come into contact, are inserted or removed); every change is written to the
     * log and counted in cell_size_changes. Where tetrahedra are of such unlike sizes that one cell size for all would
     * be dear, it uses a few grids, one after the other, each with a cell size and all vertices, for tetrahedra of
     * some sizes. The fast one chooses for each of its windows, at every step. */
    double cell_size;
    /* World box for dense storage, min < max on each axis. Points outside count to the nearest border
     * cell. All zero (the default): the box of all positions, found at every step. */
    double world_min[3];
    double world_max[3];
    /* Most bytes the grid may hold at any time; a call that would pass it fails with VOX_ERROR_BUDGET.
     * 0: no limit. Default 4 GiB. */
    uint64_t byte_budget;
    /* Buckets of the hash table, at most VOX_MAX_VERTICES, raised to the next prime. 0 (the default): the
     * first prime that is at least twice the number of vertices. */
    uint64_t hash_table_size;
    vox_allocator allocator;
    vox_log log;
    vox_task_system tasks;
    /* Threads that run a step's tasks: 1 (the default) serial, on the calling thread; 0 one per core; at most
     * VOX_MAX_WORKERS. The reference engine is serial. With a task system of one's own: how many workers it has,
     * at least 1. Contacts do not depend on it. A library built without oneTBB has no threads of its own: then the
     * built-in scheduler is serial. */
    uint32_t worker_count;
    uint32_t flags; /* vox_grid_flags, combined with |; default VOX_GRID_PENETRATIONS */
} vox_grid_desc;

/* Fills `desc` with the defaults for the fields that `struct_size` covers.
 * Errors: INVALID_ARGUMENT when desc is null or struct_size is not in [4, 65536]. */
VOX_API vox_result vox_grid_desc_init(vox_grid_desc* desc, uint32_t struct_size);

static inline vox_grid_desc vox_default_grid_desc(void) {
    vox_grid_desc desc;
    (void)vox_grid_desc_init(&desc, (uint32_t)sizeof desc);
    return desc;
}

/* Creates a grid. desc null: all defaults. The caller owns *out_grid and ends it with
 * vox_grid_destroy. Errors: INVALID_ARGUMENT (names the field and its value), OUT_OF_MEMORY, BUDGET. */
VOX_API vox_result vox_grid_create(const vox_grid_desc* desc, vox_grid** out_grid);

/* Ends a grid and releases all its memory; views and mesh ids from it are invalid. Null does nothing. */
VOX_API void vox_grid_destroy(vox_grid* grid);

/* Removes all meshes and contacts; settings stay. Old mesh ids become stale. */
VOX_API vox_result vox_grid_clear(vox_grid* grid);

/* Makes room for that many meshes and contacts, so that reaching them does not allocate for them; never takes
 * room away. Contacts stay, views of them end. Errors: LIMIT (more than VOX_MAX_MESHES), BUDGET, OUT_OF_MEMORY. */
VOX_API vox_result vox_grid_reserve(vox_grid* grid, uint32_t mesh_count, uint64_t contact_count);

/* Sets the cell size for the steps to come; 0: the library chooses. Never changes the contacts.
 * Errors: INVALID_ARGUMENT when negative, infinite or NaN. */
VOX_API vox_result vox_grid_set_cell_size(vox_grid* grid, double cell_size);

/* The cell size in use: the one set, or the one chosen for the last step (of several, that of the smallest
 * tetrahedra); 0 when none was chosen yet. */
VOX_API vox_result vox_grid_cell_size(const vox_grid* grid, double* out_cell_size);

/* Sets vox_grid_desc.worker_count for the steps to come. Errors: INVALID_ARGUMENT above VOX_MAX_WORKERS, and 0
 * with a task system of one's own. */
VOX_API vox_result vox_grid_set_worker_count(vox_grid* grid, uint32_t worker_count);

/* ---- meshes ----------------------------------------------------------------------------------- */

/* Names a mesh in its grid: slot and generation in one number. 0 is no mesh. Ids given out by one grid
 * ascend in slot order, so a fresh grid orders meshes as they were inserted. A removed mesh's id never
 * names another mesh of the grid. */
typedef uint32_t vox_mesh;
#define VOX_NULL_MESH 0u /* names no mesh */

typedef enum vox_format {
    VOX_FORMAT_FLOAT3 = 0,  /* three IEEE 754 singles x, y, z */
    VOX_FORMAT_DOUBLE3 = 1, /* three IEEE 754 doubles x, y, z, each of magnitude below 2^128 - 2^103 (3.4028236e38) */
    VOX_FORMAT_FORCE_32_BITS = 0x7fffffff
} vox_format;

typedef enum vox_mesh_flags {
    VOX_MESH_SELF_COLLISION = 1, /* also report vertices of the mesh inside its own tetrahedra */
    VOX_MESH_COPY_POSITIONS = 2, /* copy `positions` at insertion instead of borrowing them */
    VOX_MESH_FLAGS_FORCE_32_BITS = 0x7fffffff
} vox_mesh_flags;

#define VOX_MAX_RINGS 8u /* vox_filter.self_rings */

/* What a mesh does not collide with. Contacts that a filter rules out are as if they were not there: the rule of
 * vox_contact, every tetrahedron with the vertex in its interior or else the lowest on the boundary, holds for the
 * tetrahedra that are left. No filter changes the order of contacts or allocates in the step. */
typedef struct vox_filter {
    uint32_t struct_size;
    /* Two meshes of the same group, not 0, collide when it is positive and do not when it is negative. Otherwise
     * they collide when the category of each has a bit in common with the mask of the other. Defaults: 0, 1, all
     * bits. A mesh and itself: see self_collision. */
    int32_t group;
    uint64_t category;
    uint64_t mask;
    uint32_t self_collision; /* 1: vertices of the mesh inside its own tetrahedra are contacts; default 0 */
    /* Self-contact: skip tetrahedra with a corner within so many edges of the vertex, as the mesh's tetrahedra
     * connect them; at most VOX_MAX_RINGS. 0 (the default) skips those alone that own the vertex. Memory for
     * all vertices within so many edges of each: about 60 bytes a vertex for 1, 260 for 2, 700 for 3. */
    uint32_t self_rings;
    /* Self-contact: skip tetrahedra that are closer to the vertex than this in the rest pose, in the caller's unit
     * (distance to the closed tetrahedron, computed in double); 0 (the default): none. The rest pose is
     * vox_mesh_desc.rest_positions, or without those the positions at the time this was first set. */
    double self_rest_distance;
} vox_filter;

/* Fills `filter` with the defaults for the fields that `struct_size` covers. */
VOX_API vox_result vox_filter_init(vox_filter* filter, uint32_t struct_size);

static inline vox_filter vox_default_filter(void) {
    vox_filter filter;
    (void)vox_filter_init(&filter, (uint32_t)sizeof filter);
    return filter;
}

/* A body: vertices, and tetrahedra over them. Without tetrahedra (a surface, a set of points) its
 * vertices still collide with the tetrahedra of other meshes. */
typedef struct vox_mesh_desc {
    uint32_t struct_size;
    uint32_t flags; /* vox_mesh_flags, combined with | */
    /* vertex_count positions; may be null until vox_mesh_bind_positions. Borrowed: read during
     * vox_grid_step and must stay valid and unchanged while one runs, until the mesh is removed, bound
     * elsewhere or mapped. */
    const void* positions;
    uint64_t position_byte_stride; /* from one position to the next; 0: tightly packed */
    /* tet_count * 4 vertex indices, copied. Both windings are accepted. */
    const uint32_t* tets;
    uint64_t tet_count;
    uint64_t vertex_count;
    uint64_t user_data; /* the caller's own, given back by vox_mesh_user_data */
    vox_format position_format;
    uint32_t reserved; /* 0 */
    const vox_filter* filter; /* copied; null: the defaults. VOX_MESH_SELF_COLLISION turns self_collision on as well */
    /* vertex_count positions of the rest pose, in position_format, copied; null: see vox_filter.self_rest_distance. */
    const void* rest_positions;
    uint64_t rest_position_byte_stride; /* 0: tightly packed */
} vox_mesh_desc;

/* Fills `desc` with the defaults for the fields that `struct_size` covers. */
VOX_API vox_result vox_mesh_desc_init(vox_mesh_desc* desc, uint32_t struct_size);

static inline vox_mesh_desc vox_default_mesh_desc(void) {
    vox_mesh_desc desc;
    (void)vox_mesh_desc_init(&desc, (uint32_t)sizeof desc);
    return desc;
}

/* Adds a mesh. Takes part from the next step on.
 * Errors: INVALID_ARGUMENT, INVALID_MESH ("tet 17 names vertex 900 of 812"), LIMIT, BUDGET, OUT_OF_MEMORY. */
VOX_API vox_result vox_mesh_insert(vox_grid* grid, const vox_mesh_desc* desc, vox_mesh* out_mesh);

/* Takes a mesh out. Contacts of the last step stay as they are until the next one. */
VOX_API vox_result vox_mesh_remove(vox_grid* grid, vox_mesh mesh);

/* 1 when `mesh` names a mesh of the grid, else 0 (also for a null grid). Cannot fail. */
VOX_API uint32_t vox_mesh_is_valid(const vox_grid* grid, vox_mesh mesh);

/* The user_data the mesh was inserted with. */
VOX_API vox_result vox_mesh_user_data(const vox_grid* grid, vox_mesh mesh, uint64_t* out_user_data);

/* Borrows new positions for a mesh (vertex_count of them, byte_stride 0: tightly packed), under the rule
 * of vox_mesh_desc.positions; a copy made at insertion is released. Values written to the same memory
 * between steps need no new call. Errors: INVALID_ARGUMENT for an unknown format and a stride that is too small. */
VOX_API vox_result vox_mesh_bind_positions(vox_grid* grid, vox_mesh mesh, const void* positions,
                                           vox_format format, uint64_t byte_stride);

/* Has the next step look at a mesh even if it is at rest (see vox_grid_step). Contacts never need it; it is for
 * measuring steps over positions that stay the same. */
VOX_API vox_result vox_mesh_mark_moved(vox_grid* grid, vox_mesh mesh);

/* Sets what the mesh collides with, from the next step on (the filter is copied). Self-collision too: the flag given
 * at insertion counts no more. Builds what the self-contact filters need, in proportion to the mesh.
 * Errors: INVALID_ARGUMENT, LIMIT (self_rings), INVALID_STATE (a rest distance, and neither a rest pose nor
 * positions), NON_FINITE (a rest position), BUDGET, OUT_OF_MEMORY. */
VOX_API vox_result vox_mesh_set_filter(vox_grid* grid, vox_mesh mesh, const vox_filter* filter);

/* The filter in use: writes the fields that out_filter->struct_size covers (set it first). */
VOX_API vox_result vox_mesh_filter(const vox_grid* grid, vox_mesh mesh, vox_filter* out_filter);

/* enabled 0: the mesh takes no part in the steps to come, and its positions are not read; 1 (as inserted): it does
 * again. Its contacts of the last step stay until the next one. Errors: INVALID_ARGUMENT for other numbers. */
VOX_API vox_result vox_mesh_set_enabled(vox_grid* grid, vox_mesh mesh, uint32_t enabled);

/* enabled 0: the two meshes do not collide in the steps to come, whatever their filters; 1: as their filters say.
 * Ends with the removal of either mesh. Errors: INVALID_ARGUMENT for other numbers and for mesh_a = mesh_b (see
 * vox_filter.self_collision), BUDGET, OUT_OF_MEMORY. */
VOX_API vox_result vox_grid_set_pair_enabled(vox_grid* grid, vox_mesh mesh_a, vox_mesh mesh_b, uint32_t enabled);

/* Gives the mesh positions of its own to write to, vertex_count of them packed in the format it was inserted with or
 * bound to last: to begin with the ones it has, or zeros. From the next step on those in *out_positions count,
 * whatever is written there between steps; again called, it gives the same. They belong to the library and live
 * until the mesh is removed or bound, or the grid is cleared or destroyed. Null for a mesh without vertices.
 * A mesh inserted with VOX_MESH_COPY_POSITIONS has them already: nothing is copied.
 * Errors: BUDGET, OUT_OF_MEMORY. */
VOX_API vox_result vox_mesh_map_positions(vox_grid* grid, vox_mesh mesh, void** out_positions,
                                          uint64_t* out_byte_stride);

/* Moves a mesh as a whole: in the steps to come a vertex stands at
 *     x' = ((m[0] * x + m[1] * y) + m[2] * z) + m[3], y' likewise from m[4..7], z' from m[8..11],
 * computed from its position in double, in this order, each operation rounded. Contacts are exact for x', y', z' as
 * they come out, as if these had been given as VOX_FORMAT_DOUBLE3; where they pass the limits of that format, the
 * step fails. `matrix`: three rows of four, copied; any affine map. Null (the default): none, the positions as they
 * are. Stays when other positions are bound.
 * Errors: INVALID_ARGUMENT (an element that is not finite). */
VOX_API vox_result vox_mesh_set_transform(vox_grid* grid, vox_mesh mesh, const double matrix[12]);

/* ---- cutting and growing ---------------------------------------------------------------------- */

/* Edits of a mesh between steps. Indices stay: a tetrahedron or vertex keeps its index whatever happens to others,
 * and the index of one that was removed is never given to another (it counts towards the limits all the same), until
 * vox_mesh_set_topology begins anew. What an edit takes away is as if it were not there: for contacts, penetrations,
 * queries, suggestions and the rings of a filter. Contacts of the last step stay as they are until the next one,
 * whose events follow from it: a pair that still touches persists.
 * Time: that of an edit is in proportion to what it changes and to the tetrahedra around that, but for the first edit
 * of a mesh, which is in proportion to the mesh. So is the first step after an edit of more than an eighth of its
 * tetrahedra, or after edits that together, since the last time, changed more than a quarter of them; and a step after
 * an edit that found no memory for repairs. Memory: about 20 bytes a tetrahedron and 35 a vertex from the first edit
 * on, 16 a tetrahedron more once one was off. The first step after an edit may allocate.
 * Positions must be bound, or else come before the next step, as ever. `count` 0 does nothing; an index may be named
 * several times. Errors of all: INVALID_ARGUMENT (also: an index that the mesh does not have, or that was removed),
 * INVALID_MESH ("tet 17 names vertex 900 of 812", or one that was removed), LIMIT, BUDGET, OUT_OF_MEMORY. */

/* Other tetrahedra, vertices and positions, as if the mesh had been inserted with them; its id, user data, filter,
 * transform, exceptions of pairs and whether it is enabled stay. Of `desc`, user_data, filter and the flag
 * VOX_MESH_SELF_COLLISION do not count. positions null: those that it has, and its rest pose, stay where the number of
 * vertices does, else it has none until vox_mesh_bind_positions. The rest pose of a filter with a rest distance is
 * taken from desc as at insertion. Errors: also INVALID_STATE and NON_FINITE, as vox_mesh_set_filter. */
VOX_API vox_result vox_mesh_set_topology(vox_grid* grid, vox_mesh mesh, const vox_mesh_desc* desc);

/* enabled 0: the tetrahedra named are off, which means that they hold nothing and have no edges and facets; 1 (as
 * inserted): on again. Their vertices stay and collide with others either way. Errors: INVALID_ARGUMENT for other
 * numbers. */
VOX_API vox_result vox_mesh_set_tets_enabled(vox_grid* grid, vox_mesh mesh, const uint32_t* tets, uint64_t count,
                                             uint32_t enabled);

/* Gives tetrahedron tets[i] the corners corners[4 * i] to corners[4 * i + 3], copied, for each i below count: of an
 * index named twice the last. One that is off stays off. A cut that opens a gap appends copies of the vertices on it
 * and has the tetrahedra of one side name those. */
VOX_API vox_result vox_mesh_replace_tets(vox_grid* grid, vox_mesh mesh, const uint32_t* tets, uint64_t count,
                                         const uint32_t* corners);

/* Adds `count` tetrahedra with 4 corners each, copied; *out_first is the index of the first, those of the others
 * follow. */
VOX_API vox_result vox_mesh_append_tets(vox_grid* grid, vox_mesh mesh, const uint32_t* corners, uint64_t count,
                                        uint32_t* out_first);

/* Takes tetrahedra away, off ones too. Their vertices stay: see vox_mesh_remove_vertices. */
VOX_API vox_result vox_mesh_remove_tets(vox_grid* grid, vox_mesh mesh, const uint32_t* tets, uint64_t count);

/* Vertices to come, and where they are. All positions are in the format that the mesh was inserted with or bound to
 * last. */
typedef struct vox_vertices_desc {
    uint32_t struct_size;
    uint32_t reserved; /* 0 */
    uint64_t count;
    /* Of a mesh that borrows its positions: an array of all of them, first those of the vertices it has, then the new
     * ones, borrowed from now on instead of the old array, under the rule of vox_mesh_desc.positions. Of a mesh with
     * positions of its own (copied, mapped, or loaded): `count` of them, copied; what vox_mesh_map_positions gave
     * ends. May be null for a mesh that has none yet; with copies_of also for one with positions of its own. */
    const void* positions;
    uint64_t position_byte_stride; /* 0: tightly packed */
    /* For each the vertex that it is a copy of: null, or `count` indices of vertices that the mesh had before. A copy
     * begins where that is in the rest pose and, where `positions` is null, in the positions of the mesh's own. */
    const uint32_t* copies_of;
    /* For meshes with a rest pose (vox_filter.self_rest_distance), `count` positions in it, copied; null: those of
     * copies_of or, where that is null too, the positions of the new vertices as they are now. */
    const void* rest_positions;
    uint64_t rest_position_byte_stride; /* 0: tightly packed */
} vox_vertices_desc;

/* Fills `desc` with the defaults for the fields that `struct_size` covers: all 0. */
VOX_API vox_result vox_vertices_desc_init(vox_vertices_desc* desc, uint32_t struct_size);

static inline vox_vertices_desc vox_default_vertices_desc(void) {
    vox_vertices_desc desc;
    (void)vox_vertices_desc_init(&desc, (uint32_t)sizeof desc);
    return desc;
}

/* Adds vertices, which no tetrahedron names yet; *out_first is the index of the first, those of the others follow.
 * Errors: also INVALID_STATE (a rest pose, and no position for a new vertex), NON_FINITE (one of the rest pose). */
VOX_API vox_result vox_mesh_append_vertices(vox_grid* grid, vox_mesh mesh, const vox_vertices_desc* desc,
                                            uint32_t* out_first);

/* Takes vertices away that no tetrahedron which is on names (else INVALID_ARGUMENT): they make no contacts any more,
 * and no tetrahedron may name them again. Their positions are still read and must stay finite: best where they are. */
VOX_API vox_result vox_mesh_remove_vertices(vox_grid* grid, vox_mesh mesh, const uint32_t* vertices, uint64_t count);

/* ---- step and contacts ------------------------------------------------------------------------ */

/* Finds all contacts of the positions as they are now. On success the previous contacts are replaced; on
 * failure they are gone and the grid stays usable.
 * A mesh is at rest when its positions, bit by bit, are those of the last step; the fast engine keeps a copy to know.
 * Between meshes at rest, and of a mesh at rest with itself, contacts are taken over from the last step: such meshes
 * cost little more than reading their positions. (A mesh that has been moving is copied, and so looked at once more,
 * when it comes to rest.) A step that follows a failed one, or a change of a setting, looks at all meshes.
 * In the steady state (same meshes, no more to do than before) it allocates nothing, with any number of workers; the
 * built-in scheduler's own memory is oneTBB's, not the grid's.
 * Errors: INVALID_STATE (a mesh has no positions), NON_FINITE and LIMIT (a coordinate that VOX_FORMAT_DOUBLE3 does not
 * allow; both name mesh and vertex), LIMIT (more than VOX_MAX_CONTACTS; dense storage of 2^31 cells or more), BUDGET,
 * OUT_OF_MEMORY. */
VOX_API vox_result vox_grid_step(vox_grid* grid);

/* Vertex `vertex` of mesh_a lies in the closed tetrahedron `tet` of mesh_b, which does not own it.
 * Decided exactly for the coordinates given. Per (mesh_a, vertex, mesh_b): every tetrahedron that holds
 * the vertex in its interior; when none does, the one of lowest index whose boundary holds it. A
 * tetrahedron of exactly zero volume holds nothing.
 * `barycentric` are the vertex's weights for the tetrahedron's four corners in their given order: each in
 * [0, 1], the sum 1 to rounding. */
typedef struct vox_contact {
    vox_mesh mesh_a;
    uint32_t vertex;
    vox_mesh mesh_b;
    uint32_t tet;
    float barycentric[4];
} vox_contact;

/* `count` contacts, `byte_stride` apart, sorted by (mesh_a, vertex, mesh_b, tet). `data` lives until the
 * next step, clear, reserve or destroy of the grid; `epoch` is vox_grid_epoch() of that state. */
typedef struct vox_contact_view {
    const vox_contact* data;
    size_t byte_stride;
    uint64_t count;
    uint64_t epoch;
} vox_contact_view;

/* The contacts of the last step; count 0 before the first, after a failed one and after a clear. */
VOX_API vox_result vox_grid_contacts(const vox_grid* grid, vox_contact_view* out_view);

/* Number of steps, clears and reserves so far, failed steps included. A view is valid while its epoch is this. */
VOX_API vox_result vox_grid_epoch(const vox_grid* grid, uint64_t* out_epoch);

/* A hash of the contacts: all fields, in order. The same for any cell size, storage, hash and engine. */
VOX_API vox_result vox_grid_hash(const vox_grid* grid, uint64_t* out_hash);

/* ---- penetrations ----------------------------------------------------------------------------- */

/* How a penetration's depth and direction were found. Below, p is the vertex; a colliding vertex is one of mesh_a
 * with a contact with mesh_b; edges are those of mesh_a's tetrahedra; the surface of mesh_b are the facets of
 * exactly one of its tetrahedra, doubled ones taken once. SURFACE and PROPAGATED are the method of Heidelberger et
 * al. 2004; the other states are where it gives no answer. Closest: the closest point of mesh_b's surface to p;
 * depth is the distance to it and direction leads straight to it. For self-contact the surface is that of the
 * fold that p has entered, never a triangle that has p as a corner. */
typedef enum vox_penetration_state {
    VOX_PENETRATION_SURFACE = 0,    /* edges lead from p out of mesh_b: mean over where they cross the surface */
    VOX_PENETRATION_PROPAGATED = 1, /* all neighbours of p collide: mean over those closer to the surface */
    VOX_PENETRATION_ENCLOSED = 2,   /* no edge leads out from p or from a colliding vertex connected with it, or p has
                                       no edges, as in meshes without tetrahedra: closest */
    VOX_PENETRATION_CROSSING = 3,   /* the means are of no use: the normals nearly cancel (edges leave on opposite
                                       sides), the depth would not be positive, or an edge that leads out crosses
                                       no surface (inverted tetrahedra, non-manifold facets); or all that p is
                                       connected with is so: closest */
    VOX_PENETRATION_COINCIDENT = 4, /* p lies on the surface: depth 0, direction is the surface's normal at p */
    VOX_PENETRATION_STATE_FORCE_32_BITS = 0x7fffffff
} vox_penetration_state;

/* Vertex `vertex` of mesh_a lies inside mesh_b (a = b: self-contact), and mesh_b is the side it has to leave: moving
 * the vertex by depth * direction leads to the surface of mesh_b, exactly where the state says closest, and as well
 * as a mean over neighbours tells elsewhere. Always finite, and direction always a unit vector to rounding. A
 * mesh_b without any surface (each facet belongs to several tetrahedra) gives depth 0 and the normal of a facet of
 * the contact's tetrahedron. Does not depend on engine, cell size, workers or machine. */
typedef struct vox_penetration {
    vox_mesh mesh_a;
    uint32_t vertex;
    vox_mesh mesh_b;
    vox_penetration_state state;
    uint64_t contact;   /* index in vox_grid_contacts of the first contact of (mesh_a, vertex, mesh_b) */
    float depth;        /* >= 0, in the caller's unit */
    float direction[3]; /* in the frame of the positions, out of mesh_b */
} vox_penetration;

/* `count` penetrations, `byte_stride` apart: one for each (mesh_a, vertex, mesh_b) that has contacts, in that order.
 * A vertex inside two meshes has two. Lives and ends with the contacts' view. */
typedef struct vox_penetration_view {
    const vox_penetration* data;
    size_t byte_stride;
    uint64_t count;
    uint64_t epoch;
} vox_penetration_view;

/* The penetrations of the last step; count 0 when it found no contacts, before the first, after a failed one and
 * after a clear. Errors: INVALID_STATE when the grid was created without VOX_GRID_PENETRATIONS. */
VOX_API vox_result vox_grid_penetrations(const vox_grid* grid, vox_penetration_view* out_view);

/* ---- touching pairs and events ---------------------------------------------------------------- */

/* Two meshes that touch: a vertex of one of them lies in a tetrahedron of the other. mesh_a <= mesh_b; both are
 * the same where a mesh touches itself. The contacts of the pair are those that
 * vox_pair_view.contacts[first], ... names: first the a_in_b contacts of vertices of mesh_a in tets of mesh_b, then
 * the b_in_a of vertices of mesh_b in tets of mesh_a (0 for a mesh with itself), each in the order of
 * vox_grid_contacts. */
typedef struct vox_pair {
    vox_mesh mesh_a;
    vox_mesh mesh_b;
    uint64_t user_data_a; /* of mesh_a, as given at insertion */
    uint64_t user_data_b;
    uint64_t first;
    uint64_t a_in_b;
    uint64_t b_in_a;
} vox_pair;

#define VOX_MAX_CONTACTS 4294967295u /* of one step; more fail it with VOX_ERROR_LIMIT */

/* `count` pairs, `byte_stride` apart, sorted by (mesh_a, mesh_b). `contacts`: the index of every contact of
 * vox_grid_contacts() once, pair by pair. Both live until the next step, clear, reserve or destroy of the grid. */
typedef struct vox_pair_view {
    const vox_pair* data;
    size_t byte_stride;
    uint64_t count;
    uint64_t epoch;
    const uint32_t* contacts;
} vox_pair_view;

/* The pairs that touched in the last step; count 0 before the first, after a failed one and after a clear. */
VOX_API vox_result vox_grid_pairs(const vox_grid* grid, vox_pair_view* out_view);

/* Copies the first `capacity` of the last step's contacts that `mesh` has a part in, as mesh_a or as mesh_b: pair
 * by pair as in vox_grid_pairs, in the order given there. *out_count is how many there are, which may be more than
 * were copied. `contacts` may be null when capacity is 0. Also of a mesh that is disabled by now; not of one that
 * was removed. Errors: INVALID_ARGUMENT, INVALID_HANDLE. */
VOX_API vox_result vox_mesh_copy_contacts(const vox_grid* grid, vox_mesh mesh, vox_contact* contacts,
                                          uint64_t capacity, uint64_t* out_count);

/* The same of the contacts between two meshes, in either order, or of one mesh with itself (mesh_a = mesh_b): those of
 * their vox_pair. */
VOX_API vox_result vox_pair_copy_contacts(const vox_grid* grid, vox_mesh mesh_a, vox_mesh mesh_b,
                                          vox_contact* contacts, uint64_t capacity, uint64_t* out_count);

/* Of a touch_event: how the last successful step differs from the successful step before it. */
typedef enum vox_touch {
    VOX_TOUCH_BEGAN = 1,     /* touches, and did not */
    VOX_TOUCH_PERSISTED = 2, /* touches, and did */
    VOX_TOUCH_ENDED = 3,     /* does not touch any more, for whatever reason */
    VOX_TOUCH_FORCE_32_BITS = 0x7fffffff
} vox_touch;

/* What became of a pair of meshes, mesh_a <= mesh_b. Every pair that began persists in each following step until
 * it ends, once: also when a mesh was removed, disabled or filtered, or the grid cleared. Then `mesh_a` and
 * `mesh_b` may be ids that are stale by now: the user data are those of the meshes that they named. */
typedef struct vox_touch_event {
    vox_mesh mesh_a;
    vox_mesh mesh_b;
    uint64_t user_data_a;
    uint64_t user_data_b;
    vox_touch kind;
    uint32_t pair; /* its index in vox_grid_pairs; VOX_NO_PAIR when it ended */
} vox_touch_event;

#define VOX_NO_PAIR 0xffffffffu /* vox_touch_event.pair: none */

/* All that began, then all that persisted, then all that ended: `count` together, `byte_stride` apart, each part
 * sorted by (mesh_a, mesh_b). `data` lives until the next step or destroy of the grid. */
typedef struct vox_touch_view {
    const vox_touch_event* data;
    size_t byte_stride;
    uint64_t count;
    uint64_t epoch;
    uint64_t began;
    uint64_t persisted;
    uint64_t ended;
} vox_touch_view;

/* What the last step changed; count 0 before the first one. A step that fails gives no events and loses none: the
 * next one is compared with the last that succeeded. Removing meshes and clearing the grid give no events at once;
 * the next step ends the pairs. Destroying the grid ends them without events. */
VOX_API vox_result vox_grid_touch_events(const vox_grid* grid, vox_touch_view* out_view);

/* Vertex `vertex` of mesh_a came into tetrahedra of mesh_b, or is in none of them any more. Moving on from one
 * tetrahedron of mesh_b to another is no event. */
typedef struct vox_contact_event {
    vox_mesh mesh_a;
    uint32_t vertex;
    vox_mesh mesh_b;
    vox_touch kind; /* VOX_TOUCH_BEGAN or VOX_TOUCH_ENDED */
} vox_contact_event;

/* All that began, then all that ended, each part sorted by (mesh_a, vertex, mesh_b); lives as vox_touch_view. */
typedef struct vox_contact_event_view {
    const vox_contact_event* data;
    size_t byte_stride;
    uint64_t count;
    uint64_t epoch;
    uint64_t began;
    uint64_t ended;
} vox_contact_event_view;

/* The same for single vertices, under the same rules, on grids with VOX_GRID_CONTACT_EVENTS.
 * Errors: INVALID_STATE on other grids. */
VOX_API vox_result vox_grid_contact_events(const vox_grid* grid, vox_contact_event_view* out_view);

/* ---- readings --------------------------------------------------------------------------------- */

/* What a program that answers contacts, draws or reports them wants of each: where the vertex is, the surface next to
 * it, how deep it is. A grid that is never asked pays nothing: vox_grid_prepare_readings computes them, once a step and
 * only where they are wanted. It is a change of the grid; what follows it are reads. */

/* Which parts of a vox_reading there are; what belongs to others is all zero. */
typedef enum vox_reading_flags {
    VOX_READING_POSITION = 1, /* not of a vertex that is gone by now, with its mesh or from it */
    VOX_READING_SURFACE = 2,  /* nor then, nor when mesh_b is gone or has no surface, or all of its tetrahedra that held
                                 the vertex are gone or off */
    VOX_READING_DEPTH = 4,    /* not of grids without VOX_GRID_PENETRATIONS */
    VOX_READING_FLAGS_FORCE_32_BITS = 0x7fffffff
} vox_reading_flags;

/* One contact, read. All contacts of the same (mesh_a, vertex, mesh_b) read the same but for the first field.
 * The surface of mesh_b, the facets of exactly one of its tetrahedra, doubled ones taken once, is looked at from the
 * vertex: `triangle` is the one that comes closest, computed in double as by vox_grid_query_closest; of those equally
 * far the one with the lowest corners, compared in ascending order. For self-contact it is one of the fold that the
 * vertex has entered, never one that has the vertex as a corner: see vox_penetration_state.
 * No reading depends on engine, cell size, workers or machine. */
typedef struct vox_reading {
    uint64_t contact;            /* its index in vox_grid_contacts */
    uint32_t known;              /* vox_reading_flags, combined with | */
    vox_penetration_state state; /* DEPTH: state, depth and direction of the vertex's vox_penetration */
    float depth;
    float direction[3];
    double position[3];         /* POSITION: of the vertex, as it collides: its doubles, its transform */
    double distance;            /* SURFACE: from the vertex to surface_position, and what follows but user data */
    double surface_position[3]; /* the closest point of `triangle` */
    double barycentric[3];      /* its weights for the triangle's corners: in [0, 1] to rounding, the sum 1 */
    /* Unit, out of the triangle's tetrahedron, or where this is flat to the side on which the vertex is not. Where the
     * triangle has no area: from the vertex to the closest point, or 0, 0, 1 when it is there. */
    double normal[3];
    uint32_t triangle[3];       /* vertices of mesh_b, the lowest first, counter-clockwise seen from where the normal
                                   points */
    uint32_t reserved;
    uint64_t user_data_a;       /* of mesh_a, as given at insertion */
    uint64_t user_data_b;
} vox_reading;

/* `count` readings, `byte_stride` apart, one for each contact in their order; a field of them, say position, is an
 * array of its own with that stride. `data` lives until the next step, clear, vox_grid_prepare_readings or destroy of
 * the grid. */
typedef struct vox_reading_view {
    const vox_reading* data;
    size_t byte_stride;
    uint64_t count;
    uint64_t epoch;
} vox_reading_view;

/* Reads the contacts of the last step, of the meshes as they are now: positions that the caller has borrowed out must
 * still be those of the step. What was removed or changed in between is told by vox_reading.known. May be called
 * again; takes time in proportion to the contacts, and to the vertices and surfaces of the meshes that they name.
 * Memory for as many contacts and triangles is kept until the grid is destroyed: a call that needs no more than one
 * before allocates nothing. Enqueues at most one task.
 * Errors: NON_FINITE and LIMIT (positions that changed since the step; a mesh of more tetrahedra than
 * VOX_GRID_PENETRATIONS allows), BUDGET, OUT_OF_MEMORY; the readings that there were stay then. INVALID_ARGUMENT: see
 * vox_task_system; there are none then. */
VOX_API vox_result vox_grid_prepare_readings(vox_grid* grid);

/* The readings that were prepared. Errors: INVALID_STATE when none were since the last step or clear. */
VOX_API vox_result vox_grid_readings(const vox_grid* grid, vox_reading_view* out_view);

/* As vox_mesh_copy_contacts, of readings: the same ones in the same order. Errors: INVALID_ARGUMENT, INVALID_HANDLE,
 * INVALID_STATE as vox_grid_readings. */
VOX_API vox_result vox_mesh_copy_readings(const vox_grid* grid, vox_mesh mesh, vox_reading* readings, uint64_t capacity,
                                          uint64_t* out_count);

/* As vox_pair_copy_contacts, of readings. Errors: INVALID_ARGUMENT, INVALID_HANDLE, INVALID_STATE as
 * vox_grid_readings. */
VOX_API vox_result vox_pair_copy_readings(const vox_grid* grid, vox_mesh mesh_a, vox_mesh mesh_b, vox_reading* readings,
                                          uint64_t capacity, uint64_t* out_count);

/* ---- snapshots -------------------------------------------------------------------------------- */

/* Writes the grid as it is now to `bytes`, in a format that is the same on every machine (docs/snapshot.md): settings,
 * meshes under their ids, their positions, and what events are counted from. Positions are read during the call,
 * borrowed ones too. Not in it: allocator, log, task system, worker count, byte budget, and the results of the last
 * step. *out_size is the number of bytes; `bytes` null asks for it and writes nothing. Allocates nothing.
 * Errors: INVALID_ARGUMENT when the capacity is too small (gives both numbers). */
VOX_API vox_result vox_grid_save(const vox_grid* grid, void* bytes, uint64_t capacity, uint64_t* out_size);

/* Creates the grid that a snapshot holds. Ids name the same meshes, the next ids given out are the same, and its
 * steps find the same contacts and events in the same order, with the same hash and epoch. There are no contacts
 * until its first step. The meshes own their positions: bind others where they are to move.
 * Of `desc`, the allocator, log, tasks, worker_count and byte_budget count, and the engine unless it is AUTO; null:
 * the defaults. The caller owns *out_grid and ends it with vox_grid_destroy.
 * The bytes need not be trusted: everything in them is checked, no count is believed before its bytes are there, and
 * the byte budget holds for what is made of them.
 * Errors: FORMAT (names chunk and byte), UNSUPPORTED (of a later version), INVALID_ARGUMENT, LIMIT, BUDGET,
 * OUT_OF_MEMORY. */
VOX_API vox_result vox_grid_load(const void* bytes, uint64_t size, const vox_grid_desc* desc, vox_grid** out_grid);

/* ---- queries ---------------------------------------------------------------------------------- */

/* Queries are about the meshes as they were when vox_grid_prepare_queries was called last: after the step, say.
 * Later moves, removals and other changes do not show until the next call, so an answer may name a mesh that was
 * removed since; vox_grid_clear ends what was prepared. Disabled meshes and meshes without tetrahedra take no part.
 * Preparing is a change of the grid; the queries are reads: any number of threads at once. They take what memory they
 * need for the time of the call from the C++ runtime's heap. Answers do not depend on engine, cell size, workers or
 * machine.
 * `mask`: a mesh takes part when its filter's category, as it was at that time, has a bit in common; UINT64_MAX: all.
 * `capacity`: that many hits are written, the first ones in the order given; *out_count is how many there are.
 * Errors of all: INVALID_STATE (not prepared), INVALID_ARGUMENT, NON_FINITE (a coordinate asked for that is not
 * finite, boxes and radii excepted), LIMIT (one of 2^128 or more), OUT_OF_MEMORY. */

/* Copies the positions as they are now. Time and memory in proportion to vertices and tetrahedra: about 24 bytes a
 * vertex and 60 a tetrahedron, kept until the grid is destroyed; the reference engine's grids also hold tiles from
 * now on, as the fast engine's do. Errors: INVALID_STATE (a mesh has no positions), NON_FINITE, LIMIT, BUDGET,
 * OUT_OF_MEMORY; what was prepared before stays then. */
VOX_API vox_result vox_grid_prepare_queries(vox_grid* grid);

/* Point `point` of the query lies in the closed tetrahedron `tet` of `mesh`: exactly, and under the rule of
 * vox_contact: every tetrahedron of a mesh that has it in its interior, or else the lowest whose boundary has it.
 * `barycentric` as there. */
typedef struct vox_point_hit {
    uint32_t point;
    vox_mesh mesh;
    uint32_t tet;
    float barycentric[4];
} vox_point_hit;

/* The tetrahedra that hold a point, sorted by (mesh, tet); vox_point_hit.point is 0. `hits` may be null when capacity
 * is 0. */
VOX_API vox_result vox_grid_query_point(const vox_grid* grid, const double point[3], uint64_t mask,
                                        vox_point_hit* hits, uint64_t capacity, uint64_t* out_count);

/* The same for up to 2^32 - 1 points at once, `byte_stride` apart (0: tightly packed), sorted by (point, mesh, tet):
 * faster than one by one. */
VOX_API vox_result vox_grid_query_points(const vox_grid* grid, const void* points, vox_format format,
                                         uint64_t byte_stride, uint64_t point_count, uint64_t mask,
                                         vox_point_hit* hits, uint64_t capacity, uint64_t* out_count);

/* Tetrahedron `tet` of `mesh`. */
typedef struct vox_tet_hit {
    vox_mesh mesh;
    uint32_t tet;
} vox_tet_hit;

/* The tetrahedra whose bounding box has a point in common with the closed box from min to max, exactly; sorted by
 * (mesh, tet). That is a superset of the tetrahedra which themselves meet it; those of zero volume count too.
 * Infinite corners are allowed. Errors: INVALID_ARGUMENT unless min <= max on each axis. */
VOX_API vox_result vox_grid_query_box(const vox_grid* grid, const double min[3], const double max[3], uint64_t mask,
                                      vox_tet_hit* hits, uint64_t capacity, uint64_t* out_count);

/* A point of facet `facet` of a tetrahedron, the one opposite its corner `facet`; the facet's corners are
 *     facet 0: corners 1, 2, 3    1: 0, 3, 2    2: 0, 1, 3    3: 0, 2, 1
 * of the tetrahedron, counter-clockwise from outside where its volume is positive. The surface of a mesh are the
 * facets of exactly one tetrahedron. */
typedef struct vox_surface_hit {
    vox_mesh mesh; /* VOX_NULL_MESH: there is none, and all is zero */
    uint32_t tet;
    uint32_t facet;
    uint32_t reserved;
    double barycentric[3]; /* weights of the facet's corners in that order: in [0, 1] to rounding, the sum 1 */
    double position[3];
    double distance;
} vox_surface_hit;

/* The point closest to `point` of the surfaces of all meshes, if it is no further away than radius (which may be
 * infinite). Computed in double; of points equally far the lowest (mesh, tet, facet). */
VOX_API vox_result vox_grid_query_closest(const vox_grid* grid, const double point[3], double radius, uint64_t mask,
                                          vox_surface_hit* out_hit);

typedef enum vox_side {
    VOX_SIDE_NONE = 0,   /* the tetrahedron has no volume */
    VOX_SIDE_ENTERS = 1, /* into the tetrahedron */
    VOX_SIDE_LEAVES = 2,
    VOX_SIDE_FORCE_32_BITS = 0x7fffffff
} vox_side;

/* What the closed segment from `from` to `to` meets first; t is 0 at `from` and 1 at `to`. Whether it meets a
 * tetrahedron or a facet is decided exactly; t, and with it which of two is first, to rounding. Of those at the same t
 * the lowest (mesh, tet, facet). */
typedef struct vox_ray_hit {
    vox_mesh mesh; /* the first tetrahedron; VOX_NULL_MESH: it meets none, and all is zero */
    uint32_t tet;
    double t; /* 0 when `from` lies in it */
    /* The first facet of a surface (see vox_surface_hit); VOX_NULL_MESH: none, as for a segment that ends before it
     * leaves a mesh. A facet is not met by a segment that lies in its plane. */
    vox_mesh surface_mesh;
    uint32_t surface_tet;
    uint32_t surface_facet;
    vox_side surface_side;
    double surface_t;
    double surface_barycentric[3];
} vox_ray_hit;

/* Finds both in one call. from = to asks for a point. */
VOX_API vox_result vox_grid_query_ray(const vox_grid* grid, const double from[3], const double to[3], uint64_t mask,
                                      vox_ray_hit* out_hit);

/* ---- measurements ----------------------------------------------------------------------------- */

/* What the last successful step did. From `cells` to `skipped_degenerate`, what was taken over from the step before
 * counts nothing. `tets`: those that are on. `skipped_degenerate`: tetrahedra of exactly zero volume that were met: all
 * of them with the reference engine, those with a vertex of theirs to test with the fast one. */
typedef struct vox_counters {
    uint32_t struct_size;
    uint32_t meshes;
    uint64_t vertices;
    uint64_t tets;
    uint64_t cells;              /* occupied cells; where there are several cell sizes, of all of them together */
    uint64_t entries;            /* vertices in them */
    uint64_t fullest_cell;       /* most vertices in one cell */
    uint64_t visited_cells;      /* objective voxels looked into */
    uint64_t visited_entries;    /* vertices met there */
    uint64_t candidates;         /* (vertex, tet) pairs that passed the box test: the narrow phase's input */
    uint64_t exact_tests;        /* orientations that needed exact arithmetic */
    uint64_t contacts;
    uint64_t skipped_degenerate;
    uint64_t bytes;              /* held by the grid now, the caller's arrays not counted */
    uint64_t peak_bytes;         /* most it ever held */
    uint64_t moved_meshes;       /* meshes that were not found at rest: see vox_grid_step */
    uint64_t carried_contacts;   /* of `contacts`: taken over from the step before, between meshes at rest */
    uint64_t penetrations;
    uint64_t leaving_edges;      /* edges from a colliding vertex to one outside mesh_b */
    uint64_t edge_tests;         /* tetrahedra that these were followed through */
    uint64_t closest_searches;   /* penetrations that took the closest point of the surface */
    uint64_t closest_tests;      /* triangles whose closest point that took */
    uint64_t disabled_meshes;    /* beside `meshes`: see vox_mesh_set_enabled */
    uint64_t filtered;           /* (vertex, tet) pairs of one mesh that self_rings or self_rest_distance ruled out */
    uint64_t cell_size_changes;  /* times that the reference engine's cell size was chosen anew: see vox_grid_desc */
} vox_counters;

/* Writes the fields that out_counters->struct_size covers (set it first). */
VOX_API vox_result vox_grid_counters(const vox_grid* grid, vox_counters* out_counters);

/* Nanoseconds of the last successful step, whole and by stage. Fields from stream_ns on are the stages of the fast
 * engine, and bin_ns, broad_ns and narrow_ns are sums of them. The reference engine has just those three stages, and
 * leaves the fields from stream_ns on 0. */
typedef struct vox_profile {
    uint32_t struct_size;
    uint32_t reserved;
    uint64_t step_ns;
    uint64_t bin_ns;         /* classify the vertices, recompute the boxes: stream + winding + windows */
    uint64_t broad_ns;       /* cells and box tests: broad_phase + query */
    uint64_t narrow_ns;      /* exact decisions: decide */
    uint64_t contacts_ns;    /* canonical order, barycentric coordinates */
    uint64_t depth_ns;       /* penetrations */
    uint64_t events_ns;      /* touching pairs and events */
    uint64_t stream_ns;      /* read all positions: boxes, and which meshes moved */
    uint64_t winding_ns;     /* rule out self-contacts by winding numbers; of the worker that took longest over them */
    uint64_t broad_phase_ns; /* regions in which meshes may be in contact */
    uint64_t windows_ns;     /* bin the vertices that lie there */
    uint64_t query_ns;       /* tetrahedra against these: box tests, and all that floats can decide */
    uint64_t decide_ns;      /* decide the rest exactly; of the worker that took longest over it */
} vox_profile;

/* Writes the fields that out_profile->struct_size covers (set it first). */
VOX_API vox_result vox_grid_profile(const vox_grid* grid, vox_profile* out_profile);

/* ---- cell size -------------------------------------------------------------------------------- */

typedef enum vox_cost_model {
    VOX_COST_MODEL_PAPER = 0,     /* the paper's z(delta), Sect. 4, Eqs. 3-8: from means, in cell visits */
    VOX_COST_MODEL_REFERENCE = 1, /* the reference engine, counted tet by tet: nanoseconds of a step */
    VOX_COST_MODEL_FAST = 2,      /* the fast engine with this cell size in all windows: nanoseconds of a step */
    VOX_COST_MODEL_FORCE_32_BITS = 0x7fffffff
} vox_cost_model;

/* Reading of s, the size of a tetrahedron in Eq. 4. */
typedef enum vox_size_reading {
    VOX_SIZE_MEAN_EDGE = 0,         /* mean length of the unique edges: reproduces the paper's tables */
    VOX_SIZE_MEAN_LONGEST_EDGE = 1, /* mean over tets of the longest edge: the words of Sect. 4.2 */
    VOX_SIZE_MEAN_BOX_SIDE = 2,     /* mean over tets of the longest side of the bounding box */
    VOX_SIZE_READING_FORCE_32_BITS = 0x7fffffff
} vox_size_reading;

/* Reading of A, the facet area of Eqs. 5-7. */
typedef enum vox_area_reading {
    VOX_AREA_UNIQUE_FACETS = 0,   /* mean over all facets, shared ones once: reproduces the tables */
    VOX_AREA_TET_FACETS = 1,      /* mean over the four facets of every tet */
    VOX_AREA_BOUNDARY_FACETS = 2, /* mean over the facets of exactly one tet */
    VOX_AREA_READING_FORCE_32_BITS = 0x7fffffff
} vox_area_reading;

typedef struct vox_suggest_desc {
    uint32_t struct_size;
    vox_cost_model model;
    vox_size_reading size_reading;
    vox_area_reading area_reading;
    double p_nc;               /* probability that a tet has no collision, in (0, 1); default 0.99 */
    double cost_ratio;         /* r: cost of one particle test over one cell visit, > 0; default 5 */
    double world_edge;         /* edge of the cubic world, for cells_per_axis; 0: longest side of the bounds */
    double zone_loss;          /* the zone is where predicted cost <= (1 + zone_loss) * minimum; in [0, 1e6],
                                  default 0.05 */
    double mean_edge_factor;   /* for rules.mean_edge_multiple (Gregory et al. 2000), > 0; default 2 */
    double resolution;         /* for rules.resolution (McNeely et al. 1999): the wanted detail; 0: none */
    uint64_t byte_budget;      /* REFERENCE with dense storage: most bytes of its cells; 0 (the default): no limit */
    vox_storage storage;       /* REFERENCE: as in vox_grid_desc; AUTO and HASHED are the same here */
    uint32_t reserved;         /* 0 */
} vox_suggest_desc;

/* Fills `desc` with the defaults for the fields that `struct_size` covers. */
VOX_API vox_result vox_suggest_desc_init(vox_suggest_desc* desc, uint32_t struct_size);

static inline vox_suggest_desc vox_default_suggest_desc(void) {
    vox_suggest_desc desc;
    (void)vox_suggest_desc_init(&desc, (uint32_t)sizeof desc);
    return desc;
}

/* What the meshes look like, all together. Lengths, areas and volumes in the caller's unit. A tet that names a
 * vertex twice has no edges and facets of its own, but counts in the means over tets. */
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
    double median_box_side; /* over tets, of the longest side of the bounding box */
    double mean_facet_area;
    double mean_tet_facet_area;
    double mean_boundary_facet_area;
    double mean_volume; /* of |volume| */
    double bounds_min[3]; /* of the vertices that tets use; of all vertices for a mesh without tets */
    double bounds_max[3];
} vox_geometry_stats;

/* Cell sizes that other rules would choose; 0 where a rule does not apply. */
typedef struct vox_cell_size_rules {
    double mean_edge;          /* Teschner et al. 2003 */
    double mean_edge_multiple; /* Gregory et al. 2000: a constant times the mean edge */
    double object_512;         /* Garcia-Alonso et al. 1994: 512 voxels in an object's box, mean over meshes
                                  whose box has a volume */
    double resolution;         /* McNeely et al. 1999: the wanted resolution */
    double mean_volume;        /* cube root of the mean tet volume (tried and rejected in Sect. 5) */
    double median_box_side;    /* IPC Toolkit: median of the longest box sides */
} vox_cell_size_rules;

/* A point of a curve of costs. */
typedef struct vox_cost_sample {
    double cell_size;
    double cost;
} vox_cost_sample;

#define VOX_COST_CURVE_CAPACITY 64u     /* samples of a curve */
#define VOX_COST_TERM_CAPACITY 12u      /* terms of a cost; no model has more */
#define VOX_CELL_SIZE_LEVEL_CAPACITY 4u /* grids side by side, of vox_suggestion.uniform_loss */

/* One term of a cost: a piece of work, how often it is done, and what that costs. */
typedef struct vox_cost_share {
    char name[24]; /* what is done, e.g. "visit a cell"; ends in a zero */
    double count;
    double cost;  /* count times the weight */
    double share; /* of the whole cost, 0 to 1 */
} vox_cost_share;

/* A cell size and why. Costs are in visits of one cell per tetrahedron (PAPER), or nanoseconds of a step. */
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
    vox_cell_size_rules rule_costs; /* predicted cost at the cell size of each rule; 0 where there is none */
    double budget_cell_size; /* cells must not be smaller, for the byte budget; 0: it does not matter */
    /* REFERENCE: what one cell size for tetrahedra of all sizes loses: predicted cost over that of a few grids
     * side by side, each with the cell size that is best for its share of the tetrahedra, less 1. About 0 where
     * one size is as good as several, and for the other models. A grid with cell_size 0 uses them where there are
     * several. */
    double uniform_loss;
    double levels[VOX_CELL_SIZE_LEVEL_CAPACITY]; /* those sizes, for the smallest tets first; level_count of them */
    uint32_t level_count;
    uint32_t reserved;
} vox_suggestion;

/* The cell size that minimises the cost model for these meshes (their positions as they are now).
 * desc null: defaults. Set out->struct_size first; the fields it covers are written.
 * `meshes` is an array whose elements are meshes[0].struct_size bytes apart, a multiple of 8: all of them have that
 * struct_size. Of flags VOX_MESH_SELF_COLLISION matters, to REFERENCE and FAST. Errors name a mesh by its index in
 * the array. Time and memory (the C++ runtime's heap, for the time of the call) are in proportion to vertices and
 * tets.
 * Errors: INVALID_ARGUMENT (also: no tetrahedron at all, or all of zero size), INVALID_MESH, NON_FINITE, LIMIT,
 * OUT_OF_MEMORY. */
VOX_API vox_result vox_suggest_cell_size(const vox_suggest_desc* desc, const vox_mesh_desc* meshes,
                                         uint64_t mesh_count, vox_suggestion* out);

/* The same for the meshes of a grid. desc null: the model of its engine, with its storage and byte budget; the paper's
 * model takes p_nc from the last step where it had contacts and desc is null or has the default. FAST knows from it
 * which meshes rest and which need no cells for self-collision: those cost nothing. Quicker: from samples, means good
 * to a few per cent. The first call after a mesh came or was cut looks at all of it, and keeps up to 10 KB of the C++
 * runtime's heap (docs/cell-size.md has what each costs). Positions must be bound. Errors: as vox_suggest_cell_size;
 * INVALID_STATE for a mesh without positions. */
VOX_API vox_result vox_grid_suggest_cell_size(const vox_grid* grid, const vox_suggest_desc* desc,
                                              vox_suggestion* out);

/* A cost at one cell size, term by term. */
typedef struct vox_cost_prediction {
    uint32_t struct_size;
    uint32_t term_count;
    double cell_size;
    double cost;
    vox_cost_share terms[VOX_COST_TERM_CAPACITY];
} vox_cost_prediction;

/* What desc->model (desc null: PAPER) predicts for these meshes at one cell size. Arguments and errors as
 * vox_suggest_cell_size; also INVALID_ARGUMENT for a cell size that is not finite and above 0. */
VOX_API vox_result vox_cost_predict(const vox_suggest_desc* desc, const vox_mesh_desc* meshes, uint64_t mesh_count,
                                    double cell_size, vox_cost_prediction* out);

/* What one unit of each piece of work costs on a machine, in nanoseconds: the weights of REFERENCE and FAST. Plain
 * numbers, to be saved and loaded. All are above 0. */
typedef struct vox_cost_weights {
    uint32_t struct_size;
    uint32_t measured; /* 1: on the machine they are for; 0: shipped with the library */
    double reference_classify_vertex;
    double reference_prepare_tet; /* its box */
    double reference_visit_cell; /* whose list is as long as the one before */
    double reference_scan_cell; /* an occupied one, gone through instead of a box that meets more cells */
    double reference_read_vertex;
    double reference_test_box;
    double reference_test_tet; /* or its own corner, which is in the box as well */
    double reference_clear_bucket;
    double fast_bin_vertex;
    double fast_clear_cell;
    double fast_visit_tile; /* for one window */
    double fast_visit_row;
    double fast_read_vertex;
    double fast_test_vertex; /* one in a tile's box, against its tets */
    double reference_changed_list; /* in a visited cell, of another length than the one before */
    double reference_fetch_vertex; /* passed over, and not read just before */
} vox_cost_weights;

/* Measures the weights by steps of both engines over a small scene of its own: ten milliseconds or so at the first
 * call, from a cache of the process after that. They are then in use, by all suggestions and grids of the process.
 * out null: only that; else set out->struct_size first. Any thread. Errors: OUT_OF_MEMORY. */
VOX_API vox_result vox_cost_calibrate(vox_cost_weights* out);

/* The weights in use: those calibrated or set last, else those shipped. Any thread. */
VOX_API vox_result vox_cost_get_weights(vox_cost_weights* out);
/* Uses weights that were saved; fields that struct_size does not cover are those shipped, of the last two in proportion
 * to reference_visit_cell and reference_read_vertex. Null: those shipped. Any thread. Errors: INVALID_ARGUMENT (names the field that is not a finite number above 0). */
VOX_API vox_result vox_cost_set_weights(const vox_cost_weights* weights);

/* ---- the method for any algorithm ------------------------------------------------------------- */

/* Cost at a cell size. What is not a finite number counts as infinitely dear. Called on the thread that asks. */
typedef double vox_cost_function(double cell_size, void* user);

/* coefficient * cell_size ^ power. A cost is a sum of these: (s / delta + 1)^3 is four of them. */
typedef struct vox_cost_term {
    double coefficient;
    double power;
} vox_cost_term;

/* Cell sizes to choose from, and how wide the zone is. */
typedef struct vox_cost_bounds {
    uint32_t struct_size;
    uint32_t reserved;  /* 0 */
    double min;         /* 0 < min <= max, finite */
    double max;
    double zone_loss;   /* as vox_suggest_desc.zone_loss; default 0.05 */
} vox_cost_bounds;

/* Fills `bounds` with the defaults for the fields that `struct_size` covers; min and max are 0 and must be set. */
VOX_API vox_result vox_cost_bounds_init(vox_cost_bounds* bounds, uint32_t struct_size);

static inline vox_cost_bounds vox_default_cost_bounds(void) {
    vox_cost_bounds bounds;
    (void)vox_cost_bounds_init(&bounds, (uint32_t)sizeof bounds);
    return bounds;
}

typedef struct vox_cost_minimum {
    uint32_t struct_size;
    uint32_t curve_count;
    double cell_size;
    double cost;
    double zone_min; /* around cell_size, where the cost is at most (1 + zone_loss) times the least; in the bounds */
    double zone_max;
    vox_cost_sample curve[VOX_COST_CURVE_CAPACITY]; /* over the bounds, evenly spaced in the logarithm */
} vox_cost_minimum;

/* The cell size of least cost within the bounds, for a cost function of one's own: a scan that is even in the
 * logarithm of the cell size, then a golden-section search around its best place. `cost` is called on this thread,
 * some hundred times, and must not throw. Errors: INVALID_ARGUMENT (also: no finite cost anywhere it was looked
 * at, or a least cost that is negative). */
VOX_API vox_result vox_cost_minimise(vox_cost_function* cost, void* user, const vox_cost_bounds* bounds,
                                     vox_cost_minimum* out);

/* The same for the sum of `term_count` terms. */
VOX_API vox_result vox_cost_minimise_terms(const vox_cost_term* terms, uint64_t term_count,
                                           const vox_cost_bounds* bounds, vox_cost_minimum* out);

/* Eq. 9: how far cells-per-axis `n` lies from the optimum, in units of the optimal zone
 * [n_min, n_max]; 0 at n = n_opt, below 1 inside the zone. All in cells per axis, > 0, n_min <= n_opt <= n_max.
 * Where the zone has no width on the side n lies on, *out_epsilon is infinity (0 at n = n_opt).
 * Errors: INVALID_ARGUMENT (numbers that do not fit what is said here). */
VOX_API vox_result vox_zone_distance(double n, double n_min, double n_opt, double n_max,
                                     double* out_epsilon);

#ifdef __cplusplus
}
#endif

#endif
