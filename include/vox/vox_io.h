/* vox_io: mesh files and ready-made bodies for vox. A separate library; the core does not need it.
 *
 * The conventions of vox.h hold here too: vox_result, vox_last_error(), struct_size, untouched
 * out-parameters on failure. Positions are double and in the file's order. In a file with tets, vertices that belong
 * to no tet are left out: geometry points, nodes on edges of ten-node tets, corners of elements that are skipped. So
 * are tets of ten or more nodes whose corners lie in one plane. The
 * vertices of a surface are merged if their positions are equal, and numbered in order of first use. The caller owns
 * every mesh that a function here creates and releases it with vox_io_mesh_destroy.
 *
 * CMake: find_package(vox COMPONENTS io), then link vox::io, which brings vox::vox with it. pkg-config: vox_io.
 *
 * Paths and names are UTF-8 on every system, Windows included. Other systems take any bytes as a path.
 *
 * A tet file must contain a tet. Anything else that is odd about it is listed in the report and never stops a load.
 *
 * Threads: no function keeps state between calls. Different meshes are independent, and one mesh may be
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
    VOX_IO_FORMAT_AUTO = 0,    /* determined from the content or, failing that, from the name's extension */
    VOX_IO_FORMAT_GMSH = 1,    /* .msh 1, 2.2, 4.0, 4.1; ASCII and binary */
    VOX_IO_FORMAT_TETGEN = 2,  /* .node with .ele */
    VOX_IO_FORMAT_MEDIT = 3,   /* .mesh, ASCII */
    VOX_IO_FORMAT_VEGA = 4,    /* .veg */
    VOX_IO_FORMAT_VTK = 5,     /* legacy .vtk, 2.0 to 5.1; ASCII and binary; tets, or POLYDATA: triangles, no tets */
    /* XML .vtu, and .vtp: triangles, no tets; ASCII, base64, appended; raw, zlib, LZ4 or LZMA. Reading it is UNSUPPORTED
     * in a library that is built without pugixml and zlib, or for LZMA without liblzma (docs/file-formats.md). */
    VOX_IO_FORMAT_VTU = 6,
    VOX_IO_FORMAT_SURFACE = 7, /* .stl, .obj, .ply, .off, .gltf, .glb; triangles, no tets */
    /* Any other surface that assimp reads. assimp is not made for damaged files: they can end the process, keep it
     * busy without end and fill its memory. So AUTO never chooses it, and a library that is built without it, as is the
     * default (docs/file-formats.md), answers UNSUPPORTED. */
    VOX_IO_FORMAT_ASSIMP = 8,
    VOX_IO_FORMAT_ABAQUS = 9 /* .inp; also of CalculiX */
} vox_io_format;

/* Flags of a vox_io_load_desc. */
typedef enum vox_io_load_flags {
    /* Keep vertices that belong to no tet, and triangles that name one. A vertex then has the file's number. In a
     * grid such vertices collide like all others. */
    VOX_IO_LOAD_KEEP_UNUSED = 1,
    /* Split hexahedra, wedges (prisms) and pyramids into tets. Otherwise these are left out, with a warning. A face of
     * four corners is split by the diagonal from its corner that comes first in the file, so that neighbours fit
     * together. Only corners are used, of cells of higher order, too. Each tet has the region of its cell. */
    VOX_IO_LOAD_SPLIT_CELLS = 2
} vox_io_load_flags;

typedef struct vox_io_load_desc {
    uint32_t struct_size;
    vox_io_format format;
    uint32_t mesh;  /* which mesh of a scene file to take, from 1; 0: all, joined */
    uint32_t flags; /* vox_io_load_flags */
    /* Where the arrays of the mesh live until vox_io_mesh_destroy. Copied; null: the C++ runtime's heap. Other memory
     * that reading needs is taken from that heap and released at the end of the call. */
    VOX_OPTIONAL const vox_allocator* allocator;
    /* Called now and then, on the calling thread, with the fraction of the work done, ascending from 0 to 1: about half
     * of it is reading, the rest the report. A result other than 0 cancels. May be null. */
    VOX_OPTIONAL int32_t (*progress)(double fraction, void* user);
    void* progress_user;
} vox_io_load_desc;

