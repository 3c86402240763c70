// The implicit integrators on the equation of a whole world, contact included: implicit_euler and
// sdirk2 as in sim/soft/implicit_step.h, but every minimisation is of all bodies at once
// (world_energy.h).
//
// Guarantees, for every step, up to rounding, if they hold at its start:
//   no pair of features has crossed, of two bodies or of one, and no vertex is a reach below z = 0;
//   V > 0 of every body with gas;
//   kinetic + spring + gas + gravity + contact energy does not grow, unless keys move something.
#pragma once

#include <vector>

#include "sim/potential/world_minimiser.h"

namespace pneuma::sim {

/// Positions and velocities of all surfaces' vertices, and the boxes whose corners move freely.
struct WorldState {
  VertexArray positions;          // m
  VertexArray velocities;         // m/s
  std::vector<RigidState> boxes;  // in the order of the world's
};

struct ImplicitWorldReport {
  bool is_valid = true;  // else nothing was done: the start has no energy
  int iterations = 0;
  int gradient_iterations = 0;
  bool converged = true;
  bool arrived = true;  // what keys move; else `blocked` has stopped it
  bool by_euler = false;
  double excess = 0.0;  // J, of motion at the end, by which the energy has grown beyond rounding
  WayLimit blocked;
  ContactPair blocked_pair;
};

class ImplicitWorldStep {
 public:
  /// Refers to the surfaces. Takes memory for all that follows.
  ImplicitWorldStep(const World& world, const ContactSurfaces& surfaces);

  /// One step of the world's settings from `start`. What forces do not move goes on straight with
  /// its velocities. `end` means something only if the report is valid and everything arrived.
  ImplicitWorldReport step(const World& world, const WorldState& start, WorldState& end);

 private:
  bool implicit_euler(const World& world, double step, const WorldState& start, WorldState& end);
  bool sdirk2(const World& world, double step, const WorldState& start, WorldState& end);
  bool minimise(const World& world, double beta, const WorldState& base, const WorldState& lag,
                const WorldState& guess, double step_from_start);
  void finish(WorldState& end) const;
  void move_corners(WorldState& state) const;
  void extrapolate_boxes();
  const VertexArray& own_part(const VertexArray& all, std::size_t i);
  double potential(const World& world, const WorldState& state);
  double kinetic(const World& world, const WorldState& state) const;
  double kinetic_of_boxes(const World& world, const WorldState& state) const;
  void keep_given(const WorldState& start, double step, WorldState& end) const;

  const ContactSurfaces& surfaces_;
  WorldEnergy energy_;
  WorldMinimiser minimiser_;
  std::vector<EulerBase> bases_;
  std::vector<Deformation> start_deformations_;  // per body
  WorldState extrapolated_, middle_;
  VertexArray targets_;
  std::vector<VertexArray> own_;  // positions, per body
  double tolerance_ = 0.0;        // m
  double start_energy_ = 0.0;
  double magnitude_ = 0.0;
  bool does_work_ = false;
  ImplicitWorldReport report_;
};

}  // namespace pneuma::sim
