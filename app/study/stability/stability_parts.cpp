#include "app/study/stability/stability_parts.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace pneuma::app {
namespace {

using nlohmann::json;

json trial_json(const Trial& trial) {
  return {trial.steps_per_second, static_cast<int>(trial.verdict), trial.reason};
}

Trial trial_of(const json& trial) {
  return {trial[0].get<int>(), static_cast<Verdict>(trial[1].get<int>()),
          trial[2].get<std::string>()};
}

template <class Value>
json or_null(const std::optional<Value>& value) {
  return value ? json(*value) : json(nullptr);
}

template <class Value>
std::optional<Value> optional_of(const json& value) {
  return value.is_null() ? std::nullopt : std::optional(value.get<Value>());
}

json point_json(const StabilityPoint& point) {
  json trials = json::array();
  for (const Trial& trial : point.trials) trials.push_back(trial_json(trial));
  return {{"integrator", static_cast<int>(point.integrator)},
          {"varied", point.varied},
          {"value", point.value},
          {"stable_rate", or_null(point.stable_rate)},
          {"predicted_step", or_null(point.predicted_step)},
          {"trials", std::move(trials)}};
}

sim::Integrator integrator_of(const json& owner) {
  return static_cast<sim::Integrator>(owner["integrator"].get<int>());
}

StabilityPoint point_of(const json& point) {
  StabilityPoint result{integrator_of(point),
                        point["varied"],
                        point["value"],
                        optional_of<int>(point["stable_rate"]),
                        optional_of<double>(point["predicted_step"]),
                        {}};
  for (const json& trial : point["trials"]) result.trials.push_back(trial_of(trial));
  return result;
}

}  // namespace

json part_json(const StabilityStudy& study) {
  json points = json::array(), limits = json::array(), map = json::array();
  for (const StabilityPoint& point : study.points) points.push_back(point_json(point));
  for (const StiffnessLimit& limit : study.limits) {
    limits.push_back({{"integrator", static_cast<int>(limit.integrator)},
                      {"k", limit.k},
                      {"unlimited", limit.unlimited}});
  }
  for (const StabilityCell& cell : study.map) {
    map.push_back({{"integrator", static_cast<int>(cell.integrator)},
                   {"k", cell.k},
                   {"trial", trial_json(cell.trial)}});
  }
  return {{"scene", study.scene},
          {"body", study.body},
          {"points", std::move(points)},
          {"limits", std::move(limits)},
          {"map", std::move(map)}};
}

StabilityStudy join_parts(const StabilityOptions& options, std::span<const json> parts) {
  StabilityStudy study;
  study.options = options;
  for (const json& part : parts) {
    study.scene = part["scene"];
    study.body = part["body"];
    for (const json& limit : part["limits"]) {
      study.limits.push_back({integrator_of(limit), limit["k"], limit["unlimited"]});
    }
    for (const json& cell : part["map"]) {
      study.map.push_back({integrator_of(cell), cell["k"], trial_of(cell["trial"])});
    }
  }
  // Value by value, all integrators of each.
  const std::size_t values = parts.empty() ? 0 : parts.front()["points"].size();
  for (std::size_t value = 0; value < values; ++value) {
    for (const json& part : parts) study.points.push_back(point_of(part["points"][value]));
  }
  return study;
}

}  // namespace pneuma::app
