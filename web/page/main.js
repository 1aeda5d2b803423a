// The page: controls, what a visitor does with pointer and keys, and the figures beside the bodies. The scene itself runs in worker.js.
import { Chart, hue, length, more, time } from "./chart.js";
import { predictedAt } from "./curve.js";
import { SAMPLES } from "./samples.js";
import { KINDS, TOOL } from "./scene.js";
import { View } from "./view.js";

const DROPPED = KINDS.slice(0, 5); // what the page makes itself
const MOST_LINES = 100; // of the log
const MOST_DOTS = 10; // that stay where the slider was
const ABOUT = {
  1: "One cell size for all bodies, as in the paper: a wrong one costs a multiple.",
  2: "Its cost hardly depends on the size. With cell_size = 0 it gives each body its own.",
};
const find = (id) => document.getElementById(id);
const count = (n) => Math.round(n).toLocaleString("en");

const worker = new Worker(new URL("worker.js", import.meta.url), { type: "module" });
const view = new View(find("view"));
const chart = new Chart(find("chart"));
const parameters = new URLSearchParams(location.search);

let facts = null;
let hash = "";
let curve = null; // of the chosen algorithm
let dots = []; // measured where the slider has been: { size, part: of the predicted time }; the last one is the newest
let swept = new Map(); // sizes, and how many times the time at the best
let sweeping = false;
let engine = 1;
let size = 0;
let followsBest = true; // until the slider is moved
let cellsUntil = 0; // drawn while the slider moves
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
  if (stays) find("loading").hidden = true;
  clearTimeout(bannerTimer);
  if (!stays) bannerTimer = setTimeout(() => (banner.hidden = true), 8000);
  log(text, true);
}

const seen = () => ({ size, cells: find("show-cells").checked || performance.now() < cellsUntil });

function list(id, pairs) {
  find(id).replaceChildren(
    ...pairs.map(([name, value]) => {
      const pair = document.createElement("div");
      pair.append(Object.assign(document.createElement("dt"), { textContent: name }), Object.assign(document.createElement("dd"), { textContent: value }));
      return pair;
    }),
  );
}

function showFacts() {
  list("facts", [
    ["fps", String(framesPerSecond)],
    [facts.contacts === 1 ? "contact" : "contacts", count(facts.contacts)],
    ["touching pairs", count(facts.pairs)],
    ["deepest overlap", facts.deepest.toFixed(3)],
    ...(tool ? [["on the tool", count(facts.touched)]] : []),
    [facts.asleep ? "at rest" : paused ? "paused" : "moving", ""],
  ]);
  list("more-facts", [
    ["tetrahedra", count(facts.tets)],
    ["a step, with motion and depths", time(facts.stepNs / 1e6)],
    ["of it collision detection", time(facts.detectNs / 1e6)],
    ["memory", `${(facts.bytes / 1e6).toFixed(0)} of ${(facts.byteLimit / 1e6).toFixed(0)} MB`],
    ...(seen().cells ? [["cells with vertices", count(view.cellCount)]] : []),
  ]);
  find("hash").textContent = `${hash.slice(0, 8)}…`;
}
find("copy-hash").addEventListener("click", async () => {
  await navigator.clipboard.writeText(hash);
  find("copy-hash").textContent = "Copied";
  setTimeout(() => (find("copy-hash").textContent = "Copy"), 1500);
});

// ---- the cell size ----

const median = (values) => values.toSorted((a, b) => a - b)[values.length >> 1];

/** How many times the predicted times the measured ones are: the height of the curve; its shape is predicted. */
const height = () => (dots.length > 0 ? median(dots.map(({ part }) => part)) : 1);

/** How many times the least time a step takes here: as measured, or else as predicted. */
function factorHere() {
  const here = dots.at(-1);
  return (predictedAt(curve, size) / curve.ms) * (here?.size === size ? here.part / height() : 1);
}

// At most ten times a second.
let costTimer = null;
function showCost() {
  costTimer ??= setTimeout(() => {
    costTimer = null;
    showCostNow();
  }, 100);
}

