#include "sim/swept/soft_way.h"

#include <algorithm>
#include <cmath>

namespace pneuma::sim {

SoftWay way_of(const SoftState& start, const VertexArray& end, double step) {
  const VertexReader from(start.positions), velocity(start.velocities), to(end);
  SoftWay result;
  double way = 0.0, off_line = 0.0;  // squared
  for (int v = 0; v < end.size(); ++v) {
    const Vec4d before = from[v], after = to[v];
    const Vec4d moved = after - before, bent = moved - step * velocity[v];
    result.box.include({min(before, after), max(before, after)});
    way = std::max(way, dot(moved, moved));
    off_line = std::max(off_line, dot(bent, bent));
  }
  result.allowed_change = std::max(allowed_of_way * std::sqrt(way), std::sqrt(off_line));
  return result;
}

}  // namespace pneuma::sim
