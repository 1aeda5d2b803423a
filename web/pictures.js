// usage: node pictures.js FOLDER: frames of the page as PNG files, for moving_picture.py, and the measured curve.
import { mkdirSync } from "node:fs";
import path from "node:path";
import { launch, serve } from "./test/browser.js";

const folder = process.argv[2];
mkdirSync(folder, { recursive: true });
const server = await serve();
const browser = await launch();
const page = await browser.newPage({ viewport: { width: 1180, height: 760 } });
async function until(holds) {
  while (!(await page.evaluate(holds))) await page.waitForTimeout(50);
}
await page.goto(`${server.address}?scene=empty&stopped`);
await until(() => globalThis.playground?.ready);
const run = (steps) => page.evaluate((n) => playground.ask("run", { steps: n }), steps);
let frame = 0;
async function shoot(frames, each) {
  for (let i = 0; i < frames; ++i) {
    await run(each);
    await page.waitForTimeout(120);
    await page.locator("#view").screenshot({ path: path.join(folder, `${String(frame++).padStart(3, "0")}.png`) });
  }
}
for (let i = 0; i < 10; ++i) await page.evaluate((kind) => playground.act("drop", { kind, tets: 1000 }), i % 5);
await shoot(34, 5);
await page.click("#halve");
await shoot(12, 5);
await page.check("#show-cells");
await until(() => playground.curves);
await shoot(6, 5);
await page.uncheck("#show-cells");
await run(200);
await page.click("#sweep");
await until(() => playground.points?.length > 10);
await page.fill("#size", "330");
await page.waitForTimeout(1500);
await page.locator("#cost").screenshot({ path: path.join(folder, "cost.png") });
await browser.close();
server.close();
