// The equation written down again, the simulation's own, and the energies: three paths to one
// force.
#include "app/study/error/reference_equation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/inspect/inspect.h"
#include "sim/soft/acceleration.h"
#include "tests/support/worlds.h"

namespace pneuma::app {
namespace {

using sim::Vec3;

const Vec3 gravity(0.5, -1.0, -9.81);

sim::SoftBody moving_body(double amount = 0.3) {
  sim::SoftBody body = sim::make_body(sim::make_torus(3.0, 1.0, 7, 5), {5.0, -2.0, 30.0});
  sim::perturb(body, amount, 11);
  return body;
}

std::vector<double> reference_derivative(const std::vector<sim::SoftBody>& bodies) {
  const ReferenceEquation equation(bodies, gravity);
  const std::vector<double> state = flat_state(bodies);
  std::vector<double> derivative(state.size());
  EXPECT_TRUE(equation(state.data(), derivative.data()));
  return derivative;
}

/// Greatest difference from the simulation's own acceleration, over its greatest.
double difference_from_simulation(const sim::SoftBody& body) {
  sim::AccelerationScratch scratch(*body.mesh);
  const sim::SoftAcceleration own(*body.mesh, body.material, gravity, scratch);
  sim::VertexArray acceleration(body.positions.size());
  EXPECT_GT(own(body.positions, body.velocities, acceleration), 0.0);
  const std::vector<double> derivative = reference_derivative({body});
  double greatest = 0.0;
  for (int v = 0; v < body.positions.size(); ++v) {
    for (int c = 0; c < 3; ++c) {
      const auto i = static_cast<std::size_t>(3 * (body.positions.size() + v) + c);
      greatest = std::max(greatest, std::abs(derivative[i] - acceleration[v][c]));
    }
  }
  return greatest / acceleration.rows().cwiseAbs().maxCoeff();
}

// Sums of some ten terms, of the size of the greatest: rounding.
constexpr double sum_rounding = 1e-13;

TEST(ReferenceEquation, IsTheSimulations) {
  EXPECT_LT(difference_from_simulation(moving_body()), sum_rounding);
}

TEST(ReferenceEquation, IsTheSimulationsWithEveryChoice) {
  const auto check = [](const char* what, const auto& change) {
    sim::SoftBody body = moving_body();
    change(body.material);
    EXPECT_LT(difference_from_simulation(body), sum_rounding) << what;
  };
  check("valence", [](auto& m) { m.pressure_weighting = sim::PressureWeighting::valence; });
  check("air outside", [](auto& m) {
    m.gas_exponent = 1.4;
    m.start_volume = 20.0;
    m.ambient_pressure = 300.0;
  });
  check("no gas", [](auto& m) { m.n = 0.0; });
  check("no springs", [](auto& m) { m.k = 0.0; });
  check("no dashpots", [](auto& m) { m.k_max = std::numeric_limits<double>::infinity(); });
  check("at k_max", [](auto& m) { m.k_max = m.k; });
  check("drag", [](auto& m) { m.rho_g = 0.3; });
  check("light", [](auto& m) { m.vertex_mass = 0.01; });
}

TEST(ReferenceEquation, IsTheSimulationsWithBending) {
  sim::SoftBody body = moving_body();
  body.mesh = sim::with_hinges(*body.mesh);
  body.material.bending = 200.0;
  const double without = difference_from_simulation(moving_body());
  // Angles by an arc function, against the distance of unit normals: some ten roundings more.
  EXPECT_LT(difference_from_simulation(body), 10.0 * sum_rounding);
  EXPECT_LT(without, sum_rounding);
  for (const double damping : {0.01, 1.0}) {
    body.material.bending_damping = damping;
    EXPECT_LT(difference_from_simulation(body), 10.0 * sum_rounding) << damping;
  }
  sim::AccelerationScratch scratch(*body.mesh);
  sim::VertexArray with(body.positions.size()), none(body.positions.size());
  sim::VertexArray damped(body.positions.size());
  sim::SoftAcceleration(*body.mesh, body.material, gravity, scratch)(body.positions,
                                                                     body.velocities, damped);
  body.material.bending_damping = 0.0;
  sim::SoftAcceleration(*body.mesh, body.material, gravity, scratch)(body.positions,
                                                                     body.velocities, with);
  body.material.bending = 0.0;
  sim::SoftAcceleration(*body.mesh, body.material, gravity, scratch)(body.positions,
                                                                     body.velocities, none);
  EXPECT_GT((with.rows() - none.rows()).norm(), 0.1 * none.rows().norm());
  EXPECT_GT((damped.rows() - with.rows()).norm(), 0.1 * none.rows().norm());
}

TEST(ReferenceEquation, IsTheGradientOfTheEnergiesWhereNothingIsLost) {
  sim::SoftBody body = moving_body();
  sim::undamp(body.material);
  const std::vector<double> derivative = reference_derivative({body});
  const double h = 1e-5;  // m: truncation and rounding of the differences meet near 1e-9
  const auto potential = [&](int v, int c, double move) {
    sim::SoftBody moved = body;
    moved.positions[v][c] += move;
    const sim::Energy energy = sim::energy(moved, gravity);
    return energy.spring + energy.gas + energy.gravity;
  };
  for (const int v : {0, 3, 17, 34}) {
    for (int c = 0; c < 3; ++c) {
      const double force = -(potential(v, c, h) - potential(v, c, -h)) / (2.0 * h);
      const auto i = static_cast<std::size_t>(3 * (body.positions.size() + v) + c);
      EXPECT_NEAR(derivative[i] * body.material.vertex_mass, force, 1e-5 * 50.0);
    }
  }
}

TEST(ReferenceEquation, TakesSeveralBodies) {
  const sim::SoftBody torus = moving_body();
  sim::SoftBody sphere = sim::make_body(sim::make_sphere(2.0, 5, 6));
  sim::perturb(sphere, 0.2, 5);
  sphere.material.pressure_weighting = sim::PressureWeighting::valence;
  const auto both = reference_derivative({torus, sphere});
  const auto first = reference_derivative({torus}), second = reference_derivative({sphere});
  const std::size_t a = first.size() / 2, b = second.size() / 2;
  for (std::size_t i = 0; i < a; ++i) {
    EXPECT_EQ(both[i], first[i]);
    EXPECT_EQ(both[a + b + i], first[a + i]);
  }
  for (std::size_t i = 0; i < b; ++i) {
    EXPECT_EQ(both[a + i], second[i]);
    EXPECT_EQ(both[2 * a + b + i], second[b + i]);
  }
}

TEST(ReferenceEquation, RefusesABodyInsideOut) {
  std::vector bodies = {moving_body(0.0)};
  bodies[0].positions.rows().row(0) *= -1.0;  // a mirror image
  const ReferenceEquation equation(bodies, gravity);
  const std::vector<double> state = flat_state(bodies);
  std::vector<double> derivative(state.size());
  EXPECT_FALSE(equation(state.data(), derivative.data()));
}

TEST(ReferenceEquation, RefusesLiteralDamping) {
  std::vector bodies = {moving_body()};
  bodies[0].material.damping = sim::Damping::literal;
  EXPECT_THROW(ReferenceEquation(bodies, gravity), std::invalid_argument);
}

TEST(FlatState, IsReadBack) {
  const std::vector bodies = {moving_body(), sim::make_body(sim::make_sphere(1.0, 3, 4))};
  std::vector<sim::SoftBody> others = bodies;
  for (sim::SoftBody& body : others) {
    body.positions.rows().setZero();
    body.velocities.rows().setZero();
  }
  read_flat_state(flat_state(bodies), others);
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    EXPECT_EQ(others[b].positions.rows(), bodies[b].positions.rows());
    EXPECT_EQ(others[b].velocities.rows(), bodies[b].velocities.rows());
  }
}

}  // namespace
}  // namespace pneuma::app
