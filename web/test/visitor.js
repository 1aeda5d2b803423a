// A visitor of the page in a real browser, beside the same scene run natively: what the tests share.
// PLAYGROUND_NATIVE and VOX_TOOL, in the environment, name the two programs.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import path from "node:path";
import { after, before } from "node:test";
import { launch, serve } from "./browser.js";

export { cube } from "./browser.js";

/** For files of these tests; goes with them. */
export const folder = mkdtempSync(path.join(tmpdir(), "playground-"));
let server;
let browser;

before(async () => {
  server = await serve();
  browser = await launch();
});
after(async () => {
  await browser?.close();
  server?.close();
  rmSync(folder, { recursive: true, force: true });
});

/** Waits until a function is true in the page. Playwright's own way needs a page that allows eval(). */
export async function until(page, holds, argument = null) {
  for (const end = Date.now() + 120000; !(await page.evaluate(holds, argument)); await page.waitForTimeout(50))
    if (Date.now() > end) assert.fail(`in vain: ${holds} (${JSON.stringify(argument)}); the page: ${await page.textContent("body")}`);
}

/** Runs `use` on a page of its own. Whatever it logs as an error, or asks of another server, fails the test. */
export async function visit(search, use, options = {}) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 900 }, ...options });
  await context.addInitScript({ content: "addEventListener('securitypolicyviolation', (e) => console.error('policy: ' + e.violatedDirective + ' ' + e.blockedURI));" });
  const faults = [];
  context.on("request", (request) => {
    if (!request.url().startsWith(server.address) && !/^(?:data|blob):/.test(request.url())) faults.push(`asks for ${request.url()}`);
  });
  const page = await context.newPage();
  page.on("console", (message) => ["error", "warning"].includes(message.type()) && !/GPU stall|swiftshader/i.test(message.text()) && faults.push(message.text()));
  page.on("pageerror", (error) => faults.push(String(error)));
  try {
    await page.goto(server.address + search);
    await until(page, () => globalThis.playground?.ready && playground.facts);
    await use(page, context);
    assert.deepEqual(faults, []);
  } finally {
    await context.close();
  }
}

export const run = (page, steps) => page.evaluate((n) => playground.ask("run", { steps: n }), steps);
export const dropAll = (page, tets, kinds = [0, 1, 2, 3, 4]) =>
  page.evaluate(([list, n]) => list.forEach((kind) => playground.act("drop", { kind, tets: n })), [kinds, tets]);
export const facts = (page) => page.evaluate(() => playground.facts);
export const logged = (page, words) => until(page, (w) => document.getElementById("log").textContent.includes(w), words);

/** Waits until what is written somewhere matches. */
export const reads = (page, selector, words) =>
  until(page, ([where, pattern]) => new RegExp(pattern).test(document.querySelector(where).textContent), [selector, words.source]);

/** What the native scene prints for these commands. */
export function native(commands) {
  const done = spawnSync(process.env.PLAYGROUND_NATIVE, { input: `${commands.join("\n")}\n`, encoding: "utf8" });
  assert.equal(done.status, 0, done.stderr);
  return done;
}
export const hashesOf = ({ stdout }) => [...stdout.matchAll(/hash ([0-9a-f]{16})/g)].map((match) => match[1]);

/** A point of the view where a body is that can be dragged. */
export const overABody = (page) =>
  page.evaluate(() => {
    const box = document.getElementById("view").getBoundingClientRect();
    for (let row = 1; row < 40; ++row)
      for (let column = 1; column < 40; ++column) {
        const [x, y] = [box.left + (box.width * column) / 40, box.top + (box.height * row) / 40];
        // Of a body's middle rather than its rim.
        if ([[0, 0], [6, 0], [-6, 0], [0, 6], [0, -6]].every(([a, b]) => playground.view.hits(playground.view.ray(x + a, y + b)))) return { x, y };
      }
    return null;
  });

/** One body of each kind, and 200 frames. */
export const scene = [...[0, 1, 2, 3, 4].map((kind) => `drop ${kind} 1000`), "steps 200"];

export const dropFile = (page, name, text) =>
  page.evaluate(([n, t]) => {
    const data = new DataTransfer();
    data.items.add(new File([t], n));
    document.dispatchEvent(new DragEvent("drop", { dataTransfer: data, bubbles: true, cancelable: true }));
  }, [name, text]);
