// Scenes with more than one thing wrong.
#include <gtest/gtest.h>

#include "scenes/load_scene.h"

namespace pneuma::scenes {
namespace {

TEST(SeveralErrors, AllErrorsOfAFileAreReportedAtOnceInItsOrder) {
  const std::string text =
      "titel = \"x\"\n"
      "[picture]\n"
      "width = 5\n"
      "[[body]]\n"
      "kind = \"rigid\"\n"
      "k = 3\n"
      "size = [1, 2]\n";
  try {
    parse_scene(text, "many.toml");
    FAIL();
  } catch (const SceneError& error) {
    std::vector<int> lines;
    for (const Diagnostic& diagnostic : error.diagnostics()) lines.push_back(diagnostic.line);
    EXPECT_EQ(lines, (std::vector<int>{1, 3, 6, 7})) << error.what();
    EXPECT_EQ(std::string(error.what()).rfind("many.toml:1:1: unknown key 'titel'", 0), 0u);
  }
}

TEST(SeveralErrors, ARefusedValueCausesNoErrorsElsewhere) {
  // With the default 60 steps in place of the refused ones, 25 frames a second would not fit.
  const std::string text =
      "[simulation]\nsteps_per_second = -50\n[picture]\nframes_per_second = 25\n[[body]]\n";
  try {
    parse_scene(text, "x.toml");
    FAIL();
  } catch (const SceneError& error) {
    ASSERT_EQ(error.diagnostics().size(), 1u) << error.what();
    EXPECT_EQ(error.diagnostics()[0].line, 2);
  }
}

TEST(SeveralErrors, AFloodOfErrorsIsCutShort) {
  std::string text = "[[body]]\n";
  for (int i = 0; i < 1000; ++i) text.append("x").append(std::to_string(i)).append(" = 1\n");
  try {
    parse_scene(text, "x.toml");
    FAIL();
  } catch (const SceneError& error) {
    EXPECT_EQ(error.diagnostics().size(), 101u);
    EXPECT_EQ(error.diagnostics().back().message, "900 more errors are not shown");
  }
}

}  // namespace
}  // namespace pneuma::scenes
