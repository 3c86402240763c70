#include "app/study/error/error_meter.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/worlds.h"

namespace pneuma::app {
namespace {

using sim::Vec3;

constexpr double rounding = 1e-12;

/// A sphere of radius 3 that moves as a whole at (2, 0, 0) m/s.
sim::World moving_sphere() {
  sim::World world = sim::make_free_world(sim::make_body(sim::make_sphere(3.0, 8, 8)));
  world.settings.gravity = {0.0, 0.0, -10.0};
  for (int v = 0; v < world.soft[0].velocities.size(); ++v) {
    world.soft[0].velocities[v] = Vec3(2.0, 0.0, 0.0);
  }
  return world;
}

StateErrors errors(const sim::World& expected, const sim::World& found) {
  return ErrorMeter(expected, {take_sample(expected)}).errors(0, take_sample(found));
}

TEST(RestRadius, IsThatOfASphereAndReachesAroundATorus) {
  EXPECT_NEAR(rest_radius(sim::make_body(sim::make_sphere(3.0, 8, 8), {1.0, 2.0, 3.0})), 3.0,
              rounding);
  EXPECT_NEAR(rest_radius(sim::make_body(sim::make_torus(6.0, 2.0, 16, 16))), 8.0, rounding);
}

TEST(ErrorMeter, FindsNoneInTheReferenceItself) {
  const sim::World world = moving_sphere();
  const StateErrors none = errors(world, world);
  EXPECT_EQ(none.position, 0.0);
  EXPECT_EQ(none.volume, 0.0);
  EXPECT_EQ(none.centre, 0.0);
  EXPECT_EQ(none.energy, 0.0);
  EXPECT_EQ(none.momentum, 0.0);
}

TEST(ErrorMeter, MeasuresAShift) {
  const sim::World world = moving_sphere();
  sim::World shifted = world;
  for (int v = 0; v < 58; ++v) shifted.soft[0].positions[v] += Vec3(0.0, 0.3, 0.4);
  const StateErrors found = errors(world, shifted);
  EXPECT_NEAR(found.position, 0.5 / 3.0, rounding);
  EXPECT_NEAR(found.centre, 0.5 / 3.0, rounding);
  EXPECT_NEAR(found.volume, 0.0, rounding);
  EXPECT_NEAR(found.momentum, 0.0, rounding);
  EXPECT_NEAR(found.angular_momentum, 0.5 / 3.0, rounding);  // (0, 0.3, 0.4) m across its way
  // m g 0.4 m over m/2 (2 m/s)^2.
  EXPECT_NEAR(found.energy, 10.0 * 0.4 / 2.0, rounding);
}

TEST(ErrorMeter, MeasuresASpinAboutTheCentre) {
  sim::World world = moving_sphere();
  for (int v = 0; v < 58; ++v) world.soft[0].positions[v] += Vec3(40.0, 0.0, 0.0);
  sim::World spinning = world;
  sim::SoftBody& body = spinning.soft[0];
  const Vec3 spin(0.0, 0.0, 1.5), centre = sim::mean(body.positions);
  Vec3 angular = Vec3::Zero();
  for (int v = 0; v < 58; ++v) {
    const Vec3 arm = body.positions[v] - centre, faster = spin.cross(arm);
    body.velocities[v] += faster;
    angular += arm.cross(faster);
  }
  const StateErrors found = errors(world, spinning);
  EXPECT_NEAR(found.momentum, 0.0, rounding);
  // Of equal vertices at 2 m/s, whose mass goes out.
  EXPECT_NEAR(found.angular_momentum, angular.norm() / (58.0 * 2.0 * 3.0), 1e-10);
}

TEST(ErrorMeter, TakesTheRootMeanSquareOverVertices) {
  const sim::World world = moving_sphere();
  sim::World one_off = world;
  one_off.soft[0].positions[7] += Vec3(0.6, 0.0, 0.0);
  EXPECT_NEAR(errors(world, one_off).position, 0.6 / 3.0 / std::sqrt(58.0), rounding);
}

TEST(ErrorMeter, MeasuresVolumeAndMomentum) {
  const sim::World world = moving_sphere();
  sim::World other = world;
  other.soft[0].positions.rows() *= 1.1;
  other.soft[0].velocities.rows() *= 1.25;
  const StateErrors found = errors(world, other);
  EXPECT_NEAR(found.volume, 1.1 * 1.1 * 1.1 - 1.0, rounding);
  EXPECT_NEAR(found.momentum, 0.25, rounding);  // all mass moves as one
}

TEST(ErrorMeter, TakesTheWorstBodyAndAllOfTheirVertices) {
  sim::World world = moving_sphere();
  world.soft.push_back(sim::make_body(sim::make_sphere(1.0, 8, 8)));
  sim::World other = world;
  for (int v = 0; v < 58; ++v) other.soft[1].positions[v] += Vec3(0.2, 0.0, 0.0);
  const StateErrors found = errors(world, other);
  EXPECT_NEAR(found.centre, 0.2, rounding);
  EXPECT_NEAR(found.position, 0.2 / std::sqrt(2.0), rounding);
}

TEST(ErrorMeter, SeesABoxTurn) {
  sim::World world = moving_sphere();
  world.soft.clear();
  world.rigid.push_back(sim::make_rigid({2.0, 2.0, 2.0}, {0.0, 0.0, 0.0}));
  world.rigid[0].velocity = {1.0, 0.0, 0.0};
  sim::World turned = world;
  turned.rigid[0].orientation = Eigen::AngleAxisd(std::numbers::pi / 2.0, Vec3::UnitZ());
  // Each corner goes to the next one, 2 m away; the radius is half the diagonal.
  EXPECT_NEAR(errors(world, turned).position, 2.0 / std::sqrt(3.0), rounding);
  EXPECT_NEAR(errors(world, turned).centre, 0.0, rounding);
}

TEST(ErrorMeter, TellsTheEndFromTheGreatest) {
  const sim::World world = moving_sphere();
  sim::World off = world;
  off.soft[0].positions.rows() *= 1.2;
  const Sample expected = take_sample(world), other = take_sample(off);
  ErrorMeter meter(world, {expected, expected, expected});
  const RunErrors found = meter.errors({expected, other, expected});
  EXPECT_EQ(found.end.position, 0.0);
  EXPECT_NEAR(found.greatest.volume, 1.2 * 1.2 * 1.2 - 1.0, rounding);
}

TEST(ErrorMeter, DividesByWhatThereIsAtAnyTime) {
  // At rest at the first sample: the scale is that of the second.
  const sim::World moving = moving_sphere();
  sim::World resting = moving;
  resting.soft[0].velocities.rows().setZero();
  ErrorMeter meter(moving, {take_sample(resting), take_sample(moving)});
  EXPECT_NEAR(meter.errors(0, take_sample(moving)).momentum, 1.0, rounding);
}

}  // namespace
}  // namespace pneuma::app
