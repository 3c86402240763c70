#include "sim/collision/separating_plane.h"

#include <algorithm>
#include <limits>

#include "sim/mesh/vec4d.h"

namespace pneuma::sim {
namespace {

double min_lane(Vec4d row) { return std::min({row[0], row[1], row[2], row[3]}); }

/// Min coordinate of the vertices along an axis, now and `seconds` later.
double min_along(const SoftBody& body, Vec4d axis, double seconds) {
  const VertexReader positions(body.positions), velocities(body.velocities);
  Vec4d lowest = Vec4d{} + std::numeric_limits<double>::infinity();
  const int last = body.positions.size() - 1;
  const auto along = [axis, last](const VertexReader& values, int first) {
    const Vec3x4 four =
        to_columns(values[first], values[std::min(first + 1, last)],
                   values[std::min(first + 2, last)], values[std::min(first + 3, last)]);
    return four.x * axis[0] + (four.y * axis[1] + four.z * axis[2]);
  };
  for (int v = 0; v <= last; v += 4) {
    const Vec4d now = along(positions, v);
    lowest = min(lowest, min(now, now + seconds * along(velocities, v)));
  }
  return min_lane(lowest);
}

}  // namespace

bool has_separating_plane(const SoftBody& first, const SoftBody& second, const Vec3& direction,
                          double reach, double seconds) {
  const double length = direction.norm();
  if (!(length > 0.0)) return false;
  const Vec4d axis = to_vec4d(direction / length);
  const double farthest_of_first = -min_along(first, -axis, seconds);
  return min_along(second, axis, seconds) - farthest_of_first > reach;
}

}  // namespace pneuma::sim