function showCostNow() {
  if (!curve) return;
  if (followsBest) choose(curve.size);
  const factor = factorHere();
  const fit = height();
  chart.draw({
    curve, size, factor,
    dots: [
      ...dots.map((dot, i) => ({ size: dot.size, factor: ((predictedAt(curve, dot.size) / curve.ms) * dot.part) / fit, age: 1 - (i + 1) / dots.length })).slice(0, -1),
      ...[...swept].map(([at, times]) => ({ size: at, factor: times, swept: true })),
    ],
  });
  const ms = factor * fit * curve.ms;
  document.documentElement.style.setProperty("--heat", String(hue(factor)));
  find("size").style.setProperty("--track", Chart.track(curve));
  find("step-time").textContent = time(ms);
  find("step-factor").textContent = factor < 1.1 ? "the best" : `${factor.toFixed(1)} × the best`;
  find("size").value = String(Math.round(placeOf(size))); // another place now, as the range follows the curve
  const edge = curve.rules[0].size; // the mean edge
  const text = `${length(size)} = ${(size / edge).toFixed(2)} mean edges`;
  find("size-text").textContent = text;
  find("size").setAttribute("aria-valuetext", `${text}, ${factor.toFixed(1)} times the best time`);
  fillTable("terms", curve.work.toSorted((a, b) => b.share - a.share), (term) => [term.name, count(term.count), `${(100 * term.share).toFixed(0)} %`]);
  fillTable("rules", [{ name: "vox", size: curve.size, ms: curve.ms }, ...curve.rules], (rule) => [rule.name, length(rule.size), more(rule.ms / curve.ms)]);
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

function say(text, bad = false) {
  find("verdict").replaceChildren(...(text ? [Object.assign(document.createElement("p"), { textContent: text, className: bad ? "bad" : "" })] : []));
}

// The slider is even in the logarithm of the size.
const sizeAt = (place) => chart.range[0] * (chart.range[1] / chart.range[0]) ** (place / 1000);
const placeOf = (at) => (1000 * Math.log(at / chart.range[0])) / Math.log(chart.range[1] / chart.range[0]);

function choose(chosen) {
  if (chosen === size) return;
  size = chosen;
  playgroundApi.size = size;
  act("choose", { size });
  view.setCells(seen().size, seen().cells);
}

find("size").addEventListener("input", (event) => {
  if (!curve) return;
  followsBest = false;
  cellsUntil = performance.now() + 1500;
  choose(sizeAt(Number(event.target.value)));
  showCostNow();
});
find("best").addEventListener("click", () => {
  followsBest = true;
  cellsUntil = performance.now() + 1500;
  showCostNow();
});
function forget() {
  dots = [];
  swept.clear();
  say("");
}
const settings = () => ({ engine, self: find("self").checked, stiffness: 2e5 * 10 ** Number(find("stiffness").value) });
function configure() {
  act("configure", settings());
  const pascals = settings().stiffness;
  find("stiffness").setAttribute("aria-valuetext", `${count(pascals / 1000)} kilopascals`);
}
for (const id of ["self", "stiffness"]) find(id).addEventListener("change", configure);
for (const input of document.getElementsByName("engine"))
  input.addEventListener("change", () => {
    engine = Number(input.value);
    followsBest = true;
    curve = null;
    forget();
    find("about-engine").textContent = ABOUT[engine];
    configure();
  });
find("about-engine").textContent = ABOUT[engine];
find("sweep").addEventListener("click", () => {
  sweeping = true;
  find("sweep").disabled = true;
  swept.clear();
  say("");
  act("sweep");
});

/** What measuring all sizes has shown. */
function conclude() {
  const all = [...swept];
  if (all.length < 3) return;
  const [best, least] = all.reduce((a, b) => (b[1] < a[1] ? b : a));
  const [worst, most] = all.reduce((a, b) => (b[1] > a[1] ? b : a));
  const chosen = all.reduce((a, b) => (Math.abs(Math.log(b[0] / curve.size)) < Math.abs(Math.log(a[0] / curve.size)) ? b : a));
  say(`Best of ${all.length} sizes: ${length(best)}. Chosen without measuring: ${length(chosen[0])}, ${chosen[0] === best ? "the same" : more(chosen[1] / least)}. ` +
    `Worst: ${length(worst)}, ${(most / least).toFixed(1)} times as long.`);
}

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
    playgroundApi.list = bodies;
    forget(); // what was measured was of other bodies
  },
  came({ origin, frames: near }) {
    if (started) view.show(origin, near);
  },
  frame(frame) {
    facts = frame.facts;
    hash = frame.hash;
    playgroundApi.facts = facts;
    playgroundApi.hash = hash;
    playgroundApi.positions = frame.positions;
    playgroundApi.touched = frame.touched;
    view.setFrame(frame, seen());
  },
  curve(sent) {
    if (sent.engine !== engine) return;
    curve = sent.curve;
    playgroundApi.curve = curve;
    for (const id of ["size", "best"]) find(id).disabled = false;
    find("sweep").disabled = sweeping;
    find("loading").hidden = true;
    showCostNow();
  },
  measured(sent) {
    if (sent.engine !== engine || !curve) return;
    playgroundApi.measured = sent;
    dots = [...dots.filter((dot) => Math.abs(Math.log(dot.size / sent.size)) > 0.04), { size: sent.size, part: sent.ms / predictedAt(curve, sent.size) }].slice(-MOST_DOTS);
    if (sent.same === false) say(`The contacts differ at the cell size ${length(sent.size)}. Please report this.`, true);
    showCost();
  },
  point({ size: at, factor, same, part }) {
    swept.set(at, factor);
    find("sweep").textContent = `Measuring: ${Math.round(100 * part)} %`;
    if (!same) say(`The contacts differ at the cell size ${length(at)}. Please report this.`, true);
    showCost();
  },
  swept({ complete }) {
    sweeping = false;
    find("sweep").disabled = false;
    find("sweep").textContent = "Measure all sizes";
    playgroundApi.swept = [...swept];
    if (complete && !find("verdict").querySelector(".bad")) conclude();
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
  find("pause").textContent = on ? "Resume" : "Pause";
  act("pause", { on });
}

