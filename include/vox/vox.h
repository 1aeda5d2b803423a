/* vox: exact collision detection for deformable tetrahedral meshes on a voxel grid. Vertices collide with tetrahedra;
 * the edges and faces of triangle meshes and point sets, which have no tetrahedra, collide with nothing.
 *
 * This header is the whole interface of the core library: plain C99 with fixed-width types. No struct is
 * passed by value. The version is written here and nowhere else.
 *
 * Conventions that hold for every function unless its comment says otherwise
 *   Errors    A function that can fail returns vox_result. On failure the out-parameters are left
 *             untouched, nothing has changed, and vox_last_error() gives the reason with numbers in it. It names a
 *             mesh by its id, its slot, which counts from 0, and its user data.
 *             No function prints, exits, throws or asserts on user input, in any build.
 *             Every function may return INVALID_ARGUMENT for a null pointer that its comment does not allow,
 *             and INVALID_HANDLE for an id that names no mesh of the grid.
 *   Structs   Structs whose first field is struct_size may grow. Begin with vox_default_X(): it sets struct_size and
 *             the defaults, which are 0 unless its body says otherwise. If a function writes the struct, set
 *             struct_size before the call. The library reads and writes only the fields that struct_size covers, so
 *             old programs run with new libraries and the reverse. A struct_size below 4 or above 65536 is an
 *             INVALID_ARGUMENT.
 *   Ownership The library copies what it is given, except positions bound as borrowed. Pointers it
 *             hands out belong to it and live as long as their comment says.
 *   Threads   One thread at a time may change a grid. Between changes any number of threads may read
 *             it: a function that takes a const grid reads it, any other changes it. Different grids are
 *             independent. Functions without a grid run on any thread, at any time. vox_last_error() is
 *             per thread.
 *   Floats    Whatever floating-point environment the calling thread has (rounding, denormals flushed to zero, as
 *             -ffast-math does, traps), the library computes in the default one, gives the same bits, and leaves the
 *             thread's own as it was, flags included. Callbacks run in that of the thread that made the call; those of
 *             a grid inside a vox_sim, an experiment or vox_grids_step, in the default one.
 *   Units     Lengths are in the caller's own unit; nothing in the library has a length built in.
 */
#ifndef VOX_VOX_H
#define VOX_VOX_H

#include <stddef.h>
#include <stdint.h>

#define VOX_VERSION_MAJOR 0
#define VOX_VERSION_MINOR 1
#define VOX_VERSION_PATCH 0

/* Version of the stable interface. A program runs with every library that has the ABI version it was built with. It is
 * part of the shared libraries' names (docs/abi.md). */
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

#define VOX_OPTIONAL /* may be null; without this mark a pointer may not, unless its array is empty */

#ifdef __cplusplus
#define VOX_ZERO {} /* initialises a struct with zeros */
extern "C" {
#else
#define VOX_ZERO {0}
#endif

#define VOX_ALL_CORES 0xffffffffu /* as a worker_count: one worker per core */
#define VOX_NONE 0xffffffffu      /* as an index: none */

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
    VOX_ERROR_UNSUPPORTED = -9,      /* recognised, but not supported by this build or version; or the processor is
                                        an x86-64 without SSE4.2: nothing is created there, and no cell size found */
    VOX_ERROR_FILE = -10,            /* a file cannot be opened, read or written */
    VOX_ERROR_FORMAT = -11,          /* a file is malformed */
    VOX_ERROR_INTERNAL = -12         /* a defect of the library: please report it */
} vox_result;

/* Compiles only where enums have 32 bits (not with -fshort-enums). */
typedef char vox_enums_have_32_bits[sizeof(vox_result) == 4 ? 1 : -1];

/* Name of a result code, e.g. "VOX_ERROR_BUDGET". Static text; never null. Any thread. */
VOX_API const char* vox_result_string(vox_result result);

/* The text of this thread's last failure, e.g. "tet 17 names vertex 900 of 812", or "" if nothing has failed yet.
 * It lives until the thread's next failing call. Successful calls leave it alone. Never null. */
VOX_API const char* vox_last_error(void);

/* Sets this thread's vox_last_error() text and returns `result`, so that libraries built on vox (vox_io among them) can
 * report failures the same way. The text is copied, its first 1023 bytes at most, and of UTF-8 no part of a character.
 * A null text counts as "". Cannot fail itself. */
VOX_API vox_result vox_fail(vox_result result, VOX_OPTIONAL const char* text);

/* ---- version ---------------------------------------------------------------------------------- */

/* Version of the library that is running: major * 1000000 + minor * 1000 + patch. Cannot fail. */
VOX_API uint32_t vox_version(void);

/* VOX_ABI_VERSION of the library that is running. A program that loads the library by its name at run time compares it
 * with that of the header it was written for. Cannot fail. */
VOX_API uint32_t vox_abi_version(void);

/* "vox", the version, compiler, language level, instruction sets, built-in scheduler and options of this build, in one
 * line. Static text. Cannot fail. */
VOX_API const char* vox_build_info(void);

/* ---- positions -------------------------------------------------------------------------------- */

typedef enum vox_format {
    VOX_FORMAT_FLOAT = 0,  /* IEEE 754 singles */
    VOX_FORMAT_DOUBLE = 1  /* IEEE 754 doubles, of magnitudes below 2^128 - 2^103 (3.4028236e38), the largest float */
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
    vox_positions positions = VOX_ZERO;
    positions.data = xyz;
    positions.count = count;
    return positions;
}

/* An array of packed doubles x y z. */
static inline vox_positions vox_double_positions(const double* xyz, uint64_t count) {
    vox_positions positions = VOX_ZERO;
    positions.data = xyz;
    positions.count = count;
    positions.format = VOX_FORMAT_DOUBLE;
    return positions;
}

/* ---- grid ------------------------------------------------------------------------------------- */

/* Limits. Exceeding one gives VOX_ERROR_LIMIT. docs/limits.md lists these and all others. */
#define VOX_MAX_BODIES 1048576u           /* per grid, at one time, including retired slots */
#define VOX_MAX_GENERATIONS 4095u         /* uses of one mesh slot before it is retired */
#define VOX_MAX_VERTICES 2147483647u      /* per grid */
#define VOX_MAX_TETS 2147483647u          /* per grid */
#define VOX_MAX_WORKERS 256u              /* workers of a grid */

typedef enum vox_grid_flags {
    VOX_GRID_PENETRATIONS = 1, /* run the depth stage in a step (vox_grid_penetrations); on by default. A mesh of more
                                  than 357913941 tets then gives VOX_ERROR_LIMIT, unless its filter does without */
    VOX_GRID_CONTACT_EVENTS = 2, /* also report events of single vertices (vox_grid_contact_events) */
    VOX_GRID_SKIP_BAD_BODIES = 4, /* a mesh with a coordinate that VOX_FORMAT_DOUBLE does not allow (NaN, infinite, too
                                     large) takes no part in a step, in vox_grid_suggest_cell_size and in locators
                                     (vox_query.h), as if it were disabled; without this flag they fail.
                                     Counted (vox_grid_info.skipped_bodies), listed (vox_grid_get_failure), and logged
                                     once until the mesh is well again */
    VOX_GRID_EDGE_CONTACTS = 8    /* also find edges of surfaces through faces of others (vox_grid_edge_contacts);
                                   experimental. A mesh of more than 357913941 tets then gives VOX_ERROR_LIMIT */
} vox_grid_flags;

/* An open grid: a set of meshes and the settings they collide under. */
typedef struct vox_grid vox_grid;

/* Settings of a grid. What the pointers name is copied. */
typedef struct vox_grid_desc {
    uint32_t struct_size;
    uint32_t flags; /* vox_grid_flags, combined with | */
    /* Threads that share a step, the calling one being one of them: up to VOX_MAX_WORKERS, or VOX_ALL_CORES; 0: one.
     * With `tasks`, the number of that system's workers. Contacts do not depend on it. The built-in scheduler never
     * uses more threads than there are cores, nor more than the system gives. It is oneTBB, or without it
     * (vox_build_info says which) each grid has threads of its own, from the first step that needs them until its end,
     * which sleep between steps; in a process made by fork it makes new ones. Builds for systems without threads are
     * serial. */
    uint32_t worker_count;
    uint32_t reserved; /* 0 */
    /* Edge length of a cell; 0: the library chooses it. It never changes contacts. The fast engine chooses one for each
     * body in every step, from the size of the tiles near other bodies; for the reference engine see
     * vox_reference_desc. */
    double cell_size;
    double margin;        /* see vox_grid_set_margin. Experimental */
    uint64_t byte_budget; /* most bytes the grid may hold; a call that would exceed it fails with VOX_ERROR_BUDGET. 0:
                             4 GiB; UINT64_MAX: no limit */
    /* Most searches for a closest point that the depth stage makes in one step: for penetrations that would be
     * ENCLOSED, or CROSSING with nothing but a closest point to go by. The first ones, in the order of the
     * penetrations, get them; the others become VOX_PENETRATION_UNKNOWN, which is counted (unknown_penetrations) and
     * written to the log. Those of meshes at rest, which are carried over from the last step, take nothing of it, and
     * stay UNKNOWN where they are. 0: no limit. */
    uint64_t closest_budget;
    VOX_OPTIONAL const struct vox_allocator* allocator;      /* null: the C++ runtime's heap */
    VOX_OPTIONAL const struct vox_log* log;                  /* null: no log */
    VOX_OPTIONAL const struct vox_task_system* tasks;        /* null: the built-in scheduler */
    VOX_OPTIONAL const struct vox_reference_desc* reference; /* null: the fast engine; else the paper's */
} vox_grid_desc;

