// Where a surface runs through itself or touches itself.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "assets/model.h"

namespace pneuma::assets {

struct SelfTouching {
  std::size_t count = 0;                  // of pairs of triangles
  std::vector<std::array<int, 2>> first;  // some of them, lower triangle first, sorted
  bool complete = true;                   // false: too many triangles lie over each other to look
                                          // at all pairs
};

/// Pairs of triangles that have more in common than the vertices and edges they share.
///
/// The coordinates are rounded to a grid of 2^-30 of the extent, and from there on the arithmetic
/// is exact: there are no tolerances, and a surface on that grid is found to touch itself if and
/// only if it does. Surfaces nearer to each other than the grid's width, a thousandth of the
/// tolerance for welding, may count as touching.
SelfTouching find_self_touching(const sim::TriangleMesh& mesh, std::size_t max_places);

}  // namespace pneuma::assets
