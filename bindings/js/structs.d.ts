// Written by bindings/generate.py from bindings/api.json. Do not edit.

import type { AreaReading, CellContent, CellLook, CostModel, CrossingKind, ForeignRule, Format, KnownGrid,
PenetrationState, PrimitiveType, Result, Side, SizeReading, Touch } from "./enums.js";

/** Settings of a grid. What the pointers name is copied. */
export interface GridDesc {
  /** vox_grid_flags, combined with | */
  flags: number;
  /**
   * Threads that share a step, the calling one being one of them: up to VOX_MAX_WORKERS, or VOX_ALL_CORES; 0: one. With
   * `tasks`, the number of that system's workers. Contacts do not depend on it. The built-in scheduler never uses more
   * threads than there are cores, nor more than the system gives. It is oneTBB, or without it (vox_build_info says
   * which) each grid has threads of its own, from the first step that needs them until its end, which sleep between
   * steps; in a process made by fork it makes new ones. Builds for systems without threads are serial.
   */
  workerCount: number;
  /**
   * Edge length of a cell; 0: the library chooses it. It never changes contacts. The fast engine chooses one for each
   * body in every step, from the size of the tiles near other bodies; for the reference engine see vox_reference_desc.
   */
  cellSize: number;
  /** see vox_grid_set_margin. Experimental */
  margin: number;
  /**
   * most bytes the grid may hold; a call that would exceed it fails with VOX_ERROR_BUDGET. 0: 4 GiB; UINT64_MAX: no
   * limit
   */
  byteBudget: number;
  /**
   * Most searches for a closest point that the depth stage makes in one step: for penetrations that would be ENCLOSED,
   * or CROSSING with nothing but a closest point to go by. The first ones, in the order of the penetrations, get them;
   * the others become VOX_PENETRATION_UNKNOWN, which is counted (unknown_penetrations) and written to the log. Those of
   * meshes at rest, which are carried over from the last step, take nothing of it, and stay UNKNOWN where they are. 0:
   * no limit.
   */
  closestBudget: number;
}

/** A grid as it is now, and what its last successful step did. */
export interface GridInfo {
  /** vox_grid_flags, combined with | */
  flags: number;
  /**
   * Number of steps, clears, reserves and changes of flags or margin so far, failed steps included. A view is valid
   * while its epoch equals it.
   */
  epoch: number;
  /**
   * The cell size that was set, or else the last one that was chosen; 0 before the first step. If a step chose several,
   * it is that of the smallest tetrahedra (reference engine) or of the last body that needed one (fast).
   */
  cellSize: number;
  margin: number;
  /** held now, without the caller's arrays */
  bytes: number;
  peakBytes: number;
  /** nanoseconds */
  stepNs: number;
  /** bodies that were not at rest (see vox_grid_step) */
  movedBodies: number;
  /** bodies that were left out (VOX_GRID_SKIP_BAD_BODIES) */
  skippedBodies: number;
  /** pairs that began, in all steps so far */
  totalBegan: number;
  /** pairs that ended, in all steps so far */
  totalEnded: number;
}

/**
 * What a mesh collides with. With all fields 0, the default, it collides with every other mesh, but not with itself.
 * Two meshes in different worlds never collide; use worlds for copies of a scene in one grid. Two meshes with the same
 * group other than 0 collide if it is positive and do not collide if it is negative. Any other two collide if the
 * category of each has a bit in common with the mask of the other, as in Box2D. A tetrahedron that is ruled out for a
 * vertex is treated as if it did not exist: the rule of vox_contact (every tetrahedron with the vertex in its interior,
 * or else the lowest with it on the boundary) is applied to the remaining ones.
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
   * Self-contact skips tetrahedra that have a corner within this many edges of the vertex, along the edges of the
   * mesh's tetrahedra; at most VOX_MAX_RINGS. 0 skips only tetrahedra that have the vertex as a corner. Takes about 60,
   * 260 or 700 bytes a vertex for 1, 2 or 3.
   */
  selfRings: number;
  /**
   * Self-contact skips tetrahedra that are closer to the vertex than this in the rest pose (distance to the closed
   * tetrahedron, computed in double). The rest pose is vox_mesh_desc.rest_positions or, without those, the positions at
   * the time this was first set.
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

/** A mesh as it is now, e.g. after vox_grid_load. */
export interface BodyInfo {
  /** from 0 */
  slot: number;
  /** as given at insertion */
  userData: bigint;
  /** with those that are disabled or removed: indices of tetrahedra are below it */
  tetCount: number;
  enabledTetCount: number;
  /** 1, or 0 (see vox_body_set_enabled) */
  enabled: number;
  /**
   * vox_mesh_flags: COPY_POSITIONS if the positions are the mesh's own (copied, mapped or loaded), BORROW_TETS while
   * the tetrahedra are the caller's
   */
  flags: number;
  /** 1 if vox_body_set_transform gave it one */
  hasTransform: number;
  /** as vox_body_set_transform; without one the rows 1 0 0 0, 0 1 0 0, 0 0 1 0 */
  transform: number[];
  /** in use: neither category nor mask is 0 */
  filter: Filter;
}

