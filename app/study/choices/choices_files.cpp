#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/study/choices/choices_report.h"
#include "app/study/choices/martin.h"
#include "app/study/csv.h"
#include "app/study/error/error_report.h"
#include "app/study/error/samples.h"

namespace pneuma::app {
namespace {

using nlohmann::json;
using Style = DiagramSeries::Style;

// A distance of nothing at all still has a place on a logarithmic axis.
constexpr double least_distance = 1e-17;

std::string word(sim::Damping damping) {
  return damping == sim::Damping::dashpot ? "dashpot" : "literal";
}

json optional_json(const std::optional<double>& value) { return value ? json(*value) : json(); }

std::string optional_cell(const std::optional<double>& value) {
  return value ? csv_cell(*value) : std::string();
}

json range_json(const std::array<double, 3>& range) {
  return {{"min", range[0]}, {"median", range[1]}, {"max", range[2]}};
}

json drift_json(const DriftStudy& study) {
  const auto weighting = [](const std::vector<DriftTrial>& trials) -> json {
    return {{"distance_over_radius", range_json(drift_range(trials))},
            {"net_force_over_vertex_force", range_json(force_range(trials))}};
  };
  return {{"trials", study.uniform.size()},       {"seconds", study.seconds},
          {"perturbation_m", study.perturbation}, {"uniform", weighting(study.uniform)},
          {"valence", weighting(study.valence)},  {"sentence", drift_sentence(study)}};
}

json damping_json(const DampingStudy& study) {
  json runs = json::array();
  for (const DampingRun& run : study.runs) {
    runs.push_back({{"damping", word(run.damping)},
                    {"steps_per_second", run.steps_per_second},
                    {"fall_speed_m_s", optional_json(run.fall_speed)},
                    {"swing_left", optional_json(run.swing_left)}});
  }
  return {{"seconds", study.seconds},
          {"exact_fall_speed_m_s", study.exact_fall_speed},
          {"runs", std::move(runs)},
          {"sentences", damping_sentences(study)}};
}

void add_trials(Csv& csv, const std::string& weighting, const std::vector<DriftTrial>& trials) {
  for (std::size_t t = 0; t < trials.size(); ++t) {
    for (std::size_t i = 0; i < trials[t].distances.size(); ++i) {
      csv.add_row({weighting, csv_cell(t + 1), csv_cell(sample_time(i)),
                   csv_cell(trials[t].distances[i]), csv_cell(trials[t].net_force)});
    }
  }
}

void add_trials(Diagram& diagram, const std::string& name, const std::vector<DriftTrial>& trials,
                int look) {
  for (std::size_t t = 0; t < trials.size(); ++t) {
    DiagramSeries series{
        .name = t == 0 ? name : "", .points = {}, .style = Style::line, .look = look};
    for (std::size_t i = 0; i < trials[t].distances.size(); ++i) {
      series.points.push_back({sample_time(i), std::max(trials[t].distances[i], least_distance)});
    }
    diagram.series.push_back(std::move(series));
  }
}

}  // namespace

json choices_json(const ChoicesStudy& study) {
  return {{"scene", study.name},
          {"title", study.title},
          {"drift", drift_json(study.drift)},
          {"damping", damping_json(study.damping)},
          {"martin",
           {{"sentences", martin_sentences(study.integrators)},
            {"study", error_json(study.integrators)}}}};
}

std::string drift_csv(const ChoicesStudy& study) {
  Csv csv({"pressure", "trial", "time_s", "distance_over_radius", "net_force_over_vertex_force"});
  add_trials(csv, "uniform", study.drift.uniform);
  add_trials(csv, "valence", study.drift.valence);
  return csv.text();
}

std::string damping_csv(const ChoicesStudy& study) {
  Csv csv({"damping", "steps_per_second", "step_s", "fall_speed_m_s", "swing_left"});
  for (const DampingRun& run : study.damping.runs) {
    csv.add_row({word(run.damping), csv_cell(run.steps_per_second),
                 csv_cell(1.0 / run.steps_per_second), optional_cell(run.fall_speed),
                 optional_cell(run.swing_left)});
  }
  return csv.text();
}

std::string martin_csv(const ChoicesStudy& study) {
  Csv csv({"other", "steps_per_second", "martin_error_over_other", "martin_run_time_over_other"});
  for (const MartinComparison& comparison : compare_martin(study.integrators)) {
    csv.add_row({csv_cell(comparison.other), csv_cell(comparison.steps_per_second),
                 csv_cell(comparison.error_ratio), csv_cell(comparison.time_ratio)});
  }
  return csv.text();
}

Diagram drift_diagram(const ChoicesStudy& study) {
  Diagram diagram;
  diagram.title = study.name + ": drift of a free body";
  diagram.subtitle = "no gravity, no ground: whatever moves it comes from inside";
  diagram.x = {.label = "time, s"};
  diagram.y = {.label = "distance of the centre of mass / rest radius", .logarithmic = true};
  add_trials(diagram, "valence", study.drift.valence, 0);
  add_trials(diagram, "uniform", study.drift.uniform, 3);
  return diagram;
}

Diagram damping_diagram(const ChoicesStudy& study) {
  Diagram diagram;
  diagram.title = study.name + ": speed of a falling body over the step";
  diagram.subtitle = "with the paper's damping as written (literal) and as an equation (dashpot)";
  diagram.x = {.label = "step, s", .logarithmic = true};
  diagram.y = {.label = "fall speed, m/s", .logarithmic = true};
  for (const sim::Damping damping : {sim::Damping::literal, sim::Damping::dashpot}) {
    DiagramSeries series{
        .name = word(damping), .points = {}, .look = damping == sim::Damping::literal ? 0 : 3};
    for (const DampingRun& run : study.damping.runs) {
      if (run.damping != damping || !run.fall_speed || *run.fall_speed <= 0.0) continue;
      series.points.push_back({1.0 / run.steps_per_second, *run.fall_speed});
    }
    diagram.series.push_back(std::move(series));
  }
  return diagram;
}

}  // namespace pneuma::app
