// Programs that are installed.
#pragma once

#include <optional>
#include <string>

namespace pneuma::app {

/// Where PATH finds the program, if anywhere.
std::optional<std::string> find_program(const std::string& name);

}  // namespace pneuma::app
