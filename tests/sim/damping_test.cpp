#include "sim/soft/damping.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/inspect/inspect.h"
#include "tests/support/worlds.h"

namespace pneuma::sim {
namespace {

TEST(Damping, OneSpringLosesThePapersShareInASixtiethOfASecond) {
  // Two masses m on a dashpot c: m dv0/dt = c u, m dv1/dt = -c u, so u = v1 - v0 decays at 2 c / m.
  SoftMaterial material;
  material.k = 150.0;
  material.k_max = 400.0;
  material.vertex_mass = 0.7;
  const double decay = std::exp(-2.0 * dashpot_constant(material) / material.vertex_mass / 60.0);
  EXPECT_NEAR(decay, 1.0 - 150.0 / 400.0, 1e-15);
}

TEST(Damping, SpringsBeyondKMaxStayFinite) {
  SoftMaterial material;
  material.k_max = 400.0;
  material.k = 400.0;
  const double at_most = dashpot_constant(material);
  EXPECT_TRUE(std::isfinite(at_most));
  material.k = 1e8;
  EXPECT_EQ(dashpot_constant(material), at_most);
}

TEST(Damping, BothReadingsLoseTheSameShareInASixtiethOfASecond) {
  // A body that moves without turning: the springs' dashpots see nothing, the literal form takes
  // its whole rho.
  for (const double rho_g : {0.0, 0.01, 0.3}) {
    SoftBody body = make_body(make_sphere(3.0, 8, 8));
    body.material.n = 0.0;
    body.material.rho_g = rho_g;
    body.velocities.rows().row(0).setConstant(2.0);
    body.material.damping = Damping::dashpot;
    World continuous = make_free_world(body);
    continuous.settings.steps_per_second = 960;
    ASSERT_FALSE(run(continuous, 1.0 / 60.0));
    // rk4 of exp(-gamma t): 16 steps with an error of 2 (gamma h)^5 / 120, gamma h at most 0.0223.
    EXPECT_NEAR(continuous.soft[0].velocities[0].x(), 2.0 * (1.0 - rho_g), 1.5e-9);

    body.material.damping = Damping::literal;
    World literal = make_free_world(body);
    ASSERT_FALSE(run(literal, 1.0 / 60.0));
    const double rho = rho_g + (1.0 - rho_g) * body.material.k / body.material.k_max;
    EXPECT_DOUBLE_EQ(literal.soft[0].velocities[0].x(), 2.0 * (1.0 - rho));
  }
}

TEST(Damping, LiteralDependsOnTheStepAndHoldsAFallingBodyBack) {
  // ERRATA row 5: k = 150 takes 38 % a step, and a falling ball reaches only 0.43 m/s. In closed
  // form the terminal speed is (1 - rho) / rho g h.
  const auto fall = [](int steps_per_second) {
    SoftBody body = make_body(make_sphere(3.0, 8, 8));
    body.material.k = 150.0;
    body.material.n = 0.0;
    body.material.damping = Damping::literal;
    World world = make_free_world(body);
    world.settings.gravity = {0.0, 0.0, -9.81};
    world.settings.steps_per_second = steps_per_second;
    EXPECT_FALSE(run(world, 5.0));
    return -mean(world.soft[0].velocities).z();
  };
  const double rho = 0.01 + 0.99 * 150.0 / 400.0;
  EXPECT_NEAR(rho, 0.38, 0.002);
  // The mean of 58 equal numbers, and a geometric series that has converged: rounding.
  EXPECT_NEAR(fall(60), (1.0 - rho) / rho * 9.81 / 60.0, 1e-12);
  EXPECT_NEAR(fall(240), (1.0 - rho) / rho * 9.81 / 240.0, 1e-12);
  EXPECT_LT(fall(60), 0.43);
}

TEST(Damping, DashpotsTakeEnergyButNoMomentum) {
  SoftBody body = make_body(make_torus(4.0, 1.5, 16, 16));
  perturb(body, 0.1, 5);
  body.material.rho_g = 0.0;
  World world = make_free_world(body);
  const Momentum before = momentum(world);
  const double energy_before = energy(world).total();
  ASSERT_FALSE(run(world, 1.0));
  const Momentum after = momentum(world);
  // Linear: internal forces cancel to rounding over 60 x 4 evaluations of 256 vertices. Angular:
  // rk4 keeps it only to its own error.
  const double scale = body.material.vertex_mass * 256 * 0.1;
  EXPECT_LT((after.linear - before.linear).norm() / scale, 1e-10);
  EXPECT_LT((after.angular - before.angular).norm() / (scale * 4.0), 1e-3);
  EXPECT_LT(energy(world).total(), energy_before);
}

}  // namespace
}  // namespace pneuma::sim
