/* vox_dist: bodies that lie on many machines, or are cut into parts that do. A separate library over the public interface
 * of vox; the core does not need it, and it needs no message passing library: it talks through the callbacks of a
 * vox_transport. vox_mpi.h makes one of an MPI communicator; vox_transport_run makes some inside a process.
 *
 * Contacts are exact, and the same for any number of ranks and any partition (docs/distributed.md). Bodies, vertices and
 * tetrahedra have global numbers of 64 bits. A rank inserts parts: the tetrahedra of a body that lie there, and all
 * vertices that these name, its own and copies of those of other ranks. Each tetrahedron is on one rank. Each vertex is
 * owned by one rank; copies have the same position, bit for bit. vox_scene_check finds where this does not hold.
 *
 * The conventions of vox.h hold here too: vox_result, vox_last_error(), struct_size, untouched out-parameters on
 * failure.
 *
 *   Collective A function whose comment begins with "Collective" is called by all ranks, in the same order. It gives all
 *              ranks the same result: of several failures that of the lowest rank. There vox_last_error() has the
 *              reason; on the others it names that rank. After a failure the scene stays usable. A null scene is refused
 *              at once, on that rank alone, which others then wait for.
 *   Threads    One thread at a time may use a scene. Different scenes are independent, but for their transport.
 *   Machines   All ranks have the same order of bytes, and the same version of this library.
 */
#ifndef VOX_VOX_DIST_H
#define VOX_VOX_DIST_H

#include <vox/vox.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- transport -------------------------------------------------------------------------------- */

/* A message: `size` bytes. */
typedef struct vox_bytes {
    VOX_OPTIONAL const void* data;
    uint64_t size;
} vox_bytes;

/* How ranks talk. All ranks call the functions in the same order, each from the thread that called a collective function
 * of a scene. A failure of allgather or agree ends the collective function on that rank with its code; what happens on
 * others is up to the transport. After a failure of exchange, as for want of memory, the rank goes on with the calls that
 * the others make, so that none waits, and all ranks get its code; but not in the last exchange of a step, about boundaries.
 *   allgather  gives each rank the `bytes` bytes of every rank, at most 64, in the order of ranks.
 *   exchange   sends out[i] to the rank ranks[i] and sets in[i] to what that sent, for each i below count. The two ranks
 *              of each pair name each other; ranks ascend, and count may be 0. in[i] lives until the next call.
 *   agree      replaces each of the minima by its minimum over all ranks, and each of the sums by its sum. There are
 *              at most 8 of each. */
typedef struct vox_transport {
    uint32_t struct_size;
    uint32_t rank; /* below size */
    uint32_t size; /* ranks, at least 1 */
    uint32_t reserved; /* 0 */
    vox_result (*allgather)(const void* in, uint64_t bytes, void* out, void* user);
    vox_result (*exchange)(const uint32_t* ranks, uint32_t count, const vox_bytes* out, vox_bytes* in, void* user);
    vox_result (*agree)(uint64_t* minima, uint32_t minimum_count, uint64_t* sums, uint32_t sum_count, void* user);
    void* user;
} vox_transport;

static inline vox_transport vox_default_transport(void) {
    vox_transport transport = VOX_ZERO;
    transport.struct_size = (uint32_t)sizeof transport;
    transport.size = 1;
    return transport;
}

/* What one rank does, on a thread of its own. */
typedef void vox_rank_function(const vox_transport* transport, void* user);

/* Runs `function` for `size` ranks of this process, each on a thread of its own, and returns when all have returned.
 * At most `parallel` of them run at the same time, the others wait for their turn; 0: all. With 1, the ranks take turns
 * as if on one thread. The transport lives until the function returns. For tests and for learning: one vox_grid does
 * the same work faster. Errors: INVALID_ARGUMENT (size 0 or above 4096), OUT_OF_MEMORY (also if the system gives no
 * thread; then `function` was not called). */
VOX_EXPERIMENTAL vox_result vox_transport_run(uint32_t size, uint32_t parallel, vox_rank_function* function,
                                              VOX_OPTIONAL void* user);

/* ---- scene ------------------------------------------------------------------------------------ */

/* The parts of bodies that lie on this rank, and what they found in the last step. */
typedef struct vox_scene vox_scene;

/* Settings of a scene. */
typedef struct vox_scene_desc {
    uint32_t struct_size;
    uint32_t reserved; /* 0 */
    /* Settings of the grid inside, read during create; null: the defaults without penetrations. Its allocator serves the
     * whole scene; its budget is for the grid. It must have no flags: depth, events and edge contacts of bodies that
     * are split are UNSUPPORTED, as is a margin. */
    VOX_OPTIONAL const vox_grid_desc* grid;
} vox_scene_desc;

static inline vox_scene_desc vox_default_scene_desc(void) {
    vox_scene_desc desc = VOX_ZERO;
    desc.struct_size = (uint32_t)sizeof desc;
    return desc;
}

/* Creates a scene without parts. desc null: all defaults; transport null: one rank. The transport is copied; what its
 * `user` names must live as long as the scene. Collective, unless the pointer out_scene is null. Errors:
 * INVALID_ARGUMENT, UNSUPPORTED (flags of the grid), OUT_OF_MEMORY, BUDGET. */
