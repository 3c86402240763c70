// Bodies deep in each other: which they are, and what parting them does to energy and momentum.
#include "sim/collision/overlapping_pair.h"

#include <gtest/gtest.h>

#include "sim/collision/point_in_body.h"
#include "sim/inspect/checkpoint.h"
#include "sim/inspect/inspect.h"
#include "sim/response/depenetrate_pairs.h"
#include "tests/sim/contact_worlds.h"

namespace pneuma::sim {
namespace {

SoftBody cube(double side, const Vec3& position) {
  return make_body(make_box(Vec3::Constant(side), 1), position);
}

std::optional<OverlappingPair> overlapping_pair(const World& world, bool is_depenetrating = false) {
  OverlappingPairScratch scratch;
  return find_overlapping_pair(world, 0, 1, is_depenetrating, scratch);
}

World two_cubes(double distance, double skin) {
  World world = isolated();
  world.settings.skin_thickness = skin;
  add(world, cube(4.0, Vec3::Zero()));
  add(world, cube(4.0, {distance, 0.0, 0.0}));
  return world;
}

TEST(OverlappingPair, IsDeeperThanTwoSkins) {
  EXPECT_FALSE(overlapping_pair(two_cubes(3.01, 0.5))) << "0.99 m";
  const auto deep = overlapping_pair(two_cubes(2.99, 0.5));
  ASSERT_TRUE(deep) << "1.01 m";
  EXPECT_DOUBLE_EQ(deep->clear, 2.0 + 2.0 + 0.5);
  EXPECT_LT((deep->between - Vec3(2.99, 0.0, 0.0)).norm(), 1e-14);
}

TEST(OverlappingPair, WithThinSkinsIsDeeperThanAQuarterOfTheSmallerOne) {
  EXPECT_FALSE(overlapping_pair(two_cubes(3.51, 1e-3)));
  EXPECT_TRUE(overlapping_pair(two_cubes(3.49, 1e-3)));
}

TEST(OverlappingPair, WithThickSkinsIsOneWhoseCentreLiesInTheOther) {
  EXPECT_FALSE(overlapping_pair(two_cubes(2.01, 10.0)));
  EXPECT_TRUE(overlapping_pair(two_cubes(1.99, 10.0)));
}

TEST(OverlappingPair, IsPartedUntilTheSkinLiesBetweenThem) {
  EXPECT_TRUE(overlapping_pair(two_cubes(4.49, 0.5), true));
  EXPECT_FALSE(overlapping_pair(two_cubes(4.51, 0.5), true));
}

TEST(OverlappingPair, InTheSamePlaceIsOne) { EXPECT_TRUE(overlapping_pair(two_cubes(0.0, 0.5))); }

TEST(OverlappingPair, WhatIsInTheHoleOfATorusIsNotInIt) {
  World world = isolated();
  add(world, torus(6.5, Vec3::Zero()));
  add(world, sphere(Vec3::Zero()));
  EXPECT_FALSE(has_filled_centre(*world.soft[0].mesh));
  EXPECT_TRUE(has_filled_centre(*world.soft[1].mesh));
  EXPECT_FALSE(overlapping_pair(world));
}

/// Where the body is first left, found by walking from its centre in steps of a millimetre.
double walk_out(const SoftBody& body, const Vec3& direction) {
  const Vec3 centre = mean(body.positions);
  double way = 0.0;
  while (is_inside({body.mesh->topology, body.positions}, centre + way * direction)) way += 1e-3;
  return way;
}

TEST(OverlappingPair, IsClearWhereTheLineBetweenTheCentresLeavesBoth) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    World world = isolated();
    add(world, sphere(Vec3::Zero()));
    add(world, sphere({0.1 * seed, 1.0, -0.5}));
    perturb(world.soft[0], 0.5, 2 * seed);
    perturb(world.soft[1], 0.5, 2 * seed + 1);
    const auto deep = overlapping_pair(world);
    ASSERT_TRUE(deep);
    const Vec3 line = deep->between.normalized();
    const double clear =
        walk_out(world.soft[0], line) + walk_out(world.soft[1], -line) + 0.5;  // and the skin
    EXPECT_NEAR(deep->clear, clear, 2e-3);                                     // one step each
  }
}

// Moving a pair apart.

World two_spheres(const Vec3& between) {
  World world = isolated();
  add(world, sphere({5.0, -3.0, 2.0}));
  add(world, sphere(Vec3(5.0, -3.0, 2.0) + between));
  world.soft[1].material.vertex_mass *= 3.0;
  for (SoftBody& body : world.soft) perturb(body, 0.2, 7);
  push(world.soft[0], {20.0, 1.0, 4.0});
  push(world.soft[1], {-10.0, 0.0, 0.0});
  return world;
}

