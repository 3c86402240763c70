#include "scenes/loader/text_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <regex>

#include "scenes/loader/tables.h"

namespace pneuma::scenes {
namespace {

constexpr std::size_t longest_line = 200;
constexpr std::size_t longest_number = 60;  // with its unit
constexpr std::size_t longest_path = 4095;  // Linux takes no longer one
constexpr std::size_t longest_body_name = 64;

// Not the functions of <cctype>, which follow the locale.
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_hex_digit(char c) {
  return is_digit(c) || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F');
}
bool is_printable_ascii(char c) { return c >= 0x20 && c < 0x7f; }

}  // namespace

std::string check_line(std::string_view text) {
  if (text.size() > longest_line) {
    return fmt::format("is {} characters long; at most {} are allowed", text.size(), longest_line);
  }
  if (!std::all_of(text.begin(), text.end(), is_printable_ascii)) {
    return "holds something else than printable ASCII; captions can show nothing else";
  }
  return {};
}

std::string check_file(std::string_view text) {
  if (text.size() > longest_path) {
    return fmt::format("is {} characters long; at most {} are allowed", text.size(), longest_path);
  }
  if (!std::all_of(text.begin(), text.end(), is_printable_ascii)) {
    return "holds something else than printable ASCII; scene files can say nothing else, so give "
           "the file another name or a link";
  }
  return {};
}

std::string check_body_name(std::string_view text) {
  const bool valid = !text.empty() && text.size() <= longest_body_name && is_letter(text[0]) &&
                     std::all_of(text.begin(), text.end(), [](char c) {
                       return is_letter(c) || is_digit(c) || c == '_' || c == '-';
                     });
  if (!valid) {
    return fmt::format(
        "is not a name; allowed: a letter, then letters, digits, '_' and '-', at "
        "most {} in all",
        longest_body_name);
  }
  const std::vector<std::string_view> tables = child_tables("");
  if (is_body_table(text) || std::find(tables.begin(), tables.end(), text) != tables.end()) {
    return "is the name of a table of scene files; choose another";
  }
  return {};
}

std::string check_colour(std::string_view text) {
  const bool valid =
      text.size() == 7 && text[0] == '#' && std::all_of(text.begin() + 1, text.end(), is_hex_digit);
  return valid ? std::string() : "is not a colour; write #rrggbb, such as \"#d9381e\"";
}

std::string number_hint(std::string_view text) {
  if (text.size() > longest_number) return {};
  static const std::regex pattern(R"(([+-]?)(\d*)(\.?)(\d*)([eE][+-]?\d+)?\s*([A-Za-z%][^\s]*)?)");
  std::cmatch parts;
  const bool is_one = std::regex_match(text.data(), text.data() + text.size(), parts, pattern) &&
                      parts[2].length() + parts[4].length() > 0;
  if (!is_one) return {};
  const bool has_point = parts[3].length() > 0, has_unit = parts[6].length() > 0;
  const bool is_whole_number = parts[2].length() > 0 && parts[4].length() > 0;
  if (!has_unit && (!has_point || is_whole_number)) return {};
  const auto or_zero = [](const std::string& digits) { return digits.empty() ? "0" : digits; };
  const std::string number = parts[1].str() + or_zero(parts[2].str()) +
                             (has_point ? "." + or_zero(parts[4].str()) : std::string()) +
                             parts[5].str();
  return fmt::format("; {}write {}", has_unit ? "a number stands without its unit: " : "", number);
}

}  // namespace pneuma::scenes