VOX_EXPERIMENTAL vox_result vox_scene_create(VOX_OPTIONAL const vox_scene_desc* desc,
                                             VOX_OPTIONAL const vox_transport* transport, vox_scene** out_scene);

/* Destroys a scene; not collective. Its views become invalid. Null does nothing. */
VOX_EXPERIMENTAL void vox_scene_destroy(VOX_OPTIONAL vox_scene* scene);

/* A part in the scene of its rank. 0 is no part. */
typedef uint32_t vox_part;

/* A part of a body. */
typedef struct vox_part_desc {
    uint32_t struct_size;
    uint32_t reserved; /* 0 */
    uint64_t body;     /* its number, the same on all ranks; a rank has one part of a body at most */
    /* Vertices and tetrahedra of the part, as in vox_mesh_insert; tetrahedra are copied in any case. The filter must be
     * the same for all parts of a body. Rings and rest distance of a filter are UNSUPPORTED. */
    const vox_mesh_desc* mesh;
    /* Global numbers of vertices and tetrahedra, all different; null: 0, 1, 2 and so on. They are copied. */
    VOX_OPTIONAL const uint64_t* vertex_ids;
    VOX_OPTIONAL const uint64_t* tet_ids;
    /* 1 for each vertex that this rank owns, 0 for copies; null: it owns all. Copied. */
    VOX_OPTIONAL const uint8_t* owned;
} vox_part_desc;

static inline vox_part_desc vox_default_part_desc(void) {
    vox_part_desc desc = VOX_ZERO;
    desc.struct_size = (uint32_t)sizeof desc;
    return desc;
}

/* Adds a part, which takes part from the next step on. Not collective. Errors: as vox_mesh_insert; INVALID_ARGUMENT (a
 * number that is there twice, a second part of a body, an owned that is not 0 or 1), UNSUPPORTED. */
VOX_EXPERIMENTAL vox_result vox_scene_insert(vox_scene* scene, const vox_part_desc* desc, vox_part* out_part);

/* Removes a part. Not collective. The contacts of the last step stay as they are until the next one. Errors:
 * INVALID_HANDLE. */
VOX_EXPERIMENTAL vox_result vox_scene_remove(vox_scene* scene, vox_part part);

/* As vox_mesh_bind_positions. Values written to the same memory between steps need no new call. Not collective.
 * Errors: INVALID_ARGUMENT. */
VOX_EXPERIMENTAL vox_result vox_scene_bind_positions(vox_scene* scene, vox_part part, const vox_positions* positions);

/* ---- step ------------------------------------------------------------------------------------- */

/* Collective. Finds all contacts of the positions as they are now, between all bodies of all ranks. On success the
 * previous contacts are replaced; on failure they are gone. Errors: as vox_grid_step (NON_FINITE and LIMIT name body,
 * vertex and rank), INVALID_STATE (a copy with another position than its owner's, seen where it matters to a contact;
 * ranks that call different functions), and those of the transport. */
VOX_EXPERIMENTAL vox_result vox_scene_step(vox_scene* scene);

/* Vertex `vertex` of body_a is in the closed tetrahedron `tet` of body_b: the contacts of one vox_grid of the whole, see
 * vox_contact, where the "lowest" tetrahedron is that of the lowest global number. */
typedef struct vox_scene_contact {
    uint64_t body_a;
    uint64_t vertex; /* global number */
    uint64_t body_b;
    uint64_t tet; /* global number */
    float barycentric[4];
    uint32_t index;    /* of the vertex (vox_scene_contacts) or the tetrahedron (vox_scene_incoming) in the part here */
    uint32_t rank;     /* of the other side: where the tetrahedron lies, or the vertex is owned */
    uint32_t interior; /* 1: the vertex is in the interior of the tetrahedron; 0: on its boundary */
    uint32_t reserved; /* 0 */
} vox_scene_contact;

/* `count` contacts, `byte_stride` apart, sorted by (body_a, vertex, body_b, tet). */
typedef struct vox_scene_contact_view {
    const vox_scene_contact* data;
    size_t byte_stride;
    uint64_t count;
} vox_scene_contact_view;

/* The contacts of the vertices that this rank owns, as the last step found them; none before the first and after a
 * failed one. The view lives until the next step. */
VOX_EXPERIMENTAL vox_result vox_scene_contacts(const vox_scene* scene, vox_scene_contact_view* out_view);

/* The contacts in the tetrahedra that lie on this rank: the same contacts, seen from the other side. The view
 * lives until the next step. */
VOX_EXPERIMENTAL vox_result vox_scene_incoming(const vox_scene* scene, vox_scene_contact_view* out_view);

/* From which side of the contacts to which vox_scene_send sends. */
typedef enum vox_direction {
    VOX_DIRECTION_TO_TETS = 0,     /* from vox_scene_contacts to vox_scene_incoming */
    VOX_DIRECTION_TO_VERTICES = 1  /* back */
} vox_direction;