/** A mesh that made a step fail, or that a step left out. */
export interface Failure {
  /**
   * NON_FINITE or LIMIT (a coordinate that VOX_FORMAT_DOUBLE does not allow), INVALID_STATE (no positions),
   * INVALID_ARGUMENT (doubles under VOX_FORMAT_FLOAT); VOX_OK if there is none
   */
  result: Result;
  /** VOX_NULL_BODY if there is none */
  mesh: number;
  /** of the mesh, from 0 */
  slot: number;
  /** of the mesh, as given at insertion */
  userData: bigint;
  /** the first with such a coordinate; VOX_NO_VERTEX if the failure is about none */
  vertex: number;
  /** of that vertex, as it would collide: in double and transformed; else 0 */
  position: [number, number, number];
}

/**
 * Vertex `vertex` of body_a is in the closed tetrahedron `tet` of body_b and is not a corner of it. This is decided
 * exactly for the coordinates given. For each (body_a, vertex, body_b) there is a contact for every tetrahedron that
 * has the vertex in its interior; if there is none, one for the tetrahedron of lowest index that has it on its
 * boundary. A tetrahedron of exactly zero volume contains nothing. `barycentric` are the vertex's weights for the
 * tetrahedron's four corners in their given order. Each is in [0, 1], and their sum is 1 up to rounding.
 */
export interface Contact {
  bodyA: number;
  vertex: number;
  bodyB: number;
  tet: number;
  barycentric: [number, number, number, number];
}

/** Columns of Contact: of an array field, its elements one after the other. */
export interface ContactColumns {
  readonly bodyA: Uint32Array;
  readonly vertex: Uint32Array;
  readonly bodyB: Uint32Array;
  readonly tet: Uint32Array;
  readonly barycentric: Float32Array;
}

/**
 * Vertex `vertex` of body_a is inside body_b (a = b: self-contact) and has to leave it: moving the vertex by depth *
 * direction leads to the surface of body_b, exactly if the state says closest, and otherwise as well as edges and
 * neighbours can estimate it. All values are finite, and direction is a unit vector up to rounding. If body_b has no
 * surface (each facet belongs to several tetrahedra), depth is 0 and direction the normal of a facet of the contact's
 * tetrahedron. Does not depend on engine, cell size, workers or machine.
 */
export interface Penetration {
  bodyA: number;
  vertex: number;
  bodyB: number;
  state: PenetrationState;
  /** index in vox_grid_get_contacts of the first contact of (body_a, vertex, body_b) */
  contact: number;
  /** >= 0, in the caller's unit */
  depth: number;
  /** in the frame of the positions, out of body_b */
  direction: [number, number, number];
}

/** Columns of Penetration: of an array field, its elements one after the other. */
export interface PenetrationColumns {
  readonly bodyA: Uint32Array;
  readonly vertex: Uint32Array;
  readonly bodyB: Uint32Array;
  readonly state: Int32Array;
  readonly contact: Float64Array;
  readonly depth: Float32Array;
  readonly direction: Float32Array;
}

/**
 * Depth and direction of a vox_penetration as computed, in double; rounded to floats they are those of the
 * vox_penetration.
 */
export interface Depth {
  depth: number;
  direction: [number, number, number];
}

/** Columns of Depth: of an array field, its elements one after the other. */
export interface DepthColumns {
  readonly depth: Float64Array;
  readonly direction: Float64Array;
}

/**
 * An edge of the surface of body_a and a face of the surface of body_b that have a point in common (a = b:
 * self-contact; then they have no vertex in common). The surface of a mesh consists of the facets of exactly one of its
 * enabled tetrahedra, duplicates counted once, and of their edges. Decided exactly for the coordinates given. So two
 * bars laid across each other are seen, though no vertex of one is in the other. Where several points are common, the
 * position is that of one of them: an end of the edge if one is, the lower vertex first.
 */
