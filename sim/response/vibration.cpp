#include "sim/response/vibration.h"

#include <algorithm>
#include <cmath>

#include "sim/mesh/vec4d.h"

namespace pneuma::sim {
namespace {

/// The velocities of a rigid body with a soft body's momentum and angular momentum.
struct RigidMotion {
  Vec4d centre{};
  Vec4d velocity{};
  Vec4d angular_velocity{};

  /// Of a body with pins: none, since nothing turns or moves it as a whole.
  explicit RigidMotion(const SoftBody& body) {
    if (body.pins) return;
    const VertexReader x(body.positions), v(body.velocities);
    const int count = body.positions.size();
    for (int i = 0; i < count; ++i) {
      centre += x[i];
      velocity += v[i];
    }
    centre = centre / count;
    velocity = velocity / count;
    Vec4d turning{};
    Vec4d moments{}, products{};  // of inertia of masses of one kilogram; x y, y z, z x
    for (int i = 0; i < count; ++i) {
      const Vec4d arm = x[i] - centre;
      turning += cross(arm, v[i] - velocity);
      moments += dot(arm, arm) - arm * arm;
      products += arm * yzx(arm);
    }
    Mat3 inertia;
    inertia << moments[0], -products[0], -products[2],  //
        -products[0], moments[1], -products[1],         //
        -products[2], -products[1], moments[2];
    angular_velocity = to_vec4d(inertia.ldlt().solve(to_vec3(turning)));
  }

  Vec4d at_point(Vec4d point) const { return velocity + cross(angular_velocity, point - centre); }
};

double energy_of_vibration(const SoftBody& body, const RigidMotion& rigid) {
  const VertexReader x(body.positions), v(body.velocities);
  double sum = 0.0;
  for (int i = 0; i < body.positions.size(); ++i) {
    const Vec4d own = v[i] - rigid.at_point(x[i]);
    sum += dot(own, own);
  }
  return 0.5 * body.material.vertex_mass * sum;
}

/// Returns what was taken, J.
double slow_vibration(SoftBody& body, const RigidMotion& rigid, double factor, bool on_ground) {
  const VertexReader x(body.positions);
  double taken = 0.0;  // for masses of 2 kg
  for (int i = 0; i < body.positions.size(); ++i) {
    const Vec3 before = body.velocities[i];
    if (on_ground && before.isZero(0.0)) continue;
    const Vec3 of_rigid = to_vec3(rigid.at_point(x[i]));
    const Vec3 after = of_rigid + factor * (before - of_rigid);
    taken += before.squaredNorm() - after.squaredNorm();
    body.velocities[i] = after;
  }
  return 0.5 * body.material.vertex_mass * taken;
}

}  // namespace

double energy_of_vibration(const SoftBody& body) {
  return energy_of_vibration(body, RigidMotion(body));
}

double slow_vibration(SoftBody& body, double factor, bool on_ground) {
  return slow_vibration(body, RigidMotion(body), factor, on_ground);
}

double take_from_vibration(SoftBody& body, double energy) {
  if (!(energy > 0.0)) return 0.0;
  const RigidMotion rigid(body);
  const double there_is = energy_of_vibration(body, rigid);
  const double taken = std::min(energy, there_is);
  if (!(taken > 0.0)) return 0.0;
  return slow_vibration(body, rigid, std::sqrt(1.0 - taken / there_is), false);
}

}  // namespace pneuma::sim
