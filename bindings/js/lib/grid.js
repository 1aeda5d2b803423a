import { Format } from "../enums.js";
import { bits, bytes, callback, fields, flag, float, floats, indices, integer, list, bodyId, options, positions } from "./check.js";
import { cellSizeResult, suggestOptions, weighted } from "./cell_size.js";
import { Locator } from "./locator.js";
import { meshArrays, meshDesc, same } from "./mesh_arrays.js";
import { guarded, memoryOf, Owned, pointerOf, pointerOfKind } from "./owned.js";
import { records } from "./records.js";
import { shapeOf } from "./shapes.js";

const GRID = ["cellSize", "margin", "byteBudget", "maxConstraintsPerPair", "flags", "log", "reference"];
const REFERENCE = ["flags", "hashTableSize", "worldMin", "worldMax"];
const FILTER = ["flags", "group", "category", "mask", "world", "selfRings", "selfRestDistance"];
const MESH = ["positions", "tets", "userData", "filter", "restPositions"];
const TOPOLOGY = ["positions", "tets", "restPositions"];
const VERTICES = ["positions", "copiesOf", "restPositions"];
const CONSTRAINTS = ["method", "bodyA", "bodyB", "mask", "closestBudget"];

const filterOf = (filter) => fields(filter, "filter", "vox_filter", FILTER);

let logged;
let lend;

// The module's memory outlives grids, and what it calls must not hold them: a log may well hold its grid. So these functions
// stand where they see nothing else.

/** The log of a grid: its own from the options, until there is an object that has it. */
function logOf(owner) {
  return (...line) => {
    const grid = owner.grid?.deref();
    if (grid) logged(grid, ...line);
    else owner.log?.(...line);
  };
}

function closing(memory, id, lent) {
  return (pointer) => {
    memory.call.vox_grid_destroy(pointer);
    memory.removeCallback(id);
    for (const at of lent.values()) memory.exports.free(at);
  };
}

/** A set of meshes that collide. */
export class Grid extends Owned {
  #log;
  #lent; // of meshes by id: where their previous positions are

  /** @param {Uint8Array} [snapshot] what save() gave, instead of an empty grid */
  constructor(memory, settings, snapshot) {
    const { log, reference, ...given } = fields(settings, "options", "vox_grid_desc", GRID);
    const paper = reference && weighted(reference, "options.reference", "vox_reference_desc", REFERENCE);
    const owner = { log: log === undefined ? undefined : callback(log, "options.log") };
    const id = log ? memory.addCallback(logOf(owner)) : 0;
    let pointer = 0;
    try {
      pointer = memory.frame((frame) => {
        if (paper) given.reference = paper(frame);
        if (log) memory.exports.voxtet_set_log((given.log = frame.struct("vox_log")), id);
        const desc = frame.struct("vox_grid_desc", given);
        memory.exports.voxtet_set_threads?.(desc);
        const out = frame.take(4);
        memory.data.setUint32(out, 0, true);
        try {
          if (snapshot) memory.call.vox_grid_load(frame.array(snapshot), snapshot.length, desc, out);
          else memory.call.vox_grid_create(desc, out);
        } catch (error) {
          const made = memory.stopped ? 0 : memory.data.getUint32(out, true); // its log threw, when it was made
          if (made !== 0) memory.call.vox_grid_destroy(made);
          throw error;
        }
        return memory.data.getUint32(out, true);
      });
    } catch (error) {
      memory.removeCallback(id);
      throw error;
    }
    const lent = new Map();
    super(memory, "grid", pointer, closing(memory, id, lent));
    this.#log = log;
    this.#lent = lent;
    owner.grid = new WeakRef(this);
    owner.log = undefined;
  }

  static {
    logged = (grid, ...line) => guarded([grid], () => grid.#log(...line));
    lend = (grid, id, at) => {
      memoryOf(grid).exports.free(grid.#lent.get(id) ?? 0);
      grid.#lent.set(id, at);
    };
  }

  #call(name, ...given) {
    return memoryOf(this).call[name](pointerOf(this), ...given);
  }

  #get(struct, name, ...given) {
    return memoryOf(this).get(struct, (out) => this.#call(name, ...given, out));
  }

  /** The view that `name` gives, and its records in a copy. */
  #view(name, struct) {
    const view = this.#get(`${struct}_view`, name);
    return [view, records(memoryOf(this), struct, view.data, view.count)];
  }

