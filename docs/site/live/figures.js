// The live figures of the pages: every element with data-figure="NAME" becomes the figure of that name, in place of the
// picture inside it. All numbers are those of cost_model.js and of the measurements in paper_data.js.

import * as model from "./cost_model.js";
import {models} from "./paper_data.js";
import {bodiesInThePlane, countedOver, meanEdgeOf, stepInThePlane, testShare, triangleInTheMiddle} from "./plane.js";

// ---- small helpers ----

function element(name, attributes = {}, ...children) {
  const made = name.startsWith("svg:") ? document.createElementNS("http://www.w3.org/2000/svg", name.slice(4)) :
                                         document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  made.append(...children);
  return made;
}

let labels = 0;

// A slider with its label and its value in words. `change` gets the number.
function slider(label, from, to, step, value, words, change) {
  const id = `vox-slider-${++labels}`;
  const said = element("output", {"for": id});
  const input = element("input", {type: "range", id, min: from, max: to, step, value});
  const moved = () => {
    said.textContent = words(Number(input.value));
    input.setAttribute("aria-valuetext", said.textContent);
    change(Number(input.value));
  };
  input.addEventListener("input", moved);
  said.textContent = words(value);
  input.setAttribute("aria-valuetext", said.textContent);
  return {
    row: element(
        "div", {class: "vox-slider"},
        element("label", {"for": id}, label),
        input, said
    ),
    input,
    moved
  };
}

const rounded = (value, digits = 3) => Number(value.toPrecision(digits)).toString();
const perCent = (loss) => `${loss < 0 ? "−" : "+"}${(100 * Math.abs(loss)).toFixed(Math.abs(loss) < 0.0995 ? 1 : 0)} %`;

// A chart over cell sizes, evenly in the logarithm: axes, lines, dots and marks.
class Chart {
  constructor(name, from, to, height, xTitle, yTitle) {
    this.from = from;
    this.to = to;
    this.height = height;
    this.svg = element("svg:svg", {viewBox: "0 0 640 320", role: "img", "aria-label": name});
    this.axes = element("svg:g", {class: "vox-axes"});
    this.body = element("svg:g", {});
    this.svg.append(this.axes, this.body);
    for (const tick of [0.25, 0.5, 1, 2, 4, 8].filter((t) => t >= from && t <= to)) {
      this.axes.append(
          element("svg:line", {x1: this.x(tick), x2: this.x(tick), y1: 28, y2: 272}),
          this.text(this.x(tick), 290, String(tick), "middle"),
      );
    }
    for (let tick = 0; tick <= height; ++tick) {
      this.axes.append(
          element("svg:line", {x1: 44, x2: 628, y1: this.y(tick), y2: this.y(tick)}),
          this.text(38, this.y(tick) + 4, String(tick), "end"),
      );
    }
    this.axes.append(this.text(336, 312, xTitle, "middle"), this.text(38, 14, yTitle, "start"));
  }

  x(size) {
    return 44 + (584 * Math.log(size / this.from)) / Math.log(this.to / this.from);
  }

  y(value) {
    return 272 - (244 * Math.min(value, this.height * 1.05)) / this.height;
  }

  text(x, y, words, anchor, kind = "") {
    return element("svg:text", {x, y, "text-anchor": anchor, class: kind}, words);
  }

  clear() {
    this.body.replaceChildren();
  }

  line(points, kind) {
    const path =
        points.filter(([, value]) => value <= this.height * 1.04)
            .map(([size, value], i) => `${i ? "L" : "M"}${this.x(size).toFixed(1)} ${this.y(value).toFixed(1)}`)
            .join("");
    this.body.append(element("svg:path", {d: path, class: `vox-line ${kind}`}));
  }

  dot(size, value, kind) {
    if (value > this.height || size < this.from || size > this.to) return;
    this.body.append(element("svg:circle", {cx: this.x(size), cy: this.y(value), r: 3.5, class: kind}));
  }

  band(from, to, kind) {
    const [left, right] = [Math.max(from, this.from), Math.min(to, this.to)];
    this.body.append(
        element("svg:rect", {x: this.x(left), y: 28, width: this.x(right) - this.x(left), height: 244, class: kind})
    );
  }

