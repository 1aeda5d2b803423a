// The curve of costs: predicted times of both algorithms against the cell size, what was measured, and the marks of other rules. As SVG.

const SVG = "http://www.w3.org/2000/svg";
const WIDTH = 460;
const HEIGHT = 300;
const LEFT = 46;
const RIGHT = 10;
const TOP = 14;
const BOTTOM = 50;
const NAMES = { 1: "paper", 2: "fast" };

function element(name, attributes, parent, text) {
  const made = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  if (text !== undefined) made.textContent = text;
  parent?.append(made);
  return made;
}

export const time = (ms) => (ms >= 100 ? `${ms.toFixed(0)} ms` : ms >= 10 ? `${ms.toFixed(1)} ms` : ms >= 0.1 ? `${ms.toFixed(2)} ms` : `${(1000 * ms).toFixed(0)} µs`);
export const length = (size) => Number(size.toPrecision(3)).toString();

export class Chart {
  #svg;
  #range = [0.05, 5]; // of cell sizes
  #values = [0.01, 100]; // of milliseconds

  constructor(parent) {
    this.#svg = element("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: "img" }, parent);
  }

  get range() {
    return this.#range;
  }

  #x(size) {
    const [a, b] = this.#range.map(Math.log);
    return LEFT + ((Math.log(size) - a) / (b - a)) * (WIDTH - LEFT - RIGHT);
  }

  #y(ms) {
    const [a, b] = this.#values.map(Math.log);
    return HEIGHT - BOTTOM - ((Math.log(ms) - a) / (b - a)) * (HEIGHT - TOP - BOTTOM);
  }

  /** `curves` of each engine; points: measured { engine, size, ms }; chosen: { engine, size }; now: { ms } measured there. */
  draw({ curves, points, chosen, now }) {
    const best = curves[chosen.engine];
    // The same range for both algorithms, wide enough for both minima.
    const sizes = Object.values(curves).map((curve) => curve.size);
    this.#range = [Math.min(...sizes) / 7, Math.max(...sizes) * 7];
    const inRange = ({ size }) => size >= this.#range[0] && size <= this.#range[1];
    const lows = Object.values(curves).map((curve) => curve.ms);
    this.#values = [Math.max(Math.min(...lows) / 2.5, Math.max(...lows) / 1000), Math.max(...lows) * 40];
    const inside = ({ ms }) => ms >= this.#values[0] && ms <= this.#values[1];
    this.#svg.replaceChildren();
    const svg = this.#svg;
    const bottom = HEIGHT - BOTTOM;

    const zone = best.zone.map((size) => this.#x(Math.min(this.#range[1], Math.max(this.#range[0], size))));
    element("rect", { class: "chart-zone", x: zone[0], y: TOP, width: zone[1] - zone[0], height: bottom - TOP }, svg);
    for (let power = Math.ceil(Math.log10(this.#values[0])); 10 ** power <= this.#values[1]; ++power) {
      const y = this.#y(10 ** power);
      element("line", { class: "chart-axis", x1: LEFT, x2: WIDTH - RIGHT, y1: y, y2: y }, svg);
      element("text", { class: "chart-faint", x: LEFT - 4, y: y + 4, "text-anchor": "end" }, svg, power >= 0 ? `${10 ** power} ms` : `${Math.round(1000 * 10 ** power)} µs`);
    }
    for (const size of [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50]) {
      if (!inRange({ size })) continue;
      const x = this.#x(size);
      element("line", { class: "chart-axis", x1: x, x2: x, y1: TOP, y2: bottom }, svg);
      element("text", { class: "chart-faint", x, y: bottom + 14, "text-anchor": "middle" }, svg, String(size));
    }
    element("text", { class: "chart-text", x: (LEFT + WIDTH - RIGHT) / 2, y: HEIGHT - 6, "text-anchor": "middle" }, svg, "cell size");
    element("text", { class: "chart-text", x: LEFT + 4, y: TOP + 10 }, svg, "time of a step");
    element("text", { class: "chart-faint", x: (zone[0] + zone[1]) / 2, y: bottom - 5, "text-anchor": "middle" }, svg, "zone: within 5 %");

    for (const rule of best.rules.filter(inRange)) {
      const x = this.#x(rule.size);
      element("title", {}, element("path", { class: "chart-rule", d: `M${x} ${bottom}v8`, "stroke-width": 3 }, svg), `${rule.name}: ${length(rule.size)}`);
    }
    element("text", { class: "chart-faint", x: LEFT, y: bottom + 28 }, svg, "▮ marks: the rules of others");

    for (const [engine, curve] of Object.entries(curves)) {
      const faded = Number(engine) === chosen.engine ? "" : " unchosen";
      const seen = curve.curve.filter((sample) => inRange(sample) && inside(sample));
      const d = seen.map(({ size, ms }, i) => `${i ? "L" : "M"}${this.#x(size).toFixed(1)} ${this.#y(ms).toFixed(1)}`).join("");
      element("path", { class: `chart-line ${NAMES[engine]}-line${faded}`, d }, svg);
      for (const point of points.filter((p) => p.engine === Number(engine) && inRange(p) && inside(p)))
        element("circle", { class: `${NAMES[engine]}-dot${faded}`, cx: this.#x(point.size), cy: this.#y(point.ms), r: 3.5 }, svg);
      const last = seen.at(-1);
      if (last) {
        const name = engine === "1" ? "the paper's" : "fast";
        element("text", { class: `chart-text${faded}`, x: WIDTH - RIGHT - 4, y: this.#y(last.ms) - 7, "text-anchor": "end" }, svg, name);
      }
    }
    element("circle", { class: "chart-best", cx: this.#x(best.size), cy: this.#y(best.ms), r: 8 }, svg);
    element("text", { class: "chart-text", x: this.#x(best.size), y: this.#y(best.ms) + 24, "text-anchor": "middle" }, svg, `predicted best ${length(best.size)}`);
    const x = this.#x(chosen.size);
    element("line", { class: "chart-size", x1: x, x2: x, y1: TOP, y2: bottom, "stroke-dasharray": "4 3" }, svg);
    if (now && inside(now)) element("path", { class: `${NAMES[chosen.engine]}-dot`, d: `M${x} ${this.#y(now.ms) - 7}l7 7l-7 7l-7 -7z` }, svg);
    svg.setAttribute("aria-label",
      `Predicted time of a step against the cell size. It is least, ${time(best.ms)}, at the cell size ${length(best.size)}, and grows to both sides. ` +
      `The line is at ${length(chosen.size)}.`);
  }
}
