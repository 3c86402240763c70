#include "sim/collision/bounding_sphere.h"

#include <algorithm>
#include <cmath>

namespace pneuma::sim {

namespace {

bool is_finite(const BoundingSphere& sphere) {
  return sphere.centre.allFinite() && std::isfinite(sphere.radius);
}

/// The axis along which the centres vary most: there the sweep meets the fewest neighbours.
int axis_of_greatest_spread(std::span<const BoundingSphere> spheres) {
  Vec3 sum = Vec3::Zero();
  double count = 0.0;
  for (const BoundingSphere& sphere : spheres) {
    if (!is_finite(sphere)) continue;
    sum += sphere.centre;
    count += 1.0;
  }
  const Vec3 mean = sum / std::max(count, 1.0);
  Vec3 variance = Vec3::Zero();
  for (const BoundingSphere& sphere : spheres) {
    if (is_finite(sphere)) variance += (sphere.centre - mean).cwiseAbs2();
  }
  int axis = 0;
  variance.maxCoeff(&axis);
  return axis;
}

}  // namespace

BoundingSphere bounding_sphere(const VertexArray& positions, const Bounds& bounds, double margin) {
  const Vec3 centre = bounds.centre();
  double squared_radius = 0.0;
  for (int i = 0; i < positions.size(); ++i) {
    squared_radius = std::max(squared_radius, (positions[i] - centre).squaredNorm());
  }
  return {centre, std::sqrt(squared_radius) + margin};
}

BoundingSphere bounding_sphere(const VertexArray& positions, double margin) {
  return bounding_sphere(positions, bounds(positions), margin);
}

BoundingSphere bounding_sphere(const OrientedBox& box, double margin) {
  return {box.centre, box.half.norm() + margin};
}

bool overlap(const BoundingSphere& a, const BoundingSphere& b) {
  const double reach = a.radius + b.radius;
  return (a.centre - b.centre).squaredNorm() <= reach * reach;
}

bool overlap(const Bounds& a, const Bounds& b) {
  return (a.low.array() <= b.high.array()).all() && (b.low.array() <= a.high.array()).all();
}

// Sort and sweep: in the order in which they begin along one axis, each sphere is compared with the
// ones that begin before it ends.
void PairFinder::find(std::span<const BoundingSphere> spheres, std::vector<BodyPair>& pairs) {
  pairs.clear();
  entries_.clear();
  const int axis = axis_of_greatest_spread(spheres);
  for (int i = 0; i < static_cast<int>(spheres.size()); ++i) {
    const BoundingSphere& sphere = spheres[at(i)];
    if (!is_finite(sphere)) continue;  // to sort by a NaN would be undefined behaviour
    const double along = sphere.centre[axis];
    entries_.push_back({along - sphere.radius, along + sphere.radius, sphere, i});
  }
  std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
    return a.low != b.low ? a.low < b.low : a.index < b.index;
  });
  for (auto a = entries_.begin(); a != entries_.end(); ++a) {
    for (auto b = a + 1; b != entries_.end() && b->low <= a->high; ++b) {
      if (!overlap(a->sphere, b->sphere)) continue;
      pairs.push_back({std::min(a->index, b->index), std::max(a->index, b->index)});
    }
  }
  std::sort(pairs.begin(), pairs.end());
}

}  // namespace pneuma::sim