static inline vox_grid_desc vox_default_grid_desc(void) {
    vox_grid_desc desc = VOX_ZERO;
    desc.struct_size = (uint32_t)sizeof desc;
    desc.flags = VOX_GRID_PENETRATIONS;
    return desc;
}

/* Creates a grid. desc null: all defaults. The caller owns *out_grid and releases it with
 * vox_grid_destroy. Errors: INVALID_ARGUMENT (names the field and its value), UNSUPPORTED (an x86-64 without SSE4.2),
 * OUT_OF_MEMORY, BUDGET. */
VOX_API vox_result vox_grid_create(VOX_OPTIONAL const vox_grid_desc* desc, vox_grid** out_grid);

/* Destroys a grid and releases all its memory. Its views and mesh ids become invalid, except for
 * locators (vox_query.h), which live on with their memory until they are released. Null does nothing. */
VOX_API void vox_grid_destroy(VOX_OPTIONAL vox_grid* grid);

/* Removes all meshes and contacts and keeps the settings. Old mesh ids become stale. */
VOX_API vox_result vox_grid_clear(vox_grid* grid);

/* Allocates memory for what a grid keeps of that many meshes and contacts beside the meshes themselves, in advance;
 * never releases any. A contact takes 69 bytes, with VOX_GRID_PENETRATIONS 88 more and with VOX_GRID_CONTACT_EVENTS 56
 * more; the closest points that a step searches (docs/depth.md) take up to 24 each. Contacts stay, views end. Errors:
 * LIMIT (more than VOX_MAX_BODIES), BUDGET, OUT_OF_MEMORY. */
VOX_API vox_result vox_grid_reserve(vox_grid* grid, uint32_t mesh_count, uint64_t contact_count);

/* Sets the cell size of the following steps; 0: the library chooses. Never changes the contacts.
 * Errors: INVALID_ARGUMENT when negative, infinite or NaN. */
VOX_API vox_result vox_grid_set_cell_size(vox_grid* grid, double cell_size);

/* Sets vox_grid_desc.worker_count for the following steps. Errors: INVALID_ARGUMENT (also VOX_ALL_CORES if the grid has
 * a task system of the caller's). */
VOX_API vox_result vox_grid_set_worker_count(vox_grid* grid, uint32_t worker_count);

/* Sets vox_grid_desc.flags (all of them) for the following steps. With a changed flag, contacts stay, but views of the
 * last step's results end.
 * VOX_GRID_PENETRATIONS switched on prepares all meshes at once, as their insertion would have done, in time and memory
 * proportional to them; vox_grid_penetrations is empty until the next step. Switched off, it releases all that memory.
 * VOX_GRID_CONTACT_EVENTS switched on lets the next step report each vertex in contact as one that began, as a first
 * step does. Switched off, it releases the memory of these events.
 * VOX_GRID_EDGE_CONTACTS switched on lets the next step prepare the surfaces of the meshes that are near others.
 * Switched off, it releases the memory of that.
 * Errors: INVALID_ARGUMENT (unknown flags), UNSUPPORTED (edge contacts in a build without), LIMIT, BUDGET,
 * OUT_OF_MEMORY; after these all meshes are as they were. */
VOX_API vox_result vox_grid_set_flags(vox_grid* grid, uint32_t flags);

/* From the next step on, also find the vertices of other meshes that are outside of the tetrahedra of a mesh, but
 * within `margin` (in the caller's unit) of its surface: vox_grid_margin_contacts. 0 (the default): none, at no cost,
 * and the memory that this took is released. Contacts stay, but views of the last step's results end. A mesh of more
 * than 357913941 tets then makes a step fail with LIMIT. Snapshots do not keep the margin.
 * Errors: INVALID_ARGUMENT when negative, NaN or above 2^125; UNSUPPORTED in a build without. */
VOX_EXPERIMENTAL vox_result vox_grid_set_margin(vox_grid* grid, double margin);

/* A grid as it is now, and what its last successful step did. */
typedef struct vox_grid_info {
    uint32_t struct_size;
    uint32_t flags; /* vox_grid_flags, combined with | */
    /* Number of steps, clears, reserves and changes of flags or margin so far, failed steps included. A view is valid
     * while its epoch equals it. */
    uint64_t epoch;
    /* The cell size that was set, or else the last one that was chosen; 0 before the first step. If a step chose
     * several, it is that of the smallest tetrahedra (reference engine) or of the last body that needed one (fast). */
    double cell_size;
    double margin;
    uint64_t bytes;          /* held now, without the caller's arrays */
    uint64_t peak_bytes;
    uint64_t step_ns;        /* nanoseconds */
    uint64_t moved_bodies;   /* bodies that were not at rest (see vox_grid_step) */
    uint64_t skipped_bodies; /* bodies that were left out (VOX_GRID_SKIP_BAD_BODIES) */
    uint64_t total_began;    /* pairs that began, in all steps so far */
    uint64_t total_ended;    /* pairs that ended, in all steps so far */
} vox_grid_info;

/* Gets a grid's state. Set out_info->struct_size first. */
VOX_API vox_result vox_grid_get_info(const vox_grid* grid, vox_grid_info* out_info);

/* ---- meshes ----------------------------------------------------------------------------------- */

/* Identifies a mesh in its grid: slot and generation in one number. 0 is no mesh. The ids of a grid ascend in slot
 * order, so a fresh grid orders meshes as they were inserted. The id of a removed mesh is never used again in that
 * grid. */
typedef uint32_t vox_body;
#define VOX_NULL_BODY 0u /* names no mesh */

typedef enum vox_filter_flags {
    VOX_FILTER_SELF_COLLISION = 1, /* the mesh also collides with itself */
    VOX_FILTER_SENSOR = 2          /* the mesh has contacts, but no penetrations; takes less memory */
} vox_filter_flags;

#define VOX_MAX_RINGS 8u /* vox_filter.self_rings */

/* What a mesh collides with. With all fields 0, the default, it collides with every other mesh, but not with itself.
 * Two meshes in different worlds never collide; use worlds for copies of a scene in one grid. Two meshes with the same
 * group other than 0 collide if it is positive and do not collide if it is negative. Any other two collide if the
 * category of each has a bit in common with the mask of the other, as in Box2D. A tetrahedron that is ruled out for a
 * vertex is treated as if it did not exist: the rule of vox_contact (every tetrahedron with the vertex in its interior,
 * or else the lowest with it on the boundary) is applied to the remaining ones. */
typedef struct vox_filter {
    uint32_t flags; /* vox_filter_flags, combined with | */
    int32_t group;
    uint64_t category; /* 0: 1 */
    uint64_t mask;     /* 0: all bits */
    uint32_t world;
    /* Self-contact skips tetrahedra that have a corner within this many edges of the vertex, along the edges of the
     * mesh's tetrahedra; at most VOX_MAX_RINGS. 0 skips only tetrahedra that have the vertex as a corner. Takes about
     * 60, 260 or 700 bytes a vertex for 1, 2 or 3. */
    uint32_t self_rings;
    /* Self-contact skips tetrahedra that are closer to the vertex than this in the rest pose (distance to the closed
     * tetrahedron, computed in double). The rest pose is vox_mesh_desc.rest_positions or, without those, the positions
     * at the time this was first set. */
    double self_rest_distance;
} vox_filter;

typedef enum vox_mesh_flags {
    VOX_MESH_COPY_POSITIONS = 1, /* copy the positions instead of borrowing them */
    VOX_MESH_BORROW_TETS = 2     /* borrow the tetrahedra instead of copying them, 16 bytes each */
} vox_mesh_flags;

