// Lengths of edges: the springs' and their rest lengths, of the same rounding.
#pragma once

#include <cmath>

#include "sim/mesh/vec4d.h"

namespace pneuma::sim {

/// m^2, added to every squared length: far below the rounding of any that means something, and
/// nothing is ever divided by zero.
inline constexpr double min_squared_length = 1e-200;

/// Of x y z each a number, or each a Vec4d of four edges.
template <class Coordinates>
Coordinates squared_length(const Coordinates& x, const Coordinates& y, const Coordinates& z) {
  return fma(x, x, fma(y, y, fma(z, z, Coordinates{} + min_squared_length)));
}

/// m.
inline double edge_length(const Vec3& edge) {
  return std::sqrt(squared_length(edge.x(), edge.y(), edge.z()));
}

}  // namespace pneuma::sim