static inline vox_io_load_desc vox_default_io_load_desc(void) {
    vox_io_load_desc desc = VOX_ZERO;
    desc.struct_size = (uint32_t)sizeof desc;
    return desc;
}

/* One file in memory. `name` supplies the extension and appears in error texts; may be null. */
typedef struct vox_io_source {
    VOX_OPTIONAL const char* name;
    const void* data;
    size_t size;
} vox_io_source;

/* A mesh in memory. Immutable. */
typedef struct vox_io_mesh vox_io_mesh;

/* Reads the file at `path` (for TetGen either file of the pair; the other must be beside it, as must files that a
 * .gltf names). desc null: defaults. A surface takes at most 16 times the size of its files and 16 MB of memory; one
 * that stands for more triangles or vertices than that fails with LIMIT. A regular file is mapped into memory while
 * it is read and must not be shortened meanwhile.
 * Errors: FILE, FORMAT (the text names the file, the line or byte, and what was expected there),
 * UNSUPPORTED, LIMIT, OUT_OF_MEMORY, INVALID_ARGUMENT, INVALID_STATE (cancelled). */
VOX_API vox_result vox_io_load(const char* path, VOX_OPTIONAL const vox_io_load_desc* desc,
                               vox_io_mesh** out_mesh);

/* The same from memory. `sources` holds one file or, for TetGen, two: .node and .ele in any order. */
VOX_API vox_result vox_io_read(const vox_io_source* sources, size_t source_count,
                               VOX_OPTIONAL const vox_io_load_desc* desc, vox_io_mesh** out_mesh);

/* Releases a mesh. Null does nothing. */
VOX_API void vox_io_mesh_destroy(VOX_OPTIONAL vox_io_mesh* mesh);

/* Arrays of a mesh; they live until vox_io_mesh_destroy. Indices count from 0. */
typedef struct vox_io_mesh_view {
    const double* positions;
    uint64_t vertex_count;
    const uint32_t* tets; /* corners in the file's order */
    uint64_t tet_count;
    const uint32_t* triangles; /* as in the file */
    uint64_t triangle_count;
    /* A number for each tet, where the file has some that are not 0; else null. Physical groups of Gmsh (of several, the
     * first), references of Medit, the last attribute of TetGen. Of VTK the cell array "region", "gmsh:physical",
     * "medit:ref", "material" or the like, else the first that has one whole number for each cell. */
    VOX_OPTIONAL const int32_t* tet_regions;
    /* For each vertex its number in the file, counted from 0 in the file's order, ascending; null if vertices were not
     * left out. Values for vertex v belong to vertex file_vertices[v] of the file. */
    VOX_OPTIONAL const uint32_t* file_vertices;
    /* For each tet the number of its cell in the file, counted from 0 in the file's order through cells of every kind,
     * ascending; null if tet t is cell t. Instances of a part in an Abaqus file count one after the other. */
    VOX_OPTIONAL const uint32_t* tet_cells;
} vox_io_mesh_view;

/* The mesh's arrays. */
VOX_API vox_result vox_io_mesh_get_arrays(const vox_io_mesh* mesh, vox_io_mesh_view* out_view);

/* Describes the mesh for vox_mesh_insert and vox_suggest_cell_size: sets positions, tets and tet_count,
 * and leaves all other fields of `desc` as they are. Fill it with
 * vox_default_mesh_desc() first. Positions are borrowed: keep the mesh as long as they are bound, or set
 * VOX_MESH_COPY_POSITIONS. As they never change, a body that moves gets others: vox_mesh_map_positions,
 * vox_mesh_bind_positions or vox_body_set_transform. Triangles are not described. docs/files.md has a whole program.
 * Errors: INVALID_ARGUMENT (null, or a struct_size that does not reach to tet_count). */
VOX_API vox_result vox_io_mesh_describe(const vox_io_mesh* mesh, vox_mesh_desc* desc);

/* Makes a mesh from arrays (copied) on the C++ runtime's heap. Nothing is left out. Errors: INVALID_ARGUMENT,
 * INVALID_MESH, NON_FINITE, LIMIT (more than VOX_MAX_VERTICES or VOX_MAX_TETS), OUT_OF_MEMORY. */
