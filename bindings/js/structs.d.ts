// Written by bindings/generate.py from bindings/api.json. Do not edit.

import type { CellsKept, CellsQueried, CellsStored, ConstraintKind, CostModel, DepthMethod, DepthState, Format,
KnownGrid, LocationState, PairState, PrimitiveType, Result, ShapeKind, Side } from "./enums.js";

/** Settings of a grid; all 0 by default. What the pointers name is copied. */
export interface GridDesc {
  /** vox_grid_flags, combined with | */
  flags: number;
  /** threads that share a step: up to VOX_MAX_WORKERS, or VOX_ALL_CORES; 0: one */
  workerCount: number;
  /**
   * Most constraints of a pair, up to VOX_MAX_CONSTRAINTS_PER_PAIR; 0: all. The deepest stays, then whichever is
   * farthest from all that stay; PROXIMITY only if no others are left. Pairs and contacts do not change.
   */
  maxConstraintsPerPair: number;
  /** edge length of a cell; 0: the library chooses it in every step. Never changes results */
  cellSize: number;
  /** see vox_grid_set_margin */
  margin: number;
  /** most bytes the grid may hold; 0: 4 GiB; UINT64_MAX: no limit */
  byteBudget: number;
}

/**
 * What a body collides with. With all fields 0, the default, it collides with every other body, but not with itself.
 * Two bodies in different worlds never collide; use worlds for copies of a scene in one grid. Two bodies with the same
 * group other than 0 collide if it is positive and do not collide if it is negative. Any other two collide if the
 * category of each has a bit in common with the mask of the other, as in Box2D. A tetrahedron that is ruled out for a
 * vertex is treated as if it did not exist.
 */
export interface Filter {
  /** vox_filter_flags, combined with | */
  flags: number;
  group: number;
  /** 0: 1 */
  category: bigint;
  /** 0: all bits */
  mask: bigint;
  world: number;
  /**
   * Self-contact ignores tetrahedra that have a corner within this many edges of the vertex; at most VOX_MAX_RINGS.
   * Takes about 60, 260 or 700 bytes per vertex for 1, 2 or 3.
   */
  selfRings: number;
  /**
   * Self-contact ignores tetrahedra that are closer to the vertex than this in the rest pose. The rest pose is
   * vox_mesh_desc.rest_positions or, without these, the positions when this distance is first set.
   */
  selfRestDistance: number;
}

/** Columns of Filter: of an array field, its elements one after the other. */
export interface FilterColumns {
  readonly flags: Uint32Array;
  readonly group: Int32Array;
  readonly category: BigUint64Array;
  readonly mask: BigUint64Array;
  readonly world: Uint32Array;
  readonly selfRings: Uint32Array;
  readonly selfRestDistance: Float64Array;
}

/**
 * Vertex `vertex` of body_a lies in the closed tetrahedron `tet` of body_b and is not one of its corners. This is
 * decided exactly. For each vertex and body_b there is a contact for every tetrahedron that has the vertex in its
 * interior. If there is none, there is one for the lowest tetrahedron that has it on its boundary. A tetrahedron of
 * zero volume contains nothing.
 */
export interface Contact {
  bodyA: number;
  vertex: number;
  bodyB: number;
  tet: number;
}

/** Columns of Contact: of an array field, its elements one after the other. */
export interface ContactColumns {
  readonly bodyA: Uint32Array;
  readonly vertex: Uint32Array;
  readonly bodyB: Uint32Array;
  readonly tet: Uint32Array;
}

/**
 * Two bodies that touch, or touched in the step before. They touch if a vertex of one is inside the other or went
 * through it within the step, or if an edge of one meets a face of the other. body_a < body_b; they are equal for a
 * mesh that touches itself. A pair that began ends exactly once, even if a body is removed, disabled or filtered out,
 * or the grid is cleared. Its ids may be stale then.
 */
