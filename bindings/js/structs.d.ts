// Written by bindings/generate.py from bindings/api.json. Do not edit.

import type { AreaReading, CellContent, CellLook, ConstraintKind, CostModel, DepthMethod, DepthState, ForeignRule,
Format, KnownGrid, PairState, PrimitiveType, Result, Side, SizeReading } from "./enums.js";

/** Settings of a grid; all 0 by default. What the pointers name is copied. */
export interface GridDesc {
  /** vox_grid_flags, combined with | */
  flags: number;
  /** threads that share a step: up to VOX_MAX_WORKERS, or VOX_ALL_CORES; 0: one */
  workerCount: number;
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
 * interior; if there is none, there is one for the lowest tetrahedron that has it on its boundary. A tetrahedron of
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
 * All vertices are in one list: first those of body_a, whose weights add up to 1; then those of body_b, whose weights
 * are negative and add up to -1. When vertex i is at x[i], gap = offset + dot(normal, sum of weights[i] * x[i])
 * (vox_constraint_gap) is negative while the two overlap. Its gradient for vertex i is weights[i] * normal, so a solver
 * pushes vertex i in that direction, whatever the kind. With velocities in place of x, the sum is the velocity of the
 * point of body_a relative to that of body_b, for damping and friction. kind vertices of body_a vertices of body_b gap
 * in the step INSIDE the vertex the tetrahedron that contains it minus the depth EDGE the edge the face minus the depth
 * of its part inside, from the middle of that part PROXIMITY the vertex the face with the closest point the distance
 * IMPACT the vertex the face that it met first minus the distance behind its plane
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
  /** tetrahedron of body_b: the lowest that contains the vertex, or the one behind the face */
  elementB: number;
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
  /** the one that was set, or else the one used last; 0 before the first step */
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
  /** not this body, e.g. the one that asks; an id that the locator does not have excludes none */
  excluded: number;
  /** vox_locator_find_closest: no further than this, in the caller's unit; 0: any distance */
  maxDistance: number;
}

