#include "app/picture/place_camera.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "app/world/build_world.h"
#include "app/world/simulation.h"
#include "render/frame/camera.h"
#include "scenes/loader/load_scene.h"

namespace pneuma::app {
namespace {

using sim::Bounds;
using sim::Vec3;

constexpr const char* falling_ball = R"(
duration = 2.0
[[body]]
kind = "soft"
shape = "sphere"
radius = 1.0
position = [0.0, 0.0, 6.0]
velocity = [4.0, 0.0, 0.0]
)";

PlacedCamera camera_of(const scenes::Scene& scene) {
  return place_camera(scene, build_world(scene), 1);
}

/// The largest of |x| and |y| in clip coordinates over all vertices: 1 is the picture's edge.
float widest(const scenes::Scene& scene, const sim::World& world, const render::Camera& camera) {
  const float aspect =
      static_cast<float>(scene.picture.width) / static_cast<float>(scene.picture.height);
  const render::Mat4f to_clip =
      render::projection_matrix(camera.field_of_view, aspect, 0.1f, 1000.0f) *
      render::view_matrix(camera);
  float result = 0.0f;
  for (const sim::SoftBody& body : world.soft) {
    for (int v = 0; v < body.positions.size(); ++v) {
      const render::Vec3f point = Vec3(body.positions[v]).cast<float>();
      const Eigen::Vector4f clip = to_clip * point.homogeneous();
      EXPECT_GT(clip.w(), 0.0f);  // in front of the camera
      result = std::max({result, std::abs(clip.x() / clip.w()), std::abs(clip.y() / clip.w())});
    }
  }
  return result;
}

TEST(PlaceCamera, HasTheWholeRunInView) {
  for (const char* size : {"picture.width=1280", "picture.width=300"}) {  // wide, and upright
    const std::string overrides[] = {size};
    const scenes::Scene scene = scenes::parse_scene(falling_ball, "test.toml", overrides);
    const PlacedCamera placed = camera_of(scene);
    EXPECT_EQ(placed.notice, "");

    Simulation simulation(scene, build_world(scene), 1);
    float most = widest(scene, simulation.world(), placed.camera);
    while (simulation.frame() < scenes::frame_count(scene)) {
      simulation.advance_frame();
      most = std::max(most, widest(scene, simulation.world(), placed.camera));
    }
    EXPECT_LE(most, 1.0f) << size;
    EXPECT_GE(most, 0.5f) << size;  // nor lost in the distance
  }
}

TEST(PlaceCamera, StandsWhereTheSceneSays) {
  const std::string overrides[] = {"camera.azimuth=0", "camera.elevation=45"};
  const scenes::Scene scene = scenes::parse_scene(falling_ball, "test.toml", overrides);
  const render::Camera camera = camera_of(scene).camera;
  const render::Vec3f backward = (camera.eye - camera.target).normalized();
  // From +x, half way up. Single precision over a distance of tens of metres.
  EXPECT_LT((backward - render::Vec3f(std::sqrt(0.5f), 0.0f, std::sqrt(0.5f))).norm(), 1e-5f);
}

TEST(PlaceCamera, TakesAGivenCameraWithoutSimulating) {
  const std::string overrides[] = {"camera.eye=[1,2,3]", "camera.target=[4,5,6]",
                                   "camera.field_of_view=50"};
  const scenes::Scene scene = scenes::parse_scene(falling_ball, "test.toml", overrides);
  const PlacedCamera placed = place_camera(scene, build_world(scene), 1,
                                           [](const sim::World&) { ADD_FAILURE() << "simulated"; });
  EXPECT_EQ(placed.camera.eye, render::Vec3f(1.0f, 2.0f, 3.0f));
  EXPECT_EQ(placed.camera.target, render::Vec3f(4.0f, 5.0f, 6.0f));
  EXPECT_EQ(placed.camera.field_of_view, 50.0f);
}

TEST(PlaceCamera, CanBeStopped) {
  struct Stop {};
  const scenes::Scene scene = scenes::parse_scene(falling_ball, "test.toml");
  EXPECT_THROW(place_camera(scene, build_world(scene), 1, [](const sim::World&) { throw Stop(); }),
               Stop);
}

TEST(PlaceCamera, DoesNotFollowWhatFallsForEver) {
  const std::string overrides[] = {"ground.present=false", "duration=10"};
  const scenes::Scene scene = scenes::parse_scene(falling_ball, "test.toml", overrides);
  const PlacedCamera placed = camera_of(scene);
  EXPECT_NE(placed.notice, "");
  // The start is in view.
  EXPECT_LE(widest(scene, build_world(scene), placed.camera), 1.0f);
}

TEST(PlaceCamera, LeavesDivergenceToTheRun) {
  const std::string overrides[] = {"body.k=1e9"};
  EXPECT_NO_THROW(camera_of(scenes::parse_scene(falling_ball, "test.toml", overrides)));
}

Bounds bounds_of(double low, double high) { return {Vec3::Constant(low), Vec3::Constant(high)}; }

TEST(UsefulBounds, AreTheRunsOwnWhileThatStaysNear) {
  const Bounds useful = useful_bounds(bounds_of(0.0, 1.0), bounds_of(-1.0, 3.0), 1.0);
  EXPECT_EQ(useful.low, Vec3::Constant(-1.0));
  EXPECT_EQ(useful.high, Vec3::Constant(3.0));
}

TEST(UsefulBounds, AllowForBodiesThatGrow) {
  // A ball of 1 m that is blown up to 40 m is not far away, but large.
  const Bounds useful = useful_bounds(bounds_of(0.0, 1.0), bounds_of(-20.0, 20.0), 40.0);
  EXPECT_EQ(useful.high, Vec3::Constant(20.0));
}

TEST(UsefulBounds, EndWhereABodyFliesAway) {
  const Bounds useful = useful_bounds(bounds_of(0.0, 1.0), bounds_of(-1e6, 3.0), 1.0);
  EXPECT_GT(useful.low.x(), -10.0);
  EXPECT_EQ(useful.high, Vec3::Constant(3.0));
}

TEST(PlaceCamera, WarnsOfAnEyeThatSeesNoBodyOrIsInOne) {
  const auto notice = [](const std::string& eye, const std::string& target) {
    const std::string camera = "camera = {eye = " + eye + ", target = " + target + "}\n";
    return camera_of(scenes::parse_scene(camera + falling_ball, "x.toml")).notice;
  };
  EXPECT_EQ(notice("[0, -9, 6]", "[0, 0, 6]"), "");
  EXPECT_NE(notice("[0, -9, 6]", "[0, -19, 6]").find("sees no body"), std::string::npos);
  EXPECT_NE(notice("[0, 0, 6]", "[0, 5, 6]").find("inside body 'body1'"), std::string::npos);
}

}  // namespace
}  // namespace pneuma::app
