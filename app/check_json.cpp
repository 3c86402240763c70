#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "app/check_report.h"
#include "app/vector_json.h"
#include "scenes/print_scene.h"

namespace pneuma::app {
namespace {

using nlohmann::json;

json item_json(const sim::Plan::Item& item) {
  if (item.runs) return {{"runs", true}};
  return {{"runs", false}, {"reason", item.reason}};
}

json plan_json(const sim::Plan& plan) {
  json stages = json::object(), kinds = json::object();
  for (std::size_t s = 0; s < plan.stages.size(); ++s) {
    stages[std::string(sim::to_string(static_cast<sim::Stage>(s)))] = item_json(plan.stages[s]);
  }
  for (std::size_t k = 0; k < plan.contact_kinds.size(); ++k) {
    const auto kind = static_cast<sim::ContactKind>(k);
    kinds[std::string(sim::to_string(kind))] = item_json(plan.contact_kinds[k]);
  }
  return {{"stages", std::move(stages)},
          {"contact_kinds", std::move(kinds)},
          {"valence_weights", item_json(plan.valence_weights)},
          {"spring_damping", item_json(plan.spring_damping)}};
}

json size_json(const WorldSize& size) {
  return {{"soft_bodies", size.soft_bodies}, {"rigid_boxes", size.rigid_boxes},
          {"meshes", size.meshes},           {"vertices", size.vertices},
          {"springs", size.springs},         {"triangles", size.triangles},
          {"state_bytes", size.state_bytes}};
}

json momentum_json(const sim::Momentum& momentum) {
  return {{"linear_kg_m_per_s", vector_json(momentum.linear)},
          {"angular_kg_m2_per_s", vector_json(momentum.angular)}};
}

json energy_json(const sim::Energy& energy) {
  return {{"kinetic", energy.kinetic},
          {"spring", energy.spring},
          {"gas", energy.gas},
          {"gravity", energy.gravity},
          {"total", energy.total()}};
}

json contacts_json(const ContactTally& contacts) {
  const auto count_json = [&](const ContactTally::Count& count) -> json {
    return {{"mean", contacts.mean(count)}, {"max", count.most}};
  };
  json result = {{"all", count_json(contacts.all)}};
  for (int k = 0; k < sim::contact_kind_count; ++k) {
    const auto kind = static_cast<sim::ContactKind>(k);
    result[std::string(sim::to_string(kind))] = count_json(contacts.of(kind));
  }
  return result;
}

json steps_json(const std::vector<StepAdvice>& steps) {
  json result = json::array();
  for (const StepAdvice& advice : steps) {
    // JSON has no infinity: null says that no step is too long.
    const json limit = std::isinf(advice.limit) ? json(nullptr) : json(advice.limit);
    result.push_back({{"body", advice.body},
                      {"step_s", advice.step},
                      {"stable_up_to_s", limit},
                      {"too_long", advice.too_long()}});
  }
  return result;
}

}  // namespace

json run_statistics_json(const RunStatistics& run) {
  json volumes = json::array();
  for (const VolumeRange& range : run.volumes) {
    volumes.push_back({{"body", range.body},
                       {"start", range.start},
                       {"least", range.least},
                       {"greatest", range.greatest}});
  }
  return {
      {"steps", run.steps},
      {"seconds", run.seconds},
      {"divergence", run.divergence ? json(*run.divergence) : json(nullptr)},
      {"penetration_m",
       {{"greatest", run.penetration.value},
        {"at_s", run.penetration.time},
        {"at_start", run.start_penetration},
        {"greatest_in_last_half", run.settled_penetration}}},
      {"energy_J",
       {{"start", energy_json(run.energy_start)},
        {"end", energy_json(run.energy_end)},
        {"drift", run.energy_end.total() - run.energy_start.total()},
        {"greatest_rise_between_frames", run.energy_rise.value},
        {"greatest_rise_at_s", run.energy_rise.time},
        {"all_rises", run.energy_rises},
        {"span", run.energy_span}}},
      {"contacts_per_step", contacts_json(run.contacts)},
      {"volumes_m3", std::move(volumes)},
      {"free", run.free},
      {"momentum",
       {{"start", momentum_json(run.momentum_start)}, {"end", momentum_json(run.momentum_end)}}},
      {"end_speed_m_per_s", run.end_speed},
      {"at_rest", run.end_speed < rest_speed && !run.divergence},
      {"state_hash", fmt::format("{:016x}", run.state_hash)}};
}

json check_json(const CheckReport& report) {
  return {{"scene", report.scene.name},
          {"effective_scene", scenes::print_scene(report.scene)},
          {"plan", plan_json(report.plan)},
          {"size", size_json(report.size)},
          {"steps", steps_json(report.steps)},
          {"run", report.run ? run_statistics_json(*report.run) : json(nullptr)}};
}

}  // namespace pneuma::app
