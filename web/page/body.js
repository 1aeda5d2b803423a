// A body as it is drawn: smooth where its surface is smooth, with sharp edges, thin lines along all edges, and cut faces of another colour.
import * as THREE from "three";
import { cornerNormals, cornersOf } from "../viewer/look.js";

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
    cornerNormals(index, at, faces, normals);
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
