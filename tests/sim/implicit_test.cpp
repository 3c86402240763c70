// The implicit integrators: accuracy and bookkeeping. What sim/soft/implicit_step.h guarantees is
// in implicit_extremes_test.cpp, rest and friction on the ground in implicit_ground_test.cpp.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/inspect/checkpoint.h"
#include "sim/inspect/inspect.h"
#include "sim/soft/damping.h"
#include "sim/soft/implicit_step.h"
#include "tests/sim/implicit_integrators.h"
#include "tests/support/count_allocations.h"
#include "tests/support/worlds.h"

namespace pneuma::sim {
namespace {

class Implicit : public testing::TestWithParam<Integrator> {};
INSTANTIATE_TEST_SUITE_P(Both, Implicit, testing::ValuesIn(implicit_integrators),
                         [](const auto& tested) { return name(tested.param); });

/// A free sphere that its gas blows up, with dents and a spin, so that nothing is symmetric.
World swinging_sphere(Integrator integrator, int steps_per_second, bool damped) {
  SoftBody body = make_body(make_sphere(3.0, 8, 8));
  body.material.vertex_mass = 1.0;
  if (!damped) undamp(body.material);
  perturb(body, 0.1, 3);
  for (int v = 0; v < body.positions.size(); ++v) {
    body.velocities[v] += Vec3(0.2, 0.5, 0.3).cross(Vec3(body.positions[v]));
  }
  World world = make_free_world(std::move(body));
  world.settings.integrator = integrator;
  world.settings.steps_per_second = steps_per_second;
  return world;
}

VertexArray after_half_a_second(Integrator integrator, int steps_per_second, bool damped) {
  World world = swinging_sphere(integrator, steps_per_second, damped);
  EXPECT_FALSE(run(world, 0.5));
  return world.soft[0].positions;
}

TEST_P(Implicit, HasItsOrderWithDashpotsAndWithout) {
  const double order = GetParam() == Integrator::sdirk2 ? 2.0 : 1.0;
  for (const bool damped : {false, true}) {
    // rk4 at 1/7680 s: its error is 1e-6 of the least compared.
    const VertexArray exact = after_half_a_second(Integrator::rk4, 7680, damped);
    const auto error = [&](int rate) {
      return (after_half_a_second(GetParam(), rate, damped).rows() - exact.rows()).norm();
    };
    // Within 0.1 of the order: at 1/480 s the next order's term has faded.
    EXPECT_NEAR(std::log2(error(480) / error(960)), order, 0.1) << damped;
  }
}

TEST(Implicit, TheSecondOrderOneIsAsAccurateAsVelocityVerlet) {
  const VertexArray exact = after_half_a_second(Integrator::rk4, 7680, false);
  const auto error = [&](Integrator integrator) {
    return (after_half_a_second(integrator, 60, false).rows() - exact.rows()).norm();
  };
  EXPECT_LT(error(Integrator::sdirk2), 1.5 * error(Integrator::velocity_verlet));
}

TriangleMesh tetrahedron() {
  return {{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}},
          {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}}};
}

/// Breathing of a tetrahedron: all six springs lengthen by sqrt(8/3) of the vertices' way r, so its
/// energy is 6 k/2 (8/3) r^2 + 4 m/2 r'^2, and omega^2 = 4 k / m; likewise the dashpots, 4 c / m.
struct BreathingTetrahedron {
  World world;
  double omega, damping;

  BreathingTetrahedron(Integrator integrator, int steps_per_second, double rho_g, double k_max) {
    SoftBody body = make_body(tetrahedron());
    body.material.n = 0.0;
    body.material.k = 100.0;
    body.material.vertex_mass = 1.0;
    body.material.rho_g = rho_g;
    body.material.k_max = k_max;
    omega = std::sqrt(4.0 * body.material.k / body.material.vertex_mass);
    damping = drag_rate(body.material) + 4.0 * dashpot_constant(body.material);
    body.positions.rows() *= 1.1;
    world = make_free_world(std::move(body));
    world.settings.integrator = integrator;
    world.settings.steps_per_second = steps_per_second;
  }

