#include "app/study/error/conclusions.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/study/report_text.h"
#include "app/terminal/table.h"

namespace pneuma::app {
namespace {

using Status = ErrorRun::Status;

// Errors beyond are not small, and their terms of higher order not yet gone.
constexpr double greatest_asymptotic_error = 0.1;
// Errors below so many times the reference's own uncertainty are partly that.
constexpr double clear_of_uncertainty = 10.0;
constexpr double band = 0.2;

// By the words of scene files. One that is not here has an observed order only.
struct Theory {
  std::string_view method;
  double order;
};
constexpr std::array theories = {
    Theory{"martin", 1.0},
    Theory{"symplectic_euler", 1.0},
    Theory{"velocity_verlet", 2.0},
    Theory{"rk4", 4.0},
    Theory{"rk8", 8.0},
    Theory{"implicit_euler", 1.0},
    Theory{"sdirk2", 2.0},
};

std::optional<double> theory_of(const ErrorStudy& study, const std::string& method) {
  const auto* const known = std::ranges::find(theories, method, &Theory::method);
  if (study.flight.contacts || known == theories.end()) return std::nullopt;
  return known->order;
}

bool asymptotic(const ErrorStudy& study, const ErrorRun& run) {
  return run.ours && run.status == Status::stable && error_of(run) < greatest_asymptotic_error &&
         error_of(run) > clear_of_uncertainty * study.reference.uncertainty;
}

std::optional<PointRange> all_of(const std::vector<double>& points) {
  if (points.size() < 3) return std::nullopt;
  return PointRange{0, points.size() - 1};
}

void fit(const ErrorStudy& study, ObservedOrder& order) {
  std::vector<double> steps, errors;
  std::vector<int> rates;
  for (const ErrorRun& run : study.runs) {
    if (run.method != order.method || !asymptotic(study, run)) continue;
    steps.push_back(run.step());
    errors.push_back(error_of(run));
    rates.push_back(run.steps_per_second);
  }
  const auto range = study.flight.contacts ? all_of(steps) : power_law_range(steps, errors, band);
  if (!range) return;
  order.points = range->count();
  order.law = fit_power_law(std::span(steps).subspan(range->first, order.points),
                            std::span(errors).subspan(range->first, order.points));
  order.first_steps_per_second = rates[range->first];
  order.last_steps_per_second = rates[range->last];
}

void keep_cheaper(std::optional<ErrorRun>& best, const ErrorRun& run) {
  if (!best || run.run_time < best->run_time) best = run;
}

std::string in_microseconds(double seconds) { return readable(1e6 * seconds); }

/// Why not the next longer step; empty when there is none.
std::string next_longer(const ErrorStudy& study, const ErrorRun& run) {
  const auto longer = std::ranges::find_if(study.runs, [&](const ErrorRun& other) {
    return other.method == run.method && 2 * other.steps_per_second == run.steps_per_second;
  });
  if (longer == study.runs.end()) return "";
  const std::string what = longer->status == Status::stable
                               ? fmt::format("its error is {:.1e}", error_of(*longer))
                               : "it is unstable";
  return fmt::format(" (at 1/{} s {})", longer->steps_per_second, what);
}

/// What makes up the two run times, in evaluations of the forces.
std::string reason(const ErrorStudy& study, const Choice& choice) {
  const double evaluation = study.evaluation_time;
  const ErrorRun& ours = *choice.ours;
  const ErrorRun& peer = *choice.peer;
  const double own_work = std::max(0.0, 1.0 - peer.evaluations * evaluation / peer.run_time);
  const std::string theirs = fmt::format(
      "Per simulated second {} evaluates the forces {} times, at {} us each, and spends {:.0f} % "
      "of "
      "its time on other work;",
      peer.method, readable(peer.evaluations), in_microseconds(evaluation), 100.0 * own_work);
  return fmt::format("{} {} at 1/{} s takes as long as {} evaluations{}, theirs as long as {}.",
                     theirs, ours.method, ours.steps_per_second,
                     readable(ours.run_time / evaluation), next_longer(study, ours),
                     readable(peer.run_time / evaluation));
}

constexpr const char* not_known = "the motion itself is not known that well";

/// Empty when ours is ahead.
std::string shortfall(const ErrorStudy& study, const Choice& choice) {
  if (!choice.known) return fmt::format("nothing can be said: {}", not_known);
  if (!choice.ours) {
    return fmt::format("{}: none of our steps studied reaches it",
                       choice.peer ? "SUNDIALS is ahead" : "neither can be chosen");
  }
  if (!choice.peer || *choice.ratio() >= 1.0) return "";
  return fmt::format("ours is behind SUNDIALS, {:.2g} times as fast. {}", *choice.ratio(),
                     reason(study, choice));
}

}  // namespace

std::vector<ObservedOrder> observed_orders(const ErrorStudy& study) {
  std::vector<ObservedOrder> orders;
  for (const ErrorRun& run : study.runs) {
    if (!run.ours || (!orders.empty() && orders.back().method == run.method)) continue;
    ObservedOrder& order = orders.emplace_back();
    order.method = run.method;
    order.theory = theory_of(study, run.method);
    fit(study, order);
  }
  return orders;
}

std::optional<double> Choice::ratio() const {
  if (!ours || !peer) return std::nullopt;
  return peer->run_time / ours->run_time;
}

Choice choose(const ErrorStudy& study, double error) {
  Choice choice;
  choice.error = error;
  choice.known = study.reference.uncertainty <= 0.1 * error;
  if (!choice.known) return choice;
  for (const ErrorRun& run : study.runs) {
    if (run.status != Status::stable || !(error_of(run) <= error)) continue;
    keep_cheaper(run.ours ? choice.ours : choice.peer, run);
  }
  return choice;
}

std::string recommendation(const Choice& choice) {
  const std::string error = power_of_ten(choice.error);
  if (!choice.known) {
    return fmt::format("for an error of {} there is no recommendation: {}", error, not_known);
  }
  if (!choice.ours) {
    return fmt::format("an error of {} is reached by none of the steps studied", error);
  }
  const ErrorRun& run = *choice.ours;
  return fmt::format(
      "for an error of {} take {} at step 1/{} s: {} microseconds per simulated second (its error: "
      "{:.1e})",
      error, run.method, run.steps_per_second, in_microseconds(run.run_time), error_of(run));
}

std::vector<std::string> shortfalls(const ErrorStudy& study) {
  std::vector<std::string> sentences;
  if (study.flight.contacts) return sentences;
  for (const double error : compared_errors) {
    const std::string what = shortfall(study, choose(study, error));
    if (!what.empty()) {
      sentences.push_back(fmt::format("at an error of {} {}", power_of_ten(error), what));
    }
  }
  return sentences;
}

}  // namespace pneuma::app
