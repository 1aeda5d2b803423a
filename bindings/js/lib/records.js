// Arrays of structs, copied out of the module's memory once: nothing that the library does later changes them.
import { structs } from "../layout.js";
import { fieldsOf, readStruct } from "./memory.js";

const columnOf = {
  u8: [Uint8Array, 1],
  i32: [Int32Array, 4],
  u32: [Uint32Array, 4],
  f32: [Float32Array, 4],
  f64: [Float64Array, 8],
  u64: [BigUint64Array, 8],
  count: [Float64Array, 8],
};

class Records {
  #struct;
  #size;
  #columns = {};
  /** The copy: records one after the other, as C has them. */
  bytes;
  length;

  constructor(struct, bytes) {
    this.#struct = struct;
    this.#size = structs[struct].size;
    this.bytes = bytes;
    this.length = bytes.length / this.#size;
  }

  /** Record `index` as an object; one below 0 counts from the end. Without such a record: undefined. */
  at(index) {
    const i = Math.trunc(index) || 0;
    const place = i < 0 ? i + this.length : i;
    if (place < 0 || place >= this.length) return undefined;
    const { buffer, byteOffset } = this.bytes;
    return readStruct(new DataView(buffer, byteOffset + place * this.#size, this.#size), 0, this.#struct);
  }

  *[Symbol.iterator]() {
    for (let i = 0; i < this.length; ++i) yield this.at(i);
  }

  /** The records from `begin` to before `end`, as of an array, in the same memory. */
  slice(begin = 0, end = this.length) {
    const place = (index) => {
      const i = Math.trunc(index) || 0;
      return Math.max(0, Math.min(i < 0 ? i + this.length : i, this.length));
    };
    return new this.constructor(this.#struct, this.bytes.subarray(place(begin) * this.#size, place(end) * this.#size));
  }

  column(offset, type, count) {
    return (this.#columns[offset] ??= this.#gather(offset, type, count));
  }

  #gather(offset, type, count) {
    const [Column, size] = columnOf[type];
    const Source = type === "count" ? BigUint64Array : Column;
    const { buffer, byteOffset, byteLength } = this.bytes;
    const from = new Source(buffer, byteOffset, byteLength / size);
    const to = new Column(this.length * count);
    const step = this.#size / size;
    const first = offset / size;
    for (let i = 0, n = 0; i < this.length; ++i)
      for (let k = 0; k < count; ++k, ++n) {
        const found = from[first + i * step + k];
        to[n] = type === "count" ? Number(found) : found;
      }
    return to;
  }
}

const classes = {};

/** The class of records of a struct: with a getter for each of its columns. */
function classOf(struct) {
  if (classes[struct]) return classes[struct];
  const Class = class extends Records {};
  for (const [name, offset, type, count] of fieldsOf(struct))
    Object.defineProperty(Class.prototype, name, {
      get() {
        return this.column(offset, type, count);
      },
      enumerable: true,
    });
  return (classes[struct] = Class);
}

/** A copy of `count` records at `at`. */
export function records(memory, struct, at, count) {
  return new (classOf(struct))(struct, memory.copy("u8", at, count * structs[struct].size));
}
