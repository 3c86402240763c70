// The words of the command line into the options of the commands.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace pneuma::app {

/// `command_line` begins with the program's own name. False when there is nothing left to do,
/// because help or the version were asked for and printed. Throws UsageError.
bool read_command_line(CLI::App& cli, const std::vector<std::string>& command_line);

}  // namespace pneuma::app
