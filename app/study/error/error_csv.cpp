#include <cmath>

#include "app/study/csv.h"
#include "app/study/error/conclusions.h"
#include "app/study/error/error_report.h"

namespace pneuma::app {
namespace {

using Status = ErrorRun::Status;

/// Empty where there is no such number.
std::string positive(double value) { return value > 0.0 ? csv_cell(value) : std::string(); }

void add_errors(std::vector<std::string>& cells, const ErrorRun& run) {
  for (const StateErrors* errors : {&run.errors.end, &run.errors.greatest}) {
    for (const double error : {errors->position, errors->volume, errors->centre, errors->energy,
                               errors->momentum, errors->angular_momentum}) {
      cells.push_back(run.status == Status::stable ? csv_cell(error) : std::string());
    }
  }
}

/// Method, its step or tolerance, its error and its time.
void add_choice(std::vector<std::string>& cells, const std::optional<ErrorRun>& run) {
  if (!run) {
    cells.insert(cells.end(), 4, "");
    return;
  }
  cells.push_back(csv_cell(run->method));
  cells.push_back(csv_cell(run->ours ? run->step() : run->tolerance));
  cells.push_back(csv_cell(error_of(*run)));
  cells.push_back(csv_cell(run->run_time));
}

}  // namespace

std::string runs_csv(const ErrorStudy& study) {
  Csv csv({"scene",
           "method",
           "steps_per_second",
           "step_s",
           "tolerance",
           "outcome",
           "failure",
           "run_time_s_per_simulated_s",
           "evaluations_per_simulated_s",
           "position_end",
           "volume_end",
           "centre_end",
           "energy_end",
           "momentum_end",
           "angular_momentum_end",
           "position_max",
           "volume_max",
           "centre_max",
           "energy_max",
           "momentum_max",
           "angular_momentum_max"});
  for (const ErrorRun& run : study.runs) {
    std::vector<std::string> cells = {csv_cell(study.name),
                                      csv_cell(run.method),
                                      run.ours ? csv_cell(run.steps_per_second) : "",
                                      run.ours ? csv_cell(run.step()) : "",
                                      positive(run.tolerance),
                                      csv_cell(std::string(to_string(run.status))),
                                      csv_cell(run.failure),
                                      positive(run.run_time),
                                      positive(run.evaluations)};
    add_errors(cells, run);
    csv.add_row(cells);
  }
  return csv.text();
}

std::string ratios_csv(const ErrorStudy& study) {
  Csv csv({"scene", "error", "our_method", "our_step_s", "our_error",
           "our_run_time_s_per_simulated_s", "sundials_method", "sundials_tolerance",
           "sundials_error", "sundials_run_time_s_per_simulated_s", "sundials_over_ours"});
  for (const double error : compared_errors) {
    const Choice choice = choose(study, error);
    std::vector<std::string> cells = {csv_cell(study.name), csv_cell(error)};
    add_choice(cells, choice.ours);
    add_choice(cells, choice.peer);
    cells.push_back(choice.ratio() ? csv_cell(*choice.ratio()) : "");
    csv.add_row(cells);
  }
  return csv.text();
}

}  // namespace pneuma::app
