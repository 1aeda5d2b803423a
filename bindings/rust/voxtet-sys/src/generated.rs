// Written by bindings/generate.py from bindings/api.json. Do not edit.
#![allow(non_camel_case_types, rustdoc::all, clippy::all)]

use core::ffi::{c_char, c_void};
use core::marker::{PhantomData, PhantomPinned};

/// A program runs with any library of the ABI version that it was built with (docs/abi.md).
pub const VOX_ABI_VERSION: u32 = 1;
/// as an index: none
pub const VOX_NONE: u32 = 4294967295;
/// as a worker_count: one worker per core
pub const VOX_ALL_CORES: u32 = 4294967295;
/// in a grid at one time
pub const VOX_MAX_BODIES: u32 = 1048576;
/// in a grid
pub const VOX_MAX_VERTICES: u32 = 2147483647;
/// in a grid
pub const VOX_MAX_TETS: u32 = 2147483647;
/// in a mesh whose surface is needed: constraints, edges, margin, queries
pub const VOX_MAX_SURFACE_TETS: u32 = 357913941;
/// in a step
pub const VOX_MAX_CONTACTS: u32 = 4294967295;
/// of a grid
pub const VOX_MAX_WORKERS: u32 = 256;
/// vox_grid_desc.max_constraints_per_pair
pub const VOX_MAX_CONSTRAINTS_PER_PAIR: u32 = 256;
/// names no body
pub const VOX_NULL_BODY: u32 = 0;
/// vox_filter.self_rings
pub const VOX_MAX_RINGS: u32 = 8;
/// most vertices of a constraint
pub const VOX_STENCIL_CAPACITY: u32 = 5;
/// in one call
pub const VOX_MAX_TASKS: u32 = 64;
/// most samples of a curve
pub const VOX_CURVE_CAPACITY: u32 = 64;
/// most terms of a cost
pub const VOX_TERM_CAPACITY: u32 = 12;
/// most rules that are compared
pub const VOX_RULE_CAPACITY: u32 = 8;
/// most runs of vox_foreign_grid_tune
pub const VOX_TIMING_CAPACITY: u32 = 32;
/// bytes of a note, its zero included; it is cut to that
pub const VOX_NOTE_CAPACITY: u32 = 256;
/// numbers in vox_cost_weights
pub const VOX_COST_WEIGHT_CAPACITY: u32 = 24;
/// vertices, edges or faces of a surface, each
pub const VOX_MAX_FEATURES: u32 = 2147483647;
/// patches of a surface
pub const VOX_MAX_PATCHES: u32 = 65536;

pub type vox_result = i32;
pub const VOX_OK: vox_result = 0;
/// a null pointer, an unknown enumerator, a bad number
pub const VOX_ERROR_INVALID_ARGUMENT: vox_result = -1;
/// an id that is null, stale or of another grid
pub const VOX_ERROR_INVALID_HANDLE: vox_result = -2;
/// a tetrahedron or triangle names a vertex that does not exist
pub const VOX_ERROR_INVALID_MESH: vox_result = -3;
/// the call does not fit the state, e.g. a mesh has no positions yet
pub const VOX_ERROR_INVALID_STATE: vox_result = -4;
/// a position is NaN or infinite
pub const VOX_ERROR_NON_FINITE: vox_result = -5;
/// a documented limit would be exceeded
pub const VOX_ERROR_LIMIT: vox_result = -6;
/// the byte budget would be exceeded
pub const VOX_ERROR_BUDGET: vox_result = -7;
/// the allocator returned null
pub const VOX_ERROR_OUT_OF_MEMORY: vox_result = -8;
/// not in this build or version
pub const VOX_ERROR_UNSUPPORTED: vox_result = -9;
/// a file cannot be opened, read or written
pub const VOX_ERROR_FILE: vox_result = -10;
/// a file or a snapshot is malformed
pub const VOX_ERROR_FORMAT: vox_result = -11;
/// a defect of the library: please report it
pub const VOX_ERROR_INTERNAL: vox_result = -12;

pub type vox_format = i32;
pub const VOX_FORMAT_FLOAT: vox_format = 0;
/// magnitudes below 2^128 - 2^103, the largest float
pub const VOX_FORMAT_DOUBLE: vox_format = 1;

/// What a step does besides finding contacts and pairs.
pub type vox_grid_flags = u32;
/// also find constraints: as vox_grid_find_constraints with the defaults
pub const VOX_GRID_CONSTRAINTS: vox_grid_flags = 1;
/// also find edges that pass through faces. Experimental
pub const VOX_GRID_EDGES: vox_grid_flags = 2;
/// leave out a body with a bad coordinate (NaN, infinite, too large) instead of failing (vox_grid_get_failure)
pub const VOX_GRID_SKIP_BAD_BODIES: vox_grid_flags = 4;

pub type vox_filter_flags = u32;
/// the mesh also collides with itself
pub const VOX_FILTER_SELF_COLLISION: vox_filter_flags = 1;
/// the body has contacts and pairs, but no constraints; takes less memory
pub const VOX_FILTER_SENSOR: vox_filter_flags = 2;

pub type vox_mesh_flags = u32;
/// copy the positions instead of borrowing them
pub const VOX_MESH_COPY_POSITIONS: vox_mesh_flags = 1;
/// borrow the tetrahedra instead of copying them, 16 bytes each
pub const VOX_MESH_BORROW_TETS: vox_mesh_flags = 2;

/// What changed since the last successful step.
pub type vox_pair_state = i32;
/// does not touch, but is within the margin
pub const VOX_PAIR_NEAR: vox_pair_state = 0;
/// touches now and did not before
pub const VOX_PAIR_BEGAN: vox_pair_state = 1;
/// touches now and did before
pub const VOX_PAIR_PERSISTED: vox_pair_state = 2;
/// touched before and does not now
pub const VOX_PAIR_ENDED: vox_pair_state = 3;

/// Why there is a constraint. A vertex has at most one INSIDE, PROXIMITY or IMPACT constraint with each body.
pub type vox_constraint_kind = i32;
/// a vertex of body_a is inside body_b
pub const VOX_CONSTRAINT_INSIDE: vox_constraint_kind = 0;
/// an edge of body_a meets a face of body_b (VOX_GRID_EDGES)
pub const VOX_CONSTRAINT_EDGE: vox_constraint_kind = 1;
/// a vertex of body_a is outside body_b and within the margin (vox_grid_set_margin)
pub const VOX_CONSTRAINT_PROXIMITY: vox_constraint_kind = 2;
/// a vertex of body_a is not inside body_b, but went in within the step and is behind the face that it met first
/// (vox_mesh_bind_previous_positions)
pub const VOX_CONSTRAINT_IMPACT: vox_constraint_kind = 3;

/// How gap and normal were found, and thus how far to trust them (docs/depth.md).
pub type vox_depth_state = i32;
/// a mean over the edges that lead from the vertex out of body_b
pub const VOX_DEPTH_SURFACE: vox_depth_state = 0;
/// a mean over neighbouring vertices that are closer to the surface
pub const VOX_DEPTH_PROPAGATED: vox_depth_state = 1;
/// the closest point of the surface, which may jump from step to step
pub const VOX_DEPTH_CLOSEST: vox_depth_state = 2;
/// the bodies pass through each other: the nearest way out, which may be the wrong side
pub const VOX_DEPTH_AMBIGUOUS: vox_depth_state = 3;
/// the bodies only touch here: gap 0
pub const VOX_DEPTH_TOUCHING: vox_depth_state = 4;
/// closest_budget was used up: gap 0; or no depth was asked for: gap and normal 0
pub const VOX_DEPTH_UNKNOWN: vox_depth_state = 5;
/// the plane of the face: for IMPACT, and for EDGE of a mesh with itself
pub const VOX_DEPTH_PLANE: vox_depth_state = 6;

/// How the depth of a vertex inside a mesh is found.
pub type vox_depth_method = i32;
/// smooth along the surface; neighbouring vertices leave on the same side: for response (Heidelberger et al. 2004)
pub const VOX_DEPTH_METHOD_CONSISTENT: vox_depth_method = 0;
/// to the closest point of the surface, with the vertices of its face in place of the tetrahedron's: for finite
/// elements, pictures, reports
pub const VOX_DEPTH_METHOD_CLOSEST: vox_depth_method = 1;
/// none: vertices, weights and position alone. Quick
pub const VOX_DEPTH_METHOD_NONE: vox_depth_method = 2;

/// Shapes are given in a frame of their own. vox_body_set_transform places them, and moves them from step to step.
pub type vox_shape_kind = i32;
pub const VOX_SHAPE_NONE: vox_shape_kind = 0;
/// z <= 0: a floor
pub const VOX_SHAPE_HALF_SPACE: vox_shape_kind = 1;
/// around the origin: radius
pub const VOX_SHAPE_SPHERE: vox_shape_kind = 2;
/// along the z axis, around the origin: radius, half_length
pub const VOX_SHAPE_CAPSULE: vox_shape_kind = 3;
/// likewise, with flat ends
pub const VOX_SHAPE_CYLINDER: vox_shape_kind = 4;
/// around the origin: half_size
pub const VOX_SHAPE_BOX: vox_shape_kind = 5;
/// terrain, solid below, without walls at its ends: heights, columns, rows, spacing
pub const VOX_SHAPE_HEIGHTFIELD: vox_shape_kind = 6;
/// the inside of a closed surface: positions, triangles
pub const VOX_SHAPE_SOLID: vox_shape_kind = 7;
/// what is within `radius` of triangles: a blade, a wall. A triangle that names a vertex twice is a segment of a
/// needle: positions, triangles, radius
pub const VOX_SHAPE_SHEET: vox_shape_kind = 8;
/// where a function of the caller is not positive: field, half_size
pub const VOX_SHAPE_FIELD: vox_shape_kind = 9;

/// How serious a line of the log is.
pub type vox_log_level = i32;
pub const VOX_LOG_INFO: vox_log_level = 0;
pub const VOX_LOG_WARNING: vox_log_level = 1;

pub type vox_query_flags = u32;
/// vox_locator_find_ray_hits: report only the first hit of each ray
pub const VOX_QUERY_FIRST_HIT: vox_query_flags = 1;
/// vox_locator_locate: for a point outside, compute the weights of the point itself, some of which are negative, rather
/// than of the closest point
pub const VOX_QUERY_EXTRAPOLATE: vox_query_flags = 2;

pub type vox_location_state = i32;
/// no body is within max_distance; the other fields are 0
pub const VOX_LOCATION_NONE: vox_location_state = 0;
/// the closed tetrahedron contains the point
pub const VOX_LOCATION_INSIDE: vox_location_state = 1;
/// no tetrahedron contains the point; this one has the closest point of all surfaces, as vox_locator_find_closest finds
/// it
pub const VOX_LOCATION_OUTSIDE: vox_location_state = 2;

pub type vox_side = i32;
/// the facet's tetrahedron has no volume
pub const VOX_SIDE_NONE: vox_side = 0;
/// the ray goes into the tetrahedron
pub const VOX_SIDE_ENTERS: vox_side = 1;
pub const VOX_SIDE_LEAVES: vox_side = 2;

/// What a result depends on, combined with |. vox_cell_size_result.note says it in words, with numbers.
pub type vox_cell_size_warnings = u32;
/// nothing is known of the grid's times; a few timings would help
pub const VOX_CELL_SIZE_GUESSED_WEIGHTS: vox_cell_size_warnings = 1;
/// it is the mean edge: the weights do not show for certain that another is better
pub const VOX_CELL_SIZE_BY_RULE: vox_cell_size_warnings = 2;
/// it is min_cell_size, though a smaller one would cost less
pub const VOX_CELL_SIZE_AT_MINIMUM: vox_cell_size_warnings = 4;
/// the primitives have no size; it follows from the distances between them
pub const VOX_CELL_SIZE_FROM_SPACING: vox_cell_size_warnings = 8;
/// all primitives are in one place; any large enough cell size will do
pub const VOX_CELL_SIZE_ONE_PLACE: vox_cell_size_warnings = 16;
/// the timings do not follow the counts of the described grid
pub const VOX_CELL_SIZE_MODEL_DISAGREES: vox_cell_size_warnings = 32;
/// timings at the same cell size differ widely
pub const VOX_CELL_SIZE_TIMINGS_DISAGREE: vox_cell_size_warnings = 64;
/// the best cell size lies beyond those that were timed
pub const VOX_CELL_SIZE_OUT_OF_RANGE: vox_cell_size_warnings = 128;
/// the callback stopped, or could not run at a cell size
pub const VOX_CELL_SIZE_STOPPED: vox_cell_size_warnings = 256;

pub type vox_cost_model = i32;
/// the paper's z(delta) (Sect. 4, Eqs. 3-8)
pub const VOX_COST_MODEL_PAPER: vox_cost_model = 0;
/// a step of the paper's engine, counted tetrahedron by tetrahedron
pub const VOX_COST_MODEL_REFERENCE: vox_cost_model = 1;
/// a step of the fast engine, with the same cell size everywhere
pub const VOX_COST_MODEL_FAST: vox_cost_model = 2;
/// the searches of vox_surface.h in the meshes' surfaces
pub const VOX_COST_MODEL_SURFACE: vox_cost_model = 3;

pub type vox_reference_flags = u32;
/// store a list for every cell of a box, instead of hashing cells into a table
pub const VOX_REFERENCE_DENSE: vox_reference_flags = 1;
/// hash by i*73856093 xor j*19349663 xor k*83492791 (Teschner et al. 2003, Sect. 4.1), instead of by a well-mixed hash
pub const VOX_REFERENCE_PAPER_HASH: vox_reference_flags = 2;

pub type vox_primitive_type = i32;
/// one vertex
pub const VOX_PRIMITIVE_POINT: vox_primitive_type = 0;
/// two
pub const VOX_PRIMITIVE_EDGE: vox_primitive_type = 1;
/// three
pub const VOX_PRIMITIVE_TRIANGLE: vox_primitive_type = 2;
/// four
pub const VOX_PRIMITIVE_TET: vox_primitive_type = 3;
/// two: opposite corners, in any order
pub const VOX_PRIMITIVE_BOX: vox_primitive_type = 4;

/// Grids whose layout and weights are known, as measured by bench/foreign.
pub type vox_known_grid = i32;
/// the weights with the smallest worst loss over all grids below
pub const VOX_KNOWN_GRID_NONE: vox_known_grid = 0;
/// C++: a counting sort into a dense lattice
pub const VOX_KNOWN_GRID_SORTED: vox_known_grid = 1;
/// C++: std::unordered_map from cell to list
pub const VOX_KNOWN_GRID_HASHED: vox_known_grid = 2;
/// NVIDIA Warp's HashGrid on the processor
pub const VOX_KNOWN_GRID_WARP: vox_known_grid = 3;
/// IPC Toolkit's SpatialHash
pub const VOX_KNOWN_GRID_IPC: vox_known_grid = 4;
/// IPC Toolkit's HashGrid
pub const VOX_KNOWN_GRID_IPC_PAIRS: vox_known_grid = 5;
/// VTK's vtkStaticCellLocator
pub const VOX_KNOWN_GRID_VTK: vox_known_grid = 6;
/// PBAT's HashGrid3
pub const VOX_KNOWN_GRID_PBAT: vox_known_grid = 7;
/// hashed voxels of points, as in PCL and Open3D
pub const VOX_KNOWN_GRID_POINT_VOXELS: vox_known_grid = 8;
/// sorted keys in numpy
pub const VOX_KNOWN_GRID_NUMPY: vox_known_grid = 9;

/// The cells that store a primitive.
pub type vox_cells_stored = i32;
/// as in the known grid, else BOX
pub const VOX_CELLS_STORED_DEFAULT: vox_cells_stored = 0;
/// all cells that its box meets
pub const VOX_CELLS_STORED_BOX: vox_cells_stored = 1;
/// the cell that contains the centre of its box
pub const VOX_CELLS_STORED_CENTRE: vox_cells_stored = 2;

/// The cells that a query visits.
pub type vox_cells_queried = i32;
/// as in the known grid, else BOX
pub const VOX_CELLS_QUERIED_DEFAULT: vox_cells_queried = 0;
/// all cells that its box meets; one for a point
pub const VOX_CELLS_QUERIED_BOX: vox_cells_queried = 1;
/// the cell that contains its centre, and the 26 cells around it. Only with CENTRE
pub const VOX_CELLS_QUERIED_27: vox_cells_queried = 2;
/// none: the grid goes through its cells and reports every pair within a cell
pub const VOX_CELLS_QUERIED_PAIRS: vox_cells_queried = 3;

/// The cells that exist.
pub type vox_cells_kept = i32;
/// as in the known grid, else OCCUPIED
pub const VOX_CELLS_KEPT_DEFAULT: vox_cells_kept = 0;
/// those that store something
pub const VOX_CELLS_KEPT_OCCUPIED: vox_cells_kept = 1;
/// all cells in the box of the stored primitives
pub const VOX_CELLS_KEPT_DENSE: vox_cells_kept = 2;

/// What a surface consists of.
pub type vox_feature = i32;
pub const VOX_FEATURE_VERTEX: vox_feature = 0;
pub const VOX_FEATURE_EDGE: vox_feature = 1;
pub const VOX_FEATURE_FACE: vox_feature = 2;

pub type vox_motion_flags = u32;
/// leave out pairs of boxes whose features provably stay further apart than twice the radius
pub const VOX_MOTION_CULL: vox_motion_flags = 1;

