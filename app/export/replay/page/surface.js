// The meshes as one list of triangles, coarse ones rounded. As render/geometry/refine.cpp, rounding.cpp and
// drawn_surface.cpp, but that all edges of a mesh are halved equally often, however they are seen.

const fewTriangles = 3000;  // a mesh of fewer is halved again
const mostLevels = 3;
const receiversPerRow = 128;  // of the texture that light.js makes of `lit`

// All edges of the triangles halved so many times. Points are corners and weights, three of each; first the vertices.
function refine(triangles, vertexCount, levels) {
  const corners = [], weights = [];
  for (let v = 0; v < vertexCount; ++v) {
    corners.push(v, v, v);
    weights.push(1, 0, 0);
  }
  let parts = [];
  for (let t = 0; t < triangles.length; t += 3) {
    parts.push({ of: triangles.subarray(t, t + 3), points: [...triangles.subarray(t, t + 3)],
      weights: [[1, 0, 0], [0, 1, 0], [0, 0, 1]] });
  }
  for (let level = 0; level < levels; ++level) {
    const middles = new Map();  // by the ends' numbers; both sides of an edge share it
    const halved = [];
    for (const { of, points, weights: w } of parts) {
      const middleWeights = [0, 1, 2].map((i) => w[i].map((x, k) => 0.5 * (x + w[(i + 1) % 3][k])));
      const middle = [0, 1, 2].map((i) => {
        const a = points[i], b = points[(i + 1) % 3];
        const key = Math.min(a, b) * 2 ** 26 + Math.max(a, b);
        if (!middles.has(key)) {
          middles.set(key, corners.length / 3);
          corners.push(...of);
          weights.push(...middleWeights[i]);
        }
        return middles.get(key);
      });
      for (let i = 0; i < 3; ++i) {
        const before = (i + 2) % 3;
        halved.push({ of, points: [points[i], middle[i], middle[before]],
          weights: [w[i], middleWeights[i], middleWeights[before]] });
      }
      halved.push({ of, points: middle, weights: middleWeights });
    }
    parts = halved;
  }
  return { corners, weights, triangles: parts.flatMap(({ points }) => points) };
}

// A triangle of a flat mesh has vertices of its own.
function apart(triangles) {
  const corners = [], weights = [];
  for (let i = 0; i < triangles.length; ++i) {
    corners.push(i, i, i);
    weights.push(1, 0, 0);
  }
  return { corners, weights, triangles: triangles.map((v, i) => i) };
}

// Both of each edge: first and second point, triangle. `places`: numbers that are the same for points at one place;
// null where no two are.
function sidesOf(triangles, places) {
  const place = (point) => (places ? places[point] : point);
  const firsts = new Map();  // by the numbers of the ends' places, from the first to the second
  const sides = [];
  triangles.forEach((from, i) => {
    const to = triangles[i % 3 === 2 ? i - 2 : i + 1];
    const [a, b] = [place(from), place(to)];
    const side = [from, to, Math.floor(i / 3)], other = firsts.get(b * 2 ** 26 + a);
    if (other) sides.push(...other, ...side);
    else firsts.set(a * 2 ** 26 + b, side);
  });
  return sides;
}

function levelsOf(mesh, triangles) {
  let levels = 0;
  if (!mesh.rounded) return levels;
  for (let count = triangles.length / 3; count < fewTriangles && levels < mostLevels; count *= 4) ++levels;
  return levels;
}

