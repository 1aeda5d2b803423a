// The arrays of a mesh, on their way to the library.
import { Format, MeshFlags } from "../enums.js";
import { indices, positions } from "./check.js";

export function same(what, found, expected) {
  if (found !== expected) throw new RangeError(`${what}: expected ${expected} vertices, as there are positions, got ${found}`);
}

/** positions, tets and restPositions of a mesh, checked. */
export function meshArrays(given, memory) {
  const array = positions(given.positions, "positions", memory);
  const tets = given.tets === undefined ? new Uint32Array() : indices(given.tets, "tets", 4, memory);
  const rest = given.restPositions === undefined ? undefined : positions(given.restPositions, "restPositions", memory);
  if (rest) {
    same("restPositions", rest.length / 3, array.length / 3);
    if (rest.BYTES_PER_ELEMENT !== array.BYTES_PER_ELEMENT)
      throw new TypeError(`restPositions: the positions are a ${array.constructor.name}, got a ${rest.constructor.name}`);
  }
  return { array, tets, rest };
}

/** The fields of a vox_mesh_desc of arrays that are copied. */
export function meshFields(frame, { array, tets, rest }, further) {
  return {
    flags: MeshFlags.COPY_POSITIONS,
    positions: frame.array(array),
    positionFormat: array.BYTES_PER_ELEMENT === 8 ? Format.DOUBLE3 : Format.FLOAT3,
    vertexCount: array.length / 3,
    tets: frame.array(tets),
    tetCount: tets.length / 4,
    restPositions: rest ? frame.array(rest) : 0,
    ...further,
  };
}

export function meshDesc(frame, arrays, further) {
  return frame.struct("vox_mesh_desc", meshFields(frame, arrays, further));
}
