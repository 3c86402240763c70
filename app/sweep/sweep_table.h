// The result of a sweep: one table, the same bytes however its runs were distributed.
#pragma once

#include <string>

#include "app/study/study_folder.h"
#include "app/sweep/sweep_journal.h"

namespace pneuma::app {

/// A row per run: its number, scene, parameters, verdict, exit code, measures, and its words.
/// `rows` has all runs.
std::string sweep_csv(const Sweep& sweep, const SweepRows& rows);
nlohmann::ordered_json sweep_json(const Sweep& sweep, const SweepRows& rows,
                                  const std::string& fingerprint);
/// Seconds of each run: what a table that is the same everywhere cannot have.
std::string seconds_csv(const SweepRows& rows);

/// How many runs came to what, for people, and of each way to fail the first run and its reason.
std::string sweep_summary(const Sweep& sweep, const SweepRows& rows);

/// Of the first run that failed, or done.
ExitCode exit_code_of(const SweepRows& rows);

/// A number of a run, of a parameter or a measure; not finite where it is none.
double number_of(const std::string& toml);
double number_of(const nlohmann::ordered_json& value);

}  // namespace pneuma::app
