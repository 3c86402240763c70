// The state of a world as bytes, to continue an interrupted run.
#pragma once

#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim/world/world.h"

namespace pneuma::sim {

class CheckpointError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Everything that steps change: positions, velocities, orientations, gas that comes and goes,
/// particles, warm-start impulses, slips, pairs that are being moved apart, the step count.
std::vector<std::uint8_t> save_state(const World& world);

/// Puts saved state into a world built from the same scene. Throws CheckpointError when the bytes
/// are damaged or belong to another world, which is then unchanged.
void load_state(std::span<const std::uint8_t> bytes, World& world);

}  // namespace pneuma::sim