export interface Pair {
  bodyA: number;
  bodyB: number;
  userDataA: bigint;
  userDataB: bigint;
  state: PairState;
  /** see vox_pair_view.contacts */
  firstContact: number;
  /** 0 if the two touch in another way, or no longer */
  contactCount: number;
}

/** Columns of Pair: of an array field, its elements one after the other. */
export interface PairColumns {
  readonly bodyA: Uint32Array;
  readonly bodyB: Uint32Array;
  readonly userDataA: BigUint64Array;
  readonly userDataB: BigUint64Array;
  readonly state: Int32Array;
  readonly firstContact: Float64Array;
  readonly contactCount: Float64Array;
}

/**
 * A point of body_a and a point of body_b that must not pass through each other. Each is a weighted sum of vertices.
 * All vertices are in one list: first the vertices of body_a, whose weights add up to 1; then the vertices of body_b,
 * whose weights are negative and add up to -1. When vertex i is at x[i], gap = offset + dot(normal, sum of weights[i] *
 * x[i]) (vox_constraint_gap) is negative while the two overlap. Its gradient for vertex i is weights[i] * normal, so a
 * solver pushes vertex i in that direction, whatever the kind. With velocities in place of x, the sum is the velocity
 * of the point of body_a relative to the point of body_b, for damping and friction. kind vertices of body_a vertices of
 * body_b gap in the step INSIDE the vertex the tetrahedron that contains it minus the depth EDGE the edge the face
 * minus the depth of its part inside, from the middle of that part PROXIMITY the vertex the face with the closest point
 * the distance IMPACT the vertex the face that it met first minus the distance behind its plane A rigid shape has no
 * vertices and is always body_b. The plane of an IMPACT with it moves as the shape does.
 */
export interface Constraint {
  bodyA: number;
  bodyB: number;
  kind: ConstraintKind;
  state: DepthState;
  /** how many vertices of body_a */
  countA: number;
  /** how many vertices in all */
  count: number;
  /** those beyond `count` are 0, and so are their weights */
  vertices: number[];
  /**
   * tetrahedron of body_b: the lowest that contains the vertex; with a face, the tetrahedron behind it. Triangle of a
   * shape; VOX_NONE if it has none
   */
  elementB: number;
  /** of corners of a tetrahedron: rounded as in vox_location (vox_query.h) */
  weights: number[];
  /** a unit vector out of body_b, the way for body_a */
  normal: [number, number, number];
  gap: number;
  offset: number;
  /** of the point of body_a */
  position: [number, number, number];
  /** when within the step, from 0 to 1, a vertex met the surface; 1 if that is not known */
  time: number;
  userDataA: bigint;
  userDataB: bigint;
  /** index of its pair in vox_grid_get_pairs */
  pair: number;
  /**
   * index of the same constraint in the list of the step before, for a warm start; VOX_NONE if it is new. Same means
   * the same vertex and body_b, or the same edge and face
   */
  previous: number;
  /** how many more its pair would have without max_constraints_per_pair */
  leftOut: number;
}

/** Columns of Constraint: of an array field, its elements one after the other. */
export interface ConstraintColumns {
  readonly bodyA: Uint32Array;
  readonly bodyB: Uint32Array;
  readonly kind: Int32Array;
  readonly state: Int32Array;
  readonly countA: Uint32Array;
  readonly count: Uint32Array;
  readonly vertices: Uint32Array;
  readonly elementB: Uint32Array;
  readonly weights: Float64Array;
  readonly normal: Float64Array;
  readonly gap: Float64Array;
  readonly offset: Float64Array;
  readonly position: Float64Array;
  readonly time: Float64Array;
  readonly userDataA: BigUint64Array;
  readonly userDataB: BigUint64Array;
  readonly pair: Uint32Array;
  readonly previous: Uint32Array;
  readonly leftOut: Float64Array;
}