export interface EdgeContact {
  bodyA: number;
  /** vertices of body_a, the lower first */
  edge: [number, number];
  bodyB: number;
  /** vertices of body_b, the lowest first, counter-clockwise as seen from the side that the normal points to */
  face: [number, number, number];
  /** of body_b, behind the face; of doubled ones the lowest */
  tet: number;
  kind: CrossingKind;
  /** of the point, in [0, 1], with the sum 1 up to rounding */
  edgeWeights: [number, number];
  /** of the same point */
  faceWeights: [number, number, number];
  /** of the point, rounded */
  position: [number, number, number];
  /**
   * A unit vector out of `tet` or, if that is flat, to the side away from the lower vertex of the edge; 0, 0, 1 if the
   * face has no area.
   */
  normal: [number, number, number];
}

/** Columns of EdgeContact: of an array field, its elements one after the other. */
export interface EdgeContactColumns {
  readonly bodyA: Uint32Array;
  readonly edge: Uint32Array;
  readonly bodyB: Uint32Array;
  readonly face: Uint32Array;
  readonly tet: Uint32Array;
  readonly kind: Int32Array;
  readonly edgeWeights: Float64Array;
  readonly faceWeights: Float64Array;
  readonly position: Float64Array;
  readonly normal: Float64Array;
}

/**
 * Vertex `vertex` of body_a is in no tetrahedron of body_b, but no further than the margin from its surface. The point
 * of the surface of body_b that is closest to it is on a facet of `tet`; of several at the same distance that of the
 * lowest (tet, facet), as in vox_locator_find_closest (vox_query.h). Computed in double.
 */
export interface MarginContact {
  bodyA: number;
  vertex: number;
  /** never body_a */
  bodyB: number;
  /** of body_b */
  tet: number;
  /** of the tetrahedron, as in vox_closest_hit */
  facet: number;
  /** its vertices, in the order given there */
  face: [number, number, number];
  /** of the closest point, in [0, 1], with the sum 1 up to rounding */
  faceWeights: [number, number, number];
  /** from the vertex to the closest point */
  distance: number;
  /** a unit vector from the closest point to the vertex; out of the tetrahedron if there is no distance between them */
  normal: [number, number, number];
}

/** Columns of MarginContact: of an array field, its elements one after the other. */
export interface MarginContactColumns {
  readonly bodyA: Uint32Array;
  readonly vertex: Uint32Array;
  readonly bodyB: Uint32Array;
  readonly tet: Uint32Array;
  readonly facet: Uint32Array;
  readonly face: Uint32Array;
  readonly faceWeights: Float64Array;
  readonly distance: Float64Array;
  readonly normal: Float64Array;
}

/**
 * Vertex `vertex` of body_a met the surface of body_b while both moved from their previous positions to the present
 * ones (vox_mesh_bind_previous_positions; a mesh without previous positions stands still), wherever it was before and
 * is after: also where it went through a thin mesh and out again.
 */
export interface Passage {
  bodyA: number;
  vertex: number;
  /** never body_a */
  bodyB: number;
  /** of body_b */
  tet: number;
  /**
   * of the tetrahedron, as in vox_closest_hit: the first that the vertex met; the lowest (tet, facet) of several at the
   * same time
   */
  facet: number;
  /** its vertices, in the order given there */
  face: [number, number, number];
  /**
   * in [0, 1], 0 at the previous positions: when it met it; never too late, and too early by no more than rounding
   * errors make necessary
   */
  time: number;
}

/** Columns of Passage: of an array field, its elements one after the other. */
export interface PassageColumns {
  readonly bodyA: Uint32Array;
  readonly vertex: Uint32Array;
  readonly bodyB: Uint32Array;
  readonly tet: Uint32Array;
  readonly facet: Uint32Array;
  readonly face: Uint32Array;
  readonly time: Float64Array;
}

/**
 * Two meshes that touch: a vertex of one of them is in a tetrahedron of the other, or they have edge contacts
 * (VOX_GRID_EDGE_CONTACTS). body_a <= body_b; they are equal if a mesh touches itself. The contacts of the pair are
 * those whose indices begin at vox_pair_view.contacts[first]: first the a_in_b contacts of vertices of body_a in tets
 * of body_b, then the b_in_a contacts of vertices of body_b in tets of body_a (0 for a mesh with itself), each in the
 * order of vox_grid_get_contacts.
 */
export interface Pair {
  bodyA: number;
  bodyB: number;
  /** of body_a, as given at insertion */
  userDataA: bigint;
  userDataB: bigint;
  first: number;
  aInB: number;
  bInA: number;
}

/** Columns of Pair: of an array field, its elements one after the other. */
export interface PairColumns {
  readonly bodyA: Uint32Array;
  readonly bodyB: Uint32Array;
  readonly userDataA: BigUint64Array;
  readonly userDataB: BigUint64Array;
  readonly first: Float64Array;
  readonly aInB: Float64Array;
  readonly bInA: Float64Array;
}

