#include "app/joints/check_turns.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "scenes/loader/load_scene.h"
#include "sim/rigid/given_motion.h"

namespace pneuma::app {
namespace {

constexpr double half_turn = 180.0;
constexpr double degrees = 180.0 / std::numbers::pi;

/// A monotone cubic is nowhere steeper than this, in units of the slope between its keys.
constexpr double steepest = 3.0;

[[noreturn]] void refuse(const scenes::Scene& scene, const scenes::BodyScene& body, double turn,
                         double time) {
  const int steps = scene.settings.steps_per_second;
  throw scenes::SceneError({scenes::diagnostic_at(
      scene, body.place,
      fmt::format("body '{}': it turns by {:.4g} degrees in the step at {:.4g} s, and in one step "
                  "of 1/{} s it must be less than 180, or it would turn the other way; turn it "
                  "more slowly, or set simulation.steps_per_second to at least {:.0f}",
                  body.name, turn, time, steps, std::ceil(1.01 * steps * turn / half_turn)))});
}

/// Degrees from one step to the next, at most: turns about the three axes added up.
double turn(const sim::Vec3& from, const sim::Vec3& to) { return (to - from).cwiseAbs().sum(); }

sim::Vec3 value(const sim::KeyFrame& key) { return {key[1], key[2], key[3]}; }

}  // namespace

void check_turns(const scenes::Scene& scene, const scenes::BodyScene& body) {
  const double step = sim::time_step(scene.settings);
  const double by_velocity = degrees * step * body.angular_velocity.norm();
  const bool turns_by_velocity = body.kind == scenes::BodyKind::moved && body.motion.empty();
  if (turns_by_velocity && by_velocity >= half_turn) refuse(scene, body, by_velocity, 0.0);
  const std::vector<sim::KeyFrame>& keys = body.motion.rotation;
  for (std::size_t i = 1; i < keys.size(); ++i) {
    const double start = keys[i - 1][0], end = keys[i][0];
    const double mean = turn(value(keys[i - 1]), value(keys[i])) * step / (end - start);
    if (steepest * mean < half_turn) continue;
    // The steps within it, and that in which it begins.
    for (auto n = std::floor(start / step); n * step < end; n += 1.0) {
      const double now = turn(sim::value_at(keys, body.motion.smooth, n * step),
                              sim::value_at(keys, body.motion.smooth, (n + 1.0) * step));
      if (now >= half_turn) refuse(scene, body, now, n * step);
    }
  }
}

}  // namespace pneuma::app
