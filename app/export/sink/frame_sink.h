// Where `pneuma export` puts the frames of a run, one by one.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "app/world/simulation.h"

namespace pneuma::app {

class FrameSink {
 public:
  virtual ~FrameSink() = default;

  /// The simulation has come to a frame before those that are wanted.
  virtual void pass(const Simulation& /*simulation*/) {}
  /// The simulation has come to a frame that is wanted.
  virtual void add(const Simulation& simulation) = 0;

  /// A frame that it has simulated ahead for itself and nobody needs to simulate again.
  virtual std::optional<SimulatedFrame> take_simulated(std::int64_t /*frame*/) {
    return std::nullopt;
  }

  /// After the last frame, or the last one before a divergence or an interruption. Returns what
  /// people are to open.
  virtual std::filesystem::path finish() = 0;
};

}  // namespace pneuma::app
