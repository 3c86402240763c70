#include "app/study/study_command.h"

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

namespace pneuma::app {

void add_study_command(CLI::App& app, Action& action, std::span<const std::string> command_line) {
  CLI::App* study = app.add_subcommand("study", "Measure what choices cost and what they gain");
  study->require_subcommand(1);
  add_error_study(*study, action, command_line);
  add_choices_study(*study, action, command_line);
  add_collision_study(*study, action, command_line);
  add_growth_study(*study, action, command_line);
  add_extreme_study(*study, action, command_line);
  add_stability_study(*study, action, command_line);
}

}  // namespace pneuma::app
