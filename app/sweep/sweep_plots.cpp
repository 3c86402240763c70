#include "app/sweep/sweep_plots.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <set>
#include <stdexcept>

#include "app/sweep/sweep_table.h"

namespace pneuma::app {
namespace {

/// Which parameters have numbers and change.
std::vector<std::size_t> varied_numbers(const Sweep& sweep) {
  std::vector<std::size_t> found;
  for (std::size_t p = 0; p < sweep.parameters.size(); ++p) {
    const Parameter& parameter = sweep.parameters[p];
    const bool numbers = std::ranges::all_of(
        parameter.values, [](const std::string& value) { return std::isfinite(number_of(value)); });
    if (numbers && parameter.values.size() != 1) found.push_back(p);
  }
  return found;
}

/// A list of values is taken for logarithmic where it spans a factor of a hundred.
bool is_logarithmic(const Parameter& parameter) {
  if (parameter.is_random() || parameter.logarithmic) return parameter.logarithmic;
  double low = number_of(parameter.values.front()), high = low;
  for (const std::string& value : parameter.values) {
    low = std::min(low, number_of(value));
    high = std::max(high, number_of(value));
  }
  return low > 0.0 && high >= 100.0 * low;
}

DiagramAxis axis_of(const Parameter& parameter) {
  return {.label = parameter.key, .logarithmic = is_logarithmic(parameter)};
}

/// "energy, J".
std::string label_of(const Measure& measure) {
  const std::string_view unit = unit_of(measure);
  return unit.empty() ? measure.name : fmt::format("{}, {}", measure.name, unit);
}

/// A file's name of it: only letters that every system takes.
std::string file_text(std::string text) {
  std::ranges::replace_if(
      text, [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '-'; },
      '_');
  return text;
}

/// Numbers of one scene and one measure, with a series for each choice of the other parameters.
class ScenePlot {
 public:
  ScenePlot(const Sweep& sweep, const SweepRows& rows, const std::string& scene,
            const Measure& measure)
      : sweep_(sweep), rows_(rows), scene_(scene), measure_(measure) {}

  Diagram curve(std::size_t x) const {
    Diagram diagram;
    diagram.title = title();
    diagram.x = axis_of(sweep_.parameters[x]);
    diagram.y = {.label = label_of(measure_)};
    const bool random = sweep_.parameters[x].is_random();
    std::map<std::string, DiagramSeries> series;
    for_each([&](const SweepRun& run, double value) {
      const std::string name = others(run, {x});
      series[name].name = name;
      series[name].points.push_back({number_of(run.values[x]), value});
    });
    for (auto& [name, one] : series) {
      if (random) one.style = DiagramSeries::Style::marks;
      std::ranges::sort(one.points, {}, &DiagramPoint::x);
      diagram.series.push_back(one);
    }
    return diagram;
  }

  /// One for each choice of the other parameters, which it is called by.
  std::map<std::string, HeatMap> maps(std::size_t x, std::size_t y) const {
    std::map<std::string, HeatMap> maps;
    for_each([&](const SweepRun& run, double value) {
      const std::string name = others(run, {x, y});
      HeatMap& map = maps[name];
      map.title = title() + (name.empty() ? "" : ", " + name);
      map.cells.push_back(
          {.x = number_of(run.values[x]), .y = number_of(run.values[y]), .value = value});
    });
    for (auto& [name, map] : maps) {
      map.value_label = label_of(measure_);
      map.x = axis_of(sweep_.parameters[x]);
      map.y = axis_of(sweep_.parameters[y]);
      map.random = sweep_.parameters[x].is_random() || sweep_.parameters[y].is_random();
    }
    return maps;
  }

  bool has_numbers() const {
    bool any = false;
    for_each([&](const SweepRun&, double value) { any = any || std::isfinite(value); });
    return any;
  }

 private:
  std::string title() const {
    return fmt::format("{}: {} of {}", sweep_.name, measure_.name, scene_);
  }

  template <class Use>
  void for_each(const Use& use) const {
    for (const auto& [number, row] : rows_) {
      const SweepRun run = run_of(sweep_, number);
      if (run.scene != scene_) continue;
      // What a run had when it diverged is no measure of its scene.
      const double unknown = std::numeric_limits<double>::quiet_NaN();
      use(run, came_to_its_end(row) ? number_of(row.values.at(measure_.name)) : unknown);
    }
  }

  /// "simulation.integrator = rk4": what tells this series from the others.
  std::string others(const SweepRun& run, const std::set<std::size_t>& axes) const {
    std::string text;
    for (std::size_t p = 0; p < run.values.size(); ++p) {
      if (axes.contains(p) || sweep_.parameters[p].is_random()) continue;
      text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", sweep_.parameters[p].key,
                          run.values[p]);
    }
    return text;
  }

  const Sweep& sweep_;
  const SweepRows& rows_;
  const std::string& scene_;
  const Measure& measure_;
};

/// "_simulation_integrator_rk4" of "simulation.integrator = "rk4"".
std::string name_ending(std::string others) {
  std::erase_if(others, [](char c) { return c == ' ' || c == '"'; });
  return others.empty() ? "" : "_" + file_text(others);
}

}  // namespace

std::vector<std::string> write_sweep_plots(const StudyFolder& folder, const Sweep& sweep,
                                           const SweepRows& rows) {
  std::vector<std::string> written;
  const std::vector<std::size_t> numbers = varied_numbers(sweep);
  if (numbers.empty() || numbers.size() > 2) return written;
  for (const std::string& scene : sweep.scenes) {
    for (const Measure& measure : sweep.measures) {
      const ScenePlot plot(sweep, rows, scene, measure);
      if (!plot.has_numbers()) continue;
      std::string name = file_text(measure.name);
      if (sweep.scenes.size() > 1) {
        name = file_text(std::filesystem::path(scene).stem().string()) + "_" + name;
      }
      name = file_text(sweep.name) + "_" + name;
      if (numbers.size() == 1) {
        write_diagram(folder, name, plot.curve(numbers[0]));
        written.push_back((folder.path() / name).string());
        continue;
      }
      for (const auto& [others, map] : plot.maps(numbers[1], numbers[0])) {
        const std::string one = name + name_ending(others);
        write_script(folder, one, heat_map_script(map, one));
        written.push_back((folder.path() / one).string());
      }
    }
  }
  return written;
}

}  // namespace pneuma::app