  mark(size, kind, words, row = 0) {
    if (size < this.from || size > this.to) return;
    const x = this.x(size);
    this.body.append(element("svg:line", {x1: x, x2: x, y1: 28, y2: 272, class: kind}));
    if (words)
      this.body.append(this.text(x + (x > 560 ? -4 : 4), 42 + 14 * row, words, x > 560 ? "end" : "start", kind));
  }
}

// ---- cells: what a step does, in a plane ----

function cellsFigure(place) {
  const {points, triangles} = bodiesInThePlane();
  const meanEdge = meanEdgeOf(points, triangles);
  const counted = countedOver(points, triangles, meanEdge);
  const best = counted.reduce((least, one) => (one.total < least.total ? one : least));

  const drawing = element("svg:svg", {viewBox: "0 0 18.5 10.6", role: "img", class: "vox-plane"});
  const chart = new Chart(
      "Cells visited, points looked at, and their sum, over cell sizes", 0.25, 8, 4, "cell size, in mean edges",
      "work, least sum = 1"
  );
  const said = element("p", {class: "vox-said", "aria-live": "polite"});
  let cell = 0.6;
  let chosen = triangleInTheMiddle(points, triangles);

  function draw() {
    const size = cell * meanEdge;
    const step = stepInThePlane(points, triangles, size);
    const one = step.each[chosen];
    drawing.replaceChildren();
    drawing.append(element("svg:rect", {
      x: one.low[0] * size,
      y: one.low[1] * size,
      width: (one.high[0] - one.low[0] + 1) * size,
      height: (one.high[1] - one.low[1] + 1) * size,
      class: "vox-covered",
    }));
    const lines = [];
    for (let x = 0; x <= 18.5; x += size) lines.push(`M${x} 0V10.6`);
    for (let y = 0; y <= 10.6; y += size) lines.push(`M0 ${y}H18.5`);
    drawing.append(element("svg:path", {d: lines.join(""), class: "vox-lattice"}));
    triangles.forEach((corners, i) => {
      const triangle = element("svg:path", {
        d: `M${corners.map((c) => points[c].join(" ")).join("L")}Z`,
        class: i === chosen ? "vox-triangle vox-chosen" : "vox-triangle",
      });
      triangle.addEventListener("pointerenter", () => choose(i));
      drawing.append(triangle);
    });
    const looked = new Set(one.found);
    points.forEach(([x, y], i) => drawing.append(element("svg:circle", {
      cx: x,
      cy: y,
      r: looked.has(i) ? 0.17 : 0.08,
      class: looked.has(i) ? "vox-looked" : "vox-point",
    })));
    drawing.setAttribute(
        "aria-label",
        `Two bodies of triangles on a lattice of cells. The box of one triangle covers ${one.covered} cells with ${
            one.found.length} points in them.`
    );
    const work = step.visits + testShare * step.tests;
    const where = cell < best.size * 0.7 ? "Most of the work is visiting cells." :
        cell > best.size * 1.45          ? "Most of the work is looking at points." :
                                           "Both are about balanced.";
    said.replaceChildren(
        element(
            "strong", {},
            `This triangle visits ${one.covered} ${one.covered === 1 ? "cell" : "cells"} and looks at ${
                one.found.length} points.`
        ),
        ` All ${triangles.length} together: ${step.visits} visits, ${step.tests} points; work ${Math.round(work)}, ${
            perCent(work / best.total - 1)} over the best. ${where}`,
    );
    chart.clear();
    for (const kind of ["visits", "tests", "total"])
      chart.line(counted.map((c) => [c.size, c[kind] / best.total]), `vox-${kind}`);
    chart.mark(best.size, "vox-best", "best");
    chart.mark(cell, "vox-here", "");
    chart.dot(cell, work / best.total, "vox-here");
  }

  function choose(i) {
    chosen = i;
    which.input.value = i;
    draw();
  }

  const size =
      slider("Cell size", Math.log2(0.25), 3, 0.01, Math.log2(cell), (v) => inEdges(2 ** v), (v) => {
        cell = 2 ** v;
        draw();
      });
  const which = slider("Triangle", 0, triangles.length - 1, 1, chosen, (v) => `number ${v}`, (v) => {
    chosen = v;
    draw();
  });
  place.replaceChildren(element("div", {class: "vox-figure"}, drawing, size.row, which.row, said, chart.svg, legend([
                                  ["vox-visits", "cells visited"],
                                  ["vox-tests", `points looked at, each ${testShare} of a visit`],
                                  ["vox-total", "together"]
                                ])));
  draw();
}

