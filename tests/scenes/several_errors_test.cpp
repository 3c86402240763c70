// Scenes with more than one thing wrong.
#include <gtest/gtest.h>

#include "scenes/loader/load_scene.h"
#include "scenes/loader/other_names.h"
#include "scenes/loader/print_scene.h"

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
  // With 60 steps in place of the refused ones, 25 frames a second would not fit.
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

TEST(SeveralErrors, AMassIsRefusedOnceWhateverItsBody) {
  for (const char* kind : {"soft", "rigid"}) {
    try {
      parse_scene(std::string("[[body]]\nkind = \"") + kind + "\"\nmass = -1\n", "x.toml");
      FAIL();
    } catch (const SceneError& error) {
      EXPECT_EQ(error.diagnostics().size(), 1u) << error.what();
    }
  }
}

TEST(SeveralErrors, AnUnknownKindCausesNoErrorsAboutKeysOfItsBody) {
  try {
    parse_scene("[[body]]\nkind = \"rigd\"\nsize = [2, 2, 2]\nmass = 3\nvelocty = 1\n", "x.toml");
    FAIL();
  } catch (const SceneError& error) {
    ASSERT_EQ(error.diagnostics().size(), 2u) << error.what();
    EXPECT_EQ(error.diagnostics()[0].line, 2);
    EXPECT_EQ(error.diagnostics()[1].line, 5);
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

std::string errors_of(const std::string& text) {
  try {
    parse_scene(text, "x.toml");
  } catch (const SceneError& error) {
    return error.what();
  }
  return "";
}

TEST(SourceLine, StandsBelowTheErrorWithACaretUnderTheColumn) {
  const std::string text = errors_of("[[body]]\n  raduis = 2.0  # \xc3\xa9\r\n\tk = -1\n");
  EXPECT_NE(text.find("\n    2 |   raduis = 2.0  # \xc3\xa9\n      |   ^\nx.toml:3:"),
            std::string::npos)
      << text;
  EXPECT_TRUE(text.ends_with("\n    3 | \tk = -1\n      | \t    ^")) << text;
}

TEST(SourceLine, IsCutAroundTheColumnWhenItIsLong) {
  const std::string text = errors_of("title = \"" + std::string(500, 'x') + "\" nonsense = 1\n");
  const std::string shown = text.substr(text.find('\n') + 1);
  EXPECT_TRUE(shown.starts_with("    1 | ...xxx")) << text;
  EXPECT_LT(shown.find('\n'), 120u) << text;
}

TEST(SourceLine, IsNotShownWhereNoLineIsToBlame) {
  EXPECT_EQ(errors_of("duration = 1.0\n"), "x.toml:1:1: a scene needs at least one [[body]]");
}

TEST(OtherNames, LeadToTheKeyThatIsMeant) {
  for (const OtherName& other : other_names()) {
    const std::string text = errors_of("[[body]]\n" + std::string(other.name) + " = 30\n");
    EXPECT_NE(text.find("; write " + std::string(other.key)), std::string::npos) << text;
    EXPECT_NE(text.find(other.remark), std::string::npos) << text;
    const std::string reference = scene_reference();
    const std::string key(other.key.substr(other.key.find('.') + 1));
    EXPECT_NE(reference.find("\n  " + key + " "), std::string::npos) << other.key;
  }
}

std::size_t count_errors(const std::string& text) {
  try {
    parse_scene(text, "x.toml");
  } catch (const SceneError& error) {
    return error.diagnostics().size();
  }
  return 0;
}

TEST(SeveralErrors, OneSlipIsOneError) {
  EXPECT_EQ(count_errors("[[bodies]]\nn = 1\n"), 1u);
  EXPECT_EQ(count_errors("[camera]\neye = [0, -9, 3]\ntargt = [0, 0, 3]\n[[body]]\n"), 1u);
  EXPECT_EQ(count_errors("[[body]]\nkind = \"rigid\"\nshape = \"sphere\"\n"), 1u);
  const std::string box = errors_of("[[body]]\nkind = \"rigid\"\nshape = \"sphere\"\nradius = 1\n");
  EXPECT_EQ(box.find("rigid sphere"), std::string::npos) << box;
}

TEST(SeveralErrors, ATableOfTheSceneBelowABodyIsToldToGoAbove) {
  const std::string camera =
      errors_of("[[body]]\ncamera = {eye = [0, -9, 3], target = [0, 0, 3]}\n");
  EXPECT_NE(camera.find("x.toml:2:1: unknown key 'camera'"), std::string::npos) << camera;
  EXPECT_NE(camera.find("above the first [[body]]"), std::string::npos) << camera;
}

TEST(SeveralErrors, AMissingBodyOfAnOverrideListsThoseThereAre) {
  const std::vector<std::string> overrides = {"box.k=200"};
  try {
    parse_scene("[[body]]\nname = \"ball\"\n[[body]]\n", "x.toml", overrides);
    FAIL();
  } catch (const SceneError& error) {
    EXPECT_NE(std::string(error.what()).find("bodies: ball, body2"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace pneuma::scenes
