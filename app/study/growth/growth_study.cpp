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

/// What is measured, at every size: the same part of the same motion. A scene at rest takes a third
/// of the time (its impulses are right at the first sweep), so that to measure as many steps as fit
/// into the time would compare small scenes at rest with large ones in motion.
struct MeasuredPart {
  double begin = 0.5;    // s, of the scene's time
  double seconds = 1.0;  // of the same
};
/// Of two balls that meet: until they press each other most.
constexpr MeasuredPart until_pressed{0.05, 0.25};

double icosphere_vertices(int subdivisions) { return 10.0 * std::pow(4.0, subdivisions) + 2.0; }

/// The material stays the same: springs of one stiffness, and vertices that share a mass of 20 kg.
/// So the step, about a quarter of the longest that is stable, shrinks with the edges.
std::string icosphere(int subdivisions) {
  return fmt::format(
      "[simulation]\nsteps_per_second = {}\n[[body]]\nshape = \"icosphere\"\nsubdivisions = "
      "{}\nposition = [0, 0, 3.1]\nn = 0.3\nk = 50\nvertex_mass = {}\n",
      15 << subdivisions, subdivisions, 20.0 / icosphere_vertices(subdivisions));
}

/// Two that meet at 4 m/s, of one material too.
std::string icospheres_in_contact(int subdivisions, const std::string& simulation) {
  const auto ball = [&](int side) {
    return fmt::format(
        "[[body]]\nshape = \"icosphere\"\nsubdivisions = {}\nposition = [{}, 0, 0]\nvelocity = "
        "[{}, 0, 0]\ninflation = 1.1\nk = 50\nvertex_mass = {}\n",
        subdivisions, 3.01 * side, -2 * side, 20.0 / icosphere_vertices(subdivisions));
  };
  return "[simulation]\ngravity = [0, 0, 0]\n" + simulation + "[ground]\npresent = false\n" +
         ball(-1) + ball(1);
}

/// The step shrinks with the edges.
std::string icospheres_by_rk4(int subdivisions) {
  return icospheres_in_contact(subdivisions,
                               fmt::format("steps_per_second = {}\n", 30 << subdivisions));
}

std::string icospheres_by_potential(int subdivisions) {
  return icospheres_in_contact(
      subdivisions,
      "steps_per_second = 60\nintegrator = \"implicit_euler\"\ncontact = \"potential\"\n");
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

GrowthPoint measure(double size, const std::string& toml, const MeasuredPart& part,
                    double seconds) {
  const scenes::Scene scene = scenes::parse_scene(toml, "growth.toml");
  sim::World settled = build_world(scene);
  settled.settings.sleep_speed = 0.0;  // what sleeps costs nothing, however much of it there is
  const int rate = settled.settings.steps_per_second;
  {
    sim::Stepper stepper(settled);
    advance(stepper, settled, static_cast<std::int64_t>(part.begin * rate), scene.name);
  }
  std::vector<double> times;
  const Budget budget({}, seconds, 1);
  while (budget.more(static_cast<std::int64_t>(times.size()))) {
    sim::World world = settled;
    sim::Stepper stepper(world);
    for (int step = 0; step < part.seconds * rate; ++step) {
      const double start = thread_seconds();
      advance(stepper, world, 1, scene.name);
      times.push_back(thread_seconds() - start);
    }
  }
  return {size, spread(std::move(times)).median, rate};
}

GrowthSeries measure(const std::string& name, const std::vector<int>& steps,
                     const std::function<double(int)>& size,
                     const std::function<std::string(int)>& scene, const MeasuredPart& part,
                     const GrowthOptions& options,
                     const std::function<void(const std::string&)>& say) {
  GrowthSeries series;
  series.name = name;
  std::vector<double> sizes, steps_seconds, seconds_seconds;
  for (const int step : steps) {
    say(fmt::format("{:g} {}", size(step), name));
    const GrowthPoint point = measure(size(step), scene(step), part, options.seconds_per_point);
    series.points.push_back(point);
    sizes.push_back(point.size);
    steps_seconds.push_back(point.step_seconds);
    seconds_seconds.push_back(point.seconds_per_second());
  }
  series.step = fit_power_law(sizes, steps_seconds);
  series.second = fit_power_law(sizes, seconds_seconds);
  return series;
}

}  // namespace

std::vector<GrowthSeries> study_growth(const GrowthOptions& options,
                                       const std::function<void(const std::string&)>& say) {
  using Steps = std::vector<int>;
  const auto both = [](int s) { return 2.0 * icosphere_vertices(s); };
  const auto square = [](int along) { return 1.0 * along * along; };
  const auto stacked = [](int along) { return 5.0 * along * along; };
  const bool few = options.few;
  return {measure("vertices", few ? Steps{2, 3} : Steps{2, 3, 4, 5, 6}, icosphere_vertices,
                  icosphere, {}, options, say),
          measure("vertices in contact", few ? Steps{1, 2} : Steps{3, 4, 5, 6}, both,
                  icospheres_by_rk4, until_pressed, options, say),
          measure("vertices in contact, by potential", few ? Steps{1, 2} : Steps{3, 4, 5}, both,
                  icospheres_by_potential, until_pressed, options, say),
          measure("soft spheres", few ? Steps{1, 3} : Steps{1, 3, 10, 18, 32}, square, spheres, {},
                  options, say),
          measure("cubes", few ? Steps{1, 3} : Steps{1, 2, 4, 8, 14}, stacked, stacks, {}, options,
                  say)};
}

Diagram growth_diagram(const std::vector<GrowthSeries>& series) {
  Diagram diagram;
  diagram.title = "Time of a simulated second per piece, over the number of pieces";
  diagram.x = {.label = "vertices, soft spheres, or cubes", .logarithmic = true};
  diagram.y = {.label = "time of a second / number, us", .logarithmic = true};
  for (const GrowthSeries& one : series) {
    DiagramSeries line;
    line.name = fmt::format("{}: exponent {:.2f}", one.name, one.second.exponent);
    for (const GrowthPoint& point : one.points) {
      line.points.push_back({point.size, 1e6 * point.seconds_per_second() / point.size});
    }
    diagram.series.push_back(std::move(line));
  }
  return diagram;
}

}  // namespace pneuma::app
