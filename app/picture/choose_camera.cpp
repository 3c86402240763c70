#include "app/picture/choose_camera.h"

#include <fmt/format.h>

#include "app/host/clock.h"
#include "app/host/interrupt.h"

namespace pneuma::app {

render::Camera choose_camera(const scenes::Scene& scene, const sim::World& start, int threads,
                             Progress& progress) {
  const auto on_frame = [&](const sim::World& world) {
    throw_if_interrupted();
    progress.show(fmt::format("looking ahead for the camera: t = {:.2f} s of {:g} s",
                              sim::time(world), scene.duration));
  };
  const Clock::time_point begin = Clock::now();
  const PlacedCamera placed = place_camera(scene, start, threads, on_frame);
  constexpr double worth_a_word = 5.0;  // s
  const double seconds = seconds_since(begin);
  if (seconds > worth_a_word) {
    progress.say(fmt::format(
        "{}: looking ahead for the camera took {:.0f} s; eye and target in [camera] save that",
        scene.name, seconds));
  }
  if (!placed.notice.empty()) progress.say(fmt::format("{}: {}", scene.name, placed.notice));
  return placed.camera;
}

}  // namespace pneuma::app
