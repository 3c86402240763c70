// The light and the colours that all passes share, as GLSL.
//
// Light is reckoned in linear colours; the framebuffer holds sRGB, which shaders convert to.
// Leaving that to GL_FRAMEBUFFER_SRGB costs a third more on llvmpipe, which then converts each
// sample at each write.
#pragma once

namespace pneuma::render {

/// `sun`, `sky`, `bounce`: what arrives from the light, from above and from below, linear;
/// `to_srgb(linear)`;
/// `backdrop(height)`: the background at a height in the picture, 0 at its foot and 1 at its top,
/// in sRGB.
inline constexpr const char* look_source = R"(
const vec3 sun = vec3(0.80, 0.775, 0.73);
const vec3 sky = vec3(0.34, 0.37, 0.42);
const vec3 bounce = vec3(0.16, 0.15, 0.14);

// Without the straight piece at the dark end, where the two differ by less than 3 of 255.
vec3 to_srgb(vec3 linear) {
  return 1.055 * pow(max(linear, vec3(0.0008)), vec3(1.0 / 2.4)) - 0.055;
}

vec3 backdrop(float height) {
  const vec3 foot = vec3(0.905, 0.910, 0.914);
  const vec3 top = vec3(0.690, 0.745, 0.800);
  return mix(foot, top, height * height * (3.0 - 2.0 * height));
}
)";

}  // namespace pneuma::render
