// Two bodies that are shot at each other, as a scene file, from a seed and a number.
#pragma once

#include <cstdint>
#include <string>

namespace pneuma::app {

struct RandomImpact {
  std::string scene;     // TOML; no gravity, no ground, no drag
  std::string bodies;    // "needle on torus"
  double speed = 0.0;    // m/s, of the second body; the first is at rest
  double seconds = 0.0;  // until one second after they must have met
};

/// The same on every machine. At least one of the bodies is soft, in five of six impacts: a sphere,
/// an icosphere, a torus, a box or a model, of 50 to 642 vertices; boxes are cubes, plates and
/// needles. Speeds from 1 to 200 m/s, as many between 1 and 2 as between 100 and 200; 60 to 960
/// steps a second.
RandomImpact random_impact(std::uint64_t seed, int number);

}  // namespace pneuma::app
