// Written by bindings/generate.py from bindings/api.json. Do not edit.

export declare const Result: Readonly<{
  OK: 0;
  /** a null pointer, an unknown enumerator, a bad number */
  ERROR_INVALID_ARGUMENT: -1;
  /** an id that is null, stale or of another grid */
  ERROR_INVALID_HANDLE: -2;
  /** a tetrahedron or triangle names a vertex that does not exist */
  ERROR_INVALID_MESH: -3;
  /** the call does not fit the state, e.g. a mesh has no positions yet */
  ERROR_INVALID_STATE: -4;
  /** a position is NaN or infinite */
  ERROR_NON_FINITE: -5;
  /** a documented limit would be exceeded */
  ERROR_LIMIT: -6;
  /** the byte budget would be exceeded */
  ERROR_BUDGET: -7;
  /** the allocator returned null */
  ERROR_OUT_OF_MEMORY: -8;
  /** not in this build or version */
  ERROR_UNSUPPORTED: -9;
  /** a file cannot be opened, read or written */
  ERROR_FILE: -10;
  /** a file or a snapshot is malformed */
  ERROR_FORMAT: -11;
  /** a defect of the library: please report it */
  ERROR_INTERNAL: -12;
}>;
export type Result = (typeof Result)[keyof typeof Result];

export declare const Format: Readonly<{
  FLOAT: 0;
  /** magnitudes below 2^128 - 2^103, the largest float */
  DOUBLE: 1;
}>;
export type Format = (typeof Format)[keyof typeof Format];

/** What a step does besides finding contacts and pairs. */
export declare const GridFlags: Readonly<{
  /** also find constraints: as vox_grid_find_constraints with the defaults */
  CONSTRAINTS: 1;
  /** also find edges that pass through faces. Experimental */
  EDGES: 2;
  /** leave out a body with a bad coordinate (NaN, infinite, too large) instead of failing (vox_grid_get_failure) */
  SKIP_BAD_BODIES: 4;
}>;
export type GridFlags = number;

export declare const FilterFlags: Readonly<{
  /** the mesh also collides with itself */
  SELF_COLLISION: 1;
  /** the body has contacts and pairs, but no constraints; takes less memory */
  SENSOR: 2;
}>;
export type FilterFlags = number;

export declare const MeshFlags: Readonly<{
  /** copy the positions instead of borrowing them */
  COPY_POSITIONS: 1;
  /** borrow the tetrahedra instead of copying them, 16 bytes each */
  BORROW_TETS: 2;
}>;
export type MeshFlags = number;

/** What changed since the last successful step. */
export declare const PairState: Readonly<{
  /** does not touch, but is within the margin */
  NEAR: 0;
  /** touches now and did not before */
  BEGAN: 1;
  /** touches now and did before */
  PERSISTED: 2;
  /** touched before and does not now */
  ENDED: 3;
}>;
export type PairState = (typeof PairState)[keyof typeof PairState];

/** Why there is a constraint. A vertex has at most one INSIDE, PROXIMITY or IMPACT constraint with each body. */
export declare const ConstraintKind: Readonly<{
  /** a vertex of body_a is inside body_b */
  INSIDE: 0;
  /** an edge of body_a meets a face of body_b (VOX_GRID_EDGES) */
  EDGE: 1;
  /** a vertex of body_a is outside body_b and within the margin (vox_grid_set_margin) */
  PROXIMITY: 2;
  /**
   * a vertex of body_a is not inside body_b, but went in within the step and is behind the face that it met first
   * (vox_mesh_bind_previous_positions)
   */
  IMPACT: 3;
}>;
export type ConstraintKind = (typeof ConstraintKind)[keyof typeof ConstraintKind];

/** How gap and normal were found, and thus how far to trust them (docs/depth.md). */
export declare const DepthState: Readonly<{
  /** a mean over the edges that lead from the vertex out of body_b */
  SURFACE: 0;
  /** a mean over neighbouring vertices that are closer to the surface */
  PROPAGATED: 1;
  /** the closest point of the surface, which may jump from step to step */
  CLOSEST: 2;
  /** the bodies pass through each other: the nearest way out, which may be the wrong side */
  AMBIGUOUS: 3;
  /** the bodies only touch here: gap 0 */
  TOUCHING: 4;
  /** closest_budget was used up: gap 0; or no depth was asked for: gap and normal 0 */
  UNKNOWN: 5;
  /** the plane of the face: for IMPACT, and for EDGE of a mesh with itself */
  PLANE: 6;
}>;
export type DepthState = (typeof DepthState)[keyof typeof DepthState];

