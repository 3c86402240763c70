// A step of bodies that springs join (sim/world/body_spring.h).
//
// The explicit integrators take all of them as one body: in every stage the springs pull on both
// ends as they are in that stage, and the method keeps its order. The implicit ones minimise each
// body's energy for itself, and the springs act while the positions stand still: under sdirk2 for
// half a step before and half a step after it by Heun's method (Strang splitting, of second order),
// under implicit_euler for a step before it by Euler's (of first order: dashpots then know what
// hangs at rest to be at rest). This part is explicit: it is stable for steps below 2 sqrt(m / k),
// m being the reduced mass of the ends.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "sim/soft/integrators.h"
#include "sim/world/world.h"

namespace pneuma::sim {

/// Of bodies that springs join. Refers to nothing; takes memory for all that follows.
class JoinedStep {
 public:
  /// `bodies`: indices into World::soft, ascending. `start` below and the world's bodies are known
  /// by these.
  JoinedStep(const World& world, std::vector<int> bodies);

  const std::vector<int>& bodies() const { return bodies_; }

  /// Steps them from `start` (per soft body of the world), and returns of each the smallest volume
  /// at which its force was evaluated. `scratch(body)` is memory for its mesh, which several may
  /// share. Obstacles stay as they are.
  template <class ScratchOf>
  std::span<const double> step(World& world, std::span<const SoftState> start,
                               const ScratchOf& scratch) {
    scratch_.clear();
    for (const int body : bodies_) scratch_.push_back(&scratch(body));
    if (is_implicit(world.settings.integrator)) {
      step_implicitly(world, start);
    } else {
      step_explicitly(world, start);
    }
    return min_volumes_;
  }

 private:
  /// One body.
  struct Piece {
    int first = 0;  // its first vertex in what holds all of them
    bool is_obstacle = false;
    SoftState state;
    VertexArray accelerations;
  };
  /// A spring's ends among the vertices of all bodies.
  struct Spring {
    std::size_t index = 0;              // in World::springs
    std::size_t first = 0, second = 0;  // in pieces_
  };

  void step_explicitly(World& world, std::span<const SoftState> start);
  void step_implicitly(World& world, std::span<const SoftState> start);
  double accelerations(const World& world, const VertexArray& positions,
                       const VertexArray& velocities, VertexArray& result);
  void add_springs(const World& world, const VertexArray& positions, const VertexArray& velocities,
                   VertexArray& result) const;
  void kick(const World& world, double seconds, const VertexArray& positions,
            VertexArray& velocities);
  void gather(std::span<const SoftState> start);

  std::vector<int> bodies_;
  std::vector<Piece> pieces_;
  std::vector<Spring> springs_;
  std::vector<IntegratorScratch*> scratch_;  // of each body
  std::vector<double> min_volumes_;          // m^3, of each body
  SoftState start_, end_;                    // of all, one after the other
  std::unique_ptr<ExplicitScratch> all_;
  VertexArray changes_, predicted_;
};

}  // namespace pneuma::sim
