// What the vertices of a soft body do from the start of a step to its end.
#pragma once

#include "sim/soft/soft_state.h"
#include "sim/swept/moving_surface.h"

namespace pneuma::sim {

/// Of the longest way in the step: by so much impulses move its end before all is searched again.
inline constexpr double allowed_of_way = 0.5;

struct SoftWay {
  WayBox box;
  /// m, by which impulses may move the ends before all is searched again: half of the longest way,
  /// or all by which a vertex leaves the line that it started along, since of a body at rest
  /// contacts take that back.
  double allowed_change = 0.0;
};

/// Over `step` seconds.
SoftWay way_of(const SoftState& start, const VertexArray& end, double step);

}  // namespace pneuma::sim
