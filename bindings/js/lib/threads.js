// Threads of a module: Workers over the memory that all of them share.
import { sharedImports } from "./thread_imports.js";

const PAGE = 65536;
const inNode = typeof process === "object" && typeof process.versions?.node === "string";

/** Whether memory can be shared with Workers: a page must be cross-origin isolated for it. */
export function threadsSupported() {
  return typeof SharedArrayBuffer === "function" && (inNode || (typeof Worker === "function" && globalThis.crossOriginIsolated === true));
}

export async function coreCount() {
  if (globalThis.navigator?.hardwareConcurrency) return navigator.hardwareConcurrency;
  if (!inNode) return 1;
  const os = "node:os"; // not for bundlers
  return (await import(/* webpackIgnore: true */ /* @vite-ignore */ os)).cpus().length;
}

export function sharedMemory(module) {
  const { length: imported } = WebAssembly.Module.imports(module).filter(({ kind }) => kind === "memory");
  return imported === 0 ? undefined : new WebAssembly.Memory({ initial: 256, maximum: PAGE, shared: true });
}

/** The imports of a module with threads, beside those of any module. Threads that it wants are added to `wanted`. */
export function threadImports(module, memory, wanted, exports) {
  const mayWait = typeof window === "undefined"; // the thread of a page must not
  return {
    ...sharedImports(module, memory),
    __emscripten_init_main_thread_js: (pointer) => exports()._emscripten_thread_init(pointer, 1, 1, Number(mayWait), 0),
    __pthread_create_js(pointer, _attributes, _routine, argument) {
      wanted.push({ pointer, argument });
      return 0;
    },
  };
}

async function makeWorker() {
  if (!inNode) return new Worker(new URL("./thread.js", import.meta.url), { type: "module" });
  const threads = "node:worker_threads"; // not for bundlers
  const { Worker: NodeWorker } = await import(/* webpackIgnore: true */ /* @vite-ignore */ threads);
  return new NodeWorker(new URL("./thread.js", import.meta.url), { execArgv: [] }); // not those of `node -e`
}

/** Resolves when the thread waits for tasks. */
async function start(module, memory, { pointer, argument }) {
  const worker = await makeWorker();
  try {
    await new Promise((resolve, reject) => {
      const fail = (error) => reject(error instanceof Error ? error : new Error(`a Worker has not started: ${error.message ?? error}`));
      if (inNode) worker.once("message", resolve).once("error", fail);
      else Object.assign(worker, { onmessage: resolve, onerror: fail });
      worker.postMessage({ module, memory, pointer, argument });
    });
  } catch (error) {
    worker.terminate();
    throw error;
  }
  worker.unref?.(); // a program ends although its threads do not
  return worker;
}

/** Workers for all of `wanted`; none, if one of them fails. */
export async function startAll(module, memory, wanted) {
  const started = await Promise.allSettled(wanted.map((thread) => start(module, memory, thread)));
  const workers = started.filter(({ status }) => status === "fulfilled").map(({ value }) => value);
  const failed = started.find(({ status }) => status === "rejected");
  if (failed) {
    for (const worker of workers) worker.terminate();
    throw failed.reason;
  }
  return workers;
}
