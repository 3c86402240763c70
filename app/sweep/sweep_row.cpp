#include "app/sweep/sweep_row.h"

#include <fmt/format.h>

#include <exception>

#include "app/check/check_report.h"
#include "app/check/judge_run.h"
#include "app/host/clock.h"
#include "app/host/errors.h"
#include "app/host/failure.h"
#include "app/sweep/render_run.h"
#include "app/world/open_scene.h"

namespace pneuma::app {
namespace {

namespace fs = std::filesystem;

/// Runs may differ in it: "" where it is the default, or named.
std::string chosen_steps(const scenes::Scene& scene) {
  const int steps = scene.settings.steps_per_second;
  if (scene.names_step ||
      steps == scenes::default_steps_per_second(scene.picture.frames_per_second)) {
    return "";
  }
  return fmt::format("{} steps per second", steps);
}

void run_into(SweepRow& row, const Sweep& sweep, const SweepRun& run, const fs::path& folder) {
  const scenes::Scene scene = open_scene(run.scene_path, run.overrides(sweep));
  build_checked_world(scene);
  const RunStatistics statistics = run_statistics(scene, 1, OnDivergence::stop);
  const nlohmann::json json = run_statistics_json(statistics);
  for (const Measure& measure : sweep.measures) {
    const bool counts = !statistics.divergence || is_of_length(measure);
    if (counts) row.values[measure.name] = measured(measure, json);
  }
  if (statistics.divergence) throw DivergenceError(*statistics.divergence);
  const RunVerdict verdict = judge_run(scene, statistics);
  row.code = verdict.code;
  row.words = verdict.code == ExitCode::done ? chosen_steps(scene) : verdict.words;
  if (sweep.frames == SweepFrames::none || folder.empty()) return;
  const std::int64_t last = scenes::frame_count(scene);
  render_run(sweep, run, sweep.frames == SweepFrames::last ? fmt::format("{0}-{0}", last) : "",
             picture_folder(folder, run.number));
}

std::string trimmed(std::string text) {
  text.erase(text.find_last_not_of(" \n") + 1);
  return text;
}

}  // namespace

SweepRow run_one(const Sweep& sweep, const SweepRun& run, const fs::path& folder) {
  SweepRow row;
  row.run = run.number;
  row.values = nlohmann::ordered_json::object();
  for (const Measure& measure : sweep.measures) row.values[measure.name] = nullptr;
  Stopwatch watch;
  try {
    run_into(row, sweep, run, folder);
  } catch (const Interrupted&) {
    throw;
  } catch (...) {
    const Failure failure = failure_of(std::current_exception());
    row.code = failure.code;
    row.words = failure.words;
  }
  row.words = trimmed(row.words);
  row.seconds = watch.lap();
  return row;
}

std::string verdict_text(ExitCode code) {
  switch (code) {
    case ExitCode::done:
      return "done";
    case ExitCode::internal_error:
      return "program error";
    case ExitCode::usage:
      return "refused";
    case ExitCode::invalid_scene:
      return "invalid";
    case ExitCode::no_gl:
      return "no OpenGL";
    case ExitCode::diverged:
      return "diverged";
    case ExitCode::input_output:
      return "input or output failed";
    case ExitCode::check_failed:
      return "crossed";
    case ExitCode::interrupted:
      return "interrupted";
  }
  return "program error";
}

nlohmann::ordered_json row_json(const SweepRow& row) {
  return {{"run", row.run},
          {"exit_code", static_cast<int>(row.code)},
          {"words", row.words},
          {"values", row.values},
          {"seconds", row.seconds}};
}

SweepRow row_of(const nlohmann::ordered_json& json) {
  return {.run = json.at("run").get<std::int64_t>(),
          .code = static_cast<ExitCode>(json.at("exit_code").get<int>()),
          .words = json.at("words").get<std::string>(),
          .values = json.at("values"),
          .seconds = json.at("seconds").get<double>()};
}

}  // namespace pneuma::app
