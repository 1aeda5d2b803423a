// Rigid shapes: each kind, and where it is and was.
import assert from "node:assert/strict";
import test from "node:test";
import { ConstraintKind, GridFlags, polyline, ShapeKind } from "../voxtet.js";
import { loaded } from "./scenes.js";

const vox = await loaded();
const positions = new Float64Array([0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1]);
const triangles = [0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3];
const at = (z) => [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, z];

function near(found, expected) {
  assert.ok(Math.abs(found - expected) < 1e-12, `${found}, expected ${expected}`);
}

for (const [name, shape, point, gap, normal] of [
  ["HALF_SPACE", {}, [3, 4, -0.25], -0.25, [0, 0, 1]],
  ["SPHERE", { radius: 1 }, [0.5, 0, 0], -0.5, [1, 0, 0]],
  ["CAPSULE", { radius: 0.5, halfLength: 1 }, [0.25, 0, 1], -0.25, [1, 0, 0]],
  ["CYLINDER", { radius: 0.5, halfLength: 1 }, [0, 0.25, 0.5], -0.25, [0, 1, 0]],
  ["BOX", { halfSize: [1, 0.5, 2] }, [0, -0.25, 0], -0.25, [0, -1, 0]],
  ["HEIGHTFIELD", { heights: Array(6).fill(-0.5), columns: 3, spacing: [1, 2] }, [1, 1, -0.75], -0.25, [0, 0, 1]],
  ["SOLID", { positions, triangles }, [0.25, 0.25, 0.125], -0.125, [0, 0, -1]],
  ["SHEET", { positions, triangles, radius: 0.25 }, [0.25, 0.25, -0.125], -0.125, [0, 0, -1]],
  ["SHEET", { positions: new Float32Array(positions), triangles: polyline(2), radius: 0.25 }, [0.5, 0, -0.125], -0.125, [0, 0, -1]],
])
  test(`a vertex in a shape: ${name}`, () => {
    const grid = new vox.Grid({ flags: GridFlags.CONSTRAINTS });
    const mesh = grid.add({ positions: new Float64Array([...point, 2, 3, 4]) });
    const body = grid.addShape({ kind: ShapeKind[name], userData: 2n ** 63n, filter: { category: 2 }, ...shape });
    grid.step();
    assert.equal(grid.constraints.length, 1);
    const found = grid.constraints.at(0);
    assert.deepEqual([found.bodyA, found.bodyB, found.userDataB], [mesh.id, body.id, 2n ** 63n]);
    assert.deepEqual([found.count, found.countA, found.vertices[0]], [1, 1, 0]);
    near(found.gap, gap);
    normal.forEach((n, k) => near(found.normal[k], n));
    assert.deepEqual([body.info.shape, mesh.info.shape, body.filter.category], [ShapeKind[name], ShapeKind.NONE, 2n]);
    assert.deepEqual(grid.bodies.map(({ id }) => id), [mesh.id, body.id]);
    grid.dispose();
  });

test("a shape that moves meets what it passes", () => {
  const grid = new vox.Grid({ flags: GridFlags.CONSTRAINTS });
  grid.add({ positions: new Float64Array([0, 0, 3]) });
  const ball = grid.addShape({ kind: ShapeKind.SPHERE, radius: 0.25 });
  ball.setTransform(at(6));
  ball.setPreviousTransform(at(0));
  grid.step();
  assert.equal(grid.constraints.at(0).kind, ConstraintKind.IMPACT);
  assert.ok(Math.abs(grid.constraints.at(0).time - 2.75 / 6) < 1e-9);
  ball.setPreviousTransform(null);
  grid.step();
  assert.equal(grid.constraints.length, 0);
  ball.remove();
  assert.equal(ball.valid, false);
  grid.dispose();
});

test("polylines", () => {
  assert.deepEqual([...polyline(3)], [0, 1, 1, 1, 2, 2]);
  assert.deepEqual([polyline(0).length, polyline(1).length], [0, 0]);
});
