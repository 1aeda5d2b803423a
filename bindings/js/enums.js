// Written by bindings/generate.py from bindings/api.json. Do not edit.

export const ABI_VERSION = 1;
export const NONE = 4294967295;
export const ALL_CORES = 4294967295;
export const MAX_BODIES = 1048576;
export const MAX_VERTICES = 2147483647;
export const MAX_TETS = 2147483647;
export const MAX_SURFACE_TETS = 357913941;
export const MAX_CONTACTS = 4294967295;
export const MAX_WORKERS = 256;
export const NULL_BODY = 0;
export const MAX_RINGS = 8;
export const STENCIL_CAPACITY = 5;
export const MAX_TASKS = 64;
export const COST_WEIGHT_CAPACITY = 24;
export const COST_CURVE_CAPACITY = 64;
export const COST_TERM_CAPACITY = 12;
export const CELL_SIZE_LEVEL_CAPACITY = 4;
export const NOTE_CAPACITY = 256;
export const TUNE_RUN_CAPACITY = 32;

export const Result = Object.freeze({
  OK: 0,
  ERROR_INVALID_ARGUMENT: -1,
  ERROR_INVALID_HANDLE: -2,
  ERROR_INVALID_MESH: -3,
  ERROR_INVALID_STATE: -4,
  ERROR_NON_FINITE: -5,
  ERROR_LIMIT: -6,
  ERROR_BUDGET: -7,
  ERROR_OUT_OF_MEMORY: -8,
  ERROR_UNSUPPORTED: -9,
  ERROR_FILE: -10,
  ERROR_FORMAT: -11,
  ERROR_INTERNAL: -12,
});

export const Format = Object.freeze({
  FLOAT: 0,
  DOUBLE: 1,
});

export const GridFlags = Object.freeze({
  CONSTRAINTS: 1,
  EDGES: 2,
  SKIP_BAD_BODIES: 4,
});

export const FilterFlags = Object.freeze({
  SELF_COLLISION: 1,
  SENSOR: 2,
});

export const MeshFlags = Object.freeze({
  COPY_POSITIONS: 1,
  BORROW_TETS: 2,
});

export const PairState = Object.freeze({
  NEAR: 0,
  BEGAN: 1,
  PERSISTED: 2,
  ENDED: 3,
});

export const ConstraintKind = Object.freeze({
  INSIDE: 0,
  EDGE: 1,
  PROXIMITY: 2,
  IMPACT: 3,
});

export const DepthState = Object.freeze({
  SURFACE: 0,
  PROPAGATED: 1,
  CLOSEST: 2,
  AMBIGUOUS: 3,
  TOUCHING: 4,
  UNKNOWN: 5,
  PLANE: 6,
});

export const DepthMethod = Object.freeze({
  CONSISTENT: 0,
  CLOSEST: 1,
  NONE: 2,
});

export const LogLevel = Object.freeze({
  INFO: 0,
  WARNING: 1,
});

export const QueryFlags = Object.freeze({
  FIRST_HIT: 1,
});

export const Side = Object.freeze({
  NONE: 0,
  ENTERS: 1,
  LEAVES: 2,
});

export const ReferenceFlags = Object.freeze({
  DENSE: 1,
  PAPER_HASH: 2,
});

export const CostModel = Object.freeze({
  PAPER: 0,
  REFERENCE: 1,
  FAST: 2,
  SURFACE: 3,
});

export const SizeReading = Object.freeze({
  MEAN_EDGE: 0,
  MEAN_LONGEST_EDGE: 1,
  MEAN_BOX_SIDE: 2,
});

export const AreaReading = Object.freeze({
  UNIQUE_FACETS: 0,
  TET_FACETS: 1,
  BOUNDARY_FACETS: 2,
});

export const PrimitiveType = Object.freeze({
  POINT: 0,
  EDGE: 1,
  TRIANGLE: 2,
  TET: 3,
  BOX: 4,
});

export const CellContent = Object.freeze({
  CELLS_HOLD_BOXES: 0,
  CELLS_HOLD_CENTRES: 1,
});

export const CellLook = Object.freeze({
  BOX: 0,
  AROUND: 1,
  PAIRS: 2,
});

export const KnownGrid = Object.freeze({
  ANY: 0,
  SORTED: 1,
  HASHED: 2,
  WARP: 3,
  IPC: 4,
  IPC_PAIRS: 5,
  VTK: 6,
  PBAT: 7,
  POINT_VOXELS: 8,
  NUMPY: 9,
});

export const ForeignFlags = Object.freeze({
  DENSE: 1,
});

export const ForeignWarnings = Object.freeze({
  WEIGHTS_UNKNOWN: 1,
  BY_RULE: 2,
  AT_LEAST_SIZE: 4,
  NO_SIZE: 8,
  ONE_PLACE: 16,
  MODEL_DISAGREES: 32,
  TIMINGS_DISAGREE: 64,
  OUT_OF_RANGE: 128,
  STOPPED: 256,
});

export const ForeignRule = Object.freeze({
  NONE: 0,
  MEAN_EDGE: 1,
  MEAN_BOX_SIDE: 2,
  MEDIAN_BOX_SIDE: 3,
  SPACING: 4,
  RADIUS: 5,
});
