#include "app/study/error/error_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "app/host/clock.h"
#include "app/host/interrupt.h"
#include "app/study/error/solver.h"
#include "scenes/loader/integrator_names.h"
#include "sim/base/enum_name.h"
#include "sim/soft/acceleration.h"

namespace pneuma::app {
namespace {

using Status = ErrorRun::Status;

// Off by more than this many rest radii a body is somewhere else altogether.
constexpr double unstable_error = 10.0;
// Repeats of long runs do not find a much lesser time, and take long.
constexpr double enough_timing = 0.5;
constexpr int least_repeats = 2;

/// A run, and how to start it.
struct Candidate {
  ErrorRun run;
  std::function<std::unique_ptr<Solver>()> start;
  int repeats = 0;
  double spent = 0.0;  // s
};

/// From coarse to fine, so that the first one that takes too long stops the rest.
using Method = std::vector<Candidate>;

bool can_integrate(sim::Integrator integrator, const sim::World& world) {
  return std::ranges::all_of(world.soft, [&](const sim::SoftBody& body) {
    return sim::can_integrate(integrator, body.material);
  });
}

std::vector<Method> all_methods(const Flight& flight, const ErrorOptions& options) {
  std::vector<Method> methods;
  for (const auto& [integrator, name] : scenes::integrator_names()) {
    if (!can_integrate(integrator, flight.world)) continue;
    const auto& wanted = options.integrators;
    if (!wanted.empty() && std::ranges::count(wanted, integrator) == 0) continue;
    const sim::Settings& settings = flight.world.settings;
    if (sim::is_as_printed(settings) && integrator != settings.integrator) continue;
    Method& method = methods.emplace_back();
    for (const int rate : options.steps_per_second) {
      sim::World world = flight.world;
      world.settings.integrator = integrator;
      world.settings.steps_per_second = rate;
      Candidate& candidate = method.emplace_back();
      candidate.run.method = name;
      candidate.run.steps_per_second = rate;
      candidate.start = [world = std::move(world), contacts = flight.contacts] {
        return make_stepper_solver(world, contacts);
      };
    }
  }
  // Contacts that are impulses are none of SUNDIALS' business.
  if (flight.contacts && flight.world.settings.contact != sim::ContactMethod::potential) {
    return methods;
  }
  for (const SundialsMethod kind : sundials_methods) {
    if (flight.contacts && is_preconditioned(kind)) continue;
    Method& method = methods.emplace_back();
    for (const double tolerance : options.tolerances) {
      Candidate& candidate = method.emplace_back();
      candidate.run.method = to_string(kind);
      candidate.run.ours = false;
      candidate.run.tolerance = tolerance;
      candidate.start = [&flight, kind, tolerance] {
        return make_peer_solver(flight.world, kind, tolerance);
      };
    }
  }
  return methods;
}

bool is_finite(const StateErrors& errors) {
  return std::isfinite(errors.position + errors.volume + errors.centre + errors.energy +
                       errors.momentum + errors.angular_momentum);
}

/// The run once, with its samples; the time is that of the stepping only.
void measure_error(Candidate& candidate, ErrorMeter& meter) {
  const std::unique_ptr<Solver> solver = candidate.start();
  ErrorRun& run = candidate.run;
  Trajectory trajectory;
  double seconds = 0.0;
  bool sound = true;
  while (sound && trajectory.size() < meter.size()) {
    throw_if_interrupted();
    const double start = thread_seconds();
    sound = solver->advance(trajectory.size());
    seconds += thread_seconds() - start;
    if (sound) trajectory.push_back(solver->sample());
  }
  const double simulated = sound ? sample_time(meter.size() - 1) : solver->failure_time();
  run.run_time = seconds / simulated;
  run.evaluations = static_cast<double>(solver->evaluations()) / simulated;
  candidate.repeats = 1;
  candidate.spent = seconds;
  if (!sound) {
    run.status = Status::unstable;
    run.failure = solver->failure();
    return;
  }
  run.errors = meter.errors(trajectory);
  if (!is_finite(run.errors.greatest) || run.errors.greatest.position > unstable_error) {
    run.status = Status::unstable;
    run.failure = "its errors grow without bound";
  }
}

/// The run once more, with nothing between the steps.
void measure_time(Candidate& candidate, std::size_t samples) {
  const std::unique_ptr<Solver> solver = candidate.start();
  bool sound = true;
  const double start = thread_seconds();
  for (std::size_t i = 0; sound && i < samples; ++i) sound = solver->advance(i);
  const double seconds = thread_seconds() - start;
  const double simulated = sound ? sample_time(samples - 1) : solver->failure_time();
  candidate.run.run_time = std::min(candidate.run.run_time, seconds / simulated);
  candidate.spent += seconds;
  ++candidate.repeats;
}

std::string label(const ErrorRun& run) {
  return run.ours ? fmt::format("{} at 1/{} s", run.method, run.steps_per_second)
                  : fmt::format("{} at tolerance {:.1e}", run.method, run.tolerance);
}

void measure_errors(Method& method, ErrorMeter& meter, const ErrorOptions& options,
                    const std::function<void(const std::string&)>& say) {
  std::string no_further;
  for (Candidate& candidate : method) {
    ErrorRun& run = candidate.run;
    if (!no_further.empty()) {
      run.status = Status::skipped;
      run.failure = no_further;
      continue;
    }
    say(label(run));
    measure_error(candidate, meter);
    if (candidate.spent > options.longest_run) {
      no_further = fmt::format("the run before it took {:.0f} s", candidate.spent);
    } else if (run.status == Status::stable && error_of(run) < options.finest_error) {
      no_further = "the run before it is good enough";
    }
  }
}

/// In rounds over all runs, so that a slow moment of the machine does not fall on all repeats of
/// one.
void measure_times(std::vector<Method>& methods, std::size_t samples, const ErrorOptions& options) {
  for (int round = 1; round < options.repeats; ++round) {
    for (Method& method : methods) {
      for (Candidate& candidate : method) {
        throw_if_interrupted();
        if (candidate.run.status == Status::skipped) continue;
        const bool enough = candidate.repeats >= least_repeats && candidate.spent > enough_timing;
        if (!enough && candidate.spent < options.longest_run) measure_time(candidate, samples);
      }
    }
  }
}

}  // namespace

std::string study_name(const scenes::Scene& scene, const std::string& body) {
  return body.empty() || scene.bodies.size() == 1 ? scene.name : scene.name + "_" + body;
}

std::string_view to_string(Status status) {
  static constexpr auto names = std::to_array<std::string_view>({"stable", "unstable", "skipped"});
  return base::enum_name(names, status);
}

ErrorOptions full_sweep() {
  ErrorOptions options;
  for (int rate = 15; rate <= 7680; rate *= 2) options.steps_per_second.push_back(rate);
  for (int i = 2; i <= 18; ++i) options.tolerances.push_back(std::pow(10.0, -0.5 * i));
  return options;
}

ErrorOptions short_sweep() {
  ErrorOptions options;
  options.flight.seconds = 0.4;
  for (int rate = 15; rate <= 960; rate *= 2) options.steps_per_second.push_back(rate);
  for (int i = 1; i <= 7; ++i) options.tolerances.push_back(std::pow(10.0, -i));
  options.repeats = 2;
  options.longest_run = 2.0;
  return options;
}

double measure_evaluation(const sim::World& world) {
  constexpr double batch = 1e-3;  // s: long for the clock, short beside a slice of the scheduler
  constexpr int batches = 20;
  double sum = 0.0;
  for (const sim::SoftBody& body : world.soft) {
    sim::AccelerationScratch scratch(*body.mesh);
    const sim::SoftAcceleration equation(*body.mesh, body.material, world.settings.gravity,
                                         scratch);
    sim::VertexArray acceleration(body.positions.size());
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < batches; ++i) {
      int count = 0;
      double elapsed = 0.0;
      const double start = thread_seconds();
      for (; elapsed < batch; elapsed = thread_seconds() - start) {
        for (int j = 0; j < 10; ++j, ++count) {
          equation(body.positions, body.velocities, acceleration);
        }
      }
      least = std::min(least, elapsed / count);
    }
    sum += least;
  }
  return sum;
}