/** Which constraints to find. By default all fields are 0: all constraints, with consistent depth. */
export interface ConstraintDesc {
  method: DepthMethod;
  /** only pairs of this body; VOX_NULL_BODY: all pairs */
  bodyA: number;
  /** only its pair with body_a; VOX_NULL_BODY: all pairs of body_a */
  bodyB: number;
  /** only pairs in which the category of a body has a bit in common with it; 0: all pairs */
  mask: bigint;
  /**
   * most searches for a closest point; constraints that get none are UNKNOWN, and the log has a warning. 0: no limit
   */
  closestBudget: number;
}

/** A body as it is now. */
export interface BodyInfo {
  /** vox_shape_kind; VOX_SHAPE_NONE for a mesh */
  shape: number;
  userData: bigint;
  /** 1 or 0 */
  enabled: number;
  /** vox_mesh_flags: COPY_POSITIONS if the grid owns the positions, BORROW_TETS while the caller owns the tetrahedra */
  flags: number;
  /** with disabled and removed ones: indices are below it */
  tetCount: number;
  enabledTetCount: number;
  filter: Filter;
  transform: number[];
}

/** A grid as it is now, and what its last successful step did. */
export interface GridInfo {
  /** vox_grid_flags */
  flags: number;
  /** counts up when an epoch ends (see Ownership above) */
  epoch: number;
  /** as it was set, or else as it was used last; 0 before the first step */
  cellSize: number;
  margin: number;
  /** held now, without the caller's arrays */
  bytes: number;
  peakBytes: number;
  /** nanoseconds */
  stepNs: number;
  /** bodies that were not at rest */
  movedBodies: number;
  /** bodies that were left out (VOX_GRID_SKIP_BAD_BODIES) */
  skippedBodies: number;
  /** pairs that began, in all steps so far */
  totalBegan: number;
  /** pairs that ended, in all steps so far */
  totalEnded: number;
}

/** A count, or a time in nanoseconds, with its name. */
export interface Counter {
  value: number;
}

/** A body that made a step fail, or that a step left out. */
export interface Failure {
  /** VOX_OK: there is no such body */
  result: Result;
  body: number;
  /** the first vertex with a bad coordinate; VOX_NONE if the failure is not about a vertex */
  vertex: number;
  userData: bigint;
  /** of that vertex, transformed */
  position: [number, number, number];
}

/** Which bodies answer, and how far to look. All fields are 0 by default: all bodies, at any distance. */
export interface QueryDesc {
  /** vox_query_flags, combined with | */
  flags: number;
  /** only bodies whose category had a bit in common with it; 0: all */
  mask: bigint;
  /** not this body, e.g. the asking body; an id that the locator does not have excludes none */
  excluded: number;
  /**
   * vox_locator_locate, vox_locator_find_closest and vox_locator_find_closest_to_segments: no further than this, in the
   * caller's unit; 0: any distance
   */
  maxDistance: number;
}

/**
 * Where a point is, and the weights that interpolate a field there. If several tetrahedra contain the point, this is
 * one of the lowest body: the lowest that has the point in its interior or, if there is none, the lowest that has it on
 * its boundary.
 */
export interface Location {
  body: number;
  tet: number;
  state: LocationState;
  /**
   * Of the tetrahedron's corners, for the point or, if it is outside, for the closest point; VOX_QUERY_EXTRAPOLATE asks
   * for the point. Each is rounded from the true weight once, or off by 2^-58 more. Exceptions are the closest points
   * of facets thinner than 2^-20 of their length or with an edge below 2^-40 of the distance, and a flat tetrahedron is
   * not extrapolated.
   */
  weights: [number, number, number, number];
  /** to the closest point, in the caller's unit; 0 inside */
  distance: number;
}

/** Columns of Location: of an array field, its elements one after the other. */
export interface LocationColumns {
  readonly body: Uint32Array;
  readonly tet: Uint32Array;
  readonly state: Int32Array;
  readonly weights: Float64Array;
  readonly distance: Float64Array;
}

/** A tetrahedron that contains a point. */
export interface PointHit {
  /** index of the point */
  point: number;
  body: number;
  tet: number;
  /** of the tetrahedron's corners, in [0, 1], as in vox_location */
  weights: [number, number, number, number];
}

