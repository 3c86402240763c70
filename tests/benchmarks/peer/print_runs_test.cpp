#include "benchmarks/peer/print_runs.h"

#include <gtest/gtest.h>

#include <string>
#include <string_view>

namespace pneuma::benchmarks {
namespace {

bool contains(const std::string& text, std::string_view part) {
  return text.find(part) != std::string::npos;
}

TEST(PrintRuns, TheVerdictNamesWhatAPeerMisses) {
  const Quality ours{.inflation = 2.0};
  EXPECT_EQ(verdict({.inflation = 2.1, .end_speed = 0.01}, ours), "as ours");
  EXPECT_EQ(verdict({.inflation = 1.0, .end_speed = 0.5, .deepest = 0.3}, ours),
            "not our inflation, rest, depth");
}

TEST(PrintRuns, RowsHaveTheRatiosAndTheQualityOfAllSides) {
  PairedRun run;
  run.name = "a_scene";
  run.bullet_options.gas_fraction = 1.25;
  run.bullet.seconds_per_second = 60 * 9e-6;
  run.rk4.seconds_per_second = 60 * 3e-6;
  run.velocity_verlet.seconds_per_second = 60 * 6e-6;
  run.velocity_verlet.steps_per_second = 120;
  run.bullet.quality = {.inflation = 1.4, .deepest = 0.2345, .crossings = 17};
  const std::string text = runs_text({run});
  for (const char* part : {"a_scene", "3.00x", "1.50x", "6.00 (2 steps)", "0.2345", "17",
                           "not our inflation, depth", "gas 1.25"}) {
    EXPECT_TRUE(contains(text, part)) << part << "\n" << text;
  }
}

TEST(PrintRuns, ASearchSaysWhetherAnythingReaches) {
  SettingSearch search;
  search.tried = 12;
  search.nearest.push_back({{.gas_fraction = 0.5}, {.quality = {.inflation = 3.0}}});
  EXPECT_TRUE(contains(search_text("a_scene", search),
                       "a_scene: 12 of Bullet's settings tried, none simulates it as ours"));
  EXPECT_TRUE(contains(search_text("a_scene", search), "gas 0.5,"));
  search.reaching.push_back({{.gas_fraction = 0.75}, {}});
  EXPECT_TRUE(contains(search_text("a_scene", search), "the cheapest that simulate it as ours"));
  EXPECT_TRUE(contains(search_text("a_scene", search), "gas 0.75,"));
}

TEST(PrintRuns, NamesBothCompilersFlagsAndTheLibrary) {
  const std::string text = builds_text();
  EXPECT_TRUE(contains(text, "Ours: double precision"));
  EXPECT_TRUE(contains(text, "-O"));
  EXPECT_TRUE(contains(text, "libBulletSoftBody"));
}

}  // namespace
}  // namespace pneuma::benchmarks
