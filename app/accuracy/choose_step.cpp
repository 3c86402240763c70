#include "app/accuracy/choose_step.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "app/accuracy/measured_steps.h"
#include "app/accuracy/motion_time.h"
#include "app/host/errors.h"
#include "app/world/build_world.h"
#include "app/world/distinct_bodies.h"
#include "app/world/open_scene.h"
#include "scenes/loader/integrator_names.h"
#include "scenes/loader/overrides.h"
#include "sim/joints/body_springs.h"
#include "sim/joints/spring_limit.h"
#include "sim/step/stages/plan.h"

namespace pneuma::app {
namespace {

/// Of the predicted limit of stability: the longest explicit step that is taken. What a body does
/// when it is hit is stiffer than the small motions of the prediction.
constexpr double fraction_of_limit = 0.8;
constexpr double highest_rate = 1e6;  // 1/s, that a scene may ask for

Situation situation_of(const sim::World& world) {
  if (!std::ranges::all_of(world.rigid, &sim::RigidBox::is_kinematic)) return Situation::boxes;
  if (world.soft.size() > 1) return Situation::bodies;
  const bool alone = world.rigid.empty() && !world.settings.ground;
  return alone ? Situation::free_flight : Situation::one_body;
}

/// s, of the body that is the first to fail; infinite for implicit integrators, but for springs
/// between bodies.
double stable_step(const sim::World& world, sim::Integrator integrator) {
  double least = std::numeric_limits<double>::infinity();
  for (const DistinctBody& body : distinct_bodies(world)) {
    least = std::min(least, sim::settled_stability_limit(integrator, *body.first).step);
  }
  for (int i = 0; i < static_cast<int>(world.soft.size()); ++i) {
    if (sim::is_kinematic(world.soft[sim::at(i)]) || !sim::has_springs(world, i)) continue;
    least = std::min(least, sim::joined_stability_limit(integrator, world, i).step);
  }
  return least;
}

struct Candidate {
  sim::Integrator integrator;
  double rate = 0.0;  // steps per second, whole numbers a frame
  double cost = 0.0;  // per simulated second
  std::string why;
};

class StepChooser {
 public:
  StepChooser(const scenes::Scene& scene, Accuracy accuracy, std::span<const std::string> overrides)
      : scene_(scene),
        accuracy_(accuracy),
        given_(overrides),
        world_(build_world(scene)),
        situation_(situation_of(world_)),
        time_(motion_time(world_, scene.duration)) {}

  StepChoice make() {
    refuse_what_has_no_choice();
    std::vector<Candidate> candidates = all_candidates();
    const bool given_step = scenes::is_overridden(given_, "simulation.steps_per_second");
    if (given_step) {
      std::erase_if(candidates, [&](const Candidate& candidate) {
        return candidate.rate > scene_.settings.steps_per_second;
      });
    }
    if (candidates.empty()) refuse_step();
    const Candidate best = *std::ranges::min_element(candidates, {}, &Candidate::cost);
    StepChoice choice{{}, best.why};
    if (!scenes::is_overridden(given_, "simulation.integrator")) {
      choice.overrides.push_back("simulation.integrator=" +
                                 scenes::integrator_name(best.integrator));
    }
    if (!given_step) {
      choice.overrides.push_back(fmt::format("simulation.steps_per_second={:.0f}", best.rate));
    }
    return choice;
  }

 private:
  void refuse_what_has_no_choice() const {
    if (sim::is_as_printed(scene_.settings)) {
      refuse(
          "simulation.method = \"paper\" sets contact and integrator itself; leave one of the "
          "two out, or add --set simulation.method=corrected");
    }
    if (scene_.settings.contact != sim::ContactMethod::swept) {
      refuse(
          "only swept contacts have measured steps; leave out --set simulation.contact, or set "
          "simulation.contact=swept if the scene has another");
    }
    for (const sim::SoftBody& body : world_.soft) {
      if (body.material.damping != sim::Damping::literal) continue;
      refuse(
          fmt::format("the damping of '{}' is literal, which depends on the step; add --set "
                      "body.damping=dashpot",
                      body.name));
    }
  }

  std::vector<Candidate> all_candidates() const {
    std::vector<Candidate> candidates;
    for (const MeasuredStep& row : measured_steps()) {
      const double steps = row.steps[static_cast<std::size_t>(accuracy_)];
      if (row.situation != situation_ || steps == 0.0 || !allowed(row.integrator)) continue;
      const double stable = fraction_of_limit * stable_step(world_, row.integrator);
      const double step = std::min(time_.seconds / steps, stable);
      const double frames = scene_.picture.frames_per_second;
      const double rate = frames * std::max(1.0, std::ceil(1.0 / (step * frames) - 1e-9));
      if (!(rate <= highest_rate)) continue;
      candidates.push_back({row.integrator, rate, rate * row.cost, why(steps, stable)});
    }
    return candidates;
  }

  bool allowed(sim::Integrator integrator) const {
    const bool other = scenes::is_overridden(given_, "simulation.integrator") &&
                       integrator != scene_.settings.integrator;
    return !other && std::ranges::all_of(world_.soft, [&](const sim::SoftBody& body) {
      return sim::can_integrate(integrator, body.material);
    });
  }

  std::string why(double steps, double stable) const {
    if (stable < time_.seconds / steps) {
      return fmt::format("{}; {:g} of the predicted limit of stability", to_string(situation_),
                         fraction_of_limit);
    }
    return fmt::format("{}; {:g} steps in the {:.2g} s in which '{}' moves by its radius",
                       to_string(situation_), steps, time_.seconds, time_.body);
  }

  [[noreturn]] void refuse_step() const {
    const std::vector<Candidate> candidates = all_candidates();
    if (candidates.empty()) {
      refuse(fmt::format("{} has no measured step for it; leave out --set simulation.integrator",
                         scenes::integrator_name(scene_.settings.integrator)));
    }
    const Candidate slowest = *std::ranges::min_element(candidates, {}, &Candidate::rate);
    refuse(
        fmt::format("{} steps per second are too few: at least {:.0f} are needed, with {}; "
                    "leave out --set simulation.steps_per_second",
                    scene_.settings.steps_per_second, slowest.rate,
                    scenes::integrator_name(slowest.integrator)));
  }

  [[noreturn]] void refuse(const std::string& why) const {
    throw UsageError(fmt::format("--accuracy {}: {}", to_string(accuracy_), why));
  }

  const scenes::Scene& scene_;
  Accuracy accuracy_;
  std::span<const std::string> given_;
  sim::World world_;
  Situation situation_;
  MotionTime time_;
};

}  // namespace

StepChoice choose_step(const scenes::Scene& scene, Accuracy accuracy,
                       std::span<const std::string> overrides) {
  return StepChooser(scene, accuracy, overrides).make();
}

std::string choice_text(Accuracy accuracy, const StepChoice& choice) {
  std::string text = fmt::format("--accuracy {}:", to_string(accuracy));
  for (const std::string& one : choice.overrides) text += " --set " + one;
  return fmt::format("{} ({})", text, choice.why);
}

AccurateScene open_scene(const std::string& name, const std::vector<std::string>& overrides,
                         const ModelChoice& model, std::optional<Accuracy> accuracy) {
  scenes::Scene scene = open_scene(name, overrides, model);
  if (!accuracy) return {std::move(scene), ""};
  const StepChoice choice = choose_step(scene, *accuracy, overrides);
  std::vector<std::string> all = overrides;
  all.insert(all.end(), choice.overrides.begin(), choice.overrides.end());
  return {open_scene(name, all, model), choice_text(*accuracy, choice)};
}

}  // namespace pneuma::app