/** Columns of PointHit: of an array field, its elements one after the other. */
export interface PointHitColumns {
  readonly point: Uint32Array;
  readonly body: Uint32Array;
  readonly tet: Uint32Array;
  readonly weights: Float64Array;
}

/**
 * A point of a surface. The surface of a mesh consists of the facets of exactly one of its tetrahedra. Facet k is
 * opposite corner k. The corners of facets are facet 0: corners 1, 2, 3 1: 0, 3, 2 2: 0, 1, 3 3: 0, 2, 1 of the
 * tetrahedron, counter-clockwise as seen from outside if its volume is positive.
 */
export interface ClosestHit {
  /** VOX_NULL_BODY: no surface is within max_distance; all other fields but `inside` are 0 */
  body: number;
  tet: number;
  facet: number;
  /** how many bodies contain the point; exact */
  inside: number;
  /** the vertices of the facet, in the order of its corners */
  face: [number, number, number];
  /** of these vertices, for the closest point, in [0, 1] */
  weights: [number, number, number];
  /** of the closest point */
  position: [number, number, number];
  /**
   * A unit vector out of the facet's tetrahedron or, if that is flat, to the side away from the point. If the facet has
   * no area, it points from the point to `position`, or is 0, 0, 1 if both coincide.
   */
  normal: [number, number, number];
  /** from the point to `position`; negative if the body contains the point, which is exact */
  distance: number;
}

/** Columns of ClosestHit: of an array field, its elements one after the other. */
export interface ClosestHitColumns {
  readonly body: Uint32Array;
  readonly tet: Uint32Array;
  readonly facet: Uint32Array;
  readonly inside: Uint32Array;
  readonly face: Uint32Array;
  readonly weights: Float64Array;
  readonly position: Float64Array;
  readonly normal: Float64Array;
  readonly distance: Float64Array;
}

/** A tetrahedron whose bounding box meets a box. */
export interface BoxHit {
  /** index of the box */
  box: number;
  body: number;
  tet: number;
}

/** Columns of BoxHit: of an array field, its elements one after the other. */
export interface BoxHitColumns {
  readonly box: Uint32Array;
  readonly body: Uint32Array;
  readonly tet: Uint32Array;
}

/** A facet of a surface that a ray meets; see vox_closest_hit. */
export interface RayHit {
  /** index of the ray */
  ray: number;
  body: number;
  tet: number;
  facet: number;
  side: Side;
  /** the vertices of the facet, in the order of its corners */
  face: [number, number, number];
  t: number;
  /** of these vertices, in [0, 1] */
  weights: [number, number, number];
}

/** Columns of RayHit: of an array field, its elements one after the other. */
export interface RayHitColumns {
  readonly ray: Uint32Array;
  readonly body: Uint32Array;
  readonly tet: Uint32Array;
  readonly facet: Uint32Array;
  readonly side: Int32Array;
  readonly face: Uint32Array;
  readonly t: Float64Array;
  readonly weights: Float64Array;
}

/** The part of a segment that lies in one tetrahedron. A segment is a closed one, as a ray is. */
export interface TrackPiece {
  /** index of the segment */
  segment: number;
  body: number;
  tet: number;
  /** where the segment enters the tetrahedron, the lowest of several; VOX_NONE if the piece begins elsewhere */
  facetIn: number;
  /** where it leaves; VOX_NONE if the piece ends elsewhere */
  facetOut: number;
  /** the doubles nearest to the true ones */
  tIn: number;
  tOut: number;
}

/** Columns of TrackPiece: of an array field, its elements one after the other. */
export interface TrackPieceColumns {
  readonly segment: Uint32Array;
  readonly body: Uint32Array;
  readonly tet: Uint32Array;
  readonly facetIn: Uint32Array;
  readonly facetOut: Uint32Array;
  readonly tIn: Float64Array;
  readonly tOut: Float64Array;
}

/**
 * A tetrahedron that a triangle meets, and the edges of it that the triangle cuts. Edges are 0: corners 0, 1 1: 0, 2 2:
 * 0, 3 3: 1, 2 4: 1, 3 5: 2, 3 of the tetrahedron.
 */
