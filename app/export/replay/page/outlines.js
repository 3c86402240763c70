// Smooth outlines and creases with one sample a pixel. As render/geometry/outline.cpp and render/passes/outlines.cpp.

const alike = 0.99;  // cosine between normals of faces that look alike

class Outlines {
  // `between`, `boxContacts`: undefined where there is no such light.
  constructor(gl, shaders, defines, surface, between, boxContacts) {
    Object.assign(this, { gl, surface, between, boxContacts });
    this.program = new Program(gl, { vertex: shaders.outline, fragment: shaders.surface.fragment }, shaders.look,
      [...new Set([...defines, "NEAR_BOXES", "OUTLINE"])]);
    this.facing = new Uint8Array(surface.triangles.length / 3);
    this.ends = between ? new LitPoints(gl) : null;
    this.makeBuffers();
  }

  // Of each outline both ends, but for their light, and the normal of the triangle on its left.
  makeBuffers() {
    const { gl, ends, boxContacts } = this;
    const ofEnd = [[0, 3], [1, 4], [2, 4], ...(boxContacts ? [[5, 4], [6, 4]] : [])];  // locations and sizes
    const to = 7, facet = 14;  // locations
    const ofOutline = [...ofEnd, ...ofEnd.map(([location, size]) => [to + location, size]), [facet, 3]];
    this.vertices = gl.createVertexArray();
    gl.bindVertexArray(this.vertices);
    this.buffer = gl.createBuffer();
    this.stride = this.attributes(this.buffer, ofOutline);
    if (ends) this.attributes(ends.light, [[3, 3], [4, 2], [to + 3, 3], [to + 4, 2]]);
    for (const first of [0, to]) {
      if (!ends) setUsualLight(gl, first + 3, first + 4);
      if (!boxContacts) for (const i of [5, 6]) gl.vertexAttrib4f(first + i, ...noBox);
    }
    gl.bindVertexArray(null);
  }

  // Side by side. Returns how many floats they have.
  attributes(buffer, locationsAndSizes) {
    const gl = this.gl;
    const stride = locationsAndSizes.reduce((sum, [, size]) => sum + size, 0);
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    let offset = 0;
    for (const [location, size] of locationsAndSizes) {
      gl.enableVertexAttribArray(location);
      gl.vertexAttribPointer(location, size, gl.FLOAT, false, 4 * stride, 4 * offset);
      gl.vertexAttribDivisor(location, 1);
      offset += size;
    }
    return stride;
  }

  // Before anything is drawn.
  find(view) {
    this.findFacing(view.eye);
    const { facing, surface: { sides, normals, positions } } = this;
    const differ = (p, q) => p !== q && normals[3 * p] * normals[3 * q] + normals[3 * p + 1] * normals[3 * q + 1] +
      normals[3 * p + 2] * normals[3 * q + 2] < alike;
    const { view: axes, near } = view;  // the third row is of the depth
    const isAhead = (p) =>
      axes[2] * positions[3 * p] + axes[6] * positions[3 * p + 1] + axes[10] * positions[3 * p + 2] + axes[14] < -near;
    this.found = [];
    for (let i = 0; i < sides.length; i += 6) {
      const first = facing[sides[i + 2]], second = facing[sides[i + 5]];
      if (!first && !second) continue;
      if (first && second && !differ(sides[i], sides[i + 4]) && !differ(sides[i + 1], sides[i + 3])) continue;
      const side = first ? i : i + 3;
      if (isAhead(sides[side]) && isAhead(sides[side + 1])) this.found.push(side);
    }
    this.load();
  }

  findFacing(eye) {
    const { facing, surface: { triangles, positions: x } } = this;
    for (let t = 0; t < facing.length; ++t) {
      const a = 3 * triangles[3 * t], b = 3 * triangles[3 * t + 1], c = 3 * triangles[3 * t + 2];
      const px = x[b] - x[a], py = x[b + 1] - x[a + 1], pz = x[b + 2] - x[a + 2];
      const qx = x[c] - x[a], qy = x[c + 1] - x[a + 1], qz = x[c + 2] - x[a + 2];
      facing[t] = (py * qz - pz * qy) * (eye[0] - x[a]) + (pz * qx - px * qz) * (eye[1] - x[a + 1]) +
        (px * qy - py * qx) * (eye[2] - x[a + 2]) > 0;
    }
  }

  load() {
    const { gl, found, stride, ends, boxContacts, surface } = this;
    const floats = new Float32Array(stride * found.length);
    let at = 0;
    const put = (values, size, number) => {
      floats.set(values.subarray(size * number, size * (number + 1)), at);
      at += size;
    };
    for (const side of found) {
      for (const point of surface.sides.subarray(side, side + 2)) {
        put(surface.positions, 3, point);
        put(surface.outward, 4, point);
        put(surface.materials, 4, point);
        if (boxContacts) put(boxContacts.near, 4 * mostNear, point);
      }
      put(this.facet(surface.sides[side + 2]), 3, 0);
    }
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
    gl.bufferData(gl.ARRAY_BUFFER, floats, gl.STREAM_DRAW);
    if (!ends || found.length === 0) return;
    const corners = new Uint32Array(6 * found.length), weights = new Float32Array(6 * found.length);
    corners.forEach((unused, i) => {
      const from = 3 * surface.sides[found[Math.floor(i / 6)] + Math.floor(i / 3) % 2] + i % 3;
      corners[i] = surface.corners[from];
      weights[i] = surface.weights[from];
    });
    ends.load(corners, weights);
    this.between.spreadTo(ends);
  }

  // Its normal.
  facet(triangle) {
    const { positions, triangles } = this.surface;
    const [a, b, c] = [0, 1, 2].map((i) => {
      const at = 3 * triangles[3 * triangle + i];
      return [positions[at], positions[at + 1], positions[at + 2]];
    });
    const across = cross(subtract(b, a), subtract(c, a));
    return new Float32Array(scale(across, 1 / (norm(across) || 1)));
  }

  // Over the surfaces. `values`: those of the program that draws them.
  draw(values) {
    const { gl, found } = this;
    if (found.length === 0) return;
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    gl.depthFunc(gl.LEQUAL);
    gl.depthMask(false);
    this.program.use(values);
    gl.bindVertexArray(this.vertices);
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, found.length);
  }
}
