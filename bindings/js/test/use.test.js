import assert from "node:assert/strict";
import { once } from "node:events";
import test from "node:test";
import { Worker } from "node:worker_threads";
import { CellSizeWarnings, ConstraintKind, COST_WEIGHT_CAPACITY, CURVE_CAPACITY, DepthMethod, DepthState, GridFlags, KnownGrid, LocationState, LogLevel, NONE, PairState,
  PrimitiveType, QueryFlags, ReferenceFlags, Result, Side, VoxError } from "../voxtet.js";
import { block, loaded } from "./scenes.js";

const vox = await loaded();
const failure = (code) => (error) => error instanceof VoxError && error.code === code;

function touching(options) {
  const grid = new vox.Grid(options);
  const left = grid.add(block(4));
  const right = grid.add({ ...block(4, [0.7, 0.31, 0.17]), userData: 2n ** 63n });
  grid.step();
  return { grid, left, right };
}

test("results are columns and records of one copy", () => {
  const { grid, left, right } = touching();
  const contacts = grid.contacts;
  assert.ok(contacts.length > 20);
  const all = [...contacts];
  assert.equal(all.length, contacts.length);
  all.forEach((contact, i) => {
    assert.deepEqual(contact, contacts.at(i));
    for (const key of ["bodyA", "vertex", "bodyB", "tet"]) assert.equal(contact[key], contacts[key][i]);
  });
  assert.equal(contacts.vertex, contacts.vertex, "a column is made once");
  assert.deepEqual(contacts.at(-1), all.at(-1));
  assert.equal(contacts.at(all.length), undefined);
  assert.equal(contacts.at(-all.length - 1), undefined);
  assert.deepEqual([...contacts.slice(3, 7)], all.slice(3, 7));
  assert.deepEqual([...contacts.slice(3, 7).vertex], all.slice(3, 7).map((c) => c.vertex));
  assert.equal(contacts.slice(5, 2).length, 0);
  assert.deepEqual([...contacts.slice(-2)], all.slice(-2));

  const before = contacts.bytes.slice();
  right.positions = block(4, [9, 9, 9]).positions;
  grid.step();
  assert.equal(grid.contacts.length, 0);
  grid.clear();
  grid.dispose();
  assert.deepEqual(contacts.bytes, before);
  assert.equal(contacts.bodyA[0], left.id);
});

test("columns of 64 bits", () => {
  const { grid, right } = touching();
  assert.deepEqual([...grid.pairs.userDataB], [2n ** 63n]);
  assert.equal(right.userData, 2n ** 63n);
  const { pairs } = grid;
  assert.deepEqual([[...pairs.firstContact], [...pairs.contactCount]], [[0], [grid.contacts.length]]);
  assert.deepEqual([...pairs.contacts].sort((a, b) => a - b), [...grid.contacts.vertex.keys()]);
  grid.dispose();
});

test("positions survive the growth of the memory when they are taken anew", () => {
  const { grid, left } = touching();
  const held = left.positions;
  const hash = grid.hash;
  const values = [...held];
  const grids = [];
  while (held.length !== 0) {
    assert.ok(grids.length < 400, "the memory did not grow");
    grids.push(new vox.Grid());
    grids.at(-1).add(block(24));
  }
  assert.deepEqual([...left.positions], values);
  grid.step();
  assert.equal(grid.hash, hash);
  left.positions[3 * grid.contacts.vertex[0]] += 9;
  grid.step();
  assert.notEqual(grid.hash, hash);
  // Arrays in the module's memory may be given to it, although it may grow before they are copied.
  for (let i = 0; i < 100; ++i) {
    const copy = grid.add({ positions: left.positions, tets: left.tets });
    assert.equal(copy.info.vertexCount, 125);
    assert.deepEqual(copy.positions, left.positions);
  }
  for (const each of [grid, ...grids]) each.dispose();
});

