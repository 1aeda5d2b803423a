/// <reference lib="esnext.disposable" />
// voxtet: vox in WebAssembly. Fields of options and results are those of the structs of vox.h, whose comments they have.
import type { CellsKept, CellsQueried, CellsStored, Format, KnownGrid, LogLevel, PrimitiveType, Result, ShapeKind } from "./enums.js";
import type {
  BodyInfo, BoxHit, BoxHitColumns, CellSizeDesc, CellSizeResult as CellSizeResultStruct, CellSizeRule as CellSizeRuleStruct,
  ClosestHit, ClosestHitColumns, Constraint, ConstraintColumns, ConstraintDesc, Contact, ContactColumns,
  CostTerm as CostTermStruct, CostWeights, Failure, Filter, ForeignCounts, ForeignWeights, Geometry, GridDesc, GridInfo, Location,
  LocationColumns, Pair, PairColumns, PointHit, PointHitColumns, QueryDesc, RayHit, RayHitColumns, ReferenceDesc, Timing,
  TrackPiece, TrackPieceColumns, TriangleHit, TriangleHitColumns, TuneDesc,
} from "./structs.js";

export * from "./enums.js";
export type {
  BodyInfo, BoxHit, ClosestHit, Constraint, Contact, CostSample, CostWeights, Failure, Filter, ForeignCounts, ForeignWeights,
  Geometry, GridInfo, Location, Pair, PointHit, RayHit, Timing, TrackPiece, TriangleHit,
} from "./structs.js";

/** A call that vox refused. The message says what was wrong, with numbers in it; `code` is one of `Result`. */
export declare class VoxError extends Error {
  constructor(code: Result, text: string);
  code: Result;
}

// ---- loading ----

export interface LoadOptions {
  /** Which of the two modules to load; by default the one with SIMD, where that is supported. */
  simd?: boolean;
  /** Threads that a step uses, that of the caller included; "all": one per core. By default 1. Where memory cannot be shared
   * with Workers (`threadsSupported`) or there is no SIMD it is 1, whatever is asked for. */
  threads?: number | "all";
  /** Another place for the module: an address, its bytes, a Response, or a compiled module (as of a Worker). */
  wasm?: string | URL | ArrayBuffer | ArrayBufferView | WebAssembly.Module | Response
    | Promise<ArrayBuffer | WebAssembly.Module | Response>;
}

/** Loads the module. Each call gives another one, with its own memory; what was compiled is used again. */
export declare function load(options?: LoadOptions): Promise<Vox>;

/** Whether this machine has WebAssembly with SIMD. */
export declare function simdSupported(): boolean;

/** Whether memory can be shared with Workers, and so be used by several threads: in Node, and in pages that are cross-origin
 * isolated. */
export declare function threadsSupported(): boolean;

/** A module. Everything that it gives lies in its memory, and works with nothing of another module. */
export interface Vox {
  readonly Grid: GridConstructor;
  /** Of the library, as "0.1.0". */
  readonly version: string;
  /** Compiler and options of the library. */
  readonly buildInfo: string;
  /** To be posted to a Worker, which gives it to `load({ wasm })`. */
  readonly module: WebAssembly.Module;
  /** Threads that a step of its grids uses, that of the caller included. */
  readonly threads: number;
  /** Size of the memory. It grows, and never shrinks. */
  readonly memoryBytes: number;

  /** Steps all of them, one after the other. If some fail, all others have had their step when the first failure is thrown.
   * A log that is called meanwhile must not use any of them. */
  stepGrids(grids: readonly Grid[]): void;

  /** The cell size that minimises the cost model for these meshes. */
  suggestCellSize(meshes: readonly SuggestMesh[], options?: SuggestOptions): CellSizeResult;
  /** Sizes in these meshes. */
  measureGeometry(meshes: readonly SuggestMesh[]): Geometry;
  /** Measures what work costs on this machine, for `weights` of SuggestOptions and ReferenceOptions; plain numbers. */
  calibrate(): CostWeights;
  /** The cell size of least cost between min and max, for a cost function of one's own; `zoneLoss` as in SuggestOptions. */
  minimiseCost(cost: (cellSize: number) => number, min: number, max: number, zoneLoss?: number): CellSizeResult;

