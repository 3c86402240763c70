// Worlds of boxes that move freely where contact is a potential.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "sim/rigid/inertia.h"
#include "sim/rigid/rigid_motion.h"
#include "tests/sim/potential/potential_worlds.h"

namespace pneuma::sim {

inline RigidBox undamped_box(const Vec3& size, const Vec3& position, double mass = 1.0) {
  RigidBox box = make_rigid(size, position, mass);
  box.rho_g = 0.0;
  return box;
}

inline World world_of_boxes(Integrator integrator, int steps_per_second,
                            std::vector<RigidBox> boxes) {
  World world = potential_world(integrator, steps_per_second);
  world.rigid = std::move(boxes);
  return world;
}

/// Euler's equations in body axes by rk4, and the orientation with them.
inline RigidBox spun(RigidBox box, double duration, int steps) {
  const Vec3 inertia = body_inertia(box);
  const auto slope = [&](const Vec3& rate) -> Vec3 {
    return (inertia.cwiseProduct(rate)).cross(rate).cwiseQuotient(inertia);
  };
  Vec3 rate = box.orientation.conjugate() * box.angular_velocity;
  const double h = duration / steps;
  for (int i = 0; i < steps; ++i) {
    const Vec3 a = slope(rate), b = slope(rate + 0.5 * h * a), c = slope(rate + 0.5 * h * b);
    const Vec3 next = rate + h / 6.0 * (a + 2.0 * b + 2.0 * c + slope(rate + h * c));
    const Vec3 middle = rate + 0.5 * h * a;
    box.orientation = turned(box.orientation, h * (box.orientation * middle));
    rate = next;
  }
  box.angular_velocity = box.orientation * rate;
  return box;
}

/// Boxes and a ball that fall onto each other, turned at random.
inline World falling_pile(Integrator integrator, int steps_per_second) {
  World world = potential_world(integrator, steps_per_second);
  world.soft.push_back(soft_ball({0, 0, 1.1}, Vec3::Zero()));
  for (int i = 0; i < 5; ++i) {
    RigidBox box = make_rigid({0.8, 0.5, 1.0}, {0.5 * (i % 2), 0.3 * (i % 3), 3.0 + 1.6 * i});
    box.name = "box-" + std::to_string(i);
    box.orientation = turned(box.orientation, {0.7 * i, 1.0 - 0.3 * i, 0.4});
    box.angular_velocity = {2.0 - i, 1.0 * i, 0.5};
    box.velocity = {0, 0, -3.0};
    box.mass = std::pow(2.0, i - 2);
    world.rigid.push_back(box);
  }
  world.rigid.push_back(make_rigid({6, 6, 0.3}, {0, 0, -0.35}));
  world.rigid.back().is_kinematic = true;
  world.settings.ground.reset();
  return world;
}

}  // namespace pneuma::sim
