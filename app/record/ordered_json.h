// JSON whose keys keep the order in which they were added, as files that people read want it.
#pragma once

#include <nlohmann/json.hpp>

namespace pneuma::app {

using Json = nlohmann::ordered_json;

}  // namespace pneuma::app