  double amplitude() const {  // of the vertices' way, in units of that at the start
    const double radius = Vec3(world.soft[0].positions[0]).norm();
    return (radius / std::sqrt(3.0) - 1.0) / 0.1;
  }
};

/// What one step of the method makes of x'' + damping x' + omega^2 x = 0: from its stability
/// function R of the 2 x 2 system, R(z) = 1 / (1 - z) or (1 + (1 - 2 a) z) / (1 - a z)^2.
Eigen::Matrix2d step_matrix(Integrator integrator, double omega, double damping, double h) {
  Eigen::Matrix2d z;
  z << 0.0, h, -omega * omega * h, -damping * h;
  const Eigen::Matrix2d one = Eigen::Matrix2d::Identity();
  if (integrator == Integrator::implicit_euler) return (one - z).inverse();
  const double a = 1.0 - std::sqrt(0.5);
  const Eigen::Matrix2d inverse = (one - a * z).inverse();
  return inverse * inverse * (one + (1.0 - 2.0 * a) * z);
}

TEST_P(Implicit, DecaysAsItsStabilityFunctionSays) {
  for (const double k_max : {std::numeric_limits<double>::infinity(), 400.0}) {
    BreathingTetrahedron breathing(GetParam(), 60, 0.02, k_max);
    const Eigen::Matrix2d step =
        step_matrix(GetParam(), breathing.omega, breathing.damping, 1.0 / 60.0);
    Eigen::Vector2d expected(1.0, 0.0);
    Stepper stepper(breathing.world);
    for (int i = 0; i < 60; ++i) {
      ASSERT_FALSE(stepper.step(breathing.world));
      expected = step * expected;
      // The tolerance of the minimisation, 1e-10 m of 0.17 m, sixty times over.
      EXPECT_NEAR(breathing.amplitude(), expected.x(), 1e-7) << i;
    }
  }
}

TEST_P(Implicit, ComesToTheHarmonicMotionInTheLimit) {
  BreathingTetrahedron breathing(GetParam(), 7680, 0.02, 400.0);
  ASSERT_FALSE(run(breathing.world, 0.25));
  const double half = 0.5 * breathing.damping, t = 0.25;
  const double turn = std::sqrt(breathing.omega * breathing.omega - half * half);
  const double exact =
      std::exp(-half * t) * (std::cos(turn * t) + half / turn * std::sin(turn * t));
  // h (omega^2 + damping^2) t / 2 for the first order, (h omega)^3 t / (25 h) for the second.
  const double error = GetParam() == Integrator::sdirk2 ? 1e-5 : 0.01;
  EXPECT_NEAR(breathing.amplitude(), exact, error);
}

TEST_P(Implicit, KeepsTheMomentumOfAFreeBody) {
  World world = swinging_sphere(GetParam(), 60, false);
  for (int v = 0; v < 58; ++v) world.soft[0].velocities[v] += Vec3(3.0, -2.0, 1.0);
  const Momentum before = momentum(world);
  ASSERT_FALSE(run(world, 2.0));
  const Momentum after = momentum(world);
  // 58 kg at 3.7 m/s: rounding of positions, divided by the step, over 120 steps.
  EXPECT_LT((after.linear - before.linear).norm(), 1e-9 * before.linear.norm());
}

TEST_P(Implicit, AngularMomentumComesBackWithTheOrder) {
  const auto lost = [&](int rate) {
    World world = swinging_sphere(GetParam(), rate, false);
    const Vec3 before = momentum(world).angular;
    EXPECT_FALSE(run(world, 0.5));
    return (momentum(world).angular - before).norm() / before.norm();
  };
  const double order = GetParam() == Integrator::sdirk2 ? 2.0 : 1.0;
  // Within 0.1 of the order: at 1/960 s the next order's term has faded.
  EXPECT_NEAR(std::log2(lost(960) / lost(1920)), order, 0.1);
}

