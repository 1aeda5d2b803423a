// The page: controls, what a visitor does with pointer and keys, and the figures beside the bodies. The scene itself runs in worker.js.
import { Chart, length, time } from "./chart.js";
import { predictedAt } from "./curve.js";
import { KINDS } from "./scene.js";
import { View } from "./view.js";

const DROPPED = KINDS.slice(0, 5); // what the page makes itself
const MOST_LINES = 100; // of the log
const find = (id) => document.getElementById(id);
const count = (n) => Math.round(n).toLocaleString("en");

const worker = new Worker(new URL("worker.js", import.meta.url), { type: "module" });
const view = new View(find("view"));
const chart = new Chart(find("chart"));
const parameters = new URLSearchParams(location.search);

let facts = null;
let hash = "";
let curves = null;
let points = [];
let trail = new Map(); // what was measured where the slider has been, by algorithm and size
let measured = null;
let chosen = { engine: 1, size: 0 };
let followsBest = true; // until the slider is moved
let paused = false;
let waiting = new Map();
let nextReply = 1;
let frames = 0;
let framesPerSecond = 0;

const act = (type, what = {}, transfer = []) => worker.postMessage({ type, ...what }, transfer);
const ask = (type, what = {}) =>
  new Promise((resolve) => {
    waiting.set(nextReply, resolve);
    act(type, { ...what, id: nextReply++ });
  });

// ---- words ----

function log(text, bad = false) {
  const line = document.createElement("li");
  line.textContent = `${facts ? (facts.steps / 60).toFixed(1) : "0.0"} s: ${text}`;
  line.classList.toggle("bad", bad);
  const list = find("log");
  list.prepend(line);
  while (list.children.length > MOST_LINES) list.lastChild.remove();
}

let bannerTimer;
function refuse(text, stays = false) {
  const banner = find("banner");
  banner.textContent = text;
  banner.hidden = false;
  clearTimeout(bannerTimer);
  if (!stays) bannerTimer = setTimeout(() => (banner.hidden = true), 8000);
  log(text, true);
}

function showFacts() {
  const shown = [
    ["tetrahedra", count(facts.tets)],
    ["contacts", count(facts.contacts)],
    ["deepest", facts.deepest.toFixed(3)],
    ["a step", time(facts.stepNs / 1e6)],
    ["of it, collision", time(facts.detectNs / 1e6)],
    ["cell size, by itself", length(facts.cellSize)],
    ["pictures a second", String(framesPerSecond)],
    ["memory", `${(facts.bytes / 1e6).toFixed(0)} of ${(facts.byteLimit / 1e6).toFixed(0)} MB`],
    ["state", facts.asleep ? "asleep: nothing moves" : paused ? "stopped" : "awake"],
    ["hash of all contacts", hash],
  ];
  if (find("show-cells").checked) shown.push(["cells with vertices", count(view.cellCount)]);
  find("facts").replaceChildren(
    ...shown.map(([name, value]) => {
      const pair = document.createElement("div");
      const term = document.createElement("dt");
      term.textContent = name;
      const detail = document.createElement("dd");
      detail.textContent = value;
      pair.append(term, detail);
      return pair;
    }),
  );
}

function paragraph(text) {
  const made = document.createElement("p");
  made.textContent = text;
  return made;
}

const times = (factor) => (factor < 1.095 ? `${Math.max(0, (factor - 1) * 100).toFixed(0)} % more than` : `${factor.toFixed(1)} times`);

// At most ten times a second.
let costTimer = null;
function showCost() {
  costTimer ??= setTimeout(() => {
    costTimer = null;
    showCostNow();
  }, 100);
}

