#include "app/study/study_command.h"

#include <gtest/gtest.h>

#include "app/host/errors.h"
#include "app/study/study_options.h"
#include "tests/support/help_examples.h"
#include "tests/support/run_pneuma.h"

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

}  // namespace
}  // namespace pneuma