VOX_API vox_result vox_io_mesh_create(const vox_io_mesh_view* arrays, vox_io_mesh** out_mesh);

/* ---- diagnosis -------------------------------------------------------------------------------- */

/* What was read, what was left out, and what is odd about the mesh. A "surface" is a mesh without tets. */
typedef struct vox_io_report {
    uint32_t struct_size;
    vox_io_format format;          /* AUTO for a mesh that was not read from a file */
    uint64_t vertices;
    uint64_t tets;
    uint64_t triangles;
    uint64_t skipped_elements;     /* elements of the file that are neither tet nor triangle */
    uint64_t second_order_tets;    /* tets of ten or more nodes, of which only the corners were used */
    uint64_t inverted_tets;        /* of negative volume, decided exactly */
    uint64_t degenerate_tets;      /* of exactly zero volume */
    uint64_t nearly_flat_tets;     /* six times the volume below 1e-9 times the longest edge cubed, but not zero */
    uint64_t duplicate_tets;       /* the same four vertices as an earlier tet */
    uint64_t degenerate_triangles; /* triangles that name a vertex twice */
    uint64_t duplicate_vertices;   /* vertices at the position of an earlier one */
    uint64_t unused_vertices;      /* in no tet and no triangle */
    uint64_t boundary_facets;      /* facets of exactly one tet; for a surface: its triangles */
    uint64_t non_manifold_facets;  /* facets of more than two tets; for a surface: edges of more than two triangles */
    uint64_t open_edges;           /* for a surface: edges of exactly one triangle; 0 when it is closed */
    uint64_t misoriented_edges;    /* for a surface: edges that two triangles run through in the same direction */
    uint64_t components;           /* parts connected by shared vertices; unused vertices are not counted */
    double volume;                 /* sum of the tets' volumes, inverted ones counted as positive; for a closed
                                    * surface the enclosed volume, negative if it is inside out; otherwise 0 */
    double bounds_min[3];          /* bounding box of the vertices in use, or of all vertices if none is in use */
    double bounds_max[3];
    double unit_in_metres;         /* length of the file's unit; 0 if the file does not state it */
    uint64_t left_out_vertices;    /* vertices of the file that belong to no tet and are not in the mesh */
    uint64_t left_out_triangles;   /* triangles of the file that name one of them and are not in the mesh */
    uint64_t split_cells;          /* hexahedra, wedges and pyramids of the file that were split into tets */
    uint64_t left_out_tets;        /* tets of ten or more nodes whose corners lie in one plane, exactly */
} vox_io_report;

/* Writes the fields that out_report->struct_size covers (set it first). */
VOX_API vox_result vox_io_mesh_get_report(const vox_io_mesh* mesh, vox_io_report* out_report);

/* The problems in the report as text, one line each ("3 tets are inverted"); "" if there are none. Lives until
 * vox_io_mesh_destroy. Cannot fail; null for a null mesh. */
VOX_API VOX_OPTIONAL const char* vox_io_mesh_get_warnings(VOX_OPTIONAL const vox_io_mesh* mesh);

/* Name of a format, e.g. "Gmsh .msh". Static text; never null. */
VOX_API const char* vox_io_format_string(vox_io_format format);

/* ---- surface to tetrahedra -------------------------------------------------------------------- */

typedef enum vox_io_solid_kind {
    /* Isosurface stuffing: the boundary follows the surface, and dihedral angles are between 10.7 and 164.8 degrees. */
    VOX_IO_SOLID_STUFFED = 0,
    /* Every lattice cube that the surface touches or encloses, uncut and split into five tets, so that the surface is
     * inside. For rough or open surfaces that are to be carried along by the tets around them. */
    VOX_IO_SOLID_CUBES = 1
} vox_io_solid_kind;

