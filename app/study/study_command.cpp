#include "app/study/study_command.h"

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

namespace pneuma::app {

void add_study_command(CLI::App& app, [[maybe_unused]] Action& action,
                       [[maybe_unused]] std::span<const std::string> command_line) {
  CLI::App* study = app.add_subcommand("study", "Measure what choices cost and what they gain");
  study->require_subcommand(1);
}

}  // namespace pneuma::app
