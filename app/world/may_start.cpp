#include "app/world/may_start.h"

#include <array>

#include "app/world/build_world.h"
#include "app/world/start_overlap.h"
#include "assets/model.h"
#include "scenes/loader/load_scene.h"
#include "scenes/loader/print_scene.h"

namespace pneuma::app {

bool may_start_with(const scenes::Scene& scene, std::span<const std::string> overrides) {
  try {
    const scenes::Scene changed = scenes::parse_scene(
        scenes::print_scene(scene), scene.folder / (scene.name + ".toml"), overrides);
    refuse_start_overlap(changed, build_world(changed));
  } catch (const scenes::SceneError&) {
    return false;
  } catch (const assets::ModelError&) {
    return false;
  }
  return true;
}

bool may_use_potential(const scenes::Scene& scene, const std::string& integrator) {
  return may_start_with(scene, std::array<std::string, 2>{"simulation.contact=potential",
                                                          "simulation.integrator=" + integrator});
}

}  // namespace pneuma::app
