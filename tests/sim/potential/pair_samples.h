// Random pairs of features, and differences of functions of their corners.
#pragma once

#include <random>

#include "sim/potential/pair_distance.h"

namespace pneuma::sim {

inline PairCorners random_corners(std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  PairCorners x;
  for (Vec3& corner : x) {
    for (double& coordinate : corner) coordinate = uniform(random);
  }
  return x;
}

inline PairCorners moved(PairCorners x, int coordinate, double by) {
  x[at(coordinate / 3)][coordinate % 3] += by;
  return x;
}

/// By central differences.
template <class Function>
Vec12 difference_gradient(const Function& function, const PairCorners& x, double width) {
  Vec12 gradient;
  for (int i = 0; i < 12; ++i) {
    gradient[i] = (function(moved(x, i, width)) - function(moved(x, i, -width))) / (2.0 * width);
  }
  return gradient;
}

/// Of a function that returns its gradient.
template <class Gradient>
Mat12 difference_hessian(const Gradient& gradient, const PairCorners& x, double width) {
  Mat12 hessian;
  for (int i = 0; i < 12; ++i) {
    hessian.col(i) = (gradient(moved(x, i, width)) - gradient(moved(x, i, -width))) / (2.0 * width);
  }
  return hessian;
}

}  // namespace pneuma::sim
