// Written by bindings/generate.py from bindings/api.json. Do not edit.

export declare const Result: Readonly<{
  OK: 0;
  /** a null pointer, an unknown enum, a bad number */
  ERROR_INVALID_ARGUMENT: -1;
  /** a mesh id that is null, stale or from another grid */
  ERROR_INVALID_HANDLE: -2;
  /** a tetrahedron names a vertex that does not exist */
  ERROR_INVALID_MESH: -3;
  /** the call does not fit the state, e.g. no positions bound */
  ERROR_INVALID_STATE: -4;
  /** a position is NaN or infinite */
  ERROR_NON_FINITE: -5;
  /** a documented limit would be passed */
  ERROR_LIMIT: -6;
  /** the grid's byte budget would be passed */
  ERROR_BUDGET: -7;
  /** the allocator returned null */
  ERROR_OUT_OF_MEMORY: -8;
  /**
   * recognised, but not supported by this build or version; or the processor is an x86-64 without SSE4.2: nothing is
   * created there, and no cell size found
   */
  ERROR_UNSUPPORTED: -9;
  /** a file cannot be opened, read or written */
  ERROR_FILE: -10;
  /** a file is malformed */
  ERROR_FORMAT: -11;
  /** a defect of the library: please report it */
  ERROR_INTERNAL: -12;
}>;
export type Result = (typeof Result)[keyof typeof Result];

export declare const Format: Readonly<{
  /** IEEE 754 singles */
  FLOAT: 0;
  /** IEEE 754 doubles, of magnitudes below 2^128 - 2^103 (3.4028236e38), the largest float */
  DOUBLE: 1;
}>;
export type Format = (typeof Format)[keyof typeof Format];

export declare const GridFlags: Readonly<{
  /**
   * run the depth stage in a step (vox_grid_penetrations); on by default. A mesh of more than 357913941 tets then gives
   * VOX_ERROR_LIMIT, unless its filter does without
   */
  PENETRATIONS: 1;
  /** also report events of single vertices (vox_grid_contact_events) */
  CONTACT_EVENTS: 2;
  /**
   * a mesh with a coordinate that VOX_FORMAT_DOUBLE does not allow (NaN, infinite, too large) takes no part in a step,
   * in vox_grid_suggest_cell_size and in locators (vox_query.h), as if it were disabled; without this flag they fail.
   * Counted (vox_grid_info.skipped_bodies), listed (vox_grid_get_failure), and logged once until the mesh is well again
   */
  SKIP_BAD_BODIES: 4;
  /**
   * also find edges of surfaces through faces of others (vox_grid_edge_contacts); experimental. A mesh of more than
   * 357913941 tets then gives VOX_ERROR_LIMIT
   */
  EDGE_CONTACTS: 8;
}>;
export type GridFlags = number;

