// What implicit steps cost beside explicit ones, and from which stiffness on they are worth it.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/study/error/error_study.h"

namespace pneuma::app {

inline constexpr std::array costed_integrators = {
    sim::Integrator::rk4, sim::Integrator::implicit_euler, sim::Integrator::sdirk2};

struct StepCost {
  int vertices = 0;
  std::array<double, costed_integrators.size()> seconds = {};  // of the processor, median of a step
};

/// Of a free body, which its gas blows up and lets swing for a second from there on, in steps of
/// 1/60 s: the paper's sphere and torus, and spheres of 2,562 and 10,242 vertices; `few`: the first
/// two. Finer bodies are as heavy as a whole, of softer springs, so that rk4 is stable.
std::vector<StepCost> measure_step_costs(bool few,
                                         const std::function<void(const std::string&)>& say);

/// "58 vertices: ...", a table.
std::string step_cost_text(const std::vector<StepCost>& costs);
std::string step_cost_csv(const std::vector<StepCost>& costs);

/// The cheapest runs for an error of `stiff_error` at one spring constant.
struct StiffChoice {
  double k = 0.0;  // N/m
  std::optional<ErrorRun> of_explicit, of_implicit;

  bool implicit_wins() const {
    return of_implicit && (!of_explicit || of_implicit->run_time < of_explicit->run_time);
  }
};
inline constexpr double stiff_error = 1e-2;

StiffChoice choose_for_stiffness(double k, const ErrorStudy& study);

/// Of a scene in free flight for a second, by `pneuma study error`, with each of these spring
/// constants (and eight times as large a k_max) in turn. `load` makes the scene with overrides.
std::vector<StiffChoice> study_stiffness(
    const std::function<scenes::Scene(const std::vector<std::string>&)>& load,
    const std::vector<double>& stiffnesses, bool few,
    const std::function<void(const std::string&)>& say);

/// A table, and "implicit integrators are cheaper from k = ... on".
std::string stiffness_text(const std::vector<StiffChoice>& choices);
std::string stiffness_csv(const std::vector<StiffChoice>& choices);

}  // namespace pneuma::app