  /** The cell size that costs a grid of another program least. */
  foreignGridSuggest(grid: ForeignGridOptions): CellSizeResult;
  /** What a run of that grid does at one cell size. */
  foreignGridCount(grid: ForeignGridOptions, cellSize: number): ForeignCounts;
  /** Its weights and best cell size from timings at three cell sizes or more. */
  foreignGridFit(grid: ForeignGridOptions, timings: readonly Timing[]): CellSizeResult;
  /**
   * Its best cell size by running it: `run` runs it once at a cell size and returns how many seconds that took, Infinity if it
   * cannot run at this size, NaN to stop. What it throws is thrown here. Without a `grid`, `first` must be set.
   */
  foreignGridTune(run: (cellSize: number) => number, options?: TuneOptions): CellSizeResult;
}

/** Segments between `count` positions, one after the other, as triangles of a sheet: a needle, a thread. */
export declare function polyline(count: number): Uint32Array;

// ---- arrays ----

/** x y z of each vertex, singles or doubles. */
export type Positions = Float32Array | Float64Array;
/** Numbers of vertices or tetrahedra. Arrays other than a Uint32Array are looked at number by number. */
export type Indices = Uint32Array | Uint16Array | Uint8Array | Int32Array | Int16Array | Int8Array | readonly number[];
export type Vector = ArrayLike<number>;
/** 64 bits: a bigint, or a whole number below 2 ** 53. */
export type Bits = bigint | number;
/** A mesh, or its id; null: none. */
export type BodyOrId = Body | number;

/**
 * Records in a copy of their own: nothing that the grid does later changes them. Besides `at` and iteration, which make an
 * object of each record, every field of theirs is a property: a column of the values of all records, made when it is asked
 * for, with those of array fields one after the other.
 */
export interface RecordsOf<Item, Columns> extends Iterable<Item> {
  readonly length: number;
  /** The copy: records as C has them, one after the other. */
  readonly bytes: Uint8Array;
  /** An index below 0 counts from the end. */
  at(index: number): Item | undefined;
  /** Those from `begin` to before `end`, as of an array, in the same memory. */
  slice(begin?: number, end?: number): this;
}
export type Records<Item, Columns> = RecordsOf<Item, Columns> & Columns;

export type Contacts = Records<Contact, ContactColumns>;
export type Locations = Records<Location, LocationColumns>;
export type TrackPieces = Records<TrackPiece, TrackPieceColumns>;
export type TriangleHits = Records<TriangleHit, TriangleHitColumns>;
export type PointHits = Records<PointHit, PointHitColumns>;
export type ClosestHits = Records<ClosestHit, ClosestHitColumns>;
export type BoxHits = Records<BoxHit, BoxHitColumns>;
export type RayHits = Records<RayHit, RayHitColumns>;
/** `contacts`: the index of every contact once, pair by pair; those of a pair begin at its `firstContact`. */
export type Pairs = Records<Pair, PairColumns> & { readonly contacts: Uint32Array };
/** Those of pair p are slice(pairOffsets[p], pairOffsets[p + 1]). */
export type Constraints = Records<Constraint, ConstraintColumns> & { readonly pairOffsets: number[] };

// ---- grids ----

export interface GridOptions
  extends Partial<Pick<GridDesc, "cellSize" | "margin" | "byteBudget" | "maxConstraintsPerPair">> {
  /** The paper's engine, in place of the fast one. */
  reference?: ReferenceOptions;
  /** GridFlags, combined with |; default none. */
  flags?: number;
  /**
   * Gets the lines that the library writes. It must not use the grid that it belongs to. What it throws is thrown by the call
   * that wrote the line, when that call has done its work.
   */
  log?: (level: LogLevel, text: string) => void;
}

export interface ReferenceOptions extends Partial<Omit<ReferenceDesc, "worldMin" | "worldMax">> {
  /** The box that has cells, where these are dense. */
  worldMin?: Vector;
  worldMax?: Vector;
  /** Missing: those shipped with the library. */
  weights?: CostWeights;
}

export interface FilterOptions extends Partial<Omit<Filter, "category" | "mask">> {
  category?: Bits;
  mask?: Bits;
}

export interface MeshOptions {
  /** Copied: `Body.positions` moves them. */
  positions: Positions;
  /** Four vertices each, copied. Without any, the vertices alone collide. */
  tets?: Indices;
  userData?: Bits;
  filter?: FilterOptions;
  /** The rest pose, for FilterOptions.selfRestDistance; in numbers of the same size. */
  restPositions?: Positions;
}

