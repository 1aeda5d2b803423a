import { FilterFlags } from "../enums.js";
import { structs } from "../layout.js";
import { callback, fields, float, list, options } from "./check.js";
import { foreignGrid } from "./foreign.js";
import { meshArrays, meshFields } from "./mesh_arrays.js";

const SUGGEST = ["model", "sizeReading", "areaReading", "pNc", "costRatio", "worldEdge", "zoneLoss", "meanEdgeFactor",
  "resolution", "byteBudget", "referenceFlags"];
const TUNE = ["mostRuns", "min", "max", "first", "zoneLoss", "wantedLoss"];

/** Settings with weights, checked: a function that makes the struct of C of them. */
export function weighted(settings, what, struct, known) {
  const { weights, ...given } = fields(settings, what, struct, [...known, "weights"]);
  const numbers = weights === undefined ? 0 : fields(weights, `${what}.weights`, "vox_cost_weights", ["measured", "ns"]);
  return (frame) => frame.struct(struct, { ...given, weights: numbers ? frame.struct("vox_cost_weights", numbers) : 0 });
}

export function suggestOptions(settings) {
  return weighted(settings, "options", "vox_suggest_desc", SUGGEST);
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
  const described = suggestOptions(settings);
  const all = list(meshes, "meshes", "{ positions, tets }").map((mesh, i) => {
    const { selfCollision = false, ...arrays } = options(mesh, `meshes[${i}]`, ["positions", "tets", "selfCollision"]);
    if (typeof selfCollision !== "boolean") throw new TypeError(`meshes[${i}].selfCollision: expected true or false`);
    return [meshArrays(arrays, memory), { flags: selfCollision ? FilterFlags.SELF_COLLISION : 0 }];
  });
  return memory.frame((frame) => {
    const { size } = structs.vox_mesh_desc;
    const list = frame.take(all.length * size);
    all.forEach(([arrays, filter], i) => memory.fill(list + i * size, "vox_mesh_desc", meshFields(frame, arrays, { filter })));
    return use(described(frame), list, all.length);
  });
}

/** The functions of a module about cell sizes. */
export function cellSizes(memory) {
  const { call } = memory;
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

    calibrate: () => memory.get("vox_cost_weights", (out) => call.vox_cost_calibrate(out)),

    minimiseCost(cost, min, max, zoneLoss = 0) {
      const given = Object.entries({ min, max, zoneLoss }).map(([name, value]) => float(value, name));
      return calling(cost, "cost", (id) =>
        memory.frame((frame) => {
          const out = frame.struct("vox_cost_minimum");
          call.voxtet_cost_minimise(id, ...given, out);
          return suggestion(memory.read("vox_cost_minimum", out));
        }),
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
  };
}