/* A body: vertices, and tetrahedra over them. Without tetrahedra (a surface, a set of points) its vertices still
 * collide with the tetrahedra of other meshes, but its edges and faces with nothing, so a thin blade may cross a body
 * without a contact. The first such mesh that a grid gets is written to its log as a warning;
 * the counter meshes_without_tets is how many. */
typedef struct vox_mesh_desc {
    uint32_t struct_size;
    uint32_t flags; /* vox_mesh_flags, combined with | */
    /* positions.count is the number of vertices. The data is borrowed until the mesh is removed, bound to other
     * positions or mapped. Every step reads it, and while it runs the data must stay unchanged: to move the mesh, write
     * to it between steps. If it is null, bind positions before the next step. */
    vox_positions positions;
    /* tet_count * 4 vertex indices, copied unless VOX_MESH_BORROW_TETS is set. Both windings are accepted.
     * With that flag, they must stay valid and unchanged, as any function of the grid may read them, until the mesh is
     * removed or gets another topology, or the grid is cleared or destroyed. The first call that turns tetrahedra
     * off, replaces, removes or appends some copies them, and leaves the caller's array as it is and no longer needed.
     * A grid made from a snapshot has its own copy. */
    const uint32_t* tets;
    uint64_t tet_count;
    uint64_t user_data; /* any number of the caller's, returned by vox_body_get_user_data */
    vox_filter filter;
    vox_positions rest_positions; /* of all vertices, copied; none: see vox_filter.self_rest_distance */
} vox_mesh_desc;

static inline vox_mesh_desc vox_default_mesh_desc(void) {
    vox_mesh_desc desc = VOX_ZERO;
    desc.struct_size = (uint32_t)sizeof desc;
    return desc;
}

/* Describes a mesh with packed floats x y z; the other fields have their defaults. The arrays are borrowed and copied
 * as vox_mesh_desc says. */
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

/* Adds a mesh, which takes part from the next step on.
 * Packed positions in VOX_FORMAT_FLOAT that can only be doubles are refused: from 16 vertices on, every other number
 * would be of ordinary size, those between far too large and far too small by turns (as most bit patterns are). They
 * are looked at once for each format: here if they are copied, else when a step, suggestion or locator reads them.
 * Errors: INVALID_ARGUMENT, INVALID_MESH ("tet 17 names vertex 900 of 812"), LIMIT, BUDGET, OUT_OF_MEMORY. */
VOX_API vox_result vox_mesh_insert(vox_grid* grid, const vox_mesh_desc* desc, vox_body* out_body);

/* Removes a mesh. The contacts of the last step stay as they are until the next one. */
VOX_API vox_result vox_body_remove(vox_grid* grid, vox_body body);

/* 1 when `mesh` names a mesh of the grid, else 0 (also for a null grid). Cannot fail. */
VOX_API uint32_t vox_body_is_valid(VOX_OPTIONAL const vox_grid* grid, vox_body body);

/* The user_data the mesh was inserted with. */
VOX_API vox_result vox_body_get_user_data(const vox_grid* grid, vox_body body, uint64_t* out_user_data);

/* Copies the ids of the first `capacity` meshes of the grid, disabled ones included, ascending. *out_count is how many
 * there are, which may be more than were copied. `bodies` may be null if capacity is 0. Errors: INVALID_ARGUMENT. */
VOX_API vox_result vox_grid_get_bodies(const vox_grid* grid, vox_body* bodies, uint64_t capacity, uint64_t* out_count);

/* A mesh as it is now, e.g. after vox_grid_load. */
typedef struct vox_body_info {
    uint32_t struct_size;
    uint32_t slot;         /* from 0 */
    uint64_t user_data;    /* as given at insertion */
    uint64_t tet_count;    /* with those that are disabled or removed: indices of tetrahedra are below it */
    uint64_t enabled_tet_count;
    uint32_t enabled;      /* 1, or 0 (see vox_body_set_enabled) */
    uint32_t flags;        /* vox_mesh_flags: COPY_POSITIONS if the positions are the mesh's own (copied, mapped or
                              loaded), BORROW_TETS while the tetrahedra are the caller's */
    uint32_t has_transform; /* 1 if vox_body_set_transform gave it one */
    uint32_t reserved;      /* 0 */
    /* The positions, without the transform; removed vertices are among them. The data is null if the mesh has none. It
     * lives until the mesh is removed, bound to other positions, mapped, or gets other or more vertices, or the grid is
     * cleared or destroyed. No stride is 0 unless the data is null. */
    vox_positions positions;
    double transform[12]; /* as vox_body_set_transform; without one the rows 1 0 0 0, 0 1 0 0, 0 0 1 0 */
    vox_filter filter;    /* in use: neither category nor mask is 0 */
} vox_body_info;

/* Writes the fields that out_info->struct_size covers (set it first). How long `positions` live: see vox_body_info.
 * Errors: INVALID_ARGUMENT, INVALID_HANDLE. */
VOX_API vox_result vox_body_get_info(const vox_grid* grid, vox_body body, vox_body_info* out_info);

/* Copies the first `capacity` tetrahedra of a mesh: of tetrahedron t the corners, as they were given, to corners[4 * t]
 * to corners[4 * t + 3], and to enabled[t] 1 or, if it is disabled or removed, 0. Each of the two arrays may be null,
 * and is not written then. *out_count is how many tetrahedra there are (vox_body_info.tet_count).
 * Errors: INVALID_ARGUMENT, INVALID_HANDLE. */
VOX_API vox_result vox_mesh_get_tets(const vox_grid* grid, vox_body body, VOX_OPTIONAL uint32_t* corners,
                                     VOX_OPTIONAL uint8_t* enabled, uint64_t capacity, uint64_t* out_count);

/* Makes a mesh borrow another array of positions, one for each vertex, under the rule of vox_mesh_desc.positions, and
 * releases one that it owned. There is no need to bind the same array again after writing to it.
 * Errors: INVALID_ARGUMENT (e.g. another count). */
VOX_API vox_result vox_mesh_bind_positions(vox_grid* grid, vox_body body, const vox_positions* positions);

/* Borrows the positions that the vertices of a mesh had before they moved to those of vox_mesh_bind_positions: in the
 * following steps each vertex moves from one to the other in a straight line, at constant speed, and such steps also
 * find vox_grid_passages. Values may be written to the same memory between steps. The mesh's transform does not apply
 * to them: they are where the vertices were. Null ends it, as do vox_mesh_set_topology and vox_mesh_append_vertices.
 * Snapshots do not keep them. A step fails with NON_FINITE or LIMIT where they are not as VOX_FORMAT_DOUBLE has it;
 * VOX_GRID_SKIP_BAD_BODIES is about positions alone.
 * Errors: as vox_mesh_bind_positions. */
VOX_EXPERIMENTAL vox_result vox_mesh_bind_previous_positions(vox_grid* grid, vox_body body,
                                                             VOX_OPTIONAL const vox_positions* positions);

/* Binds packed floats x y z. Errors: as vox_mesh_bind_positions. */
static inline vox_result vox_mesh_bind_floats(vox_grid* grid, vox_body body, const float* xyz, uint64_t count) {
    const vox_positions positions = vox_float_positions(xyz, count);
    return vox_mesh_bind_positions(grid, body, &positions);
}

/* Binds packed doubles x y z. Errors: as vox_mesh_bind_positions. */
static inline vox_result vox_mesh_bind_doubles(vox_grid* grid, vox_body body, const double* xyz, uint64_t count) {
    const vox_positions positions = vox_double_positions(xyz, count);
    return vox_mesh_bind_positions(grid, body, &positions);
}

/* Makes the next step process a mesh even if it is at rest (see vox_grid_step). Contacts are correct without it; it
 * serves to measure steps over positions that stay the same. */
VOX_API vox_result vox_body_mark_moved(vox_grid* grid, vox_body body);

/* Sets what the mesh collides with, from the next step on (the filter is copied). The tables of the self-contact
 * filters, and what penetrations need of a mesh that was a sensor, are built in the call, in time and memory
 * proportional to the mesh.
 * Errors: INVALID_ARGUMENT, LIMIT (self_rings; tetrahedra of a mesh with penetrations), INVALID_STATE (a rest distance
 * without a rest pose or positions), NON_FINITE (a rest position), BUDGET, OUT_OF_MEMORY. */
VOX_API vox_result vox_body_set_filter(vox_grid* grid, vox_body body, const vox_filter* filter);

/* Disables a mesh (enabled 0), so that it takes no part in the following steps and its positions are not read, or
 * enables it again (1, as at insertion). Its contacts of the last step stay until the next one.
 * Errors: INVALID_ARGUMENT for other numbers. */
VOX_API vox_result vox_body_set_enabled(vox_grid* grid, vox_body body, uint32_t enabled);

