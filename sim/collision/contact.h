// One contact between two bodies, or a body and the ground, as detection hands it to the response.
#pragma once

#include <cstdint>

#include "sim/mesh/topology.h"

namespace pneuma::sim {

/// What takes part in a contact: unlike a body of a scene, also the ground.
enum class SideKind : std::uint8_t { soft, rigid, ground };

/// One side of a contact as detection finds it, plain indices: a feature of a soft body, a point of
/// a rigid box, or the ground. The solver makes a SolverSide of it (sim/response/contact_side.h),
/// which knows masses and velocities.
struct ContactSide {
  SideKind kind = SideKind::ground;
  int body = 0;     // index into World::soft or World::rigid
  Feature feature;  // of a soft body
};

struct Contact {
  ContactSide first;  // never the ground
  ContactSide second;
  Vec3 point = Vec3::Zero();   // where the bodies touch, m
  Vec3 normal = Vec3::Zero();  // unit; the impulse on `first` is along +normal (section 5.3.1)
  double depth = 0.0;  // m the sides must move apart along the normal; at or below 0 for none
  // Speculative margin, m: by how much the sides may still approach within the step. Above 0 only
  // between boxes, and boxes and the ground, which rest by touching.
  double speculative_margin = 0.0;
  // N s on `first` in the step, friction included; `second` gets the opposite. Known once the
  // contact is resolved; where a step is divided, a contact is listed with each part. Where contact
  // is a potential it is the force at the end of the step times the step, which is what acts on
  // bodies at rest; not what acted in an impact, where integrators weigh the forces of several
  // moments and take restitution and friction from those of the start. What an implicit integrator
  // keeps on the ground itself has none.
  Vec3 impulse = Vec3::Zero();
};

}  // namespace pneuma::sim
