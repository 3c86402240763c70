#include "app/manual/command_model.h"

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <sstream>

namespace pneuma::app {
namespace {

/// CLI11 writes a value's type as NAME:CHECK, and a check against a list as {one,other}.
std::vector<std::string> choices_in(const std::string& type) {
  std::vector<std::string> choices;
  const std::size_t open = type.find('{'), close = type.find('}');
  if (open == std::string::npos || close == std::string::npos) return choices;
  std::istringstream list(type.substr(open + 1, close - open - 1));
  for (std::string choice; std::getline(list, choice, ',');) choices.push_back(choice);
  return choices;
}

OptionModel option_model(const CLI::Option& option) {
  OptionModel model;
  const std::string type = option.get_type_name();
  if (option.get_items_expected_max() > 0) model.value = type.substr(0, type.find(':'));
  model.choices = choices_in(type);
  model.description = option.get_description();
  model.repeated = option.get_items_expected_max() > 1;
  if (option.get_positional()) {
    model.names = {option.get_single_name()};
    return model;
  }
  for (const std::string& name : option.get_snames()) model.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) model.names.push_back("--" + name);
  return model;
}

std::vector<std::string> examples_in(const std::string& footer) {
  std::vector<std::string> examples;
  std::istringstream lines(footer);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("  ")) examples.push_back(line.substr(2));
  }
  return examples;
}

CommandModel model_below(const CLI::App& command, std::vector<std::string> path) {
  CommandModel model;
  model.path = std::move(path);
  model.description = command.get_description();
  for (const CLI::Option* option : command.get_options()) {
    auto& list = option->get_positional() ? model.positionals : model.options;
    list.push_back(option_model(*option));
  }
  model.examples = examples_in(command.get_footer());
  for (const CLI::App* below : command.get_subcommands({})) {
    auto path_below = model.path;
    path_below.push_back(below->get_name());
    model.commands.push_back(model_below(*below, std::move(path_below)));
  }
  return model;
}

}  // namespace

CommandModel command_model(const CLI::App& cli) { return model_below(cli, {}); }

std::vector<const CommandModel*> flattened(const CommandModel& command) {
  std::vector<const CommandModel*> all = {&command};
  for (const CommandModel& below : command.commands) {
    for (const CommandModel* each : flattened(below)) all.push_back(each);
  }
  return all;
}

}  // namespace pneuma::app
