#include "app/picture/choose_elevation.h"

#include <gtest/gtest.h>

#include "app/world/build_world.h"
#include "scenes/loader/load_scene.h"

namespace pneuma::app {
namespace {

double elevation(const std::string& text) {
  const scenes::Scene scene = scenes::parse_scene(text, "x.toml");
  return choose_elevation(scene, build_world(scene), scene.camera.orbit != 0.0);
}

/// Of walls that stand around what starts above them, 2 m apart.
std::string make_pit(double height) {
  const auto wall = [&](const char* size, const char* place) {
    return "[[body]]\nkind = \"static\"\nsize = [" + std::string(size) + ", " +
           std::to_string(height) + "]\nposition = [" + place + ", " +
           std::to_string(0.5 * height) + "]\n";
  };
  return wall("0.1, 2.2", "-1.0, 0") + wall("0.1, 2.2", "1.0, 0") + wall("1.89, 0.1", "0, -1.0") +
         wall("1.89, 0.1", "0, 1.0");
}

std::string make_ball(double height) {
  return "[[body]]\nradius = 0.2\nposition = [0, 0, " + std::to_string(height) + "]\n";
}

TEST(ChooseElevation, LooksOverWalls) {
  const double open = elevation(make_ball(3.0));
  const double low = elevation(make_pit(1.0) + make_ball(0.3));
  const double high = elevation(make_pit(2.0) + make_ball(0.3));
  EXPECT_EQ(open, 22.0);
  EXPECT_GT(low, open);
  EXPECT_GT(high, low);
  EXPECT_LE(high, 82.0);
  EXPECT_EQ(elevation(make_pit(7.0) + make_ball(0.3)), 82.0) << "of which the top alone is seen";
}

TEST(ChooseElevation, LooksOverAWallFromAllAroundWhereItGoesAround) {
  const std::string wall =
      "[[body]]\nkind = \"static\"\nsize = [8, 0.2, 4]\nposition = [0, 1, 2]\n" + make_ball(0.3);
  EXPECT_EQ(elevation(wall), 22.0) << "it stands behind the ball";
  EXPECT_GT(elevation("[camera]\norbit = 30\n" + wall), 40.0);
}

TEST(ChooseElevation, OfACameraThatFollowsIsTheUsual) {
  EXPECT_EQ(elevation("[camera]\nfollow = \"b\"\n[[body]]\nname = \"b\"\nposition = [9, 9, 2]\n" +
                      make_pit(2.0) + make_ball(0.3)),
            22.0);
}

/// It would fall into the pit.
TEST(ChooseElevation, LooksAtWhereBodiesFall) {
  EXPECT_EQ(elevation(make_pit(2.0) + make_ball(3.0)), elevation(make_pit(2.0) + make_ball(0.3)));
  EXPECT_EQ(elevation("[simulation]\ngravity = [0, 0, 0]\n" + make_pit(2.0) + make_ball(6.0)),
            22.0);
}

TEST(ChooseElevation, IsTheUsualWhereNothingHelpsOrHides) {
  const std::string lid =
      "[[body]]\nkind = \"static\"\nsize = [3, 3, 0.1]\nposition = [0, 0, 2.2]\n";
  EXPECT_EQ(elevation(make_pit(2.0) + lid + make_ball(0.3)), 22.0) << "a closed box";
  EXPECT_EQ(elevation(make_pit(2.0)), 22.0) << "nothing moves";
  std::string bars = make_pit(2.0) + make_ball(0.3);
  for (auto i = bars.find("kind"); i != std::string::npos; i = bars.find("kind", i + 20)) {
    bars.insert(i, "drawn = \"edges\"\n");
  }
  EXPECT_EQ(elevation(bars), 22.0);
  EXPECT_EQ(elevation(make_ball(1.0) + "[[body]]\nkind = \"static\"\nposition = [8, 8, 0.5]\n"),
            22.0);
}

TEST(ChooseElevation, IsTheScenesIfItGivesOne) {
  EXPECT_EQ(elevation("[camera]\nelevation = 5\n" + make_pit(2.0) + make_ball(0.3)), 5.0);
}

}  // namespace
}  // namespace pneuma::app