pub type vox_crossing_kind = i32;
/// the edge passes through the interior of the face
pub const VOX_CROSSING_THROUGH: vox_crossing_kind = 0;
/// an end of the edge is on the face, or it passes through a side or a corner of it
pub const VOX_CROSSING_TOUCHING: vox_crossing_kind = 1;
/// it lies in the plane of the face and meets it, or one of them is degenerate
pub const VOX_CROSSING_COPLANAR: vox_crossing_kind = 2;

pub type vox_io_format = i32;
/// determined from the content or, failing that, from the name's extension
pub const VOX_IO_FORMAT_AUTO: vox_io_format = 0;
/// .msh 1, 2.2, 4.0, 4.1; ASCII and binary
pub const VOX_IO_FORMAT_GMSH: vox_io_format = 1;
/// .node with .ele
pub const VOX_IO_FORMAT_TETGEN: vox_io_format = 2;
/// .mesh, ASCII
pub const VOX_IO_FORMAT_MEDIT: vox_io_format = 3;
/// .veg
pub const VOX_IO_FORMAT_VEGA: vox_io_format = 4;
/// legacy .vtk, 2.0 to 5.1; ASCII and binary; tets, or POLYDATA: triangles, no tets
pub const VOX_IO_FORMAT_VTK: vox_io_format = 5;
/// XML .vtu, and .vtp: triangles, no tets; ASCII, base64, appended; raw, zlib, LZ4 or LZMA. Reading it is UNSUPPORTED
/// in a library that is built without pugixml and zlib, or for LZMA without liblzma (docs/file-formats.md).
pub const VOX_IO_FORMAT_VTU: vox_io_format = 6;
/// .stl, .obj, .ply, .off, .gltf, .glb; triangles, no tets
pub const VOX_IO_FORMAT_SURFACE: vox_io_format = 7;
/// Any other surface that assimp reads. assimp is not made for damaged files: they can end the process, keep it busy
/// without end and fill its memory. So AUTO never chooses it, and a library that is built without it, as is the default
/// (docs/file-formats.md), answers UNSUPPORTED.
pub const VOX_IO_FORMAT_ASSIMP: vox_io_format = 8;
/// .inp; also of CalculiX
pub const VOX_IO_FORMAT_ABAQUS: vox_io_format = 9;

/// Flags of a vox_io_load_desc.
pub type vox_io_load_flags = u32;
/// Keep vertices that belong to no tet, and triangles that name one. A vertex then has the file's number. In a grid
/// such vertices collide like all others.
pub const VOX_IO_LOAD_KEEP_UNUSED: vox_io_load_flags = 1;
/// Split hexahedra, wedges (prisms) and pyramids into tets. Otherwise these are left out, with a warning. A face of
/// four corners is split by the diagonal from its corner that comes first in the file, so that neighbours fit together.
/// Only corners are used, of cells of higher order, too. Each tet has the region of its cell.
pub const VOX_IO_LOAD_SPLIT_CELLS: vox_io_load_flags = 2;

pub type vox_io_solid_kind = i32;
/// Isosurface stuffing: the boundary follows the surface, and dihedral angles are between 10.7 and 164.8 degrees.
pub const VOX_IO_SOLID_STUFFED: vox_io_solid_kind = 0;
/// Every lattice cube that the surface touches or encloses, uncut and split into five tets, so that the surface is
/// inside. For rough or open surfaces that are to be carried along by the tets around them.
pub const VOX_IO_SOLID_CUBES: vox_io_solid_kind = 1;

pub type vox_io_write_format = i32;
/// determined by the name's extension: .msh is MSH_41, .vtu is VTU
pub const VOX_IO_WRITE_AUTO: vox_io_write_format = 0;
/// Gmsh .msh 2.2
pub const VOX_IO_WRITE_MSH_22: vox_io_write_format = 1;
/// Gmsh .msh 4.1
pub const VOX_IO_WRITE_MSH_41: vox_io_write_format = 2;
/// VTK XML, for ParaView
pub const VOX_IO_WRITE_VTU: vox_io_write_format = 3;

pub type vox_sim_body_flags = u32;
pub const VOX_SIM_BODY_SELF_COLLISION: vox_sim_body_flags = 1;
/// never moves; others collide with it
pub const VOX_SIM_BODY_FIXED: vox_sim_body_flags = 2;

pub type vox_resolve_flags = u32;
/// the body does not move
pub const VOX_RESOLVE_FIXED: vox_resolve_flags = 1;

/// A body of a grid: a mesh or a rigid shape. An id is never used again in the same grid. Ids ascend with slots, so in
/// a new grid they ascend in the order of insertion.
pub type vox_body = u32;

/// A set of bodies, and the settings for finding their contacts.
#[repr(C)]
pub struct vox_grid {
    _data: [u8; 0],
    _marker: PhantomData<(*mut u8, PhantomPinned)>,
}

/// The meshes of a grid at one moment.
#[repr(C)]
pub struct vox_locator {
    _data: [u8; 0],
    _marker: PhantomData<(*mut u8, PhantomPinned)>,
}

/// Vertices, edges and faces, and their motion.
#[repr(C)]
pub struct vox_surface {
    _data: [u8; 0],
    _marker: PhantomData<(*mut u8, PhantomPinned)>,
}

/// A mesh in memory. Immutable.
#[repr(C)]
pub struct vox_io_mesh {
    _data: [u8; 0],
    _marker: PhantomData<(*mut u8, PhantomPinned)>,
}

/// Soft bodies and the grid they collide in.
#[repr(C)]
pub struct vox_sim {
    _data: [u8; 0],
    _marker: PhantomData<(*mut u8, PhantomPinned)>,
}

/// Does the items [begin, end) of a task, on any thread. `worker` is below worker_count; two calls at the same time
/// have different ones.
#[rustfmt::skip]
pub type vox_task = Option<unsafe extern "C" fn(begin: u64, end: u64, worker: u32, context: *mut c_void)>;

/// Returns the cost at a cell size; infinity or NaN if it is impossible. Called on the calling thread. Must not throw.
#[rustfmt::skip]
pub type vox_cost_function = Option<unsafe extern "C" fn(cell_size: f64, user: *mut c_void) -> f64>;

/// Runs the caller's grid once, and returns how many seconds that took; infinity if this cell size is impossible; a
/// negative number or NaN to stop tuning. Called on the calling thread. Must not throw.
#[rustfmt::skip]
pub type vox_foreign_run = Option<unsafe extern "C" fn(cell_size: f64, user: *mut c_void) -> f64>;

/// An array of positions. Coordinate k (0, 1, 2 for x, y, z) of position i is at byte i * byte_stride + k *
/// component_byte_stride of `data`. With both strides 0 the array is packed: x y z, x y z, ... If positions are part of
/// larger records, set byte_stride to the size of a record. For columns (all x, then all y, then all z, as in Eigen,
/// Julia, Fortran and Matlab), set component_byte_stride to the distance between columns. Strides at which positions
/// would overlap are an INVALID_ARGUMENT everywhere.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct vox_positions {
    /// null: no positions
    pub data: *const c_void,
    pub count: u64,
    pub format: vox_format,
    /// 0
    pub reserved: u32,
    /// 0: packed; for columns, the size of a number
    pub byte_stride: u64,
    /// 0: the size of a number
    pub component_byte_stride: u64,
}

/// Settings of a grid; all 0 by default. What the pointers name is copied.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct vox_grid_desc {
    pub struct_size: u32,
    /// vox_grid_flags, combined with |
    pub flags: u32,
    /// threads that share a step: up to VOX_MAX_WORKERS, or VOX_ALL_CORES; 0: one
    pub worker_count: u32,
    /// Most constraints of a pair, up to VOX_MAX_CONSTRAINTS_PER_PAIR; 0: all. The deepest stays, then whichever is
    /// farthest from all that stay; PROXIMITY only if no others are left. Pairs and contacts do not change.
    pub max_constraints_per_pair: u32,
    /// edge length of a cell; 0: the library chooses it in every step. Never changes results
    pub cell_size: f64,
    /// see vox_grid_set_margin
    pub margin: f64,
    /// most bytes the grid may hold; 0: 4 GiB; UINT64_MAX: no limit
    pub byte_budget: u64,
    /// null: the C++ runtime's heap
    pub allocator: *const vox_allocator,
    /// null: no log
    pub log: *const vox_log,
    /// null: the built-in scheduler
    pub tasks: *const vox_task_system,
    /// null: the fast engine; else the paper's engine, which is slower and finds the same (vox_cell_size.h)
    pub reference: *const vox_reference_desc,
}

/// What a body collides with. With all fields 0, the default, it collides with every other body, but not with itself.
/// Two bodies in different worlds never collide; use worlds for copies of a scene in one grid. Two bodies with the same
/// group other than 0 collide if it is positive and do not collide if it is negative. Any other two collide if the
/// category of each has a bit in common with the mask of the other, as in Box2D. A tetrahedron that is ruled out for a
/// vertex is treated as if it did not exist.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct vox_filter {
    /// vox_filter_flags, combined with |
    pub flags: u32,
    pub group: i32,
    /// 0: 1
    pub category: u64,
    /// 0: all bits
    pub mask: u64,
    pub world: u32,
    /// Self-contact ignores tetrahedra that have a corner within this many edges of the vertex; at most VOX_MAX_RINGS.
    /// Takes about 60, 260 or 700 bytes per vertex for 1, 2 or 3.
    pub self_rings: u32,
    /// Self-contact ignores tetrahedra that are closer to the vertex than this in the rest pose. The rest pose is
    /// vox_mesh_desc.rest_positions or, without these, the positions when this distance is first set.
    pub self_rest_distance: f64,
}

/// A mesh: vertices, and tetrahedra between them. A mesh without tetrahedra is a set of points, which collide with
/// tetrahedra and shapes; edges and faces between them collide with nothing.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct vox_mesh_desc {
    pub struct_size: u32,
    /// vox_mesh_flags, combined with |
    pub flags: u32,
    /// positions.count is the number of vertices. The data is borrowed until the mesh is removed or bound to other
    /// positions. Every step reads it: to move the mesh, write to it between steps. If it is null, bind positions
    /// before the next step.
    pub positions: vox_positions,
    /// 4 * tet_count vertex indices, in either winding. Copied; or borrowed until the mesh is removed or edited
    pub tets: *const u32,
    pub tet_count: u64,
    /// any number; results repeat it
    pub user_data: u64,
    pub filter: vox_filter,
    /// copied; see vox_filter.self_rest_distance
    pub rest_positions: vox_positions,
}

/// Vertex `vertex` of body_a lies in the closed tetrahedron `tet` of body_b and is not one of its corners. This is
/// decided exactly. For each vertex and body_b there is a contact for every tetrahedron that has the vertex in its
/// interior. If there is none, there is one for the lowest tetrahedron that has it on its boundary. A tetrahedron of
/// zero volume contains nothing.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct vox_contact {
    pub body_a: vox_body,
    pub vertex: u32,
    pub body_b: vox_body,
    pub tet: u32,
}

/// Contacts, sorted by (body_a, vertex, body_b, tet). The arrays live until the end of the epoch.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct vox_contact_view {
    pub data: *const vox_contact,
    pub count: u64,
    /// one for each contact: 1 if the vertex is in the interior, 0 if on the boundary
    pub interiors: *const u8,
}

/// Two bodies that touch, or touched in the step before. They touch if a vertex of one is inside the other or went
/// through it within the step, or if an edge of one meets a face of the other. body_a < body_b; they are equal for a
/// mesh that touches itself. A pair that began ends exactly once, even if a body is removed, disabled or filtered out,
/// or the grid is cleared. Its ids may be stale then.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct vox_pair {
    pub body_a: vox_body,
    pub body_b: vox_body,
    pub user_data_a: u64,
    pub user_data_b: u64,
    pub state: vox_pair_state,
    pub reserved: u32,
    /// see vox_pair_view.contacts
    pub first_contact: u64,
    /// 0 if the two touch in another way, or no longer
    pub contact_count: u64,
}

/// Pairs, sorted by (body_a, body_b). The arrays live until the end of the epoch.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct vox_pair_view {
    pub data: *const vox_pair,
    pub count: u64,
    /// indices of contacts. A pair has contact_count of them, from contacts[first_contact] on: first for vertices of
    /// body_a, then for vertices of body_b
    pub contacts: *const u32,
}

/// A point of body_a and a point of body_b that must not pass through each other. Each is a weighted sum of vertices.
/// All vertices are in one list: first the vertices of body_a, whose weights add up to 1; then the vertices of body_b,
/// whose weights are negative and add up to -1. When vertex i is at x[i], gap = offset + dot(normal, sum of weights[i]
/// * x[i]) (vox_constraint_gap) is negative while the two overlap. Its gradient for vertex i is weights[i] * normal, so
/// a solver pushes vertex i in that direction, whatever the kind. With velocities in place of x, the sum is the
/// velocity of the point of body_a relative to the point of body_b, for damping and friction. kind vertices of body_a
/// vertices of body_b gap in the step INSIDE the vertex the tetrahedron that contains it minus the depth EDGE the edge
/// the face minus the depth of its part inside, from the middle of that part PROXIMITY the vertex the face with the
/// closest point the distance IMPACT the vertex the face that it met first minus the distance behind its plane A rigid
/// shape has no vertices and is always body_b. The plane of an IMPACT with it moves as the shape does.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct vox_constraint {
    pub body_a: vox_body,
    pub body_b: vox_body,
    pub kind: vox_constraint_kind,
    pub state: vox_depth_state,
    /// how many vertices of body_a
    pub count_a: u32,
    /// how many vertices in all
    pub count: u32,
    /// those beyond `count` are 0, and so are their weights
    pub vertices: [u32; 5],
    /// tetrahedron of body_b: the lowest that contains the vertex; with a face, the tetrahedron behind it. Triangle of
    /// a shape; VOX_NONE if it has none
    pub element_b: u32,
    /// of corners of a tetrahedron: rounded as in vox_location (vox_query.h)
    pub weights: [f64; 5],
    /// a unit vector out of body_b, the way for body_a
    pub normal: [f64; 3],
    pub gap: f64,
    pub offset: f64,
    /// of the point of body_a
    pub position: [f64; 3],
    /// when within the step, from 0 to 1, a vertex met the surface; 1 if that is not known
    pub time: f64,
    pub user_data_a: u64,
    pub user_data_b: u64,
    /// index of its pair in vox_grid_get_pairs
    pub pair: u32,
    /// index of the same constraint in the list of the step before, for a warm start; VOX_NONE if it is new. Same means
    /// the same vertex and body_b, or the same edge and face
    pub previous: u32,
    /// how many more its pair would have without max_constraints_per_pair
    pub left_out: u64,
}

/// Which constraints to find. By default all fields are 0: all constraints, with consistent depth.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct vox_constraint_desc {
    pub struct_size: u32,
    pub method: vox_depth_method,
    /// only pairs of this body; VOX_NULL_BODY: all pairs
    pub body_a: vox_body,
    /// only its pair with body_a; VOX_NULL_BODY: all pairs of body_a
    pub body_b: vox_body,
    /// only pairs in which the category of a body has a bit in common with it; 0: all pairs
    pub mask: u64,
    /// most searches for a closest point; constraints that get none are UNKNOWN, and the log has a warning. 0: no limit
    pub closest_budget: u64,
}

/// Constraints, sorted by pair, then by kind, body_a and vertices; the vertices of a face ascend. Pair p of
/// vox_grid_get_pairs has data[pair_offsets[p]] to data[pair_offsets[p + 1] - 1]. The arrays live until the end of the
/// epoch, or until constraints are found again.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct vox_constraint_view {
    pub data: *const vox_constraint,
    pub count: u64,
    /// pair_count + 1
    pub pair_offsets: *const u64,
    /// as in vox_pair_view.count
    pub pair_count: u64,
}

/// A body as it is now.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct vox_body_info {
    pub struct_size: u32,
    /// vox_shape_kind; VOX_SHAPE_NONE for a mesh
    pub shape: u32,
    pub user_data: u64,
    /// 1 or 0
    pub enabled: u32,
    /// vox_mesh_flags: COPY_POSITIONS if the grid owns the positions, BORROW_TETS while the caller owns the tetrahedra
    pub flags: u32,
    /// with disabled and removed ones: indices are below it
    pub tet_count: u64,
    pub enabled_tet_count: u64,
    /// of a mesh, without its transform; valid as long as they stay bound or mapped
    pub positions: vox_positions,
    pub filter: vox_filter,
    pub transform: [f64; 12],
}

/// A rigid shape. It is copied as a whole. Lengths may be 0.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct vox_shape_desc {
    pub struct_size: u32,
    pub kind: vox_shape_kind,
    pub radius: f64,
    /// of a capsule, between the centres of its round ends
    pub half_length: f64,
    /// half the sides of a box; of a box around the origin that holds the shape of a field
    pub half_size: [f64; 3],
    pub positions: vox_positions,
    /// 3 * triangle_count vertex indices; of a SOLID counter-clockwise as seen from outside
    pub triangles: *const u32,
    pub triangle_count: u64,
    /// columns * rows numbers: z at x = column * spacing[0], y = row * spacing[1] is heights[row * columns + column]. A
    /// cell is two triangles, divided from the lower left to the upper right
    pub heights: *const f64,
    pub columns: u32,
    pub rows: u32,
    pub spacing: [f64; 2],
    #[rustfmt::skip]
    /// Computes the distances of `count` points, x y z each, from the shape in its frame. For a point outside it is at
    /// most the true distance, up to rounding; for a point inside it is not above 0. Gradients, x y z each, point out
    /// of the shape; their length does not matter. Steps call it on several threads at once, with at most 8 points. It
    /// must not call the grid.
    pub field: Option<unsafe extern "C" fn(points: *const f64, count: u64, distances: *mut f64, gradients: *mut f64, user: *mut c_void)>,
    /// passed to `field` as `user`
    pub field_user: *mut c_void,
    pub user_data: u64,
    /// self-collision, rings and rest distance have no meaning
    pub filter: vox_filter,
}

