#include "app/study/contact/contact_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "app/study/csv.h"
#include "app/study/report_text.h"
#include "app/terminal/table.h"

namespace pneuma::app {
namespace {

using Align = Table::Align;
using Status = ErrorRun::Status;

// A run whose error is exactly zero still has a place on a logarithmic axis.
constexpr double least_shown = 1e-16;

std::string step_of(const ErrorRun& run) { return fmt::format("1/{}", run.steps_per_second); }

std::string heading(const ContactStudy& study) {
  const Reference& reference = study.limit.reference;
  std::string text = fmt::format("{}: {}\n", study.name, study.title);
  text +=
      labelled("Compared", fmt::format("until {:.4g} s with {}; known to {:.1e}.",
                                       reference.seconds, reference.method, reference.uncertainty));
  if (!reference.limit.empty()) {
    text += labelled(
        "", fmt::format("Not until the {:.4g} s asked for: {}.", study.seconds, reference.limit));
  }
  if (!reaches_a_contact(study)) {
    text += labelled("", fmt::format("Nothing touches until then, the first time at {:.4g} s: the "
                                     "runs below say nothing of contacts.",
                                     study.first_contact));
  }
  if (std::ranges::count(study.forms, ContactForm::impulses, &ContactRuns::form) == 0) {
    text += labelled("Left out",
                     "impulses and the paper's contacts, which know no static and no "
                     "moved boxes.");
  }
  std::string distances;
  for (std::size_t i = 0; i < study.limit.distances.size(); ++i) {
    distances += fmt::format("{}{:.1e} at {:.3g} m", i == 0 ? "" : ", ", study.limit.errors[i],
                             study.limit.distances[i]);
  }
  text += labelled("Potential", fmt::format("is itself off by {}.", distances));
  text += labelled("error",
                   fmt::format("root mean square distance of the vertices from where they should "
                               "be, max. over time, divided by the rest radius, {:.3g} m.",
                               study.rest_radius));
  return text + labelled("us",
                         "microseconds of processor time per simulated second: the stepping alone, "
                         "min. of the repeats.");
}

std::string cheapest_table(const ContactStudy& study) {
  Table table(
      {{"contact", Align::left}, {"integrator", Align::left}, {"step, s"}, {"error"}, {"us"}});
  for (const ContactRuns& form : study.forms) {
    const std::vector<ErrorRun> front = cheapest_runs(form);
    for (const ErrorRun& run : front) {
      table.add_row({std::string(to_string(form.form)), run.method, step_of(run),
                     fmt::format("{:.1e}", error_of(run)), readable(1e6 * run.run_time)});
    }
    if (front.empty()) table.add_row({std::string(to_string(form.form)), "-", "-", "-", "-"});
  }
  return table.text();
}

/// "swept, rk4 1/60 s: 2,092 us".
std::string choice_cell(const ContactChoice& choice) {
  if (!choice.known) return "not known";
  if (!choice.form) return "none";
  return fmt::format("{}, {}\n{} s: {} us\n({:.1e})", to_string(*choice.form), choice.run.method,
                     step_of(choice.run), readable(1e6 * choice.run.run_time),
                     error_of(choice.run));
}

nlohmann::json contact_run_json(const ErrorRun& run) {
  const bool is_stable = run.status == Status::stable;
  return {{"method", run.method},
          {"steps_per_second", run.steps_per_second},
          {"outcome", std::string(to_string(run.status))},
          {"failure", run.failure},
          {"run_time_s_per_simulated_s",
           run.status == Status::skipped ? nlohmann::json(nullptr) : nlohmann::json(run.run_time)},
          {"error", is_stable ? nlohmann::json(error_of(run)) : nlohmann::json(nullptr)}};
}

nlohmann::json contact_choice_json(const ContactChoice& choice) {
  nlohmann::json found = {{"for", choice.purpose}, {"known", choice.known}, {"contact", nullptr}};
  if (!choice.form) return found;
  found["contact"] = std::string(to_string(*choice.form));
  found["run"] = contact_run_json(choice.run);
  return found;
}

}  // namespace

std::string contact_text(const ContactStudy& study) {
  return heading(study) +
         "\nThe cheapest runs of each form of contact, each better than those before\n" +
         cheapest_table(study);
}

std::string advice_text(std::span<const ContactStudy> studies) {
  std::vector<Table::Column> columns = {{"scene", Align::left}};
  for (const ContactChoice& choice : choose_contacts(studies.front())) {
    columns.push_back({choice.purpose, Align::left, "cheapest for"});
  }
  Table table(std::move(columns));
  for (const ContactStudy& study : studies) {
    std::vector<std::string> cells = {study.name};
    for (const ContactChoice& choice : choose_contacts(study)) cells.push_back(choice_cell(choice));
    table.add_row(std::move(cells));
  }
  std::string text =
      "What to take: contact, integrator, step, microseconds per simulated second (error)\n";
  text += table.text();
  text += labelled("picture", "an error of 5e-2, as --accuracy picture has it.");
  return text + labelled("guarantee",
                         "nothing crosses another or itself, and contacts give no energy: the "
                         "potential by an implicit integrator.");
}

std::string contact_csv(const ContactStudy& study) {
  Csv csv({"scene", "contact", "integrator", "steps_per_second", "outcome", "failure",
           "run_time_s_per_simulated_s", "position_max", "volume_max", "energy_max", "momentum_max",
           "angular_momentum_max"});
  for (const ContactRuns& form : study.forms) {
    for (const ErrorRun& run : form.runs) {
      const StateErrors& errors = run.errors.greatest;
      std::vector<std::string> cells = {
          csv_cell(study.name),
          csv_cell(std::string(to_string(form.form))),
          csv_cell(run.method),
          csv_cell(run.steps_per_second),
          csv_cell(std::string(to_string(run.status))),
          csv_cell(run.failure),
          run.status == Status::skipped ? "" : csv_cell(run.run_time)};
      for (const double error : {errors.position, errors.volume, errors.energy, errors.momentum,
                                 errors.angular_momentum}) {
        cells.push_back(run.status == Status::stable ? csv_cell(error) : "");
      }
      csv.add_row(cells);
    }
  }
  return csv.text();
}

nlohmann::json contact_json(const ContactStudy& study) {
  const Reference& reference = study.limit.reference;
  nlohmann::json forms = nlohmann::json::array(), choices = nlohmann::json::array();
  for (const ContactRuns& form : study.forms) {
    nlohmann::json runs = nlohmann::json::array();
    for (const ErrorRun& run : form.runs) runs.push_back(contact_run_json(run));
    forms.push_back({{"contact", std::string(to_string(form.form))}, {"runs", std::move(runs)}});
  }
  for (const ContactChoice& choice : choose_contacts(study))
    choices.push_back(contact_choice_json(choice));
  return {{"scene", study.name},
          {"title", study.title},
          {"seconds_asked_for", study.seconds},
          {"seconds_compared", reference.seconds},
          {"first_contact_s", study.first_contact},
          {"rest_radius_m", study.rest_radius},
          {"reference",
           {{"method", reference.method},
            {"uncertainty", reference.uncertainty},
            {"limit", reference.limit},
            {"distances_m", study.limit.distances},
            {"errors", study.limit.errors}}},
          {"choices", std::move(choices)},
          {"forms", std::move(forms)}};
}

Diagram contact_diagram(const ContactStudy& study) {
  Diagram diagram;
  diagram.title = fmt::format("{}: error over run time, by contact", study.name);
  diagram.subtitle = fmt::format("{:.3g} s; of each contact the cheapest runs of all integrators",
                                 study.limit.reference.seconds);
  diagram.x = {.label = "run time of a simulated second, microseconds", .logarithmic = true};
  diagram.y = {.label = "max. position error / rest radius", .logarithmic = true};
  for (const ContactRuns& form : study.forms) {
    DiagramSeries& series = diagram.series.emplace_back();
    series.name = std::string(to_string(form.form));
    for (const ErrorRun& run : cheapest_runs(form)) {
      series.points.push_back({1e6 * run.run_time, std::max(least_shown, error_of(run))});
    }
  }
  DiagramSeries known{
      .name = "how well the limit is known", .points = {}, .style = DiagramSeries::Style::dashed};
  for (const DiagramSeries& series : diagram.series) {
    for (const DiagramPoint& point : series.points) {
      known.points.push_back({point.x, std::max(least_shown, study.limit.reference.uncertainty)});
    }
  }
  std::ranges::sort(known.points, {}, &DiagramPoint::x);
  diagram.series.push_back(std::move(known));
  return diagram;
}

}  // namespace pneuma::app