/** A tetrahedron that contains a point. */
export interface PointHit {
  /** index of the point */
  point: number;
  body: number;
  tet: number;
  /** of the tetrahedron's corners, in [0, 1], each within 2^-41 of the true one */
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

/**
 * How many nanoseconds one unit of each piece of work takes on a machine: what the models REFERENCE and FAST, and the
 * reference engine, choose a cell size by. From vox_cost_calibrate; plain numbers, which may be saved and loaded.
 */
export interface CostWeights {
  /** 1: by vox_cost_calibrate */
  measured: number;
  /** in the library's own order, finite, >= 0; 0: the one shipped with the library */
  ns: number[];
}

/**
 * The paper's engine (Sect. 3), for vox_grid_desc.reference. It is serial and finds what the fast engine finds. If the
 * grid's cell_size is 0, it chooses by its cost model, at the first step, and again when the counts of its steps show
 * that another size would be better; each change is written to the log and counted in cell_size_changes. If the sizes
 * of the tetrahedra differ so much that a single cell size would be expensive, it uses a few grids in turn: each has a
 * cell size of its own, holds all vertices, and serves the tetrahedra of a range of sizes. Where positions were chosen
 * so that many cells share a bucket, the step finds cells by binary search instead, so its time stays bounded.
 */
export interface ReferenceDesc {
  /** vox_reference_flags, combined with | */
  flags: number;
  /**
   * buckets, at most VOX_MAX_VERTICES, raised to the next prime; 0: the first prime that is at least twice the number
   * of vertices
   */
  hashTableSize: number;
  /** DENSE: the box that has cells, min < max on each axis. Points outside go to */
  worldMin: [number, number, number];
  /** the nearest cell. All 0: the box of all positions, in every step */
  worldMax: [number, number, number];
}

export interface SuggestDesc {
  model: CostModel;
  sizeReading: SizeReading;
  areaReading: AreaReading;
  /** probability that a tet has no collision, in (0, 1); 0: 0.99 */
  pNc: number;
  /** the paper's r: cost of a particle test divided by that of a cell visit; 0: 5 */
  costRatio: number;
  /** edge of the cubic world, for cells_per_axis; 0: longest side of the bounds */
  worldEdge: number;
  /** the zone is where predicted cost <= (1 + zone_loss) * minimum; at most 1e6; 0: 0.05 */
  zoneLoss: number;
  /** for rules.mean_edge_multiple (Gregory et al. 2000); 0: 2 */
  meanEdgeFactor: number;
  /** for rules.resolution (McNeely et al. 1999): the required detail; 0: none */
  resolution: number;
  /** REFERENCE with DENSE cells: most bytes that these may take; 0: no limit */
  byteBudget: number;
  /** REFERENCE: vox_reference_flags, combined with | */
  referenceFlags: number;
}

/**
 * Geometry of all meshes together, in the caller's unit. Above 1500 tets, and in grids, the means and the counts of
 * edges, facets and flat tets are estimates from samples. Tets that name a vertex twice have no edges and facets.
 */
export interface GeometryStats {
  vertices: number;
  tets: number;
  /** unique */
  edges: number;
  /** unique triangles */
  facets: number;
  /** facets of exactly one tet */
  boundaryFacets: number;
  /** of exactly zero volume */
  degenerateTets: number;
  meanEdge: number;
  meanLongestEdge: number;
  meanBoxSide: number;
  /** median over tets of the longest side of the bounding box */
  medianBoxSide: number;
  meanFacetArea: number;
  meanTetFacetArea: number;
  meanBoundaryFacetArea: number;
  /** mean over tets of |volume| */
  meanVolume: number;
  /** of the vertices that tets use; of all vertices for a mesh without tets */
  boundsMin: [number, number, number];
  boundsMax: [number, number, number];
}

/** Columns of GeometryStats: of an array field, its elements one after the other. */
export interface GeometryStatsColumns {
  readonly vertices: Float64Array;
  readonly tets: Float64Array;
  readonly edges: Float64Array;
  readonly facets: Float64Array;
  readonly boundaryFacets: Float64Array;
  readonly degenerateTets: Float64Array;
  readonly meanEdge: Float64Array;
  readonly meanLongestEdge: Float64Array;
  readonly meanBoxSide: Float64Array;
  readonly medianBoxSide: Float64Array;
  readonly meanFacetArea: Float64Array;
  readonly meanTetFacetArea: Float64Array;
  readonly meanBoundaryFacetArea: Float64Array;
  readonly meanVolume: Float64Array;
  readonly boundsMin: Float64Array;
  readonly boundsMax: Float64Array;
}

/** Cell sizes that other rules would choose; 0 where a rule does not apply. */
export interface CellSizeRules {
  /** Teschner et al. 2003 */
  meanEdge: number;
  /** Gregory et al. 2000: a constant times the mean edge */
  meanEdgeMultiple: number;
  /** Garcia-Alonso et al. 1994: 512 voxels in an object's box, mean over meshes whose box has a volume */
  object512: number;
  /** McNeely et al. 1999: the required resolution */
  resolution: number;
  /** cube root of the mean tet volume (tried and rejected in Sect. 5) */
  meanVolume: number;
  /** IPC Toolkit: median of the longest box sides */
  medianBoxSide: number;
}

/** Columns of CellSizeRules: of an array field, its elements one after the other. */
export interface CellSizeRulesColumns {
  readonly meanEdge: Float64Array;
  readonly meanEdgeMultiple: Float64Array;
  readonly object512: Float64Array;
  readonly resolution: Float64Array;
  readonly meanVolume: Float64Array;
  readonly medianBoxSide: Float64Array;
}

/** A point of a curve of costs. */
export interface CostSample {
  cellSize: number;
  cost: number;
}

/** Columns of CostSample: of an array field, its elements one after the other. */
export interface CostSampleColumns {
  readonly cellSize: Float64Array;
  readonly cost: Float64Array;
}

/** One term of a cost: a piece of work, how often it is done, and what that costs. */
export interface CostShare {
  /** what is done, e.g. "visit a cell"; zero-terminated */
  name: string;
  count: number;
  /** count times the weight */
  cost: number;
  /** fraction of the whole cost, 0 to 1 */
  share: number;
}

/** A cell size and the reasons for it. Costs are in cell visits per tetrahedron (PAPER), or nanoseconds. */
export interface Suggestion {
  model: CostModel;
  cellSize: number;
  /** world edge / cell size, as the paper counts */
  cellsPerAxis: number;
  /** smallest and largest cell size of the zone */
  zoneMin: number;
  zoneMax: number;
  /** at cell_size */
  predictedCost: number;
  rules: CellSizeRules;
  stats: GeometryStats;
  /** ascending in cell_size, evenly spaced in its logarithm */
  curve: CostSample[];
  curveCount: number;
  termCount: number;
  /** at cell_size; their costs add up to predicted_cost */
  terms: CostShare[];
  /** predicted cost at the cell size of each rule; 0 if the rule does not apply */
  ruleCosts: CellSizeRules;
  /** smallest cell size within the byte budget; 0: the budget does not limit it */
  budgetCellSize: number;
  /**
   * REFERENCE: the loss of using one cell size for tetrahedra of all sizes. It is predicted_cost divided by the
   * predicted cost of a few grids, each with the cell size that is best for its share of the tetrahedra, minus 1. About
   * 0 if one size is as good as several, and for the other models. A vox_grid with cell_size 0 uses several sizes if
   * there are several `levels`.
   */
  uniformLoss: number;
  /** level_count cell sizes, that of the smallest tets first */
  levels: [number, number, number, number];
  levelCount: number;
}

/** The least cost, and where it is. */
export interface CostMinimum {
  curveCount: number;
  cellSize: number;
  cost: number;
  /** the range around cell_size, within [min, max], where the cost is at most (1 + zone_loss) times the least */
  zoneMin: number;
  zoneMax: number;
  /** from min to max, evenly spaced in the logarithm */
  curve: CostSample[];
}

/** What a run of a grid does at one cell size. The means over all positions of the lattice. */
export interface GridWork {
  /** primitives put into a cell */
  entries: number;
  /** cells looked at; with PAIRS, those that hold something */
  visits: number;
  /** visits of a cell that holds nothing */
  empty: number;
  /** entries of the cells looked at; with PAIRS, pairs in a cell */
  reads: number;
  /** cells that hold something */
  occupied: number;
  /** of the box of all that is held: cells of a dense grid */
  cells: number;
}

/** Columns of GridWork: of an array field, its elements one after the other. */
export interface GridWorkColumns {
  readonly entries: Float64Array;
  readonly visits: Float64Array;
  readonly empty: Float64Array;
  readonly reads: Float64Array;
  readonly occupied: Float64Array;
  readonly cells: Float64Array;
}

/** Nanoseconds for one of each, >= 0. */
export interface GridWeights {
  /** a run, whatever the cell size */
  fixed: number;
  entries: number;
  visits: number;
  /** what a visit of a cell that holds something takes more than one of an empty cell */
  found: number;
  reads: number;
  /** making and forgetting a cell */
  occupied: number;
  /** for grids with dense storage: clearing one */
  cells: number;
}

/** Columns of GridWeights: of an array field, its elements one after the other. */
export interface GridWeightsColumns {
  readonly fixed: Float64Array;
  readonly entries: Float64Array;
  readonly visits: Float64Array;
  readonly found: Float64Array;
  readonly reads: Float64Array;
  readonly occupied: Float64Array;
  readonly cells: Float64Array;
}

/** Cell sizes that other rules would choose; 0 where a rule does not apply. */
export interface ForeignRules {
  /** mean length of the edges of the primitives held, shared ones counted each time */
  meanEdge: number;
  /** mean of the longest sides of their boxes */
  meanBoxSide: number;
  /** median of these */
  medianBoxSide: number;
  /** cube root of the volume of the box of all, over their number */
  spacing: number;
  /** mean radius of those that ask */
  radius: number;
}

/** Columns of ForeignRules: of an array field, its elements one after the other. */
export interface ForeignRulesColumns {
  readonly meanEdge: Float64Array;
  readonly meanBoxSide: Float64Array;
  readonly medianBoxSide: Float64Array;
  readonly spacing: Float64Array;
  readonly radius: Float64Array;
}

/** A cell size for a foreign grid, and the reasons for it. Costs are nanoseconds of a run. */
export interface ForeignSuggestion {
  /** vox_foreign_warnings */
  warnings: number;
  cellSize: number;
  /** as in vox_suggestion, and not below least_cell_size */
  zoneMin: number;
  zoneMax: number;
  /** at cell_size */
  predictedCost: number;
  /** the smallest legal size; 0: any */
  leastCellSize: number;
  /** at cell_size */
  work: GridWork;
  /** that were used */
  weights: GridWeights;
  rules: ForeignRules;
  /**
   * predicted cost at the cell size of each rule; 0 if it does not apply, or that size is too small for vox_count_for
   */
  ruleCosts: ForeignRules;
  /** ascending in cell_size, evenly spaced in its logarithm */
  curve: CostSample[];
  curveCount: number;
  termCount: number;
  /** at cell_size; their costs add up to predicted_cost */
  terms: CostShare[];
  /** whose size it is */
  rule: ForeignRule;
  /** zero-terminated; "" if there is no warning */
  note: string;
}

/** One timing of a grid: a run at this cell size took so long. */
export interface GridTiming {
  /** > 0 */
  cellSize: number;
  /** 1e-30 to 1e30 */
  seconds: number;
}

/** Columns of GridTiming: of an array field, its elements one after the other. */
export interface GridTimingColumns {
  readonly cellSize: Float64Array;
  readonly seconds: Float64Array;
}

/** Weights from timings, and the cell size they lead to. */
export interface GridFit {
  /** vox_foreign_warnings */
  warnings: number;
  /**
   * >= 0; the best fit to the timings. To be put into vox_foreign_grid.weights, also for other scenes of the same grid
   */
  weights: GridWeights;
  /** root mean square of (fitted time / measured time - 1) over the timings */
  residual: number;
  cellSize: number;
  zoneMin: number;
  zoneMax: number;
  /** at cell_size */
  predictedSeconds: number;
  /** in seconds */
  curve: CostSample[];
  curveCount: number;
  note: string;
}

/** How to tune; all 0 by default. */
export interface TuneDesc {
  /** 3 to VOX_TUNE_RUN_CAPACITY; 0: 7 */
  mostRuns: number;
  /** cell sizes to try, 0 < min <= max; both 0: an eighth to eight times the first */
  min: number;
  max: number;
  /** the cell size to begin with; 0: what vox_suggest_for says. Must be set where there is no grid */
  first: number;
  /** as vox_suggest_desc.zone_loss */
  zoneLoss: number;
  /** stops where the cell size is within this of the best one, as far as it can tell; 0: 0.02 */
  wantedLoss: number;
}

/** What tuning found. */
export interface Tuning {
  /** vox_foreign_warnings */
  warnings: number;
  cellSize: number;
  zoneMin: number;
  zoneMax: number;
  /** of a run at cell_size, as fitted */
  seconds: number;
  /**
   * how much longer a run may take than at the best cell size, as far as it can tell: 0.03 for 3 %. The most by any of
   * several fits: without each of the timings, and with each moved by the noise. Infinite if only one cell size of
   * several was timed
   */
  expectedLoss: number;
  /** relative: how far timings are from the fitted curve, root mean square */
  noise: number;
  /** as in vox_grid_fit; all 0 where there is no grid */
  weights: GridWeights;
  /** run_count runs, in order; seconds may be infinite */
  runs: GridTiming[];
  runCount: number;
  curveCount: number;
  /** in seconds */
  curve: CostSample[];
  note: string;
}
