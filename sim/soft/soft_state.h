#pragma once

#include "sim/mesh/vertex_array.h"

namespace pneuma::sim {

/// Positions and velocities of one body at one moment.
struct SoftState {
  VertexArray positions;   // m
  VertexArray velocities;  // m/s
};

}  // namespace pneuma::sim
