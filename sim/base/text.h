// Numbers in messages.
#pragma once

#include <array>
#include <cstdio>
#include <string>

namespace pneuma::base {

/// With three digits.
inline std::string text(double value) {
  std::array<char, 32> buffer;
  std::snprintf(buffer.data(), buffer.size(), "%.3g", value);
  return buffer.data();
}

}  // namespace pneuma::base
