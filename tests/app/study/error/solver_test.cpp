#include "app/study/error/solver.h"

#include <gtest/gtest.h>

#include "app/study/error/error_meter.h"
#include "tests/app/study/error/small_study.h"
#include "tests/support/worlds.h"

namespace pneuma::app {
namespace {

constexpr std::size_t samples = 4;

Trajectory follow(Solver& solver) {
  Trajectory trajectory;
  for (std::size_t i = 0; i < samples; ++i) {
    EXPECT_TRUE(solver.advance(i)) << solver.failure();
    trajectory.push_back(solver.sample());
  }
  return trajectory;
}

double error(const sim::World& world, Solver& solver, const Trajectory& reference) {
  return ErrorMeter(world, reference).errors(follow(solver)).greatest.position;
}

sim::World at_rate(sim::World world, sim::Integrator integrator, int steps_per_second) {
  world.settings.integrator = integrator;
  world.settings.steps_per_second = steps_per_second;
  return world;
}

TEST(Reference, AgreesWithRk4AtATinyStep) {
  // 1e-9 is the bound that says which of the two is wrong if they differ. Here rk4's own error is
  // below 1e-13: it falls with the fourth power of the step from 1e-4 at 1/60 s.
  for (const char* material :
       {"", "pressure_weighting = \"valence\"\n", "k_max = 60.0\nrho_g = 0.2\n", "n = 0.0\n"}) {
    sim::World world = small_world();
    if (std::string(material) == "n = 0.0\n") {
      world.soft[0].material.n = 0.0;
    } else {
      world = small_world(material);
    }
    sim::perturb(world.soft[0], 0.3, 3);
    const auto ours = make_stepper_solver(at_rate(world, sim::Integrator::rk4, 7680), false);
    const auto reference = make_reference_solver(world, 1e-12);
    EXPECT_LT(error(world, *ours, follow(*reference)), 1e-10) << material;
  }
}

TEST(Peer, ComesCloserWithTheTolerance) {
  const sim::World world = small_world();
  const auto reference = make_reference_solver(world, 1e-12);
  const Trajectory expected = follow(*reference);
  for (const SundialsMethod method : sundials_methods) {
    const auto loose = make_peer_solver(world, method, 1e-2);
    const auto tight = make_peer_solver(world, method, 1e-8);
    const double far = error(world, *loose, expected), near = error(world, *tight, expected);
    EXPECT_LT(far, 0.5);
    EXPECT_GT(far, method < SundialsMethod::arkode_3 ? 1e-4 : 10.0 * near);
    EXPECT_LT(near, 1e-6);
    EXPECT_GT(tight->evaluations(), loose->evaluations());
  }
}

TEST(Peer, DoesNotDependOnThePlace) {
  sim::World here = small_world(), there = small_world();
  for (int v = 0; v < there.soft[0].positions.size(); ++v) {
    there.soft[0].positions[v] += sim::Vec3(1e3, 0.0, 0.0);
  }
  const auto near = make_peer_solver(here, SundialsMethod::cvode_adams, 1e-4);
  const auto far = make_peer_solver(there, SundialsMethod::cvode_adams, 1e-4);
  follow(*near);
  follow(*far);
  EXPECT_EQ(near->evaluations(), far->evaluations());
}

TEST(Peer, TakesSeveralBodies) {
  sim::World world = small_world();
  world.soft.push_back(sim::make_body(sim::make_torus(3.0, 1.0, 6, 5), {20.0, 0.0, 5.0}));
  const auto reference = make_reference_solver(world, 1e-12);
  const auto peer = make_peer_solver(world, SundialsMethod::cvode_adams, 1e-8);
  EXPECT_LT(error(world, *peer, follow(*reference)), 1e-6);
}

// A spinning box falls onto another and turns away from it. rk4's own error is that of its second
// order where the nearest features change.
TEST(Peer, TakesBoxesWhereContactIsAPotential) {
  sim::World world = at_rate({}, sim::Integrator::rk4, 61'440);
  world.settings.contact = sim::ContactMethod::potential;
  world.settings.ground.reset();
  world.rigid = {sim::make_rigid({2, 2, 1}, {0, 0, 0}, 3.0),
                 sim::make_rigid({1, 0.8, 0.6}, {0.6, 0.2, 1.3})};
  for (sim::RigidBox& box : world.rigid) box.surface = {1.0, 0.0};
  world.rigid[1].angular_velocity = {2.0, 3.0, 1.0};
  world.rigid[1].velocity = {0, 0, -2.0};
  const auto peer = make_peer_solver(world, SundialsMethod::cvode_adams, 1e-10);
  const auto ours = make_stepper_solver(world, true);
  const Trajectory expected = follow(*peer);
  EXPECT_LT(error(world, *ours, expected), 1e-5);
  sim::World alone = world;
  alone.rigid.erase(alone.rigid.begin());
  const auto free = make_stepper_solver(alone, true);
  const double way =
      (follow(*free).back().rigid[0].position - expected.back().rigid[1].position).norm();
  EXPECT_GT(way, 0.1) << "the boxes must have met";
}

// A plate that keys move and turn pushes a free box away.
TEST(Reference, KnowsWhatKeysMove) {
  sim::World world = at_rate({}, sim::Integrator::rk4, 61'440);
  world.settings.contact = sim::ContactMethod::potential;
  world.settings.ground.reset();
  world.settings.gravity.setZero();
  world.rigid = {sim::make_rigid({2, 2, 0.4}, {0, 0, 0}),
                 sim::make_rigid({1, 0.8, 0.6}, {0.3, 0.2, 0.6})};
  sim::RigidBox& plate = world.rigid[0];
  plate.is_kinematic = true;
  sim::GivenMotion motion;
  motion.keys.path = {{0, 0, 0, 0}, {0.3, 0, 0, 0.4}};
  motion.keys.rotation = {{0, 0, 0, 0}, {0.3, 10, 0, 0}};
  plate.motion = std::make_shared<const sim::GivenMotion>(motion);
  const auto reference = make_contact_reference_solver(world, 1e-10);
  const auto ours = make_stepper_solver(world, true);
  const Trajectory expected = follow(*reference);
  EXPECT_GT(expected.back().rigid[1].position.z(), 0.7) << "it must have been pushed";
  EXPECT_LT(error(world, *ours, expected), 1e-6);  // of rk4, whose plate moves evenly in a step
}

TEST(StepperSolver, IsTheSimulation) {
  sim::World world = at_rate(small_world(), sim::Integrator::velocity_verlet, 60);
  const auto solver = make_stepper_solver(world, true);
  const Trajectory trajectory = follow(*solver);
  for (const Sample& sample : trajectory) {
    ASSERT_FALSE(sim::run(world, 1.0 / samples_per_second));
    EXPECT_EQ(sample.soft[0].positions.rows(), world.soft[0].positions.rows());
  }
}

TEST(StepperSolver, InFlightKnowsNoGround) {
  sim::World world = at_rate(small_world(), sim::Integrator::rk4, 240);
  for (int v = 0; v < world.soft[0].positions.size(); ++v) {
    world.soft[0].positions[v].z() -= 50.0;  // half in the ground
  }
  sim::World free = world;
  free.settings.ground.reset();
  const auto flying = make_stepper_solver(world, false),
             touching = make_stepper_solver(world, true);
  const Trajectory expected = follow(*make_stepper_solver(free, true));
  EXPECT_EQ(error(world, *flying, expected), 0.0);
  EXPECT_GT(error(world, *touching, expected), 1e-3);
}

TEST(StepperSolver, SaysWhenItDiverges) {
  const sim::World world = small_world("vertex_mass = 1e-5\n");
  const auto solver = make_stepper_solver(at_rate(world, sim::Integrator::martin, 15), false);
  std::size_t i = 0;
  while (i < 15 && solver->advance(i)) ++i;
  ASSERT_LT(i, 15u);
  EXPECT_NE(solver->failure().find(" s: "), std::string::npos) << solver->failure();
  EXPECT_GE(solver->failure_time(), 1.0 / 15.0);
  EXPECT_LE(solver->failure_time(), 1.0);
}

}  // namespace
}  // namespace pneuma::app
