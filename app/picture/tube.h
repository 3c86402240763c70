// Tubes about lines: what coils, pipes and bars are drawn as.
#pragma once

#include <cstdint>

#include "render/frame/frame.h"

namespace pneuma::app {

/// Unit vectors along a line and across it, right-handed.
struct LineAxes {
  render::Vec3f along, across, other;

  /// `way`: from the line's start to its end; of none the line is along x.
  explicit LineAxes(const render::Vec3f& way);
};

/// Adds the triangles of a tube that is open at both ends: rings of `sides` vertices, one after the
/// other from number `first` on, each counter-clockwise about the way to the next.
void add_tube(std::uint32_t first, int rings, int sides, render::MeshShape& shape);

}  // namespace pneuma::app
