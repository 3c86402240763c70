#include <fmt/format.h>

#include "app/study/csv.h"
#include "app/study/stability/contact_stability.h"
#include "app/terminal/table.h"
#include "scenes/loader/integrator_names.h"

namespace pneuma::app {
namespace {

std::string milliseconds(const std::optional<double>& step) {
  return step ? readable(1e3 * *step) : "-";
}

std::string ratio(const ContactStabilityPoint& point) {
  if (!point.stable_step || !point.predicted_step) return "";
  return fmt::format("{:.3f}", *point.stable_step / *point.predicted_step);
}

std::string own_text(const OwnSteps& own) {
  if (!own.failure.empty()) return "diverged";
  return fmt::format("{:.3g}, {:.2g}", own.parts, own.trembling);
}

}  // namespace

std::string contact_stability_text(const std::string& scene,
                                   const std::vector<ContactStabilityPoint>& points) {
  using Align = Table::Align;
  std::vector<Table::Column> columns = {{"varied", Align::left},     {"value"},
                                        {"integrator", Align::left}, {"longest stable\nstep, ms"},
                                        {"predicted\nms"},           {"found /\npredicted"}};
  if (!points.empty()) {
    for (const OwnSteps& own : points.front().own) {
      columns.push_back({fmt::format("1/{} s", own.steps_per_second), Align::right,
                         "parts of own steps, trembling m/s"});
    }
  }
  Table table(std::move(columns));
  const ContactStabilityPoint* above = nullptr;
  for (const ContactStabilityPoint& point : points) {
    const bool again =
        above != nullptr && point.varied == above->varied && point.value == above->value;
    above = &point;
    std::vector<std::string> cells = {
        again ? "" : point.varied,
        again ? "" : fmt::format("{:g}", point.value),
        scenes::integrator_name(point.integrator),
        point.predicted_step ? milliseconds(point.stable_step) : "",
        point.predicted_step ? milliseconds(point.predicted_step) : "no limit",
        ratio(point)};
    for (const OwnSteps& own : point.own) cells.push_back(own_text(own));
    table.add_row(std::move(cells));
  }
  return fmt::format(
      "{}, its first soft body on the ground by potential, alone or under a plate: contact "
      "stiffness\nof the default one, mass of the plate of the body's; -: none found near what is "
      "predicted\n\n{}",
      scene, table.text());
}

std::string contact_stability_csv(const std::vector<ContactStabilityPoint>& points) {
  Csv csv({"integrator", "varied", "value", "stable_step_s", "predicted_step_s", "own_step_s",
           "parts", "trembling_m_per_s", "failure"});
  for (const ContactStabilityPoint& point : points) {
    for (const OwnSteps& own : point.own) {
      csv.add_row({csv_cell(scenes::integrator_name(point.integrator)), csv_cell(point.varied),
                   csv_cell(point.value), point.stable_step ? csv_cell(*point.stable_step) : "",
                   point.predicted_step ? csv_cell(*point.predicted_step) : "",
                   csv_cell(1.0 / own.steps_per_second), csv_cell(own.parts),
                   csv_cell(own.trembling), csv_cell(own.failure)});
    }
  }
  return csv.text();
}

}  // namespace pneuma::app
