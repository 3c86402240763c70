#include "app/export/sink/bytes.h"

#include <algorithm>

namespace pneuma::app {

std::string base64(std::span<const std::uint8_t> bytes) {
  constexpr const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t three = 0;
    for (std::size_t j = 0; j < 3; ++j) three = three << 8 | (j < count ? bytes[i + j] : 0u);
    for (std::size_t digit = 0; digit < 4; ++digit) {
      text += digit <= count ? digits[three >> (18 - 6 * digit) & 63] : '=';
    }
  }
  return text;
}

}  // namespace pneuma::app
