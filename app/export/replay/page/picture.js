// The picture: the passes of render/renderer.cpp, by its own shaders.

const backdropFragment = `uniform float picture_height;
out vec4 colour;
void main() { colour = vec4(backdrop(gl_FragCoord.y / picture_height), 1.0); }`;

const groundDepth = {
  vertex: `layout(location = 0) in vec2 position;
uniform mat4 view_projection;
void main() { gl_Position = view_projection * vec4(position, 0.0, 1.0); }`,
  fragment: "void main() {}",
};

const ink = [0.09, 0.10, 0.12];  // of the wireframe

// Pixels: in small pictures discs shrink no further. As in render/passes/discs.cpp.
const readable = 5;

class Picture {
  constructor(canvas, recording) {
    const gl = canvas.getContext("webgl2", { alpha: false, antialias: true });
    if (!gl) throw new Error("This browser has no WebGL 2, which the picture is drawn with.");
    this.gl = gl;
    this.canvas = canvas;
    this.recording = recording;
    this.scenery = recording.header.scenery;
    const { shaders } = recording.header;
    this.toLight = normalize(scale(this.scenery.light, -1));
    this.shadows = new Shadows(gl, this.scenery, shaders);
    this.backdrop = new Program(gl, { vertex: fullScreenVertex, fragment: backdropFragment }, shaders.look);
    this.ground = new Program(gl, shaders.ground, shaders.look + shaders.nearness);
    this.groundDepth = new Program(gl, groundDepth);
    const shadowed = this.scenery.shadows ? ["SHADOWED"] : [];
    this.smooth = new Program(gl, shaders.surface, shaders.look, ["SMOOTH", ...shadowed]);
    this.flat = new Program(gl, shaders.surface, shaders.look, shadowed);
    this.discs = new Program(gl, shaders.disc);
    this.lines = new Program(gl, shaders.line);
    this.nothing = gl.createVertexArray();
    this.groundVertices = new Vertices(gl, [2]);
    this.discVertices = new Vertices(gl, [3, 3, 1], 1);
    this.lineVertices = new Vertices(gl, [3, 3, 3, 1], 1);
    this.makeMeshes();
  }

