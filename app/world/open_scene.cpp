#include "app/world/open_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <optional>

#include "app/files/find_model.h"
#include "app/files/find_scene.h"
#include "app/files/refuse_body.h"
#include "app/host/errors.h"
#include "app/world/build_world.h"
#include "app/world/fastest_motion.h"
#include "app/world/scene_warnings.h"
#include "app/world/smallest_box.h"
#include "app/world/start_overlap.h"
#include "app/world/step_advice.h"
#include "assets/model.h"
#include "assets/model_file.h"
#include "scenes/loader/load_scene.h"
#include "scenes/loader/overrides.h"
#include "scenes/loader/text_checks.h"

namespace pneuma::app {
namespace {

/// So that a run still ends: stiffer bodies are for implicit methods, as their refusal says.
constexpr int most_chosen_steps = 100'000;

constexpr double most_mib = 2048.0;  // of limits.model_file_mib

/// Damping by the step is of the steps that were thought of.
bool is_damped_by_the_step(const scenes::Scene& scene) {
  return sim::is_as_printed(scene.settings) ||
         std::ranges::any_of(scene.bodies, [](const scenes::BodyScene& body) {
           return body.material.damping == sim::Damping::literal;
         });
}

bool can_be_chosen(const StepAdvice& advice) {
  return advice.steps_per_second > 0 && advice.steps_per_second <= most_chosen_steps;
}

std::string why_shorter(const StepAdvice& advice) {
  const std::string stable =
      fmt::format("small motions are stable up to {:.3g} s for {}", advice.limit, advice.why);
  if (advice.too_long()) return stable;
  return fmt::format("{}, and steps beyond {:.3g} s come too near that", stable, advice.safe);
}

std::string why_shorter(const FastestMotion& motion) {
  return fmt::format("it is moved at up to {:.3g} m/s, and body '{}' is {:.3g} m wide",
                     motion.speed, motion.soft, motion.extent);
}

std::string why_shorter(const SmallestBox& box) {
  return fmt::format("it falls by its {:.3g} m across in {:.3g} s", box.extent, box.fall_time);
}

struct ChosenStep {
  int steps_per_second = 0;
  std::string body = {}, why = {};  // empty: the scene's
};

/// Of the bodies whose steps are not safe the one that needs the shortest; the scene's if there is
/// none.
ChosenStep shortest_step(int of_scene, const std::vector<StepAdvice>& advices) {
  ChosenStep chosen{of_scene};
  for (const StepAdvice& advice : advices) {
    if (advice.is_safe() || advice.steps_per_second <= chosen.steps_per_second) continue;
    chosen = {advice.steps_per_second, advice.body, why_shorter(advice)};
  }
  return chosen;
}

/// A multiple of what is chosen: that fits frames, and is as stable.
template <class Need>
void shorten(ChosenStep& chosen, const std::optional<Need>& need) {
  if (!need) return;
  const double factor = std::ceil(need->steps_per_second() / chosen.steps_per_second);
  if (factor <= 1.0) return;
  chosen = {static_cast<int>(factor) * chosen.steps_per_second, need->body, why_shorter(*need)};
}

void choose_step(scenes::Scene& scene) {
  if (scene.names_step || is_damped_by_the_step(scene)) return;
  const sim::World world = build_world(scene);
  const std::vector<StepAdvice> advices = step_advices(world);
  const bool is_refused = std::ranges::any_of(advices, [](const StepAdvice& advice) {
    return !advice.is_safe() && !can_be_chosen(advice);
  });
  if (is_refused) return;
  int& steps = scene.settings.steps_per_second;
  ChosenStep chosen = shortest_step(steps, advices);
  shorten(chosen, fastest_motion(world, scene.duration));
  shorten(chosen, smallest_box(world));
  if (chosen.why.empty()) return;
  scene.warnings.push_back(to_string(scenes::diagnostic_at(
      place_of(scene, chosen.body),
      fmt::format("note: body '{}': {} steps per second in place of {}, because {}; "
                  "simulation.steps_per_second sets others",
                  chosen.body, chosen.steps_per_second, steps, chosen.why))));
  steps = chosen.steps_per_second;
}

/// "--set simulation.integrator=implicit_euler, or --set simulation.steps_per_second=166200".
std::string ways_to_start(const StepAdvice& advice) {
  std::string ways = advice.implicit_can ? "--set simulation.integrator=implicit_euler" : "";
  if (advice.steps_per_second > 0) {
    ways += fmt::format("{}--set simulation.steps_per_second={}", ways.empty() ? "" : ", or ",
                        advice.steps_per_second);
  }
  return ways.empty() ? remedy(advice) : ways;
}

constexpr int steps_of_paper = 60;  // per second

/// More steps damp more, and a body that falls hangs in the air.
void note_damping_by_the_step(scenes::Scene& scene) {
  const int steps = scene.settings.steps_per_second;
  if (!is_damped_by_the_step(scene) || steps == steps_of_paper) return;
  const bool is_printed = sim::is_as_printed(scene.settings);
  scene.warnings.push_back(fmt::format(
      "note: {} acts once in every step, at {} steps per second {:.3g} times as often as at the "
      "paper's {}; {} does not depend on the step",
      is_printed ? "the damping of simulation.method = \"paper\"" : "damping = \"literal\"", steps,
      static_cast<double>(steps) / steps_of_paper, steps_of_paper,
      is_printed ? "that of simulation.method = \"corrected\"" : "damping = \"dashpot\""));
}

/// Where the file does not say how it is to be read.
std::vector<std::string> notes(const std::filesystem::path& model, const ModelChoice& choice,
                               const scenes::ModelScene& made) {
  std::vector<std::string> result;
  const std::string file = model.filename().string();
  if (!choice.rotation && assets::up_axis(model) == "z") {
    result.push_back(fmt::format(
        "note: {}: z is taken to point upwards; --up y if the model lies where it should stand",
        file));
  }
  if (!choice.vertices && made.vertices) {
    result.push_back(fmt::format(
        "note: {}: simplified to {} vertices; --vertices N takes more, and longer, or fewer", file,
        *made.vertices));
  }
  return result;
}

/// A model that an override turns is measured as it then stands, so that it starts above the
/// ground; one that an override gives more or fewer vertices has the step that these need.
scenes::Scene model_scene(const std::filesystem::path& model, ModelChoice choice,
                          std::span<const std::string> overrides) {
  const std::filesystem::path file = model_scene_file(model);
  const std::string text = model_scene_text(model, choice);
  scenes::Scene scene = scenes::parse_scene(text, file, overrides);
  const scenes::ModelScene made = scenes::parse_scene(text, file).bodies.front().model;
  const scenes::ModelScene wanted = scene.bodies.front().model;
  const bool is_turned = wanted.rotation != made.rotation;
  const bool is_remeshed = wanted.vertices != made.vertices;
  if (is_turned) choice.rotation = wanted.rotation;
  if (is_remeshed) choice.vertices = wanted.vertices;
  if (is_turned || is_remeshed) {
    scene = scenes::parse_scene(model_scene_text(model, choice), file, overrides);
  }
  std::ranges::move(notes(model, choice, scene.bodies.front().model),
                    std::back_inserter(scene.warnings));
  return scene;
}

/// Those that hold before there is a scene; bad values are refused with it.
ModelChoice with_limits(ModelChoice choice, std::span<const std::string> overrides) {
  const auto vertices = scenes::number_override(overrides, "limits.vertices_per_body");
  if (vertices && *vertices >= 1.0 && *vertices <= scenes::max_model_vertices) {
    choice.most_vertices = static_cast<int>(*vertices);
  }
  const auto mib = scenes::number_override(overrides, "limits.model_file_mib");
  if (mib && *mib > 0.0 && *mib <= most_mib) {
    choice.most_bytes = static_cast<std::size_t>(*mib * 1024.0 * 1024.0);
  }
  return choice;
}

/// The scene made of a model names the file.
void check_path(const std::filesystem::path& model) {
  const std::string path = std::filesystem::absolute(model).string();
  const std::string reason = scenes::check_file(path);
  if (!reason.empty()) throw assets::ModelError(fmt::format("{}: the path {}", path, reason));
}

}  // namespace

scenes::Scene open_scene(const std::string& name, std::span<const std::string> overrides,
                         const ModelChoice& choice) {
  if (assets::has_model_ending(name)) {
    const std::filesystem::path model = find_model(name, "");
    check_path(model);
    return model_scene(model, with_limits(choice, overrides), overrides);
  }
  if (choice.repair || choice.rotation || choice.vertices || !choice.component.empty()) {
    throw UsageError(
        "--repair, --component, --up and --vertices are of a model file; for a model in a scene "
        "use --set body.model.repair=true, body.model.component=NAME, "
        "body.model.rotation=[90,0,0] and body.model.vertices=N");
  }
  scenes::Scene scene = scenes::load_scene(find_scene(name), overrides, model_error);
  choose_step(scene);
  note_damping_by_the_step(scene);
  return scene;
}

sim::World build_checked_world(const scenes::Scene& scene) {
  sim::World start = build_world(scene);
  refuse_start_overlap(scene, start);
  refuse_unstable_step(scene, start);
  return start;
}

void refuse_unstable_step(const scenes::Scene& scene, const sim::World& start) {
  const int fewest = scenes::default_steps_per_second(scene.picture.frames_per_second);
  const bool is_chosen = scene.settings.steps_per_second != fewest;
  if (scene.names_step || is_chosen || is_damped_by_the_step(scene)) return;
  for (const StepAdvice& advice : step_advices(start)) {
    if (!advice.too_long() || can_be_chosen(advice)) continue;
    refuse_body(scene, place_of(scene, advice.body), advice.body,
                fmt::format("small motions stay stable up to steps of {:.3g} s for {}, and more "
                            "than {} steps per second are made only where asked for; use {}",
                            advice.limit, advice.why, most_chosen_steps, ways_to_start(advice)));
  }
}

}  // namespace pneuma::app
