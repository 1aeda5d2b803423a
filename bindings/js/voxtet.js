// voxtet: vox in WebAssembly. See README.md; types and their comments are in voxtet.d.ts.
import { MAX_WORKERS } from "./enums.js";
import { cellSizes } from "./lib/cell_size.js";
import { integer } from "./lib/check.js";
import { VoxError } from "./lib/errors.js";
import { Grid, snapshotBytes, stepGrids } from "./lib/grid.js";
import { Memory } from "./lib/memory.js";
import { polyline } from "./lib/shapes.js";
import { coreCount, threadsSupported } from "./lib/threads.js";

export * from "./enums.js";
export { polyline, threadsSupported, VoxError };

// A module of one function that returns a vector: valid where WebAssembly has SIMD.
const SIMD_PROBE = [0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 10, 1, 8, 0, 65, 0, 253, 15, 253, 98, 11];

const compiled = {};

/** The module in a file of this package: read where files can be, else fetched. */
async function compileFile(url) {
  if (url.protocol !== "file:") return compileResponse(await fetch(url));
  const files = "node:fs/promises"; // not for bundlers
  const { readFile } = await import(/* webpackIgnore: true */ /* @vite-ignore */ files);
  return WebAssembly.compile(await readFile(url));
}

async function compileResponse(response) {
  if (!response.ok) throw new Error(`${response.url}: ${response.status} ${response.statusText}`);
  const isWasm = response.headers.get("content-type")?.startsWith("application/wasm");
  return isWasm ? WebAssembly.compileStreaming(response) : WebAssembly.compile(await response.arrayBuffer());
}

async function compile(source, simd, threads) {
  if (source instanceof WebAssembly.Module) return source;
  if (source instanceof URL || typeof source === "string") return compileFile(new URL(source, import.meta.url));
  if (source !== undefined) return typeof source.arrayBuffer === "function" ? compileResponse(source) : WebAssembly.compile(source);
  // Each address as bundlers look for it.
  const url = threads
    ? new URL("./vox_threads.wasm", import.meta.url)
    : simd
      ? new URL("./vox_simd.wasm", import.meta.url)
      : new URL("./vox.wasm", import.meta.url);
  const module = (compiled[url] ??= compileFile(url));
  module.catch(() => delete compiled[url]); // so that it can be tried again
  return module;
}

export function simdSupported() {
  return WebAssembly.validate(new Uint8Array(SIMD_PROBE));
}

export async function load({ simd = simdSupported(), threads = 1, wasm } = {}) {
  const asked = threads === "all" ? await coreCount() : integer(threads, "threads", "u32");
  const wanted = threadsSupported() ? Math.max(1, Math.min(asked, MAX_WORKERS)) : 1;
  const module = await compile(await wasm, simd, simd && wanted > 1);
  const memory = await Memory.open(module, wanted);
  const { call } = memory;
  return Object.defineProperties(
    {
      Grid: boundGrid(memory),
      stepGrids: (grids) => stepGrids(memory, grids),
      version: memory.text(call.vox_build_info()).match(/[\d.]+/)[0],
      buildInfo: memory.text(call.vox_build_info()),
      module,
      threads: memory.threads,
    },
    {
      ...Object.getOwnPropertyDescriptors(cellSizes(memory)),
      memoryBytes: { get: () => memory.buffer.byteLength, enumerable: true },
    },
  );
}

/** The class of the grids of one module. */
function boundGrid(memory) {
  const Unbound = Grid;
  return {
    Grid: class extends Unbound {
      constructor(settings, snapshot) {
        super(memory, settings, snapshot === undefined ? undefined : snapshotBytes(snapshot, memory));
      }

      static load(bytes, settings) {
        return new this(settings, snapshotBytes(bytes, memory));
      }
    },
  }.Grid;
}
