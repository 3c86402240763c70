#include "app/study/choices/damping_steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/host/interrupt.h"
#include "sim/inspect/inspect.h"
#include "sim/mesh/measure.h"
#include "sim/soft/damping.h"
#include "sim/step/stepper.h"

namespace pneuma::app {
namespace {

constexpr double standard_gravity = 9.81;

/// At rest in its rest shape, which its gas then blows up: it swings.
sim::World start(sim::SoftBody body, const DampingRun& run, double gravity) {
  body.positions = body.mesh->rest_positions;
  body.velocities.rows().setZero();
  body.material.damping = run.damping;
  sim::World world;
  world.settings.ground.reset();
  world.settings.gravity = {0.0, 0.0, -gravity};
  world.settings.integrator = sim::Integrator::rk4;
  world.settings.steps_per_second = run.steps_per_second;
  world.soft.push_back(std::move(body));
  return world;
}

template <class Look>
bool run_steps(sim::World& world, double seconds, const Look& look) {
  sim::Stepper stepper(world);
  const auto steps = std::llround(seconds * world.settings.steps_per_second);
  for (std::int64_t i = 0; i < steps; ++i) {
    throw_if_interrupted();
    if (stepper.step(world)) return false;
    look();
  }
  return true;
}

std::optional<double> fall_speed(const sim::SoftBody& body, const DampingRun& run, double seconds) {
  sim::World world = start(body, run, standard_gravity);
  if (!run_steps(world, seconds, [] {})) return std::nullopt;
  return -sim::mean(world.soft[0].velocities).z();
}

std::optional<double> swing_left(const sim::SoftBody& body, const DampingRun& run, double seconds) {
  sim::World world = start(body, run, 0.0);
  double first = 0.0, second = 0.0;
  const auto look = [&] {
    double& half = sim::time(world) <= 0.5 * seconds ? first : second;
    half = std::max(half, sim::energy(world).kinetic);
  };
  if (!run_steps(world, seconds, look) || first == 0.0) return std::nullopt;
  return second / first;
}

std::string text_of(const std::optional<double>& value) {
  return value ? fmt::format("{:.3g}", *value) : "-";
}

std::string sentence(const DampingStudy& study, sim::Damping damping, const char* name) {
  std::vector<DampingRun> runs;
  for (const DampingRun& run : study.runs) {
    if (run.damping == damping && run.fall_speed) runs.push_back(run);
  }
  if (runs.empty()) return fmt::format("{}: no step is stable", name);
  const DampingRun& coarse = runs.front();
  const DampingRun& fine = runs.back();
  return fmt::format(
      "{}: after falling for {:g} s the body has {:.3g} m/s at 1/{} s and {:.3g} m/s at 1/{} s "
      "(the "
      "equation: {:.3g}); of its swing {} is left at 1/{} s and {} at 1/{} s",
      name, study.seconds, *coarse.fall_speed, coarse.steps_per_second, *fine.fall_speed,
      fine.steps_per_second, study.exact_fall_speed, text_of(coarse.swing_left),
      coarse.steps_per_second, text_of(fine.swing_left), fine.steps_per_second);
}

}  // namespace

DampingStudy study_damping(const sim::SoftBody& body, const std::vector<int>& steps_per_second,
                           double seconds) {
  DampingStudy study;
  study.seconds = seconds;
  sim::SoftMaterial material = body.material;
  material.damping = sim::Damping::dashpot;
  const double gamma = sim::drag_rate(material);
  study.exact_fall_speed = gamma > 0.0 ? -standard_gravity * std::expm1(-gamma * seconds) / gamma
                                       : standard_gravity * seconds;
  for (const sim::Damping damping : {sim::Damping::dashpot, sim::Damping::literal}) {
    for (const int rate : steps_per_second) {
      DampingRun run{damping, rate, std::nullopt, std::nullopt};
      run.fall_speed = fall_speed(body, run, seconds);
      run.swing_left = swing_left(body, run, seconds);
      study.runs.push_back(run);
    }
  }
  return study;
}

std::vector<std::string> damping_sentences(const DampingStudy& study) {
  return {sentence(study, sim::Damping::dashpot, "dashpot"),
          sentence(study, sim::Damping::literal, "literal")};
}

}  // namespace pneuma::app