/* With enabled 0, the two meshes do not collide in the following steps, whatever their filters say; with 1, their
 * filters decide. The setting ends when either mesh is removed. Errors: INVALID_ARGUMENT for other numbers and for
 * body_a = body_b (see VOX_FILTER_SELF_COLLISION), BUDGET, OUT_OF_MEMORY. */
VOX_API vox_result vox_grid_set_pair_enabled(vox_grid* grid, vox_body body_a, vox_body body_b, uint32_t enabled);

/* Gives the mesh positions of its own that the caller may write to: one for each vertex, packed, in the format
 * it was inserted with or bound to last. At first they hold the mesh's present positions, or zeros if it has none.
 * From the next step on, the mesh uses what the caller has written there between steps. Calling it again returns the
 * same array. The array belongs to the library and lives until the mesh is removed or bound, or the grid is cleared or
 * destroyed. It is null for a mesh without vertices. For a mesh inserted with VOX_MESH_COPY_POSITIONS it is the copy
 * made then.
 * Errors: BUDGET, OUT_OF_MEMORY. */
VOX_API vox_result vox_mesh_map_positions(vox_grid* grid, vox_body body, void** out_positions);

/* Moves a mesh as a whole. In the following steps a vertex has the position
 *     x' = ((m[0] * x + m[1] * y) + m[2] * z) + m[3], y' likewise from m[4..7], z' from m[8..11],
 * computed in double, in this order, each operation rounded. Contacts are exact for the resulting x', y', z', as if
 * these had been given as VOX_FORMAT_DOUBLE. If they exceed the limits of that format, the step fails. `matrix` is any
 * affine map, three rows of four numbers, copied. Null (the default) means no transform. The transform stays when
 * other positions are bound.
 * Errors: INVALID_ARGUMENT (an element that is not finite); BUDGET, OUT_OF_MEMORY (for a first transform). */
VOX_API vox_result vox_body_set_transform(vox_grid* grid, vox_body body, VOX_OPTIONAL const double matrix[12]);

/* ---- cutting and growing ---------------------------------------------------------------------- */

/* Edits of a mesh between steps. A tetrahedron or vertex keeps its index whatever happens to others. The index of a
 * removed one is never reused, and still counts towards the limits, until vox_mesh_set_topology replaces everything.
 * What an edit removes no longer exists for contacts, penetrations, locators, suggestions and the rings of a filter.
 * The contacts of the last step stay as they are until the next step, which derives its events as usual: a pair that
 * still touches persists.
 * Time: an edit takes time proportional to what it changes and to the tetrahedra around that. The following take time
 * proportional to the mesh: the first edit of a mesh; the first step after an edit of more than an eighth of its
 * tetrahedra, or after edits that together changed more than a quarter of them since the last such step; and a step
 * after an edit that could not get memory for its repairs. Memory: about 20 bytes a tetrahedron and 35 a vertex from
 * the first edit on, and 16 more a tetrahedron once one was disabled; another 16 from the first edit of borrowed
 * tetrahedra on (VOX_MESH_BORROW_TETS), which are copied then. The first step after an edit may allocate.
 * Positions must be bound before the next step, as usual. `count` 0 does nothing; an index may be named several times.
 * Errors of all: INVALID_ARGUMENT (also for an index that the mesh does not have, or that was removed), INVALID_MESH
 * ("tet 17 names vertex 900 of 812", or a vertex that was removed), LIMIT, BUDGET, OUT_OF_MEMORY. */

/* Replaces tetrahedra, vertices and positions, as if the mesh had been inserted with those of `desc`. Its id, user
 * data, filter, transform, disabled pairs, and whether it is enabled stay as they are; of `desc`, user_data and filter
 * are ignored. If desc->positions is null, the mesh keeps its positions and its rest
 * pose if the number of vertices is unchanged; otherwise it has no positions until vox_mesh_bind_positions. The rest
 * pose of a filter with a rest distance is taken from desc as at insertion. Errors: also INVALID_STATE and NON_FINITE,
 * as vox_body_set_filter. */
VOX_API vox_result vox_mesh_set_topology(vox_grid* grid, vox_body body, const vox_mesh_desc* desc);

/* Disables the `count` tetrahedra named by `tets` (enabled 0), so that they contain no vertex and have no edges and
 * facets, or enables them again (1, as at insertion). Their vertices stay and collide with others either way.
 * Errors: INVALID_ARGUMENT for other numbers. */
VOX_API vox_result vox_mesh_set_tets_enabled(vox_grid* grid, vox_body body, const uint32_t* tets, uint64_t count,
                                             uint32_t enabled);

/* Gives tetrahedron tets[i] the corners corners[4 * i] to corners[4 * i + 3], copied, for each i below count. If an
 * index is named twice, the last corners are used. A disabled tetrahedron stays disabled. To cut a mesh open, append
 * copies of the vertices on the cut and let the tetrahedra of one side use those. */
VOX_API vox_result vox_mesh_replace_tets(vox_grid* grid, vox_body body, const uint32_t* tets, uint64_t count,
                                         const uint32_t* corners);

/* Adds `count` tetrahedra with 4 corners each, copied. *out_first is the index of the first; the others have the
 * following indices. */
VOX_API vox_result vox_mesh_append_tets(vox_grid* grid, vox_body body, const uint32_t* corners, uint64_t count,
                                        uint32_t* out_first);

/* Removes tetrahedra, disabled ones included. Their vertices stay; see vox_mesh_remove_vertices. */
VOX_API vox_result vox_mesh_remove_tets(vox_grid* grid, vox_body body, const uint32_t* tets, uint64_t count);

/* Vertices to append. */
typedef struct vox_vertices_desc {
    uint32_t struct_size;
    uint32_t reserved; /* 0 */
    uint64_t count;
    /* For a mesh that borrows its positions: an array of all positions, first those of the vertices it has, then those
     * of the new ones. It is borrowed from now on instead of the old array, under the rule of vox_mesh_desc.positions.
     * For a mesh with positions of its own (copied, mapped, or loaded): `count` positions in its format, copied; the
     * array of vox_mesh_map_positions becomes invalid. There may be none for a mesh that has no positions yet and,
     * together with copies_of, for a mesh with positions of its own. */
    vox_positions positions;
    /* Null, or `count` indices of earlier vertices of the mesh: the vertex that each new one is a copy of. A copy gets
     * the rest position of that vertex and, without `positions`, its position, too. */
    VOX_OPTIONAL const uint32_t* copies_of;
    /* For meshes with a rest pose (vox_filter.self_rest_distance): `count` positions in it, copied. None: those of
     * copies_of or, if that is null too, the present positions of the new vertices. */
    vox_positions rest_positions;
} vox_vertices_desc;

static inline vox_vertices_desc vox_default_vertices_desc(void) {
    vox_vertices_desc desc = VOX_ZERO;
    desc.struct_size = (uint32_t)sizeof desc;
    return desc;
}

/* Adds vertices, which belong to no tetrahedron yet. *out_first is the index of the first; the others have the
 * following indices. Errors: also INVALID_STATE (the mesh has a rest pose, but a new vertex has no position for it),
 * NON_FINITE (a position of the rest pose). */
VOX_API vox_result vox_mesh_append_vertices(vox_grid* grid, vox_body body, const vox_vertices_desc* desc,
                                            uint32_t* out_first);

/* Removes vertices; a vertex of an enabled tetrahedron is an INVALID_ARGUMENT. Removed vertices make no more contacts,
 * and no tetrahedron may name them again. Their positions are still read and must stay finite, so it is best to leave
 * them as they are. */
VOX_API vox_result vox_mesh_remove_vertices(vox_grid* grid, vox_body body, const uint32_t* vertices, uint64_t count);

/* ---- step and contacts ------------------------------------------------------------------------ */

/* Finds all contacts of the positions as they are now. On success the previous contacts are replaced; on failure they
 * are gone and the grid stays usable.
 * A mesh is at rest if its positions are bit for bit those of the last step; the fast engine keeps a copy to compare.
 * Contacts between meshes at rest, and of a mesh at rest with itself, are carried over from the last step with their
 * penetrations, so such meshes cost little more than reading their positions. (When a moving mesh comes to rest, it is
 * processed in one more step, in which the copy is made.) A step after a failed one, or after a change of a setting,
 * processes all meshes.
 * In the steady state (same meshes, no more work than before) it allocates nothing, with any number of workers. The
 * memory of the built-in scheduler, such as the stacks of its threads, is not the grid's and is not counted.
 * Errors: INVALID_STATE (a mesh has no positions), NON_FINITE and LIMIT (a coordinate that VOX_FORMAT_DOUBLE does not
 * allow), INVALID_ARGUMENT (doubles under VOX_FORMAT_FLOAT, see vox_mesh_insert); all these name the mesh, as does
 * vox_grid_get_failure. LIMIT (more than VOX_MAX_CONTACTS; dense storage of 2^31 cells or more), BUDGET,
 * OUT_OF_MEMORY. */
