// The commands and options of a command line as plain data, from which manual and completions are
// written.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace pneuma::app {

struct OptionModel {
  std::vector<std::string> names;  // "-h", "--help"; of a positional its name only
  std::string value;  // what stands for its value in text, as DIR; empty: it takes none
  std::vector<std::string> choices;  // all values that it takes, where they can be listed
  std::string description;
  bool repeated = false;
};

struct CommandModel {
  std::vector<std::string> path;  // {"study", "error"}; empty: the program itself
  std::string description;
  std::vector<OptionModel> options;
  std::vector<OptionModel> positionals;
  std::vector<std::string> examples;
  std::vector<CommandModel> commands;
};

CommandModel command_model(const CLI::App& cli);

/// The command and all below it, it first.
std::vector<const CommandModel*> flattened(const CommandModel& command);

}  // namespace pneuma::app
