// Near-parallel edges: where two edges are nearest jumps as they turn past each other, so their
// potential is taken away smoothly as they become parallel (Li et al., Incremental Potential
// Contact, 2020, section 4.2, equation 24): it is multiplied by
//
//   m(c) = (2 - c / eps) c / eps  for  c = |u x v|^2 < eps,  else 1.
#pragma once

#include "sim/potential/pair_distance.h"

namespace pneuma::sim {

/// eps in m^4 of two edges with these lengths at rest, m.
inline double mollifier_threshold(double first, double second) {
  constexpr double fraction = 1e-3;
  return fraction * first * first * second * second;
}

/// |u x v|^2 in m^4.
double squared_cross(const PairCorners& edges);

struct Mollifier {
  double value = 1.0;
  Vec12 gradient = Vec12::Zero();
  Mat12 hessian = Mat12::Zero();
};

double mollifier_value(double squared_cross, double threshold);
/// With derivatives by the corners.
Mollifier mollifier(const PairCorners& edges, double threshold);

}  // namespace pneuma::sim
