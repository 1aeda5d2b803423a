// A step in WebAssembly beside one of the native library: the same scenes, by turns, least times of many steps.
//   node bench/wasm.mjs NATIVE_PROGRAM [ROUNDS]        NATIVE_PROGRAM: bench/wasm_native.c, linked to libvox (bench/README.md)
import { execFileSync } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import path from "node:path";
import { load } from "../bindings/js/voxtet.js";
import { block } from "../bindings/js/test/scenes.js";

const [native, rounds = "5"] = process.argv.slice(2);
const flavours = { "wasm SIMD": await load({ simd: true }) };
await load({ simd: false }).then((vox) => (flavours.wasm = vox), () => {});

// Two blocks of 5 n^3 tetrahedra, one of which moves to and fro; how far they overlap.
const scenes = [["2k tets", 6, 0.9], ["40k tets, light", 16, 0.97], ["40k tets, deep", 16, 0.6], ["200k tets", 27, 0.97]];
const STEPS = 60;

function scene(vox, arrays, offset) {
  const grid = new vox.Grid();
  grid.add(arrays);
  const body = grid.add(arrays);
  const step = (i) => {
    body.setTransform([1, 0, 0, offset + 0.001 * (i % 2), 0, 1, 0, 0.013, 0, 0, 1, 0.017]);
    const began = performance.now();
    grid.step();
    return performance.now() - began;
  };
  return { grid, step };
}

const folder = mkdtempSync(path.join(tmpdir(), "vox-wasm-"));
for (const [name, n, offset] of scenes) {
  const arrays = block(n);
  const file = path.join(folder, "scene");
  writeFileSync(file, Buffer.concat([Buffer.from(new Uint32Array([arrays.positions.length / 3, arrays.tets.length / 4]).buffer),
    Buffer.from(arrays.positions.buffer), Buffer.from(arrays.tets.buffer)]));
  const grids = Object.entries(flavours).map(([flavour, vox]) => [flavour, scene(vox, arrays, offset)]);
  const least = { native: Infinity };
  let hash;
  for (let round = 0; round < Number(rounds); ++round) {
    const [ms, nativeHash] = execFileSync(native, [file, String(offset), String(STEPS)], { encoding: "utf8" }).trim().split(" ");
    least.native = Math.min(least.native, Number(ms));
    for (const [flavour, { grid, step }] of grids) {
      for (let i = 0; i < STEPS; ++i) least[flavour] = Math.min(least[flavour] ?? Infinity, step(i));
      hash = grid.hash.toString(16).padStart(16, "0");
      if (hash !== nativeHash) throw new Error(`${name}: ${flavour} has the hash ${hash}, the native library ${nativeHash}`);
    }
  }
  const times = Object.entries(least).map(([who, ms]) => `${who} ${ms.toFixed(3)} ms` + (who === "native" ? "" : ` (${(ms / least.native).toFixed(2)})`));
  console.log(`${name}: ${times.join(", ")}; ${grids[0][1].grid.contacts.length} contacts, hash ${hash}`);
  for (const [, { grid }] of grids) grid.dispose();
}
rmSync(folder, { recursive: true });
