#include "app/python/scripted_world.h"

#include <fmt/format.h>

#include "app/host/errors.h"
#include "app/host/thread_count.h"
#include "app/world/build_world.h"
#include "app/world/open_scene.h"
#include "app/world/scene_warnings.h"
#include "app/world/simulation.h"

namespace pneuma::app {
namespace {

int picture_side(const char* name, const std::optional<int>& given, int of_scene) {
  const int side = given.value_or(of_scene);
  if (side >= scenes::smallest_picture_side && side <= scenes::greatest_picture_side) return side;
  throw UsageError(fmt::format("{} = {}: a picture has {} to {} pixels along a side", name, side,
                               scenes::smallest_picture_side, scenes::greatest_picture_side));
}

/// Before the scene is read, which may take long.
scenes::Scene opened(const std::string& scene, const std::vector<std::string>& overrides,
                     int threads) {
  if (threads < 1 || threads > max_threads) {
    throw UsageError(
        fmt::format("threads = {}: a simulation has 1 to {} threads", threads, max_threads));
  }
  return open_scene(scene, overrides);
}

}  // namespace

ScriptedWorld::ScriptedWorld(const std::string& scene, const std::vector<std::string>& overrides,
                             int threads)
    : scene_(opened(scene, overrides, threads)),
      simulation_(scene_, build_checked_world(scene_), threads),
      camera_(scene_, world(), threads) {}

void ScriptedWorld::step() {
  simulation_.advance_step();
  camera_.see(world());
}

render::Image ScriptedWorld::draw(const PictureSize& size, Show show) {
  render::RenderOptions options;
  options.width = picture_side("width", size.width, scene_.picture.width);
  options.height = picture_side("height", size.height, scene_.picture.height);
  options.samples = scene_.picture.samples;
  if (!builder_) builder_.emplace(scene_, build_world(scene_));
  if (!drawing_) drawing_.emplace();
  return drawing_->draw(options, builder_->build(world(), camera_.at(world()), contacts(), show));
}

const std::vector<std::string>& ScriptedWorld::warnings() {
  if (!warnings_) {
    const sim::World start = build_world(scene_);
    warnings_ =
        scene_warnings(scene_, start, step_advices(start), gas_advices_before_run(scene_, start));
  }
  return *warnings_;
}

}  // namespace pneuma::app