find("drop").addEventListener("click", drop);
find("samples").append(...Object.entries(SAMPLES).map(([name, { make, tets: about }]) => {
  const button = Object.assign(document.createElement("button"), { textContent: name[0].toUpperCase() + name.slice(1) });
  button.addEventListener("click", () => act("file", { name, bytes: new TextEncoder().encode(make()), tets: about, yUp: true, format: "obj" }));
  return button;
}));
find("clear").addEventListener("click", () => act("clear"));
find("pause").addEventListener("click", () => setPaused(!paused));
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
  else act("file", { name: file.name, bytes, tets: tets(), yUp: find("y-up").checked }, [bytes.buffer]);
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
let stroke = null; // where a cut began: { at }
let tool = null; // in the hand: { kind, point, along, moves }

const mode = () => document.querySelector('input[name="mode"]:checked').value;
const hints = { drag: "Drag a body. Drag beside it to orbit.", cut: "Draw a line across bodies.", look: "Drag to orbit, pinch or turn the wheel to zoom.",
  sphere: "Drag the sphere through the bodies.", blade: "Drag the blade through the bodies: it shows the edges that it crosses." };
for (const input of document.getElementsByName("mode"))
  input.addEventListener("change", () => {
    find("hint").textContent = hints[mode()];
    const kind = TOOL[mode()] ?? TOOL.none;
    tool = kind === TOOL.none ? null : { kind, point: view.shifted(view.controls.target.toArray(), 0, 2.4), along: view.aslant };
    view.setTool(kind, tool?.along);
    hold(tool?.point ?? [0, 0, 0]);
  });

function hold(point) {
  if (tool) tool.point = point;
  act("hold", { tool: tool?.kind ?? TOOL.none, point, along: tool?.along ?? [1, 0] });
}

canvas.addEventListener(
  "pointerdown",
  async (event) => {
    canvas.focus({ preventScroll: true });
    if (!event.isPrimary || event.button !== 0) return;
    const ray = view.ray(event.clientX, event.clientY);
    const takes = tool || mode() === "cut" || (mode() === "drag" && view.hits(ray));
    view.controls.enabled = !takes;
    if (!takes) return;
    canvas.setPointerCapture(event.pointerId);
    if (tool) {
      tool.moves = true;
      hold(view.beside(ray, tool.point));
    } else if (mode() === "cut") stroke = { at: [event.clientX, event.clientY] };
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
  if (stroke) drawStroke(stroke.at, [event.clientX, event.clientY]);
  if (tool?.moves) hold(view.beside(view.ray(event.clientX, event.clientY), tool.point));
  if (!held?.point) return;
  held.point = view.beside(view.ray(event.clientX, event.clientY), held.point);
  act("drag", { point: held.point });
});
function pointerEnds(event) {
  view.controls.enabled = true;
  if (held) act("letGo");
  held = null;
  if (tool) tool.moves = false;
  if (stroke && event.type === "pointerup") cutBetween(stroke.at, [event.clientX, event.clientY]);
  stroke = null;
  find("stroke").classList.remove("drawn"); // it fades
}
canvas.addEventListener("pointerup", pointerEnds);
canvas.addEventListener("pointercancel", pointerEnds);

