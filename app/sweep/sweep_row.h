// What one run of a sweep came to: a row of its table.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "app/host/exit_code.h"
#include "app/sweep/sweep.h"

namespace pneuma::app {

struct SweepRow {
  std::int64_t run = 0;
  ExitCode code = ExitCode::done;  // what `pneuma check --run` would end with
  std::string words;               // what it would say of an error; empty: nothing
  // Of the measures, by their names; null: not measured. What a run had when it diverged is no
  // measure of its scene: of that there is only how far it came.
  nlohmann::ordered_json values;
  double seconds = 0.0;  // that it took; no part of the table, which is the same everywhere
};

/// Runs it on the calling thread. Whatever goes wrong with the run is in the row. Pictures go to
/// picture_folder(folder, run); none are made when `folder` is empty. Throws Interrupted only.
SweepRow run_one(const Sweep& sweep, const SweepRun& run, const std::filesystem::path& folder);

/// A run that failed for want of disk or memory says nothing about its scene: it is made again.
inline bool is_to_be_repeated(const SweepRow& row) { return row.code == ExitCode::input_output; }

/// Others have no pictures.
inline bool came_to_its_end(const SweepRow& row) {
  return row.code == ExitCode::done || row.code == ExitCode::check_failed;
}

/// "done", "diverged", "crossed", ...
std::string verdict_text(ExitCode code);

nlohmann::ordered_json row_json(const SweepRow& row);
/// Throws nlohmann::json::exception for what row_json has not made.
SweepRow row_of(const nlohmann::ordered_json& json);

}  // namespace pneuma::app
