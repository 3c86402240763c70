// The light on surfaces that does not come from the sun. As render/light/elements.cpp, gather.cpp and indirect.cpp,
// but that shaders add it up.

// What each element sends, over pi.
const sentFragment = `${seenGroundFunctions}uniform sampler2D discs;
uniform sampler2D depths;
uniform mat4 world_to_map;
uniform vec3 to_light;
uniform float on_ground;  // 1 with a shadow on the ground
out uvec4 sent;

bool is_lit(vec3 point) {
  vec3 in_map = (world_to_map * vec4(point, 1.0)).xyz;
  int side = textureSize(depths, 0).x;
  ivec2 texel = clamp(ivec2(in_map.xy * float(side)), 0, side - 1);
  return texelFetch(depths, texel, 0).r >= in_map.z;
}

void main() {
  const float usually_open = 0.85;
  const float left_in_shadow = 0.3;
  ivec2 element = ivec2(gl_FragCoord.xy);
  vec3 centre = texelFetch(discs, ivec2(3 * element.x, element.y), 0).xyz;
  vec3 normal = texelFetch(discs, ivec2(3 * element.x + 1, element.y), 0).xyz;
  vec3 albedo = texelFetch(discs, ivec2(3 * element.x + 2, element.y), 0).xyz;
  vec2 foot = seen_on_ground(centre.xy, max(centre.z, 0.0), normal);
  float floor_left = is_lit(vec3(foot, 0.0)) ? 1.0 : mix(1.0, left_in_shadow, on_ground);
  vec3 light = usually_open * (sky_irradiance(normal.z) + floor_left * floor_light * (0.5 - 0.5 * normal.z));
  float facing = dot(normal, to_light);
  if (facing > 0.0 && is_lit(centre)) light += facing * sun;
  vec3 each = albedo * light / (1.0 - (1.0 - usually_open) * albedo);
  sent = uvec4(floatBitsToUint(each), 0u);
}`;

// What the ball in a body's place sends.
const ballFragment = `uniform sampler2D discs;
uniform sampler2D balls;
uniform usampler2D sent;
out uvec4 sent_by_ball;

void main() {
  int body = int(gl_FragCoord.y);
  int count = int(texelFetch(balls, ivec2(1, body), 0).y);
  vec3 sum = vec3(0.0);
  float area = 0.0;
  for (int i = 0; i < count; ++i) {
    float of_element = texelFetch(discs, ivec2(3 * i, body), 0).w;
    sum += of_element * uintBitsToFloat(texelFetch(sent, ivec2(i, body), 0).rgb);
    area += of_element;
  }
  sent_by_ball = uvec4(floatBitsToUint(sum / max(area, 1e-12)), 0u);
}`;

