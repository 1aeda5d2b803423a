// Grids of other programs, on their way to the library.
import { Format, PrimitiveType } from "../enums.js";
import { structs } from "../layout.js";
import { camel, fields, floats, indices, positions } from "./check.js";

const PRIMITIVES = ["type", "positions", "indices", "radii", "radius"];
const GRID = ["held", "asking", "known", "content", "look", "flags", "radius", "leastCellSize", "zoneLoss", "weights"];
const WEIGHTS = Object.keys(structs.vox_grid_weights.fields).map(camel);
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
  const { known, weights, ...found } = fields(given, "grid", "vox_foreign_grid", GRID);
  const held = primitives(found.held, "grid.held", memory);
  const asking = found.asking === undefined ? () => 0 : primitives(found.asking, "grid.asking", memory);
  const nanoseconds = weights === undefined ? {} : fields(weights, "grid.weights", "vox_grid_weights", WEIGHTS);
  return (frame) => {
    const at = frame.struct("vox_foreign_grid");
    memory.call.vox_foreign_grid_set_known(at, known ?? 0);
    const like = memory.read("vox_foreign_grid", at);
    memory.fill(at, "vox_foreign_grid", {
      ...like,
      ...found,
      held: held(frame),
      asking: asking(frame),
      weights: { ...like.weights, ...nanoseconds },
    });
    return at;
  };
}
