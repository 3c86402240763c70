#include "sim/swept/gauss_seidel.h"

#include <algorithm>
#include <numeric>

namespace pneuma::sim {

double GaussSeidel::correct(std::span<SweptImpulse* const> impulses,
                            std::span<const ImpulseNodes> nodes, double tolerance,
                            int max_iterations) {
  const auto select_all = [&] {
    corrected_.resize(impulses.size());
    std::iota(corrected_.begin(), corrected_.end(), 0);
  };
  select_all();
  double greatest = 0.0;
  for (int i = 0; i < max_iterations; ++i) {
    greatest = iterate(impulses, nodes, tolerance);
    if (greatest > tolerance) {
      select_unsettled(nodes);
    } else if (corrected_.size() < impulses.size()) {
      select_all();
    } else {
      break;
    }
  }
  return greatest;
}

double GaussSeidel::iterate(std::span<SweptImpulse* const> impulses,
                            std::span<const ImpulseNodes> nodes, double tolerance) {
  ++iteration_;
  double greatest = 0.0;
  for (const int i : corrected_) {
    const double change = impulses[at(i)]->correct();
    greatest = std::max(greatest, change);
    if (change <= tolerance) continue;
    for (const int node : nodes[at(i)]) {
      if (node >= 0) changed_in_[at(node)] = iteration_;
    }
  }
  return greatest;
}

/// Those that move what the last iteration has changed.
void GaussSeidel::select_unsettled(std::span<const ImpulseNodes> nodes) {
  corrected_.clear();
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const bool is_unsettled = std::ranges::any_of(
        nodes[i], [&](int node) { return node >= 0 && changed_in_[at(node)] == iteration_; });
    if (is_unsettled) corrected_.push_back(static_cast<int>(i));
  }
}

}  // namespace pneuma::sim
