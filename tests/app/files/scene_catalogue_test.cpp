#include "app/files/scene_catalogue.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "app/host/build_info.h"
#include "scenes/loader/load_scene.h"

namespace pneuma::app {
namespace {

namespace fs = std::filesystem;

TEST(SceneCatalogue, HasEverySceneFile) {
  std::set<std::string> files, names;
  for (const auto& file : fs::directory_iterator(PNEUMA_SOURCE_FOLDER "/scenes")) {
    if (file.path().extension() == ".toml") files.insert(file.path().stem().string());
  }
  for (const CatalogueEntry& entry : scene_catalogue()) {
    names.insert(entry.name);
    EXPECT_EQ(entry.error, "") << entry.name;
    EXPECT_NE(entry.title, "") << entry.name;
  }
  EXPECT_FALSE(files.empty());
  EXPECT_TRUE(std::ranges::includes(names, files));
}

TEST(SceneCatalogue, PutsThePapersBenchmarkFirst) {
  std::vector<std::string> names;
  for (const fs::path& path : scenes_of_the_paper()) names.push_back(path.stem().string());
  ASSERT_GE(names.size(), 2u);
  EXPECT_EQ(names[0], "one_sphere");
  EXPECT_EQ(names[1], "one_torus");
  EXPECT_EQ(names.back(), "cat_on_sphere") << "the last figure";
  for (const fs::path& path : scenes_of_the_paper()) {
    EXPECT_TRUE(scenes::load_scene(path).paper_fps) << path;
  }
}

}  // namespace
}  // namespace pneuma::app
