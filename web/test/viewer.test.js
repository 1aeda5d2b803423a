// The page that `vox collide -o x.html` writes, in Chromium. VOX_TOOL, in the environment, names the tool.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import path from "node:path";
import test from "node:test";
import { pathToFileURL } from "node:url";
import pngjs from "pngjs";
import { cube, launch } from "./browser.js";

test("the page of vox collide draws bodies and contacts, in light and dark, turns, comes nearer, and asks for nothing", async () => {
  const folder = mkdtempSync(path.join(tmpdir(), "viewer-"));
  const [body, result] = ["cube.obj", "result.html"].map((name) => path.join(folder, name));
  writeFileSync(body, cube);
  const found = JSON.parse(execFileSync(process.env.VOX_TOOL, ["collide", body, body, "--fill", "--fill-cell", "0.4", "--offset", "0.3", "0.2", "0.1", "--json", "-o", result]));
  assert.ok(found.contact_count > 0);
  const browser = await launch();
  try {
    for (const colorScheme of ["light", "dark"]) {
      const page = await browser.newPage({ colorScheme, viewport: { width: 600, height: 500 } });
      const complaints = [];
      page.on("console", (message) => /GPU stall|swiftshader/i.test(message.text()) || complaints.push(message.text()));
      page.on("pageerror", (error) => complaints.push(String(error)));
      page.on("request", (request) => request.url().startsWith("file:") || complaints.push(request.url()));
      await page.goto(pathToFileURL(result).href);
      assert.match(await page.textContent("#facts"), new RegExp(`^${found.contact_count} contacts, the deepest [\\d.]+ inside`));
      assert.match(await page.textContent("#deepest"), /deepest: [\d.]+/);
      const seen = async () => {
        await page.waitForTimeout(300);
        return pngjs.PNG.sync.read(await page.locator("#view").screenshot({ style: "#facts, #deepest { visibility: hidden; }" }));
      };
      const colours = (shot) => {
        const sky = [...shot.data.subarray(-4, -1)]; // the last pixel
        const near = (at, colour) => colour.every((value, c) => Math.abs(shot.data[at + c] - value) < 12);
        const places = Array.from({ length: shot.data.length / 4 }, (_, i) => 4 * i);
        return { sky, drawn: places.filter((at) => !near(at, sky)).length, dots: places.filter((at) => near(at, [0xe3, 0x12, 0x2f])).length };
      };
      const first = await seen();
      const { sky, drawn, dots } = colours(first);
      assert.deepEqual(sky, colorScheme === "light" ? [0xdf, 0xe6, 0xed] : [0x16, 0x1b, 0x21]);
      assert.ok(drawn > first.data.length / 4 / 20 && dots > 50, `${drawn} pixels drawn, ${dots} of contacts`);
      await page.mouse.move(300, 300);
      await page.mouse.down();
      await page.mouse.move(380, 320, { steps: 3 });
      await page.mouse.up();
      const turned = await seen();
      assert.notDeepEqual(turned.data, first.data);
      const touch = await page.context().newCDPSession(page);
      for (const [type, x] of [["touchStart", 60], ["touchMove", 70], ["touchMove", 80], ["touchEnd"]]) // two fingers part
        await touch.send("Input.dispatchTouchEvent", { type, touchPoints: x ? [{ x: 300 - x, y: 300, id: 0 }, { x: 300 + x, y: 300, id: 1 }] : [] });
      const near = colours(await seen()).drawn;
      assert.ok(near > 1.3 * colours(turned).drawn, `${near} pixels after ${colours(turned).drawn}`);
      for (const box of (await page.locator("#facts input").all()).slice(0, 2)) await box.uncheck();
      assert.ok(colours(await seen()).drawn < near / 2); // contacts alone
      assert.deepEqual(complaints, []);
      await page.close();
    }
  } finally {
    await browser.close();
    rmSync(folder, { recursive: true });
  }
});
