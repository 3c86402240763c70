// --accuracy: contact, integrator and step for a scene, from the measured table.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/accuracy/accuracy.h"
#include "app/world/model_scene.h"
#include "scenes/loader/scene.h"

namespace pneuma::app {

struct StepChoice {
  std::vector<std::string> overrides;  // "simulation.integrator=rk4": what was left to choose
  std::string why;  // "12 steps in the 0.071 s in which 'sphere' moves by its radius"
};

/// The cheapest integrator and longest step that the table has for what the scene contains, within
/// the predicted limit of stability, as many whole steps a frame. Keys that the overrides set stay
/// as they are, and the rest is chosen to fit. Throws UsageError, with what to do, when nothing
/// fits: with a step that is too long, another contact than swept, the paper's method or literal
/// damping.
StepChoice choose_step(const scenes::Scene& scene, Accuracy accuracy,
                       std::span<const std::string> overrides);

/// A scene as opened, and what was chosen for it.
struct AccurateScene {
  scenes::Scene scene;
  std::string choice;  // the --set options that one could write, and why; empty: nothing
};

/// open_scene, with what is chosen for the accuracy; without one just that.
AccurateScene open_scene(const std::string& name, const std::vector<std::string>& overrides,
                         const ModelChoice& model, std::optional<Accuracy> accuracy);

/// "--accuracy 1e-2: --set simulation.integrator=rk4 ... (why)".
std::string choice_text(Accuracy accuracy, const StepChoice& choice);

}  // namespace pneuma::app
