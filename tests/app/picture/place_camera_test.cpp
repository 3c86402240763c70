#include "app/picture/place_camera.h"

#include <gtest/gtest.h>

#include <string>

#include "app/world/build_world.h"
#include "scenes/loader/load_scene.h"

namespace pneuma::app {
namespace {

scenes::Scene ball_seen_with(const std::string& camera) {
  return scenes::parse_scene("camera = {" + camera + "}\n" + R"(
[[body]]
radius = 1.0
position = [0.0, 0.0, 6.0]
)",
                             "x.toml");
}

render::Camera camera_at_start(const scenes::Scene& scene) {
  return placed_camera(scene, build_world(scene));
}

TEST(PlaceCamera, IsLeftToTheProgramWithoutAPlaceAPathAndABody) {
  EXPECT_TRUE(is_left_to_program(ball_seen_with("orbit = 30").camera));
  EXPECT_TRUE(is_left_to_program(ball_seen_with("azimuth = 30").camera));
  EXPECT_FALSE(is_left_to_program(ball_seen_with("eye = [0, -9, 6], target = [0, 0, 6]").camera));
  EXPECT_FALSE(is_left_to_program(ball_seen_with("follow = \"body1\"").camera));
  EXPECT_FALSE(is_left_to_program(ball_seen_with("path = [[0, 0, -9, 6, 0, 0, 6]]").camera));
}

TEST(PlaceCamera, TakesTheScenesOwn) {
  const render::Camera camera =
      camera_at_start(ball_seen_with("eye = [1, 2, 3], target = [4, 5, 6], field_of_view = 50"));
  EXPECT_EQ(camera.eye, render::Vec3f(1.0f, 2.0f, 3.0f));
  EXPECT_EQ(camera.target, render::Vec3f(4.0f, 5.0f, 6.0f));
  EXPECT_EQ(camera.field_of_view, 50.0f);
  const char* path = "path = [[1, 0, -9, 6, 0, 0, 6], [2, 9, 0, 6, 0, 0, 5]]";
  EXPECT_EQ(camera_at_start(ball_seen_with(path)).eye, render::Vec3f(0, -9, 6));
}

TEST(PlaceCamera, WarnsOfAnEyeThatSeesNoBodyOrIsInOne) {
  const auto missed = [](const std::string& eye, const std::string& target) {
    const scenes::Scene scene = ball_seen_with("eye = " + eye + ", target = " + target);
    return what_camera_misses(scene, build_world(scene));
  };
  EXPECT_EQ(missed("[0, -9, 6]", "[0, 0, 6]"), "");
  EXPECT_NE(missed("[0, -9, 6]", "[0, -19, 6]").find("sees no body"), std::string::npos);
  EXPECT_NE(missed("[0, 0, 6]", "[0, 5, 6]").find("inside body 'body1'"), std::string::npos);
}

}  // namespace
}  // namespace pneuma::app
