// Pairs of features that are looked for once and hold for all positions near those.
#pragma once

#include <vector>

#include "sim/potential/near_pairs.h"

namespace pneuma::sim {

class KeptPairs {
 public:
  /// Refers to the surfaces, which must outlive it.
  explicit KeptPairs(const ContactSurfaces& surfaces);

  /// From now on all pairs that come within their reach while every vertex is within `margin` (m)
  /// of its straight way.
  void find(const VertexArray& from, const VertexArray& to, double margin);
  /// Whether every vertex is, also `beside` (m) from there. Then so it is between such positions.
  bool cover(const VertexArray& positions, double beside = 0.0) const;

  const std::vector<ContactPair>& pairs() const { return pairs_; }

 private:
  PairFinder finder_;
  std::vector<ContactPair> pairs_;
  VertexArray from_, ways_;  // m
  double margin_ = -1.0;     // m; below 0: none
};

}  // namespace pneuma::sim
