// Wrong arguments, use after dispose, garbage: always an error of JavaScript's, and everything is as it was before.
import assert from "node:assert/strict";
import test from "node:test";
import { Result, VoxError } from "../voxtet.js";
import { block, loaded } from "./scenes.js";

const vox = await loaded();
const failure = (code) => (error) => error instanceof VoxError && error.code === code;

function scene() {
  const grid = new vox.Grid();
  const left = grid.add(block(2));
  const right = grid.add(block(2, [0.7, 0.31, 0.17]));
  grid.step();
  return { grid, left, right, locator: grid.locator() };
}

test("errors say what was wrong", () => {
  const { grid, left, locator } = scene();
  const point = new Float32Array(3);
  const cases = [
    [() => new vox.Grid({ cellsize: 1 }), TypeError, /"cellsize" is not known; there are cellSize, .*reference/],
    [() => new vox.Grid(7), TypeError, /options: expected an object, got 7/],
    [() => new vox.Grid({ cellSize: "1" }), TypeError, /options.cellSize: expected a number, got "1"/],
    [() => new vox.Grid({ flags: 1.5 }), RangeError, /options.flags: expected a whole number from 0 to 4294967295, got 1.5/],
    [() => new vox.Grid({ log: 1 }), TypeError, /options.log: expected a function, got 1/],
    [() => new vox.Grid({ reference: { flags: 99 } }), VoxError, /reference flags/],
    [() => vox.Grid.load("snapshot"), TypeError, /bytes: expected an ArrayBuffer or a view of one, got "snapshot"/],
    [() => vox.Grid.load(new Uint8Array(100)), VoxError, /snapshot/],
    [() => grid.add(), TypeError, /positions: expected a Float32Array or Float64Array, got undefined/],
    [() => grid.add({ positions: [0, 0, 0] }), TypeError, /got Array/],
    [() => grid.add({ positions: new Float32Array(4) }), RangeError, /positions: 4 numbers, which is not a multiple of 3/],
    [() => grid.add({ positions: new Float32Array(12), tets: [0, 1, 2] }), RangeError, /tets: 3 numbers/],
    [() => grid.add({ positions: new Float32Array(12), tets: [0, 1, 2, 2 ** 32] }), RangeError, /tets\[3\]/],
    [() => grid.add({ positions: new Float32Array(12), tets: [0, 1, 2, 4] }), VoxError, /tet 0 names vertex 4 of 4/],
    [() => grid.add({ positions: new Float32Array(12), userData: -1n }), RangeError, /userData/],
    [() => grid.addShape({ kind: "sphere" }), TypeError, /shape.kind: expected a whole number, got "sphere"/],
    [() => grid.addShape({ kind: 2, radus: 1 }), TypeError, /"radus" is not known; there are kind, radius/],
    [() => grid.addShape({ kind: 2, radius: -1 }), VoxError, /radius is -1/],
    [() => grid.addShape({}), VoxError, /kind/],
    [() => grid.addShape({ kind: 9 }), RangeError, /a field, which is a function/],
    [() => grid.addShape({ kind: 5, halfSize: [1, 2] }), RangeError, /shape.halfSize: expected 3 numbers, got 2/],
    [() => grid.addShape({ kind: 6, heights: [1, 2, 3], columns: 2, spacing: [1, 1] }), RangeError, /heights: 3 numbers in rows of 2/],
    [() => grid.addShape({ kind: 6, heights: ["1", 2], columns: 2, spacing: [1, 1] }), TypeError, /heights\[0\]: expected a number/],
    [() => grid.addShape({ kind: 6, heights: [], columns: 2, spacing: [1, 1] }), VoxError, /0 rows/],
    [() => grid.addShape({ kind: 7, positions: new Float32Array(9), triangles: [0, 1, 3] }), VoxError, /vertex 3 of 3/],
    [() => grid.addShape({ kind: 7, positions: new Float32Array(9), triangles: [0, 1] }), RangeError, /shape.triangles: 2 numbers/],
    [() => left.setPreviousTransform(null), VoxError, /is a mesh/],
    [() => left.setPreviousTransform([1, 2]), RangeError, /matrix: expected 12 numbers, got 2/],
    [() => grid.body("left"), TypeError, /id: expected a whole number, got "left"/],
    [() => grid.body(77).info, VoxError, /77/],
    [() => left.setTransform([1, 2, 3]), RangeError, /matrix: expected 12 numbers, got 3/],
    [() => left.replaceTets([0, 1], [0, 1, 2, 3]), RangeError, /corners: expected 4 numbers for each of 2 tets, got 4/],
    [() => left.bindPreviousPositions([0, 0, 0]), TypeError, /positions: expected a Float32Array or Float64Array, got Array/],
    [() => grid.findConstraints({ methd: 1 }), TypeError, /"methd" is not known; there are method, bodyA, bodyB, mask, closestBudget/],
    [() => grid.findConstraints({ method: 7 }), VoxError, /method is 7/],
    [() => (grid.margin = -1), VoxError, /margin is -1/],
    [() => (left.enabled = 2), VoxError, /enabled is 2, expected 0 or 1/],
    [() => locator.findPointHits([0, 0, 0]), TypeError, /points: expected a Float32Array or Float64Array, got Array/],
    [() => locator.findPointHits(new Float32Array(4)), RangeError, /points: 4 numbers, which is not a multiple of 3/],
    [() => locator.findPointHits(new Float64Array([0, 0, NaN])), VoxError, /points: position 0 is \(0, 0, nan\)/],
    [() => locator.testRays(point, new Float64Array(6)), VoxError, /from.count is 1, to.count is 2/],
    [() => locator.findClosest(point, { radius: 1 }), TypeError, /"radius" is not known; there are flags, mask, excluded, maxDistance/],
    [() => locator.update(locator), TypeError, /grid: expected a grid of this module/],
    [() => vox.stepGrids([locator]), TypeError, /grids\[0\]: expected a grid of this module/],
    [() => vox.minimiseCost(7, 1, 2), TypeError, /cost: expected a function/],
    [() => vox.minimiseCost(() => "1", 1, 2), TypeError, /what cost returned: expected a number, got "1"/],
    [() => vox.minimiseCost(() => 1, 1), TypeError, /max: expected a number, got undefined/],
    [() => vox.suggestCellSize([], { weights: { ns: [1] } }), RangeError, /options.weights.ns: expected 24 numbers, got 1/],
    [() => new vox.Grid({ reference: { weights: { ns: Array(24).fill(-1) } } }), VoxError, /weights.ns\[0\] is -1/],
    [() => vox.foreignGridSuggest({ store: {} }), TypeError, /"store" is not known; there are stored, querying/],
    [() => vox.foreignGridSuggest({}), TypeError, /grid.stored.positions: expected a Float32Array or Float64Array/],
    [() => vox.foreignGridSuggest({ stored: { positions: new Float32Array(9), type: 3 } }), RangeError, /3 vertices, which is not a multiple of 4/],
    [() => vox.foreignGridSuggest({ stored: { positions: new Float32Array(9), radii: [1] } }), RangeError, /radii: expected 3 numbers, got 1/],
    [() => vox.foreignGridSuggest({ stored: { positions: new Float32Array(9), type: 9 } }), VoxError, /type is 9/],
    [() => vox.foreignGridSuggest({ stored: { positions: new Float32Array(9) }, weights: { reads: 1 } }), TypeError, /grid.weights: "reads" is not known/],
    [() => vox.foreignGridFit({ stored: { positions: new Float32Array(9) } }, [[1, 2]]), TypeError, /timings\[0\]/],
    [() => vox.foreignGridTune(() => 1n, { first: 1 }), TypeError, /what run returned: expected a number, got 1n/],
    [() => vox.foreignGridTune(() => 1, { firs: 1 }), TypeError, /"firs" is not known/],
  ];
  for (const [call, Kind, text] of cases)
    assert.throws(call, (error) => {
      assert.ok(error instanceof Kind, `${call}: ${error.stack}`);
      assert.match(error.message, text, `${call}`);
      return true;
    });
  grid.dispose();
});

