// The page as a visitor uses it, beyond what page.test.js looks at. usage: ../check BUILD_FOLDER --full
import assert from "node:assert/strict";
import { execFileSync, spawnSync } from "node:child_process";
import { readFileSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import path from "node:path";
import test from "node:test";
import pngjs from "pngjs";
import { cube, dropAll, dropFile, facts, folder, hashesOf, logged, native, overABody, reads, run, scene, until, visit } from "./visitor.js";

const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");

test("200 frames have the native hash without SIMD, too", async () => {
  const [expected] = hashesOf(native(scene));
  await visit("?scene=empty&stopped&plain", async (page) => {
    await dropAll(page, 1000);
    assert.equal((await run(page, 200)).hash, expected);
  });
});

test("self-collision, a cut and a drag have the native hash, too", async () => {
  const [a, b, c, d] = hashesOf(native([...scene, "configure 1 1 2e5", "cut -20 0.1 1.2  20 8 0  20 -8 0", "steps 60",
    "grab 0 0 9  0 0 0", "drag 0.5 0.5 4", "steps 30", "let-go", "steps 30"]));
  await visit("?scene=empty&stopped", async (page) => {
    await dropAll(page, 1000);
    assert.equal((await run(page, 200)).hash, a);
    await page.check("#self");
    const cut = await page.evaluate(() => playground.ask("cut", { eye: [-20, 0.1, 1.2], first: [20, 8, 0], second: [20, -8, 0] }));
    assert.ok(cut > 0);
    assert.equal((await run(page, 60)).hash, b);
    assert.ok(await page.evaluate(() => playground.ask("grab", { from: [0, 0, 9], to: [0, 0, 0] })));
    await page.evaluate(() => playground.act("drag", { point: [0.5, 0.5, 4] }));
    assert.equal((await run(page, 30)).hash, c);
    await page.evaluate(() => playground.act("letGo"));
    assert.equal((await run(page, 30)).hash, d);
  });
});

test("a body is dragged by the pointer", async () => {
  await visit("?scene=empty&stopped", async (page) => {
    await dropAll(page, 400, [0]);
    await run(page, 200);
    const before = await page.evaluate(() => Math.max(...playground.positions.filter((_, i) => i % 3 === 2)));
    const { x, y } = await overABody(page);
    await page.mouse.move(x, y);
    await page.mouse.down();
    await until(page, () => playground.held?.point);
    await page.mouse.move(x, y - 150, { steps: 5 });
    await run(page, 40);
    const lifted = await page.evaluate(() => Math.max(...playground.positions.filter((_, i) => i % 3 === 2)));
    assert.ok(lifted > before + 0.5, `${before} to ${lifted}`);
    await page.mouse.up();
    await run(page, 200);
    const fallen = await page.evaluate(() => Math.max(...playground.positions.filter((_, i) => i % 3 === 2)));
    assert.ok(fallen < lifted - 0.3, `${lifted} to ${fallen}`);
  });
});

test("a finger drags as well, on a phone's screen, whose page is not wider than it", async () => {
  await visit("?scene=empty&stopped", async (page) => {
    await dropAll(page, 400, [0]);
    await run(page, 200);
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
    const { x, y } = await overABody(page);
    const touch = await page.context().newCDPSession(page);
    await touch.send("Input.dispatchTouchEvent", { type: "touchStart", touchPoints: [{ x, y }] });
    await until(page, () => playground.held?.point);
    await touch.send("Input.dispatchTouchEvent", { type: "touchMove", touchPoints: [{ x, y: y - 60 }] });
    await run(page, 30);
    await touch.send("Input.dispatchTouchEvent", { type: "touchEnd", touchPoints: [] });
    await until(page, () => !playground.held);
  }, { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true, deviceScaleFactor: 2 });
});

test("a stroke cuts, and so does the button", async () => {
  await visit("?scene=empty&stopped", async (page) => {
    await dropAll(page, 1000, [0]);
    await run(page, 150);
    const bodies = () => page.evaluate(() => playground.bodies);
    assert.equal(await bodies(), 2); // and the ring
    const before = await facts(page);
    const { x, y } = await overABody(page);
    await page.check('input[value="cut"]');
    await page.mouse.move(x - 300, y + 15);
    await page.mouse.down();
    await page.mouse.move(x + 300, y + 15, { steps: 3 });
    assert.equal(await page.getAttribute("#stroke", "class"), "drawn");
    assert.ok(await page.evaluate(() => document.querySelector("#stroke line").x2.baseVal.value > 300));
    await page.mouse.up();
    await logged(page, "1 body cut");
    const parts = await bodies();
    assert.ok(parts > 2, `${parts}`);
    // Its parts keep its colour, have cut faces, and do not hold each other: at once, and after seconds.
    const list = await page.evaluate(() => playground.list.slice(1).map(({ origin, uncut, triangles }) => ({ origin, uncut, count: triangles.length / 3 })));
    assert.equal(new Set(list.map((body) => body.origin)).size, 1);
    assert.ok(list.some((body) => body.uncut < body.count && body.uncut > 0));
    assert.equal((await run(page, 1)).facts.pairs, before.pairs);
    for (const steps of [60, 300]) assert.ok((await run(page, steps)).facts.deepest < 0.06, JSON.stringify(await facts(page)));
    await page.click("#halve");
    await until(page, () => document.getElementById("log").textContent.match(/bod(?:y|ies) cut|crosses no body/g)?.length === 2);
  });
});

test("keys do what the pointer does", async () => {
  await visit("?scene=empty&stopped", async (page) => {
    await page.focus("#view");
    await page.keyboard.press("d");
    await until(page, () => playground.bodies === 2);
    await run(page, 200);
    await page.keyboard.press("ArrowLeft");
    await page.keyboard.press("+");
    await page.keyboard.press("g");
    await logged(page, "the middle");
    if (await page.evaluate(() => Boolean(playground.held))) {
      await page.keyboard.press("ArrowUp");
      await page.keyboard.press("Escape");
      await until(page, () => !playground.held);
    }
    await page.keyboard.press("c");
    await until(page, () => /cut|crosses/.test(document.getElementById("log").textContent));
    await page.keyboard.press(" ");
    await until(page, () => document.getElementById("pause").getAttribute("aria-pressed") === "false");
  });
});

test("files of four formats are read as the native library reads them", async () => {
  const write = (name, text) => {
    writeFileSync(path.join(folder, name), text);
    return name;
  };
  const obj = write("solid.obj", cube);
  execFileSync(process.env.VOX_TOOL, ["tetrahedralize", obj, "-o", "solid.msh", "--cell", "0.5"], { cwd: folder });
  write("two.vtk", ["# vtk DataFile Version 3.0", "two", "ASCII", "DATASET UNSTRUCTURED_GRID", "POINTS 5 double",
    "0 0 0", "1 0 0", "0 1 0", "0 0 1", "1 1 1", "CELLS 2 10", "4 0 1 2 3", "4 1 2 3 4", "CELL_TYPES 2", "10", "10", ""].join("\n"));
  const corners = cube.split("\n").filter((line) => line.startsWith("v")).map((line) => line.slice(2));
  const facets = cube.split("\n").filter((line) => line.startsWith("f")).map((line) => line.slice(2).split(" "));
  write("cube.stl", ["solid cube", ...facets.flatMap((f) => ["facet normal 0 0 0", "outer loop", ...f.map((v) => `vertex ${corners[v - 1]}`), "endloop", "endfacet"]), "endsolid cube", ""].join("\n"));
  const names = ["solid.msh", "two.vtk", "cube.stl", obj];
  const [expected] = hashesOf(native([...names.map((name) => `file ${path.join(folder, name)} 1000 1`), "steps 150"]));
  await visit("?scene=empty&stopped", async (page) => {
    await page.setInputFiles("#file", path.join(folder, names[0]));
    await until(page, () => playground.bodies === 2);
    for (const [i, name] of names.slice(1).entries()) {
      await dropFile(page, name, readFileSync(path.join(folder, name), "utf8"));
      await until(page, (n) => playground.bodies === n, i + 3);
    }
    assert.equal((await run(page, 150)).hash, expected);
  });
});

test("a damaged file shows the library's text, and changes nothing", async () => {
  const bad = cube.replace("f 1 4 3", "f 1 4 900");
  writeFileSync(path.join(folder, "bad.obj"), bad);
  const says = spawnSync(process.env.VOX_TOOL, ["info", "bad.obj"], { cwd: folder, encoding: "utf8" });
  assert.notEqual(says.status, 0);
  const expected = says.stderr.trim().split("\n").at(-1).replace(/^(?:vox: )?(?:error: )?/, "");
  await visit("?scene=empty&stopped", async (page) => {
    await dropAll(page, 400, [0]);
    const { hash } = await run(page, 100);
    await dropFile(page, "bad.obj", bad);
    await page.waitForSelector("#banner:not([hidden])");
    const shown = await page.textContent("#banner");
    assert.ok(expected.includes(shown) || shown.includes(expected), `${shown} / ${expected}`);
    for (const name of ["bad.vox", "bad.msh", "bad.stl", "bad.vtk", "bad.bin"]) await dropFile(page, name, "\u0000\u0001 nothing of use");
    await until(page, () => document.querySelectorAll("#log .bad").length === 6);
    assert.equal(await page.evaluate(() => playground.hash), hash);
    assert.equal((await run(page, 1)).facts.steps, 101);
  });
});

test("the end of the memory is said, and the scene goes on", async () => {
  await visit("?scene=empty&stopped&memory=12", async (page) => {
    await dropAll(page, 3000, Array(20).fill(0));
    await page.waitForSelector("#banner:not([hidden])");
    assert.match(await page.textContent("#banner"), /memory|budget|bytes/i);
    const had = await facts(page);
    assert.ok(had.bytes <= 12e6 && had.tets > 3000, JSON.stringify(had));
    await page.click("#clear");
    await dropAll(page, 400, [1]);
    const { facts: now } = await run(page, 100);
    assert.ok(now.steps === had.steps + 100 && now.tets < had.tets, JSON.stringify(now));
  });
});

test("all sizes are measured one by one while bodies move; then it is said how good the choice was", async (t) => {
  await visit("", async (page) => {
    await until(page, () => playground.curve && playground.facts.steps > 100);
    await page.click("#sweep");
    await until(page, () => document.querySelectorAll(".chart-swept").length > 3);
    const { steps } = await facts(page);
    assert.ok(await page.isDisabled("#sweep"));
    await reads(page, "#verdict", /Best of \d+ sizes: [\d.]+\. Chosen without measuring: [\d.]+, .*Worst: [\d.]+, [\d.]+ times as long\./);
    assert.ok((await facts(page)).steps > steps, "the bodies stood still");
    const swept = await page.evaluate(() => playground.swept);
    assert.ok(swept.length >= 9, JSON.stringify(swept));
    t.diagnostic(await page.textContent("#verdict"));
  });
});

test("bodies that come while all sizes are measured end it, and it can begin again", async () => {
  await visit("?stopped", async (page) => {
    await run(page, 100);
    await page.click("#sweep");
    await until(page, () => /Measuring: [1-9]/.test(document.getElementById("sweep").textContent));
    await page.click("#drop");
    await reads(page, "#banner", /Measure again/);
    await until(page, () => !document.getElementById("sweep").disabled);
    assert.equal(await page.locator(".chart-swept").count(), 0);
  });
});

test("a mesh of the page's own is one click away, is named, and stands upright; the camera goes to it", async () => {
  await visit("?scene=empty&stopped", async (page) => {
    await until(page, () => playground.curve);
    const target = () => page.evaluate(() => playground.view.controls.target.toArray());
    const before = await target();
    for (const [i, name] of ["Knot", "Jack", "Gear"].entries()) {
      await page.click(`#samples button:nth-child(${i + 1})`);
      await until(page, (n) => playground.bodies === n, i + 2);
      await reads(page, "#name", new RegExp(`^${name.toLowerCase()}$`));
    }
    assert.ok(await page.isVisible("#name"));
    await run(page, 20);
    assert.notDeepEqual(await target(), before);
    // A bar along y stands with y up, and lies without.
    const bar = cube.replace(/^v (\S+) (\S+) (\S+)$/gm, (_, x, y, z) => `v ${x} ${4 * y} ${z}`);
    const heights = [];
    for (const up of [true, false]) {
      await page.click("#clear");
      await until(page, () => playground.bodies === 1);
      await page.setChecked("#y-up", up);
      await dropFile(page, "bar.obj", bar);
      await until(page, () => playground.bodies === 2);
      heights.push(await page.evaluate(() => {
        const z = playground.positions.slice(-3 * playground.list[1].vertexCount).filter((_, i) => i % 3 === 2);
        return Math.max(...z) - Math.min(...z);
      }));
    }
    assert.ok(heights[0] > 3 * heights[1], `${heights}`);
  });
});

test("stiffer bodies give way less", async () => {
  const [soft, stiff] = ["1e4", "1e6"].map((modulus) =>
    Number(/deepest ([\d.]+), speed/.exec(native([`configure 2 0 ${modulus}`, ...Array(4).fill("drop 0 1000"), "steps 240"]).stdout)[1]));
  assert.notEqual(soft, stiff);
  await visit("?scene=empty&stopped", async (page) => {
    const heights = [];
    for (const place of ["-1.3", "0.7"]) {
      await page.fill("#stiffness", place);
      await page.click("#clear");
      await until(page, () => playground.bodies === 1);
      await dropAll(page, 400, [0]);
      await run(page, 300);
      heights.push(await page.evaluate(() => Math.max(...playground.positions.slice(-3 * playground.list[1].vertexCount).filter((_, i) => i % 3 === 2))));
    }
    assert.ok(heights[0] < heights[1] - 0.1, `${heights}`);
  });
});

test("the log has no touches; the hash is short, and copied whole", async () => {
  await visit("?scene=empty&stopped", async (page, context) => {
    await context.grantPermissions(["clipboard-read", "clipboard-write"]);
    await dropAll(page, 400);
    const { hash } = await run(page, 150);
    assert.doesNotMatch(await page.textContent("#log"), /touches|leaves/);
    await reads(page, "#facts", /\d+touching pairs|touching pairs\d+/);
    await page.click("#inside summary >> nth=0");
    await reads(page, "#hash", new RegExp(`^${hash.slice(0, 8)}…$`));
    await page.click("#copy-hash");
    await reads(page, "#copy-hash", /Copied/);
    assert.equal(await page.evaluate(() => navigator.clipboard.readText()), hash);
  });
});

test("it is as dark as the address or the page around it says", async () => {
  await visit("?scene=empty&stopped&scheme=dark", async (page) => {
    const page_colour = () => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
    const darkest = await page_colour();
    await page.evaluate(() => postMessage({ scheme: "light" }, "*"));
    await until(page, (colour) => getComputedStyle(document.body).backgroundColor !== colour, darkest);
    await page.evaluate(() => postMessage({ scheme: "pink" }, "*"));
    await page.evaluate(() => postMessage({ scheme: "dark" }, "*"));
    await until(page, (colour) => getComputedStyle(document.body).backgroundColor === colour, darkest);
  });
});

test("on a phone there are two tabs below the bodies, and the slider is as wide as the screen", async () => {
  await visit("?stopped", async (page) => {
    await until(page, () => playground.curve);
    const slider = await page.locator("#size").boundingBox();
    assert.ok(slider.width > 0.85 * 390 && slider.y + slider.height < 844, JSON.stringify(slider));
    assert.ok(await page.isHidden("#drop"));
    await page.click("#tab-play");
    assert.ok((await page.isVisible("#drop")) && (await page.isHidden("#size")));
    await page.press("#tab-play", "ArrowLeft");
    assert.ok(await page.isVisible("#size"));
  }, { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true });
});

test("labels of the curve do not touch each other", async () => {
  await visit("?stopped", async (page) => {
    for (const [engine, place] of [[1, "500"], [1, "430"], [1, "900"], [2, "520"]]) {
      await page.check(`input[value="${engine}"]`);
      await until(page, (n) => playground.curve && playground.measured?.engine === n, engine);
      await page.fill("#size", place);
      const touching = await page.evaluate(() => {
        const boxes = [...document.querySelectorAll("#chart text")].map((text) => [text.textContent, text.getBoundingClientRect()]);
        return boxes.flatMap(([a, p], i) => boxes.slice(i + 1).filter(([, q]) => p.left < q.right && q.left < p.right && p.top + 4 < q.bottom && q.top + 4 < p.bottom).map(([b]) => `${a} / ${b}`));
      });
      assert.deepEqual(touching, []);
    }
  });
});

test("a snapshot goes to the native tool and back", async () => {
  await visit("?scene=empty&stopped", async (page) => {
    await dropAll(page, 1000);
    const { facts: saved } = await run(page, 200);
    await page.click("#inside summary >> nth=0");
    const [download] = await Promise.all([page.waitForEvent("download"), page.click("#save")]);
    const file = path.join(folder, download.suggestedFilename());
    await download.saveAs(file);
    const [, hash] = (await page.textContent("#log")).match(/have the hash ([0-9a-f]{16})/);
    const replayed = execFileSync(process.env.VOX_TOOL, ["replay", file], { encoding: "utf8" });
    assert.ok(replayed.includes(hash), replayed);
    const [first, second] = hashesOf(native([`load ${file}`, "steps 50", `save ${file}2`]));
    await page.setInputFiles("#snapshot", file);
    await logged(page, "is shown");
    const { hash: after, facts: restored } = await run(page, 50);
    assert.equal(restored.tets, saved.tets);
    assert.equal(after, first);
    assert.ok(execFileSync(process.env.VOX_TOOL, ["replay", `${file}2`], { encoding: "utf8" }).includes(second));
  });
});

test("bodies come to rest and sleep; what is done to them wakes them", async () => {
  await visit("?scene=empty&stopped", async (page) => {
    await dropAll(page, 400, [1]);
    let { facts: now } = await run(page, 600);
    for (let i = 0; i < 10 && !now.asleep; ++i) ({ facts: now } = await run(page, 300));
    assert.equal(now.asleep, 1);
    const { steps } = now;
    assert.equal((await run(page, 10)).facts.steps, steps);
    await dropAll(page, 400, [0]);
    assert.equal((await run(page, 10)).facts.steps, steps + 10);
  });
});

test("contacts, cells, tiles and windows are drawn where they are asked for", async () => {
  await visit("?scene=empty&stopped", async (page) => {
    await dropAll(page, 1000);
    await run(page, 200);
    const look = async () => pngjs.PNG.sync.read(await page.locator("#view").screenshot());
    await page.click("#inside summary >> nth=0");
    await page.check('input[value="2"]'); // the engine that has tiles and windows
    await page.uncheck("#show-contacts");
    await page.waitForTimeout(300);
    let last = await look();
    for (const id of ["contacts", "cells", "tiles", "windows"]) {
      await page.check(`#show-${id}`);
      await page.waitForTimeout(400);
      const now = await look();
      let differs = 0;
      for (let i = 0; i < now.data.length; i += 4) differs += Math.abs(now.data[i] - last.data[i]) + Math.abs(now.data[i + 1] - last.data[i + 1]) > 30;
      assert.ok(differs > 20, `${id}: ${differs} pixels differ`);
      last = now;
    }
  });
});

for (const [name, options] of [["light", {}], ["dark", { colorScheme: "dark" }], ["a phone", { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true }]])
  test(`axe finds nothing: ${name}`, async () => {
    await visit("?stopped", async (page) => {
      await run(page, 60);
      await until(page, () => playground.curve && playground.measured);
      for (const details of await page.locator("details").all()) await details.evaluate((one) => (one.open = true));
      await page.evaluate(axe); // through the debugger, which no policy holds back
      const { violations } = await page.evaluate(() => globalThis.axe.run());
      assert.deepEqual(violations.map((v) => `${v.id}: ${v.nodes.map((node) => node.target).join(", ")}`), []);
    }, options);
  });

test("who wants less motion gets none until he asks for it", async () => {
  await visit("", async (page) => {
    await until(page, () => playground.bodies > 5);
    await page.waitForTimeout(200);
    const { steps } = await facts(page);
    await page.waitForTimeout(300);
    assert.equal((await facts(page)).steps, steps);
    await page.click("#pause");
    await until(page, (n) => playground.facts.steps > n, steps);
  }, { reducedMotion: "reduce" });
});

test("once loaded, it needs no network", async () => {
  await visit("?stopped", async (page, context) => {
    await context.setOffline(true);
    await dropAll(page, 1000, [2]);
    await dropFile(page, "cube.obj", cube);
    await logged(page, "filled with");
    assert.ok((await run(page, 100)).facts.contacts > 0);
    await page.fill("#size", "300");
    await until(page, () => playground.measured);
  });
});

test("the time of a step with 30,000 tetrahedra is shown, beside the native one", async (t) => {
  const done = native(["configure 1 0 2e5", ...Array(10).fill("drop 0 3000"), "steps 200", "steps 100"]);
  const native200 = Number([...done.stderr.matchAll(/([\d.]+) ms a step/g)][1][1]);
  await visit("?scene=empty&stopped", async (page) => {
    await dropAll(page, 3000, Array(10).fill(0));
    await run(page, 200);
    const { stepMs, facts: found, hash } = await run(page, 100);
    assert.equal(hash, hashesOf(done)[1]);
    await reads(page, "#readout", /[\d.]+ ms/);
    t.diagnostic(`${found.tets} tets: ${stepMs.toFixed(2)} ms a step, native ${native200.toFixed(2)} ms: ${(stepMs / native200).toFixed(2)} times`);
    const drawn = await page.evaluate(() =>
      Array.from({ length: 20 }, () => {
        playground.view.turn(0.02, 0);
        const start = performance.now();
        playground.view.draw();
        return performance.now() - start;
      }).sort((a, b) => a - b)[10],
    );
    t.diagnostic(`a picture takes ${drawn.toFixed(1)} ms of the page's thread`);
    await page.click("#pause");
    await page.waitForTimeout(3000);
    t.diagnostic(`${await page.evaluate(() => playground.framesPerSecond)} pictures a second, drawn by software`);
  });
});
