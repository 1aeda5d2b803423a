// The simulation's thread: steps the scene sixty times a second, with the algorithm and the cell size that were chosen, and sends what is
// to be drawn and how long a step took. The page never waits for it.
import { predictedAt } from "./curve.js";
import { ENGINE, KINDS, Scene, SceneError, simdSupported } from "./scene.js";

const FRAME_MS = 1000 / 60;
const ROUNDS = 3; // of measuring all sizes
const MORE_ROUNDS = 10; // of the fastest

let scene;
let bodies = [];
let names = new Map(); // by the origin of bodies
let paused = false;
let shown = {};
let settings = { engine: ENGINE.paper, self: false, stiffness: 2e5 };
let size = 0;
let curve = null; // of the engine, for the bodies as they were at curveAt
let curveAt = -Infinity;
let curveSteps = -1;
let recent = []; // milliseconds at the chosen size
let measureAfter = 0;
let sweep = null; // { jobs, round, next } while all sizes are measured
let nextTick = 0;

const send = (type, what = {}, transfer = []) => postMessage({ type, ...what }, transfer);
const log = (text, bad = false) => send("event", { text, bad });

/** The mean of the middle half: no disturbance counts, and clocks that are coarser than a step do no harm. */
function middle(values) {
  const half = values.toSorted((a, b) => a - b).slice(values.length >> 2, values.length - (values.length >> 2));
  return half.reduce((sum, value) => sum + value, 0) / half.length;
}

function sendBodies() {
  bodies = scene.bodies();
  send("bodies", { bodies: bodies.map(({ positions, ...body }) => ({ ...body, name: names.get(body.origin) })) });
  curve = null;
  recent = [];
  if (sweep) endSweep("Other bodies came. Measure again.");
}

function sendFrame() {
  const positions = scene.positions(bodies);
  const contacts = shown.contacts ? scene.penetrations() : null;
  const touched = shown.contacts ? scene.touched() : null;
  const tiles = shown.tiles ? scene.tiles() : null;
  const windows = shown.windows ? scene.windows() : null;
  const transfer = [positions, contacts, touched, tiles, windows].filter(Boolean).map((array) => array.buffer);
  send("frame", { positions, contacts, touched, tiles, windows, facts: scene.facts(), hash: scene.hash() }, transfer);
}

/** What a failed act says. The scene is as it was before. */
function attempt(act) {
  try {
    return act();
  } catch (error) {
    if (!(error instanceof SceneError) && !(error instanceof RangeError)) throw error;
    send("refused", { text: error.message });
    return undefined;
  }
}

function changed(act) {
  const result = attempt(act);
  sendBodies();
  sendFrame();
  return result;
}

function dropped(act, name, frames) {
  const text = attempt(act);
  if (text !== undefined) {
    const { origin } = scene.bodies().at(-1);
    names.set(origin, name(origin));
    send("came", { origin, frames });
  }
  sendBodies();
  sendFrame();
  return text;
}

// ---- the cell size ----

/** The curve of the bodies as they are, at most once a second. */
function suggest() {
  const { steps } = scene.facts();
  if (curve && (performance.now() < curveAt + 1000 || steps === curveSteps)) return;
  curve = scene.suggest(settings.engine);
  curveAt = performance.now();
  curveSteps = steps;
  send("curve", { engine: settings.engine, curve });
}

/** Some milliseconds long, as clocks of pages are coarse. */
function measure(at) {
  const steps = Math.min(50, Math.max(1, Math.ceil(3 / predictedAt(curve, at))));
  return scene.measure(settings.engine, at, steps);
}

function tell(ms, same) {
  recent = [...recent, ms].slice(-20);
  const typical = middle(recent);
  if (typical > 0) send("measured", { engine: settings.engine, size, ms: typical, same });
}

/** While nothing moves: the time of a step of a grid of its own, for a quarter of the time. */
function measureStanding() {
  const begin = performance.now();
  if (begin < measureAfter || predictedAt(curve, size) > 2000) return;
  measureAfter = begin + 5000; // if this fails
  const { ms, same } = measure(size);
  tell(ms, same);
  measureAfter = performance.now() + 3 * (performance.now() - begin);
}

function beginSweep() {
  const jobs = [];
  for (let i = -8; i <= 8; ++i) jobs.push({ size: curve.size * 2 ** (i / 3), here: Infinity, best: Infinity });
  sweep = { best: curve.size, jobs: jobs.filter((job) => predictedAt(curve, job.size) < Math.max(60, 40 * curve.ms)), round: 0, next: 0, after: 0 };
}

