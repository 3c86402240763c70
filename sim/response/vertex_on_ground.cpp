#include "sim/response/vertex_on_ground.h"

#include <algorithm>

#include "sim/response/contact_impulse.h"

namespace pneuma::sim {

bool meet_ground(double start_approach, const ContactMaterial& pair, Vec3& velocity) {
  const double approach = -velocity.z();
  if (!(approach > 0.0)) return false;
  double bounce = pair.restitution * std::clamp(start_approach, 0.0, approach);
  if (bounce < min_bounce_speed) bounce = 0.0;
  velocity.z() = bounce;
  if (pair.friction == 0.0) return false;
  const double limit = pair.friction * (approach + bounce);
  const double sliding = velocity.head<2>().norm();
  if (sliding <= limit) {
    velocity.head<2>().setZero();
    return true;
  }
  velocity.head<2>() *= 1.0 - limit / sliding;
  return false;
}

}  // namespace pneuma::sim