test("positions of doubles, and of meshes without vertices", () => {
  const grid = new vox.Grid();
  const mesh = grid.add(block(2, [0, 0, 0], Float64Array));
  assert.ok(mesh.positions instanceof Float64Array);
  assert.throws(() => (mesh.positions = new Float32Array(81)), TypeError);
  assert.throws(() => (mesh.positions = new Float64Array(3)), RangeError);
  mesh.positions = mesh.positions;
  const empty = grid.add({ positions: new Float32Array() });
  assert.equal(empty.positions.length, 0);
  assert.equal(empty.tets.length, 0);
  grid.add({ positions: new Float32Array([0.5, 0.5, 0.5]) });
  grid.step();
  assert.equal(grid.counters.bodies_without_tets, 1);
  grid.dispose();
});

test("the log, and what it throws", () => {
  const lines = [];
  let grid;
  const log = (level, text) => {
    lines.push([level, text]);
    if (lines.length === 2) throw new RangeError("of the log");
    assert.throws(() => grid.step(), failure(Result.ERROR_INVALID_STATE));
    assert.throws(() => grid.dispose(), failure(Result.ERROR_INVALID_STATE));
  };
  grid = new vox.Grid({ flags: GridFlags.SKIP_BAD_BODIES, log });
  const points = grid.add({ positions: new Float32Array(3) });
  assert.equal(lines.length, 1, "points have no edges, which is a warning");
  assert.equal(lines[0][0], LogLevel.WARNING);
  points.positions[0] = NaN;
  const { epoch } = grid;
  assert.throws(() => grid.step(), /of the log/);
  assert.notEqual(grid.epoch, epoch, "the call had done its work");
  grid.step();
  grid.dispose();

  const other = new vox.Grid();
  const asking = new vox.Grid({ log: () => other.add(block(1)) });
  asking.add({ positions: new Float32Array(3) });
  assert.equal(other.bodies.length, 1, "a log may use other grids");

  // But not those that are stepped together with its own.
  const refused = [];
  const together = [0, 1, 2].map((i) => {
    const each = new vox.Grid({ flags: GridFlags.SKIP_BAD_BODIES, log: (_, text) => {
      for (const use of [() => together[2].dispose(), () => together[i].step(), () => together[0].hash])
        assert.throws(use, failure(Result.ERROR_INVALID_STATE));
      refused.push(text);
    } });
    each.add({ positions: new Float32Array(12).fill(NaN), tets: [0, 1, 2, 3] });
    return each;
  });
  vox.stepGrids(together);
  assert.equal(refused.length, 3);
  for (const each of together) {
    assert.equal(each.epoch, 1);
    each.dispose();
  }
});

/** The gap that a constraint has at these positions, by what it says itself. */
function gapOf({ offset, normal, vertices, weights, count, countA }, a, b) {
  let gap = offset;
  for (let i = 0; i < count; ++i) {
    const x = (i < countA ? a : b).positions.subarray(3 * vertices[i], 3 * vertices[i] + 3);
    gap += weights[i] * normal.reduce((sum, n, axis) => sum + n * x[axis], 0);
  }
  return gap;
}