/** One size, right after the best, so that neither the pose nor a busy machine counts. A quarter of the time. */
function measureNext() {
  const begin = performance.now();
  if (begin < sweep.after) return;
  const { jobs } = sweep;
  const job = jobs[(7 * sweep.next) % jobs.length]; // those next to each other at different times
  const best = measure(sweep.best);
  const here = job.size === sweep.best ? best : measure(job.size);
  job.best = Math.min(job.best, best.ms);
  job.here = Math.min(job.here, here.ms);
  send("point", { size: job.size, factor: job.here / job.best, same: here.same && best.same, part: Math.min(1, (sweep.round * jobs.length + sweep.next + 1) / (ROUNDS * jobs.length)) });
  if (++sweep.next === jobs.length) {
    sweep.next = 0;
    // The least of many noisy times is too good to be true, so it is measured anew.
    if (++sweep.round === ROUNDS) sweep.jobs = [{ size: jobs.reduce((a, b) => (b.here / b.best < a.here / a.best ? b : a)).size, here: Infinity, best: Infinity }];
    if (sweep.round === ROUNDS + MORE_ROUNDS) return endSweep();
  }
  sweep.after = performance.now() + 3 * (performance.now() - begin);
}

function endSweep(text) {
  sweep = null;
  if (text) send("refused", { text });
  send("swept", { complete: !text });
}

// ---- the loop ----

function tick() {
  const now = performance.now();
  if (!paused) {
    const { steps } = scene.facts();
    if (!attempt(() => (scene.step(), true))) { // it would fail again
      paused = true;
      send("stopped");
    }
    sendFrame();
    const facts = scene.facts();
    if (facts.steps > steps && size && !sweep) tell(facts.gridNs / 1e6);
  }
  attempt(() => {
    suggest();
    if (sweep) measureNext();
    else if (size && (paused || scene.facts().asleep)) measureStanding();
  });
  nextTick = Math.max(nextTick + FRAME_MS, now);
  setTimeout(tick, Math.max(0, nextTick - performance.now()));
}

const acts = {
  async start({ memory, paused: stands, settings: first, simd = simdSupported() }) {
    paused = stands;
    scene = await Scene.load(new URL(simd ? "playground_simd.wasm" : "playground.wasm", self.location.href), memory);
    settings = first;
    scene.configure(settings);
    names.set(scene.bodies()[0].origin, "the ring on the floor");
    sendBodies();
    send("ready", { version: scene.version, simd });
    sendFrame();
    nextTick = performance.now();
    setTimeout(tick); // after the first bodies
  },
  drop({ kind, tets }) {
    dropped(() => scene.drop(kind, tets), (origin) => `${KINDS[kind]} ${origin}`, false);
  },
  file({ name, bytes, tets, yUp, format }) {
    const text = dropped(() => scene.dropFile(format ? `${name}.${format}` : name, bytes, tets, yUp), () => name, true);
    if (text !== undefined) log(text === "" ? `${name} is read` : `${name}: ${text}`);
  },
  nothing({ id }) {
    send("reply", { id });
  },
  clear() {
    changed(() => scene.clear());
  },
  configure(what) {
    if (changed(() => (scene.configure(what), true))) settings = what;
  },
  pause({ on }) {
    paused = on;
  },
  show(what) {
    shown = what;
    sendFrame();
  },
  choose({ size: chosen }) {
    if (chosen !== size) recent = [];
    size = chosen;
    scene.setCellSize(size);
    measureAfter = 0;
  },
  grab({ from, to, id }) {
    send("reply", { id, value: attempt(() => scene.grab(from, to)) ?? null });
  },
  drag({ point }) {
    scene.drag(point);
  },
  letGo() {
    scene.letGo();
  },
  hold({ tool, point, along }) {
    attempt(() => scene.hold(tool, point, along));
  },
  cut({ eye, first, second, id }) {
    const count = changed(() => scene.cut(eye, first, second));
    if (count) log(`${count} ${count === 1 ? "body" : "bodies"} cut`);
    send("reply", { id, value: count ?? 0 });
  },
  save({ id }) {
    const saved = attempt(() => scene.save());
    if (saved) log(`snapshot: its contacts have the hash ${saved.hash}`);
    send("reply", { id, value: saved ?? null }, saved ? [saved.bytes.buffer] : []);
  },
  restore({ name, bytes }) {
    if (changed(() => (scene.restore(bytes), true))) log(`${name} is shown; its bodies rest in the shape that they have there`);
  },
  sweep() {
    attempt(() => (suggest(), beginSweep()));
  },
  /** Exactly so many steps, as fast as they go. */
  run({ steps, id }) {
    let stepNs = 0;
    for (let i = 0; i < steps; ++i) {
      scene.step();
      stepNs += scene.facts().stepNs;
    }
    sendFrame();
    send("reply", { id, value: { hash: scene.hash(), facts: scene.facts(), stepMs: stepNs / steps / 1e6 } });
  },
};

self.onmessage = ({ data }) => {
  Promise.resolve()
    .then(() => acts[data.type](data))
    .catch((error) => send("broken", { text: String(error?.message ?? error) }));
};