test("after dispose() every use throws", () => {
  const { grid, left, locator } = scene();
  const names = (object) => {
    const found = [];
    for (let at = Object.getPrototypeOf(object); at !== Object.prototype; at = Object.getPrototypeOf(at))
      found.push(...Object.entries(Object.getOwnPropertyDescriptors(at)));
    return found.filter(([name]) => !["constructor", "dispose", "disposed", "mesh", "id", "grid"].includes(name));
  };
  locator.dispose();
  assert.throws(() => locator.update(grid), failure(Result.ERROR_INVALID_STATE));
  grid.dispose();
  for (const object of [grid, left, locator])
    for (const [name, property] of names(object)) {
      if (property.get)
        assert.throws(() => object[name], failure(Result.ERROR_INVALID_STATE), name);
      else if (property.value.length === 0)
        assert.throws(() => object[name](), failure(Result.ERROR_INVALID_STATE), name);
    }
  assert.throws(() => grid.add(block(1)), failure(Result.ERROR_INVALID_STATE));
  assert.throws(() => (left.positions = block(2).positions), failure(Result.ERROR_INVALID_STATE));
  assert.throws(() => vox.stepGrids([grid]), failure(Result.ERROR_INVALID_STATE));
  assert.throws(() => locator.findPointHits(new Float32Array(3)), failure(Result.ERROR_INVALID_STATE));
  grid.dispose();
  // Also when that happens while the arguments are being looked at.
  const other = scene();
  const mesh = { get positions() { other.grid.dispose(); return new Float32Array(3); } };
  assert.throws(() => other.grid.add(mesh), failure(Result.ERROR_INVALID_STATE));
});

