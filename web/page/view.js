// What is drawn of the scene, by three.js, and where the pointer is in it.
import * as THREE from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { COLOURS, CONTACT, PALETTE, contactDots } from "../viewer/look.js";
import { BodyMesh } from "./body.js";
import { FIXED, TOOL } from "./scene.js";

const RING = 0x8d99a6;
const MOST_CELLS = 4000; // that are drawn
const DEEP = 0.06; // what counts as a deep contact in a scene of this size

/** The ground: cells of the chosen size, as thin lines that fade towards the horizon. */
const groundLines = {
  vertexShader: "varying vec2 at; void main() { at = position.xy; gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }",
  fragmentShader: `varying vec2 at; uniform float size; uniform vec3 color; uniform float strength;
    void main() {
      vec2 cell = at / size, width = fwidth(cell);
      vec2 near = abs(fract(cell - 0.5) - 0.5) / max(width, vec2(1e-6));
      float line = 1.0 - min(min(near.x, near.y), 1.0);
      float fade = smoothstep(9.0, 3.0, length(at)) * smoothstep(0.5, 0.15, max(width.x, width.y));
      gl_FragColor = vec4(color, strength * line * fade);
    }`,
};

/** Lines along the edges of boxes, given as min and max. */
function boxLines(boxes, out) {
  let n = 0;
  for (let i = 0; i < boxes.length; i += 6) {
    const [x0, y0, z0, x1, y1, z1] = boxes.subarray(i, i + 6);
    for (const [a, b, c, d, e, f] of [
      [x0, y0, z0, x1, y0, z0], [x0, y1, z0, x1, y1, z0], [x0, y0, z1, x1, y0, z1], [x0, y1, z1, x1, y1, z1],
      [x0, y0, z0, x0, y1, z0], [x1, y0, z0, x1, y1, z0], [x0, y0, z1, x0, y1, z1], [x1, y0, z1, x1, y1, z1],
      [x0, y0, z0, x0, y0, z1], [x1, y0, z0, x1, y0, z1], [x0, y1, z0, x0, y1, z1], [x1, y1, z0, x1, y1, z1],
    ]) {
      out[n++] = a; out[n++] = b; out[n++] = c; out[n++] = d; out[n++] = e; out[n++] = f;
    }
  }
  return n / 3;
}

/** Points or lines whose number changes from frame to frame. */
class Changing {
  constructor(scene, Type, material) {
    this.object = new Type(new THREE.BufferGeometry(), material);
    this.object.frustumCulled = false;
    this.object.renderOrder = 1; // over the bodies
    scene.add(this.object);
  }

  /** `write` fills an array with at most `most` numbers, and depths of points, and returns how many vertices there are. */
  set(most, write) {
    const { geometry } = this.object;
    let attribute = geometry.getAttribute("position");
    if (!attribute || attribute.array.length < most) {
      geometry.dispose();
      attribute = new THREE.BufferAttribute(new Float32Array(Math.max(most, 3)), 3).setUsage(THREE.DynamicDrawUsage);
      geometry.setAttribute("position", attribute);
      geometry.setAttribute("depth", new THREE.BufferAttribute(new Float32Array(attribute.count), 1).setUsage(THREE.DynamicDrawUsage));
    }
    const depths = geometry.getAttribute("depth");
    geometry.setDrawRange(0, write(attribute.array, depths.array));
    attribute.needsUpdate = depths.needsUpdate = true;
    this.object.visible = true;
  }

  hide() {
    this.object.visible = false;
  }
}

export class View {
  #canvas;
  #renderer;
  #scene = new THREE.Scene();
  #camera = new THREE.PerspectiveCamera(40, 1, 0.1, 200);
  #controls;
  #bodies = []; // { body, first, drawn: a BodyMesh from the first frame on }
  #positions = new Float32Array(0);
  #needsDrawing = true;
  #ground = new THREE.Mesh(new THREE.CircleGeometry(80, 64), new THREE.MeshLambertMaterial());
  #air = new THREE.HemisphereLight(); // light from all around
  #lattice;
  #arrows;
  #dots;
  #touched;
  #tools; // by TOOL
  #tiles;
  #windows;
  #cells;
  #cellCount = 0;
  #followed = null; // { origin, until, near: whether the camera goes there }

