#include "app/world/may_start.h"

#include <gtest/gtest.h>

#include <vector>

#include "scenes/loader/load_scene.h"

namespace pneuma::app {
namespace {

const std::string two_balls =
    "[[body]]\nname = \"a\"\nradius = 1\nposition = [0, 0, 2]\n"
    "[[body]]\nname = \"b\"\nradius = 1\nposition = [3, 0, 2]\n";

scenes::Scene scene_of(const std::string& text) { return scenes::parse_scene(text, "two.toml"); }

TEST(MayStart, WithWhatTheSceneCanHave) {
  const std::vector<std::string> euler = {"simulation.integrator=implicit_euler"};
  EXPECT_TRUE(may_start_with(scene_of(two_balls), euler));
  EXPECT_FALSE(may_start_with(scene_of(two_balls + "pressure_weighting = \"valence\"\n"), euler));
}

TEST(MayStart, WithContactAsAPotential) {
  EXPECT_TRUE(may_use_potential(scene_of(two_balls), "sdirk2"));
  EXPECT_TRUE(may_use_potential(scene_of(two_balls), "rk4"));
  EXPECT_FALSE(may_use_potential(scene_of(two_balls + "damping = \"literal\"\n"), "rk4"));
  EXPECT_FALSE(may_use_potential(
      scene_of(two_balls + "[[spring]]\nfrom = \"a\"\nto = \"b\"\nk = 1\n"), "sdirk2"));
  EXPECT_FALSE(may_use_potential(
      scene_of(two_balls + "[[body]]\nradius = 1\nposition = [0, 0, 4]\n"), "sdirk2"))
      << "it touches the first one";
}

}  // namespace
}  // namespace pneuma::app
