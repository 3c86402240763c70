#include "app/study/report_text.h"

#include <fmt/format.h>

#include <cmath>

#include "app/terminal/table.h"

namespace pneuma::app {
namespace {

constexpr std::size_t text_width = 118;
constexpr std::size_t label_width = 11;

}  // namespace

std::string labelled(const std::string& label, const std::string& text) {
  std::string result = fmt::format("{:<{}}", label, label_width);
  for (const char c : wrapped(text, text_width - label_width)) {
    result += c;
    if (c == '\n') result.append(label_width, ' ');
  }
  return result + '\n';
}

std::string list_item(const std::string& text) {
  return wrapped(fmt::format("- {}", text), text_width) + '\n';
}

std::string warnings_text(const std::vector<std::string>& warnings) {
  std::string text;
  for (const std::string& warning : warnings) {
    text += wrapped(fmt::format("Warning: {}.", warning), text_width) + '\n';
  }
  return text;
}

std::string power_of_ten(double value) {
  return fmt::format("1e{}", std::lround(std::log10(value)));
}

}  // namespace pneuma::app
