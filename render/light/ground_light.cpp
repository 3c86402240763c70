#include "render/light/ground_light.h"

#include <algorithm>
#include <cmath>

namespace pneuma::render {

GroundLight::GroundLight(const Vec3f& to_light) {
  const Environment environment;
  const auto irradiance = sky_irradiance(environment);
  of_sky = irradiance[0] + irradiance[1] + irradiance[2];
  sky << of_sky / (of_sky + environment.sun * to_light.z()), 0.5f;
  sun = 1.0f - sky;
}

Eigen::Array4f GroundLight::ambient(const IndirectLight& left) const {
  Eigen::Array4f of_open_sky;
  of_open_sky << 1.03f * left.open_to.x() + left.bounced.array() / of_sky, 1.0f;
  return sky * of_open_sky.min(1.0f);
}

SeenGround seen_ground(float nz) {
  const float sine = 0.5f * (1.0f + nz);  // of a - m
  const float cosine = std::sqrt(std::max(1.0f - sine * sine, 0.0f));
  const float across = std::sqrt(std::max(1.0f - nz * nz, 0.0f));  // the sine of a
  const float cos_middle = std::max(sine * across - cosine * nz, 0.1f);
  const float sin_middle = across * cosine + nz * sine;
  return {sin_middle / cos_middle, 1.0f / cos_middle};
}

Vec3f seen_on_ground(const Vec3f& position, const Vec3f& normal) {
  const float ahead = seen_ground(normal.z()).ahead * std::max(position.z(), 0.0f);
  const float away = ahead / std::max(normal.head<2>().norm(), 1e-6f);
  return {position.x() + away * normal.x(), position.y() + away * normal.y(), 0.0f};
}

}  // namespace pneuma::render
