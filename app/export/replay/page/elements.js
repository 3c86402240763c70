// Surfaces as a few discs each, which take light from what is near and send their own. As render/light/elements.cpp.

const mostElements = 64;  // of one body, and some that are left over between others

const partsPerRow = 1024;

// Triangles in groups of neighbours.
function patches(triangles) {
  const count = triangles.length / 3;
  const size = Math.ceil(count / mostElements);
  const around = new Map();  // the triangles around each vertex
  triangles.forEach((v, i) => {
    if (!around.has(v)) around.set(v, []);
    around.get(v).push(Math.floor(i / 3));
  });
  const taken = new Uint8Array(count);
  const result = [];
  for (let seed = 0; seed < count; ++seed) {
    if (taken[seed]) continue;
    const patch = [seed];
    taken[seed] = 1;
    for (let next = 0; next < patch.length; ++next) {  // breadth first over triangles that share a vertex
      for (const v of triangles.subarray(3 * patch[next], 3 * patch[next] + 3)) {
        for (const t of around.get(v)) {
          if (taken[t] || patch.length === size) continue;
          taken[t] = 1;
          patch.push(t);
        }
      }
    }
    result.push(patch);
  }
  return result;
}

const partCount = (patch) => (patch.length > 1 ? patch.length : 0);  // triangles

// Tables of all bodies' elements, a row for each body, and of their parts.
class Elements {
  constructor(recording) {
    const shapes = new Map();
    this.materials = recording.materials;
    this.bodies = recording.meshes.map((mesh) => {
      if (!shapes.has(mesh.shape)) shapes.set(mesh.shape, patches(mesh.triangles));
      return { first: mesh.first, triangles: mesh.triangles, patches: shapes.get(mesh.shape) };
    });
    this.columns = this.bodies.reduce((most, body) => Math.max(most, body.patches.length), 1);
    // Centre and area; normal, the first of its parts; albedo, how many parts.
    this.discs = new Float32Array(3 * 4 * this.columns * this.bodies.length);
    const parts = this.bodies.reduce((sum, body) => body.patches.reduce((of, patch) => of + partCount(patch), sum), 0);
    // Centre and area; normal, 0.
    this.parts = new Float32Array(2 * 4 * partsPerRow * Math.max(Math.ceil(parts / partsPerRow), 1));
    // Of the ball in a body's place: centre and the radius that has all elements; area and how many there are.
    this.balls = new Float32Array(2 * 4 * this.bodies.length);
  }

  measure(positions) {
    this.measured = 0;  // parts
    this.bodies.forEach((body, row) => {
      const begin = 12 * this.columns * row;
      body.patches.forEach((patch, i) => this.measurePatch(body, patch, positions, begin + 12 * i));
      this.measureBall(begin, body.patches.length, 8 * row);
    });
  }

  measurePatch({ first, triangles }, patch, positions, at) {
    const { discs, materials } = this;
    let area = 0, ax = 0, ay = 0, az = 0, cx = 0, cy = 0, cz = 0, red = 0, green = 0, blue = 0;
    for (const t of patch) {
      const v = first + triangles[3 * t], w = first + triangles[3 * t + 1], u = first + triangles[3 * t + 2];
      const a = 3 * v, b = 3 * w, c = 3 * u;
      const px = positions[b] - positions[a], qx = positions[c] - positions[a];
      const py = positions[b + 1] - positions[a + 1], qy = positions[c + 1] - positions[a + 1];
      const pz = positions[b + 2] - positions[a + 2], qz = positions[c + 2] - positions[a + 2];
      const x = 0.5 * (py * qz - pz * qy), y = 0.5 * (pz * qx - px * qz), z = 0.5 * (px * qy - py * qx);
      const size = Math.sqrt(x * x + y * y + z * z);
      ax += x; ay += y; az += z;
      area += size;
      cx += size * (positions[a] + positions[b] + positions[c]);
      cy += size * (positions[a + 1] + positions[b + 1] + positions[c + 1]);
      cz += size * (positions[a + 2] + positions[b + 2] + positions[c + 2]);
      red += size * (materials[4 * v] + materials[4 * w] + materials[4 * u]);
      green += size * (materials[4 * v + 1] + materials[4 * w + 1] + materials[4 * u + 1]);
      blue += size * (materials[4 * v + 2] + materials[4 * w + 2] + materials[4 * u + 2]);
    }
    const over = 1 / (3 * Math.max(area, 1e-12));
    const facing = Math.sqrt(ax * ax + ay * ay + az * az), unit = 1 / (facing || 1);
    const normal = [ax * unit, ay * unit, az * unit], centre = [cx * over, cy * over, cz * over];
    const out = this.bulge(first, triangles, patch, positions, centre, normal);
    discs.set([...centre.map((c, k) => c + out * normal[k]), facing, ...normal, this.measured,
      red * over, green * over, blue * over, partCount(patch)], at);
    if (partCount(patch) === 0) return;
    for (const t of patch) {
      this.measurePart(...[0, 1, 2].map((i) => {
        const from = 3 * (first + triangles[3 * t + i]);
        return Array.from(positions.subarray(from, from + 3));
      }));
    }
  }

  // How far a patch reaches beyond its middle.
  bulge(first, triangles, patch, positions, centre, normal) {
    let highest = 0;
    for (const t of patch) {
      for (let i = 0; i < 3; ++i) {
        const a = 3 * (first + triangles[3 * t + i]);
        let height = 0;
        for (let k = 0; k < 3; ++k) height += normal[k] * (positions[a + k] - centre[k]);
        highest = Math.max(highest, height);
      }
    }
    return highest;
  }

  measurePart(a, b, c) {
    const p = b.map((value, k) => value - a[k]), q = c.map((value, k) => value - a[k]);
    const across = [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]];
    const size = Math.hypot(...across), unit = 1 / (size || 1);
    this.parts.set([...a.map((value, k) => (value + b[k] + c[k]) / 3), 0.5 * size,
      ...across.map((value) => value * unit), 0], 8 * this.measured++);
  }

  // A quarter of the elements' area is a convex body's mean cross section (Cauchy).
  measureBall(begin, count, at) {
    const { discs, balls } = this;
    let area = 0, radius = 0;
    const centre = [0, 0, 0];
    const each = (use) => {
      for (let i = begin; i < begin + 12 * count; i += 12) use(i);
    };
    each((i) => {
      area += discs[i + 3];
      for (let k = 0; k < 3; ++k) centre[k] += discs[i + 3] * discs[i + k];
    });
    for (let k = 0; k < 3; ++k) centre[k] /= Math.max(area, 1e-12);
    each((i) => {
      radius = Math.max(radius, Math.hypot(discs[i] - centre[0], discs[i + 1] - centre[1], discs[i + 2] - centre[2]));
    });
    balls.set([...centre, radius, 0.25 * area, count, 0, 0], at);
  }
}