let verdictText = "";
function showCostNow() {
  if (!curves) return;
  const best = curves[chosen.engine];
  if (followsBest) setSize(best.size);
  const now = measured && measured.engine === chosen.engine && measured.size === chosen.size ? measured : null;
  const seen = [...points, ...trail.values()];
  chart.draw({ curves, points: seen, chosen, now });
  find("size").value = String(Math.round(placeOf(chosen.size))); // another place now, as the range follows the curves
  showSize();
  const predicted = predictedAt(best, chosen.size);
  const algorithm = chosen.engine === 1 ? "the paper's algorithm" : "the fast engine";
  const lines = [];
  const least = Math.min(predicted, best.ms);
  const atBest = chosen.size === best.size;
  lines.push(
    `At the cell size ${length(chosen.size)}, ${algorithm} ${now ? `takes ${time(now.ms)}` : "takes … ms"} for a step (predicted: ${time(predicted)}).` +
      (atBest ? " This is the predicted best." : ` That is ${times(predicted / least)} what is predicted at the best size, ${length(best.size)}.`),
  );
  const swept = points.filter((point) => point.engine === chosen.engine);
  const other = seen.find((point) => !point.same);
  if (other) lines.push(`The contacts differ at the cell size ${length(other.size)}: please report this.`);
  else if (seen.length > 0) lines.push("The contacts are the same at every size, bit for bit. Only the time changes.");
  if (swept.length > 2) {
    const fastest = swept.reduce((a, b) => (b.ms < a.ms ? b : a));
    const nearest = swept.reduce((a, b) => (Math.abs(Math.log(b.size / best.size)) < Math.abs(Math.log(a.size / best.size)) ? b : a));
    const slowest = swept.reduce((a, b) => (b.ms > a.ms ? b : a));
    lines.push(
      `Measured: of ${swept.length} sizes, ${length(fastest.size)} was the fastest (${time(fastest.ms)}) and ${length(slowest.size)} the slowest (${time(slowest.ms)}). ` +
        `The predicted best, ${length(nearest.size)}, took ${time(nearest.ms)}, ${nearest === fastest ? "and is the fastest" : `${((nearest.ms / fastest.ms - 1) * 100).toFixed(0)} % more than the fastest`}.`,
    );
  }
  const text = lines.join("\n");
  if (text !== verdictText) {
    verdictText = text;
    find("verdict").replaceChildren(...lines.map(paragraph));
  }
  fillTable("terms", best.work.toSorted((a, b) => b.share - a.share), (term) => [term.name, count(term.count), `${(100 * term.share).toFixed(0)} %`]);
  fillTable("rules", [{ name: "predicted best", size: best.size, ms: best.ms }, ...best.rules], (rule) => [rule.name, length(rule.size), time(rule.ms)]);
}

function fillTable(id, rows, cells) {
  find(id).tBodies[0].replaceChildren(
    ...rows.map((row) => {
      const line = document.createElement("tr");
      for (const text of cells(row)) line.append(Object.assign(document.createElement("td"), { textContent: text }));
      return line;
    }),
  );
}

// ---- the slider: even in the logarithm of the size ----

const sizeAt = (place) => chart.range[0] * (chart.range[1] / chart.range[0]) ** (place / 1000);
const placeOf = (size) => (1000 * Math.log(size / chart.range[0])) / Math.log(chart.range[1] / chart.range[0]);

function setSize(size) {
  if (size === chosen.size) return;
  chosen = { ...chosen, size };
  act("choose", chosen);
}

function showSize() {
  const edge = curves[chosen.engine].rules[0].size; // the mean edge
  const text = `${length(chosen.size)}, ${(chosen.size / edge).toFixed(2)} mean edges`;
  find("size-text").textContent = text;
  find("size").setAttribute("aria-valuetext", text);
}

find("size").addEventListener("input", (event) => {
  if (!curves) return;
  followsBest = false;
  setSize(sizeAt(Number(event.target.value)));
  showSize();
  showCost();
});
find("best").addEventListener("click", () => {
  followsBest = true;
  showCostNow();
});
for (const input of document.getElementsByName("engine"))
  input.addEventListener("change", () => {
    chosen = { ...chosen, engine: Number(input.value) };
    act("choose", chosen);
    showCost();
  });
find("sweep").addEventListener("click", () => {
  find("sweep").disabled = true;
  points = [];
  trail.clear();
  log("all sizes are measured, with bodies that stand still meanwhile");
  act("sweep");
});

// ---- what the worker says ----

