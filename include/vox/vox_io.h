/* vox_io: mesh files and ready-made bodies for vox. A library of its own; the core does not need it.
 *
 * The conventions of vox.h hold here too: vox_result, vox_last_error(), struct_size, untouched
 * out-parameters on failure. Positions are double and numbered as in the file; vertices of
 * surfaces are joined where their positions are equal, and numbered in order of first use.
 *
 * A tet file must hold a tet; what else is odd about it is told by the report and never stops a load.
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

#define VOX_IO_ALL_MESHES 0xffffffffu /* vox_io_load_desc.mesh_index: join them */

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
 * A regular file is mapped into memory while it is read and must not be shortened meanwhile.
 * Errors: FILE, FORMAT (text names the file, the line or byte, and what was expected there),
 * UNSUPPORTED, LIMIT, OUT_OF_MEMORY, INVALID_ARGUMENT. */
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

/* The mesh's arrays. */
VOX_API vox_result vox_io_mesh_get(const vox_io_mesh* mesh, vox_io_mesh_view* out_view);

/* Makes a mesh from arrays (copied). Errors: INVALID_ARGUMENT, INVALID_MESH, NON_FINITE, LIMIT (more than
 * VOX_MAX_VERTICES or VOX_MAX_TETS), OUT_OF_MEMORY. */
VOX_API vox_result vox_io_mesh_create(const vox_io_mesh_view* arrays, vox_io_mesh** out_mesh);

/* ---- diagnosis -------------------------------------------------------------------------------- */

/* What was read, what was left out, and what is odd about it. A "surface" is a mesh without tets. */
typedef struct vox_io_report {
    uint32_t struct_size;
    vox_io_format format;          /* AUTO for a mesh that was made, not read */
    uint64_t vertices;
    uint64_t tets;
    uint64_t triangles;
    uint64_t skipped_elements;     /* of the file: neither tet nor triangle */
    uint64_t second_order_tets;    /* tets of ten or more nodes, of which the corners were taken */
    uint64_t inverted_tets;        /* of negative volume, decided exactly */
    uint64_t degenerate_tets;      /* of exactly zero volume */
    uint64_t nearly_flat_tets;     /* six times the volume below 1e-9 times the longest edge cubed, but not zero */
    uint64_t duplicate_tets;       /* the same four vertices as an earlier tet */
    uint64_t degenerate_triangles; /* that name a vertex twice */
    uint64_t duplicate_vertices;   /* at the position of an earlier vertex */
    uint64_t unused_vertices;      /* in no tet and no triangle */
    uint64_t boundary_facets;      /* facets of exactly one tet; for a surface: its triangles */
    uint64_t non_manifold_facets;  /* facets of more than two tets; for a surface: edges of more than two triangles */
    uint64_t open_edges;           /* for a surface: edges of exactly one triangle; 0 when it is closed */
    uint64_t misoriented_edges;    /* for a surface: edges that two triangles run through in the same direction */
    uint64_t components;           /* connected over shared vertices, unused ones not counted */
    double volume;                 /* sum of the tets' volumes, inverted ones counted as positive; for a closed
                                    * surface the enclosed volume, negative when it is inside out; else 0 */
    double bounds_min[3];          /* of the vertices in use; of all where none is in use */
    double bounds_max[3];
    double unit_in_metres;         /* length of the file's unit; 0: the file does not say */
} vox_io_report;

/* Writes the fields that out_report->struct_size covers (set it first). */
VOX_API vox_result vox_io_mesh_report(const vox_io_mesh* mesh, vox_io_report* out_report);

/* The report's oddities as text, one line each ("3 tets are inverted"); "" when there are none. Lives until
 * vox_io_mesh_destroy. Cannot fail; null for a null mesh. */
VOX_API const char* vox_io_mesh_warnings(const vox_io_mesh* mesh);

/* Name of a format, e.g. "Gmsh .msh". Static text; never null. */
VOX_API const char* vox_io_format_string(vox_io_format format);

/* ---- surface to tetrahedra -------------------------------------------------------------------- */

