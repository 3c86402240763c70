// What touches others and the ground in the same step, with swept contacts (ERRATA row 67).
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "sim/inspect/inspect.h"
#include "sim/step/swept/swept_bodies.h"
#include "tests/sim/swept/swept_worlds.h"

namespace pneuma::sim {
namespace {

/// Implicit integrators hold vertices on the ground themselves, without an impulse.
TEST(Swept, WhatStandsOnTheGroundBesideOthersIsListed) {
  for (const Integrator integrator : {Integrator::implicit_euler, Integrator::sdirk2}) {
    World world = make_swept_world();
    world.settings.integrator = integrator;
    world.soft.push_back(make_ball({0.0, 0.0, 3.1}));
    world.soft.push_back(make_ball({0.5, 0.0, 9.3}));
    Stepper stepper(world);
    int standing_beside_others = 0;
    for (int i = 0; i < 120; ++i) {
      const auto divergence = stepper.step(world);
      ASSERT_FALSE(divergence) << divergence->what;
      std::vector<int> listed;
      for (const Contact& contact : stepper.contacts()) {
        if (contact.second.kind == SideKind::ground) listed.push_back(contact.first.feature.index);
      }
      const bool is_beside_others = stepper.contacts().size() > listed.size();
      const VertexArray& positions = world.soft[0].positions;
      for (int v = 0; v < positions.size(); ++v) {
        if (Vec3(positions[v]).z() > 0.0) continue;
        EXPECT_EQ(std::ranges::count(listed, v), 1) << "vertex " << v << " after step " << i;
        standing_beside_others += is_beside_others ? 1 : 0;
      }
    }
    EXPECT_GT(standing_beside_others, 100);
  }
}

/// What meets the ground beside what it carries: exactly, and without creeping.
TEST(Swept, APressedBodyStandsStillOnTheGround) {
  World world = make_swept_world();
  world.settings.sleep_speed = 0.0;
  world.soft.push_back(make_body(make_torus(7.0, 2.2, 16, 16), {0.0, 0.0, 2.2}));
  world.soft[0].material.k = 200.0;
  world.soft[0].material.n = 4.0;
  world.rigid.push_back(make_rigid({18.0, 18.0, 1.0}, {0.0, 0.0, 5.5}, 10.0));
  ASSERT_FALSE(run(world, 12.0));
  const VertexArray before = world.soft[0].positions;
  ASSERT_FALSE(run(world, 1.0));
  int standing = 0;
  for (int v = 0; v < before.size(); ++v) {
    const Vec3 now = world.soft[0].positions[v];
    EXPECT_GE(now.z(), 0.0) << v;
    if (now.z() > 0.0 || before[v].z() > 0.0) continue;
    EXPECT_LT((now - before[v]).norm(), 1e-5) << v;
    ++standing;
  }
  EXPECT_GT(standing, 30);
}

/// Wherever it is put then, nothing that was not searched for comes near it.
TEST(Swept, AVertexIsPutOntoTheGroundWithinItsAllowance) {
  World world = make_swept_world();
  world.soft = {make_ball({0.0, 0.0, 3.0}), make_ball({6.02, 0.0, 3.0})};
  SweptBodies bodies(world);
  MotionStart start;
  for (const SoftBody& body : world.soft) start.soft.push_back({body.positions, body.velocities});
  bodies.set_start(world, start, {}, 1.0);
  std::vector<BodyPair> near;
  bodies.find_near_bodies(world, start, near);
  ASSERT_EQ(near.size(), 1u);
  const double allowance = bodies.allowance(0);
  ASSERT_GT(allowance, 0.0);
  const Vec3 searched = world.soft[0].positions[0];
  const Vec3 end = searched + Vec3(0.6 * allowance, 0.0, 0.0);
  const Vec3 inside = searched + Vec3(0.0, 0.0, 0.9 * allowance);
  EXPECT_EQ(bodies.within_allowance(0, 0, end, inside), inside);
  const Vec3 beyond = end + Vec3(0.0, 0.0, 3.0 * allowance);
  const Vec3 put = bodies.within_allowance(0, 0, end, beyond);
  EXPECT_LT((put - (end + Vec3(0.0, 0.0, 0.8 * allowance))).norm(), 1e-12);
}

/// They turn on the way: a corner that is aimed at along a line may come down 10 mm too low. Those
/// that come further than a skin are aimed at again, and what is left is less.
TEST(Swept, BoxesThatFallTumblingDoNotSinkIn) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> anything(-1.0, 1.0);
  const auto vector = [&] { return Vec3(anything(random), anything(random), anything(random)); };
  for (int fall = 0; fall < 40; ++fall) {
    World world = make_swept_world();
    world.rigid.push_back(make_rigid(Vec3(1.3, 0.9, 0.7) + 0.6 * vector(), {0.0, 0.0, 4.0}));
    world.rigid[0].orientation = Eigen::Quaterniond(Eigen::AngleAxisd(3.0, vector().normalized()));
    world.rigid[0].velocity = 4.0 * vector();
    world.rigid[0].angular_velocity = 9.0 * vector();
    Stepper stepper(world);
    double deepest = 0.0;
    for (int i = 0; i < 180; ++i) {
      const auto divergence = stepper.step(world);
      ASSERT_FALSE(divergence) << divergence->what;
      deepest = std::max(deepest, max_penetration(world));
    }
    const double skin = SweptBodies(world).skin(0);
    EXPECT_LT(deepest, 1.1 * skin) << "fall " << fall;
  }
}

}  // namespace
}  // namespace pneuma::sim
