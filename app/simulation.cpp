#include "app/simulation.h"

#include <fmt/format.h>

#include <utility>

namespace pneuma::app {
namespace {

/// Metres. A run of twenty minutes can fall 7e6 m. Further away there is nothing left to see:
/// pictures are made of single-precision numbers, which are whole metres apart there.
constexpr double farthest = 1e8;

}  // namespace

DivergenceError divergence_error(const std::string& scene_name, const sim::Divergence& divergence,
                                 const sim::Settings& settings) {
  const double time = static_cast<double>(divergence.step) * sim::time_step(settings);
  return DivergenceError(fmt::format("{}: step {} (t = {:.4f} s): body {}: {}", scene_name,
                                     divergence.step, time, divergence.body, divergence.what));
}

Simulation::Simulation(const scenes::Scene& scene, sim::World world, int threads)
    : scene_name_(scene.name),
      steps_per_frame_(scene.settings.steps_per_second / scene.picture.frames_per_second),
      world_(std::move(world)),
      stepper_(world_, {.threads = threads, .profile = true, .plan = {}}) {}

void Simulation::advance_frame() {
  for (int i = 0; i < steps_per_frame_; ++i) {
    const auto divergence = stepper_.step(world_);
    if (divergence) throw divergence_error(scene_name_, *divergence, world_.settings);
  }
  for (const sim::SoftBody& body : world_.soft)
    require_near(body.name, body.positions.rows().cwiseAbs().maxCoeff());
  for (const sim::RigidBox& box : world_.rigid)
    require_near(box.name, box.position.cwiseAbs().maxCoeff());
}

void Simulation::require_near(const std::string& body, double distance) const {
  if (distance < farthest) return;
  const sim::Divergence divergence{
      .stage = sim::Stage::integrate_soft,
      .step = world_.steps,
      .body = body,
      .what = fmt::format("it is {:.3g} m away, too far to be seen", distance)};
  throw divergence_error(scene_name_, divergence, world_.settings);
}

}  // namespace pneuma::app