TEST_P(Implicit, FallsLikeAPoint) {
  SoftBody body = make_body(make_sphere(3.0, 8, 8), {0.0, 0.0, 1e6});  // far up: digits are kept
  undamp(body.material);
  World world = make_free_world(std::move(body));
  world.settings.integrator = GetParam();
  world.settings.gravity = {0.0, 0.0, -9.81};
  const double start = mean(world.soft[0].positions).z();
  ASSERT_FALSE(run(world, 1.0));
  // x1 = x0 + h v1 adds h/2 g t to the fall; sdirk2 is exact for it. 1e6 m has 1e-10 m of rounding.
  const double extra = GetParam() == Integrator::sdirk2 ? 0.0 : 0.5 * 9.81 / 60.0;
  EXPECT_NEAR(mean(world.soft[0].positions).z() - start, -0.5 * 9.81 - extra, 1e-7);
  EXPECT_NEAR(mean(world.soft[0].velocities).z(), -9.81, 1e-9);
}

TEST_P(Implicit, StartsThatMeanNothingAreReported) {
  World flat;
  flat.soft.push_back(make_body(make_sphere(3.0, 8, 8), {0.0, 0.0, 4.0}));
  flat.settings.integrator = GetParam();
  World torn = flat;
  for (int v = 0; v < 58; ++v) flat.soft[0].positions[v].z() = 4.0;
  torn.soft[0].velocities[3].x() = std::numeric_limits<double>::quiet_NaN();
  for (World* world : {&flat, &torn}) {
    const auto divergence = run(*world, 1.0);
    ASSERT_TRUE(divergence);
    EXPECT_EQ(divergence->step, 1);
  }
}

/// N/m: of springs that leave Newton's directions to conjugate gradients, and of ones that take
/// factors (sim/soft/conjugate_gradients.h).
constexpr double soft_and_stiff[] = {50.0, 1e6};

TEST_P(Implicit, ThreadsChangeNoBit) {
  World one;
  for (int i = 0; i < 5; ++i) {  // by turns, on the same memory
    one.soft.push_back(make_body(make_sphere(3.0, 8, 8), {20.0 * i, 0.0, 3.5}));
    one.soft.back().material.k = soft_and_stiff[i % 2];
    perturb(one.soft.back(), 0.05, static_cast<unsigned>(i));
  }
  one.settings.integrator = GetParam();
  EXPECT_EQ(state_hash_after(one, 1.0, 1), state_hash_after(one, 1.0, 2));
}

TEST_P(Implicit, ContinuesBitForBitFromACheckpoint) {
  World whole;
  for (const double k : soft_and_stiff) {
    whole.soft.push_back(make_body(make_sphere(3.0, 8, 8), {k < 1e3 ? 0.0 : 20.0, 0.0, 3.5}));
    whole.soft.back().material.k = k;
  }
  whole.settings.integrator = GetParam();
  World first_half = whole, second_half = whole;
  ASSERT_FALSE(run(whole, 2.0));
  ASSERT_FALSE(run(first_half, 1.0));
  load_state(save_state(first_half), second_half);
  ASSERT_FALSE(run(second_half, 1.0));
  EXPECT_EQ(state_hash(second_half), state_hash(whole));
}

TEST_P(Implicit, AllocatesNothingOnceWarm) {
  World world;
  for (const double k : soft_and_stiff) {
    world.soft.push_back(make_body(make_sphere(3.0, 8, 8), {k < 1e3 ? 0.0 : 20.0, 0.0, 3.5}));
    world.soft.back().material.k = k;
  }
  world.settings.integrator = GetParam();
  Stepper stepper(world);
  for (int i = 0; i < 300; ++i) ASSERT_FALSE(stepper.step(world));
  const long before = allocation_count();
  for (int i = 0; i < 300; ++i) ASSERT_FALSE(stepper.step(world));
  EXPECT_EQ(allocation_count() - before, 0);
}

TEST(Implicit, ValenceIsRefused) {
  World world;
  world.soft.push_back(make_body(make_sphere(3.0, 8, 8)));
  world.soft[0].material.pressure_weighting = PressureWeighting::valence;
  for (const Integrator integrator : implicit_integrators) {
    world.settings.integrator = integrator;
    EXPECT_THROW(Stepper{world}, std::invalid_argument);
  }
}

}  // namespace
}  // namespace pneuma::sim