typedef enum vox_io_solid_kind {
    /* Isosurface stuffing: the boundary follows the surface; dihedral angles between 10.7 and 164.8 degrees. */
    VOX_IO_SOLID_STUFFED = 0,
    /* Every lattice cube that the surface touches or encloses, whole, in five tets: the surface lies inside. For
     * rough surfaces, open ones too, that are to be carried along by the tets around them. */
    VOX_IO_SOLID_CUBES = 1,
    VOX_IO_SOLID_KIND_FORCE_32_BITS = 0x7fffffff
} vox_io_solid_kind;

typedef struct vox_io_tetrahedralize_desc {
    uint32_t struct_size;
    vox_io_solid_kind kind;
    double cell;       /* edge of a lattice cube, > 0; 0 (the default): a fiftieth of the surface's longest side */
    uint64_t max_tets; /* more fail with LIMIT; default 100000000 */
    /* STUFFED: largest Hausdorff distance to the surface, as vox_io_measure_quality tells it. Cells at the boundary
     * are halved until it is kept, those inside stay at `cell`; thin details may need many. 0 (the default): no
     * halving, and no promise. */
    double max_distance;
    /* STUFFED: how many times cells away from the boundary may be merged two by two by two; 0 (the default): all
     * tets are of one size. The boundary stays as it is. */
    uint32_t coarsen;
    uint32_t reserved; /* 0 */
    /* Called now and then, on the calling thread, with the share of the work done, ascending from 0 to 1. A result
     * other than 0 cancels. Null: nobody asks. */
    int32_t (*progress)(double fraction, void* user);
    void* progress_user;
} vox_io_tetrahedralize_desc;

/* Fills `desc` with the defaults for the fields that `struct_size` covers. */
VOX_API vox_result vox_io_tetrahedralize_desc_init(vox_io_tetrahedralize_desc* desc, uint32_t struct_size);

/* Fills the inside of a closed surface (the triangles of `surface`; its tets are not looked at) with tetrahedra.
 * desc null: defaults. All tets positive, no two overlap, inner facets shared by exactly two. The surface may have
 * any orientation, several parts, and intersect itself: inside is where its winding number is not zero, or, where
 * its triangles do not agree on an orientation, where rays cross it an odd number of times. Holes smaller than a
 * cell or so are closed. Details thinner than a cell may be lost, and edges are rounded by a fraction of one
 * (max_distance prevents it). The same input gives the same tets, bit for bit. Memory and time go with the cells
 * inside.
 * Errors: INVALID_ARGUMENT (no triangles, no volume, no tet fits in), NON_FINITE, INVALID_MESH (the surface is
 * open; not for CUBES), LIMIT (more than 4096 cells along an axis, more than max_tets), INVALID_STATE (cancelled),
 * OUT_OF_MEMORY. */
VOX_API vox_result vox_io_tetrahedralize(const vox_io_mesh* surface, const vox_io_tetrahedralize_desc* desc,
                                         vox_io_mesh** out_mesh);

/* How good a tet mesh is, and how near its boundary comes to a surface. */
typedef struct vox_io_quality {
    uint32_t struct_size;
    uint32_t reserved;
    uint64_t vertices;
    uint64_t tets;
    uint64_t boundary_facets;
    double min_dihedral; /* smallest and largest angle between two facets of a tet, in degrees; 0 without tets */
    double max_dihedral;
    double volume;            /* sum of the signed tet volumes */
    double surface_volume;    /* enclosed by the surface, by its orientation; 0 without one */
    /* Largest distance from sample points of the one to all of the other. Samples lie on every triangle at most
     * half a mean boundary edge apart, corners among them; the distances are exact. 0 without a surface. */
    double mesh_to_surface;
    double surface_to_mesh;
    double hausdorff; /* the larger of the two */
} vox_io_quality;

/* Measures `mesh`; `surface` (its triangles) may be null. Writes the fields that out_quality->struct_size covers
 * (set it first). Errors: INVALID_ARGUMENT, OUT_OF_MEMORY. */
VOX_API vox_result vox_io_measure_quality(const vox_io_mesh* mesh, const vox_io_mesh* surface,
                                          vox_io_quality* out_quality);

/* ---- writing ---------------------------------------------------------------------------------- */

