// `pneuma study stability`: the longest stable step of each integrator, found by trying, beside the
// one that theory predicts (sim/soft/stability_limit.h).
//
// One soft body of a scene, alone and at rest under its springs and gas, is given a little motion.
// One thing at a time is varied: the spring constant, the gas, the vertices' mass, the fineness of
// the mesh. With k goes k_max, eight times as large as the paper has it (50 of 400), so that
// damping stays the same fraction.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/study/stability/trial.h"
#include "scenes/loader/integrator_names.h"
#include "scenes/loader/scene.h"
#include "sim/world/world.h"

namespace pneuma::app {

/// One integrator, one value of what is varied.
struct StabilityPoint {
  sim::Integrator integrator;
  std::string varied;  // "k", "n", "vertex_mass", "vertices"
  double value = 0.0;
  std::optional<int> stable_rate = {};        // steps/s
  std::optional<double> predicted_step = {};  // s; nothing: no limit by theory
  std::vector<Trial> trials = {};

  /// s; nothing when no step that was tried is stable.
  std::optional<double> stable_step() const {
    return stable_rate ? std::optional(1.0 / *stable_rate) : std::nullopt;
  }
  /// Whether the longest step tried is stable.
  bool unlimited() const { return stable_rate == fewest_steps_per_second; }
};

/// The max. k at which an integrator is stable at 1/60 s, to 5 %.
struct StiffnessLimit {
  sim::Integrator integrator;
  double k = 0.0;          // N/m; 0 when not even the min. one tried
  bool unlimited = false;  // the max. one tried is borne
};

/// One cell of the map of step against stiffness.
struct StabilityCell {
  sim::Integrator integrator;
  double k = 0.0;  // N/m
  Trial trial;
};

struct StabilityOptions {
  TrialOptions trial;
  std::vector<sim::Integrator> integrators;  // none named: all that can integrate the body
  std::vector<double> k, n, vertex_mass;
  std::vector<int> subdivisions;    // of icospheres in place of the body's mesh
  std::vector<int> map_rates;       // steps/s of the map's cells
  std::int64_t most_map_steps = 0;  // of each cell
};
StabilityOptions full_stability_sweep();
StabilityOptions short_stability_sweep();

struct StabilityStudy {
  std::string scene;
  std::string body;
  StabilityOptions options;
  std::vector<StabilityPoint> points;
  std::vector<StiffnessLimit> limits;
  std::vector<StabilityCell> map;
};

/// Throws as study_stability does.
sim::SoftBody first_soft_body(const scenes::Scene& scene);

/// Those that can integrate the scene's first soft body. Throws as study_stability does.
std::vector<sim::Integrator> integrators_of(const scenes::Scene& scene);

/// `say` is told what is being tried. Throws UsageError for a scene without a soft body,
/// scenes::SceneError and Interrupted.
StabilityStudy study_stability(const scenes::Scene& scene, const StabilityOptions& options,
                               const std::function<void(const std::string&)>& say);

/// "at 1/60 s: martin up to k = ..., ..., implicit_euler: no limit found up to k = 1e+08".
std::string stiffness_sentence(const StabilityStudy& study);

/// As in the paper, 400 / 50.
inline constexpr double k_max_over_k = 8.0;

using scenes::integrator_name;

}  // namespace pneuma::app