test("constraints of all kinds", () => {
  const { grid, left, right } = touching({ flags: GridFlags.CONSTRAINTS | GridFlags.EDGES, margin: 0.125 });
  const meshes = { [left.id]: left, [right.id]: right };
  assert.equal(grid.margin, 0.125);
  const all = [...grid.constraints];
  assert.deepEqual(new Set(all.map((c) => c.kind)), new Set([ConstraintKind.INSIDE, ConstraintKind.EDGE, ConstraintKind.PROXIMITY]));
  for (const c of all) {
    assert.ok(Math.abs(gapOf(c, meshes[c.bodyA], meshes[c.bodyB]) - c.gap) < 1e-6);
    assert.ok(c.kind === ConstraintKind.PROXIMITY ? c.gap >= 0 && c.gap <= 0.125 : c.gap <= 0);
    assert.deepEqual(new Set([c.userDataA, c.userDataB]), new Set([0n, 2n ** 63n]));
    assert.deepEqual([c.pair, c.previous, c.time], [0, NONE, 1]);
  }
  assert.deepEqual(grid.constraints.pairOffsets, [0, all.length]);
  grid.step();
  assert.deepEqual([...grid.constraints.previous], [...all.keys()]);

  // Those that are asked for.
  grid.flags = 0;
  grid.margin = 0;
  grid.step();
  assert.throws(() => grid.constraints, failure(Result.ERROR_INVALID_STATE));
  grid.findConstraints({ method: DepthMethod.CLOSEST, bodyA: right, bodyB: left.id });
  const inside = new Set([...grid.contacts].map((c) => `${c.bodyA} ${c.vertex}`));
  assert.equal(grid.constraints.length, inside.size);
  assert.ok(grid.constraints.countA.every((count) => count === 1) && grid.constraints.count.every((count) => count === 4));
  grid.findConstraints({ method: DepthMethod.CLOSEST, closestBudget: 1 });
  assert.ok(grid.constraints.state.filter((state) => state === DepthState.UNKNOWN).length > 1);
  grid.findConstraints({ mask: 2n });
  assert.deepEqual([grid.constraints.length, grid.constraints.pairOffsets], [0, [0, 0]]);
  grid.dispose();
  const empty = new vox.Grid({ flags: GridFlags.CONSTRAINTS });
  empty.step();
  assert.deepEqual(empty.constraints.pairOffsets, [0]);
  empty.dispose();
});

test("previous positions: vertices that went through a body within a step", () => {
  const grid = new vox.Grid({ flags: GridFlags.CONSTRAINTS });
  const wall = grid.add(block(2));
  const points = grid.add({ positions: new Float32Array([0.3, 0.4, -2]) });
  const impacts = () => [...grid.constraints].filter((c) => c.kind === ConstraintKind.IMPACT);
  points.bindPreviousPositions(new Float32Array([0.3, 0.4, 2]));
  touching().grid.dispose(); // whose arrays take any memory that is free
  grid.step();
  const [impact] = impacts();
  assert.deepEqual([impact.bodyA, impact.bodyB, impact.count, impact.normal], [points.id, wall.id, 4, [0, 0, 1]]);
  assert.ok(Math.abs(impact.time - 0.25) < 1e-9 && Math.abs(impact.gap + 3) < 1e-6);
  assert.deepEqual([...grid.pairs.state], [PairState.BEGAN]);
  points.bindPreviousPositions(points.positions); // copied
  grid.step();
  assert.deepEqual([impacts(), [...grid.pairs.state]], [[], [PairState.ENDED]]);
  points.bindPreviousPositions(new Float64Array([0.3, 0.4, 2]));
  grid.step();
  assert.equal(impacts().length, 1);
  assert.throws(() => points.bindPreviousPositions(new Float32Array(6)), failure(Result.ERROR_INVALID_ARGUMENT));
  grid.step();
  assert.equal(impacts().length, 1);
  points.bindPreviousPositions(null);
  grid.step();
  assert.equal(impacts().length, 0);
  grid.dispose();
});

test("pairs: what began, persisted, ended and is near", () => {
  const { grid, right } = touching({ margin: 0.2 });
  const found = [[...grid.pairs.state]];
  for (const x of [0.7, 1.1, 1.1, 9]) {
    right.positions = block(4, [x, 0.31, 0.17]).positions;
    grid.step();
    found.push([...grid.pairs.state]);
  }
  assert.deepEqual(found, [[PairState.BEGAN], [PairState.PERSISTED], [PairState.ENDED], [PairState.NEAR], []]);
  assert.deepEqual([grid.info.totalBegan, grid.info.totalEnded], [1, 1]);
  grid.dispose();
});