export interface TriangleHit {
  /** index of the triangle */
  triangle: number;
  body: number;
  tet: number;
  /** bit k: the triangle meets edge k, an end of it included */
  edges: number;
  /** when the triangle first meets the tetrahedron; 0 if it does at first. The double nearest to the true time. */
  t: number;
  /**
   * where it first meets edge k, from 0 at the end with the lower vertex index to 1: the same for all tetrahedra that
   * share the edge; 0 for edges that it does not meet
   */
  s: number[];
}

/** Columns of TriangleHit: of an array field, its elements one after the other. */
export interface TriangleHitColumns {
  readonly triangle: Uint32Array;
  readonly body: Uint32Array;
  readonly tet: Uint32Array;
  readonly edges: Uint32Array;
  readonly t: Float64Array;
  readonly s: Float64Array;
}

/** A point of a cost curve. */
export interface CostSample {
  cellSize: number;
  cost: number;
}

/** Columns of CostSample: of an array field, its elements one after the other. */
export interface CostSampleColumns {
  readonly cellSize: Float64Array;
  readonly cost: Float64Array;
}

/** One kind of work: how often it is done at the suggested cell size, and what that costs. */
export interface CostTerm {
  count: number;
  cost: number;
}

/** The cell size that a rule of thumb gives, and the predicted cost there. */
export interface CellSizeRule {
  /** 0: the rule does not apply */
  cellSize: number;
  /** 0: not known */
  cost: number;
}

/** A run at one cell size, and how long it took. */
export interface Timing {
  /** > 0 */
  cellSize: number;
  /** 1e-30 to 1e30; in a result infinity if the run was impossible */
  seconds: number;
}

/** Columns of Timing: of an array field, its elements one after the other. */
export interface TimingColumns {
  readonly cellSize: Float64Array;
  readonly seconds: Float64Array;
}

/** How many nanoseconds a foreign grid takes for each kind of work, >= 0. */
export interface ForeignWeights {
  /** for a run, whatever the cell size */
  run: number;
  /** to store a primitive in a cell */
  store: number;
  /** to visit a cell in a query */
  visit: number;
  /** extra, to visit a cell that is not empty */
  found: number;
  /** to read a primitive in a visited cell */
  read: number;
  /** to create and drop a cell that is not empty */
  occupied: number;
  /** to clear a cell of a dense grid */
  cell: number;
}

/** Columns of ForeignWeights: of an array field, its elements one after the other. */
export interface ForeignWeightsColumns {
  readonly run: Float64Array;
  readonly store: Float64Array;
  readonly visit: Float64Array;
  readonly found: Float64Array;
  readonly read: Float64Array;
  readonly occupied: Float64Array;
  readonly cell: Float64Array;
}

/**
 * A cell size and the reasons for it. Costs are seconds of a step or a run; for the model PAPER they are visits of
 * cells per tetrahedron. Fields that a function does not know are 0.
 */
export interface CellSizeResult {
  /** vox_cell_size_warnings */
  warnings: number;
  cellSize: number;
  /** the range around cell_size where the cost is at most (1 + zone_loss) times the least */
  zoneMin: number;
  zoneMax: number;
  /** predicted at cell_size */
  cost: number;
  /** the smallest that gives right answers, or fits the byte budget; 0: any */
  minCellSize: number;
  /** edge of the world divided by cell_size, as the paper counts */
  cellsPerAxis: number;
  /** of fit and tune: root mean square of (fitted time / measured time - 1) */
  fitError: number;
  /** of tune: how much longer a run may take than at the best cell size; 0.03 means 3 % */
  expectedLoss: number;
  curveCount: number;
  termCount: number;
  ruleCount: number;
  timingCount: number;
  /** ascending, evenly spaced in the logarithm of the cell size */
  curve: CostSample[];
  /** their costs add up to `cost` */
  terms: CostTerm[];
  rules: CellSizeRule[];
  /** of tune: the runs, in order */
  timings: Timing[];
  /** of foreign grids: those used, or those found by fit and tune */
  weights: ForeignWeights;
  /** the warnings in words; "" if there are none */
  note: string;
}