VOX_API vox_result vox_grid_step(vox_grid* grid);

/* Steps `count` grids, which must differ, each as by vox_grid_step, several at the same time: for many small scenes
 * that have nothing to do with each other. The grids are split among `worker_count` threads (as in vox_grid_desc) of
 * `tasks` (null: the built-in scheduler), as one task; within it each grid uses workers of its own, so one of them is
 * best. What a grid finds does not depend on the others. Its callbacks are called on the thread that steps it. One
 * thread at a time may change each of the grids, so none of them may be used until the call returns. Threads of the
 * built-in scheduler may be kept for a next call with as many workers: those of one call at most, at most
 * VOX_MAX_WORKERS - 1, which sleep, until the process ends or the library is unloaded. results: null, or `count`
 * results, of the grids in their order. If grids fail, the others are stepped nevertheless, and the call returns the
 * result of the first of them and its text, after its index ("grid 17: ...").
 * Errors: as vox_grid_step; INVALID_ARGUMENT (a null or repeated grid, a worker_count) and OUT_OF_MEMORY, after which
 * no grid was stepped and `results` is not written, unless the task system broke its rules, see vox_task_system. */
VOX_API vox_result vox_grids_step(vox_grid* const* grids, uint64_t count,
                                  VOX_OPTIONAL const struct vox_task_system* tasks, uint32_t worker_count,
                                  VOX_OPTIONAL vox_result* results);

/* A mesh that made a step fail, or that a step left out. */
typedef struct vox_failure {
    uint32_t struct_size;
    vox_result result;  /* NON_FINITE or LIMIT (a coordinate that VOX_FORMAT_DOUBLE does not allow), INVALID_STATE (no
                           positions), INVALID_ARGUMENT (doubles under VOX_FORMAT_FLOAT); VOX_OK if there is none */
    vox_body mesh;      /* VOX_NULL_BODY if there is none */
    uint32_t slot;      /* of the mesh, from 0 */
    uint64_t user_data; /* of the mesh, as given at insertion */
    uint32_t vertex;    /* the first with such a coordinate; VOX_NO_VERTEX if the failure is about none */
    uint32_t reserved;
    double position[3]; /* of that vertex, as it would collide: in double and transformed; else 0 */
} vox_failure;

#define VOX_NO_VERTEX 0xffffffffu /* vox_failure.vertex where a failure is not about a vertex */

/* The mesh that made the last step fail (index 0), or the meshes that it left out (VOX_GRID_SKIP_BAD_BODIES): the
 * index-th of them, in the order of ids. `mesh` is VOX_NULL_BODY beyond the last, after steps that failed for another
 * reason and after a clear. Writes the fields that out_failure->struct_size covers (set it first). The mesh may have
 * been removed since. Errors: INVALID_ARGUMENT (a null pointer, a bad struct_size). */
VOX_API vox_result vox_grid_get_failure(const vox_grid* grid, uint32_t index, vox_failure* out_failure);

/* Vertex `vertex` of body_a is in the closed tetrahedron `tet` of body_b and is not a corner of it.
 * This is decided exactly for the coordinates given. For each (body_a, vertex, body_b) there is a contact for every
 * tetrahedron that has the vertex in its interior; if there is none, one for the tetrahedron of lowest index that has
 * it on its boundary. A tetrahedron of exactly zero volume contains nothing.
 * `barycentric` are the vertex's weights for the tetrahedron's four corners in their given order. Each is in
 * [0, 1], and their sum is 1 up to rounding. */
typedef struct vox_contact {
    vox_body body_a;
    uint32_t vertex;
    vox_body body_b;
    uint32_t tet;
    float barycentric[4];
} vox_contact;

/* `count` contacts, `byte_stride` apart, sorted by (body_a, vertex, body_b, tet). They live until the next step, clear,
 * reserve, change of the flags or destroy of the grid; `epoch` is vox_grid_info.epoch of that state. */
typedef struct vox_contact_view {
    const vox_contact* data;
    size_t byte_stride;
    uint64_t count;
    uint64_t epoch;
    /* One for each contact: 1 if the vertex is in the interior of the tetrahedron, 0 if it is on its boundary; exact.
     * On a face that two tetrahedra share, a vertex has a contact with one of them (see vox_contact): who joins the
     * contacts of several grids, each with a part of a mesh, keeps the rule with this. No part of vox_grid_get_hash. */
    const uint8_t* interiors;
} vox_contact_view;

/* The contacts of the last step; count 0 before the first, after a failed one and after a clear. */
VOX_API vox_result vox_grid_get_contacts(const vox_grid* grid, vox_contact_view* out_view);

/* The contacts of `count` grids, one grid after the other: those of grid i begin at index offsets[i] and end before
 * offsets[i + 1], where offsets has count + 1 numbers, all of which are written. Copies the first `capacity` contacts;
 * `contacts` may be null if capacity is 0. Errors: INVALID_ARGUMENT. */
VOX_API vox_result vox_grids_copy_contacts(const vox_grid* const* grids, uint64_t count, vox_contact* contacts,
                                           uint64_t capacity, uint64_t* offsets);

/* A hash of the contacts: all fields, in order. The same for any cell size, storage, hash and engine. */
VOX_API vox_result vox_grid_get_hash(const vox_grid* grid, uint64_t* out_hash);

/* ---- penetrations ----------------------------------------------------------------------------- */

/* How a penetration's depth and direction were found. In the following, p is the vertex; a colliding vertex is a vertex
 * of body_a that has a contact with body_b; edges are those of body_a's tetrahedra; the surface of body_b consists of
 * the facets of exactly one of its tetrahedra, duplicates counted once. SURFACE and PROPAGATED are the method of
 * Heidelberger et al. 2004; the other states stand for cases in which it gives no answer. "Closest" means that depth is
 * the distance from p to the closest point of body_b's surface, and direction points straight to it. For self-contact
 * the surface is that of the fold that p has entered, never a triangle that has p as a corner. */
typedef enum vox_penetration_state {
    VOX_PENETRATION_SURFACE = 0,    /* edges lead from p out of body_b; mean over the points where they cross the
                                       surface */
    VOX_PENETRATION_PROPAGATED = 1, /* all neighbours of p collide; mean over those closer to the surface */
    VOX_PENETRATION_ENCLOSED = 2,   /* closest: no edge leads out from p or from a colliding vertex connected with it,
                                       or p has no edges, as in meshes without tetrahedra */
    VOX_PENETRATION_CROSSING = 3,   /* the means are unusable, as the normals nearly cancel (edges leave on opposite
                                       sides), the depth would not be positive, or an edge that leads out crosses no
                                       surface (inverted tetrahedra, non-manifold facets); or this is the case for all
                                       vertices that p is connected with. The nearest way out alone: of the edges, or
                                       by a neighbour. Closest only if no edge of any of these vertices leads out */
    VOX_PENETRATION_COINCIDENT = 4, /* p lies on the surface; depth is 0, direction the surface's normal at p */
    VOX_PENETRATION_UNKNOWN = 5     /* the step's closest_budget was used up (see vox_grid_desc): depth is 0, direction
                                       the normal of a facet of the contact's tetrahedron */
} vox_penetration_state;

/* Vertex `vertex` of body_a is inside body_b (a = b: self-contact) and has to leave it: moving the vertex by
 * depth * direction leads to the surface of body_b, exactly if the state says closest, and otherwise as well as edges
 * and neighbours can estimate it. All values are finite, and direction is a unit vector up to rounding. If body_b has
 * no surface (each facet belongs to several tetrahedra), depth is 0 and direction the normal of a facet of the
 * contact's tetrahedron. Does not depend on engine, cell size, workers or machine. */
typedef struct vox_penetration {
    vox_body body_a;
    uint32_t vertex;
    vox_body body_b;
    vox_penetration_state state;
    uint64_t contact;   /* index in vox_grid_get_contacts of the first contact of (body_a, vertex, body_b) */
    float depth;        /* >= 0, in the caller's unit */
    float direction[3]; /* in the frame of the positions, out of body_b */
} vox_penetration;

/* `count` penetrations, `byte_stride` apart: one for each (body_a, vertex, body_b) that has contacts, in that order,
 * unless one of them is a sensor (VOX_FILTER_SENSOR). A vertex inside two meshes has two. The data lives as long as
 * that of the contacts' view. */
typedef struct vox_penetration_view {
    const vox_penetration* data;
    size_t byte_stride;
    uint64_t count;
    uint64_t epoch;
} vox_penetration_view;

