#include "scenes/loader/guard.h"

#include <fmt/format.h>

#include <algorithm>

namespace pneuma::scenes {
namespace {

constexpr int most_dots_per_line = 100;
constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";

bool beyond_ascii(char c) { return static_cast<unsigned char>(c) >= 0x80; }
bool is_control(char c) {
  return (static_cast<unsigned char>(c) < 0x20 && c != '\t') || c == '\x7f';
}

/// Looks at one line, without its end, as toml++ would as long as it finds nothing wrong.
class LineGuard {
 public:
  LineGuard(std::string_view line, Origin start) : line_(line), start_(start) {}

  /// Where the comment starts, or the line ends. Throws SyntaxError.
  std::size_t find_comment() {
    check_characters();
    check_header();
    while (at_ < line_.size() && line_[at_] != '#') {
      const char c = line_[at_];
      if (beyond_ascii(c)) break;
      if (c == '"' || c == '\'') {
        skip_string(c);
        continue;
      }
      if (c == '.' && !is_in_number() && ++dots_ > most_dots_per_line) {
        refuse(
            fmt::format("more than {} dots in the keys of one line; each may nest a table. Break "
                        "the line",
                        most_dots_per_line));
      }
      ++at_;
    }
    check_ascii();
    return at_;
  }

 private:
  [[noreturn]] void refuse(const std::string& message) const {
    throw SyntaxError({start_.line, static_cast<int>(at_) + 1, start_.override_index}, message);
  }

  void check_characters() {
    at_ = static_cast<std::size_t>(std::find_if(line_.begin(), line_.end(), is_control) -
                                   line_.begin());
    if (at_ < line_.size()) {
      refuse(fmt::format("control character 0x{:02x}; remove it", int{line_[at_]}));
    }
    at_ = 0;
  }

  void check_ascii() {
    const std::string_view before = line_.substr(0, std::min(at_ + 1, line_.size()));
    const auto found = std::find_if(before.begin(), before.end(), beyond_ascii);
    if (found == before.end()) return;
    at_ = static_cast<std::size_t>(found - before.begin());
    refuse("scene files are ASCII but for comments, because captions can show nothing else");
  }

  void check_header() {
    skip_blanks();
    if (at_ == line_.size() || line_[at_] != '[') return;
    ++at_;
    skip_blanks();
    if (at_ < line_.size() && line_[at_] == '[') ++at_;
    skip_blanks();
    if (at_ == line_.size()) return;
    constexpr std::string_view others = "_-\"']";  // toml++ itself refuses a bracket here
    const char c = line_[at_];
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    const bool digit = c >= '0' && c <= '9';
    if (!letter && !digit && others.find(c) == others.npos) {
      refuse("a table's name starts with a letter, a digit, '_' or '-'");
    }
  }

  /// Whether the dot here is the only one of a word that starts as a number does, and that a value
  /// ends with: a key goes on with another dot or an equals sign.
  bool is_in_number() const {
    constexpr std::string_view of_words =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+.";
    const std::size_t before = line_.find_last_not_of(of_words, at_);
    const std::size_t begin = before == line_.npos ? 0 : before + 1;
    const std::size_t end = std::min(line_.find_first_not_of(of_words, at_), line_.size());
    const std::string_view word = line_.substr(begin, end - begin);
    const std::size_t next = line_.find_first_not_of(" \t", end);
    return std::string_view("0123456789-+").find(word.front()) != word.npos &&
           std::count(word.begin(), word.end(), '.') == 1 &&
           (next == line_.npos || std::string_view(",]}#").find(line_[next]) != word.npos);
  }

  void skip_blanks() {
    while (at_ < line_.size() && (line_[at_] == ' ' || line_[at_] == '\t')) ++at_;
  }

  /// Moves past the closing quote. toml++ reports a missing one.
  void skip_string(char quote) {
    if (line_.substr(at_, 3) == std::string(3, quote)) {
      refuse("a scene file has no strings of several lines; write one line in one pair of quotes");
    }
    for (++at_; at_ < line_.size() && line_[at_] != quote; ++at_) {
      if (quote == '"' && line_[at_] == '\\') ++at_;
    }
    at_ = std::min(at_ + 1, line_.size());
  }

  std::string_view line_;
  Origin start_;
  std::size_t at_ = 0;
  int dots_ = 0;
};

}  // namespace

std::string guarded(std::string_view text, int override_index) {
  if (text.substr(0, byte_order_mark.size()) == byte_order_mark) {
    text.remove_prefix(byte_order_mark.size());
  }
  if (std::count(text.begin(), text.end(), '\0') > 1) {
    throw SyntaxError(
        // Without the line, which may be all of the file.
        {1, 1, override_index, override_index < 0},
        "this is no text, but a picture, a program or text in UTF-16; a scene is TOML in ASCII");
  }
  std::string result(text);
  int number = 1;
  for (std::size_t start = 0; start < text.size(); ++number) {
    const std::size_t end = std::min(text.find('\n', start), text.size());
    std::string_view line = text.substr(start, end - start);
    if (end < text.size() && !line.empty() && line.back() == '\r') line.remove_suffix(1);
    const std::size_t comment = LineGuard(line, {number, 1, override_index}).find_comment();
    const auto first = result.begin() + static_cast<std::ptrdiff_t>(start + comment);
    const auto last = result.begin() + static_cast<std::ptrdiff_t>(start + line.size());
    std::replace_if(first, last, beyond_ascii, '?');
    start = end + 1;
  }
  return result;
}

}  // namespace pneuma::scenes
