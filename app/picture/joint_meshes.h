// Springs between bodies, drawn as coils, and valves, drawn as pipes.
#pragma once

#include <memory>
#include <vector>

#include "render/frame/frame.h"
#include "sim/world/world.h"

namespace pneuma::app {

class JointMeshes {
 public:
  /// `world`: in the state in which pipes are put where two bodies are nearest to each other.
  explicit JointMeshes(const sim::World& world);

  /// Adds them to the frame, as they are now.
  void add(const sim::World& world, render::Frame& frame) const;

 private:
  struct Joint {
    sim::SpringEnd first, second;
    std::shared_ptr<const render::MeshShape> shape;
    int turns = 0;             // of the coil; 0: a straight pipe
    float radius = 0.0f;       // m, of the wire or pipe
    float coil_radius = 0.0f;  // m, of its middle line
  };
  std::vector<Joint> joints_;
};

}  // namespace pneuma::app
