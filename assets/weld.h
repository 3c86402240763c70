// One vertex where a file has several in one place.
#pragma once

#include <vector>

#include "assets/model.h"

namespace pneuma::assets {

/// Vertices nearer to each other than this fraction of the bounding box's diagonal are one. Far
/// above the rounding of the 32-bit numbers that most formats hold (6e-8 of a coordinate), far
/// below the shortest edge of 100,000 vertices spread evenly (3e-3).
inline constexpr double weld_tolerance = 1e-6;

struct Weld {
  std::vector<Vec3> vertices;  // each the first of those that it stands for, in their order
  std::vector<int> new_index;  // of each vertex before
};

/// Every vertex becomes the first one before it that is no further than `distance` and that is
/// itself kept, or is kept. `distance` > 0, coordinates finite and within 1e15 distances of each
/// other, so that they can be counted.
Weld weld(const std::vector<Vec3>& vertices, double distance);

}  // namespace pneuma::assets
