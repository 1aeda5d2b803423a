// What the playground and the files of `vox collide -o x.html` look like: colours, contacts, and corners of smooth surfaces.

export const PALETTE = [0x3d8bd4, 0xf08a3c, 0x4fae62, 0xc069b8, 0xe0b93a, 0x43b3a6, 0xe06666, 0x8b7fe0];
export const COLOURS = {
  light: { sky: 0xdfe6ed, air: 0xf2f7ff, ground: 0xc9d2db, line: 0x2a4560 },
  dark: { sky: 0x161b21, air: 0xb8cbe2, ground: 0x46525e, line: 0xb4d0ee },
};
export const CONTACT = 0xe3122f;

/** A contact: a round dot with a white rim, larger where it is deeper, up to the depth `full`. */
export const contactDots = {
  vertexShader: `attribute float depth; uniform float scale, full; varying float shown;
    void main() {
      gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
      float part = clamp(depth / full, 0.0, 1.0);
      shown = mix(0.55, 1.0, part);
      gl_PointSize = scale * mix(4.5, 15.0, sqrt(part));
    }`,
  fragmentShader: `uniform vec3 color; varying float shown;
    void main() {
      float far = 2.0 * length(gl_PointCoord - 0.5);
      if (far > 1.0) discard;
      vec3 seen = mix(color, vec3(1.0), smoothstep(0.58, 0.7, far));
      gl_FragColor = vec4(seen, shown * smoothstep(1.0, 0.85, far));
    }`,
};

const SMOOTH = Math.cos(1.1); // faces that meet at less than this angle share a normal

/** Corners for drawing: one for each vertex and each smooth piece of the surface around it; and edges between them. */
export function cornersOf({ triangles, uncut }, positions) {
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

/** Sums of the normals of the triangles around each corner: into `out`, by way of `faces`, 3 numbers of each triangle. */
export function cornerNormals(index, positions, faces = new Float32Array(index.length), out = new Float32Array(positions.length)) {
  faceNormals(index, positions, faces);
  out.fill(0);
  for (let i = 0; i < index.length; ++i) {
    const face = 3 * Math.floor(i / 3);
    for (let c = 0; c < 3; ++c) out[3 * index[i] + c] += faces[face + c];
  }
  return out;
}
