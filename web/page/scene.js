// The scene's module: WebAssembly and the few functions that it asks for, with arrays and texts of JavaScript.

/** Engines have the numbers of the vox_cost_model that predicts their times. */
export const ENGINE = { paper: 1, fast: 2 };
/** play_kind. */
export const KINDS = ["ball", "box", "ring", "capsule", "bar", "file"];
export const FIXED = KINDS.length;
/** play_tool. */
export const TOOL = { none: 0, sphere: 1, blade: 2 };
const FACTS = ["tets", "contacts", "deepest", "stepNs", "detectNs", "gridNs", "cellSize", "maxSpeed", "steps", "asleep", "bytes", "byteLimit", "pairs", "touched", "toolX", "toolY", "toolZ"];

/** A module with one instruction of the SIMD of 128 bits. */
const simdProbe = Uint8Array.of(0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 10, 1, 8, 0, 65, 0, 253, 15, 253, 98, 11);
export const simdSupported = () => WebAssembly.validate(simdProbe);

/** What the library refuses, in its own words. */
export class SceneError extends Error {}

const utf8 = new TextDecoder();

export class Scene {
  #exports;
  #play;

  static async load(address, byteLimit) {
    const scene = new Scene();
    const noFiles = () => 52; // "not supported": the module reads no files
    const response = await fetch(address);
    if (!response.ok) throw new Error(`${address}: ${response.status}${simdSupported() ? "" : ", and this browser has no SIMD in WebAssembly"}`);
    const module = await WebAssembly.compile(await response.arrayBuffer());
    const imports = {};
    for (const { module: from, name } of WebAssembly.Module.imports(module)) (imports[from] ??= {})[name] = noFiles;
    Object.assign((imports.wasi_snapshot_preview1 ??= {}), {
      clock_time_get: (clock, precision, at) => {
        new DataView(scene.#exports.memory.buffer).setBigUint64(at, BigInt(Math.round(performance.now() * 1e6)), true);
        return 0;
      },
      proc_exit: (code) => {
        throw new Error(`the module has ended with ${code}`);
      },
    });
    Object.assign((imports.env ??= {}), { emscripten_notify_memory_growth: () => {} });
    scene.#exports = (await WebAssembly.instantiate(module, imports)).exports;
    scene.#exports._initialize?.();
    scene.#play = scene.#out(4, (at) => scene.#check(scene.#exports.play_create(BigInt(byteLimit), at)), (view) => view.getUint32(0, true));
    return scene;
  }

  #check(result) {
    if (result !== 0) throw new SceneError(this.#text(this.#exports.vox_last_error()));
  }

  #text(at) {
    const bytes = new Uint8Array(this.#exports.memory.buffer, at);
    return utf8.decode(bytes.subarray(0, bytes.indexOf(0)));
  }

  /** Runs `call` with `size` bytes of memory, and reads them. */
  #out(size, call, read) {
    const at = this.#take(size);
    try {
      call(at);
      return read(new DataView(this.#exports.memory.buffer, at, size));
    } finally {
      this.#exports.free(at);
    }
  }

  #take(size) {
    const at = this.#exports.malloc(size);
    if (at === 0) throw new SceneError(`there is not enough memory for ${size} bytes`);
    return at;
  }

  /** Runs `call` with a copy of bytes. */
  #with(bytes, call) {
    const at = this.#take(Math.max(bytes.length, 1));
    try {
      new Uint8Array(this.#exports.memory.buffer, at, bytes.length).set(bytes);
      return call(at);
    } finally {
      this.#exports.free(at);
    }
  }

  #numbers(values, call) {
    return this.#with(new Uint8Array(Float64Array.from(values).buffer), call);
  }

  /** A list that a function returns, with its length: a copy. */
  #list(call, Type, width) {
    let from = 0;
    const count = this.#out(4, (at) => (from = call(at)), (view) => view.getUint32(0, true));
    return new Type(this.#exports.memory.buffer, from, count * width).slice();
  }

  get version() {
    return this.#text(this.#exports.vox_build_info()).match(/[\d.]+/)[0];
  }

  drop(kind, tets) {
    this.#check(this.#exports.play_drop(this.#play, kind, tets));
  }

