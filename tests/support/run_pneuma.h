// Runs the program as a user does.
#pragma once

#include <string>

#include "tests/support/run_command.h"

namespace pneuma {

/// `arguments` as in a shell, so that a redirection at their end works; `environment` as
/// "NAME=value ". PNEUMA_PROGRAM is the path of the program, from CMake.
inline ProgramResult run_pneuma(const std::string& arguments, const std::string& environment = "") {
  return run_command(environment + " '" PNEUMA_PROGRAM "' " + arguments);
}

}  // namespace pneuma
