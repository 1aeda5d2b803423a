// A body as it is drawn: smooth where its surface is smooth, with sharp edges, thin lines along all edges, and cut faces of another colour.
import * as THREE from "three";

const SMOOTH = Math.cos(1.1); // faces that meet at less than this angle share a normal

/** Corners for drawing: one for each vertex and each smooth piece of the surface around it; and edges between them. */
function cornersOf({ triangles, uncut }, positions) {
  const normals = faceNormals(triangles, positions);
  const pieces = new Map(); // of each vertex: { corner, normal, cut }
  const vertices = [];
  const cut = [];
  const index = triangles.map((vertex, i) => {
    const face = Math.floor(i / 3);
    const normal = normals.subarray(3 * face, 3 * face + 3);
    const isCut = face >= uncut;
    const around = pieces.get(vertex) ?? pieces.set(vertex, []).get(vertex);
    let piece = around.find((p) => p.cut === isCut && (isCut || (p.normal[0] * normal[0] + p.normal[1] * normal[1] + p.normal[2] * normal[2]) > SMOOTH * Math.hypot(...p.normal)));
    if (!piece) {
      piece = { corner: vertices.length, normal: [0, 0, 0], cut: isCut };
      around.push(piece);
      vertices.push(vertex);
      cut.push(isCut);
    }
    for (let c = 0; c < 3; ++c) piece.normal[c] += normal[c];
    return piece.corner;
  });
  const edges = new Map();
  for (let i = 0; i < triangles.length; i += 3)
    for (let k = 0; k < 3; ++k) {
      const [a, b] = [i + k, i + ((k + 1) % 3)];
      const key = Math.min(triangles[a], triangles[b]) * 2 ** 26 + Math.max(triangles[a], triangles[b]);
      edges.set(key, [index[a], index[b]]);
    }
  return { vertices: Uint32Array.from(vertices), cut, index, edges: [...edges.values()].flat() };
}

/** Unit normals of triangles. */
function faceNormals(triangles, p, out = new Float32Array(triangles.length)) {
  for (let i = 0; i < triangles.length; i += 3) {
    const [a, b, c] = [3 * triangles[i], 3 * triangles[i + 1], 3 * triangles[i + 2]];
    const [ux, uy, uz, vx, vy, vz] = [p[b] - p[a], p[b + 1] - p[a + 1], p[b + 2] - p[a + 2], p[c] - p[a], p[c + 1] - p[a + 1], p[c + 2] - p[a + 2]];
    const [x, y, z] = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
    const length = Math.sqrt(x * x + y * y + z * z) || 1;
    out[i] = x / length;
    out[i + 1] = y / length;
    out[i + 2] = z / length;
  }
  return out;
}

export class BodyMesh {
  /** `positions`: of its vertices, as they are now. */
  constructor(body, positions, colour, cutColour) {
    this.body = body;
    const { vertices, cut, index, edges } = cornersOf(body, positions);
    this.vertices = vertices;
    this.index = index;
    this.faces = new Float32Array(index.length);
    const changing = () => new THREE.BufferAttribute(new Float32Array(3 * vertices.length), 3).setUsage(THREE.DynamicDrawUsage);
    this.position = changing();
    this.normal = changing();
    const geometry = new THREE.BufferGeometry();
    geometry.setIndex(new THREE.BufferAttribute(index, 1));
    geometry.setAttribute("position", this.position);
    geometry.setAttribute("normal", this.normal);
    geometry.setAttribute("color", new THREE.BufferAttribute(Float32Array.from(cut.flatMap((isCut) => (isCut ? cutColour : colour).toArray())), 3));
    this.mesh = new THREE.Mesh(geometry, new THREE.MeshStandardMaterial({
      vertexColors: true, roughness: 0.55, side: THREE.DoubleSide, shadowSide: THREE.BackSide, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1,
    }));
    this.mesh.castShadow = this.mesh.receiveShadow = true;
    const lines = new THREE.BufferGeometry();
    lines.setIndex(edges);
    lines.setAttribute("position", this.position);
    this.lines = new THREE.LineSegments(lines, new THREE.LineBasicMaterial({ color: 0x000000, transparent: true, opacity: 0.16 }));
    this.object = new THREE.Group().add(this.mesh, this.lines);
    for (const part of this.object.children) part.frustumCulled = false;
  }

  move(positions) {
    const { vertices, index, faces } = this;
    const [at, normals] = [this.position.array, this.normal.array];
    for (let i = 0; i < vertices.length; ++i)
      for (let c = 0; c < 3; ++c) at[3 * i + c] = positions[3 * vertices[i] + c];
    faceNormals(index, at, faces);
    normals.fill(0);
    for (let i = 0; i < index.length; ++i) {
      const face = 3 * Math.floor(i / 3);
      for (let c = 0; c < 3; ++c) normals[3 * index[i] + c] += faces[face + c];
    }
    this.position.needsUpdate = this.normal.needsUpdate = true;
    this.mesh.geometry.boundingSphere = null; // for rays
  }

  /** Its middle and how far it reaches from there. */
  get ball() {
    if (!this.mesh.geometry.boundingSphere) this.mesh.geometry.computeBoundingSphere();
    return this.mesh.geometry.boundingSphere;
  }

  dispose() {
    for (const { geometry, material } of this.object.children) {
      geometry.dispose();
      material.dispose();
    }
  }
}
