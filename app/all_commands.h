// The whole command line of the program.
#pragma once

#include <span>
#include <string>

#include "app/terminal/command.h"

namespace pneuma::app {

/// Adds every command, with what holds for all of them. The rest is as in command.h.
void add_all_commands(CLI::App& cli, Action& action, std::span<const std::string> command_line);

}  // namespace pneuma::app
