// Shadows: what the light sees, and the shadow on the ground. As render/passes/shadow_map.cpp and ground_shadow.cpp.

const shadowSize = 768;  // texels on a side of the map
const coverSize = 160;   // of the ground's shadow, which is blurred

const depthShaders = {
  vertex: `layout(location = 0) in vec3 position;
uniform mat4 world_to_clip;
void main() { gl_Position = world_to_clip * vec4(position, 1.0); }`,
  fragment: "void main() {}",
};

const fullScreenVertex = `out vec2 at;
void main() {
  at = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0;
  gl_Position = vec4(at * 2.0 - 1.0, 0.0, 1.0);
}`;

// Red: how much of the light is blocked. Green: that times how soft the shadow is to be.
const coverFragment = `uniform highp sampler2D depths;
uniform vec3 ground;
uniform float softness;
out vec4 cover;
void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  ivec2 from = texel * ${shadowSize} / ${coverSize};
  ivec2 to = (texel + 1) * ${shadowSize} / ${coverSize};
  float nearest = 1.0;
  float sum = 0.0;
  for (int y = from.y; y < to.y; ++y) {
    for (int x = from.x; x < to.x; ++x) {
      float depth = texelFetch(depths, ivec2(x, y), 0).r;
      nearest = min(nearest, depth);
      if (depth < 1.0) sum += 1.0;
    }
  }
  float share = sum / float((to.x - from.x) * (to.y - from.y));
  float below = dot(ground, vec3(gl_FragCoord.xy / ${coverSize}.0, 1.0)) - nearest;
  cover = vec4(share, share * clamp(below * softness, 0.0, 1.0), 0.0, 1.0);
}`;

// Nine binomial weights, `stride` apart.
const blurFragment = `in vec2 at;
uniform sampler2D picture;
uniform vec2 stride;
out vec4 blurred;
void main() {
  float weights[5] = float[5](70.0, 56.0, 28.0, 8.0, 1.0);
  vec4 sum = texture(picture, at) * weights[0];
  for (int i = 1; i < 5; ++i) {
    vec2 away = stride * float(i);
    sum += (texture(picture, at + away) + texture(picture, at - away)) * weights[i];
  }
  blurred = sum / 256.0;
}`;

// What is left of the ground's colour.
const leftFragment = `in vec2 at;
uniform sampler2D narrow;
uniform sampler2D wide;
uniform float light_z;
out vec4 left;
void main() {
  vec4 w = texture(wide, at);
  float blocked = mix(texture(narrow, at).r, w.r, w.g / max(w.r, 0.004));
  vec3 direct = sun * light_z;
  left = vec4(pow(1.0 - clamp(blocked, 0.0, 1.0) * direct / (sky_irradiance(1.0) + direct), vec3(1.0 / 2.2)), 1.0);
}`;

class Shadows {
  constructor(gl, scenery, shaders) {
    this.gl = gl;
    this.scenery = scenery;
    this.toLight = normalize(scale(scenery.light, -1));
    this.depthProgram = new Program(gl, depthShaders);
    const filter = (fragment, before = "") => new Program(gl, { vertex: fullScreenVertex, fragment }, before);
    this.cover = filter(coverFragment);
    this.blur = filter(blurFragment);
    this.left = filter(leftFragment, shaders.look);
    this.onGround = new Program(gl, shaders.ground_shadow, shaders.nearness);
    this.quad = new Vertices(gl, [2]);
    this.nothing = gl.createVertexArray();
    this.makeMap();
    this.scratch = new DrawnTexture(gl, coverSize);
    this.narrow = new DrawnTexture(gl, coverSize);
    this.wide = new DrawnTexture(gl, coverSize);
    this.result = new DrawnTexture(gl, coverSize);
  }

