// What the surface of a body does in a contact.
#pragma once

namespace pneuma::sim {

/// What a surface does in a contact.
struct ContactMaterial {
  double restitution = 0.2;  // 0..1; 0 keeps no normal velocity
  double friction = 0.5;     // Coulomb mu, >= 0
};

/// m/s. A body that would part more slowly, and rise by less than 5 um, does not bounce: a stack
/// always trembles a little and rests better so (ERRATA row 55).
inline constexpr double min_bounce_speed = 0.01;

/// The material of a contact between two: the greater restitution, the geometric mean of the
/// frictions
/// (ERRATA row 52).
ContactMaterial combine(const ContactMaterial& a, const ContactMaterial& b);

}  // namespace pneuma::sim
