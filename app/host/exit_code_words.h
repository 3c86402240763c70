// The exit codes in words, for --help and the manual page.
#pragma once

#include <string_view>

namespace pneuma::app {

inline constexpr std::string_view exit_code_words =
    "0 done; 1 an error of the program itself; 2 the command line is wrong; 3 scene or model\n"
    "invalid or not readable; 4 no OpenGL; 5 the simulation diverged; 6 input or output failed;\n"
    "7 a check failed; 130 interrupted.";

}  // namespace pneuma::app