/* The penetrations of the last step; count 0 if it found no contacts, before the first step, after a failed one and
 * after a clear. Errors: INVALID_STATE if the grid's flags lack VOX_GRID_PENETRATIONS. */
VOX_API vox_result vox_grid_penetrations(const vox_grid* grid, vox_penetration_view* out_view);

/* Depth and direction of a vox_penetration as computed, in double; rounded to floats they are those of the
 * vox_penetration. */
typedef struct vox_depth {
    double depth;
    double direction[3];
} vox_depth;

/* `count` depths, `byte_stride` apart. The data lives as long as the penetrations or readings that they belong to. */
typedef struct vox_depth_view {
    const vox_depth* data;
    size_t byte_stride;
    uint64_t count;
    uint64_t epoch;
} vox_depth_view;

/* The depths of vox_grid_penetrations, one for each, in that order. Errors: as vox_grid_penetrations. */
VOX_API vox_result vox_grid_depths(const vox_grid* grid, vox_depth_view* out_view);

/* ---- edge contacts ---------------------------------------------------------------------------- */

/* How an edge meets a face. */
typedef enum vox_crossing_kind {
    VOX_CROSSING_THROUGH = 0,  /* it passes through the interior of the face, with an end on either side */
    VOX_CROSSING_TOUCHING = 1, /* an end is on the face, or it passes through an edge or a corner of the face */
    VOX_CROSSING_COPLANAR = 2  /* it lies in the plane of the face and meets it, or one of them is degenerate and they
                                  meet */
} vox_crossing_kind;

/* An edge of the surface of body_a and a face of the surface of body_b that have a point in common (a = b:
 * self-contact; then they have no vertex in common). The surface of a mesh consists of the facets of exactly one of its
 * enabled tetrahedra, duplicates counted once, and of their edges. Decided exactly for the coordinates given.
 * So two bars laid across each other are seen, though no vertex of one is in the other. Where several points are
 * common, the position is that of one of them: an end of the edge if one is, the lower vertex first. */
typedef struct vox_edge_contact {
    vox_body body_a;
    uint32_t edge[2];       /* vertices of body_a, the lower first */
    vox_body body_b;
    uint32_t face[3];       /* vertices of body_b, the lowest first, counter-clockwise as seen from the side that the
                               normal points to */
    uint32_t tet;           /* of body_b, behind the face; of doubled ones the lowest */
    vox_crossing_kind kind;
    uint32_t reserved;      /* 0 */
    double edge_weights[2]; /* of the point, in [0, 1], with the sum 1 up to rounding */
    double face_weights[3]; /* of the same point */
    double position[3];     /* of the point, rounded */
    /* A unit vector out of `tet` or, if that is flat, to the side away from the lower vertex of the edge; 0, 0, 1 if
     * the face has no area. */
    double normal[3];
} vox_edge_contact;

/* `count` edge contacts, `byte_stride` apart, sorted by body_a, edge, body_b and the three vertices of the face in
 * ascending order. The data lives as long as that of the contacts' view. */
typedef struct vox_edge_contact_view {
    const vox_edge_contact* data;
    size_t byte_stride;
    uint64_t count;
    uint64_t epoch;
} vox_edge_contact_view;

/* The edge contacts of the last step: the same for every engine, cell size and number of workers. Count 0 before the
 * first step, after a failed one and after a clear. Which meshes collide is up to vox_filter and
 * vox_grid_set_pair_enabled, as for contacts; a self-contact is ruled out where vox_filter rules out the contact of
 * either end of the edge with `tet`. Meshes that touch by edges alone are pairs of vox_grid_get_pairs, with no
 * contacts, and have touch events. vox_grid_get_hash and readings are of contacts alone.
 * Errors: INVALID_STATE if the grid's flags lack VOX_GRID_EDGE_CONTACTS. */
VOX_EXPERIMENTAL vox_result vox_grid_edge_contacts(const vox_grid* grid, vox_edge_contact_view* out_view);

/* A hash of the edge contacts: all fields, in order. The same for any cell size, storage, hash and engine. Errors: as
 * vox_grid_edge_contacts. */
VOX_EXPERIMENTAL vox_result vox_grid_edge_hash(const vox_grid* grid, uint64_t* out_hash);

/* Computes the way out for every edge contact of the last step (vox_grid_edge_depths). It reads positions, which must
 * still be those of the step. A program that does not need it pays nothing.
 * The part of an edge inside body_b begins and ends at contacts with it, or at an end of the edge. Moving its middle by
 * depth * direction leads to the closest point of the surface of body_b; of several, that of the first triangle. Where
 * no part begins or ends, because the two only touch, depth is 0 and direction the normal. For self-contact the middle
 * moves to the plane of the face, along the normal, instead.
 * Errors: INVALID_STATE (as vox_grid_edge_contacts; or a mesh of a contact was removed or edited since the step, or
 * lacks positions), NON_FINITE, BUDGET, OUT_OF_MEMORY. */
VOX_EXPERIMENTAL vox_result vox_grid_prepare_edge_depths(vox_grid* grid);

/* The depth and direction of each edge contact, in the order of vox_grid_edge_contacts. Errors: INVALID_STATE before
 * vox_grid_prepare_edge_depths. */
VOX_EXPERIMENTAL vox_result vox_grid_edge_depths(const vox_grid* grid, vox_depth_view* out_view);

/* ---- margin contacts and passages ------------------------------------------------------------- */

/* Vertex `vertex` of body_a is in no tetrahedron of body_b, but no further than the margin from its surface. The point
 * of the surface of body_b that is closest to it is on a facet of `tet`; of several at the same distance that of the
 * lowest (tet, facet), as in vox_locator_find_closest (vox_query.h). Computed in double. */
typedef struct vox_margin_contact {
    vox_body body_a;
    uint32_t vertex;
    vox_body body_b;        /* never body_a */
    uint32_t tet;           /* of body_b */
    uint32_t facet;         /* of the tetrahedron, as in vox_closest_hit */
    uint32_t face[3];       /* its vertices, in the order given there */
    double face_weights[3]; /* of the closest point, in [0, 1], with the sum 1 up to rounding */
    double distance;        /* from the vertex to the closest point */
    double normal[3];       /* a unit vector from the closest point to the vertex; out of the tetrahedron if there is
                               no distance between them */
} vox_margin_contact;

/* `count` margin contacts, `byte_stride` apart, sorted by (body_a, vertex, body_b), each of which has one at most. The
 * data lives as long as that of the contacts' view. */
typedef struct vox_margin_contact_view {
    const vox_margin_contact* data;
    size_t byte_stride;
    uint64_t count;
    uint64_t epoch;
} vox_margin_contact_view;

/* The margin contacts of the last step: the same for every engine, cell size and number of workers. Count 0 before the
 * first step, after a failed one and after a clear. Which meshes collide is up to vox_filter and
 * vox_grid_set_pair_enabled, as for contacts. They are not part of vox_grid_get_hash, and no pairs or events come of
 * them.
 * Errors: INVALID_STATE if the margin is 0 (vox_grid_set_margin). */
VOX_EXPERIMENTAL vox_result vox_grid_margin_contacts(const vox_grid* grid, vox_margin_contact_view* out_view);

/* Vertex `vertex` of body_a met the surface of body_b while both moved from their previous positions to the present
 * ones (vox_mesh_bind_previous_positions; a mesh without previous positions stands still), wherever it was before
 * and is after: also where it went through a thin mesh and out again. */
typedef struct vox_passage {
    vox_body body_a;
    uint32_t vertex;
    vox_body body_b;  /* never body_a */
    uint32_t tet;     /* of body_b */
    uint32_t facet;   /* of the tetrahedron, as in vox_closest_hit: the first that the vertex met; the lowest
                         (tet, facet) of several at the same time */
    uint32_t face[3]; /* its vertices, in the order given there */
    double time;      /* in [0, 1], 0 at the previous positions: when it met it; never too late, and too early by no
                         more than rounding errors make necessary */
} vox_passage;

/* `count` passages, `byte_stride` apart, sorted by (body_a, vertex, body_b), each of which has one at most. The data
 * lives as long as that of the contacts' view. */
typedef struct vox_passage_view {
    const vox_passage* data;
    size_t byte_stride;
    uint64_t count;
    uint64_t epoch;
} vox_passage_view;

/* The passages of the last step, between meshes of which one has previous positions: the same for every engine, cell
 * size and number of workers. None is missed; a vertex that comes as close to a surface as rounding errors are large
 * may be reported as well. Filters as for contacts. Count 0 where no mesh has previous positions, before the first
 * step, after a failed one and after a clear. */
VOX_EXPERIMENTAL vox_result vox_grid_passages(const vox_grid* grid, vox_passage_view* out_view);

/* ---- touching pairs and events ---------------------------------------------------------------- */

