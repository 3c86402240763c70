// What the paper's figures show, by number, at the end of their scenes.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "app/world/build_world.h"
#include "app/world/find_scene.h"
#include "scenes/loader/load_scene.h"
#include "sim/inspect/inspect.h"
#include "sim/mesh/measure.h"
#include "sim/step/stepper.h"

namespace pneuma::app {
namespace {

using sim::SoftBody;
using sim::Vec3;
using sim::World;

template <class Visit>
World run_scene(const std::string& name, const Visit& after_step) {
  const scenes::Scene scene = scenes::load_scene(find_scene(name));
  World world = build_world(scene);
  sim::Stepper stepper(world);
  const std::int64_t steps = scenes::frame_count(scene) * scene.settings.steps_per_second /
                             scene.picture.frames_per_second;
  while (world.steps < steps) {
    EXPECT_FALSE(stepper.step(world));
    after_step(world);
  }
  return world;
}

World world_at_end(const std::string& name) {
  return run_scene(name, [](const World&) {});
}

const SoftBody& body(const World& world, const std::string& name) {
  return *std::ranges::find(world.soft, name, &SoftBody::name);
}

Vec3 middle(const SoftBody& body) {
  Vec3 sum = Vec3::Zero();
  for (int v = 0; v < body.positions.size(); ++v) sum += body.positions[v];
  return sum / body.positions.size();
}

/// Distance from the axis of a torus, which is upright in these scenes.
double from_axis(const Vec3& place) { return place.head<2>().norm(); }

double outer_radius(const SoftBody& torus) {
  const sim::Bounds bounds = sim::bounds(torus.positions);
  return 0.5 * (bounds.high.x() - bounds.low.x());
}

/// Nearer to the axis than the middle of the tube, and lower than the top of it.
void expect_in_hole(const Vec3& place, const SoftBody& torus, const std::string& name) {
  EXPECT_LT(from_axis(place - middle(torus)), 0.75 * outer_radius(torus)) << name;
  EXPECT_LT(place.z(), sim::bounds(torus.positions).high.z() + 1.5) << name;
}

TEST(PaperFigures, In64TheFirmSphereIsRoundAndTheSoftOneSags) {
  const auto height_over_width = [](const std::string& scene) {
    const Vec3 size = sim::bounds(world_at_end(scene).soft.front().positions).size();
    return size.z() / std::max(size.x(), size.y());
  };
  // Of the paper's pictures, as measured in them to about 0.05.
  EXPECT_NEAR(height_over_width("pressure_firm"), 1.0, 0.05);
  EXPECT_NEAR(height_over_width("pressure_soft"), 0.83, 0.05);
}

TEST(PaperFigures, In65BottomLeftTwoSpheresAndTheCubesAreInTheHole) {
  const World world = world_at_end("torus_three_spheres_four_cubes");
  const SoftBody& torus = body(world, "torus");
  ASSERT_EQ(world.rigid.size(), 4u);
  for (const sim::RigidBox& cube : world.rigid) expect_in_hole(cube.position, torus, cube.name);
  for (const char* sphere : {"left", "right"}) {
    expect_in_hole(middle(body(world, sphere)), torus, sphere);
  }
  EXPECT_GT(from_axis(middle(body(world, "outside")) - middle(torus)), outer_radius(torus));
}

TEST(PaperFigures, WhatIsDroppedIntoATorusIsInItsHole) {
  const World spheres = world_at_end("sphere_in_torus");
  expect_in_hole(middle(body(spheres, "sphere")), body(spheres, "torus"), "sphere");
  const World cubes = world_at_end("torus_four_cubes");
  ASSERT_EQ(cubes.rigid.size(), 4u);
  for (const sim::RigidBox& cube : cubes.rigid) {
    expect_in_hole(cube.position, body(cubes, "torus"), cube.name);
  }
}

/// How far the middles of a torus's 16 sections are from the plane nearest to them, root mean
/// square, over its radius: 0 if it is only turned.
double bend(const SoftBody& torus) {
  constexpr int sections = 16, vertices = 16;
  Eigen::Matrix<double, 3, sections> middles;
  for (int i = 0; i < sections; ++i) {
    Vec3 sum = Vec3::Zero();
    for (int v = 0; v < vertices; ++v) sum += torus.positions[i * vertices + v];
    middles.col(i) = sum / vertices;
  }
  middles.colwise() -= middles.rowwise().mean().eval();
  const sim::Mat3 covariance = middles * middles.transpose() / sections;
  const Eigen::SelfAdjointEigenSolver<sim::Mat3> axes(covariance);
  // Of a circle the other two are half its squared radius each.
  return std::sqrt(axes.eigenvalues()(0) / axes.eigenvalues().tail<2>().sum());
}

TEST(PaperFigures, In65TopRightTheTorusIsBentByTheSpheresItLiesOn) {
  double most = 0.0;
  const World world = run_scene("torus_three_spheres", [&](const World& now) {
    most = std::max(most, bend(body(now, "torus")));
  });
  EXPECT_GT(most, 0.1);
  EXPECT_GT(bend(body(world, "torus")), 0.02);
  EXPECT_LT(bend(body(world_at_end("one_torus"), "torus")), 0.01) << "on the ground it is flat";
}

/// Of the upper half of a ball: how much nearer its nearest vertex is to its middle than all are on
/// average.
double dent(const SoftBody& ball) {
  const Vec3 centre = middle(ball);
  double nearest = std::numeric_limits<double>::infinity(), sum = 0.0;
  for (int v = 0; v < ball.positions.size(); ++v) {
    const Vec3 arm = ball.positions[v] - centre;
    sum += arm.norm();
    if (arm.z() > 0.0) nearest = std::min(nearest, arm.norm());
  }
  return 1.0 - nearest * ball.positions.size() / sum;
}

TEST(PaperFigures, In65BottomRightTheCatDentsTheSphereAndSlidesOffIt) {
  double deepest = 0.0;
  const World world = run_scene("cat_on_sphere", [&](const World& now) {
    deepest = std::max(deepest, dent(body(now, "sphere")));
  });
  const SoftBody& cat = body(world, "cat");
  const SoftBody& sphere = body(world, "sphere");
  EXPECT_GT(deepest, 0.3);
  EXPECT_LT(dent(sphere), 0.1);
  EXPECT_LT(sim::bounds(cat.positions).low.z(), 0.01) << "it is on the ground";
  EXPECT_GT(from_axis(middle(cat) - middle(sphere)), outer_radius(sphere)) << "and beside it";
}

}  // namespace
}  // namespace pneuma::app
