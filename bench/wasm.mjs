// A step in WebAssembly beside one of the native library, by stage: the same scenes, by turns, least times of many steps.
//   node bench/wasm.mjs NATIVE_PROGRAM [--level portable|sse4|avx2|avx512] [--rounds N] [--module FILE]...
// NATIVE_PROGRAM: the target bench_wasm_native; modules: those of bindings/js, and others to compare with them.
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import path from "node:path";
import { parseArgs } from "node:util";
import { load } from "../bindings/js/voxtet.js";
import { block } from "../bindings/js/test/scenes.js";

const { positionals: [native], values: { level, rounds, module: modules } } = parseArgs({
  allowPositionals: true,
  options: {
    level: { type: "string", default: "avx2" },
    rounds: { type: "string", default: "5" },
    module: { type: "string", multiple: true, default: [] },
  },
});
const flavours = {};
for (const simd of [true, false]) await load({ simd }).then((vox) => (flavours[simd ? "wasm SIMD" : "wasm"] = vox), () => {});
for (const file of modules) flavours[path.basename(file)] = await load({ wasm: readFileSync(file) });

// Two blocks of 5 n^3 tetrahedra, one of which moves to and fro; how far they overlap.
const scenes = [["2k tets", 6, 0.9], ["40k tets, light", 16, 0.97], ["40k tets, deep", 16, 0.6], ["200k tets", 27, 0.97]];
const STAGES = ["stream", "broad_phase", "windows", "lookup", "decide", "contacts", "depth", "constraints", "pairs"];
const STEPS = 60;

class Times {
  step = Infinity;
  stages = STAGES.map(() => Infinity);
  add(ms, ns) {
    this.step = Math.min(this.step, ms);
    this.stages = this.stages.map((least, k) => Math.min(least, ns[k]));
  }
}

function scene(vox, arrays, offset) {
  const grid = new vox.Grid({ flags: vox.GridFlags.CONSTRAINTS });
  grid.add(arrays);
  const body = grid.add(arrays);
  const times = new Times();
  const step = (i) => {
    body.setTransform([1, 0, 0, offset + 0.001 * (i % 2), 0, 1, 0, 0.013, 0, 0, 1, 0.017]);
    const began = performance.now();
    grid.step();
    const ms = performance.now() - began;
    const { profile } = grid;
    times.add(ms, STAGES.map((stage) => profile[`${stage.replace(/_(.)/, (_, c) => c.toUpperCase())}Ns`]));
  };
  return { grid, step, times };
}

const folder = mkdtempSync(path.join(tmpdir(), "vox-wasm-"));
for (const [name, n, offset] of scenes) {
  const arrays = block(n);
  const file = path.join(folder, "scene");
  writeFileSync(file, Buffer.concat([Buffer.from(new Uint32Array([arrays.positions.length / 3, arrays.tets.length / 4]).buffer),
    Buffer.from(arrays.positions.buffer), Buffer.from(arrays.tets.buffer)]));
  const grids = Object.entries(flavours).map(([flavour, vox]) => [flavour, scene(vox, arrays, offset)]);
  const reference = new Times();
  let hash;
  for (let round = 0; round < Number(rounds); ++round) {
    const [ms, nativeHash, ...ns] = execFileSync(native, [file, offset, STEPS, level].map(String), { encoding: "utf8" }).trim().split(" ");
    reference.add(Number(ms), ns.map(Number));
    for (const [flavour, { grid, step }] of grids) {
      for (let i = 0; i < STEPS; ++i) step(i);
      hash = grid.hash.toString(16).padStart(16, "0");
      if (hash !== nativeHash) throw new Error(`${name}: ${flavour} has the hash ${hash}, the native library ${nativeHash}`);
    }
  }
  console.log(`${name}: ${grids[0][1].grid.contacts.length} contacts, hash ${hash}; microseconds`);
  const row = (who, { step, stages }) => {
    const ratio = who === level ? "" : (step / reference.step).toFixed(2);
    const parts = stages.map((time, k) => `${STAGES[k]} ${(time / 1e3).toFixed(0)}${who === level ? "" : ` (${(time / reference.stages[k]).toFixed(1)})`}`);
    console.log(`  ${who.padEnd(12)} ${(1e3 * step).toFixed(0).padStart(6)} ${ratio.padStart(5)}   ${parts.join(", ")}`);
  };
  row(level, reference);
  for (const [flavour, { grid, times }] of grids) {
    row(flavour, times);
    grid.dispose();
  }
}
rmSync(folder, { recursive: true });
