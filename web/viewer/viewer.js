// Draws the bodies and contacts of a file that `vox collide -o x.html` has written. Plain WebGL: the file needs nothing but itself.
import { COLOURS, CONTACT, PALETTE, contactDots, cornerNormals, cornersOf } from "./look.js";

const data = JSON.parse(document.getElementById("data").textContent);
const bytesOf = (text) => Uint8Array.from(atob(text), (char) => char.charCodeAt(0)).buffer;
const rgb = (hex) => [16, 8, 0].map((shift) => ((hex >> shift) & 255) / 255);
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const canvas = document.getElementById("view");
const gl = canvas.getContext("webgl2", { antialias: true, alpha: false });
const facts = document.getElementById("facts");

// ---- programs and arrays, with the names that three.js gives to what it hands to a shader ----

const matrices = "precision highp float; attribute vec3 position; uniform mat4 modelViewMatrix, projectionMatrix;";
const surface = {
  vertexShader: `attribute vec3 normal; varying vec3 upright;
    void main() { upright = mat3(modelViewMatrix) * normal; gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }`,
  fragmentShader: `varying vec3 upright; uniform vec3 color;
    void main() {
      vec3 n = normalize(gl_FrontFacing ? upright : -upright);
      gl_FragColor = vec4(color * (0.5 + 0.15 * n.y + 0.5 * max(dot(n, normalize(vec3(0.4, 0.7, 0.8))), 0.0)), 1.0);
    }`,
};
const line = {
  vertexShader: "void main() { gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }",
  fragmentShader: "uniform vec3 color; uniform float opacity; void main() { gl_FragColor = vec4(color, opacity); }",
};

