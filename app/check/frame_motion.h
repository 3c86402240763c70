// How fast the bodies of a world move from one frame to the next.
#pragma once

#include <string>
#include <vector>

#include "app/check/run_statistics.h"
#include "sim/mesh/vertex_array.h"
#include "sim/rigid/rigid_state.h"
#include "sim/world/world.h"

namespace pneuma::app {

/// Where bodies are: none of the soft ones that never move, or only as they are told to.
struct Places {
  std::vector<sim::VertexArray> soft;
  std::vector<sim::RigidState> boxes;
};

void keep_places(const sim::World& world, Places& places);

/// Per soft body, then per box, m/s: what is slower is at rest.
std::vector<double> rest_limits(const sim::World& world);

/// The fastest of all, and that with the greatest part of its body's limit.
struct Motion {
  FastestPoint fastest;
  FastestPoint liveliest;

  void meet(double speed, const std::string& body, double limit);
};

/// In the last `duration` (s), at whose start the bodies were there. The velocity of a vertex that
/// is pressed holds, at the end of a step, what its forces did since the last impulses; that of a
/// box does not hold what moved it apart from another.
Motion motion(const sim::World& world, const Places& before, double duration,
              const std::vector<double>& limits);

}  // namespace pneuma::app
