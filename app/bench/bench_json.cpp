#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "app/bench/bench_report.h"
#include "app/record/provenance.h"
#include "app/record/world_json.h"

namespace pneuma::app {
namespace {

using nlohmann::json;

json spread_json(const Spread& spread) {
  return {{"p5", spread.low}, {"median", spread.median}, {"p95", spread.high}};
}

json ratio_json(double fps, const std::optional<double>& paper_fps) {
  return paper_fps ? json(fps / *paper_fps) : json(nullptr);
}

json paper_method_json(const PaperMethodFps& paper_method) {
  const auto& [fps, reason] = paper_method;
  return {{"fps", fps ? spread_json(*fps) : json(nullptr)},
          {"not_measured_because", reason.empty() ? json(nullptr) : json(reason)}};
}

json stages_json(const SceneTimes& scene) {
  return json_by_stage([&](sim::Stage stage) {
    const double share = scene.stage_shares[static_cast<std::size_t>(stage)];
    return scene.plan.runs(stage) ? json(share) : json(nullptr);
  });
}

json scene_json(const SceneTimes& scene) {
  const Spread simulation = simulation_fps(scene);
  json result = {{"scene", scene.name},
                 {"title", scene.title},
                 {"figure", scene.figure},
                 {"paper_fps", scene.paper_fps ? json(*scene.paper_fps) : json(nullptr)},
                 {"bodies", scene.bodies},
                 {"measured_from_s", scene.measured_from},
                 {"measured_to_s", scene.measured_to},
                 {"steps", scene.steps},
                 {"steps_per_clock_reading", scene.steps_per_reading},
                 {"steps_per_frame", scene.steps_per_frame},
                 {"step_s", spread_json(scene.step_seconds)},
                 {"simulation_fps", spread_json(simulation)},
                 {"simulation_over_paper", ratio_json(simulation.median, scene.paper_fps)},
                 {"paper_method", paper_method_json(scene.paper_method)},
                 {"picture", nullptr},
                 {"contacts_per_step", contacts_per_step_json(scene.contacts)},
                 {"stage_shares", stages_json(scene)},
                 {"processor_share", scene.processor_share}};
  if (scene.frames) {
    const Spread fps = inverse(scene.frames->seconds);
    result["picture"] = {{"width", scene.frames->width},
                         {"height", scene.frames->height},
                         {"png", "encoded to memory"},
                         {"frames", scene.frames->frames},
                         {"frame_s", spread_json(scene.frames->seconds)},
                         {"fps", spread_json(fps)},
                         {"median_part_s",
                          {{"step", scene.frames->steps},
                           {"mesh", scene.frames->build},
                           {"draw", scene.frames->draw},
                           {"png", scene.frames->encode}}},
                         {"over_paper", ratio_json(fps.median, scene.paper_fps)}};
  }
  return result;
}

}  // namespace

json bench_json(const BenchReport& report) {
  json scenes = json::array();
  for (const SceneTimes& scene : report.scenes) scenes.push_back(scene_json(scene));

  json result = provenance_json();
  result.update({{"date", report.date},
                 {"threads", report.options.threads},
                 {"show", fmt::format("{}", fmt::join(shown_names(report.options.show), ","))},
                 {"clock_resolution_s", clock_resolution()},
                 {"warnings", report.warnings},
                 {"scenes", std::move(scenes)}});
  return result;
}

}  // namespace pneuma::app
