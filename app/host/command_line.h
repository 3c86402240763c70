// Command lines as text.
#pragma once

#include <span>
#include <string>

namespace pneuma::app {

/// As one line that a shell reads back to the same arguments.
std::string shell_line(std::span<const std::string> arguments);

}  // namespace pneuma::app
