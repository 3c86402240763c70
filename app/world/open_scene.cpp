#include "app/world/open_scene.h"

#include <filesystem>

#include "app/host/errors.h"
#include "app/world/find_model.h"
#include "app/world/find_scene.h"
#include "assets/model_file.h"
#include "scenes/loader/load_scene.h"

namespace pneuma::app {

scenes::Scene open_scene(const std::string& name, std::span<const std::string> overrides,
                         const ModelChoice& choice) {
  if (assets::has_model_ending(name)) {
    const std::filesystem::path model = find_model(name, "");
    return scenes::parse_scene(model_scene_text(model, choice), model_scene_file(model), overrides);
  }
  if (choice.repair || !choice.component.empty()) {
    throw UsageError(
        "--repair and --component are of a model file; for a model in a scene use --set "
        "body.model.repair=true and --set body.model.component=NAME");
  }
  return scenes::load_scene(find_scene(name), overrides);
}

}  // namespace pneuma::app