/// A grid as it is now, and what its last successful step did.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct vox_grid_info {
    pub struct_size: u32,
    /// vox_grid_flags
    pub flags: u32,
    /// counts up when an epoch ends (see Ownership above)
    pub epoch: u64,
    /// as it was set, or else as it was used last; 0 before the first step
    pub cell_size: f64,
    pub margin: f64,
    /// held now, without the caller's arrays
    pub bytes: u64,
    pub peak_bytes: u64,
    /// nanoseconds
    pub step_ns: u64,
    /// bodies that were not at rest
    pub moved_bodies: u64,
    /// bodies that were left out (VOX_GRID_SKIP_BAD_BODIES)
    pub skipped_bodies: u64,
    /// pairs that began, in all steps so far
    pub total_began: u64,
    /// pairs that ended, in all steps so far
    pub total_ended: u64,
}

/// A count, or a time in nanoseconds, with its name.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct vox_counter {
    /// static text, e.g. "candidates" or "lookup_ns"
    pub name: *const c_char,
    pub value: u64,
}

/// Counters. A library always has the same ones in the same order.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct vox_counter_view {
    pub data: *const vox_counter,
    pub count: u64,
}

/// A body that made a step fail, or that a step left out.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct vox_failure {
    pub struct_size: u32,
    /// VOX_OK: there is no such body
    pub result: vox_result,
    pub body: vox_body,
    /// the first vertex with a bad coordinate; VOX_NONE if the failure is not about a vertex
    pub vertex: u32,
    pub user_data: u64,
    /// of that vertex, transformed
    pub position: [f64; 3],
}

/// Vertices to append.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct vox_vertices_desc {
    pub struct_size: u32,
    /// 0
    pub reserved: u32,
    pub count: u64,
    /// In the mesh's format. If the mesh borrows its positions: an array for all vertices, the old ones first, borrowed
    /// from now on. If it owns them: the positions of the new vertices, copied; or none, with copies_of.
    pub positions: vox_positions,
    /// `count` indices: the vertex whose position and rest position each one gets
    pub copies_of: *const u32,
    /// of the new vertices, if the mesh has a rest pose. Default: as copies_of says, or else `positions`
    pub rest_positions: vox_positions,
}

/// An allocator. `allocate` returns `size` bytes at `alignment` (a power of two), or null. `release` receives the same
/// size and alignment again. If both are null, the C++ runtime's heap is used. They are called only from functions of
/// the object they were given to, one call at a time, on the calling thread or on a thread that runs its tasks. A
/// locator that outlives its grid calls `release` on the thread that releases it.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct vox_allocator {
    #[rustfmt::skip]
    pub allocate: Option<unsafe extern "C" fn(size: usize, alignment: usize, user: *mut c_void) -> *mut c_void>,
    #[rustfmt::skip]
    pub release: Option<unsafe extern "C" fn(memory: *mut c_void, size: usize, alignment: usize, user: *mut c_void)>,
    pub user: *mut c_void,
}

/// Receives lines of text, valid during the call, on the thread that called the library. It must not call the grid.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct vox_log {
    #[rustfmt::skip]
    pub write: Option<unsafe extern "C" fn(level: vox_log_level, text: *const c_char, user: *mut c_void)>,
    pub user: *mut c_void,
}

/// The caller's scheduler, as in Box3D. `enqueue` splits the items [0, item_count) into ranges, of at least min_range
/// items where possible, and has `task` called once for each, now or later, on any thread. It returns a handle, for
/// which `finish` waits until these calls have returned; or null if they have already. If both are null, the built-in
/// scheduler is used. Both are called on the thread that called the library, at most VOX_MAX_TASKS times in a call. If
/// not every item is done exactly once, the library's call fails with INVALID_ARGUMENT.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct vox_task_system {
    #[rustfmt::skip]
    pub enqueue: Option<unsafe extern "C" fn(task: vox_task, item_count: u64, min_range: u64, context: *mut c_void, user: *mut c_void) -> *mut c_void>,
    #[rustfmt::skip]
    pub finish: Option<unsafe extern "C" fn(handle: *mut c_void, user: *mut c_void)>,
    pub user: *mut c_void,
}

/// Which bodies answer, and how far to look. All fields are 0 by default: all bodies, at any distance.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct vox_query_desc {
    pub struct_size: u32,
    /// vox_query_flags, combined with |
    pub flags: u32,
    /// only bodies whose category had a bit in common with it; 0: all
    pub mask: u64,
    /// not this body, e.g. the asking body; an id that the locator does not have excludes none
    pub excluded: vox_body,
    /// 0
    pub reserved: u32,
    /// vox_locator_locate, vox_locator_find_closest and vox_locator_find_closest_to_segments: no further than this, in
    /// the caller's unit; 0: any distance
    pub max_distance: f64,
}

/// Where a point is, and the weights that interpolate a field there. If several tetrahedra contain the point, this is
/// one of the lowest body: the lowest that has the point in its interior or, if there is none, the lowest that has it
/// on its boundary.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct vox_location {
    pub body: vox_body,
    pub tet: u32,
    pub state: vox_location_state,
    /// 0
    pub reserved: u32,
    /// Of the tetrahedron's corners, for the point or, if it is outside, for the closest point; VOX_QUERY_EXTRAPOLATE
    /// asks for the point. Each is rounded from the true weight once, or off by 2^-58 more. Exceptions are the closest
    /// points of facets thinner than 2^-20 of their length or with an edge below 2^-40 of the distance, and a flat
    /// tetrahedron is not extrapolated.
    pub weights: [f64; 4],
    /// to the closest point, in the caller's unit; 0 inside
    pub distance: f64,
}

/// A tetrahedron that contains a point.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct vox_point_hit {
    /// index of the point
    pub point: u32,
    pub body: vox_body,
    pub tet: u32,
    /// 0
    pub reserved: u32,
    /// of the tetrahedron's corners, in [0, 1], as in vox_location
    pub weights: [f64; 4],
}

/// A point of a surface. The surface of a mesh consists of the facets of exactly one of its tetrahedra. Facet k is
/// opposite corner k. The corners of facets are facet 0: corners 1, 2, 3 1: 0, 3, 2 2: 0, 1, 3 3: 0, 2, 1 of the
/// tetrahedron, counter-clockwise as seen from outside if its volume is positive.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct vox_closest_hit {
    /// VOX_NULL_BODY: no surface is within max_distance; all other fields but `inside` are 0
    pub body: vox_body,
    pub tet: u32,
    pub facet: u32,
    /// how many bodies contain the point; exact
    pub inside: u32,
    /// the vertices of the facet, in the order of its corners
    pub face: [u32; 3],
    /// 0
    pub reserved: u32,
    /// of these vertices, for the closest point, in [0, 1]
    pub weights: [f64; 3],
    /// of the closest point
    pub position: [f64; 3],
    /// A unit vector out of the facet's tetrahedron or, if that is flat, to the side away from the point. If the facet
    /// has no area, it points from the point to `position`, or is 0, 0, 1 if both coincide.
    pub normal: [f64; 3],
    /// from the point to `position`; negative if the body contains the point, which is exact
    pub distance: f64,
}

/// A tetrahedron whose bounding box meets a box.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct vox_box_hit {
    /// index of the box
    pub r#box: u32,
    pub body: vox_body,
    pub tet: u32,
}

/// A facet of a surface that a ray meets; see vox_closest_hit.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct vox_ray_hit {
    /// index of the ray
    pub ray: u32,
    pub body: vox_body,
    pub tet: u32,
    pub facet: u32,
    pub side: vox_side,
    /// the vertices of the facet, in the order of its corners
    pub face: [u32; 3],
    pub t: f64,
    /// of these vertices, in [0, 1]
    pub weights: [f64; 3],
}

/// The part of a segment that lies in one tetrahedron. A segment is a closed one, as a ray is.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct vox_track_piece {
    /// index of the segment
    pub segment: u32,
    pub body: vox_body,
    pub tet: u32,
    /// where the segment enters the tetrahedron, the lowest of several; VOX_NONE if the piece begins elsewhere
    pub facet_in: u32,
    /// where it leaves; VOX_NONE if the piece ends elsewhere
    pub facet_out: u32,
    /// 0
    pub reserved: u32,
    /// the doubles nearest to the true ones
    pub t_in: f64,
    pub t_out: f64,
}

/// A tetrahedron that a triangle meets, and the edges of it that the triangle cuts. Edges are 0: corners 0, 1 1: 0, 2
/// 2: 0, 3 3: 1, 2 4: 1, 3 5: 2, 3 of the tetrahedron.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct vox_triangle_hit {
    /// index of the triangle
    pub triangle: u32,
    pub body: vox_body,
    pub tet: u32,
    /// bit k: the triangle meets edge k, an end of it included
    pub edges: u32,
    /// when the triangle first meets the tetrahedron; 0 if it does at first. The double nearest to the true time.
    pub t: f64,
    /// where it first meets edge k, from 0 at the end with the lower vertex index to 1: the same for all tetrahedra
    /// that share the edge; 0 for edges that it does not meet
    pub s: [f64; 6],
}

/// A point of a cost curve.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct vox_cost_sample {
    pub cell_size: f64,
    pub cost: f64,
}

/// One kind of work: how often it is done at the suggested cell size, and what that costs.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct vox_cost_term {
    /// static text, e.g. "visit a cell"
    pub name: *const c_char,
    pub count: f64,
    pub cost: f64,
}

/// The cell size that a rule of thumb gives, and the predicted cost there.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct vox_cell_size_rule {
    /// static text, e.g. "mean edge (Teschner et al. 2003)"
    pub name: *const c_char,
    /// 0: the rule does not apply
    pub cell_size: f64,
    /// 0: not known
    pub cost: f64,
}

/// A run at one cell size, and how long it took.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct vox_timing {
    /// > 0
    pub cell_size: f64,
    /// 1e-30 to 1e30; in a result infinity if the run was impossible
    pub seconds: f64,
}

/// How many nanoseconds a foreign grid takes for each kind of work, >= 0.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct vox_foreign_weights {
    /// for a run, whatever the cell size
    pub run: f64,
    /// to store a primitive in a cell
    pub store: f64,
    /// to visit a cell in a query
    pub visit: f64,
    /// extra, to visit a cell that is not empty
    pub found: f64,
    /// to read a primitive in a visited cell
    pub read: f64,
    /// to create and drop a cell that is not empty
    pub occupied: f64,
    /// to clear a cell of a dense grid
    pub cell: f64,
}

/// A cell size and the reasons for it. Costs are seconds of a step or a run; for the model PAPER they are visits of
/// cells per tetrahedron. Fields that a function does not know are 0.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct vox_cell_size_result {
    pub struct_size: u32,
    /// vox_cell_size_warnings
    pub warnings: u32,
    pub cell_size: f64,
    /// the range around cell_size where the cost is at most (1 + zone_loss) times the least
    pub zone_min: f64,
    pub zone_max: f64,
    /// predicted at cell_size
    pub cost: f64,
    /// the smallest that gives right answers, or fits the byte budget; 0: any
    pub min_cell_size: f64,
    /// edge of the world divided by cell_size, as the paper counts
    pub cells_per_axis: f64,
    /// of fit and tune: root mean square of (fitted time / measured time - 1)
    pub fit_error: f64,
    /// of tune: how much longer a run may take than at the best cell size; 0.03 means 3 %
    pub expected_loss: f64,
    pub curve_count: u32,
    pub term_count: u32,
    pub rule_count: u32,
    pub timing_count: u32,
    /// ascending, evenly spaced in the logarithm of the cell size
    pub curve: [vox_cost_sample; 64],
    /// their costs add up to `cost`
    pub terms: [vox_cost_term; 12],
    pub rules: [vox_cell_size_rule; 8],
    /// of tune: the runs, in order
    pub timings: [vox_timing; 32],
    /// of foreign grids: those used, or those found by fit and tune
    pub weights: vox_foreign_weights,
    /// the warnings in words; "" if there are none
    pub note: [c_char; 256],
}

/// How many nanoseconds each kind of work takes on a machine, for the models REFERENCE and FAST. Measured by
/// vox_cost_calibrate; may be saved and loaded.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct vox_cost_weights {
    pub struct_size: u32,
    /// 1 if vox_cost_calibrate filled it
    pub measured: u32,
    /// in the library's own order; 0: the value shipped with the library
    pub ns: [f64; 24],
}

/// The paper's engine (Sect. 3), for vox_grid_desc.reference. It is serial and finds what the fast engine finds. If the
/// grid's cell_size is 0, it chooses by its cost model, and again when its counters call for another size.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct vox_reference_desc {
    pub struct_size: u32,
    /// vox_reference_flags, combined with |
    pub flags: u32,
    /// raised to the next prime; 0: twice the number of vertices
    pub hash_table_size: u64,
    /// DENSE: the box that has cells. Points outside go to the nearest cell. Both 0: the
    pub world_min: [f64; 3],
    /// box of all positions, in every step
    pub world_max: [f64; 3],
    /// copied; null: those shipped with the library
    pub weights: *const vox_cost_weights,
}

/// How to suggest a cell size; all 0 by default.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct vox_cell_size_desc {
    pub struct_size: u32,
    pub model: vox_cost_model,
    /// REFERENCE: vox_reference_flags, combined with |
    pub reference_flags: u32,
    /// 0
    pub reserved: u32,
    /// 0: 0.05
    pub zone_loss: f64,
    /// PAPER: the share of tetrahedra without a contact, in (0, 1); 0: 0.99
    pub p_nc: f64,
    /// PAPER: r, the cost of a particle test divided by the cost of a cell visit; 0: 5
    pub cost_ratio: f64,
    /// for cells_per_axis; 0: the longest side of the box of all vertices
    pub world_edge: f64,
    /// REFERENCE with DENSE cells: most bytes that these may take; 0: no limit
    pub byte_budget: u64,
    /// REFERENCE and FAST; null: those shipped with the library
    pub weights: *const vox_cost_weights,
    /// null: the C++ runtime's heap
    pub allocator: *const vox_allocator,
}

/// Sizes in meshes, as in the paper's tables.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct vox_geometry {
    pub struct_size: u32,
    pub reserved: u32,
    pub vertices: u64,
    pub tets: u64,
    /// unique
    pub edges: u64,
    /// unique
    pub facets: u64,
    /// of exactly one tetrahedron
    pub boundary_facets: u64,
    /// of zero volume; exact
    pub degenerate_tets: u64,
    pub mean_edge: f64,
    /// over tetrahedra
    pub mean_longest_edge: f64,
    /// over tetrahedra, the longest side of the box
    pub mean_box_side: f64,
    pub median_box_side: f64,
    /// over unique facets
    pub mean_facet_area: f64,
    /// over the four facets of each tetrahedron
    pub mean_tet_facet_area: f64,
    pub mean_boundary_facet_area: f64,
    pub mean_volume: f64,
    pub bounds_min: [f64; 3],
    pub bounds_max: [f64; 3],
}

/// An array of primitives. Only the box of each one matters: the box of its vertices, grown by its radius on all sides.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct vox_primitives {
    pub struct_size: u32,
    pub r#type: vox_primitive_type,
    /// of vertices
    pub positions: vox_positions,
    /// the vertices of each primitive; null: 0, 1, 2, ... in order
    pub indices: *const u32,
    /// from one primitive to the next; 0: packed
    pub index_byte_stride: u64,
    /// number of primitives
    pub count: u64,
    /// one number >= 0 for each primitive; null: 0
    pub radii: *const c_void,
    /// 0: packed
    pub radius_byte_stride: u64,
    pub radius_format: vox_format,
    /// 0
    pub reserved: u32,
    /// added to all radii
    pub radius: f64,
}

/// A uniform grid of another library. A run stores primitives in cells; then each query visits cells and reads the
/// primitives stored there.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct vox_foreign_grid {
    pub struct_size: u32,
    pub known: vox_known_grid,
    pub cells_stored: vox_cells_stored,
    pub cells_queried: vox_cells_queried,
    pub cells_kept: vox_cells_kept,
    /// 0
    pub reserved: u32,
    /// the primitives in cells; must be set
    pub stored: *const vox_primitives,
    /// the queries; null: the stored primitives query each other. With PAIRS it is a second set: each pair has one of
    /// either
    pub querying: *const vox_primitives,
    /// grows the boxes of queries on all sides
    pub radius: f64,
    /// the smallest that gives right answers; 0: any, or with 27 what the boxes demand
    pub min_cell_size: f64,
    /// 0: 0.05
    pub zone_loss: f64,
    /// all 0: as for the known grid
    pub weights: vox_foreign_weights,
    /// null: the C++ runtime's heap
    pub allocator: *const vox_allocator,
}

