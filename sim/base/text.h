// Numbers in messages.
#pragma once

#include <array>
#include <cmath>
#include <cstdio>
#include <string>

namespace pneuma::base {

/// With three digits.
inline std::string text(double value) {
  std::array<char, 32> buffer;
  std::snprintf(buffer.data(), buffer.size(), "%.3g", value);
  return buffer.data();
}

/// With three digits, of a value above zero. What is written is not above it, so that a limit may
/// be given back as it reads.
inline std::string text_below(double value) {
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 2.0);
  return text(unit * std::floor(value / unit * (1.0 - 1e-12)));
}

/// With so many digits, and not below the value (> 0).
inline double rounded_up(double value) {
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 2.0);
  return unit * std::ceil(value / unit * (1.0 + 1e-12));
}
inline std::string text_above(double value) { return text(rounded_up(value)); }

}  // namespace pneuma::base
