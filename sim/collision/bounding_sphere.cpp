#include "sim/collision/bounding_sphere.h"

#include <algorithm>
#include <cmath>

#include "sim/mesh/vec4d.h"

namespace pneuma::sim {

BoundingSphere bounding_sphere(const VertexArray& positions, const Bounds& bounds, double margin) {
  const Vec3 centre = bounds.centre();
  const Vec4d middle = to_vec4d(centre);
  const VertexReader x(positions);
  double squared_radius = 0.0;
  for (int i = 0; i < positions.size(); ++i) {
    const Vec4d offset = x[i] - middle;
    squared_radius = std::max(squared_radius, dot(offset, offset));
  }
  return {centre, std::sqrt(squared_radius) + margin};
}

BoundingSphere bounding_sphere(const VertexArray& positions, double margin) {
  return bounding_sphere(positions, bounds(positions), margin);
}

BoundingSphere bounding_sphere(const OrientedBox& box, double margin) {
  return {box.centre, box.half.norm() + margin};
}

BoundingSphere printed_bounding_sphere(const Bounds& bounds) {
  return {bounds.centre(), 0.5 * (bounds.high - bounds.low).norm()};
}

bool overlap(const BoundingSphere& a, const BoundingSphere& b) {
  const double reach = a.radius + b.radius;
  return (a.centre - b.centre).squaredNorm() <= reach * reach;
}

bool overlap(const Bounds& a, const Bounds& b) {
  return (a.low.array() <= b.high.array()).all() && (b.low.array() <= a.high.array()).all();
}

}  // namespace pneuma::sim