/// How often a run does what, on average over all positions of the lattice.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct vox_foreign_counts {
    /// primitives stored in a cell
    pub stored: f64,
    /// cells visited; with PAIRS, cells that store something
    pub visits: f64,
    /// visited cells that store nothing
    pub empty: f64,
    /// primitives read in visited cells; with PAIRS, pairs within a cell
    pub reads: f64,
    /// cells that store something
    pub occupied: f64,
    /// cells in the box of the stored primitives
    pub cells: f64,
}

/// How to tune; all 0 by default.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct vox_tune_desc {
    pub struct_size: u32,
    /// 3 to VOX_TIMING_CAPACITY; 0: 7
    pub max_runs: u32,
    /// the range of cell sizes to try; both 0: from 1/8 to 8 times the first
    pub min: f64,
    pub max: f64,
    /// the cell size to begin with; 0: as vox_foreign_grid_suggest says
    pub first: f64,
    /// stop when the expected loss is below this; 0: 0.02
    pub wanted_loss: f64,
}

/// The topology of a surface, which is copied. Faces may have any winding. Edges and faces may be degenerate or
/// duplicated.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct vox_surface_desc {
    pub struct_size: u32,
    /// as in vox_grid_desc
    pub worker_count: u32,
    /// at least 1
    pub vertex_count: u64,
    pub edge_count: u64,
    pub face_count: u64,
    /// 2 * edge_count vertex indices. Null: the edges of the faces, each once. Not null, with edge_count 0: no edges
    pub edges: *const u32,
    /// 3 * face_count vertex indices
    pub faces: *const u32,
    /// Patches say what may meet. Two features may meet if a vertex of one and a vertex of the other may. Two vertices
    /// may meet if the category of the patch of each has a bit in common with the mask of the patch of the other. the
    /// patch of each vertex; null: one patch for all
    pub patches: *const u32,
    /// patch_count numbers; null: 1 each
    pub patch_categories: *const u64,
    /// patch_count numbers; null: all bits
    pub patch_masks: *const u64,
    pub patch_count: u64,
    /// edge length of a cell; 0: the library chooses it for every motion. Never changes answers
    pub cell_size: f64,
    /// most bytes the surface may hold, lists included; 0: 4 GiB; UINT64_MAX: no limit
    pub byte_budget: u64,
    /// copied; null: the C++ runtime's heap
    pub allocator: *const vox_allocator,
    /// copied; null: the built-in scheduler
    pub tasks: *const vox_task_system,
}

/// The vertices of edges or faces.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct vox_feature_view {
    /// 2 * count indices for edges, 3 * count for faces
    pub vertices: *const u32,
    /// number of edges or faces
    pub count: u64,
}

/// Positions of all vertices, or a motion from one set of positions to another.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct vox_motion {
    pub struct_size: u32,
    /// vox_motion_flags, combined with |
    pub flags: u32,
    /// at time 0
    pub from: vox_positions,
    /// at time 1, in the same format; none: everything stands still
    pub to: vox_positions,
    /// grows the box of a vertex on all sides, rounded outward to the next number of the format, by one number also
    /// where it is 0; may be infinite
    pub radius: f64,
}

/// Lists of partners. Feature first + i has partners[offsets[i]] to partners[offsets[i + 1] - 1], ascending.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct vox_partner_lists {
    /// count + 1 numbers
    pub offsets: *const u64,
    pub partners: *const u32,
    pub first: u64,
    /// features with a list; fewer than the range has if the byte budget is short
    pub count: u64,
}

/// An edge and a face that have a point in common.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct vox_crossing {
    pub edge: u32,
    pub face: u32,
    pub kind: vox_crossing_kind,
    /// 0
    pub reserved: u32,
    /// of a common point; they add up to 1, as do the next
    pub edge_weights: [f64; 2],
    pub face_weights: [f64; 3],
    pub position: [f64; 3],
}

/// Crossings, sorted by (edge, face).
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct vox_crossing_view {
    pub data: *const vox_crossing,
    pub count: u64,
}

/// Two features and their closest points.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct vox_proximity {
    pub a: u32,
    pub b: u32,
    pub distance: f64,
    /// of the closest point of a: one for each of its vertices, then 0
    pub weights_a: [f64; 3],
    pub weights_b: [f64; 3],
    pub point_a: [f64; 3],
    pub point_b: [f64; 3],
}

/// Proximities, sorted by (a, b).
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct vox_proximity_view {
    pub data: *const vox_proximity,
    pub count: u64,
}

/// How times of impact are computed; all 0 by default.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct vox_impact_desc {
    pub struct_size: u32,
    /// for a pair, after which its time is too early; 0: 10000
    pub max_iterations: u32,
    /// two features meet when they come this close
    pub distance: f64,
    /// part of their first gap that may be left at the reported time, below 1; 0: 0.1. Smaller values take longer and
    /// allow larger steps
    pub slack: f64,
}

/// How much of the motion is free of impacts, and which pair ends it.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct vox_safe_step {
    /// nothing meets before this time; 1: nothing meets
    pub step: f64,
    /// number of pairs examined
    pub pairs: u64,
    /// the first pair to meet, if step is below 1: FACE and VERTEX, or EDGE and EDGE
    pub kind_a: vox_feature,
    pub kind_b: vox_feature,
    pub a: u32,
    pub b: u32,
    /// 1 if its time is early because of max_iterations, else 0
    pub unfinished: u32,
    /// 0
    pub reserved: u32,
}

/// Two features that may meet, and the earliest time.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct vox_impact {
    pub a: u32,
    pub b: u32,
    pub time: f64,
}

/// Impacts, sorted by (a, b).
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct vox_impact_view {
    pub data: *const vox_impact,
    pub count: u64,
}

#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct vox_io_load_desc {
    pub struct_size: u32,
    pub format: vox_io_format,
    /// which mesh of a scene file to take, from 1; 0: all, joined
    pub mesh: u32,
    /// vox_io_load_flags
    pub flags: u32,
    /// Where the arrays of the mesh live until vox_io_mesh_destroy. Copied; null: the C++ runtime's heap. Other memory
    /// that reading needs is taken from that heap and released at the end of the call.
    pub allocator: *const vox_allocator,
    #[rustfmt::skip]
    /// Called now and then, on the calling thread, with the fraction of the work done, ascending from 0 to 1: about
    /// half of it is reading, the rest the report. A result other than 0 cancels. May be null.
    pub progress: Option<unsafe extern "C" fn(fraction: f64, user: *mut c_void) -> i32>,
    pub progress_user: *mut c_void,
}

/// One file in memory. `name` supplies the extension and appears in error texts; may be null.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct vox_io_source {
    pub name: *const c_char,
    pub data: *const c_void,
    pub size: usize,
}

/// Arrays of a mesh; they live until vox_io_mesh_destroy. Indices count from 0.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct vox_io_mesh_view {
    pub positions: *const f64,
    pub vertex_count: u64,
    /// corners in the file's order
    pub tets: *const u32,
    pub tet_count: u64,
    /// as in the file
    pub triangles: *const u32,
    pub triangle_count: u64,
    /// A number for each tet, where the file has some that are not 0; else null. Physical groups of Gmsh (of several,
    /// the first), references of Medit, the last attribute of TetGen. Of VTK the cell array "region", "gmsh:physical",
    /// "medit:ref", "material" or the like, else the first that has one whole number for each cell.
    pub tet_regions: *const i32,
    /// For each vertex its number in the file, counted from 0 in the file's order, ascending; null if vertices were not
    /// left out. Values for vertex v belong to vertex file_vertices[v] of the file.
    pub file_vertices: *const u32,
    /// For each tet the number of its cell in the file, counted from 0 in the file's order through cells of every kind,
    /// ascending; null if tet t is cell t. Instances of a part in an Abaqus file count one after the other.
    pub tet_cells: *const u32,
}

/// What was read, what was left out, and what is odd about the mesh. A "surface" is a mesh without tets.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct vox_io_report {
    pub struct_size: u32,
    /// AUTO for a mesh that was not read from a file
    pub format: vox_io_format,
    pub vertices: u64,
    pub tets: u64,
    pub triangles: u64,
    /// elements of the file that are neither tet nor triangle
    pub skipped_elements: u64,
    /// tets of ten or more nodes, of which only the corners were used
    pub second_order_tets: u64,
    /// of negative volume, decided exactly
    pub inverted_tets: u64,
    /// of exactly zero volume
    pub degenerate_tets: u64,
    /// six times the volume below 1e-9 times the longest edge cubed, but not zero
    pub nearly_flat_tets: u64,
    /// the same four vertices as an earlier tet
    pub duplicate_tets: u64,
    /// triangles that name a vertex twice
    pub degenerate_triangles: u64,
    /// vertices at the position of an earlier one
    pub duplicate_vertices: u64,
    /// in no tet and no triangle
    pub unused_vertices: u64,
    /// facets of exactly one tet; for a surface: its triangles
    pub boundary_facets: u64,
    /// facets of more than two tets; for a surface: edges of more than two triangles
    pub non_manifold_facets: u64,
    /// for a surface: edges of exactly one triangle; 0 when it is closed
    pub open_edges: u64,
    /// for a surface: edges that two triangles run through in the same direction
    pub misoriented_edges: u64,
    /// parts connected by shared vertices; unused vertices are not counted
    pub components: u64,
    /// sum of the tets' volumes, inverted ones counted as positive; for a closed surface the enclosed volume, negative
    /// if it is inside out; otherwise 0
    pub volume: f64,
    /// bounding box of the vertices in use, or of all vertices if none is in use
    pub bounds_min: [f64; 3],
    pub bounds_max: [f64; 3],
    /// length of the file's unit; 0 if the file does not state it
    pub unit_in_metres: f64,
    /// vertices of the file that belong to no tet and are not in the mesh
    pub left_out_vertices: u64,
    /// triangles of the file that name one of them and are not in the mesh
    pub left_out_triangles: u64,
    /// hexahedra, wedges and pyramids of the file that were split into tets
    pub split_cells: u64,
    /// tets of ten or more nodes whose corners lie in one plane, exactly
    pub left_out_tets: u64,
}

#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct vox_io_tetrahedralize_desc {
    pub struct_size: u32,
    pub kind: vox_io_solid_kind,
    /// edge of a lattice cube; 0: a fiftieth of the surface's longest side
    pub cell: f64,
    /// more tets fail with LIMIT; 0: 100000000
    pub max_tets: u64,
    /// STUFFED: largest Hausdorff distance to the surface, as measured by vox_io_mesh_measure. Cells at the boundary
    /// are halved until the distance is met, while those inside keep the size `cell`; thin details may need many tets.
    /// Fails with LIMIT as soon as the way the distance falls would take more than four times max_tets. 0: cells are
    /// not halved, and no distance is guaranteed.
    pub max_distance: f64,
    /// STUFFED: how many times cells away from the boundary may be merged, eight into one. 0: all tets have the same
    /// size. The boundary does not change.
    pub coarsen: u32,
    /// 0
    pub reserved: u32,
    #[rustfmt::skip]
    /// Called now and then, on the calling thread, with the fraction of the work done, ascending from 0 to 1. A result
    /// other than 0 cancels. May be null.
    pub progress: Option<unsafe extern "C" fn(fraction: f64, user: *mut c_void) -> i32>,
    pub progress_user: *mut c_void,
    /// as vox_io_load_desc.allocator
    pub allocator: *const vox_allocator,
}

/// How good a tet mesh is, and how close its boundary is to a surface.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct vox_io_quality {
    pub struct_size: u32,
    pub reserved: u32,
    pub vertices: u64,
    pub tets: u64,
    pub boundary_facets: u64,
    /// smallest and largest angle between two facets of a tet, in degrees; 0 without tets
    pub min_dihedral: f64,
    pub max_dihedral: f64,
    /// sum of the signed tet volumes
    pub volume: f64,
    /// volume enclosed by the surface, signed by its orientation; 0 without a surface
    pub surface_volume: f64,
    /// Largest distance from sample points on the mesh's boundary to the surface, and the reverse. Samples are at most
    /// half a mean boundary edge apart on every triangle and include its corners; their distances are exact. 0 without
    /// a surface.
    pub mesh_to_surface: f64,
    pub surface_to_mesh: f64,
    /// the larger of the two
    pub hausdorff: f64,
}

/// Numbers attached to the vertices or cells, e.g. contacts or penetration depths. Cells are the triangles, then the
/// tets.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct vox_io_point_data {
    /// not empty, without control characters and double quotes
    pub name: *const c_char,
    /// Finite numbers, `components` for each vertex, or for each cell.
    pub values: *const f64,
    /// 1 (scalars), 3 (vectors) or 9 (tensors)
    pub components: u32,
    /// 0
    pub reserved: u32,
}

#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct vox_io_write_desc {
    pub struct_size: u32,
    pub format: vox_io_write_format,
    /// 0: text, from which the same doubles are read back; 1: binary, in this machine's byte order
    pub binary: u32,
    /// 0
    pub reserved: u32,
    /// read during the call
    pub point_data: *const vox_io_point_data,
    pub point_data_count: u64,
    /// with values for each cell
    pub cell_data: *const vox_io_point_data,
    pub cell_data_count: u64,
}

/// Receives `size` bytes of a file, in order, on the thread that writes. Returns 0 on success; any other value stops
/// the writing.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct vox_io_sink {
    #[rustfmt::skip]
    pub write: Option<unsafe extern "C" fn(data: *const c_void, size: usize, user: *mut c_void) -> i32>,
    pub user: *mut c_void,
}

/// Settings of a simulation. Each comment ends with the default, which vox_default_sim_desc() sets.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct vox_sim_desc {
    pub struct_size: u32,
    /// of a step, 1 to 10000; 10
    pub substeps: u32,
    /// substeps from one detection of contacts to the next, or 0 for no detection; 1
    pub detect_every: u32,
    /// 0
    pub reserved: u32,
    /// 0, 0, -9.81
    pub gravity: [f64; 3],
    /// longer steps are shortened to this; 1/30
    pub max_time_step: f64,
    /// particles stay where dot(floor_normal, x) >= floor_offset; all 0: no floor; 0, 0, 1
    pub floor_normal: [f64; 3],
    /// 0
    pub floor_offset: f64,
    /// Coulomb's coefficient; 0.5
    pub friction: f64,
    /// inverse stiffness of contacts, or 0 for the stiffest that a substep can handle; 0
    pub contact_compliance: f64,
    /// greatest speed at which older overlap is undone; 1
    pub max_push_speed: f64,
    /// depth that is tolerated, or -1 for a hundredth of the mean edge; -1
    pub contact_slop: f64,
    /// settings of the grid inside; null: the defaults
    pub grid: *const vox_grid_desc,
    pub log: *const vox_log,
    /// of the simulation and, unless `grid` has one, its grid
    pub allocator: *const vox_allocator,
}

/// A soft body, which is copied. Numbers in comments are the defaults, which vox_default_sim_body_desc() sets.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct vox_sim_body_desc {
    pub struct_size: u32,
    /// vox_sim_body_flags, combined with |
    pub flags: u32,
    /// 3 * vertex_count
    pub positions: *const f64,
    /// 3 * vertex_count: the undeformed shape; null: positions
    pub rest_positions: *const f64,
    /// 3 * vertex_count; null: 0
    pub velocities: *const f64,
    /// 4 * tet_count vertex indices, in either winding
    pub tets: *const u32,
    pub vertex_count: u64,
    /// at least 1
    pub tet_count: u64,
    /// mass over rest volume; 1000
    pub density: f64,
    /// resistance to stretching; 1e6
    pub youngs_modulus: f64,
    /// resistance to changes of volume, beyond what the edges have; 1e6
    pub bulk_modulus: f64,
    /// a time: damping of the edges over their stiffness; 0.01
    pub damping: f64,
    /// of the body in the grid
    pub user_data: u64,
}

/// The arrays of a body. The pointers stay valid until the body is removed; steps change the contents.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct vox_sim_body_view {
    /// 3 * vertex_count
    pub positions: *const f64,
    /// 3 * vertex_count
    pub velocities: *const f64,
    /// vertex_count
    pub masses: *const f64,
    /// 3 * vertex_count: positions rounded to float; the grid borrows them, or `positions` once floats round by more
    /// than 2^-14 of a mean edge, far from the origin
    pub grid_positions: *const f32,
    /// 4 * tet_count
    pub tets: *const u32,
    pub vertex_count: u64,
    pub tet_count: u64,
}

/// Energy and motion.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct vox_sim_energy {
    pub kinetic: f64,
    /// in gravity, 0 at the origin
    pub potential: f64,
    pub elastic: f64,
    pub mass: f64,
    pub momentum: [f64; 3],
    /// of mass
    pub centre: [f64; 3],
    /// of the fastest particle
    pub max_speed: f64,
}

/// A body whose intersections are to go: tetrahedra, or a surface without any.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct vox_resolve_body {
    pub struct_size: u32,
    /// vox_resolve_flags, combined with |
    pub flags: u32,
    /// 3 * vertex_count; vox_resolve replaces them
    pub positions: *mut f64,
    pub vertex_count: u64,
    /// 4 * tet_count vertex indices, in either winding
    pub tets: *const u32,
    pub tet_count: u64,
    /// 3 * face_count vertex indices; a body with tetrahedra has none
    pub faces: *const u32,
    pub face_count: u64,
    /// Results, which vox_resolve sets:
    pub moved_vertices: u64,
    /// of a vertex
    pub largest_move: f64,
    /// of the tetrahedra or in a closed surface; else 0
    pub volume_before: f64,
    /// afterwards
    pub volume: f64,
    /// whose signed volume has another sign than before
    pub inverted_tets: u64,
}