function inEdges(size) {
  return `${rounded(size)} mean ${rounded(size) === "1" ? "edge" : "edges"}`;
}

function legend(entries) {
  const list = element("ul", {class: "vox-legend"});
  for (const [kind, words] of entries) list.append(element("li", {class: kind}, words));
  return list;
}

// ---- curve: the paper's cost function, its terms, and measured times ----

const ruleNames = {
  suggestion: "the paper's cost function",
  traditional: "mean edge",
  mean_edge_multiple: "twice the mean edge",
  object_512: "512 cells an object",
  mean_volume: "cube root of the mean volume",
  median_box_side: "median box side",
};

function curveFigure(place) {
  const chart = new Chart(
      "The paper's cost function over cell sizes, its two terms, and measured times", 0.25, 8, 4,
      "cell size, in mean edges", "cost and time, least = 1"
  );
  const said = element("p", {class: "vox-said", "aria-live": "polite"});
  const table = element("table", {class: "vox-rules"});
  const state = {
    body: models.find((m) => m.name === "Bunny"),
    cell: 1,
    pNc: model.defaults.pNc,
    ratio: model.defaults.ratio,
    size: 1,
    area: Math.sqrt(3) / 4
  };

  function scene() {
    const {body} = state;
    const size = body ? body.meanEdge : state.size;
    const area = body ? model.areaFrom(size, 4 / body.cellsPerAxis) : state.area;
    return {size, area, pNc: state.pNc, ratio: state.ratio};
  }

  function draw() {
    const now = scene();
    const best = model.bestCellSize(now);
    const least = model.cost(now, best).total;
    const zone = model.zone(now);
    const edges = (size) => size / now.size;
    const here = model.cost(now, state.cell * now.size);
    const measured = state.body?.times ?? [];
    const fastest = Math.min(...measured.map((t) => t.time));
    chart.clear();
    chart.band(edges(zone.min), edges(zone.max), "vox-zone");
    for (const kind of ["visits", "tests", "total"])
      chart.line(
          model.sweep(0.25, 8, 121).map((size) => [size, model.cost(now, size * now.size)[kind] / least]), `vox-${kind}`
      );
    for (const t of measured) chart.dot(edges(t.cellSize), t.time / fastest, "vox-measured");
    chart.mark(edges(best), "vox-best", "least cost");
    chart.mark(1, "vox-rule", "mean edge", 1);
    chart.mark(state.cell, "vox-here", "");
    chart.dot(state.cell, here.total / least, "vox-here");
    const inside = state.cell >= edges(zone.min) && state.cell <= edges(zone.max);
    said.replaceChildren(
        element(
            "strong", {},
            `At ${inEdges(state.cell)} a tetrahedron costs ${rounded(here.total)} visits of a cell, ${
                perCent(here.total / least - 1)} over the least.`
        ),
        ` It covers ${rounded(model.cellsCovered(now, state.cell * now.size))} cells, with ${
            rounded(model.verticesPerCell(now, state.cell * now.size))} vertices in each. ` +
            `Visits ${rounded(here.visits)}, tests ${rounded(here.tests)}. ` +
            `The least, ${rounded(least)}, is at ${inEdges(edges(best))} (cell size ${
                rounded(best, 4)}), the zone of 5 % from ${rounded(edges(zone.min))} to ${rounded(edges(zone.max))}` +
            `${inside ? ": you are in it." : "."}`,
    );
    table.replaceChildren();
    if (measured.length === 0) return;
    table.append(element(
        "thead", {},
        element(
            "tr", {},
            ...["rule", "in mean edges", "cost predicted", "time measured"].map((t) => element("th", {scope: "col"}, t))
        )
    ));
    const rows = measured.filter((t) => t.rule in ruleNames).sort((a, b) => a.time - b.time);
    table.append(element(
        "tbody", {},
        ...rows.map(
            (t) => element(
                "tr", {}, element("th", {scope: "row"}, ruleNames[t.rule]),
                element("td", {}, rounded(edges(t.cellSize))),
                element("td", {}, perCent(model.cost(now, t.cellSize).total / least - 1)),
                element("td", {}, `${t.time.toFixed(2)} ms, ${perCent(t.time / fastest - 1)}`)
            )
        )
    ));
  }

  const cell = slider("Cell size", -2, 3, 0.01, 0, (v) => inEdges(2 ** v), (v) => {
    state.cell = 2 ** v;
    draw();
  });
  const choice = element("select", {id: "vox-body"});
  for (const m of models)
    choice.append(element("option", {value: m.name}, `${m.name}, ${m.tets.toLocaleString("en")} tetrahedra`));
  choice.append(element("option", {value: ""}, "numbers of your own"));
  choice.value = "Bunny";
  const own = element("div", {class: "vox-own", hidden: ""});
  choice.addEventListener("change", () => {
    state.body = models.find((m) => m.name === choice.value);
    own.toggleAttribute("hidden", Boolean(state.body));
    draw();
  });
  for (const [key, words] of [["size", "s, mean edge"], ["area", "A, mean area of a facet"]]) {
    const input =
        element("input", {type: "number", id: `vox-${key}`, value: rounded(state[key], 4), min: 0, step: "any"});
    input.addEventListener("input", () => {
      if (Number(input.value) > 0) state[key] = Number(input.value);
      draw();
    });
    own.append(element("label", {"for": `vox-${key}`}, words), input);
  }
  own.append(element("p", {}, "Both are printed by vox info (mean edge, mean facet area)."));
  const pNc = slider("p_nc, share without a collision", 0.9, 0.999, 0.001, state.pNc, (v) => v.toFixed(3), (v) => {
    state.pNc = v;
    draw();
  });
  const ratio = slider("r, a test in cell visits", 0.2, 20, 0.1, state.ratio, (v) => v.toFixed(1), (v) => {
    state.ratio = v;
    draw();
  });
  place.replaceChildren(element(
      "div", {class: "vox-figure"},
      element(
          "div", {class: "vox-slider"},
          element("label", {"for": "vox-body"}, "Body"),
          choice
      ),
      own, cell.row, pNc.row, ratio.row, chart.svg, legend([
        ["vox-visits", "visiting cells"], ["vox-tests", "testing vertices"], ["vox-total", "z, together"],
        ["vox-measured", "measured time of a step"], ["vox-zone", "zone of 5 %"]
      ]),
      said, table
  ));
  draw();
}

