// A hash by which two states, or two texts, are told apart. Not for secrets.
#pragma once

#include <bit>
#include <cstdint>
#include <string_view>

namespace pneuma::base {

/// FNV-1a on 64-bit words (what is hashed is mostly doubles and integers), with the high bits
/// folded back after each word: a product alone never carries a change of a high bit, such as a
/// sign, into the lower ones.
class Hash {
 public:
  void add(std::uint64_t word) {
    value_ = (value_ ^ word) * 0x100000001b3ULL;
    value_ ^= value_ >> 29;
  }
  void add(int value) { add(static_cast<std::uint64_t>(value)); }
  void add(double value) { add(std::bit_cast<std::uint64_t>(value)); }
  void add(std::string_view text) {
    for (const char c : text) add(static_cast<std::uint64_t>(static_cast<unsigned char>(c)));
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325ULL;
};

}  // namespace pneuma::base
