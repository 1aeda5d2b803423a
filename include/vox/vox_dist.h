/* vox_dist: contacts of bodies that are distributed over many machines, whole or in parts. A library of its own. It
 * talks through callbacks; vox_mpi.h provides them for MPI.
 *
 * Contacts are exact, and the same for any number of ranks and any partition (docs/distributed.md). Bodies, vertices
 * and tetrahedra have global 64-bit numbers. Each tetrahedron lies on one rank, with all vertices that it names. Each
 * vertex is owned by one rank; other ranks may have copies with the same position, bit for bit. vox_dist_scene_check
 * checks this.
 *
 * Everything that this header declares is experimental. Conventions: as in vox.h, and
 *   Collective  All ranks call such a function, in the same order, and get the same result: of several failures the
 *               failure of the lowest rank. There vox_last_error() has the reason; elsewhere it names that rank. A
 *               scene stays usable after a failure. What keeps a rank from talking (a null scene or out_scene, a bad
 *               transport) is refused on that rank alone, and the others wait for it.
 *   Threads     One thread at a time may use a scene, even to read it. Scenes with different transports are
 *               independent.
 *   Machines    All ranks have the same byte order and the same version of this library.
 */
#ifndef VOX_VOX_DIST_H
#define VOX_VOX_DIST_H

#include <vox/vox_query.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- transport -------------------------------------------------------------------------------- */

/* A message. */
typedef struct vox_dist_message {
    VOX_OPTIONAL const void* data;
    uint64_t size;
} vox_dist_message;

/* How ranks talk. All ranks call these functions in the same order, on the thread that called a collective function.
 * Zero the struct, then set struct_size, rank, size and, for more than one rank, the functions.
 *   allgather  gives every rank the `bytes` bytes of each rank, at most 64, in the order of ranks.
 *   exchange   sends out[i] to rank ranks[i], and sets in[i] to what that rank sent to this one, which lives until the
 *              next call. Two ranks that exchange messages name each other. Ranks ascend; count may be 0.
 *   agree      replaces each of the minima by its minimum over all ranks, and each of the sums by its sum; at most 8
 *              each.
 * If one fails, so does the collective function. After a failed exchange the rank goes on with the calls that the
 * others make, so that none of them waits and all get its result. Only the last exchange of a step, which is about
 * boundaries, may fail on one rank alone. After a failed allgather or agree it stops at once. */
typedef struct vox_dist_transport {
    uint32_t struct_size;
    uint32_t rank;     /* below size */
    uint32_t size;     /* ranks */
    uint32_t reserved; /* 0 */
    vox_result (*allgather)(const void* in, uint64_t bytes, void* out, void* user);
    vox_result (*exchange)(const uint32_t* ranks, uint32_t count, const vox_dist_message* out, vox_dist_message* in,
                           void* user);
    vox_result (*agree)(uint64_t* minima, uint32_t minimum_count, uint64_t* sums, uint32_t sum_count, void* user);
    void* user;
} vox_dist_transport;

/* ---- scene ------------------------------------------------------------------------------------ */

/* The parts of bodies that lie on this rank, and their contacts. */
typedef struct vox_dist_scene vox_dist_scene;

/* Collective. Creates a scene. `grid` has the settings of the grid inside; null: no flags, the default of the rest.
 * Flags and a margin are UNSUPPORTED. Its allocator serves the whole scene, its budget
 * is for the grid alone. The transport is copied, and what its `user` names must outlive the scene; null: one rank. The
 * caller owns *out_scene and releases it with vox_dist_scene_destroy.
 * Errors: INVALID_ARGUMENT, UNSUPPORTED, OUT_OF_MEMORY, BUDGET. */
VOX_EXPERIMENTAL vox_result vox_dist_scene_create(VOX_OPTIONAL const vox_grid_desc* grid,
                                                  VOX_OPTIONAL const vox_dist_transport* transport,
                                                  vox_dist_scene** out_scene);

