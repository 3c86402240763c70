// pneuma study stability: its options, and what it leaves.
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/files/find_scene.h"
#include "app/host/standard_streams.h"
#include "app/record/provenance.h"
#include "app/study/stability/contact_stability.h"
#include "app/study/stability/stability_parts.h"
#include "app/study/stability/stability_report.h"
#include "app/study/stability/step_cost.h"
#include "app/study/study_command.h"
#include "app/study/study_folder.h"
#include "app/study/study_parts.h"
#include "app/terminal/common_options.h"
#include "app/terminal/progress.h"
#include "scenes/loader/load_scene.h"

namespace pneuma::app {
namespace {

struct StabilityArguments : SplitOptions {
  std::vector<std::string> scenes;
  std::vector<std::string> overrides;
  bool quiet = false;
};

std::string map_name(const std::string& scene, sim::Integrator integrator) {
  return fmt::format("{}_{}", scene, integrator_name(integrator));
}

void write_files(const StudyFolder& folder, const StabilityStudy& study) {
  folder.write(study.scene + "_limits.csv", limits_csv(study));
  folder.write(study.scene + "_trials.csv", trials_csv(study));
  for (const StiffnessLimit& limit : study.limits) {
    write_diagram(folder, map_name(study.scene, limit.integrator),
                  stability_map(study, limit.integrator));
  }
}

StudyFiles files_of(const std::vector<scenes::Scene>& scenes) {
  StudyFiles files = {{"stability.json", "contact.csv", "step_cost.csv", "stiffness.csv"}};
  for (const scenes::Scene& scene : scenes) {
    files.files.insert(files.files.end(), {scene.name + "_limits.csv", scene.name + "_trials.csv"});
    for (const sim::Integrator integrator : integrators_of(scene)) {
      files.diagrams.push_back(map_name(scene.name, integrator));
    }
  }
  return files;
}

std::vector<double> stiffnesses(bool few) {
  if (few) return {50.0, 5e4};
  std::vector<double> all;
  for (int i = 0; i < 11; ++i) all.push_back(50.0 * std::pow(10.0, 0.5 * i));
  return all;
}

using Say = std::function<void(const std::string&)>;

/// Of the first scene: what implicit steps cost and gain.
nlohmann::json measure_costs(const StabilityArguments& typed, const Say& say) {
  const auto load = [&](const std::vector<std::string>& stiffness) {
    std::vector<std::string> overrides = typed.overrides;
    overrides.insert(overrides.end(), stiffness.begin(), stiffness.end());
    return scenes::load_scene(find_scene(typed.scenes.front()), overrides);
  };
  const std::vector<StepCost> costs = measure_step_costs(typed.is_short, say);
  const std::vector<StiffChoice> choices =
      study_stiffness(load, stiffnesses(typed.is_short), typed.is_short, say);
  return {
      {"machine", machine_json()},
      {"csv", {{"step_cost", step_cost_csv(costs)}, {"stiffness", stiffness_csv(choices)}}},
      {"text", fmt::format("Processor time of a step of 1/60 s\n\n{}\n"
                           "{} in free flight, for an error of 1e-2 of its radius\n\n{}\n",
                           step_cost_text(costs), typed.scenes.front(), stiffness_text(choices))}};
}

/// Of the first scene: what lies on the ground, by potential.
nlohmann::json measure_contact(const StabilityArguments& typed, const scenes::Scene& scene,
                               const Say& say) {
  const std::vector<ContactStabilityPoint> points = study_contact_stability(
      scene, typed.is_short ? short_contact_sweep() : full_contact_sweep(), say);
  return {{"csv", {{"contact", contact_stability_csv(points)}}},
          {"text", contact_stability_text(scene.name, points)}};
}

/// Every scene's integrators one by one, then contact and the costs.
std::vector<StudyPart> parts_of(const StabilityArguments& typed,
                                const std::vector<scenes::Scene>& scenes,
                                const StabilityOptions& options, const Say& say) {
  std::vector<StudyPart> parts;
  for (const scenes::Scene& scene : scenes) {
    for (const sim::Integrator integrator : integrators_of(scene)) {
      parts.push_back({part_name({scene.name, integrator_name(integrator)}), [&, integrator] {
                         StabilityOptions one = options;
                         one.integrators = {integrator};
                         return part_json(study_stability(scene, one, [&](const auto& what) {
                           say(fmt::format("{}: {}", scene.name, what));
                         }));
                       }});
    }
  }
  parts.push_back({"contact", [&] { return measure_contact(typed, scenes.front(), say); }});
  parts.push_back({"costs", [&] { return measure_costs(typed, say); }});
  return parts;
}

ExitCode run_stability_study(const StabilityArguments& typed) {
  const std::vector<scenes::Scene> scenes = load_scenes(typed.scenes, typed.overrides);
  const StabilityOptions options =
      typed.is_short ? short_stability_sweep() : full_stability_sweep();
  Progress progress(progress_style(typed.quiet));
  const Say say = [&](const std::string& what) { progress.show(what); };
  const auto measured = measure_parts(typed, {"stability", files_of(scenes)}, scenes,
                                      parts_of(typed, scenes, options, say));
  if (!measured) return ExitCode::done;
  const StudyFolder folder(typed.out);
  nlohmann::json json = study_head(typed);
  std::span<const nlohmann::json> left = *measured;
  for (const scenes::Scene& scene : scenes) {
    const std::size_t count = integrators_of(scene).size();
    const StabilityStudy study = join_parts(options, left.first(count));
    left = left.subspan(count);
    write_files(folder, study);
    json["scenes"].push_back(stability_json(study));
    fmt::print("{}\n", stability_text(study));
  }
  folder.write("stability.json", json.dump(2) + '\n');
  if (left.back()["machine"]["cpu"] != machine().cpu) {
    print_message("costs were measured on another machine: {}\n",
                  left.back()["machine"]["cpu"].get<std::string>());
  }
  for (const nlohmann::json& part : left) {
    for (const auto& [file, text] : part["csv"].items()) folder.write(file + ".csv", text);
    fmt::print("{}\n", part["text"].get<std::string>());
  }
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
  add_split_options(*command, *typed, command_line, "Fewer values and shorter trials: seconds");
  add_quiet_option(*command, typed->quiet);
  command->callback([typed, &action] { action = [typed] { return run_stability_study(*typed); }; });
}

}  // namespace pneuma::app
