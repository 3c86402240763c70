// The program with each of the broken scenes: exit code 3, the place on standard error, and nothing
// else anywhere.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/scenes/broken_scenes.h"
#include "tests/support/run_pneuma.h"
#include "tests/support/temporary_folder.h"

namespace pneuma {
namespace {

TEST(RefusedScenes, EndTheProgramWithTheirPlaceAndNothingElse) {
  const TemporaryFolder folder;
  const std::filesystem::path scene = folder / "broken.toml", errors = folder / "errors",
                              out = folder / "out";
  for (const scenes::BrokenScene& broken : scenes::broken_scenes()) {
    write_text(scene, broken.text);
    const std::string place = fmt::format("{}:{}:{}: ", scene.string(), broken.line, broken.column);
    // Not `bench`, which gives the picture's size itself.
    for (const std::string& arguments :
         {fmt::format("check --json '{}'", scene.string()),
          fmt::format("render '{}' --out '{}'", scene.string(), out.string())}) {
      const ProgramResult result = run_pneuma(fmt::format("{} 2>'{}'", arguments, errors.string()));
      EXPECT_EQ(result.exit_code, 3) << broken.name << ": " << arguments;
      EXPECT_EQ(result.output, "") << broken.name << ": " << arguments;
      const std::string said = read_text(errors);
      EXPECT_TRUE(said.starts_with(place)) << broken.name << ": " << place << " but " << said;
      for (const std::string& word : broken.words) {
        EXPECT_NE(said.find(word), std::string::npos) << broken.name << ": " << said;
      }
    }
    EXPECT_FALSE(std::filesystem::exists(out)) << broken.name;
  }
}

}  // namespace
}  // namespace pneuma