const gatherFunctions = `uniform sampler2D discs;
uniform sampler2D parts;
uniform sampler2D balls;
uniform usampler2D sent;
uniform usampler2D sent_by_ball;
uniform int body_count;

const float far_away = 3.0;  // radii of the body from its centre
const float close_by = 4.0;  // radii of an element: about the 2 of gather.cpp, which asks for 64 points at once
const float pi = 3.14159265;

struct Gathered {
  float above;
  float below;
  vec3 sent;
  vec2 open_to;
};

struct Left {
  vec3 bounced;
  vec2 open_to;
};

void add_taken(inout Gathered sum, float taken, vec3 away, uvec4 radiosity) {
  float above = taken * clamp(1e6 * away.z, 0.0, 1.0);
  sum.above += above;
  sum.below += taken - above;
  sum.sent += taken * uintBitsToFloat(radiosity.rgb);
}

void add_disc(inout Gathered sum, vec3 normal, vec3 away, vec3 facing, float area, uvec4 radiosity) {
  float height = -dot(facing, away);
  float raised = sqrt(height * height + area / pi);
  float squared = dot(away, away) + area / pi + 1e-9;
  float at_receiver = max(dot(normal, away) - (raised - height) * dot(normal, facing), 0.0);
  float taken = clamp(1e6 * height, 0.0, 1.0) * area / pi * at_receiver * raised / (squared * squared);
  add_taken(sum, taken, away, radiosity);
}

void add_ball(inout Gathered sum, vec3 normal, vec3 away, float area, uvec4 radiosity) {
  float squared = dot(away, away) + 1e-9;
  float taken = area * max(dot(normal, away), 0.0) / (sqrt(squared) * (pi * squared + area));
  add_taken(sum, taken, away, radiosity);
}

void add_element(inout Gathered sum, vec3 position, vec3 normal, int body, int i) {
  vec4 disc = texelFetch(discs, ivec2(3 * i, body), 0);
  vec4 facing = texelFetch(discs, ivec2(3 * i + 1, body), 0);
  uvec4 radiosity = texelFetch(sent, ivec2(i, body), 0);
  int first = int(facing.w), count = int(texelFetch(discs, ivec2(3 * i + 2, body), 0).w);
  if (count == 0 || distance(position, disc.xyz) > close_by * sqrt(disc.w / pi)) {
    add_disc(sum, normal, disc.xyz - position, facing.xyz, disc.w, radiosity);
    return;
  }
  for (int part = first; part < first + count; ++part) {
    ivec2 at = ivec2(2 * (part % ${partsPerRow}), part / ${partsPerRow});
    disc = texelFetch(parts, at, 0);
    add_disc(sum, normal, disc.xyz - position, texelFetch(parts, at + ivec2(1, 0), 0).xyz, disc.w, radiosity);
  }
}

// Of the hemisphere, sky and floor.
vec2 shares(vec3 normal) { return max(0.5 + vec2(0.5, -0.5) * normal.z, 0.02); }

Gathered gather(vec3 position, vec3 normal) {
  Gathered sum = Gathered(0.0, 0.0, vec3(0.0), vec2(1.0));
  for (int body = 0; body < body_count; ++body) {
    vec4 ball = texelFetch(balls, ivec2(0, body), 0);
    vec2 more = texelFetch(balls, ivec2(1, body), 0).xy;
    vec3 away = ball.xyz - position;
    vec2 before = vec2(sum.above, sum.below);
    if (dot(away, away) > far_away * far_away * ball.w * ball.w) {
      add_ball(sum, normal, away, more.x, texelFetch(sent_by_ball, ivec2(0, body), 0));
    } else {
      for (int i = 0; i < int(more.y); ++i) add_element(sum, position, normal, body, i);
    }
    sum.open_to *= max(1.0 - (vec2(sum.above, sum.below) - before) / shares(normal), 0.0);
  }
  return sum;
}

Left left_at(vec3 position, vec3 normal) {
  Gathered sum = gather(position, normal);
  float all = sum.above + sum.below;
  float part = all > 0.0 ? dot(shares(normal), 1.0 - sum.open_to) / all : 0.0;
  return Left(part * sum.sent, sum.open_to);
}
`;

const litFragment = `uniform sampler2D lit;
out uvec4 light;

void main() {
  ivec2 receiver = ivec2(gl_FragCoord.xy);
  vec3 position = texelFetch(lit, ivec2(2 * receiver.x, receiver.y), 0).xyz;
  vec3 normal = texelFetch(lit, ivec2(2 * receiver.x + 1, receiver.y), 0).xyz;
  Left left = left_at(position, normal);
  left.open_to.y *= left_below(position, normal);
  light = uvec4(floatBitsToUint(left.bounced), packUnorm2x16(left.open_to));
}`;

// From one light per lit vertex, one per point. As DrawnSurface::spread.
const spreadShaders = {
  vertex: `layout(location = 0) in uvec3 corners;
layout(location = 1) in vec3 weights;
uniform usampler2D light;
out vec3 bounced;
out vec2 open_to;

void main() {
  bounced = vec3(0.0);
  open_to = vec2(0.0);
  for (int i = 0; i < 3; ++i) {
    int number = int(corners[i]);
    uvec4 words = texelFetch(light, ivec2(number % ${receiversPerRow}, number / ${receiversPerRow}), 0);
    bounced += weights[i] * uintBitsToFloat(words.rgb);
    open_to += weights[i] * unpackUnorm2x16(words.a);
  }
  gl_Position = vec4(0.0);
}`,
  fragment: "void main() {}",
};

// Points of a surface by lit vertices and weights, three of each, and their light: bounced, and openness.
class LitPoints {
  constructor(gl) {
    Object.assign(this, { gl, vertices: gl.createVertexArray(), light: gl.createBuffer() });
    [this.corners, this.weights] = [gl.createBuffer(), gl.createBuffer()];
    gl.bindVertexArray(this.vertices);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.corners);
    gl.enableVertexAttribArray(0);
    gl.vertexAttribIPointer(0, 3, gl.UNSIGNED_INT, 0, 0);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.weights);
    gl.enableVertexAttribArray(1);
    gl.vertexAttribPointer(1, 3, gl.FLOAT, false, 0, 0);
    gl.bindVertexArray(null);
  }

  load(corners, weights) {
    const { gl } = this;
    this.count = corners.length / 3;
    for (const [buffer, content] of [[this.corners, corners], [this.weights, weights], [this.light, 20 * this.count]]) {
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
      gl.bufferData(gl.ARRAY_BUFFER, content, gl.DYNAMIC_DRAW);
    }
    gl.bindBuffer(gl.ARRAY_BUFFER, null);
  }
}