  makeMeshes() {
    const gl = this.gl;
    const { materials, smooth, flat, vertexCount } = this.recording;
    this.normals = new Float32Array(3 * vertexCount);
    this.meshes = gl.createVertexArray();
    gl.bindVertexArray(this.meshes);
    const attribute = (location, data, size = 3) => {
      const buffer = gl.createBuffer();
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
      if (data) gl.bufferData(gl.ARRAY_BUFFER, data, gl.STATIC_DRAW);
      gl.enableVertexAttribArray(location);
      gl.vertexAttribPointer(location, size, gl.FLOAT, false, 0, 0);
      return buffer;
    };
    this.positionBuffer = attribute(0);
    this.normalBuffer = attribute(1);
    attribute(2, materials, 4);
    // Light between bodies is left out: nothing comes from them, and all of sky and ground is seen.
    gl.vertexAttrib3f(3, 0, 0, 0);
    gl.vertexAttrib2f(4, 1, 1);
    const indices = new Uint32Array(smooth.length + flat.length);
    indices.set(smooth);
    indices.set(flat, smooth.length);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, indices, gl.STATIC_DRAW);
    gl.bindVertexArray(null);
  }

  // Each vertex's from the areas of the triangles around it.
  findNormals(positions) {
    const { normals, recording: { smooth } } = this;
    normals.fill(0);
    for (let t = 0; t < smooth.length; t += 3) {
      const [a, b, c] = [3 * smooth[t], 3 * smooth[t + 1], 3 * smooth[t + 2]];
      const ux = positions[b] - positions[a], vx = positions[c] - positions[a];
      const uy = positions[b + 1] - positions[a + 1], vy = positions[c + 1] - positions[a + 1];
      const uz = positions[b + 2] - positions[a + 2], vz = positions[c + 2] - positions[a + 2];
      const x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
      for (const v of [a, b, c]) {
        normals[v] += x;
        normals[v + 1] += y;
        normals[v + 2] += z;
      }
    }
    for (let v = 0; v < normals.length; v += 3) {
      const length = Math.hypot(normals[v], normals[v + 1], normals[v + 2]) || 1;
      for (let axis = 0; axis < 3; ++axis) normals[v + axis] /= length;
    }
  }

  load(frame) {
    const gl = this.gl;
    const positions = this.recording.positionsAt(frame);
    this.findNormals(positions);
    this.casters = boxAround(positions);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.positionBuffer);
    gl.bufferData(gl.ARRAY_BUFFER, positions, gl.STREAM_DRAW);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.normalBuffer);
    gl.bufferData(gl.ARRAY_BUFFER, this.normals, gl.STREAM_DRAW);
    this.loaded = frame;
  }

  drawMeshes(begin, count) {
    const gl = this.gl;
    gl.bindVertexArray(this.meshes);
    if (count > 0) gl.drawElements(gl.TRIANGLES, count, gl.UNSIGNED_INT, 4 * begin);
  }

  draw(frame, camera, show) {
    const { gl, canvas, scenery, recording } = this;
    if (this.loaded !== frame) this.load(frame);
    const view = camera.view(canvas.width, canvas.height, this.casters);
    const groundSeen = scenery.grid_spacing !== null && view.eye[2] > 0;
    const groundShadow = scenery.shadows && scenery.grid_spacing !== null && this.toLight[2] > 0.05;
    if (scenery.shadows) {
      const all = recording.smooth.length + recording.flat.length;
      this.shadows.drawMap(() => this.drawMeshes(0, all), this.casters);
      if (groundShadow) this.shadows.drawGroundShadow();
    }
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.viewport(0, 0, canvas.width, canvas.height);
    this.drawBackdrop(view);
    if (groundSeen) this.drawGround(view);
    if (groundSeen && groundShadow) this.shadows.darkenGround(view);
    this.drawSurfaces(view, groundSeen);
    if (show.wireframe) this.drawLines(view, this.edgesOf(), 0.7);
    if (show.contacts) this.drawLines(view, recording.normalsAt(frame).map((line) => ({ ...line, width: 1.5 })), 1);
    const points = [];
    if (show.particles) points.push(...recording.marksAt(recording.particles, frame));
    if (show.contacts) points.push(...recording.marksAt(recording.contacts, frame));
    if (points.length > 0) this.drawDiscs(view, points);
  }

  drawBackdrop(view) {
    const gl = this.gl;
    gl.disable(gl.BLEND);
    gl.disable(gl.DEPTH_TEST);
    this.backdrop.use({ picture_height: view.height });
    gl.bindVertexArray(this.nothing);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  }

  groundPlaces(view) {
    const [x, y] = view.target;
    const r = view.groundRadius;
    return [x - r, y - r, x + r, y - r, x - r, y + r, x + r, y + r];
  }

  drawGround(view) {
    this.ground.use({ view_projection: view.viewProjection, picture_height: view.height,
      spacing: this.scenery.grid_spacing, centre: view.target.slice(0, 2), radius: view.groundRadius,
      line_width: view.pixelScale });
    this.groundVertices.draw(this.gl.TRIANGLE_STRIP, this.groundPlaces(view));
  }

  drawSurfaces(view, groundSeen) {
    const { gl, shadows, recording: { smooth, flat } } = this;
    gl.disable(gl.BLEND);
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LESS);
    gl.depthMask(true);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    if (groundSeen) {  // its depth alone, so that what lies below is not drawn
      gl.colorMask(false, false, false, false);
      this.groundDepth.use({ view_projection: view.viewProjection });
      this.groundVertices.draw(gl.TRIANGLE_STRIP, this.groundPlaces(view));
      gl.colorMask(true, true, true, true);
    }
    const values = { view_projection: view.viewProjection, eye: view.eye, to_light: this.toLight };
    if (this.scenery.shadows) {
      bindTexture(gl, 0, shadows.depth, shadows.comparing);
      Object.assign(values, { map: 0, world_to_map: shadows.worldToMap,
        edge: Math.min(0.5 * shadows.edge, 2.2 / shadowSize) });
    }
    gl.enable(gl.CULL_FACE);
    gl.cullFace(gl.BACK);
    this.smooth.use(values);
    this.drawMeshes(0, smooth.length);
    this.flat.use(values);
    this.drawMeshes(smooth.length, flat.length);
    gl.disable(gl.CULL_FACE);
  }

  beginQuads(program, view, opacity) {
    const gl = this.gl;
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    gl.depthMask(false);
    program.use({ view: view.view, projection: view.projection, picture_size: [view.width, view.height],
      near: view.near, opacity });
  }

  edgesOf() {
    const { positions, edges } = this.recording;
    const place = (v) => [positions[3 * v], positions[3 * v + 1], positions[3 * v + 2]];
    const lines = [];
    for (let e = 0; e < edges.length; e += 2) {
      lines.push({ from: place(edges[e]), to: place(edges[e + 1]), colour: ink, width: 1.1 });
    }
    return lines;
  }

  drawLines(view, lines, opacity) {
    if (lines.length === 0) return;
    this.beginQuads(this.lines, view, opacity);
    this.gl.depthFunc(this.gl.LESS);
    this.lineVertices.drawQuads(lines.flatMap(({ from, to, colour, width }) =>
      [...from, ...to, ...colour, width * view.pixelScale]));
  }

  // Far ones first; what is hidden shines through.
  drawDiscs(view, points) {
    const gl = this.gl;
    const forward = subtract(view.target, view.eye);
    points.sort((a, b) => dot(b.position, forward) - dot(a.position, forward));
    const floats = points.flatMap(({ position, colour, diameter }) =>
      [...position, ...colour, 0.5 * Math.max(diameter * view.pixelScale, Math.min(diameter, readable))]);
    this.beginQuads(this.discs, view, 0.55);
    gl.depthFunc(gl.GEQUAL);
    this.discVertices.drawQuads(floats);
    this.beginQuads(this.discs, view, 1);
    gl.depthFunc(gl.LESS);
    this.discVertices.drawQuads(floats);
  }
}
