#include "app/terminal/read_command_line.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <optional>
#include <string_view>

#include "app/host/errors.h"
#include "sim/base/nearest.h"

namespace pneuma::app {
namespace {

std::vector<std::string_view> views(const std::vector<std::string>& names) {
  return {names.begin(), names.end()};
}

std::vector<std::string> names_of_commands(const CLI::App& above) {
  std::vector<std::string> names;
  for (const CLI::App* command : above.get_subcommands({})) names.push_back(command->get_name());
  return names;
}

/// "pneuma study error".
std::string full_name(const CLI::App& command) {
  const CLI::App* above = command.get_parent();
  return above == nullptr ? command.get_name() : full_name(*above) + ' ' + command.get_name();
}

/// What is chosen with the next word: "command", "study".
std::string choice_in(const CLI::App& above) {
  return above.get_parent() == nullptr ? "command" : above.get_name();
}

/// How far the words name commands.
struct NamedCommand {
  const CLI::App* command = nullptr;
  std::optional<std::string> next_word;  // that names none; none when it is an option
};

NamedCommand named_command(const CLI::App& cli, const std::vector<std::string>& command_line) {
  const CLI::App* command = &cli;
  for (std::size_t i = 1; i < command_line.size(); ++i) {
    if (command_line[i].starts_with('-')) return {command, std::nullopt};
    const auto below = command->get_subcommands({});
    const auto named = std::ranges::find(below, command_line[i],
                                         [](const CLI::App* each) { return each->get_name(); });
    if (named == below.end()) return {command, command_line[i]};
    command = *named;
  }
  return {command, std::nullopt};
}

/// What to say of a word that should be a command and is none; empty where it is one.
std::string unknown_command_complaint(const NamedCommand& named) {
  const std::vector<std::string> names = names_of_commands(*named.command);
  if (names.empty() || !named.next_word) return "";
  return fmt::format("there is no {} {}{}", choice_in(*named.command),
                     base::in_quotes(*named.next_word),
                     base::suggestion_and_all(*named.next_word, views(names)));
}

std::string missing_command_complaint(const NamedCommand& named) {
  const std::vector<std::string> names = names_of_commands(*named.command);
  if (names.empty() || named.next_word) return "";
  return fmt::format("{} needs a {}; allowed: {}", full_name(*named.command),
                     choice_in(*named.command), fmt::join(names, ", "));
}

/// Full names of the commands below that have the option.
void add_commands_with(const CLI::App& above, const std::string& option,
                       std::vector<std::string>& names) {
  for (const CLI::App* command : above.get_subcommands({})) {
    if (command->get_option_no_throw(option) != nullptr) names.push_back(full_name(*command));
    add_commands_with(*command, option, names);
  }
}

/// "; pneuma check has it", for an option that belongs to few commands, none of them this one.
std::string where_it_belongs(const CLI::App& command, const std::string& option) {
  const CLI::App* root = &command;
  while (root->get_parent() != nullptr) root = root->get_parent();
  constexpr std::size_t most_named = 3;
  std::vector<std::string> names;
  add_commands_with(*root, option, names);
  if (names.empty() || names.size() > most_named) return "";
  return fmt::format("; {} {} it", fmt::join(names, " and "), names.size() == 1 ? "has" : "have");
}

std::string unknown_option_complaint(const CLI::App& command, const std::string& typed) {
  const std::string name = typed.substr(0, typed.find('='));
  std::vector<std::string> known;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& long_name : option->get_lnames()) known.push_back("--" + long_name);
  }
  return fmt::format("{} has no option {}{}{}", full_name(command), base::in_quotes(name),
                     base::suggestion_and_all(name, views(known)), where_it_belongs(command, name));
}

/// What to say of words that the command takes no notice of; empty where there are none. After an
/// unknown option nobody knows which of the next words belong to it, so that it alone is named. A
/// wrong value of an option is what the words may have been meant for: "--set duration 2".
std::string extra_words_complaint(const CLI::App& command, const std::string& wrong_value) {
  const std::vector<std::string> extra = command.remaining();
  const auto option =
      std::ranges::find_if(extra, [](const std::string& word) { return word.starts_with('-'); });
  if (option != extra.end()) return unknown_option_complaint(command, *option);
  if (extra.empty() || !wrong_value.empty()) return wrong_value;
  return fmt::format("{} does not expect: {}", full_name(command), fmt::join(extra, " "));
}

/// An empty value would be taken for an option that was left out.
std::string empty_value_complaint(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options()) {
    const std::vector<std::string>& values = option->results();
    if (std::ranges::find(values, "") == values.end()) continue;
    return fmt::format("{}: its value is empty; write one, or leave the option out",
                       option->get_name());
  }
  return "";
}

/// The first that there is, and where to read more.
void throw_complaint(const CLI::App& command, std::initializer_list<std::string> complaints) {
  const auto* complaint =
      std::ranges::find_if(complaints, [](const std::string& text) { return !text.empty(); });
  if (complaint == complaints.end()) return;
  throw UsageError(fmt::format("{}\n`{} --help` says more", *complaint, full_name(command)));
}

/// "pneuma help render" is "pneuma render --help".
std::vector<std::string> with_help_as_option(std::vector<std::string> command_line) {
  if (command_line.size() < 2 || command_line[1] != "help") return command_line;
  command_line.erase(command_line.begin() + 1);
  command_line.emplace_back("--help");
  return command_line;
}

}  // namespace

bool read_command_line(CLI::App& cli, const std::vector<std::string>& typed) {
  const std::vector<std::string> command_line = with_help_as_option(typed);
  const NamedCommand named = named_command(cli, command_line);
  if (command_line != typed) throw_complaint(*named.command, {unknown_command_complaint(named)});
  try {
    // CLI11 takes its words from the end of a vector.
    cli.parse(std::vector<std::string>(command_line.rbegin(), command_line.rend() - 1));
  } catch (const CLI::Success& asked) {
    cli.exit(asked);
    return false;
  } catch (const CLI::ParseError& error) {
    const bool is_of_value = dynamic_cast<const CLI::ValidationError*>(&error) != nullptr;
    throw_complaint(*named.command,
                    {unknown_command_complaint(named),
                     extra_words_complaint(*named.command, is_of_value ? error.what() : ""),
                     missing_command_complaint(named), error.what()});
  }
  throw_complaint(*named.command, {empty_value_complaint(*named.command)});
  return true;
}

}  // namespace pneuma::app
