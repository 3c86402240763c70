#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "sim/inspect/inspect.h"
#include "tests/support/worlds.h"

namespace pneuma::sim {
namespace {

World boxes_on_ground(double friction = 0.5, double restitution = 0.2) {
  World world;
  world.settings.ground = ContactMaterial{restitution, friction};
  return world;
}

/// Of the surface of the first box; two lie side by side, with a seam at x = 0.
void replace_ground_by_slabs(World& world, int count) {
  world.settings.ground.reset();
  const double width = 100.0 / count;
  for (int i = 0; i < count; ++i) {
    const double x = (i - 0.5 * (count - 1)) * width;
    world.rigid.push_back(make_rigid({width, 100.0, 1.0}, {x, 0.0, -0.5}));
    world.rigid.back().is_kinematic = true;
    world.rigid.back().surface = world.rigid.front().surface;
  }
}

World stack_of_ten(double gap) {
  World world = boxes_on_ground();
  for (int i = 0; i < 10; ++i) {
    world.rigid.push_back(make_rigid({1.0, 1.0, 1.0}, {0.0, 0.0, 0.5 + gap + (1.0 + gap) * i}));
  }
  return world;
}

class Stack : public testing::TestWithParam<double> {};

// Different gaps are different disturbances: a stack that just about stands falls for some of them.
INSTANTIATE_TEST_SUITE_P(Gaps, Stack, testing::Values(0.0, 0.0005, 0.001, 0.003, 0.01));

TEST_P(Stack, OfTenCubesStands) {
  World world = stack_of_ten(GetParam());
  double sideways = 0.0, sunk = 0.0, overlap = 0.0;
  Stepper stepper(world);
  for (int i = 0; i < 20 * 60; ++i) {
    ASSERT_FALSE(stepper.step(world));
    for (int cube = 0; cube < 10; ++cube) {
      const Vec3& p = world.rigid[at(cube)].position;
      sideways = std::max(sideways, p.head<2>().norm());
      sunk = std::max(sunk, 0.5 + cube - p.z());
    }
    overlap = std::max(overlap, max_penetration(world));
  }
  // The first steps start from no impulses, and ten iterations do not carry the weight of ten cubes
  // from the ground up: the stack sags by 2 cm, by 4.5 cm after a fall of 10 cm in all, and leans
  // by up to 8 mm a cube before it is held.
  EXPECT_LT(sideways, 0.1);
  EXPECT_LT(sunk, 0.06);
  // Boxes are left 2.5 mm in each other, and sink while the stack sags.
  EXPECT_LT(overlap, 0.015);
  // At rest since: it stands a little askew, and for as long again hardly stirs.
  EXPECT_LT(energy(world).kinetic, 1e-6);
  const World there = world;
  ASSERT_FALSE(run(world, 20.0));
  for (int cube = 0; cube < 10; ++cube) {
    const Vec3& p = world.rigid[at(cube)].position;
    EXPECT_LT(p.head<2>().norm(), 0.05) << cube;
    EXPECT_LT((p - there.rigid[at(cube)].position).norm(), 0.003) << cube;
  }
}

World cube_on_slope(double share, double mu) {
  World world = boxes_on_ground(mu, 0.0);
  world.rigid.push_back(make_rigid({1.0, 1.0, 1.0}, {0.0, 0.0, 0.5}));
  world.rigid[0].surface = {0.0, mu};
  const double angle = share * std::atan(mu);
  world.settings.gravity = {g * std::sin(angle), 0.0, -g * std::cos(angle)};
  return world;
}

TEST(RigidRest, ACubeSticksBelowTheAngleOfFriction) {
  for (const double mu : {0.2, 0.5, 0.8}) {
    for (const double share : {0.9, 0.95}) {
      World world = cube_on_slope(share, mu);
      ASSERT_FALSE(run(world, 20.0));
      EXPECT_LT(world.rigid[0].position.head<2>().norm(), 1e-3) << mu << " " << share;
    }
  }
}

TEST(RigidRest, ACubeSlidesAboveTheAngleOfFriction) {
  // v' = a - gamma v with a = g (sin - mu cos): friction takes mu times the normal part of the same
  // weight.
  constexpr double kept = 0.99;  // in 1/60 s
  for (const double mu : {0.2, 0.5, 0.8}) {
    World world = cube_on_slope(1.1, mu);
    const double angle = 1.1 * std::atan(mu);
    const double a = g * (std::sin(angle) - mu * std::cos(angle));
    const double limit = a / (-60.0 * std::log(kept));
    for (int second = 1; second <= 5; ++second) {
      ASSERT_FALSE(run(world, 1.0));
      const double expected = limit * (1.0 - std::pow(kept, 60 * second));
      // In the first steps the weight is not yet spread over the four corners as it will be.
      EXPECT_NEAR(world.rigid[0].velocity.x() / expected, 1.0, 0.01) << mu << " " << second;
      EXPECT_LT(world.rigid[0].angular_velocity.norm(), 1e-6) << mu << " " << second;
    }
  }
}

class OnGroundAndSlabs : public testing::TestWithParam<int> {};

INSTANTIATE_TEST_SUITE_P(RigidRest, OnGroundAndSlabs, testing::Values(0, 1, 2));

/// v^2 / (2 mu g), in steps of 1/60 s.
TEST_P(OnGroundAndSlabs, ACubeSlidesAsFarAsFrictionLetsIt) {
  constexpr double speed = 5.0, mu = 0.5;
  for (const double turned : {0.0, 0.4}) {
    World world = boxes_on_ground(mu);
    RigidBox cube = make_rigid({1.0, 1.0, 1.0}, {0.0, 0.0, 0.5}, 2.0);
    cube.orientation = Eigen::AngleAxisd(turned, Vec3::UnitZ());
    cube.velocity.x() = speed;
    cube.rho_g = 0.0;
    cube.surface = {0.0, mu};
    world.rigid = {cube};
    if (GetParam() > 0) replace_ground_by_slabs(world, GetParam());
    ASSERT_FALSE(run(world, 3.0));
    const double distance = speed * speed / (2.0 * mu * g);
    // It stops within the last step.
    EXPECT_NEAR(world.rigid[0].position.x(), distance, 2e-3 * distance) << turned;
  }
}

/// It rocks from edge to edge: what falls about an edge must not fall by more than its weight pays.
World make_rocking_cube(double tilt, int steps_per_second, int slabs) {
  constexpr double degree = 3.14159265358979 / 180.0;
  World world = boxes_on_ground(0.0, 1.0);
  world.settings.contact = ContactMethod::swept;
  world.settings.steps_per_second = steps_per_second;
  RigidBox cube = make_rigid({0.5, 0.5, 0.5}, {0.0, 0.0, 0.33}, 1.0);
  cube.orientation = Eigen::AngleAxisd(tilt * degree, Vec3::UnitX()) *
                     Eigen::AngleAxisd(1.5 * tilt * degree, Vec3::UnitY());
  cube.rho_g = 0.0;
  cube.surface = {1.0, 0.0};
  world.rigid = {cube};
  if (slabs > 0) replace_ground_by_slabs(world, slabs);
  return world;
}

/// J, above what the cube has where it lies flat.
double energy_above_rest(const World& world) { return energy(world).total() - g * 0.25; }

TEST_P(OnGroundAndSlabs, AnElasticCubeThatRocksGainsNoEnergy) {
  for (const double tilt : {1.0, 2.0, 4.0, 7.0}) {
    World world = make_rocking_cube(tilt, 60, GetParam());
    const double before = energy_above_rest(world);
    for (int second = 1; second <= 30; ++second) {
      ASSERT_FALSE(run(world, 1.0));
      // A thousandth of its energy above the ground.
      EXPECT_LT(energy_above_rest(world), before + 1e-3 * g * 0.33) << tilt << " " << second;
    }
  }
}

/// What follows keys stands still between them.
TEST(RigidRest, AnElasticCubeThatRocksOnAPlateThatHasStoppedGainsNoEnergy) {
  World world = make_rocking_cube(7.0, 60, 1);
  auto motion = std::make_shared<GivenMotion>();
  motion->position = world.rigid[1].position;
  world.rigid[1].motion = motion;
  const double before = energy_above_rest(world);
  for (int second = 1; second <= 30; ++second) {
    ASSERT_FALSE(run(world, 1.0));
    EXPECT_LT(energy_above_rest(world), before + 1e-3 * g * 0.33) << second;
  }
}

/// At 60 steps per second it is at rest after some 20 s (ERRATA row 36).
TEST_P(OnGroundAndSlabs, AnElasticCubeThatRocksKeepsItsEnergyInShortSteps) {
  for (const double tilt : {2.0, 7.0}) {
    World world = make_rocking_cube(tilt, 480, GetParam());
    const double before = energy_above_rest(world);
    ASSERT_FALSE(run(world, 20.0));
    EXPECT_NEAR(energy_above_rest(world), before, 0.02 * before) << tilt;
  }
}

TEST(RigidRest, ABoxDroppedOnACornerComesToRest) {
  for (const Vec3& size : {Vec3(1.0, 1.0, 1.0), Vec3(1.0, 2.0, 3.0)}) {
    World world = boxes_on_ground();
    world.rigid.push_back(make_rigid(size, {0.0, 0.0, 5.0}));
    world.rigid[0].orientation = Eigen::Quaterniond::FromTwoVectors(size, -Vec3::UnitZ());
    world.rigid[0].angular_velocity = {0.3, 0.1, 0.2};
    ASSERT_FALSE(run(world, 15.0));
    const RigidBox there = world.rigid[0];
    ASSERT_FALSE(run(world, 5.0));
    EXPECT_LT(energy(world).kinetic, 1e-6);
    EXPECT_LT((world.rigid[0].position - there.position).norm(), 1e-3);
    EXPECT_LT(world.rigid[0].orientation.angularDistance(there.orientation), 1e-3);
    EXPECT_LT(max_penetration(world), 0.005);
  }
}

TEST(RigidRest, ACubeReboundsWithTheRestitution) {
  for (const double epsilon : {0.0, 0.3, 0.8, 1.0}) {
    World world = by_impulses(boxes_on_ground(0.5, epsilon));
    world.rigid.push_back(make_rigid({1.0, 1.0, 1.0}, {0.0, 0.0, 3.0}));
    world.rigid[0].surface.restitution = 0.0;
    const double impact = step_until_contact(world, 0).velocity.z();
    EXPECT_LT(impact, -5.0);
    // The four corners are corrected in turns, in ten iterations: 2e-4 of the impulse are left.
    EXPECT_NEAR(world.rigid[0].velocity.z(), -epsilon * impact, 2e-3);
  }
}

}  // namespace
}  // namespace pneuma::sim
