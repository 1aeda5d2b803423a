/** What each thread of a module imports. Most of what Emscripten's C library names is never called. */
export function sharedImports(module, memory) {
  const refused = WebAssembly.Module.imports(module).map(({ name }) => [
    name,
    () => {
      throw new Error(`voxtet cannot call ${name}`);
    },
  ]);
  return { ...Object.fromEntries(refused), memory, voxtet_now: () => performance.now() };
}