  constructor(canvas) {
    this.#canvas = canvas;
    const renderer = new THREE.WebGLRenderer({ canvas, antialias: true, powerPreference: "high-performance" });
    this.#renderer = renderer;
    renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    renderer.toneMapping = THREE.NeutralToneMapping;
    renderer.shadowMap.enabled = true;
    renderer.shadowMap.type = THREE.PCFShadowMap;
    this.#camera.up.set(0, 0, 1);
    this.#camera.position.set(6.2, -10.2, 6.6);
    this.#controls = new OrbitControls(this.#camera, canvas);
    this.#controls.target.set(0, 0, 0.9);
    this.#controls.minDistance = 2;
    this.#controls.maxDistance = 60;
    this.#controls.maxPolarAngle = 0.5 * Math.PI - 0.02;
    this.#controls.addEventListener("change", () => (this.#needsDrawing = true));
    this.#controls.addEventListener("start", () => this.#followed && (this.#followed.near = false));
    this.#controls.update();
    this.#air.position.set(0, 0, 1);
    const back = new THREE.DirectionalLight(0xbfd8ff, 0.7);
    back.position.set(-6, 5, 3);
    this.#scene.add(this.#air, back);
    const sun = new THREE.DirectionalLight(0xfff1df, 2.4);
    sun.position.set(5, -5, 11);
    sun.castShadow = true;
    sun.shadow.mapSize.set(2048, 2048);
    Object.assign(sun.shadow.camera, { left: -7, right: 7, top: 7, bottom: -7, near: 1, far: 30 });
    sun.shadow.normalBias = 0.03;
    sun.shadow.radius = 3;
    this.#scene.add(sun);
    this.#ground.receiveShadow = true;
    this.#lattice = new THREE.Mesh(new THREE.PlaneGeometry(20, 20), new THREE.ShaderMaterial({
      ...groundLines, transparent: true, depthWrite: false, uniforms: { size: { value: 1 }, color: { value: new THREE.Color() }, strength: { value: 0 } },
    }));
    this.#lattice.position.z = 0.003;
    this.#scene.add(this.#ground, this.#lattice);
    this.#cells = new Changing(this.#scene, THREE.LineSegments, new THREE.LineBasicMaterial({ transparent: true, opacity: 0.3 }));
    this.#tiles = new Changing(this.#scene, THREE.LineSegments, new THREE.LineBasicMaterial({ color: 0x2e9e52 }));
    this.#windows = new Changing(this.#scene, THREE.LineSegments, new THREE.LineBasicMaterial({ color: 0xd9803f }));
    this.#arrows = new Changing(this.#scene, THREE.LineSegments, new THREE.LineBasicMaterial({ color: CONTACT, depthTest: false, transparent: true }));
    this.#dots = new Changing(this.#scene, THREE.Points, new THREE.ShaderMaterial({
      ...contactDots, transparent: true, depthTest: false, uniforms: { color: { value: new THREE.Color(CONTACT) }, scale: { value: renderer.getPixelRatio() }, full: { value: DEEP } },
    }));
    this.#touched = new Changing(this.#scene, THREE.LineSegments, new THREE.LineBasicMaterial({ color: CONTACT, depthTest: false, transparent: true }));
    for (const changing of [this.#cells, this.#tiles, this.#windows, this.#arrows, this.#dots, this.#touched]) changing.hide();
    const steel = (opacity) => new THREE.MeshStandardMaterial({ color: 0xaab4c0, roughness: 0.35, side: THREE.DoubleSide, transparent: opacity < 1, opacity });
    const blade = new THREE.PlaneGeometry(1.8, 1.8).rotateX(Math.PI / 2); // as tool.cpp has it
    this.#tools = [null, new THREE.Mesh(new THREE.SphereGeometry(0.6, 48, 32), steel(1)), new THREE.Mesh(blade, steel(0.55))];
    for (const tool of this.#tools) tool && this.#scene.add(Object.assign(tool, { visible: false, castShadow: true }));
    new ResizeObserver(() => this.#resize()).observe(canvas);
    this.#resize();
  }

  /** "light" or "dark". */
  setScheme(scheme) {
    const { sky, air, ground, line } = COLOURS[scheme];
    this.#scene.background = new THREE.Color(sky);
    this.#scene.fog = new THREE.Fog(sky, 16, 42);
    this.#air.color.set(air);
    this.#air.groundColor.set(ground);
    this.#air.intensity = scheme === "dark" ? 1.1 : 1.6;
    this.#ground.material.color.set(ground);
    this.#lattice.material.uniforms.color.value.set(line);
    this.#cells.object.material.color.set(line);
    this.#needsDrawing = true;
  }

  #resize() {
    const { clientWidth: width, clientHeight: height } = this.#canvas;
    if (width === 0 || height === 0) return;
    this.#renderer.setSize(width, height, false);
    this.#camera.aspect = width / height;
    this.#camera.fov = width < height * 1.1 ? 52 : 40; // so that the ring fits
    this.#camera.updateProjectionMatrix();
    this.#needsDrawing = true;
  }

  /** Draws less: no shadows, and no more pixels than the page has. */
  simplify() {
    this.#renderer.setPixelRatio(1);
    this.#renderer.shadowMap.enabled = false;
    this.#scene.traverse(({ material }) => material && (material.needsUpdate = true));
    this.#resize();
  }

  /** Bodies as worker.js lists them. */
  setBodies(bodies) {
    const kept = new Map(this.#bodies.map((shown) => [shown.body.serial, shown]));
    let first = 0;
    this.#bodies = bodies.map((body) => {
      const shown = kept.get(body.serial) ?? { body };
      kept.delete(body.serial);
      shown.first = first;
      first += 3 * body.vertexCount;
      return shown;
    });
    for (const { drawn } of kept.values()) {
      if (!drawn) continue;
      this.#scene.remove(drawn.object);
      drawn.dispose();
    }
  }

  #drawnBody(body, positions) {
    const colour = new THREE.Color(body.kind === FIXED ? RING : PALETTE[body.origin % PALETTE.length]);
    const drawn = new BodyMesh(body, positions, colour, colour.clone().lerp(new THREE.Color(0xfff1dd), 0.72));
    this.#scene.add(drawn.object);
    return drawn;
  }

  setFrame({ positions, contacts, touched, tiles, windows, facts }, { size, cells }) {
    this.#positions = positions;
    for (const shown of this.#bodies) {
      const own = positions.subarray(shown.first, shown.first + 3 * shown.body.vertexCount);
      shown.drawn ??= this.#drawnBody(shown.body, own);
      shown.drawn.move(own);
    }
    if (contacts && contacts.length > 0) {
      const count = contacts.length / 6;
      this.#dots.set(3 * count, (out, depths) => {
        for (let i = 0; i < count; ++i) {
          for (let c = 0; c < 3; ++c) out[3 * i + c] = contacts[6 * i + c];
          depths[i] = Math.hypot(contacts[6 * i + 3], contacts[6 * i + 4], contacts[6 * i + 5]);
        }
        return count;
      });
      this.#arrows.set(6 * count, (out) => {
        for (let i = 0; i < contacts.length; i += 6)
          for (let c = 0; c < 3; ++c) {
            out[i + c] = contacts[i + c];
            out[i + 3 + c] = contacts[i + c] + 2 * contacts[i + 3 + c]; // twice its length, to be seen
          }
        return 2 * count;
      });
    } else {
      this.#dots.hide();
      this.#arrows.hide();
    }
    if (touched && touched.length > 0) {
      this.#touched.set(touched.length, (out) => {
        out.set(touched);
        return touched.length / 3;
      });
    } else this.#touched.hide();
    for (const tool of this.#tools) tool?.position.set(facts.toolX, facts.toolY, facts.toolZ);
    for (const [changing, boxes] of [[this.#tiles, tiles], [this.#windows, windows]]) {
      if (boxes && boxes.length > 0) changing.set(12 * boxes.length, (out) => boxLines(boxes, out));
      else changing.hide();
    }
    this.setCells(size, cells);
    this.#follow();
    this.#needsDrawing = true;
  }

  /** The cells: on the ground always, and around the bodies if `all`. */
  setCells(size, all) {
    if (size) this.#lattice.material.uniforms.size.value = size;
    this.#lattice.visible = Boolean(size);
    this.#lattice.material.uniforms.strength.value = all ? 0.45 : 0.15;
    this.#drawCells(all ? size : 0);
    this.#needsDrawing = true;
  }

  /** Lights a body up for a second, and lets the camera go to it if `near`. */
  show(origin, near) {
    const before = this.#followed && this.#drawnOf(this.#followed.origin);
    before?.mesh.material.emissive.setScalar(0);
    this.#followed = { origin, near, begin: performance.now() };
  }

  /** Where the body that was shown is in the page: { x, y, name }, or null after some seconds. */
  get label() {
    const drawn = this.#followed && this.#drawnOf(this.#followed.origin);
    if (!drawn) return null;
    const at = drawn.ball.center.clone().setZ(drawn.ball.center.z + drawn.ball.radius).project(this.#camera);
    const { clientWidth, clientHeight } = this.#canvas;
    return { x: (0.5 + 0.5 * at.x) * clientWidth, y: (0.5 - 0.5 * at.y) * clientHeight, name: drawn.body.name };
  }

  #drawnOf(origin) {
    return this.#bodies.find(({ body, drawn }) => drawn && body.origin === origin)?.drawn;
  }

  #follow() {
    if (!this.#followed) return;
    const { origin, near, begin } = this.#followed;
    const age = (performance.now() - begin) / 1000;
    const drawn = this.#drawnOf(origin);
    drawn?.mesh.material.emissive.setScalar(0.35 * Math.max(0, 1 - age));
    if (!drawn || age > 3) return void (this.#followed = null);
    if (!near) return;
    const part = matchMedia("(prefers-reduced-motion: reduce)").matches ? 1 : 0.08;
    const { center, radius } = drawn.ball;
    const { target } = this.#controls;
    const offset = this.#camera.position.clone().sub(target);
    target.lerp(center, part);
    offset.setLength(offset.length() + part * (Math.max(7, 5 * radius) - offset.length()));
    this.#camera.position.copy(target).add(offset);
    this.#controls.update();
  }

  /** Cells that hold vertices; of many, those nearest to the middle. */
  #drawCells(size) {
    this.#cellCount = 0;
    if (!size) return this.#cells.hide();
    const cells = new Map();
    for (let i = 0; i < this.#positions.length; i += 3) {
      const [i0, j, k] = [0, 1, 2].map((c) => Math.floor(this.#positions[i + c] / size));
      const key = (i0 + 32768) * 4294967296 + (j + 32768) * 65536 + (k + 32768);
      if (!cells.has(key)) cells.set(key, [i0, j, k]);
    }
    this.#cellCount = cells.size;
    let list = [...cells.values()];
    if (list.length > MOST_CELLS) {
      const far = ([i, j, k]) => i * i + j * j + (k - 1 / size) ** 2;
      list = list.sort((a, b) => far(a) - far(b)).slice(0, MOST_CELLS);
    }
    const boxes = new Float32Array(6 * list.length);
    list.forEach((cell, n) => cell.forEach((c, axis) => {
      boxes[6 * n + axis] = c * size;
      boxes[6 * n + 3 + axis] = (c + 1) * size;
    }));
    if (boxes.length > 0) this.#cells.set(12 * boxes.length, (out) => boxLines(boxes, out));
    return undefined;
  }

  get cellCount() {
    return this.#cellCount;
  }

  get controls() {
    return this.#controls;
  }

  /** Where a pointer's ray begins and ends, in the scene. */
  ray(clientX, clientY) {
    const box = this.#canvas.getBoundingClientRect();
    const at = new THREE.Vector3((2 * (clientX - box.left)) / box.width - 1, 1 - (2 * (clientY - box.top)) / box.height, 0.5);
    at.unproject(this.#camera);
    const from = this.#camera.position.clone();
    return { from: from.toArray(), to: from.clone().add(at.sub(from).normalize().multiplyScalar(100)).toArray() };
  }

  /** Whether a ray hits a body that can be dragged before any other. */
  hits({ from, to }) {
    const way = new THREE.Vector3(...to).sub(new THREE.Vector3(...from)).normalize();
    const caster = new THREE.Raycaster(new THREE.Vector3(...from), way);
    const drawn = this.#bodies.flatMap((shown) => shown.drawn ?? []);
    const [hit] = caster.intersectObjects(drawn.map(({ mesh }) => mesh), false);
    return Boolean(hit) && drawn.find(({ mesh }) => mesh === hit.object).body.kind !== FIXED;
  }

  /** The point of a ray that is as far from the camera, along its axis, as `point`. */
  beside({ from, to }, point) {
    const axis = this.#camera.getWorldDirection(new THREE.Vector3());
    const start = new THREE.Vector3(...from);
    const way = new THREE.Vector3(...to).sub(start);
    const depth = new THREE.Vector3(...point).sub(start).dot(axis);
    return start.add(way.multiplyScalar(depth / way.dot(axis))).toArray();
  }

  /** Moves a point by so much to the right and up, as seen. */
  shifted(point, right, up) {
    const [x, y] = [0, 1].map((column) => new THREE.Vector3().setFromMatrixColumn(this.#camera.matrixWorld, column));
    return new THREE.Vector3(...point).addScaledVector(x, right).addScaledVector(y, up).toArray();
  }

  /** Shows a tool alone; a blade stands along a direction. */
  setTool(shown, [x, y] = [1, 0]) {
    this.#tools.forEach((tool, kind) => tool && (tool.visible = kind === shown));
    this.#tools[TOOL.blade].rotation.z = Math.atan2(y, x);
    this.#needsDrawing = true;
  }

  /** The level direction halfway between to the right and away: a blade along it shows a side. */
  get aslant() {
    const right = new THREE.Vector3().setFromMatrixColumn(this.#camera.matrixWorld, 0);
    return [right.x - right.y, right.y + right.x];
  }

  turn(left, up) {
    const offset = this.#camera.position.clone().sub(this.#controls.target);
    const spherical = new THREE.Spherical().setFromVector3(new THREE.Vector3(offset.x, offset.z, -offset.y));
    spherical.theta += left;
    spherical.phi = Math.min(this.#controls.maxPolarAngle, Math.max(0.05, spherical.phi + up));
    const turned = new THREE.Vector3().setFromSpherical(spherical);
    this.#camera.position.set(turned.x, -turned.z, turned.y).add(this.#controls.target);
    this.#controls.update();
  }

  approach(factor) {
    const offset = this.#camera.position.clone().sub(this.#controls.target);
    offset.setLength(Math.min(60, Math.max(2, offset.length() * factor)));
    this.#camera.position.copy(this.#controls.target).add(offset);
    this.#controls.update();
  }

  get centre() {
    const box = this.#canvas.getBoundingClientRect();
    return [box.left + box.width / 2, box.top + box.height / 2];
  }

  /** Draws, if something has changed since. */
  draw() {
    if (!this.#needsDrawing) return false;
    this.#needsDrawing = false;
    this.#renderer.render(this.#scene, this.#camera);
    return true;
  }
}
