// `pneuma study collision`: its options.
#pragma once

#include "app/command.h"

namespace pneuma::app {

void add_collision_study(CLI::App& study, Action& action,
                         std::span<const std::string> command_line);

}  // namespace pneuma::app
