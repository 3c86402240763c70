#include "app/terminal/common_options.h"

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>

#include "app/host/thread_count.h"
#include "assets/model_file.h"
#include "scenes/loader/scene.h"

namespace pneuma::app {

void add_scene_option(CLI::App& command, std::string& scene) {
  command
      .add_option("scene", scene,
                  "A scene file, or the name of one in scenes/; or a model file (" +
                      assets::model_endings() + ")")
      ->required()
      ->type_name("SCENE|MODEL");
}

void add_override_option(CLI::App& command, std::vector<std::string>& overrides) {
  const auto has_value = [](const std::string& typed) -> std::string {
    if (typed.find('=') != std::string::npos) return {};
    return typed + ": expected PATH=VALUE in one word, such as duration=2 or body.k=200";
  };
  command.add_option("--set", overrides, "Override a value of the scene, as body.k=200")
      ->type_name("PATH=VALUE")
      ->check(has_value, "")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->allow_extra_args(false);  // or each would take all words up to the next option
}

void add_accuracy_option(CLI::App& command, std::optional<Accuracy>& accuracy) {
  const std::vector<std::string> names(accuracy_names.begin(), accuracy_names.end());
  command
      .add_option_function<std::string>(
          "--accuracy",
          [&accuracy, names](const std::string& name) {
            accuracy = static_cast<Accuracy>(std::ranges::find(names, name) - names.begin());
          },
          "Choose contact, integrator and step for a picture, or for an error of 1e-2 or 1e-3 of a "
          "body's radius; what --set says stays")
      ->type_name("NAME")
      ->check(CLI::IsMember(names));
}

void add_model_options(CLI::App& command, ModelChoice& choice) {
  command
      .add_option("--component", choice.component,
                  "Of a model file with several bodies: which, by name or number")
      ->type_name("NAME");
  command.add_flag("--repair", choice.repair,
                   "Of a model file: close cracks and small holes, split what meets in a point, "
                   "part a surface from itself");
  command
      .add_option_function<std::string>(
          "--up", [&choice](const std::string& axis) { choice.rotation = rotation_of_up(axis); },
          "Of a model file: which of its axes points upwards [y of glTF, what a DAE "
          "says, z of others]")
      ->type_name("AXIS")
      ->check(CLI::IsMember({"x", "y", "z"}));
  command
      .add_option("--vertices", choice.vertices,
                  fmt::format("Of a model file: simplify a finer one to so many [{}]",
                              most_chosen_vertices))
      ->type_name("N")
      ->check(CLI::Range(scenes::min_model_vertices, scenes::max_model_vertices));
}

void add_frames_option(CLI::App& command, std::string& frames) {
  command.add_option("--frames", frames, "The first N frames, or a part as 10-20, or 10-")
      ->type_name("N");
}

void add_backend_option(CLI::App& command, std::optional<render::Backend>& backend) {
  const std::vector<std::string> names(render::backend_names.begin(), render::backend_names.end());
  command
      .add_option_function<std::string>(
          "--backend",
          [&backend](const std::string& name) {
            backend = name == render::to_string(render::Backend::osmesa) ? render::Backend::osmesa
                                                                         : render::Backend::egl;
          },
          "What makes the OpenGL context [osmesa where it is installed, else egl]")
      ->type_name("NAME")
      ->check(CLI::IsMember(names));
}

void add_threads_option(CLI::App& command, int& threads) {
  command.add_option("--threads", threads, "Threads of the simulation [1]")
      ->check(CLI::Range(1, max_threads));
}

void add_examples(CLI::App& command, std::initializer_list<std::string> lines) {
  std::string footer = "Examples:";
  for (const std::string& line : lines) footer += "\n  " + line;
  command.footer(footer);
}

void add_quiet_option(CLI::App& command, bool& quiet) {
  command.add_flag("--quiet", quiet, "No progress: only errors, and data on standard output");
}

}  // namespace pneuma::app