function programOf({ vertexShader, fragmentShader }) {
  const program = gl.createProgram();
  for (const [kind, text] of [[gl.VERTEX_SHADER, matrices + vertexShader], [gl.FRAGMENT_SHADER, `precision highp float; ${fragmentShader}`]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
  return program;
}

function bufferOf(values, target = gl.ARRAY_BUFFER) {
  const buffer = gl.createBuffer();
  gl.bindBuffer(target, buffer);
  gl.bufferData(target, values, gl.STATIC_DRAW);
  return buffer;
}

/** Draws `count` of an index, or of the vertices. Attributes: { name: [buffer, numbers of a vertex] }; uniforms: numbers or lists. */
function draw(program, mode, attributes, uniforms, count, index) {
  gl.useProgram(program);
  for (const [name, [buffer, width]] of Object.entries(attributes)) {
    const at = gl.getAttribLocation(program, name);
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.enableVertexAttribArray(at);
    gl.vertexAttribPointer(at, width, gl.FLOAT, false, 0, 0);
  }
  for (const [name, value] of Object.entries(uniforms)) {
    const at = gl.getUniformLocation(program, name);
    if (value.length === 16) gl.uniformMatrix4fv(at, false, value);
    else if (value.length === 3) gl.uniform3fv(at, value);
    else gl.uniform1f(at, value);
  }
  gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, index ?? null);
  if (index) gl.drawElements(mode, count, gl.UNSIGNED_INT, 0);
  else gl.drawArrays(mode, 0, count);
  for (const name of Object.keys(attributes)) gl.disableVertexAttribArray(gl.getAttribLocation(program, name));
}

// ---- what is drawn ----

let reach = 0; // of the farthest vertex from the middle, where the file has its origin

function bodyOf({ name, positions: text, triangles: corners }, place) {
  const positions = new Float32Array(bytesOf(text));
  const { vertices, index, edges } = cornersOf({ triangles: new Uint32Array(bytesOf(corners)), uncut: Infinity }, positions);
  const at = new Float32Array(3 * vertices.length).map((_, i) => positions[3 * vertices[Math.floor(i / 3)] + (i % 3)]);
  const normals = cornerNormals(index, at);
  for (let i = 0; i < positions.length; i += 3) reach = Math.max(reach, Math.hypot(positions[i], positions[i + 1], positions[i + 2]));
  const colour = PALETTE[place % PALETTE.length];
  return {
    name, colour, box: labelled(name, colour),
    position: bufferOf(at), normal: bufferOf(normals),
    index: bufferOf(index, gl.ELEMENT_ARRAY_BUFFER), corners: index.length,
    edges: bufferOf(Uint32Array.from(edges), gl.ELEMENT_ARRAY_BUFFER), ends: edges.length,
  };
}

/** A checked box beside words. */
function labelled(words, colour) {
  const label = document.createElement("label");
  const box = Object.assign(document.createElement("input"), { type: "checkbox", checked: colour !== undefined });
  const swatch = document.createElement("i");
  if (colour !== undefined) swatch.style.background = `#${colour.toString(16).padStart(6, "0")}`;
  label.append(box, " ", swatch, ` ${words}`);
  facts.append(label);
  box.addEventListener("change", redraw);
  return box;
}

const numbers = new Float32Array(bytesOf(data.contacts)); // of each contact: where, and the way out
const count = numbers.length / 6;
const contacts = Array.from({ length: count }, (_, i) => numbers.subarray(6 * i, 6 * i + 6))
  .map(([x, y, z, ...way]) => ({ point: [x, y, z], end: [x + way[0], y + way[1], z + way[2]], depth: Math.hypot(...way) }))
  .sort((a, b) => a.depth - b.depth); // so that the deepest are on top
const deepest = contacts.at(-1);
const isDeep = count > 0 && deepest.depth > 0;
const label = document.getElementById("deepest");
label.textContent = isDeep ? `deepest: ${deepest.depth.toPrecision(4)}` : "";
label.hidden = !isDeep;

// ---- camera ----

const camera = { theta: -0.9, phi: 0.5, distance: 1, target: [0, 0, 0] };

function axesOf({ theta, phi }, yUp) {
  const turned = ([x, y, z]) => (yUp ? [x, z, -y] : [x, y, z]);
  const [s, c, t, d] = [Math.sin(theta), Math.cos(theta), Math.sin(phi), Math.cos(phi)];
  return [[-s, c, 0], [-t * c, -t * s, d], [d * c, d * s, t]].map(turned); // right, up, back
}

function matricesOf(axes, aspect) {
  const { distance, target } = camera;
  const [right, up, back] = axes;
  const near = Math.max(0.003 * reach, distance - 4 * reach);
  const far = distance + 4 * reach;
  const f = 1 / Math.tan((aspect < 1 ? 26 : 20) * (Math.PI / 180));
  return {
    modelViewMatrix: [
      ...[0, 1, 2].flatMap((i) => [right[i], up[i], back[i], 0]), -dot(right, target), -dot(up, target), -dot(back, target) - distance, 1],
    projectionMatrix: [f / aspect, 0, 0, 0, 0, f, 0, 0, 0, 0, (far + near) / (near - far), -1, 0, 0, (2 * far * near) / (near - far), 0],
  };
}

function placeLabel({ modelViewMatrix: m, projectionMatrix: p }) {
  if (!isDeep) return;
  const { point } = deepest;
  const [x, y, z] = [0, 1, 2].map((row) => m[row] * point[0] + m[4 + row] * point[1] + m[8 + row] * point[2] + m[12 + row]);
  label.style.left = `${50 - (50 * p[0] * x) / z}%`;
  label.style.top = `${50 + (50 * p[5] * y) / z}%`;
  label.hidden = z >= 0;
}

const dark = matchMedia("(prefers-color-scheme: dark)");
let waiting = false;

function redraw() {
  if (!waiting) requestAnimationFrame(render);
  waiting = true;
}

function render() {
  waiting = false;
  const ratio = Math.min(devicePixelRatio, 2);
  canvas.width = Math.max(1, canvas.clientWidth * ratio);
  canvas.height = Math.max(1, canvas.clientHeight * ratio);
  gl.viewport(0, 0, canvas.width, canvas.height);
  gl.clearColor(...rgb(COLOURS[dark.matches ? "dark" : "light"].sky), 1);
  gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
  const seen = matricesOf(axesOf(camera, yUp.checked), canvas.width / canvas.height);
  gl.enable(gl.DEPTH_TEST);
  for (const { box, position, normal, index, corners, edges, ends, colour } of bodies.filter((body) => body.box.checked)) {
    gl.enable(gl.POLYGON_OFFSET_FILL); // for the edges
    draw(programs.surface, gl.TRIANGLES, { position: [position, 3], normal: [normal, 3] }, { ...seen, color: rgb(colour) }, corners, index);
    gl.disable(gl.POLYGON_OFFSET_FILL);
    draw(programs.line, gl.LINES, { position: [position, 3] }, { ...seen, color: [0, 0, 0], opacity: 0.16 }, ends, edges);
  }
  gl.disable(gl.DEPTH_TEST); // contacts are inside of bodies
  const color = rgb(CONTACT);
  draw(programs.line, gl.LINES, { position: [buffers.ways, 3] }, { ...seen, color, opacity: 0.4 }, 2 * count);
  draw(programs.dots, gl.POINTS, { position: [buffers.where, 3], depth: [buffers.depths, 1] },
    { ...seen, color, scale: ratio, full: isDeep ? deepest.depth : 1 }, count);
  placeLabel(seen);
}

// ---- pointers and keys ----

function orbit(x, y) {
  camera.theta -= x;
  camera.phi = Math.min(1.55, Math.max(-1.55, camera.phi + y));
  redraw();
}

function approach(factor) {
  camera.distance = Math.min(20 * reach, Math.max(0.01 * reach, camera.distance * factor));
  redraw();
}

function shift(x, y) {
  const [right, up] = axesOf(camera, yUp.checked);
  const scale = (0.73 * camera.distance) / canvas.clientHeight;
  camera.target = camera.target.map((value, i) => value + scale * (y * up[i] - x * right[i]));
  redraw();
}

const pointers = new Map();
const apart = () => {
  const [a, b] = [...pointers.values()];
  return Math.hypot(a.clientX - b.clientX, a.clientY - b.clientY);
};
canvas.addEventListener("pointerdown", (event) => {
  canvas.setPointerCapture(event.pointerId);
  pointers.set(event.pointerId, event);
});
canvas.addEventListener("pointermove", (event) => {
  const before = pointers.get(event.pointerId);
  if (!before) return;
  const [x, y] = [event.clientX - before.clientX, event.clientY - before.clientY];
  const gap = pointers.size === 2 ? apart() : 0;
  pointers.set(event.pointerId, event);
  if (pointers.size === 2) {
    approach(gap / Math.max(apart(), 1));
    shift(x / 2, y / 2);
  } else if (event.buttons === 2 || event.shiftKey) shift(x, y);
  else orbit(0.007 * x, 0.007 * y);
});
for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, (event) => pointers.delete(event.pointerId));
canvas.addEventListener("contextmenu", (event) => event.preventDefault());
canvas.addEventListener("wheel", (event) => {
  event.preventDefault();
  approach(Math.exp(Math.sign(event.deltaY) * Math.min(Math.abs(event.deltaY), 100) * 0.0015));
}, { passive: false });
const KEYS = {
  ArrowLeft: () => orbit(-0.1, 0), ArrowRight: () => orbit(0.1, 0), ArrowUp: () => orbit(0, 0.1), ArrowDown: () => orbit(0, -0.1),
  "+": () => approach(0.9), "-": () => approach(1 / 0.9),
};
canvas.addEventListener("keydown", (event) => {
  if (!KEYS[event.key]) return;
  event.preventDefault();
  KEYS[event.key]();
});

// ---- begin ----

const summary = facts.querySelector("p");
if (!gl) throw new Error((summary.textContent = "This browser has no WebGL 2, so it cannot draw the bodies."));
summary.textContent = `${count} ${count === 1 ? "contact" : "contacts"}${isDeep ? `, the deepest ${deepest.depth.toPrecision(4)} inside` : ""}`;
const programs = { surface: programOf(surface), line: programOf(line), dots: programOf(contactDots) };
const buffers = {
  where: bufferOf(Float32Array.from(contacts.flatMap(({ point }) => point))),
  ways: bufferOf(Float32Array.from(contacts.flatMap(({ point, end }) => [...point, ...end]))),
  depths: bufferOf(Float32Array.from(contacts.map(({ depth }) => depth))),
};
const bodies = data.bodies.map(bodyOf);
const yUp = labelled("y is up");
reach ||= 1;
camera.distance = 3.2 * reach;
gl.polygonOffset(1, 1);
gl.enable(gl.BLEND);
gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
dark.addEventListener("change", redraw);
new ResizeObserver(redraw).observe(canvas);
redraw();
