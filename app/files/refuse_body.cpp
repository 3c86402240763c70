#include "app/files/refuse_body.h"

#include <fmt/format.h>

namespace pneuma::app {

scenes::Diagnostic body_diagnostic(const scenes::Scene& scene, const scenes::Place& place,
                                   const std::string& name, const std::string& reason) {
  return scenes::diagnostic_at(scene, place, fmt::format("body '{}': {}", name, reason));
}

void refuse_body(const scenes::Scene& scene, const scenes::Place& place, const std::string& name,
                 const std::string& reason) {
  throw scenes::SceneError({body_diagnostic(scene, place, name, reason)});
}

}  // namespace pneuma::app
