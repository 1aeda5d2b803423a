// The arrays of a mesh, on their way to the library.
import { MeshFlags } from "../enums.js";
import { indices, positions } from "./check.js";

export function same(what, found, expected) {
  if (found !== expected) throw new RangeError(`${what}: expected ${expected} vertices, as there are positions, got ${found}`);
}

/** positions, tets and restPositions of a mesh, checked. */
export function meshArrays(given, memory) {
  const array = positions(given.positions, "positions", memory);
  const tets = given.tets === undefined ? new Uint32Array() : indices(given.tets, "tets", 4, memory);
  const rest = given.restPositions === undefined ? undefined : positions(given.restPositions, "restPositions", memory);
  return { array, tets, rest };
}

/** The fields of a vox_mesh_desc of arrays that are copied. */
export function meshFields(frame, { array, tets, rest }, further) {
  return {
    flags: MeshFlags.COPY_POSITIONS,
    positions: frame.positions(array),
    tets: frame.array(tets),
    tetCount: tets.length / 4,
    restPositions: frame.positions(rest),
    ...further,
  };
}

export function meshDesc(frame, arrays, further) {
  return frame.struct("vox_mesh_desc", meshFields(frame, arrays, further));
}
