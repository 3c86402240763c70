// Enumerators as text.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace pneuma::base {

/// `names` has one for each enumerator, in the order of the enumeration, which counts from 0.
/// Throws std::out_of_range for a value without a name.
template <class Enum, std::size_t count>
constexpr std::string_view enum_name(const std::array<std::string_view, count>& names, Enum value) {
  return names.at(static_cast<std::size_t>(value));
}

}  // namespace pneuma::base
