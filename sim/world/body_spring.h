// Springs between two bodies, as plain data.
#pragma once

#include <string>
#include <vector>

namespace pneuma::sim {

/// Where a spring is fixed to a soft body: to the middle of some of its vertices, all of which it
/// pulls alike.
struct SpringEnd {
  int body = 0;               // index in World::soft
  std::vector<int> vertices;  // at least one
};

/// It pulls its ends together with k (l - L) + c dl/dt, where l is their distance.
struct BodySpring {
  SpringEnd first;
  SpringEnd second;          // of another body
  double k = 0.0;            // N/m, >= 0
  double damping = 0.0;      // c, N s/m, >= 0
  double rest_length = 0.0;  // L, m, >= 0
};

}  // namespace pneuma::sim