test("locators", () => {
  const { grid, left, right } = touching();
  const locator = grid.locator();
  assert.equal(locator.epoch, 1);
  const middle = new Float64Array([0.85, 0.6, 0.6]);
  const [from, to] = [[-1, 0.6, 0.61, -1, 9, 0], [3, 0.6, 0.61, 3, 9, 0]].map((numbers) => new Float32Array(numbers));
  grid.clear();
  grid.dispose();
  assert.deepEqual([...new Set(locator.findPointHits(middle).body)], [left.id, right.id]);
  assert.deepEqual([...locator.findClosest(middle, { maxDistance: 0.001 }).body], [0]);
  const far = locator.findClosest(new Float32Array([9, 9, 9, ...middle]), { maxDistance: 1, excluded: right });
  assert.deepEqual([...far.body], [0, left.id]);
  const places = locator.locate(new Float32Array([9, 9, 9, ...middle]), { maxDistance: 1 });
  assert.deepEqual([...places.state], [LocationState.NONE, LocationState.INSIDE]);
  assert.equal(places.at(1).body, left.id);
  const beyond = [0, QueryFlags.EXTRAPOLATE].map((flags) => locator.locate(from.subarray(0, 3), { flags }).at(0));
  assert.ok(beyond[0].weights.every((w) => w >= 0) && beyond[1].weights.some((w) => w < 0));
  const pieces = locator.findTracks(from, to, { excluded: right.id });
  assert.ok(pieces.length > 2 && pieces.tIn.every((t, i) => i === 0 || t === pieces.tOut[i - 1]));
  const axes = locator.findClosestToSegments(from, to);
  assert.ok(axes.distance[0] === 0 && axes.distance[1] > 0);
  const [tip, end] = [[...from.subarray(0, 3)], [...to.subarray(0, 3)]];
  const blade = new Float32Array([...tip, ...end, ...end]);
  assert.ok(locator.findTriangleHits(blade).length > 2);
  const cut = locator.findTriangleHits(new Float32Array([...tip, ...tip, ...tip]), blade);
  assert.ok(cut.length > 2 && cut.t.every((t) => t > 0));
  const hits = locator.findRayHits(from, to, { excluded: right.id });
  assert.deepEqual([[...hits.ray], [...hits.side]], [[0, 0], [Side.ENTERS, Side.LEAVES]]);
  assert.equal(locator.findRayHits(from, to, { flags: QueryFlags.FIRST_HIT }).length, 1);
  assert.deepEqual([...locator.testRays(from, to)], [1, 0]);
  assert.deepEqual([...locator.testRays(from, to, { mask: 2n })], [0, 0]);
  const box = [new Float32Array([-9, -9, -9]), new Float32Array([9, 9, 9])];
  assert.equal(locator.findBoxHits(...box).length, 640, "more than there is room for at first");
  assert.equal(locator.findPointHits(new Float32Array()).length + locator.testRays(new Float32Array(), new Float32Array()).length, 0);
  assert.equal(locator.userData(right), 2n ** 63n);
  locator.update(touching().grid);
  assert.equal(locator.findBoxHits(...box).length, 640);
  locator.dispose();
  assert.throws(() => locator.epoch, failure(Result.ERROR_INVALID_STATE));
});

test("edits, and meshes by name", () => {
  const { grid, left, right } = touching();
  const first = left.appendVertices({ copiesOf: [0, 1] });
  assert.equal(first, 125);
  assert.equal(left.appendVertices({ positions: new Float32Array([4, 4, 4]) }), 127);
  assert.deepEqual([...left.positions.subarray(381)], [4, 4, 4]);
  assert.equal(left.appendTets([0, 1, 2, 127]), 320);
  left.setTetsEnabled([0, 1], false);
  left.removeTets(new Uint16Array([2]));
  assert.equal(left.info.enabledTetCount, 318);
  assert.deepEqual([...left.enabledTets.subarray(0, 4)], [0, 0, 0, 1]);
  left.removeVertices([126]);
  left.setTopology(block(2));
  assert.deepEqual(left.tets, block(2).tets);
  left.setTransform([1, 0, 0, 0.5, 0, 1, 0, 0, 0, 0, 1, 0]);
  assert.equal(left.info.transform[3], 0.5);
  left.setTransform(null);
  left.filter = { ...left.filter, group: -3 };
  right.filter = { group: -3 };
  grid.step();
  assert.equal(grid.contacts.length, 0);
  left.filter = {};
  assert.equal(left.filter.group, 0);
  grid.setPairEnabled(left, right, false);
  left.enabled = false;
  assert.equal(left.enabled, false);
  right.markMoved();
  right.remove();
  assert.equal(right.valid, false);
  assert.throws(() => right.info, failure(Result.ERROR_INVALID_HANDLE));
  assert.deepEqual(grid.bodies.map((mesh) => mesh.id), [left.id]);
  grid.dispose();
});