typedef enum vox_io_write_format {
    VOX_IO_WRITE_AUTO = 0,   /* told by the name's extension: .msh is MSH_41, .vtu is VTU */
    VOX_IO_WRITE_MSH_22 = 1, /* Gmsh .msh 2.2 */
    VOX_IO_WRITE_MSH_41 = 2, /* Gmsh .msh 4.1 */
    VOX_IO_WRITE_VTU = 3,    /* VTK XML, for ParaView */
    VOX_IO_WRITE_FORMAT_FORCE_32_BITS = 0x7fffffff
} vox_io_write_format;

/* Numbers that belong to the vertices, e.g. contacts or penetration depths. */
typedef struct vox_io_point_data {
    const char* name;     /* not empty, without control characters and double quotes */
    const double* values; /* components * vertex_count, finite */
    uint32_t components;  /* 1 (scalars), 3 (vectors) or 9 (tensors) */
    uint32_t reserved;    /* 0 */
} vox_io_point_data;

typedef struct vox_io_write_desc {
    uint32_t struct_size;
    vox_io_write_format format;
    uint32_t binary;   /* 0: text that reads back to the same doubles; 1: binary, in this machine's byte order */
    uint32_t reserved; /* 0 */
    const vox_io_point_data* point_data; /* point_data_count of them; read during the call */
    uint64_t point_data_count;
} vox_io_write_desc;

/* Fills `desc` with the defaults (AUTO, text, no point data) for the fields that `struct_size` covers. */
VOX_API vox_result vox_io_write_desc_init(vox_io_write_desc* desc, uint32_t struct_size);

/* Writes vertices, triangles and tets, in the mesh's order. desc null: defaults. A file that exists at `path`
 * is replaced at the end, and only if all went well.
 * Errors: FILE, INVALID_ARGUMENT (names the field), NON_FINITE, UNSUPPORTED (the extension), LIMIT (more
 * elements than .msh 2.2 can number), OUT_OF_MEMORY. */
VOX_API vox_result vox_io_write(const vox_io_mesh* mesh, const char* path, const vox_io_write_desc* desc);

/* Receives `size` bytes of a file, in order, on the thread that writes; 0 on success, anything else ends the
 * writing. */
typedef struct vox_io_sink {
    int32_t (*write)(const void* data, size_t size, void* user);
    void* user;
} vox_io_sink;

/* As vox_io_write, into memory or anywhere else. desc->format must not be AUTO. Errors: those, and FILE for a sink
 * that fails; what it has received by then is of no use. */
VOX_API vox_result vox_io_write_to(const vox_io_mesh* mesh, const vox_io_write_desc* desc, const vox_io_sink* sink);

/* ---- ready-made bodies ------------------------------------------------------------------------ */

/* All bodies lie around the origin and have positive tets only. Lengths must be finite and above 0.
 * Errors: INVALID_ARGUMENT (names the number), LIMIT, OUT_OF_MEMORY. */

/* A ball of `radius` around the origin, made of about `tet_count` tetrahedra: a cubic lattice cut in five
 * tetrahedra a cube, the cubes inside the ball kept, boundary vertices moved onto the sphere, interior ones
 * smoothed by three Laplace sweeps. The count is met within 1 % for 1000 tets and more. */
VOX_API vox_result vox_io_make_lattice_ball(uint64_t tet_count, double radius, vox_io_mesh** out_mesh);

/* Bodies by isosurface stuffing on a lattice of cubes with edge `cell`, with the angles of
 * vox_io_tetrahedralize. The rims of a cylinder are rounded by a fraction of a cell. */
VOX_API vox_result vox_io_make_ball(double radius, double cell, vox_io_mesh** out_mesh);
/* Around the z axis; `radius` reaches the middle of the tube, tube_radius < radius. */
VOX_API vox_result vox_io_make_torus(double radius, double tube_radius, double cell, vox_io_mesh** out_mesh);
/* Along the z axis; `length` lies between the middles of the two round ends. */
VOX_API vox_result vox_io_make_capsule(double radius, double length, double cell, vox_io_mesh** out_mesh);
/* Along the z axis. */
VOX_API vox_result vox_io_make_cylinder(double radius, double length, double cell, vox_io_mesh** out_mesh);

/* A box, exactly: cubes of about `cell`, stretched so that a whole number of them fits each side, five tets each.
 * A bar is a long box. */
VOX_API vox_result vox_io_make_box(double size_x, double size_y, double size_z, double cell,
                                   vox_io_mesh** out_mesh);

#ifdef __cplusplus
}
#endif

#endif
