// What the light sees: depth along the light. As render/passes/shadow_map.cpp.

const shadowSize = 768;  // texels on a side of the map

const depthShaders = {
  vertex: `layout(location = 0) in vec3 position;
uniform mat4 world_to_clip;
void main() { gl_Position = world_to_clip * vec4(position, 1.0); }`,
  fragment: "void main() {}",
};

class ShadowMap {
  constructor(gl, scenery) {
    this.gl = gl;
    this.scenery = scenery;
    this.toLight = normalize(scale(scenery.light, -1));
    this.program = new Program(gl, depthShaders);
    this.depth = makeTexture(gl, gl.DEPTH_COMPONENT32F, shadowSize, shadowSize, gl.NEAREST);
    this.framebuffer = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.framebuffer);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, this.depth, 0);
    this.comparing = gl.createSampler();
    const set = (name, value) => gl.samplerParameteri(this.comparing, name, value);
    for (const side of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) set(side, gl.CLAMP_TO_EDGE);
    for (const way of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) set(way, gl.LINEAR);
    set(gl.TEXTURE_COMPARE_MODE, gl.COMPARE_REF_TO_TEXTURE);
    set(gl.TEXTURE_COMPARE_FUNC, gl.LEQUAL);
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

  // Where the light that passes a point of the map meets the ground.
  onGround(u, v) {
    const inMap = subtract([u, v, 0], this.offset);
    const world = this.axes.reduce((sum, axis, i) => add(sum, scale(axis, this.units[i] * inMap[i])), [0, 0, 0]);
    return subtract(world, scale(this.toLight, world[2] / this.toLight[2])).slice(0, 2);
  }

  draw(drawMeshes, casters) {
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
    this.program.use({ world_to_clip: multiply(mapToClip, this.worldToMap) });
    drawMeshes();
    gl.disable(gl.CULL_FACE);
  }
}