/// A place where something is left: an edge that meets a face, or two features closer than the gap.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct vox_resolve_place {
    /// indices into the bodies, which may be the same
    pub body_a: u32,
    pub body_b: u32,
    /// 0: they meet
    pub distance: f64,
    pub position: [f64; 3],
}

/// Settings; all 0 by default.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct vox_resolve_desc {
    pub struct_size: u32,
    /// as in vox_grid_desc
    pub worker_count: u32,
    /// 0: 400
    pub max_iterations: u32,
    /// 0
    pub reserved: u32,
    /// least distance of features without a common vertex; 0: they only do not meet
    pub gap: f64,
    /// no vertex moves further than this; 0: no limit
    pub max_move: f64,
    /// receives the first place_capacity places where something is left
    pub places: *mut vox_resolve_place,
    pub place_capacity: u64,
    pub allocator: *const vox_allocator,
}

/// What was done and what is left.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct vox_resolve_report {
    pub struct_size: u32,
    /// 1: nothing is left; else 0
    pub resolved: u32,
    /// edges that met a face before
    pub first_crossings: u64,
    /// edges that still do
    pub crossings: u64,
    /// vertices and edges that still are in a body
    pub inside_vertices: u64,
    /// pairs closer than the gap; 0 if there are crossings
    pub close_pairs: u64,
    /// greatest depth in a body before
    pub first_depth: f64,
    /// of close pairs; 0 if there are crossings; else the gap
    pub least_distance: f64,
    pub largest_move: f64,
    pub iterations: u64,
    /// of crossings and close pairs together
    pub place_count: u64,
}

#[rustfmt::skip]
extern "C" {
    /// Why the last failing call on this thread failed, e.g. "tet 17 names vertex 900 of 812"; "" if no call has
    /// failed. Bodies are named by id, slot and user data. Never null. The text lives until the next failing call on
    /// this thread.
    pub fn vox_last_error() -> *const c_char;
    /// Name of a result, e.g. "VOX_ERROR_BUDGET". Static text; never null.
    pub fn vox_result_string(result: vox_result) -> *const c_char;
    /// Creates a grid. The caller owns *out_grid and releases it with vox_grid_destroy. Errors: INVALID_ARGUMENT (names
    /// the field), OUT_OF_MEMORY, BUDGET.
    pub fn vox_grid_create(desc: *const vox_grid_desc, out_grid: *mut *mut vox_grid) -> vox_result;
    /// Destroys a grid, its bodies and results. Null does nothing.
    pub fn vox_grid_destroy(grid: *mut vox_grid);
    /// Adds a mesh, which takes part from the next step on. Positions whose format is FLOAT, but that can only be
    /// doubles, are refused when they are first read. Errors: INVALID_ARGUMENT, INVALID_MESH, LIMIT, INVALID_STATE and
    /// NON_FINITE (rest pose), BUDGET, OUT_OF_MEMORY.
    pub fn vox_mesh_insert(
        grid: *mut vox_grid,
        desc: *const vox_mesh_desc,
        out_body: *mut vox_body,
    ) -> vox_result;
    /// Removes a body. The results of the last step stay as they are; the next step ends the body's pairs.
    pub fn vox_body_remove(grid: *mut vox_grid, body: vox_body) -> vox_result;
    /// Makes a mesh borrow another array of positions, one for each vertex, in place of its present array. There is no
    /// need to bind the same array again after writing to it. Errors: INVALID_ARGUMENT (e.g. another count).
    pub fn vox_mesh_bind_positions(
        grid: *mut vox_grid,
        body: vox_body,
        positions: *const vox_positions,
    ) -> vox_result;
    /// Finds all contacts of the bodies as they are now, and whatever the flags ask for. This replaces the results of
    /// the previous step. If the step fails there are no results, and the grid stays usable. A body that has not moved
    /// costs little more than reading its positions. In the steady state a step allocates no memory; but the first
    /// search for a closest point in a body makes that body's tree, unless vox_grid_prepare did. Errors: INVALID_STATE
    /// (a mesh without positions), NON_FINITE, LIMIT, INVALID_ARGUMENT (doubles read as floats; a task system that
    /// broke its rules), BUDGET, OUT_OF_MEMORY. vox_grid_get_failure names the body.
    pub fn vox_grid_step(grid: *mut vox_grid) -> vox_result;
    /// Steps many different grids, several at a time: for many small scenes. worker_count and `tasks` are as in
    /// vox_grid_desc; each grid is stepped by one thread and should have a worker_count of 0 itself. If a grid fails,
    /// the others are stepped nevertheless; `results` receives the result of each. Returns the first failure, whose
    /// text says which grid. Errors: as vox_grid_step; INVALID_ARGUMENT (a null or repeated grid) or OUT_OF_MEMORY
    /// before any grid is stepped.
    pub fn vox_grids_step(
        grids: *const *mut vox_grid,
        count: u64,
        worker_count: u32,
        tasks: *const vox_task_system,
        results: *mut vox_result,
    ) -> vox_result;
    /// Gets the contacts of the last step. There are none before the first step and after a failed one.
    pub fn vox_grid_get_contacts(
        grid: *const vox_grid,
        out_view: *mut vox_contact_view,
    ) -> vox_result;
    /// Gets a hash of the contacts and their order, which is the same on every machine.
    pub fn vox_grid_get_hash(grid: *const vox_grid, out_hash: *mut u64) -> vox_result;
    /// Gets the pairs of the last step. There are none before the first step and after a failed one. Read them after
    /// every step, as each step reports only its own changes. The totals in vox_grid_info show whether a program has
    /// missed some.
    pub fn vox_grid_get_pairs(grid: *const vox_grid, out_view: *mut vox_pair_view) -> vox_result;
    /// Finds the constraints of the last step. This replaces constraints that were found before. With
    /// VOX_GRID_CONSTRAINTS every step does so itself. Call it before anything moves: positions must be as they were in
    /// the step, and no body of a pair may have been removed or edited. Constraints between bodies at rest are carried
    /// over. Errors: INVALID_STATE (no step yet; a body was removed or edited), INVALID_ARGUMENT, NON_FINITE, LIMIT,
    /// BUDGET, OUT_OF_MEMORY.
    pub fn vox_grid_find_constraints(
        grid: *mut vox_grid,
        desc: *const vox_constraint_desc,
    ) -> vox_result;
    /// Gets the constraints that were found last. Errors: INVALID_STATE if none were looked for since the last step.
    pub fn vox_grid_get_constraints(
        grid: *const vox_grid,
        out_view: *mut vox_constraint_view,
    ) -> vox_result;
    /// Places a body. In the following steps a position x, y, z stands for x' = ((m[0] * x + m[1] * y) + m[2] * z) +
    /// m[3], y' likewise with m[4..7], z' with m[8..11], computed in double in this order. Contacts are exact for x',
    /// y', z'. The matrix is copied; null: none. For a mesh it is any affine map; for a shape it rotates, moves, and
    /// scales all axes alike, and may be off by rounding to floats. Errors: INVALID_ARGUMENT (a number that is not
    /// finite, a map that is not of this kind), BUDGET, OUT_OF_MEMORY.
    pub fn vox_body_set_transform(
        grid: *mut vox_grid,
        body: vox_body,
        matrix: *const [f64; 12],
    ) -> vox_result;
    /// Disables a body (0), or enables it again (1). A disabled body takes no part in steps; its positions are not
    /// read. Errors: INVALID_ARGUMENT (another number).
    pub fn vox_body_set_enabled(grid: *mut vox_grid, body: vox_body, enabled: u32) -> vox_result;
    /// Sets what a body collides with from the next step on. Rings and rest distance are prepared in the call. Errors:
    /// INVALID_ARGUMENT, LIMIT, INVALID_STATE (no rest pose), NON_FINITE, BUDGET, OUT_OF_MEMORY.
    pub fn vox_body_set_filter(
        grid: *mut vox_grid,
        body: vox_body,
        filter: *const vox_filter,
    ) -> vox_result;
    /// Keeps two bodies from colliding, whatever their filters say (0), or lets their filters decide again (1). Ends
    /// when either body is removed. Errors: INVALID_ARGUMENT (another number; twice the same body), BUDGET,
    /// OUT_OF_MEMORY.
    pub fn vox_grid_set_pair_enabled(
        grid: *mut vox_grid,
        body_a: vox_body,
        body_b: vox_body,
        enabled: u32,
    ) -> vox_result;
    /// Makes the next step treat a body as if it had moved: for measurements.
    pub fn vox_body_mark_moved(grid: *mut vox_grid, body: vox_body) -> vox_result;
    /// Gives a mesh a packed array of its own, in its format, which the caller may write to between steps. It starts
    /// with the present positions, or zeros. It belongs to the grid and lives until other positions are bound, vertices
    /// are appended or replaced, or the mesh is removed. Calling this again returns the same array. Errors: BUDGET,
    /// OUT_OF_MEMORY.
    pub fn vox_mesh_map_positions(
        grid: *mut vox_grid,
        body: vox_body,
        out_positions: *mut *mut c_void,
    ) -> vox_result;
    /// Makes a mesh borrow the positions that its vertices had before. In the following steps each vertex moves from
    /// there to its position, in a straight line at constant speed, and steps also find IMPACT constraints. None is
    /// missed. A vertex that misses a surface by no more than rounding errors may be reported. Bodies without previous
    /// positions stand still. The transform does not apply to previous positions. Null ends this, as does a change of
    /// the mesh's vertices. Snapshots do not keep it. Errors: INVALID_ARGUMENT.
    pub fn vox_mesh_bind_previous_positions(
        grid: *mut vox_grid,
        body: vox_body,
        positions: *const vox_positions,
    ) -> vox_result;
    /// Gets a body's state. Set out_info->struct_size first. `positions` lives as its comment says.
    pub fn vox_body_get_info(
        grid: *const vox_grid,
        body: vox_body,
        out_info: *mut vox_body_info,
    ) -> vox_result;
    /// Gets the user_data that a body was inserted with.
    pub fn vox_body_get_user_data(
        grid: *const vox_grid,
        body: vox_body,
        out_user_data: *mut u64,
    ) -> vox_result;
    /// Returns 1 if `body` names a body of the grid, else 0; gives 0 for a null grid. Cannot fail.
    pub fn vox_body_is_valid(grid: *const vox_grid, body: vox_body) -> u32;
    /// Gets the first `capacity` bodies of the grid in ascending order, disabled ones included; `bodies` may be null if
    /// it is 0. *out_count is the number of all. Errors: INVALID_ARGUMENT.
    pub fn vox_grid_get_bodies(
        grid: *const vox_grid,
        bodies: *mut vox_body,
        capacity: u64,
        out_count: *mut u64,
    ) -> vox_result;
    /// Adds a shape, which takes part from the next step on. The vertices of meshes collide with it. With
    /// VOX_GRID_EDGES, so do their edges and faces, with the flat sides of a BOX, HEIGHTFIELD, SOLID or SHEET. Shapes
    /// do not collide with each other. A shape has pairs and constraints, but no contacts, and is always body_b. A
    /// vertex is looked at in the shape's frame, where its place is computed in double. Whether that place is in the
    /// shape is decided exactly, but for a FIELD and a SHEET with a radius. The surface is part of the shape. The gap
    /// of a HALF_SPACE, SPHERE or BOX is off by at most one unit in the last place, unless the shape is scaled. The gap
    /// of others is rounded in proportion to the coordinates. An EDGE constraint has the two vertices of an edge of the
    /// mesh, or the three of a face that an edge of the shape passes through. An edge of the mesh is as deep as the
    /// middle of its part in the shape. A SHEET has no inside: the shorter part of the edge has to leave. A face has to
    /// move until the middle of the part behind it is on its plane. Errors: INVALID_ARGUMENT, INVALID_MESH (e.g. an
    /// open SOLID), NON_FINITE, LIMIT, BUDGET, OUT_OF_MEMORY.
    pub fn vox_shape_insert(
        grid: *mut vox_grid,
        desc: *const vox_shape_desc,
        out_body: *mut vox_body,
    ) -> vox_result;
    /// Says where a shape was before. In the following steps it moves from there to its transform, and steps also find
    /// IMPACT constraints with it. Each vertex moves through the shape's frame in a straight line, at constant speed. A
    /// vertex that begins in a shape, or on its surface, does not meet it. On a SHEET without a radius it is on neither
    /// side, and may still meet triangles other than those that it begins on. The matrix is as in
    /// vox_body_set_transform, and copied; null ends this. Snapshots do not keep it. Errors: INVALID_ARGUMENT (e.g. a
    /// mesh, which has vox_mesh_bind_previous_positions), OUT_OF_MEMORY, BUDGET.
    pub fn vox_shape_set_previous_transform(
        grid: *mut vox_grid,
        body: vox_body,
        matrix: *const [f64; 12],
    ) -> vox_result;
    /// Removes all bodies and results, and keeps the settings. The next step ends all pairs.
    pub fn vox_grid_clear(grid: *mut vox_grid) -> vox_result;
    /// Allocates memory for this many bodies and contacts in advance, besides what the bodies themselves need. Errors:
    /// LIMIT, BUDGET, OUT_OF_MEMORY.
    pub fn vox_grid_reserve(grid: *mut vox_grid, body_count: u32, contact_count: u64) -> vox_result;
    /// Makes now what steps make of a mesh once, when they first need it: topology, rings, tiles of its surface and the
    /// tree over that, as far as the flags, the margin and its filter ask for them. Meshes without positions are passed
    /// over. It takes no room for results, and leaves the results of the last step as they are. Errors: NON_FINITE,
    /// LIMIT, INVALID_ARGUMENT (doubles read as floats), BUDGET, OUT_OF_MEMORY.
    pub fn vox_grid_prepare(grid: *mut vox_grid) -> vox_result;
    /// Sets vox_grid_desc.cell_size for the following steps. Errors: INVALID_ARGUMENT (negative, infinite, NaN).
    pub fn vox_grid_set_cell_size(grid: *mut vox_grid, cell_size: f64) -> vox_result;
    /// Sets vox_grid_desc.worker_count for the following steps. Errors: INVALID_ARGUMENT.
    pub fn vox_grid_set_worker_count(grid: *mut vox_grid, worker_count: u32) -> vox_result;
    /// Sets all vox_grid_desc.flags for the following steps. Memory that is no longer needed is released. Errors:
    /// INVALID_ARGUMENT, UNSUPPORTED (in this build).
    pub fn vox_grid_set_flags(grid: *mut vox_grid, flags: u32) -> vox_result;
    /// Sets the margin for the following steps: vertices outside another body, but no further than this from its
    /// surface, have PROXIMITY constraints, and the two bodies are a pair. 0, the default: none, at no cost. Snapshots
    /// lack it. Errors: INVALID_ARGUMENT (negative, NaN, above 2^125), UNSUPPORTED (in this build).
    pub fn vox_grid_set_margin(grid: *mut vox_grid, margin: f64) -> vox_result;
    /// Gets a grid's state. Set out_info->struct_size first.
    pub fn vox_grid_get_info(grid: *const vox_grid, out_info: *mut vox_grid_info) -> vox_result;
    /// Gets counts and times of the last step, stage by stage (docs/engine.md lists them). They live until the end of
    /// the epoch.
    pub fn vox_grid_get_counters(
        grid: *const vox_grid,
        out_view: *mut vox_counter_view,
    ) -> vox_result;
    /// Gets the body that made the last step fail, with index 0; or else the bodies that it left out, with indices from
    /// 0 on. Set out_failure->struct_size first. Errors: INVALID_ARGUMENT.
    pub fn vox_grid_get_failure(
        grid: *const vox_grid,
        index: u32,
        out_failure: *mut vox_failure,
    ) -> vox_result;
    /// Replaces vertices, tetrahedra and positions by what desc has. Id, user data, filter, transform and disabled
    /// pairs stay. If desc has no positions, but as many vertices as the mesh, positions and rest pose stay, too.
    /// Errors: also INVALID_STATE and NON_FINITE (rest pose).
    pub fn vox_mesh_set_topology(
        grid: *mut vox_grid,
        body: vox_body,
        desc: *const vox_mesh_desc,
    ) -> vox_result;
    /// Disables tetrahedra (0), or enables them again (1). A disabled tetrahedron contains no vertices and has no edges
    /// and faces. Its vertices still collide with others.
    pub fn vox_mesh_set_tets_enabled(
        grid: *mut vox_grid,
        body: vox_body,
        tets: *const u32,
        count: u64,
        enabled: u32,
    ) -> vox_result;
    /// Gives tetrahedron tets[i] the corners corners[4 * i] to corners[4 * i + 3].
    pub fn vox_mesh_replace_tets(
        grid: *mut vox_grid,
        body: vox_body,
        tets: *const u32,
        count: u64,
        corners: *const u32,
    ) -> vox_result;
    /// Adds `count` tetrahedra with four corners each. *out_first is the index of the first; the others follow.
    pub fn vox_mesh_append_tets(
        grid: *mut vox_grid,
        body: vox_body,
        corners: *const u32,
        count: u64,
        out_first: *mut u32,
    ) -> vox_result;
    /// Removes tetrahedra. Their vertices stay.
    pub fn vox_mesh_remove_tets(
        grid: *mut vox_grid,
        body: vox_body,
        tets: *const u32,
        count: u64,
    ) -> vox_result;
    /// Adds vertices, which belong to no tetrahedron yet. *out_first is the index of the first; the others follow.
    /// Errors: also INVALID_STATE (a mesh with a rest pose, a vertex without), NON_FINITE.
    pub fn vox_mesh_append_vertices(
        grid: *mut vox_grid,
        body: vox_body,
        desc: *const vox_vertices_desc,
        out_first: *mut u32,
    ) -> vox_result;
    /// Removes vertices that belong to no enabled tetrahedron. Their positions are still read and must stay finite.
    pub fn vox_mesh_remove_vertices(
        grid: *mut vox_grid,
        body: vox_body,
        vertices: *const u32,
        count: u64,
    ) -> vox_result;
    /// Copies the first `capacity` tetrahedra: four corners each, and 1 if it is enabled or 0 if it is disabled or
    /// removed. *out_count is the number of all.
    pub fn vox_mesh_get_tets(
        grid: *const vox_grid,
        body: vox_body,
        corners: *mut u32,
        enabled: *mut u8,
        capacity: u64,
        out_count: *mut u64,
    ) -> vox_result;
    /// Writes a grid to `bytes`, in a format that is the same on every machine (docs/snapshot.md): settings, bodies
    /// with their ids and positions, and which pairs touch. It does not contain allocator, log, tasks, worker_count,
    /// byte_budget, margin, previous positions and results. *out_size is the number of bytes; with `bytes` null nothing
    /// is written. Errors: INVALID_ARGUMENT (the capacity is too small), INVALID_STATE (a shape with a FIELD).
    pub fn vox_grid_save(
        grid: *const vox_grid,
        bytes: *mut c_void,
        capacity: u64,
        out_size: *mut u64,
    ) -> vox_result;
    /// Creates a grid from a snapshot. Ids name the same bodies, and steps give the same results. Meshes own their
    /// positions; map or bind positions to move them. desc supplies what snapshots do not contain; its flags, cell_size
    /// and max_constraints_per_pair are ignored. The bytes need not be trusted. The caller owns *out_grid and releases
    /// it with vox_grid_destroy. Errors: FORMAT (names the place), UNSUPPORTED (a later version), INVALID_ARGUMENT,
    /// LIMIT, BUDGET, OUT_OF_MEMORY.
    pub fn vox_grid_load(
        bytes: *const c_void,
        size: u64,
        desc: *const vox_grid_desc,
        out_grid: *mut *mut vox_grid,
    ) -> vox_result;
    /// The version of the library at run time: major * 1000000 + minor * 1000 + patch. Cannot fail.
    pub fn vox_version() -> u32;
    /// The VOX_ABI_VERSION of the library at run time. Cannot fail.
    pub fn vox_abi_version() -> u32;
    /// Version, compiler, instruction sets, scheduler and options of the library, in one line. Static text; never null.
    pub fn vox_build_info() -> *const c_char;
    /// Sets this thread's vox_last_error() to a copy of `text`, of 1023 bytes at most, and returns `result`: for
    /// libraries that report failures in the same way. Null counts as "". Cannot fail itself.
    pub fn vox_fail(result: vox_result, text: *const c_char) -> vox_result;
}

