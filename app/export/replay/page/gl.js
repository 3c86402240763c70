// WebGL 2: programs, buffers, textures. Shaders come from the program that renders PNG pictures, in the header.

const glslHead = "#version 300 es\nprecision highp float;\nprecision highp int;\n" +
  "precision highp sampler2DShadow;\nprecision highp sampler2D;\nprecision highp usampler2D;\n#define noperspective\n";

function compile(gl, stage, source) {
  const shader = gl.createShader(stage);
  gl.shaderSource(shader, glslHead + source);
  gl.compileShader(shader);
  if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
  return shader;
}

class Program {
  // `outputs`: of the vertex shader, which go to a buffer one after the other instead of being drawn.
  constructor(gl, { vertex, fragment }, before = "", defines = [], outputs = []) {
    const preamble = defines.map((name) => `#define ${name}\n`).join("");
    this.gl = gl;
    this.name = gl.createProgram();
    gl.attachShader(this.name, compile(gl, gl.VERTEX_SHADER, preamble + vertex));
    gl.attachShader(this.name, compile(gl, gl.FRAGMENT_SHADER, preamble + before + fragment));
    if (outputs.length > 0) gl.transformFeedbackVaryings(this.name, outputs, gl.INTERLEAVED_ATTRIBS);
    gl.linkProgram(this.name);
    if (!gl.getProgramParameter(this.name, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(this.name));
    this.uniforms = new Map();
    const count = gl.getProgramParameter(this.name, gl.ACTIVE_UNIFORMS);
    for (let i = 0; i < count; ++i) {
      const { name, type } = gl.getActiveUniform(this.name, i);
      this.uniforms.set(name, { type, location: gl.getUniformLocation(this.name, name) });
    }
  }

  // Those of `values` that the program has.
  use(values) {
    const gl = this.gl;
    gl.useProgram(this.name);
    for (const [name, value] of Object.entries(values)) {
      const uniform = this.uniforms.get(name);
      if (!uniform) continue;
      switch (uniform.type) {
        case gl.FLOAT: gl.uniform1f(uniform.location, value); break;
        case gl.FLOAT_VEC2: gl.uniform2fv(uniform.location, value); break;
        case gl.FLOAT_VEC3: gl.uniform3fv(uniform.location, value); break;
        case gl.FLOAT_MAT4: gl.uniformMatrix4fv(uniform.location, false, value); break;
        default: gl.uniform1i(uniform.location, value);  // samplers, by their unit
      }
    }
  }
}

// Attributes at the locations 0, 1, ... of so many floats each, side by side in one buffer.
class Vertices {
  constructor(gl, sizes, divisor = 0) {
    this.gl = gl;
    this.vao = gl.createVertexArray();
    this.buffer = gl.createBuffer();
    gl.bindVertexArray(this.vao);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
    const stride = sizes.reduce((sum, size) => sum + size, 0);
    let offset = 0;
    sizes.forEach((size, location) => {
      gl.enableVertexAttribArray(location);
      gl.vertexAttribPointer(location, size, gl.FLOAT, false, 4 * stride, 4 * offset);
      gl.vertexAttribDivisor(location, divisor);
      offset += size;
    });
    this.stride = stride;
  }

  draw(mode, floats) {
    const gl = this.gl;
    this.load(floats);
    gl.drawArrays(mode, 0, floats.length / this.stride);
  }

  // Quads whose corners the vertex shader makes.
  drawQuads(floats) {
    this.load(floats);
    this.gl.drawArraysInstanced(this.gl.TRIANGLE_STRIP, 0, 4, floats.length / this.stride);
  }

  load(floats) {
    const gl = this.gl;
    gl.bindVertexArray(this.vao);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(floats), gl.STREAM_DRAW);
  }
}

// All of a picture in one triangle.
const fullScreenVertex = `out vec2 at;
void main() {
  at = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0;
  gl_Position = vec4(at * 2.0 - 1.0, 0.0, 1.0);
}`;

class FullScreen {
  constructor(gl, fragment, before = "") {
    this.gl = gl;
    this.program = new Program(gl, { vertex: fullScreenVertex, fragment }, before);
    this.nothing = gl.createVertexArray();
  }

  // `textures`: the names of samplers, each with what it reads: a texture, or a list of it and its sampler.
  draw(values, textures = {}) {
    const gl = this.gl;
    const units = {};
    Object.entries(textures).forEach(([name, read], unit) => {
      bindTexture(gl, unit, ...[read].flat());
      units[name] = unit;
    });
    gl.disable(gl.BLEND);
    gl.disable(gl.DEPTH_TEST);
    this.program.use({ ...values, ...units });
    gl.bindVertexArray(this.nothing);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  }
}

function makeTexture(gl, format, width, height, filter, levels = 1) {
  const texture = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, texture);
  gl.texStorage2D(gl.TEXTURE_2D, levels, format, width, height);
  for (const side of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, side, gl.CLAMP_TO_EDGE);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, filter);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, levels > 1 ? gl.LINEAR_MIPMAP_LINEAR : filter);
  return texture;
}

// A table that shaders fetch from, of four numbers a texel.
class FloatTable {
  constructor(gl, width, height) {
    Object.assign(this, { gl, width, height, texture: makeTexture(gl, gl.RGBA32F, width, height, gl.NEAREST) });
  }

  load(floats) {
    const { gl, width, height } = this;
    gl.bindTexture(gl.TEXTURE_2D, this.texture);
    gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, width, height, gl.RGBA, gl.FLOAT, floats);
  }
}

// What shaders draw and read.
class Target {
  constructor(gl, format, width, height, filter, levels = 1) {
    Object.assign(this, { gl, width, height, texture: makeTexture(gl, format, width, height, filter, levels) });
    this.framebuffer = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.framebuffer);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, this.texture, 0);
  }

  begin() {
    this.gl.bindFramebuffer(this.gl.FRAMEBUFFER, this.framebuffer);
    this.gl.viewport(0, 0, this.width, this.height);
  }
}

// A square picture of colours.
const drawnPicture = (gl, size, levels = 1) => new Target(gl, gl.RGBA8, size, size, gl.LINEAR, levels);

// Of floats as their bits, which every WebGL 2 can draw.
const drawnBits = (gl, width, height) => new Target(gl, gl.RGBA32UI, width, height, gl.NEAREST);

function bindTexture(gl, unit, texture, sampler = null) {
  gl.activeTexture(gl.TEXTURE0 + unit);
  gl.bindTexture(gl.TEXTURE_2D, texture);
  gl.bindSampler(unit, sampler);
}
