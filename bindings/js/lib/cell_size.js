import { FilterFlags } from "../enums.js";
import { structs } from "../layout.js";
import { callback, camel, fields, float, list, options } from "./check.js";
import { foreignGrid } from "./foreign.js";
import { meshArrays, meshFields } from "./mesh_arrays.js";

const SUGGEST = ["model", "sizeReading", "areaReading", "pNc", "costRatio", "worldEdge", "zoneLoss", "meanEdgeFactor",
  "resolution", "byteBudget", "referenceFlags"];
const BOUNDS = ["min", "max", "zoneLoss"];
const TUNE = ["mostRuns", "min", "max", "first", "zoneLoss", "wantedLoss"];
const WEIGHTS = Object.keys(structs.vox_cost_weights.fields);

export function suggestFields(settings) {
  return fields(settings, "options", "vox_suggest_desc", SUGGEST);
}

/** Arrays that C fills in part, cut to what there is. */
export function suggestion({ curveCount, termCount, levelCount, runCount, ...found }) {
  const { curve, terms, levels, runs } = found;
  if (curve) found.curve = curve.slice(0, curveCount);
  if (terms) found.terms = terms.slice(0, termCount);
  if (levels) found.levels = levels.slice(0, levelCount);
  if (runs) found.runs = runs.slice(0, runCount);
  return found;
}

/** Runs `use` with options and meshes as C wants them. */
function withMeshes(memory, meshes, settings, use) {
  const given = suggestFields(settings);
  const all = list(meshes, "meshes", "{ positions, tets }").map((mesh, i) => {
    const { selfCollision = false, ...arrays } = options(mesh, `meshes[${i}]`, ["positions", "tets", "selfCollision"]);
    if (typeof selfCollision !== "boolean") throw new TypeError(`meshes[${i}].selfCollision: expected true or false`);
    return [meshArrays(arrays, memory), { flags: selfCollision ? FilterFlags.SELF_COLLISION : 0 }];
  });
  return memory.frame((frame) => {
    const { size } = structs.vox_mesh_desc;
    const list = frame.take(all.length * size);
    all.forEach(([arrays, filter], i) => memory.fill(list + i * size, "vox_mesh_desc", meshFields(frame, arrays, { filter })));
    return use(frame.struct("vox_suggest_desc", given), list, all.length);
  });
}

/** The functions of a module about cell sizes. */
export function cellSizes(memory) {
  const { call } = memory;
  const minimum = (bounds, ask) => {
    const given = fields(bounds, "bounds", "vox_cost_bounds", BOUNDS);
    return memory.frame((frame) => {
      const out = frame.struct("vox_cost_minimum");
      ask(frame, frame.struct("vox_cost_bounds", given), out);
      return suggestion(memory.read("vox_cost_minimum", out));
    });
  };
  /** Runs `use` with the number of a function that C may call. */
  const calling = (given, what, use) => {
    callback(given, what);
    const id = memory.addCallback((cellSize) => float(given(cellSize), `what ${what} returned`));
    try {
      return use(id);
    } finally {
      memory.removeCallback(id);
    }
  };
  return {
    suggestCellSize: (meshes, settings) =>
      withMeshes(memory, meshes, settings, (desc, list, count) =>
        suggestion(memory.get("vox_suggestion", (out) => call.vox_suggest_cell_size(desc, list, count, out))),
      ),

    predictCost(meshes, cellSize, settings) {
      const size = float(cellSize, "cellSize");
      return withMeshes(memory, meshes, settings, (desc, list, count) =>
        suggestion(memory.get("vox_cost_prediction", (out) => call.vox_cost_predict(desc, list, count, size, out))),
      );
    },

    calibrate: () => memory.get("vox_cost_weights", (out) => call.vox_cost_calibrate(out)),

    get costWeights() {
      return memory.get("vox_cost_weights", (out) => call.vox_cost_get_weights(out));
    },

    set costWeights(weights) {
      const given = weights === null ? null : fields(weights, "costWeights", "vox_cost_weights", WEIGHTS.map(camel));
      memory.frame((frame) => {
        if (!given) return call.vox_cost_set_weights(0);
        const all = { ...memory.get("vox_cost_weights", (out) => call.vox_cost_get_weights(out)), ...given };
        return call.vox_cost_set_weights(frame.struct("vox_cost_weights", all));
      });
    },

    minimiseCost: (cost, bounds) =>
      calling(cost, "cost", (id) => minimum(bounds, (_, desc, out) => call.voxtet_cost_minimise(id, desc, out))),

    minimiseCostTerms(terms, bounds) {
      const numbers = list(terms, "terms", "{ coefficient, power }").flatMap((term, i) => {
        const { coefficient, power } = options(term, `terms[${i}]`, ["coefficient", "power"]);
        return [float(coefficient, `terms[${i}].coefficient`), float(power, `terms[${i}].power`)];
      });
      return minimum(bounds, (frame, desc, out) =>
        call.vox_cost_minimise_terms(frame.numbers(numbers), numbers.length / 2, desc, out),
      );
    },

    suggestFor(grid) {
      const described = foreignGrid(grid, memory);
      return memory.frame((frame) =>
        suggestion(memory.get("vox_foreign_suggestion", (out) => call.vox_suggest_for(described(frame), out))),
      );
    },

    countFor(grid, cellSize) {
      const described = foreignGrid(grid, memory);
      const size = float(cellSize, "cellSize");
      return memory.frame((frame) => memory.get("vox_grid_work", (out) => call.vox_count_for(described(frame), size, out)));
    },

    costFit(grid, timings) {
      const described = foreignGrid(grid, memory);
      const numbers = list(timings, "timings", "{ cellSize, seconds }").flatMap((timing, i) => {
        const { cellSize, seconds } = options(timing, `timings[${i}]`, ["cellSize", "seconds"]);
        return [float(cellSize, `timings[${i}].cellSize`), float(seconds, `timings[${i}].seconds`)];
      });
      return memory.frame((frame) => {
        const given = frame.numbers(numbers);
        return suggestion(
          memory.get("vox_grid_fit", (out) => call.vox_cost_fit(described(frame), given, numbers.length / 2, out)),
        );
      });
    },

    tune(run, settings) {
      const { grid, ...rest } = options(settings, "options", ["grid", ...TUNE]);
      const described = grid === undefined ? () => 0 : foreignGrid(grid, memory);
      const given = fields(rest, "options", "vox_tune_desc", TUNE);
      return calling(run, "run", (id) =>
        memory.frame((frame) => {
          const out = frame.struct("vox_tuning");
          call.voxtet_cost_tune(described(frame), frame.struct("vox_tune_desc", given), id, out);
          return suggestion(memory.read("vox_tuning", out));
        }),
      );
    },

    zoneDistance(n, nMin, nOpt, nMax) {
      const given = Object.entries({ n, nMin, nOpt, nMax }).map(([name, value]) => float(value, name));
      return memory.number("f64", (out) => call.vox_zone_distance(...given, out));
    },
  };
}
