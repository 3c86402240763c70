// Boxes that are moved by keys in time.
#include "sim/rigid/given_motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sim/inspect/checkpoint.h"
#include "sim/inspect/crossings.h"
#include "sim/inspect/inspect.h"
#include "sim/mesh/rotation.h"
#include "tests/support/worlds.h"

namespace pneuma::sim {
namespace {

const std::vector<KeyFrame> there_and_back = {
    {1.0, 0.0, 0.0, 0.0}, {2.0, 3.0, -6.0, 0.0}, {4.0, 4.0, 6.0, 0.0}};

RigidBox make_moved(const Vec3& size, const Vec3& position, KeyFrames keys) {
  RigidBox box = make_rigid(size, position);
  box.is_kinematic = true;
  box.surface = {0.0, 0.5};
  box.motion = std::make_shared<const GivenMotion>(
      GivenMotion{std::move(keys), box.position, box.orientation});
  return box;
}

TEST(KeyFrames, AreMetAndAtRestOutsideThem) {
  for (const bool by : {false, true}) {
    EXPECT_EQ(value_at(there_and_back, by, 0.0), Vec3(0.0, 0.0, 0.0));
    EXPECT_EQ(value_at(there_and_back, by, 1.0), Vec3(0.0, 0.0, 0.0));
    EXPECT_EQ(value_at(there_and_back, by, 2.0), Vec3(3.0, -6.0, 0.0));
    EXPECT_EQ(value_at(there_and_back, by, 9.0), Vec3(4.0, 6.0, 0.0));
    EXPECT_EQ(value_at({}, by, 1.0), Vec3(0.0, 0.0, 0.0));
  }
  EXPECT_EQ(value_at(there_and_back, false, 1.5), Vec3(1.5, -3.0, 0.0));
  EXPECT_EQ(value_at(there_and_back, false, 3.0), Vec3(3.5, 0.0, 0.0));
}

TEST(KeyFrames, SmoothOnesHaveNoJumpsOfSpeedAndDoNotOvershoot) {
  constexpr double tiny = 1e-6;  // s: a central difference is then good to about 1e-9 / 1e-6
  const auto at = [](double time) { return value_at(there_and_back, true, time); };
  Vec3 before = Vec3::Zero();
  for (int i = 0; i <= 4'000; ++i) {
    const double time = 0.5 + 1e-3 * i;
    const Vec3 in = (at(time) - at(time - tiny)) / tiny, out = (at(time + tiny) - at(time)) / tiny;
    EXPECT_LT((in - out).norm(), 1e-3) << "at " << time << " s";
    EXPECT_GE(at(time).x(), before.x());
    EXPECT_GE(at(time).y(), -6.0);
    EXPECT_LE(at(time).y(), 6.0);
    before = at(time);
  }
}

TEST(GivenMotion, VelocitiesAreTheDerivativesOfThePose) {
  constexpr double tiny = 1e-5;  // s: a central difference is then good to about 1e-9
  const std::vector<KeyFrame> turns = {
      {0.0, 0.0, 0.0, 0.0}, {1.5, 90.0, -50.0, 0.0}, {4.0, 120.0, 80.0, 400.0}};
  for (const bool smooth : {false, true}) {
    const GivenMotion motion{{there_and_back, turns, smooth},
                             {5.0, 0.0, 9.0},
                             rotation_of_degrees({20.0, 30.0, 40.0}),
                             {0.1, 0.2, 0.3},
                             {1.0, -0.4, 0.7}};
    for (double time = 0.003; time < 5.0; time += 0.01) {
      const Pose before = pose_at(motion, time - tiny), after = pose_at(motion, time + tiny);
      const auto [linear, angular] = velocities_at(motion, time);
      const Eigen::AngleAxisd turn(after.orientation * before.orientation.conjugate());
      EXPECT_LT((linear - (after.position - before.position) / (2 * tiny)).norm(), 1e-8) << time;
      EXPECT_LT((angular - turn.angle() * turn.axis() / (2 * tiny)).norm(), 1e-7) << time;
    }
  }
}

TEST(GivenMotion, ABoxIsWhereItsKeysSayAfterEveryStep) {
  World world;
  world.settings.ground.reset();
  world.rigid = {make_moved({1.0, 1.0, 1.0}, {5.0, 0.0, 9.0},
                            {there_and_back, {{0.0, 0.0, 0.0, 0.0}, {4.0, 0.0, 0.0, 720.0}}}),
                 make_rigid({1.0, 1.0, 1.0}, {-20.0, 0.0, 0.0})};
  const GivenMotion motion = *world.rigid[0].motion;
  Stepper stepper(world);
  for (int i = 0; i < 300; ++i) {
    const Eigen::Quaterniond before = world.rigid[0].orientation;
    ASSERT_FALSE(stepper.step(world));
    const RigidBox& box = world.rigid[0];
    const Pose pose = pose_at(motion, time(world));
    EXPECT_EQ(box.position, pose.position);
    EXPECT_EQ(box.orientation.coeffs(), pose.orientation.coeffs());
    // What contacts saw during the step.
    const Vec3 turn = time_step(world.settings) * box.angular_velocity;
    const Eigen::Quaterniond turned(Eigen::AngleAxisd(turn.norm(), Vec3::UnitZ()));
    EXPECT_NEAR((turned * before).angularDistance(box.orientation), 0.0, 1e-7);
  }
  EXPECT_EQ(world.rigid[0].position, Vec3(9.0, 6.0, 9.0));
}

/// A ball between a slab and a plate that comes down on it and rises again.
World make_press() {
  World world;
  SoftBody ball = make_body(make_sphere(3.0, 8, 8), {0.0, 0.0, 8.1});
  ball.material.n = 0.5;
  world.soft = {ball};
  KeyFrames still, press;
  still.path = {{0.0, 0.0, 0.0, 0.0}};
  press.path = {{0.0, 0.0, 0.0, 0.0}, {1.0, 0.0, 0.0, -1.5}, {2.0, 0.0, 0.0, 0.0}};
  world.rigid = {make_moved({10.0, 10.0, 1.0}, {0.0, 0.0, 4.5}, still),
                 make_moved({10.0, 10.0, 1.0}, {0.0, 0.0, 12.0}, press)};
  return world;
}

TEST(GivenMotion, APressLetsNothingThroughAndComesBack) {
  World world = make_press();
  Stepper stepper(world);
  double least = volume(world.soft[0].mesh->topology, world.soft[0].positions);
  for (int i = 0; i < 150; ++i) {
    const auto divergence = stepper.step(world);
    ASSERT_FALSE(divergence) << divergence->what;
    ASSERT_EQ(crossings(world).between_bodies, 0) << "after step " << i;
    least = std::min(least, volume(world.soft[0].mesh->topology, world.soft[0].positions));
  }
  EXPECT_EQ(world.rigid[1].position.z(), 12.0);
  EXPECT_GT(least, 1.0);
}

struct Balance {
  double driven = 0.0;  // J, by what is moved
  double missed = 0.0;  // J, the change of energy less all work
};

/// Without friction with air and in springs, 1 s long: until the plate is lowest.
Balance energy_balance(int steps_per_second, ContactMethod contact, Integrator integrator) {
  World world = make_press();
  world.settings.steps_per_second = steps_per_second;
  world.settings.contact = contact;
  world.settings.integrator = integrator;
  if (contact == ContactMethod::potential) {  // whose friction and restitution take energy
    world.soft[0].material.surface = {1.0, 0.0};
    for (RigidBox& box : world.rigid) box.surface = {1.0, 0.0};
  }
  world.soft[0].material.rho_g = 0.0;
  world.soft[0].material.k_max = 1e12;  // dashpots of springs are as good as none
  const double start = energy(world).total();
  Stepper stepper(world, {.measure_work = true, .plan = {}});
  Balance balance;
  double contacts = 0.0;
  for (int i = 0; i < steps_per_second; ++i) {
    EXPECT_FALSE(stepper.step(world));
    balance.driven += stepper.driven_work();
    contacts += stepper.contact_work();
  }
  balance.missed = energy(world).total() - start - contacts - balance.driven;
  return balance;
}

// What is missed is the error of rk4 in free motion and in contacts that begin within a step: at
// least of second order.
TEST(GivenMotion, APressGivesTheEnergyThatIsGained) {
  double last = 1e-4;  // of the work, which is 38 J
  for (const int steps_per_second : {120, 240, 480, 960}) {
    const Balance balance = energy_balance(steps_per_second, ContactMethod::swept, Integrator::rk4);
    EXPECT_NEAR(balance.driven, 38.0, 0.5);
    const double part = std::abs(balance.missed) / balance.driven;
    EXPECT_LT(part, last) << steps_per_second << " steps per second";
    last = part / 3.0;
  }
}

// By potential it is an integral over each step by two points, and what it misses the error of that
// and of velocity_verlet. Implicit steps lose energy, of which the plate knows nothing.
TEST(GivenMotion, APressGivesTheEnergyThatIsGainedByPotential) {
  for (const int steps_per_second : {960, 1920}) {
    const Balance balance =
        energy_balance(steps_per_second, ContactMethod::potential, Integrator::velocity_verlet);
    EXPECT_NEAR(balance.driven, 49.2, 0.1);
    EXPECT_LT(std::abs(balance.missed), 1e-4 * balance.driven) << steps_per_second;
  }
  double last = 0.02;  // of the work
  for (const int steps_per_second : {480, 1920}) {
    const Balance balance =
        energy_balance(steps_per_second, ContactMethod::potential, Integrator::sdirk2);
    EXPECT_LT(balance.missed, 0.0) << steps_per_second << " steps per second";
    EXPECT_LT(-balance.missed, last * balance.driven) << steps_per_second << " steps per second";
    last /= 16.0;
  }
}

TEST(GivenMotion, GoesOnFromASavedStateBitForBit) {
  World whole = make_press();
  Stepper stepper(whole);
  std::vector<std::uint8_t> saved;
  for (int i = 0; i < 60; ++i) {
    if (i == 25) saved = save_state(whole);
    ASSERT_FALSE(stepper.step(whole));
  }
  World resumed = make_press();
  load_state(saved, resumed);
  Stepper other(resumed);
  for (int i = 25; i < 60; ++i) ASSERT_FALSE(other.step(resumed));
  EXPECT_EQ(state_hash(resumed), state_hash(whole));
}

}  // namespace
}  // namespace pneuma::sim