test("settings, failures and measurements", () => {
  const { grid, left } = touching({
    reference: { flags: ReferenceFlags.DENSE, worldMin: [-1, -1, -1], worldMax: new Float64Array([9, 9, 9]) },
  });
  grid.cellSize = 0.25;
  assert.equal(grid.cellSize, 0.25);
  grid.flags = GridFlags.CONSTRAINTS;
  assert.equal(grid.flags, GridFlags.CONSTRAINTS);
  grid.reserve(10, 1000);
  left.positions[4] = NaN;
  assert.throws(() => grid.step(), failure(Result.ERROR_NON_FINITE));
  assert.equal(grid.failure().vertex, 1);
  assert.equal(grid.failure(1), null);
  left.positions[4] = 0;
  grid.step();
  assert.equal(grid.failure(), null);
  assert.ok(grid.counters.step_ns > 0);
  assert.equal(grid.counters.bodies, 2);
  assert.ok(grid.suggestCellSize().cellSize > 0);
  assert.notEqual(grid.suggestCellSize({ model: 0 }).terms[0].name, grid.suggestCellSize({ model: 1 }).terms[0].name);
  assert.throws(() => new vox.Grid({ byteBudget: 10 }), failure(Result.ERROR_BUDGET));
  grid.dispose();
  assert.equal(grid.disposed, true);
  grid.dispose();
});

test("costs and cell sizes", () => {
  const meshes = [block(3), { ...block(3, [0.5, 0, 0]), selfCollision: true }];
  const found = vox.suggestCellSize(meshes, { model: 1, pNc: 0.9 });
  assert.equal(found.curve.length, CURVE_CAPACITY);
  assert.ok(found.terms.length > 0 && found.terms.every((term) => term.name.length > 0));
  const sum = found.terms.reduce((all, term) => all + term.cost, 0);
  assert.ok(Math.abs(sum / found.cost - 1) < 1e-9);
  const { tets, boundsMax, meanEdge } = vox.measureGeometry(meshes);
  assert.deepEqual([tets, ...boundsMax], [(meshes[0].tets.length + meshes[1].tets.length) / 4, 1.5, 1, 1]);
  assert.match(found.rules[0].name, /^mean edge/);
  assert.ok(Math.abs(found.rules[0].cellSize / meanEdge - 1) < 1e-6);
  assert.equal(found.timings.length, 0);
  const weights = vox.calibrate();
  assert.ok(weights.measured === 1 && weights.ns.length === COST_WEIGHT_CAPACITY && weights.ns.some((ns) => ns > 0));
  weights.ns = weights.ns.map((ns) => 1000 * ns); // of a machine that is far slower
  const shipped = { ns: new Float64Array(COST_WEIGHT_CAPACITY) };
  const costs = (suggest) => [{ weights }, { weights: shipped }, {}].map((more) => suggest({ model: 1, ...more }).cost);
  const [slow, zeros, none] = costs((settings) => vox.suggestCellSize(meshes, settings));
  assert.ok(slow > 10 * none && zeros === none);
  const grid = new vox.Grid({ reference: { weights } });
  for (const { positions, tets } of meshes) grid.add({ positions, tets });
  const [given, others, own] = costs((settings) => grid.suggestCellSize(settings));
  assert.ok(own > 10 * others && given === own);

  const least = vox.minimiseCost((size) => size + 4 / size, 0.1, 10);
  assert.ok(Math.abs(least.cellSize - 2) < 1e-3 && least.zoneMin < 2);
  assert.ok(vox.minimiseCost((size) => size + 4 / size, 0.1, 10, 0.5).zoneMin < least.zoneMin);
  assert.throws(() => vox.minimiseCost(() => { throw new Error("of the cost"); }, 1, 2), /of the cost/);
  assert.throws(() => vox.minimiseCost((size) => size, 3, 2), failure(Result.ERROR_INVALID_ARGUMENT));
});

