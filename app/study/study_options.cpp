#include "app/study/study_options.h"

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <nlohmann/json.hpp>

#include "app/files/refuse_to_replace.h"
#include "app/host/command_line.h"
#include "app/host/errors.h"
#include "app/host/interrupt.h"
#include "app/record/provenance.h"
#include "app/study/diagram.h"
#include "app/world/open_scene.h"

namespace pneuma::app {

void add_study_options(CLI::App& command, StudyOptions& options,
                       std::span<const std::string> command_line,
                       const std::string& what_is_short) {
  options.command_line = shell_line(command_line);
  options.out = "out/study/" + command.get_name();
  command
      .add_option("--out", options.out,
                  "Folder for tables, JSON and diagrams [" + options.out + "]")
      ->type_name("DIR");
  command.add_flag("--short", options.is_short, what_is_short);
  command.add_flag("--overwrite", options.overwrite, "Replace the study's files in the folder");
}

void refuse_old_files(const StudyOptions& options, const StudyFiles& files) {
  if (options.overwrite) return;
  const std::string other_place = "choose another folder with --out";
  refuse_to_replace(options.out, files.files, other_place);
  for (const std::string& diagram : files.diagrams) {
    refuse_to_replace(options.out, diagram_files(diagram), other_place);
  }
}

StudyFolder open_study_folder(const StudyOptions& options, const StudyFiles& files) {
  refuse_old_files(options, files);
  return StudyFolder(options.out);
}

namespace {

void refuse_paper_method(const scenes::Scene& scene) {
  if (!sim::is_as_printed(scene.settings)) return;
  throw UsageError(
      fmt::format("{} has simulation.method = \"paper\", which sets what this study varies; use "
                  "simulation.method = \"corrected\" (--set simulation.method=corrected)",
                  scene.name));
}

}  // namespace

std::vector<scenes::Scene> load_scenes(const std::vector<std::string>& names,
                                       const std::vector<std::string>& overrides) {
  const NothingToKeep nothing;
  std::vector<scenes::Scene> loaded;
  for (const std::string& name : names) {
    loaded.push_back(open_scene(name, overrides));
    refuse_paper_method(loaded.back());
  }
  return loaded;
}

nlohmann::json study_head(const StudyOptions& options) {
  nlohmann::json head = provenance_json();
  head["date"] = utc_date();
  head["command"] = options.command_line;
  return head;
}

}  // namespace pneuma::app