// Lit vertices: one for each vertex of a smooth mesh, three for each triangle of a flat one. Points: what is drawn.
class Surface {
  constructor(recording) {
    this.smoothTriangles = recording.smooth;
    this.vertexNormals = new Float32Array(3 * recording.vertexCount);
    this.vertexFlatness = new Float32Array(recording.vertexCount);
    const sources = [], cornerNormals = [], flat = [], sharing = [], corners = [], weights = [], triangles = [];
    const sides = [];
    this.flatMeshes = [];
    const made = new Map();  // refinements, of which copies of a body have one
    for (const mesh of recording.meshes) {
      const first = sources.length, firstPoint = corners.length / 3;
      const key = `${mesh.shape} ${mesh.smooth} ${mesh.rounded}`;
      if (!made.has(key)) {
        const shape = mesh.smooth ? refine(mesh.triangles, mesh.vertices, levelsOf(mesh, mesh.triangles))
          : apart(mesh.triangles);
        made.set(key, { ...shape, sides: sidesOf(shape.triangles, mesh.smooth ? null : mesh.triangles) });
      }
      const refinement = made.get(key);
      if (mesh.smooth) {
        for (let v = 0; v < mesh.vertices; ++v) {
          if (mesh.rounded) sharing.push(sources.length);
          sources.push(mesh.first + v);
        }
      } else {
        this.flatMeshes.push({ ...mesh, firstPoint });
        const firstCorner = cornerNormals.length;
        for (let i = 0; i < mesh.triangles.length; ++i) {
          if (i % 3 === 0) flat.push(sources.length);
          cornerNormals.push(firstCorner + (mesh.cornerNormals ? mesh.cornerNormals[i] : i));
          sources.push(mesh.first + mesh.triangles[i]);
        }
      }
      const firstTriangle = triangles.length / 3;
      refinement.sides.forEach((number, i) => sides.push(number + (i % 3 === 2 ? firstTriangle : firstPoint)));
      for (const corner of refinement.corners) corners.push(first + corner);
      for (const weight of refinement.weights) weights.push(weight);
      for (const point of refinement.triangles) triangles.push(firstPoint + point);
    }
    this.sources = Uint32Array.from(sources);
    this.flat = Uint32Array.from(flat);        // the first of each flat triangle's lit vertices
    this.cornerNormals = Uint32Array.from(cornerNormals);  // the number of each corner's normal, of these triangles
    this.flatNormals = new Float32Array(3 * cornerNormals.length);
    this.sharing = Uint32Array.from(sharing);  // lit vertices with a share of the bulge, as they are recorded
    this.corners = Uint32Array.from(corners);
    this.weights = Float32Array.from(weights);
    this.triangles = Uint32Array.from(triangles);
    this.sides = Uint32Array.from(sides);  // both of each edge: first and second point, triangle
    const rows = Math.ceil(sources.length / receiversPerRow);
    // Position, share of the bulge; normal, its squared cosine with the facet at it that differs most.
    this.lit = new Float32Array(8 * receiversPerRow * rows);
    this.positions = new Float32Array(corners.length);  // of the points
    this.normals = new Float32Array(corners.length);
    this.outward = new Float32Array(corners.length / 3 * 4);  // the same, and that cosine
    this.materials = this.mixMaterials(recording.materials);
  }

  // Linear colour and roughness of each point.
  mixMaterials(materials) {
    const { corners, weights, sources } = this;
    const mixed = new Float32Array(corners.length / 3 * 4);
    for (let i = 0; i < corners.length; ++i) {
      const from = 4 * sources[corners[i]], to = 4 * Math.floor(i / 3);
      for (let k = 0; k < 4; ++k) mixed[to + k] += weights[i] * materials[from + k];
    }
    return mixed;
  }

  // `positions`: of the vertices. `shares`: of the bulge; null where nothing is rounded. `limits`: the
  // ground's (groundLimits); null where there is none.
  place(positions, shares, limits) {
    this.findVertexNormals(positions);
    this.findFlatness(positions);
    this.placeLit(positions, shares);
    this.placePoints(limits);
  }

  // Each vertex's from the areas of the triangles around it. As sim/mesh/measure.cpp.
  findVertexNormals(positions) {
    const { vertexNormals: normals, smoothTriangles } = this;
    normals.fill(0);
    for (let t = 0; t < smoothTriangles.length; t += 3) {
      const a = 3 * smoothTriangles[t], b = 3 * smoothTriangles[t + 1], c = 3 * smoothTriangles[t + 2];
      const ux = positions[b] - positions[a], vx = positions[c] - positions[a];
      const uy = positions[b + 1] - positions[a + 1], vy = positions[c + 1] - positions[a + 1];
      const uz = positions[b + 2] - positions[a + 2], vz = positions[c + 2] - positions[a + 2];
      const x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
      normals[a] += x; normals[a + 1] += y; normals[a + 2] += z;
      normals[b] += x; normals[b + 1] += y; normals[b + 2] += z;
      normals[c] += x; normals[c + 1] += y; normals[c + 2] += z;
    }
    setLengthsToOne(normals);
  }

  // As render/geometry/drawn_surface.cpp.
  findFlatness(positions) {
    const { vertexNormals: normals, vertexFlatness: flatness, smoothTriangles } = this;
    flatness.fill(1);
    const place = (v) => positions.subarray(3 * v, 3 * v + 3);
    for (let t = 0; t < smoothTriangles.length; t += 3) {
      const vertices = smoothTriangles.subarray(t, t + 3), [a, b, c] = vertices;
      const across = cross([...subtract(place(b), place(a))], [...subtract(place(c), place(a))]);
      const length = norm(across);
      for (const v of vertices) {
        const cosine = Math.max(dot(across, normals.subarray(3 * v, 3 * v + 3)) / length, 0);
        if (length > 0) flatness[v] = Math.min(flatness[v], cosine * cosine);
      }
    }
  }

