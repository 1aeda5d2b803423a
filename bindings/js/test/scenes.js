// Bodies for the tests and bench/wasm.mjs: blocks of cubes, cut into five tetrahedra each.
import { GridFlags, load } from "../voxtet.js";

/** The module that the tests are about: VOXTET_PLAIN=1 chooses the one without SIMD. */
export function loaded() {
  return load({ simd: process.env.VOXTET_PLAIN !== "1" });
}

/** n x n x n cubes of edge 1 / n, moved by `offset`. */
export function block(n, offset = [0, 0, 0], Type = Float32Array) {
  const positions = new Type(3 * (n + 1) ** 3);
  const at = (i, j, k) => (i * (n + 1) + j) * (n + 1) + k;
  const tets = [];
  for (let i = 0; i <= n; ++i)
    for (let j = 0; j <= n; ++j)
      for (let k = 0; k <= n; ++k) {
        positions.set([i, j, k].map((c, axis) => c / n + offset[axis]), 3 * at(i, j, k));
        if (i === n || j === n || k === n) continue;
        const corner = (x) => at(i + ((x >> 2) & 1), j + ((x >> 1) & 1), k + (x & 1));
        const odd = (i + j + k) % 2 ? 7 : 0;
        for (const tet of [[0, 1, 2, 4], [3, 1, 7, 2], [5, 1, 4, 7], [6, 2, 7, 4], [1, 2, 4, 7]])
          tets.push(...tet.map((x) => corner(x ^ odd)));
      }
  return { positions, tets: Uint32Array.from(tets) };
}

/** Contacts and hash of each step of two blocks, one of which moves; as text, for JSON. */
export function stepped(vox) {
  const grid = new vox.Grid({ flags: GridFlags.CONSTRAINTS | GridFlags.EDGES, margin: 0.05 });
  const body = block(6, [0.9, 0.013, 0.017]);
  grid.add(block(6));
  const mesh = grid.add(body);
  const found = [];
  for (let i = 0; i < 5; ++i) {
    mesh.setTransform([1, 0, 0, -0.05 * i, 0, 1, 0, 0, 0, 0, 1, 0]);
    grid.step();
    found.push([grid.contacts.length, grid.constraints.length, grid.hash.toString(16)]);
  }
  grid.dispose();
  return found;
}
