// Whether a world may start under the contact potential: nothing of it may cross or touch.
#pragma once

#include <optional>

#include "sim/world/world.h"

namespace pneuma::sim {

/// Two surfaces that the potential pushes apart, by body indices (soft bodies, then boxes); second
/// == -1: the ground. What crosses is for crossings() to say.
struct NearStart {
  int first = 0;
  int second = -1;
  double distance = 0.0;  // m; of the ground: the height of the lowest vertex
  double reach = 0.0;     // m
};

/// Those nearest to each other, of their reach.
std::optional<NearStart> find_nearest_start(const World& world);
/// The same if they touch to rounding, or if a vertex is a reach or more below z = 0.
std::optional<NearStart> find_touching_start(const World& world);

}  // namespace pneuma::sim
