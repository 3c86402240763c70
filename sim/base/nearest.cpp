#include "sim/base/nearest.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>

namespace pneuma::base {
namespace {

constexpr std::size_t longest_name = 40;  // longer ones are no slip of the pen
constexpr std::size_t longest_quote = 60;

bool same_letter(char a, char b) {
  return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
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

std::string printable(std::string_view text) {
  std::string result;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7f)
      result += fmt::format("\\x{:02x}", byte);
    else
      result += c;
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
