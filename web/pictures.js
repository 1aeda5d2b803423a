// usage: node pictures.js FOLDER: frames of the page as PNG files, for moving_picture.py, and the measured curve.
import { mkdirSync } from "node:fs";
import path from "node:path";
import { launch, serve } from "./test/browser.js";

const folder = process.argv[2];
mkdirSync(folder, { recursive: true });
const server = await serve();
const browser = await launch();
const page = await browser.newPage({ viewport: { width: 1440, height: 900 } });
async function until(holds) {
  while (!(await page.evaluate(holds))) await page.waitForTimeout(50);
}
await page.goto(`${server.address}?scene=empty&stopped`);
await until(() => globalThis.playground?.ready && playground.curve);
await page.evaluate(() => ["facts", "hint"].forEach((id) => (document.getElementById(id).hidden = true)));
const run = (steps) => page.evaluate((n) => playground.ask("run", { steps: n }), steps);
let frame = 0;
async function shoot(frames, each) {
  for (let i = 0; i < frames; ++i) {
    await run(each);
    await page.waitForTimeout(120);
    await page.locator("#view").screenshot({ path: path.join(folder, `${String(frame++).padStart(3, "0")}.png`) });
  }
}
for (let i = 0; i < 10; ++i) await page.evaluate((kind) => playground.act("drop", { kind, tets: 1000 }), (i + 2) % 5);
await shoot(34, 5);
await page.click("#halve");
await shoot(12, 5);
await page.check("#show-cells");
await page.fill("#size", "620");
await shoot(6, 5);
await page.uncheck("#show-cells");
await page.click("#best");
await run(200);
await page.click("#sweep");
await until(() => playground.swept?.length > 10);
await page.fill("#size", "170");
await page.waitForTimeout(2500);
await page.screenshot({ path: path.join(folder, "cost.png") });
await browser.close();
server.close();