interface ShapeBasics {
  userData?: Bits;
  filter?: FilterOptions;
}

/**
 * A rigid shape, in a frame of its own: `setTransform` of what `addShape` returns places it. Arrays are copied, lengths may be 0.
 * May change in any release.
 */
export type ShapeOptions = ShapeBasics &
  (
    | { /** All z <= 0: a floor. */ kind: typeof ShapeKind.HALF_SPACE }
    | { /** Around the origin. */ kind: typeof ShapeKind.SPHERE; radius: number }
    | { /** Along the z axis; `halfLength` is half the distance between the centres of a capsule's round ends. */
        kind: typeof ShapeKind.CAPSULE | typeof ShapeKind.CYLINDER; radius: number; halfLength: number }
    | { /** Around the origin, by half its sides. */ kind: typeof ShapeKind.BOX; halfSize: Vector }
    | { /** Terrain, solid below: heights row after row, at x = column * spacing[0], y = row * spacing[1]. */
        kind: typeof ShapeKind.HEIGHTFIELD; heights: Vector; columns: number; spacing: Vector }
    | { /** The inside of a closed surface, whose triangles are counter-clockwise as seen from outside. */
        kind: typeof ShapeKind.SOLID; positions: Positions; triangles: Indices }
    | { /** What is within `radius` of triangles; of segments: see `polyline`. */
        kind: typeof ShapeKind.SHEET; positions: Positions; triangles: Indices; radius?: number }
  );

export interface SuggestMesh {
  positions: Positions;
  tets?: Indices;
  selfCollision?: boolean;
}

export interface SuggestOptions extends Partial<CellSizeDesc> {
  /** Of the models REFERENCE and FAST. Missing: those of the grid's reference engine, or those shipped with the library. */
  weights?: CostWeights;
}
export type CostTerm = CostTermStruct & { name: string };
export type CellSizeRule = CellSizeRuleStruct & { name: string };
/** A cell size and the reasons for it; its arrays have as many elements as there are. */
export interface CellSizeResult
  extends Omit<CellSizeResultStruct, "curveCount" | "termCount" | "ruleCount" | "timingCount" | "terms" | "rules"> {
  /** Their costs add up to `cost`. */
  terms: CostTerm[];
  rules: CellSizeRule[];
}

/** What a grid stores, or what queries it. Of each primitive only the box counts. */
export interface Primitives {
  /** Default: points. */
  type?: PrimitiveType;
  positions: Positions;
  /** The vertices of each primitive: two an edge or a box, three a triangle, four a tetrahedron. Without them, the vertices in
   * their order. */
  indices?: Indices;
  /** Each is larger by its radius. */
  radii?: Vector;
  /** All are larger by this, too. */
  radius?: number;
}

/** A uniform grid of another program. What is missing is as `known` has it. */
export interface ForeignGridOptions {
  /** What is put into cells. */
  stored: Primitives;
  /** The queries; missing: those stored query each other. */
  querying?: Primitives;
  /** The grid that it is like; default: none. */
  known?: KnownGrid;
  cellsStored?: CellsStored;
  cellsQueried?: CellsQueried;
  cellsKept?: CellsKept;
  /** The boxes of queries are larger by this on all sides. */
  radius?: number;
  /** The smallest that gives right answers; 0: any, or with 27 what the boxes demand. */
  minCellSize?: number;
  zoneLoss?: number;
  /** In nanoseconds; those that are missing are 0. All 0: those of `known`. */
  weights?: Partial<ForeignWeights>;
}

export type TuneOptions = Partial<TuneDesc> & { grid?: ForeignGridOptions };

/** Which constraints to find; by default all, with consistent depth. */
export interface ConstraintOptions extends Partial<Pick<ConstraintDesc, "method" | "closestBudget">> {
  /** Only pairs of this mesh, */
  bodyA?: BodyOrId;
  /** and this one. */
  bodyB?: BodyOrId;
  /** Only pairs in which the category of a mesh has a bit in common; 0: all. */
  mask?: Bits;
}

/** Which meshes answer, and how far to look; by default all, at any distance. */
export interface QueryOptions extends Partial<Pick<QueryDesc, "flags" | "maxDistance">> {
  /** Only meshes whose filter's category had a bit in common; 0: all. */
  mask?: Bits;
  /** Not this mesh. */
  excluded?: BodyOrId;
}

