// Three closed surfaces to drop, made here: no file is loaded. Each is the text of an OBJ file, upright along its y axis.

const TAU = 2 * Math.PI;

/** OBJ of rows of points; `quad` joins a row with the next, and `ends` are fans over the first and the last row. */
function obj(rows, { closed }) {
  const width = rows[0].length;
  const lines = rows.flat().map((point) => `v ${point.map((x) => x.toFixed(5)).join(" ")}`);
  const at = (row, i) => (row % rows.length) * width + (i % width) + 1;
  for (let row = 0; row < (closed ? rows.length : rows.length - 1); ++row)
    for (let i = 0; i < width; ++i) lines.push(`f ${at(row, i)} ${at(row, i + 1)} ${at(row + 1, i + 1)}`, `f ${at(row, i)} ${at(row + 1, i + 1)} ${at(row + 1, i)}`);
  if (!closed)
    for (let i = 1; i + 1 < width; ++i) lines.push(`f ${at(0, 0)} ${at(0, i + 1)} ${at(0, i)}`, `f ${at(rows.length - 1, 0)} ${at(rows.length - 1, i)} ${at(rows.length - 1, i + 1)}`);
  return `${lines.join("\n")}\n`;
}

const add = (a, b, scale = 1) => a.map((x, i) => x + scale * b[i]);
const cross = (a, b) => [0, 1, 2].map((i) => a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3]);
const unit = (a) => a.map((x) => x / Math.hypot(...a));

/** A trefoil knot: a tube around a closed curve. */
function knot() {
  const curve = (t) => [Math.sin(t) + 2 * Math.sin(2 * t), Math.cos(t) - 2 * Math.cos(2 * t), -1.2 * Math.sin(3 * t)];
  const rows = Array.from({ length: 120 }, (_, row) => {
    const t = (TAU * row) / 120;
    const along = unit(add(curve(t + 1e-3), curve(t - 1e-3), -1));
    const u = unit(cross([Math.cos(t), Math.sin(t), 3], along));
    const v = cross(along, u);
    return Array.from({ length: 14 }, (_, i) => add(add(curve(t), u, 0.62 * Math.cos((TAU * i) / 14)), v, 0.62 * Math.sin((TAU * i) / 14)));
  });
  return obj(rows, { closed: true });
}

/** A jack: a ball with six arms. */
function jack() {
  const rows = Array.from({ length: 39 }, (_, row) => {
    const tilt = (Math.PI * (row + 1)) / 40;
    return Array.from({ length: 64 }, (_, i) => {
      const way = [Math.sin(tilt) * Math.cos((TAU * i) / 64), Math.cos(tilt), Math.sin(tilt) * Math.sin((TAU * i) / 64)];
      const arm = way.reduce((sum, x) => sum + x ** 12, 0);
      return way.map((x) => x * (0.42 + 0.6 * arm));
    });
  });
  return obj(rows, { closed: false });
}

/** A cog wheel: its outline, wide and narrow by turns, around a hole. */
function gear() {
  const steps = 80;
  const ring = (radius, z) => Array.from({ length: steps }, (_, i) => [radius(i) * Math.cos((TAU * i) / steps), radius(i) * Math.sin((TAU * i) / steps), z]);
  const outside = (i) => [1, 1, 1, 0.9, 0.76, 0.76, 0.76, 0.9][i % 8];
  const inside = () => 0.4;
  return obj([ring(outside, -0.3), ring(outside, 0.3), ring(inside, 0.3), ring(inside, -0.3)], { closed: true });
}

/** By name: the text, and about how many tetrahedra show its shape. */
export const SAMPLES = { knot: { make: knot, tets: 8000 }, jack: { make: jack, tets: 6000 }, gear: { make: gear, tets: 4000 } };
