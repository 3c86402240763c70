// The stages of a step, in the order of the Stage enum. Private to sim/step.
#pragma once

#include "sim/step/workspace.h"

namespace pneuma::sim {

/// Forces and integration of every soft body (sections 3.1, 3.2). Returns the first body's failure.
std::optional<Divergence> integrate_soft(World& world, StepWorkspace& workspace);

/// Free motion of every box (4.1). Returns the first box's failure.
std::optional<Divergence> integrate_rigid(World& world, StepWorkspace& workspace);

/// Bodies whose bounding spheres overlap (5.1), of soft ones those that no plane keeps apart;
/// of these those that are deep in each other are set aside, and the others get their particles,
/// if they are searched by them.
void find_pairs(World& world, StepWorkspace& workspace);

/// Lets the particles of all near pairs walk (5.2.1).
void move_particles(World& world, StepWorkspace& workspace);

/// Fills the workspace's contacts: kind by kind, body by body, so that their order is fixed (5.2).
void find_contacts(const World& world, StepWorkspace& workspace);

/// Impulses, friction and separation (5.3), island by island. Returns the first body
/// that they left with a value that is not finite.
std::optional<Divergence> resolve_contacts(World& world, StepWorkspace& workspace);

/// Moves soft bodies that lie deep in each other apart (sim/response/part_deep_pairs.h).
std::optional<Divergence> part_bodies(World& world, StepWorkspace& workspace);

}  // namespace pneuma::sim
