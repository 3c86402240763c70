// Boxes that stand still or are moved, whatever they meet.
#include <gtest/gtest.h>

#include "sim/inspect/crossings.h"
#include "sim/inspect/inspect.h"
#include "tests/support/worlds.h"

namespace pneuma::sim {
namespace {

RigidBox make_kinematic(const Vec3& size, const Vec3& position,
                        const Vec3& velocity = Vec3::Zero()) {
  RigidBox box = make_rigid(size, position);
  box.is_kinematic = true;
  box.velocity = velocity;
  box.surface = {0.0, 0.5};
  return box;
}

TEST(Kinematic, ABoxRestsOnAStaticSlab) {
  World world;
  world.rigid = {make_kinematic({8.0, 8.0, 1.0}, {0.0, 0.0, 5.0}),
                 make_rigid({1.0, 1.0, 1.0}, {0.3, 0.2, 6.5})};
  ASSERT_FALSE(run(world, 3.0));
  EXPECT_EQ(world.rigid[0].position, Vec3(0.0, 0.0, 5.0));
  EXPECT_NEAR(world.rigid[1].position.z(), 6.0, 0.01);
  EXPECT_LT(world.rigid[1].velocity.norm(), 0.01);
}

TEST(Kinematic, AMovedBoxTakesAFreeOneAlongAtItsSpeed) {
  World world;
  world.settings.ground.reset();
  world.settings.gravity.setZero();
  world.rigid = {make_kinematic({1.0, 2.0, 2.0}, {-2.0, 0.0, 0.0}, {2.0, 0.0, 0.0}),
                 make_rigid({1.0, 1.0, 1.0}, {0.0, 0.0, 0.0}, 5.0)};
  world.rigid[1].surface = {0.0, 0.0};
  world.rigid[1].rho_g = 0.0;
  ASSERT_FALSE(run(world, 2.0));
  EXPECT_EQ(world.rigid[0].velocity, Vec3(2.0, 0.0, 0.0));
  EXPECT_NEAR(world.rigid[0].position.x(), 2.0, 1e-12);
  EXPECT_NEAR(world.rigid[1].velocity.x(), 2.0, 1e-3);
  EXPECT_GT(world.rigid[1].position.x() - world.rigid[0].position.x(), 0.99);
}

/// A press comes down on a cube of 1 m that lies on the ground, until it leaves `room` (m) for it.
/// `work`: J, of the press.
std::optional<Divergence> press_cube(double room, double* work = nullptr) {
  World world;
  world.rigid = {make_rigid({1.0, 1.0, 1.0}, {0.0, 0.0, 0.5}),
                 make_kinematic({3.0, 3.0, 1.0}, {0.0, 0.0, 1.5 + 1.2}, {0.0, 0.0, -1.0})};
  world.rigid[0].name = "victim";
  world.rigid[1].name = "press";
  Stepper stepper(world);
  while (world.rigid[1].position.z() - 0.5 > room) {
    if (auto divergence = stepper.step(world)) return divergence;
    if (work) *work += stepper.driven_work();
  }
  world.rigid[1].velocity.setZero();
  return run(world, 0.5);
}

/// It comes so near that it keeps its distance by impulses, which the ground gives back.
TEST(Kinematic, APressThatLeavesRoomDoesNoMoreWorkThanWouldLiftTheBox) {
  for (const double room : {1.01, 1.004, 1.002}) {
    double work = 0.0;
    const auto divergence = press_cube(room, &work);
    EXPECT_FALSE(divergence) << divergence->what;
    EXPECT_LT(std::abs(work), 9.81) << room;
  }
}

TEST(Kinematic, ABoxWithoutRoomEndsTheRunByName) {
  EXPECT_FALSE(press_cube(1.01));
  const auto divergence = press_cube(0.6);
  ASSERT_TRUE(divergence);
  EXPECT_EQ(divergence->body, "victim");
  EXPECT_NE(divergence->what.find("no room left"), std::string::npos) << divergence->what;
  EXPECT_NE(divergence->what.find(" into press."), std::string::npos) << divergence->what;
  EXPECT_EQ(divergence->other, "press");
}

/// The plate lies 3 cm in the ground for a moment.
TEST(Kinematic, AThinPlateThatIsHitIsNotSqueezedByWhatIsMovedElsewhere) {
  World world;
  world.rigid = {make_rigid({2.0, 2.0, 0.02}, {0.0, 0.0, 0.72}),
                 make_rigid({2.0, 2.0, 2.0}, {-0.23, 0.1, 4.7}, 1000.0),
                 make_kinematic({1.0, 1.0, 1.0}, {90.0, 0.0, 3.0}, {0.3, 0.0, 0.0})};
  world.rigid[0].orientation =
      Eigen::AngleAxisd(0.02, Vec3::UnitY()) * Eigen::AngleAxisd(0.01, Vec3::UnitX());
  world.rigid[1].orientation = Eigen::AngleAxisd(0.4, Vec3::UnitY());
  world.rigid[1].velocity = {0.0, 0.0, -10.0};
  const auto divergence = run(world, 1.5);
  EXPECT_FALSE(divergence) << divergence->what;
}

TEST(Kinematic, ABallIsPressedBetweenASlabAndAPlateAndCrossesNeither) {
  World world;
  SoftBody ball = make_body(make_sphere(3.0, 8, 8), {0.0, 0.0, 8.1});
  ball.material.n = 0.5;
  world.soft = {ball};
  world.rigid = {make_kinematic({10.0, 10.0, 1.0}, {0.0, 0.0, 4.5}),
                 make_kinematic({10.0, 10.0, 1.0}, {0.0, 0.0, 12.0}, {0.0, 0.0, -1.0})};
  Stepper stepper(world);
  for (int i = 0; i < 90; ++i) {
    const auto divergence = stepper.step(world);
    ASSERT_FALSE(divergence) << divergence->what;
    ASSERT_EQ(crossings(world).between_bodies, 0) << "after step " << i;
  }
  EXPECT_NEAR(world.rigid[1].position.z(), 10.5, 1e-12);
  EXPECT_GT(volume(world.soft[0].mesh->topology, world.soft[0].positions), 1.0);
}

TEST(Kinematic, ABallDoesTheSameBesideAnotherThatIsFarAway) {
  for (const bool has_slab : {true, false}) {
    World alone;
    alone.soft = {make_body(make_sphere(3.0, 8, 8), {0.0, 0.0, 8.2})};
    alone.soft[0].material.n = 0.5;
    if (has_slab) alone.rigid = {make_kinematic({90.0, 10.0, 1.0}, {30.0, 0.0, 4.5})};
    World beside = alone;
    beside.soft.push_back(make_body(make_sphere(2.0, 10, 7), {60.0, 0.5, 9.0}));
    beside.soft[1].material.n = 0.2;
    Stepper one(alone), other(beside);
    for (int i = 0; i < 120; ++i) {
      ASSERT_FALSE(one.step(alone));
      ASSERT_FALSE(other.step(beside));
      ASSERT_TRUE(alone.soft[0].positions.rows() == beside.soft[0].positions.rows()) << i;
      ASSERT_TRUE(alone.soft[0].velocities.rows() == beside.soft[0].velocities.rows()) << i;
    }
  }
}

TEST(Kinematic, WhatIsOfNoFiniteMassHasNoEnergyAndNoMomentum) {
  World world;
  world.rigid = {make_kinematic({1.0, 1.0, 1.0}, {0.0, 0.0, 5.0}, {3.0, 0.0, 0.0})};
  EXPECT_EQ(energy(world).total(), 0.0);
  EXPECT_EQ(momentum(world).linear, Vec3(0.0, 0.0, 0.0));
  world.rigid[0].position.z() = 0.2;
  EXPECT_EQ(max_penetration(world), 0.0) << "nor is its place a matter of contacts";
}

}  // namespace
}  // namespace pneuma::sim
