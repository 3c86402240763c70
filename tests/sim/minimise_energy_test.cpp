#include "sim/soft/minimise_energy.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/soft/implicit_step.h"
#include "tests/sim/minimiser_case.h"

namespace pneuma::sim {
namespace {

/// What holds at a least value on or above the floor: no force but that of the floor, upwards.
void expect_least(MinimiserCase& c, EnergyMinimiser& minimiser) {
  minimiser.update_gradient(c.energy);
  c.point = minimiser.point();
  const Eigen::VectorXd gradient = c.gradient();
  for (int v = 0; v < c.point.positions.size(); ++v) {
    const double floor_force = minimiser.floor_force(c.energy, v);
    if (c.energy.ground) {
      EXPECT_GE(c.point.positions[v].z(), c.energy.floor[at(v)]);
    }
    // N: the tolerance of 1e-10 m times a stiffness of some thousand N/m.
    EXPECT_LT((gradient.segment<3>(3 * v) - Vec3(0.0, 0.0, floor_force)).norm(), 1e-5) << v;
  }
}

TEST(EnergyMinimiser, EndsWhereNoForceIsLeftButThatOfTheFloor) {
  for (const bool ground : {false, true}) {
    for (const auto& [noise, gas] : {std::pair{0.02, 5000.0}, std::pair{0.3, 5000.0},
                                     std::pair{1.5, 5000.0}, std::pair{0.3, 0.0}}) {
      MinimiserCase c(make_sphere(3.0, 8, 8), noise);
      c.energy.ground = ground;
      c.energy.gas.strength = gas;
      for (int v = 0; v < c.point.positions.size(); ++v) {
        c.energy.floor[at(v)] = ground ? std::min(-2.0, c.point.positions[v].z()) : -1e9;
        c.energy.target[v].z() -= 1.5;
      }
      ASSERT_TRUE(evaluate(c.mesh(), c.energy, c.point));
      const double start = c.point.energy;
      EnergyMinimiser minimiser(c.mesh());
      minimiser.point() = c.point;
      const MinimiserReport report = minimiser.minimise(c.energy, 1e-10);
      EXPECT_TRUE(report.converged);
      EXPECT_LT(minimiser.point().energy, start);
      EXPECT_GT(minimiser.point().volume, 0.0);
      expect_least(c, minimiser);
    }
  }
}

TEST(EnergyMinimiser, FindsTheOnlyMinimumOfSpringsInClosedForm) {
  // Without gas and with rest lengths of zero E is quadratic: A (x - y) + s L x = 0, L the graph's
  // Laplacian. By conjugate gradients, and by factors, of which one solution is exact.
  for (const auto& [stiffness, iterations] : {std::pair{300.0, 4}, std::pair{3e4, 2}}) {
    MinimiserCase c(ball(), 0.3);
    c.energy.gas.strength = 0.0;
    c.energy.friction = false;
    c.energy.stiffness = stiffness;
    std::fill(c.energy.rest_lengths.begin(), c.energy.rest_lengths.end(), 0.0);
    ASSERT_TRUE(evaluate(c.mesh(), c.energy, c.point));
    const int vertices = c.point.positions.size();
    Eigen::MatrixXd system = c.energy.inertia * Eigen::MatrixXd::Identity(vertices, vertices);
    for (const auto& [a, b] : c.mesh().topology.edges()) {
      system(a, a) += c.energy.stiffness;
      system(b, b) += c.energy.stiffness;
      system(a, b) -= c.energy.stiffness;
      system(b, a) -= c.energy.stiffness;
    }
    const Eigen::MatrixXd expected =
        system.ldlt().solve(c.energy.inertia * c.energy.target.rows().transpose()).transpose();
    EnergyMinimiser minimiser(c.mesh());
    minimiser.point() = c.point;
    const MinimiserReport report = minimiser.minimise(c.energy, 1e-10);
    EXPECT_LE(report.iterations, iterations);
    EXPECT_EQ(report.factorizations, stiffness == 300.0 ? 0 : 1);
    EXPECT_LT((minimiser.point().positions.rows() - expected).norm(), 1e-10);
  }
}

TEST(EnergyMinimiser, KnowsNothingOfTheBodyBefore) {
  // One with gas, of a volume far from 1 m^3, and then one without.
  MinimiserCase full(ball()), empty(ball());
  empty.energy.gas.strength = 0.0;
  ASSERT_TRUE(evaluate(empty.mesh(), empty.energy, empty.point));
  EnergyMinimiser used(full.mesh()), fresh(full.mesh());
  used.point() = full.point;
  EXPECT_TRUE(used.minimise(full.energy, 1e-10).converged);
  used.forget();
  for (EnergyMinimiser* minimiser : {&used, &fresh}) {
    minimiser->point().positions.rows() = empty.point.positions.rows();
    ASSERT_TRUE(evaluate(empty.mesh(), empty.energy, minimiser->point()));
    EXPECT_TRUE(minimiser->minimise(empty.energy, 1e-10).converged);
  }
  EXPECT_EQ(used.point().positions.rows(), fresh.point().positions.rows());
}

TEST(EnergyMinimiser, IsNotStoppedByOneKinkOfFrictionAfterTheOther) {
  // A light body that is blown up against the ground: dozens of vertices come to rest there in one
  // step. One after the other they took up to 55 iterations here, and 131 with 2,562 vertices.
  World world;
  world.settings.integrator = Integrator::implicit_euler;
  SoftBody body = make_body(make_icosphere(3.0, 3), {0.0, 0.0, 3.2});
  body.material.k = 1.0;
  body.material.n = 1.0;
  body.material.vertex_mass = 20.0 / body.positions.size();
  ImplicitScratch scratch(*body.mesh);
  int pushed = 0;
  for (int step = 0; step < 8; ++step) {
    const SoftState start{body.positions, body.velocities};
    const ImplicitReport report = implicit_step(*body.mesh, body.material, world.settings, start,
                                                body.positions, body.velocities, scratch);
    EXPECT_TRUE(report.converged);
    EXPECT_LE(report.iterations, 20) << step;  // of up to four rounds of friction
    pushed = static_cast<int>(std::count(scratch.pushed.begin(), scratch.pushed.end(), 1));
  }
  EXPECT_GT(pushed, 50);
}

TEST(EnergyMinimiser, ComesBackFromAVolumeOfAlmostNothing) {
  // The pressure of 5,000 J in 1e-12 m^3 is that of the inside of the sun.
  MinimiserCase c(make_sphere(3.0, 8, 8), 0.0);
  for (int v = 0; v < c.point.positions.size(); ++v) c.point.positions[v].z() *= 1e-14;
  ASSERT_TRUE(evaluate(c.mesh(), c.energy, c.point));
  ASSERT_LT(c.point.volume, 1e-12);
  EnergyMinimiser minimiser(c.mesh());
  minimiser.point() = c.point;
  EXPECT_TRUE(minimiser.minimise(c.energy, 1e-10).converged);
  expect_least(c, minimiser);
}

}  // namespace
}  // namespace pneuma::sim
