// Worlds of cubes that are to come to rest: towers, a pyramid, cards, heavy on light, heaps.
#pragma once

#include <string>
#include <vector>

#include "sim/world/world.h"

namespace pneuma::benchmarks {

struct PileWorld {
  std::string name;
  sim::World world;
  double seconds = 0.0;       // simulated
  bool measures_top = false;  // the last box is the top of a tower or pyramid
};

/// By their names, in this order; all of them if `names` is empty. Cubes of 2 m and 1 kg on the
/// ground, friction 0.5, restitution 0.1. `short_runs`: a second of each. Throws
/// std::invalid_argument.
std::vector<PileWorld> make_pile_worlds(const std::vector<std::string>& names, bool short_runs);

}  // namespace pneuma::benchmarks
