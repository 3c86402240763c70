// Boxes of a scene in which vertices start.
#pragma once

#include <algorithm>
#include <vector>

#include "scenes/loader/scene.h"

namespace pneuma::app {

inline bool is_in(const scenes::Region& region, const sim::Vec3& point) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    if (point[axis] < region[i] || point[axis] > region[i + 3]) return false;
  }
  return true;
}

inline bool is_in_any(const std::vector<scenes::Region>& regions, const sim::Vec3& point) {
  return std::ranges::any_of(regions,
                             [&](const scenes::Region& region) { return is_in(region, point); });
}

}  // namespace pneuma::app
