// The paper's algorithm in a plane, to draw it: squares for cells, triangles for tetrahedra.

import {sweep} from "./cost_model.js";

export const testShare = 0.2;  // of a cell visit: about what docs/evidence/paper.md measures (0.12 to 0.22)

// Two bodies of triangles about one unit wide, on a lattice that is bent.
export function bodiesInThePlane() {
  const points = [];
  const triangles = [];
  for (const [centreX, centreY, turn] of [[5.4, 5.1, 0.3], [12.6, 5.6, 1.1]]) {
    const number = new Map();
    const at = (i, j) => {
      const [x, y] = [i + j / 2, (j * Math.sqrt(3)) / 2];
      if (Math.hypot(x, y) > 4.3) return -1;
      const key = `${i} ${j}`;
      if (!number.has(key)) {
        number.set(key, points.length);
        const [bentX, bentY] = [x + 0.22 * Math.sin(1.3 * y + turn), y + 0.22 * Math.sin(1.7 * x - turn)];
        points.push([
          centreX + bentX * Math.cos(turn) - bentY * Math.sin(turn),
          centreY + bentX * Math.sin(turn) + bentY * Math.cos(turn)
        ]);
      }
      return number.get(key);
    };
    for (let i = -8; i < 8; ++i)
      for (let j = -8; j < 8; ++j)
        for (const corners of [[at(i, j), at(i + 1, j), at(i, j + 1)], [at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]])
          if (Math.min(...corners) >= 0) triangles.push(corners);
  }
  return {points, triangles};
}

// What one step does on a lattice of squares in the plane, by the paper's algorithm: each triangle visits the cells
// that its box covers, and looks at the points in them. `points` and `triangles` are [x, y] and [a, b, c].
export function stepInThePlane(points, triangles, cellSize) {
  const cells = new Map();
  const cellOf = (v) => Math.floor(v / cellSize);
  points.forEach(([x, y], i) => {
    const key = `${cellOf(x)} ${cellOf(y)}`;
    if (!cells.has(key)) cells.set(key, []);
    cells.get(key).push(i);
  });
  let visits = 0;
  let tests = 0;
  const each = triangles.map((corners) => {
    const xs = corners.map((i) => points[i][0]);
    const ys = corners.map((i) => points[i][1]);
    const low = [cellOf(Math.min(...xs)), cellOf(Math.min(...ys))];
    const high = [cellOf(Math.max(...xs)), cellOf(Math.max(...ys))];
    const found = [];
    for (let i = low[0]; i <= high[0]; ++i)
      for (let j = low[1]; j <= high[1]; ++j) found.push(...(cells.get(`${i} ${j}`) ?? []));
    const covered = (high[0] - low[0] + 1) * (high[1] - low[1] + 1);
    visits += covered;
    tests += found.length;
    return {low, high, covered, found};
  });
  return {visits, tests, each};
}

// One that lies where the two bodies meet, to begin with.
export function triangleInTheMiddle(points, triangles) {
  const distance = (corners) => Math.hypot(
      corners.reduce((sum, c) => sum + points[c][0] / 3, 0) - 9,
      corners.reduce((sum, c) => sum + points[c][1] / 3, 0) - 5.3
  );
  return triangles.reduce((best, corners, i) => (distance(corners) < distance(triangles[best]) ? i : best), 0);
}

export function meanEdgeOf(points, triangles) {
  const length = (a, b) => Math.hypot(points[a][0] - points[b][0], points[a][1] - points[b][1]);
  const edges = triangles.flatMap(([a, b, c]) => [length(a, b), length(b, c), length(c, a)]);
  return edges.reduce((sum, edge) => sum + edge, 0) / edges.length;
}

// The work at many cell sizes, in mean edges, each the mean over a few positions of the lattice.
export function countedOver(points, triangles, meanEdge) {
  const offsets = [0, 0.31, 0.57, 0.83];
  return sweep(0.25, 8, 61).map((size) => {
    let [visits, tests] = [0, 0];
    for (const offset of offsets) {
      const moved = points.map(([x, y]) => [x + offset * size * meanEdge, y + ((offset * 3) % 1) * size * meanEdge]);
      const step = stepInThePlane(moved, triangles, size * meanEdge);
      visits += step.visits / offsets.length;
      tests += (testShare * step.tests) / offsets.length;
    }
    return {size, visits, tests, total: visits + tests};
  });
}
