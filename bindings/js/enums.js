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
export const MAX_CONSTRAINTS_PER_PAIR = 256;
export const NULL_BODY = 0;
export const MAX_RINGS = 8;
export const STENCIL_CAPACITY = 5;
export const MAX_TASKS = 64;
export const CURVE_CAPACITY = 64;
export const TERM_CAPACITY = 12;
export const RULE_CAPACITY = 8;
export const TIMING_CAPACITY = 32;
export const NOTE_CAPACITY = 256;
export const COST_WEIGHT_CAPACITY = 24;

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

export const ShapeKind = Object.freeze({
  NONE: 0,
  HALF_SPACE: 1,
  SPHERE: 2,
  CAPSULE: 3,
  CYLINDER: 4,
  BOX: 5,
  HEIGHTFIELD: 6,
  SOLID: 7,
  SHEET: 8,
  FIELD: 9,
});

export const LogLevel = Object.freeze({
  INFO: 0,
  WARNING: 1,
});

export const QueryFlags = Object.freeze({
  FIRST_HIT: 1,
  EXTRAPOLATE: 2,
});

export const LocationState = Object.freeze({
  NONE: 0,
  INSIDE: 1,
  OUTSIDE: 2,
});

export const Side = Object.freeze({
  NONE: 0,
  ENTERS: 1,
  LEAVES: 2,
});

export const CellSizeWarnings = Object.freeze({
  GUESSED_WEIGHTS: 1,
  BY_RULE: 2,
  AT_MINIMUM: 4,
  FROM_SPACING: 8,
  ONE_PLACE: 16,
  MODEL_DISAGREES: 32,
  TIMINGS_DISAGREE: 64,
  OUT_OF_RANGE: 128,
  STOPPED: 256,
});

export const CostModel = Object.freeze({
  PAPER: 0,
  REFERENCE: 1,
  FAST: 2,
  SURFACE: 3,
});

export const ReferenceFlags = Object.freeze({
  DENSE: 1,
  PAPER_HASH: 2,
});

export const PrimitiveType = Object.freeze({
  POINT: 0,
  EDGE: 1,
  TRIANGLE: 2,
  TET: 3,
  BOX: 4,
});

export const KnownGrid = Object.freeze({
  NONE: 0,
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

export const CellsStored = Object.freeze({
  DEFAULT: 0,
  BOX: 1,
  CENTRE: 2,
});

export const CellsQueried = Object.freeze({
  DEFAULT: 0,
  BOX: 1,
  QUERIED_27: 2,
  PAIRS: 3,
});

export const CellsKept = Object.freeze({
  DEFAULT: 0,
  OCCUPIED: 1,
  DENSE: 2,
});
