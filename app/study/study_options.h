// What the studies have in common: options, scenes and the head of their JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "scenes/loader/scene.h"

namespace CLI {
class App;
}

namespace pneuma::app {

struct StudyOptions {
  std::string out;           // folder
  std::string command_line;  // as it was typed, for the report
  bool is_short = false;
};

/// --out DIR, by default out/study/NAME of the command, and --short.
void add_study_options(CLI::App& command, StudyOptions& options,
                       std::span<const std::string> command_line, const std::string& what_is_short);

/// All are loaded first, so that a slip in the last one is seen before anything is measured. Throws
/// UsageError for a scene by the paper's method: it is one set of choices, and studies vary some of
/// them, so that they would measure what is neither the paper's method nor ours.
std::vector<scenes::Scene> load_scenes(const std::vector<std::string>& names,
                                       const std::vector<std::string>& overrides);

/// Machine, program, date and command: what a study's JSON says of itself.
nlohmann::json study_head(const StudyOptions& options);

}  // namespace pneuma::app