export declare const FilterFlags: Readonly<{
  /** the mesh also collides with itself */
  SELF_COLLISION: 1;
  /** the mesh has contacts, but no penetrations; takes less memory */
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

/**
 * How a penetration's depth and direction were found. In the following, p is the vertex; a colliding vertex is a vertex
 * of body_a that has a contact with body_b; edges are those of body_a's tetrahedra; the surface of body_b consists of
 * the facets of exactly one of its tetrahedra, duplicates counted once. SURFACE and PROPAGATED are the method of
 * Heidelberger et al. 2004; the other states stand for cases in which it gives no answer. "Closest" means that depth is
 * the distance from p to the closest point of body_b's surface, and direction points straight to it. For self-contact
 * the surface is that of the fold that p has entered, never a triangle that has p as a corner.
 */
export declare const PenetrationState: Readonly<{
  /** edges lead from p out of body_b; mean over the points where they cross the surface */
  SURFACE: 0;
  /** all neighbours of p collide; mean over those closer to the surface */
  PROPAGATED: 1;
  /**
   * closest: no edge leads out from p or from a colliding vertex connected with it, or p has no edges, as in meshes
   * without tetrahedra
   */
  ENCLOSED: 2;
  /**
   * the means are unusable, as the normals nearly cancel (edges leave on opposite sides), the depth would not be
   * positive, or an edge that leads out crosses no surface (inverted tetrahedra, non-manifold facets); or this is the
   * case for all vertices that p is connected with. The nearest way out alone: of the edges, or by a neighbour. Closest
   * only if no edge of any of these vertices leads out
   */
  CROSSING: 3;
  /** p lies on the surface; depth is 0, direction the surface's normal at p */
  COINCIDENT: 4;
  /**
   * the step's closest_budget was used up (see vox_grid_desc): depth is 0, direction the normal of a facet of the
   * contact's tetrahedron
   */
  UNKNOWN: 5;
}>;
export type PenetrationState = (typeof PenetrationState)[keyof typeof PenetrationState];

/** How an edge meets a face. */
export declare const CrossingKind: Readonly<{
  /** it passes through the interior of the face, with an end on either side */
  THROUGH: 0;
  /** an end is on the face, or it passes through an edge or a corner of the face */
  TOUCHING: 1;
  /** it lies in the plane of the face and meets it, or one of them is degenerate and they meet */
  COPLANAR: 2;
}>;
export type CrossingKind = (typeof CrossingKind)[keyof typeof CrossingKind];

/** What an event reports: how the last successful step differs from the successful step before it. */
export declare const Touch: Readonly<{
  /** touches now, and did not before */
  BEGAN: 1;
  /** touches now, and did before */
  PERSISTED: 2;
  /** no longer touches, for whatever reason */
  ENDED: 3;
}>;
export type Touch = (typeof Touch)[keyof typeof Touch];

/** Which parts of a vox_reading are wanted, or present; all fields of the other parts are zero. */
export declare const ReadingFlags: Readonly<{
  /** missing if the vertex or its mesh was removed after the step */
  POSITION: 1;
  /**
   * missing where POSITION is or would be, if body_b was removed or has no surface, or if all of its tetrahedra that
   * contained the vertex were removed or disabled
   */
  SURFACE: 2;
  /** missing on grids without VOX_GRID_PENETRATIONS, and where one of the meshes is a sensor */
  DEPTH: 4;
}>;
export type ReadingFlags = number;

/** Severity of a log line. */
export declare const LogLevel: Readonly<{
  INFO: 0;
  WARNING: 1;
}>;
export type LogLevel = (typeof LogLevel)[keyof typeof LogLevel];

export declare const QueryFlags: Readonly<{
  /** vox_locator_find_ray_hits: report only the first hit of each ray */
  FIRST_HIT: 1;
}>;
export type QueryFlags = number;

export declare const Side: Readonly<{
  /** the facet's tetrahedron has no volume */
  NONE: 0;
  /** the ray goes into the tetrahedron */
  ENTERS: 1;
  LEAVES: 2;
}>;
export type Side = (typeof Side)[keyof typeof Side];

export declare const ReferenceFlags: Readonly<{
  /** store a list for every cell of a box (linear id k*nx*ny + j*nx + i), instead of hashing cells into a table */
  DENSE: 1;
  /**
   * hash by i*73856093 xor j*19349663 xor k*83492791 (Teschner et al. 2003, Sect. 4.1), instead of by a well-mixed hash
   */
  PAPER_HASH: 2;
}>;
export type ReferenceFlags = number;

export declare const CostModel: Readonly<{
  /** the paper's z(delta) (Sect. 4, Eqs. 3-8), from means; in cell visits */
  PAPER: 0;
  /** the reference engine, counted tet by tet; in nanoseconds of a step */
  REFERENCE: 1;
  /** the fast engine with one cell size in all windows; in nanoseconds of a step */
  FAST: 2;
  /**
   * the searches of vox_surface.h in the meshes' surfaces, for pairs of edges and of faces and vertices; in
   * nanoseconds, of their grids alone
   */
  SURFACE: 3;
}>;
export type CostModel = (typeof CostModel)[keyof typeof CostModel];

/** How s, the size of a tetrahedron in Eq. 4, is measured. */
export declare const SizeReading: Readonly<{
  /** mean length of the unique edges; reproduces the paper's tables */
  MEAN_EDGE: 0;
  /** mean over tets of the longest edge; as worded in Sect. 4.2 */
  MEAN_LONGEST_EDGE: 1;
  /** mean over tets of the longest side of the bounding box */
  MEAN_BOX_SIDE: 2;
}>;
export type SizeReading = (typeof SizeReading)[keyof typeof SizeReading];

/** How A, the facet area in Eqs. 5-7, is measured. */
export declare const AreaReading: Readonly<{
  /** mean over all facets, shared ones counted once; reproduces the paper's tables */
  UNIQUE_FACETS: 0;
  /** mean over the four facets of every tet */
  TET_FACETS: 1;
  /** mean over the facets of exactly one tet */
  BOUNDARY_FACETS: 2;
}>;
export type AreaReading = (typeof AreaReading)[keyof typeof AreaReading];

export declare const PrimitiveType: Readonly<{
  /** one vertex */
  POINT: 0;
  /** two */
  EDGE: 1;
  /** three */
  TRIANGLE: 2;
  /** four */
  TET: 3;
  /** two: opposite corners of a box along the axes, in any order */
  BOX: 4;
}>;
export type PrimitiveType = (typeof PrimitiveType)[keyof typeof PrimitiveType];

/** Which cells hold a primitive. */
export declare const CellContent: Readonly<{
  /** all that its box meets */
  CELLS_HOLD_BOXES: 0;
  /** the one with the centre of its box; for a point, with the point */
  CELLS_HOLD_CENTRES: 1;
}>;
export type CellContent = (typeof CellContent)[keyof typeof CellContent];

/** Which cells a primitive that asks looks at. */
export declare const CellLook: Readonly<{
  /** those that its box meets: one for a point, those of the ball's box for one with a radius */
  BOX: 0;
  /**
   * 27: the one with the centre of its box, and those around. Only with HOLD_CENTRES, and only legal where a cell is as
   * large as the distance that matters along any axis
   */
  AROUND: 1;
  /**
   * nobody asks: the grid goes through the cells and pairs what is in each. With two sets, both are put into cells, and
   * pairs are of one of each
   */
  PAIRS: 2;
}>;
export type CellLook = (typeof CellLook)[keyof typeof CellLook];

/** Grids that weights are shipped for, each measured by bench/foreign. */
export declare const KnownGrid: Readonly<{
  /** nothing is known: weights that lose least in the worst of the grids below */
  ANY: 0;
  /** a plain grid in C++: a counting sort into a dense lattice */
  SORTED: 1;
  /** a plain grid in C++: std::unordered_map from cell to list */
  HASHED: 2;
  /** NVIDIA Warp's HashGrid on the processor: points, asked by balls */
  WARP: 3;
  /** IPC Toolkit's SpatialHash: boxes in all their cells, asked by boxes */
  IPC: 4;
  /** IPC Toolkit's HashGrid: boxes in all their cells, paired cell by cell */
  IPC_PAIRS: 5;
  /** VTK's vtkStaticCellLocator: boxes in all their cells, asked by points */
  VTK: 6;
  /** PBAT's HashGrid3: centres of boxes, asked from 27 cells */
  PBAT: 7;
  /** hashed voxels of points asked by balls, as in PCL and Open3D */
  POINT_VOXELS: 8;
  /** a grid of sorted keys in numpy */
  NUMPY: 9;
}>;
export type KnownGrid = (typeof KnownGrid)[keyof typeof KnownGrid];

export declare const ForeignFlags: Readonly<{
  /** the grid keeps a list for each cell of the box of all that it holds */
  DENSE: 1;
}>;
export type ForeignFlags = number;

/** What an answer was based on, combined with |. `note` says the same in words, with numbers. */
export declare const ForeignWarnings: Readonly<{
  /** nothing is known of the grid's times: a few timings would help */
  WEIGHTS_UNKNOWN: 1;
  /** cell_size is that of `rule`: by the weights, a guess, no gain over it is sure */
  BY_RULE: 2;
  /** the least legal size; a smaller one would be faster */
  AT_LEAST_SIZE: 4;
  /** the primitives have no size: the cell size follows from their distances */
  NO_SIZE: 8;
  /** all are in one place: any cell size that is large enough does */
  ONE_PLACE: 16;
  /** the timings do not follow the counts of the described grid */
  MODEL_DISAGREES: 32;
  /** timings at the same cell size differ widely */
  TIMINGS_DISAGREE: 64;
  /** the best cell size is beyond those timed */
  OUT_OF_RANGE: 128;
  /** the callback stopped, or failed at a cell size */
  STOPPED: 256;
}>;
export type ForeignWarnings = number;

/** The rules of vox_foreign_rules, in its order. Suggestions are by NONE or MEAN_EDGE so far. */
export declare const ForeignRule: Readonly<{
  /** the model's minimum */
  NONE: 0;
  MEAN_EDGE: 1;
  MEAN_BOX_SIDE: 2;
  MEDIAN_BOX_SIDE: 3;
  SPACING: 4;
  RADIUS: 5;
}>;
export type ForeignRule = (typeof ForeignRule)[keyof typeof ForeignRule];

/**
 * Version of the stable interface. A program runs with every library that has the ABI version it was built with. It is
 * part of the shared libraries' names (docs/abi.md).
 */
export declare const ABI_VERSION: 1;
/** as a worker_count: one worker per core */
export declare const ALL_CORES: 4294967295;
/** as an index: none */
export declare const NONE: 4294967295;
/** per grid, at one time, including retired slots */
export declare const MAX_BODIES: 1048576;
/** uses of one mesh slot before it is retired */
export declare const MAX_GENERATIONS: 4095;
/** per grid */
export declare const MAX_VERTICES: 2147483647;
/** per grid */
export declare const MAX_TETS: 2147483647;
/** workers of a grid */
export declare const MAX_WORKERS: 256;
/** names no mesh */
export declare const NULL_BODY: 0;
/** vox_filter.self_rings */
export declare const MAX_RINGS: 8;
/** vox_failure.vertex where a failure is not about a vertex */
export declare const NO_VERTEX: 4294967295;
/** contacts of one step; a step with more fails with VOX_ERROR_LIMIT */
export declare const MAX_CONTACTS: 4294967295;
/** vox_touch_event.pair of a pair that ended */
export declare const NO_PAIR: 4294967295;
/** tasks enqueued in one step */
export declare const MAX_TASKS: 64;
/** numbers of vox_cost_weights */
export declare const COST_WEIGHT_CAPACITY: 24;
/** most samples of a curve */
export declare const COST_CURVE_CAPACITY: 64;
/** most terms of a cost, in any model */
export declare const COST_TERM_CAPACITY: 12;
/** most entries of vox_suggestion.levels */
export declare const CELL_SIZE_LEVEL_CAPACITY: 4;
/** bytes of a note, its zero included */
export declare const NOTE_CAPACITY: 256;
/** most runs of vox_cost_tune */
export declare const TUNE_RUN_CAPACITY: 32;