  // ---- settings ----

  clear() {
    this.#call("vox_grid_clear");
    for (const id of this.#lent.keys()) lend(this, id, 0);
  }

  reserve(meshes, contacts) {
    this.#call("vox_grid_reserve", integer(meshes, "meshes", "u32"), integer(contacts, "contacts", "count"));
  }

  prepare() {
    this.#call("vox_grid_prepare");
  }

  get cellSize() {
    return this.info.cellSize;
  }

  set cellSize(value) {
    this.#call("vox_grid_set_cell_size", float(value, "cellSize"));
  }

  get margin() {
    return this.info.margin;
  }

  set margin(value) {
    this.#call("vox_grid_set_margin", float(value, "margin"));
  }

  get flags() {
    return this.info.flags;
  }

  set flags(value) {
    this.#call("vox_grid_set_flags", integer(value, "flags", "u32"));
  }

  // ---- meshes ----

  add(mesh) {
    const memory = memoryOf(this);
    const given = options(mesh, "mesh", MESH);
    const filter = given.filter === undefined ? undefined : filterOf(given.filter);
    const userData = given.userData === undefined ? 0n : bits(given.userData, "userData");
    const arrays = meshArrays(given, memory);
    const id = memory.frame((frame) =>
      memory.number("u32", (out) =>
        this.#call(
          "vox_mesh_insert",
          meshDesc(frame, arrays, { userData, filter }),
          out,
        ),
      ),
    );
    return new Body(this, id);
  }

