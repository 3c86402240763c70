// P V^g = constant with an ambient pressure outside (ERRATA row 69), in every integrator.
#include "sim/soft/gas_law.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sim/equilibrium/held_shape.h"
#include "sim/soft/acceleration.h"
#include "sim/soft/stability_limit.h"
#include "tests/support/worlds.h"

namespace pneuma::sim {
namespace {

/// In which the gas is at the pressure P at the start.
SoftBody filled(const TriangleMesh& mesh, double exponent, double absolute, double ambient) {
  SoftBody body = make_body(mesh, {3.0, -1.0, 2.0});
  undamp(body.material);
  body.material.gas_exponent = exponent;
  body.material.start_volume = volume_of(body);
  body.material.ambient_pressure = ambient;
  body.material.n = absolute * volume_of(body) / (gas_constant * body.material.temperature);
  return body;
}

std::vector<SoftBody> air_bodies() {
  std::vector<SoftBody> bodies;
  for (const double exponent : {1.0, 1.0001, 1.4, 5.0 / 3.0}) {
    for (const double ambient : {0.0, 100.0, 400.0}) {
      bodies.push_back(filled(make_sphere(2.0, 5, 6), exponent, 200.0, ambient));
    }
  }
  return bodies;
}

TEST(GasLaw, ForceIsTheNegativeGradientOfTheEnergy) {
  for (SoftBody body : air_bodies()) {
    perturb(body, 0.2, 3);
    body.velocities.rows().setZero();
    AccelerationScratch scratch(*body.mesh);
    VertexArray a(body.positions.size());
    SoftAcceleration(*body.mesh, body.material, Vec3::Zero(), scratch)(body.positions,
                                                                       body.velocities, a);
    const double h = 1e-5;  // m: truncation 1e-10 of the forces, rounding 1e-16 E / h = 1e-7 N
    double wrong = 0.0, size = 0.0;
    for (int v = 0; v < body.positions.size(); ++v) {
      for (int axis = 0; axis < 3; ++axis) {
        double& x = body.positions[v][axis];
        const double here = x;
        x = here + h;
        const double above = energy(body, Vec3::Zero()).total();
        x = here - h;
        const double below = energy(body, Vec3::Zero()).total();
        x = here;
        const double force = body.material.vertex_mass * a[v][axis];
        wrong = std::max(wrong, std::abs(force + (above - below) / (2.0 * h)));
        size = std::max(size, std::abs(force));
      }
    }
    EXPECT_LT(wrong / size, 1e-7) << body.material.gas_exponent;
  }
}

TEST(GasLaw, TendsToTheIsothermalOne) {
  const GasLaw isothermal{5000.0, 1.0, 20.0, 30.0}, nearly{5000.0, 1.0 + 1e-9, 20.0, 30.0};
  for (const double v : {0.1, 20.0, 500.0}) {
    EXPECT_NEAR(gas_energy(nearly, v), gas_energy(isothermal, v), 1e-3);
    EXPECT_NEAR(absolute_pressure(nearly, v) * v, 5000.0, 1e-4);
  }
  EXPECT_EQ(gas_energy(GasLaw{}, 3.0), 0.0);
}

/// An icosahedron's 12 vertices and 30 edges, all at one distance r from its centre: l = a r and
/// V = b r^3, so that 12 m r'' = -30 k a (a r - L) + 3 b r^2 (P - p0).
struct Breathing {
  double squared_frequency;  // rad^2/s^2 about rest
  double speed;              // m/s of every vertex, small beside the frequency times r
};

Breathing breathing(const SoftBody& body) {
  const SoftMaterial& m = body.material;
  const double r = (Vec3(body.positions[0]) - mean(body.positions)).norm();
  const double a = body.mesh->rest_lengths[0] / r, b = volume_of(body) / (r * r * r);
  const double p = absolute_pressure(gas_law(m), volume_of(body));
  const double stiffness = 30.0 * m.k * a * a + 9.0 * b * r * m.gas_exponent * p -
                           6.0 * b * r * (p - m.ambient_pressure);
  const double squared = stiffness / (12.0 * m.vertex_mass);
  return {squared, 1e-4 * r * std::sqrt(squared)};
}

/// s of one oscillation, over ten: from one volume of the start to the next, upwards.
double period(const SoftBody& body, Integrator integrator) {
  const Breathing motion = breathing(body);
  World world = make_free_world(body);
  world.settings.integrator = integrator;
  const double expected = 2.0 * std::numbers::pi / std::sqrt(motion.squared_frequency);
  world.settings.steps_per_second = static_cast<int>(400.0 / expected);
  SoftBody& moving = world.soft[0];
  const Vec3 centre = mean(moving.positions);
  for (int v = 0; v < 12; ++v) {
    moving.velocities[v] = motion.speed * (Vec3(moving.positions[v]) - centre).normalized();
  }
  const double rest = volume_of(moving);
  Stepper stepper(world);
  double before = 0.0, last_crossing = 0.0;
  for (int crossings = 0; crossings < 10;) {
    if (stepper.step(world)) return 0.0;
    const double now = volume_of(moving) - rest;
    if (before < 0.0 && now >= 0.0) {
      ++crossings;
      last_crossing = time(world) - time_step(world.settings) * now / (now - before);
    }
    before = now;
  }
  return last_crossing / 10.0;
}

TEST(GasLaw, ABallBreathesAtItsClosedFormFrequency) {
  for (const double exponent : {1.0, 1.4}) {
    // Springs at rest, P = p0; then no springs at all: gas between its own walls (Minnaert, 1933).
    for (const double k : {50.0, 0.0}) {
      SoftBody body = filled(make_icosphere(2.0, 0), exponent, 300.0, 300.0);
      body.material.k = k;
      const double expected = 2.0 * std::numbers::pi / std::sqrt(breathing(body).squared_frequency);
      for (const Integrator integrator :
           {Integrator::rk4, Integrator::velocity_verlet, Integrator::sdirk2}) {
        EXPECT_NEAR(period(body, integrator) / expected, 1.0, 1e-3)
            << "k = " << k << " N/m, g = " << exponent;
      }
    }
  }
}

/// J by which the energy is off at most in a second.
double energy_error(const SoftBody& body, Integrator integrator, int steps_per_second) {
  World world = make_free_world(body);
  world.settings.integrator = integrator;
  world.settings.steps_per_second = steps_per_second;
  const double start = energy(world).total();
  Stepper stepper(world);
  double error = 0.0;
  for (int i = 0; i < steps_per_second; ++i) {
    EXPECT_FALSE(stepper.step(world));
    error = std::max(error, std::abs(energy(world).total() - start));
  }
  return error;
}

TEST(GasLaw, KeepsEnergyToTheOrderOfTheIntegrator) {
  SoftBody body = filled(make_sphere(2.0, 6, 8), 1.4, 250.0, 200.0);
  const double less = energy_error(body, Integrator::velocity_verlet, 240);
  EXPECT_NEAR(less / energy_error(body, Integrator::velocity_verlet, 480), 4.0, 0.8);
  const double least = energy_error(body, Integrator::rk4, 240);
  EXPECT_GT(least / energy_error(body, Integrator::rk4, 480), 14.0);
  EXPECT_LT(least, 0.01 * less);
}

TEST(GasLaw, ImplicitStepsConvergeToTheSameMotion) {
  const SoftBody body = filled(make_sphere(2.0, 5, 6), 1.4, 250.0, 200.0);
  const auto end = [&](Integrator integrator, int steps_per_second) {
    World world = make_free_world(body);
    world.settings.integrator = integrator;
    world.settings.steps_per_second = steps_per_second;
    EXPECT_FALSE(run(world, 0.25));
    return world.soft[0].positions;
  };
  const VertexArray exact = end(Integrator::rk4, 4000);
  const auto error = [&](int steps_per_second) {
    return (end(Integrator::sdirk2, steps_per_second).rows() - exact.rows()).norm();
  };
  EXPECT_NEAR(error(200) / error(400), 4.0, 0.5);
}

TEST(GasLaw, SpringsInEquilibriumHoldWhatIsAboveTheAmbientPressure) {
  SoftBody body = filled(make_sphere(2.0, 6, 8), 1.4, 1030.0, 1000.0);
  body.mesh = make_soft_mesh(*body.mesh, find_equilibrium(body.mesh->topology, body.positions,
                                                          body.material, exact_equilibrium)
                                             .rest_lengths);
  World world = make_free_world(body);
  EXPECT_FALSE(run(world, 1.0));
  EXPECT_LT((world.soft[0].positions.rows() - body.positions.rows()).norm(), 1e-9);
  // The most gas is that of the ambient pressure and of the most that springs hold without it.
  SoftMaterial vacuum = body.material;
  vacuum.ambient_pressure = 0.0;
  const double outside = 1000.0 * volume_of(body) / (gas_constant * vacuum.temperature);
  EXPECT_NEAR(max_held_gas(*body.mesh, body.positions, body.material),
              max_held_gas(*body.mesh, body.positions, vacuum) + outside, 1e-9 * outside);
}

TEST(GasLaw, PredictsTheLongestStableStep) {
  // Taut and adiabatic: the breathing mode is the fastest.
  SoftBody body = filled(make_icosphere(2.0, 0), 5.0 / 3.0, 3e4, 3e4);
  const double limit = settled_stability_limit(Integrator::velocity_verlet, body).step;
  EXPECT_NEAR(limit * std::sqrt(breathing(body).squared_frequency), 2.0, 0.01);
}

}  // namespace
}  // namespace pneuma::sim
