// The page in short, for every run of the tests: it loads, steps as the native scene does, is drawn, reads a file, measures a
// cell size. full.test.js has the rest. usage: ../check BUILD_FOLDER
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import path from "node:path";
import test from "node:test";
import pngjs from "pngjs";
import { cube, dropAll, dropFile, facts, folder, hashesOf, logged, native, reads, run, scene, until, visit } from "./visitor.js";

test("200 frames have the native hash, and the picture is the one on record, with tolerance", async (t) => {
  const [expected] = hashesOf(native(scene));
  await visit("?scene=empty&stopped", async (page) => {
    await dropAll(page, 1000);
    const { hash, facts: found } = await run(page, 200);
    assert.equal(hash, expected);
    assert.ok(found.contacts > 0 && found.tets > 5000, JSON.stringify(found));
    await page.evaluate(() => ["readout", "facts", "hint", "loading"].forEach((id) => (document.getElementById(id).hidden = true)));
    await page.waitForTimeout(500);
    const shot = pngjs.PNG.sync.read(await page.locator("#view").screenshot());
    // Means of blocks of 20 by 20 pixels, so that no edge of a triangle counts.
    const blocks = [];
    for (let y = 40; y + 20 <= shot.height; y += 20)
      for (let x = 0; x + 20 <= shot.width; x += 20) {
        let sum = 0;
        for (let j = 0; j < 20; ++j) for (let i = 0; i < 20; ++i) for (let c = 0; c < 3; ++c) sum += shot.data[4 * ((y + j) * shot.width + x + i) + c];
        blocks.push(Math.round(sum / 1200));
      }
    const file = new URL("picture.json", import.meta.url);
    if (process.env.PLAYGROUND_RENEW) writeFileSync(file, `${JSON.stringify({ width: shot.width, height: shot.height, blocks })}\n`);
    const record = JSON.parse(readFileSync(file, "utf8"));
    assert.deepEqual([shot.width, shot.height], [record.width, record.height]);
    const far = blocks.filter((value, i) => Math.abs(value - record.blocks[i]) > 24).length;
    t.diagnostic(`${far} of ${blocks.length} blocks differ`);
    assert.ok(far <= blocks.length / 50, `${far} of ${blocks.length} blocks differ`);
  });
});

test("frames follow each other by themselves, stop, and go on", async () => {
  await visit("", async (page) => {
    await until(page, () => playground.facts.steps > 30);
    await page.click("#pause");
    await page.waitForTimeout(300);
    const { steps } = await facts(page);
    await page.waitForTimeout(300);
    assert.equal((await facts(page)).steps, steps);
    await page.click("#pause");
    await until(page, (n) => playground.facts.steps > n, steps);
  });
});

test("a sphere and a blade are dragged through the bodies, which are pushed as natively; the blade shows the edges that it crosses", async () => {
  const drags = ["hold 1 0 -3 1 1 0", "hold 1 0 0 0.8 1 0", "hold 2 0 -3 1 1 1", "hold 2 0 0 1 1 1", "hold 0 0 0 0 1 0"];
  const hashes = hashesOf(native([...scene, ...drags.flatMap((drag) => [drag, "steps 40"])]));
  await visit("?scene=empty&stopped", async (page) => {
    await dropAll(page, 1000);
    await run(page, 200);
    for (const [i, drag] of drags.entries()) {
      const [tool, x, y, z, ...along] = drag.split(" ").slice(1).map(Number);
      await page.evaluate((held) => playground.act("hold", held), { tool, point: [x, y, z], along });
      assert.equal((await run(page, 40)).hash, hashes[i + 1], drag);
    }
    for (const name of ["sphere", "blade"]) { // the same by the pointer
      await page.check(`input[value="${name}"]`);
      await page.waitForTimeout(100);
      const above = (await run(page, 1)).facts;
      assert.ok(above.toolZ > 2 && above.touched === 0, JSON.stringify(above));
      const [left, top] = await page.evaluate(() => playground.view.centre);
      await page.mouse.move(left, top - 200);
      await page.mouse.down();
      await page.mouse.move(left, top, { steps: 5 });
      await page.mouse.up();
      const { facts: found } = await run(page, 60);
      assert.ok(found.touched > 0 && Math.abs(found.toolZ - 0.9) < 0.1, JSON.stringify(found));
      assert.equal((await page.evaluate(() => playground.touched.length)) > 0, name === "blade");
      await reads(page, "#facts", /on the tool/);
    }
    await page.check('input[value="drag"]');
    await run(page, 1);
    assert.equal((await facts(page)).touched, 0);
  });
});

test("a file is dropped on the page: a surface is filled and falls", async () => {
  await visit("?scene=empty&stopped", async (page) => {
    await dropFile(page, "cube.obj", cube);
    await logged(page, "filled with");
    const file = path.join(folder, "cube.obj");
    writeFileSync(file, cube);
    const [expected] = hashesOf(native([`file ${file} 1000 1`, "steps 100"]));
    assert.equal((await run(page, 100)).hash, expected);
    await page.setInputFiles("#file", file); // by the button
    await until(page, () => playground.bodies === 3);
  });
});

test("the slider drives the scene: its cell size, the time that is shown, and the same contacts at every size and by both engines", async () => {
  const [expected] = hashesOf(native(scene));
  await visit("?scene=empty&stopped", async (page) => {
    await dropAll(page, 1000);
    await until(page, () => playground.curve && playground.measured);
    assert.ok(await page.isHidden("#loading"));
    await reads(page, "#step-factor", /^the best$/);
    for (const mark of [/mean edge \+\d+ %/, /median box \(IPC\) \+\d+ %/, /chosen by vox: you are here/]) await reads(page, "#chart", mark);
    const best = await page.evaluate(() => playground.size);
    await page.fill("#size", "200");
    await run(page, 60);
    const { cellSize } = await facts(page);
    assert.ok(cellSize < best / 2, `${cellSize} of ${best}`);
    assert.equal(cellSize, await page.evaluate(() => playground.size));
    await reads(page, "#step-factor", /^[\d.]+ × the best$/);
    await reads(page, "#chart", /you (?:\+\d+ %|[\d.]+ ×)/);
    await page.fill("#size", "800");
    await run(page, 60);
    assert.ok((await facts(page)).cellSize > 2 * best);
    await page.check('input[value="2"]');
    await until(page, () => playground.curve && playground.measured.engine === 2);
    await page.click("#best");
    assert.equal((await run(page, 80)).hash, expected);
    await page.click("summary >> nth=0");
    assert.ok((await page.locator("#terms tbody tr").count()) >= 5);
  });
});