/** In the memory of the module, until dispose(): what is forgotten instead is returned at some time after it was collected. */
export interface Owned {
  /** Returns the memory at once. Any later use throws a VoxError; a second dispose() does nothing. */
  dispose(): void;
  [Symbol.dispose](): void;
  readonly disposed: boolean;
}

/**
 * The meshes of a grid at one moment, to be asked at any later time, whatever became of the grid. Decided exactly
 * (vox_query.h). Record lists are in copies of their own, sorted by what was asked about.
 */
export interface Locator extends Owned {
  /** Takes the meshes of a grid as they are now instead of those it had. */
  update(grid: Grid): void;
  /** Grid.epoch when they were taken. */
  readonly epoch: number;
  /** The number that a mesh was added with. */
  userData(mesh: BodyOrId): bigint;
  /** Where points are, and the weights that interpolate a field there; outside, of the closest point, or with
   * QueryFlags.EXTRAPOLATE of the point itself. Record i is that of point i. */
  locate(points: Positions, options?: QueryOptions): Locations;
  /** The tetrahedra that contain points. */
  findPointHits(points: Positions, options?: QueryOptions): PointHits;
  /** The closest point of all surfaces: record i is that of point i; its body is 0 if there is none. */
  findClosest(points: Positions, options?: QueryOptions): ClosestHits;
  /** The tetrahedra whose bounding boxes meet boxes. */
  findBoxHits(min: Positions, max: Positions, options?: QueryOptions): BoxHits;
  /** The facets that rays meet, of each ray by t; with QueryFlags.FIRST_HIT only its first. */
  findRayHits(from: Positions, to: Positions, options?: QueryOptions): RayHits;
  /** The tetrahedra that segments pass through, of each segment by body and t. */
  findTracks(from: Positions, to: Positions, options?: QueryOptions): TrackPieces;
  /** The closest points of segments and all surfaces: the distance is 0 where a segment meets a surface. */
  findClosestToSegments(from: Positions, to: Positions, options?: QueryOptions): ClosestHits;
  /** The tetrahedra that triangles meet, of each triangle by body and t. Each has three corners, which move to those in `to`. */
  findTriangleHits(from: Positions, to?: Positions | null, options?: QueryOptions): TriangleHits;
  /** Of each ray 1 if it meets a tetrahedron, else 0. */
  testRays(from: Positions, to: Positions, options?: QueryOptions): Uint8Array;
}

export interface GridConstructor {
  new (options?: GridOptions): Grid;
  /** A grid from what `save` gave, which need not be trusted. Of the options `log`, `byteBudget`, `margin` and `reference` are used. */
  load(bytes: ArrayBuffer | ArrayBufferView, options?: GridOptions): Grid;
  readonly prototype: Grid;
}

/** A set of meshes that collide. */
export interface Grid extends Owned {
  /** Removes all meshes and contacts and keeps the settings. */
  clear(): void;
  /** Takes memory for that many meshes and contacts in advance. */
  reserve(meshes: number, contacts: number): void;
  /** Makes now what steps make of a mesh once, when they first need it. */
  prepare(): void;
  /** Edge length of a cell; 0: the library chooses. */
  cellSize: number;
  /** Vertices outside a mesh, but within this distance, have constraints of ConstraintKind.PROXIMITY. May change in any
   * release. */
  margin: number;
  /** GridFlags, combined with |. */
  flags: number;

  /** Adds a mesh. Its arrays are copied. */
  add(mesh: MeshOptions): Body;
  /**
   * Adds a rigid shape, which takes part from the next step on. The vertices of meshes collide with it. Its
   * constraints have vertices of `bodyA` alone. What it returns is good wherever a shape has what a mesh has: transform,
   * filter, user data, whether it is enabled; its `info.shape` is a ShapeKind. May change in any release.
   */
  addShape(shape: ShapeOptions): Body;
  /** The body of an id, as results have it. Whether there is one shows when it is used. */
  body(id: number): Body;
  /** All meshes and shapes, in the order of their ids. */
  readonly bodies: Body[];
  /** Whether two bodies collide, if their filters let them. */
  setPairEnabled(bodyA: BodyOrId, bodyB: BodyOrId, enabled: boolean): void;

