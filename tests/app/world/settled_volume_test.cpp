#include "app/world/settled_volume.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/equilibrium/equilibrium.h"
#include "sim/soft/pressure_force.h"
#include "tests/support/worlds.h"

namespace pneuma::app {
namespace {

using sim::SoftBody;

/// Of the body once it has come to rest under an explicit integrator.
double volume_after_a_run(SoftBody body) {
  body.material.rho_g = 0.5;  // so that it comes to rest
  sim::World world = sim::make_free_world(std::move(body));
  world.settings.steps_per_second = 480;
  EXPECT_FALSE(sim::run(world, 20.0));
  return volume_of(world.soft[0]);
}

void expect_what_a_run_comes_to(const sim::TriangleMesh& mesh, double tolerance) {
  for (const double n : {0.01, 0.5, 10.0, 100.0}) {
    SoftBody body = sim::make_body(mesh, {1.0, -2.0, 5.0});
    body.material.n = n;
    const auto settled = settled_volume(body);
    ASSERT_TRUE(settled) << n;
    EXPECT_NEAR(*settled / volume_after_a_run(body), 1.0, tolerance) << n;
  }
}

TEST(SettledVolume, IsWhatARunComesTo) {
  expect_what_a_run_comes_to(sim::make_sphere(2.0, 8, 8), 1e-3);
  expect_what_a_run_comes_to(sim::make_icosphere(2.0, 2), 1e-3);
  // A torus blown up far has several balances, whose volumes differ by a few hundredths.
  expect_what_a_run_comes_to(sim::make_torus(4.0, 1.5, 12, 12), 0.05);
}

TEST(SettledVolume, OfAnIcosahedronHasAClosedForm) {
  SoftBody body = sim::make_body(sim::make_icosphere(2.0, 0));
  const double edge = body.mesh->rest_lengths[0];
  const double stiffness = 30.0 * body.material.k * edge * edge;
  for (const double n : {0.1, 1.0, 50.0}) {
    body.material.n = n;
    // At s times its size the energy 30 k/2 (s - 1)^2 edge^2 - 3 nRT ln s is minimal.
    const double gas = 3.0 * sim::gas_strength(body.material);
    const double s = 0.5 * (1.0 + std::sqrt(1.0 + 4.0 * gas / stiffness));
    EXPECT_NEAR(settled_volume(body).value() / (volume_of(body) * s * s * s), 1.0, 1e-3) << n;
  }
}

// Of any shape: at s times its size at rest its energy is least at s = 1.
TEST(SettledVolume, OfManyVerticesBalancesSpringsAndGas) {
  SoftBody body = sim::make_body(sim::make_torus(4.0, 1.5, 72, 72));
  body.material.n = 10.0;
  const auto settled = settled_body(body);
  ASSERT_TRUE(settled);
  double springs = 0.0;
  for (int e = 0; e < body.mesh->topology.edge_count(); ++e) {
    const auto& [a, b] = body.mesh->topology.edges()[sim::at(e)];
    const double length = (settled->positions[b] - settled->positions[a]).norm();
    springs += body.material.k * (length - body.mesh->rest_lengths[sim::at(e)]) * length;
  }
  // Swings of 3e-4 of the volume are left.
  EXPECT_NEAR(springs / (3.0 * sim::gas_strength(body.material)), 1.0, 1e-2);
}

TEST(SettledVolume, DoesNotDependOnTheMass) {
  SoftBody body = sim::make_body(sim::make_icosphere(50.0, 3));
  body.material.k = 2e6;
  body.material.n = 0.5 * body.material.k;
  const double light = settled_volume(body).value();
  const double held = held_pressure(body, 1.1 * volume_of(body)).value();
  for (const double vertex_mass : {7e3, 7e6}) {
    body.material.vertex_mass = vertex_mass;
    EXPECT_NEAR(settled_volume(body).value() / light, 1.0, 1e-3) << vertex_mass;
    EXPECT_NEAR(held_pressure(body, 1.1 * volume_of(body)).value() / held, 1.0, 1e-3)
        << vertex_mass;
  }
}

TEST(SettledVolume, StaysWithoutGasOrInEquilibrium) {
  SoftBody body = sim::make_body(sim::make_sphere(3.0, 8, 8));
  const double start = volume_of(body);
  body.material.n = 0.5;
  const auto held =
      sim::find_equilibrium(body.mesh->topology, body.positions, body.material).rest_lengths;
  SoftBody balanced = body;
  balanced.mesh = sim::make_soft_mesh(*body.mesh, held);
  EXPECT_NEAR(settled_volume(balanced).value(), start, 1e-3 * start);
  body.material.n = 0.0;
  EXPECT_EQ(settled_volume(body), start);
  body.material.k = 0.0;
  body.material.n = 1.0;
  EXPECT_TRUE(std::isinf(settled_volume(body).value()));
}

}  // namespace
}  // namespace pneuma::app
