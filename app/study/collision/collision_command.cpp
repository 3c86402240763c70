// pneuma study collision: its options, and what it leaves.
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/host/errors.h"
#include "app/study/collision/collision_report.h"
#include "app/study/study_command.h"
#include "app/study/study_folder.h"
#include "app/study/study_options.h"
#include "app/terminal/common_options.h"
#include "app/terminal/number_text.h"

namespace pneuma::app {
namespace {

const std::vector<std::string> default_scenes = {"two_spheres_contact", "three_spheres_contact",
                                                 "sphere_in_torus", "torus_three_spheres"};

struct CollisionArguments : StudyOptions {
  std::vector<std::string> scenes;
  std::vector<std::string> overrides;
  CollisionStudyOptions study;
};

/// With contacts by impulses, whose search this is: swept contacts are found otherwise, and nothing
/// is to be chosen there. Loaded as asked for first, for whatever is to be refused about that.
std::vector<scenes::Scene> load_with_impulses(const CollisionArguments& options) {
  const auto& names = options.scenes.empty() ? default_scenes : options.scenes;
  load_scenes(names, options.overrides);
  std::vector<std::string> overrides = options.overrides;
  overrides.emplace_back("simulation.contact=impulses");
  return load_scenes(names, overrides);
}

std::vector<scenes::Scene> load(const CollisionArguments& options) {
  std::vector<scenes::Scene> loaded = load_with_impulses(options);
  for (const scenes::Scene& scene : loaded) {
    std::int64_t soft = 0;
    for (const scenes::BodyScene& body : scene.bodies) {
      if (body.kind == scenes::BodyKind::soft) soft += scenes::copy_count(body);
    }
    if (soft < 2) {
      throw UsageError(fmt::format(
          "{} has fewer than two soft bodies, so that no soft contacts are searched for; choose "
          "another scene, such as {}",
          scene.name, default_scenes.front()));
    }
  }
  return loaded;
}

StudyFiles files_of(const std::vector<scenes::Scene>& scenes) {
  StudyFiles files = {{"collision.csv", "collision.json"}};
  for (const scenes::Scene& scene : scenes) files.diagrams.push_back("collision_" + scene.name);
  return files;
}

ExitCode run_collision_study(const CollisionArguments& options) {
  const std::vector<scenes::Scene> loaded = load(options);
  const StudyFolder folder = open_study_folder(options, files_of(loaded));
  CollisionStudyOptions study = options.study;
  study.few = options.is_short;
  std::vector<CollisionStudy> studies;
  for (const scenes::Scene& scene : loaded) {
    studies.push_back(study_collision(scene, study));
    fmt::print("{}\n", collision_text(studies.back()));
    if (studies.back().steps > 0) {
      write_diagram(folder, "collision_" + scene.name, collision_diagram(studies.back()));
    }
  }
  folder.write("collision.csv", collision_csv(studies));
  nlohmann::json report = study_head(options);
  report["scenes"] = collision_json(studies);
  folder.write("collision.json", report.dump(2) + '\n');
  fmt::print("{}\n", folder.path().string());
  return ExitCode::done;
}

}  // namespace

void add_collision_study(CLI::App& study, Action& action,
                         std::span<const std::string> command_line) {
  const auto options = std::make_shared<CollisionArguments>();
  CLI::App* command = study.add_subcommand(
      "collision", "What the search for contacts of soft bodies finds, and what it costs");
  std::string defaults;
  for (const std::string& name : default_scenes) defaults += (defaults.empty() ? "" : " ") + name;
  command->add_option("scene", options->scenes, "Scene files or names [" + defaults + "]")
      ->type_name("SCENE");
  add_override_option(*command, options->overrides);
  command->add_option("--seconds", options->study.seconds, "Only the scenes' first S seconds [10]")
      ->type_name("S")
      ->check(number_range(0.1, 1e4));
  add_study_options(*command, *options, command_line, "Four settings in place of all");
  command->callback(
      [options, &action] { action = [options] { return run_collision_study(*options); }; });
}

}  // namespace pneuma::app
