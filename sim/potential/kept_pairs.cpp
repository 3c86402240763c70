#include "sim/potential/kept_pairs.h"

#include <algorithm>

#include "sim/mesh/vec4d.h"

namespace pneuma::sim {

KeptPairs::KeptPairs(const ContactSurfaces& surfaces)
    : finder_(surfaces), from_(surfaces.vertex_count()), ways_(surfaces.vertex_count()) {}

void KeptPairs::find(const VertexArray& from, const VertexArray& to, double margin) {
  finder_.find(from, to, margin, pairs_);
  from_.rows() = from.rows();
  ways_.rows() = to.rows() - from.rows();
  margin_ = margin;
}

bool KeptPairs::cover(const VertexArray& positions, double beside) const {
  const double most = margin_ - beside;
  if (!(most >= 0.0)) return false;
  const VertexReader x(positions), from(from_), ways(ways_);
  for (int v = 0; v < positions.size(); ++v) {
    const Vec4d offset = x[v] - from[v], way = ways[v];
    const double squared = dot(way, way);
    const double along = squared > 0.0 ? std::clamp(dot(offset, way) / squared, 0.0, 1.0) : 0.0;
    const Vec4d apart = offset - along * way;
    if (!(dot(apart, apart) <= most * most)) return false;
  }
  return true;
}

}  // namespace pneuma::sim