function drawStroke(from, to) {
  const box = canvas.getBoundingClientRect();
  const line = find("stroke").firstElementChild;
  for (const [name, value] of Object.entries({ x1: from[0] - box.left, y1: from[1] - box.top, x2: to[0] - box.left, y2: to[1] - box.top })) line.setAttribute(name, value);
  find("stroke").classList.add("drawn");
}

/** A cut between two places of the page, drawn. */
async function cutBetween(from, to) {
  drawStroke(from, to);
  requestAnimationFrame(() => find("stroke").classList.remove("drawn"));
  const first = view.ray(...from);
  const cut = await ask("cut", { eye: first.from, first: first.to, second: view.ray(...to).to });
  if (cut === 0) log("the line crosses no body");
}

/** A cut from the top to the bottom of the view, through its middle. */
function halve() {
  const box = canvas.getBoundingClientRect();
  const [x] = view.centre;
  return cutBetween([x, box.top], [x, box.bottom]);
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
  } else if (way && tool) hold(view.shifted(tool.point, 0.25 * way[0], 0.25 * way[1]));
  else if (way) view.turn(0.1 * -way[0], 0.1 * -way[1]);
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

let turns = 0; // of the browser, to draw
let slow = 0; // half seconds in a row
function draw() {
  ++turns;
  if (view.draw()) ++frames;
  const label = view.label;
  find("name").hidden = !label;
  if (label) {
    find("name").textContent = label.name;
    Object.assign(find("name").style, { left: `${label.x}px`, top: `${label.y}px` });
  }
  requestAnimationFrame(draw);
}
requestAnimationFrame(draw);
setInterval(() => {
  framesPerSecond = frames * 2;
  playgroundApi.framesPerSecond = framesPerSecond;
  frames = 0;
  slow = turns < 5 && !paused && !document.hidden ? slow + 1 : 0;
  if (slow === 6) view.simplify(); // there is no graphics processor, or a slow one
  turns = 0;
  if (facts) showFacts();
}, 500);

const stands = parameters.has("stopped") || matchMedia("(prefers-reduced-motion: reduce)").matches;

// ---- tabs, where the screen is narrow; light or dark ----

const tabs = [find("tab-cost"), find("tab-play")];
function openTab(tab) {
  for (const other of tabs) {
    other.setAttribute("aria-selected", String(other === tab));
    other.tabIndex = other === tab ? 0 : -1;
  }
  document.body.dataset.tab = tab.getAttribute("aria-controls");
}
for (const tab of tabs) {
  tab.addEventListener("click", () => openTab(tab));
  tab.addEventListener("keydown", (event) => {
    if (event.key !== "ArrowLeft" && event.key !== "ArrowRight") return;
    const other = tabs[1 - tabs.indexOf(tab)];
    openTab(other);
    other.focus();
  });
}

/** As the page around this one says, by ?scheme= or a message, or else as the system does. */
const dark = matchMedia("(prefers-color-scheme: dark)");
function setScheme(scheme) {
  if (scheme === "light" || scheme === "dark") document.documentElement.dataset.scheme = scheme;
  view.setScheme(document.documentElement.dataset.scheme ?? (dark.matches ? "dark" : "light"));
}
dark.addEventListener("change", () => setScheme());
addEventListener("message", ({ source, data }) => source === parent && setScheme(data?.scheme));
setScheme(parameters.get("scheme"));

let started = false; // the first bodies are there

/** What a visitor finds at first. ?scene=empty begins without bodies; for those who want less motion, it stands still. */
function start() {
  if (parameters.get("scene") !== "empty") for (let i = 0; i < 10; ++i) act("drop", { kind: (i + 2) % DROPPED.length, tets: tets() });
  if (stands) {
    setPaused(true);
    log("it stands still, as less motion was asked for: Resume starts it");
  }
  ask("nothing").then(() => (started = true));
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
act("start", { paused: stands, settings: settings(), memory: Number.isFinite(memory) && memory > 0 ? memory : 1e9, ...(parameters.has("plain") && { simd: false }) });
