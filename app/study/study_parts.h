// A study in parts that machines can take by themselves: a workflow of them for Snakemake, one
// part, or all that were measured put together.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/study/study_options.h"

namespace pneuma::app {

struct SplitOptions : StudyOptions {
  std::string snakemake;  // folder for the workflow
  std::string part;       // the only one to be measured
  bool gather = false;
  std::vector<std::string> arguments;  // as typed
};

/// add_study_options, --snakemake DIR, --part NAME and --gather.
void add_split_options(CLI::App& command, SplitOptions& options,
                       std::span<const std::string> command_line, const std::string& what_is_short);

struct SplitStudy {
  std::string name;   // its JSON file's, which the workflow makes
  StudyFiles leaves;  // once all parts are there
};

struct StudyPart {
  std::string name;  // see part_name
  std::function<nlohmann::json()> measure;
};

/// Letters, digits, '-', '.' and '_' of these words, joined by '.': "one_sphere.rk4".
std::string part_name(std::initializer_list<std::string> words);

/// What all parts measured, in their order: measured now, and left in parts/ too, or, with
/// --gather, read from the folder. Nothing when --part leaves one of them in parts/NAME.json, or
/// --snakemake the workflow. Throws UsageError for two parts of one name and for a part that there
/// is not; base::IoError for parts that are missing or of another command, scene or program, and
/// for files that would be replaced without --overwrite.
std::optional<std::vector<nlohmann::json>> measure_parts(const SplitOptions& typed,
                                                         const SplitStudy& study,
                                                         std::span<const scenes::Scene> scenes,
                                                         std::span<const StudyPart> parts);

}  // namespace pneuma::app
