// pneuma study choices: where this project departs from the paper, what that changes.
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/host/interrupt.h"
#include "app/host/timing_conditions.h"
#include "app/record/provenance.h"
#include "app/study/choices/choices_report.h"
#include "app/study/error/error_report.h"
#include "app/study/report_text.h"
#include "app/study/study_command.h"
#include "app/study/study_options.h"
#include "app/terminal/common_options.h"
#include "app/terminal/progress.h"
#include "app/world/build_world.h"
#include "app/world/open_scene.h"

namespace pneuma::app {
namespace {

/// The options as they were typed.
struct ChoicesArguments : StudyOptions {
  std::string scene = "one_sphere";
  std::vector<std::string> overrides;
  std::string body;
  bool json = false;
  bool quiet = false;
};

ChoicesStudy measure(const ChoicesArguments& typed, const scenes::Scene& scene,
                     Progress& progress) {
  ErrorOptions sweep = typed.is_short ? short_sweep() : full_sweep();
  sweep.tolerances.clear();
  sweep.flight.free_flight = true;
  sweep.flight.body = typed.body;
  DriftOptions drift;
  if (typed.is_short) drift = {.trials = 5, .seconds = 1.0};
  const double damping_seconds = typed.is_short ? 0.4 : 2.0;

  ChoicesStudy study;
  const auto say = [&](const std::string& what) {
    progress.show(fmt::format("{}: {}", scene.name, what));
  };
  study.integrators = study_errors(scene, sweep, say);
  study.name = study.integrators.name;
  study.title = scene.title;
  const sim::SoftBody& body = study.integrators.flight.world.soft.front();
  // At the scene's own step where that is shorter: it is what its springs need.
  const int own_rate = scene.settings.steps_per_second;
  while (drift.steps_per_second < own_rate) drift.steps_per_second *= 2;
  say("drift");
  study.drift = study_drift(body, drift);
  say("damping");
  study.damping = study_damping(body, sweep.steps_per_second, damping_seconds);
  return study;
}

void write_files(const StudyFolder& folder, const ChoicesStudy& study) {
  folder.write(study.name + "_drift.csv", drift_csv(study));
  folder.write(study.name + "_damping.csv", damping_csv(study));
  folder.write(study.name + "_martin.csv", martin_csv(study));
  write_diagram(folder, study.name + "_drift", drift_diagram(study));
  write_diagram(folder, study.name + "_damping", damping_diagram(study));
  write_diagram(folder, study.name + "_integrators", work_diagram(study.integrators));
}

StudyFiles files_of(const std::string& name) {
  return {{"choices.json", name + "_drift.csv", name + "_damping.csv", name + "_martin.csv"},
          {name + "_drift", name + "_damping", name + "_integrators"}};
}

ExitCode study(const ChoicesArguments& typed) {
  scenes::Scene scene =
      with_nothing_to_keep([&] { return open_scene(typed.scene, typed.overrides); });
  // Whatever the scene chooses, both are measured; the integrators on the one that is an equation.
  for (scenes::BodyScene& body : scene.bodies) body.material.damping = sim::Damping::dashpot;
  const StudyFolder folder = open_study_folder(typed, files_of(study_name(scene, typed.body)));
  const std::vector<std::string> warnings = timing_warnings(timing_conditions());
  Progress progress(progress_style(typed.quiet));
  const ChoicesStudy study = measure(typed, scene, progress);
  write_files(folder, study);

  nlohmann::json report = study_head(typed);
  report.update({{"warnings", warnings}, {"choices", choices_json(study)}});
  const std::string report_text = report.dump(2) + "\n";
  folder.write("choices.json", report_text);
  progress.say("files in " + folder.path().string());
  fmt::print("{}", typed.json ? report_text
                              : choices_text(study) + "\n" + provenance_text(report["date"]) +
                                    warnings_text(warnings));
  return ExitCode::done;
}

}  // namespace

void add_choices_study(CLI::App& study_command, Action& action,
                       std::span<const std::string> command_line) {
  const auto typed = std::make_shared<ChoicesArguments>();
  CLI::App* command = study_command.add_subcommand(
      "choices", "What the paper's own forms do beside ours: pressure, damping, integrator");
  command->add_option("scene", typed->scene, "A scene file or name [one_sphere]")
      ->type_name("SCENE");
  add_override_option(*command, typed->overrides);
  command->add_option("--body", typed->body, "This body of the scene [the first soft one]")
      ->type_name("NAME");
  add_study_options(*command, *typed, command_line, "Fewer steps, less time: to see that it works");
  command->add_flag("--json", typed->json, "JSON in place of text");
  add_quiet_option(*command, typed->quiet);
  command->callback([typed, &action] { action = [typed] { return study(*typed); }; });
}

}  // namespace pneuma::app
