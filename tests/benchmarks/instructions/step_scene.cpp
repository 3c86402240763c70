// Runs a scene to its end without looking at it: what scripts/instructions counts the instructions
// of.
#include <fmt/format.h>

#include <cstdint>
#include <exception>

#include "app/files/find_scene.h"
#include "app/world/build_world.h"
#include "app/world/replay.h"
#include "scenes/loader/load_scene.h"

int main(int argc, char** argv) {
  using namespace pneuma;
  try {
    if (argc != 2) throw std::invalid_argument("usage: pneuma_step_scene SCENE");
    const scenes::Scene scene = scenes::load_scene(app::find_scene(argv[1]));
    sim::World world = app::build_world(scene);
    sim::Stepper stepper(world);
    const auto steps = static_cast<std::int64_t>(scene.duration * world.settings.steps_per_second);
    app::advance(stepper, world, steps, scene.name);
    fmt::print("{}\n", steps);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