/* Destroys a scene; not collective. Null does nothing. */
VOX_EXPERIMENTAL void vox_dist_scene_destroy(VOX_OPTIONAL vox_dist_scene* scene);

/* A part of a body. */
typedef struct vox_dist_part_desc {
    uint32_t struct_size;
    uint32_t reserved;         /* 0 */
    uint64_t body;             /* a rank has one part of a body at most */
    const vox_mesh_desc* mesh; /* as for vox_mesh_insert, but its tetrahedra are always copied; the parts of a body have
                                  the same filter, without rings and rest distance */
    VOX_OPTIONAL const uint64_t* vertex_ids; /* the global number of each vertex, copied; null: 0, 1, 2, ... */
    VOX_OPTIONAL const uint64_t* tet_ids;    /* the global number of each tetrahedron, copied; null: 0, 1, 2, ... */
    VOX_OPTIONAL const uint8_t* owned;       /* 1 for each vertex that this rank owns, else 0; copied; null: owns all */
} vox_dist_part_desc;

static inline vox_dist_part_desc vox_default_dist_part_desc(void) {
    vox_dist_part_desc desc = VOX_ZERO;
    desc.struct_size = (uint32_t)sizeof desc;
    return desc;
}

/* Adds the part of a body that lies here, for the next steps. Not collective.
 * Errors: as vox_mesh_insert; INVALID_ARGUMENT (a number that occurs twice, a second part of a body, an `owned` that is
 * not 0 or 1), UNSUPPORTED (rings or a rest distance). */
VOX_EXPERIMENTAL vox_result vox_dist_scene_insert(vox_dist_scene* scene, const vox_dist_part_desc* desc);

/* Removes the part of a body that lies here. Not collective. The contacts of the last step stay until the next one.
 * Errors: INVALID_HANDLE (there is none). */
VOX_EXPERIMENTAL vox_result vox_dist_scene_remove(vox_dist_scene* scene, uint64_t body);

/* Makes the part of a body that lies here borrow other positions, as vox_mesh_bind_positions does. Not collective.
 * Errors: INVALID_HANDLE (there is no part of the body here), INVALID_ARGUMENT. */
VOX_EXPERIMENTAL vox_result vox_dist_scene_bind_positions(vox_dist_scene* scene, uint64_t body,
                                                          const vox_positions* positions);

/* ---- step ------------------------------------------------------------------------------------- */

/* Collective. Finds all contacts between all bodies of all ranks, as they are now. After an error there are none.
 * Errors: as vox_grid_step (the text names body and vertex); INVALID_STATE (a copy whose position differs from its
 * owner's, where that was noticed; ranks that call different functions); errors of the transport. */
VOX_EXPERIMENTAL vox_result vox_dist_scene_step(vox_dist_scene* scene);

/* A contact, as one vox_grid with all bodies would find it: see vox_contact. The lowest tetrahedron is that with the
 * lowest global number. */
typedef struct vox_dist_contact {
    uint64_t body_a;
    uint64_t vertex; /* global number */
    uint64_t body_b;
    uint64_t tet; /* global number */
    double weights[4]; /* barycentric weights of the vertex in the tetrahedron */
    uint32_t index;    /* of the vertex or the tetrahedron, in the part that lies here */
    uint32_t rank;     /* where the other side of the contact is */
    uint32_t interior; /* 1 if the vertex is in the interior of the tetrahedron, 0 if on its boundary */
    uint32_t reserved; /* 0 */
} vox_dist_contact;

/* Contacts, sorted by (body_a, vertex, body_b, tet). They live until the next step. */
typedef struct vox_dist_contact_view {
    const vox_dist_contact* data;
    uint64_t count;
} vox_dist_contact_view;

/* The two sides of contacts. */
typedef enum vox_dist_side {
    VOX_DIST_VERTICES = 0, /* contacts of the vertices that this rank owns */
    VOX_DIST_TETS = 1      /* contacts with the tetrahedra that lie on this rank */
} vox_dist_side;

