#include "render/passes/look.h"

#include <fmt/format.h>

namespace pneuma::render {
namespace {

constexpr const char* functions = R"(
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

std::string constant(const char* name, const std::array<float, 3>& value) {
  return fmt::format("const vec3 {} = vec3({}, {}, {});\n", name, value[0], value[1], value[2]);
}

}  // namespace

std::string look_source() {
  return constant("sun", sun) + constant("sky", sky) + constant("bounce", bounce) + functions;
}

}  // namespace pneuma::render
