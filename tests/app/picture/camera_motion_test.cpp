#include "app/picture/camera_motion.h"

#include <gtest/gtest.h>

#include <cmath>

#include "app/picture/place_camera.h"
#include "app/world/build_world.h"
#include "app/world/simulation.h"
#include "render/frame/camera.h"
#include "scenes/loader/load_scene.h"
#include "sim/mesh/measure.h"

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
  const render::Camera camera = place_camera(scene, start, 1).camera;
  const CameraMotion motion(scene, start, camera);
  EXPECT_EQ(motion.at(start).eye, camera.eye);

  sim::World moved = start;
  const auto shift = [&](std::size_t body, const Vec3& by) {
    for (int v = 0; v < moved.soft[body].positions.size(); ++v) moved.soft[body].positions[v] += by;
  };
  shift(2, {5.0, 5.0, 5.0});  // ball2 is another body, not a copy
  EXPECT_EQ(motion.at(moved).eye, camera.eye);
  shift(0, {1.0, 2.0, 3.0});
  shift(1, {1.0, 2.0, 3.0});
  EXPECT_LT((motion.at(moved).eye - camera.eye - Vec3f(1, 2, 3)).norm(), 1e-5f);
  EXPECT_LT((motion.at(moved).target - camera.target - Vec3f(1, 2, 3)).norm(), 1e-5f);
}

TEST(CameraMotion, OrbitsByTheTimeOfTheWorld) {
  const scenes::Scene scene = scene_with("orbit = 90, eye = [0, -9, 6], target = [0, 0, 6]");
  sim::World world = build_world(scene);
  const CameraMotion motion(scene, world, place_camera(scene, world, 1).camera);
  world.steps = world.settings.steps_per_second;  // a second
  EXPECT_LT((motion.at(world).eye - Vec3f(9, 0, 6)).norm(), 1e-5f);
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
  EXPECT_EQ(place_camera(scene, build_world(scene), 1).camera.eye, Vec3f(0, -9, 6));
}

/// How far from the middle of the picture anything is seen: 1 is its side.
float widest(const sim::World& world, const render::Camera& camera, float aspect) {
  const render::Mat4f to_clip =
      render::projection_matrix(camera.field_of_view, aspect, 0.1f, 1000.0f) *
      render::view_matrix(camera);
  float result = 0.0f;
  for (const sim::SoftBody& body : world.soft) {
    for (int v = 0; v < body.positions.size(); ++v) {
      const Eigen::Vector4f clip =
          to_clip * Vec3f(Vec3(body.positions[v]).cast<float>()).homogeneous();
      result = std::max({result, std::abs(clip.x() / clip.w()), std::abs(clip.y() / clip.w())});
    }
  }
  return result;
}

TEST(CameraAround, HasAllBodiesInViewFromAllSides) {
  const scenes::Scene scene = scenes::parse_scene(two_balls, "x.toml");
  const sim::World world = build_world(scene);
  const render::Camera camera = camera_around(scene, world);
  float most = 0.0f;
  for (int i = 0; i < 36; ++i) {
    most = std::max(most, widest(world, turned(camera, 10.0 * i), 16.0f / 9.0f));
  }
  EXPECT_LE(most, 1.0f);
  EXPECT_GE(most, 0.7f);
}

TEST(PlaceCamera, LooksAtTheBodyThatItFollowsWithoutSimulating) {
  const scenes::Scene scene = scene_with(R"(follow = "ball2")");
  const render::Camera camera = place_camera(scene, build_world(scene), 1, [](const sim::World&) {
                                  ADD_FAILURE() << "simulated";
                                }).camera;
  EXPECT_LT((camera.target - Vec3f(0, 9, 6)).norm(), 0.1f);  // 8 slices are not quite symmetric
}

TEST(PlaceCamera, OfAnOrbitHasTheRunInView) {
  const scenes::Scene scene = scene_with("orbit = 180");
  const sim::World start = build_world(scene);
  const CameraMotion motion(scene, start, place_camera(scene, start, 1).camera);
  Simulation simulation(scene, start, 1);
  while (simulation.frame() < scenes::frame_count(scene)) {
    EXPECT_LE(widest(simulation.world(), motion.at(simulation.world()), 16.0f / 9.0f), 1.0f);
    simulation.advance_frame();
  }
}

}  // namespace
}  // namespace pneuma::app
