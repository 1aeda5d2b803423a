// Rigid shapes, on their way to the library.
import { ShapeKind } from "../enums.js";
import { bits, fields, indices, positions } from "./check.js";

const SHAPE = ["kind", "radius", "halfLength", "halfSize", "positions", "triangles", "heights", "columns", "spacing", "userData", "filter"];

/** The numbers of a row after a row. */
function rows(heights, columns) {
  if (heights.length === 0) return 0;
  if (!(columns > 0) || heights.length % columns !== 0)
    throw new RangeError(`shape.heights: ${heights.length} numbers in rows of ${columns}`);
  return heights.length / columns;
}

/** What writes a vox_shape_desc into a frame, of a shape that was checked. */
export function shapeOf(shape, filterOf, memory) {
  const given = fields(shape, "shape", "vox_shape_desc", SHAPE);
  if (given.kind === ShapeKind.FIELD) throw new RangeError("shape.kind: a field, which is a function, has no place in JavaScript");
  const at = given.positions === undefined ? undefined : positions(given.positions, "shape.positions", memory);
  const triangles = given.triangles === undefined ? new Uint32Array() : indices(given.triangles, "shape.triangles", 3, memory);
  const heights = Float64Array.from(given.heights ?? [], (height, i) => {
    if (typeof height !== "number") throw new TypeError(`shape.heights[${i}]: expected a number, got ${typeof height}`);
    return height;
  });
  const further = {
    rows: rows(heights, given.columns ?? 0),
    userData: given.userData === undefined ? 0n : bits(given.userData, "shape.userData"),
    filter: given.filter === undefined ? undefined : filterOf(given.filter),
    triangleCount: triangles.length / 3,
  };
  return (frame) =>
    frame.struct("vox_shape_desc", {
      ...given,
      ...further,
      positions: frame.positions(at),
      triangles: frame.array(triangles),
      heights: frame.array(heights),
    });
}

/** Segments between `count` positions, one after the other, as triangles of a sheet. */
export function polyline(count) {
  return Uint32Array.from({ length: 3 * Math.max(count - 1, 0) }, (_, i) => Math.floor(i / 3) + (i % 3 === 0 ? 0 : 1));
}
