#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <utility>

#include "app/study/error/conclusions.h"
#include "app/study/error/error_report.h"
#include "app/study/report_text.h"
#include "app/terminal/table.h"

namespace pneuma::app {
namespace {

using Status = ErrorRun::Status;

constexpr std::size_t ours_in_a_table = 5, peers_in_a_table = 3;  // of at most 120 columns

std::string microseconds(double seconds) { return readable(1e6 * seconds); }

std::string error_cell(const ErrorRun& run) {
  if (run.status != Status::stable) return std::string(to_string(run.status));
  return fmt::format("{:.1e}", error_of(run));
}

std::string time_cell(const ErrorRun& run) {
  return run.status == Status::skipped ? "-" : microseconds(run.run_time);
}

std::vector<std::string> methods_of(const ErrorStudy& study, bool ours) {
  std::vector<std::string> methods;
  for (const ErrorRun& run : study.runs) {
    if (run.ours == ours && (methods.empty() || methods.back() != run.method)) {
      methods.push_back(run.method);
    }
  }
  return methods;
}

/// Of these methods, all ours or none: a row for each step or tolerance, and for each method its
/// error and its time in it.
std::string runs_table(const ErrorStudy& study, bool ours, std::span<const std::string> methods) {
  std::vector<Table::Column> columns = {{ours ? "step, s" : "tolerance"}};
  std::vector<std::pair<std::string, std::vector<std::string>>> rows;
  std::string method;
  for (const ErrorRun& run : study.runs) {
    if (run.ours != ours || std::ranges::count(methods, run.method) == 0) continue;
    if (run.method != method) {
      method = run.method;
      columns.push_back({"error", Table::Align::right, method});
      columns.push_back({"us", Table::Align::right, method});
    }
    const std::string key =
        ours ? fmt::format("1/{}", run.steps_per_second) : fmt::format("{:.1e}", run.tolerance);
    auto row = std::ranges::find(rows, key, &decltype(rows)::value_type::first);
    if (row == rows.end()) row = rows.insert(rows.end(), {key, {key}});
    row->second.push_back(error_cell(run));
    row->second.push_back(time_cell(run));
    if (!ours) row->second.push_back(readable(run.evaluations));
    if (!ours && row == rows.begin())
      columns.push_back({"evaluations", Table::Align::right, method});
  }
  Table table(std::move(columns));
  for (auto& [key, cells] : rows) table.add_row(std::move(cells));
  return table.text();
}

std::string heading(const ErrorStudy& study) {
  const Reference& reference = study.reference;
  std::string text = fmt::format("{}: {}\n", study.name, study.title);
  text +=
      labelled("Motion", fmt::format("{}; {} vertices, rest radius {:.3g} m.",
                                     study.flight.description, study.vertices, study.rest_radius));
  text +=
      labelled("Compared", fmt::format("until {:.4g} s with {}; known to {:.1e}.",
                                       reference.seconds, reference.method, reference.uncertainty));
  if (!reference.limit.empty()) {
    text += labelled("", fmt::format("Not until the {:.4g} s asked for: {}.", study.flight.seconds,
                                     reference.limit));
  }
  text += labelled("error",
                   "root mean square distance of the vertices from where they should be, max. "
                   "over time, divided by the rest radius.");
  return text + labelled("us",
                         "microseconds of processor time per simulated second: the stepping alone, "
                         "min. of the repeats.");
}

std::string orders_text(const ErrorStudy& study) {
  std::string text = "Order: the power of the step with which the error falls";
  text += study.flight.contacts ? "; contacts are not smooth and have none in theory\n" : "\n";
  for (const ObservedOrder& order : observed_orders(study)) {
    const std::string theory = order.theory ? fmt::format(", in theory {:g}", *order.theory) : "";
    text += order.law ? fmt::format("  {:<18}{:.2f}{} (fit over {} steps, 1/{} to 1/{} s)\n",
                                    order.method, order.law->exponent, theory, order.points,
                                    order.first_steps_per_second, order.last_steps_per_second)
                      : fmt::format("  {:<18}no range of steps with a power law{}\n", order.method,
                                    theory);
  }
  return text;
}

/// What else is off in the recommended runs.
std::string other_errors_table(const ErrorStudy& study) {
  constexpr const char* greatest = "max. over time";
  constexpr const char* end = "at the end";
  Table table({{"run", Table::Align::left},
               {"position", Table::Align::right, greatest},
               {"volume", Table::Align::right, greatest},
               {"centre", Table::Align::right, greatest},
               {"energy", Table::Align::right, greatest},
               {"momentum", Table::Align::right, greatest},
               {"angular\nmomentum", Table::Align::right, greatest},
               {"position", Table::Align::right, end},
               {"energy", Table::Align::right, end}});
  const auto cell = [](double error) { return fmt::format("{:.1e}", error); };
  std::string last;
  for (const double error : recommended_errors) {
    const Choice choice = choose(study, error);
    if (!choice.ours) continue;
    const ErrorRun& run = *choice.ours;
    const std::string name = fmt::format("{} 1/{} s", run.method, run.steps_per_second);
    if (std::exchange(last, name) == name) continue;
    const StateErrors& worst = run.errors.greatest;
    table.add_row({name, cell(worst.position), cell(worst.volume), cell(worst.centre),
                   cell(worst.energy), cell(worst.momentum), cell(worst.angular_momentum),
                   cell(run.errors.end.position), cell(run.errors.end.energy)});
  }
  return last.empty() ? "" : table.text();
}

std::string recommendations_text(const ErrorStudy& study) {
  std::string text = "Recommended\n";
  for (const double error : recommended_errors) {
    text += fmt::format("  {}\n", recommendation(choose(study, error)));
  }
  return text + other_errors_table(study);
}

std::string comparison_text(const ErrorStudy& study) {
  Table table({{"error"},
               {"method", Table::Align::left, "ours"},
               {"step, s", Table::Align::right, "ours"},
               {"us", Table::Align::right, "ours"},
               {"method", Table::Align::left, "SUNDIALS, given the same forces"},
               {"tolerance", Table::Align::right, "SUNDIALS, given the same forces"},
               {"us", Table::Align::right, "SUNDIALS, given the same forces"},
               {"SUNDIALS /\nours"}});
  for (const double error : compared_errors) {
    const Choice choice = choose(study, error);
    std::vector<std::string> cells = {power_of_ten(error)};
    const auto add = [&](const std::optional<ErrorRun>& run) {
      if (!run) return cells.insert(cells.end(), 3, "-");
      cells.push_back(run->method);
      cells.push_back(run->ours ? fmt::format("1/{}", run->steps_per_second)
                                : fmt::format("{:.1e}", run->tolerance));
      cells.push_back(microseconds(run->run_time));
      return cells.end();
    };
    add(choice.ours);
    add(choice.peer);
    cells.push_back(choice.ratio() ? fmt::format("{:.2f}x", *choice.ratio()) : "-");
    table.add_row(std::move(cells));
  }
  std::string text = table.text();
  const std::vector<std::string> sentences = shortfalls(study);
  if (sentences.empty()) return text + "Ours is ahead of SUNDIALS at all of these errors.\n";
  text += "Where ours is not as wished beside SUNDIALS:\n";
  for (const std::string& sentence : sentences) text += list_item(sentence);
  return text;
}

/// All runs of ours, or of the peers.
std::string runs_tables(const ErrorStudy& study, bool ours) {
  const std::vector<std::string> methods = methods_of(study, ours);
  const std::size_t most = ours ? ours_in_a_table : peers_in_a_table;
  std::string text;
  for (std::size_t i = 0; i < methods.size(); i += most) {
    const std::size_t count = std::min(most, methods.size() - i);
    text += runs_table(study, ours, std::span(methods).subspan(i, count)) + "\n";
  }
  return text;
}

}  // namespace

std::string error_text(const ErrorStudy& study) {
  std::string text = heading(study) + "\n" + runs_tables(study, true);
  if (!study.flight.contacts) text += runs_tables(study, false);
  text += orders_text(study) + "\n" + recommendations_text(study);
  if (!study.flight.contacts) text += fmt::format("\n{}", comparison_text(study));
  return text;
}

}  // namespace pneuma::app
