// Each of the broken scenes is refused at its place. tests/app/check/refused_scenes_test.cpp has
// the program do it.
#include <gtest/gtest.h>

#include <set>

#include "scenes/loader/load_scene.h"
#include "tests/scenes/broken_scenes.h"

namespace pneuma::scenes {
namespace {

class RefusedScene : public testing::TestWithParam<BrokenScene> {};

TEST_P(RefusedScene, IsRefusedAtThePlaceWithAMessageThatHelps) {
  const BrokenScene& broken = GetParam();
  try {
    parse_scene(broken.text, "broken.toml");
    FAIL() << "was accepted:\n" << broken.text;
  } catch (const SceneError& error) {
    ASSERT_EQ(error.diagnostics().size(), 1u) << error.what();
    const Diagnostic& diagnostic = error.diagnostics().front();
    EXPECT_EQ(diagnostic.file, "broken.toml");
    EXPECT_EQ(diagnostic.line, broken.line) << error.what();
    EXPECT_EQ(diagnostic.column, broken.column) << error.what();
    EXPECT_GT(diagnostic.message.size(), 10u);
    for (const std::string& word : broken.words) {
      EXPECT_NE(diagnostic.message.find(word), std::string::npos)
          << "'" << word << "' is not in: " << diagnostic.message;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(BrokenScenes, RefusedScene, testing::ValuesIn(broken_scenes()),
                         [](const auto& broken) { return broken.param.name; });

TEST(BrokenScenes, AreFortyAndMoreAndAllDifferent) {
  std::set<std::string> texts;
  for (const BrokenScene& broken : broken_scenes()) texts.insert(broken.text);
  EXPECT_EQ(texts.size(), broken_scenes().size());
  EXPECT_GE(texts.size(), 40u);
}

}  // namespace
}  // namespace pneuma::scenes
