// How a step fails.
#pragma once

#include <cstdint>
#include <string>

#include "sim/step/stages/plan.h"

namespace pneuma::sim {

/// A step that did not end in a valid state: something is not finite, a volume is not above zero, a
/// vertex is faster than anything, or energy came from nowhere (find_divergence.h). Found in the
/// step in which it happens.
struct Divergence {
  Stage stage;
  std::int64_t step;  // the step that failed, counted from 1
  std::string body;
  std::string what;         // happened, with its values
  int vertex = -1;          // of a soft body: in which it shows, or its fastest; -1: none
  bool inverted = false;    // the body became flat or turned inside out
  std::string remedy = {};  // what may do instead of the step, if that is known
  std::string other = {};   // body, or "the ground", that `what` names beside the body
};

}  // namespace pneuma::sim
