#include "app/world/smallest_box.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "app/world/open_scene.h"
#include "tests/support/temporary_folder.h"

namespace pneuma::app {
namespace {

/// A cube of 2 m, and a plate of `size` m across.
std::string boxes(const std::string& kind, double size, double gravity,
                  const std::string& simulation = "") {
  return fmt::format(
      "[simulation]\ngravity = [0, 0, {}]\n{}"
      "[[body]]\nname = \"large\"\nkind = \"rigid\"\nsize = [2, 2, 2]\nposition = [0, 0, 5]\n"
      "[[body]]\nname = \"plate\"\nkind = \"{}\"\nsize = [{}, {}, {}]\nposition = [0, 0, 1]\n",
      gravity, simulation, kind, 4.0 * size, size, 0.25 * size);
}

class SmallBoxes : public testing::Test {
 protected:
  scenes::Scene open(const std::string& text) {
    write_text(folder_ / "it.toml", text);
    return open_scene((folder_ / "it.toml").string(), {});
  }
  int steps(const std::string& text) { return open(text).settings.steps_per_second; }

 private:
  TemporaryFolder folder_;
};

/// One of 1 cm falls by 0.3 of its size in a step that does for one of 1 m.
TEST_F(SmallBoxes, TakeShorterSteps) {
  const scenes::Scene small = open(boxes("rigid", 0.01, -9.81));
  // It falls by 1 cm in 0.0452 s: six steps, in a multiple of 60 a second.
  EXPECT_EQ(small.settings.steps_per_second, 180);
  ASSERT_EQ(small.warnings.size(), 1u);
  EXPECT_NE(small.warnings[0].find("it.toml:8:1: note: body 'plate': 180 steps per second in place "
                                   "of 60, because it falls by its 0.01 m across in 0.0452 s"),
            std::string::npos)
      << small.warnings[0];
  EXPECT_EQ(steps(boxes("rigid", 0.1, -98.1)), 180);
  EXPECT_GT(steps(boxes("rigid", 1e-7, -9.81)), 1'900);
  EXPECT_LE(steps(boxes("rigid", 1e-7, -9.81)), 2'060);
}

TEST_F(SmallBoxes, LeaveOtherStepsAsTheyAre) {
  EXPECT_EQ(steps(boxes("rigid", 0.1, -9.81)), 60);
  EXPECT_EQ(steps(boxes("rigid", 0.01, 0.0)), 60);
  EXPECT_EQ(steps(boxes("static", 0.01, -9.81)), 60);
  EXPECT_EQ(steps(boxes("rigid", 0.01, -9.81, "steps_per_second = 60\n")), 60);
}

}  // namespace
}  // namespace pneuma::app
