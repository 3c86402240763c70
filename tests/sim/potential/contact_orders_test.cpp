// The orders of the integrators with contact: two balls that meet, without friction, which bounce
// fully, so that nothing of the equation has a jump. Against rk4 at a far finer step.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/sim/potential/potential_worlds.h"

namespace pneuma::sim {
namespace {

constexpr double seconds = 0.13;

World smooth_balls(Integrator integrator, int steps_per_second) {
  World world = meeting_balls(integrator, steps_per_second);
  world.settings.potential.distance = 1.0;  // the most that edges allow
  world.settings.potential.stiffness = 300.0;
  for (SoftBody& ball : world.soft) ball.material.surface = {1.0, 0.0};
  return world;
}

VertexArray end_of(Integrator integrator, int steps_per_second) {
  World world = smooth_balls(integrator, steps_per_second);
  EXPECT_FALSE(run(world, seconds));
  return world.soft[0].positions;
}

double error_at(Integrator integrator, int steps_per_second, const VertexArray& exact) {
  return (end_of(integrator, steps_per_second).rows() - exact.rows()).colwise().norm().maxCoeff();
}

/// From steps of h and h / 2.
double order_at(Integrator integrator, int steps_per_second, const VertexArray& exact) {
  return std::log2(error_at(integrator, steps_per_second, exact) /
                   error_at(integrator, 2 * steps_per_second, exact));
}

TEST(ContactOrders, AreThoseOfTheIntegrators) {
  const VertexArray exact = end_of(Integrator::rk4, 16'000);
  ASSERT_GT((exact.rows() - end_of(Integrator::rk4, 4'000).rows()).norm(), 0.0);
  World free = smooth_balls(Integrator::rk4, 2000);
  free.soft.resize(1);
  ASSERT_FALSE(run(free, seconds));
  ASSERT_GT((exact.rows() - free.soft[0].positions.rows()).colwise().norm().maxCoeff(), 0.01)
      << "the balls must have met";
  EXPECT_GT(order_at(Integrator::rk4, 1000, exact), 1.9);
  EXPECT_NEAR(order_at(Integrator::velocity_verlet, 2000, exact), 2.0, 0.1);
  EXPECT_NEAR(order_at(Integrator::symplectic_euler, 4000, exact), 1.0, 0.1);
  EXPECT_NEAR(order_at(Integrator::implicit_euler, 4000, exact), 1.0, 0.1);
  EXPECT_GT(order_at(Integrator::sdirk2, 1000, exact), 1.8);
}

}  // namespace
}  // namespace pneuma::sim