  /** Finds all contacts of the positions as they are now. */
  step(): void;
  /** Number of steps, clears, reserves and changes of flags or margin so far. */
  readonly epoch: number;
  /** A hash of the contacts: the same on every machine. */
  readonly hash: bigint;
  /** The contacts of the last step; a copy, made at each use, as those that follow. */
  readonly contacts: Contacts;
  /** Of each contact 1 if the vertex is in the interior of the tetrahedron, 0 if on its boundary. */
  readonly contactInteriors: Uint8Array;
  /** The pairs that touch, and those that ended in this step or are within the margin: see `state`. */
  readonly pairs: Pairs;
  /** Finds what `constraints` gives, for the last step. With GridFlags.CONSTRAINTS each step does, by the defaults. */
  findConstraints(options?: ConstraintOptions): void;
  readonly constraints: Constraints;
  /** The mesh that made the last step fail, or one of those that it left out; null beyond the last. */
  failure(index?: number): Failure | null;

  /** The meshes as they are now, to be asked where they are. */
  locator(): Locator;

  /** The grid as bytes that are the same on every machine: settings, meshes, positions, pairs that touch. */
  save(): Uint8Array;

  /** The grid as it is now. */
  readonly info: GridInfo;
  /** What the last step did, and how long each stage of it took, by the names of vox_grid_get_counters. */
  readonly counters: Record<string, number>;
  /** The cell size that minimises the cost model for the meshes of the grid. */
  suggestCellSize(options?: SuggestOptions): CellSizeResult;
}

/** A mesh or a shape of a grid. It is a name: the grid owns what it names, and a removed body is an error when it is used. */
export interface Body {
  readonly id: number;
  readonly grid: Grid;
  readonly valid: boolean;
  remove(): void;
  readonly info: BodyInfo & { vertexCount: number; positionFormat: Format };
  readonly userData: bigint;
  /**
   * The positions, of the kind of array that the mesh was added with. This is the module's memory: what is written to it moves
   * the mesh. Take it anew each time: the array is detached (of length 0) when the memory grows, and must not be used after the
   * mesh was removed or got other vertices. An assignment copies positions into it.
   */
  get positions(): Positions;
  set positions(positions: Positions);
  /**
   * Copies the positions from which the vertices move in the following steps: then vertices that go through a surface
   * within a step have constraints of ConstraintKind.IMPACT. Null ends this. May change in any release.
   */
  bindPreviousPositions(positions: Positions | null): void;
  /** A copy of the tetrahedra as they were given, those that are disabled or removed, too. */
  readonly tets: Uint32Array;
  /** Of each tetrahedron 1, or 0 if it is disabled or removed. */
  readonly enabledTets: Uint8Array;
  /** Makes the next step process the mesh even if it did not move, for measurements. */
  markMoved(): void;
  /** Moves the mesh as a whole by an affine map, three rows of four; null: not at all. A shape is rotated, moved, and scaled
   * along all axes alike. */
  setTransform(matrix: Vector | null): void;
  /** Of a shape: where it was, as in `setTransform`. In the following steps it moves from there, and they also find
   * constraints of ConstraintKind.IMPACT with it. Null ends this. May change in any release. */
  setPreviousTransform(matrix: Vector | null): void;
  /** What the body collides with. Of an assignment, what is missing becomes the default. */
  get filter(): Filter;
  set filter(filter: FilterOptions);
  /** Whether the mesh takes part in steps. */
  enabled: boolean;

  /** Replaces vertices, tetrahedra and positions. */
  setTopology(mesh: Pick<MeshOptions, "positions" | "tets" | "restPositions">): void;
  setTetsEnabled(tets: Indices, enabled: boolean): void;
  /** Gives tetrahedron tets[i] the corners corners[4 * i] to corners[4 * i + 3]. */
  replaceTets(tets: Indices, corners: Indices): void;
  /** Adds tetrahedra, four corners each; gives the index of the first. */
  appendTets(corners: Indices): number;
  removeTets(tets: Indices): void;
  /** Adds vertices, at `positions` or at those of the vertices that they are copies of; gives the index of the first. */
  appendVertices(vertices: { positions?: Positions; copiesOf?: Indices; restPositions?: Positions }): number;
  removeVertices(vertices: Indices): void;
}

