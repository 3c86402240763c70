// Numbers on the command line.
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace pneuma::app {

/// A whole number without a sign that is all of `text`.
inline std::optional<std::int64_t> whole_number(std::string_view text) {
  std::int64_t value = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end || text.starts_with('-')) return std::nullopt;
  return value;
}

/// A number from one bound to the other, which "nan" is not.
inline CLI::Validator number_range(double low, double high) {
  const CLI::Range range(low, high);
  const auto check = [=](std::string& text) {
    double value = 0.0;
    const bool is_nan = CLI::detail::lexical_cast(text, value) && std::isnan(value);
    return is_nan ? fmt::format("Value {} not in range {} to {}", text, low, high) : range(text);
  };
  return {check, range.get_description()};
}

}  // namespace pneuma::app
