#include "app/world/open_scene.h"

#include <filesystem>

#include "app/world/find_model.h"
#include "app/world/find_scene.h"
#include "app/world/model_scene.h"
#include "assets/model_file.h"
#include "scenes/loader/load_scene.h"

namespace pneuma::app {

scenes::Scene open_scene(const std::string& name, std::span<const std::string> overrides) {
  if (!assets::has_model_ending(name)) return scenes::load_scene(find_scene(name), overrides);
  const std::filesystem::path model = find_model(name, "");
  return scenes::parse_scene(model_scene_text(model), model_scene_file(model), overrides);
}

}  // namespace pneuma::app