#[rustfmt::skip]
extern "C" {
    /// Takes a locator of the grid as it is now, and releases what *locator held before, if anything. The caller owns
    /// *locator and releases it with vox_locator_release. The first call after a mesh was inserted or edited takes
    /// longer. If the call fails, *locator stays as it is. A locator uses the grid's memory, within its byte budget:
    /// about 36 bytes a vertex and 28 a tetrahedron, and 12 a tetrahedron that all locators of a grid share. The memory
    /// of released locators is used again, so that a program that takes one in every frame soon allocates nothing;
    /// vox_grid_clear and vox_grid_destroy return it. If a locator outlives its grid, its last release returns its
    /// memory, on the thread that calls. Errors: INVALID_STATE (a mesh without positions), NON_FINITE, LIMIT,
    /// INVALID_ARGUMENT (doubles under VOX_FORMAT_FLOAT, see vox_mesh_insert; a defective task system), BUDGET,
    /// OUT_OF_MEMORY.
    pub fn vox_grid_update_locator(
        grid: *mut vox_grid,
        locator: *mut *mut vox_locator,
    ) -> vox_result;
    /// Adds an owner, who has to release the locator as well: so one thread can still ask it while another takes the
    /// next one. The caller must be sure that nobody releases the last owner meanwhile.
    pub fn vox_locator_retain(locator: *mut vox_locator) -> vox_result;
    /// Removes an owner. The locator ends with its last owner. Null does nothing.
    pub fn vox_locator_release(locator: *mut vox_locator);
    /// Gets vox_grid_info.epoch of the moment when the locator was taken.
    pub fn vox_locator_get_epoch(locator: *const vox_locator, out_epoch: *mut u64) -> vox_result;
    /// Gets the user_data of a body, even if it was removed since. Errors: INVALID_HANDLE (the locator does not have
    /// it).
    pub fn vox_locator_get_user_data(
        locator: *const vox_locator,
        body: vox_body,
        out_user_data: *mut u64,
    ) -> vox_result;
    /// Locates points: out_locations[i] is for point i, and depends on no other point. No point inside a mesh is
    /// missed, on whatever facet, edge or vertex it is. Many points in one call are located several times as fast as
    /// one by one, whatever their order. Errors: also INVALID_ARGUMENT (a negative or NaN max_distance).
    pub fn vox_locator_locate(
        locator: *const vox_locator,
        points: *const vox_positions,
        desc: *const vox_query_desc,
        out_locations: *mut vox_location,
    ) -> vox_result;
    /// Finds the tetrahedra that contain points, by the rule of vox_contact: every tetrahedron of a body that has the
    /// point in its interior or, if there is none, the lowest that has it on its boundary. Sorted by (point, body,
    /// tet). Many points in one call are found several times as fast as one by one, whatever their order.
    pub fn vox_locator_find_point_hits(
        locator: *const vox_locator,
        points: *const vox_positions,
        desc: *const vox_query_desc,
        hits: *mut vox_point_hit,
        capacity: u64,
        out_count: *mut u64,
    ) -> vox_result;
    /// Finds the closest point of all surfaces: out_hits[i] is for point i. If several are equally close, the lowest
    /// (body, tet, facet) counts. Points that are close together should follow each other: each search begins at the
    /// facet found before. Errors: also INVALID_ARGUMENT (a negative or NaN max_distance).
    pub fn vox_locator_find_closest(
        locator: *const vox_locator,
        points: *const vox_positions,
        desc: *const vox_query_desc,
        out_hits: *mut vox_closest_hit,
    ) -> vox_result;
    /// Finds the tetrahedra whose bounding box has a point in common with the closed box from min[i] to max[i], decided
    /// exactly and sorted by (box, body, tet). They include all tetrahedra that meet the box themselves, also
    /// tetrahedra of zero volume. Corners may be infinite. Errors: INVALID_ARGUMENT (arrays of different lengths; a min
    /// that is not <= its max).
    pub fn vox_locator_find_box_hits(
        locator: *const vox_locator,
        min: *const vox_positions,
        max: *const vox_positions,
        desc: *const vox_query_desc,
        hits: *mut vox_box_hit,
        capacity: u64,
        out_count: *mut u64,
    ) -> vox_result;
    /// Finds the facets of surfaces that rays meet, sorted by (ray, t, body, tet, facet). Which facets a ray meets is
    /// exact; t, and so the order, is rounded. A ray through an edge or a vertex meets all facets there. A ray in the
    /// plane of a facet does not meet it.
    pub fn vox_locator_find_ray_hits(
        locator: *const vox_locator,
        from: *const vox_positions,
        to: *const vox_positions,
        desc: *const vox_query_desc,
        hits: *mut vox_ray_hit,
        capacity: u64,
        out_count: *mut u64,
    ) -> vox_result;
    /// Tests whether each ray meets a tetrahedron that has a volume: out_blocked[i] is 1 or 0, which is exact. The
    /// search for a ray ends at the first such tetrahedron. from[i] = to[i] tests a point.
    pub fn vox_locator_test_rays(
        locator: *const vox_locator,
        from: *const vox_positions,
        to: *const vox_positions,
        desc: *const vox_query_desc,
        out_blocked: *mut u8,
    ) -> vox_result;
    /// Finds the tetrahedra that segments pass through, sorted by (segment, body, t_in, t_out, tet). By the rule of
    /// vox_contact, a stretch of a segment belongs to every tetrahedron of a body that has it in its interior. If none
    /// has, it belongs to the lowest that has it in a facet or an edge. So the pieces in a body whose tetrahedra do not
    /// overlap have no gap inside the body and do not overlap: t_out of one is t_in of the next, bit for bit. Which
    /// tetrahedra a segment passes through is exact. A point is no piece: segments that only touch a tetrahedron, and
    /// those without length, have none there. Many segments in one call are found about ten times as fast as one by
    /// one, apart from those through edges and vertices. The first such call for a mesh takes 16 bytes a tetrahedron
    /// from the heap, until it is edited or no locator has it.
    pub fn vox_locator_find_tracks(
        locator: *const vox_locator,
        from: *const vox_positions,
        to: *const vox_positions,
        desc: *const vox_query_desc,
        pieces: *mut vox_track_piece,
        capacity: u64,
        out_count: *mut u64,
    ) -> vox_result;
    /// Finds the closest points of segments and all surfaces, e.g. of a capsule's axis: it touches where the distance
    /// is less than its radius. out_hits[i] is for the closed segment from from[i] to to[i], as for a point: `position`
    /// is the point of the surface that is closest to the segment. If the segment meets the surface, which is exact,
    /// the distance is 0. `inside` and the sign say where from[i] is: put the tip of a tool there, and ask
    /// vox_locator_find_closest how deep it is. Segments that are close together should follow each other. Errors: as
    /// vox_locator_find_closest, and INVALID_ARGUMENT (arrays of different lengths).
    pub fn vox_locator_find_closest_to_segments(
        locator: *const vox_locator,
        from: *const vox_positions,
        to: *const vox_positions,
        desc: *const vox_query_desc,
        out_hits: *mut vox_closest_hit,
    ) -> vox_result;
    /// Finds the tetrahedra that triangles meet, sorted by (triangle, body, t, tet): for a cut, in order along the
    /// motion. Points 3 i, 3 i + 1 and 3 i + 2 are the corners of triangle i, which may be a segment, e.g. a needle or
    /// the edge of a blade, or a point. With `to`, each corner moves on a line and steadily, from its place in `from`,
    /// where t is 0, to `to`, where t is 1. A hit is then a tetrahedron that the triangle meets at any time. Without, t
    /// is 0. Which tetrahedra and edges a triangle meets is exact, touching included, also for tetrahedra without
    /// volume; s is rounded. Errors: also INVALID_ARGUMENT (a count that is no multiple of 3; arrays of different
    /// lengths).
    pub fn vox_locator_find_triangle_hits(
        locator: *const vox_locator,
        from: *const vox_positions,
        to: *const vox_positions,
        desc: *const vox_query_desc,
        hits: *mut vox_triangle_hit,
        capacity: u64,
        out_count: *mut u64,
    ) -> vox_result;
}

#[rustfmt::skip]
extern "C" {
    /// Suggests the cell size with the least cost for these meshes as they are now. Set out->struct_size first. The
    /// elements of `meshes` are meshes[0].struct_size bytes apart. Their filters count only for self-collision. Large
    /// meshes are sampled: with PAPER, meshes of more than 200,000 tetrahedra. Errors: INVALID_ARGUMENT (also if no
    /// tetrahedron has a size), INVALID_MESH, NON_FINITE, LIMIT, OUT_OF_MEMORY, UNSUPPORTED (SURFACE in a build without
    /// surfaces).
    pub fn vox_suggest_cell_size(
        desc: *const vox_cell_size_desc,
        meshes: *const vox_mesh_desc,
        mesh_count: u64,
        out: *mut vox_cell_size_result,
    ) -> vox_result;
    /// Suggests a cell size for the meshes of a grid. It is faster, as samples are smaller. Without desc it uses the
    /// model of the grid's engine. If p_nc is 0, it is taken from the last step. Errors: as vox_suggest_cell_size; also
    /// INVALID_STATE (a mesh without positions).
    pub fn vox_grid_suggest_cell_size(
        grid: *const vox_grid,
        desc: *const vox_cell_size_desc,
        out: *mut vox_cell_size_result,
    ) -> vox_result;
    /// Measures this machine's weights with steps over a small scene, in about ten milliseconds. Set out->struct_size
    /// first. Errors: OUT_OF_MEMORY.
    pub fn vox_cost_calibrate(out: *mut vox_cost_weights) -> vox_result;
    /// Measures meshes, which are given as for vox_suggest_cell_size. Above 200,000 tetrahedra, means are estimated
    /// from samples. Set out->struct_size first. Errors: INVALID_ARGUMENT, INVALID_MESH, NON_FINITE, OUT_OF_MEMORY.
    pub fn vox_measure_geometry(
        meshes: *const vox_mesh_desc,
        mesh_count: u64,
        out: *mut vox_geometry,
    ) -> vox_result;
    /// Finds the cell size between min and max with the least cost: a scan evenly spaced in the logarithm, then a
    /// golden-section search, in about a hundred calls. zone_loss 0 means 0.05. Set out->struct_size first. Errors:
    /// INVALID_ARGUMENT (unless 0 < min <= max; no finite cost; a negative least cost).
    pub fn vox_cost_minimise(
        cost: vox_cost_function,
        user: *mut c_void,
        min: f64,
        max: f64,
        zone_loss: f64,
        out: *mut vox_cell_size_result,
    ) -> vox_result;
    /// Suggests the cell size with the least cost. Set out->struct_size first. Many primitives are sampled. Errors:
    /// INVALID_ARGUMENT (also for no primitives, and for 27 without CENTRE), INVALID_MESH, NON_FINITE, LIMIT,
    /// OUT_OF_MEMORY.
    pub fn vox_foreign_grid_suggest(
        grid: *const vox_foreign_grid,
        out: *mut vox_cell_size_result,
    ) -> vox_result;
    /// Predicts the counts of a run at a cell size, for comparison with a program's own counters. Errors: as
    /// vox_foreign_grid_suggest; also INVALID_ARGUMENT (not a finite number above 0) and LIMIT (much too small).
    pub fn vox_foreign_grid_count(
        grid: *const vox_foreign_grid,
        cell_size: f64,
        out: *mut vox_foreign_counts,
    ) -> vox_result;
    /// Finds weights and cell size from timings of whole runs at three or more cell sizes; 0.6, 1.2 and 2.4 mean edges
    /// will do. It fits by non-negative least squares of relative errors. The weights also hold for other scenes in the
    /// same grid. Set out->struct_size first. Errors: as vox_foreign_grid_suggest; also INVALID_ARGUMENT (too few
    /// timings, or one out of range).
    pub fn vox_foreign_grid_fit(
        grid: *const vox_foreign_grid,
        timings: *const vox_timing,
        count: u64,
        out: *mut vox_cell_size_result,
    ) -> vox_result;
    /// Finds the best cell size by running the grid a few times. Without a description of the grid, desc->first must be
    /// set. The same times lead to the same runs and the same result. Set out->struct_size first. Errors: as
    /// vox_foreign_grid_suggest; also INVALID_STATE (no run succeeded), INVALID_ARGUMENT (a run of less than 1e-30
    /// seconds).
    pub fn vox_foreign_grid_tune(
        grid: *const vox_foreign_grid,
        desc: *const vox_tune_desc,
        run: vox_foreign_run,
        user: *mut c_void,
        out: *mut vox_cell_size_result,
    ) -> vox_result;
}

