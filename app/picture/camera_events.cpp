#include "app/picture/camera_events.h"

#include <fmt/format.h>

#include "app/host/interrupt.h"

namespace pneuma::app {

CameraEvents camera_events(const scenes::Scene& scene, Progress& progress) {
  CameraEvents events;
  events.looked_ahead = [&progress](const sim::World& ahead, double until) {
    throw_if_interrupted();
    progress.show(fmt::format("looking ahead for the camera: t = {:.2f} s of {:g} s",
                              sim::time(ahead), until));
  };
  events.notice = [&progress, name = scene.name](const std::string& text) {
    progress.say(fmt::format("{}: {}", name, text));
  };
  return events;
}

}  // namespace pneuma::app