  placeLit(positions, shares) {
    const { lit, sources, vertexNormals, vertexFlatness } = this;
    for (let i = 0; i < sources.length; ++i) {
      const at = 8 * i, v = 3 * sources[i];
      for (let k = 0; k < 3; ++k) {
        lit[at + k] = positions[v + k];
        lit[at + 4 + k] = vertexNormals[v + k];
      }
      lit[at + 3] = 0;
      lit[at + 7] = vertexFlatness[sources[i]];
    }
    if (shares) this.sharing.forEach((i, number) => { lit[8 * i + 3] = shares[number]; });
    this.placeFlatNormals();
  }

  // Larger triangles bend a normal that corners share more. As render/geometry/drawn_surface.cpp.
  placeFlatNormals() {
    const { lit, flat, cornerNormals, flatNormals } = this;
    flatNormals.fill(0);
    flat.forEach((first, triangle) => {
      const place = (i) => lit.subarray(8 * (first + i), 8 * (first + i) + 3);
      const across = cross([...subtract(place(1), place(0))], [...subtract(place(2), place(0))]);
      for (let i = 0; i < 3; ++i) {
        for (let k = 0; k < 3; ++k) flatNormals[3 * cornerNormals[3 * triangle + i] + k] += across[k];
      }
    });
    setLengthsToOne(flatNormals);
    flat.forEach((first, triangle) => {
      for (let i = 0; i < 3; ++i) {
        const normal = 3 * cornerNormals[3 * triangle + i];
        lit.set(flatNormals.subarray(normal, normal + 3), 8 * (first + i) + 4);
      }
    });
  }

  // p + share / 2 * sum of w_i ((x_i - p) . n_i) n_i
  placePoints(limits) {
    const { lit, corners, weights, positions, normals } = this;
    for (let i = 0; i < corners.length; i += 3) {
      let px = 0, py = 0, pz = 0, nx = 0, ny = 0, nz = 0, share = 0;
      for (let k = i; k < i + 3; ++k) {
        const at = 8 * corners[k], w = weights[k];
        px += w * lit[at]; py += w * lit[at + 1]; pz += w * lit[at + 2];
        share += w * lit[at + 3];
        nx += w * lit[at + 4]; ny += w * lit[at + 5]; nz += w * lit[at + 6];
      }
      let x = 0, y = 0, z = 0;
      for (let k = i; k < i + 3; ++k) {
        const at = 8 * corners[k];
        const height = 0.5 * share * weights[k] * ((lit[at] - px) * lit[at + 4] + (lit[at + 1] - py) * lit[at + 5] +
          (lit[at + 2] - pz) * lit[at + 6]);
        x += height * lit[at + 4]; y += height * lit[at + 5]; z += height * lit[at + 6];
      }
      positions[i] = px + x;
      positions[i + 1] = py + y;
      positions[i + 2] = limits ? keptAboveGround(limits, pz + z, pz) : pz + z;
      normals[i] = nx; normals[i + 1] = ny; normals[i + 2] = nz;
    }
    setLengthsToOne(normals);
    this.placeOutward();
  }

  placeOutward() {
    const { lit, corners, weights, normals, outward } = this;
    for (let i = 0; i < corners.length; i += 3) {
      const to = 4 * i / 3;
      outward.set(normals.subarray(i, i + 3), to);
      outward[to + 3] = 0;
      for (let k = i; k < i + 3; ++k) outward[to + 3] += weights[k] * lit[8 * corners[k] + 7];
    }
  }
}

// Where the ground may not hide a body, in m, of a scene seen from this distance. As render/geometry/drawn_surface.cpp.
function groundLimits(distance) {
  return {
    mostSunk: Math.min(0.03, 0.03 * distance),  // a soft body that rests may be so far below
    justAbove: Math.min(0.002, 4e-4 * distance),
  };
}

// Nothing above the ground comes nearer to it than half its height; what is pressed into it is not hidden by it.
function keptAboveGround({ mostSunk, justAbove }, height, flatHeight) {
  return flatHeight <= -mostSunk ? height : Math.max(height, 0.5 * flatHeight, justAbove);
}

function setLengthsToOne(vectors) {
  for (let v = 0; v < vectors.length; v += 3) {
    const x = vectors[v], y = vectors[v + 1], z = vectors[v + 2];
    const over = 1 / (Math.sqrt(x * x + y * y + z * z) || 1);
    vectors[v] *= over; vectors[v + 1] *= over; vectors[v + 2] *= over;
  }
}