const heard = {
  ready({ version, simd }) {
    log(`vox ${version}, ${simd ? "with" : "without"} SIMD`);
    act("show", shownParts());
    playgroundApi.ready = true;
    start();
  },
  bodies({ bodies }) {
    view.setBodies(bodies);
    playgroundApi.bodies = bodies.length;
    points = []; // of other bodies
    trail.clear();
    measured = null;
  },
  frame(frame) {
    facts = frame.facts;
    hash = frame.hash;
    playgroundApi.facts = facts;
    playgroundApi.hash = hash;
    playgroundApi.positions = frame.positions;
    view.setFrame(frame, find("show-cells").checked ? chosen.size : 0);
  },
  curves(sent) {
    curves = sent.curves;
    playgroundApi.curves = curves;
    showCostNow();
  },
  measured(sent) {
    measured = sent;
    playgroundApi.measured = sent;
    trail.set(`${sent.engine} ${sent.size}`, sent);
    if (trail.size > 200) trail.delete(trail.keys().next().value);
    showCost();
  },
  sweeping({ part }) {
    find("sweep").textContent = `Measuring: ${Math.round(100 * part)} %`;
  },
  swept(sent) {
    points = sent.points;
    playgroundApi.points = points;
    find("sweep").disabled = false;
    find("sweep").textContent = "Measure all sizes";
    showCost();
  },
  event({ text, bad }) {
    log(text, bad);
  },
  stopped() {
    setPaused(true);
  },
  refused({ text }) {
    refuse(text);
  },
  broken({ text }) {
    refuse(`The scene has stopped: ${text}. Load the page again.`, true);
  },
  reply({ id, value }) {
    waiting.get(id)(value);
    waiting.delete(id);
  },
};
worker.onmessage = ({ data }) => heard[data.type](data);
worker.onerror = (event) => refuse(`The scene cannot run here: ${event.message ?? "its thread did not start"}`, true);

// ---- buttons ----

find("kind").append(...DROPPED.map((name, i) => Object.assign(document.createElement("option"), { value: i, textContent: name })));

const tets = () => Number(find("tets").value);
const drop = () => act("drop", { kind: Number(find("kind").value), tets: tets() });
function setPaused(on) {
  paused = on;
  find("pause").setAttribute("aria-pressed", String(on));
  find("pause").textContent = on ? "Go on" : "Stop";
  act("pause", { on });
}

find("drop").addEventListener("click", drop);
find("clear").addEventListener("click", () => act("clear"));
find("pause").addEventListener("click", () => setPaused(!paused));
find("self").addEventListener("change", (event) => act("self", { on: event.target.checked }));
const shownParts = () => ({
  contacts: find("show-contacts").checked,
  tiles: find("show-tiles").checked,
  windows: find("show-windows").checked,
});
for (const id of ["show-contacts", "show-cells", "show-tiles", "show-windows"])
  find(id).addEventListener("change", () => act("show", shownParts()));

find("save").addEventListener("click", async () => {
  const saved = await ask("save");
  if (!saved) return;
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([saved.bytes], { type: "application/octet-stream" }));
  link.download = "playground.vox";
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
});

async function takeFile(file) {
  let bytes;
  try {
    bytes = new Uint8Array(await file.arrayBuffer());
  } catch (error) { // it is too large, or gone
    return refuse(`${file.name}: ${error.message}`);
  }
  if (file.name.endsWith(".vox")) act("restore", { name: file.name, bytes }, [bytes.buffer]);
  else act("file", { name: file.name, bytes, tets: tets() }, [bytes.buffer]);
  return undefined;
}
for (const id of ["file", "snapshot"])
  find(id).addEventListener("change", async (event) => {
    for (const file of event.target.files) await takeFile(file);
    event.target.value = "";
  });
document.addEventListener("dragover", (event) => event.preventDefault());
document.addEventListener("drop", async (event) => {
  event.preventDefault();
  for (const file of event.dataTransfer.files) await takeFile(file);
});

// ---- pointer ----

const canvas = find("view");
let held = null; // the point that is dragged
let stroke = null; // where a cut began

const mode = () => document.querySelector('input[name="mode"]:checked').value;
const hints = { drag: "Drag a body. Drag beside it to turn the view.", cut: "Draw a line across bodies.", look: "Drag to turn the view, pinch or turn the wheel to come nearer." };
for (const input of document.getElementsByName("mode")) input.addEventListener("change", () => (find("hint").textContent = hints[mode()]));

