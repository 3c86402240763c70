#include "sim/collision/sweep_and_prune.h"

#include <algorithm>
#include <cmath>

namespace pneuma::sim {
namespace {

bool is_finite(const BoundingSphere& sphere) {
  return sphere.centre.allFinite() && std::isfinite(sphere.radius);
}

/// The axis along which the centres vary most: there the sweep meets the fewest neighbours.
int axis_of_max_spread(std::span<const BoundingSphere> spheres) {
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

// Sort and sweep: in the order in which they begin along one axis, each sphere is compared with the
// ones that begin before it ends.
void SweepAndPrune::find(std::span<const BoundingSphere> spheres, std::vector<BodyPair>& pairs) {
  pairs.clear();
  line_up(spheres);
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    compare_with_next(i, spheres[at(entries_[i].index)], pairs);
  }
  sort_by(&BodyPair::second, spheres.size(), pairs);
  sort_by(&BodyPair::first, spheres.size(), pairs);
}

void SweepAndPrune::line_up(std::span<const BoundingSphere> spheres) {
  entries_.clear();
  const int axis = axis_of_max_spread(spheres);
  for (int i = 0; i < static_cast<int>(spheres.size()); ++i) {
    const BoundingSphere& sphere = spheres[at(i)];
    if (!is_finite(sphere)) continue;  // to sort by a NaN would be undefined behaviour
    const double along = sphere.centre[axis];
    entries_.push_back({along - sphere.radius, along + sphere.radius, i});
  }
  std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
    return a.low != b.low ? a.low < b.low : a.index < b.index;
  });

  spheres_.resize(entries_.size());
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    spheres_.set(i, spheres[at(entries_[i].index)]);
  }
}

/// One that begins only after the sphere's end does not overlap it either.
void SweepAndPrune::compare_with_next(std::size_t i, const BoundingSphere& sphere,
                                      std::vector<BodyPair>& pairs) const {
  const auto [low, high, index] = entries_[i];
  const auto add = [&, index = index](std::size_t next) {
    const int other = entries_[next].index;
    pairs.push_back({std::min(index, other), std::max(index, other)});
  };
  for (std::size_t next = i + 1; next < entries_.size() && entries_[next].low <= high; next += 4) {
    spheres_.for_overlapping_of_four(next, sphere, add);
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