  /** What was odd about the file. */
  dropFile(name, bytes, tets, yUp) {
    this.#with(new TextEncoder().encode(`${name}\0`), (nameAt) =>
      this.#with(bytes, (at) => this.#check(this.#exports.play_drop_file(this.#play, nameAt, at, BigInt(bytes.length), tets, Number(yUp)))),
    );
    return this.#text(this.#exports.play_text(this.#play));
  }

  clear() {
    this.#check(this.#exports.play_clear(this.#play));
  }

  configure({ engine, self, stiffness }) {
    this.#check(this.#exports.play_configure(this.#play, engine, Number(self), stiffness));
  }

  setCellSize(size) {
    this.#check(this.#exports.play_set_cell_size(this.#play, size));
  }

  step() {
    this.#check(this.#exports.play_step(this.#play));
  }

  /** The point that is held, or null. */
  grab(from, to) {
    return this.#numbers([...from, ...to], (at) =>
      this.#out(
        32,
        (out) => this.#check(this.#exports.play_grab(this.#play, at, at + 24, out, out + 24)),
        (view) => (view.getUint32(24, true) ? [0, 8, 16].map((place) => view.getFloat64(place, true)) : null),
      ),
    );
  }

  drag(point) {
    this.#numbers(point, (at) => this.#exports.play_drag(this.#play, at));
  }

  letGo() {
    this.#exports.play_let_go(this.#play);
  }

  /** Takes a tool (TOOL) into the hand, or moves it; a blade stands along a direction. */
  hold(tool, point, along) {
    this.#numbers([...point, ...along], (at) => this.#check(this.#exports.play_hold(this.#play, tool, at, at + 24)));
  }

  /** How many bodies were cut. */
  cut(eye, first, second) {
    return this.#numbers([...eye, ...first, ...second], (at) =>
      this.#out(4, (out) => this.#check(this.#exports.play_cut(this.#play, at, at + 24, at + 48, out)), (view) => view.getUint32(0, true)),
    );
  }

  /** Bodies, without their positions. */
  bodies() {
    const memory = () => this.#exports.memory.buffer;
    return Array.from({ length: this.#exports.play_body_count(this.#play) }, (_, i) => {
      const [positions, triangles, vertexCount, triangleCount, uncut, serial, origin, kind] = new Uint32Array(
        memory(), this.#exports.play_get_body(this.#play, i), 8);
      return { positions, vertexCount, uncut, serial, origin, kind, triangles: new Uint32Array(memory(), triangles, 3 * triangleCount).slice() };
    });
  }

  /** The positions of all bodies, one after the other. */
  positions(bodies) {
    const all = new Float32Array(bodies.reduce((sum, body) => sum + 3 * body.vertexCount, 0));
    let at = 0;
    for (const { positions, vertexCount } of bodies) {
      all.set(new Float32Array(this.#exports.memory.buffer, positions, 3 * vertexCount), at);
      at += 3 * vertexCount;
    }
    return all;
  }

  penetrations() {
    return this.#list((at) => this.#exports.play_penetrations(this.#play, at), Float32Array, 6);
  }

  /** Lines: edges that the blade crosses. */
  touched() {
    return this.#list((at) => this.#exports.play_touched(this.#play, at), Float32Array, 6);
  }

  tiles() {
    return this.#list((at) => this.#exports.play_boxes(this.#play, 0, at), Float32Array, 6);
  }

  windows() {
    return this.#list((at) => this.#exports.play_boxes(this.#play, 1, at), Float32Array, 6);
  }

  facts() {
    const values = new Float64Array(this.#exports.memory.buffer, this.#exports.play_get_facts(this.#play), FACTS.length);
    return Object.fromEntries(FACTS.map((name, i) => [name, values[i]]));
  }

  hash() {
    return BigInt.asUintN(64, this.#exports.play_hash(this.#play)).toString(16).padStart(16, "0");
  }

  /** Milliseconds of a step at a cell size, and whether its contacts are those of the default settings. */
  measure(engine, cellSize, steps) {
    return this.#out(
      16,
      (at) => this.#check(this.#exports.play_measure(this.#play, engine, cellSize, steps, at, at + 8)),
      (view) => ({ ms: view.getFloat64(0, true) / steps / 1e6, same: view.getUint32(8, true) === 1 }),
    );
  }

  /** The curve of an engine's predicted milliseconds, with what else is known of it. */
  suggest(engine) {
    const milliseconds = (seconds) => Math.max(1000 * seconds, 1e-5); // bodies that are far apart cost the fast engine nothing
    const at = this.#exports.play_suggest_numbers(this.#play, engine);
    if (at === 0) throw new SceneError(this.#text(this.#exports.vox_last_error()));
    const numbers = (begin, length) => new Float64Array(this.#exports.memory.buffer, at + 8 * begin, length);
    const [size, min, max, cost, ...counts] = numbers(0, 7);
    const [curve, terms, rules] = counts.map((count, kind) => {
      const begin = 7 + 2 * counts.slice(0, kind).reduce((sum, one) => sum + one, 0);
      return Array.from({ length: count }, (_, i) => numbers(begin + 2 * i, 2));
    });
    const timed = ([size, cost]) => ({ size, ms: milliseconds(cost) });
    const found = {
      ...timed([size, cost]),
      zone: [min, max],
      curve: curve.map(timed),
      work: terms.map(([count, part], i) => ({
        name: this.#text(this.#exports.play_term(this.#play, i)),
        count,
        share: cost > 0 ? part / cost : 0,
      })),
      rules: rules
        .map((rule, i) => ({ name: this.#text(this.#exports.play_rule(this.#play, i)), ...timed(rule) }))
        .filter((rule) => rule.size > 0),
    };
    const odd = [found, ...found.curve].find(({ size, ms }) => !(size > 0 && ms > 0 && ms < Infinity));
    if (odd) throw new SceneError(`a step is predicted to take ${odd.ms} ms at the cell size ${odd.size}`);
    return found;
  }

  /** A snapshot, and the hash of the contacts in it. */
  save() {
    return this.#out(
      24,
      (at) => this.#check(this.#exports.play_save(this.#play, at, at + 8, at + 16)),
      (view) => ({
        bytes: new Uint8Array(this.#exports.memory.buffer, view.getUint32(0, true), Number(view.getBigUint64(8, true))).slice(),
        hash: view.getBigUint64(16, true).toString(16).padStart(16, "0"),
      }),
    );
  }

  restore(bytes) {
    this.#with(bytes, (at) => this.#check(this.#exports.play_load(this.#play, at, BigInt(bytes.length))));
  }
}
