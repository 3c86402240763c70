#include "app/study/horizon/horizon_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "app/host/interrupt.h"
#include "app/record/statistics.h"
#include "app/study/error/error_meter.h"
#include "app/study/power_law.h"
#include "app/world/build_world.h"
#include "app/world/replay.h"
#include "sim/rigid/rigid_motion.h"

namespace pneuma::app {
namespace {

using sim::Vec3;

// Of the rest radius: larger differences do not grow as small ones do.
constexpr double small_difference = 1e-2;
constexpr std::size_t least_fitted = 3;
// Two runs that are the same still have a place on a logarithmic axis.
constexpr double least_shown_difference = 1e-17;

/// Each component normally distributed, so that its expected square is `size`^2.
class RandomWay {
 public:
  RandomWay(std::uint64_t seed, double size)
      : random_(seed), component_(0.0, size / std::sqrt(3.0)) {}
  Vec3 operator()() {
    const double x = component_(random_), y = component_(random_), z = component_(random_);
    return {x, y, z};
  }

 private:
  std::mt19937_64 random_;
  std::normal_distribution<double> component_;
};

sim::World disturbed(sim::World world, int seed, double difference) {
  for (std::size_t i = 0; i < world.soft.size(); ++i) {
    sim::SoftBody& body = world.soft[i];
    RandomWay way(1000 * static_cast<std::uint64_t>(seed) + i, difference * rest_radius(body));
    for (int v = 0; v < body.positions.size(); ++v) body.positions[v] += way();
  }
  for (std::size_t i = 0; i < world.rigid.size(); ++i) {
    sim::RigidBox& box = world.rigid[i];
    if (box.is_kinematic) continue;
    const double radius = 0.5 * box.size.norm();
    RandomWay way(1000 * static_cast<std::uint64_t>(seed) + world.soft.size() + i,
                  difference * radius);
    box.position += way();
    box.orientation = sim::turned(box.orientation, way() / radius);
  }
  return world;
}

/// Steps until look i.
std::int64_t steps_until(std::size_t i, int steps_per_second) {
  return std::llround(static_cast<double>(i + 1) * steps_per_second / samples_per_second);
}

Trajectory run(sim::World world, std::size_t looks, const std::string& name) {
  Trajectory trajectory;
  sim::Stepper stepper(world);
  for (std::size_t i = 0; i < looks; ++i) {
    throw_if_interrupted();
    advance(stepper, world, steps_until(i, world.settings.steps_per_second) - world.steps, name);
    trajectory.push_back(take_sample(world));
  }
  return trajectory;
}

}  // namespace

double fit_growth(const std::vector<Difference>& differences) {
  std::vector<double> times, logarithms;
  for (const auto& [time, size] : differences) {
    if (size > small_difference) break;
    if (!(size > 0.0)) continue;
    times.push_back(time);
    logarithms.push_back(std::log(size));
  }
  if (times.size() < least_fitted) return std::numeric_limits<double>::quiet_NaN();
  return fit_line(times, logarithms).slope;
}

std::optional<double> Horizon::exceeds(double size) const {
  const auto first = std::ranges::find_if(
      differences, [&](const Difference& difference) { return difference.size > size; });
  if (first == differences.end()) return std::nullopt;
  return first->time;
}

Horizon study_horizon(const scenes::Scene& scene, const HorizonOptions& options,
                      const std::function<void(const std::string&)>& say) {
  Horizon horizon;
  horizon.name = scene.name;
  horizon.start = options.difference;
  const sim::World world = build_world(scene);
  const double seconds = std::min(options.seconds.value_or(scene.duration), scene.duration);
  const auto looks =
      static_cast<std::size_t>(std::max(1.0, std::floor(seconds * samples_per_second)));
  say("as it is");
  ErrorMeter meter(world, run(world, looks, scene.name));
  std::vector<std::vector<double>> sizes(looks);
  for (int seed = 1; seed <= options.tries; ++seed) {
    say(fmt::format("difference {}", seed));
    const Trajectory other = run(disturbed(world, seed, options.difference), looks, scene.name);
    for (std::size_t i = 0; i < looks; ++i) {
      sizes[i].push_back(meter.errors(i, other[i]).position);
    }
  }
  for (std::size_t i = 0; i < looks; ++i) {
    const auto steps = static_cast<double>(steps_until(i, world.settings.steps_per_second));
    horizon.differences.push_back(
        {steps / world.settings.steps_per_second, spread(sizes[i]).median});
  }
  horizon.growth_rate = fit_growth(horizon.differences);
  return horizon;
}

Diagram horizon_diagram(const std::vector<Horizon>& horizons) {
  Diagram diagram;
  diagram.title = "How a small difference at the start grows";
  diagram.x = {.label = "time, s"};
  diagram.y = {.label = "difference / rest radius", .logarithmic = true};
  for (const Horizon& horizon : horizons) {
    DiagramSeries& line = diagram.series.emplace_back();
    line.name = horizon.name;
    line.style = DiagramSeries::Style::line;
    for (const auto& [time, size] : horizon.differences) {
      line.points.push_back({time, std::max(size, least_shown_difference)});
    }
  }
  return diagram;
}

}  // namespace pneuma::app