/// Parts the two bodies of a world, each by at most so many of its radii.
void part(World& world, double radii) {
  const auto deep = overlapping_pair(world);
  ASSERT_TRUE(deep);
  std::vector<BoundingSphere> spheres;
  for (const SoftBody& body : world.soft) spheres.push_back(bounding_sphere(body.positions, 0.0));
  DepenetrationScratch scratch;
  depenetrate_pairs(world, std::span(&*deep, 1), radii, spheres, scratch);
}

double mass(const SoftBody& body) { return body.material.vertex_mass * body.positions.size(); }

Vec3 centre_of_mass(const World& world) {
  Vec3 sum = Vec3::Zero();
  double all = 0.0;
  for (const SoftBody& body : world.soft) {
    sum += mass(body) * mean(body.positions);
    all += mass(body);
  }
  return sum / all;
}

constexpr double rounding = 1e-12;  // of sums over 116 vertices, relative

TEST(DepenetratePairs, MovesPlacesWithoutEnergyOrMomentum) {
  for (const bool ground : {false, true}) {
    World world = two_spheres({1.0, 0.5, -0.3});
    for (SoftBody& body : world.soft) body.velocities.rows().setZero();
    if (ground) world.settings.ground = ContactMaterial{};
    world.settings.gravity = {0.5, 0.0, -9.81};
    const World before = world;
    part(world, 0.1);
    EXPECT_GT((mean(world.soft[0].positions) - mean(before.soft[0].positions)).norm(), 0.1);
    const Energy was = energy(before), is = energy(world);
    EXPECT_EQ(is.kinetic, 0.0);
    EXPECT_NEAR(is.spring, was.spring, rounding * was.spring);
    EXPECT_NEAR(is.gas, was.gas, rounding * std::abs(was.gas));
    EXPECT_NEAR(is.gravity, was.gravity, rounding * std::abs(was.gravity));
    EXPECT_LT((centre_of_mass(world) - centre_of_mass(before)).norm(), rounding);
    if (!ground) continue;
    for (std::size_t i = 0; i < 2; ++i) {
      for (int v = 0; v < world.soft[i].positions.size(); ++v) {
        EXPECT_EQ(world.soft[i].positions[v].z(), before.soft[i].positions[v].z()) << "height";
      }
    }
  }
}

TEST(DepenetratePairs, StopsTheApproachLikeClay) {
  World world = two_spheres({1.0, 0.5, -0.3});
  const World before = world;
  part(world, 0.0);  // velocities only
  const Momentum was = momentum(before), is = momentum(world);
  EXPECT_LT((is.linear - was.linear).norm(), rounding * was.linear.norm());
  EXPECT_LT((is.angular - was.angular).norm(), rounding * was.angular.norm());

  const Vec3 line = (mean(before.soft[1].positions) - mean(before.soft[0].positions)).normalized();
  const auto approach = [&](const World& w) {
    return (mean(w.soft[0].velocities) - mean(w.soft[1].velocities)).dot(line);
  };
  EXPECT_GT(approach(before), 10.0);
  EXPECT_NEAR(approach(world), 0.0, rounding * approach(before));
  // A perfectly inelastic collision loses mu v^2 / 2, mu the reduced mass.
  const double reduced = 1.0 / (1.0 / mass(world.soft[0]) + 1.0 / mass(world.soft[1]));
  const double lost = 0.5 * reduced * approach(before) * approach(before);
  EXPECT_NEAR(energy(before).kinetic - energy(world).kinetic, lost,
              rounding * energy(before).kinetic);
}

TEST(DepenetratePairs, LeavesBodiesThatPartAloneTheirVelocities) {
  World world = two_spheres({-1.0, 0.5, -0.3});
  const World before = world;
  part(world, 0.1);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(world.soft[i].velocities.rows(), before.soft[i].velocities.rows());
  }
}

// The stage.

World in_one_place(int bodies, double height) {
  World world = by_impulses();
  for (int i = 0; i < bodies; ++i) add(world, sphere({0.0, 0.0, height}));
  return world;
}

bool are_parted_after(World& world, double seconds) {
  EXPECT_FALSE(run(world, seconds));
  return world.depenetrating.empty() && max_penetration(world) == 0.0;
}

TEST(Depenetrate, PartsTwoBodiesInOnePlaceWithinASecond) {
  World world = in_one_place(2, 3.5);
  EXPECT_TRUE(are_parted_after(world, 1.0));
  EXPECT_GT((mean(world.soft[0].positions) - mean(world.soft[1].positions)).norm(), 6.0);
}

