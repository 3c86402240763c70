// An exception as what the program says of it: the one place where an error becomes an exit code.
#pragma once

#include <exception>
#include <string>

#include "app/host/exit_code.h"

namespace pneuma::app {

struct Failure {
  ExitCode code = ExitCode::internal_error;
  std::string words;  // what() as it is, or what explains it
  bool is_placed =
      false;  // the words start with file:line:column, or the file, which editors jump to
};

/// Of what app/host/errors.h lists, and of any other.
Failure failure_of(const std::exception_ptr& error);

}  // namespace pneuma::app
