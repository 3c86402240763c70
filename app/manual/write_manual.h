// Texts that are written from the table of commands.
#pragma once

#include <string>

#include "app/manual/command_model.h"

namespace pneuma::app {

/// pneuma(1) in the language of man(7).
std::string manual_page(const CommandModel& program, const std::string& version);

/// What the shells read to complete commands, options, choices, scenes and files.
std::string bash_completion(const CommandModel& program);
std::string zsh_completion(const CommandModel& program);
std::string fish_completion(const CommandModel& program);

}  // namespace pneuma::app
