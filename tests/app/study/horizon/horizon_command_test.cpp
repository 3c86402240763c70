// pneuma study horizons from the outside.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/support/run_pneuma.h"
#include "tests/support/temporary_folder.h"

namespace pneuma {
namespace {

TEST(StudyHorizons, WritesTableDiagramAndJson) {
  const TemporaryFolder folder;
  const ProgramResult result =
      run_pneuma("study horizons one_sphere two_spheres_contact --short --quiet --out '" +
                 folder.path().string() + "'");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_NE(result.output.find("two_spheres_contact"), std::string::npos);
  const auto json = nlohmann::json::parse(read_text(folder / "horizons.json"));
  ASSERT_EQ(json["scenes"].size(), 2U);
  EXPECT_EQ(json["scenes"][0]["scene"], "one_sphere");
  EXPECT_EQ(json["scenes"][0]["start"], 1e-9);
  EXPECT_TRUE(std::filesystem::exists(folder / "horizons.gp"));
  // A heading and fifteen looks at each scene.
  const std::string csv = read_text(folder / "horizons.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 31);
}

TEST(StudyHorizons, OfAShortOneTakeWhatIsTyped) {
  const TemporaryFolder folder;
  const ProgramResult result =
      run_pneuma("study horizons one_sphere --short --seconds 2 --quiet --out '" +
                 folder.path().string() + "'");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(nlohmann::json::parse(read_text(folder / "horizons.json"))["scenes"][0]["seconds"], 2);
}

TEST(StudyHorizons, RefusesADifferenceThatIsNotSmall) {
  EXPECT_EQ(run_pneuma("study horizons one_sphere --difference 1 2>/dev/null").exit_code, 2);
}

}  // namespace
}  // namespace pneuma
