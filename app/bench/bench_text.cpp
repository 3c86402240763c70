#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "app/bench/bench_report.h"
#include "app/record/provenance.h"
#include "app/terminal/table.h"

namespace pneuma::app {
namespace {

using Align = Table::Align;

constexpr std::size_t text_width = 120;

std::string ratio_text(double fps, const std::optional<double>& paper_fps) {
  return paper_fps ? readable(fps / *paper_fps) + "x" : "-";
}

/// The bench draws all scenes in one size.
const FrameTimes* picture_size(const std::vector<SceneTimes>& scenes) {
  return scenes.empty() || !scenes.front().frames ? nullptr : &*scenes.front().frames;
}

std::string percent(double share) { return fmt::format("{:.0f}%", 100.0 * share); }

void add(std::vector<std::string>& cells, std::vector<std::string> more) {
  cells.insert(cells.end(), more.begin(), more.end());
}

std::string fps_table(const BenchReport& report) {
  std::vector<Table::Column> columns = {{"scene", Align::left}, {"paper\nfps"}};
  const auto add_group = [&](const std::string& group) {
    for (const char* heading : {"median", "5th", "95th", "/ paper"}) {
      columns.push_back({heading, Align::right, group});
    }
  };
  add_group("simulation only, fps");
  columns.push_back({"as\nprinted", Align::right, "simulation only, fps"});
  if (picture_size(report.scenes)) add_group("with picture, fps");

  Table table(std::move(columns));
  for (const SceneTimes& scene : report.scenes) {
    std::vector<std::string> cells = {
        scene.name, scene.paper_fps ? fmt::format("{:g}", *scene.paper_fps) : "-"};
    const auto add_spread = [&](const Spread& fps) {
      add(cells, {readable(fps.median), readable(fps.low), readable(fps.high),
                  ratio_text(fps.median, scene.paper_fps)});
    };
    add_spread(simulation_fps(scene));
    const std::optional<Spread>& printed = scene.paper_method.fps;
    cells.push_back(printed ? readable(printed->median) : "-");
    if (scene.frames) add_spread(inverse(scene.frames->seconds));
    table.add_row(std::move(cells));
  }
  return table.text();
}

std::string step_table(const BenchReport& report) {
  Table table({{"scene", Align::left},
               {"median", Align::right, "time of a step, us"},
               {"5th", Align::right, "time of a step, us"},
               {"95th", Align::right, "time of a step, us"},
               {"bodies"},
               {"all", Align::right, "contacts per step"},
               {"between bodies", Align::right, "contacts per step"},
               {"steps with\nbodies touching"}});
  for (const SceneTimes& scene : report.scenes) {
    const auto microseconds = [](double seconds) { return readable(1e6 * seconds); };
    const bool pairs = scene.bodies > 1;
    table.add_row({scene.name, microseconds(scene.step_seconds.median),
                   microseconds(scene.step_seconds.low), microseconds(scene.step_seconds.high),
                   grouped(scene.bodies), readable(scene.contacts.mean(scene.contacts.all)),
                   pairs ? readable(scene.contacts.mean_between_bodies()) : "-",
                   pairs ? percent(scene.contacts.touching_share()) : "-"});
  }
  return table.text();
}

std::string frame_table(const BenchReport& report) {
  constexpr const char* whole = "time of a frame, ms";
  constexpr const char* parts = "medians of its parts";
  Table table({{"scene", Align::left},
               {"median", Align::right, whole},
               {"5th", Align::right, whole},
               {"95th", Align::right, whole},
               {"step", Align::right, parts},
               {"mesh", Align::right, parts},
               {"draw", Align::right, parts},
               {"PNG", Align::right, parts},
               {"frames\nmeasured"}});
  for (const SceneTimes& scene : report.scenes) {
    if (!scene.frames) continue;
    const FrameTimes& frame = *scene.frames;
    std::vector<std::string> cells = {scene.name};
    for (const double seconds : {frame.seconds.median, frame.seconds.low, frame.seconds.high,
                                 frame.steps, frame.build, frame.draw, frame.encode}) {
      cells.push_back(readable(1e3 * seconds));
    }
    cells.push_back(grouped(frame.frames));
    table.add_row(std::move(cells));
  }
  return table.text();
}

/// "integrate_soft" on two lines, to keep columns narrow.
std::string two_lines(std::string_view stage) {
  std::string text(stage);
  std::ranges::replace(text, '_', '\n');
  return text;
}

std::string stage_table(const BenchReport& report) {
  constexpr const char* group = "fraction of each stage in a step";
  std::vector<Table::Column> columns = {{"scene", Align::left}};
  for (int s = 0; s < sim::stage_count; ++s) {
    columns.push_back({two_lines(sim::to_string(static_cast<sim::Stage>(s))), Align::right, group});
  }
  Table table(std::move(columns));
  for (const SceneTimes& scene : report.scenes) {
    std::vector<std::string> cells = {scene.name};
    for (std::size_t s = 0; s < scene.stage_shares.size(); ++s) {
      cells.push_back(scene.plan.stages[s].runs ? percent(scene.stage_shares[s]) : "-");
    }
    table.add_row(std::move(cells));
  }
  return table.text();
}

/// "from 2 s to the end": one line per different part, since scenes differ in length.
std::string measured_parts(const std::vector<SceneTimes>& scenes) {
  std::set<std::string> parts;
  for (const SceneTimes& scene : scenes) {
    parts.insert(fmt::format("{:g} s to {:g} s", scene.measured_from, scene.measured_to));
  }
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : ", ") + part;
  return text;
}

std::string legend(const BenchReport& report) {
  std::string text =
      "A frame is the paper's: 1/60 s of the scene's time, drawn once.\n"
      "  simulation only  the steps of a frame (one, at the usual 60 steps a second)\n";
  if (const FrameTimes* picture = picture_size(report.scenes)) {
    text += fmt::format(
        "  with picture     the same, and drawing {} x {} pixels, and encoding them as PNG to "
        "memory\n",
        picture->width, picture->height);
    const std::vector<std::string> shown = shown_names(report.options.show);
    if (!shown.empty()) {
      text += fmt::format("                   also drawn: {}\n", fmt::join(shown, ", "));
    }
  }
  return text +
         "  5th, 95th        percentiles: 5 of 100 values are below, 5 above\n"
         "  / paper          the median over the paper's frame rate\n"
         "  as printed       the median by the paper's method: simulation.method = \"paper\"\n";
}

std::string notes(const BenchReport& report) {
  std::string text = fmt::format(
      "Measured: {} of each scene, over and over, the steps before not counted; {} thread{}.\n"
      "Steps and fractions of the stages come from separate runs, as reading the clock costs "
      "time.\n"
      "\"-\": not there, or left out of the step by its plan; why is what pneuma check SCENE "
      "says.\n",
      measured_parts(report.scenes), report.options.threads,
      report.options.threads == 1 ? "" : "s");
  for (const SceneTimes& scene : report.scenes) {
    if (scene.steps_per_reading > 1) {
      text += fmt::format("{}: {} steps per reading of the clock, which resolves {:.0f} ns.\n",
                          scene.name, scene.steps_per_reading, 1e9 * clock_resolution());
    }
  }
  for (const SceneTimes& scene : report.scenes) {
    const std::string& reason = scene.paper_method.reason;
    if (reason.empty()) continue;
    text += wrapped(fmt::format("{} as printed: {}.", scene.name, reason), text_width) + '\n';
  }
  return text + provenance_text(report.date);
}

}  // namespace

std::vector<std::string> measurement_warnings(const std::vector<SceneTimes>& scenes) {
  // A thread that had less than this of a core was interrupted often enough to shift percentiles.
  constexpr double least_processor_share = 0.95;
  double least = 1.0;
  std::string names;
  for (const SceneTimes& scene : scenes) {
    if (scene.processor_share >= least_processor_share) continue;
    least = std::min(least, scene.processor_share);
    names += (names.empty() ? "" : ", ") + scene.name;
  }
  if (names.empty()) return {};
  return {
      fmt::format("the machine was busy with something else while these were measured, which had "
                  "a core for as little as {} of the time: {}",
                  percent(least), names)};
}

std::string bench_text(const BenchReport& report) {
  std::string text = legend(report) + '\n' + fps_table(report) + '\n' + step_table(report) + '\n' +
                     stage_table(report) + '\n';
  if (picture_size(report.scenes)) text += frame_table(report) + '\n';
  text += notes(report);
  for (const std::string& warning : report.warnings) {
    text += wrapped("Warning: " + warning + ".", text_width) + '\n';
  }
  return text;
}

}  // namespace pneuma::app
