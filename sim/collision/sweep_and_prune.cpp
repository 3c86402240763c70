#include "sim/collision/sweep_and_prune.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace pneuma::sim {
namespace {

bool is_finite(const BoundingSphere& sphere) {
  return sphere.centre.allFinite() && std::isfinite(sphere.radius);
}

bool is_finite(const Bounds& box) { return box.low.allFinite() && box.high.allFinite(); }

const Vec3& centre_of(const BoundingSphere& sphere) { return sphere.centre; }
Vec3 centre_of(const Bounds& box) { return box.centre(); }

std::pair<double, double> extent_along(int axis, const BoundingSphere& sphere) {
  const double along = sphere.centre[axis];
  return {along - sphere.radius, along + sphere.radius};
}
std::pair<double, double> extent_along(int axis, const Bounds& box) {
  return {box.low[axis], box.high[axis]};
}

/// The axis along which the centres vary most: there the sweep meets the fewest neighbours.
template <class Shape>
int axis_of_max_spread(std::span<const Shape> shapes) {
  Vec3 sum = Vec3::Zero();
  double count = 0.0;
  for (const Shape& shape : shapes) {
    if (!is_finite(shape)) continue;
    sum += centre_of(shape);
    count += 1.0;
  }
  const Vec3 mean = sum / std::max(count, 1.0);
  Vec3 variance = Vec3::Zero();
  for (const Shape& shape : shapes) {
    if (is_finite(shape)) variance += (centre_of(shape) - mean).cwiseAbs2();
  }
  int axis = 0;
  variance.maxCoeff(&axis);
  return axis;
}

}  // namespace

void SweepAndPrune::find(std::span<const BoundingSphere> spheres, std::vector<BodyPair>& pairs) {
  find(spheres, spheres_, pairs);
}

void SweepAndPrune::find(std::span<const Bounds> boxes, std::vector<BodyPair>& pairs) {
  find(boxes, boxes_, pairs);
}

// Sort and sweep: in the order in which they begin along one axis, each shape is compared with the
// ones that begin before it ends.
template <class Shape, class Packed>
void SweepAndPrune::find(std::span<const Shape> shapes, Packed& packed,
                         std::vector<BodyPair>& pairs) {
  pairs.clear();
  line_up(shapes, packed);
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    compare_with_next(i, shapes[at(entries_[i].index)], packed, pairs);
  }
  sort_by(&BodyPair::second, shapes.size(), pairs);
  sort_by(&BodyPair::first, shapes.size(), pairs);
}

template <class Shape, class Packed>
void SweepAndPrune::line_up(std::span<const Shape> shapes, Packed& packed) {
  entries_.clear();
  const int axis = axis_of_max_spread(shapes);
  for (int i = 0; i < static_cast<int>(shapes.size()); ++i) {
    if (!is_finite(shapes[at(i)])) continue;  // to sort by a NaN would be undefined behaviour
    const auto [low, high] = extent_along(axis, shapes[at(i)]);
    entries_.push_back({low, high, i});
  }
  std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
    return a.low != b.low ? a.low < b.low : a.index < b.index;
  });

  packed.resize(entries_.size());
  for (std::size_t i = 0; i < entries_.size(); ++i) packed.set(i, shapes[at(entries_[i].index)]);
}

/// One that begins only after the shape's end does not overlap it either.
template <class Shape, class Packed>
void SweepAndPrune::compare_with_next(std::size_t i, const Shape& shape, const Packed& packed,
                                      std::vector<BodyPair>& pairs) const {
  const auto [low, high, index] = entries_[i];
  const auto add = [&, index = index](std::size_t next) {
    const int other = entries_[next].index;
    pairs.push_back({std::min(index, other), std::max(index, other)});
  };
  for (std::size_t next = i + 1; next < entries_.size() && entries_[next].low <= high; next += 4) {
    packed.for_overlapping_of_four(next, shape, add);
  }
}

/// Counting sort, in which pairs that share the body stay in their order.
void SweepAndPrune::sort_by(int BodyPair::*body, std::size_t bodies, std::vector<BodyPair>& pairs) {
  starts_.assign(bodies + 1, 0);
  for (const BodyPair& pair : pairs) ++starts_[at(pair.*body + 1)];
  int count = 0;
  for (int& start : starts_) start = (count += start);
  sorted_.resize(pairs.size());
  for (const BodyPair& pair : pairs) sorted_[at(starts_[at(pair.*body)]++)] = pair;
  pairs.swap(sorted_);
}

}  // namespace pneuma::sim
