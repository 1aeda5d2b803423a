// The simulation's thread: steps the scene sixty times a second, measures cell sizes in what time is left, and sends what is to be
// drawn. The page never waits for it.
import { predictedAt } from "./curve.js";
import { ENGINE, FIXED, KINDS, Scene, SceneError, simdSupported } from "./scene.js";

const FRAME_MS = 1000 / 60;

let scene;
let bodies = [];
let paused = false;
let shown = {};
let chosen = { engine: ENGINE.paper, size: 0 };
let curves = {}; // of each engine
let curvesAt = -Infinity;
let measureAfter = 0;
let recent = []; // milliseconds at the chosen size
let changes = 0; // of the bodies
let nextTick = 0;

const send = (type, what = {}, transfer = []) => postMessage({ type, ...what }, transfer);
const log = (text, bad = false) => send("event", { text, bad });

const nameOf = (body) => (body.kind === FIXED ? "the ring on the floor" : `${KINDS[body.kind]} ${body.serial}`);

function sendBodies() {
  bodies = scene.bodies();
  send("bodies", { bodies: bodies.map(({ positions, ...body }) => body) });
  curvesAt = -Infinity;
  recent = [];
  ++changes;
}

function sendFrame() {
  const positions = scene.positions(bodies);
  const arrows = shown.contacts ? scene.penetrations() : null;
  const tiles = shown.tiles ? scene.tiles() : null;
  const windows = shown.windows ? scene.windows() : null;
  const transfer = [positions, arrows, tiles, windows].filter(Boolean).map((array) => array.buffer);
  send("frame", { positions, arrows, tiles, windows, facts: scene.facts(), hash: scene.hash() }, transfer);
}

const gone = new Map(); // names of bodies that events may still be about

function stepOnce() {
  scene.step();
  const touches = scene.touches();
  if (touches.length === 0) return;
  const names = new Map(bodies.map((body) => [body.mesh, nameOf(body)]));
  const name = (mesh) => names.get(mesh) ?? gone.get(mesh) ?? "a body that is gone";
  for (let i = 0; i < touches.length; i += 3)
    log(`${name(touches[i])} ${touches[i + 2] ? "touches" : "leaves"} ${name(touches[i + 1])}`);
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
  for (const body of bodies) gone.set(body.mesh, nameOf(body));
  const result = attempt(act);
  sendBodies();
  sendFrame();
  return result;
}

// ---- the cell size ----

const median = (values) => values.toSorted((a, b) => a - b)[values.length >> 1];

const predict = (engine, size) => predictedAt(curves[engine], size);

function suggestAll() {
  for (const engine of Object.values(ENGINE)) curves[engine] = scene.suggest(engine);
  curvesAt = performance.now();
  send("curves", { curves });
}

/** One measurement, of some milliseconds: clocks of pages are coarse. */
function measure(engine, size) {
  const steps = Math.min(50, Math.max(1, Math.ceil(3 / predict(engine, size))));
  return scene.measure(engine, size, steps);
}

/** Measures the chosen size, for at most a quarter of the time. */
function measureChosen() {
  const now = performance.now();
  if (now < measureAfter) return;
  measureAfter = now + 5000; // if this fails
  if (now - curvesAt > 1000) suggestAll();
  if (!chosen.size) return void (measureAfter = now);
  if (predict(chosen.engine, chosen.size) > 2000) return; // the bodies would stand still for seconds
  const { ms, same } = measure(chosen.engine, chosen.size);
  recent = [...recent, ms].slice(-9);
  send("measured", { ...chosen, ms: median(recent), same });
  measureAfter = performance.now() + 3 * (performance.now() - now);
}

/** Times of many sizes with bodies that stand still, in rounds, so that a disturbance does not hit one size alone. */
async function sweep() {
  suggestAll();
  const before = changes;
  const jobs = [];
  for (const engine of Object.values(ENGINE)) {
    const best = curves[engine].size;
    for (let i = -8; i <= 8; ++i) {
      const size = best * 2 ** (i / 3);
      if (predict(engine, size) < Math.max(60, 40 * curves[engine].ms)) jobs.push({ engine, size, times: [] });
    }
  }
  const rounds = 5;
  for (let round = 0, done = 0; round < rounds; ++round) {
    for (const job of jobs.toSorted((a, b) => ((a.size * 7919 + round * 0.37) % 1) - ((b.size * 7919 + round * 0.37) % 1))) {
      const { ms, same } = measure(job.engine, job.size);
      job.times.push(ms);
      job.same = same && job.same !== false;
      if (++done % 8 === 0) {
        send("sweeping", { part: done / (rounds * jobs.length) });
        await new Promise((go) => setTimeout(go)); // other acts first
        if (changes !== before) throw new SceneError("other bodies came while all sizes were measured: measure again");
      }
    }
  }
  send("swept", { points: jobs.map(({ engine, size, times, same }) => ({ engine, size, ms: median(times), same })) });
}

let sweeping = false;

// ---- the loop ----

function tick() {
  const now = performance.now();
  if (!sweeping) {
    if (!paused) {
      if (!attempt(() => (stepOnce(), true))) { // it would fail again
        paused = true;
        send("stopped");
      }
      sendFrame();
    }
    attempt(measureChosen);
  }
  nextTick = Math.max(nextTick + FRAME_MS, now);
  setTimeout(tick, Math.max(0, nextTick - performance.now()));
}

const acts = {
  async start({ memory, paused: stands, simd = simdSupported() }) {
    paused = stands;
    scene = await Scene.load(new URL(simd ? "playground_simd.wasm" : "playground.wasm", self.location.href), memory);
    sendBodies();
    send("ready", { version: scene.version, simd });
    sendFrame();
    nextTick = performance.now();
    tick();
  },
  drop({ kind, tets }) {
    changed(() => scene.drop(kind, tets));
  },
  file({ name, bytes, tets }) {
    const text = changed(() => scene.dropFile(name, bytes, tets));
    if (text !== undefined) log(text === "" ? `${name} is read` : `${name}: ${text}`);
  },
  clear() {
    changed(() => scene.clear());
  },
  self({ on }) {
    changed(() => scene.setSelfCollision(on));
  },
  pause({ on }) {
    paused = on;
  },
  show(what) {
    shown = what;
    sendFrame();
  },
  choose({ engine, size }) {
    if (engine !== chosen.engine || size !== chosen.size) recent = [];
    chosen = { engine, size };
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
  async sweep() {
    if (sweeping) return;
    sweeping = true;
    try {
      await sweep();
    } catch (error) {
      if (!(error instanceof SceneError)) throw error;
      send("refused", { text: error.message });
      send("swept", { points: [] });
    } finally {
      sweeping = false;
    }
  },
  /** Exactly so many steps, as fast as they go. */
  run({ steps, id }) {
    let stepNs = 0;
    for (let i = 0; i < steps; ++i) {
      stepOnce();
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