#[rustfmt::skip]
extern "C" {
    /// Creates a surface without positions. The caller owns *out_surface and releases it with vox_surface_destroy.
    /// Errors: INVALID_ARGUMENT, INVALID_MESH ("face 17 names vertex 900 of 812"), LIMIT, BUDGET, OUT_OF_MEMORY.
    pub fn vox_surface_create(
        desc: *const vox_surface_desc,
        out_surface: *mut *mut vox_surface,
    ) -> vox_result;
    /// Destroys a surface. Null does nothing.
    pub fn vox_surface_destroy(surface: *mut vox_surface);
    /// Gets the edges or faces of a surface, in the order of their indices. They live as long as the surface. Errors:
    /// INVALID_ARGUMENT (VERTEX).
    pub fn vox_surface_get_features(
        surface: *const vox_surface,
        feature: vox_feature,
        out_view: *mut vox_feature_view,
    ) -> vox_result;
    /// Sets the motion that all other functions answer for. Positions are read during the call. Errors:
    /// INVALID_ARGUMENT, NON_FINITE and LIMIT (name the vertex), BUDGET, OUT_OF_MEMORY.
    pub fn vox_surface_move(surface: *mut vox_surface, motion: *const vox_motion) -> vox_result;
    /// Finds, for the features [first, first + count) of kind a, the features of kind b whose boxes overlap or touch
    /// theirs. The box of a feature contains it during the whole motion. If a and b are the same kind, the lower
    /// feature lists the pair. Pairs with a common vertex, pairs ruled out by patches and culled pairs are left out.
    /// The range ends at the last feature. If the byte budget is too short for all lists, call again with first =
    /// out_lists->first + out_lists->count.
    pub fn vox_surface_find_pairs(
        surface: *mut vox_surface,
        a: vox_feature,
        b: vox_feature,
        first: u64,
        count: u64,
        out_lists: *mut vox_partner_lists,
    ) -> vox_result;
    /// Finds all edges and faces that have a point in common, but no vertex, at the end of the motion: none if the
    /// surface does not intersect itself. Decided exactly. Pairs ruled out by patches are left out. The radius does not
    /// matter.
    pub fn vox_surface_find_crossings(
        surface: *mut vox_surface,
        out_view: *mut vox_crossing_view,
    ) -> vox_result;
    /// Finds all pairs of features of kinds a and b that are at most `distance` apart at the end of the motion. The
    /// kinds are face and vertex, edge and edge, edge and vertex, or vertex and vertex, in either order. Pairs with a
    /// common vertex and pairs ruled out by patches are left out. The radius does not matter. Errors: also
    /// INVALID_ARGUMENT (other kinds; a negative, infinite or NaN distance).
    pub fn vox_surface_find_proximities(
        surface: *mut vox_surface,
        a: vox_feature,
        b: vox_feature,
        distance: f64,
        out_view: *mut vox_proximity_view,
    ) -> vox_result;
    /// Finds a distance for each vertex, at most max_distance, such that nothing new touches while no vertex moves
    /// further than its distance from the end of the motion (Chen et al. 2025, Offset Geometric Contact, Sect. 3.3).
    /// Pairs with a common vertex and pairs ruled out by patches do not count. out_distances has room for one number
    /// per vertex. Errors: also INVALID_ARGUMENT (max_distance is not a finite number above 0).
    pub fn vox_surface_find_clearances(
        surface: *mut vox_surface,
        max_distance: f64,
        out_distances: *mut f64,
    ) -> vox_result;
    /// Finds the earliest time at which a face and a vertex, or two edges, may meet. Pairs that touch at time 0 give 0.
    /// Pairs with a common vertex and pairs ruled out by patches are left out.
    pub fn vox_surface_find_safe_step(
        surface: *mut vox_surface,
        desc: *const vox_impact_desc,
        out: *mut vox_safe_step,
    ) -> vox_result;
    /// Finds all pairs of FACE and VERTEX, or of EDGE and EDGE, that may meet during the motion. Pairs with a common
    /// vertex and pairs ruled out by patches are left out. All other pairs provably stay apart. Errors: also
    /// INVALID_ARGUMENT (other kinds).
    pub fn vox_surface_find_impacts(
        surface: *mut vox_surface,
        a: vox_feature,
        b: vox_feature,
        desc: *const vox_impact_desc,
        out_view: *mut vox_impact_view,
    ) -> vox_result;
    /// Sets vox_surface_desc.cell_size for the following calls. Errors: INVALID_ARGUMENT (negative, infinite, NaN).
    pub fn vox_surface_set_cell_size(surface: *mut vox_surface, cell_size: f64) -> vox_result;
    /// Suggests the cell size with the least cost for finding the pairs of kinds a and b. Set out->struct_size first.
    /// Errors: also INVALID_ARGUMENT (no such features, an infinite radius).
    pub fn vox_surface_suggest_cell_size(
        surface: *mut vox_surface,
        a: vox_feature,
        b: vox_feature,
        out: *mut vox_cell_size_result,
    ) -> vox_result;
    /// Gets counts of the last search and the bytes held (docs/surface-pairs.md lists them). They live until the next
    /// call that uses the surface.
    pub fn vox_surface_get_counters(
        surface: *const vox_surface,
        out_view: *mut vox_counter_view,
    ) -> vox_result;
}

#[cfg(feature = "io")]
#[rustfmt::skip]
extern "C" {
    /// Reads the file at `path` (for TetGen either file of the pair; the other must be beside it, as must files that a
    /// .gltf names). desc null: defaults. A surface takes at most 16 times the size of its files and 16 MB of memory;
    /// one that stands for more triangles or vertices than that fails with LIMIT. A regular file is mapped into memory
    /// while it is read and must not be shortened meanwhile. Errors: FILE, FORMAT (the text names the file, the line or
    /// byte, and what was expected there), UNSUPPORTED, LIMIT, OUT_OF_MEMORY, INVALID_ARGUMENT, INVALID_STATE
    /// (cancelled).
    pub fn vox_io_load(
        path: *const c_char,
        desc: *const vox_io_load_desc,
        out_mesh: *mut *mut vox_io_mesh,
    ) -> vox_result;
    /// The same from memory. `sources` holds one file or, for TetGen, two: .node and .ele in any order.
    pub fn vox_io_read(
        sources: *const vox_io_source,
        source_count: usize,
        desc: *const vox_io_load_desc,
        out_mesh: *mut *mut vox_io_mesh,
    ) -> vox_result;
    /// Releases a mesh. Null does nothing.
    pub fn vox_io_mesh_destroy(mesh: *mut vox_io_mesh);
    /// The mesh's arrays.
    pub fn vox_io_mesh_get_arrays(
        mesh: *const vox_io_mesh,
        out_view: *mut vox_io_mesh_view,
    ) -> vox_result;
    /// Describes the mesh for vox_mesh_insert and vox_suggest_cell_size: sets positions, tets and tet_count, and leaves
    /// all other fields of `desc` as they are. Fill it with vox_default_mesh_desc() first. Positions are borrowed: keep
    /// the mesh as long as they are bound, or set VOX_MESH_COPY_POSITIONS. As they never change, a body that moves gets
    /// others: vox_mesh_map_positions, vox_mesh_bind_positions or vox_body_set_transform. Triangles are not described.
    /// docs/files.md has a whole program. Errors: INVALID_ARGUMENT (null, or a struct_size that does not reach to
    /// tet_count).
    pub fn vox_io_mesh_describe(mesh: *const vox_io_mesh, desc: *mut vox_mesh_desc) -> vox_result;
    /// Makes a mesh from arrays (copied) on the C++ runtime's heap. Nothing is left out. Errors: INVALID_ARGUMENT,
    /// INVALID_MESH, NON_FINITE, LIMIT (more than VOX_MAX_VERTICES or VOX_MAX_TETS), OUT_OF_MEMORY.
    pub fn vox_io_mesh_create(
        arrays: *const vox_io_mesh_view,
        out_mesh: *mut *mut vox_io_mesh,
    ) -> vox_result;
    /// Writes the fields that out_report->struct_size covers (set it first).
    pub fn vox_io_mesh_get_report(
        mesh: *const vox_io_mesh,
        out_report: *mut vox_io_report,
    ) -> vox_result;
    /// The problems in the report as text, one line each ("3 tets are inverted"); "" if there are none. Lives until
    /// vox_io_mesh_destroy. Cannot fail; null for a null mesh.
    pub fn vox_io_mesh_get_warnings(mesh: *const vox_io_mesh) -> *const c_char;
    /// Name of a format, e.g. "Gmsh .msh". Static text; never null.
    pub fn vox_io_format_string(format: vox_io_format) -> *const c_char;
    /// Fills the inside of a closed surface (the triangles of `surface`; its tets are ignored) with tetrahedra. desc
    /// null: defaults. All tets have positive volume, no two overlap, and inner facets are shared by exactly two. The
    /// surface may have any orientation, consist of several parts, and intersect itself. Inside is where its winding
    /// number is not zero or, if its triangles do not agree on an orientation, where rays cross it an odd number of
    /// times. Holes up to about the size of a cell are closed. Details thinner than a cell may be lost, and edges are
    /// rounded by a fraction of a cell (max_distance prevents both). The same input gives the same tets, bit for bit.
    /// Memory and time are proportional to the number of cells inside. Errors: INVALID_ARGUMENT (no triangles, no
    /// volume, no tet fits in), NON_FINITE, INVALID_MESH (the surface is open; not for CUBES), LIMIT (more than 4096
    /// cells along an axis, more than max_tets), INVALID_STATE (cancelled), OUT_OF_MEMORY.
    pub fn vox_io_tetrahedralize(
        surface: *const vox_io_mesh,
        desc: *const vox_io_tetrahedralize_desc,
        out_mesh: *mut *mut vox_io_mesh,
    ) -> vox_result;
    /// Measures `mesh` against the triangles of `surface`, which may be null. Writes the fields that
    /// out_quality->struct_size covers (set it first). Errors: INVALID_ARGUMENT, OUT_OF_MEMORY.
    pub fn vox_io_mesh_measure(
        mesh: *const vox_io_mesh,
        surface: *const vox_io_mesh,
        out_quality: *mut vox_io_quality,
    ) -> vox_result;
    /// Writes vertices, triangles and tets, in the mesh's order, and the tets' regions: as physical groups in .msh, as
    /// the cell array "region" in .vtu, unless cell_data has one of that name. desc null: defaults. An existing file at
    /// `path` is replaced at the end, and only if everything was written. Errors: FILE, INVALID_ARGUMENT (names the
    /// field), NON_FINITE, UNSUPPORTED (the extension), LIMIT (more elements than .msh 2.2 can number), OUT_OF_MEMORY.
    pub fn vox_io_write(
        mesh: *const vox_io_mesh,
        path: *const c_char,
        desc: *const vox_io_write_desc,
    ) -> vox_result;
    /// As vox_io_write, but passes the bytes to `sink`. desc->format must not be AUTO. Errors: as vox_io_write, and
    /// FILE if the sink fails; the bytes it received before that are not a complete file.
    pub fn vox_io_write_to(
        mesh: *const vox_io_mesh,
        desc: *const vox_io_write_desc,
        sink: *const vox_io_sink,
    ) -> vox_result;
    /// A ball of `radius` around the origin, made of about `tet_count` tetrahedra. It consists of the cubes of a
    /// lattice that are inside the ball, each split into five tetrahedra; boundary vertices are moved onto the sphere,
    /// and interior ones smoothed by three Laplace sweeps. The count is met within 1 % for 1000 tets and more.
    pub fn vox_io_make_lattice_ball(
        tet_count: u64,
        radius: f64,
        out_mesh: *mut *mut vox_io_mesh,
    ) -> vox_result;
    /// A ball by isosurface stuffing on a lattice of cubes with edge `cell`. It and the three bodies below have the
    /// dihedral angles of vox_io_tetrahedralize.
    pub fn vox_io_make_ball(radius: f64, cell: f64, out_mesh: *mut *mut vox_io_mesh) -> vox_result;
    /// A torus around the z axis. `radius` is the distance from the axis to the middle of the tube; tube_radius <
    /// radius.
    pub fn vox_io_make_torus(
        radius: f64,
        tube_radius: f64,
        cell: f64,
        out_mesh: *mut *mut vox_io_mesh,
    ) -> vox_result;
    /// A capsule along the z axis. `length` is the distance between the centres of the two round ends.
    pub fn vox_io_make_capsule(
        radius: f64,
        length: f64,
        cell: f64,
        out_mesh: *mut *mut vox_io_mesh,
    ) -> vox_result;
    /// A cylinder along the z axis. Its rims are rounded by a fraction of a cell.
    pub fn vox_io_make_cylinder(
        radius: f64,
        length: f64,
        cell: f64,
        out_mesh: *mut *mut vox_io_mesh,
    ) -> vox_result;
    /// An exact box of cubes with edges of about `cell`, stretched so that a whole number of them fits each side, and
    /// split into five tets each.
    pub fn vox_io_make_box(
        size_x: f64,
        size_y: f64,
        size_z: f64,
        cell: f64,
        out_mesh: *mut *mut vox_io_mesh,
    ) -> vox_result;
}

#[cfg(feature = "sim")]
#[rustfmt::skip]
extern "C" {
    /// Creates a simulation without bodies. The caller owns *out_sim and releases it with vox_sim_destroy. Errors:
    /// INVALID_ARGUMENT (names the field), OUT_OF_MEMORY, BUDGET.
    pub fn vox_sim_create(desc: *const vox_sim_desc, out_sim: *mut *mut vox_sim) -> vox_result;
    /// Destroys a simulation with its bodies and its grid. Null does nothing.
    pub fn vox_sim_destroy(sim: *mut vox_sim);
    /// Gets the grid inside, for reading results, for setting cell size and workers, and for rigid shapes: those
    /// inserted there hold and push the bodies. A step moves a shape at constant speed from where it was in the step
    /// before to where vox_body_set_transform has placed it since; disable it for a step to let it jump. The grid lives
    /// as long as the simulation. Do not destroy it, and do not edit, move or bind the bodies' meshes there.
    pub fn vox_sim_get_grid(sim: *const vox_sim, out_grid: *mut *mut vox_grid) -> vox_result;
    /// Advances everything by time_step. Errors: INVALID_ARGUMENT (not a finite number of at least 1e-12), and errors
    /// of vox_grid_step and vox_grid_find_constraints. After these the bodies are as they were after the last completed
    /// substep.
    pub fn vox_sim_step(sim: *mut vox_sim, time_step: f64) -> vox_result;
    /// Adds a body. *out_body is also its id in the grid. Errors: INVALID_ARGUMENT (also a body without volume),
    /// INVALID_MESH, NON_FINITE, LIMIT, BUDGET, OUT_OF_MEMORY.
    pub fn vox_sim_body_insert(
        sim: *mut vox_sim,
        desc: *const vox_sim_body_desc,
        out_body: *mut vox_body,
    ) -> vox_result;
    /// Removes a body from the simulation and its grid.
    pub fn vox_sim_body_remove(sim: *mut vox_sim, body: vox_body) -> vox_result;
    /// Gets the arrays of a body. They live until the body is removed.
    pub fn vox_sim_body_get_view(
        sim: *const vox_sim,
        body: vox_body,
        out_view: *mut vox_sim_body_view,
    ) -> vox_result;
    /// Sets positions and velocities of a body, 3 * vertex_count numbers each; null leaves them as they are. Errors:
    /// NON_FINITE, INVALID_ARGUMENT (beyond 1e15).
    pub fn vox_sim_body_set_state(
        sim: *mut vox_sim,
        body: vox_body,
        positions: *const f64,
        velocities: *const f64,
    ) -> vox_result;
    /// Gets energy and motion of a body, or of all bodies that are not fixed (VOX_NULL_BODY), in the middle of the last
    /// substep.
    pub fn vox_sim_get_energy(
        sim: *const vox_sim,
        body: vox_body,
        out_energy: *mut vox_sim_energy,
    ) -> vox_result;
    /// Gets sizes, totals and times (docs/sim.md lists them). They live until the next call that changes the
    /// simulation.
    pub fn vox_sim_get_counters(sim: *const vox_sim, out_view: *mut vox_counter_view) -> vox_result;
    /// Moves bodies apart until no edge meets a face and all features without a common vertex are `gap` apart, by small
    /// steps of XPBD that keep the lengths of edges and the volumes of tetrahedra. Once nothing crosses, no step makes
    /// a crossing. A closed surface is a body with an inside; other surfaces have two sides. The same input gives the
    /// same bits, with any number of workers. Set struct_size of the report first. Errors: INVALID_ARGUMENT,
    /// INVALID_MESH, NON_FINITE, LIMIT, BUDGET, OUT_OF_MEMORY; positions are then as before.
    pub fn vox_resolve(
        desc: *const vox_resolve_desc,
        bodies: *mut vox_resolve_body,
        body_count: u64,
        out_report: *mut vox_resolve_report,
    ) -> vox_result;
}

