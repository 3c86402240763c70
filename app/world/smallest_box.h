// How short the steps of small rigid boxes must be.
#pragma once

#include <optional>
#include <string>

#include "sim/world/world.h"

namespace pneuma::app {

/// The free box that gravity lets fall by its own extent in the shortest time.
struct SmallestBox {
  std::string body;
  double extent = 0.0;     // m, the cube root of its volume
  double fall_time = 0.0;  // s, in which it falls from rest by that

  /// With which it takes at least six steps for it, but 2,000 at most. In longer steps a heap comes
  /// to rest later, trembles, and takes longer to compute (tests/benchmarks/README.md).
  double steps_per_second() const;
};

/// None without free boxes, or without gravity.
std::optional<SmallestBox> smallest_box(const sim::World& world);

}  // namespace pneuma::app
