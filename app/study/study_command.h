// `pneuma study`: the measurements behind the project's conclusions. Each study has files of its
// own, and a function here that adds it below `study` and that add_study_command calls.
#pragma once

#include "app/terminal/command.h"

namespace pneuma::app {

/// Adds `study` with all studies below it. `command_line` is what the user typed, for the reports,
/// and must outlive the action.
void add_study_command(CLI::App& app, Action& action, std::span<const std::string> command_line);

void add_error_study(CLI::App& study_command, Action& action,
                     std::span<const std::string> command_line);
void add_accuracy_study(CLI::App& study, Action& action, std::span<const std::string> command_line);
void add_choices_study(CLI::App& study_command, Action& action,
                       std::span<const std::string> command_line);
void add_collision_study(CLI::App& study_command, Action& action,
                         std::span<const std::string> command_line);
void add_contact_study(CLI::App& study_command, Action& action,
                       std::span<const std::string> command_line);
void add_growth_study(CLI::App& study_command, Action& action,
                      std::span<const std::string> command_line);
void add_extreme_study(CLI::App& study_command, Action& action,
                       std::span<const std::string> command_line);
void add_horizon_study(CLI::App& study_command, Action& action,
                       std::span<const std::string> command_line);
void add_impact_study(CLI::App& study_command, Action& action,
                      std::span<const std::string> command_line);
void add_solvers_study(CLI::App& study, Action& action, std::span<const std::string> command_line);
void add_stability_study(CLI::App& study_command, Action& action,
                         std::span<const std::string> command_line);

}  // namespace pneuma::app
