// What the program needs of a machine, and what of that is there.
#pragma once

#include <string>
#include <vector>

#include "app/exit_code.h"

namespace pneuma::app {

struct Finding {
  enum class State {
    good,
    doubtful,  // works, but worse than it could
    missing,   // something optional cannot be done
    broken,    // the program cannot do its work
  };
  std::string subject;
  State state = State::good;
  std::string detail = {};
  std::string remedy = {};         // the command that mends it; empty when nothing is to be mended
  ExitCode code = ExitCode::done;  // of the program, when broken
};

/// Looks at everything; makes and removes one file in the folder for temporary files.
std::vector<Finding> diagnose();

/// The code of the first broken finding; `done` when there is none.
ExitCode exit_code(const std::vector<Finding>& findings);

std::string diagnosis_text(const std::vector<Finding>& findings);

}  // namespace pneuma::app
