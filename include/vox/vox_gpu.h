/* vox_gpu: contacts from positions that lie on a GPU, of many scenes at once. vox_cuda is the library for NVIDIA's GPUs
 * (a driver of version 580 or newer). vox_gpu_host has the same functions, gives the same bits and runs on the processor:
 * there device memory is the program's own, and streams are ignored.
 *
 * Contacts, their order, interiors and weights are as vox_grid_step finds them, bit for bit. Meshes have positions in
 * single precision, no transform, no self_rings and no self_rest_distance. Rigid shapes are left out.
 *
 * Everything that this header declares is experimental. Conventions: as in vox.h, and
 *   Threads    One thread at a time may use a vox_gpu, even to read it.
 *   Streams    `stream` is a cudaStream_t as a pointer; null is the default stream. Steps of one vox_gpu run one after
 *              the other: in one stream, or in several that wait for each other.
 */
#ifndef VOX_VOX_GPU_H
#define VOX_VOX_GPU_H

#include <vox/vox.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Scenes on a device, and their contacts. */
typedef struct vox_gpu vox_gpu;

/* Settings; all 0 by default. */
typedef struct vox_gpu_desc {
    uint32_t struct_size;
    uint32_t device;           /* the number of the GPU, as CUDA counts them */
    uint64_t byte_budget;      /* most bytes of device memory; 0: 4 GiB; UINT64_MAX: no limit */
    uint64_t contact_capacity; /* of all scenes; 0: half as many as vertices. vox_gpu_finish raises it */
    double cell_size;          /* edge length of a cell; 0: the library chooses one for each scene. Never changes results */
} vox_gpu_desc;

static inline vox_gpu_desc vox_default_gpu_desc(void) {
    vox_gpu_desc desc = VOX_ZERO;
    desc.struct_size = (uint32_t)sizeof desc;
    return desc;
}

/* Reads the meshes of `count` grids: tetrahedra, filters and, for tiles and cells, the positions that they have now. Grid
 * i is scene i; bodies of different scenes never collide. Grids are not needed afterwards, and later changes of them are
 * not seen. Nor are pairs that vox_grid_set_pair_enabled disabled, for which filters do, and vertices that
 * vox_mesh_remove_vertices removed, which still have contacts. The caller owns *out_gpu and releases it with
 * vox_gpu_destroy.
 * Errors: UNSUPPORTED (what a mesh has, or no GPU), INVALID_STATE (a mesh without positions), LIMIT, BUDGET,
 * OUT_OF_MEMORY. */
VOX_EXPERIMENTAL vox_result vox_gpu_create(VOX_OPTIONAL const vox_gpu_desc* desc, const vox_grid* const* grids,
                                           uint64_t count, vox_gpu** out_gpu);

/* Destroys scenes and their results. No step may be running. Null does nothing. */
VOX_EXPERIMENTAL void vox_gpu_destroy(VOX_OPTIONAL vox_gpu* gpu);

/* Borrows positions on the device, one for each vertex: scene by scene, mesh by mesh in ascending order. Steps read them.
 * Packed ones are read in place, others are copied in each step.
 * Errors: INVALID_ARGUMENT (another count), UNSUPPORTED (doubles; columns); BUDGET, OUT_OF_MEMORY (the copy). */
VOX_EXPERIMENTAL vox_result vox_gpu_bind_positions(vox_gpu* gpu, const vox_positions* positions);

/* Enqueues a step: finds all contacts of the positions as they are when the stream comes to it. Never waits, allocates
 * nothing, and may be captured into a CUDA graph, which stays good until positions are bound or vox_gpu_finish fails.
 * Errors: INVALID_STATE (no positions were bound), INTERNAL (CUDA's text). */
VOX_EXPERIMENTAL vox_result vox_gpu_step(vox_gpu* gpu, VOX_OPTIONAL void* stream);

/* Why a step has no contacts. */
typedef enum vox_gpu_fault {
    VOX_GPU_FAULT_POINTS = 1,    /* too many vertices near other bodies, over all levels of cells */
    VOX_GPU_FAULT_FINDINGS = 2,  /* too many vertices near tetrahedra */
    VOX_GPU_FAULT_CONTACTS = 4,  /* more contacts than contact_capacity */
    VOX_GPU_FAULT_NON_FINITE = 8 /* a position is NaN or infinite */
} vox_gpu_fault;

/* What a step did, on the device. */
typedef struct vox_gpu_status {
    uint32_t contact_count; /* 0 with any fault: nothing is left out unseen */
    uint32_t faults;        /* vox_gpu_fault, combined with | */
    uint32_t needed_points;
    uint32_t needed_findings;
    uint32_t needed_contacts;
    uint32_t non_finite_vertex; /* the first one, counted over all meshes; VOX_NONE: all are finite */
    uint32_t near_vertices;     /* in a cell with another body */
    uint32_t exact_tests;       /* decided by integers */
    uint32_t rough_weights;     /* contacts in tetrahedra so flat that weights may be off by more than a rounding */
    uint32_t levels;            /* sizes of cells in use, as bits */
} vox_gpu_status;

/* Where the results of steps are, on the device. Scene i has contacts [scene_offsets[i], scene_offsets[i + 1]), in the
 * order of vox_contact_view. */
typedef struct vox_gpu_view {
    const vox_contact* contacts;
    const uint8_t* interiors;      /* as in vox_contact_view */
    const float* weights;          /* four barycentric coordinates a contact */
    const uint32_t* scene_offsets; /* one more than scenes */
    const vox_gpu_status* status;
    uint64_t contact_capacity;
} vox_gpu_view;

/* Gets where results are. Each step writes them anew; the arrays stay in place and live until vox_gpu_finish
 * fails or the vox_gpu is destroyed. */
VOX_EXPERIMENTAL vox_result vox_gpu_get_view(vox_gpu* gpu, vox_gpu_view* out_view);

/* Waits for the last step, and copies its status. If a list was too short, raises its capacity and fails with LIMIT:
 * step again.
 * Errors: LIMIT, NON_FINITE (names body and vertex), BUDGET, OUT_OF_MEMORY, INTERNAL (CUDA's text). */
VOX_EXPERIMENTAL vox_result vox_gpu_finish(vox_gpu* gpu, VOX_OPTIONAL vox_gpu_status* out_status);

#ifdef __cplusplus
}
#endif

#endif
