// Ten thousand grids, with and without dispose(): the module's memory stays as large as some of them need.
import assert from "node:assert/strict";
import test from "node:test";
import { setImmediate } from "node:timers/promises";
import { setFlagsFromString } from "node:v8";
import { runInNewContext } from "node:vm";
import { block, loaded } from "./scenes.js";

setFlagsFromString("--expose-gc");
const gc = runInNewContext("gc");

const ROUNDS = 10000;
const mesh = block(1);
const moved = block(1, [0.7, 0.31, 0.17]);

function live(vox, log) {
  const grid = new vox.Grid(log && { log });
  grid.add(mesh);
  grid.add(moved);
  grid.step();
  grid.bodies[0].bindPreviousPositions(moved.positions);
  grid.findConstraints();
  assert.ok(grid.constraints.length > 0);
  const locator = grid.locator();
  locator.update(grid);
  locator.dispose();
  return grid;
}

test("grids that are disposed", async () => {
  const vox = await loaded();
  for (let i = 0; i < 100; ++i) live(vox).dispose();
  const bytes = vox.memoryBytes;
  for (let i = 0; i < ROUNDS; ++i) live(vox).dispose();
  assert.equal(vox.memoryBytes, bytes);
});

test("grids that are forgotten", async () => {
  const vox = await loaded();
  let bytes;
  for (let i = 0; i < ROUNDS; ++i) {
    const grid = live(vox, () => assert.ok(grid)); // a log that holds on to its grid
    grid.locator().update(grid);
    if (i % 100 !== 99) continue;
    gc();
    await setImmediate(); // collected objects are looked after between tasks
    if (i === ROUNDS / 10 - 1) bytes = vox.memoryBytes;
  }
  assert.ok(bytes > 0);
  assert.ok(vox.memoryBytes <= 1.5 * bytes, `${vox.memoryBytes} bytes after ${ROUNDS} grids, ${bytes} after a tenth of them`);
});

test("calls that fail", async () => {
  const vox = await loaded();
  const grid = new vox.Grid();
  const wrong = { positions: new Float32Array(30000), tets: new Uint32Array(40000).fill(10000) };
  for (let i = 0; i < 10; ++i) assert.throws(() => grid.add(wrong));
  const bytes = vox.memoryBytes;
  for (let i = 0; i < 1000; ++i) assert.throws(() => grid.add(wrong));
  assert.equal(vox.memoryBytes, bytes);
});
