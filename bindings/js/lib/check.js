// What a program gives, as plain numbers and arrays. WebAssembly itself takes anything and makes a number of it.
import { structs } from "../layout.js";

const ranges = { u8: [0, 255], i32: [-(2 ** 31), 2 ** 31 - 1], u32: [0, 2 ** 32 - 1], count: [0, Number.MAX_SAFE_INTEGER] };

export function shown(value) {
  if (typeof value === "string") return JSON.stringify(value.slice(0, 40));
  if (typeof value === "bigint") return `${value}n`;
  if (typeof value === "symbol" || typeof value === "function") return `a ${typeof value}`;
  if (typeof value !== "object" || value === null) return String(value);
  return `${Object.prototype.toString.call(value).slice(8, -1)}`;
}

function wrong(what, expected, value) {
  return new TypeError(`${what}: expected ${expected}, got ${shown(value)}`);
}

export function camel(name) {
  return name.replace(/_(.)/g, (_, letter) => letter.toUpperCase());
}

export function float(value, what) {
  if (typeof value !== "number") throw wrong(what, "a number", value);
  return value;
}

export function integer(value, what, type) {
  if (typeof value !== "number") throw wrong(what, "a whole number", value);
  const [least, most] = ranges[type];
  if (!Number.isInteger(value) || value < least || value > most)
    throw new RangeError(`${what}: expected a whole number from ${least} to ${most}, got ${value}`);
  return value;
}

/** true and false, or a number for the library to judge. */
export function flag(value, what) {
  return typeof value === "boolean" ? Number(value) : integer(value, what, "u32");
}

/** 64 bits: a bigint, or a number that is exact. */
export function bits(value, what) {
  if (typeof value === "number") return BigInt(integer(value, what, "count"));
  if (typeof value !== "bigint") throw wrong(what, "a bigint", value);
  if (value < 0n || value >= 1n << 64n) throw new RangeError(`${what}: expected 0n to 2n ** 64n - 1n, got ${value}n`);
  return value;
}

/** `count` numbers. */
export function floats(value, what, count) {
  if (typeof value !== "object" || value === null) throw wrong(what, `an array of ${count} numbers`, value);
  if (value.length !== count) throw new RangeError(`${what}: expected ${count} numbers, got ${shown(value.length)}`);
  const numbers = new Float64Array(count);
  for (let i = 0; i < count; ++i) numbers[i] = float(value[i], `${what}[${i}]`);
  return numbers;
}

const arrayTypes = { Float32Array, Float64Array, Uint32Array };
const integerArrays = ["Uint8Array", "Uint16Array", "Int8Array", "Int16Array", "Int32Array"];

function kindOf(value) {
  return ArrayBuffer.isView(value) ? Object.prototype.toString.call(value).slice(8, -1) : "";
}

/** The array without what a class of the caller's adds to it, and apart from the module's memory, which may move while
 * arguments are copied into it. */
function plain(array, Type, width, what, memory) {
  const numbers = new Type(array.buffer, array.byteOffset, array.length);
  if (numbers.length % width !== 0)
    throw new RangeError(`${what}: ${numbers.length} numbers, which is not a multiple of ${width}`);
  return numbers.buffer === memory.buffer ? numbers.slice() : numbers;
}

/** x y z, x y z, ... of singles or doubles. */
export function positions(value, what, memory) {
  const kind = kindOf(value);
  if (kind !== "Float32Array" && kind !== "Float64Array") throw wrong(what, "a Float32Array or Float64Array", value);
  return plain(value, arrayTypes[kind], 3, what, memory);
}

/** Groups of `width` indices: a Uint32Array as it is; numbers of other arrays are looked at one by one. */
export function indices(value, what, width, memory) {
  if (kindOf(value) === "Uint32Array") return plain(value, Uint32Array, width, what, memory);
  if (!Array.isArray(value) && !integerArrays.includes(kindOf(value))) throw wrong(what, "a Uint32Array", value);
  const numbers = new Uint32Array(value.length);
  for (let i = 0; i < numbers.length; ++i) numbers[i] = integer(value[i], `${what}[${i}]`, "u32");
  return plain(numbers, Uint32Array, width, what, memory);
}

/** Bytes of an ArrayBuffer or of any view of one. */
export function bytes(value, what, memory) {
  if (Object.prototype.toString.call(value) === "[object ArrayBuffer]") return new Uint8Array(value);
  if (!ArrayBuffer.isView(value)) throw wrong(what, "an ArrayBuffer or a view of one", value);
  const all = new Uint8Array(value.buffer, value.byteOffset, value.byteLength);
  return all.buffer === memory.buffer ? all.slice() : all;
}

/** A copy of an array, of which nothing is looked at yet. */
export function list(value, what, item) {
  if (!Array.isArray(value)) throw wrong(what, `an array of ${item}`, value);
  return Array.from(value);
}

export function callback(value, what) {
  if (typeof value !== "function") throw wrong(what, "a function", value);
  return value;
}

/** The id of a body, given as such or as a Body; null is none. */
export function bodyId(value, what) {
  if (value === null) return 0;
  return integer(typeof value === "object" ? value.id : value, what, "u32");
}

/** An object whose keys are all among `known`, so that a misspelt option is not lost. No object: no options. */
export function options(value, what, known) {
  if (value === undefined) return {};
  if (typeof value !== "object" || value === null) throw wrong(what, "an object", value);
  const found = {};
  for (const key of Object.keys(value)) {
    if (!known.includes(key)) throw new TypeError(`${what}: "${key}" is not known; there are ${known.join(", ")}`);
    const given = value[key];
    if (given !== undefined) found[key] = given;
  }
  return found;
}

function field(value, what, type, count) {
  if (count > 1) return floats(value, what, count);
  if (type === "f64") return float(value, what);
  if (type === "u64") return bits(value, what);
  if (typeof value === "boolean") return Number(value);
  return integer(typeof value === "object" && value !== null ? value.id : value, what, type);
}

/** Fields of a struct by their names in JavaScript, checked, from an object with some of them. */
export function fields(value, what, struct, known) {
  const found = options(value, what, known);
  for (const [name, [, type, count]] of Object.entries(structs[struct].fields)) {
    const key = camel(name);
    if (key in found && known.includes(key) && type in sizes) found[key] = field(found[key], `${what}.${key}`, type, count);
  }
  return found;
}

const sizes = { i32: 4, u32: 4, u64: 8, count: 8, f64: 8 };
