#include "app/study/growth/growth_study.h"

#include <fmt/format.h>

#include <cmath>

#include "app/host/budget.h"
#include "app/record/statistics.h"
#include "app/world/build_world.h"
#include "app/world/replay.h"
#include "scenes/loader/load_scene.h"

namespace pneuma::app {
namespace {

constexpr double settle_seconds = 0.5;
/// What is measured after that, at every size: the same second of the same motion. A scene at rest
/// takes a third of the time (its impulses are right at the first sweep), so that to measure as
/// many steps as fit into the time would compare small scenes at rest with large ones in motion.
constexpr double measured_seconds = 1.0;

/// Vertices share a mass of 20 kg, and springs soften with their number, so that every size moves
/// alike and is stable at 1/60 s.
std::string icosphere(int subdivisions) {
  const double vertices = 10.0 * std::pow(4.0, subdivisions) + 2.0;
  const double k = std::min(50.0, 50.0 * 642.0 / vertices);
  return fmt::format(
      "[[body]]\nshape = \"icosphere\"\nsubdivisions = {}\nposition = [0, 0, 3.1]\nn = 0.3\nk = "
      "{}\nvertex_mass = {}\n",
      subdivisions, k, 20.0 / vertices);
}

std::string spheres(int along) {
  return fmt::format(
      "[[body]]\nn = 1.0\ncopies = [{}, {}, 1]\nspacing = [9, 9, 9]\nposition = [0, 0, 3.5]\n",
      along, along);
}

std::string stacks(int along) {
  return fmt::format(
      "[[body]]\nkind = \"rigid\"\nsize = [1, 1, 1]\ncopies = [{}, {}, 5]\nspacing = [1.5, 1.5, "
      "1.0]\nposition = [0, 0, 0.5]\n",
      along, along);
}

double median_step(const std::string& toml, double seconds) {
  const scenes::Scene scene = scenes::parse_scene(toml, "growth.toml");
  sim::World settled = build_world(scene);
  const int rate = settled.settings.steps_per_second;
  {
    sim::Stepper stepper(settled);
    advance(stepper, settled, static_cast<std::int64_t>(settle_seconds * rate), scene.name);
  }
  std::vector<double> times;
  const Budget budget({}, seconds, 1);
  while (budget.more(static_cast<std::int64_t>(times.size()))) {
    sim::World world = settled;
    sim::Stepper stepper(world);
    for (int step = 0; step < measured_seconds * rate; ++step) {
      const double start = thread_seconds();
      advance(stepper, world, 1, scene.name);
      times.push_back(thread_seconds() - start);
    }
  }
  return spread(std::move(times)).median;
}

GrowthSeries measure(const std::string& name, const std::vector<int>& steps,
                     const std::function<double(int)>& size,
                     const std::function<std::string(int)>& scene, const GrowthOptions& options,
                     const std::function<void(const std::string&)>& say) {
  GrowthSeries series;
  series.name = name;
  std::vector<double> sizes, seconds;
  for (const int step : steps) {
    say(fmt::format("{:g} {}", size(step), name));
    series.points.push_back({size(step), median_step(scene(step), options.seconds_per_point)});
    sizes.push_back(series.points.back().size);
    seconds.push_back(series.points.back().step_seconds);
  }
  series.law = fit_power_law(sizes, seconds);
  return series;
}

}  // namespace

std::vector<GrowthSeries> study_growth(const GrowthOptions& options,
                                       const std::function<void(const std::string&)>& say) {
  using Steps = std::vector<int>;
  const auto vertices = [](int s) { return 10.0 * std::pow(4.0, s) + 2.0; };
  const auto square = [](int along) { return 1.0 * along * along; };
  const auto stacked = [](int along) { return 5.0 * along * along; };
  const bool few = options.few;
  return {
      measure("vertices", few ? Steps{2, 3} : Steps{2, 3, 4, 5, 6}, vertices, icosphere, options,
              say),
      measure("soft spheres", few ? Steps{1, 3} : Steps{1, 3, 10, 18, 32}, square, spheres, options,
              say),
      measure("cubes", few ? Steps{1, 3} : Steps{1, 2, 4, 8, 14}, stacked, stacks, options, say)};
}

Diagram growth_diagram(const std::vector<GrowthSeries>& series) {
  Diagram diagram;
  diagram.title = "Time of a step per piece, over the number of pieces";
  diagram.x = {.label = "vertices of one body, soft spheres, or cubes", .logarithmic = true};
  diagram.y = {.label = "time of a step / number, us", .logarithmic = true};
  for (const GrowthSeries& one : series) {
    DiagramSeries line;
    line.name = fmt::format("{}: exponent {:.2f}", one.name, one.law.exponent);
    for (const auto& [size, seconds] : one.points) {
      line.points.push_back({size, 1e6 * seconds / size});
    }
    diagram.series.push_back(std::move(line));
  }
  return diagram;
}

}  // namespace pneuma::app
