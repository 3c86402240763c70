#include "app/host/command_line.h"

#include <string_view>

namespace pneuma::app {
namespace {

constexpr std::string_view needs_no_quotes =
    "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./,:=+@%";

std::string shell_quoted(const std::string& argument) {
  if (!argument.empty() && argument.find_first_not_of(needs_no_quotes) == std::string::npos) {
    return argument;
  }
  std::string quoted = "'";
  for (const char c : argument) {
    if (c == '\'') {
      quoted += "'\\''";
    } else {
      quoted += c;
    }
  }
  return quoted + "'";
}

}  // namespace

std::string shell_line(std::span<const std::string> arguments) {
  std::string line;
  for (const std::string& argument : arguments) {
    if (!line.empty()) line += ' ';
    line += shell_quoted(argument);
  }
  return line;
}

std::string snakemake_text(const std::string& command) {
  std::string text;
  for (const char c : command) {
    if (c == '\\' || c == '"') text += '\\';
    text += c;
    if (c == '{' || c == '}') text += c;
  }
  return text;
}

}  // namespace pneuma::app
