#include "assets/number_mistake.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "sim/base/nearest.h"

namespace pneuma::assets {
namespace {

constexpr std::string_view blanks = " \t\r\n";

bool is_number(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error != std::errc::invalid_argument && end == word.data() + word.size();
}

/// Goes through the words of a file, and knows the line.
class Words {
 public:
  explicit Words(std::string_view file) : left_(file) {}

  /// Empty at the end. Comments, from # to the end of the line, are left out.
  std::string_view next() {
    skip(std::min(left_.find_first_not_of(blanks), left_.size()));
    while (left_.starts_with('#')) {
      skip_line();
      skip(std::min(left_.find_first_not_of(blanks), left_.size()));
    }
    const std::string_view word = left_.substr(0, left_.find_first_of(blanks));
    left_.remove_prefix(word.size());
    return word;
  }

  void skip_line() { skip(std::min(left_.find('\n'), left_.size())); }
  int line() const { return line_; }

 private:
  void skip(std::size_t count) {
    line_ += static_cast<int>(std::ranges::count(left_.substr(0, count), '\n'));
    left_.remove_prefix(count);
  }

  std::string_view left_;
  int line_ = 1;
};

std::string mistake(const Words& words, std::string_view word) {
  return fmt::format("line {}: {} is not a number", words.line(), base::in_quotes(word));
}

std::string first_mistake(Words& words) {
  for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
    if (!is_number(word)) return mistake(words, word);
  }
  return {};
}

/// "ply", lines of words up to "end_header", then numbers alone if it is of text.
std::string ply_mistake(std::string_view file) {
  Words words(file);
  bool is_text = false;
  for (std::string_view word = words.next(); word != "end_header"; word = words.next()) {
    if (word.empty()) return {};
    if (word == "format") is_text = words.next() == "ascii";
    words.skip_line();
  }
  return is_text ? first_mistake(words) : std::string();
}

/// Each "vertex" and "normal" is followed by three numbers.
std::string stl_mistake(std::string_view file) {
  if (!file.starts_with("solid")) return {};
  Words words(file);
  words.skip_line();  // its name
  for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
    if (word != "vertex" && word != "normal") continue;
    for (int axis = 0; axis < 3; ++axis) {
      const std::string_view number = words.next();
      if (!is_number(number)) return mistake(words, number);
    }
  }
  return {};
}

}  // namespace

std::string number_mistake(Format format, std::string_view file) {
  if (format == Format::ply) return ply_mistake(file);
  if (format == Format::stl) return stl_mistake(file);
  if (format != Format::off) return {};
  Words words(file);
  words.next();  // OFF
  return first_mistake(words);
}

}  // namespace pneuma::assets
