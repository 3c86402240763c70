#include "app/accuracy/motion_time.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/mesh/measure.h"
#include "sim/soft/acceleration.h"

namespace pneuma::app {
namespace {

using sim::Vec3;

double root_mean_square(const sim::VertexArray& values) {
  double sum = 0.0;
  for (int v = 0; v < values.size(); ++v) sum += Vec3(values[v]).squaredNorm();
  return std::sqrt(sum / std::max(1, values.size()));
}

double start_acceleration(const sim::SoftBody& body, const Vec3& gravity) {
  sim::AccelerationScratch scratch(*body.mesh);
  const sim::SoftAcceleration equation(*body.mesh, body.material, gravity, scratch);
  sim::VertexArray acceleration(body.positions.size());
  equation(body.positions, body.velocities, acceleration);
  return root_mean_square(acceleration);
}

/// m/s, that a body which starts so high gains on its way to the ground, or in the run.
double fall_speed(const sim::Settings& settings, double height, double seconds) {
  const double down = -settings.gravity.z();
  if (!settings.ground || down <= 0.0) return settings.gravity.norm() * seconds;
  return std::min(std::sqrt(2.0 * down * std::max(0.0, height)), down * seconds);
}

double highest_speed(const sim::World& world, double seconds) {
  double highest = 0.0;
  for (const sim::SoftBody& body : world.soft) {
    const double fall =
        !sim::is_kinematic(body)
            ? fall_speed(world.settings, sim::bounds(body.positions).low.z(), seconds)
            : 0.0;
    highest = std::max(highest, root_mean_square(body.velocities) + fall);
  }
  for (const sim::RigidBox& box : world.rigid) {
    const double half = 0.5 * box.size.norm();
    const double fall =
        box.is_kinematic ? 0.0 : fall_speed(world.settings, box.position.z() - half, seconds);
    highest = std::max(highest, box.velocity.norm() + half * box.angular_velocity.norm() + fall);
  }
  return highest;
}

void shorten(MotionTime& time, double radius, double acceleration, double speed,
             const std::string& body) {
  const double seconds = std::min(std::sqrt(radius / acceleration), radius / speed);
  if (seconds < time.seconds) time = {seconds, body};
}

}  // namespace

MotionTime motion_time(const sim::World& world, double seconds) {
  MotionTime time{std::numeric_limits<double>::infinity(), ""};
  const double speed = highest_speed(world, seconds);
  for (const sim::SoftBody& body : world.soft) {
    if (sim::is_kinematic(body)) continue;
    shorten(time, sim::radius(body.mesh->rest_positions),
            start_acceleration(body, world.settings.gravity), speed, body.name);
  }
  for (const sim::RigidBox& box : world.rigid) {
    if (box.is_kinematic) continue;
    shorten(time, 0.5 * box.size.minCoeff(), world.settings.gravity.norm(), speed, box.name);
  }
  return time;
}

}  // namespace pneuma::app