/** How the depth of a vertex inside a mesh is found. */
export declare const DepthMethod: Readonly<{
  /** smooth along the surface; neighbouring vertices leave on the same side: for response (Heidelberger et al. 2004) */
  CONSISTENT: 0;
  /**
   * to the closest point of the surface, with the vertices of its face in place of the tetrahedron's: for finite
   * elements, pictures, reports
   */
  CLOSEST: 1;
  /** none: vertices, weights and position alone. Quick */
  NONE: 2;
}>;
export type DepthMethod = (typeof DepthMethod)[keyof typeof DepthMethod];

/** Shapes are given in a frame of their own. vox_body_set_transform places them, and moves them from step to step. */
export declare const ShapeKind: Readonly<{
  NONE: 0;
  /** z <= 0: a floor */
  HALF_SPACE: 1;
  /** around the origin: radius */
  SPHERE: 2;
  /** along the z axis, around the origin: radius, half_length */
  CAPSULE: 3;
  /** likewise, with flat ends */
  CYLINDER: 4;
  /** around the origin: half_size */
  BOX: 5;
  /** terrain, solid below, without walls at its ends: heights, columns, rows, spacing */
  HEIGHTFIELD: 6;
  /** the inside of a closed surface: positions, triangles */
  SOLID: 7;
  /**
   * what is within `radius` of triangles: a blade, a wall. A triangle that names a vertex twice is a segment of a
   * needle: positions, triangles, radius
   */
  SHEET: 8;
  /** where a function of the caller is not positive: field, half_size */
  FIELD: 9;
}>;
export type ShapeKind = (typeof ShapeKind)[keyof typeof ShapeKind];

/** How serious a line of the log is. */
export declare const LogLevel: Readonly<{
  INFO: 0;
  WARNING: 1;
}>;
export type LogLevel = (typeof LogLevel)[keyof typeof LogLevel];

export declare const QueryFlags: Readonly<{
  /** vox_locator_find_ray_hits: report only the first hit of each ray */
  FIRST_HIT: 1;
  /**
   * vox_locator_locate: for a point outside, compute the weights of the point itself, some of which are negative,
   * rather than of the closest point
   */
  EXTRAPOLATE: 2;
}>;
export type QueryFlags = number;

export declare const LocationState: Readonly<{
  /** no body is within max_distance; the other fields are 0 */
  NONE: 0;
  /** the closed tetrahedron contains the point */
  INSIDE: 1;
  /**
   * no tetrahedron contains the point; this one has the closest point of all surfaces, as vox_locator_find_closest
   * finds it
   */
  OUTSIDE: 2;
}>;
export type LocationState = (typeof LocationState)[keyof typeof LocationState];

export declare const Side: Readonly<{
  /** the facet's tetrahedron has no volume */
  NONE: 0;
  /** the ray goes into the tetrahedron */
  ENTERS: 1;
  LEAVES: 2;
}>;
export type Side = (typeof Side)[keyof typeof Side];

/** What a result depends on, combined with |. vox_cell_size_result.note says it in words, with numbers. */
export declare const CellSizeWarnings: Readonly<{
  /** nothing is known of the grid's times; a few timings would help */
  GUESSED_WEIGHTS: 1;
  /** it is the mean edge: the weights do not show for certain that another is better */
  BY_RULE: 2;
  /** it is min_cell_size, though a smaller one would cost less */
  AT_MINIMUM: 4;
  /** the primitives have no size; it follows from the distances between them */
  FROM_SPACING: 8;
  /** all primitives are in one place; any large enough cell size will do */
  ONE_PLACE: 16;
  /** the timings do not follow the counts of the described grid */
  MODEL_DISAGREES: 32;
  /** timings at the same cell size differ widely */
  TIMINGS_DISAGREE: 64;
  /** the best cell size lies beyond those that were timed */
  OUT_OF_RANGE: 128;
  /** the callback stopped, or could not run at a cell size */
  STOPPED: 256;
}>;
export type CellSizeWarnings = number;

export declare const CostModel: Readonly<{
  /** the paper's z(delta) (Sect. 4, Eqs. 3-8) */
  PAPER: 0;
  /** a step of the paper's engine, counted tetrahedron by tetrahedron */
  REFERENCE: 1;
  /** a step of the fast engine, with the same cell size everywhere */
  FAST: 2;
  /** the searches of vox_surface.h in the meshes' surfaces */
  SURFACE: 3;
}>;
export type CostModel = (typeof CostModel)[keyof typeof CostModel];