/**
 * An event of a pair of meshes, body_a <= body_b. A pair that began persists in every following step until it ends,
 * which it does exactly once, also if a mesh was removed, disabled or filtered, or the grid cleared. Then `body_a` and
 * `body_b` may be stale ids; the user data are those of the meshes that they named.
 */
export interface TouchEvent {
  bodyA: number;
  bodyB: number;
  userDataA: bigint;
  userDataB: bigint;
  kind: Touch;
  /** index of the pair in vox_grid_get_pairs; VOX_NO_PAIR if it ended */
  pair: number;
}

/** Columns of TouchEvent: of an array field, its elements one after the other. */
export interface TouchEventColumns {
  readonly bodyA: Uint32Array;
  readonly bodyB: Uint32Array;
  readonly userDataA: BigUint64Array;
  readonly userDataB: BigUint64Array;
  readonly kind: Int32Array;
  readonly pair: Uint32Array;
}

/**
 * Vertex `vertex` of body_a has entered body_b, or is in none of its tetrahedra any more. Moving from one tetrahedron
 * of body_b to another is not an event.
 */
export interface ContactEvent {
  bodyA: number;
  vertex: number;
  bodyB: number;
  /** VOX_TOUCH_BEGAN or VOX_TOUCH_ENDED */
  kind: Touch;
}

/** Columns of ContactEvent: of an array field, its elements one after the other. */
export interface ContactEventColumns {
  readonly bodyA: Uint32Array;
  readonly vertex: Uint32Array;
  readonly bodyB: Uint32Array;
  readonly kind: Int32Array;
}

/**
 * Geometry of one contact. All contacts of the same (body_a, vertex, body_b) have the same reading except for the first
 * field. `triangle` is the triangle closest to the vertex on the surface of body_b, which consists of the facets of
 * exactly one of its tetrahedra, duplicates counted once. It is computed in double, as by vox_locator_find_closest; of
 * several at the same distance it is the one with the lowest corners, compared in ascending order. For self-contact it
 * belongs to the fold that the vertex has entered and never has the vertex as a corner (see vox_penetration_state). No
 * reading depends on engine, cell size, workers or machine.
 */
export interface Reading {
  /** index of the contact in vox_grid_get_contacts */
  contact: number;
  /** vox_reading_flags, combined with | */
  known: number;
  /** DEPTH: state, depth and direction of the vertex's vox_penetration */
  state: PenetrationState;
  depth: number;
  direction: [number, number, number];
  /** POSITION: the vertex as it collides, in double and transformed */
  position: [number, number, number];
  /** SURFACE (up to `triangle`): distance from the vertex to surface_position */
  distance: number;
  /** the closest point of `triangle` */
  surfacePosition: [number, number, number];
  /** its weights for the triangle's corners, in [0, 1], with the sum 1 up to rounding */
  barycentric: [number, number, number];
  /**
   * A unit vector out of the triangle's tetrahedron or, if that is flat, to the side away from the vertex. If the
   * triangle has no area, it points from the vertex to the closest point, or is 0, 0, 1 if both coincide.
   */
  normal: [number, number, number];
  /** vertices of body_b, the lowest first, counter-clockwise as seen from the side that the normal points to */
  triangle: [number, number, number];
  /** of body_a, as given at insertion */
  userDataA: bigint;
  userDataB: bigint;
}

/** Columns of Reading: of an array field, its elements one after the other. */
export interface ReadingColumns {
  readonly contact: Float64Array;
  readonly known: Uint32Array;
  readonly state: Int32Array;
  readonly depth: Float32Array;
  readonly direction: Float32Array;
  readonly position: Float64Array;
  readonly distance: Float64Array;
  readonly surfacePosition: Float64Array;
  readonly barycentric: Float64Array;
  readonly normal: Float64Array;
  readonly triangle: Uint32Array;
  readonly userDataA: BigUint64Array;
  readonly userDataB: BigUint64Array;
}

/** What to read. */
export interface ReadingsDesc {
  /**
   * vox_reading_flags, combined with |; 0: all. Without SURFACE a reading takes about as long as copying it. The other
   * fields of vox_reading, such as user data, are always set
   */
  what: number;
  /** VOX_NULL_BODY: all contacts; else those that vox_mesh_copy_contacts copies */
  bodyA: number;
  /** VOX_NULL_BODY, or those that vox_pair_copy_contacts copies for body_a and it */
  bodyB: number;
  /**
   * Most searches for a closest point. The first contacts that need one get it; the readings of the others lack
   * VOX_READING_SURFACE in `known`, and the log has a warning. 0: no limit.
   */
  closestBudget: number;
}

/** A count, or a time in nanoseconds. */
export interface Counter {
  value: number;
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
