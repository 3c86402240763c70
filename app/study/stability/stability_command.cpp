// pneuma study stability: its options, and what it leaves.
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/study/stability/stability_report.h"
#include "app/study/stability/step_cost.h"
#include "app/study/study_command.h"
#include "app/study/study_folder.h"
#include "app/study/study_options.h"
#include "app/terminal/common_options.h"
#include "app/terminal/progress.h"
#include "app/world/find_scene.h"
#include "scenes/loader/load_scene.h"

namespace pneuma::app {
namespace {

struct StabilityArguments : StudyOptions {
  std::vector<std::string> scenes;
  std::vector<std::string> overrides;
  bool quiet = false;
};

void write_files(const StudyFolder& folder, const StabilityStudy& study) {
  folder.write(study.scene + "_limits.csv", limits_csv(study));
  folder.write(study.scene + "_trials.csv", trials_csv(study));
  for (const StiffnessLimit& limit : study.limits) {
    const std::string name = fmt::format("{}_{}", study.scene, integrator_name(limit.integrator));
    write_diagram(folder, name, stability_map(study, limit.integrator));
  }
}

std::vector<double> stiffnesses(bool few) {
  if (few) return {50.0, 5e4};
  std::vector<double> all;
  for (int i = 0; i < 11; ++i) all.push_back(50.0 * std::pow(10.0, 0.5 * i));
  return all;
}

/// Of the first scene: what implicit steps cost and gain.
void study_costs(const StabilityArguments& typed, const StudyFolder& folder, Progress& progress) {
  const auto say = [&](const std::string& what) { progress.show(what); };
  const auto load = [&](const std::vector<std::string>& stiffness) {
    std::vector<std::string> overrides = typed.overrides;
    overrides.insert(overrides.end(), stiffness.begin(), stiffness.end());
    return scenes::load_scene(find_scene(typed.scenes.front()), overrides);
  };
  const std::vector<StepCost> costs = measure_step_costs(typed.is_short, say);
  folder.write("step_cost.csv", step_cost_csv(costs));
  fmt::print("Processor time of a step of 1/60 s\n\n{}\n", step_cost_text(costs));
  const std::vector<StiffChoice> choices =
      study_stiffness(load, stiffnesses(typed.is_short), typed.is_short, say);
  folder.write("stiffness.csv", stiffness_csv(choices));
  fmt::print("{} in free flight, for an error of 1e-2 of its radius\n\n{}\n", typed.scenes.front(),
             stiffness_text(choices));
}

ExitCode run_stability_study(const StabilityArguments& typed) {
  const std::vector<scenes::Scene> loaded = load_scenes(typed.scenes, typed.overrides);
  const StudyFolder folder(typed.out);
  const StabilityOptions options =
      typed.is_short ? short_stability_sweep() : full_stability_sweep();
  Progress progress(progress_style(typed.quiet));
  nlohmann::json json = study_head(typed);
  for (const scenes::Scene& scene : loaded) {
    const StabilityStudy study = study_stability(scene, options, [&](const std::string& what) {
      progress.show(fmt::format("{}: {}", scene.name, what));
    });
    write_files(folder, study);
    json["scenes"].push_back(stability_json(study));
    fmt::print("{}\n", stability_text(study));
  }
  folder.write("stability.json", json.dump(2) + '\n');
  study_costs(typed, folder, progress);
  fmt::print("{}\n", folder.path().string());
  return ExitCode::done;
}

}  // namespace

void add_stability_study(CLI::App& study, Action& action,
                         std::span<const std::string> command_line) {
  const auto typed = std::make_shared<StabilityArguments>();
  typed->scenes = {"one_sphere"};
  CLI::App* command = study.add_subcommand(
      "stability", "The longest stable step of each integrator, found and predicted");
  command
      ->add_option("scene", typed->scenes,
                   "Scene files or names, of whose first soft body [one_sphere]")
      ->type_name("SCENE");
  add_override_option(*command, typed->overrides);
  add_study_options(*command, *typed, command_line, "Fewer values and shorter trials: seconds");
  add_quiet_option(*command, typed->quiet);
  command->callback([typed, &action] { action = [typed] { return run_stability_study(*typed); }; });
}

}  // namespace pneuma::app
