// What find_divergence finds, and what it lets pass.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/equilibrium/held_shape.h"
#include "sim/inspect/inspect.h"
#include "sim/soft/pins.h"
#include "sim/soft/spring_force.h"
#include "sim/soft/stability_limit.h"
#include "sim/step/stages/find_divergence.h"
#include "tests/support/worlds.h"

namespace pneuma::sim {
namespace {

World one_sphere(double height = 4.0) {
  World world;
  world.soft.push_back(make_body(make_sphere(3.0, 8, 8), {0.0, 0.0, height}));
  world.soft[0].name = "ball";
  return world;
}

/// The divergence of the first step that has one, within a second. The world must be as before it.
std::optional<Divergence> first_divergence(World& world) {
  Stepper stepper(world);
  for (int i = 0; i < world.settings.steps_per_second; ++i) {
    const World before = world;
    const auto divergence = stepper.step(world);
    if (!divergence) continue;
    EXPECT_EQ(state_hash(world), state_hash(before)) << "the last sound state";
    EXPECT_EQ(divergence->step, before.steps + 1);
    return divergence;
  }
  return std::nullopt;
}

void expect_words(const Divergence& divergence, const std::vector<std::string>& words) {
  for (const std::string& word : words) {
    EXPECT_NE(divergence.what.find(word), std::string::npos) << word << " in: " << divergence.what;
  }
}

TEST(Divergence, AValueThatIsNotFiniteIsNamedWithItsVertex) {
  World world = one_sphere();
  world.soft[0].velocities[17].y() = std::numeric_limits<double>::quiet_NaN();
  Stepper stepper(world);
  const auto divergence = stepper.step(world);
  ASSERT_TRUE(divergence);
  EXPECT_EQ(divergence->body, "ball");
  EXPECT_GE(divergence->vertex, 0);  // the springs have carried it on
  expect_words(*divergence, {"vertex", "not a finite number"});
}

TEST(Divergence, ASpeedBeyondTheBoundIsNamedWithItsVertex) {
  World world = one_sphere(1e5);
  world.soft[0].material.k = world.soft[0].material.n = 0.0;
  world.soft[0].velocities[17] = Vec3(0.0, 1.5e8, 0.0);
  const auto divergence = first_divergence(world);
  ASSERT_TRUE(divergence);
  EXPECT_EQ(divergence->vertex, 17);
  EXPECT_EQ(divergence->stage, Stage::integrate_soft);
  expect_words(*divergence, {"vertex 17", "e+08 m/s", "faster than 1e+08"});
}

TEST(Divergence, ALostVolumeIsNamedWithTheOneBefore) {
  World world = one_sphere(1e5);
  for (int v = 0; v < 29; ++v) world.soft[0].velocities[v].z() = -3000.0;  // through the others
  const auto divergence = first_divergence(world);
  ASSERT_TRUE(divergence);
  EXPECT_TRUE(divergence->inverted);
  expect_words(*divergence, {"its volume is -", "97.9 m^3 before the step", "fastest"});
}

TEST(Divergence, EnergyFromNowhereIsFoundInItsStep) {
  // Without gas nothing else would tell, until the numbers overflow.
  for (const Integrator integrator :
       {Integrator::martin, Integrator::symplectic_euler, Integrator::velocity_verlet,
        Integrator::rk4, Integrator::rk8}) {
    World world = one_sphere(1e5);
    world.settings.integrator = integrator;
    world.settings.gravity.setZero();
    SoftMaterial& material = world.soft[0].material;
    material.n = 0.0;
    material.k = 1e5;
    undamp(material);
    perturb(world.soft[0], 1e-5, 1);
    const auto divergence = first_divergence(world);
    ASSERT_TRUE(divergence);
    EXPECT_EQ(divergence->step, 1);
    EXPECT_FALSE(divergence->inverted);
    expect_words(*divergence, {"energy of motion and springs jumped from", "gravity added"});
  }
}

TEST(Divergence, ABodyPressedFlatByTheGroundIsFoundInItsStep) {
  World world = one_sphere(30.0);
  for (int v = 0; v < 58; ++v) world.soft[0].velocities[v].z() = -2000.0;
  const auto divergence = first_divergence(world);
  ASSERT_TRUE(divergence);
  EXPECT_EQ(divergence->stage, Stage::resolve_contacts);
  EXPECT_TRUE(divergence->inverted);
  expect_words(*divergence, {"pressed it flat", "fastest"});
}

TEST(Divergence, NothingIsFoundUpToTheLimitOfStability) {
  // At 0.95 of it the energy of the fastest motion swings by a factor of 40 in symplectic_euler.
  for (const Integrator integrator :
       {Integrator::martin, Integrator::symplectic_euler, Integrator::velocity_verlet,
        Integrator::rk4, Integrator::rk8}) {
    World world = one_sphere(1e5);
    world.settings.integrator = integrator;
    SoftBody& body = world.soft[0];
    undamp(body.material);
    body.material.n = 0.0;
    const StabilityLimit limit =
        stability_limit(integrator, *body.mesh, body.material, body.positions);
    world.settings.steps_per_second = 1000;
    body.material.k *= std::pow(0.95 * limit.step * 1000.0, 2);
    perturb(body, 1e-6, 1);
    EXPECT_FALSE(run(world, 5.0));
  }
}

/// A ball whose gas and springs are in balance, and a step in units of its longest stable one.
World balanced_ball(Integrator integrator, double times_the_limit) {
  World world = one_sphere(1e5);
  world.settings.integrator = integrator;
  world.settings.gravity.setZero();
  SoftBody& body = world.soft[0];
  undamp(body.material);
  body.material.n = 0.5;
  body.mesh = held_mesh(*body.mesh, body.positions, body.material);
  const StabilityLimit limit =
      stability_limit(integrator, *body.mesh, body.material, body.positions);
  world.settings.steps_per_second = 1000;
  const double stiffer = std::pow(times_the_limit * limit.step * 1000.0, 2);
  body.material.k *= stiffer;
  body.material.n *= stiffer;
  perturb(body, 1e-3, 1);
  return world;
}

TEST(Divergence, AStepThatIsALittleTooLongIsFoundBeforeTheBodyBursts) {
  for (const Integrator integrator : {Integrator::symplectic_euler, Integrator::velocity_verlet,
                                      Integrator::rk4, Integrator::rk8}) {
    World stable = balanced_ball(integrator, 0.98);
    EXPECT_FALSE(run(stable, 1.0));
    World world = balanced_ball(integrator, 1.02);
    const Energy start = energy(world);
    const auto divergence = first_divergence(world);
    ASSERT_TRUE(divergence);
    expect_words(*divergence, {"from nothing", "bears steps of"});
    const Energy now = energy(world);  // after the last step that was sound
    EXPECT_LT(now.total() - start.total(), 0.2 * start.spring);
  }
}

TEST(Divergence, NothingIsFoundInABodyAtRest) {
  // Energies of 1e-30 J that rounding makes a thousand times as great.
  World world = one_sphere();
  world.settings.ground.reset();
  world.settings.gravity.setZero();
  world.soft[0].material.n = 0.0;
  EXPECT_FALSE(run(world, 10.0));
  world.soft[0].velocities[0].x() = 1e-12;
  EXPECT_FALSE(run(world, 10.0));
}

/// Its step is too long for the ball alone, but not for the only vertex that is free.
World pinned_ball() {
  World world = one_sphere();
  world.settings.integrator = Integrator::velocity_verlet;
  world.settings.gravity.setZero();
  SoftBody& body = world.soft[0];
  body.material.k = 200.0;
  body.material.n = 0.5;
  body.mesh = held_mesh(*body.mesh, body.positions, body.material);
  const StabilityLimit limit =
      stability_limit(world.settings.integrator, *body.mesh, body.material, body.positions);
  world.settings.steps_per_second = static_cast<int>(0.95 / limit.step);
  std::vector<std::uint8_t> is_pinned(at(body.positions.size()), 1);
  is_pinned[0] = 0;
  body.pins =
      make_pins(body.positions, is_pinned, std::vector<std::uint8_t>(is_pinned.size(), 0), {});
  return world;
}

TEST(Divergence, NothingIsFoundInRoundingOfAPinnedBody) {
  World world = pinned_ball();
  EXPECT_FALSE(run(world, 5.0));
}

TEST(Divergence, TheWorkOfMovedPinsIsNotFromNothing) {
  World world = pinned_ball();
  SoftBody& body = world.soft[0];
  GivenMotion motion;
  motion.keys.path = {{0.0, 0.0, 0.0, 0.0}, {0.5, 0.0, 0.0, 1.0}, {0.6, 1.0, 0.0, 0.0}};
  std::vector<std::uint8_t> is_pinned(at(body.positions.size()), 1);
  is_pinned[0] = 0;
  body.pins = make_pins(body.positions, is_pinned, is_pinned, motion);
  EXPECT_FALSE(run(world, 2.0));
}

TEST(Divergence, TheQuickLookMissesNoJumpOfEnergy) {
  // Any two states, against the definition: more than a hundred times the energy.
  World world = one_sphere();
  world.settings.gravity.setZero();
  SoftBody& body = world.soft[0];
  body.material.n = 0.0;
  const auto moving = [&](const VertexArray& positions, const VertexArray& velocities) {
    return 0.5 * body.material.vertex_mass * velocities.rows().squaredNorm() +
           spring_energy(*body.mesh, positions, body.material.k);
  };
  int jumps = 0;
  for (unsigned seed = 0; seed < 2000; ++seed) {
    SoftBody start = body, end = body;
    perturb(start, std::pow(10.0, -1.5 + 0.001 * seed), seed);
    start.velocities.rows() *= std::pow(10.0, -2.0 + (seed % 7) * 0.5);
    end = start;
    perturb(end, std::pow(10.0, -1.5 + 0.001 * (seed * 7 % 2000)), seed + 1);
    end.velocities.rows() *= std::pow(10.0, -4.0 + (seed % 5));
    const bool jump = moving(end.positions, end.velocities) >
                      max_gain * moving(start.positions, start.velocities);
    const auto found = find_divergence(world, end, {start.positions, start.velocities}, 1.0);
    EXPECT_EQ(found.has_value(), jump) << seed;
    jumps += jump;
  }
  EXPECT_GT(jumps, 200);
  EXPECT_LT(jumps, 1800);
}

}  // namespace
}  // namespace pneuma::sim
