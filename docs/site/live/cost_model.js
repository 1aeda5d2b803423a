// The paper's cost function and what follows from it, as docs/cost-models.md derives it: plain functions over numbers.
// A scene is {size, area, pNc, ratio}: s, A, p_nc and r of Eq. 3.

export const defaults = {
  pNc: 0.99,
  ratio: 5,
  zoneLoss: 0.05
};

// v_o: the cells that the box of one tetrahedron covers (Eq. 4, without its floor).
export function cellsCovered(scene, cellSize) {
  return (scene.size / cellSize + 2) ** 3;
}

// p_v: the vertices in one cell (Eqs. 5 to 7).
export function verticesPerCell(scene, cellSize) {
  return (3 * (Math.sqrt(3) / 2) * cellSize * cellSize) / scene.area;
}

// z and its two terms, in cell visits per tetrahedron (Eq. 3).
export function cost(scene, cellSize) {
  const covered = cellsCovered(scene, cellSize);
  const visits = scene.pNc * covered;
  const tests = (1 - scene.pNc) * covered * verticesPerCell(scene, cellSize) * scene.ratio;
  return {visits, tests, total: visits + tests};
}

// The one cell size at which z is least (Eq. 8): x = size / s solves 4x^3 - x^2 = c.
export function bestCellSize(scene) {
  const k = ((1 - scene.pNc) * scene.ratio * 3 * Math.sqrt(3) * scene.size * scene.size) / (2 * scene.area);
  const c = (3 * scene.pNc) / k;
  const w = Math.cosh(Math.acosh(1 + 216 * c) / 3);
  return scene.size * (1 / 12 + w / 6);
}

// Where z is at most 1 + loss times its minimum. It falls before the minimum and rises after it.
export function zone(scene, loss = defaults.zoneLoss) {
  const best = bestCellSize(scene);
  const most = (1 + loss) * cost(scene, best).total;
  return {min: crossing(scene, best, 0.5, most), max: crossing(scene, best, 2, most)};
}

function crossing(scene, best, factor, most) {
  let inside = best;
  let outside = best * factor;
  while (cost(scene, outside).total < most) outside *= factor;
  for (let i = 0; i < 60; ++i) {
    const middle = Math.sqrt(inside * outside);
    if (cost(scene, middle).total < most)
      inside = middle;
    else
      outside = middle;
  }
  return inside;
}

// A, of which the paper's tables and docs/evidence/paper.csv say nothing, from the best cell size that it leads to.
export function areaFrom(size, best, pNc = defaults.pNc, ratio = defaults.ratio) {
  const k = (3 * size * pNc) / (best * best * (4 * best - size));
  return ((1 - pNc) * ratio * 3 * Math.sqrt(3)) / (2 * k);
}

// Eq. 9: how far n cells per axis are from the measured optimum, in widths of the measured zone on that side.
export function zoneDistance(n, best, min, max) {
  if (n === best) return 0;
  return n < best ? (best - n) / (best - min) : (n - best) / (max - best);
}

// Cell sizes from `from` to `to`, evenly in the logarithm.
export function sweep(from, to, count) {
  return Array.from({length: count}, (_, i) => from * (to / from) ** (i / (count - 1)));
}
