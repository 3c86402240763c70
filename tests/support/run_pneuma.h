// Runs the program as a user does.
#pragma once

#include <string>

#include "tests/support/paths.h"
#include "tests/support/run_command.h"

namespace pneuma {

/// `arguments` as in a shell, so that a redirection at their end works; `environment` as
/// "NAME=value ".
inline ProgramResult run_pneuma(const std::string& arguments, const std::string& environment = "") {
  return run_command(environment + " '" + program_file() + "' " + arguments);
}

}  // namespace pneuma
