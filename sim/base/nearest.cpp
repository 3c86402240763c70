#include "sim/base/nearest.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>

namespace pneuma::base {
namespace {

constexpr std::size_t longest_name = 40;  // longer ones are no slip of the pen
constexpr std::size_t longest_quote = 60;

bool same_letter(char a, char b) {
  return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
}

/// Of a letter in UTF-8, by its first byte; 0: no letter begins so.
std::size_t bytes_announced(unsigned char first) {
  if (first < 0x80) return 1;
  if (first < 0xc0 || first >= 0xf8) return 0;
  return first < 0xe0 ? 2 : first < 0xf0 ? 3 : 4;
}

/// Control characters, which terminals obey; halves of letters in UTF-16; and what takes no room,
/// breaks the line or turns the direction of writing.
bool is_shown_as_none(char32_t letter) {
  const auto within = [&](char32_t low, char32_t high) { return letter >= low && letter <= high; };
  return letter < 0x20 || within(0x7f, 0x9f) || within(0xd800, 0xdfff) || within(0x200b, 0x200f) ||
         within(0x2028, 0x202e) || within(0x2060, 0x206f) || letter == 0xfeff;
}

}  // namespace

int edit_distance(std::string_view a, std::string_view b) {
  // Row i holds the distances of a's first i letters to each beginning of b. Swaps look two rows
  // back.
  const std::size_t columns = b.size() + 1;
  std::vector<int> two_back(columns), one_back(columns), row(columns);
  for (std::size_t j = 0; j < columns; ++j) row[j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    two_back.swap(one_back);
    one_back.swap(row);
    row[0] = static_cast<int>(i);
    for (std::size_t j = 1; j < columns; ++j) {
      const int replaced = one_back[j - 1] + (same_letter(a[i - 1], b[j - 1]) ? 0 : 1);
      row[j] = std::min({replaced, one_back[j] + 1, row[j - 1] + 1});
      const bool swapped =
          i > 1 && j > 1 && same_letter(a[i - 1], b[j - 2]) && same_letter(a[i - 2], b[j - 1]);
      if (swapped) row[j] = std::min(row[j], two_back[j - 2] + 1);
    }
  }
  return row.back();
}

std::optional<std::string_view> nearest(std::string_view name,
                                        const std::vector<std::string_view>& candidates) {
  if (name.empty() || name.size() > longest_name) return std::nullopt;
  int limit = (static_cast<int>(name.size()) + 2) / 3 + 1;
  std::optional<std::string_view> found;
  for (const std::string_view candidate : candidates) {
    const int distance = edit_distance(name, candidate);
    if (distance < limit) {
      limit = distance;
      found = candidate;
    }
  }
  return found;
}

std::string suggestion(std::string_view name, const std::vector<std::string_view>& candidates) {
  const auto found = nearest(name, candidates);
  return found ? fmt::format("; did you mean '{}'?", *found) : std::string();
}

std::string suggestion_and_all(std::string_view name,
                               const std::vector<std::string_view>& candidates) {
  const std::string near = suggestion(name, candidates);
  return fmt::format("{} allowed: {}", near.empty() ? ";" : near, fmt::join(candidates, ", "));
}

std::size_t letter_size(std::string_view text) {
  if (text.empty()) return 0;
  const auto first = static_cast<unsigned char>(text[0]);
  const std::size_t size = bytes_announced(first);
  if (size == 0 || size > text.size()) return 0;
  char32_t letter = size == 1 ? first : first & (0x7fu >> size);
  for (const char c : text.substr(1, size - 1)) {
    const auto byte = static_cast<unsigned char>(c);
    if ((byte & 0xc0u) != 0x80u) return 0;
    letter = letter << 6 | (byte & 0x3fu);
  }
  constexpr std::array<char32_t, 5> least = {0, 0, 0x80, 0x800, 0x10000};  // else overlong
  return letter < least[size] || letter > 0x10ffff || is_shown_as_none(letter) ? 0 : size;
}

std::string printable(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const std::size_t size = letter_size(text);
    if (size > 0) {
      result += text.substr(0, size);
    } else {
      result += fmt::format("\\x{:02x}", static_cast<unsigned char>(text[0]));
    }
    text.remove_prefix(std::max<std::size_t>(size, 1));
  }
  return result;
}

std::string in_quotes(std::string_view text) {
  std::size_t length = std::min(text.size(), longest_quote);
  const auto inside_letter = [&](std::size_t i) {  // UTF-8 continues with bytes 10xxxxxx
    return i < text.size() && (static_cast<unsigned char>(text[i]) & 0xc0u) == 0x80u;
  };
  while (length > 0 && inside_letter(length)) --length;
  return fmt::format("'{}{}'", printable(text.substr(0, length)),
                     length < text.size() ? "..." : "");
}

}  // namespace pneuma::base