typedef struct vox_io_tetrahedralize_desc {
    uint32_t struct_size;
    vox_io_solid_kind kind;
    double cell;       /* edge of a lattice cube; 0: a fiftieth of the surface's longest side */
    uint64_t max_tets; /* more tets fail with LIMIT; 0: 100000000 */
    /* STUFFED: largest Hausdorff distance to the surface, as measured by vox_io_mesh_measure. Cells at the boundary
     * are halved until the distance is met, while those inside keep the size `cell`; thin details may need many tets.
     * Fails with LIMIT as soon as the way the distance falls would take more than four times max_tets.
     * 0: cells are not halved, and no distance is guaranteed. */
    double max_distance;
    /* STUFFED: how many times cells away from the boundary may be merged, eight into one. 0: all tets
     * have the same size. The boundary does not change. */
    uint32_t coarsen;
    uint32_t reserved; /* 0 */
    /* Called now and then, on the calling thread, with the fraction of the work done, ascending from 0 to 1. A result
     * other than 0 cancels. May be null. */
    VOX_OPTIONAL int32_t (*progress)(double fraction, void* user);
    void* progress_user;
    VOX_OPTIONAL const vox_allocator* allocator; /* as vox_io_load_desc.allocator */
} vox_io_tetrahedralize_desc;

static inline vox_io_tetrahedralize_desc vox_default_io_tetrahedralize_desc(void) {
    vox_io_tetrahedralize_desc desc = VOX_ZERO;
    desc.struct_size = (uint32_t)sizeof desc;
    return desc;
}

/* Fills the inside of a closed surface (the triangles of `surface`; its tets are ignored) with tetrahedra.
 * desc null: defaults. All tets have positive volume, no two overlap, and inner facets are shared by exactly two. The
 * surface may have any orientation, consist of several parts, and intersect itself. Inside is where its winding number
 * is not zero or, if its triangles do not agree on an orientation, where rays cross it an odd number of times. Holes
 * up to about the size of a cell are closed. Details thinner than a cell may be lost, and edges are rounded by a
 * fraction of a cell (max_distance prevents both). The same input gives the same tets, bit for bit. Memory and time
 * are proportional to the number of cells inside.
 * Errors: INVALID_ARGUMENT (no triangles, no volume, no tet fits in), NON_FINITE, INVALID_MESH (the surface is
 * open; not for CUBES), LIMIT (more than 4096 cells along an axis, more than max_tets), INVALID_STATE (cancelled),
 * OUT_OF_MEMORY. */
VOX_API vox_result vox_io_tetrahedralize(const vox_io_mesh* surface,
                                         VOX_OPTIONAL const vox_io_tetrahedralize_desc* desc, vox_io_mesh** out_mesh);

/* How good a tet mesh is, and how close its boundary is to a surface. */
typedef struct vox_io_quality {
    uint32_t struct_size;
    uint32_t reserved;
    uint64_t vertices;
    uint64_t tets;
    uint64_t boundary_facets;
    double min_dihedral; /* smallest and largest angle between two facets of a tet, in degrees; 0 without tets */
    double max_dihedral;
    double volume;            /* sum of the signed tet volumes */
    double surface_volume;    /* volume enclosed by the surface, signed by its orientation; 0 without a surface */
    /* Largest distance from sample points on the mesh's boundary to the surface, and the reverse. Samples are at most
     * half a mean boundary edge apart on every triangle and include its corners; their distances are exact. 0 without
     * a surface. */
    double mesh_to_surface;
    double surface_to_mesh;
    double hausdorff; /* the larger of the two */
} vox_io_quality;

/* Measures `mesh` against the triangles of `surface`, which may be null. Writes the fields that
 * out_quality->struct_size covers (set it first). Errors: INVALID_ARGUMENT, OUT_OF_MEMORY. */
VOX_API vox_result vox_io_mesh_measure(const vox_io_mesh* mesh, VOX_OPTIONAL const vox_io_mesh* surface,
                                          vox_io_quality* out_quality);

/* ---- writing ---------------------------------------------------------------------------------- */

typedef enum vox_io_write_format {
    VOX_IO_WRITE_AUTO = 0,   /* determined by the name's extension: .msh is MSH_41, .vtu is VTU */
    VOX_IO_WRITE_MSH_22 = 1, /* Gmsh .msh 2.2 */
    VOX_IO_WRITE_MSH_41 = 2, /* Gmsh .msh 4.1 */
    VOX_IO_WRITE_VTU = 3     /* VTK XML, for ParaView */
} vox_io_write_format;

/* Numbers attached to the vertices or cells, e.g. contacts or penetration depths. Cells are the triangles, then the
 * tets. */
