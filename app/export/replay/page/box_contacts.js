// The dark between boxes that nearly touch. As render/light/box_contacts.cpp, but that faces turned away from the eye
// have it, too: it stays when the camera moves.

const reachOfSide = 1 / 6;   // of the shorter of two boxes' shortest sides
const boxTolerance = 1e-3;   // of a box's size, beside what the recording's positions are rounded by
const facePoints = 5;        // on a side of a face
const mostNear = 2;          // boxes
const noBox = [4, 4, 4, 1];  // as of one that is too far away to take any light

// {centre; axes, rows unit; half, m, of its sides; radius, shortest: half the shortest side}, or null if the eight
// corners are not a box's. `rounding`: m.
function boxOf(corners, rounding) {
  const edges = corners.slice(1).map((corner) => subtract(corner, corners[0]));
  const lengths = edges.map(norm);
  const tolerance = boxTolerance * 0.5 * Math.max(...lengths) + 2 * rounding;
  const perpendicular = (i, j) =>
    Math.abs(dot(edges[i], edges[j])) < tolerance * Math.max(lengths[i], lengths[j]);
  for (let i = 0; i < 7; ++i) {
    for (let j = i + 1; j < 7; ++j) {
      if (!perpendicular(i, j)) continue;
      for (let k = j + 1; k < 7; ++k) {
        if (!perpendicular(i, k) || !perpendicular(j, k)) continue;
        const box = boxOn(corners[0], [i, j, k].map((edge) => edges[edge]));
        if (box.shortest > tolerance && fitsBox(box, corners, tolerance)) return box;
      }
    }
  }
  return null;
}

function boxOn(corner, edges) {
  const half = edges.map((edge) => 0.5 * norm(edge));
  const centre = edges.reduce((sum, edge) => add(sum, scale(edge, 0.5)), corner);
  return { centre, axes: edges.map(normalize), half, radius: norm(half), shortest: Math.min(...half) };
}

function fitsBox(box, corners, tolerance) {
  return corners.every((corner) => box.axes.every((axis, i) =>
    Math.abs(Math.abs(dot(axis, subtract(corner, box.centre))) - box.half[i]) < tolerance));
}

const inAxes = ({ axes }, vector) => axes.map((axis) => dot(axis, vector));

// What a box takes of the light of a face, on average over points of it: in the box's axes, in which each is as far
// away as from a box along them.
function takenOfFace(box, middle, u, v, reach) {
  const [a, b, c] = box.half;
  const [mx, my, mz] = inAxes(box, subtract(middle, box.centre));
  const [ux, uy, uz] = inAxes(box, u), [vx, vy, vz] = inAxes(box, v);
  let sum = 0;
  for (let i = 0; i < facePoints; ++i) {
    for (let j = 0; j < facePoints; ++j) {
      const alongU = 2 * i / (facePoints - 1) - 1, alongV = 2 * j / (facePoints - 1) - 1;
      const x = Math.abs(mx + alongU * ux + alongV * vx) - a;
      const y = Math.abs(my + alongU * uy + alongV * vy) - b;
      const z = Math.abs(mz + alongU * uz + alongV * vz) - c;
      const ox = Math.max(x, 0), oy = Math.max(y, 0), oz = Math.max(z, 0);
      const distance = Math.sqrt(ox * ox + oy * oy + oz * oz) + Math.min(Math.max(x, y, z), 0);
      sum += Math.min(Math.max(0.5 - 0.5 * distance / reach, 0), 1);
    }
  }
  return sum / facePoints ** 2;
}

// Whether all of a box lies behind a face or beyond `room` from its middle.
function isAway({ centre, axes, half, radius }, middle, normal, room) {
  const x = centre[0] - middle[0], y = centre[1] - middle[1], z = centre[2] - middle[2];
  if (x * x + y * y + z * z > (radius + room) ** 2) return true;
  let highest = x * normal[0] + y * normal[1] + z * normal[2];
  for (let i = 0; i < 3; ++i) highest += half[i] * Math.abs(dot(axes[i], normal));
  return highest < 0;
}

