// Grids of other programs, on their way to the library.
import { Format, PrimitiveType } from "../enums.js";
import { structs } from "../layout.js";
import { camel, fields, floats, indices, positions } from "./check.js";

const PRIMITIVES = ["type", "positions", "indices", "radii", "radius"];
const GRID = ["stored", "querying", "known", "cellsStored", "cellsQueried", "cellsKept", "radius", "minCellSize", "zoneLoss", "weights"];
const WEIGHTS = Object.keys(structs.vox_foreign_weights.fields).map(camel);
const WIDTHS = {
  [PrimitiveType.POINT]: 1,
  [PrimitiveType.EDGE]: 2,
  [PrimitiveType.TRIANGLE]: 3,
  [PrimitiveType.TET]: 4,
  [PrimitiveType.BOX]: 2,
};

function each(what, length, width) {
  if (length % width !== 0) throw new RangeError(`${what}: ${length} vertices, which is not a multiple of ${width}`);
  return length / width;
}

/** Primitives, checked: a function that makes the struct of C of them. */
function primitives(given, what, memory) {
  const found = fields(given, what, "vox_primitives", PRIMITIVES);
  const { type = PrimitiveType.POINT } = found;
  const width = WIDTHS[type] ?? 1; // the library refuses other types
  const array = positions(found.positions, `${what}.positions`, memory);
  const corners = found.indices === undefined ? null : indices(found.indices, `${what}.indices`, width, memory);
  const count = corners ? corners.length / width : each(`${what}.positions`, array.length / 3, width);
  const radii = found.radii === undefined ? null : floats(found.radii, `${what}.radii`, count);
  return (frame) =>
    frame.struct("vox_primitives", {
      type,
      positions: frame.positions(array),
      indices: corners ? frame.array(corners) : 0,
      count,
      radii: radii ? frame.array(radii) : 0,
      radiusFormat: Format.DOUBLE,
      radius: found.radius ?? 0,
    });
}

/** A described grid, checked: a function that makes the struct of C of it. */
export function foreignGrid(given, memory) {
  const { weights, ...found } = fields(given, "grid", "vox_foreign_grid", GRID);
  const stored = primitives(found.stored, "grid.stored", memory);
  const querying = found.querying === undefined ? () => 0 : primitives(found.querying, "grid.querying", memory);
  const nanoseconds = weights === undefined ? {} : fields(weights, "grid.weights", "vox_foreign_weights", WEIGHTS);
  return (frame) =>
    frame.struct("vox_foreign_grid", { ...found, stored: stored(frame), querying: querying(frame), weights: nanoseconds });
}
