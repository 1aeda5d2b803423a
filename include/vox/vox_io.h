/* vox_io: mesh files and ready-made bodies for vox. A library of its own; the core does not need it.
 *
 * The conventions of vox.h hold here too: vox_result, vox_last_error(), struct_size, untouched
 * out-parameters on failure. Positions are double and numbered as in the file.
 *
 * Threads: no function keeps state between calls; different meshes are independent, one mesh may be
 * read by many threads at once.
 */
#ifndef VOX_VOX_IO_H
#define VOX_VOX_IO_H

#include <vox/vox.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- loading ---------------------------------------------------------------------------------- */

typedef enum vox_io_format {
    VOX_IO_FORMAT_AUTO = 0,    /* told by content first, then by the name's extension */
    VOX_IO_FORMAT_GMSH = 1,    /* .msh 1, 2.2, 4.0, 4.1; ASCII and binary */
    VOX_IO_FORMAT_TETGEN = 2,  /* .node with .ele */
    VOX_IO_FORMAT_MEDIT = 3,   /* .mesh, ASCII */
    VOX_IO_FORMAT_VEGA = 4,    /* .veg */
    VOX_IO_FORMAT_VTK = 5,     /* legacy .vtk, 2.0 to 5.1; ASCII and binary */
    VOX_IO_FORMAT_VTU = 6,     /* XML .vtu: ASCII, base64, appended; raw or zlib */
    VOX_IO_FORMAT_SURFACE = 7, /* whatever assimp reads: triangles, no tets */
    VOX_IO_FORMAT_FORCE_32_BITS = 0x7fffffff
} vox_io_format;

typedef struct vox_io_load_desc {
    uint32_t struct_size;
    vox_io_format format;
    /* Scene files with several meshes: index of the one to take, or VOX_IO_ALL_MESHES to join them. */
    uint32_t mesh_index;
    uint32_t reserved; /* 0 */
} vox_io_load_desc;

#define VOX_IO_ALL_MESHES 0xffffffffu

/* Fills `desc` with the defaults (AUTO, all meshes) for the fields that `struct_size` covers. */
VOX_API vox_result vox_io_load_desc_init(vox_io_load_desc* desc, uint32_t struct_size);

/* One file in memory. `name` gives the extension and the words of error texts; may be null. */
typedef struct vox_io_source {
    const char* name;
    const void* data;
    size_t size;
} vox_io_source;

/* A mesh in memory, owned by vox_io. Immutable. */
typedef struct vox_io_mesh vox_io_mesh;

/* Reads the file at `path` (for TetGen: either file of the pair; the other lies beside it). desc null:
 * defaults. The caller owns *out_mesh and ends it with vox_io_mesh_destroy.
 * Errors: FILE, FORMAT (text names the file, the line or byte, and what was expected there),
 * UNSUPPORTED, OUT_OF_MEMORY, INVALID_ARGUMENT. */
VOX_API vox_result vox_io_load(const char* path, const vox_io_load_desc* desc, vox_io_mesh** out_mesh);

/* The same from memory. `sources` holds one file; for TetGen two, .node and .ele in any order. */
VOX_API vox_result vox_io_read(const vox_io_source* sources, size_t source_count,
                               const vox_io_load_desc* desc, vox_io_mesh** out_mesh);

/* Ends a mesh. Null does nothing. */
VOX_API void vox_io_mesh_destroy(vox_io_mesh* mesh);

/* Arrays of a mesh; they live until vox_io_mesh_destroy. Indices count from 0. */
typedef struct vox_io_mesh_view {
    const double* positions;   /* 3 * vertex_count */
    uint64_t vertex_count;
    const uint32_t* tets;      /* 4 * tet_count, corners in the file's order */
    uint64_t tet_count;
    const uint32_t* triangles; /* 3 * triangle_count: triangles of the file (for a surface: all of it) */
    uint64_t triangle_count;
} vox_io_mesh_view;

VOX_API vox_result vox_io_mesh_get(const vox_io_mesh* mesh, vox_io_mesh_view* out_view);

/* Makes a mesh from arrays (copied). Errors: INVALID_ARGUMENT, INVALID_MESH, NON_FINITE, OUT_OF_MEMORY. */
VOX_API vox_result vox_io_mesh_create(const vox_io_mesh_view* arrays, vox_io_mesh** out_mesh);

/* ---- diagnosis -------------------------------------------------------------------------------- */

/* What was read, what was left out, and what is odd about it. */
typedef struct vox_io_report {
    uint32_t struct_size;
    vox_io_format format;
    uint64_t vertices;
    uint64_t tets;
    uint64_t triangles;
    uint64_t skipped_elements;     /* of the file: neither tet nor triangle */
    uint64_t second_order_tets;    /* ten-node tets, of which the corners were taken */
    uint64_t inverted_tets;        /* of negative volume */
    uint64_t degenerate_tets;      /* of exactly zero volume */
    uint64_t duplicate_tets;       /* the same four vertices as an earlier tet */
    uint64_t duplicate_vertices;   /* at the position of an earlier vertex */
    uint64_t unused_vertices;      /* in no tet and no triangle */
    uint64_t boundary_facets;      /* facets of exactly one tet; for a surface: its triangles */
    uint64_t non_manifold_facets;  /* facets of more than two tets; for a surface: edges of not exactly two triangles */
    uint64_t components;           /* connected over shared vertices, unused ones not counted */
    double volume;                 /* sum of signed tet volumes; for a closed surface the enclosed volume */
    double bounds_min[3];
    double bounds_max[3];
} vox_io_report;

/* Writes the fields that out_report->struct_size covers (set it first). */
VOX_API vox_result vox_io_mesh_report(const vox_io_mesh* mesh, vox_io_report* out_report);

/* The report's oddities as text, one line each ("3 tets are inverted"); "" when there are none. Lives until
 * vox_io_mesh_destroy. Null for a null mesh. */
VOX_API const char* vox_io_mesh_warnings(const vox_io_mesh* mesh);

/* Name of a format, e.g. "Gmsh .msh". Static text; never null. */
VOX_API const char* vox_io_format_string(vox_io_format format);

/* ---- ready-made bodies ------------------------------------------------------------------------ */

/* A ball of `radius` around the origin, made of about `tet_count` tetrahedra: a cubic lattice cut in five
 * tetrahedra a cube, the cubes inside the ball kept, boundary vertices moved onto the sphere, interior ones
 * smoothed by three Laplace sweeps. All tets positive. The count is met within 1 % for 1000 tets and more. */
VOX_API vox_result vox_io_make_lattice_ball(uint64_t tet_count, double radius, vox_io_mesh** out_mesh);

#ifdef __cplusplus
}
#endif

#endif
