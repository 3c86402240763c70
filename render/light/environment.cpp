#include "render/light/environment.h"

namespace pneuma::render {

Light3 sky_radiance(const Environment& environment, float z) {
  if (z <= 0.0f) return Light3::Zero();
  return environment.horizon + (environment.zenith - environment.horizon) * (z * (2.0f - z));
}

std::array<Light3, 3> sky_irradiance(const Environment& environment) {
  // L(z) = sum of a_l P_l(z) with a_l = (2 l + 1) / 2 times the integral of L P_l over z.
  constexpr int steps = 256;
  std::array<Light3, 3> a = {Light3::Zero(), Light3::Zero(), Light3::Zero()};
  for (int i = 0; i < steps; ++i) {
    const float z = (static_cast<float>(i) + 0.5f) / steps;
    const Light3 part = sky_radiance(environment, z) / (2.0f * steps);
    a[0] += part;
    a[1] += 3.0f * z * part;
    a[2] += 5.0f * (1.5f * z * z - 0.5f) * part;
  }
  // P_2(z) = (3 z^2 - 1) / 2.
  return {a[0] - 0.125f * a[2], 2.0f / 3.0f * a[1], 0.375f * a[2]};
}

}  // namespace pneuma::render
