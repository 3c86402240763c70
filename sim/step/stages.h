// The stages of a step, in the order of the Stage enum. Private to sim/step.
#pragma once

#include "sim/step/workspace.h"

namespace pneuma::sim {

/// Forces and integration of every soft body (sections 3.1, 3.2). Returns the first body's failure.
std::optional<Divergence> integrate_soft(World& world, StepWorkspace& workspace);

/// Fills the workspace's contacts: kind by kind, body by body, so that their order is fixed.
void find_contacts(const World& world, StepWorkspace& workspace);

/// Impulses, friction and separation (section 5.3), in the order of the contacts.
void resolve_contacts(World& world, StepWorkspace& workspace);

}  // namespace pneuma::sim
