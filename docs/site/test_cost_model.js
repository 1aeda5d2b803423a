// The live figures' numbers beside the library's own: the cost of each of the 240 samples of docs/evidence/paper.csv, the
// paper's best cell sizes, Eq. 9 beside docs/evidence/paper-models.csv, and, given the tool, what `vox suggest --json` says of a
// mesh. usage: node test_cost_model.js [VOX MESH]

import assert from "node:assert/strict";
import {execFileSync} from "node:child_process";
import {readFileSync} from "node:fs";

import * as model from "./live/cost_model.js";
import {bodiesInThePlane, countedOver, meanEdgeOf, stepInThePlane} from "./live/plane.js";

function table(name) {
  const [head, ...rows] = readFileSync(new URL(`../evidence/${name}`, import.meta.url), "utf8").trim().split("\n");
  const keys = head.split(",");
  return rows.map(
      (row) =>
          Object.fromEntries(row.match(/("[^"]*"|[^,]*)(,|$)/g).map((cell, i) => [keys[i], cell.replace(/,$/, "")]))
  );
}

const near = (value, wanted, most, what) =>
    assert(Math.abs(value / wanted - 1) <= most, `${what}: ${value}, not ${wanted}`);

const samples = table("paper.csv");
let compared = 0;
for (const body of table("paper-models.csv")) {
  const best = 4 / Number(body.n_a);
  const size = Number(body.mean_edge);
  const scene = {size, area: model.areaFrom(size, best), ...model.defaults};
  near(model.bestCellSize(scene), best, 1e-12, `${body.model}: best cell size`);
  for (const sample of samples.filter((s) => s.model === body.model)) {
    near(
        model.cost(scene, Number(sample.cell_size)).total, Number(sample.cost), 1e-12,
        `${body.model} at ${sample.cell_size}`
    );
    ++compared;
  }
  const distance = model.zoneDistance(Number(body.n_a), Number(body.n_opt), Number(body.n_min), Number(body.n_max));
  near(distance, Number(body["epsilon:suggestion"]), 1e-9, `${body.model}: Eq. 9`);
  // Nowhere less than at the best, and at both ends of the zone 5 % more.
  const least = model.cost(scene, best).total;
  for (const cell of model.sweep(size / 8, size * 8, 400)) assert(model.cost(scene, cell).total >= least * (1 - 1e-12));
  for (const end of Object.values(model.zone(scene)))
    near(model.cost(scene, end).total, 1.05 * least, 1e-9, "end of the zone");
}
assert.equal(compared, 240);

if (process.argv.length > 2) {
  const said = JSON.parse(execFileSync(process.argv[2], ["suggest", "--json", process.argv[3]], {encoding: "utf8"}));
  const scene = {size: said.geometry.mean_edge, area: said.geometry.mean_facet_area, ...model.defaults};
  near(model.bestCellSize(scene), said.cell_size, 1e-12, "cell size");
  near(model.zone(scene).min, said.zone_min, 1e-9, "zone");
  near(model.zone(scene).max, said.zone_max, 1e-9, "zone");
  const {visits, tests} = model.cost(scene, said.cell_size);
  near(visits, said.terms[0].cost, 1e-12, said.terms[0].name);
  near(tests, said.terms[1].cost, 1e-12, said.terms[1].name);
  for (const point of said.curve) near(model.cost(scene, point.cell_size).total, point.cost, 1e-12, "curve");
  assert.equal(said.rules.length, 5);
  for (const rule of said.rules) near(model.cost(scene, rule.cell_size).total, rule.cost, 1e-12, rule.name);
}

// The plane: counts by hand for two triangles, and a minimum between the ends.
const step =
    stepInThePlane([[0.1, 0.1], [0.9, 0.1], [0.1, 0.9], [2.5, 2.5], [3.5, 2.5], [2.5, 3.5]], [[0, 1, 2], [3, 4, 5]], 1);
assert.deepEqual([step.visits, step.tests, step.each[0].covered, step.each[1].covered], [5, 6, 1, 4]);
const {points, triangles} = bodiesInThePlane();
const counted = countedOver(points, triangles, meanEdgeOf(points, triangles)).map((c) => c.total);
const least = counted.indexOf(Math.min(...counted));
assert(least > 10 && least < 50 && counted[0] > 2 * counted[least] && counted.at(-1) > 2 * counted[least]);
console.log(`${compared} costs are the library's`);
