// The shadow on the ground, and how near bodies come to it. As render/passes/ground_shadow.cpp and
// render/light/contact_shade.cpp, but that shaders make the pictures.

const groundSize = 192;  // texels on a side of the shadow's picture
const groundMargin = 24;
const groundInner = groundSize - 2 * groundMargin;  // the shadow map's
const groundLevels = Math.floor(Math.log2(groundSize)) + 1;  // each of half as many texels a side
const ambientSize = groundSize / 4;
const contactSize = groundSize / 2;
const leastStep = 0.4;  // texels between the weights of a blur
const groundFading = 0.5;  // widths of the picture over which its border's darkness falls to none beyond it

// Red: how much of the light is blocked. Green: that times how soft the shadow is to be.
const coverFragment = `uniform sampler2D depths;
uniform vec3 ground;
uniform float softness;
out vec4 cover;
void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy) - ${groundMargin};
  cover = vec4(0.0, 0.0, 0.0, 1.0);
  if (any(lessThan(texel, ivec2(0))) || any(greaterThanEqual(texel, ivec2(${groundInner})))) return;
  ivec2 from = texel * ${shadowSize} / ${groundInner};
  ivec2 to = (texel + 1) * ${shadowSize} / ${groundInner};
  float nearest = 1.0;
  float sum = 0.0;
  for (int y = from.y; y < to.y; ++y) {
    for (int x = from.x; x < to.x; ++x) {
      float depth = texelFetch(depths, ivec2(x, y), 0).r;
      nearest = min(nearest, depth);
      if (depth < 1.0) sum += 1.0;
    }
  }
  float fraction = sum / float((to.x - from.x) * (to.y - from.y));
  float below = dot(ground, vec3((vec2(texel) + 0.5) / ${groundInner}.0, 1.0)) - nearest;
  cover.rg = vec2(fraction, fraction * clamp(below * softness, 0.0, 1.0));
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

// What comes of sky and bodies to points on the ground, as a fraction of the open sky.
const ambientFragment = `in vec2 at;
uniform vec2 origin;
uniform vec2 along_u;
uniform vec2 along_v;
out vec4 ambient;
void main() {
  vec2 place = origin + at.x * along_u + at.y * along_v;
  Left left = left_at(vec3(place, 0.0), vec3(0.0, 0.0, 1.0));
  ambient = vec4(min(1.03 * left.open_to.x + left.bounced / sky_irradiance(1.0), 1.0), 1.0);
}`;

// How near the lowest surface above each texel is: 1 where it touches. Blended by the maximum.
const nearnessShaders = {
  vertex: `layout(location = 0) in vec3 position;
uniform mat4 world_to_picture;
out float height;
void main() {
  height = max(position.z, 0.0);
  gl_Position = vec4((world_to_picture * vec4(position.xy, 0.0, 1.0)).xy * 2.0 - 1.0, 0.0, 1.0);
  gl_PointSize = 1.0;
}`,
  fragment: `in float height;
uniform float reach;
out vec4 nearness;
void main() {
  float left = max(1.0 - height / reach, 0.0);
  nearness = vec4(left * left);
}`,
};

// What is left of the ground's colour, in sRGB; alpha: of the light that surfaces see of it, about the luminance.
const leftFragment = `in vec2 at;
uniform sampler2D narrow;
uniform sampler2D wide;
uniform sampler2D ambient;
uniform sampler2D contact;
uniform float light_z;
out vec4 result;
void main() {
  vec4 w = texture(wide, at);
  float blocked = clamp(mix(texture(narrow, at).r, w.r, w.g / max(w.r, 0.004)), 0.0, 1.0);
  float open = 1.0 - texture(contact, at).r;
  vec3 direct = sun * light_z;
  vec3 sky_part = sky_irradiance(1.0) / (sky_irradiance(1.0) + direct);
  vec3 of_sky = sky_part * texture(ambient, at).rgb;
  vec3 of_sun = (1.0 - sky_part) * (1.0 - blocked);
  result = vec4(pow(open * open * of_sky + of_sun, vec3(1.0 / 2.2)), of_sky.g + of_sun.g);
}`;

// How much of its light the ground below a point has left. As GroundShadow::left_below.
// As seen_ground() and, for a surface at a height, seen_on_ground() of render/light/ground_light.cpp.
const seenGroundFunctions = `
vec2 seen_ground(float nz) {
  float sine = 0.5 * (1.0 + nz);
  float cosine = sqrt(max(1.0 - sine * sine, 0.0));
  float across = sqrt(max(1.0 - nz * nz, 0.0));
  float cos_middle = max(sine * across - cosine * nz, 0.1);
  return vec2((across * cosine + nz * sine) / cos_middle, 1.0 / cos_middle);
}

