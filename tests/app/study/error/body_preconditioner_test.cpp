#include "app/study/error/body_preconditioner.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "app/study/error/reference_equation.h"
#include "app/study/error/solver.h"
#include "tests/app/study/error/small_study.h"
#include "tests/support/worlds.h"

namespace pneuma::app {
namespace {

using Vector = std::vector<double>;

/// Two balls that are out of shape, at rest: then nothing is neglected.
sim::World deformed_world(double k, double n, double rho_g) {
  sim::World world = small_world();
  world.soft[0].material.k = k;
  world.soft[0].material.n = n;
  world.soft[0].material.rho_g = rho_g;
  sim::perturb(world.soft[0], 0.2, 5);
  world.soft.push_back(world.soft[0]);
  sim::perturb(world.soft[1], 0.1, 6);
  for (sim::SoftBody& body : world.soft) body.velocities.rows().setZero();
  return world;
}

/// df/dy z, by central differences of the equation written down again.
Vector jacobian_times(const sim::World& world, const Vector& state, const Vector& z) {
  constexpr double h = 1e-5;
  const ReferenceEquation equation(world.soft, world.settings.gravity);
  Vector ahead = state, behind = state, up(state.size()), down(state.size());
  for (std::size_t i = 0; i < state.size(); ++i) {
    ahead[i] += h * z[i];
    behind[i] -= h * z[i];
  }
  EXPECT_TRUE(equation(ahead.data(), up.data()));
  EXPECT_TRUE(equation(behind.data(), down.data()));
  for (std::size_t i = 0; i < state.size(); ++i) up[i] = (up[i] - down[i]) / (2.0 * h);
  return up;
}

TEST(BodyPreconditioner, FactorsAreThoseOfTheNewtonMatrix) {
  constexpr double gamma = 0.05;
  for (const sim::World& world : {deformed_world(50.0, 5.0, 0.01), deformed_world(50.0, 0.0, 0.0),
                                  deformed_world(300.0, 5.0, 0.2)}) {
    const Vector state = flat_state(world.soft);
    Vector r(state.size()), z(state.size());
    for (std::size_t i = 0; i < r.size(); ++i) r[i] = std::sin(0.7 * static_cast<double>(i));
    const auto made = make_body_preconditioner(world.soft, BodyPreconditioning::factors);
    ASSERT_TRUE(made->set_up(state.data(), gamma));
    made->solve(r.data(), z.data());
    const Vector product = jacobian_times(world, state, z);
    // Differences at h = 1e-5 of numbers up to 1e3, and their third derivatives.
    for (std::size_t i = 0; i < r.size(); ++i) {
      EXPECT_NEAR(z[i] - gamma * product[i], r[i], 1e-5) << i;
    }
  }
}

TEST(BodyPreconditioner, RefusesAStateWithoutAMeaning) {
  sim::World world = small_world();
  world.soft[0].positions.rows().row(0) *= -1.0;  // inside out
  const Vector state = flat_state(world.soft);
  for (const auto kind : {BodyPreconditioning::blocks, BodyPreconditioning::factors}) {
    EXPECT_FALSE(make_body_preconditioner(world.soft, kind)->set_up(state.data(), 0.1));
  }
}

TEST(BodyPreconditioner, SparesEvaluationsWhereSpringsAreStiff) {
  const sim::World world = small_world("k_max = 1e7\n");
  sim::World stiff = world;
  stiff.soft[0].material.k = 1e5;
  const auto evaluations = [&](SundialsMethod method) {
    const auto solver = make_peer_solver(stiff, method, 1e-4);
    EXPECT_TRUE(solver->advance(0));
    return solver->evaluations();
  };
  const long alone = evaluations(SundialsMethod::cvode_bdf);
  EXPECT_LT(evaluations(SundialsMethod::cvode_bdf_blocks), alone);
  EXPECT_LT(2 * evaluations(SundialsMethod::cvode_bdf_factors), alone);
}

}  // namespace
}  // namespace pneuma::app
