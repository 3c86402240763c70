// Impulses that depend on each other, corrected in turn.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "sim/swept/swept_impulse.h"

namespace pneuma::sim {

/// The numbers of what an impulse moves: boxes, and vertices of soft bodies. -1 where there are
/// fewer. Impulses that have none in common do not directly depend on each other.
using ImpulseNodes = std::array<int, 6>;

/// Projected Gauss-Seidel iterations. Where a few impulses of many do not settle, such as those on
/// a vertex that is pressed from both sides, only these and what depends on them are corrected
/// again, until they settle; then all are.
class GaussSeidel {
 public:
  /// `nodes`: how many there are.
  explicit GaussSeidel(std::size_t nodes) : changed_in_(nodes, 0) {}

  /// Corrects the impulses until no correction of any changes a velocity by more than `tolerance`,
  /// in the unit of what they aim at, in at most `max_iterations` of all or of some of them.
  /// `nodes` are those of each impulse. Returns the greatest change of the last iteration, which at
  /// the limit may be one of the unsettled alone.
  double correct(std::span<SweptImpulse* const> impulses, std::span<const ImpulseNodes> nodes,
                 double tolerance, int max_iterations);

 private:
  double iterate(std::span<SweptImpulse* const> impulses, std::span<const ImpulseNodes> nodes,
                 double tolerance);
  void select_unsettled(std::span<const ImpulseNodes> nodes);

  std::vector<int> corrected_;            // impulses, in their order
  std::vector<std::int64_t> changed_in_;  // per node: the last iteration that did, over all calls
  std::int64_t iteration_ = 0;
};

}  // namespace pneuma::sim
