// The package as npm makes it: its files, its size, what the modules import, and the programs of its README.
import assert from "node:assert/strict";
import { execFileSync, spawnSync } from "node:child_process";
import { existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import path from "node:path";
import test from "node:test";
import { fileURLToPath } from "node:url";
import { brotliCompressSync, gzipSync } from "node:zlib";
import * as api from "../voxtet.js";
import { block, loaded } from "./scenes.js";

const here = fileURLToPath(new URL("..", import.meta.url));
const flavours = ["vox_simd.wasm", "vox.wasm", "vox_threads.wasm"].filter((name) => existsSync(path.join(here, name)));
const readme = readFileSync(path.join(here, "README.md"), "utf8");
const blocks = (kind) => [...readme.matchAll(new RegExp("```" + kind + "\n([^]*?)```", "g"))].map(([, text]) => text);

const most = { "vox_simd.wasm": 380000, "vox.wasm": 405000, "vox_threads.wasm": 385000 };
for (const name of flavours)
  test(`${name}: size, imports and exports`, async (t) => {
    const bytes = readFileSync(path.join(here, name));
    const size = brotliCompressSync(bytes).length; // as servers send it
    t.diagnostic(`${bytes.length} bytes, by brotli ${size}, by gzip ${gzipSync(bytes, { level: 9 }).length}`);
    assert.ok(size <= most[name], `${size} bytes compressed`);
    const module = await WebAssembly.compile(bytes);
    if (name !== "vox_threads.wasm") assert.deepEqual(WebAssembly.Module.imports(module).map((i) => `${i.module}.${i.name}`).sort(), [
      "env.emscripten_notify_memory_growth",
      "env.voxtet_cost",
      "env.voxtet_log",
      "wasi_snapshot_preview1.clock_time_get",
      "wasi_snapshot_preview1.proc_exit",
    ]);
    // Highway 1.0.3 has loops in their place: then a step takes twice as long.
    const lookups = bytes.reduce((sum, byte, i) => sum + Number(byte === 0xfd && bytes[i + 1] === 0x0e), 0); // i8x16.swizzle
    if (name !== "vox.wasm") assert.ok(lookups > 50, `${lookups} lookups of bytes in registers`);
    const exported = new Set(WebAssembly.Module.exports(module).map((e) => e.name));
    for (const wanted of readFileSync(path.join(here, "exports.txt"), "utf8").trim().split("\n")) assert.ok(exported.has(wanted), wanted);
  });

const npm = spawnSync("npm", ["--version"]).status === 0;
test("installed from what npm packs, the README's program prints what it says", { skip: !npm && "there is no npm" }, () => {
  const folder = mkdtempSync(path.join(tmpdir(), "voxtet-"));
  try {
    const run = (command, ...given) => execFileSync(command, given, { cwd: folder, encoding: "utf8", stdio: ["ignore", "pipe", "inherit"] });
    const [packed] = JSON.parse(run("npm", "pack", "--json", "--silent", here));
    const expected = ["LICENSE", "README.md", "enums.d.ts", "enums.js", "layout.js", "package.json", "structs.d.ts", "voxtet.d.ts",
      "voxtet.js", ...["cell_size", "check", "errors", "foreign", "grid", "locator", "memory", "mesh_arrays", "owned", "records", "shapes", "thread", "thread_imports", "threads"].map((n) => `lib/${n}.js`)];
    assert.deepEqual(packed.files.map((file) => file.path).sort(), [...expected, ...flavours].sort());
    const installed = path.join(folder, "node_modules", "voxtet");
    mkdirSync(installed, { recursive: true });
    run("tar", "-xzf", packed.filename, "--strip-components=1", "-C", installed);
    writeFileSync(path.join(folder, "program.mjs"), blocks("js")[0]);
    assert.equal(run(process.execPath, "program.mjs"), blocks("text")[0]);
    const version = readFileSync(path.join(here, "../../include/vox/vox.h"), "utf8").match(/VOX_VERSION_(?:MAJOR|MINOR|PATCH) (\d+)/g);
    assert.equal(packed.version, version.map((line) => line.match(/\d+$/)[0]).join("."));
  } finally {
    rmSync(folder, { recursive: true });
  }
});

/** The block with these words, as a program of its own. */
function programOf(words) {
  return blocks("js").find((text) => text.includes(words)).replace('from "voxtet"', `from ${JSON.stringify(new URL("../voxtet.js", import.meta.url).href)}`);
}

test("the README's shapes", async () => {
  const { grid } = await import(`data:text/javascript,${encodeURIComponent(`${programOf("HALF_SPACE")}; export { grid };`)}`);
  assert.deepEqual(grid.bodies.map(({ userData }) => userData), [7n, 0n, 0n]);
});

test("the README's Worker", async () => {
  const program = programOf("onmessage =");
  const posted = [];
  globalThis.postMessage = (data, transferred) => posted.push([data, transferred]);
  const url = `data:text/javascript,${encodeURIComponent(program.replace("onmessage =", "globalThis.onmessage ="))}`;
  await import(url);
  globalThis.onmessage({ data: block(1) });
  globalThis.onmessage({ data: { positions: block(1, [1, 0, 0]).positions } });
  assert.equal(posted.length, 2);
  assert.ok(posted[0][0] instanceof Uint32Array && posted[0][1][0] === posted[0][0].buffer);
});

test("every name in the types is there, and the reverse", async () => {
  const types = readFileSync(path.join(here, "voxtet.d.ts"), "utf8");
  const members = (name) => {
    const body = types.match(new RegExp(`export interface ${name}\\b[^{]*{([^]*?)\n}`))[1].replace(/\/\*\*[^]*?\*\//g, "");
    return new Set([...body.matchAll(/^ {2}(?:readonly |get |set )?(\w+)[(:?]/gm)].map((m) => m[1]).filter((n) => n !== "new"));
  };
  const own = (object) => Object.getOwnPropertyNames(object).filter((name) => name !== "constructor");
  const vox = await loaded();
  const grid = new vox.Grid();
  const mesh = grid.add(block(1));
  const proto = Object.getPrototypeOf;
  const gridClass = proto(proto(grid));
  assert.deepEqual(new Set(own(gridClass)), members("Grid"));
  assert.deepEqual(new Set(own(proto(gridClass)).filter((n) => n !== "Symbol(Symbol.dispose)")), members("Owned"));
  assert.deepEqual(new Set(own(proto(mesh))), members("Body"));
  assert.deepEqual(new Set(own(proto(grid.locator()))), members("Locator"));
  assert.deepEqual(new Set(own(vox)), members("Vox"));
  for (const name of [...types.matchAll(/export declare (?:function|class) (\w+)/g)].map((m) => m[1])) assert.ok(name in api, name);
});
