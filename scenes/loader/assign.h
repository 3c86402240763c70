// One value of a document into one member.
#pragma once

#include <optional>
#include <string>

#include "scenes/loader/document.h"
#include "scenes/loader/keys.h"

namespace pneuma::scenes {

struct Complaint {
  Origin at;
  std::string message;
};

/// Sets the key's member to the value. When type, length, range or word do not fit, says so and
/// leaves the member as it was.
std::optional<Complaint> assign(const Key& key, const Value& value);

}  // namespace pneuma::scenes
