// What a Worker of threads.js runs: one thread of a module's pool. It gets the module and its memory, says that it is ready,
// and never returns.
import { sharedImports } from "./thread_imports.js";

async function run(pool, { module, memory, pointer, argument }) {
  const imports = sharedImports(module, memory);
  const { exports } = await WebAssembly.instantiate(module, { env: imports, wasi_snapshot_preview1: imports });
  exports.__stack_pointer.value = new Uint32Array(memory.buffer, argument, 1)[0]; // before any other call
  exports._emscripten_thread_init(pointer, 0, 0, 1, 0);
  exports.emscripten_tls_init();
  pool.postMessage("ready");
  try {
    exports.voxtet_run_thread(argument);
  } finally {
    exports.voxtet_thread_failed();
  }
}

if (typeof WorkerGlobalScope === "function") {
  onmessage = ({ data }) => run(globalThis, data);
} else {
  const threads = "node:worker_threads"; // not for bundlers
  const { parentPort } = await import(/* webpackIgnore: true */ /* @vite-ignore */ threads);
  parentPort.once("message", (data) => run(parentPort, data));
}
