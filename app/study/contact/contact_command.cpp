// pneuma study contacts: which contact and integrator, for which error.
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/host/errors.h"
#include "app/host/timing_conditions.h"
#include "app/record/provenance.h"
#include "app/study/contact/contact_report.h"
#include "app/study/report_text.h"
#include "app/study/study_command.h"
#include "app/study/study_folder.h"
#include "app/study/study_options.h"
#include "app/terminal/common_options.h"
#include "app/terminal/number_text.h"
#include "app/terminal/progress.h"

namespace pneuma::app {
namespace {

struct ContactArguments : StudyOptions {
  std::vector<std::string> scenes;
  std::vector<std::string> overrides;
  std::optional<double> seconds;
  bool json = false;
  bool quiet = false;
};

void write(const StudyFolder& folder, const ContactStudy& study) {
  folder.write(study.name + "_contacts.csv", contact_csv(study));
  write_diagram(folder, study.name + "_contacts", contact_diagram(study));
}

StudyFiles files_of(const std::vector<scenes::Scene>& scenes) {
  StudyFiles files = {{"contacts.json"}};
  for (const scenes::Scene& scene : scenes) {
    files.files.push_back(scene.name + "_contacts.csv");
    files.diagrams.push_back(scene.name + "_contacts");
  }
  return files;
}

ExitCode study(const ContactArguments& typed) {
  const std::vector<std::string> names =
      typed.scenes.empty() ? std::vector<std::string>{"two_spheres_contact"} : typed.scenes;
  const std::vector<scenes::Scene> scenes = load_scenes(names, typed.overrides);
  ContactOptions options = typed.is_short ? short_contact_options() : full_contact_options();
  options.seconds = typed.seconds;
  Progress progress(progress_style(typed.quiet));
  std::vector<std::string> warnings = timing_warnings(timing_conditions());
  const StudyFolder folder = open_study_folder(typed, files_of(scenes));
  std::vector<ContactStudy> studies;
  ExitCode code = ExitCode::done;
  for (const scenes::Scene& scene : scenes) {
    try {
      studies.push_back(study_contacts(scene, options, [&](const std::string& what) {
        progress.show(fmt::format("{}: {}", scene.name, what));
      }));
      write(folder, studies.back());
    } catch (const DivergenceError& error) {  // the other scenes are still worth measuring
      warnings.push_back(fmt::format("{} is missing: {}", scene.name, error.what()));
      code = ExitCode::diverged;
    }
  }
  nlohmann::json report = study_head(typed);
  report.update({{"warnings", warnings}, {"scenes", nlohmann::json::array()}});
  for (const ContactStudy& each : studies) report["scenes"].push_back(contact_json(each));
  const std::string text = report.dump(2) + "\n";
  folder.write("contacts.json", text);
  progress.say("files in " + folder.path().string());
  if (typed.json) {
    fmt::print("{}", text);
    return code;
  }
  for (const ContactStudy& each : studies) fmt::print("{}\n", contact_text(each));
  if (!studies.empty()) fmt::print("{}\n", advice_text(studies));
  fmt::print("{}{}", provenance_text(report["date"]), warnings_text(warnings));
  return code;
}

}  // namespace

void add_contact_study(CLI::App& study_command, Action& action,
                       std::span<const std::string> command_line) {
  const auto typed = std::make_shared<ContactArguments>();
  CLI::App* command = study_command.add_subcommand(
      "contacts",
      "Error against run time of swept contacts, impulses, the potential and the paper");
  command->add_option("scene", typed->scenes, "Scene files or names [two_spheres_contact]")
      ->type_name("SCENE");
  add_override_option(*command, typed->overrides);
  command
      ->add_option("--seconds", typed->seconds,
                   "Simulated time, at most the scene's own [1 from the first contact on]")
      ->type_name("S")
      ->check(number_range(0.1, 3600.0));
  add_study_options(*command, *typed, command_line, "Fewer steps: to see that it works");
  command->add_flag("--json", typed->json, "JSON in place of text");
  add_quiet_option(*command, typed->quiet);
  command->callback([typed, &action] { action = [typed] { return study(*typed); }; });
}

}  // namespace pneuma::app
