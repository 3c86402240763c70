#include "app/runs/plot_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "app/files/refuse_to_replace.h"
#include "app/host/errors.h"
#include "app/study/csv.h"

namespace pneuma::app {
namespace {

/// null, which stands for what is not finite, draws nothing.
double number(const Json& value) {
  return value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN();
}

using Place = Json::json_pointer;

/// Of a member that not every frame has, nor every record.
double member(const Json& frame, const Place& place) {
  return frame.contains(place) ? number(frame.at(place)) : std::numeric_limits<double>::quiet_NaN();
}

/// The names of a frame's member, of all frames, in their order.
std::vector<std::string> names_in(const RecordedRun& run, const std::string& group) {
  std::vector<std::string> names;
  for (const Json& frame : run.frames()) {
    if (!frame.contains(group)) continue;
    for (const auto& [name, value] : frame[group].items()) {
      if (std::ranges::find(names, name) == names.end()) names.push_back(name);
    }
  }
  return names;
}

/// mol, of a body; frames in which it has none leave it out.
double amount_of_gas(const Json& frame, const std::string& body) {
  const double n = member(frame, Place() / "gas" / body / "n");
  return std::isfinite(n) ? n : 0.0;
}

/// The bodies whose gas comes or goes.
std::vector<std::string> filled_bodies(const RecordedRun& run) {
  std::vector<std::string> bodies = names_in(run, "gas");
  std::erase_if(bodies, [&](const std::string& body) {
    const double first = amount_of_gas(run.frames().front(), body);
    return std::ranges::all_of(
        run.frames(), [&](const Json& frame) { return amount_of_gas(frame, body) == first; });
  });
  return bodies;
}

using Value = std::function<double(const Json& frame)>;

DiagramSeries series_of(const RecordedRun& run, const std::string& name, const Value& value) {
  DiagramSeries series{.name = name, .points = {}, .style = DiagramSeries::Style::line};
  for (const Json& frame : run.frames()) {
    series.points.push_back({number(frame["time"]), value(frame)});
  }
  return series;
}

Diagram over_time(const RecordedRun& run, const std::string& what, const std::string& unit) {
  Diagram diagram;
  diagram.title = run.folder.name() + ": " + what;
  diagram.x = {.label = "time, s"};
  diagram.y = {.label = unit.empty() ? what : what + ", " + unit};
  return diagram;
}

/// A line per name in a group of each frame's members.
Diagram group_diagram(const RecordedRun& run, const std::string& group, const std::string& what,
                      const std::string& unit) {
  Diagram diagram = over_time(run, what, unit);
  for (const std::string& name : names_in(run, group)) {
    diagram.series.push_back(series_of(
        run, name, [&](const Json& frame) { return member(frame, Place() / group / name); }));
  }
  return diagram;
}

Diagram pressure_diagram(const RecordedRun& run) {
  Diagram diagram = over_time(run, "pressure above that outside", "Pa");
  for (const std::string& body : names_in(run, "gas")) {
    diagram.series.push_back(series_of(run, body, [&](const Json& frame) {
      return member(frame, Place() / "gas" / body / "gauge_pressure");
    }));
  }
  return diagram;
}

Diagram gas_diagram(const RecordedRun& run) {
  Diagram diagram = over_time(run, "gas", "mol");
  for (const std::string& body : filled_bodies(run)) {
    diagram.series.push_back(
        series_of(run, body, [&](const Json& frame) { return amount_of_gas(frame, body); }));
  }
  return diagram;
}

/// The gas energy counts from 1 m^3: only changes mean anything, and can share an axis.
Diagram energy_diagram(const RecordedRun& run) {
  Diagram diagram = group_diagram(run, "energy", "energy since the first frame", "J");
  for (DiagramSeries& series : diagram.series) {
    const double start = series.points.front().y;
    for (DiagramPoint& point : series.points) point.y -= start;
  }
  return diagram;
}

/// Stages differ by orders of magnitude. What took no time has no place on such an axis.
Diagram stages_diagram(const RecordedRun& run) {
  Diagram diagram = group_diagram(run, "seconds", "time a frame takes", "s");
  diagram.y.logarithmic = true;
  for (DiagramSeries& series : diagram.series) {
    for (DiagramPoint& point : series.points) {
      if (point.y <= 0.0) point.y = std::numeric_limits<double>::quiet_NaN();
    }
  }
  return diagram;
}

Diagram single_diagram(const RecordedRun& run, const std::string& what, const std::string& unit,
                       const Value& value) {
  Diagram diagram = over_time(run, what, unit);
  diagram.series.push_back(series_of(run, "", value));
  return diagram;
}

double contact_count(const Json& frame) { return number(frame["contacts"]["count"]); }
double penetration(const Json& frame) { return number(frame["greatest_penetration"]); }

bool shows_anything(const Diagram& diagram) {
  return std::ranges::any_of(diagram.series, [](const DiagramSeries& series) {
    return std::ranges::any_of(series.points,
                               [](const DiagramPoint& point) { return std::isfinite(point.y); });
  });
}

}  // namespace

std::vector<NamedDiagram> run_diagrams(const RecordedRun& run) {
  const std::string name = run.folder.name();
  std::vector<NamedDiagram> diagrams = {
      {name + "_energy", energy_diagram(run)},
      {name + "_volume", group_diagram(run, "volumes", "volume", "m^3")},
      {name + "_pressure", pressure_diagram(run)},
      {name + "_gas", gas_diagram(run)},
      {name + "_penetration", single_diagram(run, "max. penetration", "m", penetration)},
      {name + "_contacts", single_diagram(run, "contacts", "", contact_count)},
      {name + "_stages", stages_diagram(run)}};
  std::erase_if(diagrams,
                [](const NamedDiagram& diagram) { return !shows_anything(diagram.diagram); });
  return diagrams;
}

std::string run_csv(const RecordedRun& run) {
  std::vector<std::string> columns = {"frame", "time_s", "state_hash", "contacts", "penetration_m"};
  std::vector<Place> places;
  const auto add = [&](const Place& place, const std::string& heading) {
    places.push_back(place);
    columns.push_back(csv_cell(heading));
  };
  const auto add_group = [&](const std::string& group, const std::string& heading) {
    for (const std::string& name : names_in(run, group)) {
      add(Place() / group / name, fmt::format(fmt::runtime(heading), name));
    }
  };
  add_group("energy", "energy_{}_J");
  add_group("volumes", "volume_{}_m3");
  for (const std::string& body : names_in(run, "gas")) {
    add(Place() / "gas" / body / "gauge_pressure", fmt::format("pressure_{}_Pa", body));
  }
  for (const std::string& body : filled_bodies(run)) {
    add(Place() / "gas" / body / "n", fmt::format("gas_{}_mol", body));
  }
  add_group("seconds", "seconds_{}");
  Csv csv(columns);
  for (const Json& frame : run.frames()) {
    std::vector<std::string> cells = {
        csv_cell(frame["frame"].get<std::int64_t>()), csv_cell(number(frame["time"])),
        csv_cell(frame["state_hash"].get<std::string>()),
        csv_cell(frame["contacts"]["count"].get<std::int64_t>()), csv_cell(penetration(frame))};
    for (const Place& place : places) cells.push_back(csv_cell(member(frame, place)));
    csv.add_row(cells);
  }
  return csv.text();
}

ExitCode plot_run(const PlotRequest& request) {
  const RecordedRun run = read_run(request.run);
  if (request.csv) {
    if (!request.out.empty()) {
      throw UsageError(
          "--out is the folder of diagrams; --csv prints its table: write it to a file with > "
          "FILE");
    }
    fmt::print("{}", run_csv(run));
    return ExitCode::done;
  }
  const StudyFolder folder(request.out.empty() ? run.folder.path() / "plots"
                                               : std::filesystem::path(request.out));
  const std::vector<NamedDiagram> diagrams = run_diagrams(run);
  for (const auto& [name, diagram] : diagrams) {
    if (request.overwrite) break;
    refuse_to_replace(folder.path(), diagram_files(name), "choose another folder with --out");
  }
  for (const auto& [name, diagram] : diagrams) {
    const DiagramFiles files = write_diagram(folder, name, diagram);
    const std::filesystem::path drawn = folder.path() / (name + ".svg");
    fmt::print("{}\n", (files.drawn ? drawn : files.script).string());
  }
  return ExitCode::done;
}

}  // namespace pneuma::app
