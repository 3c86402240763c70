// Energies of bodies in other states than their own.
#pragma once

#include "sim/inspect/inspect.h"
#include "sim/rigid/rigid_state.h"
#include "sim/soft/soft_state.h"

namespace pneuma::sim {

Energy energy(const SoftBody& body, const SoftState& state, const Vec3& gravity);
Energy energy(const RigidBox& box, const RigidState& state, const Vec3& gravity);

}  // namespace pneuma::sim
