// The impulse of one contact (paper 5.3) with Coulomb friction (3.1.4, ERRATA row 6).
#pragma once

#include "sim/collision/contact.h"
#include "sim/world.h"

namespace pneuma::sim {

/// Of two surfaces, the greater restitution and the geometric mean of the frictions.
Surface combine(const Surface& a, const Surface& b);

/// What one contact received, N s.
struct Impulse {
  double normal = 0.0;
  double tangential = 0.0;
  bool sticks = false;  // friction stopped all sliding
};

/// Velocity of the first side relative to the second at the contact point, m/s.
Vec3 relative_velocity(const World& world, const Contact& contact);

/// Changes the velocities of both sides so that they part along the contact's normal, and slide on
/// with as much less speed as friction allows. Sides already parting are left alone (j >= 0).
///
/// They part with the restitution's share of the speed at which they approached at the start of the
/// step, `start_approach`: what forces add within the step would make bodies at rest bounce for
/// ever. Never adds kinetic energy for restitution <= 1, since they part no faster than they meet
/// now.
Impulse apply_contact_impulse(World& world, const Contact& contact, double start_approach);

}  // namespace pneuma::sim
