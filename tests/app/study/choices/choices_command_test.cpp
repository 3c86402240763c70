// pneuma study choices from the outside, and its report.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/support/json_numbers.h"
#include "tests/support/run_pneuma.h"
#include "tests/support/temporary_folder.h"

namespace pneuma {
namespace {

namespace fs = std::filesystem;

ProgramResult study(const std::string& arguments, const TemporaryFolder& folder) {
  return run_pneuma("study choices " + arguments + " --short --quiet --out '" +
                    folder.path().string() + "'");
}

TEST(StudyChoices, PrintsTheThreeChoicesAndLeavesTheirFiles) {
  const TemporaryFolder folder;
  const ProgramResult result = study("", folder);
  EXPECT_EQ(result.exit_code, 0);
  for (const char* part : {"Pressure, uniform or valence", "Damping, dashpot or literal",
                           "The paper's integrator", "Machine: "}) {
    EXPECT_NE(result.output.find(part), std::string::npos) << part;
  }
  std::istringstream lines(result.output);
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("Program:") && !line.starts_with("Machine:")) {
      EXPECT_LE(line.size(), 120u) << line;
    }
  }
  for (const char* name :
       {"one_sphere_drift.csv", "one_sphere_damping.csv", "one_sphere_martin.csv",
        "one_sphere_drift.gp", "one_sphere_damping.gp", "choices.json"}) {
    EXPECT_TRUE(fs::exists(folder / name)) << name;
  }
  const auto json = nlohmann::json::parse(read_text(folder / "choices.json"))["choices"];
  EXPECT_EQ(json["drift"]["trials"], 5);
  EXPECT_LT(json["drift"]["uniform"]["distance_over_radius"]["max"], 1e-12);
  EXPECT_GT(json["drift"]["valence"]["distance_over_radius"]["min"], 1e-4);
  expect_nulls_only_at(json["damping"], {});
}

TEST(StudyChoices, MeasuresBothWhateverTheSceneChooses) {
  const TemporaryFolder folder;
  const ProgramResult result =
      study("--set body.damping=literal --set body.pressure_weighting=valence --json", folder);
  EXPECT_EQ(result.exit_code, 0);
  const auto json = nlohmann::json::parse(result.output)["choices"];
  EXPECT_LT(json["drift"]["uniform"]["distance_over_radius"]["max"], 1e-12);
}

TEST(StudyChoices, RefusesWhatItDoesNotUnderstand) {
  const TemporaryFolder folder;
  EXPECT_EQ(study("no_such_scene 2>/dev/null", folder).exit_code, 3);
  EXPECT_EQ(study("one_sphere one_torus 2>/dev/null", folder).exit_code, 2);
  EXPECT_EQ(study("--body nobody 2>/dev/null", folder).exit_code, 2);
}

}  // namespace
}  // namespace pneuma
