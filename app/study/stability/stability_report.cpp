#include "app/study/stability/stability_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "app/study/csv.h"
#include "app/terminal/table.h"

namespace pneuma::app {
namespace {

std::string found_text(const StabilityPoint& point) {
  if (point.unlimited()) return fmt::format("no limit up to 1/{} s", fewest_steps_per_second);
  if (!point.stable_rate) return fmt::format("none down to 1/{} s", most_steps_per_second);
  return readable(1e3 * *point.stable_step());
}

/// Found over predicted; empty where one of them is not a number.
std::string ratio_text(const StabilityPoint& point) {
  if (point.unlimited() || !point.stable_rate || !point.predicted_step) return "";
  return fmt::format("{:.3f}", *point.stable_step() / *point.predicted_step);
}

}  // namespace

std::string stability_text(const StabilityStudy& study) {
  using Align = Table::Align;
  Table table({{"varied", Align::left},
               {"value"},
               {"integrator", Align::left},
               {"longest stable\nstep, ms"},
               {"predicted\nms"},
               {"found /\npredicted"}});
  std::string varied;
  double value = 0.0;
  for (const StabilityPoint& point : study.points) {
    const bool again = point.varied == varied && point.value == value;
    varied = point.varied;
    value = point.value;
    table.add_row({again ? "" : varied, again ? "" : fmt::format("{:g}", value),
                   integrator_name(point.integrator), found_text(point),
                   point.predicted_step ? readable(1e3 * *point.predicted_step) : "no limit",
                   ratio_text(point)});
  }
  const TrialOptions& trial = study.options.trial;
  return fmt::format(
      "{}, body {}, alone and at rest but for a little motion; a trial is of {:g} s, at most {} "
      "steps\n\n{}\n{}\n",
      study.scene, study.body, trial.seconds, grouped(trial.most_steps), table.text(),
      wrapped(stiffness_sentence(study), 118));
}

std::string limits_csv(const StabilityStudy& study) {
  Csv csv({"scene", "integrator", "varied", "value", "stable_steps_per_second", "stable_step_s",
           "predicted_step_s"});
  for (const StabilityPoint& point : study.points) {
    csv.add_row({csv_cell(study.scene), csv_cell(integrator_name(point.integrator)),
                 csv_cell(point.varied), csv_cell(point.value),
                 point.stable_rate ? csv_cell(*point.stable_rate) : "",
                 point.stable_rate ? csv_cell(*point.stable_step()) : "",
                 point.predicted_step ? csv_cell(*point.predicted_step) : ""});
  }
  return csv.text();
}

std::string trials_csv(const StabilityStudy& study) {
  Csv csv({"scene", "integrator", "varied", "value", "step_s", "verdict", "reason"});
  const auto add = [&](sim::Integrator integrator, const std::string& varied, double value,
                       const Trial& trial) {
    csv.add_row({csv_cell(study.scene), csv_cell(integrator_name(integrator)), csv_cell(varied),
                 csv_cell(value), csv_cell(1.0 / trial.steps_per_second),
                 csv_cell(to_string(trial.verdict)), csv_cell(trial.reason)});
  };
  for (const StabilityPoint& point : study.points) {
    for (const Trial& trial : point.trials) add(point.integrator, point.varied, point.value, trial);
  }
  for (const StabilityCell& cell : study.map) add(cell.integrator, "k, map", cell.k, cell.trial);
  return csv.text();
}

nlohmann::json stability_json(const StabilityStudy& study) {
  nlohmann::json points = nlohmann::json::array(), limits = nlohmann::json::array();
  for (const StabilityPoint& point : study.points) {
    points.push_back(
        {{"integrator", integrator_name(point.integrator)},
         {"varied", point.varied},
         {"value", point.value},
         {"stable_step_s",
          point.stable_rate ? nlohmann::json(*point.stable_step()) : nlohmann::json()},
         {"unlimited", point.unlimited()},
         {"predicted_step_s",
          point.predicted_step ? nlohmann::json(*point.predicted_step) : nlohmann::json()}});
  }
  for (const StiffnessLimit& limit : study.limits) {
    limits.push_back({{"integrator", integrator_name(limit.integrator)},
                      {"k", limit.k},
                      {"unlimited", limit.unlimited}});
  }
  return {{"scene", study.scene},
          {"body", study.body},
          {"seconds", study.options.trial.seconds},
          {"most_steps", study.options.trial.most_steps},
          {"points", std::move(points)},
          {"greatest_k_at_60_steps_per_second", std::move(limits)},
          {"sentence", stiffness_sentence(study)}};
}

Diagram stability_map(const StabilityStudy& study, sim::Integrator integrator) {
  std::array<DiagramSeries, 3> verdicts;
  for (const Verdict verdict : {Verdict::stable, Verdict::diverged, Verdict::inverted}) {
    DiagramSeries& series = verdicts[static_cast<std::size_t>(verdict)];
    series.name = to_string(verdict);
    series.style = verdict == Verdict::stable ? DiagramSeries::Style::marks
                                              : DiagramSeries::Style::hollow_marks;
    series.look = std::array{2, 0, 3}[static_cast<std::size_t>(verdict)];
  }
  for (const StabilityCell& cell : study.map) {
    if (cell.integrator != integrator) continue;
    verdicts[static_cast<std::size_t>(cell.trial.verdict)].points.push_back(
        {cell.k, 1.0 / cell.trial.steps_per_second});
  }
  DiagramSeries predicted{.name = "limit predicted", .points = {}};
  predicted.style = DiagramSeries::Style::dashed;
  predicted.look = 6;
  DiagramSeries found{.name = "limit found", .points = {}};
  found.look = 1;
  for (const StabilityPoint& point : study.points) {
    if (point.integrator != integrator || point.varied != "k") continue;
    if (point.predicted_step) predicted.points.push_back({point.value, *point.predicted_step});
    if (point.stable_rate && !point.unlimited()) {
      found.points.push_back({point.value, *point.stable_step()});
    }
  }
  Diagram diagram;
  diagram.title = fmt::format("Stable steps of {}: {}", integrator_name(integrator), study.scene);
  const auto [least, greatest] = std::ranges::minmax(study.options.k);
  diagram.x = {.label = "spring constant k, N/m",
               .logarithmic = true,
               .low = least / 2.0,  // so that no mark is on the border
               .high = greatest * 2.0};
  diagram.y = {.label = "step, s", .logarithmic = true};
  diagram.series.assign(verdicts.begin(), verdicts.end());
  diagram.series.push_back(std::move(predicted));
  diagram.series.push_back(std::move(found));
  return diagram;
}

}  // namespace pneuma::app