// Of each struct size, alignment, and offsets of its fields: [on 64-bit machines, in WebAssembly and on other 32-bit
// machines that align everything to its own size].
macro_rules! layouts {
    ($($name:ident: size $size:tt, alignment $alignment:tt, { $($field:ident: $offset:tt),* })*) => {
        #[cfg(any(target_pointer_width = "64", all(target_pointer_width = "32", not(target_arch = "x86"))))]
        const _: () = {
            use core::mem::{align_of, offset_of, size_of};
            const MODEL: usize = if cfg!(target_pointer_width = "64") { 0 } else { 1 };
            $(
                assert!(size_of::<$name>() == $size[MODEL], concat!("size of ", stringify!($name)));
                assert!(align_of::<$name>() == $alignment[MODEL], concat!("alignment of ", stringify!($name)));
                $(assert!(
                    offset_of!($name, $field) == $offset[MODEL],
                    concat!("offset of ", stringify!($name), ".", stringify!($field))
                );)*
            )*
        };
    };
}
layouts! {
    vox_positions: size [40, 40], alignment [8, 8], { data: [0, 0], count: [8, 8], format: [16, 16], reserved: [20, 20],
        byte_stride: [24, 24], component_byte_stride: [32, 32] }
    vox_grid_desc: size [72, 56], alignment [8, 8], { struct_size: [0, 0], flags: [4, 4], worker_count: [8, 8],
        max_constraints_per_pair: [12, 12], cell_size: [16, 16], margin: [24, 24], byte_budget: [32, 32],
        allocator: [40, 40], log: [48, 44], tasks: [56, 48], reference: [64, 52] }
    vox_filter: size [40, 40], alignment [8, 8], { flags: [0, 0], group: [4, 4], category: [8, 8], mask: [16, 16],
        world: [24, 24], self_rings: [28, 28], self_rest_distance: [32, 32] }
    vox_mesh_desc: size [152, 152], alignment [8, 8], { struct_size: [0, 0], flags: [4, 4], positions: [8, 8],
        tets: [48, 48], tet_count: [56, 56], user_data: [64, 64], filter: [72, 72], rest_positions: [112, 112] }
    vox_contact: size [16, 16], alignment [4, 4], { body_a: [0, 0], vertex: [4, 4], body_b: [8, 8], tet: [12, 12] }
    vox_contact_view: size [24, 24], alignment [8, 8], { data: [0, 0], count: [8, 8], interiors: [16, 16] }
    vox_pair: size [48, 48], alignment [8, 8], { body_a: [0, 0], body_b: [4, 4], user_data_a: [8, 8],
        user_data_b: [16, 16], state: [24, 24], reserved: [28, 28], first_contact: [32, 32], contact_count: [40, 40] }
    vox_pair_view: size [24, 24], alignment [8, 8], { data: [0, 0], count: [8, 8], contacts: [16, 16] }
    vox_constraint: size [192, 192], alignment [8, 8], { body_a: [0, 0], body_b: [4, 4], kind: [8, 8], state: [12, 12],
        count_a: [16, 16], count: [20, 20], vertices: [24, 24], element_b: [44, 44], weights: [48, 48],
        normal: [88, 88], gap: [112, 112], offset: [120, 120], position: [128, 128], time: [152, 152],
        user_data_a: [160, 160], user_data_b: [168, 168], pair: [176, 176], previous: [180, 180], left_out: [184, 184] }
    vox_constraint_desc: size [32, 32], alignment [8, 8], { struct_size: [0, 0], method: [4, 4], body_a: [8, 8],
        body_b: [12, 12], mask: [16, 16], closest_budget: [24, 24] }
    vox_constraint_view: size [32, 32], alignment [8, 8], { data: [0, 0], count: [8, 8], pair_offsets: [16, 16],
        pair_count: [24, 24] }
    vox_body_info: size [216, 216], alignment [8, 8], { struct_size: [0, 0], shape: [4, 4], user_data: [8, 8],
        enabled: [16, 16], flags: [20, 20], tet_count: [24, 24], enabled_tet_count: [32, 32], positions: [40, 40],
        filter: [80, 80], transform: [120, 120] }
    vox_shape_desc: size [200, 192], alignment [8, 8], { struct_size: [0, 0], kind: [4, 4], radius: [8, 8],
        half_length: [16, 16], half_size: [24, 24], positions: [48, 48], triangles: [88, 88], triangle_count: [96, 96],
        heights: [104, 104], columns: [112, 108], rows: [116, 112], spacing: [120, 120], field: [136, 136],
        field_user: [144, 140], user_data: [152, 144], filter: [160, 152] }
    vox_grid_info: size [88, 88], alignment [8, 8], { struct_size: [0, 0], flags: [4, 4], epoch: [8, 8],
        cell_size: [16, 16], margin: [24, 24], bytes: [32, 32], peak_bytes: [40, 40], step_ns: [48, 48],
        moved_bodies: [56, 56], skipped_bodies: [64, 64], total_began: [72, 72], total_ended: [80, 80] }
    vox_counter: size [16, 16], alignment [8, 8], { name: [0, 0], value: [8, 8] }
    vox_counter_view: size [16, 16], alignment [8, 8], { data: [0, 0], count: [8, 8] }
    vox_failure: size [48, 48], alignment [8, 8], { struct_size: [0, 0], result: [4, 4], body: [8, 8], vertex: [12, 12],
        user_data: [16, 16], position: [24, 24] }
    vox_vertices_desc: size [104, 104], alignment [8, 8], { struct_size: [0, 0], reserved: [4, 4], count: [8, 8],
        positions: [16, 16], copies_of: [56, 56], rest_positions: [64, 64] }
    vox_allocator: size [24, 12], alignment [8, 4], { allocate: [0, 0], release: [8, 4], user: [16, 8] }
    vox_log: size [16, 8], alignment [8, 4], { write: [0, 0], user: [8, 4] }
    vox_task_system: size [24, 12], alignment [8, 4], { enqueue: [0, 0], finish: [8, 4], user: [16, 8] }
    vox_query_desc: size [32, 32], alignment [8, 8], { struct_size: [0, 0], flags: [4, 4], mask: [8, 8],
        excluded: [16, 16], reserved: [20, 20], max_distance: [24, 24] }
    vox_location: size [56, 56], alignment [8, 8], { body: [0, 0], tet: [4, 4], state: [8, 8], reserved: [12, 12],
        weights: [16, 16], distance: [48, 48] }
    vox_point_hit: size [48, 48], alignment [8, 8], { point: [0, 0], body: [4, 4], tet: [8, 8], reserved: [12, 12],
        weights: [16, 16] }
    vox_closest_hit: size [112, 112], alignment [8, 8], { body: [0, 0], tet: [4, 4], facet: [8, 8], inside: [12, 12],
        face: [16, 16], reserved: [28, 28], weights: [32, 32], position: [56, 56], normal: [80, 80],
        distance: [104, 104] }
    vox_box_hit: size [12, 12], alignment [4, 4], { r#box: [0, 0], body: [4, 4], tet: [8, 8] }
    vox_ray_hit: size [64, 64], alignment [8, 8], { ray: [0, 0], body: [4, 4], tet: [8, 8], facet: [12, 12],
        side: [16, 16], face: [20, 20], t: [32, 32], weights: [40, 40] }
    vox_track_piece: size [40, 40], alignment [8, 8], { segment: [0, 0], body: [4, 4], tet: [8, 8], facet_in: [12, 12],
        facet_out: [16, 16], reserved: [20, 20], t_in: [24, 24], t_out: [32, 32] }
    vox_triangle_hit: size [72, 72], alignment [8, 8], { triangle: [0, 0], body: [4, 4], tet: [8, 8], edges: [12, 12],
        t: [16, 16], s: [24, 24] }
    vox_cost_sample: size [16, 16], alignment [8, 8], { cell_size: [0, 0], cost: [8, 8] }
    vox_cost_term: size [24, 24], alignment [8, 8], { name: [0, 0], count: [8, 8], cost: [16, 16] }
    vox_cell_size_rule: size [24, 24], alignment [8, 8], { name: [0, 0], cell_size: [8, 8], cost: [16, 16] }
    vox_timing: size [16, 16], alignment [8, 8], { cell_size: [0, 0], seconds: [8, 8] }
    vox_foreign_weights: size [56, 56], alignment [8, 8], { run: [0, 0], store: [8, 8], visit: [16, 16],
        found: [24, 24], read: [32, 32], occupied: [40, 40], cell: [48, 48] }
    vox_cell_size_result: size [2416, 2416], alignment [8, 8], { struct_size: [0, 0], warnings: [4, 4],
        cell_size: [8, 8], zone_min: [16, 16], zone_max: [24, 24], cost: [32, 32], min_cell_size: [40, 40],
        cells_per_axis: [48, 48], fit_error: [56, 56], expected_loss: [64, 64], curve_count: [72, 72],
        term_count: [76, 76], rule_count: [80, 80], timing_count: [84, 84], curve: [88, 88], terms: [1112, 1112],
        rules: [1400, 1400], timings: [1592, 1592], weights: [2104, 2104], note: [2160, 2160] }
    vox_cost_weights: size [200, 200], alignment [8, 8], { struct_size: [0, 0], measured: [4, 4], ns: [8, 8] }
    vox_reference_desc: size [72, 72], alignment [8, 8], { struct_size: [0, 0], flags: [4, 4], hash_table_size: [8, 8],
        world_min: [16, 16], world_max: [40, 40], weights: [64, 64] }
    vox_cell_size_desc: size [72, 64], alignment [8, 8], { struct_size: [0, 0], model: [4, 4], reference_flags: [8, 8],
        reserved: [12, 12], zone_loss: [16, 16], p_nc: [24, 24], cost_ratio: [32, 32], world_edge: [40, 40],
        byte_budget: [48, 48], weights: [56, 56], allocator: [64, 60] }
    vox_geometry: size [168, 168], alignment [8, 8], { struct_size: [0, 0], reserved: [4, 4], vertices: [8, 8],
        tets: [16, 16], edges: [24, 24], facets: [32, 32], boundary_facets: [40, 40], degenerate_tets: [48, 48],
        mean_edge: [56, 56], mean_longest_edge: [64, 64], mean_box_side: [72, 72], median_box_side: [80, 80],
        mean_facet_area: [88, 88], mean_tet_facet_area: [96, 96], mean_boundary_facet_area: [104, 104],
        mean_volume: [112, 112], bounds_min: [120, 120], bounds_max: [144, 144] }
    vox_primitives: size [104, 104], alignment [8, 8], { struct_size: [0, 0], r#type: [4, 4], positions: [8, 8],
        indices: [48, 48], index_byte_stride: [56, 56], count: [64, 64], radii: [72, 72], radius_byte_stride: [80, 80],
        radius_format: [88, 88], reserved: [92, 92], radius: [96, 96] }
    vox_foreign_grid: size [128, 120], alignment [8, 8], { struct_size: [0, 0], known: [4, 4], cells_stored: [8, 8],
        cells_queried: [12, 12], cells_kept: [16, 16], reserved: [20, 20], stored: [24, 24], querying: [32, 28],
        radius: [40, 32], min_cell_size: [48, 40], zone_loss: [56, 48], weights: [64, 56], allocator: [120, 112] }
    vox_foreign_counts: size [48, 48], alignment [8, 8], { stored: [0, 0], visits: [8, 8], empty: [16, 16],
        reads: [24, 24], occupied: [32, 32], cells: [40, 40] }
    vox_tune_desc: size [40, 40], alignment [8, 8], { struct_size: [0, 0], max_runs: [4, 4], min: [8, 8], max: [16, 16],
        first: [24, 24], wanted_loss: [32, 32] }
    vox_surface_desc: size [112, 88], alignment [8, 8], { struct_size: [0, 0], worker_count: [4, 4],
        vertex_count: [8, 8], edge_count: [16, 16], face_count: [24, 24], edges: [32, 32], faces: [40, 36],
        patches: [48, 40], patch_categories: [56, 44], patch_masks: [64, 48], patch_count: [72, 56],
        cell_size: [80, 64], byte_budget: [88, 72], allocator: [96, 80], tasks: [104, 84] }
    vox_feature_view: size [16, 16], alignment [8, 8], { vertices: [0, 0], count: [8, 8] }
    vox_motion: size [96, 96], alignment [8, 8], { struct_size: [0, 0], flags: [4, 4], from: [8, 8], to: [48, 48],
        radius: [88, 88] }
    vox_partner_lists: size [32, 24], alignment [8, 8], { offsets: [0, 0], partners: [8, 4], first: [16, 8],
        count: [24, 16] }
    vox_crossing: size [80, 80], alignment [8, 8], { edge: [0, 0], face: [4, 4], kind: [8, 8], reserved: [12, 12],
        edge_weights: [16, 16], face_weights: [32, 32], position: [56, 56] }
    vox_crossing_view: size [16, 16], alignment [8, 8], { data: [0, 0], count: [8, 8] }
    vox_proximity: size [112, 112], alignment [8, 8], { a: [0, 0], b: [4, 4], distance: [8, 8], weights_a: [16, 16],
        weights_b: [40, 40], point_a: [64, 64], point_b: [88, 88] }
    vox_proximity_view: size [16, 16], alignment [8, 8], { data: [0, 0], count: [8, 8] }
    vox_impact_desc: size [24, 24], alignment [8, 8], { struct_size: [0, 0], max_iterations: [4, 4], distance: [8, 8],
        slack: [16, 16] }
    vox_safe_step: size [40, 40], alignment [8, 8], { step: [0, 0], pairs: [8, 8], kind_a: [16, 16], kind_b: [20, 20],
        a: [24, 24], b: [28, 28], unfinished: [32, 32], reserved: [36, 36] }
    vox_impact: size [16, 16], alignment [8, 8], { a: [0, 0], b: [4, 4], time: [8, 8] }
    vox_impact_view: size [16, 16], alignment [8, 8], { data: [0, 0], count: [8, 8] }
    vox_io_load_desc: size [40, 28], alignment [8, 4], { struct_size: [0, 0], format: [4, 4], mesh: [8, 8],
        flags: [12, 12], allocator: [16, 16], progress: [24, 20], progress_user: [32, 24] }
    vox_io_source: size [24, 12], alignment [8, 4], { name: [0, 0], data: [8, 4], size: [16, 8] }
    vox_io_mesh_view: size [72, 64], alignment [8, 8], { positions: [0, 0], vertex_count: [8, 8], tets: [16, 16],
        tet_count: [24, 24], triangles: [32, 32], triangle_count: [40, 40], tet_regions: [48, 48],
        file_vertices: [56, 52], tet_cells: [64, 56] }
    vox_io_report: size [240, 240], alignment [8, 8], { struct_size: [0, 0], format: [4, 4], vertices: [8, 8],
        tets: [16, 16], triangles: [24, 24], skipped_elements: [32, 32], second_order_tets: [40, 40],
        inverted_tets: [48, 48], degenerate_tets: [56, 56], nearly_flat_tets: [64, 64], duplicate_tets: [72, 72],
        degenerate_triangles: [80, 80], duplicate_vertices: [88, 88], unused_vertices: [96, 96],
        boundary_facets: [104, 104], non_manifold_facets: [112, 112], open_edges: [120, 120],
        misoriented_edges: [128, 128], components: [136, 136], volume: [144, 144], bounds_min: [152, 152],
        bounds_max: [176, 176], unit_in_metres: [200, 200], left_out_vertices: [208, 208],
        left_out_triangles: [216, 216], split_cells: [224, 224], left_out_tets: [232, 232] }
    vox_io_tetrahedralize_desc: size [64, 56], alignment [8, 8], { struct_size: [0, 0], kind: [4, 4], cell: [8, 8],
        max_tets: [16, 16], max_distance: [24, 24], coarsen: [32, 32], reserved: [36, 36], progress: [40, 40],
        progress_user: [48, 44], allocator: [56, 48] }
    vox_io_quality: size [88, 88], alignment [8, 8], { struct_size: [0, 0], reserved: [4, 4], vertices: [8, 8],
        tets: [16, 16], boundary_facets: [24, 24], min_dihedral: [32, 32], max_dihedral: [40, 40], volume: [48, 48],
        surface_volume: [56, 56], mesh_to_surface: [64, 64], surface_to_mesh: [72, 72], hausdorff: [80, 80] }
    vox_io_point_data: size [24, 16], alignment [8, 4], { name: [0, 0], values: [8, 4], components: [16, 8],
        reserved: [20, 12] }
    vox_io_write_desc: size [48, 48], alignment [8, 8], { struct_size: [0, 0], format: [4, 4], binary: [8, 8],
        reserved: [12, 12], point_data: [16, 16], point_data_count: [24, 24], cell_data: [32, 32],
        cell_data_count: [40, 40] }
    vox_io_sink: size [16, 8], alignment [8, 4], { write: [0, 0], user: [8, 4] }
    vox_sim_desc: size [136, 128], alignment [8, 8], { struct_size: [0, 0], substeps: [4, 4], detect_every: [8, 8],
        reserved: [12, 12], gravity: [16, 16], max_time_step: [40, 40], floor_normal: [48, 48], floor_offset: [72, 72],
        friction: [80, 80], contact_compliance: [88, 88], max_push_speed: [96, 96], contact_slop: [104, 104],
        grid: [112, 112], log: [120, 116], allocator: [128, 120] }
    vox_sim_body_desc: size [96, 80], alignment [8, 8], { struct_size: [0, 0], flags: [4, 4], positions: [8, 8],
        rest_positions: [16, 12], velocities: [24, 16], tets: [32, 20], vertex_count: [40, 24], tet_count: [48, 32],
        density: [56, 40], youngs_modulus: [64, 48], bulk_modulus: [72, 56], damping: [80, 64], user_data: [88, 72] }
    vox_sim_body_view: size [56, 40], alignment [8, 8], { positions: [0, 0], velocities: [8, 4], masses: [16, 8],
        grid_positions: [24, 12], tets: [32, 16], vertex_count: [40, 24], tet_count: [48, 32] }
    vox_sim_energy: size [88, 88], alignment [8, 8], { kinetic: [0, 0], potential: [8, 8], elastic: [16, 16],
        mass: [24, 24], momentum: [32, 32], centre: [56, 56], max_speed: [80, 80] }
    vox_resolve_body: size [96, 96], alignment [8, 8], { struct_size: [0, 0], flags: [4, 4], positions: [8, 8],
        vertex_count: [16, 16], tets: [24, 24], tet_count: [32, 32], faces: [40, 40], face_count: [48, 48],
        moved_vertices: [56, 56], largest_move: [64, 64], volume_before: [72, 72], volume: [80, 80],
        inverted_tets: [88, 88] }
    vox_resolve_place: size [40, 40], alignment [8, 8], { body_a: [0, 0], body_b: [4, 4], distance: [8, 8],
        position: [16, 16] }
    vox_resolve_desc: size [56, 56], alignment [8, 8], { struct_size: [0, 0], worker_count: [4, 4],
        max_iterations: [8, 8], reserved: [12, 12], gap: [16, 16], max_move: [24, 24], places: [32, 32],
        place_capacity: [40, 40], allocator: [48, 48] }
    vox_resolve_report: size [80, 80], alignment [8, 8], { struct_size: [0, 0], resolved: [4, 4],
        first_crossings: [8, 8], crossings: [16, 16], inside_vertices: [24, 24], close_pairs: [32, 32],
        first_depth: [40, 40], least_distance: [48, 48], largest_move: [56, 56], iterations: [64, 64],
        place_count: [72, 72] }
}
