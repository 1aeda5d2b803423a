import fs from "node:fs";
globalThis.fetch = async (a) => ({ ok: true, arrayBuffer: async () => fs.readFileSync(a) });
const { Scene } = await import("./page/scene.js");
const s = await Scene.load("../build/web/playground_simd.wasm", 1e9);
for (const k of [0,1,2,3,4]) for (const n of [400, 1000, 3000]) { const t0 = Date.now(); try { s.drop(k, n); console.log(k, n, "ok", s.facts().tets, Date.now()-t0); } catch (e) { console.log(k, n, e.message, Date.now()-t0); } }
