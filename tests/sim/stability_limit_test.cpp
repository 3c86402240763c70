#include "sim/soft/stability_limit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/equilibrium/equilibrium.h"
#include "sim/soft/acceleration.h"
#include "sim/soft/damping.h"
#include "sim/soft/explicit_step.h"
#include "tests/support/eigenvalues.h"
#include "tests/support/worlds.h"

namespace pneuma::sim {
namespace {

constexpr std::array explicit_integrators = {Integrator::martin, Integrator::symplectic_euler,
                                             Integrator::velocity_verlet, Integrator::rk4,
                                             Integrator::rk8};

TEST(StabilityLimit, OfAnUndampedMotionInClosedForm) {
  const Oscillation motion{49.0, 0.0};
  for (const auto& [integrator, limit] :
       {std::pair{Integrator::martin, 2.0}, std::pair{Integrator::symplectic_euler, 2.0},
        std::pair{Integrator::velocity_verlet, 2.0}, std::pair{Integrator::rk4, std::sqrt(8.0)}}) {
    EXPECT_NEAR(stability_limit(integrator, motion) * 7.0, limit, 1e-6);
  }
}

TEST(StabilityLimit, OfADampedMotionInClosedForm) {
  // symplectic_euler: the trace 2 - (h omega)^2 - h delta and the determinant 1 - h delta give an
  // eigenvalue of -1 at (h omega)^2 + 2 h delta = 4.
  const double omega = 3.0, delta = 5.0;
  const double h = (-delta + std::sqrt(delta * delta + 4.0 * omega * omega)) / (omega * omega);
  EXPECT_NEAR(stability_limit(Integrator::symplectic_euler, {omega * omega, delta}), h, 1e-6);
  // rk4 of v' = -delta v: 1 + z + z^2/2 + z^3/6 + z^4/24 = 1 at z = -2.785293563.
  EXPECT_NEAR(stability_limit(Integrator::rk4, {0.0, delta}), 2.785293563 / delta, 1e-6);
  // Damped critically, as (x' + delta/2)^2: twice that.
  EXPECT_NEAR(stability_limit(Integrator::rk4, {0.25 * delta * delta, delta}),
              2.0 * 2.785293563 / delta, 1e-4);
}

TEST(StabilityLimit, ThereIsNoneForImplicitIntegratorsAndWithoutForces) {
  const Oscillation motion{1e12, 1e6};
  EXPECT_TRUE(std::isinf(stability_limit(Integrator::implicit_euler, motion)));
  EXPECT_TRUE(std::isinf(stability_limit(Integrator::sdirk2, motion)));
  EXPECT_TRUE(std::isinf(stability_limit(Integrator::rk4, Oscillation{})));
  SoftBody body = make_body(make_sphere(3.0, 8, 8));
  body.material.k = body.material.n = body.material.rho_g = 0.0;
  EXPECT_TRUE(std::isinf(settled_stability_limit(Integrator::rk4, body).step));
}

/// Springs alone: the step goes with the root of their stiffness, however stiff.
TEST(StabilityLimit, HoldsForSpringsOfAnyStiffness) {
  SoftBody body = make_body(make_sphere(3.0, 8, 8));
  body.material.n = body.material.rho_g = 0.0;
  body.material.k_max = 1e307;  // no damping
  const auto step = [&](double k) {
    body.material.k = k;
    return settled_stability_limit(Integrator::velocity_verlet, body).step;
  };
  const double at_one = step(1.0);
  for (const double k : {1e-200, 1e20, 1e160, 1e200, 1e300}) {
    EXPECT_NEAR(step(k) * std::sqrt(k) / at_one, 1.0, 1e-6) << k;
  }
}

/// A sphere whose springs are in equilibrium with its gas, that of `n` mol and what an ambient
/// pressure (Pa) balances: at rest as it is.
SoftBody held_sphere(double n, double k_max, double ambient_pressure = 0.0) {
  SoftBody body = make_body(make_sphere(3.0, 8, 8));
  body.material.k = 1000.0;
  body.material.k_max = k_max;
  body.material.ambient_pressure = ambient_pressure;
  const double inside = volume(body.mesh->topology, body.positions);
  body.material.n = n + ambient_pressure * inside / (gas_constant * body.material.temperature);
  const Equilibrium held =
      find_equilibrium(body.mesh->topology, body.positions, body.material, exact_equilibrium);
  body.mesh = make_soft_mesh(*body.mesh, held.rest_lengths);
  return body;
}

/// Of a body's own forces.
double greatest_eigenvalue(const SoftBody& body, bool of_velocities) {
  AccelerationScratch scratch(*body.mesh);
  const SoftAcceleration acceleration(*body.mesh, body.material, Vec3::Zero(), scratch);
  return greatest_eigenvalue(
      acceleration, {body.positions, body.velocities}, [](int) { return 1.0; }, of_velocities,
      1e-5);
}

TEST(VibrationMode, TheFastestIsThatOfTheGreatestEigenvalue) {
  for (const double n : {0.0, 10.0, 1000.0}) {
    SoftBody body = held_sphere(n == 1000.0 ? 10.0 : n, 4000.0);
    body.material.n = n;  // of 1,000 mol, not at rest: the gas is what is stiffest
    const VibrationMode motions(*body.mesh, body.material, body.positions);
    const Oscillation fastest = motions.along(motions.fastest(0.0));
    const double expected = greatest_eigenvalue(body, false);
    EXPECT_NEAR(fastest.squared_frequency / expected, 1.0, 0.005) << n;
    const Oscillation damped = motions.along(motions.fastest(1e9));
    EXPECT_NEAR(damped.decay / greatest_eigenvalue(body, true), 1.0, 0.005) << n;
  }
}

/// Whether small random motions about rest have grown a thousandfold after 2,000 steps.
bool grows(Integrator integrator, const SoftBody& body, double step) {
  AccelerationScratch scratch(*body.mesh);
  const SoftAcceleration acceleration(*body.mesh, body.material, Vec3::Zero(), scratch);
  SoftBody moved = body;
  perturb(moved, 1e-9, 1);
  SoftState state{moved.positions, moved.velocities};
  const auto size = [&] { return (state.positions.rows() - body.positions.rows()).norm(); };
  const double start = size();
  ExplicitScratch memory(body.positions.size(), integrator);
  VertexArray x(body.positions.size()), v(body.positions.size());
  for (int i = 0; i < 2000; ++i) {
    explicit_step(integrator, acceleration, step, state, x, v, memory);
    std::swap(state.positions, x);
    std::swap(state.velocities, v);
    if (!(size() < 1e3 * start)) return true;
  }
  return false;
}

TEST(StabilityLimit, IsWhereSmallMotionsOfABodyBeginToGrow) {
  for (const double n : {0.0, 10.0}) {
    for (const double k_max : {std::numeric_limits<double>::infinity(), 4000.0, 1200.0}) {
      const SoftBody body = held_sphere(n, k_max);
      for (const Integrator integrator : explicit_integrators) {
        const double predicted =
            stability_limit(integrator, *body.mesh, body.material, body.positions).step;
        // In 2,000 steps a thousandfold is 0.35 % a step, which the fastest motion comes to within
        // half a percent of its limit; and it is not quite that of springs and dashpots in turn.
        EXPECT_FALSE(grows(integrator, body, 0.98 * predicted)) << n << " " << k_max;
        EXPECT_TRUE(grows(integrator, body, 1.02 * predicted)) << n << " " << k_max;
      }
    }
  }
}

/// The gas makes the fastest motion, and dashpots the one that is the first to fail, or not.
TEST(StabilityLimit, HoldsForGasThatIsStifferThanTheSprings) {
  for (const double ambient_pressure : {1e3, 3e3, 6e3, 1e4, 3e4}) {
    const SoftBody body = held_sphere(10.0, 1000.0, ambient_pressure);
    for (const Integrator integrator : explicit_integrators) {
      const double predicted =
          stability_limit(integrator, *body.mesh, body.material, body.positions).step;
      EXPECT_FALSE(grows(integrator, body, 0.98 * predicted)) << ambient_pressure;
      EXPECT_TRUE(grows(integrator, body, 1.02 * predicted)) << ambient_pressure;
    }
  }
}

TEST(StabilityLimit, HoldsForHingesThatAreStifferThanTheSprings) {
  SoftBody body = make_body(make_sphere(3.0, 8, 8));
  body.material.k = 10.0;
  body.material.n = 0.0;
  body.mesh = with_hinges(*body.mesh);
  body.material.bending = 1000.0;
  for (const double damping : {0.0, 0.002, 0.02}) {  // s: of some steps
    body.material.bending_damping = damping;
    const VibrationMode motions(*body.mesh, body.material, body.positions);
    const Oscillation fastest = motions.along(motions.fastest(0.0));
    EXPECT_NEAR(fastest.squared_frequency / greatest_eigenvalue(body, false), 1.0, 0.005);
    if (damping > 0.0) {
      const Oscillation damped = motions.along(motions.fastest(1e6));
      EXPECT_NEAR(damped.decay / greatest_eigenvalue(body, true), 1.0, 0.005);
    }
    for (const Integrator integrator : explicit_integrators) {
      const double predicted =
          stability_limit(integrator, *body.mesh, body.material, body.positions).step;
      EXPECT_FALSE(grows(integrator, body, 0.98 * predicted)) << damping;
      EXPECT_TRUE(grows(integrator, body, 1.02 * predicted)) << damping;
    }
  }
}

/// So damped that the first motion to fail is one that dies away without swinging, by springs and
/// hinges against each other: neither the fastest, nor the most damped, nor of any sum of both.
TEST(StabilityLimit, HoldsForMotionsThatOnlyDieAway) {
  SoftBody body = make_body(make_icosphere(1.0, 2));
  body.material.k = 74.89;
  body.material.k_max = 9.765;
  body.material.n = 0.0;
  body.material.vertex_mass = 1.15 / body.positions.size();
  body.mesh = with_hinges(*body.mesh);
  body.material.bending = 5.15;
  for (const double damping : {0.002, 0.0031, 0.005}) {  // s
    body.material.bending_damping = damping;
    for (const Integrator integrator : {Integrator::rk4, Integrator::rk8}) {
      const double predicted =
          stability_limit(integrator, *body.mesh, body.material, body.positions).step;
      EXPECT_FALSE(grows(integrator, body, 0.98 * predicted)) << damping;
      EXPECT_TRUE(grows(integrator, body, 1.02 * predicted)) << damping;
    }
  }
}

TEST(StabilityLimit, OfABodyThatItsGasWillBlowUpHoldsAtTheStartAndWhenItIsBlownUp) {
  // Before, its gas is the stiffer; after, springs are stiff across themselves, too.
  for (const double n : {1.0, 10.0}) {
    SoftBody body = make_body(make_sphere(3.0, 8, 8));
    body.material.k = 10.0;
    body.material.n = n;
    const double predicted = settled_stability_limit(Integrator::rk4, body).step;
    World world = make_free_world(body);
    world.settings.steps_per_second = 240;
    world.soft[0].material.rho_g = 0.5;  // so that it comes to rest
    ASSERT_FALSE(run(world, 20.0));
    const double found =
        stability_limit(Integrator::rk4, *body.mesh, body.material, world.soft[0].positions).step;
    const double at_start =
        stability_limit(Integrator::rk4, *body.mesh, body.material, body.positions).step;
    // 10 %: the body is not enlarged quite evenly.
    EXPECT_NEAR(predicted / std::min(found, at_start), 1.0, 0.1) << n;
  }
}

}  // namespace
}  // namespace pneuma::sim
