#include "app/study/study_command.h"

#include <gtest/gtest.h>

#include "app/host/errors.h"
#include "app/study/study_options.h"
#include "tests/support/help_examples.h"
#include "tests/support/run_pneuma.h"
#include "tests/support/temporary_folder.h"

namespace pneuma {
namespace {

TEST(StudyHelp, HasExamplesThatCanBeRead) {
  app::Action action;
  const auto make = [&](CLI::App& cli) { app::add_study_command(cli, action, {}); };
  CLI::App cli("", "pneuma");
  make(cli);
  expect_examples_that_can_be_read(make, cli);
}

TEST(Studies, RefuseThePapersMethodWhoseChoicesTheyVary) {
  const std::vector<std::string> paper = {"simulation.method=paper"};
  try {
    app::load_scenes({"one_sphere"}, paper);
    ADD_FAILURE() << "accepted";
  } catch (const app::UsageError& error) {
    const std::string message = error.what();
    EXPECT_TRUE(message.starts_with("one_sphere has simulation.method = \"paper\"")) << message;
  }
  EXPECT_EQ(app::load_scenes({"one_sphere"}, {"simulation.method=corrected"}).size(), 1u);
  for (const char* study : {"error", "stability", "collision"}) {
    const ProgramResult result = run_pneuma(std::string("study ") + study +
                                            " two_spheres_contact --set simulation.method=paper "
                                            "--out /nowhere/at/all 2>&1");
    EXPECT_EQ(result.exit_code, 2) << study << result.output;
  }
}

/// Files and diagrams of the quickest study, so that a study's own list of them is tried too.
TEST(Studies, ReplaceOnlyTheirOwnFilesAndOnlyWhenAsked) {
  const TemporaryFolder folder;
  const auto grow = [&](const std::string& options) {
    return run_pneuma("study growth --short --quiet --out '" + folder.path().string() + "' " +
                      options + " 2>&1");
  };
  write_text(folder / "notes.csv", "mine");
  ASSERT_EQ(grow("").exit_code, 0);
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    const std::string name = entry.path().filename().string();
    if (name == "notes.csv") continue;
    const TemporaryFolder other;
    write_text(other / name, "mine");
    const ProgramResult refused =
        run_pneuma("study growth --short --out '" + other.path().string() + "' 2>&1");
    EXPECT_EQ(refused.exit_code, 6) << refused.output;
    EXPECT_NE(refused.output.find(name + " is there already; replace it with --overwrite"),
              std::string::npos)
        << refused.output;
    EXPECT_EQ(read_text(other / name), "mine");
  }
  write_text(folder / "growth.csv", "old");
  ASSERT_EQ(grow("--overwrite").exit_code, 0);
  EXPECT_NE(read_text(folder / "growth.csv"), "old");
  EXPECT_EQ(read_text(folder / "notes.csv"), "mine");
}

}  // namespace
}  // namespace pneuma