vec2 seen_on_ground(vec2 position, float height, vec3 normal) {
  return position + height * seen_ground(normal.z).x / max(length(normal.xy), 1e-6) * normal.xy;
}
`;

const leftBelowFunction = `${seenGroundFunctions}uniform sampler2D ground_left;
uniform mat4 world_to_picture;
uniform float texel;  // m; 0 without a shadow on the ground
float left_below(vec3 position, vec3 normal) {
  if (texel == 0.0) return 1.0;
  float height = max(position.z, 5.0 * texel);
  vec2 foot = seen_on_ground(position.xy, height, normal);
  vec2 at = (world_to_picture * vec4(foot, 0.0, 1.0)).xy;
  float near = max(1.0 - length(at - clamp(at, 0.0, 1.0)) / ${groundFading}, 0.0);
  float level = clamp(log2(max(2.0 * height * seen_ground(normal.z).y / texel, 1.0)), 0.0, ${groundLevels - 2}.0);
  return mix(1.0, textureLod(ground_left, at, level).a, near * near);
}
`;

const leftBelowValues = (shadow) => shadow ? { world_to_picture: shadow.worldToPicture, texel: shadow.texel }
  : { texel: 0 };

class GroundShadow {
  constructor(gl, shaders) {
    this.gl = gl;
    this.cover = new FullScreen(gl, coverFragment);
    this.blur = new FullScreen(gl, blurFragment);
    this.findAmbient = new FullScreen(gl, ambientFragment, shaders.look + gatherFunctions);
    this.nearness = new Program(gl, nearnessShaders);
    this.left = new FullScreen(gl, leftFragment, shaders.look);
    this.onGround = new Program(gl, shaders.ground_shadow, shaders.nearness);
    this.quad = new Vertices(gl, [2]);
    [this.raw, this.between, this.narrow, this.wide] = [1, 2, 3, 4].map(() => drawnPicture(gl, groundSize));
    this.ambient = drawnPicture(gl, ambientSize);
    this.contact = drawnPicture(gl, contactSize);
    this.contactBetween = drawnPicture(gl, contactSize);
    this.result = drawnPicture(gl, groundSize, groundLevels);
    this.sharp = gl.createSampler();  // of the result, for the ground
    gl.samplerParameteri(this.sharp, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
    for (const side of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.samplerParameteri(this.sharp, side, gl.CLAMP_TO_EDGE);
  }

  // After the map has been drawn. `between`: the light between bodies, if there is any; `drawSurface` draws triangles
  // and their corners.
  draw(map, between, drawSurface) {
    const gl = this.gl;
    this.fit(map);
    this.measureCover(map);
    this.measureContact(between ? drawSurface : null);
    this.measureAmbient(between);
    this.result.begin();
    this.left.draw({ light_z: map.toLight[2] }, { narrow: this.narrow.texture, wide: this.wide.texture,
      ambient: this.ambient.texture, contact: this.contact.texture });
    gl.bindTexture(gl.TEXTURE_2D, this.result.texture);
    gl.generateMipmap(gl.TEXTURE_2D);
  }

  fit(map) {
    const inner = groundInner / groundSize, margin = groundMargin / groundSize;
    this.texel = map.extent / groundInner;
    const units = [map.units[0] / inner, map.units[1] / inner, map.units[2]];
    this.worldToPicture = affine(map.axes.map((axis, i) => scale(axis, 1 / units[i])),
      [map.offset[0] * inner + margin, map.offset[1] * inner + margin, map.offset[2]]);
    this.corner = (u, v) => map.onGround((u - margin) / inner, (v - margin) / inner);
  }

  measureCover(map) {
    const normal = map.axes.map((axis, i) => axis[2] * map.units[i]);
    const ground = [-normal[0] / normal[2], -normal[1] / normal[2], dot(normal, map.offset) / normal[2]];
    this.raw.begin();
    this.cover.draw({ ground, softness: map.range / (0.35 * map.extent) }, { depths: map.depth });
    const wide = Math.max(0.4 * map.edge * groundInner, leastStep);
    this.blurInto(this.narrow, this.raw, this.between, Math.min(Math.max(0.5 * wide, leastStep), 1));
    this.blurInto(this.wide, this.narrow, this.between, wide);
  }

  // Upwards, then across.
  blurInto(target, source, between, texels) {
    between.begin();
    this.blur.draw({ stride: [0, texels / source.width] }, { picture: source.texture });
    target.begin();
    this.blur.draw({ stride: [texels / source.width, 0] }, { picture: between.texture });
  }

  measureContact(drawSurface) {
    const gl = this.gl;
    this.contact.begin();
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT);
    if (!drawSurface) return;
    gl.disable(gl.DEPTH_TEST);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE);
    gl.blendEquation(gl.MAX);
    this.nearness.use({ world_to_picture: this.worldToPicture, reach: 7 * this.texel });
    drawSurface();
    gl.blendEquation(gl.FUNC_ADD);
    this.blurInto(this.contact, this.contact, this.contactBetween, 0.7);
  }

  measureAmbient(between) {
    this.ambient.begin();
    if (!between) {
      this.gl.clearColor(1, 1, 1, 1);
      this.gl.clear(this.gl.COLOR_BUFFER_BIT);
      return;
    }
    const origin = this.corner(0, 0);
    const [alongU, alongV] = [this.corner(1, 0), this.corner(0, 1)].map((corner) => subtract(corner, origin));
    this.findAmbient.draw({ ...between.values, origin, along_u: alongU, along_v: alongV }, between.textures);
  }

  darken(view) {
    const gl = this.gl;
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ZERO, gl.SRC_COLOR);
    gl.disable(gl.DEPTH_TEST);
    bindTexture(gl, 0, this.result.texture, this.sharp);
    this.onGround.use({ view_projection: view.viewProjection, world_to_map: this.worldToPicture, shadow: 0,
      fading: groundFading, centre: view.target.slice(0, 2), radius: view.groundRadius });
    const [low, high] = [-groundFading, 1 + groundFading];
    this.quad.draw(gl.TRIANGLE_STRIP, [[low, low], [high, low], [low, high], [high, high]].flatMap(([u, v]) =>
      this.corner(u, v)));
  }
}