// Nothing comes from other bodies, and all of sky and ground is seen.
function setUsualLight(gl, bounced, openTo) {
  gl.vertexAttrib3f(bounced, 0, 0, 0);
  gl.vertexAttrib2f(openTo, 1, 1);
}

class BetweenBodies {
  constructor(gl, recording, surface, shaders) {
    Object.assign(this, { gl, surface });
    this.elements = new Elements(recording);
    const { columns, bodies: { length: bodies } } = this.elements;
    this.discs = new FloatTable(gl, 3 * columns, bodies);
    this.parts = new FloatTable(gl, 2 * partsPerRow, this.elements.parts.length / (8 * partsPerRow));
    this.balls = new FloatTable(gl, 2, bodies);
    this.sent = drawnBits(gl, columns, bodies);
    this.sentByBall = drawnBits(gl, 1, bodies);
    this.findSent = new FullScreen(gl, sentFragment, shaders.look);
    this.findSentByBall = new FullScreen(gl, ballFragment);
    const rows = surface.lit.length / (8 * receiversPerRow);
    this.lit = new FloatTable(gl, 2 * receiversPerRow, rows);
    this.light = drawnBits(gl, receiversPerRow, rows);
    this.findLight = new FullScreen(gl, litFragment, gatherFunctions + leftBelowFunction);
    this.spread = new Program(gl, spreadShaders, "", [], ["bounced", "open_to"]);
    this.feedback = gl.createTransformFeedback();
    this.points = new LitPoints(gl);
    this.points.load(surface.corners, surface.weights);
  }

  // After the map has been drawn. `positions`: of the vertices. `onGround`: whether a shadow falls on it.
  takeBodies(positions, map, onGround) {
    const { elements, discs, parts, balls } = this;
    elements.measure(positions);
    discs.load(elements.discs);
    parts.load(elements.parts);
    balls.load(elements.balls);
    this.sent.begin();
    this.findSent.draw({ world_to_map: map.worldToMap, to_light: map.toLight, on_ground: onGround ? 1 : 0 },
      { discs: discs.texture, depths: map.depth });
    this.sentByBall.begin();
    this.findSentByBall.draw({}, { discs: discs.texture, balls: balls.texture, sent: this.sent.texture });
  }

  // What gatherFunctions read.
  get textures() {
    return { discs: this.discs.texture, parts: this.parts.texture, balls: this.balls.texture, sent: this.sent.texture,
      sent_by_ball: this.sentByBall.texture };
  }

  get values() { return { body_count: this.elements.bodies.length }; }

  // Each point of it. `groundShadow`: null where there is none.
  lightSurface(groundShadow) {
    const { gl, surface } = this;
    this.lit.load(surface.lit);
    this.light.begin();
    this.findLight.draw({ ...this.values, ...leftBelowValues(groundShadow) },
      { ...this.textures, lit: this.lit.texture, ground_left: groundShadow?.result.texture ?? null });
    this.spreadTo(this.points);
  }

  // After the surface has been lit.
  spreadTo(points) {
    const { gl } = this;
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);  // what is read next may not be what is drawn to
    gl.bindVertexArray(points.vertices);
    gl.bindTransformFeedback(gl.TRANSFORM_FEEDBACK, this.feedback);
    gl.bindBufferBase(gl.TRANSFORM_FEEDBACK_BUFFER, 0, points.light);
    bindTexture(gl, 0, this.light.texture);
    this.spread.use({ light: 0 });
    gl.enable(gl.RASTERIZER_DISCARD);
    gl.beginTransformFeedback(gl.POINTS);
    gl.drawArrays(gl.POINTS, 0, points.count);
    gl.endTransformFeedback();
    gl.disable(gl.RASTERIZER_DISCARD);
    gl.bindBufferBase(gl.TRANSFORM_FEEDBACK_BUFFER, 0, null);
    gl.bindTransformFeedback(gl.TRANSFORM_FEEDBACK, null);
    gl.bindVertexArray(null);
  }
}
