#include "sim/collision/approach.h"

#include <algorithm>
#include <limits>

#include "sim/mesh/row.h"

namespace pneuma::sim {
namespace {

double least_of(Row row) { return std::min({row[0], row[1], row[2], row[3]}); }

/// How far a body reaches along an axis now and later, the lesser of the two.
double least_along(const SoftBody& body, Row axis, double seconds) {
  const RowReader positions(body.positions), velocities(body.velocities);
  Row least = Row{} + std::numeric_limits<double>::infinity();
  const int last = body.positions.size() - 1;
  const auto along = [axis, last](const RowReader& values, int first) {
    const Columns four =
        columns(values[first], values[std::min(first + 1, last)], values[std::min(first + 2, last)],
                values[std::min(first + 3, last)]);
    return four.x * axis[0] + (four.y * axis[1] + four.z * axis[2]);
  };
  for (int v = 0; v <= last; v += 4) {
    const Row now = along(positions, v);
    least = lesser(least, lesser(now, now + seconds * along(velocities, v)));
  }
  return least_of(least);
}

}  // namespace

bool may_touch(const SoftBody& first, const SoftBody& second, const Vec3& direction, double reach,
               double seconds) {
  const double length = direction.norm();
  if (!(length > 0.0)) return true;
  const Row axis = to_row(direction / length);
  const double farthest_of_first = -least_along(first, -axis, seconds);
  return !(least_along(second, axis, seconds) - farthest_of_first > reach);
}

}  // namespace pneuma::sim
