// The commands that look at what `pneuma render` has left in folders.
#pragma once

#include "app/terminal/command.h"

namespace pneuma::app {

void add_plot_command(CLI::App& app, Action& action);
void add_compare_command(CLI::App& app, Action& action);

}  // namespace pneuma::app