/* Gets the contacts of one side, as the last step found them. Errors: INVALID_ARGUMENT (another side). */
VOX_EXPERIMENTAL vox_result vox_dist_scene_get_contacts(const vox_dist_scene* scene, vox_dist_side side,
                                                        vox_dist_contact_view* out_view);

/* Collective. Sends one item per contact from one side to the other, e.g. forces. Item i of `in` belongs to contact i
 * of the side `from`. It arrives as item j of `out`, where contact j of the other side is the same contact.
 * item_bytes is from 1 to 65536; it and `from` are the same on all ranks. `in` and `out` may be null on a rank without
 * contacts of that side. Errors: INVALID_ARGUMENT, OUT_OF_MEMORY; then `out` may be written in part. */
VOX_EXPERIMENTAL vox_result vox_dist_scene_send(vox_dist_scene* scene, vox_dist_side from, uint64_t item_bytes,
                                                VOX_OPTIONAL const void* in, VOX_OPTIONAL void* out);

/* Collective. Gets a hash of all contacts, which is the same for any number of ranks and any partition. It covers all
 * fields but `index` and `rank`. */
VOX_EXPERIMENTAL vox_result vox_dist_scene_get_hash(vox_dist_scene* scene, uint64_t out_hash[2]);

/* ---- points ----------------------------------------------------------------------------------- */

/* Where a point is: what vox_location says of it, by the same rules, if all bodies of all ranks are in one locator, in
 * the order of their numbers, with all numbers in place of indices. */
typedef struct vox_dist_location {
    uint64_t body;
    uint64_t tet; /* global number */
    vox_location_state state;
    uint32_t rank;     /* where the tetrahedron lies; VOX_NONE if the state is VOX_LOCATION_NONE, where all other fields
                          are 0 */
    double weights[4]; /* of the tetrahedron's corners, for the point or the closest point, as in vox_location */
    double distance;   /* to the closest point; 0 inside */
} vox_dist_location;

/* Collective. Locates points of this rank, at most 2^31 - 1: out_locations[i] is for point i. The answers are the same
 * for any partition, bit for bit. Points outside all bodies take three more rounds of messages, with all ranks that may
 * have the closest surface. Contacts stay. The first call makes a second grid of the parts; the first with points outside
 * finds their facets.
 * Errors: as vox_dist_scene_step, where the text names a point by its index; then out_locations may be written in
 * part. */
VOX_EXPERIMENTAL vox_result vox_dist_scene_locate(vox_dist_scene* scene, const vox_positions* points,
                                                  vox_dist_location* out_locations);

/* ---- checks and measurements ------------------------------------------------------------------ */

/* Collective. Checks that owners, copies and numbers are consistent, by sending all of them once: for debugging.
 * Errors: INVALID_STATE (names body, vertex or tetrahedron, and ranks), NON_FINITE, LIMIT, OUT_OF_MEMORY. */
VOX_EXPERIMENTAL vox_result vox_dist_scene_check(vox_dist_scene* scene);

/* The cost of a part, for partitioners. */
typedef struct vox_dist_cost {
    uint64_t body;
    double seconds; /* its share of a step of this rank, predicted by the cost model of the fast engine */
} vox_dist_cost;

/* Gets the costs of the first `capacity` parts of this rank, in the order of bodies. *out_count is the number of all.
 * Not collective. Errors: INVALID_STATE (no positions), NON_FINITE, LIMIT, OUT_OF_MEMORY. */
VOX_EXPERIMENTAL vox_result vox_dist_scene_get_costs(const vox_dist_scene* scene, vox_dist_cost* costs,
                                                     uint64_t capacity, uint64_t* out_count);

/* Gets what the last step, or vox_dist_scene_locate since, sent from this rank (docs/distributed.md lists the names).
 * The view lives until the next call that changes the scene. */
VOX_EXPERIMENTAL vox_result vox_dist_scene_get_counters(const vox_dist_scene* scene, vox_counter_view* out_view);

#ifdef __cplusplus
}
#endif

#endif
