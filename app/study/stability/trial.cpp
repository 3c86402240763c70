#include "app/study/stability/trial.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "app/host/interrupt.h"
#include "sim/base/enum_name.h"
#include "sim/inspect/inspect.h"
#include "sim/step/stepper.h"

namespace pneuma::app {
namespace {

constexpr double greatest_rise = 100.0;  // of the kinetic energy at the start
constexpr double rate_precision = 1.02;

/// An empty body that grows out of its shape may come to rest in another one, folded, that costs
/// its springs no energy: it has to be looked at on the way.
constexpr int steps_per_look = 16;

/// Backward Euler takes from a motion of a frequency w all but 1 / sqrt(1 + w^2) of its size in
/// each of these steps of a second.
constexpr int settling_steps = 200;

/// To where springs and gas hold each other. `valence` pressure does not act along an energy: such
/// a body is at rest but for what its form differs by from that under `uniform`.
void settle(sim::World& world) {
  sim::World still = world;
  still.settings.integrator = sim::Integrator::implicit_euler;
  still.settings.steps_per_second = 1;
  still.soft.front().material.pressure_weighting = sim::PressureWeighting::uniform;
  sim::Stepper stepper(still);
  for (int i = 0; i < settling_steps; ++i) {
    throw_if_interrupted();
    if (stepper.step(still)) return;  // as far as it came
  }
  world.soft.front().positions = still.soft.front().positions;
}

}  // namespace

std::string to_string(Verdict verdict) {
  static constexpr auto names = std::to_array<std::string_view>({"stable", "diverged", "inverted"});
  return std::string(base::enum_name(names, verdict));
}

void disturb(sim::SoftBody& body) {
  std::mt19937_64 random(1);
  for (int v = 0; v < body.velocities.size(); ++v) {
    for (int axis = 0; axis < 3; ++axis) {
      const double share = static_cast<double>(random() >> 11) * 0x1.0p-52 - 1.0;  // -1..1
      body.velocities[v][axis] = start_speed * share;
    }
  }
}

sim::World body_at_rest(const sim::Settings& settings, sim::SoftBody body) {
  sim::World world;
  world.settings = settings;
  world.settings.ground.reset();
  world.settings.gravity.setZero();
  body.velocities.rows().setZero();
  world.soft.push_back(std::move(body));
  settle(world);
  disturb(world.soft.front());
  return world;
}

Trial try_step(const sim::World& at_rest, sim::Integrator integrator, int steps_per_second,
               const TrialOptions& options) {
  sim::World world = at_rest;
  world.settings.integrator = integrator;
  world.settings.steps_per_second = steps_per_second;
  Trial trial{steps_per_second};
  const sim::Energy before = sim::energy(world);
  sim::Stepper stepper(world);
  const auto steps = std::min(
      options.most_steps, static_cast<std::int64_t>(std::ceil(options.seconds * steps_per_second)));
  while (world.steps < steps) {
    throw_if_interrupted();
    if (const auto divergence = stepper.step(world)) {
      trial.verdict = divergence->inverted ? Verdict::inverted : Verdict::diverged;
      trial.reason = fmt::format("step {}: {}", divergence->step, divergence->what);
      return trial;
    }
    if (world.steps % steps_per_look != 0 && world.steps < steps) continue;
    const double rise = sim::energy(world).total() - before.total();
    if (rise <= greatest_rise * before.kinetic) continue;
    trial.verdict = Verdict::diverged;
    trial.reason =
        fmt::format("step {}: its energy rose by {:.3g} J, {:.3g} times what it moved with",
                    world.steps, rise, rise / before.kinetic);
    return trial;
  }
  return trial;
}

std::optional<int> find_stable_rate(const sim::World& at_rest, sim::Integrator integrator,
                                    const TrialOptions& options, std::vector<Trial>& trials) {
  const auto is_stable = [&](int rate) {
    trials.push_back(try_step(at_rest, integrator, rate, options));
    return trials.back().verdict == Verdict::stable;
  };
  int low = fewest_steps_per_second;
  if (is_stable(low)) return low;
  int high = 2 * low;
  while (!is_stable(high)) {
    if (high >= most_steps_per_second) return {};
    low = high;
    high = std::min(2 * high, most_steps_per_second);
  }
  while (high > rate_precision * low && high - low > 1) {
    const int middle = static_cast<int>(std::lround(std::sqrt(1.0 * low * high)));
    (is_stable(middle) ? high : low) = middle;
  }
  return high;
}

}  // namespace pneuma::app
