// A step of the equation of a whole world in which contact is a potential (ERRATA row 73). Private
// to sim/step.
//
// All bodies are stepped together (sim/potential/explicit_world_step.h, implicit_world_step.h). A
// step that would bring a pair through each other, or too near for an explicit integrator to follow
// the barrier, is done in two halves, and these again, and ends as a divergence where that does not
// help.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "sim/base/disjoint_sets.h"
#include "sim/potential/explicit_world_step.h"
#include "sim/potential/implicit_world_step.h"
#include "sim/response/motion_start.h"
#include "sim/step/stepper.h"

namespace pneuma::sim {

struct StepWorkspace;

/// How often a step is halved at most.
inline constexpr int max_potential_halvings = 10;
/// Of implicit steps, whose trouble is seldom their length.
inline constexpr int max_implicit_halvings = 4;

struct PotentialMemory {
  explicit PotentialMemory(const World& world);

  int max_halvings() const;
  /// In `active`.
  void find_contacts_at(const WorldState& state);

  struct Start {
    WorldState state;
    std::vector<RigidState> boxes;  // all
  };

  ContactSurfaces surfaces;
  std::vector<int> free_boxes;                 // of the world's
  std::vector<int> movable;                    // bodies, soft ones first
  base::DisjointSets joined;                   // bodies, by contacts
  std::vector<std::uint8_t> touches, is_held;  // per body; of a group, that of its first body
  std::vector<int> group;                      // bodies
  std::optional<ExplicitWorldStep> explicit_step;
  std::optional<ImplicitWorldStep> implicit_step;
  std::array<Start, max_potential_halvings + 1> starts;  // of a part of the step and all around it
  WorldState start, end;
  PairFinder finder;
  std::vector<ContactPair> pairs;
  std::vector<ActiveContact> active;
  VertexArray forces;        // N, of contacts
  double driven_work = 0.0;  // J, of what is moved, in a step
};

/// Steps the world once. On divergence the world is as the step found it.
std::optional<Divergence> potential_step(World& world, StepWorkspace& workspace);

}  // namespace pneuma::sim