export declare const ReferenceFlags: Readonly<{
  /** store a list for every cell of a box, instead of hashing cells into a table */
  DENSE: 1;
  /**
   * hash by i*73856093 xor j*19349663 xor k*83492791 (Teschner et al. 2003, Sect. 4.1), instead of by a well-mixed hash
   */
  PAPER_HASH: 2;
}>;
export type ReferenceFlags = number;

export declare const PrimitiveType: Readonly<{
  /** one vertex */
  POINT: 0;
  /** two */
  EDGE: 1;
  /** three */
  TRIANGLE: 2;
  /** four */
  TET: 3;
  /** two: opposite corners, in any order */
  BOX: 4;
}>;
export type PrimitiveType = (typeof PrimitiveType)[keyof typeof PrimitiveType];

/** Grids whose layout and weights are known, as measured by bench/foreign. */
export declare const KnownGrid: Readonly<{
  /** the weights with the smallest worst loss over all grids below */
  NONE: 0;
  /** C++: a counting sort into a dense lattice */
  SORTED: 1;
  /** C++: std::unordered_map from cell to list */
  HASHED: 2;
  /** NVIDIA Warp's HashGrid on the processor */
  WARP: 3;
  /** IPC Toolkit's SpatialHash */
  IPC: 4;
  /** IPC Toolkit's HashGrid */
  IPC_PAIRS: 5;
  /** VTK's vtkStaticCellLocator */
  VTK: 6;
  /** PBAT's HashGrid3 */
  PBAT: 7;
  /** hashed voxels of points, as in PCL and Open3D */
  POINT_VOXELS: 8;
  /** sorted keys in numpy */
  NUMPY: 9;
}>;
export type KnownGrid = (typeof KnownGrid)[keyof typeof KnownGrid];

/** The cells that store a primitive. */
export declare const CellsStored: Readonly<{
  /** as in the known grid, else BOX */
  DEFAULT: 0;
  /** all cells that its box meets */
  BOX: 1;
  /** the cell that contains the centre of its box */
  CENTRE: 2;
}>;
export type CellsStored = (typeof CellsStored)[keyof typeof CellsStored];

/** The cells that a query visits. */
export declare const CellsQueried: Readonly<{
  /** as in the known grid, else BOX */
  DEFAULT: 0;
  /** all cells that its box meets; one for a point */
  BOX: 1;
  /** the cell that contains its centre, and the 26 cells around it. Only with CENTRE */
  QUERIED_27: 2;
  /** none: the grid goes through its cells and reports every pair within a cell */
  PAIRS: 3;
}>;
export type CellsQueried = (typeof CellsQueried)[keyof typeof CellsQueried];

/** The cells that exist. */
export declare const CellsKept: Readonly<{
  /** as in the known grid, else OCCUPIED */
  DEFAULT: 0;
  /** those that store something */
  OCCUPIED: 1;
  /** all cells in the box of the stored primitives */
  DENSE: 2;
}>;
export type CellsKept = (typeof CellsKept)[keyof typeof CellsKept];

/** A program runs with any library of the ABI version that it was built with (docs/abi.md). */
export declare const ABI_VERSION: 1;
/** as an index: none */
export declare const NONE: 4294967295;
/** as a worker_count: one worker per core */
export declare const ALL_CORES: 4294967295;
/** in a grid at one time */
export declare const MAX_BODIES: 1048576;
/** in a grid */
export declare const MAX_VERTICES: 2147483647;
/** in a grid */
export declare const MAX_TETS: 2147483647;
/** in a mesh whose surface is needed: constraints, edges, margin, queries */
export declare const MAX_SURFACE_TETS: 357913941;
/** in a step */
export declare const MAX_CONTACTS: 4294967295;
/** of a grid */
export declare const MAX_WORKERS: 256;
/** vox_grid_desc.max_constraints_per_pair */
export declare const MAX_CONSTRAINTS_PER_PAIR: 256;
/** names no body */
export declare const NULL_BODY: 0;
/** vox_filter.self_rings */
export declare const MAX_RINGS: 8;
/** most vertices of a constraint */
export declare const STENCIL_CAPACITY: 5;
/** in one call */
export declare const MAX_TASKS: 64;
/** most samples of a curve */
export declare const CURVE_CAPACITY: 64;
/** most terms of a cost */
export declare const TERM_CAPACITY: 12;
/** most rules that are compared */
export declare const RULE_CAPACITY: 8;
/** most runs of vox_foreign_grid_tune */
export declare const TIMING_CAPACITY: 32;
/** bytes of a note, its zero included; it is cut to that */
export declare const NOTE_CAPACITY: 256;
/** numbers in vox_cost_weights */
export declare const COST_WEIGHT_CAPACITY: 24;
