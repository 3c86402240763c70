// pneuma study error from the outside.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/host/find_program.h"
#include "tests/support/run_pneuma.h"
#include "tests/support/temporary_folder.h"

namespace pneuma {
namespace {

namespace fs = std::filesystem;

int exit_code(const std::string& arguments) {
  const TemporaryFolder folder;
  return run_pneuma("study error " + arguments + " --out '" + folder.path().string() +
                    "' >/dev/null 2>&1")
      .exit_code;
}

TEST(StudyError, WritesTablesDiagramsAndJson) {
  const TemporaryFolder folder;
  const ProgramResult result = run_pneuma(
      "study error one_sphere --short --free-flight --seconds 0.2 --json --quiet --out '" +
      folder.path().string() + "'");
  EXPECT_EQ(result.exit_code, 0);
  const auto printed = nlohmann::json::parse(result.output);
  EXPECT_EQ(printed["scenes"][0]["scene"], "one_sphere");
  EXPECT_EQ(printed["scenes"][0]["contacts"], false);
  EXPECT_NE(printed["command"].get<std::string>().find("--free-flight"), std::string::npos);
  EXPECT_EQ(nlohmann::json::parse(read_text(folder / "error.json")), printed);
  for (const char* ending : {"_runs.csv", "_ratios.csv", "_work.gp", "_step.gp"}) {
    EXPECT_TRUE(fs::exists(folder / (std::string("one_sphere") + ending))) << ending;
  }
  if (app::find_program("gnuplot")) {
    EXPECT_TRUE(fs::exists(folder / "one_sphere_work.png"));
    EXPECT_TRUE(fs::exists(folder / "one_sphere_work.svg"));
  }
}

TEST(StudyError, TakesOneBodyOfAScene) {
  const TemporaryFolder folder;
  const ProgramResult result = run_pneuma(
      "study error cat_on_sphere --body sphere --free-flight --short --seconds 0.2 --quiet --out "
      "'" +
      folder.path().string() + "'");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_TRUE(result.output.starts_with("cat_on_sphere_sphere: "));
  EXPECT_TRUE(fs::exists(folder / "cat_on_sphere_sphere_runs.csv"));
}

TEST(StudyError, RunsOnlyTheIntegratorsAndStepsThatAreNamed) {
  const TemporaryFolder folder;
  const ProgramResult result = run_pneuma(
      "study error one_sphere --free-flight --seconds 0.1 --repeats 1 --integrators rk4 martin "
      "--steps 120 60 120 --json --quiet --out '" +
      folder.path().string() + "'");
  EXPECT_EQ(result.exit_code, 0);
  const auto printed = nlohmann::json::parse(result.output);
  std::vector<std::string> runs;
  for (const auto& run : printed["scenes"][0]["runs"]) {
    runs.push_back(run["method"].get<std::string>() + " " +
                   std::to_string(run["steps_per_second"].get<int>()));
  }
  EXPECT_EQ(runs, (std::vector<std::string>{"martin 60", "martin 120", "rk4 60", "rk4 120"}));
}

TEST(StudyError, RefusesWhatItDoesNotUnderstand) {
  EXPECT_EQ(run_pneuma("study 2>&1").exit_code, 2);
  EXPECT_EQ(run_pneuma("study no_such_study 2>&1").exit_code, 2);
  EXPECT_EQ(exit_code(""), 2);
  EXPECT_EQ(exit_code("one_sphere --seconds 0"), 2);
  EXPECT_EQ(exit_code("one_sphere --repeats 0"), 2);
  EXPECT_EQ(exit_code("one_sphere --integrators euler"), 2);
  EXPECT_EQ(exit_code("one_sphere --steps 100"), 2);  // no multiple of 15
  EXPECT_EQ(exit_code("one_sphere --body no_such_body"), 2);
  EXPECT_EQ(exit_code("one_sphere --set body.damping=literal"), 2);
  EXPECT_EQ(exit_code("no_such_scene"), 3);
  EXPECT_EQ(exit_code("one_sphere --set body.k=-1"), 3);
}

TEST(StudyError, EndsWith5WhereThereIsNoMotionToCompareWithAndStudiesTheOthers) {
  // In the ground from the start, with springs that no step studied can follow.
  const TemporaryFolder folder;
  write_text(folder / "stiff.toml",
             "duration = 1.0\nsimulation.contact = \"impulses\"\n"
             "[[body]]\nk = 1e12\nk_max = 1e15\nposition = [0, 0, 2]\n");
  const ProgramResult result = run_pneuma("study error '" + (folder / "stiff.toml").string() +
                                          "' one_sphere --short --seconds 0.2 --quiet --out '" +
                                          folder.path().string() + "' 2>&1");
  EXPECT_EQ(result.exit_code, 5);
  EXPECT_NE(result.output.find("Warning: stiff is missing"), std::string::npos);
  EXPECT_TRUE(fs::exists(folder / "one_sphere_runs.csv"));
  EXPECT_EQ(nlohmann::json::parse(read_text(folder / "error.json"))["scenes"].size(), 1u);
}

TEST(StudyError, EndsWith6WhereNothingCanBeWritten) {
  const ProgramResult result = run_pneuma("study error one_sphere --short --out /dev/null/x 2>&1");
  EXPECT_EQ(result.exit_code, 6);
}

}  // namespace
}  // namespace pneuma
