#include "app/world/open_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "app/host/errors.h"
#include "app/world/build_world.h"
#include "app/world/find_model.h"
#include "app/world/find_scene.h"
#include "app/world/step_advice.h"
#include "assets/model_file.h"
#include "scenes/loader/load_scene.h"

namespace pneuma::app {

namespace {

/// Of the default steps, so that a run still ends: stiffer bodies are for implicit methods, as the
/// warning about them says.
constexpr int most_parts = 64;

void choose_step(scenes::Scene& scene) {
  if (scene.names_step || sim::is_as_printed(scene.settings)) return;
  const std::vector<StepAdvice> advices = step_advices(build_world(scene));
  const auto slowest = std::ranges::max_element(advices, {}, [](const StepAdvice& advice) {
    return advice.too_long() ? advice.steps_per_second : 0;
  });
  int& steps = scene.settings.steps_per_second;
  if (slowest == advices.end() || !slowest->too_long() || slowest->steps_per_second == 0 ||
      slowest->steps_per_second > most_parts * steps) {
    return;
  }
  scene.warnings.push_back(fmt::format(
      "note: simulation.steps_per_second = {} instead of {}, because small motions of '{}' are "
      "stable up to steps of {:.3g} s",
      slowest->steps_per_second, steps, slowest->body, slowest->limit));
  steps = slowest->steps_per_second;
}

}  // namespace

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
  scenes::Scene scene = scenes::load_scene(find_scene(name), overrides);
  choose_step(scene);
  return scene;
}

}  // namespace pneuma::app
