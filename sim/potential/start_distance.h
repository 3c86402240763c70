// Whether a world may start under the contact potential: nothing of it may cross or touch.
#pragma once

#include <optional>

#include "sim/world/world.h"

namespace pneuma::sim {

/// Two surfaces that touch to rounding, by body indices (soft bodies, then boxes); second == -1: a
/// vertex of the first is a reach or more below z = 0. What crosses is for crossings() to say.
struct TouchingStart {
  int first = 0;
  int second = -1;
  double distance = 0.0;  // m; of the ground: the height of the lowest vertex
  double reach = 0.0;     // m
};

std::optional<TouchingStart> find_touching_start(const World& world);

}  // namespace pneuma::sim
