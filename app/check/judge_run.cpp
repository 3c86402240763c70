#include "app/check/judge_run.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/check/check_report.h"

namespace pneuma::app {
namespace {

/// With swept contacts only boxes cross, and by little; by the potential nothing does.
std::string what_keeps_apart(const scenes::Scene& scene) {
  const sim::Settings& settings = scene.settings;
  if (settings.contact == sim::ContactMethod::potential) {
    return "contact by potential should have kept them apart: an error of the program";
  }
  if (settings.contact == sim::ContactMethod::swept) {
    const bool has_moved = std::ranges::any_of(scene.bodies, [](const scenes::BodyScene& body) {
      return body.kind == scenes::BodyKind::moved;
    });
    return fmt::format("a greater simulation.steps_per_second{} keeps boxes further apart",
                       has_moved ? ", or more room beside what is moved," : "");
  }
  const char* method = sim::is_as_printed(settings) ? "simulation.method=corrected --set " : "";
  return fmt::format(
      "--set {}simulation.contact=swept keeps bodies apart, boxes to within millimetres", method);
}

}  // namespace

RunVerdict judge_run(const scenes::Scene& scene, const RunStatistics& run) {
  const CrossingStatistics& crossings = run.crossings;
  const StartOverlapStatistics& start = run.start_overlap;
  RunVerdict verdict;
  if (start.pairs > 0) {
    verdict.words = fmt::format("{}: {}\n", scene.name, start_overlap_text(start));
  }
  if (start.left > 0 || crossings.frames > 0) verdict.code = ExitCode::check_failed;
  if (run.sunk.frames > 0) {
    const bool is_swept = scene.settings.contact == sim::ContactMethod::swept;
    verdict.code = ExitCode::check_failed;
    verdict.words += fmt::format(
        "{}: {} is up to {:.2g} m in the ground, at {:.2f} s, and bodies are in {} of {} frames; a "
        "greater simulation.steps_per_second, or masses that are less different, keep them out{}\n",
        scene.name, run.sunk.body, run.sunk.depth.value, run.sunk.depth.time, run.sunk.frames,
        run.frames, is_swept ? "" : ", or --set simulation.contact=swept");
  }
  if (crossings.frames == 0) return verdict;
  verdict.words += fmt::format(
      "{}: bodies pass through each other in {} of {} frames, most of all {} at {:.2f} s; "
      "penetration at most {:.2g} m; {}\n",
      scene.name, crossings.frames, run.frames, crossings.first_bodies, crossings.edges.time,
      run.penetration.value, what_keeps_apart(scene));
  return verdict;
}

}  // namespace pneuma::app