test("the cell size of a grid of another program", () => {
  const { positions, tets } = block(4);
  const grid = {
    stored: { type: PrimitiveType.TET, positions, indices: tets },
    querying: { positions: new Float64Array(positions), radius: 0.0625, radii: new Float32Array(positions.length / 3).fill(0.03125) },
    known: KnownGrid.HASHED,
  };
  const found = vox.foreignGridSuggest(grid);
  assert.ok(found.zoneMin <= found.cellSize && found.cellSize <= found.zoneMax && found.terms.length > 1);
  assert.ok(Math.abs(found.rules.find((rule) => rule.name === "mean radius").cellSize - 0.09375) < 1e-6);
  assert.equal(found.note === "", found.warnings === 0);
  const none = Object.fromEntries(Object.keys(found.weights).map((name) => [name, 0]));
  assert.notDeepEqual(found.weights, none);
  assert.deepEqual(vox.foreignGridSuggest({ ...grid, weights: { read: 3 } }).weights, { ...none, read: 3 });
  const unknown = vox.foreignGridSuggest({ stored: grid.stored });
  assert.ok(unknown.warnings & CellSizeWarnings.GUESSED_WEIGHTS && unknown.note.length > 0);

  // A grid that takes as long as its counts say.
  const seconds = (size) => {
    const counts = vox.foreignGridCount(grid, size);
    return 1e-9 * (20 * counts.stored + 9 * counts.visits + 3 * counts.reads);
  };
  const fit = vox.foreignGridFit(grid, [0.075, 0.15, 0.3, 0.6].map((cellSize) => ({ cellSize, seconds: seconds(cellSize) })));
  assert.ok(fit.fitError < 0.02 && fit.weights.store > 0);
  const sizes = [];
  const tuning = vox.foreignGridTune((size) => (sizes.push(size), seconds(size)), { grid });
  assert.deepEqual(tuning.timings.map((timing) => timing.cellSize), sizes);
  assert.ok(seconds(tuning.cellSize) <= 1.1 * seconds(fit.cellSize) && tuning.expectedLoss < 0.1);

  const calls = sizes.length;
  assert.throws(() => vox.foreignGridTune((size) => { throw new Error(`at ${sizes.push(size)}`); }, { first: 1 }), /^Error: at \d+$/);
  assert.equal(sizes.length, calls + 1);
  assert.throws(() => vox.foreignGridTune(() => 1), failure(Result.ERROR_INVALID_ARGUMENT));
  assert.throws(() => vox.foreignGridTune(() => Infinity, { first: 1 }), failure(Result.ERROR_INVALID_STATE));
  assert.throws(() => vox.foreignGridCount(grid, NaN), failure(Result.ERROR_INVALID_ARGUMENT));
});

test("many grids", () => {
  const grids = [touching(), touching()].map(({ grid }) => grid);
  grids.push(new vox.Grid());
  vox.stepGrids(grids);
  assert.deepEqual(grids.map((grid) => grid.epoch), [2, 2, 1]);
  assert.throws(() => vox.stepGrids([grids[0], grids[0]]), failure(Result.ERROR_INVALID_ARGUMENT));
  for (const grid of grids) grid.dispose();
});

test("dispose with using, where there is Symbol.dispose", { skip: !Symbol.dispose }, () => {
  const grid = new vox.Grid();
  grid[Symbol.dispose]();
  assert.equal(grid.disposed, true);
});

test("modules are independent, and a Worker has one of its own", async () => {
  const { grid } = touching();
  const other = await loaded();
  assert.throws(() => other.stepGrids([grid]), TypeError);
  const worker = new Worker(new URL("worker.js", import.meta.url), { workerData: vox.module });
  const [[hash, vertices]] = await once(worker, "message");
  assert.equal(hash, grid.hash);
  assert.deepEqual(vertices, grid.contacts.vertex);
  await worker.terminate();
});
