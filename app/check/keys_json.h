// The reference of all keys of scene files, for scripts.
#pragma once

#include <nlohmann/json.hpp>

namespace pneuma::app {

/// A list with an object per key: the path by which --set knows it, what it takes (words: the list
/// of them), range, unit, default, the bodies or tables it is only for, and its meaning. What there
/// is none of is null.
nlohmann::json keys_json();

}  // namespace pneuma::app
