#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/host/exit_code_words.h"
#include "app/manual/write_manual.h"

namespace pneuma::app {
namespace {

/// As text: roff takes a backslash, a leading point or apostrophe and a hyphen for its own.
std::string roff(const std::string& text) {
  std::string result = text.starts_with('.') || text.starts_with('\'') ? "\\&" : "";
  for (const char c : text) {
    if (c == '\\') {
      result += "\\e";
    } else if (c == '-') {
      result += "\\-";
    } else {
      result += c;
    }
  }
  return result;
}

std::string command_name(const CommandModel& command) {
  return command.path.empty() ? "pneuma" : fmt::format("pneuma {}", fmt::join(command.path, " "));
}

std::string entry(const OptionModel& option, const std::string& name) {
  const std::string value =
      option.value.empty() ? "" : fmt::format(" \\fI{}\\fR", roff(option.value));
  return fmt::format(".TP\n\\fB{}\\fR{}\n{}\n", roff(name), value, roff(option.description));
}

std::string section(const CommandModel& command) {
  std::string text =
      fmt::format(".SS {}\n{}.\n", roff(command_name(command)), roff(command.description));
  for (const OptionModel& positional : command.positionals) {
    text += entry(positional, positional.names.front());
  }
  for (const OptionModel& option : command.options) {
    text += entry(option, fmt::format("{}", fmt::join(option.names, ", ")));
  }
  return text;
}

constexpr const char* after_exit_codes = R"(
Of a sweep: that of its first run that failed, after all of them are done.
.SH FILES
Scenes are found by name in ./scenes, in share/pneuma/scenes beside the program's folder, and in pneuma/scenes of the
XDG data folders; their models likewise in assets.
.SH ENVIRONMENT
.TP
\fBXDG_DATA_HOME\fR, \fBXDG_DATA_DIRS\fR
Where scenes and models are looked for.
.TP
\fBPNEUMA_GL\fR
With the value none, OpenGL is not used: for trying out what happens then.
)";

}  // namespace

std::string manual_page(const CommandModel& program, const std::string& version) {
  std::string text = fmt::format(
      ".TH PNEUMA 1 \"\" \"pneuma {}\" \"User Commands\"\n.SH NAME\npneuma \\- {}\n.SH SYNOPSIS\n"
      "\\fBpneuma\\fR \\fICOMMAND\\fR [\\fIOPTION\\fR]...\n.SH COMMANDS\n",
      version, roff(program.description));
  std::string examples = ".SH EXAMPLES\n";
  for (const CommandModel* command : flattened(program)) {
    text += section(*command);
    for (const std::string& example : command->examples) {
      examples += fmt::format(".EX\n{}\n.EE\n", roff(example));
    }
  }
  return text + fmt::format(".SH EXIT STATUS\n{}", exit_code_words) + after_exit_codes + examples;
}

}  // namespace pneuma::app
