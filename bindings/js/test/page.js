// What browser.test.js runs in a browser.
import { load, simdSupported } from "../voxtet.js";
import { replay } from "./replay.js";
import { stepped } from "./scenes.js";

function fail(text) {
  throw new Error(text);
}

function same(a, b) {
  if (typeof a !== "object" || typeof b !== "object" || a === null || b === null) return Object.is(a, b);
  const keys = Object.keys(a);
  return keys.length === Object.keys(b).length && keys.every((key) => key in b && same(a[key], b[key]));
}

/** As much of node:assert as replay.js uses. */
const assert = {
  ok: (value, text) => value || fail(text ?? `${value}`),
  equal: (a, b, text) => Object.is(a, b) || fail(`${text}: ${a}, expected ${b}`),
  deepEqual: (a, b, text) => same(a, b) || fail(`${text}: ${JSON.stringify(a)}, expected ${JSON.stringify(b)}`),
  throws(run, expected) {
    let error;
    try {
      run();
    } catch (thrown) {
      error = thrown;
    }
    if (!error) fail("nothing was thrown");
    if (expected.prototype ? !(error instanceof expected) : !expected(error)) throw error;
  },
};

async function run() {
  const asked = new URLSearchParams(location.search);
  const vox = await load({ simd: asked.get("simd") === "1", threads: Number(asked.get("threads") ?? 1) });
  const [script, arrays] = await Promise.all([
    fetch("/vectors/vectors.json").then((response) => response.json()),
    fetch("/vectors/vectors.bin").then((response) => response.arrayBuffer()),
  ]);
  return {
    agent: navigator.userAgent,
    simdSupported: simdSupported(),
    isolated: crossOriginIsolated,
    threads: vox.threads,
    scene: stepped(vox),
    vectors: replay(vox, script, new Uint8Array(arrays), assert),
  };
}

const found = await run().catch((error) => ({ error: `${error.stack}` }));
await fetch("/", { method: "POST", body: JSON.stringify(found) });