  makeMap() {
    const gl = this.gl;
    this.depth = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, this.depth);
    gl.texStorage2D(gl.TEXTURE_2D, 1, gl.DEPTH_COMPONENT32F, shadowSize, shadowSize);
    this.framebuffer = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.framebuffer);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, this.depth, 0);
    const sampler = (filter, compare) => {
      const name = gl.createSampler();
      for (const side of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.samplerParameteri(name, side, gl.CLAMP_TO_EDGE);
      for (const way of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.samplerParameteri(name, way, filter);
      gl.samplerParameteri(name, gl.TEXTURE_COMPARE_MODE, compare);
      gl.samplerParameteri(name, gl.TEXTURE_COMPARE_FUNC, gl.LEQUAL);
      return name;
    };
    this.comparing = sampler(gl.LINEAR, gl.COMPARE_REF_TO_TEXTURE);
    this.reading = sampler(gl.NEAREST, gl.NONE);
  }

  fit(casters) {
    const z = scale(this.toLight, -1);
    const x = normalize(cross(Math.abs(z[2]) < 0.9 ? [0, 0, 1] : [1, 0, 0], z));
    const axes = [x, cross(x, z), z];
    const seen = boxAround(corners(casters).flatMap((corner) => axes.map((axis) => dot(axis, corner))));
    const size = subtract(seen.max, seen.min);
    const span = Math.max(size[0], size[1], 1e-6);
    const { softness } = this.scenery;
    this.extent = span + 2 * (softness + 0.02) * span;
    this.edge = 0.5 * softness * span / this.extent;
    const depthPad = 0.01 * size[2] + 1e-6;
    this.range = size[2] + 2 * depthPad;
    const units = [this.extent, this.extent, this.range];
    const middle = scale(add(seen.min, seen.max), 0.5);
    const origin = [middle[0] - 0.5 * this.extent, middle[1] - 0.5 * this.extent, seen.min[2] - depthPad];
    this.axes = axes;
    this.units = units;
    this.offset = origin.map((value, axis) => -value / units[axis]);
    this.worldToMap = affine(axes.map((axis, i) => scale(axis, 1 / units[i])), this.offset);
  }

  // The map's texels at the ground, as seen along the light.
  groundCorner(u, v) {
    const inMap = subtract([u, v, 0], this.offset);
    const world = this.axes.reduce((sum, axis, i) => add(sum, scale(axis, this.units[i] * inMap[i])), [0, 0, 0]);
    return subtract(world, scale(this.toLight, world[2] / this.toLight[2])).slice(0, 2);
  }

  drawMap(drawMeshes, casters) {
    const gl = this.gl;
    this.fit(casters);
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.framebuffer);
    gl.viewport(0, 0, shadowSize, shadowSize);
    gl.disable(gl.BLEND);
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LESS);
    gl.depthMask(true);
    gl.enable(gl.CULL_FACE);
    gl.cullFace(gl.FRONT);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    const mapToClip = affine([[2, 0, 0], [0, 2, 0], [0, 0, 2]], [-1, -1, -1]);
    this.depthProgram.use({ world_to_clip: multiply(mapToClip, this.worldToMap) });
    drawMeshes();
    gl.disable(gl.CULL_FACE);
  }

  drawGroundShadow() {
    const gl = this.gl;
    gl.disable(gl.DEPTH_TEST);
    gl.bindVertexArray(this.nothing);
    const normal = this.axes.map((axis, i) => axis[2] * this.units[i]);
    const ground = [-normal[0] / normal[2], -normal[1] / normal[2], dot(normal, this.offset) / normal[2]];
    bindTexture(gl, 0, this.depth, this.reading);
    this.filter(this.cover, this.scratch, { depths: 0, ground, softness: this.range / (0.35 * this.extent) });
    const wide = 0.4 * this.edge * coverSize;
    this.blurInto(this.narrow, this.scratch, Math.min(0.5 * wide, 1));
    this.blurInto(this.wide, this.narrow, wide);
    bindTexture(gl, 0, this.narrow.texture);
    bindTexture(gl, 1, this.wide.texture);
    this.filter(this.left, this.result, { narrow: 0, wide: 1, light_z: this.toLight[2] });
  }

  filter(program, target, values) {
    target.begin();
    program.use(values);
    this.gl.drawArrays(this.gl.TRIANGLES, 0, 3);
  }

  // Across, then upwards. The result texture holds what is between.
  blurInto(target, source, texels) {
    const gl = this.gl;
    bindTexture(gl, 0, source.texture);
    this.filter(this.blur, this.result, { picture: 0, stride: [texels / coverSize, 0] });
    bindTexture(gl, 0, this.result.texture);
    this.filter(this.blur, target, { picture: 0, stride: [0, texels / coverSize] });
  }

  darkenGround(view) {
    const gl = this.gl;
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ZERO, gl.SRC_COLOR);
    bindTexture(gl, 0, this.result.texture);
    this.onGround.use({ view_projection: view.viewProjection, world_to_map: this.worldToMap, shadow: 0,
      centre: view.target.slice(0, 2), radius: view.groundRadius });
    const places = [[0, 0], [1, 0], [0, 1], [1, 1]].flatMap(([u, v]) => this.groundCorner(u, v));
    this.quad.draw(gl.TRIANGLE_STRIP, places);
  }
}
