// pneuma study contacts from the outside.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/support/run_pneuma.h"
#include "tests/support/temporary_folder.h"

namespace pneuma {
namespace {

TEST(StudyContacts, WritesTablesDiagramAndJson) {
  const TemporaryFolder folder;
  const ProgramResult result =
      run_pneuma("study contacts one_sphere --seconds 1.2 --short --json --quiet --out '" +
                 folder.path().string() + "'");
  EXPECT_EQ(result.exit_code, 0);
  const auto json = nlohmann::json::parse(result.output);
  EXPECT_EQ(json["scenes"][0]["scene"], "one_sphere");
  EXPECT_GT(json["scenes"][0]["seconds_compared"], json["scenes"][0]["first_contact_s"]);
  EXPECT_EQ(json["scenes"][0]["forms"].size(), 4U);
  EXPECT_EQ(json["scenes"][0]["choices"].size(), 4U);
  EXPECT_EQ(nlohmann::json::parse(read_text(folder / "contacts.json")), json);
  EXPECT_TRUE(std::filesystem::exists(folder / "one_sphere_contacts.csv"));
  EXPECT_TRUE(std::filesystem::exists(folder / "one_sphere_contacts.gp"));
}

TEST(StudyContacts, RefusesTheMethodThatItCompares) {
  EXPECT_EQ(
      run_pneuma("study contacts one_sphere --set simulation.method=paper 2>/dev/null").exit_code,
      2);
}

}  // namespace
}  // namespace pneuma
