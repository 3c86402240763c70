// What an error study says: orders, recommendations, and where we stand beside
// SUNDIALS. All of it
// follows from the study's numbers.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "app/study/error/error_study.h"
#include "app/study/power_law.h"

namespace pneuma::app {

/// How the error of one of our integrators falls with the step.
struct ObservedOrder {
  std::string method;
  std::optional<double> theory;  // where there is one, and the motion is smooth
  /// A fit over steps with errors below a tenth and well above the uncertainty of the reference. Of
  /// a smooth motion: where a power law is reached, that is at least three neighbouring ones whose
  /// local exponents differ by 0.2 at most. With contacts there is no such place, and it is over
  /// all of them. Nothing when there are fewer than three.
  std::optional<PowerLaw> law;
  int first_steps_per_second = 0;
  int last_steps_per_second = 0;
  std::size_t points = 0;
};

/// In the order of the runs.
std::vector<ObservedOrder> observed_orders(const ErrorStudy& study);

/// The cheapest runs that are good enough.
struct Choice {
  double error = 0.0;            // asked for
  bool known = true;             // the reference is known well enough to tell
  std::optional<ErrorRun> ours;  // nothing when none is good enough
  std::optional<ErrorRun> peer;  // likewise; always with contacts
  /// Run time of SUNDIALS' over ours; only when there are both.
  std::optional<double> ratio() const;
};

Choice choose(const ErrorStudy& study, double error);

inline constexpr std::array recommended_errors = {1e-2, 1e-3, 1e-4};
inline constexpr std::array compared_errors = {1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6};

/// "for an error of 1e-2 take rk4 at step 1/30 s: 402 microseconds per simulated second (its error:
/// 1.6e-3)", or why there is none.
std::string recommendation(const Choice& choice);

/// Where ours is not ahead of SUNDIALS, of the errors compared: a sentence each that says so and
/// why.
std::vector<std::string> shortfalls(const ErrorStudy& study);

}  // namespace pneuma::app