/* Two meshes that touch: a vertex of one of them is in a tetrahedron of the other, or they have edge contacts
 * (VOX_GRID_EDGE_CONTACTS). body_a <= body_b; they are equal if
 * a mesh touches itself. The contacts of the pair are those whose indices begin at vox_pair_view.contacts[first]: first
 * the a_in_b contacts of vertices of body_a in tets of body_b, then the b_in_a contacts of vertices of body_b in tets
 * of body_a (0 for a mesh with itself), each in the order of vox_grid_get_contacts. */
typedef struct vox_pair {
    vox_body body_a;
    vox_body body_b;
    uint64_t user_data_a; /* of body_a, as given at insertion */
    uint64_t user_data_b;
    uint64_t first;
    uint64_t a_in_b;
    uint64_t b_in_a;
} vox_pair;

#define VOX_MAX_CONTACTS 4294967295u /* contacts of one step; a step with more fails with VOX_ERROR_LIMIT */

/* `count` pairs, `byte_stride` apart, sorted by (body_a, body_b). `contacts` holds the index of every contact of
 * vox_grid_get_contacts() once, pair by pair. Both live as long as the data of the contacts' view. */
typedef struct vox_pair_view {
    const vox_pair* data;
    size_t byte_stride;
    uint64_t count;
    uint64_t epoch;
    const uint32_t* contacts;
} vox_pair_view;

/* The pairs that touched in the last step; count 0 before the first, after a failed one and after a clear. */
VOX_API vox_result vox_grid_get_pairs(const vox_grid* grid, vox_pair_view* out_view);

/* Copies the first `capacity` of the last step's contacts in which `mesh` is body_a or body_b, pair by pair, in the
 * order of vox_grid_get_pairs. *out_count is how many there are, which may be more than were copied. `contacts` may be
 * null if capacity is 0. The mesh may have been disabled since the step, but not removed.
 * Errors: INVALID_ARGUMENT, INVALID_HANDLE. */
VOX_API vox_result vox_mesh_copy_contacts(const vox_grid* grid, vox_body body, vox_contact* contacts,
                                          uint64_t capacity, uint64_t* out_count);

/* The same for the contacts between two meshes, given in either order, or of one mesh with itself (body_a = body_b):
 * the contacts of their vox_pair. */
VOX_API vox_result vox_pair_copy_contacts(const vox_grid* grid, vox_body body_a, vox_body body_b,
                                          vox_contact* contacts, uint64_t capacity, uint64_t* out_count);

/* What an event reports: how the last successful step differs from the successful step before it. */
typedef enum vox_touch {
    VOX_TOUCH_BEGAN = 1,     /* touches now, and did not before */
    VOX_TOUCH_PERSISTED = 2, /* touches now, and did before */
    VOX_TOUCH_ENDED = 3      /* no longer touches, for whatever reason */
} vox_touch;

/* An event of a pair of meshes, body_a <= body_b. A pair that began persists in every following step until it ends,
 * which it does exactly once, also if a mesh was removed, disabled or filtered, or the grid cleared. Then `body_a` and
 * `body_b` may be stale ids; the user data are those of the meshes that they named. */
typedef struct vox_touch_event {
    vox_body body_a;
    vox_body body_b;
    uint64_t user_data_a;
    uint64_t user_data_b;
    vox_touch kind;
    uint32_t pair; /* index of the pair in vox_grid_get_pairs; VOX_NO_PAIR if it ended */
} vox_touch_event;

#define VOX_NO_PAIR 0xffffffffu /* vox_touch_event.pair of a pair that ended */

/* All pairs that began, then all that persisted, then all that ended: `count` in total, `byte_stride` apart, each part
 * sorted by (body_a, body_b). `data` lives until the next step or destroy of the grid. These are the events of one
 * step: a program that steps twice and reads once loses those of the first step. vox_grid_info.total_began and
 * total_ended show the loss. */
typedef struct vox_touch_view {
    const vox_touch_event* data;
    size_t byte_stride;
    uint64_t count;
    uint64_t epoch;
    uint64_t began;
    uint64_t persisted;
    uint64_t ended;
} vox_touch_view;

/* What the last step changed; count 0 before the first one. A failed step has no events, and none are lost: the
 * next step is compared with the last successful one. Removing meshes and clearing the grid give no events at once;
 * the next step ends their pairs. Destroying the grid ends them without events. */
VOX_API vox_result vox_grid_touch_events(const vox_grid* grid, vox_touch_view* out_view);

/* Vertex `vertex` of body_a has entered body_b, or is in none of its tetrahedra any more. Moving from one tetrahedron
 * of body_b to another is not an event. */
typedef struct vox_contact_event {
    vox_body body_a;
    uint32_t vertex;
    vox_body body_b;
    vox_touch kind; /* VOX_TOUCH_BEGAN or VOX_TOUCH_ENDED */
} vox_contact_event;

/* All vertices that entered, then all that left, each part sorted by (body_a, vertex, body_b). `data` lives until the
 * next step, change of the flags or destroy of the grid. Events of one step, too: see vox_touch_view, and
 * the counters total_contacts_began and total_contacts_ended. */
typedef struct vox_contact_event_view {
    const vox_contact_event* data;
    size_t byte_stride;
    uint64_t count;
    uint64_t epoch;
    uint64_t began;
    uint64_t ended;
} vox_contact_event_view;

/* The same for single vertices, under the same rules. Errors: INVALID_STATE for a grid without
 * VOX_GRID_CONTACT_EVENTS. */
VOX_API vox_result vox_grid_contact_events(const vox_grid* grid, vox_contact_event_view* out_view);

/* ---- readings --------------------------------------------------------------------------------- */

/* What a program that responds to contacts, draws or reports them needs for each contact: where the vertex is, the
 * closest part of the surface, and how deep the vertex is. vox_grid_prepare_readings, or vox_grid_prepare_readings_of
 * for a part of it, computes this once after a step, so programs that do not need it pay nothing. These two calls
 * change the grid; the functions after them only read. */

/* Which parts of a vox_reading are wanted, or present; all fields of the other parts are zero. */
typedef enum vox_reading_flags {
    VOX_READING_POSITION = 1, /* missing if the vertex or its mesh was removed after the step */
    VOX_READING_SURFACE = 2,  /* missing where POSITION is or would be, if body_b was removed or has no surface, or if
                                 all of its tetrahedra that contained the vertex were removed or disabled */
    VOX_READING_DEPTH = 4     /* missing on grids without VOX_GRID_PENETRATIONS, and where
                                 one of the meshes is a sensor */
} vox_reading_flags;

/* Geometry of one contact. All contacts of the same (body_a, vertex, body_b) have the same reading except for the first
 * field. `triangle` is the triangle closest to the vertex on the surface of body_b, which consists of the facets of
 * exactly one of its tetrahedra, duplicates counted once. It is computed in double, as by vox_locator_find_closest; of
 * several at the same distance it is the one with the lowest corners, compared in ascending order. For self-contact it
 * belongs to the fold that the vertex has entered and never has the vertex as a corner (see vox_penetration_state).
 * No reading depends on engine, cell size, workers or machine. */
typedef struct vox_reading {
    uint64_t contact;            /* index of the contact in vox_grid_get_contacts */
    uint32_t known;              /* vox_reading_flags, combined with | */
    vox_penetration_state state; /* DEPTH: state, depth and direction of the vertex's vox_penetration */
    float depth;
    float direction[3];
    double position[3];         /* POSITION: the vertex as it collides, in double and transformed */
    double distance;            /* SURFACE (up to `triangle`): distance from the vertex to surface_position */
    double surface_position[3]; /* the closest point of `triangle` */
    double barycentric[3];      /* its weights for the triangle's corners, in [0, 1], with the sum 1 up to rounding */
    /* A unit vector out of the triangle's tetrahedron or, if that is flat, to the side away from the vertex. If the
     * triangle has no area, it points from the vertex to the closest point, or is 0, 0, 1 if both coincide. */
    double normal[3];
    uint32_t triangle[3];       /* vertices of body_b, the lowest first, counter-clockwise as seen from the side that
                                   the normal points to */
    uint32_t reserved;
    uint64_t user_data_a;       /* of body_a, as given at insertion */
    uint64_t user_data_b;
} vox_reading;

/* `count` readings, `byte_stride` apart, one for each contact or for each that was asked for, in the order of the
 * contacts. With that stride a single field, e.g. position, can be used as an array. `data` lives until readings are
 * prepared again or the next step, clear or destroy of the grid. */
typedef struct vox_reading_view {
    const vox_reading* data;
    size_t byte_stride;
    uint64_t count;
    uint64_t epoch;
} vox_reading_view;

