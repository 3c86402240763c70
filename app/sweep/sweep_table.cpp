#include "app/sweep/sweep_table.h"

#include <fmt/format.h>

#include <charconv>
#include <limits>
#include <vector>

#include "app/study/csv.h"
#include "app/terminal/table.h"

namespace pneuma::app {
namespace {

/// A string without its quotes.
std::string plain(const std::string& toml) {
  const bool quoted = toml.size() >= 2 && toml.front() == '"' && toml.back() == '"';
  return quoted ? toml.substr(1, toml.size() - 2) : toml;
}

std::string cell(const nlohmann::ordered_json& value) {
  if (value.is_null()) return "";
  if (value.is_string()) return csv_cell(value.get<std::string>());
  if (value.is_number_float()) return csv_cell(value.get<double>());
  return value.dump();
}

nlohmann::ordered_json json_of(const std::string& toml) {
  const double number = number_of(toml);
  if (number == number) return nlohmann::ordered_json::parse(toml, nullptr, false);
  if (toml == "true" || toml == "false") return toml == "true";
  return plain(toml);
}

/// A line: "run 3, the first that is invalid (body.k = -1): ...", of its words the first line.
std::string reason(const Sweep& sweep, const SweepRow& row) {
  const SweepRun run = run_of(sweep, row.run);
  std::string values;
  for (std::size_t p = 0; p < run.values.size(); ++p) {
    values += fmt::format("{}{} = {}", p == 0 ? "" : ", ", sweep.parameters[p].key, run.values[p]);
  }
  if (!values.empty()) values = fmt::format(" ({})", values);
  return fmt::format("\nrun {}, the first with verdict \"{}\"{}: {}", row.run,
                     verdict_text(row.code), values, row.words.substr(0, row.words.find('\n')));
}

}  // namespace

std::string sweep_csv(const Sweep& sweep, const SweepRows& rows) {
  std::vector<std::string> columns = {"run", "scene"};
  for (const Parameter& parameter : sweep.parameters) columns.push_back(csv_cell(parameter.key));
  columns.insert(columns.end(), {"verdict", "exit_code"});
  for (const Measure& measure : sweep.measures) columns.push_back(csv_cell(measure.name));
  columns.emplace_back("words");
  Csv csv(columns);
  for (const auto& [number, row] : rows) {
    const SweepRun run = run_of(sweep, number);
    std::vector<std::string> cells = {csv_cell(number), csv_cell(run.scene)};
    for (const std::string& value : run.values) cells.push_back(csv_cell(plain(value)));
    cells.push_back(csv_cell(verdict_text(row.code)));
    cells.push_back(csv_cell(static_cast<int>(row.code)));
    for (const Measure& measure : sweep.measures)
      cells.push_back(cell(row.values.at(measure.name)));
    cells.push_back(csv_cell(row.words));
    csv.add_row(cells);
  }
  return csv.text();
}

nlohmann::ordered_json sweep_json(const Sweep& sweep, const SweepRows& rows,
                                  const std::string& fingerprint) {
  nlohmann::ordered_json json = {{"sweep", sweep.name},
                                 {"fingerprint", fingerprint},
                                 {"file", sweep.text},
                                 {"runs", nlohmann::ordered_json::array()}};
  for (const auto& [number, row] : rows) {
    const SweepRun run = run_of(sweep, number);
    nlohmann::ordered_json parameters = nlohmann::ordered_json::object();
    for (std::size_t p = 0; p < run.values.size(); ++p) {
      parameters[sweep.parameters[p].key] = json_of(run.values[p]);
    }
    json["runs"].push_back({{"run", number},
                            {"scene", run.scene},
                            {"parameters", parameters},
                            {"verdict", verdict_text(row.code)},
                            {"exit_code", static_cast<int>(row.code)},
                            {"values", row.values},
                            {"words", row.words}});
  }
  return json;
}

std::string seconds_csv(const SweepRows& rows) {
  Csv csv({"run", "seconds"});
  for (const auto& [number, row] : rows) csv.add_row({csv_cell(number), csv_cell(row.seconds)});
  return csv.text();
}

std::string sweep_summary(const Sweep& sweep, const SweepRows& rows) {
  std::map<ExitCode, std::int64_t> counts;
  std::string reasons;
  for (const auto& [number, row] : rows) {
    if (++counts[row.code] == 1 && row.code != ExitCode::done) reasons += reason(sweep, row);
  }
  std::string text = counted(static_cast<long long>(rows.size()), "run");
  for (const auto& [code, count] : counts) {
    text += fmt::format(", {} {}", grouped(count), verdict_text(code));
  }
  return text + reasons;
}

ExitCode exit_code_of(const SweepRows& rows) {
  for (const auto& [number, row] : rows) {
    if (row.code != ExitCode::done) return row.code;
  }
  return ExitCode::done;
}

double number_of(const std::string& toml) {
  double number = 0.0;
  const auto [end, error] = std::from_chars(toml.data(), toml.data() + toml.size(), number);
  const bool whole = error == std::errc() && end == toml.data() + toml.size();
  return whole ? number : std::numeric_limits<double>::quiet_NaN();
}

double number_of(const nlohmann::ordered_json& value) {
  if (value.is_boolean()) return value.get<bool>() ? 1.0 : 0.0;
  return value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace pneuma::app
