#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "app/manual/write_manual.h"

namespace pneuma::app {
namespace {

// Printed by the program itself, so that scenes that were added later are among them; without
// names that a shell would expand, as bash's compgen does with its words once more.
constexpr const char* print_scenes =
    R"~(pneuma list --json 2>/dev/null | sed -n 's/.*"scene": "\([A-Za-z0-9_.-]*\)".*/\1/p')~";

constexpr const char* print_sweeps =
    R"~(pneuma list --sweeps 2>/dev/null | sed -n 's/^\([A-Za-z0-9_.-]*\)$/\1/p')~";

enum class Value { none, choice, folder, file, scene, sweep, other };

Value kind_of(const OptionModel& option) {
  if (option.value.empty()) return Value::none;
  if (!option.choices.empty()) return Value::choice;
  if (option.value == "DIR") return Value::folder;
  if (option.value == "FILE") return Value::file;
  if (option.value.starts_with("SCENE")) return Value::scene;
  if (option.value == "SWEEP") return Value::sweep;
  return Value::other;
}

/// Its words, each with a space before it: "", " render", " study error".
std::string key(const CommandModel& command) {
  std::string text;
  for (const std::string& word : command.path) text += " " + word;
  return text;
}

std::vector<std::string> names_below(const CommandModel& command) {
  std::vector<std::string> names;
  for (const CommandModel& below : command.commands) names.push_back(below.path.back());
  return names;
}

/// What bash's compgen offers for a value.
std::string bash_offer(const OptionModel& option) {
  switch (kind_of(option)) {
    case Value::choice:
      return fmt::format("-W '{}'", fmt::join(option.choices, " "));
    case Value::folder:
      return "-d";
    case Value::file:
      return "-f";
    case Value::scene:
      return fmt::format("-f -W \"$({})\"", print_scenes);
    case Value::sweep:
      return fmt::format("-f -W \"$({})\"", print_sweeps);
    case Value::none:
    case Value::other:
      break;
  }
  return "-W ''";
}

/// What stands between the apostrophes of a shell's word.
std::string quoted(const std::string& text, const std::string& apostrophe) {
  std::string result;
  for (const char c : text) result += c == '\'' ? apostrophe : std::string(1, c);
  return result;
}

/// zsh's _arguments takes brackets and colons for its own.
std::string zsh_text(const std::string& text) {
  std::string result;
  for (const char c : quoted(text, "'\\''")) {
    if (c == '[' || c == ']' || c == ':' || c == '\\') result += '\\';
    result += c;
  }
  return result;
}

std::string zsh_action(const OptionModel& option) {
  switch (kind_of(option)) {
    case Value::choice:
      return fmt::format("({})", fmt::join(option.choices, " "));
    case Value::folder:
      return "_files -/";
    case Value::file:
      return "_files";
    case Value::scene:
      return "_pneuma_scenes";
    case Value::sweep:
      return "_pneuma_sweeps";
    case Value::none:
    case Value::other:
      break;
  }
  return " ";
}

std::string zsh_function(const CommandModel& command) {
  std::string name = "_pneuma";
  for (const std::string& word : command.path) name += "_" + word;
  return name;
}

std::string zsh_body(const CommandModel& command) {
  std::string text = fmt::format(
      "{}() {{\n  local curcontext=$curcontext context state line\n  local -A opt_args\n  "
      "_arguments -C",
      zsh_function(command));
  for (const OptionModel& option : command.options) {
    const std::string value =
        option.value.empty() ? ""
                             : fmt::format(":{}:{}", zsh_text(option.value), zsh_action(option));
    for (const std::string& name : option.names) {
      text += fmt::format(" \\\n    '{}{}[{}]{}'", option.repeated ? "*" : "", name,
                          zsh_text(option.description), value);
    }
  }
  for (const OptionModel& positional : command.positionals) {
    text += fmt::format(" \\\n    '{}:{}:{}'", positional.repeated ? "*" : "1",
                        zsh_text(positional.value), zsh_action(positional));
  }
  if (command.commands.empty()) return text + "\n}\n";
  text += fmt::format(" \\\n    '1:command:({})' '*::argument:->below'\n  case $line[1] in\n",
                      fmt::join(names_below(command), " "));
  for (const CommandModel& below : command.commands) {
    text += fmt::format("    {}) {} ;;\n", below.path.back(), zsh_function(below));
  }
  return text + "  esac\n}\n";
}

/// When fish offers what belongs to a command: its words are there, and none of a command below.
std::string fish_condition(const CommandModel& command) {
  std::string text;
  for (const std::string& word : command.path) {
    text += fmt::format("{}__fish_seen_subcommand_from {}", text.empty() ? "" : "; and ", word);
  }
  if (!command.commands.empty()) {
    text += fmt::format("{}not __fish_seen_subcommand_from {}", text.empty() ? "" : "; and ",
                        fmt::join(names_below(command), " "));
  }
  return text;
}

std::string fish_value(const OptionModel& option) {
  switch (kind_of(option)) {
    case Value::none:
      return "";
    case Value::choice:
      return fmt::format(" -x -a '{}'", fmt::join(option.choices, " "));
    case Value::folder:
      return " -x -a '(__fish_complete_directories)'";
    case Value::file:
      return " -r";
    case Value::scene:
      return fmt::format(" -a '({})'", quoted(print_scenes, "\\'"));
    case Value::sweep:
      return fmt::format(" -a '({})'", quoted(print_sweeps, "\\'"));
    case Value::other:
      break;
  }
  return " -x";
}

std::string fish_lines(const CommandModel& command) {
  const std::string begin = fmt::format("complete -c pneuma -n '{}'", fish_condition(command));
  std::string text;
  for (const CommandModel& below : command.commands) {
    text += fmt::format("{} -f -a {} -d '{}'\n", begin, below.path.back(),
                        quoted(below.description, "\\'"));
  }
  for (const OptionModel& option : command.options) {
    text += begin;
    for (const std::string& name : option.names) {
      text += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
    }
    text += fmt::format("{} -d '{}'\n", fish_value(option), quoted(option.description, "\\'"));
  }
  for (const OptionModel& positional : command.positionals) {
    text += begin + fish_value(positional) + "\n";
  }
  return text;
}

}  // namespace

std::string bash_completion(const CommandModel& program) {
  std::string commands, values, options, words;
  for (const CommandModel* command : flattened(program)) {
    if (!command->path.empty())
      commands += fmt::format("      '{0}') command='{0}' ;;\n", key(*command));
    std::vector<std::string> names;
    for (const OptionModel& option : command->options) {
      for (const std::string& name : option.names) {
        names.push_back(name);
        if (option.value.empty()) continue;
        values +=
            fmt::format("    '{} {}') offer=({}) ;;\n", key(*command), name, bash_offer(option));
      }
    }
    options += fmt::format("    '{}') offer=(-W '{}') ;;\n", key(*command), fmt::join(names, " "));
    std::string offer = fmt::format("-W '{}'", fmt::join(names_below(*command), " "));
    if (!command->positionals.empty()) offer = bash_offer(command->positionals.front());
    words += fmt::format("    '{}') offer=({}) ;;\n", key(*command), offer);
  }
  return fmt::format(R"(# bash completion of pneuma, written from its table of commands
_pneuma() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD - 1]}} command='' i
  local -a offer=()
  for ((i = 1; i < COMP_CWORD; i++)); do
    case "$command ${{COMP_WORDS[i]}}" in
{}    esac
  done
  case "$command $before" in
{}  esac
  if ((${{#offer[@]}} == 0)) && [[ $word == -* ]]; then
    case "$command" in
{}    esac
  elif ((${{#offer[@]}} == 0)); then
    case "$command" in
{}    esac
  fi
  # Only what may be a file: bash adds a slash to a command that is called like a folder.
  [[ ${{offer[0]}} == -[df] ]] && compopt -o filenames 2>/dev/null
  mapfile -t COMPREPLY < <(compgen "${{offer[@]}}" -- "$word")
}}
complete -F _pneuma pneuma
)",
                     commands, values, options, words);
}

std::string zsh_completion(const CommandModel& program) {
  std::string text = fmt::format(
      "#compdef pneuma\n# zsh completion of pneuma, written from its table of commands\n"
      "_pneuma_scenes() {{\n  compadd -- $({})\n  _files -g '*.toml'\n}}\n"
      "_pneuma_sweeps() {{\n  compadd -- $({})\n  _files -g '*.toml'\n}}\n",
      print_scenes, print_sweeps);
  for (const CommandModel* command : flattened(program)) text += zsh_body(*command);
  return text + "_pneuma \"$@\"\n";
}

std::string fish_completion(const CommandModel& program) {
  std::string text = "# fish completion of pneuma, written from its table of commands\n";
  for (const CommandModel* command : flattened(program)) text += fish_lines(*command);
  return text;
}

}  // namespace pneuma::app
