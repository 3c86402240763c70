// The scene files of the project.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>

#include "scenes/loader/load_scene.h"
#include "tests/support/paths.h"

namespace pneuma::scenes {
namespace {

const std::filesystem::path folder = project_folder() / "scenes";

const std::set<std::string> not_of_the_paper = {
    "balloons_and_valve", "bouncing_castle", "tied_balls", "bowl",  "compactor",
    "held_balloon",       "model",           "pins",       "press", "twisted_torus"};

TEST(SceneFiles, AllLoadAndSayWhatTheyAre) {
  const std::vector<SceneInfo> scenes = list_scenes(folder);
  EXPECT_GE(scenes.size(), 4u);
  for (const SceneInfo& scene : scenes) {
    EXPECT_EQ(scene.error, "");
    EXPECT_FALSE(scene.title.empty()) << scene.name;
    EXPECT_EQ(scene.figure.empty(), not_of_the_paper.contains(scene.name)) << scene.name;
  }
  EXPECT_TRUE(std::is_sorted(scenes.begin(), scenes.end(),
                             [](const auto& a, const auto& b) { return a.name < b.name; }));
}

TEST(SceneFiles, Figure64IsThePapers) {
  const Scene firm = load_scene(folder / "pressure_firm.toml");
  const Scene soft = load_scene(folder / "pressure_soft.toml");
  EXPECT_EQ(firm.name, "pressure_firm");
  EXPECT_EQ(firm.bodies.at(0).material.n, 100.0);
  EXPECT_EQ(firm.bodies.at(0).material.k, 150.0);
  EXPECT_EQ(soft.bodies.at(0).material.n, 1.0);
  EXPECT_EQ(soft.bodies.at(0).material.k, 10.0);
  for (const Scene* scene : {&firm, &soft}) {
    EXPECT_EQ(scene->bodies.at(0).shape, Shape::sphere);
    EXPECT_EQ(vertex_count(scene->bodies.at(0)), 58);  // 8 stacks x 8 slices
    EXPECT_TRUE(scene->settings.ground);
  }
}

TEST(SceneFiles, AFolderIsListedWithTheBrokenOnesSaidToBe) {
  const std::filesystem::path scratch =
      std::filesystem::path(testing::TempDir()) / "pneuma_scene_list";
  std::filesystem::remove_all(scratch);
  std::filesystem::create_directories(scratch);
  std::ofstream(scratch / "b.toml") << "title = \"B\"\nfigure = \"6.4\"\npaper_fps = 5\n[[body]]\n";
  std::ofstream(scratch / "a.toml") << "[[body]]\nk = -1\nn = -1\n";
  std::ofstream(scratch / "notes.txt") << "not a scene";
  const std::vector<SceneInfo> scenes = list_scenes(scratch);
  std::filesystem::remove_all(scratch);
  ASSERT_EQ(scenes.size(), 2u);
  EXPECT_EQ(scenes[0].name, "a");
  EXPECT_NE(scenes[0].error.find("a.toml:2:5: k = -1"), std::string::npos) << scenes[0].error;
  EXPECT_EQ(scenes[1].name, "b");
  EXPECT_EQ(scenes[1].title, "B");
  EXPECT_EQ(scenes[1].figure, "6.4");
  EXPECT_EQ(scenes[1].paper_fps, 5.0);
  EXPECT_EQ(scenes[1].error, "");
  EXPECT_THROW(list_scenes(scratch / "absent"), SceneError);
}

}  // namespace
}  // namespace pneuma::scenes
