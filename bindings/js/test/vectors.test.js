// Replays bindings/vectors: the same results as in every other language.
import assert from "node:assert/strict";
import { existsSync, readFileSync } from "node:fs";
import test from "node:test";
import { load } from "../voxtet.js";
import { replay } from "./replay.js";

const folder = new URL("../../vectors/", import.meta.url);
const script = JSON.parse(readFileSync(new URL("vectors.json", folder), "utf8"));
const arrays = new Uint8Array(readFileSync(new URL("vectors.bin", folder)));

for (const [name, simd] of [["vox_simd.wasm", true], ["vox.wasm", false]])
  test(`the vectors, by ${name}`, { skip: !existsSync(new URL(`../${name}`, import.meta.url)) && "not built" }, async () => {
    assert.ok(replay(await load({ simd }), script, arrays, assert) > 300);
  });
