#include <nlohmann/json.hpp>

#include "app/bench_report.h"
#include "app/provenance.h"

namespace pneuma::app {
namespace {

using nlohmann::json;

json spread_json(const Spread& spread) {
  return {{"p5", spread.low}, {"median", spread.median}, {"p95", spread.high}};
}

json ratio(double fps, const std::optional<double>& paper_fps) {
  return paper_fps ? json(fps / *paper_fps) : json(nullptr);
}

json contacts_json(const ContactTally& contacts) {
  json kinds = json::object();
  for (int k = 0; k < sim::contact_kind_count; ++k) {
    const auto kind = static_cast<sim::ContactKind>(k);
    kinds[std::string(sim::to_string(kind))] = contacts.mean(contacts.of(kind));
  }
  return {{"mean", contacts.mean(contacts.all)},
          {"max", contacts.all.most},
          {"mean_between_bodies", contacts.mean_between_bodies()},
          {"share_of_steps_with_bodies_touching", contacts.touching_share()},
          {"mean_by_kind", std::move(kinds)}};
}

json stages_json(const SceneTimes& scene) {
  json stages = json::object();
  for (std::size_t s = 0; s < scene.stage_shares.size(); ++s) {
    const std::string name(sim::to_string(static_cast<sim::Stage>(s)));
    stages[name] = scene.plan.stages[s].runs ? json(scene.stage_shares[s]) : json(nullptr);
  }
  return stages;
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
                 {"simulation_over_paper", ratio(simulation.median, scene.paper_fps)},
                 {"picture", nullptr},
                 {"contacts_per_step", contacts_json(scene.contacts)},
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
                         {"over_paper", ratio(fps.median, scene.paper_fps)}};
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
                 {"clock_resolution_s", clock_resolution()},
                 {"warnings", report.warnings},
                 {"scenes", std::move(scenes)}});
  return result;
}

}  // namespace pneuma::app
