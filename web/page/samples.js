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

/** A tube of a radius around a curve over 0..1, whose cross-sections lean on `side`. */
function tube(curve, side, radius, { count, closed }) {
  const rows = Array.from({ length: count }, (_, row) => {
    const t = row / (closed ? count : count - 1);
    const along = unit(add(curve(t + 1e-4), curve(t - 1e-4), -1));
    const u = unit(cross(side(t), along));
    const v = cross(along, u);
    return Array.from({ length: 14 }, (_, i) => add(add(curve(t), u, radius * Math.cos((TAU * i) / 14)), v, radius * Math.sin((TAU * i) / 14)));
  });
  return obj(rows, { closed });
}

/** A cog wheel: its outline, wide and narrow by turns, around a hole. */
function gear() {
  const teeth = 9;
  const steps = 8 * teeth;
  const ring = (radius, z) => Array.from({ length: steps }, (_, i) => [radius(i) * Math.cos((TAU * i) / steps), radius(i) * Math.sin((TAU * i) / steps), z]);
  const outside = (i) => [1, 1, 1, 0.9, 0.76, 0.76, 0.76, 0.9][i % 8];
  const inside = () => 0.34;
  return obj([ring(outside, -0.22), ring(outside, 0.22), ring(inside, 0.22), ring(inside, -0.22)], { closed: true });
}

const knot = (t) => {
  const a = TAU * t;
  return [Math.sin(a) + 2 * Math.sin(2 * a), Math.cos(a) - 2 * Math.cos(2 * a), -1.2 * Math.sin(3 * a)];
};
const spring = (t) => [Math.cos(3.5 * TAU * t), 3 * t, Math.sin(3.5 * TAU * t)];

export const SAMPLES = {
  knot: () => tube(knot, (t) => [Math.cos(TAU * t), Math.sin(TAU * t), 3], 0.62, { count: 120, closed: true }),
  spring: () => tube(spring, () => [0, 1, 0], 0.28, { count: 120, closed: false }),
  gear,
};
