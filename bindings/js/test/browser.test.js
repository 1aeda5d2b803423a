// The package in a browser: pages that Chromium, without a window, gets over HTTP. They send what they found (page.js).
import assert from "node:assert/strict";
import { spawn, spawnSync } from "node:child_process";
import { createReadStream, existsSync, mkdtempSync, rmSync } from "node:fs";
import { createServer } from "node:http";
import { tmpdir } from "node:os";
import path from "node:path";
import test from "node:test";
import { fileURLToPath } from "node:url";
import { stepped } from "./scenes.js";
import { load } from "../voxtet.js";

const root = fileURLToPath(new URL("../..", import.meta.url)); // bindings/
const browser = ["chromium", "chromium-browser", "google-chrome"].find((name) => spawnSync(name, ["--version"]).status === 0);
const skip = !browser && "SKIPPED: there is no chromium: the package is not tested in a browser";
if (skip) console.log(skip);

const types = { ".js": "text/javascript", ".json": "application/json", ".wasm": "application/wasm" };
const page = `<!doctype html><meta charset="utf-8"><title>voxtet</title><script type="module" src="/js/test/page.js"></script>`;

/** What page.js sends, from a page that is cross-origin isolated or not, whose address ends with `search`. */
async function open(search, isolated) {
  let found;
  const sent = new Promise((resolve) => (found = resolve));
  const server = createServer((request, response) => {
    const { pathname } = new URL(request.url, "http://localhost");
    if (isolated) {
      response.setHeader("Cross-Origin-Opener-Policy", "same-origin");
      response.setHeader("Cross-Origin-Embedder-Policy", "require-corp");
    }
    if (request.method === "POST") {
      const parts = [];
      request.on("data", (part) => parts.push(part));
      request.on("end", () => {
        response.end();
        found(JSON.parse(Buffer.concat(parts).toString()));
      });
      return;
    }
    const file = path.join(root, pathname);
    if (pathname === "/") response.setHeader("Content-Type", "text/html").end(page);
    else if (!existsSync(file)) response.writeHead(404).end();
    else createReadStream(file).pipe(response.setHeader("Content-Type", types[path.extname(file)] ?? "application/octet-stream"));
  });
  await new Promise((ready) => server.listen(0, "localhost", ready));
  const profile = mkdtempSync(path.join(tmpdir(), "voxtet-browser-"));
  const started = spawn(browser, ["--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--no-first-run",
    `--user-data-dir=${profile}`, `http://localhost:${server.address().port}/${search}`], { stdio: "ignore", detached: true });
  const ended = new Promise((resolve) => started.on("exit", resolve));
  let timer;
  try {
    const late = new Promise((_, reject) => (timer = setTimeout(() => reject(new Error("the page has sent nothing in two minutes")), 120000)));
    const early = ended.then((code) => {
      throw new Error(`${browser} has ended with ${code}`);
    });
    return await Promise.race([sent, late, early]);
  } finally {
    clearTimeout(timer);
    try {
      process.kill(-started.pid, "SIGKILL"); // and the processes that it has started
    } catch {
      // it has ended
    }
    await ended;
    server.closeAllConnections?.();
    server.close();
    rmSync(profile, { recursive: true, force: true, maxRetries: 10 });
  }
}

for (const [name, simd] of [["vox_simd.wasm", true], ["vox.wasm", false]]) {
  const missing = !existsSync(path.join(root, "js", name)) && "not built";
  test(`${name} in a browser: a scene and the vectors`, { skip: skip || missing }, async (t) => {
    const found = await open(`?simd=${Number(simd)}`, false);
    assert.equal(found.error, undefined);
    t.diagnostic(found.agent);
    assert.equal(found.simdSupported, true);
    assert.equal(found.isolated, false);
    const here = stepped(await load({ simd }));
    assert.deepEqual(found.scene, here);
    assert.ok(found.vectors > 300);
  });
}

for (const isolated of [true, false]) {
  const missing = !existsSync(path.join(root, "js", "vox_threads.wasm")) && "not built";
  const name = isolated ? "threads in a page that is cross-origin isolated" : "elsewhere, one thread although three were asked for";
  test(name, { skip: skip || missing }, async () => {
    const found = await open("?simd=1&threads=3", isolated);
    assert.equal(found.error, undefined);
    assert.deepEqual([found.isolated, found.threads], [isolated, isolated ? 3 : 1]);
    assert.deepEqual(found.scene, stepped(await load()));
    assert.ok(found.vectors > 300);
  });
}