// Along each axis in units in which the box is a cube; along the one towards the face in reaches.
function inBox({ centre, axes, half }, point, normal, reach) {
  const towards = axes.map((axis) => Math.abs(dot(axis, normal)));
  const side = half[towards.indexOf(Math.max(...towards))] / reach;
  const away = subtract(add(point, scale(normal, reach)), centre);
  return [...axes.map((axis, i) => side * dot(axis, away) / half[i]), side];
}

class BoxContacts {
  constructor(recording, surface) {
    this.surface = surface;
    this.rounding = recording.header.lattice.max_error;
    this.meshes = surface.flatMeshes.filter(({ vertices, triangles }) => vertices === 8 && triangles.length === 36);
    this.near = new Float32Array(4 * mostNear * surface.corners.length / 3);  // of the points
  }

  // Whether a box can be near another.
  get any() { return this.meshes.length > 1; }

  // `positions`: of the vertices. After the surface has been placed.
  find(positions) {
    const { near, meshes, rounding } = this;
    for (let i = 0; i < near.length; ++i) near[i] = noBox[i % 4];
    this.bodies = [];
    for (const mesh of meshes) {
      const place = (v) => Array.from(positions.subarray(3 * (mesh.first + v), 3 * (mesh.first + v) + 3));
      const box = boxOf([0, 1, 2, 3, 4, 5, 6, 7].map(place), rounding);
      if (box) this.bodies.push({ box, mesh, low: box.centre[0] - box.radius, near: [] });
    }
    this.findNeighbours();
    for (const body of this.bodies) {
      for (let axis = 0; axis < 3 && body.near.length > 0; ++axis) {
        for (const sign of [1, -1]) this.darkenFace(body, axis, scale(body.box.axes[axis], sign));
      }
    }
  }

  // Sweep and prune along x, with the balls around the boxes.
  findNeighbours() {
    const { bodies } = this;
    bodies.sort((a, b) => a.low - b.low);
    bodies.forEach((body, i) => {
      const { box } = body;
      const room = box.radius + 4 * reachOfSide * box.shortest;
      for (let j = i + 1; j < bodies.length && bodies[j].low <= box.centre[0] + room; ++j) {
        const other = bodies[j].box;
        if (norm(subtract(other.centre, box.centre)) > room + other.radius) continue;
        body.near.push(other);
        bodies[j].near.push(box);
      }
    });
  }

  darkenFace({ box, mesh, near }, axis, normal) {
    const [u, v] = [(axis + 1) % 3, (axis + 2) % 3].map((i) => scale(box.axes[i], box.half[i]));
    const size = Math.hypot(norm(u), norm(v)), middle = add(box.centre, scale(normal, box.half[axis]));
    const taking = [];
    for (const other of near) {
      const reach = reachOfSide * 2 * Math.min(box.shortest, other.shortest);
      if (isAway(other, middle, normal, size + 2 * reach)) continue;
      const taken = takenOfFace(other, add(middle, scale(normal, reach)), u, v, reach);
      if (taken > 0) taking.push({ other, reach, taken });
    }
    if (taking.length === 0) return;
    taking.sort((a, b) => b.taken - a.taken).splice(mostNear);
    const { positions, normals } = this.surface;
    for (let point = mesh.firstPoint; point < mesh.firstPoint + mesh.triangles.length; ++point) {
      const x = 3 * point, y = x + 1, z = x + 2;
      if (normals[x] * normal[0] + normals[y] * normal[1] + normals[z] * normal[2] < 0.99) continue;
      const place = [positions[x], positions[y], positions[z]];
      taking.forEach(({ other, reach }, k) =>
        this.near.set(inBox(other, place, normal, reach), 4 * (mostNear * point + k)));
    }
  }
}
