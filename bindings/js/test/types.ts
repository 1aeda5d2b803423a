// Compiled by tsc --strict, and never run: the types are those that a program can use.
import { CellsQueried, ConstraintKind, DepthMethod, FilterFlags, GridFlags, KnownGrid, load, PrimitiveType, QueryFlags, Result, ShapeKind, VoxError, polyline, type CellSizeResult, type Contacts, type Grid, type Vox } from "voxtet";

export async function program(): Promise<number> {
  const vox: Vox = await load({ simd: false });
  using grid: Grid = new vox.Grid({ flags: GridFlags.CONSTRAINTS | GridFlags.EDGES, margin: 0.1, log: (level, text) => console.log(level, text) });
  const mesh = grid.add({ positions: new Float32Array(12), tets: [0, 1, 2, 3], userData: 7n, filter: { flags: FilterFlags.SELF_COLLISION } });
  mesh.positions.set([0, 1, 2]);
  mesh.positions = new Float64Array(12);
  mesh.bindPreviousPositions(mesh.positions);
  const ball = grid.addShape({ kind: ShapeKind.SPHERE, radius: 1, userData: 7 });
  ball.setPreviousTransform(null);
  grid.addShape({ kind: ShapeKind.SHEET, positions: new Float64Array(6), triangles: polyline(2), radius: 0.1, filter: { category: 2 } });
  grid.addShape({ kind: ShapeKind.HEIGHTFIELD, heights: [0, 0, 0, 0], columns: 2, spacing: [1, 1] });
  grid.step();
  const contacts: Contacts = grid.contacts;
  const vertices: Uint32Array = contacts.vertex;
  let sum = vertices.length;
  for (const contact of contacts.slice(1)) sum += contact.tet;
  grid.findConstraints({ method: DepthMethod.CLOSEST, bodyA: mesh, mask: 1n });
  for (const { kind, gap, normal } of grid.constraints) if (kind === ConstraintKind.INSIDE) sum += gap * normal[2];
  sum += grid.constraints.pairOffsets.length + grid.pairs.state[0];
  const last: number | undefined = contacts.at(-1)?.tet;
  using locator = grid.locator();
  const hit = locator.findClosest(new Float32Array(3), { mask: 1n, maxDistance: 2, excluded: mesh }).at(0);
  const sides: Int32Array = locator.findRayHits(new Float32Array(3), new Float64Array(3), { flags: QueryFlags.FIRST_HIT }).side;
  const hash: bigint = grid.hash;
  locator.update(grid);
  const size: number = vox.suggestCellSize([{ positions: new Float32Array(12), tets: new Uint32Array(4) }], { pNc: 0.5, weights: vox.calibrate() }).cellSize;
  const edge: number = vox.measureGeometry([{ positions: new Float32Array(12) }]).meanEdge;
  const grids = { stored: { type: PrimitiveType.TET, positions: new Float32Array(12), radii: [1] }, known: KnownGrid.VTK };
  const tuned: CellSizeResult = vox.foreignGridTune((cell) => edge + cell, { grid: grids, maxRuns: 5 });
  const found = vox.foreignGridSuggest({ ...grids, cellsQueried: CellsQueried.PAIRS, weights: { read: 2 } });
  const note: string = vox.foreignGridFit(grids, tuned.timings).note + found.rules[0].name;
  const copy: Grid = vox.Grid.load(grid.save());
  vox.stepGrids([grid, copy]);
  try {
    mesh.remove();
  } catch (error) {
    if (error instanceof VoxError && error.code === Result.ERROR_INVALID_HANDLE) return -1;
  }
  return sum + sides.length + (last ?? 0) + (hit?.distance ?? 0) + Number(hash) + size + note.length + copy.epoch;
}

export async function mistakes(): Promise<void> {
  const { Grid } = await load();
  const grid = new Grid();
  // @ts-expect-error positions are numbers in a typed array
  grid.add({ positions: [0, 0, 0] });
  // @ts-expect-error a sphere has a radius
  grid.addShape({ kind: ShapeKind.SPHERE });
  // @ts-expect-error a misspelt option
  new Grid({ cellsize: 1 });
  // @ts-expect-error results are not to be written
  grid.contacts = grid.contacts;
  // @ts-expect-error a mesh, not its name
  grid.setPairEnabled("left", "right", true);
  // @ts-expect-error a hash has 64 bits
  const hash: number = grid.hash;
  return void hash;
}
