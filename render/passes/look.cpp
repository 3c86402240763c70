#include "render/passes/look.h"

#include <fmt/format.h>

#include "render/light/environment.h"

namespace pneuma::render {
namespace {

// The tone curve is Khronos' PBR Neutral (its specification of 2024, section "Tone mapper"):
// colours below 0.76 keep their hue, and brighter ones run into white along a hyperbola. The curve
// takes from each channel what a grey surface mirrors, so that a palette stays what it is; what
// that takes of the luminance is given back here, or else shadows would lose half of theirs.
constexpr const char* functions = R"(
vec3 sky_light(float z) { return mix(horizon, zenith, z * (2.0 - z)); }

vec3 sky_irradiance(float z) {
  return irradiance_0 + z * (irradiance_1 + z * irradiance_2);
}

vec3 tone_mapped(vec3 light) {
  const vec3 luminance = vec3(0.2126, 0.7152, 0.0722);
  float least = min(light.r, min(light.g, light.b));
  float before = dot(light, luminance);
  light -= least < 0.08 ? least - 6.25 * least * least : 0.04;
  float left = max(dot(light, luminance), 1e-4);
  float brightest = max(light.r, max(light.g, light.b));
  float over_both = 1.0 / (left * max(brightest, 1e-4));
  float peak = before * brightest * brightest * over_both;
  float shown_peak = peak < 0.76 ? peak : 1.0 - 0.0576 / (peak - 0.52);
  light *= shown_peak * left * over_both;
  float white = 1.0 - 1.0 / (0.15 * (peak - shown_peak) + 1.0);
  return mix(light, vec3(shown_peak), white);
}

// sRGB within 1.2 of 255, from roots in place of powers, which take several times as long on a CPU;
// at the dark end, where a straight piece belongs, within 3.
vec3 shown(vec3 light) {
  vec3 root = sqrt(max(tone_mapped(light), vec3(0.0)));
  return clamp((1.21128893 - 0.19818435 * root) * root - 0.01758249, 0.0, 1.0);
}

vec3 backdrop(float height) {
  const vec3 foot = vec3(0.860, 0.865, 0.868);
  const vec3 top = vec3(0.640, 0.685, 0.735);
  return mix(foot, top, height * height * (3.0 - 2.0 * height));
}
)";

constexpr const char* reflection_functions = R"(
// Schlick's form (1994) for a refractive index of 1.5 with a rough surface's end (Lagarde, "Adopting
// a physically based shading model", 2011), which runs on to twice what GGX mirrors at a grazing
// angle: outlines would glow. It is cut off at what a polynomial gives there, within 0.07 of Karis'
// fit ("Physically based shading on mobile", 2014) and enough that with highlight() no
// more is sent than arrives.
float fresnel(float cosine, float roughness) {
  float grazing = 1.0 - cosine;
  float squared = grazing * grazing;
  float smoothness = 1.0 - roughness;
  float most = smoothness * smoothness * (0.5 + 0.5 * smoothness);
  return min(0.04 + (max(smoothness, 0.04) - 0.04) * squared * squared * grazing,
             max(most, 0.08));
}

// Of what comes from all sides onto a surface, this enters it and lights its colour.
const float entering = 0.96;

// Pi times the GGX microfacet term D V F (Walter et al. 2007) with Hammon's fit of the Smith
// visibility (GDC 2017): nl and nv are the cosines of light and eye, nh and vh those of the half
// vector.
float highlight(float nl, float nv, float nh, float vh, float roughness) {
  float alpha = roughness * roughness;
  float squared = alpha * alpha;
  float t = nh * nh * (squared - 1.0) + 1.0;
  float over_visibility = 2.0 * max(mix(2.0 * nl * nv, nl + nv, alpha), 1e-3);
  return squared / (t * t * over_visibility) * fresnel(vh, 0.0);
}
)";

std::string constant(const char* name, const Light3& value) {
  return fmt::format("const vec3 {} = vec3({:.7f}, {:.7f}, {:.7f});\n", name, value[0], value[1],
                     value[2]);
}

}  // namespace

std::string look_source() {
  const Environment environment;
  const auto irradiance = sky_irradiance(environment);
  return constant("sun", environment.sun) + constant("zenith", environment.zenith) +
         constant("horizon", environment.horizon) + constant("floor_light", environment.floor) +
         constant("irradiance_0", irradiance[0]) + constant("irradiance_1", irradiance[1]) +
         constant("irradiance_2", irradiance[2]) + reflection_functions + functions;
}

}  // namespace pneuma::render