/**
 * How many nanoseconds each kind of work takes on a machine, for the models REFERENCE and FAST. Measured by
 * vox_cost_calibrate; may be saved and loaded.
 */
export interface CostWeights {
  /** 1 if vox_cost_calibrate filled it */
  measured: number;
  /** in the library's own order; 0: the value shipped with the library */
  ns: number[];
}

/**
 * The paper's engine (Sect. 3), for vox_grid_desc.reference. It is serial and finds what the fast engine finds. If the
 * grid's cell_size is 0, it chooses by its cost model, and again when its counters call for another size.
 */
export interface ReferenceDesc {
  /** vox_reference_flags, combined with | */
  flags: number;
  /** raised to the next prime; 0: twice the number of vertices */
  hashTableSize: number;
  /** DENSE: the box that has cells. Points outside go to the nearest cell. Both 0: the */
  worldMin: [number, number, number];
  /** box of all positions, in every step */
  worldMax: [number, number, number];
}

/** How to suggest a cell size; all 0 by default. */
export interface CellSizeDesc {
  model: CostModel;
  /** REFERENCE: vox_reference_flags, combined with | */
  referenceFlags: number;
  /** 0: 0.05 */
  zoneLoss: number;
  /** PAPER: the share of tetrahedra without a contact, in (0, 1); 0: 0.99 */
  pNc: number;
  /** PAPER: r, the cost of a particle test divided by the cost of a cell visit; 0: 5 */
  costRatio: number;
  /** for cells_per_axis; 0: the longest side of the box of all vertices */
  worldEdge: number;
  /** REFERENCE with DENSE cells: most bytes that these may take; 0: no limit */
  byteBudget: number;
}

/** Sizes in meshes, as in the paper's tables. */
export interface Geometry {
  vertices: number;
  tets: number;
  /** unique */
  edges: number;
  /** unique */
  facets: number;
  /** of exactly one tetrahedron */
  boundaryFacets: number;
  /** of zero volume; exact */
  degenerateTets: number;
  meanEdge: number;
  /** over tetrahedra */
  meanLongestEdge: number;
  /** over tetrahedra, the longest side of the box */
  meanBoxSide: number;
  medianBoxSide: number;
  /** over unique facets */
  meanFacetArea: number;
  /** over the four facets of each tetrahedron */
  meanTetFacetArea: number;
  meanBoundaryFacetArea: number;
  meanVolume: number;
  boundsMin: [number, number, number];
  boundsMax: [number, number, number];
}

/** How often a run does what, on average over all positions of the lattice. */
export interface ForeignCounts {
  /** primitives stored in a cell */
  stored: number;
  /** cells visited; with PAIRS, cells that store something */
  visits: number;
  /** visited cells that store nothing */
  empty: number;
  /** primitives read in visited cells; with PAIRS, pairs within a cell */
  reads: number;
  /** cells that store something */
  occupied: number;
  /** cells in the box of the stored primitives */
  cells: number;
}

/** Columns of ForeignCounts: of an array field, its elements one after the other. */
export interface ForeignCountsColumns {
  readonly stored: Float64Array;
  readonly visits: Float64Array;
  readonly empty: Float64Array;
  readonly reads: Float64Array;
  readonly occupied: Float64Array;
  readonly cells: Float64Array;
}

/** How to tune; all 0 by default. */
export interface TuneDesc {
  /** 3 to VOX_TIMING_CAPACITY; 0: 7 */
  maxRuns: number;
  /** the range of cell sizes to try; both 0: from 1/8 to 8 times the first */
  min: number;
  max: number;
  /** the cell size to begin with; 0: as vox_foreign_grid_suggest says */
  first: number;
  /** stop when the expected loss is below this; 0: 0.02 */
  wantedLoss: number;
}
