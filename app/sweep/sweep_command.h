// `pneuma sweep`: many runs from one description.
#pragma once

#include "app/terminal/command.h"

namespace pneuma::app {

void add_sweep_command(CLI::App& app, Action& action, std::span<const std::string> command_line);

}  // namespace pneuma::app
