#include "sim/response/vertex_on_ground.h"

#include <algorithm>

#include "sim/response/contact_impulse.h"

namespace pneuma::sim {
namespace {

/// `normal`: by how much the ground has changed the velocity upwards, m/s. Returns whether friction
/// holds the vertex.
bool rub(double normal, double friction, Vec3& velocity) {
  if (friction == 0.0) return false;
  const double limit = friction * normal;
  const double sliding = velocity.head<2>().norm();
  if (sliding <= limit) {
    velocity.head<2>().setZero();
    return true;
  }
  velocity.head<2>() *= 1.0 - limit / sliding;
  return false;
}

}  // namespace

GroundImpact ground_impact(double start_height, double start_velocity, double height,
                           double velocity) {
  const double fraction = start_height > 0.0 ? start_height / (start_height - height) : 0.0;
  return {fraction, -(start_velocity + fraction * (velocity - start_velocity))};
}

std::optional<double> bounce(const GroundImpact& impact, const ContactMaterial& pair, double step,
                             Vec3& velocity) {
  const double approach = -velocity.z(), up = pair.restitution * impact.speed;
  const double at_end = up + impact.speed - approach;
  if (!(approach > 0.0) || up < min_bounce_speed || at_end < 0.0) return std::nullopt;
  velocity.z() = at_end;
  rub(approach + at_end, pair.friction, velocity);
  return 0.5 * (up + at_end) * (1.0 - impact.fraction) * step;
}

bool meet_ground(double start_approach, const ContactMaterial& pair, Vec3& velocity) {
  const double approach = -velocity.z();
  if (!(approach > 0.0)) return false;
  double up = pair.restitution * std::clamp(start_approach, 0.0, approach);
  if (up < min_bounce_speed) up = 0.0;
  velocity.z() = up;
  return rub(approach + up, pair.friction, velocity);
}

}  // namespace pneuma::sim
