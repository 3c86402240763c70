// The stable steps of bodies that springs join, beside runs with shorter and longer ones.
#include "sim/joints/spring_limit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/inspect/inspect.h"
#include "sim/joints/body_springs.h"
#include "tests/support/worlds.h"

namespace pneuma::sim {
namespace {

constexpr double stiff = 1e5;  // N/m: beside it the bodies' own springs are slack

/// Two empty balls at rest without damping, and a spring that is a trifle too short.
World make_pair(Integrator integrator, double damping) {
  World world = make_free_world(make_body(make_icosphere(0.5, 1)));
  world.soft.push_back(make_body(make_icosphere(0.7, 1), {3.0, 0.0, 0.0}));
  world.soft[0].material.vertex_mass = 0.02;
  world.soft[1].material.vertex_mass = 0.05;
  for (SoftBody& body : world.soft) {
    undamp(body.material);
    body.material.n = 0.0;
  }
  world.springs = {{{0, {3}}, {1, {5, 6, 7}}, stiff, damping, 0.0}};
  world.springs[0].rest_length = spring_between(world, world.springs[0]).norm() - 1e-6;
  world.settings.integrator = integrator;
  return world;
}

/// Of what is in the spring at the start: the most in a tenth of a second, with steps of this share
/// of the limit; or a million times as much, and more, as soon as there is that.
double greatest_growth(Integrator integrator, double damping, double share) {
  World world = make_pair(integrator, damping);
  const double start = spring_energy_between_bodies(world);
  const StabilityLimit limit = joined_stability_limit(integrator, world, 0);
  world.settings.steps_per_second = static_cast<int>(std::ceil(1.0 / (share * limit.step)));
  Stepper stepper(world);
  double greatest = 1.0;
  for (int i = 0; i < world.settings.steps_per_second / 10 && greatest < 1e6; ++i) {
    if (stepper.step(world)) return std::numeric_limits<double>::infinity();
    greatest = std::max(greatest, spring_energy_between_bodies(world) / start);
  }
  return greatest;
}

TEST(SpringLimit, IsThatOfEveryIntegrator) {
  for (const Integrator integrator : all_integrators) {
    for (const double damping : {0.0, 5.0}) {
      const int number = static_cast<int>(integrator);
      EXPECT_LT(greatest_growth(integrator, damping, 0.95), 30.0) << number << " " << damping;
      EXPECT_GE(greatest_growth(integrator, damping, 1.15), 1e6) << number << " " << damping;
    }
  }
}

TEST(SpringLimit, AddsUpWhereSpringsShareAVertex) {
  World world = make_pair(Integrator::rk4, 0.0);
  const double one = spring_oscillation(world, 0).squared_frequency;
  EXPECT_NEAR(one, stiff * (1.0 / 0.02 + 1.0 / (3.0 * 0.05)), 1e-12 * one);
  world.springs.push_back(world.springs[0]);
  world.springs[1].first.vertices = {4};
  world.springs[1].second.vertices = {8, 9, 10};
  EXPECT_EQ(spring_oscillation(world, 0).squared_frequency, one);
  world.springs[1].second.vertices = {7, 8, 9};
  EXPECT_EQ(spring_oscillation(world, 0).squared_frequency, 2.0 * one);
  world.springs.clear();
  EXPECT_EQ(spring_oscillation(world, 0).squared_frequency, 0.0);
  EXPECT_EQ(joined_stability_limit(Integrator::rk4, world, 0).step,
            settled_stability_limit(Integrator::rk4, world.soft[0]).step);
}

}  // namespace
}  // namespace pneuma::sim
