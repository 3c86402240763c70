// Binary files while they are put together, little-endian.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <vector>

namespace pneuma::app {

using Bytes = std::vector<std::uint8_t>;

static_assert(std::endian::native == std::endian::little, "the binary formats are little-endian");

template <typename Value>
void put(Bytes& bytes, const Value& value) {
  const auto start = bytes.size();
  bytes.resize(start + sizeof value);
  std::memcpy(bytes.data() + start, &value, sizeof value);
}

inline void put(Bytes& bytes, const std::string& text) {
  bytes.insert(bytes.end(), text.begin(), text.end());
}

/// A fraction of 1 as one of 255.
inline std::uint8_t to_byte(float fraction) {
  return static_cast<std::uint8_t>(std::lround(fraction * 255.0f));
}

/// As RFC 4648 has it.
std::string base64(std::span<const std::uint8_t> bytes);

}  // namespace pneuma::app
