import { FilterFlags } from "../enums.js";
import { structs } from "../layout.js";
import { callback, fields, float, list, options } from "./check.js";
import { foreignGrid } from "./foreign.js";
import { meshArrays, meshFields } from "./mesh_arrays.js";

const SUGGEST = ["model", "referenceFlags", "zoneLoss", "pNc", "costRatio", "worldEdge", "byteBudget"];
const TUNE = ["maxRuns", "min", "max", "first", "wantedLoss"];

/** Settings with weights, checked: a function that makes the struct of C of them. */
export function weighted(settings, what, struct, known) {
  const { weights, ...given } = fields(settings, what, struct, [...known, "weights"]);
  const numbers = weights === undefined ? 0 : fields(weights, `${what}.weights`, "vox_cost_weights", ["measured", "ns"]);
  return (frame) => frame.struct(struct, { ...given, weights: numbers ? frame.struct("vox_cost_weights", numbers) : 0 });
}

export function suggestOptions(settings) {
  return weighted(settings, "options", "vox_cell_size_desc", SUGGEST);
}

/** The result that `ask` has C write, with its arrays cut to what there is, and names as text. */
export function cellSizeResult(memory, ask) {
  const { curveCount, termCount, ruleCount, timingCount, ...found } = memory.frame((frame) => {
    const out = frame.struct("vox_cell_size_result"); // not that of memory.get, which callbacks may use
    ask(frame, out);
    return memory.read("vox_cell_size_result", out);
  });
  const named = (items) => items.map((item) => ({ ...item, name: memory.text(item.name) }));
  return {
    ...found,
    curve: found.curve.slice(0, curveCount),
    terms: named(found.terms.slice(0, termCount)),
    rules: named(found.rules.slice(0, ruleCount)),
    timings: found.timings.slice(0, timingCount),
  };
}

/** Meshes, checked: a function that makes an array and a count of C of them. */
function meshArray(meshes, memory) {
  const all = list(meshes, "meshes", "{ positions, tets }").map((mesh, i) => {
    const { selfCollision = false, ...arrays } = options(mesh, `meshes[${i}]`, ["positions", "tets", "selfCollision"]);
    if (typeof selfCollision !== "boolean") throw new TypeError(`meshes[${i}].selfCollision: expected true or false`);
    return [meshArrays(arrays, memory), { flags: selfCollision ? FilterFlags.SELF_COLLISION : 0 }];
  });
  return (frame) => {
    const { size } = structs.vox_mesh_desc;
    const array = frame.take(all.length * size);
    all.forEach(([arrays, filter], i) => memory.fill(array + i * size, "vox_mesh_desc", meshFields(frame, arrays, { filter })));
    return [array, all.length];
  };
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
    suggestCellSize(meshes, settings) {
      const described = suggestOptions(settings);
      const listed = meshArray(meshes, memory);
      return cellSizeResult(memory, (frame, out) => call.vox_suggest_cell_size(described(frame), ...listed(frame), out));
    },

    measureGeometry(meshes) {
      const listed = meshArray(meshes, memory);
      return memory.frame((frame) => memory.get("vox_geometry", (out) => call.vox_measure_geometry(...listed(frame), out)));
    },

    calibrate: () => memory.get("vox_cost_weights", (out) => call.vox_cost_calibrate(out)),

    minimiseCost(cost, min, max, zoneLoss = 0) {
      const given = Object.entries({ min, max, zoneLoss }).map(([name, value]) => float(value, name));
      return calling(cost, "cost", (id) =>
        cellSizeResult(memory, (_, out) => call.voxtet_cost_minimise(id, ...given, out)),
      );
    },

    foreignGridSuggest(grid) {
      const described = foreignGrid(grid, memory);
      return cellSizeResult(memory, (frame, out) => call.vox_foreign_grid_suggest(described(frame), out));
    },

    foreignGridCount(grid, cellSize) {
      const described = foreignGrid(grid, memory);
      const size = float(cellSize, "cellSize");
      return memory.frame((frame) =>
        memory.get("vox_foreign_counts", (out) => call.vox_foreign_grid_count(described(frame), size, out)),
      );
    },

    foreignGridFit(grid, timings) {
      const described = foreignGrid(grid, memory);
      const numbers = list(timings, "timings", "{ cellSize, seconds }").flatMap((timing, i) => {
        const { cellSize, seconds } = options(timing, `timings[${i}]`, ["cellSize", "seconds"]);
        return [float(cellSize, `timings[${i}].cellSize`), float(seconds, `timings[${i}].seconds`)];
      });
      return cellSizeResult(memory, (frame, out) =>
        call.vox_foreign_grid_fit(described(frame), frame.numbers(numbers), numbers.length / 2, out),
      );
    },

    foreignGridTune(run, settings) {
      const { grid, ...rest } = options(settings, "options", ["grid", ...TUNE]);
      const described = grid === undefined ? () => 0 : foreignGrid(grid, memory);
      const given = fields(rest, "options", "vox_tune_desc", TUNE);
      return calling(run, "run", (id) =>
        cellSizeResult(memory, (frame, out) =>
          call.voxtet_foreign_grid_tune(described(frame), frame.struct("vox_tune_desc", given), id, out),
        ),
      );
    },
  };
}
