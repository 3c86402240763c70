#include "app/study/study_options.h"

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <nlohmann/json.hpp>

#include "app/host/command_line.h"
#include "app/host/errors.h"
#include "app/record/provenance.h"
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
