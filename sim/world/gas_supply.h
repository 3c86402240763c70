// Gas that comes and goes, as plain data.
#pragma once

#include <vector>

#include "sim/world/key_frames.h"

namespace pneuma::sim {

/// An opening through which gas flows (sim/joints/orifice.h).
struct Orifice {
  double area = 0.0;        // m^2, > 0 where gas is to flow
  double discharge = 0.61;  // coefficient, 0..1: what the jet uses of the area
};

/// What changes the gas of a body. The value of a key is its first number.
struct GasSupply {
  std::vector<KeyFrame> n;              // mol; beside a leak or a valve, what is pumped in
  std::vector<KeyFrame> temperature;    // K; of a gas_exponent of 1
  bool smooth = true;                   // as KeyFrames::smooth
  Orifice leak;                         // to the outside, at the ambient pressure
  double outside_temperature = 293.15;  // K, of what flows or is pumped in
};

/// An opening between the gas of two soft bodies, by their indices in the world.
struct Valve {
  int first = 0;
  int second = 0;
  Orifice orifice;
};

}  // namespace pneuma::sim
