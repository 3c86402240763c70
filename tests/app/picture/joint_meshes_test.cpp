#include "app/picture/joint_meshes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "app/world/build_world.h"
#include "scenes/loader/load_scene.h"

namespace pneuma::app {
namespace {

const std::string tied_along_x =
    "[[body]]\nname = \"a\"\nradius = 1\nposition = [-1, 0, 5]\n"
    "[[body]]\nname = \"b\"\nradius = 2\nposition = [2, 0, 5]\n"
    "[[spring]]\nfrom = \"a\"\nto = \"b\"\nk = 1\n";

/// With the ends of the spring so far apart, m.
sim::World tied_world(double distance) {
  sim::World world = build_world(scenes::parse_scene(tied_along_x, "tied.toml"));
  for (const int v : world.springs[0].second.vertices) {
    world.soft[1].positions[v].x() += distance;
  }
  return world;
}

/// m, from the line between the ends.
float drawn_radius(const JointMeshes& joints, const sim::World& world) {
  render::Frame frame;
  joints.add(world, frame);
  EXPECT_EQ(frame.meshes.size(), 1u);
  float radius = 0.0f;
  for (const render::Vec3f& p : frame.meshes.at(0).positions) {
    radius = std::max(radius, std::hypot(p.y(), p.z() - 5.0f));
  }
  return radius;
}

TEST(JointMeshes, DrawASpringWhoseEndsTouchAtTheStart) {
  const sim::World start = tied_world(0.0);
  ASSERT_LT(start.springs.at(0).rest_length, 1e-9);
  const JointMeshes joints(start);
  for (const double distance : {0.0, 0.3}) {
    const float radius = drawn_radius(joints, tied_world(distance));
    EXPECT_GT(radius, 0.05f) << distance;  // of a ball with a radius of 1 m
    EXPECT_LT(radius, 0.25f) << distance;
  }
}

TEST(JointMeshes, DrawSpringsThatStartLongWider) {
  const float least = drawn_radius(JointMeshes(tied_world(0.0)), tied_world(3.0));
  EXPECT_GT(drawn_radius(JointMeshes(tied_world(3.0)), tied_world(3.0)), 1.5f * least);
}

}  // namespace
}  // namespace pneuma::app
