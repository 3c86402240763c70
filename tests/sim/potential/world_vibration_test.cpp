// Small motions of bodies that touch: against differences of their accelerations, a closed form,
// and steps that grow.
#include "sim/potential/world_vibration.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <vector>

#include "sim/potential/explicit_world_step.h"
#include "sim/soft/explicit_step.h"
#include "tests/sim/potential/free_box_worlds.h"
#include "tests/support/eigenvalues.h"

namespace pneuma::sim {
namespace {

/// A ball that lies on the ground, and another, five times as heavy a vertex, upon it.
World resting_balls(double friction) {
  World world = potential_world(Integrator::implicit_euler, 60);
  world.settings.ground = ContactMaterial{0.5, friction};
  world.soft.push_back(soft_ball({0, 0, 1.02}, Vec3::Zero()));
  world.soft.push_back(soft_ball({0, 0, 3.1}, Vec3::Zero()));
  world.soft[1].material.vertex_mass *= 5.0;
  for (SoftBody& ball : world.soft) {
    ball.material.surface = {0.5, friction};
    ball.material.rho_g = 0.3;
  }
  EXPECT_FALSE(run(world, 4.0));
  for (SoftBody& ball : world.soft) ball.velocities.rows().setZero();
  return world;
}

struct Equation {
  explicit Equation(const World& world)
      : surfaces(world),
        acceleration(world, surfaces, BoxCoordinates::Form::momentum),
        rest{VertexArray(surfaces.vertex_count()), VertexArray(surfaces.vertex_count())} {
    surfaces.gather(world, rest.positions, rest.velocities);
    for (const SoftBody& body : world.soft) {
      for (int v = 0; v < body.positions.size(); ++v) {
        masses.push_back(body.material.vertex_mass);
      }
    }
    acceleration.set_margin(0.05);
  }

  ContactSurfaces surfaces;
  WorldAcceleration acceleration;
  SoftState rest;
  std::vector<double> masses;
};

TEST(WorldVibration, TheFastestIsThatOfTheGreatestEigenvalue) {
  for (const double friction : {0.0, 0.4}) {
    const World world = resting_balls(friction);
    WorldVibration motions(world);
    ASSERT_TRUE(motions.in_contact());
    const Equation equation(world);
    const auto mass_of = [&](int v) { return equation.masses[at(v)]; };
    // Lanczos' vectors, and the curvature of the distance of what touches, which is left out.
    const double stiff =
        greatest_eigenvalue(equation.acceleration, equation.rest, mass_of, false, 1e-7);
    EXPECT_NEAR(motions.fastest(0.0).squared_frequency / stiff, 1.0, 0.01) << friction;
    // The regularised friction's slope falls from zero speed on: by 1e-4 where it is differenced.
    const double damped =
        greatest_eigenvalue(equation.acceleration, equation.rest, mass_of, true, 1e-6);
    EXPECT_NEAR(motions.fastest(1e9).decay / damped, 1.0, 0.01) << friction;
  }
}

// Of all that are found for other weights, none is faster.
TEST(WorldVibration, IsTheFastestForEveryWeight) {
  const World world = resting_balls(0.4);
  WorldVibration motions(world);
  std::vector<double> weights;
  for (int i = 0; i <= 60; ++i) weights.push_back(std::pow(10.0, 0.1 * i));
  std::vector<Oscillation> found;
  for (const double weight : weights) found.push_back(motions.fastest(weight));
  for (std::size_t i = 0; i < found.size(); ++i) {
    const auto rate = [&](const Oscillation& one) {
      return one.squared_frequency + weights[i] * one.decay;
    };
    for (const Oscillation& other : found) EXPECT_GT(rate(found[i]), 0.99 * rate(other));
  }
}

// A cube on four corners that the ground holds up with the stiffness A kappa f''(d / r) / r each:
// they move with c = (1, y, -x) as it rises and turns about x and y.
TEST(WorldVibration, ACubeSwingsOnItsCorners) {
  constexpr double mass = 3.0, deep = 0.01;
  World world = world_of_boxes(Integrator::implicit_euler, 60,
                               {undamped_box({1, 1, 1}, {0, 0, 0.5 - deep}, mass)});
  world.settings.ground = ContactMaterial{1.0, 0.0};
  world.rigid[0].surface = {1.0, 0.0};
  const ContactSurfaces surfaces(world);
  const ContactSurface& surface = surfaces[0];
  const double curvature = surfaces.stiffness() / surface.reach *
                           barrier((surface.reach - deep) / surface.reach).curvature;
  VertexArray corners(surfaces.vertex_count());
  surfaces.place_boxes(world, corners);
  Mat3 stiffness = Mat3::Zero();
  for (int i = 0; i < box_corners; ++i) {
    const Vec3 at_corner = corners[surface.first_vertex + i];
    if (at_corner.z() > 0.0) continue;
    const Vec3 c(1.0, at_corner.y(), -at_corner.x());
    stiffness += surface.areas[at(i)] * curvature * c * c.transpose();
  }
  const Vec3 inverse_root = Vec3(mass, mass / 6.0, mass / 6.0).cwiseSqrt().cwiseInverse();
  const Mat3 scaled = inverse_root.asDiagonal() * stiffness * inverse_root.asDiagonal();
  const double expected = Eigen::SelfAdjointEigenSolver<Mat3>(scaled).eigenvalues().maxCoeff();
  WorldVibration motions(world);
  // What its corners' pushes add as they turn is left out above.
  EXPECT_NEAR(motions.fastest(0.0).squared_frequency / expected, 1.0, 1e-2);
}

/// Whether small random motions about rest have grown a thousandfold after 2,000 steps.
bool grows(const Equation& equation, Integrator integrator, double step) {
  SoftState state = equation.rest;
  const int count = state.positions.size();
  for (int v = 0; v < count; ++v) {
    for (int axis = 0; axis < 3; ++axis) {
      state.positions[v][axis] += 1e-12 * std::sin(1.0 + 3 * v + axis);
    }
  }
  // What is not quite at rest goes to rest on the way: both are followed, and their difference.
  SoftState still = equation.rest;
  ExplicitScratch memory(count, integrator);
  VertexArray x(count), v(count);
  const auto size = [&] { return (state.positions.rows() - still.positions.rows()).norm(); };
  const double start = size();
  for (int i = 0; i < 2000; ++i) {
    for (SoftState* each : {&state, &still}) {
      explicit_step(integrator, equation.acceleration, step, *each, x, v, memory);
      std::swap(each->positions, x);
      std::swap(each->velocities, v);
    }
    if (!(size() < 1e3 * start)) return true;
  }
  return false;
}

TEST(WorldVibration, StepsThatAreLongerMakeSmallMotionsGrow) {
  for (const double friction : {0.0, 0.4}) {
    World world = resting_balls(friction);
    world.soft.resize(1);  // what lies on a ball rolls off it
    ASSERT_FALSE(run(world, 20.0));
    const Equation equation(world);
    WorldVibration motions(world);
    for (const Integrator integrator :
         {Integrator::martin, Integrator::symplectic_euler, Integrator::velocity_verlet,
          Integrator::rk4, Integrator::rk8}) {
      const double predicted = stability_limit(motions, integrator).step;
      EXPECT_FALSE(grows(equation, integrator, 0.97 * predicted)) << friction;
      EXPECT_TRUE(grows(equation, integrator, 1.03 * predicted)) << friction;
    }
  }
}

}  // namespace
}  // namespace pneuma::sim
