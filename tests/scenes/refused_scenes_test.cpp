// Each of the broken scenes is refused at its place. tests/app/check/refused_scenes_test.cpp has
// the program do it.
#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

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

/// Nothing of a file reaches the terminal that it might obey, and not much.
TEST(BrokenScenes, AreShownShortAndWithoutControlCharacters) {
  const auto said = [](const std::string& text) {
    try {
      parse_scene(text, "broken.toml");
    } catch (const SceneError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const std::string wild = "\x1b[2J\xc2\x9b\x9b\xff";
  EXPECT_NE(said("# k\xc3\xa4se" + wild + "\nk = 1").find("| # k\xc3\xa4se?[2J????"),
            std::string::npos)
      << said("# k\xc3\xa4se" + wild + "\nk = 1");
  EXPECT_LT(said("k = " + std::string(100'000, '\x80')).size(), 400u);
  const std::string binary = said(std::string("\x89PNG\0\0\0", 7) + std::string(10'000, '\xf5'));
  EXPECT_EQ(binary.find('|'), std::string::npos) << binary << ": no line of a picture";
  EXPECT_LT(binary.size(), 200u);
  for (const std::string& text : std::vector<std::string>{wild + "k = 1", "k = \"\\u009b\"",
                                                          "[[body]]\nshape = \"\\u009b\""}) {
    const std::string words = said(text);
    EXPECT_NE(words, "");
    EXPECT_EQ(words.find_first_of("\x1b\x9b\xff"), std::string::npos) << words;
  }
}

}  // namespace
}  // namespace pneuma::scenes