/* Computes the readings of the last step's contacts from the meshes as they are now, so borrowed positions must still
 * be those of the step. vox_reading.known shows what is missing because it was removed or changed since. May be called
 * repeatedly; each call replaces what was prepared before. Takes time proportional to the contacts and, for
 * VOX_READING_SURFACE, to the vertices and surfaces of the meshes that the vertices are in. The memory for contacts and
 * triangles is kept until the grid is destroyed, so a call that needs no more of it than an earlier one allocates
 * nothing. Enqueues at most one task.
 * Errors: NON_FINITE and LIMIT (positions that changed since the step, where they are read, or a mesh of more
 * tetrahedra than VOX_GRID_PENETRATIONS allows), BUDGET, OUT_OF_MEMORY; after these the earlier readings stay.
 * INVALID_ARGUMENT (see vox_task_system); after that there are none. */
VOX_API vox_result vox_grid_prepare_readings(vox_grid* grid);

/* What to read. */
typedef struct vox_readings_desc {
    uint32_t struct_size;
    uint32_t what; /* vox_reading_flags, combined with |; 0: all. Without SURFACE a reading takes about as long as
                      copying it. The other fields of vox_reading, such as user data, are always set */
    vox_body body_a; /* VOX_NULL_BODY: all contacts; else those that vox_mesh_copy_contacts copies */
    vox_body body_b; /* VOX_NULL_BODY, or those that vox_pair_copy_contacts copies for body_a and it */
    /* Most searches for a closest point. The first contacts that need one get it; the readings of the others lack
     * VOX_READING_SURFACE in `known`, and the log has a warning. 0: no limit. */
    uint64_t closest_budget;
} vox_readings_desc;

static inline vox_readings_desc vox_default_readings_desc(void) {
    vox_readings_desc desc = VOX_ZERO;
    desc.struct_size = (uint32_t)sizeof desc;
    return desc;
}

/* As vox_grid_prepare_readings, which is the same with desc null, but computes only the parts desc->what of the
 * readings of some contacts. All others are missing from the views and copies of the following functions.
 * Errors: as there; also INVALID_ARGUMENT (unknown parts, or body_b without body_a) and INVALID_HANDLE, after which the
 * earlier readings stay. */
VOX_API vox_result vox_grid_prepare_readings_of(vox_grid* grid, VOX_OPTIONAL const vox_readings_desc* desc);

/* The prepared readings. Errors: INVALID_STATE if none were prepared since the last step or clear. */
VOX_API vox_result vox_grid_readings(const vox_grid* grid, vox_reading_view* out_view);

/* Depth and direction of the prepared readings in double, one for each, in that order; zero where vox_reading.known
 * lacks VOX_READING_DEPTH. Count 0 if that part was not asked for. Errors: as vox_grid_readings. */
VOX_API vox_result vox_grid_reading_depths(const vox_grid* grid, vox_depth_view* out_view);

/* As vox_mesh_copy_contacts, but copies the prepared readings of those contacts, in the same order.
 * Errors: INVALID_ARGUMENT, INVALID_HANDLE, INVALID_STATE as vox_grid_readings. */
VOX_API vox_result vox_mesh_copy_readings(const vox_grid* grid, vox_body body, vox_reading* readings, uint64_t capacity,
                                          uint64_t* out_count);

/* As vox_pair_copy_contacts, but copies the prepared readings of those contacts, in the same order.
 * Errors: INVALID_ARGUMENT, INVALID_HANDLE, INVALID_STATE as vox_grid_readings. */
VOX_API vox_result vox_pair_copy_readings(const vox_grid* grid, vox_body body_a, vox_body body_b, vox_reading* readings,
                                          uint64_t capacity, uint64_t* out_count);

/* ---- snapshots -------------------------------------------------------------------------------- */

/* Writes the grid as it is now to `bytes`, in a format that is the same on every machine (docs/snapshot.md): settings,
 * meshes with their ids, positions (borrowed ones too, read during the call), and the state that the next events are
 * derived from. Allocator, log, task system, worker count, both budgets, and the results of the last step are not
 * saved. *out_size is the number of bytes; with `bytes` null nothing is written, so the size can be asked first.
 * Allocates nothing. Errors: INVALID_ARGUMENT if the capacity is too small (gives both numbers). */
VOX_API vox_result vox_grid_save(const vox_grid* grid, VOX_OPTIONAL void* bytes, uint64_t capacity, uint64_t* out_size);

/* Creates a grid from a snapshot. Ids name the same meshes, meshes inserted later get the same ids as they would in the
 * saved grid, and steps find the same contacts and events in the same order, with the same hash and epoch. There are no
 * contacts until the first step. The meshes own their positions; to move them, bind others.
 * Of `desc` only allocator, log, tasks, worker_count, both budgets, margin and reference are used; null: the defaults.
 * If reference is null, the engine is the one that was saved. The caller owns *out_grid and releases it with
 * vox_grid_destroy. The bytes need not be trusted: everything in them is checked, no memory is reserved for a count
 * before the bytes it stands for are known to be there, and the byte budget applies.
 * Errors: FORMAT (names chunk and byte), UNSUPPORTED (of a later version), INVALID_ARGUMENT, LIMIT, BUDGET,
 * OUT_OF_MEMORY. */
VOX_API vox_result vox_grid_load(const void* bytes, uint64_t size, VOX_OPTIONAL const vox_grid_desc* desc,
                                 vox_grid** out_grid);

/* ---- memory and log --------------------------------------------------------------------------- */

/* An allocator. `allocate` returns memory of at least `size` bytes at `alignment` (a power of
 * two), or null; `release` gets the same size and alignment back. If both are null, the C++ runtime's heap is used.
 * They are called only from functions of the object they were given to, one call at a time. During a step, the calling
 * thread may be one that runs its tasks. For locators (vox_query.h) that are released after vox_grid_destroy, `release`
 * is called from vox_locator_release, so it must be usable until then. */
typedef struct vox_allocator {
    VOX_OPTIONAL void* (*allocate)(size_t size, size_t alignment, void* user);
    VOX_OPTIONAL void (*release)(void* memory, size_t size, size_t alignment, void* user);
    void* user;
} vox_allocator;

/* Severity of a log line. */
typedef enum vox_log_level {
    VOX_LOG_INFO = 0,
    VOX_LOG_WARNING = 1
} vox_log_level;

/* Receives one line of text (no newline), valid during the call only. A null `write` turns the log off. It is called
 * on the thread that called the library, and must not call the grid it came from. */
typedef struct vox_log {
    VOX_OPTIONAL void (*write)(vox_log_level level, const char* text, void* user);
    void* user;
} vox_log;

/* ---- threads ---------------------------------------------------------------------------------- */

/* Handles the items [begin, end). `worker` is below worker_count; calls that run at the same time have different
 * values of it. */
typedef void vox_task(uint64_t begin, uint64_t end, uint32_t worker, void* context);

/* The caller's scheduler, designed as in Box3D. `enqueue` splits the items [0, item_count) into ranges, of at
 * least min_range items where possible, and arranges that `task` is called once for each range, now or later, on any
 * thread. It returns a handle for `finish`, or null if all these calls have already returned. `finish` waits until
 * they have. Both are called on the thread that called the library, at most VOX_MAX_TASKS times in a step, at most
 * once by vox_grid_prepare_readings, and at most four times by vox_grid_update_locator.
 * If not every item was run exactly once, or a worker index was out of range or had by two calls at the same time, the
 * function fails with INVALID_ARGUMENT and leaves no contacts, no readings, or no new locator.
 * If both are null, the built-in scheduler is used. */
typedef struct vox_task_system {
    VOX_OPTIONAL void* (*enqueue)(vox_task* task, uint64_t item_count, uint64_t min_range, void* context, void* user);
    VOX_OPTIONAL void (*finish)(void* handle, void* user);
    void* user;
} vox_task_system;

#define VOX_MAX_TASKS 64u /* tasks enqueued in one step */

/* ---- measurements ----------------------------------------------------------------------------- */

/* A count, or a time in nanoseconds. */
typedef struct vox_counter {
    const char* name; /* static text, e.g. "candidates", or for a time "lookup_ns" */
    uint64_t value;
} vox_counter;

/* `count` counters. A library always has the same ones, in the same order. `data` lives until the next step, clear or
 * destroy of the grid. */
typedef struct vox_counter_view {
    const vox_counter* data;
    uint64_t count;
} vox_counter_view;

/* What the last successful step did, and how long each stage of it took: all 0 before the first. docs/engine.md lists
 * the names; what programs act on is in vox_grid_info. */
VOX_API vox_result vox_grid_get_counters(const vox_grid* grid, vox_counter_view* out_view);

#ifdef __cplusplus
}
#endif

#endif