test("memory that cannot be had is an error", () => {
  const { grid } = scene();
  const hash = grid.hash;
  assert.throws(() => grid.reserve(1, 2 ** 31), failure(Result.ERROR_OUT_OF_MEMORY));
  assert.throws(() => grid.reserve(1, 2 ** 52), (error) => error instanceof VoxError);
  grid.step();
  assert.equal(grid.hash, hash);
  grid.dispose();
});

test("garbage in every argument", (t) => {
  let seed = Number(process.env.VOXTET_SEED ?? Date.now() % 2 ** 31);
  t.diagnostic(`VOXTET_SEED=${seed}`);
  const random = (n) => {
    seed = (Math.imul(seed, 1103515245) + 12345) >>> 0;
    return Math.floor((seed / 2 ** 32) * n);
  };
  const pick = (items) => items[random(items.length)];
  class Mine extends EvalError {}
  const detached = new Float32Array(12);
  structuredClone(detached, { transfer: [detached.buffer] });
  class Odd extends Float32Array {
    static get [Symbol.species]() { throw new Mine("species"); }
  }
  const gone = new vox.Grid();
  const goneMesh = gone.add(block(1));
  gone.dispose();
  const throwing = new Proxy({}, { get() { throw new Mine("get"); }, ownKeys() { throw new Mine("keys"); } });
  let now;
  const values = [
    () => undefined, () => null, () => NaN, () => Infinity, () => -1, () => 0, () => 1, () => 4097, () => 2 ** 31, () => 2 ** 32,
    () => 2 ** 53, () => 1.5, () => 1e300, () => "", () => "abc", () => "1", () => 7n, () => -1n, () => 2n ** 64n, () => true, () => Symbol("s"),
    () => ({}), () => [], () => [NaN], () => [0, 1, 2, 3], () => [0, 0, 0], () => [1, "2", 3], () => () => 0, () => new Date(),
    () => new Float32Array(), () => new Float32Array(3), () => new Float32Array(12).fill(NaN), () => new Float64Array([0.5, 0.5, 0.5]),
    () => new Float64Array(12).fill(1e308), () => new Float32Array(7), () => new Uint32Array([0, 1, 2, 3]), () => new Uint32Array([5, 4294967295, 1, 2]),
    () => new Uint8Array([0, 0, 1]), () => new BigInt64Array(4), () => new DataView(new ArrayBuffer(8)), () => new ArrayBuffer(64),
    () => new SharedArrayBuffer(64), () => new Odd(12), () => detached, () => throwing, () => ({ length: 2 ** 40 }), () => ({ length: 3, 0: 1, 1: 2, 2: 3 }),
    () => ({ length: 12 }), () => Object.create(null), () => gone, () => goneMesh, () => now.grid, () => now.locator, () => now.left, () => now.left.positions,
    () => now.grid.save(), () => now.grid.save().fill(random(256), random(400), random(4000)), () => now.grid.contacts, () => [now.grid, now.grid], () => [gone],
    () => ({ positions: value(), tets: value() }), () => ({ positions: new Float32Array(12), tets: [0, 1, 2, 3], userData: value(), filter: value() }),
    () => ({ positions: block(1).positions, tets: block(1).tets, restPositions: value() }), () => ({ mask: value(), flags: value() }),
    () => ({ category: value(), selfRings: value(), selfRestDistance: value() }), () => ({ maxDistance: value(), excluded: value() }),
    () => ({ copiesOf: value(), positions: value() }), () => ({ method: value(), bodyA: value(), bodyB: value() }), () => ({ min: value(), max: value() }),
    () => ({ reference: value(), cellSize: value(), flags: value(), log: value() }), () => ({ model: value(), pNc: value(), weights: { ns: value() } }),
    () => ({ stored: value(), querying: value(), known: value(), cellsQueried: value(), weights: value(), radius: value() }),
    () => ({ stored: { positions: block(1).positions, radius: value(), radii: value() }, minCellSize: value() }),
    () => ({ first: value(), maxRuns: value(), grid: value() }), () => [{ cellSize: value(), seconds: value() }], () => value,
    () => [{ positions: block(1).positions, tets: block(1).tets, selfCollision: value() }],
  ];
  const value = () => pick(values)();

  const skipped = ["constructor", "dispose", "disposed", "id", "grid", "reserve"];
  const members = [];
  for (const target of ["grid", "left", "locator", "vox", "Grid"]) {
    const object = { ...scene(), vox, Grid: vox.Grid }[target];
    const own = target === "vox" || target === "Grid";
    for (let at = own ? object : Object.getPrototypeOf(object); at && at !== Object.prototype && at !== Function.prototype; at = Object.getPrototypeOf(at)) {
      for (const [name, property] of Object.entries(Object.getOwnPropertyDescriptors(at))) {
        if (skipped.includes(name) || ["module", "prototype", "name", "length", "calibrate"].includes(name)) continue;
        if (property.set) members.push([target, `${name} =`, (o) => (o[name] = value())]);
        else if (name === "Grid") members.push([target, "new Grid", (o) => new o.Grid(value()).dispose()]);
        else if (typeof property.value === "function")
          members.push([target, name, (o) => {
            const back = o[name](...Array.from({ length: random(5) }, value));
            if (target === "Grid") back.dispose(); // of load
          }]);
      }
      if (own) break;
    }
  }
  assert.ok(members.length > 40, `${members.length} members`);

  const until = Date.now() + 1000 * Number(process.env.VOXTET_FUZZ_SECONDS ?? 5);
  const counts = { calls: 0, refused: 0 };
  while (Date.now() < until) {
    now = { ...scene(), vox, Grid: vox.Grid };
    for (let i = 0; i < 20; ++i) {
      const before = now.grid.save();
      const [target, name, call] = pick(members);
      ++counts.calls;
      try {
        call(now[target]);
      } catch (error) {
        ++counts.refused;
        const known = [TypeError, RangeError, VoxError, Mine].some((Kind) => error instanceof Kind);
        assert.ok(known && error.code !== Result.ERROR_INTERNAL, `${target}.${name}: ${error.stack}`);
        if (name !== "step") assert.deepEqual(now.grid.save(), before, `${target}.${name} changed the grid: ${error.stack}`);
      }
    }
    now.grid.clear();
    now.grid.add(block(2));
    now.grid.add(block(2, [0.7, 0.31, 0.17]));
    now.grid.step();
    now.grid.dispose();
    now.locator.dispose();
  }
  const { grid } = scene();
  assert.equal(grid.contacts.length, scene().grid.contacts.length);
  t.diagnostic(`${counts.calls} calls, ${counts.refused} refused`);
  assert.ok(counts.refused > 100);
});

test("a step for which JavaScript's stack was too small stops the module, and no other", async () => {
  const vox = await loaded();
  const grid = new vox.Grid();
  grid.add(block(2));
  grid.add(block(2, [0.7, 0.31, 0.17]));
  let found;
  const deep = () => {
    try {
      deep();
    } catch {
      if (found) return;
      try {
        grid.step(); // with a little more stack at each return
        found = "nothing";
      } catch (error) {
        if (error instanceof VoxError) found = error;
      }
      if (!found) throw new RangeError("more stack");
    }
  };
  deep();
  if (found === "nothing") return; // the stack was enough for all of the step as soon as it was for the call
  assert.match(found.message, /the module has stopped before, in vox_grid_step \(RangeError/);
  assert.throws(() => grid.hash, /has stopped/);
  assert.throws(() => new vox.Grid(), /has stopped/);
  grid.dispose();
  assert.ok(grid.disposed);
  const other = new (await loaded()).Grid();
  other.step();
  other.dispose();
});