double radius_of_first_body(const sim::World& world) {
  return world.soft.empty() ? 0.5 * world.rigid.front().size.norm()
                            : rest_radius(world.soft.front());
}

std::vector<ErrorRun> measure_runs(const Flight& flight, ErrorMeter& meter,
                                   const ErrorOptions& options,
                                   const std::function<void(const std::string&)>& say) {
  std::vector<Method> methods = all_methods(flight, options);
  for (Method& method : methods) measure_errors(method, meter, options, say);
  say("run times");
  measure_times(methods, meter.size(), options);
  std::vector<ErrorRun> runs;
  for (Method& method : methods) {
    for (Candidate& candidate : method) runs.push_back(std::move(candidate.run));
  }
  return runs;
}

ErrorStudy study_errors(const scenes::Scene& scene, const ErrorOptions& options,
                        const std::function<void(const std::string&)>& say) {
  ErrorStudy study;
  study.name = study_name(scene, options.flight.body);
  study.title = scene.title;
  say("what touches");
  study.flight = prepare_flight(scene, options.flight);
  study.rest_radius = radius_of_first_body(study.flight.world);
  for (const sim::SoftBody& body : study.flight.world.soft) study.vertices += body.positions.size();
  say("the reference");
  study.reference = make_reference(study.flight, options.steps_per_second.back());
  study.evaluation_time = measure_evaluation(study.flight.world);

  ErrorMeter meter(study.flight.world, study.reference.trajectory);
  study.runs = measure_runs(study.flight, meter, options, say);
  return study;
}

}  // namespace pneuma::app
