#include <nlohmann/json.hpp>

#include "app/check/check_report.h"
#include "app/record/world_json.h"
#include "scenes/loader/print_scene.h"

namespace pneuma::app {
namespace {

using nlohmann::json;

json item_json(const sim::Plan::Item& item) {
  if (item.runs) return {{"runs", true}};
  return {{"runs", false}, {"reason", item.reason}};
}

json plan_json(const sim::Plan& plan) {
  const auto stage_json = [&](sim::Stage stage) {
    return item_json(plan.stages[static_cast<std::size_t>(stage)]);
  };
  const auto kind_json = [&](sim::ContactKind kind) {
    return item_json(plan.contact_kinds[static_cast<std::size_t>(kind)]);
  };
  return {{"stages", json_by_stage(stage_json)},
          {"contact_kinds", json_by_contact_kind(kind_json)}};
}

json size_json(const WorldSize& size) {
  return {{"soft_bodies", size.soft_bodies}, {"rigid_boxes", size.rigid_boxes},
          {"meshes", size.meshes},           {"vertices", size.vertices},
          {"springs", size.springs},         {"triangles", size.triangles},
          {"state_bytes", size.state_bytes}};
}

json steps_json(const std::vector<StepAdvice>& steps) {
  json result = json::array();
  for (const StepAdvice& advice : steps) {
    result.push_back({{"body", advice.body},
                      {"step_s", advice.step},
                      {"stable_up_to_s", number_json(advice.limit)},  // null: none is too long
                      {"too_long", advice.too_long()}});
  }
  return result;
}

json gas_json(const std::vector<GasAdvice>& gas) {
  json result = json::array();
  for (const GasAdvice& advice : gas) {
    const auto number = [](const std::optional<double>& value) {
      return value ? number_json(*value) : json();
    };
    result.push_back({{"body", advice.body},
                      {"volume_m3", advice.volume},
                      {"settled_volume_m3", number(advice.settled)},
                      {"blown_up", advice.blown_up()},
                      {"bursts", advice.bursts()},
                      {"crushed", advice.crushed()},
                      {"max_held_mol", number(advice.max_held)}});
    if (advice.filled_at) result.back()["filled_at_s"] = *advice.filled_at;
  }
  return result;
}

json crossings_json(const CrossingStatistics& crossings) {
  return {{"frames", crossings.frames},
          {"max_edges", crossings.edges.value},
          {"at_s", crossings.edges.time},
          {"bodies", crossings.first_bodies},
          {"more", crossings.more}};
}

json range_json(const ValueRange& range) {
  return {{"start", number_json(range.start)},
          {"least", number_json(range.least)},
          {"greatest", number_json(range.greatest)},
          {"end", number_json(range.end)}};
}

}  // namespace

json run_statistics_json(const RunStatistics& run) {
  json volumes = json::array();
  for (const VolumeRange& range : run.volumes) {
    if (range.is_obstacle) continue;
    volumes.push_back({{"body", range.body},
                       {"start", range.start.value},
                       {"least", range.least.value},
                       {"greatest", range.greatest.value},
                       {"end", range.end.value},
                       {"crosses_itself",
                        {{"start", range.start.crosses_itself},
                         {"least", range.least.crosses_itself},
                         {"greatest", range.greatest.crosses_itself},
                         {"end", range.end.crosses_itself}}},
                       {"shape_deviation_of_diagonal", range.shape_deviation}});
  }
  json gas = json::array();
  for (const GasRange& range : run.gas) {
    gas.push_back({{"body", range.body},
                   {"gauge_pressure_Pa", range_json(range.pressure)},
                   {"n_mol", range_json(range.n)}});
  }
  return {
      {"units", json_units},
      {"steps", run.steps},
      {"seconds", run.seconds},
      {"divergence", run.divergence ? json(*run.divergence) : json(nullptr)},
      {"frames", run.frames},
      {"crossings", crossings_json(run.crossings)},
      {"frames_with_touches", run.touching_frames},
      {"in_the_ground",
       {{"frames", run.sunk.frames},
        {"greatest_m", run.sunk.depth.value},
        {"at_s", run.sunk.depth.time},
        {"body", run.sunk.body}}},
      {"start_overlap",
       {{"pairs", run.start_overlap.pairs},
        {"pairs_left_at_end", run.start_overlap.left},
        {"last_parted_s", run.start_overlap.parted},
        {"bodies", run.start_overlap.bodies}}},
      {"self_crossings", crossings_json(run.self_crossings)},
      {"divided_steps", run.divided_steps},
      {"most_parts_of_a_step", run.most_parts},
      {"overlap_at_end_m", run.end_overlap},
      {"overlap_at_end_bodies", run.end_overlap_bodies},
      {"penetration_m",
       {{"greatest", run.penetration.value},
        {"at_s", run.penetration.time},
        {"bodies", run.penetration_bodies},
        {"at_start", run.start_penetration},
        {"greatest_in_last_half", run.settled_penetration}}},
      {"energy_J",
       {{"start", energy_json(run.energy_start)},
        {"end", energy_json(run.energy_end)},
        {"drift", run.energy_end.total() - run.energy_start.total()},
        {"greatest_rise_between_frames", run.energy_rise.value},
        {"greatest_rise_at_s", run.energy_rise.time},
        {"all_rises", run.energy_rises},
        {"span", run.energy_span},
        {"work_of_moved_bodies", run.driven_work.value_or(0.0)},
        {"work_of_gas_flow", run.gas_work.value_or(0.0)}}},
      {"contacts_per_step", contacts_per_step_json(run.contacts)},
      {"volumes_m3", std::move(volumes)},
      {"gas", std::move(gas)},
      {"free", run.pushed_by.empty()},
      {"momentum",
       {{"start", momentum_json(run.momentum_start)}, {"end", momentum_json(run.momentum_end)}}},
      {"end_speed_m_per_s", run.at_end.speed},
      {"fastest_at_end", run.at_end.body},
      {"at_rest", run.rests_from.has_value()},
      {"at_rest_from_s", run.rests_from ? json(*run.rests_from) : json(nullptr)},
      {"state_hash", hex(run.state_hash)}};
}

json run_json(const CheckReport& report) {
  return {{"scene", report.scene.name},
          {"run", report.run ? run_statistics_json(*report.run) : json(nullptr)}};
}

json check_json(const CheckReport& report) {
  json result = run_json(report);
  result["effective_scene"] = scenes::print_scene(report.scene);
  result["plan"] = plan_json(report.plan);
  result["size"] = size_json(report.size);
  result["steps"] = steps_json(report.steps);
  result["gas"] = gas_json(report.gas);
  return result;
}

}  // namespace pneuma::app
