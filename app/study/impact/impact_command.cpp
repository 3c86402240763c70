// pneuma study impacts: its options, and what it leaves.
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <array>
#include <atomic>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "app/host/interrupt.h"
#include "app/record/vector_json.h"
#include "app/study/csv.h"
#include "app/study/impact/impact_run.h"
#include "app/study/study_command.h"
#include "app/study/study_folder.h"
#include "app/study/study_options.h"
#include "app/terminal/table.h"

namespace pneuma::app {
namespace {

constexpr int short_runs = 10;
/// m/s: up to here all impacts must hold, and of those above this share.
constexpr double all_hold_up_to = 30.0;
constexpr double least_share_above = 0.95;

struct ImpactOptions {
  StudyOptions study;
  int runs = 1000;
  std::uint64_t seed = 1;
  int first = 0;
};

struct ImpactRow {
  RandomImpact impact;
  ImpactResult result;

  bool is_slow() const { return impact.speed <= all_hold_up_to; }
  bool has_held() const { return result.outcome <= ImpactOutcome::held; }
  bool is_wrong() const {
    return result.outcome == ImpactOutcome::crossed || result.outcome == ImpactOutcome::no_volume;
  }
};

int run_count(const ImpactOptions& options) {
  return options.study.is_short ? std::min(options.runs, short_runs) : options.runs;
}

/// On all cores: impacts do not depend on each other.
std::vector<ImpactRow> run_impacts(const ImpactOptions& options) {
  std::vector<ImpactRow> rows(static_cast<std::size_t>(run_count(options)));
  std::atomic<std::size_t> next = 0;
  const auto work = [&] {
    for (std::size_t i = next++; i < rows.size() && !interrupted(); i = next++) {
      rows[i].impact = random_impact(options.seed, options.first + static_cast<int>(i));
      rows[i].result = run_impact(rows[i].impact);
    }
  };
  {
    std::vector<std::jthread> threads;
    for (unsigned i = 1; i < std::thread::hardware_concurrency(); ++i) threads.emplace_back(work);
    work();
  }
  throw_if_interrupted();
  return rows;
}

std::string outcome_text(const ImpactRow& row) {
  return std::string(impact_outcomes[static_cast<std::size_t>(row.result.outcome)]);
}

std::string table_text(const std::vector<ImpactRow>& rows) {
  using Align = Table::Align;
  Table table({{"outcome", Align::left}, {"up to 30 m/s", Align::right}, {"above", Align::right}});
  for (std::size_t i = 0; i < impact_outcomes.size(); ++i) {
    std::array<int, 2> counts{};
    for (const ImpactRow& row : rows) {
      if (static_cast<std::size_t>(row.result.outcome) == i) ++counts[row.is_slow() ? 0 : 1];
    }
    table.add_row(
        {std::string(impact_outcomes[i]), std::to_string(counts[0]), std::to_string(counts[1])});
  }
  return table.text();
}

std::string csv_text(const std::vector<ImpactRow>& rows, int first) {
  Csv csv({"number", "bodies", "speed_m_per_s", "steps_per_second", "outcome", "seconds",
           "greatest_contact_work", "message"});
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto& [impact, result] = rows[i];
    csv.add_row({csv_cell(first + static_cast<int>(i)), csv_cell(impact.bodies),
                 csv_cell(impact.speed), csv_cell(result.steps_per_second),
                 csv_cell(outcome_text(rows[i])), csv_cell(result.seconds),
                 csv_cell(result.most_work), csv_cell(result.message)});
  }
  return csv.text();
}

nlohmann::json summary_json(const ImpactOptions& options, const std::vector<ImpactRow>& rows) {
  nlohmann::json json = study_head(options.study);
  json["seed"] = options.seed;
  json["first"] = options.first;
  json["runs"] = rows.size();
  for (const std::string_view outcome : impact_outcomes) json["outcomes"][outcome] = 0;
  double most_work = 0.0;
  for (const ImpactRow& row : rows) {
    json["outcomes"][outcome_text(row)] = json["outcomes"][outcome_text(row)].get<int>() + 1;
    most_work = std::max(most_work, row.result.most_work);
  }
  json["greatest_contact_work"] = number_json(most_work);
  return json;
}

std::string scene_file(int number) { return fmt::format("impact_{}.toml", number); }

/// Those that did not hold can be run again as scenes.
void write_scenes(const StudyFolder& folder, const std::vector<ImpactRow>& rows, int first) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].has_held()) continue;
    const auto path = folder.write(scene_file(first + static_cast<int>(i)), rows[i].impact.scene);
    fmt::print("{}: {}, {} at {:.1f} m/s: {}\n", path.string(), outcome_text(rows[i]),
               rows[i].impact.bodies, rows[i].impact.speed, rows[i].result.message);
  }
}

bool are_as_promised(const std::vector<ImpactRow>& rows) {
  const auto is_fast = [](const ImpactRow& row) { return !row.is_slow(); };
  const auto fast = std::ranges::count_if(rows, is_fast);
  const auto fast_held = std::ranges::count_if(
      rows, [&](const ImpactRow& row) { return is_fast(row) && row.has_held(); });
  return std::ranges::none_of(rows, &ImpactRow::is_wrong) &&
         std::ranges::all_of(
             rows, [](const ImpactRow& row) { return !row.is_slow() || row.has_held(); }) &&
         static_cast<double>(fast_held) >= least_share_above * static_cast<double>(fast);
}

StudyFiles files_of(const ImpactOptions& options) {
  StudyFiles files = {{"impacts.csv", "impacts.json"}};
  for (int i = 0; i < run_count(options); ++i) {
    files.files.push_back(scene_file(options.first + i));
  }
  return files;
}

ExitCode run_impact_study(const ImpactOptions& options) {
  const StudyFolder folder = open_study_folder(options.study, files_of(options));
  const std::vector<ImpactRow> rows = run_impacts(options);
  folder.write("impacts.csv", csv_text(rows, options.first));
  const nlohmann::json summary = summary_json(options, rows);
  folder.write("impacts.json", summary.dump(2) + '\n');
  write_scenes(folder, rows, options.first);
  fmt::print("{}\nContacts added at most {:.2g} of the energy of the impact in a step\n{}\n",
             table_text(rows), summary["greatest_contact_work"].get<double>(),
             folder.path().string());
  return are_as_promised(rows) ? ExitCode::done : ExitCode::check_failed;
}

}  // namespace

void add_impact_study(CLI::App& study, Action& action, std::span<const std::string> command_line) {
  const auto options = std::make_shared<ImpactOptions>();
  CLI::App* command = study.add_subcommand(
      "impacts", "Shoot random bodies at each other, and look at every step for what crosses");
  add_study_options(*command, options->study, command_line,
                    fmt::format("No more than {} impacts", short_runs));
  command->add_option("--runs", options->runs, "How many impacts [1000]")
      ->type_name("N")
      ->check(CLI::Range(1, 1000000));
  command->add_option("--first", options->first, "The number of the first impact [0]")
      ->type_name("N")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--seed", options->seed, "Of the random numbers [1]")->type_name("N");
  command->callback(
      [options, &action] { action = [options] { return run_impact_study(*options); }; });
}

}  // namespace pneuma::app