// ---- all bodies at one multiple of the mean edge ----

// The time of a body at a cell size, between the two measured ones, evenly in the logarithms.
function timeAt(body, cellSize) {
  const times = [...body.times].sort((a, b) => a.cellSize - b.cellSize);
  const next = Math.max(1, times.findIndex((t) => t.cellSize >= cellSize));
  const [a, b] = [times[next - 1], times[next]];
  const share = Math.min(1, Math.max(0, Math.log(cellSize / a.cellSize) / Math.log(b.cellSize / a.cellSize)));
  return a.time * (b.time / a.time) ** share;
}

function lossFigure(place) {
  const said = element("p", {class: "vox-said", "aria-live": "polite"});
  const table = element("table", {class: "vox-bars"});

  function draw(edges) {
    const losses =
        models.map((body) => timeAt(body, edges * body.meanEdge) / Math.min(...body.times.map((t) => t.time)) - 1);
    const mean = losses.reduce((sum, loss) => sum + loss, 0) / losses.length;
    said.replaceChildren(element(
        "strong", {},
        `At ${inEdges(edges)} a step takes ${
            perCent(mean)} on average over the best cell size of each body.`
    ));
    table.replaceChildren(element("tbody", {}, ...models.map((body, i) => {
      const bar = element("span", {class: "vox-bar"});
      bar.style.inlineSize = `${Math.min(100, 100 * losses[i])}%`;
      return element(
          "tr", {}, element("th", {scope: "row"}, body.name), element("td", {}, perCent(losses[i])),
          element("td", {}, bar)
      );
    })));
  }

  const cell =
      slider("Cell size", Math.log2(0.5), 2, 0.01, 0, (v) => inEdges(2 ** v), (v) => draw(2 ** v));
  place.replaceChildren(element("div", {class: "vox-figure"}, cell.row, said, table));
  draw(1);
}

const figures = {
  cells: cellsFigure,
  curve: curveFigure,
  loss: lossFigure
};
for (const place of document.querySelectorAll("[data-figure]")) figures[place.dataset.figure](place);