typedef struct vox_io_point_data {
    const char* name; /* not empty, without control characters and double quotes */
    /* Finite numbers, `components` for each vertex, or for each cell. */
    const double* values;
    uint32_t components;  /* 1 (scalars), 3 (vectors) or 9 (tensors) */
    uint32_t reserved;    /* 0 */
} vox_io_point_data;

typedef struct vox_io_write_desc {
    uint32_t struct_size;
    vox_io_write_format format;
    uint32_t binary;   /* 0: text, from which the same doubles are read back; 1: binary, in this machine's byte order */
    uint32_t reserved; /* 0 */
    const vox_io_point_data* point_data; /* read during the call */
    uint64_t point_data_count;
    const vox_io_point_data* cell_data; /* with values for each cell */
    uint64_t cell_data_count;
} vox_io_write_desc;

static inline vox_io_write_desc vox_default_io_write_desc(void) {
    vox_io_write_desc desc = VOX_ZERO;
    desc.struct_size = (uint32_t)sizeof desc;
    return desc;
}

/* Writes vertices, triangles and tets, in the mesh's order, and the tets' regions: as physical groups in .msh, as the
 * cell array "region" in .vtu, unless cell_data has one of that name. desc null: defaults. An existing file at `path`
 * is replaced at the end, and only if everything was written.
 * Errors: FILE, INVALID_ARGUMENT (names the field), NON_FINITE, UNSUPPORTED (the extension), LIMIT (more
 * elements than .msh 2.2 can number), OUT_OF_MEMORY. */
VOX_API vox_result vox_io_write(const vox_io_mesh* mesh, const char* path,
                                VOX_OPTIONAL const vox_io_write_desc* desc);

/* Receives `size` bytes of a file, in order, on the thread that writes. Returns 0 on success; any other value stops the
 * writing. */
typedef struct vox_io_sink {
    int32_t (*write)(const void* data, size_t size, void* user);
    void* user;
} vox_io_sink;

/* As vox_io_write, but passes the bytes to `sink`. desc->format must not be AUTO. Errors: as vox_io_write, and FILE if
 * the sink fails; the bytes it received before that are not a complete file. */
VOX_API vox_result vox_io_write_to(const vox_io_mesh* mesh, const vox_io_write_desc* desc, const vox_io_sink* sink);

/* ---- ready-made bodies ------------------------------------------------------------------------ */

/* All bodies are centred at the origin and have only tets of positive volume. Lengths must be finite and above 0.
 * Errors: INVALID_ARGUMENT (names the number), LIMIT, OUT_OF_MEMORY. */

/* A ball of `radius` around the origin, made of about `tet_count` tetrahedra. It consists of the cubes of a lattice
 * that are inside the ball, each split into five tetrahedra; boundary vertices are moved onto the sphere, and interior
 * ones smoothed by three Laplace sweeps. The count is met within 1 % for 1000 tets and more. */
VOX_API vox_result vox_io_make_lattice_ball(uint64_t tet_count, double radius, vox_io_mesh** out_mesh);

/* A ball by isosurface stuffing on a lattice of cubes with edge `cell`. It and the three bodies below have the dihedral
 * angles of vox_io_tetrahedralize. */
VOX_API vox_result vox_io_make_ball(double radius, double cell, vox_io_mesh** out_mesh);
/* A torus around the z axis. `radius` is the distance from the axis to the middle of the tube; tube_radius < radius. */
VOX_API vox_result vox_io_make_torus(double radius, double tube_radius, double cell, vox_io_mesh** out_mesh);
/* A capsule along the z axis. `length` is the distance between the centres of the two round ends. */
VOX_API vox_result vox_io_make_capsule(double radius, double length, double cell, vox_io_mesh** out_mesh);
/* A cylinder along the z axis. Its rims are rounded by a fraction of a cell. */
VOX_API vox_result vox_io_make_cylinder(double radius, double length, double cell, vox_io_mesh** out_mesh);

/* An exact box of cubes with edges of about `cell`, stretched so that a whole number of them fits each side, and split
 * into five tets each. */
VOX_API vox_result vox_io_make_box(double size_x, double size_y, double size_z, double cell,
                                   vox_io_mesh** out_mesh);

#ifdef __cplusplus
}
#endif

#endif
