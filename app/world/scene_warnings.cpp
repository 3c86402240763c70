#include "app/world/scene_warnings.h"

#include <algorithm>

#include "scenes/loader/load_scene.h"

namespace pneuma::app {
namespace {

/// Of the [[body]] of which a world's body is a copy: "ball" or, of several, "ball.3".
scenes::Place place_of(const scenes::Scene& scene, const std::string& name) {
  const auto body = std::ranges::find_if(scene.bodies, [&](const scenes::BodyScene& candidate) {
    return name == candidate.name ||
           (scenes::copy_count(candidate) > 1 && name.starts_with(candidate.name + '.'));
  });
  return body == scene.bodies.end() ? scenes::Place{} : body->place;
}

std::string warning_at(const scenes::Scene& scene, const std::string& name,
                       const std::string& what) {
  return to_string(scenes::diagnostic_at(place_of(scene, name), "warning: " + what));
}

}  // namespace

std::vector<std::string> scene_warnings(const scenes::Scene& scene,
                                        const std::vector<StepAdvice>& steps,
                                        const std::vector<GasAdvice>& gas) {
  std::vector<std::string> warnings = scene.warnings;
  for (const StepAdvice& advice : steps) {
    if (advice.too_long()) warnings.push_back(warning_at(scene, advice.body, step_warning(advice)));
  }
  for (const GasAdvice& advice : gas) {
    if (advice.blown_up()) warnings.push_back(warning_at(scene, advice.body, gas_warning(advice)));
    if (advice.crushed())
      warnings.push_back(warning_at(scene, advice.body, weight_warning(advice)));
  }
  return warnings;
}

}  // namespace pneuma::app
