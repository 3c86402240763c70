// The implicit integrators: accuracy, and what sim/soft/implicit_step.h guarantees.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/inspect/checkpoint.h"
#include "sim/inspect/inspect.h"
#include "sim/soft/damping.h"
#include "sim/soft/implicit_step.h"
#include "tests/support/count_allocations.h"
#include "tests/support/worlds.h"

namespace pneuma::sim {
namespace {

constexpr std::array implicit_integrators = {Integrator::implicit_euler, Integrator::sdirk2};

std::string name(Integrator integrator) {
  return integrator == Integrator::sdirk2 ? "sdirk2" : "implicit_euler";
}

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
struct Breathing {
  World world;
  double omega, damping;

  Breathing(Integrator integrator, int steps_per_second, double rho_g, double k_max) {
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
    Breathing breathing(GetParam(), 60, 0.02, k_max);
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
  Breathing breathing(GetParam(), 7680, 0.02, 400.0);
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

// --- What is guaranteed
// ---------------------------------------------------------------------------

struct Extreme {
  std::string name;
  double k = 50.0, n = 10.0, mass = 0.35;
  double noise = 0.0;         // m and m/s, of every coordinate
  double flatness = 1.0;      // times z
  Vec3 speed = Vec3::Zero();  // m/s
  double spin = 0.0;          // rad/s
  int steps_per_second = 60;
};

const std::vector<Extreme> extremes = {
    {.name = "no_springs", .k = 0.0},
    {.name = "no_gas", .n = 0.0},
    {.name = "nothing", .k = 0.0, .n = 0.0},
    {.name = "stiff", .k = 1e8},
    {.name = "full", .n = 1e6},
    {.name = "stiff_and_full", .k = 1e8, .n = 1e6},
    {.name = "light", .mass = 1e-6},
    {.name = "heavy", .mass = 1e3},
    {.name = "displaced", .noise = 1.5},
    {.name = "displaced_and_stiff", .k = 1e8, .n = 1e6, .noise = 1.5},
    {.name = "displaced_without_gas", .k = 1e4, .n = 0.0, .noise = 1.5},
    {.name = "nearly_flat", .flatness = 1e-12},
    {.name = "nearly_flat_and_full", .k = 1e8, .n = 1e6, .flatness = 1e-12},
    {.name = "falling_at_1000_m_per_s", .k = 1e4, .speed = {0, 0, -1000}},
    {.name = "grazing_at_1000_m_per_s", .k = 1e4, .speed = {1000, 0, -10}},
    {.name = "spinning", .k = 1e4, .spin = 500.0},
    {.name = "a_step_a_second", .k = 1e6, .n = 1e4, .noise = 0.5, .steps_per_second = 1},
};

World make_world(const Extreme& extreme, Integrator integrator) {
  SoftBody body = make_body(make_sphere(3.0, 8, 8));
  body.material.k = extreme.k;
  body.material.n = extreme.n;
  body.material.vertex_mass = extreme.mass;
  perturb(body, extreme.noise, 5);
  for (int v = 0; v < body.positions.size(); ++v) {
    body.velocities[v] +=
        extreme.speed + extreme.spin * Vec3::UnitX().cross(Vec3(body.positions[v]));
    body.positions[v].z() *= extreme.flatness;
  }
  for (int v = 0; v < body.positions.size(); ++v) body.positions[v].z() += 5.0;
  World world;
  world.soft.push_back(std::move(body));
  world.settings.integrator = integrator;
  world.settings.steps_per_second = extreme.steps_per_second;
  return world;
}

/// J: all terms of the energy, of which rounding is a share.
double magnitude(const World& world) {
  const Energy e = energy(world);
  return e.kinetic + e.spring + std::abs(e.gas) + std::abs(e.gravity);
}

class Guarantee : public testing::TestWithParam<std::tuple<Extreme, Integrator>> {};
INSTANTIATE_TEST_SUITE_P(Extremes, Guarantee,
                         testing::Combine(testing::ValuesIn(extremes),
                                          testing::ValuesIn(implicit_integrators)),
                         [](const auto& tested) {
                           return std::get<0>(tested.param).name + "_by_" +
                                  name(std::get<1>(tested.param));
                         });

TEST_P(Guarantee, VolumeStaysAboveZeroAndEnergyDoesNotGrow) {
  const auto& [extreme, integrator] = GetParam();
  World world = make_world(extreme, integrator);
  Stepper stepper(world);
  double last = energy(world).total();
  for (int i = 0; i < 120; ++i) {
    ASSERT_FALSE(stepper.step(world)) << i;
    if (extreme.n > 0.0) {
      ASSERT_GT(volume(world.soft[0].mesh->topology, world.soft[0].positions), 0.0) << i;
    }
    const double now = energy(world).total();
    // Rounding: 1e-13 of the terms is allowed to the step itself, as much again to these sums.
    ASSERT_LE(now, last + 3e-13 * magnitude(world)) << i;
    ASSERT_GE(bounds(world).low.z(), 0.0) << i;
    last = now;
  }
}

TEST(Implicit, StiffFirmSphereRunsAMinuteAtTheUsualStep) {
  for (const Integrator integrator : implicit_integrators) {
    World world;
    world.soft.push_back(make_body(make_sphere(3.0, 8, 8), {0.0, 0.0, 3.2}));
    SoftMaterial& material = world.soft[0].material;
    material.k = 1e6;
    material.n = 1e4;
    material.temperature = 4.4;
    material.vertex_mass = 0.36;
    World by_rk4 = world;
    EXPECT_TRUE(run(by_rk4, 1.0)) << "an explicit integrator must fail at this";
    world.settings.integrator = integrator;
    ASSERT_FALSE(run(world, 60.0)) << name(integrator);
    const Vec3 size = bounds(world).size();
    EXPECT_NEAR(size.minCoeff(), 6.0, 0.1);  // a ball of 6 m, dented where it stands
    EXPECT_NEAR(size.maxCoeff(), 6.0, 0.1);
    EXPECT_LT(energy(world).kinetic, 1e-6);
  }
}

/// The scene pressure_soft after ten seconds.
Vec3 size_at_rest(Integrator integrator, int steps_per_second) {
  World world;
  world.soft.push_back(make_body(make_sphere(3.0, 8, 8), {0.0, 0.0, 4.0}));
  SoftMaterial& material = world.soft[0].material;
  material.k = 10.0;
  material.n = 1.0;
  material.vertex_mass = 0.36;
  world.settings.integrator = integrator;
  world.settings.steps_per_second = steps_per_second;
  EXPECT_FALSE(run(world, 10.0));
  EXPECT_EQ(bounds(world).low.z(), 0.0);
  return bounds(world).size();
}

TEST_P(Implicit, RestsOnTheGroundAsByRk4) {
  const Vec3 expected = size_at_rest(Integrator::rk4, 240);
  const auto error = [&](int rate) {
    return (size_at_rest(GetParam(), rate) - expected).norm() / expected.norm();
  };
  // Friction holds the vertices where they came to stand, and so the error of the way there: of
  // first order for both, since contacts are.
  const double coarse = error(60);
  EXPECT_LT(coarse, GetParam() == Integrator::sdirk2 ? 0.01 : 0.03);
  EXPECT_LT(error(240), coarse / 2.0);
}

/// A soft cube of 2 m on a slope with mu = 0.5, whose angle's tangent is `share` of that.
World cube_on_slope(Integrator integrator, double share) {
  World world;
  world.soft.push_back(make_body(make_box({2.0, 2.0, 2.0}, 2), {0.0, 0.0, 1.0}));
  SoftMaterial& material = world.soft[0].material;
  material.k = 5000.0;
  material.n = 0.0;
  world.settings.integrator = integrator;
  const double angle = std::atan(share * 0.5);
  world.settings.gravity = 9.81 * Vec3(std::sin(angle), 0.0, -std::cos(angle));
  return world;
}

TEST_P(Implicit, FrictionHoldsBelowItsAngle) {
  World world = cube_on_slope(GetParam(), 0.9);
  ASSERT_FALSE(run(world, 5.0));
  const Vec3 before = mean(world.soft[0].positions);
  ASSERT_FALSE(run(world, 5.0));
  // m: what is left of its swinging. Nothing creeps: sliding at anchor_speed it would be 5e-4.
  EXPECT_LT((mean(world.soft[0].positions) - before).norm(), 5e-5);
}

TEST_P(Implicit, FrictionLetsSlideAboveItsAngle) {
  World world = cube_on_slope(GetParam(), 2.0);
  world.soft[0].material.rho_g = 0.0;
  ASSERT_FALSE(run(world, 1.0));
  const double before = mean(world.soft[0].velocities).x();
  ASSERT_FALSE(run(world, 2.0));
  const double angle = std::atan(2.0 * 0.5);
  const double a = 9.81 * (std::sin(angle) - 0.5 * std::cos(angle));
  // Friction may be off by friction_bound_change, 5 %, while the ground's forces change; it is half
  // of g here.
  EXPECT_NEAR((mean(world.soft[0].velocities).x() - before) / (2.0 * a), 1.0, 0.05);
}

TEST_P(Implicit, ReboundsOfAVertexAreTheGroundsRestitution) {
  // Without springs and gas every vertex is for itself.
  SoftBody body = make_body(make_sphere(3.0, 8, 8), {0.0, 0.0, 3.5});
  body.material.k = 0.0;
  body.material.n = 0.0;
  undamp(body.material);
  body.material.surface.restitution = 0.6;
  for (int v = 0; v < body.positions.size(); ++v) body.velocities[v].z() = -5.0;
  World world;
  world.soft.push_back(std::move(body));
  world.settings.gravity.setZero();
  world.settings.integrator = GetParam();
  ASSERT_FALSE(run(world, 2.0));
  for (int v = 0; v < world.soft[0].velocities.size(); ++v) {
    EXPECT_NEAR(world.soft[0].velocities[v].z(), 0.6 * 5.0, 1e-9);
  }
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
