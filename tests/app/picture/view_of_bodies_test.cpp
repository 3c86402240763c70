#include "app/picture/view_of_bodies.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "app/picture/camera_motion.h"
#include "app/world/build_world.h"
#include "scenes/loader/load_scene.h"
#include "tests/app/picture/widest_view.h"

namespace pneuma::app {
namespace {

using sim::Bounds;
using sim::Vec3;

constexpr const char* three_balls = R"(
[[body]]
radius = 1.0
position = [0.0, 0.0, 6.0]
copies = [2, 1, 1]
spacing = [4.0, 0.0, 0.0]
[[body]]
radius = 1.0
position = [0.0, 9.0, 6.0]
)";

TEST(CameraAround, HasAllBodiesInViewFromAllSides) {
  const scenes::Scene scene = scenes::parse_scene(three_balls, "x.toml");
  const sim::World world = build_world(scene);
  const render::Camera camera = camera_around(scene, world);
  float most = 0.0f;
  for (int i = 0; i < 36; ++i) {
    most = std::max(most, widest_view(scene, world, turned(camera, 10.0 * i)));
  }
  EXPECT_LE(most, 1.0f);
  EXPECT_GE(most, 0.7f);
}

Bounds bounds_of(double low, double high) { return {Vec3::Constant(low), Vec3::Constant(high)}; }

TEST(WorthShowing, IsWhatStaysNearInItsOwnSize) {
  const Bounds shown = worth_showing(bounds_of(0.0, 1.0), 1.0);
  EXPECT_LT(shown.low.x(), -10.0) << "a ball of 1 m that rolls 10 m is in view";
  EXPECT_GT(shown.low.x(), -30.0);
  EXPECT_GT(shown.high.z(), 3.0);
  EXPECT_GT(shown.low.z(), -10.0) << "one that falls for ever is not";
}

TEST(WorthShowing, AllowsForBodiesThatGrow) {
  // A ball of 1 m that is blown up to 40 m is not far away, but large.
  EXPECT_GT(worth_showing(bounds_of(0.0, 1.0), 40.0).high.x(), 20.0);
}

TEST(ViewOfBodies, NamesTheBodyThatGoesBeyond) {
  const scenes::Scene scene = scenes::parse_scene(three_balls, "x.toml");
  sim::World world = build_world(scene);
  ViewOfBodies view(scene, world);
  EXPECT_FALSE(view.add(world));
  const render::Camera before = view.camera();
  sim::VertexArray& positions = world.soft[2].positions;
  for (int v = 0; v < positions.size(); ++v) positions[v] += Vec3(1e6, 0.0, 0.0);
  EXPECT_EQ(view.add(world), world.soft[2].name);
  EXPECT_GT((view.camera().eye - before.eye).norm(), 1.0f) << "as far as that it counts";
  EXPECT_LT((view.camera().eye - before.eye).norm(), 1e3f);
}

/// How far the camera stands from what it looks at.
float distance_of(const std::string& bodies) {
  const scenes::Scene scene = scenes::parse_scene("camera.elevation = 20\n" + bodies, "x.toml");
  const sim::World world = build_world(scene);
  ViewOfBodies view(scene, world);
  view.add(world);
  const render::Camera camera = view.camera();
  return (camera.eye - camera.target).norm();
}

TEST(ViewOfBodies, LeavesOutWhatTheGroundHides) {
  const auto block = [](double height, double turn) {
    return fmt::format(
        "[[body]]\nkind = \"static\"\nsize = [4, 4, {}]\nposition = [0, 0, {}]\n"
        "rotation = [{}, 0, 0]\n",
        height, 1.0 - 0.5 * height, turn);
  };
  const float seen = distance_of(block(1.0, 0.0));
  EXPECT_NEAR(distance_of(block(100.0, 0.0)), seen, 1e-3f * seen);
  EXPECT_GT(distance_of("ground.present = false\n" + block(100.0, 0.0)), 5.0f * seen);
  EXPECT_GT(distance_of("picture.grid = false\n" + block(100.0, 0.0)), 5.0f * seen);
  // A post that leans: from where it comes out of the ground.
  EXPECT_LT(distance_of(block(20.0, 30.0)), 3.0f * seen);
  // Nothing else is there.
  EXPECT_GT(distance_of("[[body]]\nkind = \"static\"\nsize = [4, 4, 1]\nposition = [0, 0, -9]\n"),
            0.5f * seen);
}

}  // namespace
}  // namespace pneuma::app
