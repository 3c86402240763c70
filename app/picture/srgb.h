// Between sRGB values and light (IEC 61966-2-1), both 0..1.
#pragma once

#include <algorithm>
#include <cmath>

namespace pneuma::app {

inline float to_light(float srgb) {
  return srgb <= 0.04045f ? srgb / 12.92f : std::pow((srgb + 0.055f) / 1.055f, 2.4f);
}

inline float to_srgb(float light) {
  const float srgb =
      light <= 0.0031308f ? 12.92f * light : 1.055f * std::pow(light, 1.0f / 2.4f) - 0.055f;
  return std::clamp(srgb, 0.0f, 1.0f);
}

}  // namespace pneuma::app