  addShape(shape) {
    const memory = memoryOf(this);
    const described = shapeOf(shape, filterOf, memory);
    return new Body(this, memory.frame((frame) => memory.number("u32", (out) => this.#call("vox_shape_insert", described(frame), out))));
  }

  body(id) {
    return new Body(this, integer(id, "id", "u32"));
  }

  get bodies() {
    const memory = memoryOf(this);
    return memory.frame((frame) => {
      const count = memory.number("count", (out) => this.#call("vox_grid_get_bodies", 0, 0, out));
      const ids = frame.take(4 * count);
      memory.number("count", (out) => this.#call("vox_grid_get_bodies", ids, count, out));
      return Array.from(memory.copy("u32", ids, count), (id) => new Body(this, id));
    });
  }

  setPairEnabled(bodyA, bodyB, enabled) {
    this.#call("vox_grid_set_pair_enabled", bodyId(bodyA, "bodyA"), bodyId(bodyB, "bodyB"), flag(enabled, "enabled"));
  }

  // ---- step and results ----

  step() {
    this.#call("vox_grid_step");
  }

  get epoch() {
    return this.info.epoch;
  }

  get hash() {
    return memoryOf(this).number("u64", (out) => this.#call("vox_grid_get_hash", out));
  }

  get contacts() {
    return this.#view("vox_grid_get_contacts", "vox_contact")[1];
  }

  get contactInteriors() {
    const view = this.#get("vox_contact_view", "vox_grid_get_contacts");
    return memoryOf(this).copy("u8", view.interiors, view.count);
  }

  get pairs() {
    const [view, pairs] = this.#view("vox_grid_get_pairs", "vox_pair");
    pairs.contacts = memoryOf(this).copy("u32", view.contacts, this.#get("vox_contact_view", "vox_grid_get_contacts").count);
    return pairs;
  }

  findConstraints(settings) {
    const given = fields(settings, "options", "vox_constraint_desc", CONSTRAINTS);
    memoryOf(this).frame((frame) => this.#call("vox_grid_find_constraints", frame.struct("vox_constraint_desc", given)));
  }

  get constraints() {
    const [view, constraints] = this.#view("vox_grid_get_constraints", "vox_constraint");
    constraints.pairOffsets = Array.from(memoryOf(this).copy("u64", view.pairOffsets, view.pairCount + 1), Number);
    return constraints;
  }

  failure(index = 0) {
    const failure = this.#get("vox_failure", "vox_grid_get_failure", integer(index, "index", "u32"));
    return failure.body === 0 ? null : failure;
  }

  // ---- locators, snapshots, measurements ----

  locator() {
    return new Locator(this);
  }

  save() {
    const memory = memoryOf(this);
    return memory.frame((frame) => {
      const size = memory.number("count", (out) => this.#call("vox_grid_save", 0, 0, out));
      const at = frame.take(size);
      memory.number("count", (out) => this.#call("vox_grid_save", at, size, out));
      return memory.copy("u8", at, size);
    });
  }

  get info() {
    return this.#get("vox_grid_info", "vox_grid_get_info");
  }

  get counters() {
    const memory = memoryOf(this);
    const [, all] = this.#view("vox_grid_get_counters", "vox_counter");
    return Object.fromEntries(Array.from(all, ({ name, value }) => [memory.text(name), value]));
  }

  suggestCellSize(settings) {
    const described = settings === undefined ? () => 0 : suggestOptions(settings);
    return cellSizeResult(memoryOf(this), (frame, out) => this.#call("vox_grid_suggest_cell_size", described(frame), out));
  }
}

/** A mesh or a shape of a grid: its id, and the functions that take one. */
export class Body {
  #grid;
  #id;

  constructor(grid, id) {
    this.#grid = grid;
    this.#id = id;
  }

  get id() {
    return this.#id;
  }

  get grid() {
    return this.#grid;
  }

  #call(name, ...given) {
    return memoryOf(this.#grid).call[name](pointerOf(this.#grid), this.#id, ...given);
  }

  get valid() {
    return this.#call("vox_body_is_valid") !== 0;
  }

  remove() {
    this.#call("vox_body_remove");
    lend(this.#grid, this.#id, 0);
  }

  get info() {
    const { positions, ...info } = memoryOf(this.#grid).get("vox_body_info", (out) => this.#call("vox_body_get_info", out));
    return { ...info, vertexCount: positions.count, positionFormat: positions.format };
  }

  get userData() {
    return memoryOf(this.#grid).number("u64", (out) => this.#call("vox_body_get_user_data", out));
  }

  /** The positions in the module's memory, which moves: take it anew where it is used. */
  get positions() {
    const memory = memoryOf(this.#grid);
    const { vertexCount, positionFormat } = this.info;
    return memory.frame((frame) => {
      const out = frame.take(8);
      this.#call("vox_mesh_map_positions", out);
      const numbers = 3 * vertexCount;
      const at = memory.data.getUint32(out, true);
      const Array = positionFormat === Format.DOUBLE ? Float64Array : Float32Array;
      return numbers === 0 ? new Array() : new Array(memory.buffer, at, numbers);
    });
  }

  set positions(value) {
    const array = positions(value, "positions", memoryOf(this.#grid));
    const own = this.positions;
    if (array.BYTES_PER_ELEMENT !== own.BYTES_PER_ELEMENT)
      throw new TypeError(`positions: those of this mesh are a ${own.constructor.name}, got a ${array.constructor.name}`);
    if (array.length !== own.length)
      throw new RangeError(`positions: this mesh has ${own.length / 3} vertices, got ${array.length / 3} positions`);
    own.set(array);
  }

  bindPreviousPositions(value) {
    const memory = memoryOf(this.#grid);
    const array = value === null ? undefined : positions(value, "positions", memory);
    memory.frame((frame) => {
      const given = frame.positions(array);
      this.#call("vox_mesh_bind_previous_positions", array ? frame.struct("vox_positions", given) : 0);
      lend(this.#grid, this.#id, array ? frame.keep(given.data) : 0);
    });
  }

  get tets() {
    return this.#tets(true);
  }

  get enabledTets() {
    return this.#tets(false);
  }

  #tets(corners) {
    const memory = memoryOf(this.#grid);
    const { tetCount } = this.info;
    const type = corners ? "u32" : "u8";
    const numbers = corners ? 4 * tetCount : tetCount;
    return memory.frame((frame) => {
      const at = frame.take(corners ? 4 * numbers : numbers);
      memory.number("count", (out) => this.#call("vox_mesh_get_tets", corners ? at : 0, corners ? 0 : at, tetCount, out));
      return memory.copy(type, at, numbers);
    });
  }

  markMoved() {
    this.#call("vox_body_mark_moved");
  }

  #place(name, matrix) {
    const rows = matrix === null ? null : floats(matrix, "matrix", 12);
    memoryOf(this.#grid).frame((frame) => this.#call(name, rows ? frame.numbers(rows) : 0));
  }

  setTransform(matrix) {
    this.#place("vox_body_set_transform", matrix);
  }

  setPreviousTransform(matrix) {
    this.#place("vox_shape_set_previous_transform", matrix);
  }

  get filter() {
    return this.info.filter;
  }

  set filter(value) {
    const given = filterOf(value);
    memoryOf(this.#grid).frame((frame) => this.#call("vox_body_set_filter", frame.struct("vox_filter", given)));
  }

  get enabled() {
    return this.info.enabled !== 0;
  }

  set enabled(value) {
    this.#call("vox_body_set_enabled", flag(value, "enabled"));
  }

  // ---- cutting and growing ----

  #indexed(name, array, what, ...further) {
    const given = indices(array, what, 1, memoryOf(this.#grid));
    memoryOf(this.#grid).frame((frame) => this.#call(name, frame.array(given), given.length, ...further));
  }

  setTopology(mesh) {
    const memory = memoryOf(this.#grid);
    const arrays = meshArrays(options(mesh, "mesh", TOPOLOGY), memory);
    memory.frame((frame) => this.#call("vox_mesh_set_topology", meshDesc(frame, arrays, {})));
  }

  setTetsEnabled(tets, enabled) {
    this.#indexed("vox_mesh_set_tets_enabled", tets, "tets", flag(enabled, "enabled"));
  }

  removeTets(tets) {
    this.#indexed("vox_mesh_remove_tets", tets, "tets");
  }

  removeVertices(vertices) {
    this.#indexed("vox_mesh_remove_vertices", vertices, "vertices");
  }

  replaceTets(tets, corners) {
    const memory = memoryOf(this.#grid);
    const which = indices(tets, "tets", 1, memory);
    const given = indices(corners, "corners", 4, memory);
    if (given.length !== 4 * which.length)
      throw new RangeError(`corners: expected 4 numbers for each of ${which.length} tets, got ${given.length}`);
    memory.frame((frame) =>
      this.#call("vox_mesh_replace_tets", frame.array(which), which.length, frame.array(given)),
    );
  }

  appendTets(corners) {
    const memory = memoryOf(this.#grid);
    const given = indices(corners, "corners", 4, memory);
    return memory.frame((frame) => {
      const at = frame.array(given);
      return memory.number("u32", (out) => this.#call("vox_mesh_append_tets", at, given.length / 4, out));
    });
  }

  appendVertices(vertices) {
    const memory = memoryOf(this.#grid);
    const given = options(vertices, "vertices", VERTICES);
    const array = given.positions === undefined ? undefined : positions(given.positions, "positions", memory);
    const rest = given.restPositions === undefined ? undefined : positions(given.restPositions, "restPositions", memory);
    const copiesOf = given.copiesOf === undefined ? undefined : indices(given.copiesOf, "copiesOf", 1, memory);
    const count = array ? array.length / 3 : copiesOf ? copiesOf.length : 0;
    if (copiesOf) same("copiesOf", copiesOf.length, count);
    return memory.frame((frame) => {
      const desc = frame.struct("vox_vertices_desc", {
        count,
        positions: frame.positions(array),
        copiesOf: copiesOf ? frame.array(copiesOf) : 0,
        restPositions: frame.positions(rest),
      });
      return memory.number("u32", (out) => this.#call("vox_mesh_append_vertices", desc, out));
    });
  }
}

/** Steps all of them, one after the other. The first failure is thrown when all have had their step. */
export function stepGrids(memory, grids) {
  const all = list(grids, "grids", "grids");
  const pointers = gridPointers(memory, all);
  memory.frame((frame) => {
    const at = frame.array(pointers);
    guarded(all, () => memory.call.vox_grids_step(at, pointers.length, 1, 0, 0));
  });
}

function gridPointers(memory, grids) {
  return Uint32Array.from(list(grids, "grids", "grids"), (grid, i) => pointerOfKind(grid, "grid", memory, `grids[${i}]`));
}

/** What save() gave. */
export function snapshotBytes(value, memory) {
  return bytes(value, "bytes", memory);
}
