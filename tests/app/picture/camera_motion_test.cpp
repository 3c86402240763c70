#include "app/picture/camera_motion.h"

#include <gtest/gtest.h>

#include <cmath>

#include "app/picture/place_camera.h"
#include "app/world/build_world.h"
#include "scenes/loader/load_scene.h"

namespace pneuma::app {
namespace {

using render::Vec3f;
using sim::Vec3;

constexpr const char* two_balls = R"(
duration = 2.0
[[body]]
name = "ball"
radius = 1.0
position = [0.0, 0.0, 6.0]
copies = [2, 1, 1]
spacing = [4.0, 0.0, 0.0]
[[body]]
name = "ball2"
radius = 1.0
position = [0.0, 9.0, 6.0]
)";

scenes::Scene scene_with(const std::string& camera) {
  return scenes::parse_scene("camera = {" + camera + "}\n" + two_balls, "x.toml");
}

TEST(Turned, GoesAroundTheVerticalThroughTheTarget) {
  const render::Camera camera = {{3, 0, 5}, {1, 0, 2}, 40.0f};
  const render::Camera quarter = turned(camera, 90.0);
  EXPECT_LT((quarter.eye - Vec3f(1, 2, 5)).norm(), 1e-5f);
  EXPECT_EQ(quarter.target, camera.target);
  EXPECT_LT((turned(camera, 360.0).eye - camera.eye).norm(), 1e-5f);
}

TEST(CameraMotion, FollowsABodyOrAllItsCopies) {
  const scenes::Scene scene =
      scene_with(R"(follow = "ball", eye = [0, -9, 6], target = [0, 0, 6])");
  const sim::World start = build_world(scene);
  const render::Camera camera = placed_camera(scene, start);
  const CameraMotion motion(scene, start);
  EXPECT_EQ(motion.at(camera, start).eye, camera.eye);

  sim::World moved = start;
  const auto shift = [&](std::size_t body, const Vec3& by) {
    for (int v = 0; v < moved.soft[body].positions.size(); ++v) moved.soft[body].positions[v] += by;
  };
  shift(2, {5.0, 5.0, 5.0});  // ball2 is another body, not a copy
  EXPECT_EQ(motion.at(camera, moved).eye, camera.eye);
  shift(0, {1.0, 2.0, 3.0});
  shift(1, {1.0, 2.0, 3.0});
  EXPECT_LT((motion.at(camera, moved).eye - camera.eye - Vec3f(1, 2, 3)).norm(), 1e-5f);
  EXPECT_LT((motion.at(camera, moved).target - camera.target - Vec3f(1, 2, 3)).norm(), 1e-5f);
}

TEST(CameraMotion, OrbitsByTheTimeOfTheWorld) {
  const scenes::Scene scene = scene_with("orbit = 90, eye = [0, -9, 6], target = [0, 0, 6]");
  sim::World world = build_world(scene);
  const CameraMotion motion(scene, world);
  const render::Camera camera = placed_camera(scene, world);
  world.steps = world.settings.steps_per_second;  // a second
  EXPECT_LT((motion.at(camera, world).eye - Vec3f(9, 0, 6)).norm(), 1e-5f);
}

TEST(CameraOnPath, GoesThroughItsKeysAndRestsAtBothEnds) {
  const scenes::Scene scene =
      scene_with("path = [[1, 0, -9, 6, 0, 0, 6], [2, 9, 0, 6, 0, 0, 5], [4, 0, 9, 6, 1, 0, 6]]");
  const auto eye = [&](double time) { return camera_on_path(scene.camera, time).eye; };
  EXPECT_EQ(eye(0.0), Vec3f(0, -9, 6)) << "before the first key";
  EXPECT_LT((eye(2.0) - Vec3f(9, 0, 6)).norm(), 1e-5f);
  EXPECT_EQ(camera_on_path(scene.camera, 9.0).target, Vec3f(1, 0, 6)) << "after the last";
  // By differences: no jump of the velocity at a key, none at all at the ends.
  const double step = 1e-2;
  const auto velocity = [&](double time) {
    return Vec3f((eye(time + step) - eye(time - step)) / static_cast<float>(2 * step));
  };
  EXPECT_LT((velocity(2.0 + 2 * step) - velocity(2.0 - 2 * step)).norm(), 2.0f);  // of 6 m/s
  EXPECT_LT(velocity(1.0 + step).norm(), 1.0f);
}

TEST(PlacedCamera, LooksAtTheBodyThatItFollows) {
  const scenes::Scene scene = scene_with(R"(follow = "ball2")");
  const render::Camera camera = placed_camera(scene, build_world(scene));
  EXPECT_LT((camera.target - Vec3f(0, 9, 6)).norm(), 0.1f);  // 8 slices are not quite symmetric
}

}  // namespace
}  // namespace pneuma::app
