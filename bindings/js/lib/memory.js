// The module's memory and functions, with structs and arrays that are read and written there.
import { ABI_VERSION, Format, Result } from "../enums.js";
import { functions, structs } from "../layout.js";
import { camel } from "./check.js";
import { VoxError } from "./errors.js";
import { sharedMemory, startAll, threadImports } from "./threads.js";

const OUT_BYTES = 8192; // more than any struct that is only read
const PAGE = 65536;

const arrayOf = { u8: Uint8Array, u32: Uint32Array, u64: BigUint64Array };

const readers = {
  u8: (data, at) => data.getUint8(at),
  i32: (data, at) => data.getInt32(at, true),
  u32: (data, at) => data.getUint32(at, true),
  pointer: (data, at) => data.getUint32(at, true),
  f32: (data, at) => data.getFloat32(at, true),
  f64: (data, at) => data.getFloat64(at, true),
  u64: (data, at) => data.getBigUint64(at, true),
  count: (data, at) => Number(data.getBigUint64(at, true)),
};

const writers = {
  i32: (data, at, value) => data.setInt32(at, value, true),
  u32: (data, at, value) => data.setUint32(at, value, true),
  pointer: (data, at, value) => data.setUint32(at, value, true),
  f64: (data, at, value) => data.setFloat64(at, value, true),
  u64: (data, at, value) => data.setBigUint64(at, value, true),
  count: (data, at, value) => data.setBigUint64(at, BigInt(value), true),
};

const bytesOf = { u8: 1, char: 1, i32: 4, u32: 4, pointer: 4, f32: 4, f64: 8, u64: 8, count: 8 };
const hidden = ["struct_size", "reserved"];

/** Of each struct its fields by their names in JavaScript: [name, offset, type, elements]. */
const shownFields = Object.fromEntries(
  Object.entries(structs).map(([struct, { fields }]) => [
    struct,
    Object.entries(fields)
      .filter(([name]) => !hidden.includes(name))
      .map(([name, [offset, type, count]]) => [camel(name), offset, type, count]),
  ]),
);

export function fieldsOf(struct) {
  return shownFields[struct];
}

function text(data, at, most) {
  const bytes = new Uint8Array(data.buffer, data.byteOffset + at, most);
  const end = bytes.indexOf(0);
  return new TextDecoder().decode(bytes.slice(0, end < 0 ? most : end));
}

function value(data, at, type, count) {
  if (type === "char") return text(data, at, count);
  const read = readers[type] ?? ((_, place) => readStruct(data, place, type));
  if (count === 1) return read(data, at);
  const size = bytesOf[type] ?? structs[type].size;
  return Array.from({ length: count }, (_, i) => read(data, at + i * size));
}

/** The struct at byte `at` of a DataView, as an object of its own. */
export function readStruct(data, at, struct) {
  const object = {};
  for (const [name, offset, type, count] of shownFields[struct]) object[name] = value(data, at + offset, type, count);
  return object;
}

/** Memory for the arguments of one call. */
class Frame {
  #memory;
  #taken = [];

  constructor(memory) {
    this.#memory = memory;
  }

  take(size) {
    const at = size < 2 ** 32 - 2 ** 16 ? this.#memory.exports.malloc(Math.max(size, 1)) >>> 0 : 0;
    if (at === 0) throw new VoxError(Result.ERROR_OUT_OF_MEMORY, `${size} bytes for an argument cannot be allocated`);
    this.#taken.push(at);
    return at;
  }

