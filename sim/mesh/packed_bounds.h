// Axis-aligned boxes side by side, so that one is compared with four of them at a time.
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "sim/mesh/measure.h"
#include "sim/mesh/vec4d.h"

namespace pneuma::sim {

/// Keeps its memory when it is resized.
class PackedBounds {
 public:
  void resize(std::size_t count) {
    for (auto* sides : {&low_, &high_}) {
      for (std::vector<double>& values : *sides) {
        // Behind the last a few that overlap nothing, for its row of four.
        values.resize(count + 3);
        std::fill(values.end() - 3, values.end(), std::numeric_limits<double>::quiet_NaN());
      }
    }
    count_ = count;
  }
  void set(std::size_t i, const Bounds& bounds) {
    for (int axis = 0; axis < 3; ++axis) {
      low_[at(axis)][i] = bounds.low[axis];
      high_[at(axis)][i] = bounds.high[axis];
    }
  }
  std::size_t size() const { return count_; }

  /// Calls visit(j) for those of the four from i < size() on that overlap the box.
  template <class Visit>
  void for_overlapping_of_four(std::size_t i, const Bounds& bounds, const Visit& visit) const {
    const auto along = [&](int axis) {
      return (load_vec4d(&low_[at(axis)][i]) <= bounds.high[axis]) &
             (load_vec4d(&high_[at(axis)][i]) >= bounds.low[axis]);
    };
    const auto overlaps = along(0) & along(1) & along(2);
    if ((overlaps[0] | overlaps[1] | overlaps[2] | overlaps[3]) == 0) return;
    for (int lane = 0; lane < 4; ++lane) {
      if (overlaps[lane] != 0) visit(i + at(lane));
    }
  }

 private:
  std::size_t count_ = 0;
  std::array<std::vector<double>, 3> low_, high_;  // by axes
};

}  // namespace pneuma::sim
