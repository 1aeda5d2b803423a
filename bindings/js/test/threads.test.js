// The module with threads: it finds what the others find, and a program ends although its threads wait.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { existsSync, readFileSync } from "node:fs";
import test from "node:test";
import { GridFlags, load, threadsSupported } from "../voxtet.js";
import { replay } from "./replay.js";
import { block, stepped } from "./scenes.js";

const skip = !existsSync(new URL("../vox_threads.wasm", import.meta.url)) && "not built";

test("the same results with any number of threads", { skip }, async () => {
  assert.ok(threadsSupported());
  const expected = stepped(await load());
  for (const threads of [2, 3, 7]) {
    const vox = await load({ threads });
    assert.equal(vox.threads, threads);
    assert.deepEqual(stepped(vox), expected);
  }
});

test("steps of a larger scene, whose memory grows while threads work", { skip }, async () => {
  const [one, four] = await Promise.all([load(), load({ threads: 4 })]);
  const hashes = [one, four].map((vox) => {
    const grid = new vox.Grid({ flags: GridFlags.CONSTRAINTS });
    grid.add(block(24));
    const body = grid.add(block(24));
    const found = [];
    for (let i = 0; i < 20; ++i) {
      body.setTransform([1, 0, 0, 0.97 - 0.04 * i, 0, 1, 0, 0.013, 0, 0, 1, 0.017]);
      grid.step();
      found.push([grid.hash, grid.contacts.length, grid.constraints.length]);
    }
    assert.ok(found.at(-1)[1] > 10000);
    grid.dispose();
    return found;
  });
  assert.deepEqual(hashes[1], hashes[0]);
});

test("the vectors", { skip }, async () => {
  const folder = new URL("../../vectors/", import.meta.url);
  const script = JSON.parse(readFileSync(new URL("vectors.json", folder), "utf8"));
  const arrays = new Uint8Array(readFileSync(new URL("vectors.bin", folder)));
  assert.ok(replay(await load({ threads: 3 }), script, arrays, assert) > 300);
});

test("a program ends although its threads wait", { skip }, () => {
  const program = `
    import { load } from ${JSON.stringify(new URL("../voxtet.js", import.meta.url).href)};
    const vox = await load({ threads: 3 });
    new vox.Grid().step();
    console.log(vox.threads);`;
  const { stdout, status } = spawnSync(process.execPath, ["--input-type=module", "-e", program], { encoding: "utf8", timeout: 60000 });
  assert.deepEqual([stdout, status], ["3\n", 0]);
});

test("how many threads", async () => {
  assert.equal((await load()).threads, 1);
  await assert.rejects(load({ threads: 1.5 }), RangeError);
  await assert.rejects(load({ threads: -1 }), RangeError);
  await assert.rejects(load({ threads: "two" }), TypeError);
});
