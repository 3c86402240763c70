// Spheres side by side, so that one is compared with four of them at a time.
#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "sim/collision/bounding_sphere.h"
#include "sim/mesh/vec4d.h"

namespace pneuma::sim {

/// Keeps its memory when it is resized.
class PackedSpheres {
 public:
  void resize(std::size_t count) {
    for (auto* values : {&x_, &y_, &z_, &radius_}) {
      // Behind the last a few that overlap nothing, for its row of four.
      values->resize(count + 3);
      std::fill(values->end() - 3, values->end(), std::numeric_limits<double>::quiet_NaN());
    }
    count_ = count;
  }
  void set(std::size_t i, const BoundingSphere& sphere) {
    x_[i] = sphere.centre.x();
    y_[i] = sphere.centre.y();
    z_[i] = sphere.centre.z();
    radius_[i] = sphere.radius;
  }
  std::size_t size() const { return count_; }

  /// Calls visit(j) for those of the four from i < size() on that overlap the sphere.
  template <class Visit>
  void for_overlapping_of_four(std::size_t i, const BoundingSphere& sphere,
                               const Visit& visit) const {
    const Vec4d x = load_vec4d(&x_[i]) - sphere.centre.x(),
                y = load_vec4d(&y_[i]) - sphere.centre.y();
    const Vec4d z = load_vec4d(&z_[i]) - sphere.centre.z();
    const Vec4d reach = load_vec4d(&radius_[i]) + sphere.radius;
    const auto overlaps = x * x + y * y + z * z <= reach * reach;
    if ((overlaps[0] | overlaps[1] | overlaps[2] | overlaps[3]) == 0) return;
    for (int lane = 0; lane < 4; ++lane) {
      if (overlaps[lane] != 0) visit(i + at(lane));
    }
  }

 private:
  std::size_t count_ = 0;
  std::vector<double> x_, y_, z_, radius_;
};

}  // namespace pneuma::sim