canvas.addEventListener(
  "pointerdown",
  async (event) => {
    canvas.focus({ preventScroll: true });
    if (!event.isPrimary || event.button !== 0) return;
    const ray = view.ray(event.clientX, event.clientY);
    const takes = mode() === "cut" || (mode() === "drag" && view.hits(ray));
    view.controls.enabled = !takes;
    if (!takes) return;
    canvas.setPointerCapture(event.pointerId);
    if (mode() === "cut") stroke = ray;
    else {
      held = { pending: true };
      const point = await ask("grab", ray);
      held = held && point ? { point } : null;
      if (!held) act("letGo");
    }
  },
  { capture: true }, // before the view's own
);
canvas.addEventListener("pointermove", (event) => {
  if (!held?.point) return;
  held.point = view.beside(view.ray(event.clientX, event.clientY), held.point);
  act("drag", { point: held.point });
});
function pointerEnds(event) {
  view.controls.enabled = true;
  if (held) act("letGo");
  held = null;
  if (stroke && event.type === "pointerup") cutBetween(stroke, view.ray(event.clientX, event.clientY));
  stroke = null;
}
canvas.addEventListener("pointerup", pointerEnds);
canvas.addEventListener("pointercancel", pointerEnds);

async function cutBetween(first, second) {
  const cut = await ask("cut", { eye: first.from, first: first.to, second: second.to });
  if (cut === 0) log("the line crosses no body");
}

/** A cut from the top to the bottom of the view, through its middle. */
function halve() {
  const box = canvas.getBoundingClientRect();
  const [x] = view.centre;
  return cutBetween(view.ray(x, box.top), view.ray(x, box.bottom));
}
find("halve").addEventListener("click", halve);

// ---- keys, while the view has the focus ----

const ways = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
canvas.addEventListener("keydown", async (event) => {
  if (event.ctrlKey || event.metaKey || event.altKey) return;
  const way = ways[event.key];
  if (way && held?.point) {
    held.point = view.shifted(held.point, 0.25 * way[0], 0.25 * way[1]);
    act("drag", { point: held.point });
  } else if (way) view.turn(0.1 * -way[0], 0.1 * -way[1]);
  else if (event.key === "+" || event.key === "=") view.approach(0.9);
  else if (event.key === "-") view.approach(1 / 0.9);
  else if (event.key === " ") setPaused(!paused);
  else if (event.key === "d" || event.key === "D") drop();
  else if (event.key === "c" || event.key === "C") halve();
  else if (event.key === "g" || event.key === "G" || (event.key === "Escape" && held)) {
    if (held) {
      act("letGo");
      held = null;
    } else {
      const point = await ask("grab", view.ray(...view.centre));
      held = point && { point };
      log(point ? "holds the body in the middle: arrow keys move it, G lets go" : "there is no body in the middle of the view");
    }
  } else return;
  event.preventDefault();
});

// ---- drawing ----

function draw() {
  if (view.draw()) ++frames;
  requestAnimationFrame(draw);
}
requestAnimationFrame(draw);
setInterval(() => {
  framesPerSecond = frames * 2;
  playgroundApi.framesPerSecond = framesPerSecond;
  frames = 0;
  if (facts) showFacts();
}, 500);

const stands = parameters.has("stopped") || matchMedia("(prefers-reduced-motion: reduce)").matches;

/** What a visitor finds at first. ?scene=empty begins without bodies; for those who want less motion, it stands still. */
function start() {
  if (parameters.get("scene") !== "empty") for (let i = 0; i < 10; ++i) act("drop", { kind: i % DROPPED.length, tets: tets() });
  if (stands) {
    setPaused(true);
    log("it stands still, as less motion was asked for: Go on starts it");
  }
}

/** For programs, and for the console: what the page knows, and acts by name. */
const playgroundApi = {
  act,
  ask,
  view,
  ready: false,
  get held() {
    return held;
  },
};
globalThis.playground = playgroundApi;

const memory = Number(parameters.get("memory") ?? 1000) * 1e6;
act("start", { paused: stands, memory: Number.isFinite(memory) && memory > 0 ? memory : 1e9, ...(parameters.has("plain") && { simd: false }) });
