#include "sim/swept/conjugate_iterations.h"

#include <algorithm>

namespace pneuma::sim {

double ConjugateIterations::correct(std::span<SweptImpulse* const> impulses, double tolerance,
                                    int max_iterations) {
  corrections_.resize(impulses.size());
  directions_.assign(impulses.size(), Vec4d{});
  squared_before_ = 0.0;
  double greatest = 0.0;
  for (int i = 0; i < max_iterations; ++i) {
    greatest = iterate(impulses);
    if (greatest <= tolerance || i + 1 == max_iterations) break;
    go_on(impulses);
  }
  return greatest;
}

double ConjugateIterations::iterate(std::span<SweptImpulse* const> impulses) {
  double greatest = 0.0;
  squared_ = 0.0;
  for (std::size_t i = 0; i < impulses.size(); ++i) {
    SweptImpulse& impulse = *impulses[i];
    const Vec4d before = impulse.impulse();
    greatest = std::max(greatest, impulse.correct());
    corrections_[i] = impulse.impulse() - before;
    squared_ += impulse.mobility() * dot(corrections_[i], corrections_[i]);
  }
  return greatest;
}

/// Fletcher and Reeves' ratio; where corrections grow, the directions are forgotten.
void ConjugateIterations::go_on(std::span<SweptImpulse* const> impulses) {
  const bool grows = squared_ >= squared_before_;
  const double ratio = grows ? 0.0 : squared_ / squared_before_;
  for (std::size_t i = 0; i < impulses.size(); ++i) {
    const Vec4d more = ratio * directions_[i];
    if (!grows) impulses[i]->exceed(more);
    directions_[i] = more + corrections_[i];
  }
  squared_before_ = squared_;
}

}  // namespace pneuma::sim
