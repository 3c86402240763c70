// Keys by the names that other programs have for them.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace pneuma::scenes {

struct OtherName {
  std::string_view name;    // as people write it
  std::string_view key;     // the key that is meant, with its table
  std::string_view remark;  // how its value differs; may be empty
};

std::span<const OtherName> other_names();

/// "; write simulation.steps_per_second (the inverse of the time step)", or nothing when the name
/// is not among them.
std::string meant_key(std::string_view name);

}  // namespace pneuma::scenes
