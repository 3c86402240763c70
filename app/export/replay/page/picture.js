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
    const gl = canvas.getContext("webgl2", { alpha: false, antialias: false });
    if (!gl) throw new Error("This browser has no WebGL 2, which the picture is drawn with.");
    this.gl = gl;
    this.canvas = canvas;
    this.recording = recording;
    const { scenery, shaders } = recording.header;
    this.scenery = scenery;
    this.hasGround = scenery.grid_spacing !== null;
    this.groundLimits = this.hasGround ? groundLimits(norm(subtract(scenery.eye, scenery.target))) : null;
    this.toLight = normalize(scale(scenery.light, -1));
    this.surface = new Surface(recording);
    if (scenery.shadows) {
      this.map = new ShadowMap(gl, scenery);
      if (scenery.between_bodies) {
        this.between = new BetweenBodies(gl, recording, this.surface, shaders);
        const contacts = new BoxContacts(recording, this.surface);
        if (contacts.any) this.boxContacts = contacts;
      }
      // Light along the ground or from below throws no shadow on it.
      if (this.hasGround && this.toLight[2] > 0.05) this.groundShadow = new GroundShadow(gl, shaders);
    }
    this.backdrop = new FullScreen(gl, backdropFragment, shaders.look);
    this.ground = new Program(gl, shaders.ground, shaders.look + shaders.nearness);
    this.groundDepth = new Program(gl, groundDepth);
    const defines = ["SMOOTH", ...(scenery.shadows ? ["SHADOWED"] : []), ...(this.boxContacts ? ["NEAR_BOXES"] : [])];
    this.surfaces = new Program(gl, shaders.surface, shaders.look, defines);
    this.outlines = new Outlines(gl, shaders, defines, this.surface, this.between, this.boxContacts);
    this.discs = new Program(gl, shaders.disc);
    this.lines = new Program(gl, shaders.line);
    this.groundVertices = new Vertices(gl, [2]);
    this.discVertices = new Vertices(gl, [3, 3, 1], 1);
    this.lineVertices = new Vertices(gl, [3, 3, 3, 1], 1);
    this.makeBuffers();
  }

  // As render/passes/surface_buffers.cpp.
  makeBuffers() {
    const gl = this.gl;
    this.vertices = gl.createVertexArray();
    gl.bindVertexArray(this.vertices);
    const attribute = (location, size, buffer, stride = 0, offset = 0) => {
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
      gl.enableVertexAttribArray(location);
      gl.vertexAttribPointer(location, size, gl.FLOAT, false, stride, offset);
      return buffer;
    };
    this.positionBuffer = attribute(0, 3, gl.createBuffer());
    this.normalBuffer = attribute(1, 4, gl.createBuffer());
    attribute(2, 4, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, this.surface.materials, gl.STATIC_DRAW);
    if (this.between) {
      attribute(3, 3, this.between.points.light, 20, 0);
      attribute(4, 2, this.between.points.light, 20, 12);
    } else {
      setUsualLight(gl, 3, 4);
    }
    if (this.boxContacts) {
      this.nearBuffer = attribute(5, 4, gl.createBuffer(), 32, 0);
      attribute(6, 4, this.nearBuffer, 32, 16);
    }
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, this.surface.triangles, gl.STATIC_DRAW);
    gl.bindVertexArray(null);
  }

  // All of a frame that does not depend on the camera.
  load(frame, rounded) {
    const { gl, recording, surface, map, between, groundShadow, boxContacts } = this;
    const positions = recording.positionsAt(frame);
    surface.place(positions, rounded ? recording.sharesAt(frame) : null, this.groundLimits);
    this.casters = boxAround(surface.positions);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.positionBuffer);
    gl.bufferData(gl.ARRAY_BUFFER, surface.positions, gl.STREAM_DRAW);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.normalBuffer);
    gl.bufferData(gl.ARRAY_BUFFER, surface.outward, gl.STREAM_DRAW);
    if (!map) return;
    map.draw(() => this.drawTriangles(), this.casters);
    between?.takeBodies(positions, map, Boolean(groundShadow));
    groundShadow?.draw(map, between, () => this.drawAll());
    between?.lightSurface(groundShadow);
    if (!boxContacts) return;
    boxContacts.find(positions);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.nearBuffer);
    gl.bufferData(gl.ARRAY_BUFFER, boxContacts.near, gl.STREAM_DRAW);
  }

  drawTriangles() {
    this.gl.bindVertexArray(this.vertices);
    this.gl.drawElements(this.gl.TRIANGLES, this.surface.triangles.length, this.gl.UNSIGNED_INT, 0);
  }

  // The triangles, and also their corners.
  drawAll() {
    this.drawTriangles();
    this.gl.drawArrays(this.gl.POINTS, 0, this.surface.positions.length / 3);
  }

  draw(frame, camera, show) {
    const { gl, canvas, recording } = this;
    // Edges and particles are shown where they are simulated, and lie on the surface only if it is.
    const rounded = !show.wireframe && !show.particles && !show.contacts;
    if (this.loaded !== frame || this.rounded !== rounded) this.load(frame, rounded);
    Object.assign(this, { loaded: frame, rounded });
    const view = camera.view(canvas.width, canvas.height, this.casters);
    this.outlines.find(view);
    const groundSeen = this.hasGround && view.eye[2] > 0;
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.viewport(0, 0, canvas.width, canvas.height);
    this.backdrop.draw({ picture_height: view.height });
    if (groundSeen) this.drawGround(view);
    if (groundSeen) this.groundShadow?.darken(view);
    this.drawSurfaces(view, groundSeen && this.groundHides(view, !rounded), show.wireframe);
    if (show.wireframe) this.drawLines(view, this.edgesOf(), 0.7);
    if (show.contacts) this.drawLines(view, recording.normalsAt(frame).map((line) => ({ ...line, width: 1.5 })), 1);
    const points = [];
    if (show.particles) points.push(...recording.marksAt(recording.particles, frame));
    if (show.contacts) points.push(...recording.marksAt(recording.contacts, frame));
    if (points.length > 0) this.drawDiscs(view, points);
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

  // Whether it hides anything that would be seen without it: what stands on it is drawn above it, but lines and discs
  // are wider than what they stand for. As render/renderer.cpp.
  groundHides(view, marks) {
    const pixel = 2 * view.nearest / (view.projection[5] * view.height);
    return marks || this.casters.min[2] < -0.1 * pixel;
  }

  drawSurfaces(view, groundHides, underLines) {
    const { gl, map } = this;
    gl.disable(gl.BLEND);
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LESS);
    gl.depthMask(true);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    if (groundHides) {  // its depth alone, so that what lies below is not drawn
      gl.colorMask(false, false, false, false);
      this.groundDepth.use({ view_projection: view.viewProjection });
      this.groundVertices.draw(gl.TRIANGLE_STRIP, this.groundPlaces(view));
      gl.colorMask(true, true, true, true);
    }
    const values = { view_projection: view.viewProjection, eye: view.eye, to_light: this.toLight };
    if (map) {
      bindTexture(gl, 0, map.depth, map.comparing);
      Object.assign(values, {
        map: 0, world_to_map: map.worldToMap, edge: Math.min(0.5 * map.edge, 2.2 / shadowSize), texel: 1 / shadowSize,
        lean_scale: [(map.extent / map.range) ** 2, 0.1 / map.range, 0.5 * map.extent / map.range] });
    }
    gl.enable(gl.CULL_FACE);
    gl.cullFace(gl.BACK);
    if (underLines) gl.enable(gl.POLYGON_OFFSET_FILL);
    gl.polygonOffset(1, 0);  // by what the depth changes over one pixel
    this.surfaces.use(values);
    this.drawTriangles();
    gl.disable(gl.POLYGON_OFFSET_FILL);
    gl.disable(gl.CULL_FACE);
    this.outlines.draw({ ...values, picture_size: [view.width, view.height] });
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