  /** A copy of a typed array; null for one of no elements. */
  array(array) {
    if (array.length === 0) return 0;
    const at = this.take(array.length * array.BYTES_PER_ELEMENT);
    new array.constructor(this.#memory.buffer, at, array.length).set(array);
    return at;
  }

  numbers(numbers) {
    return this.array(Float64Array.from(numbers));
  }

  /** Leaves it to the caller to free what was taken at `at`. */
  keep(at) {
    this.#taken = this.#taken.filter((taken) => taken !== at);
    return at;
  }

  /** The fields of a vox_positions of an array, of which there may be none. */
  positions(array) {
    if (!array) return {};
    const format = array.BYTES_PER_ELEMENT === 8 ? Format.DOUBLE : Format.FLOAT;
    return { data: this.array(array), count: array.length / 3, format };
  }

  /** A struct with these fields; the others are as vox_default_X sets them, or 0. */
  struct(struct, fields) {
    const { size } = structs[struct];
    const at = this.take(size);
    this.#memory.fill(at, struct, fields);
    return at;
  }

  release() {
    if (this.#memory.stopped) return;
    for (const at of this.#taken) this.#memory.exports.free(at);
  }
}

const endThreads = new FinalizationRegistry((workers) => {
  for (const worker of workers) worker.terminate();
});

export class Memory {
  exports;
  /** Threads that a step uses, that of the caller included. */
  threads = 1;
  #shared; // the memory, in a module with threads
  /** The functions of vox.h, by name. They throw where C returns a failure; counts are numbers. */
  call = {};
  #out;
  #data = new DataView(new ArrayBuffer(0));
  #callbacks = new Map();
  #next = 1;
  #thrown = [];
  #stopped;
  #registry = new FinalizationRegistry(([release, pointer]) => {
    if (!this.#stopped) release(pointer);
  });

  /** An instance of the module; `threads` are used if it can have some. */
  static async open(module, threads) {
    const memory = new Memory();
    const shared = sharedMemory(module);
    const wanted = [];
    const threadOnes = shared && threadImports(module, shared, wanted, () => memory.exports);
    const instance = await WebAssembly.instantiate(module, {
      env: {
        ...threadOnes,
        emscripten_notify_memory_growth() {},
        voxtet_log: (level, text, user) => memory.#callBack(user, level, memory.text(text >>> 0)),
        voxtet_cost: (cellSize, user) => memory.#callBack(user, cellSize) ?? NaN,
      },
      wasi_snapshot_preview1: {
        ...threadOnes,
        clock_time_get: (_clock, _precision, out) => {
          memory.data.setBigUint64(out >>> 0, BigInt(Math.round(performance.now() * 1e6)), true);
          return 0;
        },
        proc_exit(code) {
          throw new Error(`voxtet ended with ${code}`);
        },
      },
    });
    memory.#shared = shared;
    memory.#start(instance.exports);
    if (shared && threads > 1) {
      memory.threads = 1 + memory.exports.voxtet_start_threads(threads - 1);
      endThreads.register(memory, await startAll(module, shared, wanted));
    }
    return memory;
  }

  #start(exports) {
    this.exports = exports;
    if (this.#shared) exports.__wasm_call_ctors();
    else exports._initialize?.();
    const found = exports.vox_abi_version() >>> 0;
    if (found !== ABI_VERSION)
      throw new VoxError(Result.ERROR_UNSUPPORTED, `the module has ABI version ${found}, voxtet was made for ${ABI_VERSION}`);
    for (const [name, [result, parameters]] of Object.entries(functions)) this.call[name] = this.#wrap(name, result, parameters);
    for (const name of ["voxtet_cost_minimise", "voxtet_foreign_grid_tune"]) this.call[name] = this.#wrap(name, "result", []);
    this.#out = exports.malloc(OUT_BYTES) >>> 0;
  }

  #wrap(name, result, parameters) {
    const call = this.exports[name];
    const counts = parameters.flatMap((type, i) => (type === "count" ? [i] : []));
    const unsigned = result === "pointer" || result === "u32";
    return (...given) => {
      if (this.#stopped)
        throw new VoxError(Result.ERROR_INTERNAL, `the module has stopped before, in ${this.#stopped}: load it anew`);
      for (const i of counts) given[i] = BigInt(given[i]);
      const thrown = this.#thrown.length;
      let back;
      try {
        back = call(...given);
      } catch (error) {
        this.#stopped = `${name} (${error})`; // in the middle of something: a trap, or JavaScript's stack was full
        throw error;
      }
      if (this.#thrown.length > thrown) throw this.#thrown.splice(thrown)[0].error;
      if (result === "result" && back !== 0) throw new VoxError(back, this.text(this.exports.vox_last_error() >>> 0));
      return unsigned ? back >>> 0 : back;
    };
  }

  /** What made the module stop, if it has. */
  get stopped() {
    return this.#stopped;
  }

  get buffer() {
    if (!this.#shared) return this.exports.memory.buffer;
    // When another thread has let the memory grow, this one may not know it yet.
    if (this.#shared.buffer.byteLength < PAGE * this.exports.voxtet_memory_pages()) this.#shared.grow(0);
    return this.#shared.buffer;
  }

  /** Memory moves when it grows, unless it is shared. */
  get data() {
    if (this.#data.buffer !== this.buffer) this.#data = new DataView(this.buffer);
    return this.#data;
  }

  text(at) {
    return text(this.data, at, Math.min(4096, this.buffer.byteLength - at));
  }

  /** `count` elements at `at`, as they are now, in an array of JavaScript's. */
  copy(type, at, count) {
    return count === 0 ? new arrayOf[type]() : new arrayOf[type](this.buffer, at, count).slice();
  }

  /** Runs `use` with a Frame that lasts until it returns. */
  frame(use) {
    const frame = new Frame(this);
    try {
      return use(frame);
    } finally {
      frame.release();
    }
  }

  /** Sets a whole struct: what `fields` does not name is as vox_default_X sets it, or 0. */
  fill(at, struct, fields = {}) {
    const { size, defaults, fields: layout } = structs[struct];
    new Uint8Array(this.buffer, at, size).fill(0);
    if (layout.struct_size) this.data.setUint32(at, size, true);
    for (const [name, offset, type, count] of shownFields[struct]) {
      const given = fields[name] ?? defaults[name];
      if (given === undefined) continue;
      if (type in structs) this.fill(at + offset, type, given);
      if (!(type in writers)) continue;
      for (let i = 0; i < count; ++i) writers[type](this.data, at + offset + 8 * i, count > 1 ? given[i] : given);
    }
  }

  /** The struct that `ask` has written where it was told to. */
  get(struct, ask) {
    const { size, fields } = structs[struct];
    new Uint8Array(this.buffer, this.#out, size).fill(0);
    if (fields.struct_size) this.data.setUint32(this.#out, size, true);
    ask(this.#out);
    return readStruct(this.data, this.#out, struct);
  }

  read(struct, at) {
    return readStruct(this.data, at, struct);
  }

  /** The number that `ask` has written where it was told to. */
  number(type, ask) {
    ask(this.#out);
    return readers[type](this.data, this.#out);
  }

  /** A number that stands for a function, for callbacks. */
  addCallback(callback) {
    this.#callbacks.set(this.#next, callback);
    return this.#next++;
  }

  removeCallback(id) {
    this.#callbacks.delete(id);
  }

  /** What a callback throws must not unwind the module; the call from JavaScript throws it when it is done. */
  #callBack(id, ...given) {
    try {
      return this.#callbacks.get(id)?.(...given);
    } catch (error) {
      this.#thrown.push({ error });
      return undefined;
    }
  }

  /** When `object` was collected, `release` gets `pointer`. */
  watch(object, release, pointer) {
    this.#registry.register(object, [release, pointer], object);
  }

  unwatch(object) {
    this.#registry.unregister(object);
  }
}
