#include "benchmarks/peer/equal_quality.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "app/host/clock.h"
#include "app/world/build_world.h"
#include "benchmarks/peer/bullet_world.h"
#include "benchmarks/peer/quality.h"
#include "scenes/loader/integrator_names.h"
#include "scenes/loader/load_scene.h"
#include "sim/step/stepper.h"

namespace pneuma::benchmarks {
namespace {

constexpr double lost = std::numeric_limits<double>::infinity();

/// 20 kg in all and the same springs at every size: the membrane's stiffness does not depend on how
/// finely it is cut, its lightest waves do.
sim::World sphere(int subdivisions, int steps_per_second) {
  const double vertices = 10.0 * std::pow(4.0, subdivisions) + 2.0;
  const std::string text = fmt::format(
      "[simulation]\nsteps_per_second = {}\nsleep_speed = 0\n[[body]]\nshape = "
      "\"icosphere\"\nsubdivisions = {}\n"
      "position = [0, 0, 3.1]\nn = 0.5\nk = 50.0\nvertex_mass = {}\n",
      steps_per_second, subdivisions, 20.0 / vertices);
  return app::build_world(scenes::parse_scene(text, "icosphere.toml"));
}

/// Runs `step` for `seconds` at the rate; greatest volume error over the last second, and the time.
QualityTry measure(const std::string& setting, double seconds, int rate, double exact,
                   const std::function<bool()>& step, const std::function<double()>& volume) {
  QualityTry result{setting};
  const int steps = static_cast<int>(seconds * rate);
  double took = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double before = app::thread_seconds();
    const bool sound = step();
    took += app::thread_seconds() - before;
    if (!sound) return {setting, took / (i + 1) * rate, lost};
    if (i < steps - rate) continue;
    const double error = std::abs(volume() / exact - 1.0);
    result.volume_error = std::isfinite(error) ? std::max(result.volume_error, error) : lost;
  }
  result.seconds_per_second = took / steps * rate;
  return result;
}

QualityTry try_bullet(int subdivisions, double seconds, int rate, int iterations) {
  const sim::World start = sphere(subdivisions, rate);
  BulletWorld world(start, {.position_iterations = iterations});
  const auto step = [&] {
    world.step();
    return true;
  };
  return measure(fmt::format("{} iterations, 1/{} s", iterations, rate), seconds, rate,
                 soft_volume(start), step, [&] { return world.volume(0); });
}

QualityTry try_ours(int subdivisions, double seconds, int rate, sim::Integrator integrator,
                    std::string_view name, double exact) {
  sim::World world = sphere(subdivisions, rate);
  world.settings.integrator = integrator;
  sim::Stepper stepper(world);
  return measure(
      fmt::format("{}, 1/{} s", name, rate), seconds, rate, exact,
      [&] { return !stepper.step(world); }, [&] { return soft_volume(world); });
}

/// At rest, with drag that takes a fifth of the velocity in 1/60 s.
double rest_volume(int subdivisions, double seconds) {
  sim::World world = sphere(subdivisions, 480);
  world.soft[0].material.rho_g = 0.2;
  sim::Stepper stepper(world);
  while (sim::time(world) < seconds) {
    if (stepper.step(world)) return lost;
  }
  return soft_volume(world);
}

}  // namespace

const QualityTry* cheapest_good(const std::vector<QualityTry>& tries) {
  const QualityTry* best = nullptr;
  for (const QualityTry& one : tries) {
    const bool better = best == nullptr || one.seconds_per_second < best->seconds_per_second;
    if (one.good() && better) best = &one;
  }
  return best;
}

QualityComparison compare_quality(int subdivisions, double seconds) {
  QualityComparison result;
  const double exact = rest_volume(subdivisions, seconds);
  result.vertices = sphere(subdivisions, 60).soft[0].positions.size();
  for (const int rate : {60, 120, 240}) {
    for (const int iterations : {1, 2, 4, 8, 16, 32, 64}) {
      result.bullet.push_back(try_bullet(subdivisions, seconds, rate, iterations));
      if (result.bullet.back().good()) break;  // more iterations only cost more
    }
    for (const auto& [integrator, name] : scenes::integrator_names()) {
      if (sim::is_implicit(integrator)) continue;
      result.ours.push_back(try_ours(subdivisions, seconds, rate, integrator, name, exact));
    }
  }
  return result;
}

}  // namespace pneuma::benchmarks