TEST(Depenetrate, TakesAsLongAsItTakesAtARadiusPerRelaxationTime) {
  // Each goes half of two radii and a skin, at a radius in 0.1 s, less the last part: some 0.12 s.
  // The radius of the bounding sphere, and the gas, make it a little more.
  World world = in_one_place(2, 3.5);
  ASSERT_FALSE(run(world, 5.0 / 60.0));
  EXPECT_EQ(world.depenetrating.size(), 1U);
  ASSERT_FALSE(run(world, 20.0 / 60.0));
  EXPECT_TRUE(world.depenetrating.empty());
}

TEST(Depenetrate, NeverAddsEnergyToWhatItParts) {
  for (const Integrator integrator : {Integrator::rk4, Integrator::implicit_euler}) {
    World world = in_one_place(10, 3.5);
    world.settings.integrator = integrator;
    Stepper stepper(world);
    double least = energy(world).total(), risen = 0.0;
    const double start = least;
    while (time(world) < 2.0) {
      ASSERT_FALSE(stepper.step(world));
      const double now = energy(world).total();
      risen = std::max(risen, now - least);
      least = std::min(least, now);
    }
    EXPECT_GT(start - least, 1e4) << "what the gas loses that blows them up";
    // Where they are clear of each other surfaces push on, and those strain springs.
    EXPECT_LT(risen, 0.01 * (start - least));
    EXPECT_TRUE(are_parted_after(world, 1.0));
  }
}

TEST(Depenetrate, OnesOfVeryDifferentSizeAndMass) {
  World world = by_impulses();
  add(world, make_body(make_icosphere(10.0, 2), {0.0, 0.0, 10.0}));
  add(world, make_body(make_icosphere(1.0, 1), {0.0, 0.0, 10.0}));
  world.soft[1].material.n = 0.1;
  world.soft[1].material.vertex_mass = 0.05;
  const Vec3 start = mean(world.soft[0].positions);
  EXPECT_TRUE(are_parted_after(world, 2.0));
  // The small one goes: the large one moves by its share of 11.5 m, 1/28, before surfaces push on.
  EXPECT_LT((mean(world.soft[0].positions) - start).head<2>().norm(), 1.0);
}

TEST(Depenetrate, LeavesTorusesAlone) {
  World world = by_impulses();
  add(world, torus(6.5, {0.0, 0.0, 2.6}));
  add(world, torus(6.5, {0.0, 0.0, 2.7}));
  EXPECT_FALSE(make_plan(world).runs(Stage::depenetrate));
  add(world, sphere({0.0, 0.0, 3.0}));
  EXPECT_FALSE(make_plan(world).runs(Stage::depenetrate)) << "a single filled body";
  add(world, sphere({20.0, 0.0, 3.5}));
  EXPECT_TRUE(make_plan(world).runs(Stage::depenetrate));
}

TEST(Depenetrate, WithoutRoomDoesNoHarm) {
  // A pen 7 m wide, too narrow for two bodies of 7.5 m.
  World world = in_one_place(2, 4.0);
  for (const double side : {-1.0, 1.0}) {
    add(world, make_rigid({2.0, 20.0, 20.0}, {4.5 * side, 0.0, 10.0}, 1e5));
    add(world, make_rigid({7.0, 2.0, 20.0}, {0.0, 4.5 * side, 10.0}, 1e5));
  }
  const double start = energy(world).total();
  Stepper stepper(world);
  while (time(world) < 5.0) {
    ASSERT_FALSE(stepper.step(world));
    ASSERT_LT(energy(world).total(), start + 1e4) << time(world);  // of 9e7 J of gravity
  }
}

TEST(Depenetrate, IsLeftOutWhereNothingIsDeepWithoutChangingABit) {
  StepperOptions without;
  World world = by_impulses(meeting_spheres(4.0, 1));
  without.plan = make_plan(world);
  without.plan->stages[static_cast<std::size_t>(Stage::depenetrate)] = {false, "a test"};
  World other = world;
  ASSERT_FALSE(run(world, 3.0));
  ASSERT_FALSE(run(other, 3.0, without));
  EXPECT_EQ(state_hash(world), state_hash(other));
}

TEST(Depenetrate, GoesOnFromACheckpointWithinIt) {
  World world = in_one_place(4, 3.5);
  ASSERT_FALSE(run(world, 0.2));
  ASSERT_FALSE(world.depenetrating.empty());
  World resumed = in_one_place(4, 3.5);
  load_state(save_state(world), resumed);
  ASSERT_FALSE(run(world, 1.0));
  ASSERT_FALSE(run(resumed, 1.0));
  EXPECT_EQ(state_hash(world), state_hash(resumed));
}

}  // namespace
}  // namespace pneuma::sim
