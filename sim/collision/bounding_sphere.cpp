#include "sim/collision/bounding_sphere.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/mesh/row.h"

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
  const Row middle = to_row(centre);
  const RowReader x(positions);
  double squared_radius = 0.0;
  for (int i = 0; i < positions.size(); ++i) {
    const Row offset = x[i] - middle;
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
  line_up(spheres);
  for (std::size_t i = 0; i < entries_.size(); ++i) compare_with_next(i, pairs);
  sort_by(&BodyPair::second, spheres.size(), pairs);
  sort_by(&BodyPair::first, spheres.size(), pairs);
}

void PairFinder::line_up(std::span<const BoundingSphere> spheres) {
  entries_.clear();
  const int axis = axis_of_greatest_spread(spheres);
  for (int i = 0; i < static_cast<int>(spheres.size()); ++i) {
    const BoundingSphere& sphere = spheres[at(i)];
    if (!is_finite(sphere)) continue;  // to sort by a NaN would be undefined behaviour
    const double along = sphere.centre[axis];
    entries_.push_back({along - sphere.radius, along + sphere.radius, i});
  }
  std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
    return a.low != b.low ? a.low < b.low : a.index < b.index;
  });

  const std::size_t count = entries_.size();
  for (auto* values : {&x_, &y_, &z_, &radius_}) {
    values->resize(count + 3);
    std::fill(values->end() - 3, values->end(), std::numeric_limits<double>::quiet_NaN());
  }
  for (std::size_t i = 0; i < count; ++i) {
    const BoundingSphere& sphere = spheres[at(entries_[i].index)];
    x_[i] = sphere.centre.x();
    y_[i] = sphere.centre.y();
    z_[i] = sphere.centre.z();
    radius_[i] = sphere.radius;
  }
}

/// Four at a time: one that begins only after the sphere's end does not overlap it either.
void PairFinder::compare_with_next(std::size_t i, std::vector<BodyPair>& pairs) const {
  const auto [low, high, index] = entries_[i];
  for (std::size_t next = i + 1; next < entries_.size() && entries_[next].low <= high; next += 4) {
    const Row x = load_row(&x_[next]) - x_[i], y = load_row(&y_[next]) - y_[i];
    const Row z = load_row(&z_[next]) - z_[i], reach = load_row(&radius_[next]) + radius_[i];
    const auto overlaps = x * x + y * y + z * z <= reach * reach;
    if ((overlaps[0] | overlaps[1] | overlaps[2] | overlaps[3]) == 0) continue;
    for (int lane = 0; lane < 4; ++lane) {
      if (overlaps[lane] == 0) continue;
      const int other = entries_[next + at(lane)].index;
      pairs.push_back({std::min(index, other), std::max(index, other)});
    }
  }
}

/// Counting sort, in which pairs that share the body stay in their order.
void PairFinder::sort_by(int BodyPair::*body, std::size_t bodies, std::vector<BodyPair>& pairs) {
  starts_.assign(bodies + 1, 0);
  for (const BodyPair& pair : pairs) ++starts_[at(pair.*body + 1)];
  int count = 0;
  for (int& start : starts_) start = (count += start);
  sorted_.resize(pairs.size());
  for (const BodyPair& pair : pairs) sorted_[at(starts_[at(pair.*body)]++)] = pair;
  pairs.swap(sorted_);
}

}  // namespace pneuma::sim
