#include "app/world/refuse_body.h"

#include <fmt/format.h>

#include "scenes/loader/load_scene.h"

namespace pneuma::app {

void refuse_body(const scenes::Scene& scene, const scenes::Place& place, const std::string& name,
                 const std::string& reason) {
  scenes::Place named = place;
  if (named.file.empty()) named.file = (scene.folder / (scene.name + ".toml")).string();
  throw scenes::SceneError(
      {scenes::diagnostic_at(named, fmt::format("body '{}': {}", name, reason))});
}

}  // namespace pneuma::app
