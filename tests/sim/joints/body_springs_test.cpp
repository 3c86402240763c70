// Springs between bodies.
#include "sim/joints/body_springs.h"

#include <gtest/gtest.h>

#include "sim/inspect/checkpoint.h"
#include "sim/inspect/crossings.h"
#include "sim/inspect/inspect.h"
#include "tests/sim/joints/gas_worlds.h"
#include "tests/support/count_allocations.h"

namespace pneuma::sim {
namespace {

/// Three balls of different sizes, joined one to the next, that fly past each other.
World make_tied() {
  World world = make_free_world(make_body(make_icosphere(0.5, 1)));
  world.soft.push_back(make_body(make_icosphere(0.7, 1), {3.0, 0.2, 0.0}));
  world.soft.push_back(make_body(make_icosphere(0.4, 1), {5.0, 2.0, 1.0}));
  for (std::size_t i = 0; i < world.soft.size(); ++i) {
    SoftMaterial& material = world.soft[i].material;
    material.n = 0.02;
    material.k = 20.0;
    material.vertex_mass = 0.02 * static_cast<double>(i + 1);
    perturb(world.soft[i], 0.02, static_cast<unsigned>(i));
    for (int v = 0; v < world.soft[i].velocities.size(); ++v) {
      world.soft[i].velocities[v] += Vec3(0.0, i == 1 ? 1.0 : -0.5, 0.2);
    }
  }
  world.springs = {{{0, {3}}, {1, {5, 6, 7}}, 30.0, 0.0, 1.5},
                   {{2, {1}}, {1, {9}}, 12.0, 0.5, 1.0}};
  world.settings.steps_per_second = 480;
  return world;
}

Vec3 momentum_of(const World& world) { return momentum(world).linear; }

TEST(BodySprings, PullBothEndsAlikeUnderEveryIntegrator) {
  for (const Integrator integrator : all_integrators) {
    World world = make_tied();
    for (SoftBody& body : world.soft) body.material.rho_g = 0.0;  // drag takes momentum
    world.settings.integrator = integrator;
    const Vec3 before = momentum_of(world), of_first = momentum(world.soft[0]).linear;
    ASSERT_FALSE(run(world, 1.0));
    // Of each step the rounding of a sum over some hundred vertices.
    EXPECT_LT((momentum_of(world) - before).norm(), 480.0 * 1e-13 * before.norm());
    EXPECT_GT((momentum(world.soft[0]).linear - of_first).norm(), 0.1 * of_first.norm());
  }
}

/// J, in the time until two of them meet.
double change_of_energy(int steps_per_second, double damping) {
  World world = make_tied();
  for (SoftBody& body : world.soft) undamp(body.material);
  for (BodySpring& spring : world.springs) spring.damping = damping;
  world.settings.steps_per_second = steps_per_second;
  const double before = energy(world).total();
  EXPECT_GT(spring_energy_between_bodies(world), 10.0);
  EXPECT_FALSE(run(world, 0.25));
  EXPECT_LT(spring_energy_between_bodies(world), 5.0);
  return energy(world).total() - before;
}

TEST(BodySprings, KeepTheEnergyAndTheirDashpotsTakeSome) {
  // What rk4 loses is of the fifth power of the step.
  const double coarse = std::abs(change_of_energy(480, 0.0));
  EXPECT_LT(coarse, 1e-3);
  EXPECT_LT(std::abs(change_of_energy(960, 0.0)), coarse / 16.0);
  EXPECT_LT(change_of_energy(480, 0.5), -0.1);
}

TEST(BodySprings, JoinBodiesIntoGroups) {
  World world = make_tied();
  world.soft.push_back(world.soft[0]);
  using Groups = std::vector<std::vector<int>>;
  EXPECT_EQ(joined_bodies(world), (Groups{{0, 1, 2}, {3}}));
  world.springs.pop_back();
  EXPECT_EQ(joined_bodies(world), (Groups{{0, 1}, {2}, {3}}));
}

TEST(BodySprings, ABodyThatNoSpringJoinsMovesAsInAWorldWithoutAny) {
  World world = make_tied();
  world.springs.pop_back();
  World without = world;
  without.springs.clear();
  for (const Integrator integrator : all_integrators) {
    World one = world, other = without;
    one.settings.integrator = other.settings.integrator = integrator;
    ASSERT_FALSE(run(one, 0.2));
    ASSERT_FALSE(run(other, 0.2));
    EXPECT_EQ(one.soft[2].positions.rows(), other.soft[2].positions.rows());
    EXPECT_NE(one.soft[1].positions.rows(), other.soft[1].positions.rows());
  }
}

TEST(BodySprings, GoOnFromASavedStateAndWithAnyThreadsToTheLastBit) {
  World world = make_tied();
  EXPECT_EQ(state_hash_after(world, 0.2, 1), state_hash_after(world, 0.2, 3));
  ASSERT_FALSE(run(world, 0.1));
  World resumed = make_tied();
  load_state(save_state(world), resumed);
  EXPECT_EQ(state_hash_after(world, 0.1, 1), state_hash_after(resumed, 0.1, 2));
}

SoftBody make_light_ball(const Vec3& centre) {
  SoftBody ball = make_body(make_icosphere(0.5, 1), centre);
  ball.material.n = 0.01;
  ball.material.k = 60.0;
  ball.material.vertex_mass = 0.02;
  return ball;
}

/// A ball that hangs from a static one.
World make_hung_by_springs() {
  World world;
  world.settings.steps_per_second = 480;
  world.soft = {make_ball(0.3, 1.2, true, {0.0, 0.0, 6.0}), make_light_ball({0.0, 0.0, 4.0})};
  world.soft[1].material.rho_g = 0.1;
  world.springs = {{{0, {0}}, {1, {1, 2}}, 30.0, 1.0, 0.5}};
  return world;
}

TEST(BodySprings, HoldABodyByAnObstacle) {
  for (const Integrator integrator : all_integrators) {
    World world = make_hung_by_springs();
    world.settings.integrator = integrator;
    const VertexArray obstacle = world.soft[0].positions;
    const auto divergence = run(world, 6.0);
    ASSERT_FALSE(divergence) << divergence->what;
    EXPECT_EQ(world.soft[0].positions.rows(), obstacle.rows());
    const double weight = 42 * world.soft[1].material.vertex_mass * 9.81;
    const double tension = 30.0 * (spring_between(world, world.springs[0]).norm() - 0.5);
    EXPECT_NEAR(tension / weight, 1.0, 0.02) << static_cast<int>(integrator);
  }
}

TEST(BodySprings, PullBodiesTogetherThatDoNotPassThroughEachOther) {
  for (const Integrator integrator : {Integrator::rk4, Integrator::sdirk2}) {
    World world;
    world.settings.steps_per_second = 240;
    world.settings.integrator = integrator;
    world.soft = {make_light_ball({0.0, 0.0, 0.7}), make_light_ball({1.5, 0.0, 0.7}),
                  make_light_ball({0.7, 1.3, 0.7})};
    for (SoftBody& body : world.soft) body.material.surface.restitution = 0.0;
    world.springs = {{{0, {0}}, {1, {0}}, 30.0, 1.0, 0.2}, {{1, {1}}, {2, {1}}, 30.0, 1.0, 0.2}};
    Stepper stepper(world);
    std::size_t contacts = 0;
    for (int i = 0; i < 360; ++i) {
      const auto divergence = stepper.step(world);
      ASSERT_FALSE(divergence) << divergence->what;
      contacts += stepper.contacts().size();
      if (i % 8 == 0) {
        ASSERT_EQ(crossings(world).between_bodies, 0);
      }
    }
    EXPECT_GT(contacts, 100u);
    EXPECT_LT((mean(world.soft[0].positions) - mean(world.soft[1].positions)).norm(), 1.4);
  }
}

TEST(BodySprings, AllocateNothing) {
  for (const Integrator integrator : {Integrator::rk4, Integrator::sdirk2}) {
    World world = make_tied();
    world.settings.integrator = integrator;
    Plan plan = make_plan(world);  // without contacts, whose number may grow at any time
    for (const Stage stage : {Stage::find_contacts, Stage::resolve_contacts}) {
      plan.stages[static_cast<std::size_t>(stage)] = {false, "only the motion"};
    }
    Stepper stepper(world, {.plan = plan});
    for (int i = 0; i < 10; ++i) ASSERT_FALSE(stepper.step(world));
    const long before = allocation_count();
    for (int i = 0; i < 50; ++i) ASSERT_FALSE(stepper.step(world));
    EXPECT_EQ(allocation_count() - before, 0);
  }
}

}  // namespace
}  // namespace pneuma::sim
