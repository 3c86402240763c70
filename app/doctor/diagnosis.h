// What the program needs of a machine, and what of that is there.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/files/scene_catalogue.h"
#include "app/host/exit_code.h"
#include "render/context/backend.h"

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

/// Of the scenes that `catalogue` finds: broken where there are none.
Finding scenes_finding(const std::function<std::vector<CatalogueEntry>()>& catalogue);

/// Looks at everything; makes and removes a file in the folder for temporary files and one where
/// `render` writes.
std::vector<Finding> diagnose(std::optional<render::Backend> backend = std::nullopt);

/// The code of the first broken finding; `done` when there is none.
ExitCode exit_code(const std::vector<Finding>& findings);

std::string diagnosis_text(const std::vector<Finding>& findings);

}  // namespace pneuma::app
