// What is drawn of the scene, by three.js, and where the pointer is in it.
import * as THREE from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { FIXED } from "./scene.js";

const PALETTE = [0x4e93c9, 0xd9803f, 0x5fa463, 0xb96bb0, 0xc9a93a, 0x56b0a8, 0xcf6464, 0x8a83cf];
const MOST_CELLS = 4000; // that are drawn

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

  /** `write` fills an array with at most `most` numbers and returns how many vertices there are. */
  set(most, write) {
    const { geometry } = this.object;
    let attribute = geometry.getAttribute("position");
    if (!attribute || attribute.array.length < most) {
      geometry.dispose();
      attribute = new THREE.BufferAttribute(new Float32Array(Math.max(most, 3)), 3).setUsage(THREE.DynamicDrawUsage);
      geometry.setAttribute("position", attribute);
    }
    geometry.setDrawRange(0, write(attribute.array));
    attribute.needsUpdate = true;
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
  #camera = new THREE.PerspectiveCamera(45, 1, 0.05, 200);
  #controls;
  #bodies = []; // { mesh, first, count, body }
  #positions = new Float32Array(0);
  #needsDrawing = true;
  #arrows;
  #dots;
  #tiles;
  #windows;
  #cells;
  #floor;
  #cellCount = 0;

  constructor(canvas) {
    this.#canvas = canvas;
    this.#renderer = new THREE.WebGLRenderer({ canvas, antialias: true, powerPreference: "high-performance" });
    this.#renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.#camera.up.set(0, 0, 1);
    this.#camera.position.set(6.5, -9, 7);
    this.#controls = new OrbitControls(this.#camera, canvas);
    this.#controls.target.set(0, 0, 1);
    this.#controls.minDistance = 2;
    this.#controls.maxDistance = 60;
    this.#controls.maxPolarAngle = 0.5 * Math.PI - 0.02;
    this.#controls.addEventListener("change", () => (this.#needsDrawing = true));
    this.#controls.update();
    this.#scene.add(new THREE.HemisphereLight(0xffffff, 0x8a8a80, 1.7));
    const sun = new THREE.DirectionalLight(0xffffff, 1.9);
    sun.position.set(4, -6, 10);
    this.#scene.add(sun);
    this.#cells = new Changing(this.#scene, THREE.LineSegments, new THREE.LineBasicMaterial({ transparent: true, opacity: 0.35 }));
    this.#tiles = new Changing(this.#scene, THREE.LineSegments, new THREE.LineBasicMaterial({ color: 0x5fa463 }));
    this.#windows = new Changing(this.#scene, THREE.LineSegments, new THREE.LineBasicMaterial({ color: 0xd9803f }));
    this.#arrows = new Changing(this.#scene, THREE.LineSegments, new THREE.LineBasicMaterial({ color: 0xd0021b, depthTest: false, transparent: true }));
    this.#dots = new Changing(this.#scene, THREE.Points, new THREE.PointsMaterial({ color: 0xd0021b, size: 5, sizeAttenuation: false, depthTest: false, transparent: true }));
    for (const changing of [this.#cells, this.#tiles, this.#windows, this.#arrows, this.#dots]) changing.hide();
    new ResizeObserver(() => this.#resize()).observe(canvas);
    this.#resize();
    const dark = matchMedia("(prefers-color-scheme: dark)");
    dark.addEventListener("change", () => this.#colour());
    this.#colour();
  }

  #colour() {
    const style = getComputedStyle(document.documentElement);
    const colour = (name) => new THREE.Color(style.getPropertyValue(name).trim());
    this.#scene.background = colour("--sky");
    this.#cells.object.material.color = colour("--text");
    if (this.#floor) this.#scene.remove(this.#floor);
    this.#floor = new THREE.GridHelper(24, 24, colour("--floor"), colour("--floor"));
    this.#floor.rotation.x = 0.5 * Math.PI;
    this.#scene.add(this.#floor);
    this.#needsDrawing = true;
  }

  #resize() {
    const { clientWidth: width, clientHeight: height } = this.#canvas;
    if (width === 0 || height === 0) return;
    this.#renderer.setSize(width, height, false);
    this.#camera.aspect = width / height;
    this.#camera.updateProjectionMatrix();
    this.#needsDrawing = true;
  }

  /** Bodies as worker.js lists them. */
  setBodies(bodies) {
    const kept = new Map(this.#bodies.map((shown) => [shown.body.serial, shown]));
    let first = 0;
    this.#bodies = bodies.map((body) => {
      let shown = kept.get(body.serial);
      kept.delete(body.serial);
      if (!shown) {
        const geometry = new THREE.BufferGeometry();
        geometry.setIndex(new THREE.BufferAttribute(body.triangles, 1));
        geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(3 * body.vertexCount), 3).setUsage(THREE.DynamicDrawUsage));
        const color = body.kind === FIXED ? 0x9aa3ab : PALETTE[body.serial % PALETTE.length];
        const material = new THREE.MeshLambertMaterial({ color, flatShading: true, side: THREE.DoubleSide });
        shown = { body, mesh: new THREE.Mesh(geometry, material) };
        shown.mesh.frustumCulled = false;
        this.#scene.add(shown.mesh);
      }
      shown.first = first;
      first += 3 * body.vertexCount;
      return shown;
    });
    for (const { mesh } of kept.values()) {
      this.#scene.remove(mesh);
      mesh.geometry.dispose();
      mesh.material.dispose();
    }
  }

  setFrame({ positions, arrows, tiles, windows }, cellSize) {
    this.#positions = positions;
    for (const { mesh, first, body } of this.#bodies) {
      const attribute = mesh.geometry.getAttribute("position");
      attribute.array.set(positions.subarray(first, first + 3 * body.vertexCount));
      attribute.needsUpdate = true;
      mesh.geometry.boundingSphere = null;
    }
    if (arrows && arrows.length > 0) {
      this.#dots.set(arrows.length / 2, (out) => {
        for (let i = 0, n = 0; i < arrows.length; i += 6) for (let c = 0; c < 3; ++c) out[n++] = arrows[i + c];
        return arrows.length / 6;
      });
      this.#arrows.set(arrows.length, (out) => {
        for (let i = 0; i < arrows.length; i += 6)
          for (let c = 0; c < 3; ++c) {
            out[i + c] = arrows[i + c];
            out[i + 3 + c] = arrows[i + c] + 2 * arrows[i + 3 + c]; // twice its length, to be seen
          }
        return arrows.length / 3;
      });
    } else {
      this.#dots.hide();
      this.#arrows.hide();
    }
    for (const [changing, boxes] of [[this.#tiles, tiles], [this.#windows, windows]]) {
      if (boxes && boxes.length > 0) changing.set(12 * boxes.length, (out) => boxLines(boxes, out));
      else changing.hide();
    }
    this.#drawCells(cellSize);
    this.#needsDrawing = true;
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
    const [hit] = caster.intersectObjects(this.#bodies.map(({ mesh }) => mesh), false);
    return Boolean(hit) && this.#bodies.find(({ mesh }) => mesh === hit.object).body.kind !== FIXED;
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