/* Collective. Sends one item a contact from one side to the other, e.g. a force, or a value to interpolate: in[i] belongs
 * to the i-th contact of the view it comes from, and arrives as out[j], where the j-th of the other view is the same
 * contact. item_bytes, 1 to 65536, and direction are the same on all ranks. Errors: INVALID_ARGUMENT, OUT_OF_MEMORY;
 * then out may be written in part. */
VOX_EXPERIMENTAL vox_result vox_scene_send(vox_scene* scene, vox_direction direction, uint64_t item_bytes,
                                           VOX_OPTIONAL const void* in, VOX_OPTIONAL void* out);

/* Collective. A hash of all contacts of all ranks: the same on all ranks, and for any number of them and any partition. It
 * covers all fields of a vox_scene_contact that do not depend on the partition. */
VOX_EXPERIMENTAL vox_result vox_scene_hash(vox_scene* scene, uint64_t out_hash[2]);

/* The same hash for the contacts of one grid of whole bodies: the user_data of each mesh is its body's number, and indices
 * are the global numbers. Not collective. Errors: INVALID_HANDLE (a mesh of a contact was removed). */
VOX_EXPERIMENTAL vox_result vox_scene_hash_of_grid(const vox_grid* grid, uint64_t out_hash[2]);

/* ---- points ----------------------------------------------------------------------------------- */

#define VOX_NO_RANK 0xffffffffu /* vox_scene_point.rank of a point in no tetrahedron */

/* Where a point is. Of the bodies that contain it this names that with the lowest number; of its tetrahedra the lowest
 * that has the point in its interior or, if there is none, the lowest that has it on its boundary: one for each point,
 * the same for any partition. Exact. */
typedef struct vox_scene_point {
    uint64_t body;
    uint64_t tet;         /* global number */
    float barycentric[4]; /* as in vox_contact */
    uint32_t rank;        /* where the tetrahedron lies; VOX_NO_RANK: in none, and the other fields are 0 */
    uint32_t interior;    /* 1 or, on the boundary of the tetrahedron, 0 */
} vox_scene_point;

/* Collective. Finds the tetrahedra that contain points of this rank, at most 2^31 - 1: out_points[i] is for point i.
 * Other ranks ask for their own. Contacts stay. It keeps a second grid of the parts, made by the first call.
 * Errors: as vox_scene_step; the points are named by their index. */
VOX_EXPERIMENTAL vox_result vox_scene_locate(vox_scene* scene, const vox_positions* points,
                                             VOX_OPTIONAL vox_scene_point* out_points);

/* ---- checks and measurements ------------------------------------------------------------------ */

/* Collective. Checks that each vertex has one owner, that its copies have the owner's position bit for bit, and that each
 * tetrahedron is on one rank. Sends every number and position once: for debugging, not for each step. Errors:
 * INVALID_STATE (names body, vertex or tetrahedron, and ranks), NON_FINITE, LIMIT, OUT_OF_MEMORY. */
VOX_EXPERIMENTAL vox_result vox_scene_check(vox_scene* scene);

/* What a part costs, as a weight for a partitioner. */
typedef struct vox_part_cost {
    uint64_t body;
    vox_part part;
    uint32_t reserved;  /* 0 */
    double predicted_ns; /* of a step: the part's share of what the fast engine's cost model predicts for this rank */
} vox_part_cost;

/* Copies the costs of the first `capacity` parts, in the order of bodies, for positions as they are now and the vertices
 * that the last step received. *out_count is how many parts there are. Not collective. `costs` may be null if capacity
 * is 0. Errors: INVALID_STATE (no positions), NON_FINITE, LIMIT, OUT_OF_MEMORY. */
VOX_EXPERIMENTAL vox_result vox_scene_costs(const vox_scene* scene, vox_part_cost* costs, uint64_t capacity,
                                            uint64_t* out_count);

/* What the last step, or vox_scene_locate since, sent from this rank. */
typedef struct vox_scene_counters {
    uint32_t struct_size;
    uint32_t neighbours;        /* ranks whose boxes meet those of this one; not where both have one and the same
                                   body alone, which does not collide with itself */
    uint64_t messages;          /* at most three a neighbour, and one more where a vertex is on a boundary
                                   of a body that has tetrahedra on several ranks */
    uint64_t collectives;       /* 2 */
    uint64_t replicated_bytes;  /* sent by each rank to all: 64 */
    uint64_t box_bytes;         /* of the finer boxes sent to neighbours */
    uint64_t vertex_bytes;
    uint64_t hit_bytes;
    uint64_t vertices_sent;     /* a vertex sent to two ranks counts twice */
    uint64_t vertices_received;
    uint64_t vertices_here;     /* part of those received: copies of them are here in any case */
    uint64_t hits_sent;         /* contacts, before the rule over all ranks */
    uint64_t contacts;          /* of the vertices owned here */
    uint64_t incoming;          /* in the tetrahedra here */
} vox_scene_counters;

/* Writes the fields that out_counters->struct_size covers (set it first). */
VOX_EXPERIMENTAL vox_result vox_scene_get_counters(const vox_scene* scene, vox_scene_counters* out_counters);

#ifdef __cplusplus
}
#endif

#endif
