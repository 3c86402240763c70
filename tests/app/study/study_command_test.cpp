#include "app/study/study_command.h"

#include <gtest/gtest.h>

#include "tests/support/help_examples.h"

namespace pneuma {
namespace {

TEST(StudyHelp, HasExamplesThatCanBeRead) {
  app::Action action;
  const auto make = [&](CLI::App& cli) { app::add_study_command(cli, action, {}); };
  CLI::App cli("", "pneuma");
  make(cli);
  expect_examples_that_can_be_read(make, cli);
}

}  // namespace
}  // namespace pneuma
