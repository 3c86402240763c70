#include "scenes/loader/tables.h"

#include <gtest/gtest.h>

#include "scenes/loader/sections.h"

namespace pneuma::scenes {
namespace {

void expect_hint(const std::string& name, const std::string& header) {
  const std::string hint = table_suggestion(name);
  EXPECT_TRUE(hint.starts_with("; did you mean " + header + "? tables: ")) << name << hint;
}

TEST(Tables, AHeaderOfAnotherNameGetsTheOneThatIsMeant) {
  expect_hint("bodies", "[[body]]");
  expect_hint("Body", "[[body]]");
  expect_hint("boddy", "[[body]]");
  expect_hint("body1", "[[body]]");
  expect_hint("simulations", "[simulation]");
  expect_hint("sim", "[simulation]");
  expect_hint("cam", "[camera]");
  expect_hint("cameras", "[camera]");
  expect_hint("particles", "[simulation.particles]");
  expect_hint("particle", "[simulation.particles]");
  expect_hint("limit", "[limits]");
  expect_hint("pictures", "[picture]");
  expect_hint("model", "[body.model]");
}

TEST(Tables, EveryTableIsNearestToItself) {
  for (const std::string_view name : {"simulation", "ground", "camera", "picture", "limits"}) {
    expect_hint(std::string(name), header_of(name));
  }
  expect_hint("body", "[[body]]");
}

TEST(Tables, AHeaderLikeNoneGetsAllThereAre) {
  for (const char* name : {"wavelengths", "x", "", "s", "wa"}) {
    const std::string hint = table_suggestion(name);
    EXPECT_TRUE(hint.starts_with("; tables: [simulation], [simulation.potential], ")) << hint;
    EXPECT_NE(hint.find(", [[body]]"), std::string::npos) << hint;
  }
}

TEST(Tables, EveryKeyIsInOneOfThem) {
  const std::vector<Section>& sections = default_sections();
  EXPECT_EQ(sections.front().table, "");
  EXPECT_EQ(sections.back().table, "body");
  Scene scene;
  EXPECT_EQ(sections.size(), fixed_sections(scene).size() + 3);
}

}  // namespace
}  // namespace pneuma::scenes
