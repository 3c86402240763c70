// What the studies have in common: options, scenes and the head of their JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "app/study/study_folder.h"
#include "scenes/loader/scene.h"

namespace CLI {
class App;
}

namespace pneuma::app {

struct StudyOptions {
  std::string out;           // folder
  std::string command_line;  // as it was typed, for the report
  bool is_short = false;
  bool overwrite = false;
};

/// What a study leaves in its folder.
struct StudyFiles {
  std::vector<std::string> files = {};
  std::vector<std::string> diagrams = {};  // as write_diagram calls them
};

/// --out DIR, by default out/study/NAME of the command, --short and --overwrite.
void add_study_options(CLI::App& command, StudyOptions& options,
                       std::span<const std::string> command_line, const std::string& what_is_short);

/// Throws base::IoError where one of those is there already and --overwrite is not given: before
/// anything is measured.
void refuse_old_files(const StudyOptions& options, const StudyFiles& files);
/// The same, and makes the folder.
StudyFolder open_study_folder(const StudyOptions& options, const StudyFiles& files);

/// All are loaded first, so that a slip in the last one is seen before anything is measured. Throws
/// UsageError for a scene by the paper's method: it is one set of choices, and studies vary some of
/// them, so that they would measure what is neither the paper's method nor ours.
std::vector<scenes::Scene> load_scenes(const std::vector<std::string>& names,
                                       const std::vector<std::string>& overrides);

/// Machine, program, date and command: what a study's JSON says of itself.
nlohmann::json study_head(const StudyOptions& options);

}  // namespace pneuma::app
