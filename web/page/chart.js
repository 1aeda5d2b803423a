// The curve of one algorithm: how many times the least time a step takes at each cell size, as predicted; on it the sizes of known rules,
// what vox chose and where the visitor is; and dots that were measured. As SVG.
import { predictedAt } from "./curve.js";

const SVG = "http://www.w3.org/2000/svg";
const WIDTH = 460;
const HEIGHT = 320;
const LEFT = 34;
const RIGHT = 12;
const TOP = 96; // above it, a row for each label
const BOTTOM = 24;
const MOST = 6; // times the best
const SPAN = 7; // sizes up to so many times smaller and larger than the best
const ROWS = [13, 30, 47, 64, 81]; // one for each mark at most

function element(name, attributes, parent, text) {
  const made = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  if (text !== undefined) made.textContent = text;
  parent?.append(made);
  return made;
}

export const time = (ms) => (ms >= 100 ? `${ms.toFixed(0)} ms` : ms >= 10 ? `${ms.toFixed(1)} ms` : ms >= 0.1 ? `${ms.toFixed(2)} ms` : `${(1000 * ms).toFixed(0)} µs`);
export const length = (size) => Number(size.toPrecision(3)).toString();
export const more = (factor) => (factor < 3 ? `+${Math.max(0, (factor - 1) * 100).toFixed(0)} %` : `${factor.toFixed(1)} ×`);

/** From green (the best time) to red (five times as long). */
export const hue = (factor) => Math.round(140 * (1 - Math.max(0, Math.min(1, Math.log(factor / 1.1) / Math.log(4.5)))));

/** Rules that are named on the curve, by what the library calls them. */
const NAMED = [[/^mean edge/, "mean edge"], [/^2 mean edges/, "2 mean edges"], [/IPC/, "median box (IPC)"]];

export class Chart {
  #svg;
  #range = [0.05, 5]; // of cell sizes

  constructor(parent) {
    this.#svg = element("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: "img" }, parent);
  }

  /** Green where a step is fast and red where it is slow, from the smallest to the largest size: a CSS gradient. */
  static track(curve) {
    const stops = Array.from({ length: 21 }, (_, i) => predictedAt(curve, curve.size * SPAN ** (i / 10 - 1)) / curve.ms);
    return `linear-gradient(to right, ${stops.map((factor) => `hsl(${hue(factor)} 65% 48%)`).join(", ")})`;
  }

  get range() {
    return this.#range;
  }

  #x(size) {
    const [a, b] = this.#range.map(Math.log);
    return LEFT + ((Math.log(Math.min(this.#range[1], Math.max(this.#range[0], size))) - a) / (b - a)) * (WIDTH - LEFT - RIGHT);
  }

  #y(factor) {
    return HEIGHT - BOTTOM - (Math.min(factor, MOST) / MOST) * (HEIGHT - TOP - BOTTOM);
  }

  /** dots: { size, factor, age (0: new, 1: to be forgotten) or swept }; size: where the visitor is, with what factor. */
  draw({ curve, dots, size, factor }) {
    this.#range = [curve.size / SPAN, curve.size * SPAN];
    const svg = this.#svg;
    const bottom = HEIGHT - BOTTOM;
    const predicted = (at) => predictedAt(curve, at) / curve.ms;
    svg.replaceChildren();
    for (let times = 1; times <= MOST; ++times) {
      const y = this.#y(times);
      element("line", { class: times === 1 ? "chart-least" : "chart-axis", x1: LEFT, x2: WIDTH - RIGHT, y1: y, y2: y }, svg);
      element("text", { class: "chart-faint", x: LEFT - 6, y: y + 4, "text-anchor": "end" }, svg, `${times} ×`);
    }
    element("line", { class: "chart-axis", x1: LEFT, x2: WIDTH - RIGHT, y1: bottom, y2: bottom }, svg);
    for (const tick of [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50].filter((at) => at >= this.#range[0] && at <= this.#range[1]))
      element("text", { class: "chart-faint", x: this.#x(tick), y: bottom + 16, "text-anchor": "middle" }, svg, String(tick));

    const samples = curve.curve.filter((sample) => sample.size >= this.#range[0] && sample.size <= this.#range[1] && sample.ms / curve.ms <= MOST);
    const path = samples.map((sample, i) => `${i ? "L" : "M"}${this.#x(sample.size).toFixed(1)} ${this.#y(sample.ms / curve.ms).toFixed(1)}`).join("");
    if (samples.length > 0)
      element("path", { class: "chart-area", d: `${path}L${this.#x(samples.at(-1).size)} ${bottom}L${this.#x(samples[0].size)} ${bottom}Z` }, svg);
    element("path", { class: "chart-line", d: path }, svg);
    for (const dot of dots)
      element("circle", { class: dot.swept ? "chart-swept" : "chart-dot", cx: this.#x(dot.size), cy: this.#y(dot.factor), r: 3.5, opacity: dot.swept ? 1 : 0.6 * (1 - dot.age) }, svg);

    const here = Math.abs(Math.log(size / curve.size)) < 1e-3;
    const marks = [{ name: here ? "chosen by vox: you are here" : `chosen by vox`, at: curve.size, times: 1, kind: "best" }];
    for (const rule of curve.rules)
      for (const [pattern, name] of NAMED)
        if (pattern.test(rule.name)) marks.push({ name: `${name} ${more(predicted(rule.size))}`, at: rule.size, times: predicted(rule.size), kind: "rule" });
    if (!here) marks.push({ name: `you ${more(factor)}`, at: size, times: factor, kind: "you" });
    this.#drawMarks(marks);
    svg.setAttribute("aria-label",
      `Predicted time of a step against the cell size. It is least at the cell size ${length(curve.size)}, which vox chose, and grows to both sides. ` +
      `You are at ${length(size)}, with ${factor.toFixed(1)} times the least time. ` + marks.slice(1).map(({ name, at }) => `${name}: ${length(at)}.`).join(" "));
  }

  /** Each label in the first row where it has room, with a line down to its point. */
  #drawMarks(marks) {
    const ends = ROWS.map(() => -Infinity);
    const labels = element("g", {});
    for (const mark of marks.toSorted((a, b) => a.at - b.at)) {
      const x = this.#x(mark.at);
      const half = 4.3 * mark.name.length + 4;
      const middle = Math.min(WIDTH - half, Math.max(half, x));
      const row = ends.findIndex((end) => end < middle - half);
      ends[row] = middle + half;
      element("line", { class: `chart-lead ${mark.kind}`, x1: x, x2: x, y1: ROWS[row] + 5, y2: this.#y(mark.times) }, this.#svg);
      element("circle", { class: `chart-mark ${mark.kind}`, cx: x, cy: this.#y(mark.times), r: mark.kind === "rule" ? 4.5 : 7 }, this.#svg);
      element("text", { class: `chart-label ${mark.kind}`, x: middle, y: ROWS[row], "text-anchor": "middle" }, labels, mark.name);
    }
    this.#svg.append(labels); // over all lines
  }
}
