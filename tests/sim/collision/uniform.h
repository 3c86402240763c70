// Numbers drawn evenly.
#pragma once

#include <random>

#include "sim/mesh/measure.h"

namespace pneuma::sim {

class Uniform {
 public:
  explicit Uniform(unsigned seed) : engine_(seed) {}

  double operator()(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  int below(int count) { return std::uniform_int_distribution<int>(0, count - 1)(engine_); }
  /// A point in the bounds, or up to `beyond` outside of them in each coordinate.
  Vec3 within(const Bounds& bounds, double beyond) {
    Vec3 point;
    for (int k = 0; k < 3; ++k) {
      point[k] = (*this)(bounds.low[k] - beyond, bounds.high[k] + beyond);
    }
    return point;
  }

 private:
  std::mt19937 engine_;
};

}  // namespace pneuma::sim
